/* SPDX-License-Identifier: BSD-3-Clause */
/* Reference answers in test/data/reference, computed by dense sampling and refinement in long double: every interval
 * contains its reference and is as narrow as asked, or says that double arithmetic allows no more. */
#include <stdlib.h>
#include <string.h>

#include "base/rounding.h"
#include "curve_proximity/cprox.h"
#include "support/cases.h"
#include "support/csv.h"
#include "support/make_curve.h"

/* The body of a case: one vertex is a point, vertices in the plane a polygon (two a segment), in space a polytope. */
static cprox_body *body_of(const csv_curve_case *c, cprox_workspace *ws) {
  cprox_body *body = NULL;
  cprox_status status;
  if (c->n_vertices == 1) {
    status = cprox_body_create_point(c->vertices[0], ws, &body);
  } else if (c->dim == 2 && c->n_vertices > 2) {
    double(*flat)[2] = malloc(c->n_vertices * sizeof *flat);
    for (size_t i = 0; i < c->n_vertices; i++) flat[i][0] = c->vertices[i].x, flat[i][1] = c->vertices[i].y;
    status = cprox_body_create_polygon((const double(*)[2])flat, c->n_vertices, ws, &body);
    free(flat);
  } else {
    status = cprox_body_create_polytope(c->vertices, c->n_vertices, ws, &body);
  }
  if (status != CPROX_OK) fail_msg("%s: %s", c->id, cprox_workspace_error(ws));
  return body;
}

static double largest_coordinate(const csv_curve_case *c) {
  double most = 0.0;
  for (size_t i = 0; i < c->n_points; i++)
    most = fmax(most, fmax(fabs(c->points[i].x), fmax(fabs(c->points[i].y), fabs(c->points[i].z))));
  for (size_t i = 0; i < c->n_vertices; i++)
    most = fmax(most, fmax(fabs(c->vertices[i].x), fmax(fabs(c->vertices[i].y), fabs(c->vertices[i].z))));
  return most;
}

static void check_distance(const csv_curve_case *c, const cprox_curve *curve, const cprox_body *body, double reference,
                           double epsilon, cprox_workspace *ws) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilon;
  cprox_result r;
  const cprox_status status =
      cprox_distance(cprox_point_along(curve), cprox_obstacle_at(body, CPROX_POSE_IDENTITY), &options, ws, &r);
  if (status != CPROX_OK && status != CPROX_PRECISION)
    fail_msg("%s: %s (%s), [%.17g, %.17g] after %u nodes", c->id, cprox_status_name(status), cprox_workspace_error(ws),
             r.lower, r.upper, r.nodes);
  /* the reference is rounded to 17 digits, its coordinates carried 64 bits, and its search stops within 1e-16 of a
   * contact */
  const double doubt =
      4.0 * ROUND_U * fabs(reference) + ldexp(4.0 * largest_coordinate(c), -64) + (reference < 1e-15 ? 1e-16 : 0.0);
  if (r.lower > reference + doubt || r.upper < reference - doubt)
    fail_msg("%s: [%.17g, %.17g] does not contain %.17g", c->id, r.lower, r.upper, reference);
  if (status == CPROX_OK && r.upper - r.lower > epsilon)
    fail_msg("%s: [%.17g, %.17g] is wider than %g", c->id, r.lower, r.upper, epsilon);

  /* the witness points are as far apart as upper says */
  const double apart = vec_norm(vec_sub(r.witness_mover, r.witness_obstacle));
  if (fabs(apart - r.upper) > 1e-9 * fmax(1.0, largest_coordinate(c)))
    fail_msg("%s: the witness points are %.17g apart, upper is %.17g", c->id, apart, r.upper);
}

static void check_verdicts(const csv_curve_case *c, const cprox_curve *curve, const cprox_body *body, double reference,
                           double epsilon, cprox_workspace *ws) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilon;
  const cprox_mover mover = cprox_point_along(curve);
  const cprox_obstacle target = cprox_obstacle_at(body, CPROX_POSE_IDENTITY);
  cprox_result r;
  assert_true(cprox_collision(mover, target, &options, ws, &r) >= 0);
  if (r.verdict == CPROX_VERDICT_VIOLATED && reference > 1e-15)
    fail_msg("%s: a collision at distance %g", c->id, reference);
  if (reference > epsilon) assert_int_equal(r.verdict, CPROX_VERDICT_CLEAR);
  if (reference < 1e-2 * epsilon && r.verdict == CPROX_VERDICT_CLEAR && r.lower > reference)
    fail_msg("%s: free at contact", c->id);
  if (reference <= 10.0 * epsilon) return;

  /* farther than 0.99 and 0.999999 of the distance everywhere, not farther than 1.000001 and 1.5 of it */
  const double clear[] = {0.5, 0.99, 1.0 - 1e-6}, violated[] = {1.0 + 1e-6, 1.01, 1.5};
  for (int k = 0; k < 3; k++) {
    assert_true(cprox_tolerance(mover, target, clear[k] * reference, &options, ws, &r) >= 0);
    if (r.verdict != CPROX_VERDICT_CLEAR && (1.0 - clear[k]) * reference > epsilon)
      fail_msg("%s: tolerance %s at %g of the distance", c->id, cprox_verdict_name(r.verdict), clear[k]);
    assert_true(cprox_tolerance(mover, target, violated[k] * reference, &options, ws, &r) >= 0);
    if (r.verdict == CPROX_VERDICT_CLEAR ||
        (r.verdict != CPROX_VERDICT_VIOLATED && (violated[k] - 1.0) * reference > epsilon))
      fail_msg("%s: tolerance %s at %g of the distance", c->id, cprox_verdict_name(r.verdict), violated[k]);
  }
}

static void check_file(const char *inputs, const char *references) {
  csv_table in = csv_read(inputs), ref = csv_read(references);
  csv_curve_case *c = malloc(sizeof *c);
  cprox_workspace *ws = cprox_workspace_create();
  assert_true(in.n > 30);
  for (size_t i = 0; i < in.n; i++) {
    csv_curve_case_read(&in, &in.row[i], c);
    const double reference = csv_number(&ref, csv_find(&ref, c->id), 1);
    cprox_curve *curve = NULL;
    if (curve_from(describe_bezier(c->points, c->n_points, 0.0, 1.0), ws, &curve) != CPROX_OK)
      fail_msg("%s: %s", c->id, cprox_workspace_error(ws));
    cprox_body *body = body_of(c, ws);
    const double scale = fmax(1.0, largest_coordinate(c));
    check_distance(c, curve, body, reference, 1e-9 * scale, ws);
    check_distance(c, curve, body, reference, 1e-12 * scale, ws);
    check_verdicts(c, curve, body, reference, 1e-9 * scale, ws);
    cprox_body_free(body);
    cprox_curve_free(curve);
  }
  cprox_workspace_free(ws);
  free(c);
  csv_free(&in);
  csv_free(&ref);
}

CASE(curve_point_intervals_contain_their_references) {
  check_file("reference/curve_point_inputs.csv", "reference/curve_point_ref.csv");
}

CASE(curve_polygon_intervals_contain_their_references) {
  check_file("reference/curve_polygon_inputs.csv", "reference/curve_polygon_ref.csv");
}

CASE(curve3d_intervals_contain_their_references) {
  check_file("reference/curve3d_inputs.csv", "reference/curve3d_ref.csv");
}

CASE(edge_case_intervals_contain_their_references) {
  check_file("reference/edge_inputs.csv", "reference/edge_ref.csv");
}

int main(void) {
  return cases_run(NULL, NULL);
}
