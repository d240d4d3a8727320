/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_query/curve_distance.h"

#include <math.h>

#include "base/rounding.h"

/* The payload of a node: its interval, and the values at both ends of its hull. */
typedef struct distance_end {
  double value, error; /* value NAN: not measured yet */
} distance_end;

typedef struct curve_distance_node {
  curve_interval at;
  distance_end first, last;
} curve_distance_node;

static const curve_distance_node *known(const search_node *node) {
  _Static_assert(sizeof(curve_distance_node) <= sizeof(search_payload), "a node's payload holds it");
  return (const curve_distance_node *)node->payload.bytes;
}

static curve_distance_node *own(search_node *node) {
  return (curve_distance_node *)node->payload.bytes;
}

/* Slots of the pool that nodes never get: the loaded piece, and the hull at hand. */
enum { SLOT_ROOT, SLOT_HULL, SLOTS_RESERVED };

/* ---- measuring ---- */

/* The nearer one; from left to right, once there is contact, the earlier one. */
static bool is_better(const curve_distance *o, const search_best *bound) {
  const search_best *best = &o->best_bound;
  if (!o->left_to_right || best->upper > o->epsilon) return bound->upper < best->upper;
  return bound->upper <= o->epsilon && bound->at < best->at;
}

/* A point of the curve within `error` of the exact one, whose value is known. */
static void consider(curve_distance *o, const distance_sample *sample, double error) {
  const double d = sample->seen.value;
  const double offset = o->offset + curve_side_thickness(&o->side, sample->piece, sample->s).value;
  search_best bound = {.at = curve_side_parameter_below(&o->side, sample->piece, sample->s)};
  const double rounding = ROUND_UP * (error + sample->seen.rounding + 2.0 * ROUND_U * (fabs(d) + offset));
  bound.upper = d - offset + rounding + (sample->seen.error - sample->seen.rounding);
  bound.slack = rounding + 0.5 * o->body->field->error + 0.125 * o->epsilon;
  if (o->left_to_right && bound.upper <= 0.0 && bound.at < o->proven_bound.at) {
    o->proven = *sample;
    o->proven_bound = bound;
  }
  if (!is_better(o, &bound)) return;
  o->best = *sample;
  o->best_bound = bound;
  o->found = true;
}

/* At y about the body's centre; `other`, another value, or NULL. */
static cprox_status measure(curve_distance *o, vec3 y, const distance_value *other, distance_sample *sample) {
  const cprox_status usable = curve_side_status(&o->side);
  if (usable < 0) return usable;
  o->distance_queries++;
  sample->y = y;
  return distance_field_measure(o->body->field, vec_add(y, o->body->centre), other, o->workspace, &sample->seen);
}

/* ---- the hull of an interval ---- */

typedef struct interval_hull {
  curve_hull of;
  const double *x, *y, *z;
  bool is_piece;
} interval_hull;

static vec3 hull_point(const interval_hull *hull, size_t i) {
  return vec(hull->x[i], hull->y[i], hull->z[i]);
}

static interval_hull hull_of(const curve_distance *o, const curve_interval *at) {
  double *x = points_pool_at(&o->pool, SLOT_HULL), *y = x + o->side.curve->degree + 1,
         *z = y + o->side.curve->degree + 1;
  interval_hull hull = {.x = x, .y = y, .z = z, .is_piece = curve_side_is_piece(&o->side, at)};
  hull.of = curve_side_hull(&o->side, at, vec(0, 0, 0), x, y, z);
  return hull;
}

/* No point of the hull is farther than this from the segment between its ends. */
static double deviation_of(const interval_hull *hull) {
  const vec3 a = hull_point(hull, 0), ab = vec_sub(hull_point(hull, hull->of.n - 1), a);
  const double length2 = vec_norm2(ab);
  double most2 = 0.0;
  for (size_t i = 1; i + 1 < hull->of.n; i++) {
    const vec3 ap = vec_sub(hull_point(hull, i), a);
    const double s = length2 > 0.0 ? lesser(greater(vec_dot(ap, ab) / length2, 0.0), 1.0) : 0.0;
    most2 = greater(most2, vec_norm2(vec_axpy(ap, -s, ab)));
  }
  return sqrt(most2) + hull->of.radius;
}

/* One end of the hull. Those of a piece are points of the curve. */
static cprox_status measure_end(curve_distance *o, const search_node *node, const interval_hull *hull, bool last,
                                const distance_value *other, distance_end *end, distance_sample *sample) {
  const curve_interval *at = &known(node)->at;
  const vec3 y = hull_point(hull, last ? hull->of.n - 1 : 0);
  if (isnan(end->value)) {
    const cprox_status status = measure(o, y, other, sample);
    if (status != CPROX_OK) return status;
    *end = (distance_end){.value = sample->seen.value, .error = sample->seen.error};
    if (!hull->is_piece) return CPROX_OK;
    sample->piece = curve_side_piece(&o->side, at), sample->s = last ? at->b : at->a;
    consider(o, sample, hull->of.error);
    return CPROX_OK;
  }
  sample->y = y;
  sample->seen = (distance_value){.at = vec_add(y, o->body->centre), .value = end->value, .error = end->error};
  return CPROX_OK;
}

/* The bound of the segment between both ends, less how far the curve leaves it. */
static cprox_status bound(curve_distance *o, search_node *node, const interval_hull *hull) {
  curve_distance_node *payload = own(node);
  distance_sample first, last;
  cprox_status status = measure_end(o, node, hull, false, NULL, &payload->first, &first);
  if (status == CPROX_OK) status = measure_end(o, node, hull, true, &first.seen, &payload->last, &last);
  if (status != CPROX_OK) return status;
  const double least = distance_field_over_segment(o->body->field, &first.seen, &last.seen);
  const double away = deviation_of(hull), sizes = vec_norm(first.y) + vec_norm(last.y) + o->body->shape.scale;
  const double rounding =
      ROUND_UP * (hull->of.error + 16.0 * ROUND_U * (sizes + vec_norm(o->body->centre) + away + least + o->offset));
  double thin, thick;
  curve_side_radius_range(&o->side, &payload->at, &thin, &thick);
  node->lower = greater(least - away - (o->offset + thick) - rounding, node->lower);
  node->slack = rounding + 0.5 * o->body->field->error + 0.125 * o->epsilon;
  return CPROX_OK;
}

/* ---- the oracle ---- */

static double filter(void *self, search_node *node, double goal) {
  (void)self, (void)goal;
  return node->lower;
}

static cprox_status probe(void *self, search_node *node, search_best *best) {
  curve_distance *o = self;
  curve_interval *at = &own(node)->at;
  const bool is_piece = curve_side_is_piece(&o->side, at);
  if (is_piece && !curve_side_materialise(&o->side, at)) return curve_side_failure(&o->side);
  const interval_hull hull = hull_of(o, at);
  cprox_status status = bound(o, node, &hull);
  if (status != CPROX_OK) return status;
  if (!is_piece) { /* the ends of a range's chord are no points of the curve: one where it falls in two is */
    distance_sample sample;
    double error;
    const vec3 y = curve_side_junction(&o->side, at, &sample.piece, &sample.s, &error);
    status = measure(o, y, NULL, &sample);
    if (status != CPROX_OK) return status;
    consider(o, &sample, error);
  }
  *best = o->best_bound;
  return CPROX_OK;
}

/* Values that are off say no more of a shorter interval. */
static bool is_short(const curve_distance *o, const curve_interval *at) {
  const interval_hull hull = hull_of(o, at);
  const vec3 chord = vec_sub(hull_point(&hull, hull.of.n - 1), hull_point(&hull, 0));
  double thin, thick;
  curve_side_radius_range(&o->side, at, &thin, &thick);
  return vec_norm(chord) + deviation_of(&hull) + (thick - thin) <=
         greater(0.25 * o->body->field->error, 0.125 * o->epsilon);
}

static int split(void *self, search_node *node, search_node *child) {
  curve_distance *o = self;
  curve_interval *at = &own(node)->at, half[2];
  const bool is_piece = curve_side_is_piece(&o->side, at);
  if (is_piece) {
    const double middle = 0.5 * (at->a + at->b);
    if (!(at->a < middle && middle < at->b) || is_short(o, at)) return 0;
    if (!curve_side_cut_piece(&o->side, at, middle, 0.5, half)) return curve_side_failure(&o->side);
  } else {
    curve_side_cut_range(at, half);
  }
  int children = 0;
  for (int k = 0; k < 2; k++) {
    if (!is_piece && curve_side_is_empty(&o->side, &half[k])) continue;
    search_node *one = &child[children++];
    curve_distance_node *payload = own(one);
    *one = *node;
    one->start = curve_side_start(&o->side, &half[k]);
    payload->at = half[k];
    if (!is_piece || k == 1) payload->first.value = NAN;
    if (!is_piece || k == 0) payload->last.value = NAN;
  }
  return children;
}

static void release(void *self, const search_node *node) {
  curve_distance *o = self;
  points_pool_release(&o->pool, known(node)->at.slot);
}

/* ---- beginning ---- */

bool curve_distance_begin(curve_distance *o, const cprox_curve *curve, const cprox_body *body, frame placed,
                          double offset, double epsilon, cprox_workspace *workspace) {
  *o = (curve_distance){.body = body, .offset = offset, .epsilon = epsilon, .workspace = workspace};
  o->best_bound = o->proven_bound = (search_best){.upper = INFINITY, .at = INFINITY};
  curve_side_begin(&o->side, curve, &placed, &o->pool, SLOT_ROOT);
  return points_pool_begin(&o->pool, curve->degree, SLOTS_RESERVED, workspace);
}

void curve_distance_begin_contact(curve_distance *o) {
  o->left_to_right = true;
}

search_node curve_distance_root(const curve_distance *o) {
  search_node root = {.lower = -INFINITY};
  curve_distance_node *payload = own(&root);
  payload->at = o->side.part;
  payload->first.value = payload->last.value = NAN;
  root.start = curve_side_start(&o->side, &payload->at);
  return root;
}

search_oracle curve_distance_oracle(curve_distance *o) {
  return (search_oracle){
      .self = o, .work = &o->distance_queries, .filter = filter, .probe = probe, .split = split, .release = release};
}
