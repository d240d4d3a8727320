/* SPDX-License-Identifier: BSD-3-Clause */
/* How close does a ball of 2 cm, carried along a Bézier curve, come to a box? */
#include <curve_proximity/cprox.h>
#include <stdio.h>

int main(void) {
  const cprox_vec3 points[4] = {{-1.0, 0.0, 0.6}, {-0.2, 0.5, 0.4}, {0.3, -0.4, 0.9}, {1.0, 0.2, 0.5}};
  const cprox_curve_description bezier = {.kind = CPROX_CURVE_BEZIER, .points = points, .n = 4, .t1 = 1.0};
  cprox_workspace *workspace = cprox_workspace_create();
  cprox_curve *path = NULL;
  cprox_body *box = NULL;
  cprox_result r;

  if (cprox_curve_create(&bezier, workspace, &path) < 0 ||
      cprox_body_create_box((cprox_vec3){0.5, 0.5, 0.5}, workspace, &box) < 0 ||
      cprox_distance(cprox_tube_along(path, 0.02), cprox_obstacle_at(box, CPROX_POSE_IDENTITY), NULL, workspace, &r) <
          0) {
    fprintf(stderr, "%s\n", cprox_workspace_error(workspace));
    return 1;
  }
  printf("%.6f <= distance <= %.6f m, at t = %.4f (%s)\n", r.lower, r.upper, r.t, cprox_status_text(r.status));

  cprox_body_free(box);
  cprox_curve_free(path);
  cprox_workspace_free(workspace);
  return 0;
}
