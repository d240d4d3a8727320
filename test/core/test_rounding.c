/* SPDX-License-Identifier: BSD-3-Clause */
/* The theorems of doc/rounding.md against 320 bits: no error is above its bound, and no bound is padded. Each test
 * prints the largest actual error as a fraction of its bound, and asserts that it is at least FULL: a bound that is far
 * above every error that was ever seen costs precision for nothing (asked of ENOUGH cases and more). Built with and
 * without fused multiply-add. Tolerance 0; the reference's own error is 2^-267. */
#include "base/rounding.h"
#include "curve/control.h"
#include "curve/curve.h"
#include "curve_query/curve_convex.h"
#include "shape/body.h"
#include "support/cases.h"
#include "support/curves.h"
#include "support/exact.h"
#include "support/make_curve.h"
#include "support/random.h"

enum { CASES = 20000, SIGHTS = 4, MAX_DEGREE = 12, ENOUGH = 5000 };

#define FULL 0.15

/* The largest error as a fraction of its bound. */
typedef struct fraction {
  double most;
  size_t cases;
} fraction;

static void hold(fraction *f, double actual, double bound, const char *what) {
  if (!(actual <= bound)) fail_msg("%s: error %.17g above its bound %.17g", what, actual, bound);
  f->cases++;
  if (bound > 0.0) f->most = fmax(f->most, actual / bound);
}

static void tell(const fraction *f, const char *what) {
  print_message("%s: %zu cases, largest error %.3f of its bound\n", what, f->cases, f->most);
  if (f->cases >= ENOUGH) assert_true(f->most >= FULL);
}

/* ---- the exact counterparts ---- */

/* Cuts p at s: `left` and p itself become the two parts. */
static void cut_exactly(num3 *p, num3 *left, size_t degree, num s) {
  left[0] = p[0];
  for (size_t level = 1; level <= degree; level++) {
    for (size_t i = 0; i + level <= degree; i++) p[i] = exact3_blend(p[i], p[i + 1], s);
    left[level] = p[0];
  }
}

/* The columns of R(q), exactly: R = 1 + 2/q·q (w [v] + [v]²). */
static void rotation(cprox_quat q, num3 column[3]) {
  const num w = exact(q.w), v[3] = {exact(q.x), exact(q.y), exact(q.z)};
  num square = exact_mul(w, w);
  for (int k = 0; k < 3; k++) square = exact_add(square, exact_mul(v[k], v[k]));
  const num s = exact_div(exact(2.0), square);
  for (int j = 0; j < 3; j++) {
    for (int i = 0; i < 3; i++) {
      /* [v]² = v v^T - (v·v) 1; [v] has +v_k where (i, j, k) turns backwards */
      num entry = exact_mul(v[i], v[j]);
      if (i == j) {
        for (int k = 0; k < 3; k++) entry = exact_sub(entry, exact_mul(v[k], v[k]));
      } else {
        const num turn = exact_mul(w, v[3 - i - j]);
        entry = (j + 1) % 3 == i ? exact_add(entry, turn) : exact_sub(entry, turn);
      }
      entry = exact_mul(s, entry);
      column[j].k[i] = i == j ? exact_add(exact(1.0), entry) : entry;
    }
  }
}

static num3 to_local(const cprox_pose *pose, vec3 centre, vec3 world) {
  num3 column[3], out;
  rotation(pose->orientation, column);
  const num3 p = exact3_sub(exact3(world), exact3(pose->position));
  for (int k = 0; k < 3; k++) out.k[k] = exact3_dot(column[k], p);
  return exact3_sub(out, exact3(centre));
}

/* ---- T1 ---- */

/* Seed 1. A quarter at s = 1/2, where a level costs u and not 3u. */
CASE(a_cut_adds_no_more_than_it_says) {
  rng r = rng_seed(1);
  fraction halves = {0}, others = {0};
  for (size_t i = 0; i < test_cases(CASES); i++) {
    exact_reset();
    const size_t degree = 1 + rng_index(&r, MAX_DEGREE), n = degree + 1;
    vec3 p[MAX_DEGREE + 1];
    random_points(&r, n, p);
    double left[3 * (MAX_DEGREE + 1)], right[3 * (MAX_DEGREE + 1)];
    num3 exact_left[MAX_DEGREE + 1], exact_right[MAX_DEGREE + 1] = {{{0}}};
    for (size_t j = 0; j < n; j++) {
      right[j] = p[j].x, right[n + j] = p[j].y, right[2 * n + j] = p[j].z;
      exact_right[j] = exact3(p[j]);
    }
    const double s = rng_index(&r, 4) ? random_parameter(&r) : 0.5;
    const double bound = control_split(left, right, degree, s, control_magnitude(right, degree));
    cut_exactly(exact_right, exact_left, degree, exact(s));
    double most = 0.0;
    for (size_t j = 0; j < n; j++) {
      most = fmax(most, exact3_error(exact_left[j], vec(left[j], left[n + j], left[2 * n + j])));
      most = fmax(most, exact3_error(exact_right[j], vec(right[j], right[n + j], right[2 * n + j])));
    }
    hold(s == 0.5 ? &halves : &others, most, bound, "T1");
  }
  tell(&halves, "T1, cut in the middle");
  tell(&others, "T1, cut anywhere");
}

/* ---- counts that recur ---- */

/* Seed 8. Of the count 3.5 of 8 are the norm itself: other operations with it are not made here. */
CASE(a_length_and_a_speed_along_a_normal_are_as_near_as_their_counts) {
  rng r = rng_seed(8);
  fraction lengths = {0}, speeds = {0};
  for (size_t i = 0; i < test_cases(CASES); i++) {
    exact_reset();
    const double scale = rng_log_uniform(&r, 1e-6, 1e6);
    const vec3 a = rng_in_cube(&r, scale), b = rng_in_cube(&r, rng_index(&r, 2) ? scale : 1e-3 * scale);
    const num3 difference = exact3_sub(exact3(a), exact3(b));
    const double measured = vec_norm(vec_sub(a, b));
    hold(&lengths, fabs(exact_double(exact_sub(exact3_norm(difference), exact(measured)))),
         ROUND_LENGTH * ROUND_U * measured, "ROUND_LENGTH");

    const vec3 n = vec_scale(1.0 / measured, vec_sub(a, b)), v = rng_in_cube(&r, scale);
    const num towards = exact_div(exact3_dot(exact3(n), exact3(v)), exact3_norm(exact3(n)));
    const double off = fabs(exact_double(exact_sub(towards, exact(vec_dot(n, v)))));
    hold(&speeds, off, ROUND_TOWARDS * ROUND_U * vec_norm(v), "ROUND_TOWARDS");
  }
  tell(&lengths, "the norm of a difference");
  tell(&speeds, "a speed along a normal");
}

/* ---- T3, T7 ---- */

/* Seed 2. Points up to 1e6 sizes from the origin; the bound speaks of the difference to the pose's position alone. */
CASE(a_point_in_a_frame_is_as_near_as_it_says) {
  rng r = rng_seed(2);
  fraction f = {0};
  for (size_t i = 0; i < test_cases(CASES); i++) {
    exact_reset();
    const double scale = rng_log_uniform(&r, 1e-6, 1e6);
    const vec3 away = rng_in_cube(&r, rng_index(&r, 2) ? 0.0 : 1e6 * scale);
    cprox_pose pose = rng_pose(&r, scale);
    if (rng_index(&r, 3) == 0) pose.orientation = (cprox_quat){1, 0, 0, 0};
    if (rng_index(&r, 4) == 0) pose.orientation = (cprox_quat){rng_awkward(&r, 1), rng_awkward(&r, 1), 1.0 / 3.0, 0};
    pose.position = vec_add(pose.position, away);
    const vec3 centre = rng_index(&r, 2) ? vec(0, 0, 0) : rng_in_cube(&r, scale);
    const vec3 world = vec_add(away, rng_in_cube(&r, scale));
    const frame placed = frame_create(&pose, centre);
    double error = 0.0;
    const vec3 local = frame_to_local(&placed, world, &error);
    hold(&f, exact3_error(to_local(&pose, centre, world), local), error, "T3");
    assert_true(error <= 64.0 * ROUND_U * 8.0 * scale + 8.0 * ROUND_U * scale);
  }
  tell(&f, "T3 and T7, a point in a frame");
}

/* ---- T2, T4 ---- */

typedef struct obstacle {
  int kind; /* a sphere, a box, a capsule, a hull */
  vec3 size, vertex[8];
  cprox_body *body;
} obstacle;

static obstacle obstacle_random(rng *r, double scale, cprox_workspace *ws) {
  obstacle o = {.kind = (int)rng_index(r, 4)};
  o.size = vec(rng_log_uniform(r, 1e-2, 1.0) * scale, rng_log_uniform(r, 1e-2, 1.0) * scale,
               rng_log_uniform(r, 1e-2, 1.0) * scale);
  for (int i = 0; i < 8; i++) o.vertex[i] = rng_in_cube(r, scale);
  cprox_status status = CPROX_OK;
  switch (o.kind) {
    case 0: status = cprox_body_create_sphere(o.size.x, ws, &o.body); break;
    case 1: status = cprox_body_create_box(vec_scale(2.0, o.size), ws, &o.body); break;
    case 2: status = cprox_body_create_capsule(2.0 * o.size.z, o.size.x, ws, &o.body); break;
    default: status = cprox_body_create_polytope(o.vertex, 8, ws, &o.body);
  }
  if (status != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  return o;
}

static num absolute(num a) {
  return exact_max(a, exact_sub(exact(0.0), a));
}

/* max n·x over the body, about its centre. */
static num support_exactly(const obstacle *o, num3 n) {
  const double half[3] = {o->size.x, o->size.y, o->size.z};
  num h = exact(0.0);
  switch (o->kind) {
    case 0: return exact_mul(exact(o->size.x), exact3_norm(n));
    case 1:
      for (int k = 0; k < 3; k++) h = exact_add(h, exact_mul(exact(half[k]), absolute(n.k[k])));
      return h;
    case 2:
      return exact_add(exact_mul(exact(o->size.z), absolute(n.k[2])), exact_mul(exact(o->size.x), exact3_norm(n)));
    default:
      for (int i = 0; i < 8; i++) {
        const num at = exact3_dot(n, exact3_sub(exact3(o->vertex[i]), exact3(o->body->centre)));
        h = i == 0 ? at : exact_max(h, at);
      }
      return h;
  }
}

/* The distance of a point about the centre: of spheres, boxes and capsules, 0 inside. */
static num distance_exactly(const obstacle *o, num3 y) {
  const double half[3] = {o->kind == 1 ? o->size.x : 0.0, o->kind == 1 ? o->size.y : 0.0,
                          o->kind == 0 ? 0.0 : o->size.z};
  num3 beyond;
  for (int k = 0; k < 3; k++) beyond.k[k] = exact_max(exact(0.0), exact_sub(absolute(y.k[k]), exact(half[k])));
  const num margin = exact(o->kind == 1 ? 0.0 : o->size.x);
  return exact_max(exact(0.0), exact_sub(exact3_norm(beyond), margin));
}

/* A curve and a body, as given and in the library's hands. */
typedef struct problem {
  obstacle o;
  cprox_pose pose;
  size_t degree;
  vec3 points[MAX_DEGREE + 1];
  double offset;
  cprox_curve *curve;
  curve_convex c;
} problem;

/* A third about the origin, unturned and with awkward mantissas: there the arithmetic of the points is all there is. */
static void problem_random(problem *p, rng *r, cprox_workspace *ws) {
  const bool bare = rng_index(r, 3) == 0;
  const double scale = rng_log_uniform(r, 1e-6, 1e6);
  const vec3 away = rng_in_cube(r, bare || rng_index(r, 2) ? 0.0 : 1e6 * scale);
  *p = (problem){.degree = 1 + rng_index(r, bare ? 2 : 6), .o = obstacle_random(r, scale, ws)};
  for (size_t i = 0; i <= p->degree; i++)
    p->points[i] = bare ? vec(rng_awkward(r, scale), rng_awkward(r, scale), rng_awkward(r, scale))
                        : vec_add(away, rng_in_cube(r, 2.0 * scale));
  p->pose = rng_pose(r, bare ? 0.0 : scale);
  p->pose.position = vec_add(p->pose.position, away);
  if (bare || rng_index(r, 2)) p->pose.orientation = (cprox_quat){1, 0, 0, 0};
  p->offset = bare || rng_index(r, 2) ? 0.0 : 0.1 * scale;
  assert_int_equal(curve_from(describe_bezier(p->points, p->degree + 1, 0.0, 1.0), ws, &p->curve), CPROX_OK);
  assert_true(
      curve_convex_begin(&p->c, p->curve, &p->o.body->shape, frame_create(&p->pose, p->o.body->centre), p->offset, ws));
}

static void problem_free(problem *p) {
  cprox_body_free(p->o.body);
  cprox_curve_free(p->curve);
}

/* min n·P - h(n) - offset for the unit vector along n, over exact points. */
static num bound_exactly(const problem *p, const num3 *points, num3 n) {
  num least = exact3_dot(n, points[0]);
  for (size_t i = 1; i <= p->degree; i++) least = exact_min(least, exact3_dot(n, points[i]));
  return exact_sub(exact_div(exact_sub(least, support_exactly(&p->o, n)), exact3_norm(n)), exact(p->offset));
}

/* A sight from a point: the upper bound there, and the lower bound of the whole curve or of a part by its normal. */
static void attack(problem *p, rng *r, fraction *lower, fraction *upper) {
  curve_convex *c = &p->c;
  search_node node = curve_convex_root(c);
  assert_true(curve_side_materialise(&c->side, &curve_convex_own(&node)->at));
  const double s = random_parameter(r);
  curve_sample sight;
  search_best best;
  curve_convex_measure(c, 0, s, curve_side_point(&c->side, s), curve_side_point_error(&c->side), &sight, &best);

  /* the exact curve in the exact frame */
  num3 whole[MAX_DEGREE + 1], left[MAX_DEGREE + 1], right[MAX_DEGREE + 1];
  for (size_t i = 0; i <= p->degree; i++) right[i] = whole[i] = to_local(&p->pose, p->o.body->centre, p->points[i]);
  cut_exactly(right, left, p->degree, exact(s));

  /* T4 */
  if (p->o.kind < 3 && sight.near.distance > 0.0) {
    const num apart = exact_sub(distance_exactly(&p->o, left[p->degree]), exact(p->offset));
    const num computed = exact_sub(exact(best.upper), exact(best.slack));
    hold(upper, exact_double(exact_sub(apart, computed)), best.slack, "T4");
  }

  /* T2 */
  if (!isfinite(sight.support)) return;
  num3 *part = whole;
  if (s > 0.0 && s < 1.0 && rng_index(r, 2)) {
    curve_interval half[2];
    assert_true(curve_side_cut_piece(&c->side, &curve_convex_own(&node)->at, s, s, half));
    const size_t k = rng_index(r, 2);
    curve_convex_own(&node)->at = half[k];
    part = k ? right : left;
  }
  curve_convex_bound(c, &node, &sight);
  const num computed = exact_add(exact(node.lower), exact(node.slack));
  hold(lower, exact_double(exact_sub(computed, bound_exactly(p, part, exact3(sight.normal)))), node.slack, "T2");
}

/* Seed 3, four points of each curve. */
CASE(bounds_give_rounding_no_more_than_they_say) {
  rng r = rng_seed(3);
  cprox_workspace *ws = cprox_workspace_create();
  fraction lower = {0}, upper = {0};
  for (size_t i = 0; i < test_cases(CASES); i++) {
    problem p;
    problem_random(&p, &r, ws);
    for (int k = 0; k < SIGHTS; k++) {
      exact_reset();
      attack(&p, &r, &lower, &upper);
    }
    problem_free(&p);
  }
  cprox_workspace_free(ws);
  tell(&lower, "T2, lower bounds");
  tell(&upper, "T4, upper bounds");
}

/* ---- T6 ---- */

static num3 series(const vec3 *c, size_t degree, num t) {
  num3 sum = exact3(c[0]);
  for (size_t m = 1; m <= degree; m++) {
    const num angle = exact_mul(exact((double)m), t), cosine = exact_cos(angle), sine = exact_sin(angle);
    const num3 a = exact3(c[2 * m - 1]), b = exact3(c[2 * m]);
    for (int k = 0; k < 3; k++)
      sum.k[k] = exact_add(sum.k[k], exact_add(exact_mul(a.k[k], cosine), exact_mul(b.k[k], sine)));
  }
  return sum;
}

/* |psi - piece| at a point of the piece. */
static double off_at(const cprox_curve *curve, size_t piece, double s, const vec3 *c, size_t degree) {
  exact_reset();
  num3 p[6], left[6];
  for (size_t j = 0; j < 6; j++) p[j] = exact3(curve_piece(curve, piece)[j]);
  cut_exactly(p, left, 5, exact(s));
  const num t0 = exact(curve->breaks[piece]), t1 = exact(curve->breaks[piece + 1]);
  const num t = exact_add(t0, exact_mul(exact(s), exact_sub(t1, t0)));
  return exact_double(exact3_norm(exact3_sub(left[5], series(c, degree, t))));
}

/* Seed 4. Half of the points in the middle of a piece, where the remainder is largest. */
CASE(a_compiled_series_is_within_its_error) {
  rng r = rng_seed(4);
  fraction f = {0};
  cprox_workspace *ws = cprox_workspace_create();
  for (size_t i = 0; i < test_cases(CASES / 10); i++) {
    const size_t degree = 1 + rng_index(&r, 4);
    vec3 c[9];
    for (size_t j = 0; j <= 2 * degree; j++) c[j] = vec(rng_awkward(&r, 1), rng_awkward(&r, 1), rng_awkward(&r, 1));
    if (rng_index(&r, 2)) c[0] = vec(0, 0, 0);
    const double t0 = rng_uniform(&r, -10.0, 10.0);
    cprox_curve *curve = NULL;
    if (curve_from(describe_trigonometric(c, 2 * degree + 1, t0, t0 + rng_uniform(&r, 1e-3, 1.0)), ws, &curve) !=
        CPROX_OK)
      fail_msg("%s", cprox_workspace_error(ws));
    for (int k = 0; k < 4; k++) {
      const size_t piece = rng_index(&r, curve->n_pieces);
      hold(&f, off_at(curve, piece, k < 2 ? 0.5 : random_parameter(&r), c, degree), curve->error[piece], "T6");
    }
    cprox_curve_free(curve);
  }
  cprox_workspace_free(ws);
  tell(&f, "T6, compiled series");
}

static int free_numbers(void **state) {
  (void)state;
  exact_free();
  return 0;
}

int main(void) {
  return cases_run(NULL, free_numbers);
}
