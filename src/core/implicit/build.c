/* SPDX-License-Identifier: BSD-3-Clause */
/* From given coefficients to a body about its centre. */
#include <stdlib.h>
#include <string.h>

#include "base/double_double.h"
#include "base/rounding.h"
#include "base/workspace.h"
#include "implicit/implicit.h"

/* Sizes and coefficients outside these are not tested, and refused. */
static const double LEAST_SIZE = 1e-12, MOST_SIZE = 1e10, MOST_EXPONENT = 1000.0;

/* ---- memory ---- */

implicit *implicit_allocate(size_t planes, size_t quadrics, size_t powers, size_t terms) {
  const size_t bytes = sizeof(implicit) + planes * sizeof(implicit_plane) + quadrics * sizeof(implicit_quadric) +
                       powers * sizeof(implicit_power) + terms * sizeof(implicit_term);
  implicit *body = calloc(1, bytes);
  if (!body) return NULL;
  body->n_planes = (int32_t)planes;
  body->n_quadrics = (int32_t)quadrics;
  body->n_powers = (int32_t)powers;
  body->n_terms = (int32_t)terms;
  body->plane = (implicit_plane *)(void *)(body + 1);
  body->quadric = (implicit_quadric *)(void *)(body->plane + planes);
  body->term = (implicit_term *)(void *)(body->quadric + quadrics);
  body->power = (implicit_power *)(void *)(body->term + terms);
  return body;
}

static implicit *implicit_like(const implicit *body) {
  return implicit_allocate((size_t)body->n_planes, (size_t)body->n_quadrics, (size_t)body->n_powers,
                           (size_t)body->n_terms);
}

/* ---- checks ---- */

static double largest(const double *v, int n) {
  double most = 0.0;
  for (int i = 0; i < n; i++) most = isnan(v[i]) ? INFINITY : fmax(most, fabs(v[i]));
  return most;
}

static cprox_status check_vector(const char *what, int32_t k, vec3 v, double offset, cprox_workspace *workspace) {
  const double all[4] = {v.x, v.y, v.z, offset}, norm = largest(all, 3);
  if (!isfinite(largest(all, 4)))
    return workspace_fail(workspace, CPROX_INVALID, "%s %d is not finite: (%g, %g, %g, %g)", what, k, v.x, v.y, v.z,
                          offset);
  if (norm == 0.0) return workspace_fail(workspace, CPROX_INVALID, "the normal of %s %d is 0", what, k);
  if (norm < 1e-100 || norm > 1e100 || fabs(offset) > MOST_SIZE * norm)
    return workspace_fail(workspace, CPROX_INVALID, "%s %d is out of range: (%g, %g, %g, %g)", what, k, v.x, v.y, v.z,
                          offset);
  return CPROX_OK;
}

/* The least eigenvalue of a symmetric matrix, and its largest in size, by Jacobi's rotations. */
static double least_eigenvalue(const double q[6], double *most) {
  double a[3][3] = {{q[0], q[1], q[2]}, {q[1], q[3], q[4]}, {q[2], q[4], q[5]}};
  for (int sweep = 0; sweep < 30; sweep++) {
    for (int p = 0; p < 2; p++) {
      for (int r = p + 1; r < 3; r++) {
        if (a[p][r] == 0.0) continue;
        const double theta = 0.5 * atan2(2.0 * a[p][r], a[r][r] - a[p][p]), c = cos(theta), s = sin(theta);
        for (int k = 0; k < 3; k++) {
          const double x = a[k][p], y = a[k][r];
          a[k][p] = c * x - s * y;
          a[k][r] = s * x + c * y;
        }
        for (int k = 0; k < 3; k++) {
          const double x = a[p][k], y = a[r][k];
          a[p][k] = c * x - s * y;
          a[r][k] = s * x + c * y;
        }
      }
    }
  }
  *most = fmax(fabs(a[0][0]), fmax(fabs(a[1][1]), fabs(a[2][2])));
  return fmin(a[0][0], fmin(a[1][1], a[2][2]));
}

static cprox_status check_quadric(const implicit_quadric *quadric, int32_t k, cprox_workspace *workspace) {
  const double linear[4] = {quadric->b.x, quadric->b.y, quadric->b.z, quadric->c};
  const double q = largest(quadric->q, 6), b = largest(linear, 3), all = fmax(q, largest(linear, 4));
  if (!isfinite(all))
    return workspace_fail(workspace, CPROX_INVALID, "quadric %d has a coefficient that is not finite", k);
  if (q == 0.0 && b == 0.0)
    return workspace_fail(workspace, CPROX_INVALID, "quadric %d has no matrix and no normal", k);
  if (fmax(q, b) < 1e-60 || all > 1e60)
    return workspace_fail(workspace, CPROX_INVALID, "quadric %d has coefficients up to %g: out of range", k, all);
  double most;
  const double least = least_eigenvalue(quadric->q, &most);
  if (least < -64.0 * ROUND_U * most)
    return workspace_fail(workspace, CPROX_INVALID,
                          "quadric %d is not convex: its matrix is not positive semidefinite (an eigenvalue is %g)", k,
                          least);
  return CPROX_OK;
}

static cprox_status check_power(const implicit *given, int32_t k, cprox_workspace *workspace) {
  const implicit_power *power = &given->power[k];
  if (power->n < 1) return workspace_fail(workspace, CPROX_INVALID, "hyperquadric %d has no terms", k);
  if (power->n > IMPLICIT_MOST_TERMS)
    return workspace_fail(workspace, CPROX_INVALID, "hyperquadric %d has %d terms, at most %d are possible", k,
                          power->n, IMPLICIT_MOST_TERMS);
  for (int32_t i = 0; i < power->n; i++) {
    const implicit_term *t = &given->term[power->first + i];
    const double all[4] = {t->a.x, t->a.y, t->a.z, t->d}, a = largest(all, 3);
    if (!isfinite(largest(all, 4)))
      return workspace_fail(workspace, CPROX_INVALID, "term %d of hyperquadric %d is not finite: |(%g, %g, %g)·x + %g|",
                            i, k, t->a.x, t->a.y, t->a.z, t->d);
    if (!(t->p >= 1.0 && t->p <= MOST_EXPONENT))
      return workspace_fail(workspace, CPROX_INVALID,
                            "term %d of hyperquadric %d: the exponent is %g, must be between 1 and %g", i, k, t->p,
                            MOST_EXPONENT);
    if (a < 1.0 / MOST_SIZE || a > 1.0 / LEAST_SIZE || fabs(t->d) > MOST_SIZE * a)
      return workspace_fail(workspace, CPROX_INVALID,
                            "term %d of hyperquadric %d is out of range: |(%g, %g, %g)·x + %g|", i, k, t->a.x, t->a.y,
                            t->a.z, t->d);
  }
  return CPROX_OK;
}

static double determinant(const double *m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
}

static cprox_status check_map(const implicit_map *map, cprox_workspace *workspace) {
  const double shift[3] = {map->shift.x, map->shift.y, map->shift.z}, most = largest(map->linear, 9);
  if (!isfinite(most) || !isfinite(largest(shift, 3)))
    return workspace_fail(workspace, CPROX_INVALID, "the affine map is not finite");
  const double det = determinant(map->linear);
  if (most > 1e12 || !(fabs(det) > 1e-12 * most * most * most) || !(most > 1e-12))
    return workspace_fail(workspace, CPROX_INVALID, "the affine map is singular or out of range: its determinant is %g",
                          det);
  return CPROX_OK;
}

cprox_status implicit_check(const implicit *given, const implicit_map *map, cprox_workspace *workspace) {
  const int32_t rows = implicit_count(given) + given->n_terms;
  cprox_status status = CPROX_OK;
  if (implicit_count(given) == 0)
    return workspace_fail(workspace, CPROX_INVALID, "an implicit body needs at least 1 constraint, got none");
  if (rows > IMPLICIT_MOST_ROWS)
    return workspace_fail(workspace, CPROX_INVALID, "%d constraints and terms, at most %d are possible", rows,
                          IMPLICIT_MOST_ROWS);
  for (int32_t k = 0; k < given->n_planes && !status; k++)
    status = check_vector("plane", k, given->plane[k].b, given->plane[k].c, workspace);
  for (int32_t k = 0; k < given->n_quadrics && !status; k++) status = check_quadric(&given->quadric[k], k, workspace);
  for (int32_t k = 0; k < given->n_powers && !status; k++) status = check_power(given, k, workspace);
  if (!status && map) status = check_map(map, workspace);
  return status;
}

/* ---- maps: the coefficients of the set { x : K x + k in the given one }, in twice the precision, rounded once ---- */

static dd dd_dot(const dd *a, int step, const double *b) {
  dd sum = dd_scale(a[0], b[0]);
  sum = dd_add(sum, dd_scale(a[step], b[1]));
  return dd_add(sum, dd_scale(a[2 * step], b[2]));
}

static void map_plane(const double a[3], double c, const dd *k, const dd *shift, vec3 *to, double *to_c) {
  const dd x = dd_dot(k, 3, a), y = dd_dot(k + 1, 3, a), z = dd_dot(k + 2, 3, a);
  *to = vec(x.high, y.high, z.high);
  *to_c = dd_add(dd_dot(shift, 1, a), dd_from(c)).high;
}

static void map_quadric(const implicit_quadric *from, const dd *k, const dd *shift, implicit_quadric *to) {
  const double *q = from->q;
  const double full[3][3] = {{q[0], q[1], q[2]}, {q[1], q[3], q[4]}, {q[2], q[4], q[5]}};
  const double b[3] = {from->b.x, from->b.y, from->b.z};
  dd qk[9], half[3]; /* Q K, and Q shift */
  for (int i = 0; i < 3; i++) {
    half[i] = dd_dot(shift, 1, full[i]);
    for (int j = 0; j < 3; j++) qk[3 * i + j] = dd_dot(k + j, 3, full[i]);
  }
  static const int row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
  for (int e = 0; e < 6; e++) {
    dd sum = {0, 0};
    for (int i = 0; i < 3; i++) sum = dd_add(sum, dd_multiply(k[3 * i + row[e]], qk[3 * i + column[e]]));
    to->q[e] = sum.high;
  }
  dd c = dd_from(from->c), linear[3];
  for (int j = 0; j < 3; j++) {
    linear[j] = (dd){0, 0};
    for (int i = 0; i < 3; i++) {
      const dd slope = dd_add(dd_from(b[i]), dd_scale(half[i], 2.0));
      linear[j] = dd_add(linear[j], dd_multiply(k[3 * i + j], slope));
    }
    c = dd_add(c, dd_multiply(shift[j], dd_add(dd_from(b[j]), half[j])));
  }
  to->b = vec(linear[0].high, linear[1].high, linear[2].high);
  to->c = c.high;
}

static void map_all(const implicit *from, const dd *k, const dd *shift, implicit *to) {
  for (int32_t i = 0; i < from->n_planes; i++) {
    const vec3 b = from->plane[i].b;
    map_plane((double[3]){b.x, b.y, b.z}, from->plane[i].c, k, shift, &to->plane[i].b, &to->plane[i].c);
  }
  for (int32_t i = 0; i < from->n_quadrics; i++) map_quadric(&from->quadric[i], k, shift, &to->quadric[i]);
  for (int32_t i = 0; i < from->n_terms; i++) {
    const vec3 a = from->term[i].a;
    const double p = from->term[i].p;
    map_plane((double[3]){a.x, a.y, a.z}, from->term[i].d, k, shift, &to->term[i].a, &to->term[i].d);
    to->term[i].p = p;
    to->term[i].root = 1.0 / p;
    to->term[i].slope = 1.0 / (p - 1.0);
    to->term[i].whole = p <= 64.0 && p == floor(p) ? (int)p : 0;
  }
  for (int32_t i = 0; i < from->n_powers; i++) to->power[i] = from->power[i];
}

void implicit_recentre(const implicit *from, vec3 c, implicit *to) {
  const dd k[9] = {{1, 0}, {0, 0}, {0, 0}, {0, 0}, {1, 0}, {0, 0}, {0, 0}, {0, 0}, {1, 0}};
  const dd shift[3] = {{c.x, 0}, {c.y, 0}, {c.z, 0}};
  map_all(from, k, shift, to);
}

/* x' = K (x - shift), K the inverse by cofactors. */
static void implicit_transform(const implicit *from, const implicit_map *map, implicit *to) {
  dd m[9], k[9], shift[3];
  for (int i = 0; i < 9; i++) m[i] = dd_from(map->linear[i]);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      const int r = (i + 1) % 3, s = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
      const dd minor = dd_multiply(m[3 * r + d], m[3 * s + c]);
      k[3 * j + i] = dd_add(dd_multiply(m[3 * r + c], m[3 * s + d]), (dd){-minor.high, -minor.low});
    }
  }
  const dd det = dd_dot(k, 3, map->linear);
  for (int i = 0; i < 9; i++) k[i] = dd_divide(k[i], det);
  const double offset[3] = {-map->shift.x, -map->shift.y, -map->shift.z};
  for (int i = 0; i < 3; i++) shift[i] = dd_dot(k + 3 * i, 1, offset);
  map_all(from, k, shift, to);
}

/* ---- the body ---- */

static cprox_status fail_interior(cprox_workspace *workspace) {
  return workspace_fail(
      workspace, CPROX_INVALID,
      "the body has no interior: its constraints exclude each other or leave less than 1e-9 of its size");
}

/* Looks along the axes: the box, and the mean of the points found, which is a better centre than any of them. */
static cprox_status find_box(const implicit *body, void *memory, cprox_workspace *workspace, vec3 *mean,
                             double box[6]) {
  const implicit_goal goal = {.relative_epsilon = 1e-3, .max_steps = 1000, .coarse = true};
  *mean = vec(0, 0, 0);
  for (int i = 0; i < 6; i++) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const vec3 n = vec(i / 2 == 0 ? side : 0.0, i / 2 == 1 ? side : 0.0, i / 2 == 2 ? side : 0.0);
    const implicit_query query = {.a = body, .far = true, .t = n};
    implicit_answer answer;
    implicit_solve(&query, &goal, NULL, memory, &answer);
    if (!(answer.upper < MOST_SIZE))
      return workspace_fail(workspace, CPROX_INVALID, "the body is unbounded, or larger than %g, along (%g, %g, %g)",
                            MOST_SIZE, n.x, n.y, n.z);
    box[i] = answer.upper;
    *mean = vec_axpy(*mean, 1.0 / 7.0, answer.x);
  }
  return CPROX_OK;
}

/* The box seen from the point c in it, which is known to within `error`. */
static void set_box(implicit *body, vec3 c, double error, const double box[6]) {
  const double slack = 1.0 + 8.0 * ROUND_U;
  body->box =
      vec(slack * (fmax(box[0] - c.x, box[1] + c.x) + error), slack * (fmax(box[2] - c.y, box[3] + c.y) + error),
          slack * (fmax(box[4] - c.z, box[5] + c.z) + error));
  body->radius = slack * vec_norm(body->box);
}

/* Three independent terms alone are centred where all of them are 0, and reach along the axes by the closed form. */
static bool place_closed(const implicit *mapped, implicit *about, vec3 *centre) {
  double inverse[9];
  if (!implicit_is_closed(mapped, inverse)) return false;
  const implicit_term *term = mapped->term;
  *centre = vec(0, 0, 0);
  for (int i = 0; i < 3; i++) *centre = vec_axpy(*centre, -term[i].d, vec(inverse[i], inverse[3 + i], inverse[6 + i]));
  implicit_recentre(mapped, *centre, about);
  implicit_is_closed(about, about->inverse);
  double box[6];
  for (int i = 0; i < 6; i++) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    double mu = 0.0;
    box[i] = implicit_closed_support(
        about, vec(i / 2 == 0 ? side : 0.0, i / 2 == 1 ? side : 0.0, i / 2 == 2 ? side : 0.0), &mu, NULL, NULL);
  }
  const double rounded = 64.0 * ROUND_U * fmax(box[0], fmax(box[2], box[4]));
  set_box(about, vec(0, 0, 0), rounded, box);
  about->radius = fmin(about->radius, implicit_closed_radius(about));
  return implicit_measure(about);
}

/* The first reach is that of an ellipsoid that may be far longer than the body, and rounding is as large as it: so it
 * is measured again from a better centre until that gains no more. */
static cprox_status place(const implicit *mapped, implicit *about, void *memory, cprox_workspace *workspace,
                          vec3 *centre) {
  enum { PASSES = 8 };
  if (place_closed(mapped, about, centre)) return CPROX_OK;
  if (!implicit_find_interior(mapped, centre, &about->radius) || about->radius < LEAST_SIZE)
    return fail_interior(workspace);
  about->box = vec(about->radius, about->radius, about->radius);
  for (int pass = 0; pass < PASSES; pass++) {
    implicit_recentre(mapped, *centre, about);
    if (!implicit_measure(about)) return fail_interior(workspace);
    about->give = 0.0; /* of the size that is not known yet: counted below */
    vec3 mean;
    double box[6] = {0};
    const cprox_status status = find_box(about, memory, workspace, &mean, box);
    if (status) return status;

    /* the new centre is rounded: how far it is from the old one is known exactly enough */
    const vec3 old = *centre;
    const double before = about->radius;
    *centre = vec_add(old, mean);
    set_box(about, vec_sub(*centre, old), 2.0 * ROUND_U * vec_norm(*centre), box);
    if (about->radius > 0.5 * before) break;
  }
  implicit_recentre(mapped, *centre, about);
  if (!implicit_measure(about)) return fail_interior(workspace);
  about->box = vec_add(about->box, vec(about->give, about->give, about->give));
  about->radius += 2.0 * about->give;
  return implicit_measure(about) && about->inner >= 1e-9 * about->radius ? CPROX_OK : fail_interior(workspace);
}

cprox_status implicit_build(const implicit *given, const implicit_map *map, cprox_workspace *workspace, vec3 *centre,
                            implicit **made) {
  implicit *mapped = implicit_like(given), *about = implicit_like(given);
  void *memory = malloc(implicit_memory(given, NULL));
  cprox_status status = workspace_fail(workspace, CPROX_MEMORY, "no memory for a body");
  if (mapped && about && memory) {
    if (map)
      implicit_transform(given, map, mapped);
    else
      implicit_recentre(given, vec(0, 0, 0), mapped);
    status = place(mapped, about, memory, workspace, centre);
  }
  free(mapped);
  free(memory);
  if (status) {
    free(about);
    return status;
  }
  workspace_clear(workspace);
  *made = about;
  return CPROX_OK;
}

cprox_status implicit_deform(const implicit *body, const double linear[9], cprox_workspace *workspace,
                             implicit **made) {
  implicit *about = implicit_like(body);
  if (!about) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a body");
  implicit_map map = {{0}, {0, 0, 0}};
  double square = 0.0;
  for (int i = 0; i < 9; i++) {
    map.linear[i] = linear[i];
    square += linear[i] * linear[i];
  }
  implicit_transform(body, &map, about);

  /* the box's image is in a box, the ball's in a ball */
  const double up = 1.0 + 16.0 * ROUND_U;
  const vec3 box = body->box;
  about->box = vec(up * (fabs(linear[0]) * box.x + fabs(linear[1]) * box.y + fabs(linear[2]) * box.z),
                   up * (fabs(linear[3]) * box.x + fabs(linear[4]) * box.y + fabs(linear[5]) * box.z),
                   up * (fabs(linear[6]) * box.x + fabs(linear[7]) * box.y + fabs(linear[8]) * box.z));
  about->radius = fmin(up * vec_norm(about->box), up * sqrt(square) * body->radius);
  if (!implicit_measure(about) || about->inner < 1e-9 * about->radius) {
    free(about);
    return fail_interior(workspace);
  }
  *made = about;
  return CPROX_OK;
}
