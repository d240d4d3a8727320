/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_query/curve_radius.h"

#include "base/rounding.h"
#include "curve/relative_curve.h"
#include "curve_query/newton_convex.h"

/* The payload of a node: the same interval of both curves. */
typedef struct curve_radius_node {
  curve_interval at, radius;
  uint32_t seen; /* the incumbent that its bound knows already */
} curve_radius_node;

static const curve_radius_node *known(const search_node *node) {
  _Static_assert(sizeof(curve_radius_node) <= sizeof(search_payload), "a node's payload holds it");
  return (const curve_radius_node *)node->payload.bytes;
}

static curve_radius_node *own(search_node *node) {
  return (curve_radius_node *)node->payload.bytes;
}

/* The loaded piece of the radius. The base uses this slot for bounds that are not asked for here. */
enum { RADIUS_ROOT = CURVE_CONVEX_SCRATCH };

static void load(curve_radius *o, size_t piece) {
  curve_side_load(&o->base.side, piece);
  curve_side_load(&o->radius, piece);
}

/* ---- bounds ---- */

/* min n·P_i - r_i over the control points of a piece: n·psi - r is the polynomial with these coefficients. A range has
 * the sum of both bounds. */
static curve_reach reach_of(curve_radius *o, const curve_radius_node *payload, vec3 n) {
  const curve_side *side = &o->base.side;
  if (payload->at.slot < 0) {
    const curve_reach centre = curve_side_reach(side, &payload->at, n),
                      radius = curve_side_reach(&o->radius, &payload->radius, vec(-1, 0, 0));
    return (curve_reach){.least = centre.least + radius.least,
                         .error = centre.error + radius.error,
                         .magnitude = centre.magnitude + radius.magnitude};
  }
  load(o, curve_side_piece(side, &payload->at));
  const size_t degree = side->curve->degree;
  const double *x = points_pool_at(&o->base.pool, (size_t)payload->at.slot), *y = x + degree + 1, *z = y + degree + 1,
               *r = points_pool_at(&o->base.pool, (size_t)payload->radius.slot);
  double least = INFINITY;
  for (size_t i = 0; i <= degree; i++) least = lesser(n.x * x[i] + n.y * y[i] + n.z * z[i] - r[i], least);
  return (curve_reach){.least = least,
                       .error = payload->at.error + payload->radius.error,
                       .magnitude = side->root_magnitude + o->radius.root_magnitude};
}

/* Weak duality, as without a radius: a ball of radius r about x reaches down to n·x - r. */
static void bound(curve_radius *o, search_node *node, const curve_sample *sample) {
  if (!isfinite(sample->support)) return;
  const convex *shape = o->base.shape;
  const curve_reach reach = reach_of(o, known(node), sample->normal);
  const double least = reach.least - sample->support;
  const double sizes = reach.magnitude + shape->scale + shape->margin + o->offset + fabs(least);
  const double slack = ROUND_UP * (reach.error + (ROUND_SUPPORT + 4.0) * ROUND_U * sizes + shape->slack);
  node->lower = greater(least - slack, node->lower);
  node->slack = slack;
}

static double filter(void *self, search_node *node, double goal) {
  (void)goal;
  curve_radius *o = self;
  curve_radius_node *payload = own(node);
  if (o->base.incumbent == 0 || payload->seen == o->base.incumbent) return node->lower;
  bound(o, node, &o->base.best);
  payload->seen = o->base.incumbent;
  return node->lower;
}

/* ---- distance queries ---- */

/* Measures at s of a piece, and adopts what is better. *slope and *bend: derivatives by s of the distance less the
 * radius; the bend is that of the distance from the nearest point, which is the largest there can be. */
static cprox_status measure(curve_radius *o, size_t piece, double s, double *slope, double *bend) {
  curve_convex *base = &o->base;
  load(o, piece);
  const size_t degree = base->side.curve->degree;
  const double *radii = points_pool_at(&base->pool, RADIUS_ROOT);
  const curve_jet at = newton_jet(base, points_pool_at(&base->pool, CURVE_CONVEX_ROOT), s);
  curve_jet radius;
  curve_bezier_evaluate(radii, radii + degree + 1, radii + 2 * (degree + 1), 1, degree,
                        curve_binomial(base->side.curve), s, &radius.x, &radius.d1, &radius.d2);
  const double error = curve_side_point_error(&base->side) + curve_side_point_error(&o->radius);
  search_best found = {.upper = INFINITY};
  base->offset = o->offset + radius.x.x;
  const cprox_status status = curve_convex_measure(base, piece, s, at.x, error, &base->last, &found);
  if (status < 0) return status;
  base->last.support -= radius.x.x;
  const double along = vec_dot(base->last.normal, at.d1), d = fabs(base->last.near.distance);
  *slope = along - radius.d1.x;
  *bend = vec_dot(base->last.normal, at.d2) - radius.d2.x;
  if (d > 0.0) *bend += greater(vec_norm2(at.d1) - along * along, 0.0) / d;
  if (found.upper < base->best_bound.upper) curve_convex_adopt(base, &base->last, found);
  return CPROX_OK;
}

/* From what was measured at s of a piece, by secants of the slope, until nothing gets better. The first step goes by
 * the bend. */
static cprox_status refine(curve_radius *o, size_t piece, double s, double slope, double bend) {
  enum { MOST_STEPS = 10 };
  static const double LONGEST = 0.25, SHORTEST = 1e-10;
  for (int i = 0; i < MOST_STEPS; i++) {
    const double wanted = bend > 0.0 ? -slope / bend : (slope > 0.0 ? -LONGEST : LONGEST);
    const double step = lesser(greater(wanted, -LONGEST), LONGEST), next = lesser(greater(s + step, 0.0), 1.0);
    if (!(fabs(next - s) > SHORTEST)) break; /* also where a slope is not a number */
    const uint32_t before = o->base.incumbent;
    double there, unused;
    const cprox_status status = measure(o, piece, next, &there, &unused);
    if (status < 0) return status;
    if (o->base.incumbent == before) break;
    bend = (there - slope) / (next - s);
    s = next, slope = there;
  }
  return CPROX_OK;
}

static cprox_status look_at(curve_radius *o, size_t piece, double s) {
  const uint32_t before = o->base.incumbent;
  double slope, bend;
  const cprox_status status = measure(o, piece, s, &slope, &bend);
  if (status < 0 || o->base.incumbent == before) return status;
  const bool worthwhile =
      o->base.best_bound.upper > o->base.effort.good_enough && o->base.nodes > o->base.effort.newton_after;
  return worthwhile ? refine(o, piece, s, slope, bend) : CPROX_OK;
}

static bool is_piece(const curve_radius *o, const search_node *node) {
  return curve_side_is_piece(&o->base.side, &known(node)->at);
}

/* Where the best point cuts the node's own parameter, or -1 where it does not lie well inside. */
static double best_inside(const curve_radius *o, const search_node *node) {
  const curve_interval *at = &known(node)->at;
  if (o->base.incumbent == 0 || curve_side_piece(&o->base.side, at) != o->base.best.piece) return -1.0;
  const double s = (o->base.best.s - at->a) / (at->b - at->a);
  return s > 1e-12 && s < 1.0 - 1e-12 ? s : -1.0;
}

/* Where the control points are lowest along the best normal, but well inside. */
static double promising(const curve_radius *o, const curve_radius_node *payload) {
  const curve_interval *at = &payload->at;
  if (o->base.incumbent == 0) return 0.5 * (at->a + at->b);
  const size_t degree = o->base.side.curve->degree;
  const double *x = points_pool_at(&o->base.pool, (size_t)at->slot), *y = x + degree + 1, *z = y + degree + 1,
               *r = points_pool_at(&o->base.pool, (size_t)payload->radius.slot);
  const vec3 n = o->base.best.normal;
  size_t lowest = 0;
  double least = INFINITY;
  for (size_t i = 0; i <= degree; i++) {
    const double reach = n.x * x[i] + n.y * y[i] + n.z * z[i] - r[i];
    if (reach < least) least = reach, lowest = i;
  }
  const double fraction = lesser(greater((double)lowest / (double)degree, 0.125), 0.875);
  return at->a + fraction * (at->b - at->a);
}

static cprox_status probe(void *self, search_node *node, search_best *best) {
  curve_radius *o = self;
  curve_radius_node *payload = own(node);
  o->base.nodes++;
  cprox_status status = CPROX_OK;
  if (is_piece(o, node)) {
    if (!curve_side_materialise(&o->base.side, &payload->at)) return curve_side_failure(&o->base.side);
    if (!curve_side_materialise(&o->radius, &payload->radius)) return curve_side_failure(&o->radius);
    o->base.last = o->base.best;
    if (best_inside(o, node) < 0.0)
      status = look_at(o, curve_side_piece(&o->base.side, &payload->at), promising(o, payload));
  } else if (o->base.incumbent == 0) {
    double s;
    const size_t nearest = curve_side_nearest_piece(&o->base.side, &payload->at, &s);
    status = look_at(o, nearest, s);
  } else {
    o->base.last = o->base.best;
  }
  if (status < 0) return status;
  *best = o->base.best_bound;
  bound(o, node, &o->base.last);
  bound(o, node, &o->base.best);
  payload->seen = o->base.incumbent;
  return CPROX_OK;
}

/* ---- splits ---- */

static int split(void *self, search_node *node, search_node *child) {
  curve_radius *o = self;
  curve_radius_node *payload = own(node);
  curve_interval half[2], radius[2];
  const bool piece = is_piece(o, node);
  if (piece) {
    const curve_interval *at = &payload->at;
    const double inside = best_inside(o, node), s = inside < 0.0 ? 0.5 : inside;
    const double cut = inside < 0.0 ? 0.5 * (at->a + at->b) : o->base.best.s;
    if (!(at->a < cut && cut < at->b)) return 0;
    load(o, curve_side_piece(&o->base.side, at));
    if (!curve_side_cut_piece(&o->base.side, &payload->at, cut, s, half)) return curve_side_failure(&o->base.side);
    if (!curve_side_cut_piece(&o->radius, &payload->radius, cut, s, radius)) return curve_side_failure(&o->radius);
  } else {
    curve_side_cut_range(&payload->at, half);
    curve_side_cut_range(&payload->radius, radius);
  }
  int children = 0;
  for (int k = 0; k < 2; k++) {
    if (!piece && curve_side_is_empty(&o->base.side, &half[k])) continue;
    search_node *one = &child[children++];
    *one = *node;
    own(one)->at = half[k], own(one)->radius = radius[k];
    bound(o, one, &o->base.best);
    if (!vec_equal(o->base.last.normal, o->base.best.normal)) bound(o, one, &o->base.last);
    own(one)->seen = o->base.incumbent;
  }
  return children;
}

static void release(void *self, const search_node *node) {
  curve_radius *o = self;
  points_pool_release(&o->base.pool, known(node)->at.slot);
  points_pool_release(&o->base.pool, known(node)->radius.slot);
}

/* ---- the oracle ---- */

void curve_radius_begin(curve_radius *o, const cprox_curve *centres, const cprox_curve *radii) {
  o->centres = *centres, o->radii = *radii;
  o->base.side.curve = &o->centres;
  o->base.side.part = curve_side_whole();
  o->offset = o->base.offset;
  const frame world = frame_create(&CPROX_POSE_IDENTITY, vec(0, 0, 0));
  curve_side_begin(&o->radius, &o->radii, &world, &o->base.pool, RADIUS_ROOT);
}

search_node curve_radius_root(const curve_radius *o) {
  search_node root = {.lower = -INFINITY};
  own(&root)->at = o->base.side.part;
  own(&root)->radius = o->radius.part;
  return root;
}

search_oracle curve_radius_oracle(curve_radius *o) {
  return (search_oracle){.self = o,
                         .work = &o->base.distance_queries,
                         .filter = filter,
                         .probe = probe,
                         .split = split,
                         .release = release};
}
