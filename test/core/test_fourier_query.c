/* SPDX-License-Identifier: BSD-3-Clause */
/* What is asked of a gap: gradients, early exit, lanes, memory, symmetry, signals, cascades, regions, sweeps, curves.
 */
#include <stdlib.h>
#include <string.h>

#include "fourier/gap.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/make_curve.h"
#include "support/random.h"

#define MADE(call) assert_int_equal(call, CPROX_OK)

static const double L_SHAPE[6][2] = {{-0.5, -0.5}, {0.7, -0.5}, {0.7, -0.2}, {-0.1, -0.2}, {-0.1, 0.6}, {-0.5, 0.6}};

static cprox_gap *gap_of(const cprox_solid *a, const cprox_solid *b, cprox_gap_mode mode, uint32_t samples) {
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.mode = mode, o.samples = samples;
  cprox_gap *gap = NULL;
  if (cprox_gap_create(a, b, &o, ws, &gap) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  return gap;
}

static cprox_pose planar(double x, double y, double angle) {
  return (cprox_pose){.position = {x, y, 0}, .orientation = {cos(0.5 * angle), 0, 0, sin(0.5 * angle)}};
}

static cprox_pose random_pose(rng *r, int dimension, double half) {
  cprox_pose p = rng_pose(r, half);
  if (dimension == 2) p.orientation.x = p.orientation.y = p.position.z = 0.0;
  return p;
}

/* Pairs of every kind that may be turned, with centres off their origins. */
enum { PAIRS = 10 };
static void make_pair(int i, cprox_solid *out[2]) {
  const cprox_vec3 line[3] = {{-0.4, 0.1, 0}, {0.3, 0.2, 0.1}, {0.5, -0.4, 0}};
  cprox_solid *s[2];
  cprox_pose shift = planar(0.3, -0.2, 0.4);
  const double cut[1][4] = {{1, 0.2, 0, 0.3}};
  const int dimension = i < 4 ? 2 : 3;
  if (dimension == 2) {
    MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_POLYGON, .corners = L_SHAPE, .n = 6}, ws,
                            &s[0]));
    if (i == 0)
      MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_POLYGON, .corners = L_SHAPE, .n = 6}, ws,
                              &s[1]));
    if (i == 1)
      MADE(cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 2, .size = vec(0.9, 0.4, 0)}, ws, &s[1]));
    if (i == 2)
      MADE(cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_ELLIPSOID, .dimension = 2, .semi_axes = vec(0.7, 0.3, 0)}, ws,
          &s[1]));
    if (i == 3)
      MADE(cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_CLIPPED, .solid = s[0], .region = cut, .n = 1}, ws, &s[1]));
  } else {
    shift.position.z = 0.15;
    shift.orientation.x = 0.3;
    MADE(cprox_solid_create(
        &(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 3, .size = vec(0.9, 0.5, 0.7)}, ws, &s[0]));
    if (i == 4)
      MADE(cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 3, .size = vec(0.6, 0.8, 0.3)}, ws, &s[1]));
    if (i == 5)
      MADE(cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_ELLIPSOID, .dimension = 3, .semi_axes = vec(0.7, 0.3, 0.4)},
          ws, &s[1]));
    if (i == 6)
      MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = 3, .radius = 0.5}, ws,
                              &s[1]));
    if (i >= 7) {
      cprox_solid_free(s[0]);
      if (i == 7)
        MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_CYLINDER, .height = 0.8, .radius = 0.3},
                                ws, &s[0]));
      if (i == 8)
        MADE(cprox_solid_create(
            &(cprox_solid_description){.kind = CPROX_SOLID_CAPSULE, .dimension = 3, .height = 0.8, .radius = 0.3}, ws,
            &s[0]));
      if (i == 9) {
        cprox_solid *box;
        MADE(cprox_solid_create(
            &(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 3, .size = vec(0.9, 0.5, 0.7)}, ws, &box));
        MADE(cprox_solid_create(
            &(cprox_solid_description){.kind = CPROX_SOLID_CLIPPED, .solid = box, .region = cut, .n = 1}, ws, &s[0]));
        cprox_solid_free(box);
      }
      MADE(cprox_solid_create(
          &(cprox_solid_description){
              .kind = CPROX_SOLID_POLYLINE, .dimension = 3, .points = line, .n = 3, .radius = 0.2},
          ws, &s[1]));
      if (i == 9) {
        cprox_solid_free(s[1]);
        MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_UNION,
                                                           .parts = (const cprox_solid *const[]){s[0]},
                                                           .poses = (const cprox_pose[]){planar(0, 0, 1)},
                                                           .n = 1},
                                ws, &s[1]));
      }
    }
  }
  for (int k = 0; k < 2; k++) {
    MADE(cprox_solid_create(
        &(cprox_solid_description){
            .kind = CPROX_SOLID_UNION, .parts = (const cprox_solid *const[]){s[k]}, .poses = &shift, .n = 1},
        ws, &out[k]));
    cprox_solid_free(s[k]);
  }
}

/* Samples and cases that suit what turning the pair costs: polylines and meshes go one frequency after the other. */
static uint32_t samples_of(int pair, uint32_t plane) {
  return pair < 4 ? plane : pair < 8 ? 9 : 5;
}

static size_t cases_of(int pair, size_t plane) {
  return test_cases(pair < 4 ? plane : pair < 8 ? (plane + 9) / 10 : pair < 9 ? 2 : 1);
}

/* p exp(s [w]) of a pose, and its shift. */
static cprox_pose nudged(cprox_pose p, int axis, double s) {
  double *const position[3] = {&p.position.x, &p.position.y, &p.position.z};
  if (axis < 3) {
    *position[axis] += s;
    return p;
  }
  cprox_pose turn = {.orientation = {cos(0.5 * s), axis == 3 ? sin(0.5 * s) : 0, axis == 4 ? sin(0.5 * s) : 0,
                                     axis == 5 ? sin(0.5 * s) : 0}};
  return frame_compose(&p, &turn);
}

static double component(vec3 position, vec3 rotation, int axis) {
  const double v[6] = {position.x, position.y, position.z, rotation.x, rotation.y, rotation.z};
  return v[axis];
}

/* Seed 721, every pair, certified and signal: central differences of order 4, step 2e-3 of the size over N; tolerance
 * 1e-7 of max(|gradient|, 1e-3/rho) and, in the signal, 1e-7 of max(|gradient|, 1). Value and relative gradients too.
 */
CASE(gradients_agree_with_differences) {
  rng r = rng_seed(721);
  for (int i = 0; i < 2 * PAIRS; i++) {
    cprox_solid *s[2];
    make_pair(i / 2, s);
    const int dimension = s[0]->dimension;
    const cprox_gap_mode mode = i % 2 ? CPROX_GAP_MODE_SIGNAL : CPROX_GAP_MODE_CERTIFIED;
    cprox_gap *gap = gap_of(s[0], s[1], mode, samples_of(i / 2, 17));
    const cprox_gap_info info = cprox_gap_get_info(gap);
    const double h = 2e-3 * info.period / info.samples;
    for (size_t k = 0; k < cases_of(i / 2, 8); k++) {
      const cprox_pose p[2] = {random_pose(&r, dimension, 0.3), random_pose(&r, dimension, 0.3)};
      cprox_gap_result x, y;
      MADE(cprox_gap_evaluate(gap, &p[0], &p[1], ws, &x));
      if (x.verdict == CPROX_GAP_VERDICT_FAR) continue;
      double size = mode == CPROX_GAP_MODE_SIGNAL ? 1.0 : 1e-3 / info.offset;
      for (int axis = 0; axis < 6; axis++)
        size = fmax(size, fmax(fabs(component(x.position_a, x.rotation_a, axis)),
                               fabs(component(x.position_b, x.rotation_b, axis))));
      for (int body = 0; body < 2; body++)
        for (int axis = 0; axis < 6; axis++) {
          if (dimension == 2 && axis > 1 && axis < 5) continue;
          const double step[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};
          double slope = 0.0;
          for (int j = 0; j < 4; j++) {
            cprox_pose q[2] = {p[0], p[1]};
            q[body] = nudged(p[body], axis, step[j] * h);
            if (dimension == 2) q[body].orientation.x = q[body].orientation.y = 0.0;
            MADE(cprox_gap_evaluate(gap, &q[0], &q[1], ws, &y));
            slope += weight[j] * y.value / (12 * h);
          }
          const double got =
              body ? component(x.position_b, x.rotation_b, axis) : component(x.position_a, x.rotation_a, axis);
          if (!(fabs(got - slope) <= 1e-7 * size))
            fail_msg("pair %d, body %d, axis %d: %.12g, differences %.12g (size %g)", i, body, axis, got, slope, size);
        }
      /* the relative ones, from those of the second body */
      const frame f = frame_create(&p[0], vec(0, 0, 0));
      assert_true(vec_norm(vec_sub(x.position, frame_turn_to_local(&f, x.position_b))) <= 1e-14 * size);
      assert_true(vec_equal(x.rotation, x.rotation_b));
    }
    cprox_gap_free(gap);
    cprox_solid_free(s[0]);
    cprox_solid_free(s[1]);
  }
}

/* Seed 722, every pair, both modes with verdicts: the early exit says what the whole sum says, within its own error,
 * and often with fewer terms. All lane widths of this machine agree to the last bit. */
CASE(early_exit_and_lanes_change_no_verdict) {
  rng r = rng_seed(722);
  size_t fewer = 0, all = 0;
  for (int i = 0; i < 2 * PAIRS; i++) {
    cprox_solid *s[2];
    make_pair(i / 2, s);
    const int dimension = s[0]->dimension;
    cprox_gap *gap = gap_of(s[0], s[1], i % 2 ? CPROX_GAP_MODE_TUNED : CPROX_GAP_MODE_CERTIFIED, samples_of(i / 2, 33));
    const simd_level widest = gap->simd;
    for (size_t k = 0; k < cases_of(i / 2, 200); k++) {
      const cprox_pose p[2] = {random_pose(&r, dimension, 0.9), random_pose(&r, dimension, 0.9)};
      cprox_gap_result fast, full, other;
      MADE(cprox_gap_test(gap, &p[0], &p[1], ws, &fast));
      MADE(cprox_gap_evaluate(gap, &p[0], &p[1], ws, &full));
      if (fast.verdict == CPROX_GAP_VERDICT_FAR && full.verdict != CPROX_GAP_VERDICT_FAR) continue; /* by directions */
      if (fast.verdict != full.verdict)
        fail_msg("pair %d: %s, the sum says %s, V/t %.15g", i, cprox_gap_verdict_name(fast.verdict),
                 cprox_gap_verdict_name(full.verdict), full.value);
      assert_true(fabs(fast.value - full.value) <= fast.error + full.error || full.verdict == CPROX_GAP_VERDICT_FAR);
      fewer += fast.terms < full.terms;
      all += full.terms > 0;
      for (simd_level w = SIMD_BASE; w < widest; w++) {
        gap->simd = w;
        MADE(cprox_gap_evaluate(gap, &p[0], &p[1], ws, &other));
        assert_memory_equal(&other, &full, sizeof full);
        gap->simd = widest;
      }
    }
    cprox_gap_free(gap);
    cprox_solid_free(s[0]);
    cprox_solid_free(s[1]);
  }
  print_message("early exit in %zu of %zu\n", fewer, all);
  assert_true(fewer > all / 2);
}

/* The stated rounding covers the difference between the two roles' sums of equal balls, where both lattices see the
 * same, and moving the world: seed 723. */
CASE(values_do_not_depend_on_where_the_world_is) {
  rng r = rng_seed(723);
  for (int i = 0; i < PAIRS; i++) {
    cprox_solid *s[2];
    make_pair(i, s);
    const int dimension = s[0]->dimension;
    cprox_gap *gap = gap_of(s[0], s[1], CPROX_GAP_MODE_CERTIFIED, samples_of(i, 33));
    for (size_t k = 0; k < cases_of(i, 20); k++) {
      const cprox_pose p[2] = {random_pose(&r, dimension, 0.2), random_pose(&r, dimension, 0.2)},
                       world = random_pose(&r, dimension, 1.0);
      const cprox_pose q[2] = {frame_compose(&world, &p[0]), frame_compose(&world, &p[1])};
      cprox_gap_result x, y;
      MADE(cprox_gap_evaluate(gap, &p[0], &p[1], ws, &x));
      MADE(cprox_gap_evaluate(gap, &q[0], &q[1], ws, &y));
      /* poses round by 1e-15 of a few metres */
      assert_true(fabs(x.value - y.value) <= x.error + y.error + 1e-14 * gap->steepness);
    }
    cprox_gap_free(gap);
    cprox_solid_free(s[0]);
    cprox_solid_free(s[1]);
  }
}

CASE(queries_do_not_allocate_once_warm) {
  cprox_solid *s[2];
  make_pair(0, s);
  cprox_gap *gap = gap_of(s[0], s[1], CPROX_GAP_MODE_CERTIFIED, 33);
  const cprox_pose a = planar(0, 0, 0), b = planar(0.5, 0.4, 1);
  cprox_gap_result r;
  MADE(cprox_gap_evaluate(gap, &a, &b, ws, &r));
  const size_t before = allocations_made();
  MADE(cprox_gap_evaluate(gap, &a, &b, ws, &r));
  MADE(cprox_gap_test(gap, &a, &b, ws, &r));
  assert_int_equal(allocations_made(), before);
  cprox_gap_free(gap);
  cprox_solid_free(s[0]);
  cprox_solid_free(s[1]);
}

/* Squares at one place: nowhere is down. The gradient is 0 within rounding, and says nothing of the way out. */
CASE(perfect_symmetry_has_no_gradient) {
  cprox_solid *s;
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 2, .size = vec(1, 1, 0)}, ws,
                          &s));
  cprox_gap *gap = gap_of(s, s, CPROX_GAP_MODE_CERTIFIED, 17);
  const cprox_pose p = planar(3, 4, 0.7);
  cprox_gap_result r;
  MADE(cprox_gap_evaluate(gap, &p, &p, ws, &r));
  assert_true(vec_norm(r.position_b) < 1e-10 && vec_norm(r.rotation_b) < 1e-10);
  assert_true(r.verdict == CPROX_GAP_VERDICT_COLLIDE && r.value > 5.0);
  cprox_gap_free(gap);
  cprox_solid_free(s);
}

/* The slope of the value to one side, of order 4. */
static double one_sided_slope(const cprox_gap *gap, const cprox_pose *a, const cprox_pose *b, int axis, double h) {
  static const double WEIGHT[5] = {-25.0, 48.0, -36.0, 16.0, -3.0};
  double slope = 0.0;
  for (int j = 0; j < 5; j++) {
    cprox_pose q = nudged(*b, axis, j * h);
    cprox_gap_result y;
    MADE(cprox_gap_evaluate(gap, a, &q, ws, &y));
    slope += WEIGHT[j] * y.value / (12.0 * h);
  }
  return slope;
}

/* Where a distance has a kink, a gap has none: it is an integral, a sum of waves in every mode. Boxes face on face,
 * nearly corner on corner, corner on face, at one place, and a ball midway between two: the slopes to both sides are
 * the gradient, within 1e-6 of the largest. */
CASE(ties_of_nearest_points_are_no_kinks) {
  size_t sloping = 0;
  for (int dimension = 2; dimension <= 3; dimension++) {
    cprox_solid *box, *ball, *balls;
    MADE(cprox_solid_create(
        &(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = dimension, .size = vec(1, 1, 1)}, ws, &box));
    MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = dimension, .radius = 0.3},
                            ws, &ball));
    const cprox_pose left = planar(-0.6, 0, 0), right = planar(0.6, 0, 0);
    MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_UNION,
                                                       .parts = (const cprox_solid *const[]){ball, ball},
                                                       .poses = (const cprox_pose[]){left, right},
                                                       .n = 2},
                            ws, &balls));
    const cprox_pose placed[] = {planar(1, 0, 0),
                                 planar(0.9, 0, 0),
                                 planar(0.98, 0.98, 0),
                                 planar(0.95, 0.95, 0),
                                 planar(1.2, 0, 0.7853981633974483),
                                 planar(0, 0, 0)};
    const size_t n = sizeof placed / sizeof *placed;
    for (int mode = CPROX_GAP_MODE_CERTIFIED; mode <= CPROX_GAP_MODE_SIGNAL; mode++)
      for (size_t k = 0; k <= n; k++) {
        cprox_gap *gap =
            k < n ? gap_of(box, box, (cprox_gap_mode)mode, 9) : gap_of(balls, ball, (cprox_gap_mode)mode, 9);
        const cprox_gap_info info = cprox_gap_get_info(gap);
        const cprox_pose a = planar(0, 0, 0), b = k < n ? placed[k] : planar(0, 0.05, 0);
        const double h = 2e-3 * info.period / info.samples;
        cprox_gap_result x;
        MADE(cprox_gap_evaluate(gap, &a, &b, ws, &x));
        assert_true(x.verdict != CPROX_GAP_VERDICT_FAR);
        const double size = fmax(fmax(vec_norm(x.position_b), vec_norm(x.rotation_b)), fmax(1.0, fabs(x.value)));
        for (int axis = 0; axis < 6; axis++) {
          if (dimension == 2 && axis > 1 && axis < 5) continue;
          const double got = component(x.position_b, x.rotation_b, axis);
          const double ahead = one_sided_slope(gap, &a, &b, axis, h), behind = one_sided_slope(gap, &a, &b, axis, -h);
          if (!(fabs(got - ahead) <= 1e-6 * size && fabs(got - behind) <= 1e-6 * size))
            fail_msg("dimension %d, mode %d, place %zu, axis %d: %.12g, to the sides %.12g and %.12g", dimension, mode,
                     k, axis, got, behind, ahead);
          sloping += fabs(got) > 0.1;
        }
        cprox_gap_free(gap);
      }
    cprox_solid_free(box);
    cprox_solid_free(ball);
    cprox_solid_free(balls);
  }
  assert_true(sloping > 30);
}

/* At touch V/t is far larger face to face than corner to corner: a value is no distance. */
CASE(level_sets_are_not_equidistant) {
  cprox_solid *s;
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 2, .size = vec(1, 1, 0)}, ws,
                          &s));
  cprox_gap *gap = gap_of(s, s, CPROX_GAP_MODE_CERTIFIED, 65);
  const cprox_pose a = planar(0, 0, 0), face = planar(1, 0, 0), corner = planar(1, 1, 0);
  cprox_gap_result x, y;
  MADE(cprox_gap_evaluate(gap, &a, &face, ws, &x));
  MADE(cprox_gap_evaluate(gap, &a, &corner, ws, &y));
  assert_true(y.value >= 1.0 && x.value > 4.0 * y.value);
  cprox_gap_free(gap);
  cprox_solid_free(s);
}

/* c grows all the way out of a deep overlap to the edge of the bounding spheres, and its gradient leads there. */
CASE(the_signal_rises_with_clearance) {
  cprox_solid *s;
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_POLYGON, .corners = L_SHAPE, .n = 6}, ws, &s));
  cprox_gap *gap = gap_of(s, s, CPROX_GAP_MODE_SIGNAL, 33);
  const cprox_pose a = planar(0, 0, 0);
  double last = -INFINITY;
  for (double x = 0.1; x < 1.9 * s->radius; x += 0.05) {
    const cprox_pose b = planar(0.8 * x, 0.6 * x, 2);
    cprox_gap_result r;
    MADE(cprox_gap_evaluate(gap, &a, &b, ws, &r));
    assert_int_equal(r.verdict, CPROX_GAP_VERDICT_UNDECIDED);
    if (r.clearance > 0) break;
    assert_true(r.value > last);
    assert_true(x < 0.3 || 0.8 * r.position_b.x + 0.6 * r.position_b.y > 0);
    last = r.value;
  }
  cprox_gap_free(gap);
  cprox_solid_free(s);
}

/* An L of two boxes, or a box: as bodies with their poses, and as a solid. */
typedef struct blocks {
  int n;
  cprox_body *part[2];
  cprox_pose at[2];
  cprox_solid *solid;
} blocks;

static blocks make_blocks(int dimension, int n, rng *r) {
  blocks out = {.n = n};
  cprox_solid *parts[2];
  for (int i = 0; i < n; i++) {
    const cprox_vec3 size = i == 0 ? vec(rng_uniform(r, 0.5, 1.2), rng_uniform(r, 0.2, 0.4), rng_uniform(r, 0.2, 0.9))
                                   : vec(rng_uniform(r, 0.2, 0.4), rng_uniform(r, 0.4, 1.2), rng_uniform(r, 0.2, 0.6));
    out.at[i] = planar(i * 0.3, i * 0.5, 0);
    const cprox_vec3 tall = {size.x, size.y, dimension == 2 ? 20.0 : size.z}; /* never left along z in the plane */
    MADE(cprox_body_create_box(tall, ws, &out.part[i]));
    MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = dimension, .size = size},
                            ws, &parts[i]));
  }
  MADE(cprox_solid_create(
      &(cprox_solid_description){
          .kind = CPROX_SOLID_UNION, .parts = (const cprox_solid *const *)parts, .poses = out.at, .n = (size_t)n},
      ws, &out.solid));
  for (int i = 0; i < n; i++) cprox_solid_free(parts[i]);
  return out;
}

static void free_blocks(blocks *b) {
  for (int i = 0; i < b->n; i++) cprox_body_free(b->part[i]);
  cprox_solid_free(b->solid);
}

/* Signed, of a at the origin and b at the pose: parts are shifted only, never turned. */
static double exact_distance(const blocks *a, const blocks *b, const cprox_pose *pose) {
  double least = INFINITY;
  for (int i = 0; i < a->n; i++)
    for (int j = 0; j < b->n; j++) {
      const frame f = frame_create(pose, b->at[j].position);
      const cprox_pose at = {.position = f.position, .orientation = pose->orientation};
      cprox_result r;
      if (cprox_pair(cprox_obstacle_at(a->part[i], a->at[i]), cprox_obstacle_at(b->part[j], at), NULL, ws, &r) < 0)
        fail_msg("%s", cprox_workspace_error(ws));
      least = fmin(least, 0.5 * (r.lower + r.upper));
    }
  return least;
}

static int by_size(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* From far away towards a random place, to where the level is met. */
static cprox_pose fall(const blocks *a, const blocks *b, const cprox_gap *gap, cprox_pose pose, rng *r, int dimension) {
  const cprox_pose here = planar(0, 0, 0);
  vec3 way = rng_unit(r);
  if (dimension == 2) way.z = 0.0, way = vec_scale(1.0 / vec_norm(way), way);
  const vec3 aim = pose.position;
  double far = 6.0, near = 0.0;
  for (int i = 0; i < 60; i++) {
    const double at = 0.5 * (far + near);
    pose.position = vec_add(aim, vec_scale(at, way));
    cprox_gap_result got = {.value = 0.0};
    if (gap) MADE(cprox_gap_evaluate(gap, &here, &pose, ws, &got));
    const bool free = gap ? got.value < 1.0 : exact_distance(a, b, &pose) > 0.0;
    *(free ? &far : &near) = at;
  }
  pose.position = vec_add(aim, vec_scale(far, way));
  return pose;
}

/* Where solids touch c lies between the bounds; below the lower one they overlap, above the upper one they are apart. */
CASE(the_signal_of_solids_that_touch_lies_between_its_bounds) {
  rng r = rng_seed(811);
  const uint32_t samples[] = {5, 9, 17, 33, 65};
  size_t proven_deep = 0, touched = 0;
  for (size_t i = 0; i < test_cases(24); i++) {
    const int dimension = i % 2 ? 2 : 3;
    blocks a = make_blocks(dimension, 1 + (int)rng_index(&r, 2), &r), b = make_blocks(dimension, 1, &r);
    cprox_gap *gap = gap_of(a.solid, b.solid, CPROX_GAP_MODE_SIGNAL,
                            dimension == 2 ? samples[rng_index(&r, 5)] : samples[rng_index(&r, 4)]);
    const cprox_gap_info info = cprox_gap_get_info(gap);
    assert_true(info.touching_least < info.touching_most && isfinite(info.touching_least));
    const cprox_pose here = planar(0, 0, 0);
    for (int j = 0; j < 40; j++) {
      cprox_pose pose = random_pose(&r, dimension, j % 2 ? 0.8 : 0.2);
      cprox_gap_result got;
      cprox_status status = cprox_gap_evaluate(gap, &here, &pose, ws, &got);
      if (status == CPROX_OK && isfinite(got.value)) {
        const double distance = exact_distance(&a, &b, &pose);
        if (got.value < info.touching_least) proven_deep++, assert_true(distance < 1e-9);
        if (got.value > info.touching_most) assert_true(distance > -1e-9);
      }
      pose = fall(&a, &b, NULL, pose, &r, dimension);
      if (fabs(exact_distance(&a, &b, &pose)) > 1e-9) continue; /* it passed by */
      MADE(cprox_gap_evaluate(gap, &here, &pose, ws, &got));
      touched++;
      if (!(got.value >= info.touching_least && got.value <= info.touching_most))
        fail_msg("case %zu, n = %u: %g is not in [%g, %g]", i, info.samples, got.value, info.touching_least,
                 info.touching_most);
    }
    cprox_gap_free(gap);
    free_blocks(&a), free_blocks(&b);
  }
  assert_true(touched > test_cases(24) * 10 && proven_deep > test_cases(24) / 4);
}

/* A box that fills a hole on all sides: wherever it moves it overlaps, so V is near the most that touching allows. */
CASE(a_snug_box_is_not_proven_to_overlap) {
  cprox_solid *side, *cap, *box, *hole;
  const cprox_vec3 sizes[3] = {vec(0.4, 1.8, 0), vec(0.96, 0.4, 0), vec(1, 1, 0)};
  cprox_solid **const made[3] = {&side, &cap, &box};
  for (int i = 0; i < 3; i++)
    MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 2, .size = sizes[i]}, ws,
                            made[i]));
  const cprox_solid *const walls[4] = {side, side, cap, cap};
  const cprox_pose at[4] = {planar(-0.7, 0, 0), planar(0.7, 0, 0), planar(0, -0.7, 0), planar(0, 0.7, 0)};
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_UNION, .parts = walls, .poses = at, .n = 4},
                          ws, &hole));
  const cprox_pose here = planar(0, 0, 0);
  for (uint32_t n = 65; n <= 257; n = 2 * n - 1) {
    cprox_gap *gap = gap_of(hole, box, CPROX_GAP_MODE_SIGNAL, n);
    const double least = cprox_gap_get_info(gap).touching_least;
    cprox_gap_result got;
    MADE(cprox_gap_evaluate(gap, &here, &here, ws, &got));
    if (!(got.value >= least && got.value <= least + 0.5)) fail_msg("n = %u: %g, least %g", n, got.value, least);
    cprox_gap_free(gap);
  }
  cprox_solid_free(side), cprox_solid_free(cap), cprox_solid_free(box), cprox_solid_free(hole);
}

/* Of the signal where solids touch, of the certified gap where V/t = 1. */
CASE(the_logarithm_times_the_length_has_a_slope_near_one) {
  for (int mode = CPROX_GAP_MODE_CERTIFIED; mode <= CPROX_GAP_MODE_SIGNAL; mode += 2)
    for (int dimension = 2; dimension <= 3; dimension++)
      for (uint32_t n = 9; n <= 33; n = 2 * n - 1) {
        rng r = rng_seed(813);
        double slopes[400];
        size_t count = 0;
        for (size_t i = 0; i < 10; i++) {
          blocks a = make_blocks(dimension, 1 + (int)rng_index(&r, 2), &r), b = make_blocks(dimension, 1, &r);
          cprox_gap *gap = gap_of(a.solid, b.solid, (cprox_gap_mode)mode, n);
          const cprox_gap_info info = cprox_gap_get_info(gap);
          const cprox_pose here = planar(0, 0, 0);
          for (int j = 0; j < 10; j++) {
            const bool signal = mode == CPROX_GAP_MODE_SIGNAL;
            const cprox_pose pose = fall(&a, &b, signal ? NULL : gap, random_pose(&r, dimension, 0.4), &r, dimension);
            cprox_gap_result got;
            MADE(cprox_gap_evaluate(gap, &here, &pose, ws, &got));
            if (got.verdict == CPROX_GAP_VERDICT_FAR || (!signal && fabs(got.value - 1.0) > 1e-6)) continue;
            slopes[count++] = info.length * vec_norm(got.position_b) / (signal ? 1.0 : got.value);
          }
          cprox_gap_free(gap);
          free_blocks(&a), free_blocks(&b);
        }
        qsort(slopes, count, sizeof *slopes, by_size);
        if (mode == CPROX_GAP_MODE_CERTIFIED && n == 9) continue; /* nearly all poses inside the balls may collide */
        assert_true(count > 5);
        const double least = slopes[count / 10], middle = slopes[count / 2], most = slopes[9 * count / 10];
        /* the signal's blur at n = 9 is as wide as the boxes: it is flatter there */
        if (!(middle > (n == 9 ? 0.45 : 0.75) && middle < 1.25 && least > (n == 9 ? 0.3 : 0.6) && most < 1.5))
          fail_msg("mode %d, dimension %d, n = %u: %g, %g, %g", mode, dimension, n, least, middle, most);
      }
}

CASE(bad_queries_are_refused_in_words) {
  cprox_solid *s[2], *space;
  make_pair(1, s);
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = 3, .radius = 1}, ws,
                          &space));
  cprox_gap *gap = gap_of(s[0], s[1], CPROX_GAP_MODE_CERTIFIED, 9), *none = NULL;
  cprox_gap_result r = {.value = 77};
  cprox_pose good = planar(0, 0, 0), bad = good;
  bad.position.x = NAN;
  assert_int_equal(cprox_gap_test(gap, &bad, &good, ws, &r), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "pose_a: the position is not finite");
  bad = good, bad.orientation.w = 0;
  assert_int_equal(cprox_gap_evaluate(gap, &good, &bad, ws, &r), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "pose_b: the quaternion's norm is 0");
  bad = good, bad.orientation.x = 0.1;
  assert_int_equal(cprox_gap_test(gap, &good, &bad, ws, &r), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "pose_b: a planar pose turns about z only");
  assert_true(r.value == 77);
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.samples = 9;
  assert_int_equal(cprox_gap_create(s[0], space, &o, ws, &none), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "the solids have dimensions 2 and 3");
  assert_null(none);
  cprox_gap_free(gap);
  cprox_solid_free(s[0]);
  cprox_solid_free(s[1]);
  cprox_solid_free(space);
}

/* Seed 724: a cascade says clear only where a level proves it, says clear wherever its finest does, and mostly stops
 * early. */
CASE(a_cascade_stops_at_the_first_proof) {
  rng r = rng_seed(724);
  cprox_solid *s[2];
  make_pair(0, s);
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.delta = 0.25;
  cprox_gap_cascade *cascade;
  MADE(cprox_gap_cascade_create(s[0], s[1], &o, ws, &cascade));
  const cprox_gap *finest = cprox_gap_cascade_finest(cascade);
  assert_true(cprox_gap_get_info(finest).over_reach <= 0.25);
  for (size_t i = 0; i < test_cases(500); i++) {
    const cprox_pose p[2] = {random_pose(&r, 2, 0.9), random_pose(&r, 2, 0.9)};
    cprox_gap_result x, y;
    MADE(cprox_gap_cascade_test(cascade, &p[0], &p[1], ws, &x));
    MADE(cprox_gap_test(finest, &p[0], &p[1], ws, &y));
    if (y.verdict == CPROX_GAP_VERDICT_COLLIDE)
      assert_true(x.verdict == CPROX_GAP_VERDICT_COLLIDE || x.verdict == CPROX_GAP_VERDICT_CLEAR);
    if (y.verdict == CPROX_GAP_VERDICT_CLEAR) assert_true(x.verdict == CPROX_GAP_VERDICT_CLEAR);
    if (y.verdict == CPROX_GAP_VERDICT_FAR) assert_true(x.verdict == CPROX_GAP_VERDICT_FAR);
  }
  o.mode = CPROX_GAP_MODE_TUNED;
  cprox_gap_cascade *none = NULL;
  assert_int_equal(cprox_gap_cascade_create(s[0], s[1], &o, ws, &none), CPROX_INVALID);
  cprox_gap_cascade_free(cascade);
  cprox_solid_free(s[0]);
  cprox_solid_free(s[1]);
}

/* Theorem 2: overlap outside the region does not count, overlap inside does. */
CASE(a_region_localises_the_test) {
  cprox_solid *bar, *ball, *right;
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 2, .size = vec(4, 0.4, 0)},
                          ws, &bar));
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = 2, .radius = 0.3}, ws,
                          &ball));
  const double region[1][4] = {{-2, 0, 0, -1}}; /* x >= 0.5 */
  MADE(cprox_solid_create(
      &(cprox_solid_description){.kind = CPROX_SOLID_CLIPPED, .solid = bar, .region = region, .n = 1}, ws, &right));
  assert_true(fabs(cprox_solid_get_info(right).measure - 1.5 * 0.4) < 1e-14);
  cprox_gap *whole = gap_of(bar, ball, CPROX_GAP_MODE_CERTIFIED, 33),
            *local = gap_of(right, ball, CPROX_GAP_MODE_CERTIFIED, 33);
  const cprox_pose here = planar(0, 0, 0), left = planar(-1.5, 0, 0), inside = planar(1.2, 0.1, 0);
  cprox_gap_result r;
  MADE(cprox_gap_test(whole, &here, &left, ws, &r));
  assert_int_equal(r.verdict, CPROX_GAP_VERDICT_COLLIDE);
  MADE(cprox_gap_test(local, &here, &left, ws, &r));
  assert_true(r.verdict == CPROX_GAP_VERDICT_CLEAR || r.verdict == CPROX_GAP_VERDICT_FAR);
  MADE(cprox_gap_test(local, &here, &inside, ws, &r));
  assert_int_equal(r.verdict, CPROX_GAP_VERDICT_COLLIDE);
  cprox_gap_free(whole);
  cprox_gap_free(local);
  cprox_solid_free(bar);
  cprox_solid_free(ball);
  cprox_solid_free(right);
}

static cprox_curve *wave_curve(void) {
  const cprox_vec3 p[5] = {{-1, 0, 0}, {-0.5, 1.2, 0}, {0, -1.5, 0}, {0.6, 1.4, 0}, {1, 0, 0}};
  cprox_curve *c;
  MADE(curve_from(describe_bezier(p, 5, 0, 1), ws, &c));
  return c;
}

/* The distance between a box |x| <= h and the curve moved by a pose, by samples: an upper bound that is 1e-4 off at
 * most. */
static double box_to_curve(const cprox_curve *c, const cprox_pose *box, const cprox_pose *curve, double hx, double hy) {
  const frame f = frame_create(box, vec(0, 0, 0)), g = frame_create(curve, vec(0, 0, 0));
  double best = INFINITY, error = 0;
  for (int i = 0; i <= 20000; i++) {
    vec3 x;
    MADE(cprox_curve_evaluate(c, i / 20000.0, ws, &x, NULL, NULL));
    const vec3 y = frame_to_local(&f, frame_to_world(&g, x), &error);
    best = fmin(best, hypot(fmax(0, fabs(y.x) - hx), fmax(0, fabs(y.y) - hy)));
  }
  return best;
}

/* Seed 725: a sphere swept along a curve against a box, one sum. Wherever the sphere overlaps the box (by more than the
 * samples' own 1e-3) the verdict is not clear, wherever the distance exceeds the over-reach it is; the threshold of a
 * plain pair would have been too high. */
CASE(a_sweep_is_never_called_clear_where_it_hits) {
  rng r = rng_seed(725);
  const double radius = 0.05;
  cprox_curve *c = wave_curve();
  cprox_solid *sweep, *box;
  MADE(cprox_solid_create(
      &(cprox_solid_description){
          .kind = CPROX_SOLID_SWEEP, .dimension = 2, .curve = c, .radius = radius, .tolerance = 1e-3},
      ws, &sweep));
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 2, .size = vec(0.5, 0.3, 0)},
                          ws, &box));
  cprox_gap *gap = gap_of(sweep, box, CPROX_GAP_MODE_CERTIFIED, 65);
  const cprox_gap_info info = cprox_gap_get_info(gap);
  assert_true(info.guaranteed && info.over_reach < 1.0);
  size_t hits = 0, clears = 0;
  for (size_t i = 0; i < test_cases(300); i++) {
    const cprox_pose p = random_pose(&r, 2, 0.3), q = random_pose(&r, 2, 1.0);
    const double d = box_to_curve(c, &q, &p, 0.25, 0.15) - radius;
    cprox_gap_result x;
    MADE(cprox_gap_test(gap, &p, &q, ws, &x));
    const bool clear = x.verdict == CPROX_GAP_VERDICT_CLEAR || x.verdict == CPROX_GAP_VERDICT_FAR;
    hits += d < -1e-3, clears += clear;
    if (clear && d < -1e-3) fail_msg("clear at an overlap of %g, value %g", -d, x.value);
    if (!clear && !(d <= info.over_reach)) fail_msg("called colliding %g apart, over-reach %g", d, info.over_reach);
  }
  assert_true(hits > test_cases(20) / 4 && clears > test_cases(20) / 4);
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.samples = 9;
  cprox_gap *none = NULL;
  assert_int_equal(cprox_gap_create(sweep, sweep, &o, ws, &none), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "both solids are sweeps: at most one may be");
  cprox_gap_free(gap);
  cprox_solid_free(sweep);
  cprox_solid_free(box);
  cprox_curve_free(c);
}

/* Seed 726: the derivative along t by differences of order 4; the verdict over an interval against 2000 tests inside
 * it: clear only if all are, and the value never above 1. */
CASE(along_a_curve_the_verdict_holds_at_every_parameter) {
  rng r = rng_seed(726);
  cprox_curve *c = wave_curve();
  cprox_solid *s[2];
  make_pair(0, s);
  cprox_gap *gap = gap_of(s[0], s[1], CPROX_GAP_MODE_CERTIFIED, 33);
  size_t clear = 0, hit = 0;
  for (size_t i = 0; i < test_cases(60); i++) {
    const cprox_pose a = random_pose(&r, 2, 1.8);
    const cprox_quat q = random_pose(&r, 2, 1).orientation;
    const double t0 = rng_uniform(&r, 0, 0.9), t1 = rng_uniform(&r, t0, 1);
    cprox_gap_along_result v;
    MADE(cprox_gap_along_test(gap, &a, &(cprox_gap_carried){.curve = c, .orientation = q}, t0, t1, 100000, ws, &v));
    clear += v.verdict == CPROX_GAP_VERDICT_CLEAR, hit += v.verdict == CPROX_GAP_VERDICT_COLLIDE;
    assert_true(v.t >= t0 && v.t <= t1);
    cprox_gap_result x;
    MADE(cprox_gap_along(gap, &a, &(cprox_gap_carried){.curve = c, .orientation = q}, v.t, ws, &x, NULL));
    if (v.verdict == CPROX_GAP_VERDICT_COLLIDE) assert_int_equal(x.verdict, CPROX_GAP_VERDICT_COLLIDE);
    for (int k = 0; v.verdict == CPROX_GAP_VERDICT_CLEAR && k <= 200; k++) {
      cprox_pose b = {.orientation = q};
      MADE(cprox_curve_evaluate(c, t0 + (t1 - t0) * k / 200, ws, &b.position, NULL, NULL));
      MADE(cprox_gap_test(gap, &a, &b, ws, &x));
      assert_true(x.verdict == CPROX_GAP_VERDICT_CLEAR || x.verdict == CPROX_GAP_VERDICT_FAR);
    }
    const double t = rng_uniform(&r, 0.1, 0.9), h = 1e-4, step[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};
    double slope = 0, derivative;
    bool far = false;
    for (int k = 0; k < 4; k++) {
      MADE(cprox_gap_along(gap, &a, &(cprox_gap_carried){.curve = c, .orientation = q}, t + step[k] * h, ws, &x, NULL));
      slope += weight[k] * x.value / (12 * h);
      far = far || x.verdict == CPROX_GAP_VERDICT_FAR;
    }
    MADE(cprox_gap_along(gap, &a, &(cprox_gap_carried){.curve = c, .orientation = q}, t, ws, &x, &derivative));
    if (!far) assert_true(fabs(slope - derivative) <= 1e-7 * fmax(fabs(derivative), 1.0));
  }
  print_message("%zu clear, %zu hit\n", clear, hit);
  assert_true(clear > 0 && hit > 0);

  /* too few nodes: undecided, and the reason says how far it is clear */
  const cprox_pose near = planar(0, 1.9, 0);
  const cprox_quat q = {1, 0, 0, 0};
  cprox_gap_along_result v;
  assert_int_equal(
      cprox_gap_along_test(gap, &near, &(cprox_gap_carried){.curve = c, .orientation = q}, 0, 1, 1, ws, &v),
      CPROX_BUDGET);
  assert_int_equal(v.verdict, CPROX_GAP_VERDICT_UNDECIDED);
  assert_int_equal(
      cprox_gap_along_test(gap, &near, &(cprox_gap_carried){.curve = c, .orientation = q}, 0, 2, 1, ws, &v),
      CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "the interval [0, 2] must lie within [0, 1]");
  cprox_gap_free(gap);
  cprox_solid_free(s[0]);
  cprox_solid_free(s[1]);
  cprox_curve_free(c);
}

/* p after q. */
static cprox_quat quat_times(cprox_quat p, cprox_quat q) {
  return (cprox_quat){p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z, p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
                      p.w * q.y + p.y * q.w + p.z * q.x - p.x * q.z, p.w * q.z + p.z * q.w + p.x * q.y - p.y * q.x};
}

/* The rotation by a vector as 2^20 small ones: within 1e-12 for each cube of its length. */
static cprox_quat small_turns(vec3 by) {
  const double step = 0.5 / (1 << 20);
  cprox_quat q = {1.0, step * by.x, step * by.y, step * by.z};
  for (int i = 0; i < 20; i++) q = quat_times(q, q);
  return q;
}

static cprox_pose pose_on_way(const cprox_gap_carried *carried, double t, int dimension) {
  cprox_pose b;
  vec3 by;
  MADE(cprox_curve_evaluate(carried->curve, t, ws, &b.position, NULL, NULL));
  MADE(cprox_curve_evaluate(carried->turning, t, ws, &by, NULL, NULL));
  b.orientation = quat_times(small_turns(by), carried->orientation);
  if (dimension == 2) b.orientation.x = b.orientation.y = 0.0;
  return b;
}

static cprox_curve *random_spline(rng *r, size_t degree, double half, bool planar_way, bool planar_turn) {
  const double knots[2][9] = {{0, 0, 0, 0.6, 1, 1, 1}, {0, 0, 0, 0, 0.3, 1, 1, 1, 1}};
  cprox_vec3 p[5];
  for (size_t i = 0; i < degree + 2; i++) {
    p[i] = rng_in_cube(r, half);
    if (planar_way) p[i].z = 0.0;
    if (planar_turn) p[i].x = p[i].y = 0.0;
  }
  cprox_curve *c;
  MADE(curve_from(describe_bspline(p, degree + 2, degree, knots[degree - 2], degree == 2 ? 7 : 9, 0, 1), ws, &c));
  return c;
}

/* Seed 727: a solid that turns on its way, in either role, off its origin: places and values by small turns,
 * derivatives by differences of order 4, and clear over an interval only if 300 tests inside it are. The pieces of the
 * way and of the turning end elsewhere. */
CASE(along_a_pose_spline_the_verdict_holds_at_every_parameter) {
  rng r = rng_seed(727);
  const int pairs[6] = {0, 1, 2, 4, 5, 6};
  size_t clear = 0, hit = 0, nodes = 0, turned_first = 0;
  for (size_t i = 0; i < test_cases(48); i++) {
    const int dimension = pairs[i % 6] < 4 ? 2 : 3;
    cprox_solid *s[2];
    make_pair(pairs[i % 6], s);
    const bool swap = i / 6 % 2;
    cprox_gap *gap = gap_of(s[swap], s[!swap], CPROX_GAP_MODE_CERTIFIED, dimension == 2 ? 33 : 17);
    turned_first += cprox_gap_get_info(gap).turned_first;
    cprox_curve *way = random_spline(&r, 3, 0.6, dimension == 2, false);
    cprox_curve *turning = random_spline(&r, 2, 1.5, false, dimension == 2);
    const cprox_pose a = random_pose(&r, dimension, i % 2 ? 1.3 : 2.2);
    const cprox_gap_carried carried = {way, random_pose(&r, dimension, 1).orientation, turning};
    const double t0 = rng_uniform(&r, 0, 0.5), t1 = rng_uniform(&r, t0 + 0.2, 1);
    cprox_gap_along_result v;
    MADE(cprox_gap_along_test(gap, &a, &carried, t0, t1, 100000, ws, &v));
    clear += v.verdict == CPROX_GAP_VERDICT_CLEAR, hit += v.verdict == CPROX_GAP_VERDICT_COLLIDE, nodes += v.nodes;
    assert_true(v.t >= t0 && v.t <= t1);
    cprox_gap_result x;
    MADE(cprox_gap_along(gap, &a, &carried, v.t, ws, &x, NULL));
    if (v.verdict == CPROX_GAP_VERDICT_COLLIDE) assert_int_equal(x.verdict, CPROX_GAP_VERDICT_COLLIDE);
    for (int k = 0; v.verdict == CPROX_GAP_VERDICT_CLEAR && k <= 300; k++) {
      const cprox_pose b = pose_on_way(&carried, t0 + (t1 - t0) * k / 300, dimension);
      MADE(cprox_gap_test(gap, &a, &b, ws, &x));
      assert_true(x.verdict == CPROX_GAP_VERDICT_CLEAR || x.verdict == CPROX_GAP_VERDICT_FAR);
    }

    const double t = rng_uniform(&r, 0.1, 0.9), h = 1e-4, step[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};
    double slope = 0, derivative;
    bool far = fabs(t - 0.3) < 1e-3 || fabs(t - 0.6) < 1e-3;
    for (int k = 0; k < 4; k++) {
      MADE(cprox_gap_along(gap, &a, &carried, t + step[k] * h, ws, &x, NULL));
      slope += weight[k] * x.value / (12 * h);
      far = far || x.verdict == CPROX_GAP_VERDICT_FAR;
    }
    MADE(cprox_gap_along(gap, &a, &carried, t, ws, &x, &derivative));
    if (!far) assert_true(fabs(slope - derivative) <= 1e-6 * fmax(fabs(derivative), 1.0));
    const cprox_pose b = pose_on_way(&carried, t, dimension);
    cprox_gap_result y;
    MADE(cprox_gap_evaluate(gap, &a, &b, ws, &y));
    if (x.verdict != CPROX_GAP_VERDICT_FAR) assert_true(fabs(x.value - y.value) <= 1e-8 * fmax(x.value, 1.0));
    cprox_gap_free(gap);
    cprox_solid_free(s[0]);
    cprox_solid_free(s[1]);
    cprox_curve_free(way);
    cprox_curve_free(turning);
  }
  print_message("%zu clear, %zu hit, %zu nodes, %zu times the first one turned\n", clear, hit, nodes, turned_first);
  assert_true(clear > 0 && hit > 0 && turned_first > 0);
}

/* A bar that would pass a post at either end of its turn strikes it on the way; where it does not turn it is clear. */
CASE(what_only_the_turn_brings_into_contact_is_not_called_clear) {
  cprox_solid *bar, *post;
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 2, .size = vec(2, 0.1, 0)},
                          ws, &bar));
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = 2, .radius = 0.1}, ws,
                          &post));
  cprox_gap *gap = gap_of(post, bar, CPROX_GAP_MODE_CERTIFIED, 65);
  const cprox_pose a = planar(0.55, 0.55, 0);
  const cprox_vec3 still[2] = {{0, 0, 0}, {1e-3, 0, 0}}, quarter[2] = {{0, 0, 0}, {0, 0, 1.5707963267948966}};
  const cprox_vec3 tilted[2] = {{0, 0, 0}, {0, 0.1, 0}};
  cprox_curve *way, *turning, *askew, *later;
  MADE(curve_from(describe_bezier(still, 2, 0, 1), ws, &way));
  MADE(curve_from(describe_bezier(quarter, 2, 0, 1), ws, &turning));
  MADE(curve_from(describe_bezier(tilted, 2, 0, 1), ws, &askew));
  MADE(curve_from(describe_bezier(quarter, 2, 0, 2), ws, &later));
  cprox_gap_along_result v;
  MADE(cprox_gap_along_test(gap, &a, &(cprox_gap_carried){way, {1, 0, 0, 0}, NULL}, 0, 1, 10000, ws, &v));
  assert_int_equal(v.verdict, CPROX_GAP_VERDICT_CLEAR);
  MADE(cprox_gap_along_test(gap, &a, &(cprox_gap_carried){way, {1, 0, 0, 0}, turning}, 0, 1, 10000, ws, &v));
  assert_int_equal(v.verdict, CPROX_GAP_VERDICT_COLLIDE);
  assert_true(fabs(v.t - 0.5) < 0.2 && v.value > 1.0);
  /* up to where the bar is still away from the post */
  MADE(cprox_gap_along_test(gap, &a, &(cprox_gap_carried){way, {1, 0, 0, 0}, turning}, 0, 0.2, 10000, ws, &v));
  assert_int_equal(v.verdict, CPROX_GAP_VERDICT_CLEAR);

  cprox_gap_carried wrong = {way, {1, 0, 0, 0}, askew};
  assert_int_equal(cprox_gap_along_test(gap, &a, &wrong, 0, 1, 10, ws, &v), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "a planar solid turns about z only");
  wrong.turning = later;
  assert_int_equal(cprox_gap_along_test(gap, &a, &wrong, 0, 1, 10, ws, &v), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "carried->turning is over [0, 2], and the curve over [0, 1]");
  cprox_gap_free(gap);
  cprox_solid_free(bar);
  cprox_solid_free(post);
  cprox_curve *const all[] = {way, turning, askew, later};
  for (int i = 0; i < 4; i++) cprox_curve_free(all[i]);
}

/* Each allocation of making a gap or a cascade fails in turn. */
CASE(gaps_survive_every_failed_allocation) {
  cprox_solid *s[2];
  make_pair(1, s);
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.samples = 17;
  for (size_t n = 0;; n++) {
    const size_t live = allocations_live();
    cprox_gap *gap = NULL;
    cprox_gap_cascade *cascade = NULL;
    allocations_fail_after(n);
    const cprox_status first = cprox_gap_create(s[0], s[1], &o, ws, &gap);
    const cprox_status second = first == CPROX_OK ? cprox_gap_cascade_create(s[0], s[1], &o, ws, &cascade) : first;
    allocations_allow();
    cprox_gap_free(gap);
    cprox_gap_cascade_free(cascade);
    assert_int_equal(allocations_live(), live);
    if (second == CPROX_OK) break;
    assert_int_equal(second, CPROX_MEMORY);
    assert_true(n < 100000);
  }
  cprox_solid_free(s[0]);
  cprox_solid_free(s[1]);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
