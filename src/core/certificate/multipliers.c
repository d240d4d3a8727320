/* SPDX-License-Identifier: BSD-3-Clause */
#include "certificate/multipliers.h"

#include "shape/body.h"

/* Rows that pull less than this part of the direction are left out: the others make a direction of their own. */
static const double SLIGHT = 1e-9;

/* x'Qx is convex for the checker, too, whose numbers are exact: no principal minor is negative. */
static bool is_convex(const double *q) {
  const double minors[3][3] = {{q[0], q[3], q[1]}, {q[0], q[5], q[2]}, {q[3], q[5], q[4]}};
  dd last = dd_from(0.0);
  for (int i = 0; i < 3; i++) {
    const dd square = dd_product(minors[i][2], minors[i][2]);
    last = dd_add(dd_product(minors[i][0], minors[i][1]), (dd){-square.high, -square.low});
    if (!(last.high >= 0.0)) return false;
  }
  const dd det = dd_add(dd_add(dd_scale(last, q[0]), dd_scale(dd_product(q[1], q[2]), 2.0 * q[4])),
                        dd_add(dd_scale(dd_product(q[1], q[1]), -q[5]), dd_scale(dd_product(q[2], q[2]), -q[3])));
  const double sizes = q[0] * q[3] * q[5];
  return det.high > 0x1p-90 * sizes || (det.high == 0.0 && det.low == 0.0);
}

static double pull_of(const implicit *body, const implicit_dual *dual, int32_t row) {
  const double l = fabs(dual->row[row]);
  if (row < body->n_planes) return l * vec_norm(body->plane[row].b);
  row -= body->n_planes;
  vec3 gradient;
  if (row < body->n_quadrics) {
    implicit_quadric_at(&body->quadric[row], dual->x, &gradient);
    return l * vec_norm(gradient);
  }
  row -= body->n_quadrics;
  return row < body->n_powers ? INFINITY : l * vec_norm(body->term[row - body->n_powers].a);
}

static int32_t rows_of(const implicit *body) {
  return implicit_count(body) + body->n_terms;
}

bool multipliers_find(const cprox_body *body_of, vec3 own, const cprox_certificate *certificate,
                      cprox_workspace *workspace, implicit_dual *dual) {
  const implicit *body = body_of->shape.implicit;
  const size_t solver = (implicit_memory(body, NULL) + 7) / 8, rows = (size_t)rows_of(body);
  double *memory = workspace_reserve(workspace, WORKSPACE_INTERIOR, (solver + rows) * sizeof *memory);
  if (!memory) return false;
  dual->row = memory + solver;
  for (int32_t i = 0; i < rows_of(body); i++) dual->row[i] = 0.0;
  if (!implicit_dual_along(body, vec_scale(1.0 / vec_norm(own), own), memory, dual)) return false;
  double most = 0.0;
  for (int32_t i = 0; i < rows_of(body); i++) {
    const double pull = pull_of(body, dual, i);
    if (pull < SLIGHT) dual->row[i] = 0.0;
    if (isfinite(pull)) most += pull;
    dual->row[i] = certificate_round(certificate, vec(dual->row[i], 0.0, 0.0)).x;
    const int32_t quadric = i - body->n_planes;
    const bool bent = quadric >= 0 && quadric < body->n_quadrics && dual->row[i] > 0.0;
    if (bent && !is_convex(body->quadric[quadric].q)) return false;
  }
  dual->x = certificate_round(certificate, dual->x);
  return most < 1e3;
}

void multipliers_write(const cprox_body *body_of, cprox_certificate *certificate, const implicit_dual *dual) {
  const implicit *body = body_of->shape.implicit;
  if (body->n_quadrics > 0) certificate_normal(certificate, dual->x);
  uint16_t n = 0;
  for (int32_t i = 0; i < rows_of(body); i++) n = (uint16_t)(n + (dual->row[i] != 0.0));
  certificate_short(certificate, n);
  for (int32_t i = 0; i < rows_of(body); i++) {
    if (dual->row[i] == 0.0) continue;
    certificate_short(certificate, (uint16_t)i);
    certificate_real(certificate, dual->row[i]);
  }
}

vec3 multipliers_direction(const cprox_body *body, const implicit_dual *dual, double *height) {
  const reach_set set = {.body = body};
  reach_direction n;
  const reach_value reach = reach_of_multipliers(&set, dual, &n);
  const vec3 own = vec(n.k[0].high, n.k[1].high, n.k[2].high);
  const double length = vec_norm(own);
  *height = (reach.value.high - vec_dot(own, body->centre)) / length;
  return vec_scale(1.0 / length, own);
}
