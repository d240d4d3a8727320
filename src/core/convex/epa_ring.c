/* SPDX-License-Identifier: BSD-3-Clause */
/* The same for a set that is all but one of revolution about z, where the nearest points of the surface may be a whole
 * ring: a polygon that expands in the half plane of (hypot(x, y), z), from the lowest point of the set to the highest.
 * Of a set of revolution a disc of the plane lies in the section if and only if the ball lies in the set. Where no
 * point is farther than `off` from one of such a set and the other way round, the polygon is within `off` of its
 * section, and its ball less `off` within `off` of the set: 2 off in all. From above nothing is taken from the profile:
 * the reach along a direction is that of the set itself. */
#include "convex/epa.h"

#include "base/rounding.h"
#include "convex/feature.h"

enum { MOST_CORNERS = 128 };

typedef struct corner {
  simplex_vertex vertex;
  double rho, z;
  double reach; /* of the set along the direction in which the corner was found */
} corner;

/* The edge to the corner above. */
typedef struct edge {
  int32_t from, to;
  double x, z; /* unit normal, outwards */
  double offset;
} edge;

typedef struct profile {
  corner corner[MOST_CORNERS];
  edge edge[MOST_CORNERS];
  int32_t n_corners, n_edges;
} profile;

static int32_t profile_add_corner(profile *p, const epa_set *set, double x, double z) {
  const simplex_vertex v = set->farthest(set->self, vec(x, 0.0, z));
  const double reach = x * v.w.x + z * v.w.z;
  p->corner[p->n_corners] = (corner){.vertex = v, .rho = feature_hypot(v.w.x, v.w.y), .z = v.w.z, .reach = reach};
  return p->n_corners++;
}

static double reach_along(const corner *c, double x, double z) {
  return x * c->rho + z * c->z;
}

static void profile_set_edge(profile *p, int32_t at, int32_t from, int32_t to) {
  const corner *a = &p->corner[from], *b = &p->corner[to];
  const double x = b->z - a->z, z = a->rho - b->rho, length = feature_hypot(x, z);
  edge e = {.from = from, .to = to};
  const double far = feature_hypot(a->rho, a->z);
  if (length > 64.0 * ROUND_U * far) {
    e.x = x / length, e.z = z / length;
  } else { /* no edge but for rounding: the direction of the corner proves the most */
    e.x = a->rho / far, e.z = a->z / far;
  }
  e.offset = fmin(reach_along(a, e.x, e.z), reach_along(b, e.x, e.z));
  p->edge[at] = e;
}

static int32_t profile_nearest(const profile *p) {
  int32_t best = 0;
  for (int32_t i = 1; i < p->n_edges; i++)
    if (p->edge[i].offset < p->edge[best].offset) best = i;
  return best;
}

/* A little off the axis, so that the extreme points of an end lie in the half plane like all the others. */
static const double TILT = 1e-8;

/* The lowest, the widest and the highest point. */
static bool profile_begin(profile *p, const epa_set *set, double rounding) {
  p->n_corners = 0;
  profile_add_corner(p, set, TILT, -1.0);
  profile_add_corner(p, set, 1.0, 0.0);
  profile_add_corner(p, set, TILT, 1.0);
  p->n_edges = 2;
  profile_set_edge(p, 0, 0, 1);
  profile_set_edge(p, 1, 1, 2);
  return p->corner[0].z < -rounding && p->corner[2].z > rounding && p->edge[0].offset > rounding &&
         p->edge[1].offset > rounding;
}

/* The foot of 0: on one of the nearest edges, or in the middle of an end, between a corner and its image across the
 * axis. */
static void find_touch(const profile *p, double room, epa_depth *depth) {
  simplex_nearest found;
  const corner *end = &p->corner[-p->corner[0].z <= p->corner[2].z ? 0 : 2];
  double nearest = INFINITY;
  if (fabs(end->z) <= depth->least + room) {
    const simplex_vertex v = end->vertex;
    depth->touch = (simplex){.n = 2, .vertex = {v, v}};
    depth->touch.vertex[1].a = vec(-v.a.x, -v.a.y, v.a.z);
    depth->touch.vertex[1].b = vec(-v.b.x, -v.b.y, v.b.z);
    depth->touch.vertex[1].w = vec(-v.w.x, -v.w.y, v.w.z);
    if (vec_equal(depth->touch.vertex[0].w, depth->touch.vertex[1].w)) depth->touch.n = 1;
    simplex_reduce(&depth->touch, &found);
    nearest = found.distance;
  }
  for (int32_t i = 0; i < p->n_edges; i++) {
    if (p->edge[i].offset > depth->least + room) continue;
    simplex s = {.n = 2, .vertex = {p->corner[p->edge[i].from].vertex, p->corner[p->edge[i].to].vertex}};
    if (vec_equal(s.vertex[0].w, s.vertex[1].w)) s.n = 1;
    simplex_reduce(&s, &found);
    if (found.distance >= nearest) continue;
    nearest = found.distance;
    depth->touch = s;
  }
}

static void lower_most(epa_depth *depth, double reach, double x, double z) {
  if (!(reach < depth->most)) return;
  depth->most = reach;
  depth->normal = vec(x, 0.0, z);
}

bool epa_ring(const epa_set *set, double off, const epa_goal *goal, epa_depth *depth) {
  profile p;
  const double rounding = goal->rounding + off, width = goal->width - 2.0 * off;
  if (!profile_begin(&p, set, rounding)) return false;
  *depth = (epa_depth){.least = -INFINITY, .most = INFINITY, .exhausted = true, .steps = 5};
  lower_most(depth, -set->farthest(set->self, vec(0, 0, -1)).w.z, 0.0, -1.0);
  lower_most(depth, set->farthest(set->self, vec(0, 0, 1)).w.z, 0.0, 1.0);
  lower_most(depth, p.corner[1].reach, 1.0, 0.0);
  const double ends = fmin(-p.corner[0].z, p.corner[2].z);
  while (p.n_corners < MOST_CORNERS && depth->steps < goal->max_steps) {
    const int32_t best = profile_nearest(&p);
    const edge e = p.edge[best];
    depth->least = fmax(depth->least, fmin(e.offset, ends));
    depth->exhausted = depth->most - depth->least > width;
    if (!depth->exhausted) break;

    const int32_t top = profile_add_corner(&p, set, e.x, e.z);
    depth->steps++;
    const double reach = reach_along(&p.corner[top], e.x, e.z);
    if (isnan(reach)) return false;
    lower_most(depth, p.corner[top].reach, e.x, e.z);
    if (!(reach - e.offset > 0.25 * rounding)) {
      depth->exhausted = false;
      break;
    }
    p.edge[p.n_edges++] = (edge){0};
    for (int32_t i = p.n_edges - 1; i > best + 1; i--) p.edge[i] = p.edge[i - 1];
    profile_set_edge(&p, best, e.from, top);
    profile_set_edge(&p, best + 1, top, e.to);
  }
  find_touch(&p, fmax(rounding, goal->width), depth);
  depth->least -= 2.0 * off;
  return depth->least > goal->rounding;
}
