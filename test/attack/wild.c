/* SPDX-License-Identifier: BSD-3-Clause */
/* Wild arguments: not a number, infinities, huge and denormal numbers, sizes of 0, wrong kinds of words, n = 0, NULL
 * where it is allowed. Every constructor and every query either answers with an interval of numbers or refuses with a
 * message and leaves its output untouched. Meant for the sanitizers; what no sanitizer sees (a hang, a wrong interval
 * of a wild query) shows here too. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "attack.h"
#include "support/implicits.h"
#include "support/make_curve.h"
#include "support/of_list.h"

enum { POINTS = 6 };

typedef struct wild {
  attack *a;
  rng *r;
  double share; /* of wild numbers */
  double scale;
  cprox_body *body[2];
  cprox_curve *curve[2];
  cprox_workspace *ws; /* NULL in some constructors */
} wild;

static double number(wild *w) {
  static const double POOL[] = {NAN,     INFINITY, -INFINITY, 0.0,    -0.0,  DBL_MIN, 4.9e-324, -4.9e-324, 1e-300,
                                1e-160,  1e-78,    -1e-78,    1e-30,  1e16,  1e30,    -1e60,    1e61,      1e78,
                                -1e100,  1e130,    1e154,     -1e155, 1e300, DBL_MAX, -DBL_MAX, 1.0,       -1.0,
                                0x1p-52, 1e12,     1e-12,     65536,  2.0,   1000.0};
  if (rng_uniform(w->r, 0.0, 1.0) < w->share) return POOL[rng_index(w->r, sizeof POOL / sizeof *POOL)];
  return w->scale * rng_uniform(w->r, -1.0, 1.0);
}

/* Mostly of the sign that is asked for. */
static double size(wild *w) {
  const double x = number(w);
  return rng_index(w->r, 20) ? fabs(x) : x;
}

static vec3 point(wild *w) {
  const double x = number(w), y = number(w), z = number(w);
  return vec(x, y, z);
}

static vec3 sizes(wild *w) {
  const double x = size(w), y = size(w), z = size(w);
  return vec(x, y, z);
}

static cprox_pose pose(wild *w) {
  cprox_pose p = {.position = point(w), .orientation = rng_quat(w->r)};
  if (rng_uniform(w->r, 0.0, 1.0) < w->share) p.orientation = (cprox_quat){number(w), number(w), number(w), number(w)};
  return p;
}

static size_t count(wild *w, size_t most) {
  return rng_index(w->r, 30) ? 1 + rng_index(w->r, most) : 0;
}

/* A status that there is; a refusal has a message. */
static void check_status(wild *w, const char *call, cprox_status status, const cprox_workspace *ws) {
  attack_check(w->a, strcmp(cprox_status_name(status), "unknown") != 0, "%s: status %d", call, (int)status);
  if (status < 0 && ws)
    attack_check(w->a, cprox_workspace_error(ws)[0], "%s: %s without a reason", call, cprox_status_name(status));
}

/* A constructor: a handle, at `where`, if and only if the status is ok. */
static void made(wild *w, const char *call, cprox_status status, const void *where) {
  void *handle;
  memcpy(&handle, where, sizeof handle);
  attack_kind(w->a, "%s", call);
  check_status(w, call, status, w->ws);
  attack_check(w->a, (status >= 0) == (handle != NULL), "%s: %s, handle %s", call, cprox_status_name(status),
               handle ? "made" : "NULL");
}

/* ---- bodies ---- */

static void make_vertices(wild *w, vec3 *points, size_t n) {
  for (size_t i = 0; i < n; i++) points[i] = i > 0 && rng_index(w->r, 8) == 0 ? points[i - 1] : point(w);
}

static void make_mesh(wild *w, cprox_body **body) {
  vec3 points[POINTS], high[POINTS];
  uint32_t triangles[POINTS][3];
  const size_t n = count(w, POINTS), m = count(w, POINTS),
               limit = rng_index(w->r, 10) ? SIZE_MAX : rng_index(w->r, 4000);
  make_vertices(w, points, n);
  for (size_t i = 0; i < n; i++) high[i] = rng_index(w->r, 10) ? vec_add(points[i], sizes(w)) : point(w);
  for (size_t i = 0; i < POINTS; i++)
    for (int k = 0; k < 3; k++)
      triangles[i][k] = rng_index(w->r, 60) ? (uint32_t)rng_index(w->r, n ? n : 1) : (uint32_t)rng_next(w->r);
  switch (rng_index(w->r, 3)) {
    case 0: {
      const cprox_mesh_fill fill = rng_index(w->r, 20) ? (cprox_mesh_fill)rng_index(w->r, 2) : (cprox_mesh_fill)77;
      made(w, "mesh",
           cprox_body_create_mesh(n ? points : NULL, n, m ? (const uint32_t(*)[3])triangles : NULL, m, fill, limit,
                                  w->ws, body),
           body);
      return;
    }
    case 1:
      made(w, "boxes", cprox_body_create_boxes(n ? points : NULL, n ? high : NULL, n, limit, w->ws, body), body);
      return;
    default: break;
  }
  made(w, "points", cprox_body_create_points(n ? points : NULL, n, size(w), limit, w->ws, body), body);
  if (!*body || rng_index(w->r, 2)) return;
  cprox_body *updated = NULL;
  const uint32_t changed[2] = {(uint32_t)rng_index(w->r, n), (uint32_t)rng_index(w->r, n + 1)};
  const size_t k = rng_index(w->r, 3);
  made(w, "updated points",
       cprox_body_update_points(*body, k ? changed : NULL, k ? high : NULL, k, NULL, w->ws, &updated), &updated);
  cprox_body_free(updated);
}

static void make_implicit(wild *w, cprox_body **body) {
  double terms[3][5], planes[4][4], quadric[1][10];
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 5; k++) terms[i][k] = k == i ? 1.0 / number(w) : k == 4 ? 1.0 + size(w) : 0.01 * number(w);
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 4; k++) planes[i][k] = number(w);
  for (int k = 0; k < 10; k++) quadric[0][k] = (k == 0 || k == 3 || k == 5) ? size(w) : 0.1 * number(w);
  const cprox_hyperquadric power = {.terms = (const double(*)[5])terms, .n_terms = count(w, 3)};
  const cprox_implicit_description d = {.hyperquadrics = &power,
                                        .n_hyperquadrics = rng_index(w->r, 4) ? 1 : 0,
                                        .planes = (const double(*)[4])planes,
                                        .n_planes = rng_index(w->r, 2) ? 0 : count(w, 4),
                                        .quadrics = (const double(*)[10])quadric,
                                        .n_quadrics = rng_index(w->r, 2)};
  cprox_affine map = {.linear = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  for (int k = 0; k < 9; k++)
    if (rng_index(w->r, 4) == 0) map.linear[k] += number(w);
  map.translation = point(w);
  made(w, "implicit", cprox_body_create_implicit(&d, rng_index(w->r, 2) ? &map : NULL, w->ws, body), body);
  if (!*body) return;
  cprox_body *deformed = NULL;
  const double exponents[6] = {size(w), 1.0 + size(w), 1.0 + size(w), 2.0, 2.0, 2.0};
  made(w, "deformed",
       implicit_deformed(*body, &map, rng_index(w->r, 2) ? exponents : NULL, rng_index(w->r, 6), w->ws, &deformed),
       &deformed);
  cprox_body_free(deformed);
}

/* Its answers are wild themselves. */
static void wild_support(const void *user, const double d[3], double p[3]) {
  const double *radius = user;
  for (int i = 0; i < 3; i++) p[i] = copysign(*radius, d[i]);
}

static double support_radius[2];

static void make_body(wild *w, size_t which) {
  cprox_body **body = &w->body[which];
  vec3 points[POINTS];
  double flat[POINTS][2];
  const size_t n = count(w, POINTS);
  make_vertices(w, points, n);
  for (size_t i = 0; i < n; i++) {
    flat[i][0] = rng_index(w->r, 3) ? cos(6.0 * (double)i / (double)n) : points[i].x;
    flat[i][1] = rng_index(w->r, 3) ? sin(6.0 * (double)i / (double)n) : points[i].y;
  }
  support_radius[which] = number(w);
  switch (rng_index(w->r, 15)) {
    case 0: made(w, "point", cprox_body_create_point(point(w), w->ws, body), body); break;
    case 1: made(w, "sphere", cprox_body_create_sphere(size(w), w->ws, body), body); break;
    case 2: made(w, "box", cprox_body_create_box(sizes(w), w->ws, body), body); break;
    case 3: made(w, "capsule", cprox_body_create_capsule(size(w), size(w), w->ws, body), body); break;
    case 4: made(w, "cylinder", cprox_body_create_cylinder(size(w), size(w), w->ws, body), body); break;
    case 5: made(w, "cone", cprox_body_create_cone(size(w), size(w), w->ws, body), body); break;
    case 6: made(w, "ellipsoid", cprox_body_create_ellipsoid(sizes(w), w->ws, body), body); break;
    case 7: made(w, "halfspace", cprox_body_create_halfspace(point(w), number(w), w->ws, body), body); break;
    case 8: made(w, "polytope", cprox_body_create_polytope(n ? points : NULL, n, w->ws, body), body); break;
    case 9:
      made(w, "polygon", cprox_body_create_polygon(n ? (const double(*)[2])flat : NULL, n, w->ws, body), body);
      break;
    case 10: {
      const double more = size(w);
      made(w, "callback",
           cprox_body_create_support(wild_support, &support_radius[which], point(w), 2.0 * fabs(support_radius[which]),
                                     rng_index(w->r, 2) ? 0.0 : more, size(w), w->ws, body),
           body);
      break;
    }
    case 11: {
      vec3 exponents = sizes(w);
      if (rng_index(w->r, 2)) exponents = vec(1.0 + fabs(exponents.x), 2.0, 1.0 + fabs(exponents.z));
      made(w, "superquadric", cprox_body_create_superquadric(sizes(w), exponents, w->ws, body), body);
      break;
    }
    case 12: make_implicit(w, body); break;
    default: make_mesh(w, body); break;
  }
}

/* A compound or a level-of-detail body of what there is. */
static void join(wild *w) {
  cprox_body *joined = NULL;
  const cprox_body *parts[2] = {w->body[0], w->body[1]};
  const cprox_pose poses[2] = {pose(w), pose(w)};
  if (!parts[0] || !parts[1]) return;
  if (rng_index(w->r, 2))
    made(w, "compound", cprox_body_create_compound(parts, poses, rng_index(w->r, 3), w->ws, &joined), &joined);
  else
    made(w, "lod", cprox_body_create_lod(parts[0], size(w), parts[1], w->ws, &joined), &joined);
  if (joined) {
    const double radius = cprox_body_get_info(joined).radius;
    attack_check(w->a, radius >= 0.0, "bounding sphere of %g", radius);
  }
  cprox_body_free(joined);
}

/* ---- curves ---- */

static void jet_of_line(void *user, double t, cprox_vec3 jet[3]) {
  const double *slope = user;
  jet[0] = vec(slope[0] * t, slope[1] * t, slope[2] * t);
  jet[1] = vec(slope[0], slope[1], slope[2]);
  jet[2] = vec(0, 0, 0);
}

static double sixth_of_line(void *user, double a, double b) {
  (void)a;
  (void)b;
  return ((const double *)user)[3];
}

static void point_of_line(void *user, double t, cprox_vec3 *p) {
  const double *slope = user;
  *p = vec(slope[0] * t, slope[1] * t, slope[2] * t);
}

static double length_of_line(void *user, double a, double b) {
  const double *slope = user;
  return 1.000001 * sqrt(slope[0] * slope[0] + slope[1] * slope[1] + slope[2] * slope[2]) * (b - a);
}

static double line[2][4];

static void make_by_function(wild *w, size_t which, double t0, double t1) {
  for (int k = 0; k < 4; k++) line[which][k] = k == 3 ? size(w) : number(w);
  const cprox_smooth_curve smooth = {.evaluate = jet_of_line,
                                     .sixth = sixth_of_line,
                                     .user = line[which],
                                     .error = {size(w) * 1e-9, 0.0, 0.0},
                                     .accuracy = size(w)};
  const cprox_rectifiable_curve by_length = {
      .point = point_of_line, .length = length_of_line, .user = line[which], .error = 1e-12 * size(w)};
  cprox_curve **curve = &w->curve[which];
  if (rng_index(w->r, 2))
    made(w, "smooth", curve_from(describe_smooth(&smooth, t0, t1), w->ws, curve), curve);
  else
    made(w, "rectifiable", curve_from(describe_rectifiable(&by_length, t0, t1), w->ws, curve), curve);
}

static void make_curve(wild *w, size_t which) {
  cprox_curve **curve = &w->curve[which];
  vec3 points[2 * POINTS] = {{0.0, 0.0, 0.0}};
  cprox_quat preimage[POINTS];
  double numbers[4 * POINTS];
  const size_t n = count(w, 2 * POINTS - 1), degree = 1 + rng_index(w->r, 3);
  make_vertices(w, points, n);
  for (size_t i = 0; i < POINTS; i++) preimage[i] = (cprox_quat){number(w), number(w), number(w), number(w)};
  for (size_t i = 0; i < 4 * POINTS; i++) numbers[i] = rng_index(w->r, 100) ? (double)i : number(w);
  double t0 = rng_index(w->r, 3) ? 0.0 : number(w), t1 = rng_index(w->r, 3) ? 1.0 : number(w);
  switch (rng_index(w->r, 12)) {
    case 0: made(w, "bezier", curve_from(describe_bezier(n ? points : NULL, n, t0, t1), w->ws, curve), curve); break;
    case 1:
      if (rng_index(w->r, 4)) t0 = (double)degree, t1 = (double)n;
      made(w, "bspline",
           curve_from(describe_bspline(n ? points : NULL, n, degree, numbers, n + degree + 1, t0, t1), w->ws, curve),
           curve);
      break;
    case 2:
      made(w, "polynomial", curve_from(describe_polynomial(n ? points : NULL, n, t0, t1), w->ws, curve), curve);
      break;
    case 3:
      made(w, "legendre", curve_from(describe_legendre(n ? points : NULL, n, t0, t1), w->ws, curve), curve);
      break;
    case 4:
      made(w, "lagrange", curve_from(describe_lagrange(n ? points : NULL, n ? numbers : NULL, n, t0, t1), w->ws, curve),
           curve);
      break;
    case 5:
      made(w, "trigonometric", curve_from(describe_trigonometric(n ? points : NULL, n, t0, t1), w->ws, curve), curve);
      break;
    case 6:
      made(w, "clothoid",
           curve_from(describe_clothoid(points[0], number(w), number(w), number(w), t0, t1), w->ws, curve), curve);
      break;
    case 7: {
      const cprox_dubins_word word =
          rng_index(w->r, 10) ? (cprox_dubins_word)rng_index(w->r, 7) : (cprox_dubins_word)99;
      vec3 start = point(w), end = point(w);
      if (rng_index(w->r, 8)) end.z = start.z;
      made(w, "dubins", curve_from(describe_dubins(start, number(w), end, number(w), size(w), word), w->ws, curve),
           curve);
      break;
    }
    case 8:
      made(w, "involute", curve_from(describe_involute(point(w), size(w), number(w), t0, t1), w->ws, curve), curve);
      break;
    case 9:
      made(
          w, "pythagorean",
          curve_from(describe_pythagorean_hodograph(point(w), preimage, rng_index(w->r, POINTS), t0, t1), w->ws, curve),
          curve);
      break;
    default: make_by_function(w, which, t0, t1); break;
  }
}

static void chain(wild *w) {
  const cprox_curve *curves[2] = {w->curve[0], w->curve[1]};
  if (!curves[0] || !curves[1]) return;
  cprox_curve *both = NULL;
  const double ends[3] = {0.0, rng_index(w->r, 4) ? 0.5 : number(w), 1.0};
  const double gap = rng_index(w->r, 2) ? INFINITY : number(w);
  made(w, "piecewise",
       curve_from(describe_piecewise(curves, rng_index(w->r, 3), rng_index(w->r, 3) ? ends : NULL, gap), w->ws, &both),
       &both);
  vec3 at;
  if (both) check_status(w, "evaluate", cprox_curve_evaluate(both, number(w), w->a->ws, &at, NULL, NULL), w->a->ws);
  cprox_curve_free(both);
}

/* ---- queries ---- */

static cprox_options options(wild *w) {
  cprox_options o = CPROX_OPTIONS_DEFAULT;
  o.max_nodes = (uint32_t)rng_index(w->r, 300);
  if (rng_index(w->r, 3) == 0) o.epsilon = size(w);
  if (rng_index(w->r, 3) == 0) o.relative_epsilon = size(w);
  o.signed_distance = rng_index(w->r, 6) == 0;
  if (rng_index(w->r, 6) == 0) o.max_lod = (cprox_lod)rng_index(w->r, 6);
  return o;
}

/* An interval where there is one, and the parameter of its upper bound; untouched where there is none. */
static void asked(wild *w, const char *call, cprox_status status, const cprox_result *x) {
  attack_kind(w->a, "%s", call);
  check_status(w, call, status, w->a->ws);
  cprox_result untouched;
  memset(&untouched, 0xA5, sizeof untouched);
  if (status < 0) {
    attack_check(
        w->a,
        memcmp(&x->lower, &untouched.lower, sizeof x->lower) == 0 && memcmp(&x->t, &untouched.t, sizeof x->t) == 0,
        "%s: %s, but the result was written: [%.17g, %.17g] (%s)", call, cprox_status_name(status), x->lower, x->upper,
        cprox_workspace_error(w->a->ws));
    return;
  }
  attack_check(w->a, x->lower <= x->upper && (isinf(x->upper) || !isnan(x->t)), "%s: [%.17g, %.17g] (%s) at %.17g",
               call, x->lower, x->upper, cprox_status_name(status), x->t);
}

static cprox_obstacle some_target(wild *w) {
  cprox_obstacle t = {.pose = pose(w)};
  const size_t kind = rng_index(w->r, 6);
  if (kind == 0 && w->curve[1])
    t = cprox_obstacle_curve(w->curve[1], size(w));
  else if (kind == 1 && w->curve[1])
    t = cprox_synchronized(rng_index(w->r, 2) && w->body[1] ? cprox_body_along(w->body[1], w->curve[1])
                                                            : cprox_tube_along(w->curve[1], size(w)));
  else
    t.body = w->body[rng_index(w->r, 2)];
  if (rng_index(w->r, 3) == 0) t.margin = size(w);
  if (rng_index(w->r, 20) == 0) t.synchronized = !t.synchronized;
  return t;
}

static void ask_many(wild *w, cprox_mover mover, const cprox_obstacle *targets, size_t n, const cprox_options *o,
                     cprox_result *x) {
  cprox_result many[3];
  cprox_profile_interval intervals[2];
  size_t found = 0;
  const double t0 = number(w), breaks[3] = {rng_index(w->r, 2) ? 0.0 : t0, rng_index(w->r, 4) ? 0.5 : number(w),
                                            rng_index(w->r, 2) ? 1.0 : number(w)};
  memset(many, 0xA5, sizeof many);
  cprox_status status;
  switch (rng_index(w->r, 5)) {
    case 0:
      status = nearest_of_list(mover, targets, n, rng_index(w->r, 4), o, w->a->ws, many, &found);
      asked(w, "nearest", status, status < 0 || found ? many : (memset(x, 0, sizeof *x), x));
      break;
    case 1:
      status = within_of_list(mover, targets, n, size(w), o, w->a->ws, many, &found);
      asked(w, "within", status, status < 0 || found ? many : (memset(x, 0, sizeof *x), x));
      break;
    case 2:
      check_status(w, "profile", profile_of_list(mover, targets, n, breaks, rng_index(w->r, 3), o, w->a->ws, intervals),
                   w->a->ws);
      break;
    case 3: {
      cprox_obstacles *set = NULL;
      status = cprox_obstacles_create(targets, n, CPROX_INDEX_BVH, w->a->ws, &set);
      made(w, "set", status, &set);
      if (set) asked(w, "set distance", cprox_obstacles_distance(set, mover, o, w->a->ws, x, NULL), x);
      cprox_obstacles_free(set);
      break;
    }
    default: {
      cprox_obstacles *batch = NULL;
      status = cprox_obstacles_create(targets, n, CPROX_INDEX_BATCH, w->a->ws, &batch);
      made(w, "batch", status, &batch);
      if (batch)
        check_status(w, "batch distance",
                     cprox_obstacles_distance_batch(batch, &mover, 0, rng_index(w->r, 2), o, w->a->ws, x), w->a->ws);
      cprox_obstacles_free(batch);
    }
  }
}

static void ask_others(wild *w, const cprox_obstacle *targets, const cprox_options *o, cprox_result *x) {
  const cprox_translating a = {targets[0], point(w)}, b = {targets[1], point(w)};
  cprox_growth growth;
  switch (rng_index(w->r, 5)) {
    case 0: asked(w, "translating distance", cprox_translating_distance(a, b, size(w), o, w->a->ws, x), x); break;
    case 1: asked(w, "translating contact", cprox_translating_contact(a, b, size(w), o, w->a->ws, x), x); break;
    case 2:
      check_status(w, "growth", cprox_growth_distance(targets[0], targets[1], o, w->a->ws, &growth), w->a->ws);
      break;
    default: asked(w, "pair", cprox_pair(targets[0], targets[1], o, w->a->ws, x), x); break;
  }
}

static void ask_certified(wild *w, cprox_mover mover, const cprox_obstacle *targets, size_t n, cprox_options *o,
                          cprox_result *x) {
  cprox_certificate *certificate = cprox_certificate_create();
  char text[300];
  o->certificate = rng_index(w->r, 2) ? certificate : NULL;
  const cprox_status status = distance_of_list(mover, targets, n, o, w->a->ws, x, NULL);
  asked(w, "certified distance", status, x);
  if (status >= 0)
    check_status(w, "certify", certify_of_list(mover, targets, n, size(w), x, o, w->a->ws, certificate), w->a->ws);
  for (size_t i = 0; i < n; i++)
    if (targets[i].body || targets[i].curve) cprox_obstacle_describe(&targets[i], text, rng_index(w->r, sizeof text));
  cprox_certificate_free(certificate);
}

static void ask(wild *w) {
  cprox_obstacle targets[3];
  const size_t n = rng_index(w->r, 10) ? 1 + rng_index(w->r, 3) : 0;
  for (size_t i = 0; i < 3; i++) targets[i] = some_target(w);
  cprox_mover mover = cprox_tube_along(w->curve[0], rng_index(w->r, 2) ? 0.0 : size(w));
  if (rng_index(w->r, 3) == 0) mover.kind = CPROX_MOVER_BODY, mover.body = w->body[0];
  cprox_options o = options(w), *given = rng_index(w->r, 5) ? &o : NULL;
  cprox_result x;
  memset(&x, 0xA5, sizeof x);
  cprox_gradient gradient;
  switch (rng_index(w->r, 10)) {
    case 0: asked(w, "distance", cprox_distance(mover, targets[0], given, w->a->ws, &x), &x); break;
    case 1: asked(w, "tolerance", cprox_tolerance(mover, targets[0], size(w), given, w->a->ws, &x), &x); break;
    case 2:
      asked(w, "collision", collision_of_list(mover, n ? targets : NULL, n, given, w->a->ws, &x, NULL), &x);
      break;
    case 3:
      asked(w, "time of contact", time_of_contact_of_list(mover, n ? targets : NULL, n, given, w->a->ws, &x), &x);
      break;
    case 4:
      asked(w, "distance of all", distance_of_list(mover, n ? targets : NULL, n, given, w->a->ws, &x, NULL), &x);
      break;
    case 5: {
      const cprox_status status = cprox_distance(mover, targets[0], given, w->a->ws, &x);
      asked(w, "distance", status, &x);
      if (status >= 0)
        check_status(w, "gradient", cprox_distance_gradient(mover, targets[0], given, &x, w->a->ws, &gradient),
                     w->a->ws);
      break;
    }
    case 6: ask_certified(w, mover, targets, n, &o, &x); break;
    case 7: ask_others(w, targets, given, &x); break;
    default: ask_many(w, mover, n ? targets : NULL, n, given, &x); break;
  }
}

static void one_case(attack *a, rng *r) {
  static const double SHARES[] = {0.0, 0.01, 0.05, 0.3};
  static const double SCALES[] = {1.0, 1.0, 1.0, 1e-6, 1e6, 1e-150, 1e76, 1e150};
  wild w = {.a = a, .r = r, .share = SHARES[rng_index(r, 4)], .scale = SCALES[rng_index(r, 8)]};
  w.ws = rng_index(r, 10) ? a->ws : NULL;
  attack_kind(a, "making");
  for (size_t i = 0; i < 2; i++) {
    make_body(&w, i);
    make_curve(&w, i);
  }
  /* one curve at least, so that there is something to ask */
  const vec3 ends[2] = {vec(-1, 0.5, 2), vec(1, 0, 2)};
  if (!w.curve[0]) curve_from(describe_bezier(ends, 2, 0.0, 1.0), a->ws, &w.curve[0]);
  join(&w);
  chain(&w);
  for (int k = 0; k < 3; k++) ask(&w);
  for (size_t i = 0; i < 2; i++) {
    cprox_body_free(w.body[i]);
    cprox_curve_free(w.curve[i]);
  }
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "wild", one_case);
}
