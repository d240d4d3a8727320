/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/rounding.h"
#include "bvh/kernels.h"

int tree_corners(const tree *t, tree_place at, vec3 corner[3]) {
  const double *pack = t->packs + at.pack * tree_pack_size(t->kind) + at.lane;
  const int n = t->kind == TREE_TRIANGLES ? 3 : t->kind == TREE_BOXES ? 2 : 1;
  for (int k = 0; k < n; k++, pack += 3 * TREE_LANES) corner[k] = vec(pack[0], pack[TREE_LANES], pack[2 * TREE_LANES]);
  return n;
}

tree_hit tree_nearest(const tree *t, vec3 x, double bound) {
  return t->kernel->nearest(t, x, bound);
}

double tree_farthest(const tree *t, vec3 d, vec3 *at) {
  return t->kernel->farthest(t, d, at);
}

double tree_lane_reach(const tree *t, uint32_t at, uint32_t lane, vec3 d) {
  const tree_node *node = &t->nodes[at];
  const double *x = d.x > 0.0 ? node->high[0] : node->low[0], *y = d.y > 0.0 ? node->high[1] : node->low[1],
               *z = d.z > 0.0 ? node->high[2] : node->low[2];
  const double box = d.x * x[lane] + d.y * y[lane] + d.z * z[lane];
  if (!t->slabs) return box;

  /* the slab along its part of d, the box along the rest */
  const tree_slabs *slabs = &t->slabs[at];
  const vec3 s = vec(slabs->s[0][lane], slabs->s[1][lane], slabs->s[2][lane]);
  const double part = vec_dot(d, s);
  const vec3 r = vec_axpy(d, -part, s);
  const double slab = part * (part > 0.0 ? slabs->high[lane] : slabs->low[lane]) +
                      r.x * (r.x > 0.0 ? node->high[0][lane] : node->low[0][lane]) +
                      r.y * (r.y > 0.0 ? node->high[1][lane] : node->low[1][lane]) +
                      r.z * (r.z > 0.0 ? node->high[2][lane] : node->low[2][lane]) + 64.0 * ROUND_U * t->scale;
  return lesser(slab, box);
}

void tree_measure(const tree *t, uint32_t at, uint32_t wanted, const tree_segment *segment, tree_lanes *lanes) {
  t->kernel->measure(t, at, wanted, segment, lanes);
}

/* ---- one element ---- */

static vec3 unit(vec3 v) {
  const double length = vec_norm(v);
  return length > 1e-100 ? vec_scale(1.0 / length, v) : vec(0, 0, 0);
}

/* Keeps the nearer of what is known and a point of a feature. */
static void keep_nearer(tree_near *near, vec3 x, vec3 point, vec3 n, int tangents, vec3 e) {
  const double distance = vec_norm(vec_sub(x, point));
  if (distance < near->distance)
    *near = (tree_near){.distance = distance, .point = point, .normal = unit(n), .tangents = tangents, .e = {e}};
}

static void near_edge(tree_near *near, vec3 x, vec3 a, vec3 b) {
  const vec3 e = vec_sub(b, a), w = vec_sub(x, a);
  const double l2 = vec_norm2(e), along = vec_dot(w, e);
  if (!(along > 0.0) || !(l2 > 0.0)) {
    keep_nearer(near, x, a, w, 0, e);
  } else if (along >= l2) {
    keep_nearer(near, x, b, vec_sub(x, b), 0, e);
  } else {
    const vec3 u = unit(e), n = vec_axpy(w, -vec_dot(w, u), u);
    keep_nearer(near, x, vec_lerp(a, b, along / l2), vec_axpy(n, -vec_dot(n, u), u), 1, u);
  }
}

/* As in bvh/kernel.h, with the feature besides. */
static void near_triangle(tree_near *near, vec3 x, const vec3 v[3]) {
  const vec3 e[3] = {vec_sub(v[1], v[0]), vec_sub(v[2], v[1]), vec_sub(v[0], v[2])};
  for (int k = 0; k < 3; k++) near_edge(near, x, v[k], v[(k + 1) % 3]);
  int longest = 0;
  for (int k = 1; k < 3; k++)
    if (vec_norm2(e[k]) > vec_norm2(e[longest])) longest = k;
  const vec3 u = unit(e[longest]);
  vec3 m = vec_cross(e[0], e[1]);
  m = unit(vec_axpy(m, -vec_dot(m, u), u));

  const vec3 w[3] = {vec_sub(v[0], x), vec_sub(v[1], x), vec_sub(v[2], x)};
  const double weight[3] = {vec_dot(m, vec_cross(w[1], e[1])), vec_dot(m, vec_cross(w[2], e[2])),
                            vec_dot(m, vec_cross(w[0], e[0]))};
  const double sum = weight[0] + weight[1] + weight[2];
  if (!(weight[0] >= 0.0 && weight[1] >= 0.0 && weight[2] >= 0.0 && sum > 0.0)) return;
  vec3 foot = vec(0, 0, 0);
  for (int k = 0; k < 3; k++) foot = vec_axpy(foot, weight[k] / sum, w[k]);
  const double distance = vec_norm(foot);
  if (!(distance < near->distance)) return;
  const double height = -vec_dot(m, w[0]);
  *near = (tree_near){.distance = distance,
                      .point = vec_add(x, foot),
                      .normal = height < 0.0 ? vec_neg(m) : m,
                      .tangents = 2,
                      .e = {u, vec_cross(m, u)}};
}

static double clamped(double x, double low, double high) {
  return x < low ? low : x > high ? high : x;
}

static void near_box(tree_near *near, vec3 x, vec3 low, vec3 high) {
  const vec3 point = vec(clamped(x.x, low.x, high.x), clamped(x.y, low.y, high.y), clamped(x.z, low.z, high.z));
  const vec3 n = vec_sub(x, point);
  *near = (tree_near){.distance = vec_norm(n), .point = point, .normal = unit(n)};
  const vec3 axis[3] = {vec(1, 0, 0), vec(0, 1, 0), vec(0, 0, 1)};
  const bool within[3] = {n.x == 0.0, n.y == 0.0, n.z == 0.0};
  for (int k = 0; k < 3; k++)
    if (within[k] && near->tangents < 2) near->e[near->tangents++] = axis[k];
}

void tree_element_near(const tree *t, tree_place at, vec3 x, tree_near *near) {
  vec3 corner[3];
  tree_corners(t, at, corner);
  *near = (tree_near){.distance = INFINITY};
  if (t->kind == TREE_TRIANGLES)
    near_triangle(near, x, corner);
  else if (t->kind == TREE_BOXES)
    near_box(near, x, corner[0], corner[1]);
  else
    keep_nearer(near, x, corner[0], vec_sub(x, corner[0]), 0, vec(0, 0, 0));
}

/* ---- all elements near a convex shape ---- */

typedef struct open_lane {
  double bound;
  uint32_t at;
} open_lane;

void tree_seek(const tree *t, tree_seeker *seeker) {
  open_lane open[TREE_LANES * TREE_DEEPEST];
  size_t count = 0;
  tree_segment segment = {.x = seeker->centre, .n = 1, .radius = seeker->radius};
  segment.p[0][0] = segment.p[1][0] = segment.p[2][0] = 0.0;
  open[count++] = (open_lane){-INFINITY, 0};
  while (count > 0) {
    const open_lane top = open[--count];
    if (!(top.bound < seeker->bound)) continue;
    tree_lanes lanes;
    segment.known = seeker->known, segment.normal = seeker->normal;
    segment.along = seeker->least - vec_dot(seeker->normal, seeker->centre);
    segment.beyond = seeker->bound;
    tree_measure(t, top.at, TREE_ALL_LANES, &segment, &lanes);
    const size_t floor = count;
    open_lane sorted[TREE_LANES];
    size_t n = 0;
    const bool leaf = (top.at & TREE_LEAF) != 0;
    for (uint32_t l = 0; l < TREE_LANES; l++) {
      const bool used = leaf ? l == 0 || t->ids[(top.at & ~TREE_LEAF) * (size_t)TREE_LANES + l] !=
                                             t->ids[(top.at & ~TREE_LEAF) * (size_t)TREE_LANES + l - 1]
                             : (t->nodes[top.at].lanes >> l & 1u) != 0;
      if (!used || !(lanes.bound[l] < seeker->bound)) continue;
      size_t i = n++;
      for (; i > 0 && sorted[i - 1].bound > lanes.bound[l]; i--) sorted[i] = sorted[i - 1];
      sorted[i] = (open_lane){lanes.bound[l], leaf ? l : t->nodes[top.at].child[l]};
    }
    if (!leaf) {
      for (size_t i = 0; i < n; i++) open[floor + i] = sorted[n - 1 - i];
      count = floor + n;
      continue;
    }
    for (size_t i = 0; i < n && sorted[i].bound < seeker->bound; i++) {
      const tree_place at = {top.at & ~TREE_LEAF, sorted[i].at};
      seeker->visit(seeker, at, tree_element(t, at));
    }
  }
}
