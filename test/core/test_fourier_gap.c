/* SPDX-License-Identifier: BSD-3-Clause */
/* The guarantee: a certified "clear" is never wrong, and bodies beyond the over-reach are never called colliding. Truth
 * comes from separating axes of convex pieces and from distances between their edges. Larger campaigns:
 * CPROX_TEST_SCALE. */
#include <stdlib.h>
#include <string.h>

#include "fourier/gap.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/csv.h"
#include "support/random.h"

#define MADE(call) assert_int_equal(call, CPROX_OK)

static cprox_pose planar(double x, double y, double angle) {
  return (cprox_pose){.position = {x, y, 0}, .orientation = {cos(0.5 * angle), 0, 0, sin(0.5 * angle)}};
}

/* Without bounds per direction: V decides. */
static cprox_gap *gap_of(const cprox_solid *a, const cprox_solid *b, cprox_gap_mode mode, uint32_t samples) {
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.mode = mode, o.samples = samples;
  cprox_gap *gap = NULL;
  if (cprox_gap_create(a, b, &o, ws, &gap) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  enclosures_free(&gap->bounds_a);
  enclosures_free(&gap->bounds_b);
  return gap;
}

/* ---- Shapes of convex pieces ---- */

enum { MOST_PIECES = 8, MOST_CORNERS = 8 };

typedef struct shape {
  size_t n, corners[MOST_PIECES];
  double v[MOST_PIECES][MOST_CORNERS][2];
  cprox_solid *solid;
} shape;

static shape read_shape(const csv_table *t, const char *name) {
  shape s = {0};
  cprox_solid *parts[MOST_PIECES] = {NULL};
  cprox_pose poses[MOST_PIECES] = {{{0, 0, 0}, {0, 0, 0, 0}}};
  for (size_t i = 0; i < t->n; i++) {
    const csv_row *row = &t->row[i];
    if (strcmp(row->field[0], "shape") != 0 || strcmp(row->field[1], name) != 0) continue;
    const size_t n = csv_count(t, row, 2);
    s.corners[s.n] = n;
    for (size_t j = 0; j < 2 * n; j++) s.v[s.n][j / 2][j % 2] = csv_number(t, row, 3 + j);
    MADE(cprox_solid_create(
        &(cprox_solid_description){.kind = CPROX_SOLID_POLYGON, .corners = (const double(*)[2])s.v[s.n], .n = n}, ws,
        &parts[s.n]));
    poses[s.n++] = CPROX_POSE_IDENTITY;
  }
  assert_true(s.n > 0);
  MADE(cprox_solid_create(
      &(cprox_solid_description){
          .kind = CPROX_SOLID_UNION, .parts = (const cprox_solid *const *)parts, .poses = poses, .n = s.n},
      ws, &s.solid));
  for (size_t i = 0; i < s.n; i++) cprox_solid_free(parts[i]);
  return s;
}

/* Corners of piece i in the world. */
static void place(const shape *s, size_t i, const cprox_pose *pose, long double out[MOST_CORNERS][2]) {
  const long double w = (long double)pose->orientation.w, z = (long double)pose->orientation.z, norm = w * w + z * z;
  const long double c = (w * w - z * z) / norm, n = 2 * w * z / norm;
  for (size_t j = 0; j < s->corners[i]; j++) {
    const long double x = (long double)s->v[i][j][0], y = (long double)s->v[i][j][1];
    out[j][0] = (long double)pose->position.x + c * x - n * y;
    out[j][1] = (long double)pose->position.y + n * x + c * y;
  }
}

/* The widest gap along an edge normal of the first: > 0 separated, < 0 minus the overlap along that axis. */
static long double widest(long double (*a)[2], size_t n, long double (*b)[2], size_t m) {
  long double most = -INFINITY;
  for (size_t i = 0; i < n; i++) {
    const long double dx = a[(i + 1) % n][0] - a[i][0], dy = a[(i + 1) % n][1] - a[i][1],
                      length = sqrtl(dx * dx + dy * dy);
    long double least = INFINITY;
    for (size_t j = 0; j < m; j++) least = fminl(least, ((b[j][0] - a[i][0]) * dy - (b[j][1] - a[i][1]) * dx) / length);
    most = fmaxl(most, least);
  }
  return most;
}

static long double corner_to_edges(const long double *p, long double (*a)[2], size_t n) {
  long double best = INFINITY;
  for (size_t i = 0; i < n; i++) {
    const long double dx = a[(i + 1) % n][0] - a[i][0], dy = a[(i + 1) % n][1] - a[i][1];
    const long double px = p[0] - a[i][0], py = p[1] - a[i][1];
    const long double s = fminl(1, fmaxl(0, (px * dx + py * dy) / (dx * dx + dy * dy)));
    best = fminl(best, hypotl(px - s * dx, py - s * dy));
  }
  return best;
}

/* Distance between two shapes, or minus how deep the deepest pair of pieces overlaps (along an edge normal). */
static long double exact(const shape *a, const cprox_pose *pa, const shape *b, const cprox_pose *pb) {
  long double best = INFINITY;
  for (size_t i = 0; i < a->n; i++)
    for (size_t j = 0; j < b->n; j++) {
      long double p[MOST_CORNERS][2], q[MOST_CORNERS][2];
      place(a, i, pa, p);
      place(b, j, pb, q);
      const size_t n = a->corners[i], m = b->corners[j];
      long double d = fmaxl(widest(p, n, q, m), widest(q, m, p, n));
      if (d > 0) {
        d = INFINITY;
        for (size_t k = 0; k < n; k++) d = fminl(d, corner_to_edges(p[k], q, m));
        for (size_t k = 0; k < m; k++) d = fminl(d, corner_to_edges(q[k], p, n));
      }
      best = fminl(best, d);
    }
  return best;
}

/* Seed 711: letters, a star and polygons at random poses, a third of them near contact. Certified mode at n = 9, 17,
 * 33: no overlap deeper than 1e-12 is called clear, nothing beyond the proven over-reach is called colliding, and what
 * is called so is within 3.6 L/n. Tuned mode: within 1.7 L/n from n = 17 on (rods at n = 9 reach 2.2). */
CASE(certified_is_never_wrong_about_clear) {
  static const char *const names[] = {"L", "T", "E", "star", "square", "triangle", "hex", "rod"};
  enum { N = sizeof names / sizeof *names };
  csv_table t = csv_read("fourier/spectrum_2d.csv");
  shape shapes[N];
  for (int i = 0; i < N; i++) shapes[i] = read_shape(&t, names[i]);
  csv_free(&t);
  rng r = rng_seed(711);
  size_t colliding = 0, clear = 0, over = 0;
  double most = 0.0, most_tuned = 0.0;
  for (int pair = 0; pair < 24; pair++) {
    const shape *a = &shapes[rng_index(&r, N)], *b = &shapes[rng_index(&r, N)];
    const uint32_t samples = (const uint32_t[]){9, 17, 33}[pair % 3];
    cprox_gap *gap = gap_of(a->solid, b->solid, CPROX_GAP_MODE_CERTIFIED, samples);
    cprox_gap *tuned = gap_of(a->solid, b->solid, CPROX_GAP_MODE_TUNED, samples);
    const cprox_gap_info info = cprox_gap_get_info(gap), other = cprox_gap_get_info(tuned);
    assert_true(info.guaranteed && !other.guaranteed);
    for (size_t i = 0; i < test_cases(400); i++) {
      const cprox_pose pa = planar(rng_uniform(&r, -9, 9), 1, rng_uniform(&r, 0, 6.3));
      cprox_pose pb = planar(0, 0, rng_uniform(&r, 0, 6.3));
      const double angle = rng_uniform(&r, 0, 6.3);
      double away = rng_uniform(&r, 0, 2.6);
      for (int k = 0; k < 12; k++) { /* most of them close to contact */
        pb.position = vec_add(pa.position, vec(away * cos(angle), away * sin(angle), 0));
        if (i % 3 == 0) break;
        const long double d = exact(a, &pa, b, &pb);
        if (fabsl(d) < 0.01L) break;
        away = fmax(0.0, away - 0.7 * (double)d);
      }
      const long double d = exact(a, &pa, b, &pb);
      cprox_gap_result x, y;
      MADE(cprox_gap_test(gap, &pa, &pb, ws, &x));
      MADE(cprox_gap_test(tuned, &pa, &pb, ws, &y));
      const bool says_clear = x.verdict == CPROX_GAP_VERDICT_CLEAR || x.verdict == CPROX_GAP_VERDICT_FAR;
      colliding += d < -1e-12L;
      clear += says_clear;
      if (says_clear && d < -1e-12L)
        fail_msg("pair %d, n %u: clear at an overlap of %Lg, value %g", pair, samples, -d, x.value);
      if (x.verdict == CPROX_GAP_VERDICT_FAR) assert_true(x.clearance <= (double)d + 1e-12);
      if (!says_clear && d > 0) {
        over++;
        if (!((double)d <= info.over_reach)) fail_msg("called colliding %Lg apart, over-reach %g", d, info.over_reach);
        most = fmax(most, (double)d * samples / info.period);
      }
      if (y.verdict != CPROX_GAP_VERDICT_CLEAR && y.verdict != CPROX_GAP_VERDICT_FAR && d > 0) {
        if (!((double)d <= other.over_reach))
          fail_msg("tuned: called colliding %Lg apart, over-reach %g, n %u", d, other.over_reach, samples);
        if (samples > 9) most_tuned = fmax(most_tuned, (double)d * samples / other.period);
      }
    }
    cprox_gap_free(gap);
    cprox_gap_free(tuned);
  }
  for (int i = 0; i < N; i++) cprox_solid_free(shapes[i].solid);
  print_message("%zu colliding, %zu clear, %zu over-reached by at most %.2f L/n (tuned %.2f)\n", colliding, clear, over,
                most, most_tuned);
  assert_true(most <= 3.6 && most_tuned <= 1.7);
  assert_true(colliding > clear / 20 && clear > 0 && over > 0);
}

/* Boxes by the fifteen axes. The least overlap along an axis, negative where one separates. */
static long double box_overlap(const double h[2][3], const frame f[2]) {
  vec3 axes[15];
  int n = 0;
  for (int s = 0; s < 2; s++)
    for (int j = 0; j < 3; j++) axes[n++] = vec(f[s].r[j], f[s].r[3 + j], f[s].r[6 + j]);
  for (int i = 0; i < 3; i++)
    for (int j = 3; j < 6; j++) axes[n++] = vec_cross(axes[i], axes[j]);
  long double least = INFINITY;
  const vec3 x = vec_sub(f[1].position, f[0].position);
  for (int i = 0; i < 15; i++) {
    const double length = vec_norm(axes[i]);
    if (length < 1e-8) continue;
    long double reach = 0;
    for (int s = 0; s < 2; s++)
      for (int j = 0; j < 3; j++) reach += (long double)h[s][j] * fabsl((long double)vec_dot(axes[i], axes[3 * s + j]));
    least = fminl(least, (reach - fabsl((long double)vec_dot(axes[i], x))) / (long double)length);
  }
  return least;
}

/* Seed 712: the same for boxes in space, as boxes and as meshes, against each other. */
CASE(certified_is_never_wrong_in_space) {
  rng r = rng_seed(712);
  const double outside[1][4] = {{1, 0, 0, 99}};
  size_t colliding = 0, clear = 0;
  for (int pair = 0; pair < 8; pair++) {
    double h[2][3];
    cprox_solid *s[2], *mesh;
    for (int k = 0; k < 2; k++) {
      for (int j = 0; j < 3; j++) h[k][j] = rng_log_uniform(&r, 0.05, 1.0);
      MADE(cprox_solid_create(
          &(cprox_solid_description){
              .kind = CPROX_SOLID_BOX, .dimension = 3, .size = vec(2 * h[k][0], 2 * h[k][1], 2 * h[k][2])},
          ws, &s[k]));
    }
    MADE(cprox_solid_create(
        &(cprox_solid_description){.kind = CPROX_SOLID_CLIPPED, .solid = s[0], .region = outside, .n = 1}, ws, &mesh));
    const uint32_t samples = pair % 2 ? 9 : 13;
    cprox_gap *gap = gap_of(s[0], s[1], CPROX_GAP_MODE_CERTIFIED, samples),
              *of_mesh = gap_of(mesh, s[1], CPROX_GAP_MODE_CERTIFIED, samples);
    for (size_t i = 0; i < test_cases(400); i++) {
      const cprox_pose p[2] = {rng_pose(&r, 3.0), {.orientation = rng_quat(&r)}};
      cprox_pose q = p[1];
      q.position = vec_axpy(p[0].position, (s[0]->radius + s[1]->radius) * rng_uniform(&r, 0, 1.1), rng_unit(&r));
      const frame f[2] = {frame_create(&p[0], vec(0, 0, 0)), frame_create(&q, vec(0, 0, 0))};
      const long double overlap = box_overlap((const double(*)[3])h, f);
      cprox_gap_result x, y;
      MADE(cprox_gap_test(gap, &p[0], &q, ws, &x));
      MADE(cprox_gap_test(of_mesh, &p[0], &q, ws, &y));
      colliding += overlap > 1e-9L;
      clear += x.verdict == CPROX_GAP_VERDICT_CLEAR || x.verdict == CPROX_GAP_VERDICT_FAR;
      if (overlap > 1e-9L) {
        assert_true(x.verdict == CPROX_GAP_VERDICT_COLLIDE || x.verdict == CPROX_GAP_VERDICT_UNDECIDED);
        assert_true(y.verdict == CPROX_GAP_VERDICT_COLLIDE || y.verdict == CPROX_GAP_VERDICT_UNDECIDED);
      }
    }
    cprox_gap_free(gap);
    cprox_gap_free(of_mesh);
    cprox_solid_free(s[0]);
    cprox_solid_free(s[1]);
    cprox_solid_free(mesh);
  }
  assert_true(colliding > test_cases(100) / 4 && clear > test_cases(100) / 4);
}

/* A dot on a dot among bars where the ball-shaped window's kernel is negative: the bars' negative share outweighs the
 * dots'. */
CASE(bars_around_a_dot_break_the_tuned_mode_and_not_the_certified_one) {
  cprox_solid *dot, *bar, *all;
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = 2, .radius = 1e-3}, ws,
                          &dot));
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 2, .size = vec(0.1, 8.5, 0)},
                          ws, &bar));
  const cprox_solid *const parts[7] = {dot, bar, bar, bar, bar, bar, bar};
  const cprox_pose poses[7] = {planar(0, 0, 0),    planar(1.1, 0, 0), planar(-1.1, 0, 0), planar(2.9, 0, 0),
                               planar(-2.9, 0, 0), planar(4.7, 0, 0), planar(-4.7, 0, 0)};
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_UNION, .parts = parts, .poses = poses, .n = 7},
                          ws, &all));
  const cprox_pose here = CPROX_POSE_IDENTITY;
  for (int swap = 0; swap < 2; swap++) {
    const cprox_solid *a = swap ? all : dot, *b = swap ? dot : all;
    cprox_gap *tuned = gap_of(a, b, CPROX_GAP_MODE_TUNED, 17), *certified = gap_of(a, b, CPROX_GAP_MODE_CERTIFIED, 17);
    cprox_gap_result r;
    MADE(cprox_gap_test(tuned, &here, &here, ws, &r));
    assert_int_equal(r.verdict, CPROX_GAP_VERDICT_CLEAR); /* wrong */
    MADE(cprox_gap_evaluate(tuned, &here, &here, ws, &r));
    if (!(r.value < 0.7)) fail_msg("V/t = %g", r.value);
    MADE(cprox_gap_test(certified, &here, &here, ws, &r));
    assert_int_equal(r.verdict, CPROX_GAP_VERDICT_COLLIDE);
    cprox_gap_free(tuned);
    cprox_gap_free(certified);
  }
  cprox_solid_free(dot);
  cprox_solid_free(bar);
  cprox_solid_free(all);
}

/* Crossed rods 0.011 L thick: without an offset their overlap is below the t of an offset of L/4n, and would be called
 * clear. */
CASE(thin_bodies_need_the_offset) {
  cprox_solid *rod;
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 2, .size = vec(2, 0.05, 0)},
                          ws, &rod));
  const cprox_pose a = planar(0, 0, 0), b = planar(0.3, 0, 1.3);
  double reach;
  gap_plan plan = {.mode = CPROX_GAP_MODE_CERTIFIED,
                   .dimension = 2,
                   .N = 8,
                   .beta = kernel_beta(2, 17),
                   .period = 4.6,
                   .offset = 0.75 * 4.6 / 17};
  cprox_gap *bare, *certified = gap_of(rod, rod, CPROX_GAP_MODE_CERTIFIED, 17);
  MADE(gap_build(&plan, solid_offset(rod, 0.0, &reach), solid_offset(rod, 0.0, &reach), (size_t)1 << 30, ws, &bare));
  bare->radius_a = bare->radius_b = rod->radius;
  cprox_gap_result r;
  MADE(cprox_gap_test(bare, &a, &b, ws, &r));
  assert_int_equal(r.verdict, CPROX_GAP_VERDICT_CLEAR); /* false */
  MADE(cprox_gap_test(certified, &a, &b, ws, &r));
  assert_int_equal(r.verdict, CPROX_GAP_VERDICT_COLLIDE);
  cprox_gap_free(bare);
  cprox_gap_free(certified);
  cprox_solid_free(rod);
}

/* Out to 50 periods in every direction images never answer for the body; at the edge of the bounding spheres neither.
 */
CASE(images_of_the_period_never_answer) {
  rng r = rng_seed(713);
  cprox_solid *s;
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 2, .size = vec(1, 0.6, 0)},
                          ws, &s));
  cprox_gap *gap = gap_of(s, s, CPROX_GAP_MODE_CERTIFIED, 33);
  const cprox_gap_info info = cprox_gap_get_info(gap);
  for (int i = 0; i < 2000; i++) {
    const double angle = rng_uniform(&r, 0, 6.3),
                 away = i % 2 ? rng_uniform(&r, 0.9, 1.1) * 2 * s->radius : rng_uniform(&r, 1, 50) * info.period;
    const cprox_pose a = planar(0, 0, rng_uniform(&r, 0, 6.3)),
                     b = planar(away * cos(angle), away * sin(angle), rng_uniform(&r, 0, 6.3));
    cprox_gap_result x;
    MADE(cprox_gap_test(gap, &a, &b, ws, &x));
    if (away > 2 * s->radius * (1 + 1e-12)) {
      assert_int_equal(x.verdict, CPROX_GAP_VERDICT_FAR);
      assert_true(fabs(x.clearance - (away - 2 * s->radius)) <= 1e-12 * away);
    } else {
      assert_true(x.verdict != CPROX_GAP_VERDICT_FAR);
    }
  }
  /* a period that lets images overlap is refused, with what it takes */
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.samples = 33, o.period = 0.9 * info.period;
  cprox_gap *none = NULL;
  assert_int_equal(cprox_gap_create(s, s, &o, ws, &none), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "is too small: images of the solids need"));
  cprox_gap_free(gap);
  cprox_solid_free(s);
}

/* Kernels of the certified mode are squares: nonnegative up to rounding. */
CASE(certified_kernels_are_not_negative) {
  kernel k;
  for (int N = 1; N <= 96; N += N < 16 ? 1 : 16) {
    kernel_certified(&k, N, kernel_beta(2, 2 * N + 1));
    long double least = INFINITY, peak = 0;
    for (int i = 0; i <= 4000; i++) {
      long double sum = 1;
      for (int j = 1; j <= N; j++)
        sum += 2 * (long double)k.w[j] * cosl(6.283185307179586476925L * (long double)j * (long double)i / 8000);
      least = fminl(least, sum);
      peak = fmaxl(peak, sum);
    }
    if (!(least >= -1e-15L * peak)) fail_msg("N %d: %Lg of %Lg", N, least, peak);
  }
}

/* A gap for a delta holds it, with a proof; half the delta costs about twice the samples; a delta that memory does not
 * hold is refused with what it would take. */
CASE(delta_chooses_no_more_than_is_needed) {
  cprox_solid *a, *b;
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 2, .size = vec(1, 0.6, 0)},
                          ws, &a));
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = 2, .radius = 0.5}, ws, &b));
  uint32_t last = 0;
  for (double delta = 0.8; delta > 0.04; delta *= 0.5) {
    cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
    o.delta = delta;
    cprox_gap *gap, *less;
    MADE(cprox_gap_create(a, b, &o, ws, &gap));
    const cprox_gap_info info = cprox_gap_get_info(gap);
    assert_true(info.over_reach <= delta && info.samples > last);
    assert_true(info.bytes > 0 && info.terms > 0 && info.rounding < 1e-4);
    if (info.samples > 3) {
      less = gap_of(a, b, CPROX_GAP_MODE_CERTIFIED, info.samples - 2);
      assert_true(cprox_gap_get_info(less).over_reach > delta);
      cprox_gap_free(less);
    }
    last = info.samples;
    cprox_gap_free(gap);
  }
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  cprox_gap *none = NULL;
  o.delta = 0.02, o.memory_limit = 10000;
  assert_int_equal(cprox_gap_create(a, b, &o, ws, &none), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "beyond the limit of 10000"));
  o.delta = 5;
  assert_int_equal(cprox_gap_create(a, b, &o, ws, &none), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "delta 5 is larger than the bodies"));
  o.delta = 0;
  assert_int_equal(cprox_gap_create(a, b, &o, ws, &none), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "delta is 0, must be > 0 (or give samples)");
  o.samples = 8;
  assert_int_equal(cprox_gap_create(a, b, &o, ws, &none), CPROX_INVALID);
  assert_null(none);
  cprox_solid_free(a);
  cprox_solid_free(b);
}

/* Bodies of very different sizes: the accuracy is that of the pair's period, which exceeds the small body here. */
CASE(a_small_body_beside_a_large_one_is_seen_coarsely) {
  cprox_solid *large, *small;
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 2, .size = vec(4, 4, 0)}, ws,
                          &large));
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 2, .size = vec(0.1, 0.1, 0)},
                          ws, &small));
  cprox_gap *gap = gap_of(large, small, CPROX_GAP_MODE_CERTIFIED, 33);
  const cprox_gap_info info = cprox_gap_get_info(gap);
  assert_true(info.over_reach > 0.1 && info.over_reach > info.period / 33);
  /* cropping the large one to a window around the small one brings it down */
  const double window[2][4] = {{-1, 0, 0, -1.6}, {0, -1, 0, -1.6}};
  cprox_solid *corner;
  MADE(cprox_solid_create(
      &(cprox_solid_description){.kind = CPROX_SOLID_CLIPPED, .solid = large, .region = window, .n = 2}, ws, &corner));
  cprox_gap *local = gap_of(corner, small, CPROX_GAP_MODE_CERTIFIED, 33);
  assert_true(cprox_gap_get_info(local).over_reach < 0.5 * info.over_reach);
  cprox_gap_free(gap);
  cprox_gap_free(local);
  cprox_solid_free(large);
  cprox_solid_free(small);
  cprox_solid_free(corner);
}

static bool stops_at_last(void *user) {
  return --*(int *)user <= 0;
}

/* A gap of n = 257 in the plane: the function is asked while n is chosen and while the spectrum is made. */
CASE(the_stop_function_ends_the_making_of_a_gap) {
  const cprox_solid_description box = {.kind = CPROX_SOLID_BOX, .dimension = 2, .size = {1.0, 0.6, 0.0}};
  cprox_solid *s = NULL;
  assert_int_equal(cprox_solid_create(&box, ws, &s), CPROX_OK);
  cprox_gap_options options = CPROX_GAP_OPTIONS_DEFAULT;
  options.samples = 257;
  int never = 1 << 30;
  cprox_gap *gap = NULL;
  cprox_workspace_set_stop(ws, stops_at_last, &never);
  assert_int_equal(cprox_gap_create(s, s, &options, ws, &gap), CPROX_OK);
  cprox_gap_free(gap);
  const int asked = (1 << 30) - never;
  assert_true(asked > 100);
  for (int last = 1; last <= asked; last += 1 + asked / 20) {
    int polls = last;
    cprox_workspace_set_stop(ws, stops_at_last, &polls);
    cprox_gap *none = NULL;
    assert_int_equal(cprox_gap_create(s, s, &options, ws, &none), CPROX_INVALID);
    assert_true(none == NULL && strstr(cprox_workspace_error(ws), "stop function"));
  }
  cprox_workspace_set_stop(ws, NULL, NULL);
  cprox_solid_free(s);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
