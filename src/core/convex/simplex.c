/* SPDX-License-Identifier: BSD-3-Clause */
/* Signed areas and volumes about the foot of the perpendicular; a region is only left out when its sign says so beyond
 * doubt, and of the candidates that remain the nearest wins: so the answer is always a point of the simplex. */
#include "convex/simplex.h"

#include "base/rounding.h"
#include "convex/double_double_cross.h"
#include "convex/feature.h"

const vec3 simplex_spread[4] = {{0.46, 0.71, 0.53}, {0.62, -0.49, -0.61}, {-0.73, 0.41, -0.55}, {-0.35, -0.63, 0.69}};

bool simplex_has(const simplex *s, vec3 w) {
  for (int i = 0; i < s->n; i++)
    if (vec_equal(s->vertex[i].w, w)) return true;
  return false;
}

/* The nearest point found so far, on a vertex, edge or triangle of the simplex. */
typedef struct candidate {
  int n;
  int index[3];
  double weight[3];
  vec3 v;
  double square;
  const struct face *face; /* the triangle's, where n is 3 */
} candidate;

static void candidate_offer(candidate *best, const simplex *s, int n, const int index[3], const double weight[3]) {
  vec3 v = vec(0, 0, 0);
  for (int i = 0; i < n; i++) v = vec_axpy(v, weight[i], s->vertex[index[i]].w);
  const double square = vec_norm2(v);
  if (best->n > 0 && square >= best->square) return;
  *best = (candidate){.n = n, .v = v, .square = square, .face = best->face};
  for (int i = 0; i < n; i++) {
    best->index[i] = index[i];
    best->weight[i] = weight[i];
  }
}

static void try_vertex(candidate *best, const simplex *s, int i) {
  candidate_offer(best, s, 1, (int[3]){i}, (double[3]){1.0});
}

static void try_segment(candidate *best, const simplex *s, int i, int j) {
  const vec3 wi = s->vertex[i].w, wj = s->vertex[j].w, e = vec_sub(wj, wi);
  const double from_i = -vec_dot(wi, e), from_j = vec_dot(wj, e);
  if (!(from_i > 0.0)) {
    try_vertex(best, s, i);
  } else if (!(from_j > 0.0)) {
    try_vertex(best, s, j);
  } else {
    const double t = from_i / (from_i + from_j);
    candidate_offer(best, s, 2, (int[3]){i, j}, (double[3]){1.0 - t, t});
  }
}

/* The normal of a triangle from its two shorter edges, which meet at `corner`. */
typedef struct face {
  double length; /* of the normal */
  double noise;  /* the normal's rounding error */
  vec3 normal;   /* not a unit vector: twice the area long */
  int corner;
  bool sliver;
} face;

/* In a sliver the edges are all but parallel, and the rounding of their product outweighs it. */
static const double FACE_SLIVER = 0.1;

static face face_of(const simplex *s, const int index[3]) {
  vec3 edge[3]; /* edge[m] is opposite index[m] */
  double square[3];
  int longest = 0;
  for (int m = 0; m < 3; m++) {
    edge[m] = vec_sub(s->vertex[index[(m + 2) % 3]].w, s->vertex[index[(m + 1) % 3]].w);
    square[m] = vec_norm2(edge[m]);
    if (square[m] > square[longest]) longest = m;
  }
  const int p = (longest + 1) % 3, q = (longest + 2) % 3;
  const double size = sqrt(square[p] * square[q]);
  face f = {.normal = vec_cross(edge[p], edge[q]), .corner = index[longest], .noise = 4.0 * ROUND_U * size};
  f.length = vec_norm(f.normal);
  if (f.length >= FACE_SLIVER * size) return f;
  f.normal = double_double_cross(s->vertex[index[longest]].w, s->vertex[index[p]].w, s->vertex[index[q]].w);
  f.length = vec_norm(f.normal);
  f.sliver = true;
  f.noise = 4.0 * ROUND_U * f.length + 64.0 * ROUND_U * ROUND_U * size;
  return f;
}

/* A triangle whose area is all rounding has no inside. */
static bool face_is_degenerate(const face *f) {
  return !(f->length > f->noise);
}

/* Of three vertices the one nearest to 0. */
static vec3 nearest_of(const simplex *s, const int index[3]) {
  vec3 nearest = s->vertex[index[0]].w;
  for (int m = 1; m < 3; m++)
    if (vec_norm2(s->vertex[index[m]].w) < vec_norm2(nearest)) nearest = s->vertex[index[m]].w;
  return nearest;
}

/* f: the face of i, j and k. */
static void try_triangle(candidate *best, const simplex *s, int i, int j, int k, const face *f) {
  const int index[3] = {i, j, k};
  const double area2 = vec_norm2(f->normal);
  if (face_is_degenerate(f)) {
    for (int m = 0; m < 3; m++) try_segment(best, s, index[(m + 1) % 3], index[(m + 2) % 3]);
    return;
  }

  /* areas of the triangles that the foot of 0 makes with the edges, each opposite a vertex; the foot is measured from
   * the nearest vertex, so that beside a vertex it is exact to what it is away from it */
  const vec3 foot = vec_scale(vec_dot(f->normal, nearest_of(s, index)) / area2, f->normal);
  vec3 to[3];
  for (int m = 0; m < 3; m++) to[m] = vec_sub(s->vertex[index[m]].w, foot);
  double area[3];
  bool outside = false;
  for (int m = 0; m < 3; m++) {
    area[m] = vec_dot(f->normal, vec_cross(to[(m + 1) % 3], to[(m + 2) % 3])) / area2;
    if (area[m] <= 0.0) outside = true;
    if (area[m] > 0.0 && !f->sliver) continue; /* a sliver's areas are not to be trusted alone */
    try_segment(best, s, index[(m + 1) % 3], index[(m + 2) % 3]);
  }
  if (outside) return;

  /* inside: the weight of the corner first, then the place along the longest edge, opposite, measured so that it takes
   * up the first one's rounding: in a needle the areas alone would put the point far along it */
  const int a = f->corner == i ? 0 : f->corner == j ? 1 : 2, b = (a + 1) % 3, c = (a + 2) % 3;
  const vec3 base = vec_sub(to[c], to[b]);
  double weight[3];
  weight[a] = lesser(area[a], 1.0);
  const vec3 rest = vec_axpy(vec_neg(to[b]), -weight[a], vec_sub(to[a], to[b]));
  weight[c] = lesser(greater(vec_dot(rest, base) / vec_norm2(base), 0.0), 1.0 - weight[a]);
  weight[b] = greater(1.0 - weight[a] - weight[c], 0.0);
  candidate_offer(best, s, 3, index, weight);
  if (best->n == 3 && best->index[0] == i && best->index[1] == j && best->index[2] == k) best->face = f;
}

/* On which side of the face opposite vertex i does 0 lie, how far, and how far compared with the vertex? */
typedef enum face_side { FACE_INNER, FACE_OUTER, FACE_UNCLEAR } face_side;

static face_side tetrahedron_side(const simplex *s, int i, const face *f, double *depth, double *weight) {
  const vec3 corner = s->vertex[f->corner].w, apex = vec_sub(s->vertex[i].w, corner);
  const double side = vec_dot(f->normal, apex), origin = -vec_dot(f->normal, corner);

  /* of a product with the normal, per unit of the vector */
  const double doubt = 2.0 * f->noise + 4.0 * ROUND_U * f->length;
  if (face_is_degenerate(f) || !(fabs(side) > doubt * vec_norm(apex))) return FACE_UNCLEAR;
  *weight = origin / side;
  const double inner = side > 0.0 ? origin : -origin, noise = doubt * vec_norm(corner);
  *depth = (inner - noise) / f->length;
  return inner > noise ? FACE_INNER : inner < -noise ? FACE_OUTER : FACE_UNCLEAR;
}

/* True where 0 is proven inside; else the faces that it may be beyond are tried. Face i is opposite vertex i. */
static bool try_tetrahedron(candidate *best, simplex *s, face f[4], double *depth) {
  face_side side[4];
  bool unclear = false, inside = true;
  *depth = INFINITY;
  for (int i = 0; i < 4; i++) {
    double d = 0.0;
    f[i] = face_of(s, (const int[3]){(i + 1) % 4, (i + 2) % 4, (i + 3) % 4});
    side[i] = tetrahedron_side(s, i, &f[i], &d, &s->weight[i]);
    unclear |= side[i] == FACE_UNCLEAR;
    inside &= side[i] == FACE_INNER;
    *depth = lesser(d, *depth);
  }

  /* each w is within u|w| of the exact difference: moving all vertices by so much shrinks the ball by no more */
  double reach = 0.0;
  for (int i = 0; i < 4; i++) reach = greater(vec_norm(s->vertex[i].w), reach);
  *depth = *depth * (1.0 - 8.0 * ROUND_U) - 4.0 * ROUND_U * reach;
  if (inside && *depth > 0.0) {
    const double sum = s->weight[0] + s->weight[1] + s->weight[2] + s->weight[3];
    for (int i = 0; i < 4; i++) s->weight[i] /= sum;
    return true;
  }

  /* a flat tetrahedron says nothing: all of its faces are tried */
  const bool all = unclear || inside;
  for (int i = 0; i < 4; i++)
    if (all || side[i] == FACE_OUTER) try_triangle(best, s, (i + 1) % 4, (i + 2) % 4, (i + 3) % 4, &f[i]);
  return false;
}

/* v without its part along e, twice: where v is short the first pass leaves rounding along e that its unit would
 * magnify. */
static vec3 across_edge(vec3 v, vec3 e) {
  const double square = vec_norm2(e);
  vec3 unit;
  feature_unit(vec_axpy(v, -(vec_dot(v, e) / square), e), &unit);
  return vec_axpy(unit, -(vec_dot(unit, e) / square), e);
}

/* The direction of the feature's distance from 0; f: the face of three vertices. */
static vec3 feature_normal(const simplex *s, vec3 v, const face *f) {
  vec3 unit;
  if (s->n == 2) {
    const vec3 a = s->vertex[0].w, b = s->vertex[1].w;
    v = across_edge(vec_norm2(a) < vec_norm2(b) ? a : b, vec_sub(b, a));
  } else if (s->n == 3) {
    const double along = vec_dot(f->normal, nearest_of(s, (const int[3]){0, 1, 2}));
    v = along > 0.0 ? f->normal : along < 0.0 ? vec_neg(f->normal) : vec(0, 0, 0);
  }
  feature_unit(v, &unit);
  return unit;
}

/* Keeps the vertices that the nearest point needs. */
static void simplex_keep(simplex *s, const candidate *best) {
  simplex_vertex vertex[3];
  int n = 0;
  for (int i = 0; i < best->n; i++) {
    if (best->weight[i] == 0.0) continue;
    vertex[n] = s->vertex[best->index[i]];
    s->weight[n++] = best->weight[i];
  }
  for (int i = 0; i < n; i++) s->vertex[i] = vertex[i];
  s->n = n;
}

void simplex_reduce(simplex *s, simplex_nearest *nearest) {
  face f[4];
  candidate best = {.face = f};
  *nearest = (simplex_nearest){0};
  if (s->n == 1) try_vertex(&best, s, 0);
  if (s->n == 2) try_segment(&best, s, 0, 1);
  if (s->n == 3) {
    f[0] = face_of(s, (const int[3]){0, 1, 2});
    try_triangle(&best, s, 0, 1, 2, &f[0]);
  }
  if (s->n == 4 && try_tetrahedron(&best, s, f, &nearest->depth)) {
    nearest->inside = true;
    return;
  }
  simplex_keep(s, &best);
  nearest->v = best.v;
  nearest->distance = vec_norm(best.v);
  nearest->normal = feature_normal(s, best.v, best.face);
}
