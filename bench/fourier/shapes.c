/* SPDX-License-Identifier: BSD-3-Clause */
#include "fourier/shapes.h"

#include <math.h>
#include <stdlib.h>

static void add_piece(shape *s, int n, const double (*v)[2]) {
  for (int i = 0; i < n; i++) s->v[s->n][i][0] = v[i][0], s->v[s->n][i][1] = v[i][1];
  s->corners[s->n++] = n;
}

static void add_box(shape *s, double x0, double y0, double x1, double y1) {
  const double v[4][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  add_piece(s, 4, v);
}

static void add_star(shape *s) {
  for (int i = 0; i < 5; i++) {
    const double a = 1.5707963267948966 + 1.2566370614359172 * i, h = 0.6283185307179586;
    const double v[4][2] = {
        {0, 0}, {0.4 * cos(a - h), 0.4 * sin(a - h)}, {cos(a), sin(a)}, {0.4 * cos(a + h), 0.4 * sin(a + h)}};
    add_piece(s, 4, v);
  }
}

void shapes_create(shape shapes[SHAPES]) {
  for (int i = 0; i < SHAPES; i++) shapes[i] = (shape){.n = 0};
  shapes[0].name = "L", add_box(&shapes[0], -0.5, -0.5, 0.85, -0.1), add_box(&shapes[0], -0.5, -0.1, -0.1, 0.85);
  shapes[1].name = "T", add_box(&shapes[1], -0.7, 0.3, 0.7, 0.7), add_box(&shapes[1], -0.2, -0.7, 0.2, 0.3);
  shapes[2].name = "E", add_box(&shapes[2], -0.6, -0.8, -0.25, 0.8), add_box(&shapes[2], -0.25, -0.8, 0.6, -0.48);
  add_box(&shapes[2], -0.25, -0.16, 0.6, 0.16), add_box(&shapes[2], -0.25, 0.48, 0.6, 0.8);
  shapes[3].name = "star", add_star(&shapes[3]);
  shapes[4].name = "hexagon";
  double hexagon[6][2];
  for (int i = 0; i < 6; i++) hexagon[i][0] = cos(1.0471975511965976 * i), hexagon[i][1] = sin(1.0471975511965976 * i);
  add_piece(&shapes[4], 6, (const double(*)[2])hexagon);
  shapes[5].name = "rod", add_box(&shapes[5], -1, -0.04, 1, 0.04);

  for (int i = 0; i < SHAPES; i++) {
    cprox_solid *parts[SHAPE_PIECES];
    cprox_pose poses[SHAPE_PIECES];
    for (int j = 0; j < shapes[i].n; j++) {
      poses[j] = CPROX_POSE_IDENTITY;
      if (cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_POLYGON,
                                                        .corners = (const double(*)[2])shapes[i].v[j],
                                                        .n = (size_t)shapes[i].corners[j]},
                             NULL, &parts[j]))
        abort();
    }
    if (cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_UNION,
                                                      .parts = (const cprox_solid *const *)parts,
                                                      .poses = poses,
                                                      .n = (size_t)shapes[i].n},
                           NULL, &shapes[i].solid))
      abort();
    for (int j = 0; j < shapes[i].n; j++) cprox_solid_free(parts[j]);
  }
}

void shapes_free(shape shapes[SHAPES]) {
  for (int i = 0; i < SHAPES; i++) cprox_solid_free(shapes[i].solid);
}

cprox_pose shape_pose(double x, double y, double angle) {
  return (cprox_pose){.position = {x, y, 0}, .orientation = {cos(0.5 * angle), 0, 0, sin(0.5 * angle)}};
}

static void place(const shape *s, int piece, const cprox_pose *p, double out[SHAPE_CORNERS][2]) {
  const double w = p->orientation.w, z = p->orientation.z, norm = w * w + z * z, c = (w * w - z * z) / norm,
               n = 2 * w * z / norm;
  for (int j = 0; j < s->corners[piece]; j++) {
    const double x = s->v[piece][j][0], y = s->v[piece][j][1];
    out[j][0] = p->position.x + c * x - n * y, out[j][1] = p->position.y + n * x + c * y;
  }
}

/* The widest gap along an edge normal of the first. */
static double widest(double (*a)[2], int n, double (*b)[2], int m) {
  double most = -INFINITY;
  for (int i = 0; i < n; i++) {
    const double dx = a[(i + 1) % n][0] - a[i][0], dy = a[(i + 1) % n][1] - a[i][1], length = hypot(dx, dy);
    double least = INFINITY;
    for (int j = 0; j < m; j++) least = fmin(least, ((b[j][0] - a[i][0]) * dy - (b[j][1] - a[i][1]) * dx) / length);
    most = fmax(most, least);
  }
  return most;
}

static double corner_to_edges(const double p[2], double (*a)[2], int n) {
  double best = INFINITY;
  for (int i = 0; i < n; i++) {
    const double dx = a[(i + 1) % n][0] - a[i][0], dy = a[(i + 1) % n][1] - a[i][1], px = p[0] - a[i][0],
                 py = p[1] - a[i][1];
    const double s = fmin(1, fmax(0, (px * dx + py * dy) / (dx * dx + dy * dy)));
    best = fmin(best, hypot(px - s * dx, py - s * dy));
  }
  return best;
}

double shape_distance(const shape *a, const cprox_pose *pa, const shape *b, const cprox_pose *pb) {
  double best = INFINITY;
  for (int i = 0; i < a->n; i++)
    for (int j = 0; j < b->n; j++) {
      double p[SHAPE_CORNERS][2], q[SHAPE_CORNERS][2];
      place(a, i, pa, p);
      place(b, j, pb, q);
      const int n = a->corners[i], m = b->corners[j];
      double d = fmax(widest(p, n, q, m), widest(q, m, p, n));
      if (d > 0) {
        d = INFINITY;
        for (int k = 0; k < n; k++) d = fmin(d, corner_to_edges(p[k], q, m));
        for (int k = 0; k < m; k++) d = fmin(d, corner_to_edges(q[k], p, n));
      }
      best = fmin(best, d);
    }
  return best;
}
