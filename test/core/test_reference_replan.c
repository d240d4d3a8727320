/* SPDX-License-Identifier: BSD-3-Clause */
/* A thousand quintic curves round two obstacles (A. Lakshmanan et al. 2019, Fig. 12): each distance is in its interval,
 * and the verdicts sort the curves as the reference does. */
#include <stdlib.h>

#include "curve_proximity/cprox.h"
#include "support/cases.h"
#include "support/csv.h"
#include "support/make_curve.h"

#define DELTA 0.03

static cprox_body *obstacle[2];

static int make_obstacles(void **state) {
  (void)state;
  csv_table table = csv_read("reference/replan_obstacles.csv");
  for (size_t k = 0; k < 2; k++) {
    double xy[64][2];
    size_t n = 0;
    for (size_t i = 0; i < table.n; i++) {
      if (csv_count(&table, &table.row[i], 0) != k + 1) continue;
      xy[n][0] = csv_number(&table, &table.row[i], 1);
      xy[n++][1] = csv_number(&table, &table.row[i], 2);
    }
    if (cprox_body_create_polygon((const double(*)[2])xy, n, NULL, &obstacle[k]) != CPROX_OK) return 1;
  }
  csv_free(&table);
  return 0;
}

static int free_obstacles(void **state) {
  (void)state;
  for (int k = 0; k < 2; k++) cprox_body_free(obstacle[k]);
  return 0;
}

/* The field `x;y;x;y...` of six points. */
static cprox_curve *curve_of(const csv_row *row) {
  vec3 p[6] = {{0, 0, 0}};
  char *at = row->field[1];
  for (int i = 0; i < 12; i++) {
    *(i % 2 ? &p[i / 2].y : &p[i / 2].x) = strtod(at, &at);
    if (*at == ';') at++;
  }
  assert_true(*at == '\0');
  cprox_curve *curve = NULL;
  assert_int_equal(curve_from(describe_bezier(p, 6, 0.0, 1.0), NULL, &curve), CPROX_OK);
  return curve;
}

/* The references are searches that ended within 1e-10. */
static void check_distance(const cprox_curve *curve, int k, double reference, cprox_workspace *ws) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-12;
  cprox_result r;
  assert_int_equal(
      cprox_distance(cprox_point_along(curve), cprox_obstacle_at(obstacle[k], CPROX_POSE_IDENTITY), &options, ws, &r),
      CPROX_OK);
  if (!(r.lower <= reference + 1e-10 && reference - 1e-10 <= r.upper))
    fail_msg("[%.17g, %.17g], the reference is %.17g", r.lower, r.upper, reference);
}

/* 1: farther than delta from both; 2: free, but nearer; 3: in collision. */
static unsigned class_of(const cprox_curve *curve, cprox_workspace *ws) {
  const cprox_mover mover = cprox_point_along(curve);
  unsigned worst = 1;
  for (int k = 0; k < 2; k++) {
    const cprox_obstacle target = cprox_obstacle_at(obstacle[k], CPROX_POSE_IDENTITY);
    cprox_result r;
    assert_int_equal(cprox_tolerance(mover, target, DELTA, NULL, ws, &r), CPROX_OK);
    if (r.verdict == CPROX_VERDICT_CLEAR) continue;
    assert_int_equal(r.verdict, CPROX_VERDICT_VIOLATED);
    assert_int_equal(cprox_collision(mover, target, NULL, ws, &r), CPROX_OK);
    const unsigned here = r.verdict == CPROX_VERDICT_VIOLATED ? 3 : 2;
    worst = here > worst ? here : worst;
  }
  return worst;
}

CASE(the_curves_are_sorted_as_the_reference_sorts_them) {
  csv_table table = csv_read("reference/replan_curves.csv");
  cprox_workspace *ws = cprox_workspace_create();
  size_t of_class[4] = {0};
  for (size_t i = 0; i < table.n; i++) {
    const csv_row *row = &table.row[i];
    cprox_curve *curve = curve_of(row);
    for (int k = 0; k < 2; k++) check_distance(curve, k, csv_number(&table, row, 2 + (size_t)k), ws);
    const unsigned class = class_of(curve, ws);
    if (class != csv_count(&table, row, 4)) fail_msg("curve %s: class %u", row->field[0], class);
    of_class[class]++;
    cprox_curve_free(curve);
  }
  print_message("%zu clear, %zu too near, %zu in collision\n", of_class[1], of_class[2], of_class[3]);
  assert_int_equal(of_class[1] + of_class[2] + of_class[3], 1000);
  cprox_workspace_free(ws);
  csv_free(&table);
}

int main(void) {
  return cases_run(make_obstacles, free_obstacles);
}
