/* SPDX-License-Identifier: BSD-3-Clause */
#include "edges/edge_bound.h"

#include <math.h>

/* By how much one joint's transforms turn what is behind it too much, in EDGE_U, without its angle's own error; what a
 * product with a vector adds; what the vector to an obstacle adds. doc/rounding.md, Edges */
#define ROUND_TURN 21.5
#define ROUND_PRODUCT 7.0
#define ROUND_APART 13.0

/* Second order terms, and the rounding of the bounds themselves. */
#define EDGE_UP (1.0 + 0x1p-10)

/* Lanes do not see what is shorter: squares would be 0 [m]. */
#define EDGE_LEAST 1e-18

#define EDGE_TURN_MOST 64.0
#define EDGE_ANGLE_MOST 1e6
#define EDGE_REACH_MOST 1e6

static const double PI = 3.14159265358979323846;

static float above(double x) {
  return (float)(x * (1.0 + 0x1p-22));
}

/* ---- memory ---- */

size_t edge_motion_size(const cprox_edge_checker *c) {
  return c->n_frames * (2 * sizeof(float) + sizeof(edge_frame_bound) + sizeof(edge_half_bound)) +
         c->n_relations * sizeof(edge_half_bound) + c->n_parts * sizeof(float);
}

edge_motion edge_motion_in(const cprox_edge_checker *c, char *memory) {
  edge_motion m = {.bounds = (edge_frame_bound *)(void *)memory};
  m.frames = (edge_half_bound *)(void *)(m.bounds + c->n_frames);
  m.relations = m.frames + c->n_frames;
  m.middle = (float *)(void *)(m.relations + c->n_relations);
  m.rate = m.middle + c->n_frames;
  m.room = m.rate + c->n_frames;
  return m;
}

/* ---- frames ---- */

/* The value of a variable in the middle, its rate, and what double costs the first. False: beyond single precision. */
static bool find_values(const edge_frame *f, const double *from, const double *to, edge_motion *m, size_t i,
                        double *error) {
  const double a = from[f->variable], b = to[f->variable], rate = f->multiplier * (b - a);
  double middle = f->multiplier * (0.5 * a + 0.5 * b) + f->offset;
  const double sizes = fabs(f->multiplier) * (fabs(a) + fabs(b)) + fabs(f->offset);
  *error = 0x1p-50 * sizes;
  if (!(sizes <= EDGE_ANGLE_MOST) || (!f->shifts && fabs(rate) > EDGE_TURN_MOST)) return false;
  if (!f->shifts && fabs(middle) > PI) middle -= 2.0 * PI * floor(middle / (2.0 * PI) + 0.5);
  m->middle[i] = (float)middle, m->rate[i] = (float)rate;
  m->bounds[i].rate = fabs(rate) + *error;
  m->bounds[i].shift = f->shifts ? fabs(middle) + 0.5 * fabs(rate) + *error : 0.0;
  return true;
}

static void bound_frame(const edge_frame *f, const edge_frame_bound *p, double error, edge_frame_bound *b) {
  const double u = EDGE_U, length = f->length + b->shift, g = b->rate;
  const double turns = f->shifts ? 0.0 : g, shifts = f->shifts ? g : 0.0;
  const double angle = f->shifts ? 0.0 : u * (2.0 * PI + 1.5 * g) + error;
  const double value = f->shifts ? u * (2.0 * b->shift + g) + error : 0.0;

  b->reach = p->reach + length, b->spin = p->spin + turns, b->speed = p->speed + p->spin * length + shifts;
  b->turn_error = p->turn_error + ROUND_TURN * u + angle;
  b->place_error = p->place_error + (b->turn_error + ROUND_PRODUCT * u) * length + 2.0 * u * b->reach + value;
  b->spin_error = p->spin_error + turns * (b->turn_error + 3.0 * u) + u * b->spin;
  b->speed_error = p->speed_error + p->spin_error * length +
                   p->spin * ((b->turn_error + (ROUND_PRODUCT + 3.0) * u) * length + value) +
                   shifts * (b->turn_error + 3.0 * u) + 2.0 * u * b->speed;

  b->acceleration = p->acceleration + p->turn * length + 2.0 * p->spin * shifts;
  b->spin_rate = p->spin_rate + p->spin * turns;
  b->turn = b->spin_rate + b->spin * b->spin;
}

/* ---- relations ---- */

static double length_of(const edge_step *step, const edge_motion *m) {
  return step->length + (step->shifted >= 0 ? m->bounds[step->shifted].shift : 0.0);
}

/* As bound_frame(), along the way from one frame to the other. */
static edge_half_bound bound_relation(const cprox_edge_checker *c, const edge_relation *r, const edge_motion *m) {
  double acceleration = 0.0, spin = 0.0, spin_rate = 0.0;
  for (uint32_t i = r->first; i < r->first + r->n; i++) {
    const edge_step *step = &c->steps[i];
    const double g = m->bounds[step->frame].rate;
    acceleration += (spin_rate + spin * spin) * length_of(step, m);
    if (c->frames[step->frame].shifts) {
      acceleration += 2.0 * spin * g;
    } else {
      spin_rate += spin * g;
      spin += g;
    }
  }
  const double turn = spin_rate + spin * spin;
  return (edge_half_bound){.acceleration = above(0.5 * (acceleration + turn * length_of(&r->last, m))),
                           .turn = above(0.5 * turn)};
}

/* ---- parts ---- */

/* Places of a part are off by this, and so is what moves in half of the longest interval; two parts add theirs. */
static double room_of(const edge_part *part, const edge_motion *m, double reach, double spin) {
  const edge_frame_bound *b = &m->bounds[part->frame];
  const double u = EDGE_U, s = part->reach_of_centre;
  const double place = b->place_error + (b->turn_error + ROUND_PRODUCT * u) * s + ROUND_APART * u * (b->reach + s);
  const double speed = b->speed_error + b->spin_error * (s + (double)part->core + 2.0 * reach) + spin * place +
                       16.0 * u * spin * reach + 3.0 * u * b->speed;
  return EDGE_UP * (place + 2.0 * (double)EDGE_ROOT_HALF * speed) + EDGE_LEAST;
}

bool edge_motion_fill(const cprox_edge_checker *c, const double *from, const double *to, edge_motion *m) {
  m->bounds[0] = (edge_frame_bound){.rate = 0.0};
  m->frames[0] = (edge_half_bound){0};
  m->stands = true;
  for (size_t i = 1; i < c->n_frames; i++) {
    const edge_frame *f = &c->frames[i];
    double error;
    if (!find_values(f, from, to, m, i, &error)) return false;
    bound_frame(f, &m->bounds[f->parent], error, &m->bounds[i]);
    m->frames[i] = (edge_half_bound){above(0.5 * m->bounds[i].acceleration), above(0.5 * m->bounds[i].turn)};
    m->stands = m->stands && m->bounds[i].rate <= error;
  }
  double reach = 0.0, spin = 0.0;
  for (size_t i = 0; i < c->n_parts; i++) {
    const edge_frame_bound *b = &m->bounds[c->parts[i].frame];
    const double far = b->reach + c->parts[i].farthest;
    reach = far > reach ? far : reach, spin = b->spin > spin ? b->spin : spin;
  }
  if (!(reach <= EDGE_REACH_MOST)) return false;
  for (size_t i = 0; i < c->n_parts; i++) m->room[i] = above(room_of(&c->parts[i], m, reach, spin));
  return true;
}

void edge_motion_relate(const cprox_edge_checker *c, const edge_motion *m) {
  for (size_t i = 0; i < c->n_relations; i++) m->relations[i] = bound_relation(c, &c->relations[i], m);
}
