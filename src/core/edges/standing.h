/* SPDX-License-Identifier: BSD-3-Clause */
/* Obstacles by what they are made of, eight intervals at once; a part of kernel.h: polyhedra by their corners, meshes,
 * points and cells by their trees. doc/robot-edges.md, Obstacles */

/* Nodes that wait, and nodes and elements that are looked at for one piece of a part in a batch. */
enum { EDGE_TREE_STACK = 8 * TREE_DEEPEST, EDGE_MOST_ELEMENTS = 1024 };

/* An obstacle's own axes and origin, as a frame that stands. */
EDGE_TARGET static void place_standing(const edge_obstacle *o, lane_frame *to) {
  const lane zero = lane_all(0.0f);
  for (int k = 0; k < 9; k++) to->r[k] = lane_all(o->axes[k]);
  to->o = (lane3){lane_all(o->origin[0]), lane_all(o->origin[1]), lane_all(o->origin[2])};
  to->spin = to->speed = (lane3){zero, zero, zero};
}

/* A part of a robot, and one obstacle. */
typedef struct lane_standing {
  const edge_obstacle *o;
  const edge_part *part;
  const lane_frame *own;
  lane_frame frame; /* the obstacle's */
  uint32_t pair, left;
  float room, beyond;
} lane_standing;

/* A piece of a part, which a ball is one of. */
typedef struct lane_piece {
  lane_hull placed;
  lane3 speed;
  uint32_t number; /* of a hull; UINT32_MAX: it is a ball */
} lane_piece;

EDGE_INLINE lane_piece place_piece(const lane_standing *s, const edge_hull *hull, const float *points,
                                   uint32_t number) {
  const lane3 centre = lane3_add(s->own->o, lane_turn(s->own, hull->centre));
  return (lane_piece){
      .placed = {.hull = hull, .points = points, .frame = s->own, .centre = centre},
      .speed = lane3_add(s->own->speed, lane3_cross(s->own->spin, lane3_sub(centre, s->own->o))),
      .number = number,
  };
}

/* How far a piece's ball moves. */
EDGE_INLINE lane piece_moves(const lane_batch *b, const lane_standing *s, const lane_piece *p) {
  return moves_of(b, p->speed, b->motion->frames[s->part->frame], (float)s->part->reach_of_centre);
}

/* A piece and the hull of some points of the obstacle; then the pieces of that piece. */
EDGE_TARGET static void open_piece(lane_batch *b, lane_standing *s, const lane_piece *piece, const lane_hull *beside,
                                   uint32_t near) {
  const cprox_edge_checker *c = b->c;
  open_hull stack[EDGE_HULL_STACK];
  stack[0] = (open_hull){piece->number, 0, near};
  lane_apart two = {.b = *beside,
                    .part = (int32_t)(s->part - c->parts),
                    .spin = s->own->spin,
                    .bound = b->motion->frames[s->part->frame],
                    .reach = (float)s->part->reach_of_centre,
                    .pair = s->pair};
  int looked = 0;
  for (size_t n = 1; n > 0; looked++) {
    const open_hull at = stack[--n];
    uint32_t lanes = at.lanes & ~b->split & ~s->left, still = lanes;
    if (!lanes) continue;
    lane_piece own = *piece;
    if (at.hull != piece->number)
      own = place_piece(s, &c->hulls[at.hull], points_of_hull(b, &c->hulls[at.hull]), at.hull);
    const edge_hull *hull = own.placed.hull;
    two.a = own.placed, two.speed = own.speed;
    two.radius = hull->margin + s->o->around + s->beyond + s->room;
    lanes &= balls_near(b, &two);
    if (!lanes) continue;
    two.opens = hull->n_children > 0 && looked <= EDGE_MOST_HULLS && n + hull->n_children <= EDGE_HULL_STACK;
    lane depth;
    lanes = not_apart(b, &two, lanes, &still, &depth);
    if (is_open(b, s->pair)) {
      s->left |= lanes;
      continue;
    }
    halve(b, s->pair, lanes & ~still);
    if (!still) continue;
    if (!two.opens) {
      const lane_two both = {hull->geometry, s->o->obstacle, false};
      suspect(b, &both, still, depth);
      s->left |= still;
      continue;
    }
    for (uint32_t k = 0; k < hull->n_children; k++) stack[n++] = (open_hull){hull->child + k, 0, still};
  }
}

/* An element of a tree as a hull of its corners. */
EDGE_TARGET static void place_element(const lane_standing *s, const double *numbers, edge_hull *hull, float *points,
                                      lane_hull *to) {
  const tree_kind kind = s->o->tree->kind;
  const int given = kind == TREE_TRIANGLES ? 3 : kind == TREE_BOXES ? 2 : 1;
  hull->n = kind == TREE_BOXES ? 8 : (uint32_t)given;
  float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (uint32_t i = 0; i < hull->n; i++)
    for (uint32_t k = 0; k < 3; k++) {
      const uint32_t corner = kind == TREE_BOXES ? i >> k & 1u : i;
      const float x = (float)numbers[(3 * corner + k) * TREE_LANES];
      for (uint32_t l = i; l == i || (i + 1 == hull->n && l < EDGE_BLOCK); l++) points[k * EDGE_BLOCK + l] = x;
      low[k] = x < low[k] ? x : low[k], high[k] = x > high[k] ? x : high[k];
    }
  float core2 = 0.0f;
  for (int k = 0; k < 3; k++) {
    hull->centre[k] = 0.5f * low[k] + 0.5f * high[k];
    const float half = high[k] - hull->centre[k], other = hull->centre[k] - low[k];
    core2 += half > other ? half * half : other * other;
  }
  hull->core = sqrtf(core2) * (1.0f + 0x1p-20f);
  *to = (lane_hull){.hull = hull, .points = points, .frame = &s->frame};
  to->centre = lane3_add(s->frame.o, lane_turn(&s->frame, hull->centre));
}

/* The square of the distance of points, as the obstacle sees them, from a box. */
EDGE_INLINE lane distance2_from_box(lane3 x, const float *low, const float *high) {
  const lane zero = lane_all(0.0f);
  const lane3 out = {lane_max(lane_max(lane_all(low[0]) - x.x, x.x - lane_all(high[0])), zero),
                     lane_max(lane_max(lane_all(low[1]) - x.y, x.y - lane_all(high[1])), zero),
                     lane_max(lane_max(lane_all(low[2]) - x.z, x.z - lane_all(high[2])), zero)};
  return lane3_norm2(out);
}

/* A ball that something moves in: where the obstacle sees its centre, and its radius. */
typedef struct lane_ball {
  lane3 x;
  lane r; /* how far what it needs reaches: its radius and how far it moves, from above */
  float radius;
} lane_ball;

EDGE_INLINE lane_ball ball_of_piece(const lane_batch *b, const lane_standing *s, const lane_piece *p) {
  const edge_hull *hull = p->placed.hull;
  const float radius = hull->core + hull->margin + s->o->around + s->beyond + s->room;
  return (lane_ball){.x = lane_turn_back(s->frame.r, lane3_sub(p->placed.centre, s->frame.o)),
                     .r = (piece_moves(b, s, p) + lane_all(radius)) * lane_all(1.0f + (float)EDGE_GROW),
                     .radius = radius};
}

/* Eight boxes: children of a node, or elements of a pack. */
typedef struct lane_boxes {
  lane3 low, high;
} lane_boxes;

EDGE_INLINE lane3 lane3_narrow(const double *from) {
  return (lane3){lane_narrow(from), lane_narrow(from + TREE_LANES), lane_narrow(from + 2 * (size_t)TREE_LANES)};
}

/* The boxes of `use` that a ball comes near, and for each of them in which lanes of `lanes`. Boxes stand in lanes here,
 * one interval after another. */
EDGE_INLINE uint32_t near_boxes(lane_batch *b, const lane_standing *s, const lane_ball *ball, const lane_boxes *boxes,
                                uint32_t use, uint32_t lanes, lane_bits *near) {
  const lane zero = lane_all(0.0f), r2 = ball->r * ball->r;
  const lane3 low = boxes->low, high = boxes->high;
  lane beyond2 = lane_all(INFINITY); /* of each interval the least that is not near */
  lane_bits found = {0};
  for (uint32_t left = lanes; left; left &= left - 1) {
    const int l = __builtin_ctz(left), bit = 1 << l;
    const lane3 x = {lane_all(ball->x.x[l]), lane_all(ball->x.y[l]), lane_all(ball->x.z[l])};
    const lane3 out = {lane_max(lane_max(low.x - x.x, x.x - high.x), zero),
                       lane_max(lane_max(low.y - x.y, x.y - high.y), zero),
                       lane_max(lane_max(low.z - x.z, x.z - high.z), zero)};
    const lane distance2 = lane3_norm2(out);
    const lane_bits is_near = (lane_bits)(distance2 <= lane_all(r2[l]));
    found |= is_near & (lane_bits){bit, bit, bit, bit, bit, bit, bit, bit};
    if (b->measures) beyond2[l] = lane_least(lane_choose(lane_those(use) & ~is_near, distance2, lane_all(INFINITY)))[0];
  }
  if (b->measures) note_least(b, s->pair, beyond2, ball->r);
  *near = found;
  return lane_mask(found != 0) & use;
}

/* The elements of a pack that come near a piece's ball. Whether contact is proven. */
EDGE_TARGET static bool open_pack(lane_batch *b, lane_standing *s, const lane_piece *piece, const lane_ball *ball,
                                  uint32_t pack, uint32_t near) {
  const tree *t = s->o->tree;
  const double *numbers = t->packs + (size_t)pack * tree_pack_size(t->kind);
  const uint32_t *ids = t->ids + (size_t)pack * TREE_LANES;
  const size_t corners = t->kind == TREE_TRIANGLES ? 3 : t->kind == TREE_BOXES ? 2 : 1;
  lane_boxes boxes = {.low = lane3_narrow(numbers)};
  boxes.high = boxes.low;
  for (size_t c = 1; c < corners; c++) {
    const lane3 x = lane3_narrow(numbers + 3 * c * TREE_LANES), low = boxes.low, high = boxes.high;
    boxes.low = (lane3){lane_min(x.x, low.x), lane_min(x.y, low.y), lane_min(x.z, low.z)};
    boxes.high = (lane3){lane_max(x.x, high.x), lane_max(x.y, high.y), lane_max(x.z, high.z)};
  }
  int n = 1;
  while (n < TREE_LANES && ids[n] != ids[n - 1]) n++; /* what fills a pack repeats the last one */
  lane_bits near_each;
  for (uint32_t use = near_boxes(b, s, ball, &boxes, (1u << n) - 1u, near, &near_each); use; use &= use - 1) {
    const int e = __builtin_ctz(use);
    const double *own = numbers + e;
    const uint32_t lanes = (uint32_t)near_each[e] & ~b->split & ~s->left;
    if (!lanes) continue;
    if (t->kind != TREE_TRIANGLES && piece->number == UINT32_MAX) {
      const lane_two two = {piece->placed.hull->geometry, s->o->obstacle, false};
      const float inner =
          sure_radius(piece->placed.hull->inner, s->o->within, (float)b->c->hit_within, s->room + s->o->costs);
      const float low[3] = {boxes.low.x[e], boxes.low.y[e], boxes.low.z[e]},
                  high[3] = {boxes.high.x[e], boxes.high.y[e], boxes.high.z[e]};
      const lane distance2 = distance2_from_box(ball->x, low, high);
      if (proves_contact(b, &two, distance2, inner)) return true;
      settle_near(b, s->pair, &two, distance2, lanes, ball->radius);
      s->left |= lanes;
      continue;
    }
    edge_hull hull = {.n = 0};
    float points[3 * EDGE_BLOCK];
    lane_hull element;
    place_element(s, own, &hull, points, &element);
    open_piece(b, s, piece, &element, lanes);
  }
  return false;
}

typedef struct open_node {
  uint32_t child, lanes;
} open_node;

/* The elements of a tree near one piece. Whether contact is proven. */
EDGE_TARGET static bool open_tree(lane_batch *b, lane_standing *s, const lane_piece *piece, uint32_t near) {
  const tree *t = s->o->tree;
  const lane_ball ball = ball_of_piece(b, s, piece);
  open_node stack[EDGE_TREE_STACK];
  stack[0] = (open_node){0, near};
  int looked = 0;
  for (size_t n = 1; n > 0; looked++) {
    const open_node at = stack[--n];
    const uint32_t lanes = at.lanes & ~b->split & ~s->left;
    if (!lanes) continue;
    if (looked > EDGE_MOST_ELEMENTS) {
      s->left |= lanes;
      continue;
    }
    if (at.child & TREE_LEAF) {
      if (open_pack(b, s, piece, &ball, at.child & ~TREE_LEAF, lanes)) return true;
      continue;
    }
    const tree_node *node = &t->nodes[at.child];
    const lane_boxes boxes = {lane3_narrow(node->low[0]), lane3_narrow(node->high[0])};
    lane_bits near_each;
    for (uint32_t use = near_boxes(b, s, &ball, &boxes, node->lanes, lanes, &near_each); use; use &= use - 1) {
      const int k = __builtin_ctz(use);
      const uint32_t inside = (uint32_t)near_each[k];
      if (n == EDGE_TREE_STACK)
        s->left |= inside;
      else
        stack[n++] = (open_node){node->child[k], inside};
    }
  }
  return false;
}

/* A part that comes near the box or ball of an obstacle that is made of more. Whether contact is proven. */
EDGE_TARGET static bool open_standing(lane_batch *b, size_t i, uint32_t near_at, const edge_obstacle *o,
                                      uint32_t near) {
  const cprox_edge_checker *c = b->c;
  const edge_part *part = &c->parts[i];
  lane_standing s = {.o = o,
                     .part = part,
                     .own = &b->frames[part->frame],
                     .pair = near_at,
                     .room = b->motion->room[i],
                     .beyond = (float)c->clear_beyond};
  place_standing(o, &s.frame);
  need(b, part->by_hulls || !o->tree ? CPROX_EDGE_NORMAL : CPROX_EDGE_COVER);
  lane_hull beside = {
      .hull = &o->hull, .points = c->corners + (size_t)o->hull.first * 3 * EDGE_BLOCK, .frame = &s.frame};
  beside.centre = lane3_add(s.frame.o, lane_turn(&s.frame, o->hull.centre));
  const uint32_t first = part->by_hulls ? part->first_hull : part->first,
                 end = part->by_hulls ? part->end_hull : part->first + part->n;
  for (uint32_t k = first; k < end; k = part->by_hulls ? c->hulls[k].end : k + 1) {
    edge_hull ball = {.n = 1};
    if (!part->by_hulls) {
      const edge_ball *of = &c->balls[k];
      memcpy(ball.centre, of->centre, sizeof ball.centre);
      ball.margin = of->outer, ball.inner = of->inner, ball.geometry = of->geometry;
    }
    const edge_hull *hull = part->by_hulls ? &c->hulls[k] : &ball;
    float centre[3 * EDGE_BLOCK];
    for (int l = 0; l < 3 * EDGE_BLOCK && !part->by_hulls; l++) centre[l] = ball.centre[l / EDGE_BLOCK];
    const float *points = part->by_hulls ? points_of_hull(b, hull) : centre;
    const lane_piece piece = place_piece(&s, hull, points, part->by_hulls ? k : UINT32_MAX);
    if (!o->tree)
      open_piece(b, &s, &piece, &beside, near & ~s.left);
    else if (open_tree(b, &s, &piece, near & ~s.left))
      return true;
  }
  s.left &= ~b->split;
  if (s.left) leave_open(b, near_at, s.left);
  return false;
}
