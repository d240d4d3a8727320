/* SPDX-License-Identifier: BSD-3-Clause */
#include "bvh/winding.h"

#include <stdlib.h>

#include "base/rotation.h"
#include "base/rounding.h"

/* The dipole of a lane's triangles. */
typedef struct dipole {
  vec3 normal; /* sum of the area vectors */
  vec3 centre; /* weighted by area */
  double area;
  double radius; /* about the centre, of the lane's box */
} dipole;

struct winding {
  size_t n;
  dipole *dipoles; /* TREE_LANES a node */
};

/* Whole multiples of 4 pi are wanted: an error of this much of one is harmless. */
static const double HARMLESS = 0.25;

static const double FULL_ANGLE = 12.566370614359172;

/* ---- building ---- */

static void add_triangle(dipole *d, const vec3 v[3]) {
  const vec3 normal = vec_scale(0.5, vec_cross(vec_sub(v[1], v[0]), vec_sub(v[2], v[0])));
  const double area = vec_norm(normal);
  d->normal = vec_add(d->normal, normal);
  d->centre = vec_axpy(d->centre, area / 3.0, vec_add(v[0], vec_add(v[1], v[2])));
  d->area += area;
}

static bool is_repeated(const tree *t, uint32_t pack, uint32_t lane) {
  const uint32_t *ids = t->ids + (size_t)pack * TREE_LANES;
  return lane > 0 && ids[lane] == ids[lane - 1];
}

static void add_pack(const tree *t, uint32_t pack, dipole *d) {
  for (uint32_t lane = 0; lane < TREE_LANES && !is_repeated(t, pack, lane); lane++) {
    vec3 v[3];
    tree_corners(t, (tree_place){pack, lane}, v);
    add_triangle(d, v);
  }
}

/* Centres are sums here, until a lane is done. */
static dipole sum_of_child(const winding *w, const tree *t, uint32_t child) {
  dipole sum = {.area = 0.0};
  if (child & TREE_LEAF) {
    add_pack(t, child & ~TREE_LEAF, &sum);
    return sum;
  }
  const tree_node *node = &t->nodes[child];
  for (uint32_t l = 0; l < TREE_LANES; l++) {
    if (!(node->lanes >> l & 1u)) continue;
    const dipole *d = &w->dipoles[(size_t)child * TREE_LANES + l];
    sum.normal = vec_add(sum.normal, d->normal);
    sum.centre = vec_axpy(sum.centre, d->area, d->centre);
    sum.area += d->area;
  }
  return sum;
}

static double farther(double centre, double low, double high) {
  return fmax(fabs(centre - low), fabs(high - centre));
}

winding *winding_create(const tree *t) {
  winding *w = calloc(1, sizeof *w);
  if (!w) return NULL;
  w->n = t->n_nodes;
  w->dipoles = calloc(t->n_nodes * TREE_LANES, sizeof *w->dipoles);
  if (!w->dipoles) {
    winding_free(w);
    return NULL;
  }
  /* children stand behind their parents */
  for (size_t i = t->n_nodes; i-- > 0;) {
    const tree_node *node = &t->nodes[i];
    for (uint32_t l = 0; l < TREE_LANES; l++) {
      if (!(node->lanes >> l & 1u)) continue;
      dipole d = sum_of_child(w, t, node->child[l]);
      const vec3 low = vec(node->low[0][l], node->low[1][l], node->low[2][l]);
      const vec3 high = vec(node->high[0][l], node->high[1][l], node->high[2][l]);
      d.centre = d.area > 0.0 ? vec_scale(1.0 / d.area, d.centre) : low;
      d.radius = vec_norm(vec(farther(d.centre.x, low.x, high.x), farther(d.centre.y, low.y, high.y),
                              farther(d.centre.z, low.z, high.z)));
      w->dipoles[i * TREE_LANES + l] = d;
    }
  }
  return w;
}

void winding_free(winding *w) {
  if (!w) return;
  free(w->dipoles);
  free(w);
}

size_t winding_bytes_needed(size_t n_nodes) {
  return sizeof(winding) + n_nodes * TREE_LANES * sizeof(dipole);
}

size_t winding_bytes(const winding *w) {
  return w ? winding_bytes_needed(w->n) : 0;
}

/* ---- asking ---- */

/* The solid angle of a triangle seen from x (van Oosterom and Strackee 1983). */
static double solid_angle(vec3 x, const vec3 v[3]) {
  const vec3 a = vec_sub(v[0], x), b = vec_sub(v[1], x), c = vec_sub(v[2], x);
  const double la = vec_norm(a), lb = vec_norm(b), lc = vec_norm(c);
  const double volume = vec_dot(a, vec_cross(b, c));
  return 2.0 * atan2(volume, la * lb * lc + vec_dot(a, b) * lc + vec_dot(b, c) * la + vec_dot(c, a) * lb);
}

static double pack_angle(const tree *t, uint32_t pack, vec3 x) {
  double sum = 0.0;
  for (uint32_t lane = 0; lane < TREE_LANES && !is_repeated(t, pack, lane); lane++) {
    vec3 v[3];
    tree_corners(t, (tree_place){pack, lane}, v);
    sum += solid_angle(x, v);
  }
  return sum;
}

/* The winding number, dipoles standing for lanes that are beyond `far` radii; *error bounds what that costs. */
static double winding_number(const winding *w, const tree *t, vec3 x, double far, double *error) {
  uint32_t open[TREE_LANES * TREE_DEEPEST];
  size_t count = 0;
  double sum = 0.0;
  *error = 0.0;
  open[count++] = 0;
  while (count > 0) {
    const uint32_t at = open[--count];
    if (at & TREE_LEAF) {
      sum += pack_angle(t, at & ~TREE_LEAF, x);
      continue;
    }
    const tree_node *node = &t->nodes[at];
    for (uint32_t l = 0; l < TREE_LANES; l++) {
      if (!(node->lanes >> l & 1u)) continue;
      const dipole *d = &w->dipoles[(size_t)at * TREE_LANES + l];
      const vec3 r = vec_sub(d->centre, x);
      const double length = vec_norm(r), clear = length - d->radius;
      if (!(length > far * d->radius && clear > 0.0)) {
        open[count++] = node->child[l];
        continue;
      }
      /* n·y/|y|^3 about the centre: its derivative by y is at most 2/|y|^3 */
      sum += vec_dot(d->normal, r) / (length * length * length);
      *error += 2.0 * d->area * d->radius / (clear * clear * clear);
    }
  }
  *error /= FULL_ANGLE;
  return sum / FULL_ANGLE;
}

/* ---- by a ray ---- */

/* Directions that no edge of a drawing has. */
static const vec3 RAYS[] = {{0.5377, 0.7419, 0.4006}, {-0.3121, 0.6233, -0.7170}, {0.6011, -0.4127, 0.6843}};

typedef enum crossing { CROSSING_NONE, CROSSING_UP, CROSSING_DOWN, CROSSING_UNSURE } crossing;

/* How the ray x + t u, t > 0, goes through a triangle whose corners, seen from x, are v, each known to within `grain`.
 * Unsure: too near to an edge, or x to the triangle. */
static crossing cross_triangle(const vec3 v[3], vec3 u, double grain) {
  const double size[3] = {vec_norm(v[0]), vec_norm(v[1]), vec_norm(v[2])};
  int up = 0, down = 0;
  for (int i = 0; i < 3; i++) {
    const int k = (i + 1) % 3;
    const double side = vec_dot(u, vec_cross(v[i], v[k]));
    const double error = TREE_ROUND * ROUND_U * size[i] * size[k] + grain * (size[i] + size[k]);
    up += side > error;
    down += side < -error;
  }
  if (up > 0 && down > 0) return CROSSING_NONE;
  if (up < 3 && down < 3) return CROSSING_UNSURE;
  const double volume = vec_dot(v[0], vec_cross(v[1], v[2]));
  const double error = TREE_ROUND * ROUND_U * size[0] * size[1] * size[2] +
                       grain * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0]);
  if (!(fabs(volume) > error)) return CROSSING_UNSURE;
  if ((volume > 0.0) != (up == 3)) return CROSSING_NONE;
  return up == 3 ? CROSSING_UP : CROSSING_DOWN;
}

/* Does the ray come into the lane's box, made larger by `grain`? No component of u is 0. */
static bool meets_lane(const tree_node *node, uint32_t l, const double x[3], const double u[3], double grain) {
  double enter = 0.0, leave = INFINITY;
  for (int k = 0; k < 3; k++) {
    const double low = (node->low[k][l] - grain - x[k]) / u[k], high = (node->high[k][l] + grain - x[k]) / u[k];
    enter = greater(enter, lesser(low, high));
    leave = lesser(leave, greater(low, high));
  }
  return enter <= leave;
}

/* How often a closed surface winds round x: its crossings with a ray from there, in one direction less those in the
 * other. false: one of them is unsure. */
static bool count_crossings(const tree *t, vec3 x, vec3 u, int *number) {
  static const double WIDER = 8.0;
  const double from[3] = {x.x, x.y, x.z}, along[3] = {u.x, u.y, u.z};
  const double grain = TREE_ROUND * ROUND_U * (vec_norm(x) + t->scale);
  uint32_t open[TREE_LANES * TREE_DEEPEST];
  size_t count = 0;
  *number = 0;
  open[count++] = 0;
  while (count > 0) {
    const uint32_t at = open[--count];
    if (!(at & TREE_LEAF)) {
      const tree_node *node = &t->nodes[at];
      for (uint32_t l = 0; l < TREE_LANES; l++)
        if ((node->lanes >> l & 1u) && meets_lane(node, l, from, along, WIDER * grain)) open[count++] = node->child[l];
      continue;
    }
    const uint32_t pack = at & ~TREE_LEAF;
    for (uint32_t lane = 0; lane < TREE_LANES && !is_repeated(t, pack, lane); lane++) {
      vec3 v[3];
      tree_corners(t, (tree_place){pack, lane}, v);
      for (int i = 0; i < 3; i++) v[i] = vec_sub(v[i], x);
      const crossing found = cross_triangle(v, u, grain);
      if (found == CROSSING_UNSURE) return false;
      *number += (found == CROSSING_UP) - (found == CROSSING_DOWN);
    }
  }
  return true;
}

/* ---- inside or outside ---- */

/* By a ray in a microsecond; by solid angles, which take hundreds, where all rays come too near to an edge. */
bool winding_is_inside(const winding *w, const tree *t, vec3 x) {
  for (size_t i = 0; i < sizeof RAYS / sizeof RAYS[0]; i++) {
    int crossings;
    if (count_crossings(t, x, RAYS[i], &crossings)) return crossings != 0;
  }
  double error = INFINITY, number = 0.0;
  for (double far = 2.0; far < 100.0 && !(error < HARMLESS); far *= 3.0) number = winding_number(w, t, x, far, &error);
  if (!(error < HARMLESS)) number = winding_number(w, t, x, INFINITY, &error);
  return fabs(number) > 0.5;
}

/* ---- one or the other side ---- */

/* How far x is from the smallest box round the tree; 0 inside of it. */
static double from_root(const tree *t, vec3 x) {
  const tree_node *root = &t->nodes[0];
  const double at[3] = {x.x, x.y, x.z};
  double out[3];
  for (int k = 0; k < 3; k++) {
    double low = root->low[k][0], high = root->high[k][0];
    for (int l = 1; l < TREE_LANES; l++) low = lesser(low, root->low[k][l]), high = greater(high, root->high[k][l]);
    out[k] = greater(greater(low - at[k], at[k] - high), 0.0);
  }
  return vec_norm(vec(out[0], out[1], out[2]));
}

/* The side of all points of a ball. The winding number is computed farther from the surface than rounding. */
static winding_side side_of_ball(const winding *w, const tree *t, vec3 centre, double radius, double error) {
  static const double FARTHER = 4.0;
  const double sizes = vec_norm(centre) + t->scale + radius;
  double clear = ROUND_UP * (radius + FARTHER * (error + 2.0 * TREE_ROUND * ROUND_U * sizes));
  if (from_root(t, centre) > clear) return WINDING_OUTSIDE;
  const tree_hit hit = tree_nearest(t, centre, INFINITY);
  clear += FARTHER * TREE_ROUND * ROUND_U * hit.upper;
  if (!(hit.lower > clear)) return WINDING_NEAR;
  return winding_is_inside(w, t, centre) ? WINDING_INSIDE : WINDING_OUTSIDE;
}

winding_side winding_side_of(const winding *w, const tree *t, vec3 x, double error) {
  return side_of_ball(w, t, x, 0.0, error);
}

static vec3 to_host(const winding_guest *guest, vec3 x) {
  return vec_add(rotate(guest->r, x), guest->at);
}

/* A corner of an element stands for all of the element. */
static winding_side side_of_pack(const winding *w, const tree *t, const winding_guest *guest, uint32_t pack,
                                 vec3 *point) {
  winding_side all = WINDING_OUTSIDE;
  for (uint32_t lane = 0; lane < TREE_LANES && !is_repeated(guest->elements, pack, lane); lane++) {
    vec3 corner[3];
    tree_corners(guest->elements, (tree_place){pack, lane}, corner);
    *point = corner[0];
    const winding_side side = winding_side_of(w, t, to_host(guest, corner[0]), guest->error);
    if (side == WINDING_INSIDE) return side;
    if (side == WINDING_NEAR) all = side;
  }
  return all;
}

static winding_side side_of_lane(const winding *w, const tree *t, const winding_guest *guest, const tree_node *node,
                                 uint32_t l) {
  const vec3 low = vec(node->low[0][l], node->low[1][l], node->low[2][l]);
  const vec3 high = vec(node->high[0][l], node->high[1][l], node->high[2][l]);
  const vec3 middle = vec_lerp(low, high, 0.5);
  return side_of_ball(w, t, to_host(guest, middle), ROUND_UP * vec_norm(vec_sub(high, middle)), guest->error);
}

static vec3 first_corner(const tree *t, uint32_t at) {
  vec3 corner[3];
  while (!(at & TREE_LEAF)) at = t->nodes[at].child[0];
  tree_corners(t, (tree_place){at & ~TREE_LEAF, 0}, corner);
  return corner[0];
}

winding_side winding_find_inside(const winding *w, const tree *t, const winding_guest *guest, vec3 *point) {
  uint32_t open[TREE_LANES * TREE_DEEPEST];
  size_t count = 0;
  winding_side all = WINDING_OUTSIDE;
  open[count++] = 0;
  while (count > 0) {
    const uint32_t at = open[--count];
    if (at & TREE_LEAF) {
      const winding_side side = side_of_pack(w, t, guest, at & ~TREE_LEAF, point);
      if (side == WINDING_INSIDE) return side;
      if (side == WINDING_NEAR) all = side;
      continue;
    }
    const tree_node *node = &guest->elements->nodes[at];
    for (uint32_t l = 0; l < TREE_LANES; l++) {
      if (!(node->lanes >> l & 1u)) continue;
      const winding_side side = side_of_lane(w, t, guest, node, l);
      if (side == WINDING_NEAR) open[count++] = node->child[l];
      if (side != WINDING_INSIDE) continue;
      *point = first_corner(guest->elements, node->child[l]);
      return side;
    }
  }
  return all;
}
