/* SPDX-License-Identifier: BSD-3-Clause */
/* Signed distances of standing bodies, held against distances that are known by construction. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/rounding.h"
#include "body/body.h"
#include "curve_proximity/cprox/query.h"
#include "support/counting.h"
#include "support/random.h"
#include "support/reference.h"

enum { MOST = 40 };

/* ---- shapes, and their support functions in long double ---- */

typedef struct shape {
  cprox_body_kind kind;
  double size[3];
  vec3 v[MOST];
  size_t n;
  cprox_body *body;
} shape;

static const cprox_body_kind BOUNDED[] = {CPROX_POINT, CPROX_SPHERE,    CPROX_BOX,      CPROX_CAPSULE, CPROX_CYLINDER,
                                          CPROX_CONE,  CPROX_ELLIPSOID, CPROX_POLYTOPE, CPROX_POLYGON, CPROX_SUPPORT};
enum { N_BOUNDED = sizeof BOUNDED / sizeof *BOUNDED };

/* A user's callback: a box, given by its half extents. */
static void box_callback(const void *user, const double d[3], double p[3]) {
  const double *half = user;
  for (int i = 0; i < 3; i++) p[i] = d[i] < 0.0 ? -half[i] : half[i];
}

/* Fills s, which must stay where it is: a callback points into it. */
static void make_shape(rng *r, cprox_body_kind kind, double scale, double aspect, shape *s) {
  memset(s, 0, sizeof *s);
  s->kind = kind;
  for (int i = 0; i < 3; i++) s->size[i] = scale * rng_log_uniform(r, 1.0 / aspect, 1.0);
  const double *z = s->size;
  cprox_status status = CPROX_INVALID;
  switch (kind) {
    case CPROX_POINT:
      s->v[s->n++] = rng_in_cube(r, scale);
      status = cprox_body_create_point(s->v[0], NULL, &s->body);
      break;
    case CPROX_SPHERE: status = cprox_body_create_sphere(z[0], NULL, &s->body); break;
    case CPROX_BOX: status = cprox_body_create_box(vec(2 * z[0], 2 * z[1], 2 * z[2]), NULL, &s->body); break;
    case CPROX_CAPSULE: status = cprox_body_create_capsule(2 * z[1], z[0], NULL, &s->body); break;
    case CPROX_CYLINDER: status = cprox_body_create_cylinder(2 * z[1], z[0], NULL, &s->body); break;
    case CPROX_CONE: status = cprox_body_create_cone(2 * z[1], z[0], NULL, &s->body); break;
    case CPROX_ELLIPSOID: status = cprox_body_create_ellipsoid(vec(z[0], z[1], z[2]), NULL, &s->body); break;
    case CPROX_POLYTOPE:
      for (s->n = 1 + rng_index(r, MOST); s->body == NULL;) {
        const vec3 offset = rng_in_cube(r, scale);
        for (size_t i = 0; i < s->n; i++) {
          const vec3 u = rng_unit(r);
          s->v[i] = vec(offset.x + z[0] * u.x, offset.y + z[1] * u.y, offset.z + z[2] * u.z);
        }
        status = cprox_body_create_polytope(s->v, s->n, NULL, &s->body);
      }
      break;
    case CPROX_POLYGON: {
      double flat[MOST][2];
      s->n = 3 + rng_index(r, 12);
      for (size_t i = 0; i < s->n; i++) {
        const double angle = 6.283185307 * ((double)i + 0.4 * rng_uniform(r, 0.0, 1.0)) / (double)s->n;
        s->v[i] = vec(z[0] * cos(angle), z[1] * sin(angle), 0.0);
        flat[i][0] = s->v[i].x;
        flat[i][1] = s->v[i].y;
      }
      status = cprox_body_create_polygon((const double(*)[2])flat, s->n, NULL, &s->body);
      break;
    }
    case CPROX_SUPPORT:
      status = cprox_body_create_support(box_callback, s->size, vec(0, 0, 0), 2 * scale, 0.0, 0.0, NULL, &s->body);
      break;
    default: break;
  }
  assert_int_equal(status, CPROX_OK);
}

/* The point of the shape farthest along d, in its frame. */
static vec3l extreme(const shape *s, vec3l d) {
  const long double a = s->size[0], b = s->size[1], c = s->size[2], e = hypotl(d.x, d.y), length = ref_norm(d);
  vec3l x = {0, 0, 0};
  switch (s->kind) {
    case CPROX_SPHERE: return ref_scale(a / length, d);
    case CPROX_BOX:
    case CPROX_SUPPORT: return (vec3l){copysignl(a, d.x), copysignl(b, d.y), copysignl(c, d.z)};
    case CPROX_CAPSULE: x.z = copysignl(b, d.z); return ref_add(x, ref_scale(a / length, d));
    case CPROX_CYLINDER: return (vec3l){a * d.x / e, a * d.y / e, copysignl(b, d.z)};
    case CPROX_CONE:
      if (b * d.z > a * e - b * d.z) return (vec3l){0, 0, b};
      return (vec3l){a * d.x / e, a * d.y / e, -b};
    case CPROX_ELLIPSOID: {
      const vec3l w = {a * d.x, b * d.y, c * d.z};
      const long double n = ref_norm(w);
      return (vec3l){a * w.x / n, b * w.y / n, c * w.z / n};
    }
    default: { /* vertices */
      size_t best = 0;
      for (size_t i = 1; i < s->n; i++)
        if (ref_dot(d, ref_vec(s->v[i])) > ref_dot(d, ref_vec(s->v[best]))) best = i;
      return ref_vec(s->v[best]);
    }
  }
}

static vec3l turn(const cprox_pose *pose, vec3l v) {
  const cprox_pose still = {.orientation = pose->orientation};
  return ref_to_world(&still, v);
}

static vec3l turn_back(const cprox_pose *pose, vec3l v) {
  const cprox_pose still = {.orientation = pose->orientation};
  return ref_to_local(&still, v);
}

static vec3l world_extreme(const shape *s, const cprox_pose *pose, vec3l d) {
  return ref_to_world(pose, extreme(s, turn_back(pose, d)));
}

/* A direction that matters to the shape: the normal of its nearest point to somewhere, in the world. */
static vec3 telling_direction(rng *r, const shape *s, const cprox_pose *pose) {
  if (rng_index(r, 3) == 0) return rng_unit(r);
  convex_near near;
  s->body->shape.ops->nearest(&s->body->shape, vec_scale(1.5 * s->body->shape.scale, rng_unit(r)), NULL, &near);
  if (vec_norm2(near.normal) == 0.0) return rng_unit(r);
  const vec3l n = turn(pose, ref_vec(near.normal));
  return vec((double)n.x, (double)n.y, (double)n.z);
}

/* Moves b so that a's least and b's greatest point along n are `gap` apart along n: their distance if gap >= 0, a bound below
 * the signed distance if not. Returns by how much the rounding of b's position may have changed it. */
static double place(const shape *a, const cprox_pose *pa, const shape *b, cprox_pose *pb, vec3 n, double gap) {
  const vec3l d = ref_vec(n), away = ref_scale(-1, d);
  pb->position = vec(0, 0, 0);
  const vec3l p = world_extreme(a, pa, away), q = world_extreme(b, pb, d);
  const vec3l x = ref_sub(ref_sub(p, q), ref_scale(gap / ref_norm(d), d));
  pb->position = vec((double)x.x, (double)x.y, (double)x.z);
  /* and long double's own rounding, 2048 times finer */
  return (double)ref_error(x, pb->position) + 0.01 * ROUND_U * (double)(ref_norm(p) + ref_norm(q) + ref_norm(x));
}

static const char *name_of(const shape *s) {
  return cprox_body_kind_name(s->kind);
}

static void check_bracket(const shape *a, const shape *b, double gap, double tolerance, const cprox_result *r) {
  if (!(r->upper >= gap - tolerance && r->lower <= fmax(gap, 0.0) + tolerance && r->lower <= r->upper))
    fail_msg("%s and %s at gap %.17g: [%.17g, %.17g], status %s", name_of(a), name_of(b), gap, r->lower, r->upper,
             cprox_status_name(r->status));
}

static double reach_of(const shape *a, const cprox_pose *pa, const shape *b, const cprox_pose *pb) {
  return a->body->ball_radius + b->body->ball_radius + vec_norm(a->body->ball_centre) + vec_norm(b->body->ball_centre) +
         vec_norm(vec_sub(pa->position, pb->position));
}

/* ---- properties ---- */

typedef struct sweep {
  uint64_t seed;
  size_t cases;
  double aspect, ratio, least_gap, most_gap;
  double allowed_undecided; /* fraction that may end without the accuracy asked for */
} sweep;

/* Distances by construction, apart. At relative 1e-9 (or 64 rounding errors, for gaps near them) nearly all are decided. */
static void check_apart(const sweep *w) {
  rng r = rng_seed(w->seed);
  size_t undecided = 0;
  const size_t cases = test_cases(w->cases);
  static shape a, b;
  for (size_t i = 0; i < cases; i++) {
    const double scale = rng_log_uniform(&r, 1e-3, 1e3), ratio = rng_log_uniform(&r, 1.0 / w->ratio, 1.0);
    make_shape(&r, BOUNDED[rng_index(&r, N_BOUNDED)], scale, w->aspect, &a);
    make_shape(&r, BOUNDED[rng_index(&r, N_BOUNDED)], scale * ratio, w->aspect, &b);
    const cprox_pose pa = rng_pose(&r, rng_index(&r, 2) ? 0.0 : scale);
    cprox_pose pb = rng_pose(&r, 0.0);
    const bool by_a = rng_index(&r, 2);
    const vec3 n = by_a ? vec_neg(telling_direction(&r, &a, &pa)) : telling_direction(&r, &b, &pb);
    const double gap = scale * rng_log_uniform(&r, w->least_gap, w->most_gap);
    const double tolerance = place(&a, &pa, &b, &pb, n, gap);

    cprox_options options = cprox_options_default();
    const double floor = 200.0 * ROUND_U * reach_of(&a, &pa, &b, &pb);
    options.epsilon = floor;
    options.relative_epsilon = 1e-9;
    cprox_result result;
    const cprox_status status = cprox_pair(cprox_at(a.body, pa), cprox_at(b.body, pb), &options, NULL, &result);
    assert_true(status == result.status && status >= CPROX_OK);
    check_bracket(&a, &b, gap, tolerance, &result);
    undecided += status != CPROX_OK;
    if (status == CPROX_OK) assert_true(result.upper - result.lower <= fmax(floor, 1e-9 * result.upper));
    if (gap > 2.0 * floor && status == CPROX_OVERLAP)
      fail_msg("%s and %s overlap at gap %g", name_of(&a), name_of(&b), gap);

    /* the points attain upper, one on each body, and the normal points from b to a */
    if (status != CPROX_OVERLAP && gap > 1e-6 * scale) {
      const vec3 apart = vec_sub(result.on_mover, result.on_target);
      const double noise = floor + 1e-12 * vec_norm(pa.position);
      assert_true(fabs(vec_norm(apart) - result.upper) <= 1e-9 * result.upper + 2.0 * noise);
      if (status == CPROX_OK) assert_true(vec_dot(apart, result.normal) >= (1.0 - 1e-7) * result.upper - 2.0 * noise);
      assert_true(fabs(vec_norm(result.normal) - 1.0) < 1e-14);
    }
    cprox_body_free(a.body);
    cprox_body_free(b.body);
  }
  print_message("undecided: %zu of %zu\n", undecided, cases);
  assert_true((double)undecided <= 2.0 + w->allowed_undecided * (double)cases);
}

/* Seed 301, 1e5 pairs of all kinds at scales 1e-3 to 1e3. Tolerance: what the rounding of b's position moved. */
static void a_distance_known_by_construction_lies_in_the_interval(void **state) {
  (void)state;
  check_apart(&(sweep){301, 100000, 4.0, 4.0, 1e-3, 10.0, 5e-4});
}

/* Seed 302, 1e5 pairs, gaps 1e-15 to 1e-2 of the size. */
static void gaps_down_to_rounding_lie_in_the_interval(void **state) {
  (void)state;
  check_apart(&(sweep){302, 100000, 4.0, 4.0, 1e-15, 1e-2, 2e-3});
}

/* Seed 303, 3e4 pairs of aspect up to 1e6; seed 304, 3e4 pairs whose sizes are up to 1e12 apart. What thin shapes leave
 * undecided is counted, not wrong. */
static void needles_and_wafers_lie_in_the_interval(void **state) {
  (void)state;
  check_apart(&(sweep){303, 30000, 1e6, 4.0, 1e-9, 1.0, 5e-2});
}

static void sizes_a_million_million_apart_lie_in_the_interval(void **state) {
  (void)state;
  check_apart(&(sweep){304, 30000, 4.0, 1e12, 1e-9, 1.0, 2e-3});
}

/* A point of the shape: an extreme one, moved towards the mean of others by the fraction. */
static vec3l point_within(rng *r, const shape *s, const cprox_pose *pose, double fraction) {
  const vec3l p = world_extreme(s, pose, ref_vec(rng_unit(r)));
  vec3l mean = {0, 0, 0};
  for (int i = 0; i < 8; i++)
    mean = ref_add(
        mean, ref_scale(0.125L,
                        world_extreme(s, pose, ref_vec(vec(i & 1 ? 1 : -1, i & 2 ? 1.1 : -1.1, i & 4 ? 0.9 : -0.9)))));
  return ref_add(ref_scale(1 - fraction, p), ref_scale(fraction, mean));
}

/* Seed 305, 1e5 pairs that share a point, from a touch to deep inside: the interval starts at or below 0, ends at or above phi
 * of any direction, and where the overlap is proven that is said. */
static void overlaps_are_never_called_apart(void **state) {
  (void)state;
  rng r = rng_seed(305);
  size_t proven = 0, deep = 0;
  static shape a, b;
  for (size_t i = 0; i < test_cases(100000); i++) {
    make_shape(&r, BOUNDED[rng_index(&r, N_BOUNDED)], 1.0, 4.0, &a);
    make_shape(&r, BOUNDED[rng_index(&r, N_BOUNDED)], 1.0, 4.0, &b);
    const cprox_pose pa = rng_pose(&r, 1.0);
    cprox_pose pb = rng_pose(&r, 0.0);
    const double fraction = rng_index(&r, 2) ? rng_log_uniform(&r, 1e-16, 1.0) : rng_uniform(&r, 0.1, 1.0);
    const vec3l x = ref_sub(point_within(&r, &a, &pa, fraction), point_within(&r, &b, &pb, fraction));
    pb.position = vec((double)x.x, (double)x.y, (double)x.z);
    const long double tolerance = ref_error(x, pb.position) + 1e-17L;
    cprox_result result;
    assert_true(cprox_pair(cprox_at(a.body, pa), cprox_at(b.body, pb), NULL, NULL, &result) >= CPROX_OK);
    if (!(result.lower <= tolerance && result.lower <= result.upper))
      fail_msg("%s and %s share a point: [%.17g, %.17g]", name_of(&a), name_of(&b), result.lower, result.upper);
    for (int k = 0; k < 4; k++) {
      const vec3l u = ref_vec(rng_unit(&r));
      const long double phi =
          ref_dot(u, world_extreme(&a, &pa, ref_scale(-1, u))) - ref_dot(u, world_extreme(&b, &pb, u));
      if (phi / ref_norm(u) > result.upper + 1e-15L)
        fail_msg("upper %.17g, a direction gives %.20Lg", result.upper, phi);
    }
    if (result.status == CPROX_OVERLAP) {
      assert_true(result.upper == 0.0 && vec_norm(result.normal) == 0.0);
      /* the point is one of both: no direction leads from a shape to it */
      assert_true(vec_equal(result.on_mover, result.on_target));
      const vec3l p = ref_vec(result.on_mover), u = ref_vec(rng_unit(&r));
      assert_true(ref_dot(u, ref_sub(p, world_extreme(&a, &pa, u))) < 1e-13L);
      assert_true(ref_dot(u, ref_sub(p, world_extreme(&b, &pb, u))) < 1e-13L);
      proven++;
    }
    const bool solid = a.body->shape.ops->curvature && b.body->shape.ops->curvature;
    if (solid && fraction > 0.1) {
      deep++;
      if (!(result.status == CPROX_OVERLAP || result.upper < 0.0))
        fail_msg("%s and %s overlap by a fraction %g, status %s [%g, %g]", name_of(&a), name_of(&b), fraction,
                 cprox_status_name(result.status), result.lower, result.upper);
    }
    cprox_body_free(a.body);
    cprox_body_free(b.body);
  }
  print_message("proven to overlap: %zu\n", proven);
  assert_true(proven > 1000 || test_cases(100) < 100);
  assert_true(deep > 1000 || test_cases(100) < 100);
}

/* Seed 306, 2e4 pairs far from the origin of the world: what positions share does not enter the interval's width. */
static void a_common_offset_of_a_million_metres_costs_nothing(void **state) {
  (void)state;
  rng r = rng_seed(306);
  static shape a, b;
  for (size_t i = 0; i < test_cases(20000); i++) {
    make_shape(&r, BOUNDED[rng_index(&r, N_BOUNDED)], 1.0, 4.0, &a);
    make_shape(&r, BOUNDED[rng_index(&r, N_BOUNDED)], 1.0, 4.0, &b);
    const vec3 offset = vec(1e6, -2e6, 5e5);
    cprox_pose pa = rng_pose(&r, 0.0), pb = rng_pose(&r, 0.0);
    pa.position = offset;
    const double tolerance = place(&a, &pa, &b, &pb, rng_unit(&r), 0.1);
    cprox_options options = cprox_options_default();
    options.epsilon = 1e-12;
    cprox_result result;
    cprox_pair(cprox_at(a.body, pa), cprox_at(b.body, pb), &options, NULL, &result);
    check_bracket(&a, &b, 0.1, tolerance, &result);
    assert_true(result.upper - result.lower < 1e-11);
    cprox_body_free(a.body);
    cprox_body_free(b.body);
  }
}

/* Seed 307, 5e4 pairs with a ball: exact on both sides of the surface, against the ball's centre in long double for a ball and
 * against 2e4 directions for the rest: no direction may do better than lower says. */
static void balls_have_their_exact_signed_distance(void **state) {
  (void)state;
  rng r = rng_seed(307);
  static shape a, b;
  for (size_t i = 0; i < test_cases(50000); i++) {
    make_shape(&r, rng_index(&r, 2) ? CPROX_SPHERE : CPROX_POINT, 1.0, 4.0, &a);
    make_shape(&r, rng_index(&r, 4) ? BOUNDED[1 + rng_index(&r, 6)] : CPROX_SPHERE, 1.0, 4.0, &b);
    const cprox_pose pa = rng_pose(&r, 1.5), pb = rng_pose(&r, 1.5);
    cprox_options options = cprox_options_default();
    options.epsilon = 1e-12;
    cprox_result ab, ba;
    assert_int_equal(cprox_pair(cprox_at(a.body, pa), cprox_at(b.body, pb), &options, NULL, &ab), CPROX_OK);
    assert_int_equal(cprox_pair(cprox_at(b.body, pb), cprox_at(a.body, pa), &options, NULL, &ba), CPROX_OK);
    assert_true(ab.lower <= ba.upper && ba.lower <= ab.upper);
    assert_true(vec_norm(vec_sub(ab.on_mover, ba.on_target)) < 1e-12 &&
                vec_norm(vec_add(ab.normal, ba.normal)) < 1e-12);
    for (int k = 0; k < 8; k++) { /* phi of any direction is a bound below the signed distance */
      const vec3l u = ref_vec(k == 0 ? ab.normal : rng_unit(&r));
      const long double phi =
          ref_dot(u, world_extreme(&a, &pa, ref_scale(-1, u))) - ref_dot(u, world_extreme(&b, &pb, u));
      if (!((long double)ab.upper >= phi - 1e-15L)) fail_msg("upper %.17g, a direction gives %.20Lg", ab.upper, phi);
      if (k == 0) assert_true(phi >= (long double)ab.lower - 1e-7L && phi <= (long double)ab.upper + 1e-15L);
    }
    cprox_body_free(a.body);
    cprox_body_free(b.body);
  }
}

/* Seed 308, 5e4 bodies above, through and below a halfspace: the lowest point's height in long double. */
static void a_halfspace_knows_the_signed_distance_of_everything(void **state) {
  (void)state;
  rng r = rng_seed(308);
  static shape b;
  for (size_t i = 0; i < test_cases(50000); i++) {
    make_shape(&r, BOUNDED[rng_index(&r, N_BOUNDED)], 1.0, 10.0, &b);
    const cprox_pose ph = rng_pose(&r, 2.0), pb = rng_pose(&r, 2.0);
    const vec3 normal = vec_scale(rng_log_uniform(&r, 1e-3, 1e3), rng_unit(&r));
    const double offset = rng_uniform(&r, -2.0, 2.0);
    cprox_body *h = NULL;
    assert_int_equal(cprox_body_create_halfspace(normal, offset, NULL, &h), CPROX_OK);
    const vec3l n = turn(&ph, ref_vec(normal)), low = ref_to_local(&ph, world_extreme(&b, &pb, ref_scale(-1, n)));
    const long double exact = (ref_dot(ref_vec(normal), low) + offset) / ref_norm(ref_vec(normal));
    cprox_options options = cprox_options_default();
    options.epsilon = 1e-9;
    cprox_result hb, bh;
    assert_int_equal(cprox_pair(cprox_at(h, ph), cprox_at(b.body, pb), &options, NULL, &hb), CPROX_OK);
    assert_int_equal(cprox_pair(cprox_at(b.body, pb), cprox_at(h, ph), &options, NULL, &bh), CPROX_OK);
    if (!(hb.lower <= exact && exact <= hb.upper && bh.lower <= exact && exact <= bh.upper))
      fail_msg("%s: [%.17g, %.17g], exact %.20Lg", name_of(&b), hb.lower, hb.upper, exact);
    assert_true(hb.upper - hb.lower < 1e-10 * (1.0 + vec_norm(vec_scale(offset / vec_norm(normal), normal))));
    /* from b's lowest point straight to the surface */
    const vec3 step = vec_sub(hb.on_mover, hb.on_target);
    assert_true(vec_norm(vec_sub(step, vec_scale((double)exact, hb.normal))) < 1e-9 * (1.0 + fabs((double)exact)));
    assert_true(vec_norm(vec_add(hb.normal, bh.normal)) < 1e-15);
    cprox_body_free(h);
    cprox_body_free(b.body);
  }
}

/* Seed 309, 2e4 pairs. */
static void padding_is_taken_off_the_distance(void **state) {
  (void)state;
  rng r = rng_seed(309);
  static shape a, b;
  for (size_t i = 0; i < test_cases(20000); i++) {
    make_shape(&r, BOUNDED[rng_index(&r, N_BOUNDED)], 1.0, 4.0, &a);
    make_shape(&r, BOUNDED[rng_index(&r, N_BOUNDED)], 1.0, 4.0, &b);
    const cprox_pose pa = rng_pose(&r, 1.0);
    cprox_pose pb = rng_pose(&r, 0.0);
    const double gap = rng_uniform(&r, 0.1, 1.0), pad_a = rng_uniform(&r, 0.0, 0.7), pad_b = rng_uniform(&r, 0.0, 0.7);
    const double tolerance = place(&a, &pa, &b, &pb, telling_direction(&r, &b, &pb), gap),
                 exact = gap - (pad_a + pad_b);
    cprox_options options = cprox_options_default();
    options.epsilon = 1e-9;
    cprox_result result;
    const cprox_target ta = cprox_padded(cprox_at(a.body, pa), pad_a), tb = cprox_padded(cprox_at(b.body, pb), pad_b);
    cprox_pair(ta, tb, &options, NULL, &result);
    /* the cores are apart: the depth is exact as well */
    if (!(result.lower <= exact + tolerance && result.upper >= exact - tolerance))
      fail_msg("%s and %s: [%.17g, %.17g], exact %.17g", name_of(&a), name_of(&b), result.lower, result.upper, exact);
    assert_int_equal(result.status, CPROX_OK);
    cprox_body_free(a.body);
    cprox_body_free(b.body);
  }
}

/* Seed 310, 5000 unions of three against unions of two: the least of the six, and which part it was. */
static void a_compound_is_as_near_as_its_nearest_part(void **state) {
  (void)state;
  rng r = rng_seed(310);
  static shape part[5];
  for (size_t i = 0; i < test_cases(5000); i++) {
    const cprox_body *bodies[5];
    cprox_pose poses[5];
    for (int k = 0; k < 5; k++) {
      make_shape(&r, BOUNDED[rng_index(&r, N_BOUNDED)], 0.5, 4.0, &part[k]);
      bodies[k] = part[k].body;
      poses[k] = rng_pose(&r, 1.0);
    }
    cprox_body *a = NULL, *b = NULL;
    assert_int_equal(cprox_body_create_compound(bodies, poses, 3, NULL, &a), CPROX_OK);
    assert_int_equal(cprox_body_create_compound(bodies + 3, poses + 3, 2, NULL, &b), CPROX_OK);
    cprox_pose away = rng_pose(&r, 1.0);
    away.position.x += 6.0;
    cprox_options options = cprox_options_default();
    options.epsilon = 1e-9;
    cprox_result whole, single, least = {.upper = INFINITY, .lower = INFINITY};
    assert_int_equal(cprox_pair(cprox_at(a, away), cprox_at(b, cprox_pose_identity()), &options, NULL, &whole),
                     CPROX_OK);
    for (int p = 0; p < 3; p++)
      for (int q = 0; q < 2; q++) {
        const cprox_target ta = cprox_at(bodies[p], frame_compose(&away, &poses[p]));
        cprox_pair(ta, cprox_at(bodies[3 + q], poses[3 + q]), &options, NULL, &single);
        if (single.upper >= least.upper) continue;
        least = single;
        least.target_part = q;
      }
    assert_true(whole.lower <= least.upper && least.lower <= whole.upper + 1e-12);
    assert_int_equal(whole.target_part, least.target_part);
    cprox_body_free(a);
    cprox_body_free(b);
    for (int k = 0; k < 5; k++) cprox_body_free(part[k].body);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_distance_known_by_construction_lies_in_the_interval),
      cmocka_unit_test(gaps_down_to_rounding_lie_in_the_interval),
      cmocka_unit_test(needles_and_wafers_lie_in_the_interval),
      cmocka_unit_test(sizes_a_million_million_apart_lie_in_the_interval),
      cmocka_unit_test(overlaps_are_never_called_apart),
      cmocka_unit_test(a_common_offset_of_a_million_metres_costs_nothing),
      cmocka_unit_test(balls_have_their_exact_signed_distance),
      cmocka_unit_test(a_halfspace_knows_the_signed_distance_of_everything),
      cmocka_unit_test(padding_is_taken_off_the_distance),
      cmocka_unit_test(a_compound_is_as_near_as_its_nearest_part),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
