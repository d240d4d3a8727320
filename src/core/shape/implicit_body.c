/* SPDX-License-Identifier: BSD-3-Clause */
/* Superquadrics and implicit bodies as convex shapes: what curves, pairs and compounds ask of them. */
#include <stdlib.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "convex/feature.h"
#include "curve_proximity/cprox/implicit.h"
#include "implicit/implicit.h"
#include "shape/construct.h"

/* Memory of a search on the stack: most bodies need little. */
enum { SMALL_BYTES = 8 * 1024, LARGE_BYTES = 8 * 32 * 1024 };

/* Width of what a single search is asked for, relative to the body and to the distance. */
static const double IMPLICIT_EPSILON = 1e-12, IMPLICIT_RELATIVE = 1e-12, IMPLICIT_SUPPORT = 1e-11;

/* ---- the solver on the stack ---- */

static void solve_small(const implicit_query *query, const implicit_goal *goal, implicit_answer *answer) {
  _Alignas(max_align_t) unsigned char memory[SMALL_BYTES];
  implicit_solve(query, goal, NULL, memory, answer);
}

static void solve_large(const implicit_query *query, const implicit_goal *goal, implicit_answer *answer) {
  _Alignas(max_align_t) unsigned char memory[LARGE_BYTES];
  implicit_solve(query, goal, NULL, memory, answer);
}

static void solve_on_stack(const implicit_query *query, const implicit_goal *goal, implicit_answer *answer) {
  if (implicit_memory(query->a, NULL) <= SMALL_BYTES)
    solve_small(query, goal, answer);
  else
    solve_large(query, goal, answer);
}

/* ---- the queries ---- */

/* Inside, a ball is proven: the body holds the centre's ball of radius `inner`, drawn towards any point z of it by 1 -
 * g the ball of radius (1 - g) inner. */
static void nearest_inside(const convex *shape, vec3 y, convex_near *near) {
  const implicit *body = shape->implicit;
  const double depth = (1.0 - implicit_gauge(body, y, 1e-6)) * body->inner - 2.0 * body->give;
  near->distance = -fmax(depth, 0.0);
  near->point = y;
}

static void implicit_nearest(const convex *shape, vec3 y, convex_hint *hint, convex_near *near) {
  (void)hint;
  const implicit *body = shape->implicit;
  *near = (convex_near){0};
  if (implicit_value(body, y) <= 0.0) {
    nearest_inside(shape, y, near);
    return;
  }
  const implicit_query query = {.a = body, .t = y};
  const implicit_goal goal = {
      .epsilon = IMPLICIT_EPSILON * body->radius, .relative_epsilon = IMPLICIT_RELATIVE, .max_steps = 2000};
  implicit_answer answer;
  const double width = goal.epsilon + goal.relative_epsilon * vec_norm(y) + shape->slack;
  if (!body->orthogonal || !implicit_closed_nearest(body, y, width, &answer)) solve_on_stack(&query, &goal, &answer);
  near->point = convex_drawn(shape, answer.x);
  near->distance = vec_norm(vec_sub(y, near->point));
  near->normal = vec_neg(answer.normal);
  near->height = answer.height;
  near->height_known = true;
  for (int i = 0; i < 6; i++) near->hessian[i] = answer.hessian[i];
}

static double closed_support(const convex *shape, vec3 d, convex_hint *hint, vec3 *at) {
  (void)hint;
  double mu = 0.0;
  return implicit_closed_support(shape->implicit, d, &mu, at, NULL);
}

static void closed_curvature(const convex *shape, vec3 d, vec3 x, double hessian[6]) {
  (void)x;
  double mu = 0.0;
  implicit_closed_support(shape->implicit, d, &mu, NULL, hessian);
}

static vec3 closed_follow(const convex *shape, vec3 d, vec3 x) {
  double mu = 0.0;
  implicit_closed_support(shape->implicit, d, &mu, &x, NULL);
  return x;
}

/* The bound from above; the point attains it but for the shape's slack, or the answer is not a number. Where the solver
 * stalls just short of that, a direction turned by far less than the slack may do: h(d) <= h(d') + |d - d'| radius, on
 * both sides. */
static double open_support(const convex *shape, vec3 d, convex_hint *hint, vec3 *at) {
  (void)hint;
  enum { MOST_TURNS = 6 };
  const implicit *body = shape->implicit;
  vec3 unit;
  const double norm = feature_unit(d, &unit), step = 0.125 * shape->slack / body->radius;
  vec3 extreme;
  double upper;
  if (implicit_ellipsoid_support(body, unit, &extreme, &upper) && upper - vec_dot(unit, extreme) <= shape->slack) {
    if (at) *at = extreme;
    return norm * upper;
  }
  for (int turn = 0; turn <= MOST_TURNS; turn++) {
    const double aside = turn == 0 ? 0.0 : turn % 2 ? step : -step;
    const vec3 off = vec(turn <= 2 ? aside : 0.0, turn == 3 || turn == 4 ? aside : 0.0, turn > 4 ? aside : 0.0);
    const double moved = ROUND_UP * fabs(aside) * body->radius;
    const implicit_query query = {.a = body, .far = true, .t = vec_add(unit, off)};
    const implicit_goal goal = {.epsilon = IMPLICIT_SUPPORT * body->radius, .max_steps = 2000};
    implicit_answer answer;
    solve_on_stack(&query, &goal, &answer);
    if (!(answer.upper - answer.lower <= shape->slack - 2.0 * moved)) continue;
    if (at) *at = answer.x;
    return norm * (answer.upper + moved);
  }
  return NAN;
}

/* near_rounding: the interval of the search is IMPLICIT_EPSILON wide; what is more shows in the certificate of the
 * query. */
static const convex_ops superquadric_ops = {.kind = CPROX_BODY_SUPERQUADRIC,
                                            .near_rounding = 64.0,
                                            .proves_depth = true,
                                            .nearest = implicit_nearest,
                                            .support = closed_support,
                                            .curvature = closed_curvature,
                                            .follow = closed_follow};
static const convex_ops closed_ops = {.kind = CPROX_BODY_IMPLICIT,
                                      .near_rounding = 64.0,
                                      .proves_depth = true,
                                      .nearest = implicit_nearest,
                                      .support = closed_support,
                                      .curvature = closed_curvature,
                                      .follow = closed_follow};
static const convex_ops open_ops = {
    .kind = CPROX_BODY_IMPLICIT, .near_rounding = 64.0, .nearest = implicit_nearest, .support = open_support};

/* ---- making ---- */

/* The handle of a built body about its centre, which it takes over. */
static cprox_status wrap(implicit *made, bool superquadric, vec3 centre, cprox_workspace *workspace,
                         cprox_body **body) {
  const convex_ops *ops = superquadric ? &superquadric_ops : made->closed ? &closed_ops : &open_ops;
  cprox_body *handle = body_allocate(ops, ops->kind);
  if (!handle) {
    free(made);
    return body_out_of_memory(workspace);
  }
  handle->shape.implicit = made;
  handle->shape.scale = handle->ball_radius = made->radius + made->give;
  /* the solver has the rounding of the constraints at both ends of its interval */
  handle->shape.slack = made->closed ? made->give + 32.0 * ROUND_U * made->radius
                                     : 2.0 * made->give + 4.0 * IMPLICIT_SUPPORT * made->radius;
  handle->centre = handle->ball_centre = centre;
  handle->shape.drawn = made->give / made->radius + 32.0 * ROUND_U;
  *body = handle;
  return CPROX_OK;
}

/* Takes the coefficients over: checks, maps and centres them. */
static cprox_status create(implicit *given, const implicit_map *map, bool superquadric, cprox_workspace *workspace,
                           cprox_body **body) {
  vec3 centre;
  implicit *made = NULL;
  cprox_status status = implicit_check(given, map, workspace);
  if (!status) status = implicit_build(given, map, workspace, &centre, &made);
  free(given);
  return status ? status : wrap(made, superquadric, centre, workspace, body);
}

cprox_status cprox_body_create_superquadric(cprox_vec3 semi_axes, cprox_vec3 exponents, cprox_workspace *workspace,
                                            cprox_body **body) {
  WORKSPACE_USE(workspace);
  if (!body) return workspace_fail(workspace, CPROX_INVALID, "body is NULL: nowhere to put the handle");
  const double a[3] = {semi_axes.x, semi_axes.y, semi_axes.z}, n[3] = {exponents.x, exponents.y, exponents.z};
  double least = INFINITY, most = 0.0;
  for (int i = 0; i < 3; i++) {
    const char axis = (char)('x' + i);
    if (!(a[i] >= 1e-12 && a[i] <= 1e10))
      return workspace_fail(workspace, CPROX_INVALID, "semi_axes.%c is %g, must be between 1e-12 and 1e10", axis, a[i]);
    if (!(n[i] >= 1.0 && n[i] <= 1000.0))
      return workspace_fail(workspace, CPROX_INVALID, "exponents.%c is %g, must be between 1 and 1000", axis, n[i]);
    least = fmin(least, a[i]);
    most = fmax(most, a[i]);
  }
  if (most > 1e9 * least)
    return workspace_fail(workspace, CPROX_INVALID, "semi-axis %g is more than 1e9 times semi-axis %g", most, least);
  implicit *given = implicit_allocate(0, 0, 1, 3);
  if (!given) return body_out_of_memory(workspace);
  given->power[0].n = 3;
  for (int i = 0; i < 3; i++) {
    (&given->term[i].a.x)[i] = 1.0 / a[i];
    given->term[i].p = n[i];
  }
  return create(given, NULL, true, workspace, body);
}

static cprox_status check_rows(const cprox_implicit_description *d, size_t *terms, cprox_workspace *workspace) {
  *terms = 0;
  size_t rows = 0;
  const size_t most = IMPLICIT_MOST_ROWS;
  rows += d->n_planes <= most ? d->n_planes : most + 1;
  rows += d->n_quadrics <= most ? d->n_quadrics : most + 1;
  rows += d->n_hyperquadrics <= most ? d->n_hyperquadrics : most + 1;
  for (size_t k = 0; k < d->n_hyperquadrics && rows <= most; k++) {
    const cprox_hyperquadric *h = &d->hyperquadrics[k];
    if (h->n_terms > 0 && !h->terms)
      return workspace_fail(workspace, CPROX_INVALID, "the terms of hyperquadric %zu are NULL", k);
    *terms += h->n_terms <= most ? h->n_terms : most + 1;
    if (*terms > most) rows = most + 1;
  }
  if (rows + *terms > most)
    return workspace_fail(workspace, CPROX_INVALID,
                          "%zu planes, %zu quadrics and %zu hyperquadrics with their terms are more than the %d rows "
                          "that are possible",
                          d->n_planes, d->n_quadrics, d->n_hyperquadrics, IMPLICIT_MOST_ROWS);
  return CPROX_OK;
}

/* The built body's constraints once more, about its centre, for changes. */
static implicit *copy(const implicit *body) {
  implicit *given = implicit_allocate((size_t)body->n_planes, (size_t)body->n_quadrics, (size_t)body->n_powers,
                                      (size_t)body->n_terms);
  if (given) implicit_recentre(body, vec(0, 0, 0), given);
  return given;
}

static cprox_status deform(const cprox_implicit_description *d, const cprox_affine *map, cprox_workspace *workspace,
                           cprox_body **deformed) {
  const cprox_body *body = d->deformed;
  const double *exponents = d->exponents;
  const implicit *shape = body->shape.implicit;
  if (!shape)
    return workspace_fail(workspace, CPROX_INVALID, "the deformed body is a %s, must be a superquadric or implicit",
                          cprox_body_kind_name(body->kind));
  if (d->n_planes + d->n_quadrics + d->n_hyperquadrics > 0)
    return workspace_fail(workspace, CPROX_INVALID, "a deformed body has constraints of its own: list none");
  if (exponents && d->n_exponents != (size_t)shape->n_terms)
    return workspace_fail(workspace, CPROX_INVALID, "%zu exponents for a body of %d terms", d->n_exponents,
                          shape->n_terms);

  /* the centre's image, and the map about it */
  const cprox_affine affine = map ? *map : (cprox_affine){.linear = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  const double *l = affine.linear;
  implicit_map inner = {.shift = affine.translation};
  for (int i = 0; i < 9; i++) inner.linear[i] = l[i];
  implicit *given = copy(shape);
  if (!given) return body_out_of_memory(workspace);
  for (int32_t i = 0; exponents && i < shape->n_terms; i++) given->term[i].p = exponents[i];
  cprox_status status = implicit_check(given, &inner, workspace);

  const vec3 c = body->centre, moved = {l[0] * c.x + l[1] * c.y + l[2] * c.z, l[3] * c.x + l[4] * c.y + l[5] * c.z,
                                        l[6] * c.x + l[7] * c.y + l[8] * c.z};
  vec3 offset = vec(0, 0, 0);
  implicit *made = NULL;
  if (!status && (exponents || shape->closed)) {
    inner.shift = vec(0, 0, 0);
    status = implicit_build(given, &inner, workspace, &offset, &made);
  } else if (!status) {
    status = implicit_deform(shape, l, workspace, &made);
  }
  free(given);
  if (status) return status;
  const bool superquadric = body->kind == CPROX_BODY_SUPERQUADRIC && made->orthogonal;
  return wrap(made, superquadric, vec_add(vec_add(moved, affine.translation), offset), workspace, deformed);
}

cprox_status cprox_body_create_implicit(const cprox_implicit_description *description, const cprox_affine *map,
                                        cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  if (!body) return workspace_fail(workspace, CPROX_INVALID, "body is NULL: nowhere to put the handle");
  const cprox_implicit_description *d = description;
  if (!d) return workspace_fail(workspace, CPROX_INVALID, "description is NULL");
  if ((d->n_planes > 0 && !d->planes) || (d->n_quadrics > 0 && !d->quadrics) ||
      (d->n_hyperquadrics > 0 && !d->hyperquadrics))
    return workspace_fail(workspace, CPROX_INVALID, "an array of the description is NULL and its count is not 0");
  if (d->deformed) return deform(d, map, workspace, body);
  if (d->exponents) return workspace_fail(workspace, CPROX_INVALID, "exponents are given and no deformed body");
  size_t terms = 0;
  const cprox_status status = check_rows(d, &terms, workspace);
  if (status) return status;
  implicit *given = implicit_allocate(d->n_planes, d->n_quadrics, d->n_hyperquadrics, terms);
  if (!given) return body_out_of_memory(workspace);

  for (size_t k = 0; k < d->n_planes; k++) {
    const double *p = d->planes[k];
    given->plane[k] = (implicit_plane){.b = {p[0], p[1], p[2]}, .c = p[3]};
  }
  for (size_t k = 0; k < d->n_quadrics; k++) {
    const double *q = d->quadrics[k];
    given->quadric[k] =
        (implicit_quadric){.q = {q[0], q[1], q[2], q[3], q[4], q[5]}, .b = {q[6], q[7], q[8]}, .c = q[9]};
  }
  int32_t next = 0;
  for (size_t k = 0; k < d->n_hyperquadrics; k++) {
    const cprox_hyperquadric *h = &d->hyperquadrics[k];
    given->power[k] = (implicit_power){.first = next, .n = (int32_t)h->n_terms};
    for (size_t i = 0; i < h->n_terms; i++, next++)
      given->term[next] = (implicit_term){
          .a = {h->terms[i][0], h->terms[i][1], h->terms[i][2]}, .d = h->terms[i][3], .p = h->terms[i][4]};
  }
  if (!map) return create(given, NULL, false, workspace, body);
  implicit_map inner = {.shift = map->translation};
  for (int i = 0; i < 9; i++) inner.linear[i] = map->linear[i];
  return create(given, &inner, false, workspace, body);
}
