/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies without an inside: a curve that passes through one meets it at a parameter that double need not contain, and a
 * curve that slides along one touches it and no more. Contact is told in long double by the curve's root in the plane
 * and its place among the edges there: exact to 1e-18 of the sizes. */
#include <math.h>

#include "attack.h"
#include "base/frame.h"
#include "support/make_curve.h"
#include "support/reference.h"

enum { MOST_CORNERS = 9, MOST_POINTS = 6 };

/* A flat body, and what is carried past it: their difference is flat as well. */
typedef struct scene {
  size_t n, n_carried; /* corners; 0: a point rides the curve */
  vec3 corner[MOST_CORNERS], carried[2];
  cprox_body *body, *rider;
  cprox_pose pose;
  bool synchronized, splines;
  size_t degree;
  vec3 points[MOST_POINTS], other[MOST_POINTS]; /* of the mover; of the target, where it is on the clock */
  cprox_curve *curve, *clock;
  double s; /* where the two are made to meet */
} scene;

/* The polygon as a mesh of triangles about its first corner. */
static cprox_status make_fan(scene *c, cprox_workspace *ws) {
  uint32_t triangles[MOST_CORNERS][3];
  for (uint32_t i = 0; i + 2 < c->n; i++) triangles[i][0] = 0, triangles[i][1] = i + 1, triangles[i][2] = i + 2;
  return cprox_body_create_mesh(c->corner, c->n, (const uint32_t(*)[3])triangles, c->n - 2, CPROX_MESH_FILL_SURFACE,
                                SIZE_MAX, ws, &c->body);
}

static void make_body(attack *a, rng *r, scene *c) {
  const size_t kind = rng_index(r, 5);
  double flat[MOST_CORNERS][2];
  c->n = kind == 0 ? 2 : kind == 1 ? 3 : 3 + rng_index(r, MOST_CORNERS - 2);
  const double turn = rng_uniform(r, 0, 6), long_one = rng_log_uniform(r, 0.05, 1.0);
  for (size_t i = 0; i < c->n; i++) {
    const double angle = turn + 6.283185307179586 * ((double)i + rng_uniform(r, 0.0, 0.7)) / (double)c->n;
    flat[i][0] = cos(angle), flat[i][1] = long_one * sin(angle);
    c->corner[i] = kind < 2 ? rng_in_cube(r, 1.0) : vec(flat[i][0], flat[i][1], 0.0);
  }
  c->pose = rng_pose(r, 1.0);
  cprox_status status;
  if (kind == 4)
    status = make_fan(c, a->ws);
  else if (kind == 3)
    status = cprox_body_create_polygon((const double(*)[2])flat, c->n, a->ws, &c->body);
  else
    status = cprox_body_create_polytope(c->corner, c->n, a->ws, &c->body);
  c->n_carried = kind == 0 ? 2 : 0;
  for (int i = 0; i < 2; i++) c->carried[i] = rng_in_cube(r, 0.5);
  if (status == CPROX_OK && kind == 0) status = cprox_body_create_polytope(c->carried, 2, a->ws, &c->rider);
  if (status != CPROX_OK) attack_fail(a, "%s", cprox_workspace_error(a->ws));
  attack_kind(a, "%s",
              kind == 0   ? "segment across segment"
              : kind == 3 ? "polygon"
              : kind == 4 ? "mesh"
                          : "flat polytope");
}

/* The corners of the difference in the world, less the target's own motion: at most eighteen. */
static size_t corners_of(const scene *c, vec3l *corner) {
  size_t n = 0;
  for (size_t i = 0; i < c->n; i++) {
    const vec3l b = ref_to_world(&c->pose, ref_vec(c->corner[i]));
    if (c->n_carried == 0) corner[n++] = b;
    for (size_t k = 0; k < c->n_carried; k++) corner[n++] = ref_sub(b, ref_vec(c->carried[k]));
  }
  return n;
}

/* A point of the difference: well inside, or as near to an edge as `inset` says. */
static vec3 place_within(rng *r, const vec3l *corner, size_t n, double inset) {
  double w[2 * MOST_CORNERS], sum = 0.0;
  for (size_t i = 0; i < n; i++) sum += w[i] = rng_uniform(r, 0.2, 1.0) * (inset < 1.0 && i > 1 ? inset : 1.0);
  vec3l p = {0, 0, 0};
  for (size_t i = 0; i < n; i++) p = ref_add(p, ref_scale((long double)(w[i] / sum), corner[i]));
  return vec((double)p.x, (double)p.y, (double)p.z);
}

static cprox_curve *make_curve(attack *a, const scene *c, const vec3 *points) {
  cprox_curve *curve = NULL;
  double knots[MOST_POINTS + 2];
  const size_t n = c->degree + 1;
  for (size_t i = 0; i < n + 2; i++) knots[i] = (double)i - 1.0;
  const cprox_status status =
      c->splines ? curve_from(describe_bspline(points, n, 1, knots, n + 2, 0.0, (double)(n - 1)), a->ws, &curve)
                 : curve_from(describe_bezier(points, n, 0.0, 1.0), a->ws, &curve);
  if (status != CPROX_OK) attack_fail(a, "%s", cprox_workspace_error(a->ws));
  return curve;
}

/* The difference's point of the curve: where the mover is, seen from the target. */
static vec3l curve_at(const scene *c, long double t) {
  vec3 relative[MOST_POINTS];
  vec3l at[2];
  for (int k = 0; k < 2; k++) {
    const vec3 *points = k == 0 ? c->points : c->other;
    if (c->splines) {
      size_t i = t < 0 ? 0 : (size_t)t;
      if (i + 1 > c->degree) i = c->degree - 1;
      const long double f = t - (long double)i;
      at[k] = ref_add(ref_scale(1.0L - f, ref_vec(points[i])), ref_scale(f, ref_vec(points[i + 1])));
    } else {
      for (size_t i = 0; i <= c->degree; i++) relative[i] = points[i];
      at[k] = ref_bezier(relative, c->degree, t, 0);
    }
  }
  if (!c->synchronized) return at[0];
  cprox_pose turn = c->pose;
  turn.position = vec(0, 0, 0);
  return ref_sub(at[0], ref_to_world(&turn, at[1]));
}

/* A curve that passes through `hit` at c->s, or near it. */
static void make_curves(attack *a, rng *r, scene *c, vec3 hit) {
  c->splines = rng_index(r, 3) == 0;
  c->synchronized = rng_index(r, 4) == 0;
  c->degree = 1 + rng_index(r, MOST_POINTS - 1);
  for (size_t i = 0; i <= c->degree; i++) c->points[i] = rng_in_cube(r, 2.0), c->other[i] = rng_in_cube(r, 0.5);
  /* at a joint of the spline, or anywhere */
  c->s = rng_uniform(r, 0.1, 0.9) * (c->splines ? (double)c->degree : 1.0);
  if (c->splines && c->degree > 1 && rng_index(r, 2)) c->s = 1.0 + (double)rng_index(r, c->degree - 1);
  const vec3l off = ref_sub(ref_vec(hit), curve_at(c, (long double)c->s));
  for (size_t i = 0; i <= c->degree; i++)
    c->points[i] = vec_add(c->points[i], vec((double)off.x, (double)off.y, (double)off.z));
  c->curve = make_curve(a, c, c->points);
  if (c->synchronized) c->clock = make_curve(a, c, c->other);
}

/* ---- the truth ---- */

static vec3l normal_of(const vec3l *corner, size_t n) {
  vec3l best = {0, 0, 0};
  for (size_t i = 1; i + 1 < n; i++) {
    const vec3l m = ref_cross(ref_sub(corner[i], corner[0]), ref_sub(corner[i + 1], corner[0]));
    if (ref_norm(m) > ref_norm(best)) best = m;
  }
  return ref_scale(1.0L / ref_norm(best), best);
}

/* How far a point of the plane is inside the hull of the corners: by every pair that has all others on one side. */
static long double inside_by(const vec3l *corner, size_t n, vec3l normal, vec3l p) {
  long double least = INFINITY;
  for (size_t i = 0; i < n; i++) {
    for (size_t j = 0; j < n; j++) {
      const vec3l along = ref_sub(corner[j], corner[i]), across = ref_cross(normal, along);
      const long double length = ref_norm(across);
      if (i == j || !(length > 1e-12L)) continue;
      bool edge = true;
      for (size_t k = 0; k < n && edge; k++) edge = ref_dot(across, ref_sub(corner[k], corner[i])) >= -1e-15L * length;
      if (edge) least = fminl(least, ref_dot(across, ref_sub(p, corner[i])) / length);
    }
  }
  return least;
}

/* The root of the height over the plane that is nearest to t and not far behind it: bisection between signs, outward in
 * steps. */
static bool root_near(const scene *c, vec3l normal, vec3l origin, long double t, long double *root) {
  const long double most = c->splines ? (long double)c->degree : 1.0L;
  for (long double step = 1e-17L; step < 1e-3L; step *= 4.0L) {
    long double low = fmaxl(t - step, 0.0L), high = fminl(t + step, most);
    const bool below = ref_dot(normal, ref_sub(curve_at(c, low), origin)) < 0.0L;
    if ((ref_dot(normal, ref_sub(curve_at(c, high), origin)) < 0.0L) == below) continue;
    for (int i = 0; i < 100; i++) {
      const long double middle = 0.5L * (low + high);
      *((ref_dot(normal, ref_sub(curve_at(c, middle), origin)) < 0.0L) == below ? &low : &high) = middle;
    }
    *root = high;
    return true;
  }
  return false;
}

/* The sine of the angle at which the curve crosses the plane. */
static long double sine_at(const scene *c, vec3l normal, long double t) {
  const vec3l along = ref_sub(curve_at(c, t + 1e-9L), curve_at(c, t - 1e-9L));
  return fabsl(ref_dot(normal, along)) / ref_norm(along);
}

/* ---- the answers ---- */

static void check_contact(attack *a, const scene *c, const char *what, const cprox_result *x, const vec3l *corner,
                          size_t n, bool must) {
  const vec3l normal = normal_of(corner, n);
  attack_check(a, !must || x->lower <= 0.0, "%s: lower %.17g, but they meet at %.17g", what, x->lower, c->s);
  attack_check(a, !must || x->verdict == CPROX_VERDICT_VIOLATED,
               "%s: %s, [%.17g, %.17g] at %.17g, but they meet at %.17g", what, cprox_verdict_name(x->verdict),
               x->lower, x->upper, x->t, c->s);
  if (x->verdict != CPROX_VERDICT_VIOLATED) return;
  long double root = 0.0L;
  if (!attack_check(a, root_near(c, normal, corner[0], (long double)x->t, &root), "%s: no contact near %.17g", what,
                    x->t))
    return;
  const vec3l meeting = curve_at(c, root);
  const long double inside = inside_by(corner, n, normal, meeting);
  attack_check(a, inside > -1e-17L, "%s: contact at %.17g, but the curve passes by at %.3Lg", what, x->t, -inside);
  const vec3 apart = vec_sub(x->witness_mover, x->witness_obstacle);
  attack_check(a, x->upper == 0.0 && vec_norm(apart) <= x->upper, "%s: upper %.17g, points %.17g apart", what, x->upper,
               vec_norm(apart));
  if (c->n_carried > 0 || c->synchronized) return;
  const long double sine = sine_at(c, normal, root), off = ref_norm(ref_sub(ref_vec(x->witness_mover), meeting));
  /* A height over the plane, rounded, moves the common point along the curve by itself over the sine. */
  attack_check(a, off * sine < 1e-12L && off < 1e-9L, "%s: the common point is off by %.3Lg at sine %.3Lg", what, off,
               sine);
}

static void ask(attack *a, rng *r, const scene *c, bool must) {
  cprox_mover mover = cprox_point_along(c->curve);
  if (c->rider) mover = cprox_body_along(c->rider, c->curve);
  cprox_obstacle target = cprox_obstacle_at(c->body, c->pose);
  if (c->synchronized) target = cprox_synchronized(cprox_body_along(c->body, c->clock)), target.pose = c->pose;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = rng_log_uniform(r, 1e-10, 1e-4);
  vec3l corner[2 * MOST_CORNERS];
  const size_t n = corners_of(c, corner);

  cprox_result x;
  cprox_status status = cprox_collision(mover, target, &options, a->ws, &x);
  attack_check(a, status >= 0, "%s", cprox_workspace_error(a->ws));
  if (!attack_failed(a)) check_contact(a, c, "collision", &x, corner, n, must);
  attack_count(a, x.verdict == CPROX_VERDICT_VIOLATED ? "met"
                  : x.verdict == CPROX_VERDICT_CLEAR  ? "clear"
                                                      : "undecided");
  attack_check(a, x.nodes <= 1000, "collision took %u nodes", x.nodes);

  status = cprox_time_of_contact(mover, target, &options, a->ws, &x);
  attack_check(a, status >= 0, "%s", cprox_workspace_error(a->ws));
  attack_check(a, !must || x.t_contact_lower <= c->s + 1e-14, "free until %.17g, but they meet at %.17g",
               x.t_contact_lower, c->s);
  if (attack_failed(a) || x.verdict != CPROX_VERDICT_VIOLATED) return;
  check_contact(a, c, "time of contact", &x, corner, n, must);
  long double root = 0.0L;
  if (root_near(c, normal_of(corner, n), corner[0], (long double)x.t, &root))
    attack_check(a, root <= (long double)x.t + 1e-15L && x.t_contact_lower <= x.t,
                 "contact at %.17g, t %.17g, t_contact_lower %.17g", (double)root, x.t, x.t_contact_lower);
}

/* A body with a flat face in the plane z = 0 and nothing above it, and what slides there: a point or a small box whose
 * lower face lies in that plane. Its pose shifts the body, so that the face is where the curve is. */
static cprox_status make_sliding(attack *a, rng *r, cprox_body **body, cprox_pose *pose) {
  const vec3 corner[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {rng_uniform(r, -1, 1), rng_uniform(r, -1, 1), -1}};
  *pose = CPROX_POSE_IDENTITY;
  const size_t kind = rng_index(r, 6);
  if (kind < 2) return cprox_body_create_polytope(corner, kind == 0 ? 4 : 3, a->ws, body);
  pose->position = vec(0.25, 0.25, -0.5);
  if (kind == 2) return cprox_body_create_box(vec(0.5, rng_uniform(r, 0.1, 1), 1.0), a->ws, body);
  if (kind == 3) return cprox_body_create_cylinder(1.0, rng_uniform(r, 0.1, 1), a->ws, body);
  if (kind == 4) pose->orientation = (cprox_quat){.x = 1.0}; /* the base is up */
  if (kind == 4) return cprox_body_create_cone(1.0, rng_uniform(r, 0.1, 1), a->ws, body);
  pose->position.z = 0.0;
  return cprox_body_create_halfspace(vec(0, 0, 1), 0.0, a->ws, body);
}

/* Sliding in the plane, or along a face of a body that has an inside: nothing can be proven, and soon nothing is tried
 * any more. */
static void slide(attack *a, rng *r) {
  attack_kind(a, "sliding");
  vec3 points[5];
  const size_t n = 2 + rng_index(r, 4);
  for (size_t i = 0; i < n; i++) points[i] = vec(rng_uniform(r, -0.3, 1.3), rng_uniform(r, -0.3, 1.3), 0.0);
  points[0] = vec(0.2, 0.3, 0.0);
  cprox_body *body = NULL;
  cprox_curve *curve = NULL;
  cprox_pose pose;
  if (make_sliding(a, r, &body, &pose) != CPROX_OK ||
      curve_from(describe_bezier(points, n, 0.0, 1.0), a->ws, &curve) != CPROX_OK)
    attack_fail(a, "%s", cprox_workspace_error(a->ws));
  const cprox_obstacle target = cprox_obstacle_at(body, pose);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = rng_log_uniform(r, 1e-12, 1e-3);
  options.max_nodes = 200000;
  for (int query_type = 0; query_type < 4; query_type++) {
    cprox_result x;
    options.signed_distance = query_type == 1;
    const cprox_mover mover = cprox_point_along(curve);
    const cprox_status status = query_type < 2    ? cprox_distance(mover, target, &options, a->ws, &x)
                                : query_type == 2 ? cprox_collision(mover, target, &options, a->ws, &x)
                                                  : cprox_time_of_contact(mover, target, &options, a->ws, &x);
    attack_check(a, status >= 0 && x.lower <= 0.0 && x.upper >= 0.0, "query %d: [%.17g, %.17g]", query_type, x.lower,
                 x.upper);
    attack_check(a, x.nodes <= 500 && x.upper <= options.epsilon, "query %d: %u nodes, upper %.17g", query_type,
                 x.nodes, x.upper);
  }
  cprox_curve_free(curve);
  cprox_body_free(body);
}

static void one_case(attack *a, rng *r) {
  if (rng_index(r, 8) == 0) {
    slide(a, r);
    return;
  }
  scene c = {.n = 0};
  make_body(a, r, &c);
  if (attack_failed(a)) return;
  vec3l corner[2 * MOST_CORNERS];
  const size_t n = corners_of(&c, corner);
  const double inset = rng_index(r, 2) ? 1.0 : rng_log_uniform(r, 1e-17, 1e-1);
  make_curves(a, r, &c, place_within(r, corner, n, inset));

  /* they meet beyond doubt where the place is well inside and both sides of it go through the plane */
  const vec3l normal = normal_of(corner, n), hit = curve_at(&c, (long double)c.s);
  const long double ahead = ref_dot(normal, ref_sub(curve_at(&c, (long double)c.s + 1e-6L), hit)) / 1e-6L,
                    behind = ref_dot(normal, ref_sub(hit, curve_at(&c, (long double)c.s - 1e-6L))) / 1e-6L;
  const bool through = ahead * behind > 0.0L && fminl(fabsl(ahead), fabsl(behind)) > 1e-2L;
  const bool must = through && inside_by(corner, n, normal, hit) > 1e-9L;
  if (!attack_failed(a)) ask(a, r, &c, must);
  cprox_curve_free(c.curve);
  cprox_curve_free(c.clock);
  cprox_body_free(c.rider);
  cprox_body_free(c.body);
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "flat", one_case);
}
