/* SPDX-License-Identifier: BSD-3-Clause */
#include "query/curve_convex.h"

#include <string.h>

#include "base/rounding.h"
#include "curve/control.h"
#include "query/polish.h"

/* ---- memory ----------------------------------------------------------------------------------------------------------- */

/* Slot 0 is the root of the piece last asked for, slot 1 scratch; nodes get the others. */
enum { SLOT_ROOT, SLOT_SCRATCH, SLOT_NODES };

static double *slot_points(const curve_convex *o, size_t slot) {
  double *points = workspace_reserve(o->workspace, WORKSPACE_POINTS, 0);
  return points + slot * control_size(o->curve->degree);
}

static int32_t slot_take(curve_convex *o) {
  if (o->free_slots > 0) {
    const int32_t *free_slots = workspace_reserve(o->workspace, WORKSPACE_FREE_SLOTS, 0);
    return free_slots[--o->free_slots];
  }
  const size_t bytes = (o->slots + 1) * control_size(o->curve->degree) * sizeof(double);
  if (o->slots >= INT32_MAX || !workspace_reserve(o->workspace, WORKSPACE_POINTS, bytes)) return -1;
  /* room for every slot in the free list, so that giving one back cannot fail */
  if (!workspace_reserve(o->workspace, WORKSPACE_FREE_SLOTS, (o->slots + 1) * sizeof(int32_t))) return -1;
  return (int32_t)o->slots++;
}

static void slot_give(curve_convex *o, int32_t slot) {
  if (slot < SLOT_NODES) return;
  int32_t *free_slots = workspace_reserve(o->workspace, WORKSPACE_FREE_SLOTS, 0);
  free_slots[o->free_slots++] = slot;
}

/* ---- pieces ----------------------------------------------------------------------------------------------------------- */

static bool is_piece(const curve_convex *o, const search_node *node) {
  return node->part >= o->curve->n_leaves;
}

static size_t piece_of(const curve_convex *o, const search_node *node) {
  return node->part - o->curve->n_leaves;
}

/* Brings the control points of a piece into the body's frame, in slot 0. */
static void load_root(curve_convex *o, size_t piece) {
  if (o->root_piece == piece) return;
  const size_t degree = o->curve->degree;
  const vec3 *world = curve_piece(o->curve, piece);
  double *x = slot_points(o, SLOT_ROOT), *y = x + degree + 1, *z = y + degree + 1;
  double turned = 0.0;
  bool planar = o->frame.about_z;
  for (size_t i = 0; i <= degree; i++) {
    const vec3 p = frame_to_local(&o->frame, world[i], &turned);
    x[i] = p.x, y[i] = p.y, z[i] = p.z;
    planar = planar && p.z == 0.0;
  }
  o->root_piece = piece;
  o->root_planar = planar && o->shape->ops->kind == CPROX_POLYGON;
  o->root_error = o->curve->error[piece] + turned;
  o->root_magnitude = control_magnitude(x, degree);
}

/* ---- bounds ----------------------------------------------------------------------------------------------------------- */

/* What rounding can take from n·P - h(n): dot products, the support value, |n| not quite 1, the subtractions. */
static double bound_slack(const curve_convex *o, double error, double magnitude, double bound) {
  const convex *shape = o->shape;
  const double sizes = magnitude + shape->scale + shape->margin + o->offset + fabs(bound);
  return ROUND_UP * (error + ROUND_SUPPORT * ROUND_U * sizes + shape->slack);
}

/* Weak duality: along any unit n the body reaches no farther than h(n), so min n·P - h(n) is a lower bound. */
static void bound_by_normal(const curve_convex *o, search_node *node, const curve_sight *sight) {
  if (!isfinite(sight->support)) return;
  double least, slack;
  if (node->slot >= 0) {
    least = control_least(slot_points(o, (size_t)node->slot), o->curve->degree, sight->normal) - sight->support;
    slack = bound_slack(o, node->error, o->root_magnitude, least);
  } else {
    /* pieces first … last lie in a capsule round the chord from the first to the last point */
    const curve_capsule *capsule = &o->curve->capsules[node->part];
    double turned = 0.0;
    const vec3 a = frame_to_local(&o->frame, capsule->a, &turned), b = frame_to_local(&o->frame, capsule->b, &turned);
    const double magnitude = fmax(vec_norm(a), vec_norm(b)) + capsule->radius;
    least = fmin(vec_dot(sight->normal, a), vec_dot(sight->normal, b)) - capsule->radius - sight->support;
    slack = bound_slack(o, turned, magnitude, least);
  }
  node->lower = fmax(node->lower, least - slack);
  node->slack = slack;
}

/* The ball or cylinder that touches the body at the best sight; found when it is first wanted. */
static bool know_cover(curve_convex *o) {
  if (!o->cover_known) {
    const convex_ops *ops = o->shape->ops;
    o->cover_usable = ops->cover && ops->cover(o->shape, &o->best.near, &o->cover);
    o->cover_known = true;
  }
  return o->cover_usable;
}

/* A point or a ball is its own cover, from wherever it is seen. */
static bool cover_is_the_body(const curve_convex *o) {
  return !o->cover.cylinder && o->cover.radius == o->shape->margin;
}

/* Where the curve bends round a vertex or an edge, a plane is too weak; the distance from the cover's centre is not. */
static void bound_by_cover(curve_convex *o, search_node *node) {
  const double *points = slot_points(o, (size_t)node->slot);
  const double from_centre =
      control_distance_from(points, o->curve->degree, o->cover.centre, o->cover.cylinder ? &o->cover.axis : NULL,
                            slot_points(o, SLOT_SCRATCH));
  const double bound = from_centre - o->cover.radius - o->offset;
  const double slack = ROUND_UP * (node->error + 4.0 * ROUND_U * (from_centre + o->cover.radius + o->offset));
  node->lower = fmax(node->lower, bound - slack);
}

/* Nodes touch at their ends, so the best point may belong to two of them. */
static bool holds_best(const curve_convex *o, const search_node *node) {
  return piece_of(o, node) == o->best.piece && node->a <= o->best.s && o->best.s <= node->b;
}

/* Where the best point cuts the node's own parameter, or -1 where it does not lie well inside. */
static double best_inside(const curve_convex *o, const search_node *node) {
  if (o->incumbent == 0 || !holds_best(o, node)) return -1.0;
  const double s = (o->best.s - node->a) / (node->b - node->a);
  return s > 1e-12 && s < 1.0 - 1e-12 ? s : -1.0;
}

static double filter(void *self, search_node *node, double goal) {
  curve_convex *o = self;
  if (o->incumbent == 0) return node->lower;
  if (node->slot >= 0) load_root(o, piece_of(o, node));
  if (node->seen != o->incumbent) {
    bound_by_normal(o, node, &o->best);
    node->seen = o->incumbent;
  }
  if (node->slot >= 0 && node->lower < goal && node->seen_ball != o->incumbent && know_cover(o) &&
      (cover_is_the_body(o) || holds_best(o, node))) {
    bound_by_cover(o, node);
    node->seen_ball = o->incumbent;
  }
  return node->lower;
}

/* ---- probes ----------------------------------------------------------------------------------------------------------- */

cprox_status curve_convex_measure(curve_convex *o, size_t piece, double s, vec3 y, double error, curve_sight *sight,
                                  search_best *bound) {
  o->probes++;
  sight->piece = piece, sight->s = s, sight->y = y;
  if (o->root_planar)
    convex_polygon_nearest_in_plane(o->shape, y, &sight->near);
  else
    o->shape->ops->nearest(o->shape, y, &o->hint, &sight->near);
  const double d = sight->near.distance;
  if (isnan(d))
    return workspace_fail(o->workspace, CPROX_INVALID, "the support callback did not return a point of its body");

  /* the surface point is attained, so the distance to it is an upper bound but for rounding */
  const double sizes = vec_norm(y) + o->shape->scale + o->shape->margin;
  bound->slack = ROUND_UP * (error + o->shape->ops->near_rounding * ROUND_U * sizes + o->shape->slack +
                             2.0 * ROUND_U * (fabs(d) + o->offset));
  bound->upper = d - o->offset + bound->slack;

  /* any direction near the normal will do for the lower bounds, as long as its length is 1 */
  sight->normal = sight->near.normal;
  const double length2 = vec_norm2(sight->normal);
  if (fabs(length2 - 1.0) > 4.0 * ROUND_U && length2 > 0.0)
    sight->normal = vec_scale(1.0 / sqrt(length2), sight->normal);
  sight->support = length2 > 0.0 ? o->shape->ops->support(o->shape, sight->normal, &o->support_hint, NULL) +
                                       o->shape->margin + o->offset
                                 : INFINITY;
  return CPROX_OK;
}

void curve_convex_adopt(curve_convex *o, const curve_sight *sight, search_best bound) {
  o->best = *sight;
  o->best_bound = bound;
  o->incumbent++;
  o->cover_known = false;
}

/* Measures at the point where two ranges of pieces meet, which is a control point. */
static cprox_status probe_range(curve_convex *o, search_node *node) {
  size_t left = 2 * (size_t)node->part + 1; /* the right child's leftmost leaf */
  while (left < o->curve->n_leaves) left *= 2;
  size_t piece = left - o->curve->n_leaves;
  double s = 0.0;
  if (piece >= o->curve->n_pieces) piece = o->curve->n_pieces - 1, s = 1.0;
  const vec3 *points = curve_piece(o->curve, piece);
  double turned = 0.0;
  const vec3 y = frame_to_local(&o->frame, points[s == 0.0 ? 0 : o->curve->degree], &turned);
  search_best bound = {.upper = INFINITY};
  load_root(o, piece);
  const cprox_status status = curve_convex_measure(o, piece, s, y, o->curve->error[piece] + turned, &o->last, &bound);
  if (status < 0) return status;
  if (bound.upper < o->best_bound.upper) curve_convex_adopt(o, &o->last, bound);
  return CPROX_OK;
}

static cprox_status probe_piece(curve_convex *o, search_node *node) {
  const size_t degree = o->curve->degree, piece = piece_of(o, node);
  const double s = 0.5 * (node->a + node->b);
  const double *x = slot_points(o, SLOT_ROOT), *y = x + degree + 1, *z = y + degree + 1;
  vec3 point;
  curve_bezier_evaluate(x, y, z, 1, degree, o->curve->binomial, s, &point, NULL, NULL);
  search_best bound = {.upper = INFINITY};
  const cprox_status status = curve_convex_measure(o, piece, s, point, curve_convex_point_error(o), &o->last, &bound);
  if (status < 0) return status;
  if (bound.upper < o->best_bound.upper) {
    curve_convex_adopt(o, &o->last, bound);
    const bool worthwhile = bound.upper > o->good_enough && o->nodes > o->polish_after;
    if (worthwhile) return polish(o, slot_points(o, SLOT_ROOT), 0.25 * (node->b - node->a));
  }
  return CPROX_OK;
}

double curve_convex_point_error(const curve_convex *o) {
  const double n = (double)o->curve->degree;
  return ROUND_UP * (o->root_error + (3.0 * n + 8.0) * ROUND_U * 1.7320508075688774 * o->root_magnitude);
}

/* A piece whose control points are not at hand yet gets them. */
static bool materialise(curve_convex *o, search_node *node) {
  load_root(o, piece_of(o, node));
  if (node->slot >= 0) return true;
  const int32_t slot = slot_take(o);
  if (slot < 0) return false;
  memcpy(slot_points(o, (size_t)slot), slot_points(o, SLOT_ROOT), control_size(o->curve->degree) * sizeof(double));
  node->slot = slot;
  node->error = o->root_error;
  return true;
}

static cprox_status probe(void *self, search_node *node, search_best *best) {
  curve_convex *o = self;
  o->nodes++;
  const bool piece = is_piece(o, node);
  if (piece) {
    if (!materialise(o, node))
      return workspace_fail(o->workspace, CPROX_MEMORY, "no memory for another parameter interval");
    if (best_inside(o, node) >= 0.0) {
      if (node->seen != o->incumbent) bound_by_normal(o, node, &o->best);
      node->seen = o->incumbent;
      o->last = o->best;
      return CPROX_OK;
    }
  }
  const cprox_status status = piece ? probe_piece(o, node) : probe_range(o, node);
  if (status < 0) return status;
  *best = o->best_bound;

  /* the probe's own normal, and the best one if it is another */
  bound_by_normal(o, node, &o->last);
  if (node->seen != o->incumbent) bound_by_normal(o, node, &o->best);
  node->seen = o->incumbent;
  return CPROX_OK;
}

/* ---- splits ----------------------------------------------------------------------------------------------------------- */

/* Children know both normals from birth. */
static void bound_child(curve_convex *o, search_node *child) {
  bound_by_normal(o, child, &o->best);
  if (!vec_equal(o->last.normal, o->best.normal)) bound_by_normal(o, child, &o->last);
  child->seen = o->incumbent;
}

static int split_range(curve_convex *o, const search_node *node, search_node child[2]) {
  for (uint32_t k = 0; k < 2; k++) {
    child[k] = *node;
    child[k].part = 2 * node->part + k;
    if (o->curve->capsules[child[k].part].radius < 0.0)
      child[k].lower = INFINITY; /* no pieces there */
    else
      bound_child(o, &child[k]);
  }
  return 2;
}

static int split_piece(curve_convex *o, search_node *node, search_node child[2]) {
  /* the witness point, or the middle */
  const double inside = best_inside(o, node);
  const double cut = inside < 0.0 ? 0.5 * (node->a + node->b) : o->best.s;
  if (!(node->a < cut && cut < node->b)) return 0;
  const int32_t left = slot_take(o);
  if (left < 0) return workspace_fail(o->workspace, CPROX_MEMORY, "no memory for another parameter interval");

  const double added = control_split(slot_points(o, (size_t)left), slot_points(o, (size_t)node->slot), o->curve->degree,
                                     inside < 0.0 ? 0.5 : inside, o->root_magnitude);
  child[0] = child[1] = *node;
  child[0].slot = left, child[0].b = child[1].a = cut;
  for (int k = 0; k < 2; k++) {
    child[k].error += added;
    child[k].seen_ball = 0;
    bound_child(o, &child[k]);
  }
  return 2;
}

static int split(void *self, search_node *node, search_node child[2]) {
  curve_convex *o = self;
  return is_piece(o, node) ? split_piece(o, node, child) : split_range(o, node, child);
}

static void release(void *self, const search_node *node) {
  slot_give(self, node->slot);
}

/* ---- the oracle ------------------------------------------------------------------------------------------------------- */

bool curve_convex_begin(curve_convex *o, const cprox_curve *curve, const convex *shape, frame placed, double offset,
                        cprox_workspace *workspace) {
  *o = (curve_convex){.curve = curve, .shape = shape, .frame = placed, .offset = offset, .workspace = workspace};
  o->best_bound.upper = INFINITY;
  o->good_enough = -INFINITY;
  o->slots = SLOT_NODES;
  o->root_piece = SIZE_MAX;
  return workspace_reserve(workspace, WORKSPACE_POINTS, SLOT_NODES * control_size(curve->degree) * sizeof(double));
}

search_node curve_convex_root(const curve_convex *o) {
  (void)o;
  return (search_node){.lower = -INFINITY, .a = 0.0, .b = 1.0, .part = 1, .slot = -1};
}

search_oracle curve_convex_oracle(curve_convex *o) {
  return (search_oracle){.self = o, .filter = filter, .probe = probe, .split = split, .release = release};
}
