/* SPDX-License-Identifier: BSD-3-Clause */
/* What errors of an execution may cost distances, eight intervals at once; a part of kernel.h. doc/robust.md, Lanes */

/* Sums, products and roots of a chain of up to 4000 axes round by less. */
#define EDGE_LOSS_GROW 0x1p-12f

EDGE_INLINE lane_loss loss_grown(lane_loss loss) {
  const lane grow = lane_all(1.0f + EDGE_LOSS_GROW);
  return (lane_loss){loss.most * grow, loss.middle * grow};
}

EDGE_TARGET static void find_off(lane_batch *b) {
  const edge_losses *l = b->motion->losses;
  for (size_t i = 1; i < b->c->n_frames && !b->is_off; i++) {
    const edge_frame_bound *bound = &b->motion->bounds[i];
    const lane here = lane_abs(rate_of_frame(b, i)) + lane_all((float)bound->rate_error);
    const lane rate = lane_min(here + b->half * lane_all((float)bound->second), lane_all((float)bound->rate));
    const lane still = lane_all(l->still[i]), by_rate = lane_all(l->by_rate[i]);
    const lane most = lane_min(still + by_rate * rate, lane_all(l->most[i]));
    b->off[i] = (lane_off){.most = most, .middle = lane_min(still + by_rate * here, most), .turn = b->half * rate};
  }
  b->is_off = true;
}

/* A ball that a part's core is in, in the middle; the axes from `frame` on down to the base are not counted yet. */
typedef struct lane_chain {
  lane3 at;
  lane moved; /* how far the axes that are counted move it in half an interval */
  float radius;
  int32_t frame;
} lane_chain;

EDGE_INLINE lane_chain chain_of(const lane_batch *b, size_t part) {
  return (lane_chain){.at = b->parts[part].centre,
                      .moved = lane_all(0.0f),
                      .radius = b->c->parts[part].core + b->motion->losses->slack[part],
                      .frame = b->c->parts[part].frame};
}

EDGE_INLINE lane length_to(const lane_chain *s, lane3 from) {
  return lane_sqrt(lane3_norm2(lane3_sub(s->at, from))) + lane_all(s->radius);
}

EDGE_INLINE lane3 axis_of_frame(const lane_frame *f) {
  return (lane3){f->r[2], f->r[5], f->r[8]};
}

/* What an axis that is off costs: so much times its lever arm, which what is tipside of it makes longer. */
EDGE_INLINE void count_axis(const lane_batch *b, lane_chain *s, lane_loss *loss) {
  const lane_frame *f = &b->frames[s->frame];
  const lane_off *off = &b->off[s->frame];
  lane arm = lane_all(1.0f), widest = arm;
  if (!b->c->frames[s->frame].shifts) {
    arm = lane_sqrt(lane3_norm2(lane3_cross(axis_of_frame(f), lane3_sub(s->at, f->o)))) + lane_all(s->radius);
    widest = arm + s->moved;
  }
  loss->most += off->most * widest, loss->middle += off->middle * arm;
  s->moved += off->turn * arm;
  s->frame = b->c->frames[s->frame].parent;
}

/* Of a distance of a part from what stands, in b->loss and b->places. */
EDGE_TARGET static void find_loss(lane_batch *b, size_t part) {
  const edge_losses *l = b->motion->losses;
  find_off(b);
  lane_chain s = chain_of(b, part);
  lane_loss loss = {lane_all(0.0f), lane_all(0.0f)};
  const lane places = lane_all(l->places + (s.frame > 0 ? l->flex : 0.0f));
  while (s.frame > 0) count_axis(b, &s, &loss);
  const lane3 origin = {lane_all(l->base_origin[0]), lane_all(l->base_origin[1]), lane_all(l->base_origin[2])};
  const lane arm = length_to(&s, origin), turned = lane_all(l->base_rotation);
  lane_loss other = {places + turned * (arm + s.moved), places + turned * arm};
  /* an obstacle without an end stands, and the part turns about its pose's position */
  const lane zero = lane_all(0.0f), far = lane_all(l->object_far) + length_to(&s, (lane3){zero, zero, zero});
  const lane reach = lane_all(l->object_reach), turns = lane_all(l->object_rotation);
  other.middle += turns * lane_max(reach, far + loss.middle + other.middle);
  other.most += turns * lane_max(reach, far + s.moved + loss.most + other.most);
  b->places = other;
  b->loss = loss_grown((lane_loss){loss.most + other.most, loss.middle + other.middle});
}

/* The same along a normal that stands, of a ball of that part: at most b->loss. The core of the ball is in it in the
 * middle. */
EDGE_TARGET static lane_loss loss_along(const lane_batch *b, size_t part, lane3 at, float core, lane3 n) {
  const edge_losses *l = b->motion->losses;
  const lane zero = lane_all(0.0f), one = lane_all(1.0f), half = lane_all(0.5f);
  const lane slack = lane_all(l->slack[part]), size = lane_all(core), radius = size + slack;
  const int32_t last = b->c->parts[part].frame;
  /* by how much the axes that are not counted yet turn what is beyond them: by errors, and by the motion */
  lane_loss before = {lane_all(l->base_rotation), lane_all(l->base_rotation)}, loss = b->places;
  lane turned = zero, moved = zero;
  for (int32_t i = last; i > 0; i = b->c->frames[i].parent) {
    if (b->c->frames[i].shifts) continue;
    before.most += b->off[i].most, before.middle += b->off[i].middle, turned += b->off[i].turn;
  }
  before = loss_grown(before), turned *= lane_all(1.0f + EDGE_LOSS_GROW); /* differences round by less than that */
  for (int32_t i = last; i > 0; i = b->c->frames[i].parent) {
    const lane_frame *f = &b->frames[i];
    const lane_off *off = &b->off[i];
    const lane3 z = axis_of_frame(f);
    lane along = lane_abs(lane3_dot(n, z)), arm = one, widest = one, bends = zero, turns = turned;
    if (!b->c->frames[i].shifts) {
      const lane3 u = lane3_cross(z, lane3_sub(at, f->o));
      along = lane_abs(lane3_dot(n, u)) + lane_sqrt(lane3_norm2(lane3_cross(n, z))) * size + slack;
      arm = lane_sqrt(lane3_norm2(u)) + radius, widest = arm + moved, bends = half;
      before.most -= off->most, before.middle -= off->middle;
      turns = turned * arm + moved;
      turned -= off->turn;
    }
    const lane most = along + turns + widest * (before.most + bends * off->most),
               middle = along + arm * (before.middle + bends * off->middle);
    loss.most += off->most * lane_min(most, widest), loss.middle += off->middle * lane_min(middle, arm);
    moved += off->turn * arm;
  }
  loss = loss_grown(loss);
  return (lane_loss){lane_min(loss.most, b->loss.most), lane_min(loss.middle, b->loss.middle)};
}

/* Of a distance of two parts, in b->loss: by the axes between them, from the last one on. */
EDGE_TARGET static void find_pair_loss(lane_batch *b, const edge_pair *pair) {
  find_off(b);
  lane_chain one = chain_of(b, pair->a), other = chain_of(b, pair->b);
  const float flex = b->motion->losses->flex;
  const lane bent = lane_all((one.frame > 0 ? flex : 0.0f) + (other.frame > 0 ? flex : 0.0f));
  lane_loss loss = {bent, bent};
  while (one.frame != other.frame) count_axis(b, one.frame > other.frame ? &one : &other, &loss);
  b->loss = loss_grown(loss);
}
