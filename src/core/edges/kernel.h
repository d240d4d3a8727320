/* SPDX-License-Identifier: BSD-3-Clause */
/* The search of one edge, compiled once for each instruction set: the including page defines EDGE_TARGET, the attribute
 * of its functions, and EDGE_KERNEL, the name of its function. doc/robot-edges.md derives what is computed here. */
#include <string.h>

#include "edges/kernels.h"
#include "edges/lane.h"

/* Shorter intervals are left to the search. */
#define EDGE_SHORTEST 0x1p-20f

/* So many intervals wait at most: each batch takes eight of a depth and leaves sixteen of the next. */
enum { EDGE_STACK = 512, EDGE_MOST_BATCHES = 512 };

typedef struct lane_frame {
  lane r[9];
  lane3 o, spin, speed;
} lane_frame;

typedef struct lane_part {
  lane3 centre, speed;
} lane_part;

typedef struct lane_interval {
  float middle, half; /* seen from the middle of the edge */
} lane_interval;

/* What errors may cost a distance: anywhere in the interval, and in its middle. */
typedef struct lane_loss {
  lane most, middle;
} lane_loss;

/* An axis: it is off by `most` anywhere in the interval, by `middle` in its middle, and moves by `turn` from there. */
typedef struct lane_off {
  lane most, middle, turn;
} lane_off;

/* Eight intervals that are looked at together. */
typedef struct lane_batch {
  lane middle, half, half2; /* first: they are aligned most */
  lane_loss loss, places;   /* of the pair that is looked at, and what of that no axis is the cause of */
  const cprox_edge_checker *c;
  const edge_motion *motion;
  edge_open *open;
  edge_found *found;
  lane_frame *frames;
  lane_part *parts;
  lane_off *off;    /* how far axes are off: is_off */
  lane *apart2;     /* squares of distances of parts from obstacles, by `near` */
  lane3 *ways;      /* of balls from their frames' origins, where */
  uint32_t *placed; /* those of a part are known */
  lane_interval interval[EDGE_LANES];
  uint32_t all;   /* the lanes that are in use */
  uint32_t split; /* those that are to be halved: nothing more is asked about them */
  bool is_off;    /* that is known */
  bool related;   /* the motion's relations are known: edges that hit an obstacle do without */
  bool last;      /* nothing is halved any more: what is near is left to the search */
  bool suspects;  /* pairs that are left open are noted with how deep they are */
  bool measures;  /* the distances of what is not near are noted: */
  lane least;     /* of each lane the least, and of which pair and where it was found */
  uint32_t nearest[EDGE_LANES];
  float nearest_at[EDGE_LANES];
} lane_batch;

/* ---- kinematics ---- */

EDGE_INLINE lane lane_row(const lane *r, const float *p) {
  return r[0] * lane_all(p[0]) + r[1] * lane_all(p[1]) + r[2] * lane_all(p[2]);
}

EDGE_INLINE lane3 lane_turn(const lane_frame *f, const float *p) {
  return (lane3){lane_row(f->r, p), lane_row(f->r + 3, p), lane_row(f->r + 6, p)};
}

/* The frame's axes before its own variable turns them. */
EDGE_INLINE void lane_compose(const lane_frame *above, const edge_frame *f, lane *r) {
  for (int row = 0; row < 9; row += 3) {
    const lane *a = above->r + row;
    for (int k = 0; k < 3; k++)
      r[row + k] = f->from[0] >= 0
                       ? a[f->from[k]] * lane_all(f->sign[k])
                       : a[0] * lane_all(f->r[k]) + a[1] * lane_all(f->r[3 + k]) + a[2] * lane_all(f->r[6 + k]);
  }
}

/* Horner's scheme from the highest power of all variables down to the second, then the first one. */
EDGE_INLINE lane powers_at(const lane_batch *b, const float *more, float first) {
  lane higher = lane_all(0.0f);
  for (size_t k = b->motion->degree > 1 ? b->motion->degree - 1 : 0; k-- > 0;)
    higher = lane_all(more[k]) + b->middle * higher;
  return b->motion->degree > 1 ? lane_all(first) + b->middle * higher : lane_all(first);
}

/* Where a frame is. Its speed is left to move_frame(), and is the way from its parent's origin to its own one. */
EDGE_INLINE void place_frame(lane_batch *b, size_t i) {
  const edge_frame *f = &b->c->frames[i];
  const lane_frame *above = &b->frames[f->parent];
  lane_frame *to = &b->frames[i];
  const edge_motion *m = b->motion;
  const lane value = lane_all(m->middle[i]) + b->middle * powers_at(b, m->more + i * EDGE_POWERS, m->rate[i]);
  lane r[9];
  lane_compose(above, f, r);
  lane3 d = lane_turn(above, f->p);
  if (f->shifts) {
    d = lane3_add(d, (lane3){r[2] * value, r[5] * value, r[8] * value});
    memcpy(to->r, r, sizeof r);
  } else {
    lane s, c;
    lane_sincos(value, &s, &c);
    for (int row = 0; row < 9; row += 3) {
      to->r[row] = r[row] * c + r[row + 1] * s;
      to->r[row + 1] = r[row + 1] * c - r[row] * s;
      to->r[row + 2] = r[row + 2];
    }
  }
  to->o = lane3_add(above->o, d), to->speed = d;
}

EDGE_INLINE lane rate_of_frame(const lane_batch *b, size_t i) {
  return powers_at(b, b->motion->more_rate + i * EDGE_POWERS, b->motion->rate[i]);
}

/* How a frame that is placed moves. */
EDGE_INLINE void move_frame(lane_batch *b, size_t i) {
  const edge_frame *f = &b->c->frames[i];
  const lane_frame *above = &b->frames[f->parent];
  lane_frame *to = &b->frames[i];
  const lane rate = rate_of_frame(b, i);
  const lane3 along = {to->r[2] * rate, to->r[5] * rate, to->r[8] * rate};
  to->spin = f->shifts ? above->spin : lane3_add(above->spin, along);
  to->speed = lane3_add(above->speed, lane3_cross(above->spin, to->speed));
  if (f->shifts) to->speed = lane3_add(to->speed, along);
}

/* A point of a frame that is `way` from its origin, and its velocity. */
EDGE_INLINE lane3 place_point(const lane_frame *f, lane3 way, lane3 *speed) {
  *speed = lane3_add(f->speed, lane3_cross(f->spin, way));
  return lane3_add(f->o, way);
}

/* The ways of all balls, among them those of a part, which are found once a batch. */
EDGE_INLINE const lane3 *ways_of(lane_batch *b, size_t i) {
  const edge_part *part = &b->c->parts[i];
  for (uint32_t k = part->first; k < part->first + part->n && !b->placed[i]; k++)
    b->ways[k] = lane_turn(&b->frames[part->frame], b->c->balls[k].centre);
  b->placed[i] = 1;
  return b->ways;
}

/* The velocity of a point of a as b sees it. */
EDGE_INLINE lane3 relative_speed(const lane_frame *b, lane3 at, lane3 speed) {
  return lane3_sub(lane3_sub(speed, b->speed), lane3_cross(b->spin, lane3_sub(at, b->o)));
}

/* ---- distances ---- */

/* The square of the distance of points from what stands; 0 inside. */
EDGE_INLINE lane distance2_from(const edge_obstacle *o, lane3 at) {
  const lane zero = lane_all(0.0f), first = lane_all(o->size[0]), second = lane_all(o->size[1]);
  lane3 x = {at.x - lane_all(o->p[0]), at.y - lane_all(o->p[1]), at.z - lane_all(o->p[2])};
  if (o->shape == EDGE_BALL) {
    const lane d = lane_max(lane_sqrt(lane3_norm2(x)) - first, zero);
    return d * d;
  }
  if (o->shape == EDGE_HALFSPACE) {
    const lane along = x.x * lane_all(o->r[0]) + x.y * lane_all(o->r[3]) + x.z * lane_all(o->r[6]);
    const lane d = lane_max(along - lane_all(o->margin), zero);
    return d * d;
  }
  if (o->shape != EDGE_ALIGNED_BOX)
    x = (lane3){x.x * lane_all(o->r[0]) + x.y * lane_all(o->r[3]) + x.z * lane_all(o->r[6]),
                x.x * lane_all(o->r[1]) + x.y * lane_all(o->r[4]) + x.z * lane_all(o->r[7]),
                x.x * lane_all(o->r[2]) + x.y * lane_all(o->r[5]) + x.z * lane_all(o->r[8])};
  if (o->shape == EDGE_ALIGNED_BOX || o->shape == EDGE_BOX) {
    const lane3 out = {lane_max(lane_abs(x.x) - first, zero), lane_max(lane_abs(x.y) - second, zero),
                       lane_max(lane_abs(x.z) - lane_all(o->size[2]), zero)};
    return lane3_norm2(out);
  }
  if (o->shape == EDGE_CAPSULE) {
    x.z = x.z - lane_max(lane_min(x.z, second), -second);
    const lane d = lane_max(lane_sqrt(lane3_norm2(x)) - first, zero);
    return d * d;
  }
  const lane rho = lane_sqrt(x.x * x.x + x.y * x.y);
  if (o->shape == EDGE_CYLINDER) {
    const lane side = lane_max(rho - first, zero), end = lane_max(lane_abs(x.z) - second, zero);
    return side * side + end * end;
  }

  /* a cone: from its slant or its base, whichever is nearer; size[2] is the inverse of the slant's square */
  const lane below = x.z - second, height = second + second;
  const lane share = lane_max(lane_min((rho * first - below * height) * lane_all(o->size[2]), lane_all(1.0f)), zero);
  const lane across = rho - share * first, along = below + share * height;
  const lane beside = lane_max(rho - first, zero), under = x.z + second;
  const lane nearest = lane_min(across * across + along * along, beside * beside + under * under);
  const lane_bits inside = (lane_bits)(under >= zero) & (lane_bits)(rho * height + below * first <= zero);
  const lane d = lane_max(lane_sqrt(lane_choose(inside, zero, nearest)) - lane_all(o->margin), zero);
  return d * d;
}

/* ---- verdicts ---- */

/* Notes for a pair how much is left beyond what it needs, in some lanes. */
EDGE_TARGET static void note_left(lane_batch *b, uint32_t pair, lane left, lane_bits which) {
  const lane_bits less = (lane_bits)(left < b->least) & which;
  b->least = lane_choose(less, left, b->least);
  for (uint32_t lanes = lane_mask(less); lanes; lanes &= lanes - 1) {
    const int i = __builtin_ctz(lanes);
    b->nearest[i] = pair, b->nearest_at[i] = b->interval[i].middle;
  }
}

/* What is left of distances beyond the radii r, where that is more than nothing. */
EDGE_TARGET static void note_least(lane_batch *b, uint32_t pair, lane distance2, lane r) {
  note_left(b, pair, lane_sqrt(distance2) * lane_all(1.0f - (float)EDGE_GROW) - r, (lane_bits)(distance2 > r * r));
}

/* The lanes in which the distance of a pair is at most the sum of what moves and a radius. */
EDGE_INLINE uint32_t within(lane_batch *b, uint32_t pair, lane distance2, lane moves, float radius) {
  const lane r = (moves + lane_all(radius)) * lane_all(1.0f + (float)EDGE_GROW);
  if (b->measures) note_least(b, pair, distance2, r);
  return lane_mask((lane_bits)(distance2 <= r * r));
}

EDGE_INLINE uint32_t within_still(lane distance2, float radius) {
  const float r = radius * (1.0f + (float)EDGE_GROW);
  return lane_mask((lane_bits)(distance2 <= lane_all(r * r)));
}

/* The lanes in which it is proven to be less than the radius. */
EDGE_INLINE uint32_t proven_within(lane distance2, float radius) {
  const float r = radius * (1.0f - (float)EDGE_GROW);
  return r > 0.0f ? lane_mask((lane_bits)(distance2 < lane_all(r * r))) : 0;
}

/* The search is asked about it anyway: lanes look no deeper, and halve nothing more for it. */
EDGE_INLINE bool is_open(const lane_batch *b, uint32_t pair) {
  return b->open->seen[pair] == b->open->edge;
}

EDGE_TARGET static void leave_open(lane_batch *b, uint32_t pair, uint32_t lanes) {
  edge_open *open = b->open;
  if (!is_open(b, pair)) {
    open->seen[pair] = open->edge;
    open->pairs[open->n++] = pair;
  }
  for (; lanes; lanes &= lanes - 1) {
    const lane_interval *i = &b->interval[__builtin_ctz(lanes)];
    open->from = i->middle - i->half < open->from ? i->middle - i->half : open->from;
    open->to = i->middle + i->half > open->to ? i->middle + i->half : open->to;
  }
}

EDGE_INLINE void need(lane_batch *b, cprox_edge_level level) {
  if (b->found->level < level) b->found->level = level;
}

/* The lanes in which a pair is near, but would not be if nothing moved. */
EDGE_INLINE void halve(lane_batch *b, uint32_t pair, uint32_t lanes) {
  if (!b->last)
    b->split |= lanes;
  else if (lanes)
    leave_open(b, pair, lanes);
}

/* What may touch: a geometry, and an obstacle or another geometry. */
typedef struct lane_two {
  int32_t geometry, other;
  bool self;
} lane_two;

EDGE_TARGET static void note_contact(lane_batch *b, const lane_two *two, uint32_t lanes) {
  b->found->at = b->interval[__builtin_ctz(lanes)].middle;
  b->found->geometry = two->geometry, b->found->other = two->other, b->found->self = two->self;
}

/* Two that are left open in some lanes, if they are deeper in each other than all before. */
EDGE_TARGET static void suspect(lane_batch *b, const lane_two *two, uint32_t lanes, lane depth) {
  for (; lanes && b->suspects; lanes &= lanes - 1) {
    const int i = __builtin_ctz(lanes);
    if (b->found->is_suspect && !(depth[i] > b->found->depth)) continue;
    note_contact(b, two, 1u << i);
    b->found->is_suspect = true, b->found->depth = depth[i];
  }
}

/* Whether two are proven to be within a radius of each other in some lane. */
EDGE_INLINE bool proves_contact(lane_batch *b, const lane_two *two, lane distance2, float radius) {
  const uint32_t touching = proven_within(distance2, radius) & b->all;
  if (!touching) return false;
  b->found->verdict = CPROX_VERDICT_VIOLATED, b->found->is_suspect = false;
  note_contact(b, two, touching);
  return true;
}

/* A ball of the robot comes near something in some lanes, but contact is not proven. `radius` is that of both sides
 * together, with what clear needs, and what rounding may cost. */
EDGE_INLINE void settle_near(lane_batch *b, uint32_t pair, const lane_two *two, lane distance2, uint32_t near,
                             float radius) {
  const lane outer = (lane_all(radius) + b->loss.middle) * lane_all(1.0f + (float)EDGE_GROW);
  const uint32_t still = near & lane_mask((lane_bits)(distance2 <= outer * outer));
  if (still) {
    leave_open(b, pair, still);
    suspect(b, two, still, outer - lane_sqrt(distance2));
  }
  halve(b, pair, near & ~still);
}

/* The radius within which contact is proven of two balls, or of one and an obstacle (its inner radius 0); negative
 * where none is known. */
EDGE_INLINE float sure_radius(float inner, float other, float within, float costs) {
  if (!(inner >= 0.0f && other >= 0.0f)) return -1.0f;
  return (inner + other + within) * (1.0f - 0x1p-21f) -
         costs; /* the sums' rounding, which does not shrink with what is left */
}

/* How far the centre of a ball moves in half an interval: by the velocity in the middle, by all accelerations, and by
 * errors. The ball looks the same however it turns. `reach`: of the centre from its frame's origin, at most. */
EDGE_INLINE lane moves_of(const lane_batch *b, lane3 speed, edge_half_bound bound, float reach) {
  if (b->motion->stands) return b->loss.most;
  return b->half * lane_sqrt(lane3_norm2(speed)) + b->half2 * lane_all(bound.acceleration + bound.turn * reach) +
         b->loss.most;
}

/* What rounding may cost a distance of two parts. */
EDGE_INLINE float pair_room(const lane_batch *b, size_t i) {
  const edge_pair *pair = &b->c->lane_pairs[i];
  return b->motion->room[pair->a] + b->motion->room[pair->b];
}

#include "edges/executions.h"
#include "edges/normals.h"

/* ---- contact ---- */

/* In the middles of intervals: only places are needed. Most edges that are not clear end here. */

EDGE_TARGET static bool part_touches(lane_batch *b, size_t i, const edge_obstacle *o) {
  const edge_part *part = &b->c->parts[i];
  const lane_frame *own = &b->frames[part->frame];
  need(b, CPROX_EDGE_COVER);
  const lane3 *ways = ways_of(b, i);
  for (uint32_t k = part->first; k < part->first + part->n; k++) {
    const edge_ball *ball = &b->c->balls[k];
    const lane_two two = {ball->geometry, o->obstacle, false};
    const float inner = sure_radius(ball->inner, 0.0f, (float)b->c->hit_within, b->motion->room[i] + o->grown);
    if (inner > 0.0f && proves_contact(b, &two, distance2_from(o, lane3_add(own->o, ways[k])), inner)) return true;
  }
  return false;
}

/* Distances of a part from all obstacles; whether contact of a ball is proven. Its speed is left to
 * move_part(), and is the way from its frame's origin. */
EDGE_TARGET static bool place_part(lane_batch *b, size_t i) {
  const edge_part *part = &b->c->parts[i];
  const lane_frame *own = &b->frames[part->frame];
  const bool by_balls = !part->coarse && !part->by_hulls;
  const float radius = part->core + (float)b->c->hit_within; /* some ball's centre may be so near */
  const lane3 way = lane_turn(own, part->centre), centre = lane3_add(own->o, way);
  b->parts[i] = (lane_part){.centre = centre, .speed = way};
  b->placed[i] = 0;
  for (uint32_t k = part->first_near; k < part->first_near + part->n_near; k++) {
    const edge_obstacle *o = &b->c->obstacles[b->c->near[k]];
    const lane distance2 = distance2_from(o, centre);
    b->apart2[k] = distance2;
    if (by_balls && o->grown < INFINITY && (within_still(distance2, radius) & b->all) && part_touches(b, i, o))
      return true;
  }
  return false;
}

/* ---- obstacles ---- */

EDGE_TARGET static bool open_part(lane_batch *b, size_t i, uint32_t near_at, const edge_obstacle *o) {
  const edge_part *part = &b->c->parts[i];
  const lane_frame *own = &b->frames[part->frame];
  const float beyond = (float)b->c->clear_beyond, room = b->motion->room[i];
  const lane3 *ways = ways_of(b, i);
  need(b, CPROX_EDGE_COVER);
  for (uint32_t k = part->first; k < part->first + part->n; k++) {
    const edge_ball *ball = &b->c->balls[k];
    lane3 speed;
    const lane distance2 = distance2_from(o, place_point(own, ways[k], &speed));
    const lane moves = moves_of(b, speed, b->motion->frames[part->frame], ball->reach);
    const float outer = ball->outer + beyond + room;
    const uint32_t near = within(b, near_at, distance2, moves, outer) & b->all & ~b->split;
    if (!near) continue;
    const lane_two two = {ball->geometry, o->obstacle, false};
    if (proves_contact(b, &two, distance2, sure_radius(ball->inner, 0.0f, (float)b->c->hit_within, room + o->grown)))
      return true;
    settle_near(b, near_at, &two, distance2, near, outer);
  }
  return false;
}

#include "edges/standing.h"

/* How the centre of a part that is placed moves. */
EDGE_INLINE void move_part(lane_batch *b, size_t i) {
  const lane_frame *own = &b->frames[b->c->parts[i].frame];
  b->parts[i].speed = lane3_add(own->speed, lane3_cross(own->spin, b->parts[i].speed));
}

EDGE_TARGET static bool look_at_obstacles(lane_batch *b, size_t i) {
  const edge_part *part = &b->c->parts[i];
  const lane_part *at = &b->parts[i];
  if (part->n_near == 0) return false;
  bool is_rough = b->motion->losses;
  if (is_rough) b->loss.most = lane_all(b->motion->losses->standing[i]);
  lane moves = moves_of(b, at->speed, b->motion->frames[part->frame], part->reach);
  const float radius = part->outer + (float)b->c->clear_beyond + b->motion->room[i];
  for (uint32_t k = part->first_near; k < part->first_near + part->n_near; k++) {
    const edge_obstacle *o = &b->c->obstacles[b->c->near[k]];
    uint32_t near = within(b, k, b->apart2[k], moves, radius) & b->all & ~b->split;
    if (near && is_rough) {
      is_rough = false, find_loss(b, i);
      moves = moves_of(b, at->speed, b->motion->frames[part->frame], part->reach);
      near &= within(b, k, b->apart2[k], moves, radius);
    }
    if (!near) continue;
    if (part->coarse) {
      leave_open(b, k, near);
    } else if (o->tree || o->hull.n > 0) {
      if (open_standing(b, i, k, o, near)) return true;
    } else if (part->by_hulls ? open_hulls(b, i, k, o, near) : open_part(b, i, k, o)) {
      return true;
    }
  }
  return false;
}

/* ---- pairs of parts ---- */

EDGE_TARGET static bool open_pair(lane_batch *b, size_t i, float room, float costs) {
  const cprox_edge_checker *c = b->c;
  const edge_pair *pair = &c->lane_pairs[i];
  const edge_part *first = &c->parts[pair->a], *second = &c->parts[pair->b];
  const lane_frame *own = &b->frames[first->frame], *other = &b->frames[second->frame];
  const uint32_t number = (uint32_t)(c->n_near + i);
  const lane3 *ways = ways_of(b, pair->a), *its = ways_of(b, pair->b);
  need(b, CPROX_EDGE_COVER);
  for (uint32_t k = first->first; k < first->first + first->n; k++) {
    const edge_ball *ball = &c->balls[k];
    lane3 speed;
    const lane3 at = place_point(own, ways[k], &speed);
    const lane moves = moves_of(b, relative_speed(other, at, speed), b->motion->relations[pair->relation], ball->reach);
    const lane apart2 = lane3_norm2(lane3_sub(at, b->parts[pair->b].centre));
    if (!(within(b, number, apart2, moves, ball->outer + second->outer + room) & b->all & ~b->split)) continue;
    for (uint32_t l = second->first; l < second->first + second->n; l++) {
      const edge_ball *beside = &c->balls[l];
      const lane distance2 = lane3_norm2(lane3_sub(at, lane3_add(other->o, its[l])));
      const float outer = ball->outer + beside->outer + room;
      const uint32_t near = within(b, number, distance2, moves, outer) & b->all & ~b->split;
      if (!near) continue;
      const lane_two two = {ball->geometry, beside->geometry, true};
      if (proves_contact(b, &two, distance2, sure_radius(ball->inner, beside->inner, (float)c->hit_within, costs)))
        return true;
      settle_near(b, number, &two, distance2, near, outer);
    }
  }
  return false;
}

EDGE_TARGET static bool look_at_pair(lane_batch *b, size_t i) {
  const edge_pair *pair = &b->c->lane_pairs[i];
  const edge_part *first = &b->c->parts[pair->a], *second = &b->c->parts[pair->b];
  const lane_part *at = &b->parts[pair->a];
  const float costs = pair_room(b, i), room = costs + (float)b->c->clear_beyond;
  const lane distance2 = lane3_norm2(lane3_sub(at->centre, b->parts[pair->b].centre));
  const lane3 speed = relative_speed(&b->frames[second->frame], at->centre, at->speed);
  const edge_half_bound bound = b->motion->relations[pair->relation];
  const uint32_t number = (uint32_t)(b->c->n_near + i);
  const float radius = first->outer + second->outer + room;
  if (b->motion->losses) b->loss.most = lane_all(b->motion->losses->pairs[i]);
  uint32_t near = within(b, number, distance2, moves_of(b, speed, bound, first->reach), radius) & b->all & ~b->split;
  if (near && b->motion->losses) {
    find_pair_loss(b, pair);
    near &= within(b, number, distance2, moves_of(b, speed, bound, first->reach), radius);
  }
  if (!near) return false;
  if (first->coarse || second->coarse)
    leave_open(b, number, near);
  else if (first->by_hulls || second->by_hulls)
    open_hull_pair(b, i, near);
  else
    return open_pair(b, i, room, costs);
  return false;
}

/* ---- the search ---- */

/* Of a state no part and no frame has a speed. */
EDGE_INLINE void stand_still(lane_batch *b) {
  const lane zero = lane_all(0.0f);
  for (size_t i = 1; i < b->c->n_frames; i++) b->frames[i].spin = b->frames[i].speed = (lane3){zero, zero, zero};
  for (size_t i = 0; i < b->c->n_parts; i++) b->parts[i].speed = (lane3){zero, zero, zero};
}

/* Whether contact is proven. */
EDGE_TARGET static bool look_at_batch(lane_batch *b) {
  const cprox_edge_checker *c = b->c;
  for (size_t i = 1; i < c->n_frames; i++) place_frame(b, i);
  for (size_t i = c->n_parts; i-- > 0;)
    if (place_part(b, i)) return true;
  if (b->motion->stands)
    stand_still(b);
  else {
    for (size_t i = 1; i < c->n_frames; i++) move_frame(b, i);
    for (size_t i = 0; i < c->n_parts; i++) move_part(b, i);
  }
  if (!b->related) edge_motion_relate(c, b->motion);
  b->related = true;
  for (size_t i = 0; i < c->n_lane_pairs; i++)
    if (look_at_pair(b, i)) return true;
  for (size_t i = 0; i < c->n_parts; i++)
    if (look_at_obstacles(b, i)) return true;
  return false;
}

/* The least of all lanes, once there are none left. */
EDGE_TARGET static void tell_least(const lane_batch *b, edge_found *found) {
  found->least = INFINITY, found->nearest = UINT32_MAX;
  for (int i = 0; i < EDGE_LANES; i++)
    if (b->least[i] < found->least)
      found->least = b->least[i], found->nearest = b->nearest[i], found->nearest_at = b->nearest_at[i];
}

/* The intervals on top of the stack, one a lane; lanes that are left over repeat the last one. */
EDGE_TARGET static void load_batch(lane_batch *b, const lane_interval *stack, size_t *n) {
  const size_t count = *n < EDGE_LANES ? *n : EDGE_LANES;
  for (size_t i = 0; i < EDGE_LANES; i++) {
    b->interval[i] = stack[*n - 1 - (i < count ? i : count - 1)];
    b->middle[i] = b->interval[i].middle, b->half[i] = b->interval[i].half;
  }
  *n -= count;
  b->half2 = b->half * b->half;
  b->all = (uint32_t)((1u << count) - 1u);
  b->split = 0, b->is_off = false;
  b->found->intervals += (uint32_t)count;
}

/* Halves go back in the order that has the earliest on top. */
EDGE_TARGET static void split_batch(const lane_batch *b, lane_interval *stack, size_t *n) {
  for (int i = EDGE_LANES; i-- > 0;) {
    if (!(b->split >> i & 1u)) continue;
    const float half = 0.5f * b->interval[i].half, middle = b->interval[i].middle;
    stack[(*n)++] = (lane_interval){middle + half, half};
    stack[(*n)++] = (lane_interval){middle - half, half};
  }
}

EDGE_TARGET void EDGE_KERNEL(const cprox_edge_checker *c, const edge_motion *motion, edge_lanes *lanes,
                             edge_found *found) {
  lane_batch b = {.c = c, .motion = motion, .open = &lanes->open, .found = found};
  b.measures = lanes->measures, b.suspects = lanes->suspects;
  const int most = lanes->most_batches > 0 && lanes->most_batches < EDGE_MOST_BATCHES ? (int)lanes->most_batches - 1
                                                                                      : EDGE_MOST_BATCHES;
  b.least = lane_all(INFINITY);
  b.frames = (lane_frame *)(void *)lanes->memory;
  b.parts = (lane_part *)(void *)(b.frames + c->n_frames);
  b.ways = (lane3 *)(void *)(b.parts + c->n_parts);
  b.off = (lane_off *)(void *)(b.ways + c->n_balls);
  b.apart2 = (lane *)(void *)(b.off + c->n_frames);
  b.placed = (uint32_t *)(void *)(b.apart2 + c->n_near);
  memset(&b.frames[0], 0, sizeof b.frames[0]);
  for (int k = 0; k < 9; k += 4) b.frames[0].r[k] = lane_all(1.0f);
  *found = (edge_found){.verdict = CPROX_VERDICT_CLEAR, .level = CPROX_EDGE_BALL};
  lanes->open.n = 0, lanes->open.from = 1.0f, lanes->open.to = -1.0f;

  lane_interval stack[EDGE_STACK];
  size_t n = 0;
  if (motion->stands)
    stack[n++] = (lane_interval){0.0f, 0.0f};
  else
    for (int i = EDGE_LANES; i-- > 0;)
      stack[n++] = (lane_interval){((float)(2 * i + 1) - (float)EDGE_LANES) * EDGE_ROOT_HALF, EDGE_ROOT_HALF};
  for (int batches = 0; n > 0; batches++) {
    load_batch(&b, stack, &n);
    found->batches++;
    if (look_at_batch(&b)) return;
    if (found->is_suspect) {
      found->verdict = CPROX_VERDICT_UNDECIDED;
      return;
    }
    if (n == 0 && b.split == 0) break;
    float shortest = 1.0f;
    for (uint32_t left = b.split; left; left &= left - 1) {
      const float half = b.interval[__builtin_ctz(left)].half;
      shortest = half < shortest ? half : shortest;
    }
    if (n + 2 * EDGE_LANES > EDGE_STACK) {
      found->too_much = true, found->verdict = CPROX_VERDICT_UNDECIDED;
      return;
    }
    split_batch(&b, stack, &n);
    b.last = b.last || batches >= most || shortest < 2.0f * EDGE_SHORTEST;
  }
  if (lanes->open.n > 0) found->verdict = CPROX_VERDICT_UNDECIDED;
  if (b.measures) tell_least(&b, found);
}
