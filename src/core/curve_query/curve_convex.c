/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_query/curve_convex.h"

#include "base/rounding.h"
#include "convex/depth.h"
#include "convex/feature.h"
#include "curve/control.h"
#include "curve/packets.h"
#include "curve_query/newton_convex.h"

/* The loaded piece lies in the plane z = 0 of a polygon's frame, exactly: then so does the true curve. */
static bool piece_is_planar(curve_convex *o) {
  if (o->planar_piece != o->side.root_piece) {
    const size_t degree = o->side.curve->degree;
    const double *z = points_pool_at(&o->pool, CURVE_CONVEX_ROOT) + 2 * (degree + 1);
    o->planar_piece = o->side.root_piece;
    o->planar = o->shape->ops->kind == CPROX_BODY_POLYGON && o->side.frame.about_z && !o->side.curve->arcs;
    for (size_t i = 0; i <= degree && o->planar; i++) o->planar = z[i] == 0.0;
  }
  return o->planar;
}

static bool is_piece(const curve_convex *o, const search_node *node) {
  return curve_side_is_piece(&o->side, &curve_convex_known(node)->at);
}

/* ---- bounds ---- */

/* What rounding can take from n·P - h(n): dot products, the support value, |n| not quite 1, the subtractions. */
static double bound_slack(const curve_convex *o, double error, double magnitude, double bound) {
  const convex *shape = o->shape;
  const double sizes = magnitude + shape->scale + shape->margin + o->offset + fabs(bound);
  return ROUND_UP * (error + ROUND_SUPPORT * ROUND_U * sizes + shape->slack);
}

/* Weak duality: along any unit n the body reaches no farther than h(n), so min n·P - h(n) is a lower bound. */
void curve_convex_bound(const curve_convex *o, search_node *node, const curve_sample *sample) {
  if (!isfinite(sample->support)) return;
  const curve_reach reach = curve_side_reach(&o->side, &curve_convex_own(node)->at, sample->normal);
  const double bound = reach.least - sample->support;
  const double slack = bound_slack(o, reach.error, reach.magnitude, bound);
  node->lower = greater(bound - slack, node->lower);
  node->slack = slack;
}

/* Whether bounds need not rise any more: the query is settled, or the best point is as near as the answer needs. */
static bool is_enough(const curve_convex *o, double lower) {
  return lower > o->goal || lower >= o->best_bound.upper - o->effort.epsilon;
}

/* The ball or cylinder that touches the body at the best sample; found when it is first wanted. */
static bool know_cover(curve_convex *o) {
  if (!o->cover_known) {
    const convex_ops *ops = o->shape->ops;
    o->cover_usable = ops->cover && ops->cover(o->shape, &o->best.near, &o->cover);
    o->cover_known = true;
  }
  return o->cover_usable;
}

/* A point or a ball is its own cover, from wherever it is seen, and the side of a cylinder or a capsule from all round
 * the axis: so curves round it at one distance are bounded at once. */
static bool cover_is_the_body(const curve_convex *o) {
  const cprox_body_kind kind = o->shape->ops->kind;
  if (o->cover.cylinder) return kind == CPROX_BODY_CYLINDER || kind == CPROX_BODY_CAPSULE;
  return o->cover.radius == o->shape->margin;
}

/* And more than a point. */
static bool has_round_core(const curve_convex *o) {
  return convex_is_round(o->shape) && o->shape->scale > o->shape->margin;
}

/* Where the curve bends round a vertex or an edge, a plane is too weak; the distance from the cover's centre is not. */
static void bound_by_cover(curve_convex *o, search_node *node) {
  curve_convex_node *payload = curve_convex_own(node);
  const double from_centre =
      curve_side_distance_from(&o->side, &payload->at, o->cover.centre, o->cover.cylinder ? &o->cover.axis : NULL);
  const double bound = from_centre - o->cover.radius - o->offset;
  const double slack = ROUND_UP * (payload->at.error + 4.0 * ROUND_U * (from_centre + o->cover.radius + o->offset));
  node->lower = greater(bound - slack, node->lower);
}

/* Of a body that looks the same all round its axis the best plane, turned round it, says as much on every side: its
 * height over the plane is that of the distance from the axis and of the place along it. */
static void bound_all_round(curve_convex *o, search_node *node) {
  static const vec3 AXIS = {0.0, 0.0, 1.0};
  const curve_interval *at = &curve_convex_own(node)->at;
  const vec3 n = o->best.normal;
  const double across = hypot(n.x, n.y);
  if (!isfinite(o->best.support) || !(across > 0.0)) return;
  const double from_axis = curve_side_distance_from(&o->side, at, vec(0, 0, 0), &AXIS);
  const curve_reach along = curve_side_reach(&o->side, at, vec(0.0, 0.0, n.z));
  const double bound = across * from_axis + along.least - o->best.support;
  const double slack = 2.0 * bound_slack(o, at->error + along.error, along.magnitude + from_axis, bound);
  node->lower = greater(bound - slack, node->lower);
}

/* Nodes touch at their ends, so the best point may belong to two of them. */
static bool holds_best(const curve_convex *o, const search_node *node) {
  const curve_convex_node *payload = curve_convex_known(node);
  return curve_side_piece(&o->side, &payload->at) == o->best.piece && payload->at.a <= o->best.s &&
         o->best.s <= payload->at.b;
}

/* Of a node: a cut nearer to one of its ends leaves a child that is so many times shorter, and settles nothing. */
#define WELL_INSIDE 1e-12

/* Where the best point cuts the node's own parameter, or -1 where it does not lie well inside. */
static double best_inside(const curve_convex *o, const search_node *node) {
  const curve_convex_node *payload = curve_convex_known(node);
  if (o->incumbent == 0 || !holds_best(o, node)) return -1.0;
  const double s = (o->best.s - payload->at.a) / (payload->at.b - payload->at.a);
  return s > WELL_INSIDE && s < 1.0 - WELL_INSIDE ? s : -1.0;
}

/* Of a curve that is known by its arc length, whether the best point, once refined, is an end of the interval: 1 its
 * start, 2 its end; 0 neither. */
static int best_end(const curve_convex *o, const search_node *node) {
  if (!o->side.curve->arcs || !o->refined || !holds_best(o, node)) return 0;
  const curve_interval *at = &curve_convex_known(node)->at;
  return o->best.s == at->a ? 1 : o->best.s == at->b ? 2 : 0;
}

/* How far the other end of such an interval lies beyond the best point, along the best normal. */
static double rise(const curve_convex *o, const search_node *node, int end) {
  const vec3 far = curve_side_end(&o->side, &curve_convex_known(node)->at, end == 1);
  return vec_dot(o->best.normal, far) - o->best.support - (o->best_bound.upper - o->best_bound.slack);
}

/* An interval of an ellipsoid reaches below its chord by about c times its length squared, and towards it from the best
 * point the curve rises by about k times that. So of [f x, x] from the best point on all is settled where
 * k f² >= c (1 - f)²: the interval's own bound and end tell c and k. The cuts at f, f², … of the interval from the best
 * point on, until what is left is settled as well; their number. */
static int uneven_cuts(const curve_convex *o, const search_node *node, int end, double cut[CURVE_PACK]) {
  static const double MORE = 1.1, LEAST = 1.0 / 32, MOST = 0.75;
  const curve_interval *at = &curve_convex_known(node)->at;
  const double k = rise(o, node, end), c = o->best_bound.upper - node->lower, width = at->b - at->a;
  double f = 0.5, part = 1.0;
  if (k > 0.0 && c > 0.0) f = lesser(greater(MORE / (1.0 + sqrt(k / c)), LEAST), MOST);
  int n = 0;
  do {
    part *= f;
    cut[n++] = end == 1 ? at->a + part * width : at->b - part * width;
  } while (n < CURVE_PACK - 1 && k > 0.0 && c * part * part > o->effort.epsilon);
  for (int i = 0; end == 1 && 2 * i < n - 1; i++) { /* ascending */
    const double other = cut[i];
    cut[i] = cut[n - 1 - i];
    cut[n - 1 - i] = other;
  }
  return n;
}

static double filter(void *self, search_node *node, double goal) {
  curve_convex_node *payload = curve_convex_own(node);
  curve_convex *o = self;
  o->goal = goal;
  if (o->incumbent == 0) return node->lower;
  if (payload->at.slot >= 0) curve_side_load(&o->side, curve_side_piece(&o->side, &payload->at));
  if (payload->seen != o->incumbent) {
    curve_convex_bound(o, node, &o->best);
    payload->seen = o->incumbent;
  }
  if (payload->at.slot >= 0 && node->lower < goal && payload->seen_ball != o->incumbent &&
      (o->refined || o->nodes >= o->effort.newton_after)) {
    const bool covered = know_cover(o) && (cover_is_the_body(o) || holds_best(o, node));
    if (covered) bound_by_cover(o, node);
    const bool round = node->lower < goal && has_round_core(o) && !o->side.radius;
    if (round) bound_all_round(o, node);
    if (covered || round) payload->seen_ball = o->incumbent;
  }
  return node->lower;
}

/* ---- distance queries ---- */

/* A distance from the core whose upper bound ends the search: its last digits are of no interest. */
static double near_enough(const curve_convex *o, double offset, double rounding) {
  const double d = o->effort.good_enough + offset;
  return d > 0.0 ? d + o->shape->margin - 2.0 * (rounding + 4.0 * ROUND_U * (d + o->shape->margin)) : 0.0;
}

bool curve_convex_is_flat(curve_convex *o) {
  if (!o->flat_known) flat_describe(o->shape, &o->flat);
  o->flat_known = true;
  return o->flat.dimension < 3;
}

/* How far a point may be from the plane that supports the shape along n, on its side of it. */
static double depth_along(curve_convex *o, vec3 y, vec3 n) {
  return o->shape->ops->support(o->shape, n, &o->support_hint, NULL) - vec_dot(n, y);
}

/* Bounds need a plane between the shape and a point that touches it. There the way from the nearest point is rounding,
 * or none. A flat shape has a plane of its own. Else a plane that separates the shape from a point a little farther out
 * will do, as long as that point lies less far out than the touching point lies from the next edge: so the steps get
 * shorter. */
static vec3 touching_normal(curve_convex *o, vec3 y, vec3 seen, double rounding) {
  enum { ROUNDS = 7 };
  vec3 best = seen, outward, n;
  double least = vec_norm2(seen) > 0.0 ? depth_along(o, y, seen) : INFINITY;
  if (!(least > 4.0 * rounding)) return seen;
  if (curve_convex_is_flat(o)) return o->flat.normal;
  feature_unit(y, &outward);
  double step = 1e-2 * o->shape->scale;
  for (int i = 0; i < ROUNDS && least > 4.0 * rounding; i++, step *= 1e-2) {
    convex_near near;
    convex_hint hint = {0};
    o->shape->ops->nearest(o->shape, vec_axpy(y, step, outward), &hint, &near);
    if (!(feature_unit(near.normal, &n) > 0.0)) break;
    const double depth = depth_along(o, y, n);
    if (depth < least) least = depth, best = n;
  }
  return best;
}

cprox_status curve_convex_measure(curve_convex *o, size_t piece, double s, vec3 y, double error, curve_sample *sample,
                                  search_best *bound) {
  const cprox_status usable = curve_side_status(&o->side);
  if (usable < 0) return usable;
  o->distance_queries++;
  sample->piece = piece, sample->s = s, sample->y = y;
  const double offset = o->side.radius ? o->offset + curve_side_thickness(&o->side, piece, s).value : o->offset;
  const double sizes = vec_norm(y) + o->shape->scale + o->shape->margin;
  const double rounding = error + o->shape->ops->near_rounding * ROUND_U * sizes + o->shape->slack;
  o->hint.near_enough = near_enough(o, offset, rounding);
  if (piece_is_planar(o))
    convex_polygon_nearest_in_plane(o->shape, y, &sample->near);
  else
    o->shape->ops->nearest(o->shape, y, &o->hint, &sample->near);
  if (o->effort.is_signed && sample->near.distance <= 0.0 && vec_norm2(sample->near.normal) == 0.0)
    depth_of_point(o->shape, y, 0.1 * o->effort.epsilon, &sample->near);
  const double d = sample->near.distance;
  if (isnan(d)) return workspace_fail(o->workspace, CPROX_INVALID, CONVEX_NO_SUPPORT);

  /* the surface point is attained, so the distance to it is an upper bound but for rounding */
  bound->slack = ROUND_UP * (rounding + 2.0 * ROUND_U * (fabs(d) + offset));
  bound->upper = d - offset + bound->slack - convex_sure(o->shape, d);

  /* any direction near the normal will do for the lower bounds, as long as its length is 1 */
  sample->normal = sample->near.normal;
  const bool touching =
      fabs(d) <= rounding && bound->upper > greater(o->effort.good_enough, o->settled) && !piece_is_planar(o);
  if (touching) sample->normal = touching_normal(o, y, sample->normal, rounding);
  const double length2 = vec_norm2(sample->normal);
  if (fabs(length2 - 1.0) > ROUND_NORMAL * ROUND_U && length2 > 0.0)
    sample->normal = vec_scale(1.0 / sqrt(length2), sample->normal);
  sample->support = INFINITY;
  if (length2 > 0.0) {
    const double height = sample->near.height_known && !touching
                              ? sample->near.height
                              : o->shape->ops->support(o->shape, sample->normal, &o->support_hint, NULL);
    sample->support = height + o->shape->margin + o->offset;
  }
  return CPROX_OK;
}

void curve_convex_adopt(curve_convex *o, const curve_sample *sample, search_best bound) {
  o->best = *sample;
  o->best_bound = bound;
  o->incumbent++;
  o->cover_known = false;
}

/* Distances are to be had exactly; verdicts are where they do not come easily, or where the curve would cover what is
 * left to the limit within a sixteenth of the piece. */
static bool is_worth_refining(const curve_convex *o, double upper, const curve_jet *jet) {
  static const double NEAR = 1.0 / 16;
  const double left = upper - o->effort.good_enough;
  if (!(left > 0.0)) return false;
  return o->nodes > o->effort.newton_after || left * left < NEAR * NEAR * vec_norm2(jet->d1);
}

/* Measures at s of the loaded piece, and goes on from there by Newton's steps, the first no longer than `step`. */
static cprox_status probe_at(curve_convex *o, size_t piece, double s, double step) {
  const double *points = points_pool_at(&o->pool, CURVE_CONVEX_ROOT);
  curve_jet jet = {0};
  if (o->side.curve->arcs)
    jet.x = curve_side_point(&o->side, s); /* it has no derivatives */
  else
    jet = newton_jet(o, points, s);
  search_best bound = {.upper = INFINITY};
  const cprox_status status =
      curve_convex_measure(o, piece, s, jet.x, curve_side_point_error(&o->side), &o->last, &bound);
  if (status < 0 || bound.upper >= o->best_bound.upper) return status;
  curve_convex_adopt(o, &o->last, bound);
  o->refined = is_worth_refining(o, bound.upper, &jet);
  return o->refined ? newton_refine(o, points, &jet, step) : CPROX_OK;
}

/* From the frame's origin, about which the body stands, towards the chord of a range: a normal that is had without a
 * measurement. False where the chord meets the origin. */
static bool normal_from_origin(curve_convex *o, const search_node *node) {
  const vec3 y = curve_side_chord_from_origin(&o->side, &curve_convex_known(node)->at);
  const double length2 = vec_norm2(y);
  if (!(length2 > 0.0 && isfinite(length2))) return false;
  o->last.normal = vec_scale(1.0 / sqrt(length2), y);
  o->last.support =
      o->shape->ops->support(o->shape, o->last.normal, &o->support_hint, NULL) + o->shape->margin + o->offset;
  return true;
}

/* Where the loaded piece comes nearest to the frame's origin, about which the body stands, as far as a few points tell.
 */
static double nearest_sample(const curve_convex *o) {
  const size_t degree = o->side.curve->degree;
  const double *x = points_pool_at(&o->pool, CURVE_CONVEX_ROOT);
  return packet_nearest_sample(curve_binomial(o->side.curve), x, x + degree + 1, x + 2 * (degree + 1), degree);
}

/* Many pieces are so short that their chords tell as much as points on them. */
static bool is_long(const curve_convex *o) {
  return o->side.curve->n_pieces > CHORDS;
}

/* The first measurement is on the piece that the nearer chords lead to. Of what a range falls into bounds are had
 * without any; a curve that has no chords is measured at the point where two ranges meet, which is a control point. */
static cprox_status probe_range(curve_convex *o, const search_node *node) {
  const curve_convex_node *payload = curve_convex_known(node);
  if (o->incumbent == 0 && !o->side.curve->arcs) {
    double s;
    const size_t nearest = curve_side_nearest_piece(&o->side, &payload->at, &s);
    curve_side_load(&o->side, nearest);
    return probe_at(o, nearest, is_long(o) ? s : nearest_sample(o), 0.5 / CHORDS);
  }
  if (o->incumbent > 0) {
    o->last = o->best;
    return CPROX_OK;
  }
  size_t piece;
  double s, error;
  const vec3 y = curve_side_junction(&o->side, &payload->at, &piece, &s, &error);
  search_best bound = {.upper = INFINITY};
  const cprox_status status = curve_convex_measure(o, piece, s, y, error, &o->last, &bound);
  if (status == CPROX_OK && bound.upper < o->best_bound.upper) curve_convex_adopt(o, &o->last, bound);
  return status;
}

/* Where the interval's lowest control point along the best normal pulls most, but well inside. Without a normal, where
 * the piece comes nearest to the frame's origin, about which the body stands, as far as a few points tell, or the
 * middle. */
static double promising(const curve_convex *o, const curve_interval *at, double *step) {
  double fraction = 0.5;
  *step = 0.25 * (at->b - at->a);
  if (o->incumbent == 0 && !o->side.curve->arcs && at->a == 0.0 && at->b == 1.0) {
    *step = 0.5 / CHORDS;
    return nearest_sample(o);
  }
  if (o->incumbent > 0 && vec_norm2(o->best.normal) > 0.0) {
    const size_t degree = o->side.curve->degree;
    const size_t lowest = curve_side_lowest(&o->side, at, o->best.normal);
    fraction = lesser(greater((double)lowest / (double)degree, 0.125), 0.875);
  }
  return at->a + fraction * (at->b - at->a);
}

static cprox_status probe_piece(curve_convex *o, const search_node *node) {
  const curve_interval *at = &curve_convex_known(node)->at;
  double step;
  const double s = promising(o, at, &step);
  return probe_at(o, curve_side_piece(&o->side, at), s, step);
}

cprox_status curve_convex_seed(curve_convex *o, size_t piece, double s, search_node *root) {
  curve_convex_node *payload = curve_convex_own(root);
  o->nodes++;
  curve_side_load(&o->side, piece);
  const cprox_status status = probe_at(o, piece, s, 1.0 / 16);
  if (status < 0 || o->incumbent == 0 || o->best_bound.upper <= o->effort.good_enough) return status;
  if (is_piece(o, root) && !curve_side_materialise(&o->side, &payload->at)) return curve_side_failure(&o->side);
  curve_convex_bound(o, root, &o->best);
  payload->seen = o->incumbent;
  return CPROX_OK;
}

static cprox_status probe(void *self, search_node *node, search_best *best) {
  curve_convex_node *payload = curve_convex_own(node);
  curve_convex *o = self;
  o->nodes++;
  const bool piece = is_piece(o, node);
  if (piece) {
    if (!curve_side_materialise(&o->side, &payload->at)) return curve_side_failure(&o->side);
    if (best_inside(o, node) >= 0.0) {
      if (payload->seen != o->incumbent) curve_convex_bound(o, node, &o->best);
      payload->seen = o->incumbent;
      o->last = o->best;
      return CPROX_OK;
    }
    /* beyond the best point the curve rises */
    const int end = best_end(o, node);
    if (end && rise(o, node, end) > 0.0) {
      if (payload->seen != o->incumbent) curve_convex_bound(o, node, &o->best);
      payload->seen = o->incumbent;
      o->last = o->best;
      return CPROX_OK;
    }
  }
  const uint32_t before = o->incumbent;
  const cprox_status status = piece ? probe_piece(o, node) : probe_range(o, node);
  if (status < 0) return status;
  *best = o->best_bound;
  /* a plane never rises above the best point's distance: the halves will need no less */
  const bool decisive = o->goal < o->best_bound.upper - 2.0 * o->effort.epsilon;
  if (piece && !decisive && best_inside(o, node) >= 0.0) return CPROX_OK;

  /* the probe's own normal, and the best one if it is another: one step further is the best of a probe that was not
   * refined */
  curve_convex_bound(o, node, &o->last);
  if (payload->seen != o->incumbent &&
      !(o->incumbent == before + 1 && o->last.s == o->best.s && o->last.piece == o->best.piece))
    curve_convex_bound(o, node, &o->best);
  payload->seen = o->incumbent;
  return CPROX_OK;
}

/* ---- splits ---- */

/* Children know the best normal from birth, and the last where that leaves something open. */
static void bound_child(curve_convex *o, search_node *child) {
  curve_convex_bound(o, child, &o->best);
  if (!is_enough(o, child->lower) && !vec_equal(o->last.normal, o->best.normal)) curve_convex_bound(o, child, &o->last);
  curve_convex_own(child)->seen = o->incumbent;
}

/* A child that is this part of the node; the number of children then. */
static int add_child(curve_convex *o, const search_node *node, const curve_interval *part, search_node *child, int n) {
  child[n] = *node;
  curve_convex_own(&child[n])->at = *part;
  curve_convex_own(&child[n])->seen_ball = 0;
  bound_child(o, &child[n]);
  return n + 1;
}

/* Raises all of them by the normal of a sample. */
static void bound_range_children(const curve_convex *o, const curve_pack *pack, search_node *child, size_t n,
                                 const curve_sample *sample) {
  if (!isfinite(sample->support)) return;
  double least[CURVE_PACK];
  const curve_reach reach = curve_side_children_reach(&o->side, pack, sample->normal, least);
  for (size_t k = 0; k < n; k++) {
    const double bound = least[k] - sample->support;
    const double slack = bound_slack(o, reach.error, reach.magnitude, bound);
    child[k].lower = greater(bound - slack, child[k].lower);
    child[k].slack = slack;
  }
}

/* And by the ball about the frame's origin that the body lies in: each from its own side, as no one plane sees them. */
static void bound_range_children_by_ball(const curve_convex *o, const curve_pack *pack, search_node *child, size_t n) {
  const convex *shape = o->shape;
  if (shape->ops->kind == CPROX_BODY_HALFSPACE) return;
  double least[CURVE_PACK];
  const curve_reach reach = curve_side_children_distance(&o->side, pack, least);
  const double radius = shape->scale + o->offset;
  const double slack = ROUND_UP * (reach.error + 64.0 * ROUND_U * (reach.magnitude + radius) + shape->slack);
  for (size_t k = 0; k < n; k++) child[k].lower = greater(least[k] - radius - slack, child[k].lower);
}

/* Whether something is left that bounds have not settled. */
static bool is_open(const curve_convex *o, const search_node *child, size_t n) {
  for (size_t k = 0; k < n; k++)
    if (!is_enough(o, child[k].lower)) return true;
  return false;
}

/* A range of pieces falls into as many as are bounded at once: a bound costs much less than a measurement. What the
 * ball leaves open the best normal may settle, and what that leaves the one from the body's middle. */
static int split_range(curve_convex *o, const search_node *node, search_node *child) {
  curve_interval part[CURVE_PACK];
  curve_pack pack;
  const size_t n = curve_side_children(&o->side, &curve_convex_known(node)->at, part, &pack);
  for (size_t k = 0; k < n; k++) {
    child[k] = *node;
    curve_convex_own(&child[k])->at = part[k];
    curve_convex_own(&child[k])->seen_ball = 0;
    curve_convex_own(&child[k])->seen = o->incumbent;
  }
  bound_range_children_by_ball(o, &pack, child, n);
  if (is_open(o, child, n)) bound_range_children(o, &pack, child, n, &o->best);
  if (is_open(o, child, n) && normal_from_origin(o, node)) bound_range_children(o, &pack, child, n, &o->last);
  return (int)n;
}

static int split(void *self, search_node *node, search_node *child) {
  curve_convex *o = self;
  if (!is_piece(o, node)) return split_range(o, node, child);

  /* at the witness point, from the witness point on, or in the middle */
  curve_interval *at = &curve_convex_own(node)->at, part[CURVE_PACK];
  const double inside = best_inside(o, node);
  const int end = best_end(o, node);
  double cut[CURVE_PACK] = {inside < 0.0 ? 0.5 * (at->a + at->b) : o->best.s};
  const int n = inside < 0.0 && end ? uneven_cuts(o, node, end, cut) : 1;
  for (int k = 0; k <= n; k++)
    if (!((k > 0 ? cut[k - 1] : at->a) < (k < n ? cut[k] : at->b))) return 0;
  const bool done = n > 1 ? curve_side_cut_arcs(&o->side, at, cut, n, part)
                          : curve_side_cut_piece(&o->side, at, cut[0], inside < 0.0 ? 0.5 : inside, part);
  if (!done) return curve_side_failure(&o->side);
  int children = 0;
  for (int k = 0; k <= n; k++) children = add_child(o, node, &part[k], child, children);
  return children;
}

static void release(void *self, const search_node *node) {
  curve_convex *o = self;
  points_pool_release(&o->pool, curve_convex_known(node)->at.slot);
}

/* ---- the oracle ---- */

bool curve_convex_begin(curve_convex *o, const cprox_curve *curve, const convex *shape, frame placed, double offset,
                        cprox_workspace *workspace) {
  *o = (curve_convex){.shape = shape, .offset = offset, .workspace = workspace, .planar_piece = SIZE_MAX};
  o->best_bound.upper = INFINITY;
  o->effort.good_enough = -INFINITY;
  curve_side_begin(&o->side, curve, &placed, &o->pool, CURVE_CONVEX_ROOT);
  return points_pool_begin(&o->pool, curve->degree, CURVE_CONVEX_RESERVED, workspace);
}

search_node curve_convex_root(const curve_convex *o) {
  search_node root = {.lower = -INFINITY};
  curve_convex_own(&root)->at = o->side.part;
  return root;
}

search_oracle curve_convex_oracle(curve_convex *o) {
  return (search_oracle){
      .self = o, .work = &o->distance_queries, .filter = filter, .probe = probe, .split = split, .release = release};
}
