/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_query/curve_bvh.h"

#include "base/rounding.h"
#include "bvh/winding.h"
#include "curve_query/crossing.h"

/* Slots of the pool that nodes never get. */
enum { SLOT_ROOT, SLOTS_RESERVED };

enum { MOST_STEPS = 10, MOST_ELEMENTS = 8, LEAST_SEEDS = 5, MOST_SEEDS = 65, PIECES_A_SEED = 8 };

/* Boxes whose diagonal is longer than these fractions of the segment, squared, are opened at once: verdicts are settled
 * by coarse ones more often. */
static const double WIDE_DISTANCE2 = 0.5, WIDE_VERDICT2 = 2.0;

/* An entry of a list: lanes of a node or a pack. */
typedef struct tree_entry {
  uint32_t at, lanes;
} tree_entry;

static bool is_piece(const curve_tree *o, const search_node *node) {
  return curve_side_is_piece(&o->side, &curve_tree_known(node)->at);
}

/* ---- measuring ---- */

static double measure_slack(const curve_tree *o, double error, double distance, vec3 y) {
  const double sizes = vec_norm(y) + o->tree->scale + o->offset + distance;
  return ROUND_UP * (error + TREE_ROUND * ROUND_U * sizes);
}

search_best curve_tree_measure(curve_tree *o, tree_place place, size_t piece, double s, vec3 y, double error,
                               tree_sample *sample) {
  o->distance_queries++;
  *sample = (tree_sample){.place = place, .y = y, .piece = piece, .s = s};
  tree_element_near(o->tree, place, y, &sample->near);
  const double radius = curve_side_thickness(&o->side, piece, s).value;
  const double slack = measure_slack(o, error + ROUND_U * radius, sample->near.distance, y);
  return (search_best){.upper = sample->near.distance - (o->offset + radius) + slack, .slack = slack};
}

static bool adopt_better(curve_tree *o, const tree_sample *sample, const search_best *bound) {
  if (!(bound->upper < o->best_bound.upper)) return false;
  o->best = *sample;
  o->best_bound = *bound;
  o->found = true;
  return true;
}

/* ---- better points ---- */

/* One step of Newton's method on the distance, less a radius that changes, to the feature that is nearest at a sample.
 */
static double newton_step(const tree_sample *sample, curve_thickness radius, vec3 d1, vec3 d2) {
  const tree_near *near = &sample->near;
  const double along = vec_dot(near->normal, d1), slope = along - radius.slope;
  double across2 = vec_norm2(d1) - along * along;
  for (int k = 0; k < near->tangents; k++) {
    const double beside = vec_dot(near->e[k], d1);
    across2 -= beside * beside;
  }
  const double bend = vec_dot(near->normal, d2) - radius.bend;
  /* a face has no bend of its own; there the height itself is aimed at where it falls to 0 */
  const double curvature = bend + (near->tangents < 2 ? fmax(across2, 0.0) / near->distance : 0.0);
  const double to_zero = slope != 0.0 ? -(near->distance - radius.value) / slope : 0.0;
  if (!(curvature > 0.0)) return to_zero;
  const double to_least = -slope / curvature;
  return fabs(to_zero) < fabs(to_least) ? to_zero : to_least;
}

/* Newton's method along the loaded piece from the best point, with its element held fixed. */
static void refine_on_element(curve_tree *o) {
  const size_t degree = o->side.curve->degree;
  const double *x = points_pool_at(&o->pool, SLOT_ROOT), *y = x + degree + 1, *z = y + degree + 1;
  const double error = curve_side_point_error(&o->side), *binomial = curve_binomial(o->side.curve);
  tree_sample sample = o->best;
  vec3 at, d1, d2;
  curve_bezier_evaluate(x, y, z, 1, degree, binomial, sample.s, &at, &d1, &d2);
  for (int i = 0; i < MOST_STEPS && sample.near.distance > 0.0; i++) {
    const curve_thickness radius = curve_side_thickness(&o->side, sample.piece, sample.s);
    const double next = fmin(fmax(sample.s + newton_step(&sample, radius, d1, d2), o->side.part.a), o->side.part.b);
    if (!(fabs(next - sample.s) > 1e-16)) return;
    curve_bezier_evaluate(x, y, z, 1, degree, binomial, next, &at, &d1, &d2);
    const search_best bound = curve_tree_measure(o, sample.place, sample.piece, next, at, error, &sample);
    if (!adopt_better(o, &sample, &bound) && i > 1) return;
  }
}

/* On fine meshes the best point of one element lies over the next one: whose turn it is then. */
static void refine_witness(curve_tree *o) {
  if (o->side.curve->arcs) return;
  const double error = curve_side_point_error(&o->side);
  for (int i = 0; i < MOST_ELEMENTS; i++) {
    refine_on_element(o);
    const tree_sample *best = &o->best;
    const tree_hit hit = tree_nearest(o->tree, best->y, best->near.distance);
    if (!hit.found || (hit.at.pack == best->place.pack && hit.at.lane == best->place.lane)) return;
    tree_sample sample;
    const search_best bound = curve_tree_measure(o, hit.at, best->piece, best->s, best->y, error, &sample);
    if (!adopt_better(o, &sample, &bound)) return;
  }
}

/* ---- proof of contact ---- */

/* Through the triangle of a sample, which moves to where that is, or to where the curve meets its plane. */
static bool goes_through_triangle(curve_tree *o, tree_sample *sample, crossing_place *place) {
  vec3 v[3];
  double x[8], y[8], z[8], scale = 0.0;
  tree_corners(o->tree, sample->place, v);
  for (int i = 0; i < 8; i++) {
    const vec3 corner = v[i < 3 ? i : 2];
    x[i] = corner.x, y[i] = corner.y, z[i] = corner.z;
    scale = fmax(scale, vec_norm(corner));
  }
  const convex triangle = {
      .ops = &convex_polytope, .scale = ROUND_UP * scale, .n = 3, .padded = 8, .x = x, .y = y, .z = z};
  flat_shape flat;
  flat_describe(&triangle, &flat);
  const crossing of = {&o->side, &triangle, &flat};
  *place = (crossing_place){.piece = sample->piece, .s = sample->s};
  const bool proven = crossing_prove(&of, place);
  sample->piece = place->piece, sample->s = place->s;
  if (!proven) return false;
  sample->y = sample->near.point = place->meeting;
  sample->near.distance = 0.0;
  return true;
}

/* Through the triangle of a sample, or through the one that is nearest where the curve meets the plane of that. */
static bool goes_through(curve_tree *o, tree_sample *sample, crossing_place *place) {
  enum { MOST_TRIANGLES = 4 };
  const tree_sample before = *sample;
  for (int i = 0; i < MOST_TRIANGLES; i++) {
    curve_side_load(&o->side, sample->piece);
    if (goes_through_triangle(o, sample, place)) return true;
    curve_side_load(&o->side, sample->piece);
    const tree_hit hit = tree_nearest(o->tree, curve_side_point(&o->side, sample->s), INFINITY);
    if (!hit.found || (hit.at.pack == sample->place.pack && hit.at.lane == sample->place.lane)) break;
    sample->place = hit.at;
  }
  *sample = before;
  return false;
}

bool curve_tree_holds(const curve_tree *o, vec3 y) {
  return o->body->winding && winding_is_inside(o->body->winding, o->tree, y);
}

/* Inside of the solid, and farther from its surface than rounding. */
static bool is_inside(const curve_tree *o, vec3 y, double error) {
  if (!curve_tree_holds(o, y)) return false;
  const tree_hit hit = tree_nearest(o->tree, y, INFINITY);
  return hit.lower > measure_slack(o, error, hit.upper, y);
}

bool curve_tree_meets(curve_tree *o, tree_sample *sample, size_t *until_piece, double *until) {
  if (o->tree->kind != TREE_TRIANGLES || o->side.curve->arcs) return false;
  curve_side_load(&o->side, sample->piece);
  crossing_place place;
  if (goes_through(o, sample, &place)) {
    *until_piece = place.until_piece, *until = place.until;
    return true;
  }
  if (!o->body->winding) return false;

  /* a little farther along, or a little before, it is inside */
  enum { MOST_WIDTHS = 12 };
  curve_side_load(&o->side, sample->piece);
  const double error = curve_side_point_error(&o->side);
  double step = 1e-12;
  for (int i = 0; i < MOST_WIDTHS && step < 0.1; i++, step *= 10.0) {
    for (int k = 0; k < 2; k++) {
      const double s = k == 0 ? fmax(sample->s - step, o->side.part.a) : fmin(sample->s + step, o->side.part.b);
      const vec3 y = curve_side_point(&o->side, s);
      if (!is_inside(o, y, error)) continue;
      curve_tree_measure(o, sample->place, sample->piece, s, y, error, sample);
      sample->inside = true;
      *until_piece = sample->piece, *until = s;
      return true;
    }
  }
  return false;
}

/* The curve is elsewhere at the end of the piece before, by more than rounding: splines alone jump. */
static bool jumps_into(const cprox_curve *curve, size_t piece) {
  const vec3 *start = curve_piece(curve, piece);
  const double sizes = vec_norm(start[0]) + vec_norm(start[-1]);
  const double same = 64.0 * ROUND_U * sizes + curve->error[piece - 1] + curve->error[piece];
  return vec_norm(vec_sub(start[0], start[-1])) > same;
}

/* Is the point at s of a piece inside? The sample is filled then. */
static bool starts_inside(curve_tree *o, size_t piece, double s, tree_sample *sample) {
  curve_side_load(&o->side, piece);
  const vec3 y = curve_side_point(&o->side, s);
  if (!vec_finite(y) || !is_inside(o, y, curve_side_point_error(&o->side))) return false;
  *sample = (tree_sample){.y = y, .piece = piece, .s = s, .inside = true, .near = {.point = y}};
  return true;
}

bool curve_tree_begins_inside(curve_tree *o, tree_sample *sample) {
  if (!o->body->winding) return false;
  const curve_interval *part = &o->side.part;
  if (curve_side_is_piece(&o->side, part)) return starts_inside(o, curve_side_piece(&o->side, part), part->a, sample);
  if (starts_inside(o, 0, 0.0, sample)) return true;
  const cprox_curve *curve = o->side.curve;
  for (size_t i = 1; i < curve->n_pieces && !curve->arcs; i++)
    if (jumps_into(curve, i) && starts_inside(o, i, 0.0, sample)) return true;
  return false;
}

/* Nothing to subtract, and nearer than asked: only a proof of contact is better. */
static void prove_contact(curve_tree *o) {
  if (o->asked.limit != 0.0 || !(o->best_bound.upper > 0.0)) return;
  tree_sample sample = o->best;
  size_t until_piece;
  double until;
  if (!curve_tree_meets(o, &sample, &until_piece, &until)) return;
  const search_best met = {.upper = 0.0, .slack = o->best_bound.slack};
  adopt_better(o, &sample, &met);
}

/* ---- seeds ---- */

static void seed_at(curve_tree *o, size_t piece, double s) {
  curve_side_load(&o->side, piece);
  const vec3 y = curve_side_point(&o->side, s);
  const double error = curve_side_point_error(&o->side);
  if (!vec_finite(y)) return;
  const double radius = curve_side_thickness(&o->side, piece, s).value;
  const double bound = fmin(o->best_bound.upper, o->asked.cutoff) + (o->offset + radius);
  const tree_hit hit = tree_nearest(o->tree, y, bound);
  o->distance_queries++;
  if (!hit.found) return;
  tree_sample sample;
  const search_best at = curve_tree_measure(o, hit.at, piece, s, y, error, &sample);
  adopt_better(o, &sample, &at);
}

void curve_tree_measure_at(curve_tree *o, double t) {
  const double *breaks = o->side.curve->breaks;
  size_t piece = 0;
  while (piece + 1 < o->side.curve->n_pieces && breaks[piece + 1] <= t) piece++;
  seed_at(o, piece, fmin(fmax((t - breaks[piece]) / (breaks[piece + 1] - breaks[piece]), 0.0), 1.0));
}

/* Distances begin with a few points along the curve, verdicts with its ends. */
static void seed(curve_tree *o) {
  tree_sample sample;
  if (curve_tree_begins_inside(o, &sample)) {
    adopt_better(o, &sample, &(search_best){.upper = -o->offset, .slack = 0.0});
    return;
  }
  const curve_interval *part = &o->side.part;
  const bool piece = curve_side_is_piece(&o->side, part), verdict = o->asked.limit >= 0.0;
  const size_t first = piece ? curve_side_piece(&o->side, part) : 0, pieces = piece ? 1 : o->side.curve->n_pieces;
  const size_t wanted = verdict ? 2 : LEAST_SEEDS + pieces / PIECES_A_SEED;
  const size_t seeds = wanted < MOST_SEEDS ? wanted : MOST_SEEDS;
  for (size_t i = 0; i < seeds && !(o->best_bound.upper <= o->effort.good_enough); i++) {
    const double at = part->a + (part->b - part->a) * (double)i / (double)(seeds - 1) * (double)pieces;
    const size_t k = (size_t)fmin(at, (double)(pieces - 1));
    seed_at(o, first + k, fmin(at - (double)k, part->b));
  }
  if (!o->found || verdict) return;
  curve_side_load(&o->side, o->best.piece);
  refine_witness(o);
}

/* ---- lists ---- */

static tree_entry *list_reserve(const curve_tree *o, size_t n) {
  return workspace_reserve(o->workspace, WORKSPACE_LISTS, n * sizeof(tree_entry));
}

void curve_tree_segment(const curve_tree *o, const search_node *node, vec3 x, tree_segment *segment, double *slack) {
  const curve_interval *at = &curve_tree_known(node)->at;
  segment->x = x;
  const curve_hull hull = curve_side_hull(&o->side, at, x, segment->p[0], segment->p[1], segment->p[2]);
  double thinnest;
  curve_side_radius_range(&o->side, at, &thinnest, &segment->thickest);
  segment->thick = o->side.radius && at->slot >= 0 ? curve_side_radii(&o->side, at) : NULL;
  segment->n = hull.n;
  segment->radius = hull.radius;
  if (!segment->thick) segment->radius += segment->thickest, segment->thickest = 0.0;
  segment->known = o->found && vec_norm2(o->best.near.normal) > 0.5;
  segment->normal = o->best.near.normal;
  double reach2 = 0.0, along = INFINITY;
  const vec3 n = segment->normal;
  for (size_t k = 0; k < hull.n; k++) {
    const vec3 p = vec(segment->p[0][k], segment->p[1][k], segment->p[2][k]);
    const double square = vec_norm2(p), g = vec_dot(n, p) - (segment->thick ? segment->thick[k] : 0.0);
    reach2 = square > reach2 ? square : reach2;
    along = g < along ? g : along;
  }
  segment->along = along - segment->radius;
  const double sizes = vec_norm(x) + o->tree->scale + sqrt(reach2) + segment->radius + segment->thickest + o->offset;
  *slack = ROUND_UP * (hull.error + TREE_ROUND * ROUND_U * sizes);
}

/* How wide the segment is, squared. */
static double width2_of(const tree_segment *segment) {
  double sum = 0.0;
  for (int k = 0; k < 3; k++) {
    double low = segment->p[k][0], high = low;
    for (size_t i = 1; i < segment->n; i++) {
      low = fmin(low, segment->p[k][i]);
      high = fmax(high, segment->p[k][i]);
    }
    const double extent = high - low + 2.0 * segment->radius;
    sum += extent * extent;
  }
  return sum;
}

/* How much of the segment a lane leaves free, by the line through its first bound. */
static double free_share(const tree_lanes *lanes, uint32_t l, double offset, double slack) {
  const double above = lanes->first[l] - offset - 4.0 * slack;
  if (!(above > 0.0)) return 0.0;
  return lanes->slope[l] < 0.0 ? above / -lanes->slope[l] : INFINITY;
}

/* Boxes that are wide against the segment say little. Small ones serve as well as what is in them, but for the
 * distances that only elements attain: a box of one point would stay closed for ever. */
static bool is_worth_opening(const tree_node *node, const tree_lanes *lanes, uint32_t l, double wide2, double best2) {
  if (lanes->width2[l] > wide2) return true;
  const bool last = (node->child[l] & TREE_LEAF) != 0 || 64.0 * lanes->width2[l] < wide2;
  return last && lanes->distance2[l] < best2;
}

cprox_status curve_tree_filter(curve_tree *o, search_node *node, tree_segment *segment, double slack,
                               tree_place *nearest, double *least2, double *share) {
  curve_tree_node *payload = curve_tree_own(node);
  tree_entry open[TREE_LANES * TREE_DEEPEST];
  size_t count = 0, end = payload->list_end;
  const double taken = o->offset + slack,
               wide2 = (o->asked.limit >= 0.0 ? WIDE_VERDICT2 : WIDE_DISTANCE2) * width2_of(segment),
               goal = search_pruning_bound(&o->asked, o->best_bound.upper);
  const double best = fmax(o->best_bound.upper + o->offset + segment->thickest, 0.0),
               best2 = best < 1e150 ? best * best : INFINITY;
  double kept = INFINITY, rest = payload->rest;
  *least2 = INFINITY;
  /* so much farther that what is left of it, less what was taken, is still above the goal */
  segment->beyond = goal + taken + 4.0 * ROUND_U * (fabs(goal) + taken);
  tree_entry *list = list_reserve(o, end);
  for (size_t i = payload->list; count > 0 || i < payload->list_end;) {
    const tree_entry entry = count > 0 ? open[--count] : list[i++];
    const bool leaf = (entry.at & TREE_LEAF) != 0;
    tree_lanes lanes;
    tree_measure(o->tree, entry.at, entry.lanes, segment, &lanes);

    /* drop what cannot matter, look into what is wide, keep the rest */
    uint32_t kept_lanes = 0;
    const double dropped = lanes.rest - taken;
    rest = dropped < rest ? dropped : rest;
    for (uint32_t left = lanes.live; left; left &= left - 1) {
      const uint32_t l = (uint32_t)__builtin_ctz(left);
      const double bound = lanes.bound[l] - taken;
      if (leaf && lanes.distance2[l] < *least2) {
        *least2 = lanes.distance2[l];
        *nearest = (tree_place){entry.at & ~TREE_LEAF, l};
      }
      if (!leaf && is_worth_opening(&o->tree->nodes[entry.at], &lanes, l, wide2, best2)) {
        const uint32_t child = o->tree->nodes[entry.at].child[l];
        open[count++] = (tree_entry){child, child & TREE_LEAF ? TREE_ALL_LANES : o->tree->nodes[child].lanes};
      } else {
        kept = bound < kept ? bound : kept;
        kept_lanes |= 1u << l;
        if (share) *share = fmin(*share, free_share(&lanes, l, o->offset, slack));
      }
    }
    if (!kept_lanes) continue;
    list = list_reserve(o, end + 1);
    if (!list || end >= UINT32_MAX)
      return workspace_fail(o->workspace, CPROX_MEMORY, "no memory for a list of elements");
    list[end++] = (tree_entry){entry.at, kept_lanes};
  }
  payload->list = payload->list_end;
  payload->list_end = (uint32_t)end;
  payload->rest = rest;
  node->slack = slack;
  node->lower = fmax(node->lower, fmin(kept, rest));
  return CPROX_OK;
}

/* ---- the contract ---- */

static double filter(void *self, search_node *node, double goal) {
  (void)self, (void)goal; /* a list is gone through once, in the probe */
  return node->lower;
}

static cprox_status probe(void *self, search_node *node, search_best *best) {
  curve_tree *o = self;
  curve_interval *at = &curve_tree_own(node)->at;
  o->nodes++;
  if (!o->seeded) {
    o->seeded = true;
    seed(o);
    if (curve_side_status(&o->side) < 0) return curve_side_status(&o->side);
    *best = o->best_bound;
    if (o->best_bound.upper <= o->effort.good_enough) return CPROX_OK;
  }

  /* from the middle */
  const bool piece = is_piece(o, node);
  const double s = 0.5 * (at->a + at->b);
  vec3 x;
  if (piece) {
    if (!curve_side_materialise(&o->side, at)) return curve_side_failure(&o->side);
    x = curve_side_point(&o->side, s);
    if (curve_side_status(&o->side) < 0) return curve_side_status(&o->side);
  } else {
    const curve_capsule capsule = curve_capsule_at(o->side.curve, at->part);
    double unused = 0.0;
    x = frame_to_local(&o->side.frame, vec_lerp(capsule.a, capsule.b, 0.5), &unused);
  }
  tree_segment segment;
  segment.stepping = false;
  double slack, least2;
  tree_place nearest = {0, 0};
  curve_tree_segment(o, node, x, &segment, &slack);
  const cprox_status status = curve_tree_filter(o, node, &segment, slack, &nearest, &least2, NULL);
  if (status < 0) return status;

  /* the distance in the middle */
  const size_t on = piece ? curve_side_piece(&o->side, at) : 0;
  if (piece && sqrt(least2) - o->offset - curve_side_thickness(&o->side, on, s).value < o->best_bound.upper) {
    tree_sample sample;
    const search_best bound = curve_tree_measure(o, nearest, on, s, x, curve_side_point_error(&o->side), &sample);
    if (adopt_better(o, &sample, &bound) && bound.upper > o->effort.good_enough && o->nodes > o->effort.newton_after)
      refine_witness(o);
    if (o->best_bound.upper <= o->asked.epsilon) prove_contact(o);
  }
  *best = o->best_bound;
  return CPROX_OK;
}

/* Of a node: a cut nearer to one of its ends leaves a child that is so many times shorter, and settles nothing. */
#define WELL_INSIDE 1e-9

/* Where the best point cuts the node's own parameter, or a half where it does not lie well inside. */
static double cut_of(const curve_tree *o, const search_node *node) {
  const curve_interval *at = &curve_tree_known(node)->at;
  if (!o->found || curve_side_piece(&o->side, at) != o->best.piece) return 0.5;
  const double s = (o->best.s - at->a) / (at->b - at->a);
  return s > WELL_INSIDE && s < 1.0 - WELL_INSIDE ? s : 0.5;
}

static int split(void *self, search_node *node, search_node *child) {
  curve_tree_node *payload = curve_tree_own(node);
  curve_tree *o = self;
  curve_interval *at = &payload->at, half[2];
  if (payload->list == payload->list_end) return 0;
  if (!is_piece(o, node)) {
    curve_side_cut_range(at, half);
  } else {
    const double s = cut_of(o, node), cut = s == 0.5 ? 0.5 * (at->a + at->b) : o->best.s;
    if (!(at->a < cut && cut < at->b)) return 0;
    if (!curve_side_cut_piece(&o->side, at, cut, s, half)) return curve_side_failure(&o->side);
  }
  /* the half that is nearer to the best point comes last: the engine takes the last of equals first */
  const double t = o->found ? curve_side_parameter(&o->side, o->best.piece, o->best.s) : -INFINITY;
  const double middle = curve_side_is_empty(&o->side, &half[1]) ? INFINITY : curve_side_start(&o->side, &half[1]);
  const int first = t < middle ? 1 : 0;
  int children = 0;
  for (int k = 0; k < 2; k++) {
    const curve_interval *part = &half[k == 0 ? first : 1 - first];
    if (curve_side_is_empty(&o->side, part)) continue;
    child[children] = *node;
    curve_tree_own(&child[children++])->at = *part;
  }
  return children;
}

static void release(void *self, const search_node *node) {
  curve_tree *o = self;
  points_pool_release(&o->pool, curve_tree_known(node)->at.slot);
}

/* ---- the oracle ---- */

bool curve_tree_begin(curve_tree *o, const cprox_curve *curve, const cprox_body *body, frame placed, double offset,
                      cprox_workspace *workspace) {
  *o = (curve_tree){.body = body,
                    .tree = body->tree,
                    .offset = offset + body->shape.margin,
                    .asked = {.limit = -1.0, .cutoff = INFINITY},
                    .effort = {.good_enough = -INFINITY},
                    .workspace = workspace};
  o->best_bound.upper = INFINITY;
  curve_side_begin(&o->side, curve, &placed, &o->pool, SLOT_ROOT);
  return points_pool_begin(&o->pool, curve->degree, SLOTS_RESERVED, workspace);
}

bool curve_tree_root(curve_tree *o, search_node *root) {
  tree_entry *list = list_reserve(o, 1);
  if (!list) return false;
  list[0] = (tree_entry){0, o->tree->nodes[0].lanes};
  *root = (search_node){.lower = -INFINITY};
  *curve_tree_own(root) = (curve_tree_node){.at = o->side.part, .list_end = 1, .rest = INFINITY};
  return true;
}

search_oracle curve_tree_oracle(curve_tree *o) {
  return (search_oracle){
      .self = o, .work = &o->distance_queries, .filter = filter, .probe = probe, .split = split, .release = release};
}
