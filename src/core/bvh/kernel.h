/* SPDX-License-Identifier: BSD-3-Clause */
/* The loops over lanes, compiled once for each instruction set: the including page defines TREE_TARGET, the attribute
 * of its functions, and TREE_KERNEL, the name of its table. Loops of eight with no branch inside are what compilers
 * make vectors of. */
#include <math.h>

#include "base/rounding.h"
#include "bvh/kernels.h"

/* Calls would keep the loops over lanes from becoming vectors. */
#define TREE_INLINE TREE_TARGET static inline __attribute__((always_inline))

/* Normals shorter than this have no direction. */
static const double LEAST_LENGTH2 = 1e-200;

/* Divisors that may be 0 are kept from it; what is divided is 0 then, or does not matter. */
static const double LEAST_DIVISOR = 1e-300;

/* What is nearest to the origin: n from there to the origin, d2 the square of a distance that is attained. */
typedef struct lane_near {
  double nx, ny, nz, d2;
} lane_near;

/* An edge from a along e. One Gram-Schmidt step makes n orthogonal to the edge, where the nearest point is within it.
 */
TREE_INLINE lane_near near_edge(double ax, double ay, double az, double ex, double ey, double ez) {
  const double l2 = ex * ex + ey * ey + ez * ez, inverse = 1.0 / (l2 > LEAST_DIVISOR ? l2 : LEAST_DIVISOR);
  const double wanted = -(ax * ex + ay * ey + az * ez) * inverse;
  const double above = wanted > 0.0 ? wanted : 0.0, t = above < 1.0 ? above : 1.0;
  const double nx = -(ax + t * ex), ny = -(ay + t * ey), nz = -(az + t * ez);
  const double along = (nx * ex + ny * ey + nz * ez) * inverse, off = t == wanted ? along : 0.0;
  return (lane_near){nx - off * ex, ny - off * ey, nz - off * ez, nx * nx + ny * ny + nz * nz};
}

TREE_INLINE lane_near nearer(lane_near a, lane_near b) {
  const int first = a.d2 <= b.d2;
  return (lane_near){first ? a.nx : b.nx, first ? a.ny : b.ny, first ? a.nz : b.nz, first ? a.d2 : b.d2};
}

/* The triangle abc. Its inside counts only where the point that its weights make is nearer than the edges: slivers
 * whose computed normal is noise fall back to their edges. */
TREE_INLINE lane_near near_triangle(double ax, double ay, double az, double bx, double by, double bz, double cx,
                                    double cy, double cz) {
  const double ux = bx - ax, uy = by - ay, uz = bz - az;
  const double vx = cx - bx, vy = cy - by, vz = cz - bz;
  const double wx = ax - cx, wy = ay - cy, wz = az - cz;
  const lane_near edges = nearer(nearer(near_edge(ax, ay, az, ux, uy, uz), near_edge(bx, by, bz, vx, vy, vz)),
                                 near_edge(cx, cy, cz, wx, wy, wz));

  /* the plane's normal, orthogonal to the longest edge */
  double mx = uy * vz - uz * vy, my = uz * vx - ux * vz, mz = ux * vy - uy * vx;
  const double u2 = ux * ux + uy * uy + uz * uz, v2 = vx * vx + vy * vy + vz * vz, w2 = wx * wx + wy * wy + wz * wz;
  const int by_v = v2 > u2;
  const double kx = by_v ? vx : ux, ky = by_v ? vy : uy, kz = by_v ? vz : uz, k2 = by_v ? v2 : u2;
  const int by_w = w2 > k2;
  const double lx = by_w ? wx : kx, ly = by_w ? wy : ky, lz = by_w ? wz : kz, l2 = by_w ? w2 : k2;
  const double off = (mx * lx + my * ly + mz * lz) / (l2 > LEAST_DIVISOR ? l2 : LEAST_DIVISOR);
  mx -= off * lx, my -= off * ly, mz -= off * lz;
  const double m2 = mx * mx + my * my + mz * mz;

  /* weights of a, b, c in the foot of the origin */
  const double wa = mx * (by * vz - bz * vy) + my * (bz * vx - bx * vz) + mz * (bx * vy - by * vx);
  const double wb = mx * (cy * wz - cz * wy) + my * (cz * wx - cx * wz) + mz * (cx * wy - cy * wx);
  const double wc = mx * (ay * uz - az * uy) + my * (az * ux - ax * uz) + mz * (ax * uy - ay * ux);
  const double sum = wa + wb + wc, inverse = 1.0 / (sum > LEAST_DIVISOR ? sum : LEAST_DIVISOR);
  const double px = (wa * ax + wb * bx + wc * cx) * inverse, py = (wa * ay + wb * by + wc * cy) * inverse,
               pz = (wa * az + wb * bz + wc * cz) * inverse;
  const double d2 = px * px + py * py + pz * pz;
  const int inside = (wa >= 0.0) & (wb >= 0.0) & (wc >= 0.0) & (sum > LEAST_DIVISOR) & (d2 < edges.d2);
  const double s = -(mx * ax + my * ay + mz * az) / (m2 > LEAST_DIVISOR ? m2 : LEAST_DIVISOR);
  return (lane_near){inside ? s * mx : edges.nx, inside ? s * my : edges.ny, inside ? s * mz : edges.nz,
                     inside ? d2 : edges.d2};
}

/* n from the nearest point of each lane to x, and the support value of each lane along its n, less n·x. */
typedef struct normals {
  _Alignas(64) double n[3][TREE_LANES], d2[TREE_LANES], support[TREE_LANES];
} normals;

TREE_TARGET static inline void near_boxes(const double low[3][TREE_LANES], const double high[3][TREE_LANES], vec3 x,
                                          normals *out) {
#pragma omp simd
  for (int l = 0; l < TREE_LANES; l++) {
    const double lx = low[0][l] > x.x ? low[0][l] : x.x, ly = low[1][l] > x.y ? low[1][l] : x.y,
                 lz = low[2][l] > x.z ? low[2][l] : x.z;
    const double nx = x.x - (high[0][l] < lx ? high[0][l] : lx), ny = x.y - (high[1][l] < ly ? high[1][l] : ly),
                 nz = x.z - (high[2][l] < lz ? high[2][l] : lz);
    const double d2 = nx * nx + ny * ny + nz * nz;
    out->n[0][l] = nx, out->n[1][l] = ny, out->n[2][l] = nz;
    out->d2[l] = d2;
    out->support[l] = -d2; /* the nearest point is the farthest along n */
  }
}

TREE_TARGET static inline void near_points(const double *pack, vec3 x, normals *out) {
#pragma omp simd
  for (int l = 0; l < TREE_LANES; l++) {
    const double nx = x.x - pack[l], ny = x.y - pack[TREE_LANES + l], nz = x.z - pack[2 * TREE_LANES + l];
    const double d2 = nx * nx + ny * ny + nz * nz;
    out->n[0][l] = nx, out->n[1][l] = ny, out->n[2][l] = nz;
    out->d2[l] = d2;
    out->support[l] = -d2;
  }
}

TREE_TARGET static inline void near_triangles(const double *pack, vec3 x, normals *out) {
#pragma omp simd
  for (int l = 0; l < TREE_LANES; l++) {
    const double ax = pack[l] - x.x, ay = pack[8 + l] - x.y, az = pack[16 + l] - x.z;
    const double bx = pack[24 + l] - x.x, by = pack[32 + l] - x.y, bz = pack[40 + l] - x.z;
    const double cx = pack[48 + l] - x.x, cy = pack[56 + l] - x.y, cz = pack[64 + l] - x.z;
    const lane_near near = near_triangle(ax, ay, az, bx, by, bz, cx, cy, cz);
    const double a = near.nx * ax + near.ny * ay + near.nz * az, b = near.nx * bx + near.ny * by + near.nz * bz,
                 c = near.nx * cx + near.ny * cy + near.nz * cz;
    const double ab = a > b ? a : b;
    out->n[0][l] = near.nx, out->n[1][l] = near.ny, out->n[2][l] = near.nz;
    out->d2[l] = near.d2;
    out->support[l] = ab > c ? ab : c;
  }
}

/* The box of each triangle. */
typedef struct lane_boxes {
  _Alignas(64) double low[3][TREE_LANES], high[3][TREE_LANES];
} lane_boxes;

TREE_TARGET static inline void find_boxes(const double *pack, lane_boxes *out) {
  for (int k = 0; k < 3; k++) {
    const double *a = pack + 8 * k, *b = a + 24, *c = b + 24;
#pragma omp simd
    for (int l = 0; l < TREE_LANES; l++) {
      const double least = a[l] < b[l] ? a[l] : b[l], most = a[l] > b[l] ? a[l] : b[l];
      out->low[k][l] = least < c[l] ? least : c[l];
      out->high[k][l] = most > c[l] ? most : c[l];
    }
  }
}

TREE_TARGET static inline void near_pack(const tree *t, const double *pack, vec3 x, normals *out) {
  if (t->kind == TREE_TRIANGLES)
    near_triangles(pack, x, out);
  else if (t->kind == TREE_POINTS)
    near_points(pack, x, out);
  else
    near_boxes((const double(*)[TREE_LANES])pack, (const double(*)[TREE_LANES])(pack + 3 * TREE_LANES), x, out);
}

/* What rounding can add to a support by slabs, for each unit of |n| (doc/non-convex.md). */
TREE_INLINE double slab_rounding(const tree *t, vec3 x) {
  return 32.0 * ROUND_U * (fabs(x.x) + fabs(x.y) + fabs(x.z) + t->scale);
}

/* How far what is in a lane reaches along n, less n·x: the slab along its part of n, the box along the rest. */
TREE_INLINE double support_in_slab(const tree_node *node, const tree_slabs *slabs, int l, vec3 x, double nx, double ny,
                                   double nz) {
  const double sx = slabs->s[0][l], sy = slabs->s[1][l], sz = slabs->s[2][l];
  const double part = nx * sx + ny * sy + nz * sz, middle = x.x * sx + x.y * sy + x.z * sz;
  const double rx = nx - part * sx, ry = ny - part * sy, rz = nz - part * sz;
  const double plane = part > 0.0 ? slabs->high[l] : slabs->low[l];
  const double bx = rx > 0.0 ? node->high[0][l] : node->low[0][l];
  const double by = ry > 0.0 ? node->high[1][l] : node->low[1][l];
  const double bz = rz > 0.0 ? node->high[2][l] : node->low[2][l];
  return part * (plane - middle) + (rx * (bx - x.x) + ry * (by - x.y) + rz * (bz - x.z));
}

TREE_TARGET static inline void narrow_by_slabs(const tree *t, uint32_t at, vec3 x, normals *near) {
  const tree_node *node = &t->nodes[at];
  const tree_slabs *slabs = &t->slabs[at];
  const double rounding = slab_rounding(t, x);
#pragma omp simd
  for (int l = 0; l < TREE_LANES; l++) {
    const double nx = near->n[0][l], ny = near->n[1][l], nz = near->n[2][l];
    const double support = support_in_slab(node, slabs, l, x, nx, ny, nz) + rounding * (fabs(nx) + fabs(ny) + fabs(nz));
    near->support[l] = support < near->support[l] ? support : near->support[l];
  }
}

/* Raises the squared distances: what is in the lane is behind the plane across n that the support stands for. */
TREE_TARGET static inline void raise_by_slabs(const tree *t, uint32_t at, vec3 x, normals *near) {
  narrow_by_slabs(t, at, x, near);
#pragma omp simd
  for (int l = 0; l < TREE_LANES; l++) {
    const double d2 = near->d2[l], h = near->support[l];
    const double square = h * h / (d2 > LEAST_LENGTH2 ? d2 : LEAST_LENGTH2);
    near->d2[l] = h < 0.0 && square > d2 ? square : d2;
  }
}

TREE_TARGET static inline double length_of(const normals *near, int l) {
  const double n2 = near->n[0][l] * near->n[0][l] + near->n[1][l] * near->n[1][l] + near->n[2][l] * near->n[2][l];
  return sqrt(n2 > LEAST_LENGTH2 ? n2 : LEAST_LENGTH2);
}

/* The bounds, of min n·p. */
TREE_TARGET static inline void finish_bounds(const normals *near, const tree_segment *segment,
                                             const double least[TREE_LANES], tree_lanes *lanes) {
#pragma omp simd
  for (int l = 0; l < TREE_LANES; l++) {
    const double n2 = near->n[0][l] * near->n[0][l] + near->n[1][l] * near->n[1][l] + near->n[2][l] * near->n[2][l];
    const double length = sqrt(n2 > LEAST_LENGTH2 ? n2 : LEAST_LENGTH2);
    const double bound = (least[l] - near->support[l]) / length - segment->radius;
    lanes->bound[l] = n2 > LEAST_LENGTH2 ? bound : -segment->radius;
    lanes->distance2[l] = near->d2[l];
  }
}

/* The slopes, of f n·p. */
TREE_TARGET static inline void finish_slopes(const normals *near, const double slope[TREE_LANES], tree_lanes *lanes) {
#pragma omp simd
  for (int l = 0; l < TREE_LANES; l++) {
    const double n2 = near->n[0][l] * near->n[0][l] + near->n[1][l] * near->n[1][l] + near->n[2][l] * near->n[2][l];
    const double length = sqrt(n2 > LEAST_LENGTH2 ? n2 : LEAST_LENGTH2);
    lanes->first[l] = n2 > LEAST_LENGTH2 ? -near->support[l] / length : 0.0;
    lanes->slope[l] = slope[l] / length;
  }
}

/* Of points that are thick by r: (min n·p - r |n| - support)/|n|. */
TREE_TARGET __attribute__((noinline, cold)) static void bound_thick(const normals *near, const tree_segment *segment,
                                                                    tree_lanes *lanes) {
  _Alignas(64) double least[TREE_LANES];
  for (int l = 0; l < TREE_LANES; l++) least[l] = INFINITY;
  for (size_t k = 0; k < segment->n; k++) {
    const double px = segment->p[0][k], py = segment->p[1][k], pz = segment->p[2][k], r = segment->thick[k];
#pragma omp simd
    for (int l = 0; l < TREE_LANES; l++) {
      const double g = near->n[0][l] * px + near->n[1][l] * py + near->n[2][l] * pz - length_of(near, l) * r;
      least[l] = g < least[l] ? g : least[l];
    }
  }
  finish_bounds(near, segment, least, lanes);
  /* without a direction nothing but the largest ball is known */
  for (int l = 0; l < TREE_LANES; l++)
    lanes->bound[l] -=
        near->n[0][l] * near->n[0][l] + near->n[1][l] * near->n[1][l] + near->n[2][l] * near->n[2][l] > LEAST_LENGTH2
            ? 0.0
            : segment->thickest;
}

TREE_TARGET __attribute__((noinline, cold)) static void slopes_of_thick(const normals *near,
                                                                        const tree_segment *segment,
                                                                        tree_lanes *lanes) {
  _Alignas(64) double slope[TREE_LANES] = {0};
  const double degree = (double)(segment->n - 1);
  for (size_t k = 1; k < segment->n; k++) {
    const double f = degree / (double)k;
    const double px = f * segment->p[0][k], py = f * segment->p[1][k], pz = f * segment->p[2][k],
                 r = f * (segment->thick[k] - segment->thick[0]);
#pragma omp simd
    for (int l = 0; l < TREE_LANES; l++) {
      const double g = near->n[0][l] * px + near->n[1][l] * py + near->n[2][l] * pz - length_of(near, l) * r;
      slope[l] = g < slope[l] ? g : slope[l];
    }
  }
  finish_slopes(near, slope, lanes);
  for (int l = 0; l < TREE_LANES; l++) lanes->first[l] -= segment->thick[0];
}

/* (min n·p - support)/|n| for each lane's own n; 0 where n has no direction. */
TREE_TARGET static inline void bound_by_own(const normals *near, const tree_segment *segment, tree_lanes *lanes) {
  if (segment->thick) {
    bound_thick(near, segment, lanes);
    return;
  }
  _Alignas(64) double least[TREE_LANES];
  for (int l = 0; l < TREE_LANES; l++) least[l] = INFINITY;
  for (size_t k = 0; k < segment->n; k++) {
    const double px = segment->p[0][k], py = segment->p[1][k], pz = segment->p[2][k];
#pragma omp simd
    for (int l = 0; l < TREE_LANES; l++) {
      const double g = near->n[0][l] * px + near->n[1][l] * py + near->n[2][l] * pz;
      least[l] = g < least[l] ? g : least[l];
    }
  }
  finish_bounds(near, segment, least, lanes);
}

/* The same normals at the first point, and the line through there below all others. */
TREE_TARGET static inline void find_slopes(const normals *near, const tree_segment *segment, tree_lanes *lanes) {
  if (segment->thick) {
    slopes_of_thick(near, segment, lanes);
    return;
  }
  _Alignas(64) double slope[TREE_LANES] = {0};
  const double degree = (double)(segment->n - 1);
  for (size_t k = 1; k < segment->n; k++) {
    const double f = degree / (double)k;
    const double px = f * segment->p[0][k], py = f * segment->p[1][k], pz = f * segment->p[2][k];
#pragma omp simd
    for (int l = 0; l < TREE_LANES; l++) {
      const double g = near->n[0][l] * px + near->n[1][l] * py + near->n[2][l] * pz;
      slope[l] = g < slope[l] ? g : slope[l];
    }
  }
  finish_slopes(near, slope, lanes);
}

TREE_TARGET static inline void raise(tree_lanes *lanes, const double bound[TREE_LANES]) {
#pragma omp simd
  for (int l = 0; l < TREE_LANES; l++) lanes->bound[l] = bound[l] > lanes->bound[l] ? bound[l] : lanes->bound[l];
}

TREE_TARGET static inline void bound_boxes_by_known(const double low[3][TREE_LANES], const double high[3][TREE_LANES],
                                                    const tree_segment *segment, tree_lanes *lanes) {
  _Alignas(64) double bound[TREE_LANES];
  const vec3 n = segment->normal, x = segment->x;
  const double *sx = n.x > 0.0 ? high[0] : low[0], *sy = n.y > 0.0 ? high[1] : low[1],
               *sz = n.z > 0.0 ? high[2] : low[2];
#pragma omp simd
  for (int l = 0; l < TREE_LANES; l++)
    bound[l] = segment->along - (n.x * (sx[l] - x.x) + n.y * (sy[l] - x.y) + n.z * (sz[l] - x.z));
  raise(lanes, bound);
}

TREE_TARGET static inline void bound_slabs_by_known(const tree *t, uint32_t at, const tree_segment *segment,
                                                    tree_lanes *lanes) {
  _Alignas(64) double bound[TREE_LANES];
  const tree_node *node = &t->nodes[at];
  const tree_slabs *slabs = &t->slabs[at];
  const vec3 n = segment->normal, x = segment->x;
  const double along = segment->along - 2.0 * slab_rounding(t, x); /* |n| is 1: its parts add up to less than 2 */
#pragma omp simd
  for (int l = 0; l < TREE_LANES; l++) bound[l] = along - support_in_slab(node, slabs, l, x, n.x, n.y, n.z);
  raise(lanes, bound);
}

TREE_TARGET static inline void bound_corners_by_known(const double *pack, int corners, const tree_segment *segment,
                                                      tree_lanes *lanes) {
  _Alignas(64) double bound[TREE_LANES];
  const vec3 n = segment->normal, x = segment->x;
  for (int l = 0; l < TREE_LANES; l++) bound[l] = INFINITY;
  for (int j = 0; j < corners; j++) {
    const double *v = pack + 24 * j;
#pragma omp simd
    for (int l = 0; l < TREE_LANES; l++) {
      const double b = segment->along - (n.x * (v[l] - x.x) + n.y * (v[8 + l] - x.y) + n.z * (v[16 + l] - x.z));
      bound[l] = b < bound[l] ? b : bound[l];
    }
  }
  raise(lanes, bound);
}

TREE_TARGET static inline void sort_lanes(uint32_t wanted, const tree_segment *segment, tree_lanes *lanes) {
  const double beyond = segment->beyond;
  double rest = INFINITY;
  uint32_t live = 0;
#pragma omp simd reduction(| : live)
  for (uint32_t l = 0; l < TREE_LANES; l++) live |= lanes->bound[l] > beyond ? 0u : 1u << l;
#pragma omp simd reduction(min : rest)
  for (int l = 0; l < TREE_LANES; l++) {
    const double out = lanes->bound[l] > beyond ? lanes->bound[l] : INFINITY;
    rest = out < rest ? out : rest;
  }
  lanes->live = live & wanted;
  lanes->rest = rest;
}

/* Whether none of the wanted lanes of a pack of triangles could matter, by their boxes and the normal from elsewhere:
 * most packs of a list are left that way, at a fifth of the cost. */
TREE_TARGET static inline bool is_impossible(const double *pack, uint32_t wanted, const tree_segment *segment,
                                             tree_lanes *lanes) {
  lane_boxes boxes;
  normals near;
  find_boxes(pack, &boxes);
  near_boxes((const double(*)[TREE_LANES])boxes.low, (const double(*)[TREE_LANES])boxes.high, segment->x, &near);
  bound_by_own(&near, segment, lanes);
  if (segment->known) bound_corners_by_known(pack, 3, segment, lanes);
  sort_lanes(wanted, segment, lanes);
  if (lanes->live) return false;
  for (int l = 0; l < TREE_LANES; l++) lanes->distance2[l] = INFINITY;
  return true;
}

TREE_TARGET static void kernel_measure(const tree *t, uint32_t at, uint32_t wanted, const tree_segment *segment,
                                       tree_lanes *lanes) {
  normals near;
  const bool leaf = (at & TREE_LEAF) != 0;
  const tree_node *node = leaf ? NULL : &t->nodes[at];
  const double *pack = leaf ? t->packs + (at & ~TREE_LEAF) * tree_pack_size(t->kind) : NULL;
  if (leaf && t->kind == TREE_TRIANGLES && is_impossible(pack, wanted, segment, lanes)) return;
  if (leaf)
    near_pack(t, pack, segment->x, &near);
  else
    near_boxes(node->low, node->high, segment->x, &near);
  if (!leaf && t->slabs) narrow_by_slabs(t, at, segment->x, &near);
  bound_by_own(&near, segment, lanes);
  if (segment->stepping) find_slopes(&near, segment, lanes);

  if (segment->known) {
    if (!leaf && t->slabs) bound_slabs_by_known(t, at, segment, lanes);
    if (!leaf)
      bound_boxes_by_known(node->low, node->high, segment, lanes);
    else if (t->kind == TREE_BOXES)
      bound_boxes_by_known((const double(*)[TREE_LANES])pack, (const double(*)[TREE_LANES])(pack + 3 * TREE_LANES),
                           segment, lanes);
    else
      bound_corners_by_known(pack, t->kind == TREE_TRIANGLES ? 3 : 1, segment, lanes);
  }
  sort_lanes(wanted, segment, lanes);
  if (leaf) return;
#pragma omp simd
  for (int l = 0; l < TREE_LANES; l++) {
    const double dx = node->high[0][l] - node->low[0][l], dy = node->high[1][l] - node->low[1][l],
                 dz = node->high[2][l] - node->low[2][l];
    lanes->width2[l] = dx * dx + dy * dy + dz * dz;
  }
}

/* ---- the element nearest to a point ---- */

typedef struct open_node {
  double d2;
  uint32_t at;
} open_node;

TREE_TARGET static inline void visit_pack(const tree *t, uint32_t pack, vec3 x, tree_hit *hit, double *best2) {
  normals near;
  const double *corners = t->packs + (size_t)pack * tree_pack_size(t->kind);
  if (t->kind == TREE_TRIANGLES) {
    lane_boxes boxes;
    find_boxes(corners, &boxes);
    near_boxes((const double(*)[TREE_LANES])boxes.low, (const double(*)[TREE_LANES])boxes.high, x, &near);
    uint32_t live = 0;
#pragma omp simd reduction(| : live)
    for (uint32_t l = 0; l < TREE_LANES; l++) live |= near.d2[l] < *best2 ? 1u << l : 0u;
    if (!live) return;
  }
  near_pack(t, corners, x, &near);
  double least = INFINITY;
  uint32_t nearest = 0;
  for (uint32_t l = 0; l < TREE_LANES; l++)
    if (near.d2[l] < least) least = near.d2[l], nearest = l;
  if (least < *best2) {
    *best2 = least;
    hit->found = true;
    hit->at = (tree_place){pack, nearest};
  }
  if (t->kind != TREE_TRIANGLES) return; /* closed forms: the distance attained is the least one */
  double lower = hit->lower;
#pragma omp simd reduction(min : lower)
  for (int l = 0; l < TREE_LANES; l++) {
    const double n2 = near.n[0][l] * near.n[0][l] + near.n[1][l] * near.n[1][l] + near.n[2][l] * near.n[2][l];
    const double bound = -near.support[l] / sqrt(n2 > LEAST_LENGTH2 ? n2 : LEAST_LENGTH2);
    const double known = n2 > LEAST_LENGTH2 ? bound : 0.0;
    lower = known < lower ? known : lower;
  }
  hit->lower = lower;
}

TREE_TARGET static tree_hit kernel_nearest(const tree *t, vec3 x, double bound) {
  open_node open[TREE_LANES * TREE_DEEPEST];
  size_t count = 0;
  tree_hit hit = {.upper = bound, .lower = INFINITY};
  double best2 = bound < 1e150 ? bound * bound : INFINITY;
  uint32_t at = 0;
  for (;;) {
    if (at & TREE_LEAF) {
      visit_pack(t, at & ~TREE_LEAF, x, &hit, &best2);
    } else {
      normals near;
      const tree_node *node = &t->nodes[at];
      near_boxes(node->low, node->high, x, &near);
      if (t->slabs) raise_by_slabs(t, at, x, &near);
      uint32_t live = 0;
#pragma omp simd reduction(| : live)
      for (uint32_t l = 0; l < TREE_LANES; l++) live |= near.d2[l] < best2 ? 1u << l : 0u;
      /* the nearest lanes end on top */
      const size_t floor = count;
      for (live &= node->lanes; live; live &= live - 1) {
        const unsigned l = (unsigned)__builtin_ctz(live);
        const open_node child = {near.d2[l], node->child[l]};
        size_t i = count++;
        for (; i > floor && open[i - 1].d2 < child.d2; i--) open[i] = open[i - 1];
        open[i] = child;
      }
    }
    while (count > 0 && !(open[count - 1].d2 < best2)) count--;
    if (count == 0) break;
    at = open[--count].at;
  }
  if (hit.found) hit.upper = sqrt(best2);
  hit.lower = hit.lower < hit.upper ? hit.lower : hit.upper;
  return hit;
}

/* ---- the point farthest along a direction ---- */

/* Products and sums of a corner's coordinates are monotone in each of them: in the same order, no corner within a box
 * comes out farther than the box. */
TREE_TARGET static inline void reach_of_corners(const double *x, const double *y, const double *z, vec3 d,
                                                double reach[TREE_LANES]) {
#pragma omp simd
  for (int l = 0; l < TREE_LANES; l++) reach[l] = d.x * x[l] + d.y * y[l] + d.z * z[l];
}

TREE_TARGET static inline void reach_of_boxes(const double low[3][TREE_LANES], const double high[3][TREE_LANES], vec3 d,
                                              double reach[TREE_LANES]) {
  reach_of_corners(d.x > 0.0 ? high[0] : low[0], d.y > 0.0 ? high[1] : low[1], d.z > 0.0 ? high[2] : low[2], d, reach);
}

TREE_TARGET static inline void keep_farthest(const double *x, const double *y, const double *z, vec3 d, double *most,
                                             vec3 *at) {
  _Alignas(64) double reach[TREE_LANES];
  reach_of_corners(x, y, z, d, reach);
  for (int l = 0; l < TREE_LANES; l++)
    if (reach[l] > *most) *most = reach[l], *at = (vec3){x[l], y[l], z[l]};
}

TREE_TARGET static inline void keep_farthest_of_pack(const tree *t, uint32_t pack, vec3 d, double *most, vec3 *at) {
  const double *v = t->packs + (size_t)pack * tree_pack_size(t->kind);
  if (t->kind == TREE_BOXES) {
    const double *w = v + 3 * TREE_LANES;
    keep_farthest(d.x > 0.0 ? w : v, d.y > 0.0 ? w + 8 : v + 8, d.z > 0.0 ? w + 16 : v + 16, d, most, at);
    return;
  }
  const int corners = t->kind == TREE_TRIANGLES ? 3 : 1;
  for (int k = 0; k < corners; k++, v += 3 * TREE_LANES) keep_farthest(v, v + 8, v + 16, d, most, at);
}

TREE_TARGET static double farthest(const tree *t, vec3 d, vec3 *at) {
  open_node open[TREE_LANES * TREE_DEEPEST]; /* d2: minus the reach */
  size_t count = 0;
  double most = -INFINITY;
  uint32_t next = 0;
  for (;;) {
    if (next & TREE_LEAF) {
      keep_farthest_of_pack(t, next & ~TREE_LEAF, d, &most, at);
    } else {
      _Alignas(64) double reach[TREE_LANES];
      const tree_node *node = &t->nodes[next];
      reach_of_boxes(node->low, node->high, d, reach);
      const size_t floor = count;
      for (uint32_t left = node->lanes; left; left &= left - 1) {
        const unsigned l = (unsigned)__builtin_ctz(left);
        if (!(reach[l] > most)) continue;
        const open_node child = {-reach[l], node->child[l]};
        size_t i = count++;
        for (; i > floor && open[i - 1].d2 < child.d2; i--) open[i] = open[i - 1];
        open[i] = child;
      }
    }
    while (count > 0 && !(-open[count - 1].d2 > most)) count--;
    if (count == 0) return most;
    next = open[--count].at;
  }
}

const tree_kernel TREE_KERNEL = {.measure = kernel_measure, .nearest = kernel_nearest, .farthest = farthest};
