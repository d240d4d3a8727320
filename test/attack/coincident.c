/* SPDX-License-Identifier: BSD-3-Clause */
/* Overlaps whose centres lie 0 or 1e-17 to 1e-8 sizes apart: pairs of all convex kinds, carried bodies, and curves
 * through hulls. At least one of the two is thick: it holds a ball about its centre that is known in closed form, or by
 * its planes in long double, and the other's centre is a point of the other. So a common point deep inside is known
 * without a search, and must be proven. The ends of the interval are held against directions in long double, whose own
 * error is 1e-17 of what is added up. */
#include <string.h>

#include "attack.h"
#include "support/make_curve.h"
#include "support/reference.h"
#include "support/shapes.h"

/* The radius of a ball about the centre that lies inside, from below; 0 where that is not known. */
static double inner_radius(const test_shape *s) {
  const double *z = s->size;
  switch (s->kind) {
    case CPROX_BODY_SPHERE: return z[0];
    case CPROX_BODY_BOX:
    case CPROX_BODY_SUPPORT:
    case CPROX_BODY_ELLIPSOID: return fmin(z[0], fmin(z[1], z[2]));
    case CPROX_BODY_CAPSULE: return z[0];
    case CPROX_BODY_CYLINDER: return fmin(z[0], z[1]);
    case CPROX_BODY_CONE: return fmin(z[1], z[0] * z[1] / hypot(z[0], 2.0 * z[1]));
    default: return 0.0;
  }
}

/* The octahedron and the hulls of points all round their middle: their inner radius is that of the octahedron within.
 */
static double make_hull(rng *r, double scale, double aspect, test_shape *s) {
  memset(s, 0, sizeof *s);
  s->kind = CPROX_BODY_POLYTOPE;
  for (int i = 0; i < 3; i++) s->size[i] = scale * rng_log_uniform(r, 1.0 / aspect, 1.0);
  const double *z = s->size;
  for (int i = 0; i < 6; i++) {
    vec3 v = vec(0, 0, 0);
    (&v.x)[i / 2] = i % 2 ? z[i / 2] : -z[i / 2];
    s->v[s->n++] = v;
  }
  for (size_t more = 2 * rng_index(r, 8); more > 0; more -= 2) { /* in pairs, so that the mean stays where it is */
    const vec3 u = rng_unit(r), v = vec(z[0] * u.x, z[1] * u.y, z[2] * u.z);
    s->v[s->n++] = v, s->v[s->n++] = vec_neg(v);
  }
  cprox_body_create_polytope(s->v, s->n, NULL, &s->body);
  return 1.0 / sqrt(1.0 / (z[0] * z[0]) + 1.0 / (z[1] * z[1]) + 1.0 / (z[2] * z[2]));
}

/* Any kind; the radius that is known to lie within. */
static double make_any(rng *r, double scale, double aspect, test_shape *s) {
  const cprox_body_kind kind = TEST_BOUNDED[rng_index(r, TEST_N_BOUNDED)];
  if (kind == CPROX_BODY_POLYTOPE) return make_hull(r, scale, aspect, s);
  shape_make(r, kind, scale, aspect, s);
  return inner_radius(s);
}

/* Along the axes, turned by right angles, or anyhow. */
static cprox_quat any_turn(rng *r) {
  const cprox_quat axes[] = {{0, 0, 0, 1}, {1, 0, 0, 0}, {0, 1, 0, 0}, {1, 0, 0, 1},
                             {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 1, 1}};
  return rng_index(r, 2) ? rng_quat(r) : axes[rng_index(r, 7)];
}

typedef struct overlap {
  test_shape a, b;
  cprox_pose pa, pb;
  vec3 middle;  /* of b */
  double size;  /* of the larger one */
  double depth; /* they overlap at least so deep */
} overlap;

/* The middle of the shape in its own frame. */
static vec3 middle(const test_shape *s) {
  return s->kind == CPROX_BODY_POINT ? s->v[0] : vec(0, 0, 0);
}

static void overlap_make(rng *r, overlap *o) {
  const double scale = rng_log_uniform(r, 1e-3, 1e3), aspect = rng_index(r, 4) ? 4.0 : 1e3;
  double inner = 0.0;
  while (inner == 0.0) {
    if (o->a.body) cprox_body_free(o->a.body);
    inner = make_any(r, scale, aspect, &o->a);
  }
  const double other = make_any(r, scale * (rng_index(r, 2) ? 1.0 : rng_log_uniform(r, 1e-3, 1.0)), aspect, &o->b);
  o->size = scale;
  o->pa.position = rng_index(r, 2) ? vec(0, 0, 0) : rng_in_cube(r, scale);
  o->pa.orientation = any_turn(r);
  o->pb.orientation = rng_index(r, 3) ? any_turn(r) : o->pa.orientation;
  const double apart = rng_index(r, 4) == 0 ? 0.0 : fmin(scale * rng_log_uniform(r, 1e-17, 1e-8), 1e-3 * inner);
  const vec3 off = rng_index(r, 2) ? rng_unit(r) : vec(1, 0, 0);
  o->middle = vec_axpy(o->pa.position, apart, off);
  const vec3l at = ref_sub(ref_vec(o->middle), pose_turn(&o->pb, ref_vec(middle(&o->b))));
  o->pb.position = vec((double)at.x, (double)at.y, (double)at.z);
  o->depth = 0.99 * inner + other;
  if (o->depth > 1.9 * inner && other > 0.0) o->depth = 0.99 * (inner + other);
}

static void overlap_free(overlap *o) {
  cprox_body_free(o->a.body);
  cprox_body_free(o->b.body);
}

/* min over A - B of u·m, u of any length: a lower bound on the signed distance. */
static long double phi(const overlap *o, vec3l u) {
  u = ref_add(u, (vec3l){3e-30L, 5e-30L, 7e-30L}); /* a rim has no farthest point along its very axis */
  return ref_dot(u, ref_sub(shape_extreme(&o->a, &o->pa, ref_scale(-1, u)), shape_extreme(&o->b, &o->pb, u))) /
         ref_norm(u);
}

/* The greatest of directions that matter to either shape, and of some at random, climbed from. */
static long double soonest_way_out(rng *r, const overlap *o) {
  long double best = -HUGE_VALL;
  vec3l u = {0, 0, 1};
  for (int i = 0; i < 40; i++) {
    vec3l v = i < 12 ? pose_turn(i % 2 ? &o->pa : &o->pb, ref_vec(vec(i / 2 == 0   ? 1
                                                                      : i / 2 == 1 ? -1
                                                                                   : 1e-9,
                                                                      i / 2 == 2   ? 1
                                                                      : i / 2 == 3 ? -1
                                                                                   : 1e-9,
                                                                      i / 2 == 4   ? 1
                                                                      : i / 2 == 5 ? -1
                                                                                   : 1e-9)))
                     : ref_vec(rng_unit(r));
    const long double there = phi(o, v);
    if (there > best) best = there, u = v;
  }
  double step = 0.3;
  for (int i = 0; i < 60; i++) {
    const vec3l next = ref_add(u, ref_scale(step, ref_vec(rng_unit(r))));
    const long double there = phi(o, next);
    if (there > best) {
      best = there;
      u = ref_scale(1.0L / ref_norm(next), next);
    } else {
      step *= 0.85;
    }
  }
  return best;
}

static void check_pair(attack *t, rng *r, const overlap *o) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = o->size * rng_log_uniform(r, 1e-10, 1e-2);
  const bool swapped = rng_index(r, 2) == 0;
  const cprox_obstacle a = cprox_obstacle_at(o->a.body, o->pa), b = cprox_obstacle_at(o->b.body, o->pb);
  cprox_result result;
  const cprox_status status = cprox_pair(swapped ? b : a, swapped ? a : b, &options, t->ws, &result);
  if (!attack_check(t, status >= 0, "%s", cprox_workspace_error(t->ws))) return;
  if (status > 0) attack_count(t, cprox_status_name(status));
  const double hair = 1e-14 * (o->size + vec_norm(o->pa.position));
  const long double best = soonest_way_out(r, o);
  const bool enough = result.upper < 0.0 || result.upper - result.lower <= options.epsilon;
  attack_check(t, enough && result.lower <= result.upper && result.lower <= -o->depth + hair,
               "[%.17g, %.17g] of a depth of at least %.17g", result.lower, result.upper, o->depth);
  attack_check(t, (long double)result.upper >= best - 1e-17L * (long double)(o->size + vec_norm(o->pa.position)),
               "[%.17g, %.17g]: a direction proves %.20Lg", result.lower, result.upper, best);
  const vec3l n = ref_scale(swapped ? -1 : 1, ref_vec(result.normal));
  if (vec_norm2(result.normal) == 0.0) return; /* the centre of a ball */
  attack_check(t, phi(o, n) >= (long double)result.lower - 1e-17L * (long double)(o->size + vec_norm(o->pa.position)),
               "[%.17g, %.17g]: the normal (%g, %g, %g) proves less", result.lower, result.upper, result.normal.x,
               result.normal.y, result.normal.z);
}

/* b carried along a line through where it stands, or a point through a's middle. */
static void check_carried(attack *t, rng *r, const overlap *o) {
  const double away = 3.0 * (o->size + o->b.size[0] + o->b.size[1] + o->b.size[2]);
  const vec3 along = vec_scale(away, rng_index(r, 2) ? rng_unit(r) : vec(0, 1, 0));
  const vec3 points[3] = {vec_sub(o->middle, along), o->middle, vec_add(o->middle, along)};
  cprox_pose still = o->pb;
  still.position = vec(0, 0, 0);
  const cprox_body *part = o->b.body;
  cprox_body *turned = NULL;
  cprox_curve *curve = NULL;
  cprox_status status = cprox_body_create_compound(&part, &still, 1, t->ws, &turned);
  if (status >= 0) status = curve_from(describe_bezier(points, 3, 0.0, 1.0), t->ws, &curve);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-9 * o->size;
  options.max_nodes = 2000;
  cprox_result result = {0};
  const bool carried = vec_norm(middle(&o->b)) == 0.0 && rng_index(r, 2);
  if (status >= 0)
    status = cprox_collision(carried ? cprox_body_along(turned, curve) : cprox_point_along(curve),
                             cprox_obstacle_at(o->a.body, o->pa), &options, t->ws, &result);
  attack_check(t, status == CPROX_OK && result.verdict == CPROX_VERDICT_VIOLATED,
               "%s: [%.17g, %.17g] after %u nodes, status %s", carried ? "carried" : "point", result.lower,
               result.upper, (unsigned)result.nodes, cprox_status_name(status));
  cprox_curve_free(curve);
  cprox_body_free(turned);
}

static void one_case(attack *t, rng *r) {
  static overlap o;
  memset(&o, 0, sizeof o);
  overlap_make(r, &o);
  const bool carried = rng_index(r, 4) == 0;
  attack_kind(t, "%s, %s%s", shape_name(&o.a), shape_name(&o.b), carried ? ", on a curve" : "");
  if (carried)
    check_carried(t, r, &o);
  else
    check_pair(t, r, &o);
  overlap_free(&o);
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "coincident", one_case);
}
