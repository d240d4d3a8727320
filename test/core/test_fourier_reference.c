/* SPDX-License-Identifier: BSD-3-Clause */
/* Spectra, values and gradients against reference answers computed in numpy from the same corrected formulas by other
 * code. */
#include <stdlib.h>
#include <string.h>

#include "fourier/gap.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/csv.h"

static bool is(const csv_row *row, size_t field, const char *text) {
  return field < row->n && strcmp(row->field[field], text) == 0;
}

static cprox_solid *read_polygon(const csv_table *t, const csv_row *row, size_t field) {
  double v[64][2];
  const size_t n = csv_count(t, row, field);
  assert_true(n <= 64);
  for (size_t i = 0; i < 2 * n; i++) v[i / 2][i % 2] = csv_number(t, row, field + 1 + i);
  cprox_solid *s;
  assert_int_equal(
      cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_POLYGON, .corners = (const double(*)[2])v, .n = n}, ws, &s),
      CPROX_OK);
  return s;
}

static cprox_solid *read_mesh(const csv_table *t, const csv_row *row) {
  const size_t n = csv_count(t, row, 4), m = csv_count(t, row, 5);
  cprox_vec3 *v = malloc(n * sizeof *v);
  uint32_t(*f)[3] = malloc(m * sizeof *f);
  csv_points(t, row, 6, 3, n, v);
  for (size_t i = 0; i < 3 * m; i++) f[i / 3][i % 3] = (uint32_t)csv_count(t, row, 6 + 3 * n + i);
  cprox_solid *s;
  assert_int_equal(
      cprox_solid_create(
          &(cprox_solid_description){
              .kind = CPROX_SOLID_MESH, .points = v, .n = n, .triangles = (const uint32_t(*)[3])f, .n_triangles = m},
          ws, &s),
      CPROX_OK);
  free(v);
  free(f);
  return s;
}

static cprox_solid *read_solid(const csv_table *t, const csv_row *row) {
  const double a = csv_number(t, row, 4), b = row->n > 5 ? csv_number(t, row, 5) : 0,
               c = row->n > 6 ? csv_number(t, row, 6) : 0;
  cprox_solid *s = NULL;
  if (is(row, 3, "polygon")) return read_polygon(t, row, 4);
  if (is(row, 3, "mesh")) return read_mesh(t, row);
  if (is(row, 3, "disk"))
    assert_int_equal(
        cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = 2, .radius = a}, ws, &s),
        CPROX_OK);
  else if (is(row, 3, "box"))
    assert_int_equal(
        cprox_solid_create(
            &(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 3, .size = vec(2 * a, 2 * b, 2 * c)}, ws,
            &s),
        CPROX_OK);
  else if (is(row, 3, "ellipsoid"))
    assert_int_equal(
        cprox_solid_create(
            &(cprox_solid_description){.kind = CPROX_SOLID_ELLIPSOID, .dimension = 3, .semi_axes = vec(a, b, c)}, ws,
            &s),
        CPROX_OK);
  else if (is(row, 3, "cylinder"))
    assert_int_equal(
        cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_CYLINDER, .height = 2 * b, .radius = a}, ws,
                           &s),
        CPROX_OK);
  else
    fail_msg("line %zu: kind %s", row->line, row->field[3]);
  return s;
}

/* All the pieces of one side, as a union. */
static cprox_solid *read_side(const csv_table *t, const char *id, const char *side) {
  cprox_solid *parts[32] = {NULL}, *whole;
  cprox_pose poses[32] = {{{0, 0, 0}, {0, 0, 0, 0}}};
  size_t n = 0;
  for (size_t i = 0; i < t->n; i++) {
    const csv_row *row = &t->row[i];
    if (!is(row, 0, "solid") || !is(row, 1, id) || !is(row, 2, side)) continue;
    parts[n] = read_solid(t, row);
    poses[n++] = CPROX_POSE_IDENTITY;
  }
  assert_int_equal(
      cprox_solid_create(
          &(cprox_solid_description){
              .kind = CPROX_SOLID_UNION, .parts = (const cprox_solid *const *)parts, .poses = poses, .n = n},
          ws, &whole),
      CPROX_OK);
  for (size_t i = 0; i < n; i++) cprox_solid_free(parts[i]);
  return whole;
}

/* The gap of a case with the threshold that this library computes. */
static cprox_gap *read_gap(const csv_table *t, const csv_row *row, int dimension, bool swap) {
  cprox_solid *a = read_side(t, row->field[1], swap ? "b" : "a"), *b = read_side(t, row->field[1], swap ? "a" : "b");
  const gap_plan plan = {.mode = is(row, 3, "kaiser2") ? CPROX_GAP_MODE_CERTIFIED : CPROX_GAP_MODE_TUNED,
                         .dimension = dimension,
                         .N = (int)csv_count(t, row, 2),
                         .beta = csv_number(t, row, 4),
                         .offset = csv_number(t, row, 5),
                         .period = csv_number(t, row, 6),
                         .turned_first = swap}; /* the reference always turns the second */
  double reach;
  cprox_solid *pa = solid_offset(a, 0.0, &reach), *pb = solid_offset(b, 0.0, &reach);
  cprox_gap *gap;
  assert_int_equal(gap_build(&plan, pa, pb, (size_t)1 << 30, ws, &gap), CPROX_OK);
  gap->centre_a = a->centre, gap->centre_b = b->centre;
  gap->radius_a = gap->radius_b = 1e3; /* the reference has values beyond the bounding spheres too */
  cprox_solid_free(a);
  cprox_solid_free(b);
  return gap;
}

static cprox_quat quat_of_angle(double angle) {
  return (cprox_quat){cos(0.5 * angle), 0, 0, sin(0.5 * angle)};
}

/* The quaternion of a rotation matrix, by its largest part. */
static cprox_quat quat_of_matrix(const double m[9]) {
  const double w = 1 + m[0] + m[4] + m[8], x = 1 + m[0] - m[4] - m[8], y = 1 - m[0] + m[4] - m[8],
               z = 1 - m[0] - m[4] + m[8];
  if (w >= x && w >= y && w >= z) return (cprox_quat){w, m[7] - m[5], m[2] - m[6], m[3] - m[1]};
  if (x >= y && x >= z) return (cprox_quat){m[7] - m[5], x, m[1] + m[3], m[2] + m[6]};
  if (y >= z) return (cprox_quat){m[2] - m[6], m[1] + m[3], y, m[5] + m[7]};
  return (cprox_quat){m[3] - m[1], m[2] + m[6], m[5] + m[7], z};
}

static void read_plane_pose(const csv_table *t, const csv_row *row, size_t field, cprox_pose *pose) {
  pose->orientation = quat_of_angle(csv_number(t, row, field));
  pose->position = vec(csv_number(t, row, field + 1), csv_number(t, row, field + 2), 0);
}

static void read_space_pose(const csv_table *t, const csv_row *row, size_t field, cprox_pose *pose) {
  double m[9];
  for (size_t i = 0; i < 9; i++) m[i] = csv_number(t, row, field + i);
  pose->orientation = quat_of_matrix(m);
  csv_points(t, row, field + 9, 3, 1, &pose->position);
}

/* V and its four gradients in the order of the row, times t. */
static size_t read_expected(const csv_table *t, const csv_row *row, int dimension, double out[13]) {
  const size_t from = dimension == 2 ? 8 : 26, n = dimension == 2 ? 7 : 13;
  for (size_t i = 0; i < n; i++) out[i] = csv_number(t, row, from + i);
  return n;
}

static void computed(const cprox_gap_result *r, int dimension, bool swap, double out[13]) {
  const vec3 pa = swap ? r->position_b : r->position_a, wa = swap ? r->rotation_b : r->rotation_a;
  const vec3 pb = swap ? r->position_a : r->position_b, wb = swap ? r->rotation_a : r->rotation_b;
  if (dimension == 2) {
    const double v[7] = {r->value, pa.x, pa.y, wa.z, pb.x, pb.y, wb.z};
    memcpy(out, v, sizeof v);
  } else {
    const double v[13] = {r->value, pa.x, pa.y, pa.z, wa.x, wa.y, wa.z, pb.x, pb.y, pb.z, wb.x, wb.y, wb.z};
    memcpy(out, v, sizeof v);
  }
}

/* Value within 1e-9 t; gradients within 1e-9 max(|gradient|, t/rho): the accuracy the reference is stated with. */
static void compare(const csv_table *t, const csv_row *row, const cprox_gap *gap, double threshold, double rho,
                    int dimension, bool swap) {
  cprox_pose a, b;
  if (dimension == 2) {
    read_plane_pose(t, row, 2, &a);
    read_plane_pose(t, row, 5, &b);
  } else {
    read_space_pose(t, row, 2, &a);
    read_space_pose(t, row, 14, &b);
  }
  cprox_gap_result r;
  assert_int_equal(cprox_gap_evaluate(gap, swap ? &b : &a, swap ? &a : &b, ws, &r), CPROX_OK);
  double expected[13], got[13], size = threshold / rho;
  const size_t n = read_expected(t, row, dimension, expected);
  computed(&r, dimension, swap, got);
  for (size_t i = 1; i < n; i++) size = fmax(size, fabs(expected[i]));
  for (size_t i = 0; i < n; i++) {
    const double tolerance = 1e-9 * (i == 0 ? threshold : size);
    if (!(fabs(got[i] * threshold - expected[i]) <= tolerance))
      fail_msg("line %zu, number %zu: %.17g, expected %.17g (tolerance %g)", row->line, i, got[i] * threshold,
               expected[i], tolerance);
  }
}

static void check_file(const char *name, int dimension, size_t least) {
  csv_table t = csv_read(name);
  size_t compared = 0;
  for (int swap = 0; swap < 2; swap++) {
    cprox_gap *gap = NULL;
    double threshold = 0, rho = 0;
    for (size_t i = 0; i < t.n; i++) {
      const csv_row *row = &t.row[i];
      if (is(row, 0, "case")) {
        cprox_gap_free(gap);
        gap = read_gap(&t, row, dimension, swap);
        rho = csv_number(&t, row, 5), threshold = csv_number(&t, row, 7);
        const double own = cprox_gap_get_info(gap).threshold;
        if (!(fabs(own - threshold) <= 1e-12 * threshold)) fail_msg("line %zu: threshold %.17g", row->line, own);
      }
      if (!is(row, 0, "pose")) continue;
      compare(&t, row, gap, threshold, rho, dimension, swap);
      compared++;
    }
    cprox_gap_free(gap);
  }
  assert_true(compared >= 2 * least);
  csv_free(&t);
}

CASE(gaps_in_the_plane_agree_with_the_reference_in_either_role) {
  check_file("fourier/gap_2d.csv", 2, 160);
}

CASE(gaps_in_space_agree_with_the_reference_in_either_role) {
  check_file("fourier/gap_3d.csv", 3, 80);
}

/* 80 frequencies up to |q| = 500: within 1e-12 of the area, the reference's own error at tiny frequencies (2e-13, where
 * symmetry makes the imaginary part vanish). */
CASE(spectra_of_polygons_agree_with_the_reference) {
  csv_table t = csv_read("fourier/spectrum_2d.csv");
  size_t compared = 0;
  for (size_t i = 0; i < t.n; i++) {
    const csv_row *row = &t.row[i];
    if (!is(row, 0, "wave")) continue;
    const vec3 q = vec(csv_number(&t, row, 2), csv_number(&t, row, 3), 0);
    double re = 0, im = 0, area = 0;
    for (size_t j = 0; j < t.n; j++) {
      if (!is(&t.row[j], 0, "shape") || !is(&t.row[j], 1, row->field[1])) continue;
      cprox_solid *s = read_polygon(&t, &t.row[j], 2);
      double f[2];
      assert_int_equal(cprox_solid_spectrum(s, q, ws, f, NULL), CPROX_OK);
      re += f[0], im += f[1], area += cprox_solid_get_info(s).measure;
      cprox_solid_free(s);
    }
    assert_true(area > 0.0);
    if (!(hypot(re - csv_number(&t, row, 4), im - csv_number(&t, row, 5)) <= 1e-12 * area))
      fail_msg("line %zu: (%.17g, %.17g)", row->line, re, im);
    compared++;
  }
  assert_true(compared >= 80);
  csv_free(&t);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
