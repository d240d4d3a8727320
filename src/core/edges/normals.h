/* SPDX-License-Identifier: BSD-3-Clause */
/* Directions in which hulls are apart, eight intervals at once; a part of kernel.h. doc/robot-edges.md, Normals */

/* Steps of a search for a normal, hulls that are looked at for one pair of a batch, and hulls that wait. */
enum { EDGE_NORMALS = 12, EDGE_MOST_HULLS = 96, EDGE_HULL_STACK = 64 };

/* What sizes of obstacles may cost along a normal, of their sum: 16 u. */
#define EDGE_SIZES 0x1p-20f

/* A hull where its frame is in the middle. */
typedef struct lane_hull {
  const edge_hull *hull;
  const float *points;
  const lane_frame *frame;
  lane3 centre; /* from the base */
} lane_hull;

EDGE_INLINE lane3 lane3_scale(lane s, lane3 a) {
  return (lane3){s * a.x, s * a.y, s * a.z};
}

EDGE_INLINE lane3 lane3_neg(lane3 a) {
  return (lane3){-a.x, -a.y, -a.z};
}

/* a + s b */
EDGE_INLINE lane3 lane3_axpy(lane3 a, lane s, lane3 b) {
  return (lane3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

EDGE_INLINE lane3 lane3_choose(lane_bits first, lane3 a, lane3 b) {
  return (lane3){lane_choose(first, a.x, b.x), lane_choose(first, a.y, b.y), lane_choose(first, a.z, b.z)};
}

EDGE_INLINE lane3 lane_turn_lanes(const lane *r, lane3 p) {
  return (lane3){r[0] * p.x + r[1] * p.y + r[2] * p.z, r[3] * p.x + r[4] * p.y + r[5] * p.z,
                 r[6] * p.x + r[7] * p.y + r[8] * p.z};
}

EDGE_INLINE lane3 lane_turn_back(const lane *r, lane3 p) {
  return (lane3){r[0] * p.x + r[3] * p.y + r[6] * p.z, r[1] * p.x + r[4] * p.y + r[7] * p.z,
                 r[2] * p.x + r[5] * p.y + r[8] * p.z};
}

EDGE_INLINE const float *points_of_hull(const lane_batch *b, const edge_hull *hull) {
  return b->c->points + (size_t)hull->first * 3 * EDGE_BLOCK;
}

EDGE_INLINE lane_hull place_hull(const lane_batch *b, const edge_hull *hull, const lane_frame *own) {
  return (lane_hull){.hull = hull,
                     .points = points_of_hull(b, hull),
                     .frame = own,
                     .centre = lane3_add(own->o, lane_turn(own, hull->centre))};
}

/* Of one lane, eight points at once. `which`: the first point that does. */
EDGE_INLINE float least_of_one(const float *p, int32_t n, float x, float y, float z, int32_t *which) {
  lane least = lane_all(x) * lane_load(p) + lane_all(y) * lane_load(p + EDGE_BLOCK) +
               lane_all(z) * lane_load(p + 2 * EDGE_BLOCK);
  lane_bits number = {0, 1, 2, 3, 4, 5, 6, 7}, best = number;
  for (int32_t i = EDGE_BLOCK; i < n; i += EDGE_BLOCK) {
    p += 3 * EDGE_BLOCK, number += EDGE_BLOCK;
    const lane along = lane_all(x) * lane_load(p) + lane_all(y) * lane_load(p + EDGE_BLOCK) +
                       lane_all(z) * lane_load(p + 2 * EDGE_BLOCK);
    const lane_bits less = (lane_bits)(along < least);
    least = lane_min(along, least);
    best = (lane_bits)lane_choose(less, (lane)number, (lane)best);
  }
  uint32_t equal = lane_mask((lane_bits)(least == lane_least(least)));
  int k = equal ? __builtin_ctz(equal) : 0;
  for (equal &= equal - 1; equal; equal &= equal - 1)
    if (best[__builtin_ctz(equal)] < best[k]) k = __builtin_ctz(equal);
  *which = best[k];
  return least[k];
}

/* The same of all lanes, one point at once. */
EDGE_INLINE lane least_of_all(const float *p, int32_t n, lane3 t, lane_bits *which) {
  lane least = t.x * lane_all(p[0]) + t.y * lane_all(p[EDGE_BLOCK]) + t.z * lane_all(p[2 * EDGE_BLOCK]);
  lane_bits best = {0}, number = best;
  for (int32_t i = 1; i < n; i++) {
    const float *q = p + edge_point_place((size_t)i);
    number += 1;
    const lane along = t.x * lane_all(q[0]) + t.y * lane_all(q[EDGE_BLOCK]) + t.z * lane_all(q[2 * EDGE_BLOCK]);
    const lane_bits less = (lane_bits)(along < least);
    least = lane_min(along, least);
    best = (lane_bits)lane_choose(less, (lane)number, (lane)best);
  }
  *which = best;
  return least;
}

/* The least product of a hull's points with a direction in some lanes, both seen from the frame's origin; `at`: that
 * point. */
EDGE_TARGET static lane least_along(const lane_hull *h, lane3 n, uint32_t lanes, lane3 *at) {
  const lane3 t = lane_turn_back(h->frame->r, n);
  const int32_t count = (int32_t)h->hull->n, blocks = (count + EDGE_BLOCK - 1) / EDGE_BLOCK;
  lane least = lane_all(0.0f);
  lane_bits which = {0};
  if (__builtin_popcount(lanes) * (blocks + 4) >= count)
    least = least_of_all(h->points, count, t, &which);
  else
    for (uint32_t left = lanes; left; left &= left - 1) {
      const int l = __builtin_ctz(left);
      int32_t first;
      least[l] = least_of_one(h->points, count, t.x[l], t.y[l], t.z[l], &first);
      which[l] = first;
    }
  lane3 own = {least, least, least};
  for (uint32_t left = lanes; left; left &= left - 1) {
    const int l = __builtin_ctz(left);
    const float *q = h->points + edge_point_place((size_t)which[l]);
    own.x[l] = q[0], own.y[l] = q[EDGE_BLOCK], own.z[l] = q[2 * EDGE_BLOCK];
  }
  *at = lane_turn_lanes(h->frame->r, own);
  return least;
}

EDGE_INLINE lane lane_with_sign(lane size, lane of) {
  const lane_bits sign = {INT32_MIN, INT32_MIN, INT32_MIN, INT32_MIN, INT32_MIN, INT32_MIN, INT32_MIN, INT32_MIN};
  return (lane)((lane_bits)size | ((lane_bits)of & sign));
}

EDGE_INLINE lane3 obstacle_axes_back(const edge_obstacle *o, lane3 x) {
  if (o->shape == EDGE_ALIGNED_BOX || o->shape == EDGE_BALL) return x;
  return (lane3){x.x * lane_all(o->r[0]) + x.y * lane_all(o->r[3]) + x.z * lane_all(o->r[6]),
                 x.x * lane_all(o->r[1]) + x.y * lane_all(o->r[4]) + x.z * lane_all(o->r[7]),
                 x.x * lane_all(o->r[2]) + x.y * lane_all(o->r[5]) + x.z * lane_all(o->r[8])};
}

EDGE_INLINE lane3 obstacle_axes(const edge_obstacle *o, lane3 x) {
  if (o->shape == EDGE_ALIGNED_BOX || o->shape == EDGE_BALL) return x;
  return (lane3){lane_row(&x.x, o->r), lane_row(&x.x, o->r + 3), lane_row(&x.x, o->r + 6)};
}

/* The radius of a ball about each point of an obstacle's core. */
EDGE_INLINE float round_of(const edge_obstacle *o) {
  return o->shape == EDGE_BALL || o->shape == EDGE_CAPSULE     ? o->size[0]
         : o->shape == EDGE_CONE || o->shape == EDGE_HALFSPACE ? o->margin
                                                               : 0.0f;
}

/* The most that an obstacle's core reaches along a normal from its place, from above; `at`: the point that does. */
EDGE_TARGET static lane obstacle_along(const edge_obstacle *o, lane3 n, lane3 *at) {
  const lane zero = lane_all(0.0f), first = lane_all(o->size[0]), second = lane_all(o->size[1]);
  const float sizes = EDGE_SIZES * (o->size[0] + o->size[1] + o->size[2]);
  const lane3 t = obstacle_axes_back(o, n);
  lane most;
  lane3 own = {zero, zero, zero};
  switch (o->shape) {
    case EDGE_BALL:
    case EDGE_HALFSPACE: return zero;
    case EDGE_ALIGNED_BOX:
    case EDGE_BOX: {
      const lane third = lane_all(o->size[2]);
      own = (lane3){lane_with_sign(first, t.x), lane_with_sign(second, t.y), lane_with_sign(third, t.z)};
      most = lane_abs(t.x) * first + lane_abs(t.y) * second + lane_abs(t.z) * third + lane_all(sizes);
      break;
    }
    case EDGE_CAPSULE:
      own.z = lane_with_sign(second, t.z);
      most = lane_abs(t.z) * second + lane_all(EDGE_SIZES * o->size[1]);
      break;
    default: { /* a cylinder, a cone */
      const lane rho = lane_sqrt(t.x * t.x + t.y * t.y), share = first / lane_max(rho, lane_all(1e-12f));
      const lane rim = rho * first;
      own = (lane3){t.x * share, t.y * share, lane_with_sign(second, t.z)};
      most = rim + lane_abs(t.z) * second;
      if (o->shape == EDGE_CONE) {
        const lane apex = t.z * second, base = rim - apex;
        const lane_bits up = (lane_bits)(apex > base);
        own = (lane3){lane_choose(up, zero, own.x), lane_choose(up, zero, own.y), lane_choose(up, second, -second)};
        most = lane_choose(up, apex, base);
      }
      most = most + lane_all(EDGE_SIZES * (o->size[0] + o->size[1]));
      break;
    }
  }
  *at = obstacle_axes(o, own);
  return most;
}

/* From a point of an obstacle that is near another point to that; only where a search begins. */
EDGE_INLINE lane3 from_obstacle(const edge_obstacle *o, lane3 at) {
  const lane3 x = {at.x - lane_all(o->p[0]), at.y - lane_all(o->p[1]), at.z - lane_all(o->p[2])};
  const lane3 own = obstacle_axes_back(o, x);
  lane3 out = own;
  const lane first = lane_all(o->size[0]), second = lane_all(o->size[1]), third = lane_all(o->size[2]);
  if (o->shape == EDGE_BOX || o->shape == EDGE_ALIGNED_BOX) {
    out.x = own.x - lane_max(lane_min(own.x, first), -first);
    out.y = own.y - lane_max(lane_min(own.y, second), -second);
    out.z = own.z - lane_max(lane_min(own.z, third), -third);
  } else if (o->shape == EDGE_CAPSULE || o->shape == EDGE_CYLINDER) {
    out.z = own.z - lane_max(lane_min(own.z, second), -second);
  }
  const lane_bits inside = (lane_bits)(lane3_norm2(out) == lane_all(0.0f));
  return obstacle_axes(o, lane3_choose(inside, own, out));
}

/* Three points of the difference of two hulls, and the point of the triangle that is nearest to 0. */
typedef struct lane_triangle {
  lane3 a, b, c, nearest;
} lane_triangle;

/* The point of a side w v that is nearest to 0; e = v - w. */
EDGE_INLINE lane3 nearest_of_side(lane3 w, lane3 e, lane we, lane ee) {
  const lane share = lane_max(lane_min(-we / lane_max(ee, lane_all(1e-30f)), lane_all(1.0f)), lane_all(0.0f));
  return lane3_axpy(w, share, e);
}

/* The lanes in which the point of a plane w e f that is nearest to 0 lies in the triangle; that point. */
EDGE_INLINE lane_bits nearest_of_inside(lane3 w, lane3 e, lane3 f, lane we, lane wf, lane ee, lane ef, lane ff,
                                        lane3 *nearest) {
  const lane zero = lane_all(0.0f), one = lane_all(1.0f);
  const lane det = ee * ff - ef * ef, over = one / lane_max(det, lane_all(1e-30f));
  const lane s = (wf * ef - we * ff) * over, t = (we * ef - wf * ee) * over;
  *nearest = lane3_axpy(lane3_axpy(w, s, e), t, f);
  return (lane_bits)(det > lane_all(1e-6f) * ee * ff) & (lane_bits)(s > zero) & (lane_bits)(t > zero) &
         (lane_bits)(s + t < one);
}

/* Of the three triangles that a new point w makes with the sides of the old one, that which is nearest to 0. Returns
 * the lanes in which the tetrahedron of the four points contains 0. */
EDGE_INLINE uint32_t take_in_point(lane_triangle *to, lane3 w) {
  const lane zero = lane_all(0.0f);
  const lane3 a = to->a, b = to->b, c = to->c;
  const lane3 bc = lane3_cross(b, c), ca = lane3_cross(c, a), ab = lane3_cross(a, b);
  const lane volume = lane3_dot(a, bc);
  const uint32_t around =
      lane_mask((lane_bits)(volume * lane3_dot(w, bc) < zero) & (lane_bits)(volume * lane3_dot(w, ca) < zero) &
                (lane_bits)(volume * lane3_dot(w, ab) < zero));

  const lane3 e = lane3_sub(a, w), f = lane3_sub(b, w), g = lane3_sub(c, w);
  const lane ee = lane3_dot(e, e), ff = lane3_dot(f, f), gg = lane3_dot(g, g);
  const lane ef = lane3_dot(e, f), fg = lane3_dot(f, g), ge = lane3_dot(g, e);
  const lane we = lane3_dot(w, e), wf = lane3_dot(w, f), wg = lane3_dot(w, g);
  const lane3 sides[3] = {nearest_of_side(w, e, we, ee), nearest_of_side(w, f, wf, ff), nearest_of_side(w, g, wg, gg)};
  lane3 insides[3];
  const lane_bits inside[3] = {nearest_of_inside(w, e, f, we, wf, ee, ef, ff, &insides[0]),
                               nearest_of_inside(w, f, g, wf, wg, ff, fg, gg, &insides[1]),
                               nearest_of_inside(w, g, e, wg, we, gg, ge, ee, &insides[2])};
  lane least = lane_all(INFINITY);
  lane_bits dropped[3] = {{0}, {0}, {0}}; /* c, a, b */
  for (int k = 0; k < 6; k++) {
    const lane3 point = k < 3 ? sides[k] : insides[k - 3];
    const lane distance2 = lane3_norm2(point);
    lane_bits nearer = (lane_bits)(distance2 < least);
    if (k >= 3) nearer &= inside[k - 3];
    least = lane_choose(nearer, distance2, least);
    to->nearest = lane3_choose(nearer, point, to->nearest);
    for (int l = 0; l < 3; l++) dropped[l] = l == k % 3 ? dropped[l] | nearer : dropped[l] & ~nearer;
  }
  to->c = lane3_choose(dropped[0], w, c);
  to->a = lane3_choose(dropped[1], w, a);
  to->b = lane3_choose(dropped[2], w, b);
  return around;
}

/* What is asked about two hulls, or a hull and an obstacle. */
typedef struct lane_apart {
  lane3 speed, spin;      /* of a's centre and a, as the other sees it */
  lane_hull a, b;         /* b.hull NULL: */
  const edge_obstacle *o; /* the obstacle */
  int32_t part;           /* a's, where errors cost less along a normal than in any direction; -1: they do not */
  float reach, radius;    /* of a's part; of both sides together, with clear_beyond and what rounding may cost */
  uint32_t pair;
  edge_half_bound bound;
  bool opens; /* pieces of one of them are looked at next: no normal is sought that only holds them apart as they are */
} lane_apart;

/* The lanes in which not even the balls round the two hulls are apart. */
EDGE_TARGET static uint32_t balls_near(lane_batch *b, const lane_apart *two) {
  const lane distance2 =
      two->o ? distance2_from(two->o, two->a.centre) : lane3_norm2(lane3_sub(two->a.centre, two->b.centre));
  const lane moves = moves_of(b, two->speed, two->bound, two->reach);
  const float other = two->o ? -round_of(two->o) : two->b.hull->core;
  return within(b, two->pair, distance2, moves, two->a.hull->core + other + two->radius);
}

/* The lanes of `lanes` in which no normal proves the two apart over the interval; *still: nor as they are in its
 * middle; *depth: how deep they are in each other there, by the best of these normals. */
EDGE_TARGET static uint32_t not_apart(lane_batch *b, const lane_apart *two, uint32_t lanes, uint32_t *still,
                                      lane *depth) {
  const lane zero = lane_all(0.0f), grow = lane_all(1.0f + (float)EDGE_GROW);
  const lane accelerated = b->half2 * lane_all(two->bound.acceleration + two->bound.turn * two->reach);
  const lane radius = lane_all(two->radius);
  const lane3 origins =
      two->o ? (lane3){two->a.frame->o.x - lane_all(two->o->p[0]), two->a.frame->o.y - lane_all(two->o->p[1]),
                       two->a.frame->o.z - lane_all(two->o->p[2])}
             : lane3_sub(two->a.frame->o, two->b.frame->o);
  const bool plane = two->o && two->o->shape == EDGE_HALFSPACE;
  lane3 x = two->o ? from_obstacle(two->o, two->a.centre) : lane3_sub(two->a.centre, two->b.centre);
  lane_triangle near = {x, x, x, x};
  if (plane) x = (lane3){lane_all(two->o->r[0]), lane_all(two->o->r[3]), lane_all(two->o->r[6])};
  uint32_t open = lanes, asked = lanes, standing = 0;
  *depth = lane_all(INFINITY);
  for (int step = 0; step < EDGE_NORMALS && asked; step++) {
    const lane length = lane_sqrt(lane3_norm2(x)), over = lane_all(1.0f) / lane_max(length, lane_all(1e-18f));
    const lane3 n = plane ? x : lane3_scale(over, x);
    lane3 at = {zero, zero, zero}, its = at;
    const lane least = least_along(&two->a, n, asked, &at);
    const lane most = two->o ? obstacle_along(two->o, n, &its) : -least_along(&two->b, lane3_neg(n), asked, &its);
    const lane gap = lane3_dot(n, origins) + (least - most);
    const lane turns = lane_sqrt(lane3_norm2(lane3_cross(n, two->spin)));
    const lane moves =
        b->half * (lane_abs(lane3_dot(n, two->speed)) + turns * lane_all(two->a.hull->core)) + accelerated;
    lane needed = (moves + radius + b->loss.most) * grow, stands = (radius + b->loss.middle) * grow;
    if (two->part >= 0 && b->motion->losses && (asked & ~lane_mask((lane_bits)(gap > needed)))) {
      const lane_loss loss = loss_along(b, (size_t)two->part, two->a.centre, two->a.hull->core, n);
      needed = (moves + radius + loss.most) * grow, stands = (radius + loss.middle) * grow;
    }
    const uint32_t now = lane_mask((lane_bits)(gap > needed)) & asked;
    if (b->measures && now) note_left(b, two->pair, gap * lane_all(1.0f - (float)EDGE_GROW) - needed, lane_those(now));
    open &= ~now, asked &= ~now;
    standing |= lane_mask((lane_bits)(gap > stands)) & asked;
    *depth = lane_choose(lane_those(asked), lane_min(stands - gap, *depth), *depth);
    if (plane) break;
    /* no normal will do better: they are too near each other, or they move too far */
    asked &= ~(lane_mask((lane_bits)(length <= stands)) |
               ((two->opens ? asked : standing) & lane_mask((lane_bits)(length <= needed))));
    if (!asked) break;
    const lane3 w = lane3_add(origins, lane3_sub(at, its));
    asked &= ~take_in_point(&near, w);
    x = near.nearest;
  }
  *still = open & ~standing;
  return open;
}

/* Lanes in which a point of a hull is proven to be in an obstacle, or within the radius of it. */
EDGE_TARGET static uint32_t touches(const lane_hull *h, const edge_obstacle *o, float hit_within, float costs) {
  if (!(h->hull->inner >= 0.0f) || !(costs < INFINITY)) return 0;
  const float within = sure_radius(h->hull->inner, 0.0f, hit_within, costs);
  const float deep = costs * (1.0f + 0x1p-20f) - (h->hull->inner + hit_within) * (1.0f - 0x1p-20f);
  const lane first = lane_all(o->size[0] - deep), second = lane_all(o->size[1] - deep),
             third = lane_all(o->size[2] - deep), zero = lane_all(0.0f);
  uint32_t found = 0;
  for (uint32_t i = 0; i < h->hull->n; i++) {
    const float *p = h->points + edge_point_place(i), own[3] = {p[0], p[EDGE_BLOCK], p[2 * EDGE_BLOCK]};
    const lane3 at = lane3_add(h->frame->o, lane_turn(h->frame, own));
    found |= proven_within(distance2_from(o, at), within);
    if (deep < 0.0f) continue;
    const lane3 x =
        obstacle_axes_back(o, (lane3){at.x - lane_all(o->p[0]), at.y - lane_all(o->p[1]), at.z - lane_all(o->p[2])});
    if (o->shape == EDGE_BOX || o->shape == EDGE_ALIGNED_BOX)
      found |= lane_mask((lane_bits)(lane_abs(x.x) < first) & (lane_bits)(lane_abs(x.y) < second) &
                         (lane_bits)(lane_abs(x.z) < third));
    const lane shrink = lane_all(1.0f - (float)EDGE_GROW);
    if (o->shape == EDGE_BALL) found |= lane_mask((lane_bits)(lane_sqrt(lane3_norm2(x)) < first * shrink));
    if (o->shape == EDGE_CYLINDER)
      found |= lane_mask((lane_bits)(lane_sqrt(x.x * x.x + x.y * x.y) < first * shrink) &
                         (lane_bits)(lane_abs(x.z) < second));
    if (o->shape == EDGE_CAPSULE) {
      const lane half = lane_all(o->size[1]);
      const lane3 beside = {x.x, x.y, lane_max(lane_abs(x.z) - half, zero)};
      found |= lane_mask((lane_bits)(lane_sqrt(lane3_norm2(beside)) < first * shrink));
    }
    if (o->shape == EDGE_HALFSPACE) found |= lane_mask((lane_bits)(x.x < lane_all(o->margin - deep)));
  }
  return found;
}

/* ---- obstacles ---- */

typedef struct open_hull {
  uint32_t hull, other, lanes;
} open_hull;

/* What a pair of hulls leaves open: lanes to halve, lanes that the pair is left to the search in. */
EDGE_TARGET static bool open_hulls(lane_batch *b, size_t i, uint32_t near_at, const edge_obstacle *o, uint32_t near) {
  const cprox_edge_checker *c = b->c;
  const edge_part *part = &c->parts[i];
  const lane_frame *own = &b->frames[part->frame];
  const float room = b->motion->room[i];
  const bool known = is_open(b, near_at);
  need(b, CPROX_EDGE_NORMAL);
  lane_apart two = {.o = o,
                    .part = (int32_t)i,
                    .spin = own->spin,
                    .bound = b->motion->frames[part->frame],
                    .reach = (float)part->reach_of_centre,
                    .pair = near_at};
  uint32_t left = 0;
  for (uint32_t root = part->first_hull; root < part->end_hull; root = c->hulls[root].end) {
    open_hull stack[EDGE_HULL_STACK];
    stack[0] = (open_hull){root, 0, near};
    int looked = 0;
    for (size_t n = 1; n > 0; looked++) {
      const open_hull at = stack[--n];
      const edge_hull *hull = &c->hulls[at.hull];
      uint32_t lanes = at.lanes & ~b->split & ~left, still = lanes;
      if (!lanes) continue;
      two.a = place_hull(b, hull, own);
      two.speed = lane3_add(own->speed, lane3_cross(own->spin, lane3_sub(two.a.centre, own->o)));
      two.radius = hull->margin + round_of(o) + (float)c->clear_beyond + room;
      if (at.hull != root) lanes &= balls_near(b, &two);
      if (!lanes) continue;
      two.opens = hull->n_children > 0 && looked <= EDGE_MOST_HULLS && n + hull->n_children <= EDGE_HULL_STACK;
      lane depth;
      lanes = not_apart(b, &two, lanes, &still, &depth);
      if (known) {
        left |= lanes;
        continue;
      }
      halve(b, near_at, lanes & ~still);
      if (!still) continue;
      const lane_two both = {hull->geometry, o->obstacle, false};
      if (n == 0 || hull->n_children == 0) {
        const uint32_t touching = touches(&two.a, o, (float)c->hit_within, room + o->grown) & still;
        if (touching) {
          b->found->verdict = CPROX_VERDICT_VIOLATED, b->found->is_suspect = false;
          note_contact(b, &both, touching);
          return true;
        }
      }
      if (!two.opens) {
        suspect(b, &both, still, depth);
        left |= still;
        continue;
      }
      for (uint32_t k = 0; k < hull->n_children; k++) stack[n++] = (open_hull){hull->child + k, 0, still};
    }
  }
  left &= ~b->split;
  if (left) leave_open(b, near_at, left);
  return false;
}

/* ---- pairs of parts ---- */

/* Of a pair of which one hull is to be replaced by its pieces: the larger one that has any. */
EDGE_INLINE bool opens_first(const edge_hull *a, const edge_hull *b) {
  return a->n_children > 0 && (b->n_children == 0 || a->core >= b->core);
}

EDGE_TARGET static void open_hull_pair(lane_batch *b, size_t i, uint32_t near) {
  const cprox_edge_checker *c = b->c;
  const edge_pair *pair = &c->lane_pairs[i];
  const edge_part *first = &c->parts[pair->a], *second = &c->parts[pair->b];
  const lane_frame *own = &b->frames[first->frame], *other = &b->frames[second->frame];
  const uint32_t number = (uint32_t)(c->n_near + i);
  const float room = pair_room(b, i) + (float)c->clear_beyond;
  const bool known = is_open(b, number);
  need(b, CPROX_EDGE_NORMAL);
  lane_apart two = {.spin = lane3_sub(own->spin, other->spin),
                    .part = -1,
                    .bound = b->motion->relations[pair->relation],
                    .reach = (float)first->reach_of_centre,
                    .pair = number};
  open_hull stack[EDGE_HULL_STACK];
  uint32_t left = 0;
  int looked = 0;
  for (uint32_t one = first->first_hull; one < first->end_hull; one = c->hulls[one].end)
    for (uint32_t two_at = second->first_hull; two_at < second->end_hull; two_at = c->hulls[two_at].end) {
      stack[0] = (open_hull){one, two_at, near};
      for (size_t n = 1; n > 0; looked++) {
        const open_hull at = stack[--n];
        const edge_hull *hull = &c->hulls[at.hull], *beside = &c->hulls[at.other];
        uint32_t lanes = at.lanes & ~b->split & ~left, still = lanes;
        if (!lanes) continue;
        two.a = place_hull(b, hull, own), two.b = place_hull(b, beside, other);
        two.speed = relative_speed(other, two.a.centre,
                                   lane3_add(own->speed, lane3_cross(own->spin, lane3_sub(two.a.centre, own->o))));
        two.radius = hull->margin + beside->margin + room;
        lanes &= balls_near(b, &two);
        if (!lanes) continue;
        const bool first_opens = opens_first(hull, beside);
        const uint32_t child = first_opens ? hull->child : beside->child;
        const uint32_t children = first_opens ? hull->n_children : beside->n_children;
        two.opens = children > 0 && looked <= EDGE_MOST_HULLS && n + children <= EDGE_HULL_STACK;
        lane depth;
        lanes = not_apart(b, &two, lanes, &still, &depth);
        if (known) {
          left |= lanes;
          continue;
        }
        halve(b, number, lanes & ~still);
        if (!still) continue;
        if (!two.opens) {
          const lane_two both = {hull->geometry, beside->geometry, true};
          suspect(b, &both, still, depth);
          left |= still;
          continue;
        }
        for (uint32_t k = 0; k < children; k++)
          stack[n++] = first_opens ? (open_hull){child + k, at.other, still} : (open_hull){at.hull, child + k, still};
      }
    }
  left &= ~b->split;
  if (left) leave_open(b, number, left);
}
