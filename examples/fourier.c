/* SPDX-License-Identifier: BSD-3-Clause */
/* May the interiors of an L and of a disc overlap? Link: -lcprox_fourier -lcprox */
#include <curve_proximity/cprox_fourier.h>
#include <stdio.h>

int main(void) {
  const double corners[6][2] = {{0, 0}, {1, 0}, {1, 0.4}, {0.4, 0.4}, {0.4, 1}, {0, 1}};
  const cprox_solid_description shape = {.kind = CPROX_SOLID_POLYGON, .corners = corners, .n = 6};
  const cprox_solid_description disc = {.kind = CPROX_SOLID_BALL, .dimension = 2, .radius = 0.2};
  const cprox_pose here = {.orientation = {.w = 1}};
  const cprox_pose places[2] = {{.position = {1.2, 1.2, 0}, .orientation = {.w = 1}},
                                {.position = {0.3, 0.3, 0}, .orientation = {.w = 1}}};
  cprox_workspace *workspace = cprox_workspace_create();
  cprox_solid *a = NULL, *b = NULL;
  cprox_gap *gap = NULL;
  cprox_gap_options options = CPROX_GAP_OPTIONS_DEFAULT;
  options.samples = 65;

  int exit_code = cprox_solid_create(&shape, workspace, &a) < 0 || cprox_solid_create(&disc, workspace, &b) < 0 ||
                  cprox_gap_create(a, b, &options, workspace, &gap) < 0;
  for (int i = 0; i < 2 && exit_code == 0; i++) {
    cprox_gap_result r;
    exit_code = cprox_gap_evaluate(gap, &here, &places[i], workspace, &r) < 0;
    if (exit_code == 0)
      printf("(%g, %g): %s, V/t = %.3f\n", places[i].position.x, places[i].position.y,
             cprox_gap_verdict_name(r.verdict), r.value);
  }
  if (exit_code != 0) fprintf(stderr, "%s\n", cprox_workspace_error(workspace));
  cprox_gap_free(gap);
  cprox_solid_free(b);
  cprox_solid_free(a);
  cprox_workspace_free(workspace);
  return exit_code;
}
