/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve/curve_side.h"

#include <string.h>

#include "base/round_down.h"
#include "base/rounding.h"
#include "curve/control.h"
#include "curve/pack.h"
#include "curve/rectifiable.h"

/* ---- memory ---- */

/* A slot holds the control points of a piece, or two end points and a hull. */
enum { ARC_HULL = 6, ARC_SIZE = 8 };

bool points_pool_begin(points_pool *pool, size_t degree, size_t reserved, cprox_workspace *workspace) {
  const size_t size = control_size(degree);
  *pool = (points_pool){.workspace = workspace, .stride = size > ARC_SIZE ? size : ARC_SIZE, .slots = reserved};
  /* and for the first interval and its half, which most searches need */
  pool->points = workspace_reserve(workspace, WORKSPACE_POINTS, (reserved + 2) * pool->stride * sizeof(double));
  return pool->points;
}

double *points_pool_at(const points_pool *pool, size_t slot) {
  return pool->points + slot * pool->stride;
}

static int32_t points_pool_take(points_pool *pool) {
  if (pool->free_slots > 0) {
    const int32_t *free_slots = workspace_reserve(pool->workspace, WORKSPACE_FREE_SLOTS, 0);
    return free_slots[--pool->free_slots];
  }
  const size_t bytes = (pool->slots + 1) * pool->stride * sizeof(double);
  double *points = pool->slots < INT32_MAX ? workspace_reserve(pool->workspace, WORKSPACE_POINTS, bytes) : NULL;
  if (!points) return -1;
  pool->points = points;
  /* room for every slot in the free list, so that giving one back cannot fail */
  if (!workspace_reserve(pool->workspace, WORKSPACE_FREE_SLOTS, (pool->slots + 1) * sizeof(int32_t))) return -1;
  return (int32_t)pool->slots++;
}

void points_pool_release(points_pool *pool, int32_t slot) {
  if (slot < 0) return;
  int32_t *free_slots = workspace_reserve(pool->workspace, WORKSPACE_FREE_SLOTS, 0);
  free_slots[pool->free_slots++] = slot;
}

cprox_status curve_side_failure(const curve_side *side) {
  if (side->pool->failure < 0) return side->pool->failure;
  return workspace_fail(side->pool->workspace, CPROX_MEMORY, "no memory for another parameter interval");
}

cprox_status curve_side_status(const curve_side *side) {
  return side->pool->failure;
}

/* ---- pieces ---- */

/* The rounding of local = R^T (world - position) - centre, by the local size m: |world - position| <= m + |centre|
 * loses u of itself in the difference and 26u in the turn, the last difference u of m. What a frame does not do costs
 * nothing. What composing its poses may have moved the frame itself comes on top. */
static void measure_frame(curve_side *side) {
  const frame *f = &side->frame;
  const double first = (vec_norm2(f->position) > 0.0 ? 1.0 : 0.0) + (f->rotated ? ROUND_ROTATION : 0.0) + f->misturned;
  const double centre = vec_norm(f->centre), second = centre > 0.0 ? 1.0 : 0.0;
  side->turned_slope = ROUND_UP * ROUND_U * (first + second);
  side->turned_offset = ROUND_UP * (ROUND_U * first * centre + f->misplaced);
}

static vec3 local_of(const frame *f, vec3 world) {
  return vec_sub(frame_turn_to_local(f, vec_sub(world, f->position)), f->centre);
}

/* How far from the frame's origin the whole curve reaches, and what range_reach() loses to rounding: 26u to turn n
 * where the frame is turned, u to subtract the position, 3u for each product of three, 2u for the sums; of sizes that
 * are at most the curve's reach and the centre's distance from the position. */
static void measure_ranges(curve_side *side) {
  const curve_capsule whole = curve_whole(side->curve), *all = &whole;
  const vec3 a = local_of(&side->frame, all->a), b = local_of(&side->frame, all->b);
  const double computed = sqrt(greater(vec_norm2(a), vec_norm2(b)));
  const double most = ROUND_UP * (computed + all->radius + side->turned_slope * computed + side->turned_offset);
  const double roundings = (side->frame.rotated ? ROUND_ROTATION : 0.0) + 9.0 + side->frame.misturned;
  side->range_magnitude = most;
  side->range_error = ROUND_UP * (ROUND_U * roundings * (most + vec_norm(side->frame.centre)) + side->frame.misplaced);
}

void curve_side_begin(curve_side *side, const cprox_curve *curve, const frame *placed, points_pool *pool,
                      size_t root_slot) {
  side->curve = curve;
  side->radius = NULL;
  side->frame = *placed;
  side->part = curve_side_whole();
  side->pool = pool;
  side->root_slot = root_slot;
  side->root_piece = SIZE_MAX;
  side->root_error = side->root_magnitude = 0.0;
  measure_frame(side);
  measure_ranges(side);
}

/* ---- a radius that changes ---- */

static double *radii_of_slot(const curve_side *side, size_t slot) {
  return points_pool_at(side->pool, slot) + control_size(side->curve->degree);
}

const double *curve_side_radii(const curve_side *side, const curve_interval *at) {
  return radii_of_slot(side, (size_t)at->slot);
}

bool curve_side_thicken(curve_side *side, const cprox_curve *radius) {
  points_pool *pool = side->pool;
  side->radius = radius;
  side->root_piece = SIZE_MAX;
  pool->stride += side->curve->degree + 1;
  pool->points = workspace_reserve(pool->workspace, WORKSPACE_POINTS, pool->slots * pool->stride * sizeof(double));
  /* of ranges: the numbers of a capsule are exact, their sum is not */
  double least, most;
  const curve_interval whole = curve_side_whole();
  curve_side_radius_range(side, &whole, &least, &most);
  const double size = fmax(fabs(least), fabs(most));
  side->range_magnitude = ROUND_UP * (side->range_magnitude + size);
  side->range_error = ROUND_UP * (side->range_error + 4.0 * ROUND_U * size);
  return pool->points;
}

curve_thickness curve_side_thickness_of(curve_side *side, size_t piece, double s) {
  curve_side_load(side, piece);
  const double *r = radii_of_slot(side, side->root_slot);
  vec3 at, d1, d2;
  curve_bezier_evaluate(r, r, r, 1, side->curve->degree, curve_binomial(side->curve), s, &at, &d1, &d2);
  return (curve_thickness){at.x, d1.x, d2.x};
}

void curve_side_radius_range(const curve_side *side, const curve_interval *at, double *least, double *most) {
  *least = *most = 0.0;
  if (!side->radius) return;
  if (at->slot >= 0) {
    const double *r = curve_side_radii(side, at);
    *least = *most = r[0];
    for (size_t i = 1; i <= side->curve->degree; i++) *least = lesser(*least, r[i]), *most = greater(*most, r[i]);
    return;
  }
  const curve_capsule capsule = curve_capsule_at(side->radius, at->part);
  *least = lesser(capsule.a.x, capsule.b.x) - capsule.radius;
  *most = greater(capsule.a.x, capsule.b.x) + capsule.radius;
}

size_t curve_side_lowest(const curve_side *side, const curve_interval *at, vec3 n) {
  const size_t degree = side->curve->degree;
  const double *x = points_pool_at(side->pool, (size_t)at->slot), *y = x + degree + 1, *z = y + degree + 1;
  if (!side->radius) return control_lowest(x, degree, n);
  const double *r = curve_side_radii(side, at);
  size_t lowest = 0;
  double least = INFINITY;
  for (size_t i = 0; i <= degree; i++) {
    const double g = vec_dot(n, vec(x[i], y[i], z[i])) - r[i];
    if (g < least) least = g, lowest = i;
  }
  return lowest;
}

/* min n·P - r over the control points: n·psi - r is the polynomial with these coefficients. */
static double least_of_thick(const curve_side *side, const curve_interval *at, vec3 n) {
  const size_t degree = side->curve->degree;
  const double *x = points_pool_at(side->pool, (size_t)at->slot), *y = x + degree + 1, *z = y + degree + 1,
               *r = curve_side_radii(side, at);
  double least = INFINITY;
  for (size_t i = 0; i <= degree; i++) least = lesser(n.x * x[i] + n.y * y[i] + n.z * z[i] - r[i], least);
  return least;
}

/* Cuts the numbers of a row at s: `right` holds them on entry, and those of [s, 1] on return. */
static void split_row(double *left, double *right, size_t degree, double s) {
  for (size_t level = 0; level <= degree; level++) {
    left[level] = right[0];
    for (size_t i = 0; i + level < degree; i++) right[i] = (1.0 - s) * right[i] + s * right[i + 1];
  }
}

/* Cuts the numbers of a slot: control points, and radii where there are. Returns the error added. */
static double split_slot(const curve_side *side, size_t left, size_t right, double s) {
  const size_t degree = side->curve->degree;
  if (side->radius) split_row(radii_of_slot(side, left), radii_of_slot(side, right), degree, s);
  return control_split(points_pool_at(side->pool, left), points_pool_at(side->pool, right), degree, s,
                       side->root_magnitude);
}

/* How many numbers of a slot are in use. */
static size_t slot_size(const curve_side *side) {
  return control_size(side->curve->degree) + (side->radius ? side->curve->degree + 1 : 0);
}

/* The loaded piece's radii; what they add to its rounding. */
static void load_radii(curve_side *side, size_t piece) {
  const vec3 *from = curve_piece(side->radius, piece);
  double *r = radii_of_slot(side, side->root_slot), most = 0.0;
  for (size_t i = 0; i <= side->curve->degree; i++) r[i] = from[i].x, most = greater(fabs(r[i]), most);
  side->root_magnitude += most;
  side->root_error += side->radius->error[piece];
}

curve_interval curve_side_whole(void) {
  return (curve_interval){.a = 0.0, .b = 1.0, .part = 1, .slot = -1};
}

curve_interval curve_side_section(const cprox_curve *curve, size_t piece, double a, double b) {
  return (curve_interval){.a = a, .b = b, .part = (uint32_t)(curve->n_leaves + piece), .slot = -1};
}

bool curve_side_is_piece(const curve_side *side, const curve_interval *at) {
  return at->part >= side->curve->n_leaves;
}

size_t curve_side_piece(const curve_side *side, const curve_interval *at) {
  return at->part - side->curve->n_leaves;
}

bool curve_side_is_empty(const curve_side *side, const curve_interval *at) {
  return curve_is_empty_at(side->curve, at->part);
}

double curve_side_parameter(const curve_side *side, size_t piece, double s) {
  const double t0 = side->curve->breaks[piece], t1 = side->curve->breaks[piece + 1];
  return s == 1.0 ? t1 : t0 + s * (t1 - t0);
}

double curve_side_parameter_below(const curve_side *side, size_t piece, double s) {
  return round_down_between(side->curve->breaks[piece], side->curve->breaks[piece + 1], s);
}

double curve_side_start(const curve_side *side, const curve_interval *at) {
  if (curve_side_is_piece(side, at)) return curve_side_parameter_below(side, curve_side_piece(side, at), at->a);
  size_t leaf = at->part;
  while (leaf < side->curve->n_leaves) leaf *= 2;
  return side->curve->breaks[leaf - side->curve->n_leaves];
}

vec3 curve_side_chord_from_origin(const curve_side *side, const curve_interval *range) {
  const curve_capsule capsule = curve_capsule_at(side->curve, range->part);
  const vec3 a = local_of(&side->frame, capsule.a), along = vec_sub(local_of(&side->frame, capsule.b), a);
  const double length2 = vec_norm2(along), s = -vec_dot(a, along);
  return vec_axpy(a, s > 0.0 && length2 > 0.0 ? lesser(s / length2, 1.0) : 0.0, along);
}

/* How many levels at a time a range falls: three, which is a pack, but so that the last step is no small one. */
static int child_levels(const cprox_curve *c, size_t node) {
  const int left = curve_levels_below(c, node);
  return left == 4 ? 2 : left < 3 ? left : 3;
}

/* From the frame's origin. */
static void distances_of_pack(const curve_side *side, const curve_pack *pack, double distance[CURVE_PACK],
                              double s[CURVE_PACK]) {
  curve_pack_distance(pack, side->frame.position, frame_turn_to_world(&side->frame, side->frame.centre), distance, s);
}

/* The first of the nodes that a node falls into, and how many of them have pieces. */
static size_t first_child(const cprox_curve *c, size_t node, size_t *n) {
  const int levels = child_levels(c, node);
  const size_t first = node << levels;
  *n = 1;
  while (*n < (size_t)1 << levels && !curve_is_empty_at(c, first + *n)) ++*n;
  return first;
}

size_t curve_side_nearest_piece(const curve_side *side, const curve_interval *range, double *s) {
  const cprox_curve *c = side->curve;
  size_t node = range->part;
  while (node < c->n_leaves) {
    double distance[CURVE_PACK], along[CURVE_PACK];
    curve_pack pack;
    size_t n, nearest = 0;
    node = first_child(c, node, &n);
    curve_pack_fill(c, node, n, &pack);
    distances_of_pack(side, &pack, distance, along);
    for (size_t k = 1; k < n; k++) nearest = distance[k] < distance[nearest] ? k : nearest;
    node += nearest;
    *s = along[nearest];
  }
  return node - c->n_leaves;
}

void curve_side_load(curve_side *side, size_t piece) {
  if (side->root_piece == piece) return;
  const size_t degree = side->curve->degree;
  const vec3 *world = curve_piece(side->curve, piece);
  double *x = points_pool_at(side->pool, side->root_slot), *y = x + degree + 1, *z = y + degree + 1;
  for (size_t i = 0; i <= degree; i++) {
    const vec3 p = local_of(&side->frame, world[i]);
    x[i] = p.x, y[i] = p.y, z[i] = p.z;
  }
  side->root_piece = piece;
  side->root_magnitude = control_magnitude(x, degree);
  const double turned = side->turned_slope * side->root_magnitude + side->turned_offset;
  side->root_error = (side->curve->arcs ? side->curve->arcs->error : side->curve->error[piece]) + turned;
  if (side->radius) load_radii(side, piece);
}

/* ---- intervals of curves that are known by their arc length ---- */

/* Whether all went well; else the error is kept, with its message. */
static bool went_well(const curve_side *side, cprox_status status) {
  if (status < 0) side->pool->failure = status;
  return status >= 0;
}

/* The curve's parameter, never beyond its piece. */
static double arc_parameter(const curve_side *side, size_t piece, double s) {
  return fmin(curve_side_parameter(side, piece, s), side->curve->breaks[piece + 1]);
}

/* The point at s of a piece, in the side's frame; *error becomes at least how far it may be from the exact one. */
static bool arc_point(const curve_side *side, size_t piece, double s, vec3 *point, double *error) {
  vec3 world;
  const double t = arc_parameter(side, piece, s);
  if (!went_well(side, rectifiable_point(side->curve, t, side->pool->workspace, &world))) return false;
  double turned = 0.0;
  *point = frame_to_local(&side->frame, world, &turned);
  *error = fmax(*error, ROUND_UP * (side->curve->arcs->error + turned));
  return true;
}

/* Fills the slot of an interval with its ends and their hull. */
static bool arc_fill(const curve_side *side, curve_interval *at, vec3 a, vec3 b, double error) {
  const size_t piece = curve_side_piece(side, at);
  const double ta = arc_parameter(side, piece, at->a), tb = arc_parameter(side, piece, at->b);
  rectifiable_hull hull;
  if (!went_well(side, rectifiable_hull_of(side->curve, ta, tb, a, b, error, side->pool->workspace, &hull)))
    return false;
  const double numbers[ARC_SIZE] = {a.x, b.x, a.y, b.y, a.z, b.z, hull.axis, hull.radius};
  memcpy(points_pool_at(side->pool, (size_t)at->slot), numbers, sizeof numbers);
  at->error = error;
  return true;
}

static void arc_ends(const curve_side *side, const curve_interval *at, vec3 *a, vec3 *b) {
  const double *p = points_pool_at(side->pool, (size_t)at->slot);
  *a = vec(p[0], p[2], p[4]);
  *b = vec(p[1], p[3], p[5]);
}

static rectifiable_hull arc_hull(const curve_side *side, const curve_interval *at) {
  const double *p = points_pool_at(side->pool, (size_t)at->slot);
  return (rectifiable_hull){.axis = p[ARC_HULL], .radius = p[ARC_HULL + 1]};
}

/* An interval of its own. Where it is asked to end within a piece its ends are rounded, by 4u of the parameters in all:
 * what lies between is within its length of an end. */
static bool arc_materialise(const curve_side *side, curve_interval *at) {
  const size_t piece = curve_side_piece(side, at);
  vec3 a, b;
  double error = 0.0, beyond = 0.0;
  if (!arc_point(side, piece, at->a, &a, &error) || !arc_point(side, piece, at->b, &b, &error)) return false;
  const double least = side->curve->breaks[piece], most = side->curve->breaks[piece + 1];
  const double step = 4.0 * ROUND_U * fmax(fabs(least), fabs(most));
  for (int k = 0; k < 2; k++) {
    const double s = k == 0 ? at->a : at->b, t = arc_parameter(side, piece, s);
    const double from = k == 0 ? fmax(t - step, least) : t, to = k == 0 ? t : fmin(t + step, most);
    double length;
    if (!(from < to)) continue;
    if (!went_well(side, rectifiable_length(side->curve, from, to, side->pool->workspace, &length))) return false;
    beyond = fmax(beyond, length);
  }
  if (!arc_fill(side, at, a, b, error)) return false;
  at->error += beyond;
  return true;
}

bool curve_side_cut_arcs(const curve_side *side, const curve_interval *piece, const double *cut, int n,
                         curve_interval *part) {
  vec3 from, to, last;
  double error = piece->error;
  arc_ends(side, piece, &from, &last);
  for (int i = 0; i <= n; i++, from = to) {
    part[i] = *piece;
    if (i > 0) part[i].a = cut[i - 1];
    to = last;
    if (i < n) {
      part[i].b = cut[i];
      part[i].slot = points_pool_take(side->pool);
      if (part[i].slot < 0) return false;
      if (!arc_point(side, curve_side_piece(side, piece), cut[i], &to, &error)) return false;
    }
    if (!arc_fill(side, &part[i], from, to, error)) return false;
  }
  return true;
}

/* ---- intervals of pieces ---- */

/* Cuts the points of a whole piece down to those of [a, b]. False where memory is out. */
static bool cut_to_section(curve_side *side, curve_interval *at) {
  const int32_t rest = points_pool_take(side->pool);
  if (rest < 0) return false;
  const size_t degree = side->curve->degree, own = (size_t)at->slot, other = (size_t)rest;
  if (at->b < 1.0) {
    at->error += split_slot(side, other, own, at->b);
    memcpy(points_pool_at(side->pool, own), points_pool_at(side->pool, other), slot_size(side) * sizeof(double));
  }
  if (at->a > 0.0) at->error += split_slot(side, other, own, at->a / at->b);
  /* a, b and a/b are rounded, by 4 u in all: along a curve with |psi'| <= 2 degree max|P| */
  at->error += ROUND_UP * 8.0 * (double)degree * ROUND_U * side->root_magnitude;
  points_pool_release(side->pool, rest);
  return true;
}

bool curve_side_materialise(curve_side *side, curve_interval *at) {
  curve_side_load(side, curve_side_piece(side, at));
  if (at->slot >= 0) return true;
  at->slot = points_pool_take(side->pool);
  if (at->slot < 0) return false;
  if (side->curve->arcs) return arc_materialise(side, at);
  const size_t bytes = slot_size(side) * sizeof(double);
  memcpy(points_pool_at(side->pool, (size_t)at->slot), points_pool_at(side->pool, side->root_slot), bytes);
  at->error = side->root_error;
  return (at->a == 0.0 && at->b == 1.0) || cut_to_section(side, at);
}

bool curve_side_copy(const curve_side *side, curve_interval *at) {
  if (at->slot < 0) return true;
  const int32_t slot = points_pool_take(side->pool);
  if (slot < 0) return false;
  const size_t bytes = side->pool->stride * sizeof(double);
  memcpy(points_pool_at(side->pool, (size_t)slot), points_pool_at(side->pool, (size_t)at->slot), bytes);
  at->slot = slot;
  return true;
}

/* ---- bounds ---- */

/* What an ellipsoid reaches: rectifiable.h says within what. */
static curve_reach arc_reach(const curve_side *side, const curve_interval *at, vec3 n) {
  const rectifiable_hull hull = arc_hull(side, at);
  vec3 a, b;
  arc_ends(side, at, &a, &b);
  return (curve_reach){.least = rectifiable_reach(&hull, a, b, n),
                       .error = at->error,
                       .magnitude = fmax(vec_norm(a), vec_norm(b)) + hull.axis};
}

/* The pieces lie in a capsule round the chord from the first to the last point. The normal is turned, not the points.
 */
static curve_reach range_reach(const curve_side *side, const curve_interval *at, vec3 n) {
  const curve_capsule capsule = curve_capsule_at(side->curve, at->part);
  const vec3 turned = frame_turn_to_world(&side->frame, n);
  const double a = vec_dot(turned, vec_sub(capsule.a, side->frame.position));
  const double b = vec_dot(turned, vec_sub(capsule.b, side->frame.position));
  double thin, thick;
  curve_side_radius_range(side, at, &thin, &thick);
  return (curve_reach){.least = lesser(a, b) - capsule.radius - vec_dot(n, side->frame.centre) - thick,
                       .error = side->range_error,
                       .magnitude = side->range_magnitude};
}

size_t curve_side_children(const curve_side *side, const curve_interval *range, curve_interval part[CURVE_PACK],
                           curve_pack *pack) {
  size_t n;
  const size_t first = first_child(side->curve, range->part, &n);
  curve_pack_fill(side->curve, first, n, pack);
  for (size_t k = 0; k < n; k++) {
    part[k] = *range;
    part[k].part = (uint32_t)(first + k);
    double thin, thick;
    if (!side->radius) continue;
    curve_side_radius_range(side, &part[k], &thin, &thick);
    pack->radius[k] += thick;
  }
  return n;
}

curve_reach curve_side_children_reach(const curve_side *side, const curve_pack *pack, vec3 n,
                                      double least[CURVE_PACK]) {
  curve_pack_reach(pack, frame_turn_to_world(&side->frame, n), side->frame.position, least);
  const double centre = vec_dot(n, side->frame.centre);
  for (size_t k = 0; k < CURVE_PACK; k++) least[k] -= centre;
  return (curve_reach){.least = -INFINITY, .error = side->range_error, .magnitude = side->range_magnitude};
}

double curve_side_distance_from(const curve_side *side, const curve_interval *at, vec3 centre, const vec3 *axis) {
  const double *points = points_pool_at(side->pool, (size_t)at->slot);
  const double distance = control_distance_from(points, side->curve->degree, curve_binomial(side->curve), centre, axis);
  double thin, thick;
  if (side->radius) {
    curve_side_radius_range(side, at, &thin, &thick);
    return distance - thick;
  }
  /* an ellipsoid lies in the capsule round its chord */
  return side->curve->arcs ? fmax(distance - ROUND_UP * arc_hull(side, at).radius, 0.0) : distance;
}

curve_reach curve_side_reach(const curve_side *side, const curve_interval *at, vec3 n) {
  if (at->slot >= 0 && side->curve->arcs) return arc_reach(side, at, n);
  if (at->slot < 0) return range_reach(side, at, n);
  const double *points = points_pool_at(side->pool, (size_t)at->slot);
  return (curve_reach){
      .least = side->radius ? least_of_thick(side, at, n) : control_least(points, side->curve->degree, n),
      .error = at->error,
      .magnitude = side->root_magnitude};
}

curve_reach curve_side_children_distance(const curve_side *side, const curve_pack *pack, double least[CURVE_PACK]) {
  double distance[CURVE_PACK], unused[CURVE_PACK];
  distances_of_pack(side, pack, distance, unused);
  for (size_t k = 0; k < CURVE_PACK; k++) least[k] = distance[k] - pack->radius[k];
  return (curve_reach){
      .least = -INFINITY, .error = side->range_error + CURVE_LEAST, .magnitude = side->range_magnitude};
}

curve_hull curve_side_hull(const curve_side *side, const curve_interval *at, vec3 from, double *x, double *y,
                           double *z) {
  const size_t degree = side->curve->degree;
  if (at->slot >= 0) {
    const double *points = points_pool_at(side->pool, (size_t)at->slot);
    for (size_t i = 0; i <= degree; i++) {
      x[i] = points[i] - from.x;
      y[i] = points[degree + 1 + i] - from.y;
      z[i] = points[2 * (degree + 1) + i] - from.z;
    }
    const double radius = side->curve->arcs ? ROUND_UP * arc_hull(side, at).radius : 0.0;
    return (curve_hull){.n = degree + 1, .radius = radius, .error = at->error};
  }
  const curve_capsule capsule = curve_capsule_at(side->curve, at->part);
  double turned = 0.0;
  const vec3 a = vec_sub(frame_to_local(&side->frame, capsule.a, &turned), from),
             b = vec_sub(frame_to_local(&side->frame, capsule.b, &turned), from);
  x[0] = a.x, y[0] = a.y, z[0] = a.z;
  x[1] = b.x, y[1] = b.y, z[1] = b.z;
  return (curve_hull){.n = 2, .radius = capsule.radius, .error = turned};
}

/* ---- points ---- */

vec3 curve_side_end(const curve_side *side, const curve_interval *at, bool last) {
  const size_t degree = side->curve->degree, i = last ? degree : 0;
  const double *x = points_pool_at(side->pool, (size_t)at->slot), *y = x + degree + 1, *z = y + degree + 1;
  return vec(x[i], y[i], z[i]);
}

vec3 curve_side_point(const curve_side *side, double s) {
  if (side->curve->arcs) {
    vec3 at;
    double error = 0.0;
    return arc_point(side, side->root_piece, s, &at, &error) ? at : vec(NAN, NAN, NAN);
  }
  const size_t degree = side->curve->degree;
  const double *x = points_pool_at(side->pool, side->root_slot), *y = x + degree + 1, *z = y + degree + 1;
  vec3 point;
  curve_bezier_evaluate(x, y, z, 1, degree, curve_binomial(side->curve), s, &point, NULL, NULL);
  return point;
}

double curve_side_point_error(const curve_side *side) {
  if (side->curve->arcs) {
    /* every point of a piece is as near to its ends as the piece is long */
    const double reach =
        side->root_magnitude + vec_norm(side->frame.centre) + 2.0 * side->curve->error[side->root_piece];
    return ROUND_UP * (side->curve->arcs->error + (ROUND_ROTATION + side->frame.misturned + 4.0) * ROUND_U * reach +
                       side->frame.misplaced);
  }
  const double n = (double)side->curve->degree;
  const double steps = n < 2.0 ? 3.0 : 3.0 * n + 3.0; /* counted at curve_bezier_evaluate() */
  return ROUND_UP * (side->root_error + steps * ROUND_U * 1.7320508075688774 * side->root_magnitude);
}

vec3 curve_side_junction(curve_side *side, const curve_interval *range, size_t *piece, double *s, double *error) {
  /* the right child's leftmost leaf; past the last piece, the end of the curve */
  size_t leaf = 2 * (size_t)range->part + 1;
  while (leaf < side->curve->n_leaves) leaf *= 2;
  *piece = leaf - side->curve->n_leaves;
  *s = 0.0;
  if (*piece >= side->curve->n_pieces) {
    *piece = side->curve->n_pieces - 1;
    *s = 1.0;
  }
  curve_side_load(side, *piece);
  *error = side->root_error;
  const size_t degree = side->curve->degree, at = *s == 0.0 ? 0 : degree;
  const double *x = points_pool_at(side->pool, side->root_slot), *y = x + degree + 1, *z = y + degree + 1;
  return vec(x[at], y[at], z[at]);
}

/* ---- cuts ---- */

void curve_side_cut_range(const curve_interval *range, curve_interval half[2]) {
  for (uint32_t k = 0; k < 2; k++) {
    half[k] = *range;
    half[k].part = 2 * range->part + k;
  }
}

bool curve_side_cut_piece(curve_side *side, curve_interval *piece, double cut, double s, curve_interval half[2]) {
  if (side->curve->arcs) return curve_side_cut_arcs(side, piece, &cut, 1, half);
  const int32_t left = points_pool_take(side->pool);
  if (left < 0) return false;
  const double added = split_slot(side, (size_t)left, (size_t)piece->slot, s);
  half[0] = half[1] = *piece;
  half[0].slot = left;
  half[0].b = half[1].a = cut;
  half[0].error = half[1].error = piece->error + added;
  return true;
}
