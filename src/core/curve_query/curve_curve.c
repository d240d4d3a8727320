/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_query/curve_curve.h"

#include "base/rounding.h"
#include "convex/depth.h"
#include "curve/packets.h"
#include "curve_query/bent_pieces.h"
#include "curve_query/newton_curves.h"
#include "problem/carried_shape.h"

/* Slots of the pool that nodes never get: each side's loaded piece. */
enum { SLOT_FIRST, SLOT_SECOND, SLOTS_RESERVED };

/* ---- bounds ---- */

double curve_curve_carried(const curve_curve *o, vec3 n) {
  if (!o->carries) return 0.0;
  const convex *shape = &o->joined;
  return vec_dot(n, o->shift) - (shape->ops->support(shape, n, NULL, NULL) + shape->margin);
}

/* Along any unit n: the first curve's least n·P less the second's greatest n·Q is a lower bound. A carried body takes
 * off what it reaches. */
static void bound_by_reaches(const curve_curve *o, search_node *node, vec3 n, const curve_reach *first,
                             const curve_reach *second) {
  double bound = first->least + second->least - o->offset;
  double sizes = first->magnitude + second->magnitude + o->offset, error = first->error + second->error;
  if (o->carries) {
    const convex *shape = &o->joined;
    bound += curve_curve_carried(o, n);
    sizes += 2.0 * (shape->scale + shape->margin + vec_norm(o->shift));
    error += shape->slack;
  }
  const double slack = ROUND_UP * (error + ROUND_SUPPORT * ROUND_U * (sizes + fabs(bound)));
  node->lower = greater(bound - slack, node->lower);
  node->slack = slack;
}

void curve_curve_bound(const curve_curve *o, search_node *node, vec3 n) {
  curve_curve_node *payload = curve_curve_own(node);
  if (vec_norm2(n) == 0.0) return;
  const curve_reach first = curve_side_reach(&o->side[0], &payload->side[0], n);
  const curve_reach second = curve_side_reach(&o->side[1], &payload->side[1], vec_neg(n));
  bound_by_reaches(o, node, n, &first, &second);
}

/* The same for children that are all pairs of the parts: each part is asked once. */
static void bound_children(const curve_curve *o, search_node *child, curve_interval part[2][2], const int n_parts[2],
                           vec3 n) {
  if (vec_norm2(n) == 0.0) return;
  curve_reach reach[2][2];
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < n_parts[k]; i++)
      reach[k][i] = curve_side_reach(&o->side[k], &part[k][i], k == 0 ? n : vec_neg(n));
  for (int i = 0; i < n_parts[0]; i++)
    for (int j = 0; j < n_parts[1]; j++) bound_by_reaches(o, child++, n, &reach[0][i], &reach[1][j]);
}

/* Whether something is left that bounds have not settled, or brought as near to the best meeting as the answer needs.
 */
static bool is_open(const curve_curve *o, const search_node *child, int n) {
  for (int k = 0; k < n; k++)
    if (!(child[k].lower > o->goal || child[k].lower >= o->best_bound.upper - o->effort.epsilon)) return true;
  return false;
}

/* Pieces with points of their own are bounded with their whole piece loaded. */
static void load_pieces(curve_curve *o, const search_node *node) {
  const curve_curve_node *payload = curve_curve_known(node);
  for (int k = 0; k < 2; k++)
    if (payload->side[k].slot >= 0) curve_side_load(&o->side[k], curve_side_piece(&o->side[k], &payload->side[k]));
}

/* Where the curves run beside each other planes are too weak, and how both bend says more. The node's pieces must be
 * the loaded ones. */
static void bound_by_bends(const curve_curve *o, search_node *node) {
  const curve_interval *at = curve_curve_known(node)->side;
  const double *points[2];
  size_t degree[2];
  double magnitude = o->offset;
  for (int k = 0; k < 2; k++) {
    points[k] = points_pool_at(&o->pool, (size_t)at[k].slot);
    degree[k] = o->side[k].curve->degree;
    magnitude += o->side[k].root_magnitude;
  }
  const double apart = bent_pieces_apart(points, degree, magnitude);
  const double slack = ROUND_UP * (at[0].error + at[1].error + 4.0 * ROUND_U * (apart + o->offset));
  node->lower = greater(apart - o->offset - slack, node->lower);
}

/* Most searches end before that costs less than it spares. */
enum { NODES_BEFORE_BENDS = 100 };

static bool is_hard(const curve_curve *o) {
  return o->nodes > NODES_BEFORE_BENDS;
}

static bool may_bend(const curve_curve *o, const search_node *node) {
  if (o->carries || o->side[0].radius || o->side[0].curve->arcs || o->side[1].curve->arcs) return false;
  const curve_interval *at = curve_curve_known(node)->side;
  return curve_side_is_piece(&o->side[0], &at[0]) && curve_side_is_piece(&o->side[1], &at[1]);
}

static double filter(void *self, search_node *node, double goal) {
  curve_curve_node *payload = curve_curve_own(node);
  curve_curve *o = self;
  o->goal = goal;
  if (o->incumbent == 0) return node->lower;
  if (payload->seen != o->incumbent) {
    load_pieces(o, node);
    curve_curve_bound(o, node, o->best.normal);
    payload->seen = o->incumbent;
  }
  bool pieces;
  if (node->lower < goal && is_hard(o) && may_bend(o, node) && curve_curve_materialise(o, node, &pieces) == CPROX_OK) {
    load_pieces(o, node);
    bound_by_bends(o, node);
  }
  return node->lower;
}

/* ---- where the best meeting is ---- */

/* Where the best meeting cuts one side of a node, as a fraction of it: in [0, 1] if it lies there at all, else -1. */
static double best_within(const curve_curve *o, const search_node *node, int k) {
  const curve_interval *at = &curve_curve_known(node)->side[k];
  if (o->incumbent == 0 || !curve_side_is_piece(&o->side[k], at)) return -1.0;
  if (curve_side_piece(&o->side[k], at) != o->best.piece[k]) return -1.0;
  const double s = (o->best.s[k] - at->a) / (at->b - at->a);
  return s >= 0.0 && s <= 1.0 ? s : -1.0;
}

/* Of a node: a cut nearer to one of its ends leaves a child that is so many times shorter, and settles nothing. */
#define WELL_INSIDE 1e-12

static bool is_inner(double s) {
  return s > WELL_INSIDE && s < 1.0 - WELL_INSIDE;
}

/* Both points lie in the node, and at least one of them inside: the node is to be cut there. */
static bool holds_best(const curve_curve *o, const search_node *node) {
  const double s = best_within(o, node, 0), t = best_within(o, node, 1);
  return s >= 0.0 && t >= 0.0 && (is_inner(s) || is_inner(t));
}

/* ---- distance queries ---- */

/* The same of a carried body at the first point. */
static void measure_carried(curve_curve *o, curve_meeting *m, double offset, double error, search_best *bound) {
  const convex *shape = &o->joined;
  const vec3 apart = vec_add(vec_sub(m->point[0], m->point[1]), o->shift);
  shape->ops->nearest(shape, apart, NULL, &m->near);
  if (o->effort.is_signed && m->near.distance <= 0.0 && vec_norm2(m->near.normal) == 0.0)
    depth_of_point(shape, apart, 0.1 * o->effort.epsilon, &m->near);
  o->support_failed |= isnan(m->near.distance);
  m->distance = m->near.distance;
  m->normal = m->near.normal;
  const double length2 = vec_norm2(m->normal);
  if (fabs(length2 - 1.0) > ROUND_NORMAL * ROUND_U && length2 > 0.0)
    m->normal = vec_scale(1.0 / sqrt(length2), m->normal);
  const double sizes = vec_norm(apart) + 2.0 * vec_norm(o->shift) + shape->scale + shape->margin;
  bound->slack = ROUND_UP * (error + shape->ops->near_rounding * ROUND_U * sizes + shape->slack +
                             ROUND_U * (8.0 * fabs(m->distance) + 2.0 * offset));
  bound->upper = m->distance - offset + bound->slack - convex_sure(shape, m->distance);
}

/* The distance between two points of the curves, each within its error of the exact one, is an upper bound. */
void curve_curve_measure(curve_curve *o, curve_meeting *m, double error, search_best *bound) {
  o->distance_queries++;
  const double offset = o->offset + curve_side_thickness(&o->side[0], m->piece[0], m->s[0]).value;
  if (o->carries) {
    measure_carried(o, m, offset, error, bound);
    return;
  }
  const vec3 apart = vec_sub(m->point[0], m->point[1]);
  m->distance = vec_norm(apart);
  m->normal = m->distance > 0.0 ? vec_scale(1.0 / m->distance, apart) : vec(0, 0, 0);
  bound->slack = ROUND_UP * (error + ROUND_U * (8.0 * m->distance + 2.0 * offset));
  bound->upper = m->distance - offset + bound->slack;
}

void curve_curve_adopt(curve_curve *o, const curve_meeting *m, search_best bound) {
  o->best = *m;
  o->best_bound = bound;
  o->incumbent++;
}

static void consider(curve_curve *o, curve_meeting *m, double error) {
  search_best bound = {.upper = INFINITY};
  curve_curve_measure(o, m, error, &bound);
  if (bound.upper < o->best_bound.upper) curve_curve_adopt(o, m, bound);
}

/* The ends of an interval's chord. */
static void chord_of(const curve_side *side, const curve_interval *at, vec3 ends[2]) {
  if (at->slot < 0) {
    double turned = 0.0;
    const curve_capsule capsule = curve_capsule_at(side->curve, at->part);
    ends[0] = frame_to_local(&side->frame, capsule.a, &turned);
    ends[1] = frame_to_local(&side->frame, capsule.b, &turned);
    return;
  }
  const size_t degree = side->curve->degree;
  const double *x = points_pool_at(side->pool, (size_t)at->slot), *y = x + degree + 1, *z = y + degree + 1;
  ends[0] = vec(x[0], y[0], z[0]);
  ends[1] = vec(x[degree], y[degree], z[degree]);
}

/* A point of the interval near the fraction f of its chord; ranges have one at their junction. */
static double point_near(curve_side *side, const curve_interval *at, double f, vec3 *point, size_t *piece, double *s) {
  double error;
  if (!curve_side_is_piece(side, at)) {
    *point = curve_side_junction(side, at, piece, s, &error);
    return error;
  }
  *piece = curve_side_piece(side, at);
  *s = at->a + f * (at->b - at->a);
  *point = curve_side_point(side, *s);
  return curve_side_point_error(side);
}

/* The better of the best meeting and the one that Newton finds from it. */
static void refine_meeting(curve_curve *o, double step) {
  curve_meeting m = o->best;
  if (!newton_curves_descend(o->side, o->carries ? &o->shift : NULL, &m, step)) return;
  consider(o, &m, curve_side_point_error(&o->side[0]) + curve_side_point_error(&o->side[1]));
}

cprox_status curve_curve_materialise(curve_curve *o, search_node *node, bool *pieces) {
  curve_curve_node *payload = curve_curve_own(node);
  *pieces = true;
  for (int k = 0; k < 2; k++) {
    if (!curve_side_is_piece(&o->side[k], &payload->side[k])) {
      *pieces = false;
    } else if (!curve_side_materialise(&o->side[k], &payload->side[k])) {
      return curve_side_failure(&o->side[k]);
    }
  }
  return CPROX_OK;
}

vec3 curve_curve_suggest(curve_curve *o, const search_node *node, double fraction[2]) {
  const curve_curve_node *payload = curve_curve_known(node);
  vec3 first[2], second[2];
  chord_of(&o->side[0], &payload->side[0], first);
  chord_of(&o->side[1], &payload->side[1], second);
  return newton_curves_of_chords(first, second, fraction);
}

curve_meeting curve_curve_meeting_near(curve_curve *o, const search_node *node, const double fraction[2],
                                       double *error) {
  curve_meeting m = {.distance = INFINITY};
  *error = 0.0;
  for (int k = 0; k < 2; k++)
    *error +=
        point_near(&o->side[k], &curve_curve_known(node)->side[k], fraction[k], &m.point[k], &m.piece[k], &m.s[k]);
  return m;
}

/* Where the two pieces that the search begins with come nearest, as far as a few points of each tell. */
static bool nearest_sample(const curve_curve *o, const search_node *node, double fraction[2]) {
  const curve_curve_node *payload = curve_curve_known(node);
  packet_piece piece[2];
  const double *basis[2];
  const size_t degree[2] = {o->side[0].curve->degree, o->side[1].curve->degree};
  for (int k = 0; k < 2; k++)
    if (o->side[k].curve->arcs || payload->side[k].a > 0.0 || payload->side[k].b < 1.0) return false;
  if (o->carries || !packet_bases(degree, o->workspace, basis)) return false;
  for (size_t k = 0; k < 2; k++)
    piece[k] = (packet_piece){basis[k], points_pool_at(&o->pool, (size_t)payload->side[k].slot), degree[k]};
  packet_first_pair(&piece[0], &piece[1], fraction);
  return true;
}

/* Distances are to be had exactly; verdicts are, where the best meeting is so near the limit that they may hang on the
 * last digits, or where they do not come easily. */
static bool is_worth_refining(const curve_curve *o) {
  static const double NEAR = 1.05;
  const double upper = o->best_bound.upper;
  return upper > o->effort.good_enough && (o->nodes > o->effort.newton_after || upper < NEAR * o->effort.good_enough);
}

/* Measures near those fractions of the node's intervals, and goes on from there. The normal seen there is the one to go
 * by where there are no chords, or where it is worth more than theirs. */
static cprox_status measure_node(curve_curve *o, search_node *node, const double fraction[2], bool pieces,
                                 bool looked) {
  const curve_curve_node *payload = curve_curve_known(node);
  double error;
  curve_meeting m = curve_curve_meeting_near(o, node, fraction, &error);
  const uint32_t before = o->incumbent;
  consider(o, &m, error);
  if (curve_side_status(&o->side[0]) < 0) return curve_side_status(&o->side[0]); /* both sides keep it in one place */
  if (o->support_failed) return workspace_fail(o->workspace, CPROX_INVALID, CONVEX_NO_SUPPORT);
  if (o->carries || looked) {
    load_pieces(o, node);
    o->last_normal = m.normal;
  }
  if (o->carries) curve_curve_bound(o, node, m.normal);
  const double step = 0.25 * fmax(payload->side[0].b - payload->side[0].a, payload->side[1].b - payload->side[1].a);
  if (pieces && o->incumbent != before && is_worth_refining(o)) refine_meeting(o, step);
  return CPROX_OK;
}

static cprox_status probe(void *self, search_node *node, search_best *best) {
  curve_curve_node *payload = curve_curve_own(node);
  curve_curve *o = self;
  o->nodes++;
  bool pieces;
  const cprox_status ready = curve_curve_materialise(o, node, &pieces);
  if (ready < 0) return ready;

  /* points of both suggest where to measure, or the chords do, and a normal */
  double fraction[2];
  const bool looked = pieces && o->incumbent == 0 && nearest_sample(o, node, fraction);
  if (!looked) {
    o->last_normal = curve_curve_suggest(o, node, fraction);
    curve_curve_bound(o, node, o->last_normal);
    if (o->incumbent > 0 && node->lower > o->goal) return CPROX_OK; /* settled: nothing to measure */
  }

  if (!holds_best(o, node)) {
    const cprox_status measured = measure_node(o, node, fraction, pieces, looked);
    if (measured < 0) return measured;
    *best = o->best_bound;
  }

  /* measuring may have loaded other pieces */
  load_pieces(o, node);
  if (payload->seen != o->incumbent) curve_curve_bound(o, node, o->best.normal);
  payload->seen = o->incumbent;
  return CPROX_OK;
}

/* ---- splits ---- */

/* How long an interval is, roughly: which side to cut. */
static double length_of(const curve_side *side, const curve_interval *at) {
  vec3 ends[2];
  chord_of(side, at, ends);
  const double radius = curve_capsule_at(side->curve, at->part).radius;
  return vec_norm(vec_sub(ends[1], ends[0])) + 2.0 * radius * (at->b - at->a);
}

int curve_curve_longer_side(const curve_curve *o, const search_node *node) {
  const curve_curve_node *payload = curve_curve_known(node);
  return length_of(&o->side[0], &payload->side[0]) >= length_of(&o->side[1], &payload->side[1]) ? 0 : 1;
}

void curve_curve_cut_middle(curve_curve_cuts *cuts, const search_node *node, int k) {
  const curve_curve_node *payload = curve_curve_known(node);
  cuts->wanted[k] = true;
  cuts->s[k] = 0.5;
  cuts->at[k] = 0.5 * (payload->side[k].a + payload->side[k].b);
}

static bool are_ranges(const curve_curve *o, const search_node *node) {
  const curve_curve_node *payload = curve_curve_known(node);
  return !curve_side_is_piece(&o->side[0], &payload->side[0]) && !curve_side_is_piece(&o->side[1], &payload->side[1]);
}

/* The longer side in its middle; two ranges of about one length both, since bounds cost less than measurements. */
static curve_curve_cuts choose_cuts(const curve_curve *o, const search_node *node) {
  const curve_curve_node *payload = curve_curve_known(node);
  curve_curve_cuts cuts = {.wanted = {false, false}};
  if (!holds_best(o, node)) {
    const int longer = curve_curve_longer_side(o, node), other = 1 - longer;
    curve_curve_cut_middle(&cuts, node, longer);
    if ((are_ranges(o, node) || (is_hard(o) && may_bend(o, node))) &&
        2.0 * length_of(&o->side[other], &payload->side[other]) > length_of(&o->side[longer], &payload->side[longer]))
      curve_curve_cut_middle(&cuts, node, other);
    return cuts;
  }
  for (int k = 0; k < 2; k++) {
    cuts.s[k] = best_within(o, node, k);
    cuts.wanted[k] = is_inner(cuts.s[k]);
    cuts.at[k] = o->best.s[k];
  }
  return cuts;
}

/* Cuts side k of the node in two, or leaves it whole; the number of parts, 0 where it is too short, -1 without memory.
 */
static int cut_side(curve_curve *o, search_node *node, int k, const curve_curve_cuts *cuts, curve_interval part[2]) {
  curve_interval *at = &curve_curve_own(node)->side[k];
  curve_side *side = &o->side[k];
  part[0] = *at;
  if (!cuts->wanted[k]) return 1;
  if (!curve_side_is_piece(side, at)) {
    curve_side_cut_range(at, part);
    return curve_side_is_empty(side, &part[1]) ? 1 : 2;
  }
  const double cut = cuts->at[k];
  if (!(at->a < cut && cut < at->b)) return 0;
  return curve_side_cut_piece(side, at, cut, cuts->s[k], part) ? 2 : -1;
}

int curve_curve_cut(curve_curve *o, search_node *node, const curve_curve_cuts *cuts, search_node *child) {
  curve_interval part[2][2];
  int n[2];
  for (int k = 0; k < 2; k++) {
    n[k] = cut_side(o, node, k, cuts, part[k]);
    if (n[k] == 0) return 0;
    if (n[k] < 0) return curve_side_failure(&o->side[k]);
  }

  /* every pair of parts is a child; a part that serves a second child gets points of its own */
  int children = 0;
  for (int i = 0; i < n[0]; i++) {
    for (int j = 0; j < n[1]; j++) {
      search_node *made = &child[children++];
      *made = *node;
      curve_curve_node *payload = curve_curve_own(made);
      payload->side[0] = part[0][i];
      payload->side[1] = part[1][j];
      if ((j > 0 && !curve_side_copy(&o->side[0], &payload->side[0])) ||
          (i > 0 && !curve_side_copy(&o->side[1], &payload->side[1])))
        return curve_side_failure(&o->side[0]);
      payload->seen = o->incumbent;
    }
  }
  bound_children(o, child, part, n, o->last_normal);
  if (!vec_equal(o->last_normal, o->best.normal) && is_open(o, child, children))
    bound_children(o, child, part, n, o->best.normal);
  return children;
}

static int split(void *self, search_node *node, search_node *child) {
  curve_curve *o = self;
  const curve_curve_cuts cuts = choose_cuts(o, node);
  return curve_curve_cut(o, node, &cuts, child);
}

static void release(void *self, const search_node *node) {
  curve_curve *o = self;
  for (int k = 0; k < 2; k++) points_pool_release(&o->pool, curve_curve_known(node)->side[k].slot);
}

/* ---- the oracle ---- */

bool curve_curve_begin(curve_curve *o, const cprox_curve *first, const cprox_curve *second, const cprox_pose *placed,
                       double offset, cprox_workspace *workspace) {
  *o = (curve_curve){.offset = offset, .workspace = workspace, .effort = {.good_enough = -INFINITY}};
  o->best_bound.upper = INFINITY;

  /* about the second curve's first point, sizes and not positions enter the rounding */
  const vec3 centre = second->points[0];
  const cprox_pose unmoved = CPROX_POSE_IDENTITY;
  const frame from_second = frame_create(placed, centre), own = frame_create(&unmoved, centre);
  curve_side_begin(&o->side[0], first, &from_second, &o->pool, SLOT_FIRST);
  curve_side_begin(&o->side[1], second, &own, &o->pool, SLOT_SECOND);
  const size_t degree = first->degree > second->degree ? first->degree : second->degree;
  return points_pool_begin(&o->pool, degree, SLOTS_RESERVED, workspace);
}

bool curve_curve_carry(curve_curve *o, const cprox_pose *placed, const cprox_body *carried, const cprox_pose *pose) {
  carried_shape joined;
  const cprox_pose turn = {.orientation = placed->orientation};
  if (!carried_shape_join(&carried_point, &turn, carried, pose, &joined)) return false;
  o->carries = true;
  o->joined = joined.shape;
  o->shift = vec_neg(joined.placed.centre);
  o->offset += joined.offset;
  return true;
}

search_node curve_curve_root(const curve_curve *o) {
  /* two balls on curves are never nearer than minus the sum of their radii: curves have no inside */
  search_node root = {.lower = o->carries || o->side[0].radius ? -INFINITY : -o->offset};
  *curve_curve_own(&root) = (curve_curve_node){.side = {o->side[0].part, o->side[1].part}};
  return root;
}

search_oracle curve_curve_oracle(curve_curve *o) {
  return (search_oracle){
      .self = o, .work = &o->distance_queries, .filter = filter, .probe = probe, .split = split, .release = release};
}
