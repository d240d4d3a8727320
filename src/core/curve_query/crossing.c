/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_query/crossing.h"

#include "base/rounding.h"
#include "curve/control.h"

/* Intervals round the place that are tried, in pieces: from about as short as double allows, each 8 times the one
 * before. */
static const double FIRST_STEP = 1e-14;
enum { STEPS = 15 };

/* Some of a piece. */
typedef struct segment {
  size_t piece;
  double from, to;
} segment;

/* What is proven of a segment: its place is covered by the body, and at which heights over the plane it begins and
 * ends, each but for the room. */
typedef struct passage {
  double first, last, room;
} passage;

/* The control points of [from, to] of a piece; returns how far they are off. */
static double cut_out(const crossing *o, const segment *of, double rest[CONTROL_MOST]) {
  const size_t degree = o->side->curve->degree;
  curve_side_load(o->side, of->piece);
  double left[CONTROL_MOST];
  const double *whole = points_pool_at(o->side->pool, o->side->root_slot);
  for (size_t i = 0; i < control_size(degree); i++) rest[i] = whole[i];
  double error = o->side->root_error + control_split(left, rest, degree, of->to, o->side->root_magnitude);
  for (size_t i = 0; i < control_size(degree); i++) rest[i] = left[i];
  error += control_split(left, rest, degree, of->from / of->to, o->side->root_magnitude);
  return error; /* from/to is rounded: what stands in `rest` is [from (1 + u), to] */
}

/* The segment seen from the plane: false where it may leave what the body covers. */
static bool passes_over(const crossing *o, const segment *of, flat_region *region, passage *seen) {
  const flat_shape *flat = o->flat;
  const size_t n = o->side->curve->degree + 1;
  double points[CONTROL_MOST];
  const double error = cut_out(o, of, points), size = o->side->root_magnitude + o->shape->scale;
  seen->room = ROUND_UP * (4.0 * error + 64.0 * ROUND_U * size + o->shape->slack);

  /* their places along e and f, and their heights, take the room of x, y and z */
  double *x = points, *y = x + n, *z = y + n;
  for (size_t i = 0; i < n; i++) {
    const vec3 p = vec_sub(vec(x[i], y[i], z[i]), flat->origin);
    x[i] = vec_dot(flat->e, p), y[i] = vec_dot(flat->f, p), z[i] = vec_dot(flat->normal, p);
  }
  seen->first = z[0], seen->last = z[n - 1];
  return flat_region_covers(o->shape, flat, region, x, y, n, seen->room);
}

/* [at - step, at + step] of a piece, into the piece before or behind it where that is longer: one segment, or two. */
static int intervals_about(const crossing *o, size_t piece, double at, double step, segment part[2]) {
  const bool whole = !curve_side_is_piece(o->side, &o->side->part);
  const double a = whole ? 0.0 : o->side->part.a, b = whole ? 1.0 : o->side->part.b;
  part[0] = (segment){piece, greater(at - step, a), lesser(at + step, b)};
  if (whole && at - step < 0.0 && piece > 0) {
    part[1] = part[0];
    part[0] = (segment){piece - 1, 1.0 - step, 1.0};
    return 2;
  }
  if (whole && at + step > 1.0 && piece + 1 < o->side->curve->n_pieces) {
    part[1] = (segment){piece + 1, 0.0, step};
    return 2;
  }
  return 1;
}

static double height_of(const crossing *o, vec3 x) {
  return vec_dot(o->flat->normal, vec_sub(x, o->flat->origin));
}

/* Where the loaded piece meets the plane, from s on, by Newton's method. */
static double meet_plane(const crossing *o, double s) {
  enum { MOST_STEPS = 16 };
  const size_t degree = o->side->curve->degree;
  const double *points = points_pool_at(o->side->pool, o->side->root_slot);
  for (int i = 0; i < MOST_STEPS; i++) {
    vec3 at, velocity;
    curve_bezier_evaluate(points, points + degree + 1, points + 2 * (degree + 1), 1, degree,
                          curve_binomial(o->side->curve), s, &at, &velocity, NULL);
    const double height = height_of(o, at);
    const double speed = vec_dot(o->flat->normal, velocity);
    const double next = lesser(greater(s - height / speed, 0.0), 1.0);
    if (!(fabs(next - s) > ROUND_U)) return isfinite(next) ? next : s;
    s = next;
  }
  return s;
}

/* The ends on the two sides of the plane, farther from it than all corners of the region; and all between is over the
 * body. */
static bool passes_through(const crossing *o, const segment part[2], int n, flat_region *region) {
  double first = 0.0, last = 0.0, room = 0.0;
  for (int i = 0; i < n; i++) {
    passage seen;
    if (!(part[i].from < part[i].to) || !passes_over(o, &part[i], region, &seen)) return false;
    if (i == 0) first = seen.first;
    last = seen.last;
    room = greater(room, seen.room);
  }
  room += region->thickness;
  return (first > room && last < -room) || (first < -room && last > room);
}

/* Where in the segments the curve changes sides, by bisection. */
static void find_meeting(const crossing *o, const segment part[2], int n, crossing_place *place) {
  enum { BISECTIONS = 60 };
  curve_side_load(o->side, part[0].piece);
  const bool below = height_of(o, curve_side_point(o->side, part[0].from)) < 0.0;
  segment in = part[0];
  if (n == 2 && (height_of(o, curve_side_point(o->side, in.to)) < 0.0) == below) {
    in = part[1];
    curve_side_load(o->side, in.piece);
  }
  for (int i = 0; i < BISECTIONS; i++) {
    const double middle = 0.5 * (in.from + in.to);
    *((height_of(o, curve_side_point(o->side, middle)) < 0.0) == below ? &in.from : &in.to) = middle;
  }
  place->piece = in.piece, place->s = in.to;
  place->meeting = curve_side_point(o->side, in.to);
}

/* At a place in the plane of a piece: from the shortest segment on that has its ends on both sides. */
static bool proves_at(const crossing *o, double at, flat_region *region, crossing_place *place) {
  for (int i = 0; i < STEPS; i++) {
    const double step = ldexp(FIRST_STEP, 3 * i);
    segment part[2];
    const int n = intervals_about(o, place->piece, at, step, part);
    if (!passes_through(o, part, n, region)) continue;
    find_meeting(o, part, n, place);
    place->until_piece = part[n - 1].piece, place->until = part[n - 1].to;
    return true;
  }
  return false;
}

bool crossing_prove(const crossing *o, crossing_place *place) {
  if (o->side->curve->arcs || o->flat->dimension != 2) return false;
  flat_region region;
  flat_region_begin(o->shape, o->flat, &region);

  /* Newton's method may run past the place: it begins again a little to either side */
  static const double APART[] = {0.0, -1e-3, 1e-3, -1e-2, 1e-2, -1e-1, 1e-1};
  double tried = -1.0;
  const double start = place->s;
  for (size_t i = 0; i < sizeof APART / sizeof *APART; i++) {
    const double from = start + APART[i];
    if (from < 0.0 || from > 1.0) continue;
    curve_side_load(o->side, place->piece);
    const double at = meet_plane(o, from);
    if (at != tried && proves_at(o, at, &region, place)) return true;
    if (i == 0) place->s = at;
    tried = at;
  }
  return false;
}

bool crossing_prove_convex(curve_convex *o, curve_sample *sample, crossing_place *place) {
  if (!curve_convex_is_flat(o)) return false;
  const crossing of = {&o->side, o->shape, &o->flat};
  *place = (crossing_place){.piece = sample->piece, .s = sample->s};
  if (!crossing_prove(&of, place)) return false;
  sample->piece = place->piece, sample->s = place->s;
  sample->y = sample->near.point = place->meeting;
  sample->near.distance = 0.0;
  sample->near.parts_known = false; /* they are those of where the search was */
  return true;
}
