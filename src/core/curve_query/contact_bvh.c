/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_query/contact_bvh.h"

#include "base/rounding.h"

/* Above 0, and no more: what a segment that is known to be free is known to keep. */
static const double BARELY = 1e-300;

/* Pieces are cut no shorter than this to where contact is expected: where it does not come, little is lost. */
static const double SHORTEST_AIM = 1.0 / 32.0;

/* ---- measuring ---- */

/* The nearer one; once there is contact, the earlier one. */
static void consider(contact_tree *c, const tree_sample *sample, const search_best *bound) {
  curve_tree *o = &c->base;
  const search_best *best = &o->best_bound;
  if (bound->upper <= 0.0 && bound->at < c->proven_bound.at) {
    c->proven = *sample;
    c->proven_bound = *bound;
  }
  const double contact = o->asked.epsilon;
  const bool better =
      best->upper > contact ? bound->upper < best->upper : bound->upper <= contact && bound->at < best->at;
  if (!better) return;
  o->best = *sample;
  o->best_bound = *bound;
  o->found = true;
}

static tree_sample measure(contact_tree *c, tree_place place, size_t piece, double s, vec3 y, double error) {
  tree_sample sample;
  search_best bound = curve_tree_measure(&c->base, place, piece, s, y, error, &sample);
  bound.at = curve_side_parameter_below(&c->base.side, piece, s);
  consider(c, &sample, &bound);
  return sample;
}

/* Where the curve begins or jumps: inside of a solid, or somewhere from which a witness is taken. */
static void begin(contact_tree *c) {
  curve_tree *o = &c->base;
  tree_sample sample;
  const curve_interval *part = &o->side.part;
  const bool piece = curve_side_is_piece(&o->side, part);
  const size_t first = piece ? curve_side_piece(&o->side, part) : 0;
  const double s = piece ? part->a : 0.0;
  if (curve_tree_begins_inside(o, &sample)) {
    const double at = curve_side_parameter_below(&o->side, sample.piece, sample.s);
    consider(c, &sample, &(search_best){.upper = -o->offset, .at = at});
    return;
  }
  curve_side_load(&o->side, first);
  const vec3 y = curve_side_point(&o->side, s);
  if (!vec_finite(y)) return;
  const tree_hit hit = tree_nearest(o->tree, y, INFINITY);
  measure(c, hit.at, first, s, y, curve_side_point_error(&o->side));
}

/* Of a segment seen from its first point, by its own parameter. */
static vec3 first_velocity(const tree_segment *segment) {
  if (segment->n < 2) return vec(0, 0, 0);
  return vec_scale((double)(segment->n - 1), vec(segment->p[0][1], segment->p[1][1], segment->p[2][1]));
}

/* The list is gone through from the middle, and what remains from the left end, which says how far the way is free. */
static cprox_status probe_piece(contact_tree *c, search_node *node) {
  curve_tree_node *payload = curve_tree_own(node);
  curve_tree *o = &c->base;
  const curve_interval *at = &payload->at;
  tree_segment segment;
  double slack, least2;
  tree_place nearest = {0, 0};
  segment.stepping = false;
  curve_tree_segment(o, node, curve_side_point(&o->side, 0.5 * (at->a + at->b)), &segment, &slack);
  cprox_status status = curve_tree_filter(o, node, &segment, slack, &nearest, &least2, NULL);
  if (status < 0 || payload->list == payload->list_end) return status;

  const size_t stride = o->side.curve->degree + 1;
  const double *points = points_pool_at(&o->pool, (size_t)at->slot);
  const vec3 x = vec(points[0], points[stride], points[2 * stride]);
  curve_tree_segment(o, node, x, &segment, &slack);
  segment.stepping = !o->side.curve->arcs;
  double share = INFINITY;
  status = curve_tree_filter(o, node, &segment, slack, &nearest, &least2, segment.stepping ? &share : NULL);
  if (status < 0) return status;
  if (isfinite(least2)) {
    const tree_sample sample = measure(c, nearest, curve_side_piece(&o->side, at), at->a, x, at->error);
    const curve_thickness radius = curve_side_thickness(&o->side, sample.piece, sample.s);
    const double thickens = radius.slope * (at->b - at->a);
    const double speed = thickens - vec_dot(sample.near.normal, first_velocity(&segment));
    const double clearance = sample.near.distance - o->offset - radius.value;
    if (clearance > 0.0 && speed > 0.0) c->ahead = clearance / speed;
  }
  if (!segment.stepping) return CPROX_OK;
  c->share = share * (1.0 - 1e-12);
  if (c->share >= 1.0) node->lower = fmax(node->lower, BARELY);
  return CPROX_OK;
}

static cprox_status probe_range(contact_tree *c, search_node *node) {
  curve_tree *o = &c->base;
  const curve_capsule capsule = curve_capsule_at(o->side.curve, curve_tree_own(node)->at.part);
  double unused = 0.0, slack, least2;
  const vec3 x = frame_to_local(&o->side.frame, vec_lerp(capsule.a, capsule.b, 0.5), &unused);
  tree_segment segment;
  tree_place nearest;
  segment.stepping = false;
  curve_tree_segment(o, node, x, &segment, &slack);
  return curve_tree_filter(o, node, &segment, slack, &nearest, &least2, NULL);
}

static cprox_status probe(void *self, search_node *node, search_best *best) {
  curve_tree_node *payload = curve_tree_own(node);
  contact_tree *c = self;
  curve_tree *o = &c->base;
  o->nodes++;
  if (!o->seeded) begin(c);
  o->seeded = true;
  c->share = 0.0;
  c->ahead = INFINITY;
  cprox_status status;
  if (!curve_side_is_piece(&o->side, &payload->at)) {
    status = probe_range(c, node);
  } else {
    if (!curve_side_materialise(&o->side, &payload->at)) return curve_side_failure(&o->side);
    status = probe_piece(c, node);
  }
  if (status < 0) return status;
  if (curve_side_status(&o->side) < 0) return curve_side_status(&o->side);
  *best = o->best_bound;
  return CPROX_OK;
}

/* ---- cutting ---- */

static int split(void *self, search_node *node, search_node *child) {
  curve_tree_node *payload = curve_tree_own(node);
  enum { SHORTEST_STEP = 4 }; /* free segments below 1/4 are not worth a cut of their own */
  contact_tree *c = self;
  curve_tree *o = &c->base;
  curve_interval *at = &payload->at, half[2];
  const bool piece = curve_side_is_piece(&o->side, at);
  const bool stepping = piece && c->share * SHORTEST_STEP > 1.0 && c->share < 1.0;
  if (payload->list == payload->list_end) return 0;
  if (!piece) {
    curve_side_cut_range(at, half);
  } else {
    /* twice as far as contact would be at this speed: over so short a piece the next step comes close to it */
    const double s = stepping ? c->share : fmax(fmin(0.5, 2.0 * c->ahead), SHORTEST_AIM),
                 cut = at->a + s * (at->b - at->a);
    if (!(at->a < cut && cut < at->b)) return 0;
    if (!curve_side_cut_piece(&o->side, at, cut, s, half)) return curve_side_failure(&o->side);
  }
  int children = 0;
  for (int k = 0; k < 2; k++) {
    if (curve_side_is_empty(&o->side, &half[k])) continue;
    child[children] = *node;
    curve_tree_own(&child[children])->at = half[k];
    child[children].start = curve_side_start(&o->side, &half[k]);
    /* the left part is free by the lines that lie below its bounds */
    if (stepping && k == 0) child[children].lower = fmax(node->lower, BARELY);
    children++;
  }
  return children;
}

/* ---- the oracle ---- */

bool contact_tree_begin(contact_tree *c, search_node *root) {
  c->base.best_bound.at = INFINITY;
  c->proven_bound = (search_best){.upper = INFINITY, .at = INFINITY};
  c->proven_within = false;
  if (!curve_tree_root(&c->base, root)) return false;
  root->start = curve_side_start(&c->base.side, &curve_tree_own(root)->at);
  return true;
}

search_oracle contact_tree_oracle(contact_tree *c) {
  search_oracle oracle = curve_tree_oracle(&c->base); /* filter and release see the base, which is the first member */
  oracle.self = c;
  oracle.probe = probe;
  oracle.split = split;
  return oracle;
}

/* How fast the curve approaches the element of a sample, by the piece's own parameter; <= 0: it does not. */
static double approach(curve_tree *o, const tree_sample *sample) {
  curve_side_load(&o->side, sample->piece);
  const size_t degree = o->side.curve->degree;
  const double *x = points_pool_at(&o->pool, o->side.root_slot), *y = x + degree + 1, *z = y + degree + 1;
  vec3 velocity;
  curve_bezier_evaluate(x, y, z, 1, degree, curve_binomial(o->side.curve), sample->s, NULL, &velocity, NULL);
  return curve_side_thickness(&o->side, sample->piece, sample->s).slope - vec_dot(sample->near.normal, velocity);
}

void contact_tree_prove(contact_tree *c) {
  enum { MOST_STEPS = 12 };
  curve_tree *o = &c->base;
  if (!(o->best_bound.upper <= o->asked.epsilon) || c->proven_bound.at <= o->best_bound.at || o->side.curve->arcs)
    return;

  /* into the ball round the nearest element, as deep as rounding could hide it */
  const double found_at = c->proven_bound.at;
  tree_sample sample = o->best;
  search_best bound = o->best_bound;
  for (int i = 0; i < MOST_STEPS && c->proven_bound.at == found_at; i++) {
    const double speed = approach(o, &sample);
    if (!(speed > 0.0)) break;
    double next = sample.s + (bound.upper + 2.0 * bound.slack) / speed;
    size_t piece = sample.piece;
    if (next >= 1.0 && piece + 1 < o->side.curve->n_pieces) piece++, next = 0.0;
    if (piece == sample.piece && !(next > sample.s)) break;
    curve_side_load(&o->side, piece);
    next = fmin(next, 1.0);
    const vec3 y = curve_side_point(&o->side, next);
    bound = curve_tree_measure(o, sample.place, piece, next, y, curve_side_point_error(&o->side), &sample);
    bound.at = curve_side_parameter_below(&o->side, piece, next);
    consider(c, &sample, &bound);
  }
  if (c->proven_bound.at < found_at || o->offset > 0.0 || o->side.radius) return;

  /* without a radius: through the surface */
  size_t piece;
  double until;
  sample = o->best;
  if (!curve_tree_meets(o, &sample, &piece, &until)) return;
  bound = (search_best){.upper = 0.0, .at = curve_side_parameter_below(&o->side, piece, until)};
  const double before = c->proven_bound.at;
  consider(c, &sample, &bound);
  c->proven_within = c->proven_bound.at < before;
  c->proven_t = curve_side_parameter(&o->side, piece, until);
}
