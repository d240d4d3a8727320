/* SPDX-License-Identifier: BSD-3-Clause */
/* Covers of solids by cells, and tables of spectra: what stands in for a solid whose closed form costs too much holds
 * it, its value is that of the function that the proof is about, and one solid described in several ways gives verdicts
 * that agree with its distance. */
#include <string.h>

#include "fourier/gap.h"
#include "fourier/grid.h"
#include "fourier/raster.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/random.h"
#include "support/solids.h"

#define TAU 6.28318530717958647693

#define MADE(call) \
  if ((call) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws))

static cprox_solid *make(const cprox_solid_description *d) {
  cprox_solid *s = NULL;
  MADE(cprox_solid_create(d, ws, &s));
  return s;
}

static cprox_gap *gap_of(const cprox_solid *a, const cprox_solid *b, cprox_gap_mode mode, uint32_t samples) {
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.mode = mode, o.samples = samples;
  cprox_gap *gap = NULL;
  MADE(cprox_gap_create(a, b, &o, ws, &gap));
  return gap;
}

/* ---- covers ---- */

static bool is_occupied(const cprox_solid *cover, vec3 p) {
  const piece *g = cover->pieces;
  const vec3 at = vec_scale(1.0 / g->size[0], vec_sub(p, g->centre));
  const double i[3] = {floor(at.x), floor(at.y), floor(at.z)};
  for (int j = 0; j < 3; j++)
    if (i[j] < 0.0 || i[j] >= g->counts[j]) return false;
  return g->cells[((size_t)i[2] * g->counts[1] + (size_t)i[1]) * g->counts[0] + (size_t)i[0]] != 0;
}

/* Seed 5101: points of the solid lie in occupied cells, and points of occupied cells are not far from the solid. */
CASE(a_cover_holds_every_point_of_its_solid_and_little_more) {
  rng r = rng_seed(5101);
  size_t inside = 0;
  for (size_t i = 0; i < test_cases(5); i++)
    for (test_solid_kind kind = 0; kind < SOLID_KINDS; kind++) {
      if (!solid_exists(kind, 3) || kind == SOLID_SWEEP) continue;
      test_solid s = solid_make(&r, kind, 3, 1.0, 3.0);
      const double cell = rng_uniform(&r, 0.05, 0.2);
      assert_true(raster_is_possible(s.solid));
      cprox_solid *cover = raster_cover(s.solid, cell, ws);
      assert_non_null(cover);
      double reach;
      cprox_solid *grown = solid_offset(s.solid, raster_growth(s.solid, cell), &reach);
      assert_non_null(grown);
      const cprox_pose here = CPROX_POSE_IDENTITY;
      const double size = s.solid->radius + 0.3;
      for (int k = 0; k < 400; k++) {
        const vec3 p = vec_axpy(s.solid->centre, size * cbrt(rng_uniform(&r, 0, 1)), rng_unit(&r));
        cprox_body *ball;
        MADE(cprox_body_create_sphere(1e-9, ws, &ball));
        const test_solid point = {.body = ball};
        const double d = solid_distance(&s, &here, &point, &(cprox_pose){.position = p, .orientation = {1, 0, 0, 0}});
        cprox_body_free(ball);
        if (d < -2e-9) {
          inside++;
          if (!is_occupied(cover, p)) fail_msg("%s: a point %g inside is in no cell", solid_name(kind), -d);
        }
        if (is_occupied(cover, p) && kind != SOLID_CLIPPED && d > reach + 1e-6)
          fail_msg("%s: a point of the cover is %g away, farther than %g", solid_name(kind), d, reach);
      }
      cprox_solid_free(grown);
      cprox_solid_free(cover);
      solid_free(&s);
    }
  print_message("%zu points inside\n", inside);
  assert_true(inside > 0);
}

/* ---- tables ---- */

static piece some_grid(rng *r) {
  piece g = piece_create(PIECE_GRID);
  g.size[0] = rng_uniform(r, 0.05, 0.2);
  for (int j = 0; j < 3; j++) g.counts[j] = 3 + (uint32_t)rng_index(r, 6);
  g.centre =
      vec(-rng_uniform(r, 0.3, 0.6) * g.size[0] * g.counts[0], -rng_uniform(r, 0.3, 0.6) * g.size[0] * g.counts[1],
          -rng_uniform(r, 0.3, 0.6) * g.size[0] * g.counts[2]);
  const size_t n = (size_t)g.counts[0] * g.counts[1] * g.counts[2];
  g.cells = calloc(n, 1);
  assert_non_null(g.cells);
  for (size_t i = 0; i < n; i++) g.cells[i] = rng_index(r, 3) != 0;
  return g;
}

/* sinc(y/P)^6 */
static long double window(long double y, long double period) {
  const long double a = 3.14159265358979323846264338328L * y / period;
  const long double s = fabsl(a) < 1e-9L ? 1.0L : sinl(a) / a;
  return s * s * s * s * s * s;
}

static double along(vec3 v, int j) {
  return j == 0 ? v.x : j == 1 ? v.y : v.z;
}

/* The transform along one axis of a layer of cells times the window, and of its images: by the rule of Gauss with 10
 * nodes on many panels. One axis of what a table's value is a sum of products of. */
static void layer_transform(long double low, long double high, long double period, long double q, long double *re,
                            long double *im) {
  static const long double node[5] = {0.148874338981631210884826001130L, 0.433395394129247190799265943166L,
                                      0.679409568299024406234327365115L, 0.865063366688984510732096688423L,
                                      0.973906528517171720077964012084L};
  static const long double weight[5] = {0.295524224714752870173815619188L, 0.269266719309996355091226921569L,
                                        0.219086362515982043995534934228L, 0.149451349150580593145863396958L,
                                        0.066671344308688137593568809893L};
  *re = *im = 0.0L;
  for (int m = -40; m <= 40; m++)
    for (int panel = 0; panel < 4; panel++) {
      const long double width = (high - low) / 4.0L, middle = low + (panel + 0.5L) * width + m * period;
      for (int k = 0; k < 10; k++) {
        const long double y = middle + 0.5L * width * (k % 2 ? node[k / 2] : -node[k / 2]);
        const long double w = 0.5L * width * weight[k / 2] * window(y, period);
        *re += w * cosl(q * y), *im -= w * sinl(q * y);
      }
    }
}

/* Seed 5102: the value of a table is the transform of the weighted cells and all their images, each times the window,
 * by quadrature in long double; the gradient is its derivative. */
CASE(a_tables_value_is_the_transform_of_windowed_cells) {
  rng r = rng_seed(5102);
  for (size_t i = 0; i < test_cases(5); i++) {
    piece g = some_grid(&r);
    spectrum_table *t = lookup_create(&g, 12.0, ws);
    assert_non_null(t);
    double weights[3][16], *const weight[3] = {weights[0], weights[1], weights[2]};
    table_bounds bounds;
    assert_true(lookup_find_bounds(&g, &bounds, weight));
    for (int k = 0; k < 4; k++) {
      const vec3 q = vec_scale(rng_uniform(&r, 0.0, 12.0), rng_unit(&r));
      long double axis[3][16][2];
      for (int j = 0; j < 3; j++)
        for (uint32_t c = 0; c < g.counts[j]; c++) {
          const long double low = along(g.centre, j) + (long double)g.size[0] * c;
          layer_transform(low, low + g.size[0], t->bounds.period[j], along(q, j), &axis[j][c][0], &axis[j][c][1]);
          axis[j][c][0] *= weight[j][c], axis[j][c][1] *= weight[j][c];
        }
      long double re = 0.0L, im = 0.0L;
      for (uint32_t z = 0; z < g.counts[2]; z++)
        for (uint32_t y = 0; y < g.counts[1]; y++)
          for (uint32_t x = 0; x < g.counts[0]; x++) {
            if (!g.cells[(z * g.counts[1] + y) * g.counts[0] + x]) continue;
            const long double *a = axis[0][x], *b = axis[1][y], *c = axis[2][z];
            const long double pr = a[0] * b[0] - a[1] * b[1], pi = a[0] * b[1] + a[1] * b[0];
            re += pr * c[0] - pi * c[1], im += pr * c[1] + pi * c[0];
          }
      wave_jet at, more, less;
      lookup_at(t, q, true, &at);
      const double tolerance = 1e-12 * bounds.mass;
      assert_true(fabs(at.value.re - (double)re) < tolerance && fabs(at.value.im - (double)im) < tolerance);
      const double h = 1e-5;
      for (int j = 0; j < 3; j++) {
        const vec3 step = vec(j == 0 ? h : 0, j == 1 ? h : 0, j == 2 ? h : 0);
        lookup_at(t, vec_add(q, step), false, &more);
        lookup_at(t, vec_sub(q, step), false, &less);
        assert_true(fabs((more.value.re - less.value.re) / (2 * h) - along(at.re, j)) < 1e-8 * bounds.mass);
        assert_true(fabs((more.value.im - less.value.im) / (2 * h) - along(at.im, j)) < 1e-8 * bounds.mass);
      }
    }
    lookup_free(t);
    piece_free(&g);
  }
}

/* Seed 5103: the function of a table is at least 1 on the cells, and no larger than its bounds; that of the images, too,
 * and it never is negative. */
CASE(a_tables_function_is_at_least_one_on_its_cells) {
  rng r = rng_seed(5103);
  for (size_t i = 0; i < test_cases(25); i++) {
    piece g = some_grid(&r);
    double weights[3][16], *const weight[3] = {weights[0], weights[1], weights[2]};
    table_bounds b;
    assert_true(lookup_find_bounds(&g, &b, weight));
    double low[3], high[3];
    for (int j = 0; j < 3; j++) {
      low[j] = along(g.centre, j), high[j] = low[j] + g.size[0] * g.counts[j];
      assert_true(b.period[j] > 2.0 * fmax(-low[j], high[j]));
    }
    for (int k = 0; k < 200; k++) {
      long double here = 1.0L, all = 1.0L;
      size_t at[3];
      for (int j = 0; j < 3; j++) {
        at[j] = rng_index(&r, g.counts[j]);
        const long double y = low[j] + (long double)g.size[0] * ((double)at[j] + rng_uniform(&r, 0, 1));
        long double sum = 0.0L;
        for (int m = -40; m <= 40; m++) sum += window(y + m * (long double)b.period[j], b.period[j]);
        here *= weight[j][at[j]] * window(y, b.period[j]), all *= weight[j][at[j]] * sum;
      }
      if (!g.cells[(at[2] * g.counts[1] + at[1]) * g.counts[0] + at[0]]) continue;
      assert_true(here >= 1.0L - 1e-13L && here <= b.peak * (1.0L + 1e-13L));
      assert_true(all - here >= 0.0L && all - here <= b.image_peak);
    }
    /* of a cover whose cells are not known yet no less */
    double most[3], least[3];
    for (int j = 0; j < 3; j++) most[j] = fmax(-low[j], high[j]), least[j] = fmax(g.size[0], 0.9 * most[j]);
    table_bounds ahead;
    const double cube = g.size[0] * g.size[0] * g.size[0];
    lookup_bound_cover(least, most, g.size[0], cube * g.counts[0] * g.counts[1] * g.counts[2], &ahead);
    assert_true(ahead.peak >= b.peak && ahead.image_mass >= b.image_mass && ahead.image_peak >= b.image_peak * 0.999);
    piece_free(&g);
  }
}

/* ---- gaps ---- */

/* Seed 5104: kinds that are turned as tables. No overlap is clear by the sum alone, none farther than the over-reach
 * collides, and gradients by both poses agree with differences. */
CASE(gaps_of_tables_are_never_clear_in_an_overlap) {
  rng r = rng_seed(5104);
  static const test_solid_kind kinds[] = {SOLID_CONVEX, SOLID_FOLDED, SOLID_CAPSULE, SOLID_POLYLINE, SOLID_GRID};
  enum { KINDS = sizeof kinds / sizeof *kinds };
  size_t overlapping = 0, clear = 0;
  for (size_t i = 0; i < test_cases(10); i++) {
    test_solid a = solid_make(&r, kinds[rng_index(&r, KINDS)], 3, 1.0, 3.0),
               b = solid_make(&r, kinds[rng_index(&r, KINDS)], 3, 1.0, 3.0);
    cprox_gap *gap = gap_of(a.solid, b.solid, CPROX_GAP_MODE_CERTIFIED, i % 2 ? 17 : 33);
    assert_non_null(gap->table);
    cprox_gap by_sum = *gap;
    by_sum.bounds_a = by_sum.bounds_b = (enclosures){0};
    for (int k = 0; k < 40; k++) {
      const cprox_pose pa = solid_pose(&r, 3, 0.2);
      cprox_pose pb = solid_pose(&r, 3, 1.0);
      const double d = solid_distance(&a, &pa, &b, &pb);
      cprox_gap_result x;
      MADE(cprox_gap_test(&by_sum, &pa, &pb, ws, &x));
      const bool is_clear = x.verdict == CPROX_GAP_VERDICT_CLEAR || x.verdict == CPROX_GAP_VERDICT_FAR;
      overlapping += d < -1e-9, clear += is_clear;
      if (d < -1e-9 && is_clear) fail_msg("%s and %s overlap by %g, clear", solid_name(a.kind), solid_name(b.kind), -d);
      if (!is_clear) assert_true(d <= gap->info.over_reach);
      if (k % 10 != 0) continue;
      MADE(cprox_gap_evaluate(gap, &pa, &pb, ws, &x));
      if (x.verdict == CPROX_GAP_VERDICT_FAR) continue;
      const double h = 1e-6 * gap->info.period;
      const vec3 u = rng_unit(&r);
      cprox_gap_result more, less;
      pb.position = vec_axpy(pb.position, h, u);
      MADE(cprox_gap_evaluate(gap, &pa, &pb, ws, &more));
      pb.position = vec_axpy(pb.position, -2.0 * h, u);
      MADE(cprox_gap_evaluate(gap, &pa, &pb, ws, &less));
      if (more.verdict != CPROX_GAP_VERDICT_FAR && less.verdict != CPROX_GAP_VERDICT_FAR)
        assert_true(fabs((more.value - less.value) / (2.0 * h) - vec_dot(x.position_b, u)) <
                    1e-6 * gap->steepness + gap->info.rounding / h);
    }
    cprox_gap_free(gap);
    solid_free(&a);
    solid_free(&b);
  }
  print_message("%zu overlapping, %zu clear\n", overlapping, clear);
  assert_true(overlapping > 0 && clear > 0);
}

/* A cube of edge 2h in every way that this library takes it. */
enum { WAYS = 6 };
static const char *const WAY[WAYS] = {"box", "mesh", "half-spaces", "two halves", "cells", "region of a body"};

static void make_ways(double h, cprox_solid *way[WAYS]) {
  static const uint32_t faces[12][3] = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                                        {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  vec3 corner[8];
  for (int i = 0; i < 8; i++) corner[i] = vec(i & 4 ? h : -h, i & 2 ? h : -h, i & 1 ? h : -h);
  way[0] = make(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 3, .size = {2 * h, 2 * h, 2 * h}});
  way[1] = make(&(cprox_solid_description){
      .kind = CPROX_SOLID_MESH, .points = corner, .n = 8, .triangles = faces, .n_triangles = 12});
  const double planes[6][4] = {{1, 0, 0, h}, {-1, 0, 0, h}, {0, 1, 0, h}, {0, -1, 0, h}, {0, 0, 1, h}, {0, 0, -1, h}};
  cprox_solid *large =
      make(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 3, .size = {3 * h, 3 * h, 3 * h}});
  way[2] = make(&(cprox_solid_description){.kind = CPROX_SOLID_CLIPPED, .solid = large, .region = planes, .n = 6});
  cprox_solid *half =
      make(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 3, .size = {h, 2 * h, 2 * h}});
  const cprox_solid *const parts[2] = {half, half};
  const cprox_pose poses[2] = {{.position = {-0.5 * h, 0, 0}, .orientation = {1, 0, 0, 0}},
                               {.position = {0.5 * h, 0, 0}, .orientation = {1, 0, 0, 0}}};
  way[3] = make(&(cprox_solid_description){.kind = CPROX_SOLID_UNION, .parts = parts, .poses = poses, .n = 2});
  unsigned char cells[16 * 16 * 16];
  memset(cells, 1, sizeof cells);
  way[4] = make(&(cprox_solid_description){.kind = CPROX_SOLID_GRID,
                                           .dimension = 3,
                                           .lowest = {-h, -h, -h},
                                           .cell = 0.125 * h,
                                           .counts = {16, 16, 16},
                                           .occupied = cells});
  cprox_body *body;
  MADE(cprox_body_create_box((cprox_vec3){2 * h, 2 * h, 2 * h}, ws, &body));
  way[5] = make(&(cprox_solid_description){.kind = CPROX_SOLID_CLIPPED, .solid = way[0], .body = body});
  cprox_body_free(body);
  cprox_solid_free(large);
  cprox_solid_free(half);
}

/* Seed 5105: a ball, and a cube, each approaching a cube in its ways: whatever the way, clear is clear, and colliding
 * ends within the way's own over-reach, which is no more than twice the box's. */
CASE(one_solid_in_several_ways_gives_verdicts_that_agree) {
  rng r = rng_seed(5105);
  for (size_t i = 0; i < test_cases(5); i++) {
    const double h = rng_uniform(&r, 0.1, 1.0);
    cprox_solid *way[WAYS], *other[2];
    make_ways(h, way);
    other[0] = make(&(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = 3, .radius = h});
    other[1] = way[i % WAYS];
    cprox_body *cube, *ball;
    MADE(cprox_body_create_box((cprox_vec3){2 * h, 2 * h, 2 * h}, ws, &cube));
    MADE(cprox_body_create_sphere(h, ws, &ball));
    for (int k = 0; k < 2; k++) {
      double over_reach = 0.0;
      for (int w = 0; w < WAYS; w++) {
        cprox_gap *gap = gap_of(way[w], other[k], CPROX_GAP_MODE_CERTIFIED, 33);
        const cprox_gap_info info = cprox_gap_get_info(gap);
        if (w == 0) over_reach = info.over_reach;
        if (info.over_reach > 2.0 * over_reach)
          fail_msg("cube as %s: over-reach %g, the box %g", WAY[w], info.over_reach, over_reach);
        enclosures_free(&gap->bounds_a);
        enclosures_free(&gap->bounds_b);
        for (int j = 0; j < 12; j++) {
          const cprox_pose a = CPROX_POSE_IDENTITY, b = solid_pose(&r, 3, 4.0 * h);
          const test_solid s = {.body = cube}, t = {.body = k == 0 ? ball : cube};
          const double d = solid_distance(&s, &a, &t, &b);
          cprox_gap_result x;
          MADE(cprox_gap_test(gap, &a, &b, ws, &x));
          const bool is_clear = x.verdict == CPROX_GAP_VERDICT_CLEAR || x.verdict == CPROX_GAP_VERDICT_FAR;
          if (is_clear ? d < -1e-9 : d > info.over_reach)
            fail_msg("cube as %s: %s at a distance of %g", WAY[w], cprox_gap_verdict_name(x.verdict), d);
        }
        cprox_gap_free(gap);
      }
    }
    cprox_body_free(cube);
    cprox_body_free(ball);
    cprox_solid_free(other[0]);
    for (int w = 0; w < WAYS; w++) cprox_solid_free(way[w]);
  }
}

/* Four planes meet in the tip of a roof. */
CASE(a_roof_of_five_planes_is_the_mesh_of_its_corners) {
  const double planes[5][4] = {{0, 0, -1, 0}, {1, 0, 1, 1}, {-1, 0, 1, 1}, {0, 1, 1, 1}, {0, -1, 1, 1}};
  cprox_solid *box = make(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 3, .size = {3, 3, 3}});
  cprox_solid *roof =
      make(&(cprox_solid_description){.kind = CPROX_SOLID_CLIPPED, .solid = box, .region = planes, .n = 5});
  assert_true(fabs(cprox_solid_get_info(roof).measure - 4.0 / 3.0) < 1e-14);
  const vec3 corner[5] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}};
  const uint32_t faces[6][3] = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  cprox_solid *mesh = make(&(cprox_solid_description){
      .kind = CPROX_SOLID_MESH, .points = corner, .n = 5, .triangles = faces, .n_triangles = 6});
  rng r = rng_seed(5106);
  for (int i = 0; i < 50; i++) {
    const vec3 q = vec_scale(rng_uniform(&r, 0.0, 30.0), rng_unit(&r));
    double x[2], y[2];
    MADE(cprox_solid_spectrum(roof, q, ws, x, NULL));
    MADE(cprox_solid_spectrum(mesh, q, ws, y, NULL));
    assert_true(fabs(x[0] - y[0]) < 1e-13 && fabs(x[1] - y[1]) < 1e-13);
  }
  cprox_solid_free(box);
  cprox_solid_free(roof);
  cprox_solid_free(mesh);
}

/* ---- stopping ---- */

static bool stops_at_last(void *user) {
  int *left = user;
  return --*left <= 0;
}

/* Wherever the stop function ends the making of a gap with a table: an error that says so, and nothing is left. */
CASE(making_a_table_can_be_stopped_anywhere) {
  rng r = rng_seed(5107);
  test_solid a = solid_make(&r, SOLID_FOLDED, 3, 1.0, 3.0), b = solid_make(&r, SOLID_POLYLINE, 3, 1.0, 3.0);
  cprox_gap_options o = CPROX_GAP_OPTIONS_DEFAULT;
  o.samples = 17;
  int never = 1 << 30;
  cprox_gap *gap = NULL;
  cprox_workspace_set_stop(ws, stops_at_last, &never);
  MADE(cprox_gap_create(a.solid, b.solid, &o, ws, &gap));
  assert_non_null(gap->table);
  cprox_gap_free(gap);
  const int polls = (1 << 30) - never;
  assert_true(polls > 100);
  for (int stop = 1; stop <= polls; stop += 1 + polls / 40) {
    int left = stop;
    gap = NULL;
    cprox_workspace_set_stop(ws, stops_at_last, &left);
    assert_int_equal(cprox_gap_create(a.solid, b.solid, &o, ws, &gap), CPROX_INVALID);
    assert_non_null(strstr(cprox_workspace_error(ws), "the stop function ended"));
    assert_null(gap);
  }
  cprox_workspace_set_stop(ws, NULL, NULL);
  solid_free(&a);
  solid_free(&b);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
