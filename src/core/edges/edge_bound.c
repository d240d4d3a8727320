/* SPDX-License-Identifier: BSD-3-Clause */
#include "edges/edge_bound.h"

#include <math.h>
#include <string.h>

#include "kinematics/errors.h"
#include "problem/obstacles.h"

/* By how much one joint's transforms turn what is behind it too much, in EDGE_U, without its angle's own error; what a
 * product with a vector adds; what the vector to an obstacle adds. doc/rounding.md, Edges */
#define ROUND_TURN 21.5
#define ROUND_PRODUCT 7.0
#define ROUND_APART 13.0

/* What the part of a velocity along a normal adds. */
#define ROUND_ALONG 8.0

/* Second order terms, and the rounding of the bounds themselves. */
#define EDGE_UP (1.0 + 0x1p-10)

/* Lanes do not see what is shorter: squares would be 0 [m]. */
#define EDGE_LEAST 1e-18

/* Single precision places what is in a part no farther than this, by the largest distance from its frame. */
#define EDGE_PLACE 0x1p-20

/* Lever arms of lanes are off by the places of the part and of the axis, by the direction of the axis, and by what they
 * are computed with: each of them by less than the part's room. doc/rounding.md */
enum { ROUND_ARM = 4 };

#define EDGE_TURN_MOST 64.0
#define EDGE_ANGLE_MOST 1e6
#define EDGE_REACH_MOST 1e6

static const double PI = 3.14159265358979323846;

static float above(double x) {
  return (float)(x * (1.0 + 0x1p-22));
}

/* ---- memory ---- */

size_t edge_motion_size(const cprox_edge_checker *c) {
  return c->n_frames * ((2 + 2 * EDGE_POWERS) * sizeof(float) + sizeof(edge_frame_bound) + sizeof(edge_half_bound)) +
         c->n_relations * sizeof(edge_half_bound) + c->n_parts * sizeof(float);
}

edge_motion edge_motion_in(const cprox_edge_checker *c, char *memory) {
  edge_motion m = {.bounds = (edge_frame_bound *)(void *)memory};
  m.frames = (edge_half_bound *)(void *)(m.bounds + c->n_frames);
  m.relations = m.frames + c->n_frames;
  m.middle = (float *)(void *)(m.relations + c->n_relations);
  m.rate = m.middle + c->n_frames;
  m.more = m.rate + c->n_frames;
  m.more_rate = m.more + EDGE_POWERS * c->n_frames;
  m.room = m.more_rate + EDGE_POWERS * c->n_frames;
  return m;
}

/* ---- variables ---- */

/* What a variable does over the edge: a polynomial of the edge's parameter, seen from its middle. */
typedef struct edge_way {
  double power[MOTION_MAX_DEGREE + 1];
  size_t degree;
  double rate, second; /* bounds on both derivatives */
  double sizes;        /* of what all that was computed from */
  double error;        /* of all powers together */
} edge_way;

static edge_way way_between(double a, double b) {
  return (edge_way){.power = {0.5 * a + 0.5 * b, b - a},
                    .degree = a != b,
                    .rate = fabs(b - a),
                    .sizes = fabs(a) + fabs(b),
                    .error = 0x1p-50 * (fabs(a) + fabs(b))};
}

/* The coefficients of the part from a to b, by de Casteljau's scheme. */
static void cut_out(double *c, size_t degree, double a, double b) {
  for (size_t k = 1; b < 1.0 && k <= degree; k++)
    for (size_t i = degree; i >= k; i--) c[i] = (1.0 - b) * c[i - 1] + b * c[i];
  const double at = b > 0.0 ? a / b : 0.0;
  for (size_t k = 1; at > 0.0 && k <= degree; k++)
    for (size_t i = 0; i + k <= degree; i++) c[i] = (1.0 - at) * c[i] + at * c[i + 1];
}

/* All that is computed here is within 2^20 roundings of the largest coefficient, for degrees up to 9: differences have
 * factors of 2^9 at most, binomials of 126, and no number goes through more than 32 roundings. doc/rounding.md */
static edge_way way_along(const cprox_motion *m, int32_t variable, const motion_interval *over) {
  const int32_t slot = m->slot[variable];
  if (slot < 0) return way_between(m->rest[variable], m->rest[variable]);
  const motion_track *t = &m->tracks[0];
  const size_t degree = t->degree[over->first], at = over->first * t->n_moving + (size_t)slot - t->first_slot;
  double c[MOTION_MAX_DEGREE + 1];
  edge_way way = {.degree = degree};
  for (size_t i = 0; i <= degree; i++) {
    c[i] = t->coefficients[at * t->stride + i];
    way.sizes = greater(fabs(c[i]), way.sizes);
  }
  way.error = 0x1p-32 * way.sizes + t->error[at];
  cut_out(c, degree, over->a, over->b);
  double binomial = 1.0;
  for (size_t k = 0; k <= degree; k++) { /* c: the differences of order k */
    way.power[k] = binomial * bernstein_at(c, degree - k, 0.5);
    double largest = 0.0;
    for (size_t i = 0; i + k <= degree; i++) largest = greater(fabs(c[i]), largest);
    if (k == 1) way.rate = (double)degree * largest;
    if (k == 2) way.second = (double)(degree * (degree - 1)) * largest;
    for (size_t i = 0; i + k < degree; i++) c[i] = c[i + 1] - c[i];
    binomial = binomial * (double)(degree - k) / (double)(k + 1);
  }
  while (way.degree > 0 && way.power[way.degree] == 0.0) way.degree--;
  if (way.degree > 0 || way.rate > 0.0) way.rate += way.error, way.second += way.error;
  return way;
}

/* What lanes get of it, and what they are off by. A power is rounded by u; Horner's scheme has two more roundings for
 * each step that it goes through. False: beyond single precision. */
static bool take_way(const edge_frame *f, const edge_way *way, edge_motion *m, size_t i) {
  edge_frame_bound *b = &m->bounds[i];
  const double u = EDGE_U, factor = fabs(f->multiplier), sizes = factor * way->sizes + fabs(f->offset);
  const double error = factor * way->error + 0x1p-50 * sizes;
  double middle = f->multiplier * way->power[0] + f->offset, beside = 0.0;
  if (!(sizes <= EDGE_ANGLE_MOST)) return false;
  if (!f->shifts && fabs(middle) > PI) middle -= 2.0 * PI * floor(middle / (2.0 * PI) + 0.5);
  const size_t degree = way->degree;
  const double rate = degree > 0 ? f->multiplier * way->power[1] : 0.0;
  m->middle[i] = (float)middle, m->rate[i] = (float)rate;
  b->value_error = error + u * ((f->shifts ? 2.0 * fabs(middle) : 2.0 * PI) + (degree > 1 ? 2.0 : 1.5) * fabs(rate));
  b->rate_error = degree > 1 ? error + u * 3.0 * fabs(rate) : 0.0;
  double half = 0.5; /* 2^(1-k) */
  for (size_t k = 2; k <= degree; k++) {
    const double power = f->multiplier * way->power[k], size = fabs(power) * half;
    m->more[i * EDGE_POWERS + k - 2] = (float)power, m->more_rate[i * EDGE_POWERS + k - 2] = (float)((double)k * power);
    half *= 0.5, beside += 0.5 * size;
    b->value_error += (double)(k + 1) * u * size;
    b->rate_error += (double)(2 * k + 3) * u * (double)k * size;
  }
  b->rate = factor * way->rate + error;
  b->second = factor * way->second + (degree > 1 ? error : 0.0);
  b->shift = f->shifts ? fabs(middle) + 0.5 * fabs(rate) + beside + error : 0.0;
  m->degree = degree > m->degree ? degree : m->degree;
  m->stands = m->stands && degree == 0 && way->rate == 0.0;
  return f->shifts || fabs(rate) + 2.0 * beside <= EDGE_TURN_MOST;
}

/* ---- frames ---- */

static void bound_frame(const edge_frame *f, const edge_frame_bound *p, edge_frame_bound *b) {
  const double u = EDGE_U, length = f->length + b->shift, g = b->rate;
  const double turns = f->shifts ? 0.0 : g, shifts = f->shifts ? g : 0.0;
  const double angle = f->shifts ? 0.0 : b->value_error, value = f->shifts ? b->value_error : 0.0;

  b->reach = p->reach + length, b->spin = p->spin + turns, b->speed = p->speed + p->spin * length + shifts;
  b->turn_error = p->turn_error + ROUND_TURN * u + angle;
  b->place_error = p->place_error + (b->turn_error + ROUND_PRODUCT * u) * length + 2.0 * u * b->reach + value;
  b->spin_error = p->spin_error + turns * (b->turn_error + 3.0 * u) + u * b->spin + (f->shifts ? 0.0 : b->rate_error);
  b->speed_error = p->speed_error + p->spin_error * length +
                   p->spin * ((b->turn_error + (ROUND_PRODUCT + 3.0) * u) * length + value) +
                   shifts * (b->turn_error + 3.0 * u) + 2.0 * u * b->speed + (f->shifts ? b->rate_error : 0.0);

  b->acceleration = p->acceleration + p->turn * length + 2.0 * p->spin * shifts + (f->shifts ? b->second : 0.0);
  b->bend = p->bend + (f->shifts ? 0.0 : b->second);
  b->turn = b->bend + b->spin * b->spin;
}

/* ---- relations ---- */

static double length_of(const edge_step *step, const edge_motion *m) {
  return step->length + (step->shifted >= 0 ? m->bounds[step->shifted].shift : 0.0);
}

/* As bound_frame(), along the way from one frame to the other. */
static edge_half_bound bound_relation(const cprox_edge_checker *c, const edge_relation *r, const edge_motion *m) {
  double acceleration = 0.0, spin = 0.0, bend = 0.0;
  for (uint32_t i = r->first; i < r->first + r->n; i++) {
    const edge_step *step = &c->steps[i];
    const double g = m->bounds[step->frame].rate;
    const double second = m->bounds[step->frame].second;
    acceleration += (bend + spin * spin) * length_of(step, m);
    if (c->frames[step->frame].shifts) {
      acceleration += 2.0 * spin * g + second;
    } else {
      bend += second;
      spin += g;
    }
  }
  const double turn = bend + spin * spin;
  return (edge_half_bound){.acceleration = above(0.5 * (acceleration + turn * length_of(&r->last, m))),
                           .turn = above(0.5 * turn)};
}

/* ---- parts ---- */

/* Places of a part are off by this, and so is what moves in half of the longest interval; two parts add theirs. */
static double room_of(const edge_part *part, const edge_motion *m, double reach, double spin, double world) {
  const edge_frame_bound *b = &m->bounds[part->frame];
  const double u = EDGE_U, s = part->reach_of_centre;
  const double place =
      b->place_error + (b->turn_error + ROUND_PRODUCT * u) * s + ROUND_APART * u * (b->reach + s) + ROUND_WORLD * world;
  const double speed = b->speed_error + b->spin_error * (s + (double)part->core + 2.0 * reach) + spin * place +
                       16.0 * u * spin * reach + 3.0 * u * b->speed +
                       ROUND_ALONG * u * (b->speed + spin * (s + (double)part->core + 2.0 * reach));
  return EDGE_UP * (place + 2.0 * (double)EDGE_ROOT_HALF * speed) + EDGE_LEAST;
}

double edge_motion_reach(const cprox_edge_checker *c, const edge_motion *m, size_t part) {
  return m->bounds[c->parts[part].frame].reach + c->parts[part].farthest;
}

static void begin(edge_motion *m) {
  m->bounds[0] = (edge_frame_bound){.rate = 0.0};
  m->frames[0] = (edge_half_bound){0};
  m->stands = true, m->degree = 0;
}

static bool add_frame(const cprox_edge_checker *c, const edge_way *way, edge_motion *m, size_t i) {
  const edge_frame *f = &c->frames[i];
  if (!take_way(f, way, m, i)) return false;
  bound_frame(f, &m->bounds[f->parent], &m->bounds[i]);
  m->frames[i] = (edge_half_bound){above(0.5 * m->bounds[i].acceleration), above(0.5 * m->bounds[i].turn)};
  return true;
}

static bool finish(const cprox_edge_checker *c, edge_motion *m) {
  const double world = vec_norm(c->base);
  double reach = 0.0, spin = 0.0;
  for (size_t i = 0; i < c->n_parts; i++) {
    const edge_frame_bound *b = &m->bounds[c->parts[i].frame];
    reach = greater(edge_motion_reach(c, m, i), reach), spin = greater(b->spin, spin);
  }
  if (!(reach <= EDGE_REACH_MOST)) return false;
  for (size_t i = 0; i < c->n_parts; i++) m->room[i] = above(room_of(&c->parts[i], m, reach, spin, world));
  return true;
}

bool edge_motion_fill(const cprox_edge_checker *c, const double *from, const double *to, edge_motion *m) {
  begin(m);
  for (size_t i = 1; i < c->n_frames; i++) {
    const edge_way way = way_between(from[c->frames[i].variable], to[c->frames[i].variable]);
    if (!add_frame(c, &way, m, i)) return false;
  }
  return finish(c, m);
}

bool edge_motion_fill_along(const cprox_edge_checker *c, const cprox_motion *along, const motion_interval *over,
                            edge_motion *m) {
  begin(m);
  memset(m->more, 0, 2 * EDGE_POWERS * c->n_frames * sizeof *m->more); /* what is beyond a variable's own degree */
  for (size_t i = 1; i < c->n_frames; i++) {
    const edge_way way = way_along(along, c->frames[i].variable, over);
    if (!add_frame(c, &way, m, i)) return false;
  }
  return finish(c, m);
}

void edge_motion_relate(const cprox_edge_checker *c, const edge_motion *m) {
  for (size_t i = 0; i < c->n_relations; i++)
    m->relations[i] = m->stands ? (edge_half_bound){0} : bound_relation(c, &c->relations[i], m);
}

/* ---- errors of an execution ---- */

size_t edge_losses_size(const cprox_edge_checker *c) {
  return c->n_frames * (3 * sizeof(float) + sizeof(int32_t)) + (2 * c->n_parts + c->n_lane_pairs) * sizeof(float);
}

edge_losses edge_losses_in(const cprox_edge_checker *c, const query *q, size_t first, size_t last, char *memory) {
  const cprox_error_bounds *b = q->errors->bounds;
  const double scale = q->errors->scale;
  const vec3 origin = vec_sub(b->base_origin, c->base);
  const double rounded = EDGE_U * vec_norm(origin);
  edge_losses l = {
      .still = (float *)(void *)memory,
      .base_origin = {(float)origin.x, (float)origin.y, (float)origin.z},
      .base_rotation = above(scale * b->base_rotation),
      .object_rotation = above(scale * b->object_rotation),
      .places = above(scale * (b->base_position + b->base_rotation * rounded + b->object_position + b->sensor)),
      .flex = above(scale * b->flex)};
  l.by_rate = l.still + c->n_frames, l.most = l.by_rate + c->n_frames;
  l.slack = l.most + c->n_frames, l.standing = l.slack + c->n_parts, l.pairs = l.standing + c->n_parts;
  l.axis_of = (int32_t *)(void *)(l.pairs + c->n_lane_pairs);
  l.axis_of[0] = -1;
  for (size_t i = 0; i < q->mover.motion->robot->n_axes; i++)
    if (c->frame_of[i] > 0) l.axis_of[c->frame_of[i]] = (int32_t)i;
  double reach = 0.0, far = -INFINITY;
  for (size_t i = first; i < last; i++) {
    const double ends = obstacle_reach(&q->obstacles[i]);
    if (ends < INFINITY)
      reach = greater(ends, reach);
    else
      far = greater(vec_norm(vec_sub(q->obstacles[i].pose.position, c->base)), far);
  }
  l.object_reach = above(reach), l.object_far = above(far);
  return l;
}

static void bound_axis(const query *q, const motion_interval *over, size_t f, edge_losses *l) {
  const cprox_motion *m = q->mover.motion;
  const axis_error e = errors_of_axis_over(m, q->errors, l->axis_of[f], over);
  const double duration = (over->b - over->a) * (m->times[over->first + 1] - m->times[over->first]);
  const bool by_rate = duration > 0.0 && e.by_speed < 1e18 * duration; /* else it is off by the most at all times */
  l->most[f] = above(e.most);
  l->still[f] = by_rate ? above(e.still) : l->most[f];
  l->by_rate[f] = by_rate ? above(e.by_speed / duration) : 0.0f;
}

/* A part is in a ball about an axis, anywhere on the edge. */
static double loss_of_axis(const cprox_edge_checker *c, const edge_motion *edge, const edge_losses *l,
                           const edge_part *part, int32_t f) {
  const double arm = edge->bounds[part->frame].reach - edge->bounds[f].reach + part->farthest;
  return (double)l->most[f] * (c->frames[f].shifts ? 1.0 : arm + ROUND_WORLD * edge->bounds[part->frame].reach);
}

static double standing_loss(const cprox_edge_checker *c, const edge_motion *edge, const edge_losses *l, size_t i) {
  const edge_part *part = &c->parts[i];
  const float *o = l->base_origin;
  const double reach = edge_motion_reach(c, edge, i) + (double)l->slack[i];
  double off = (double)l->places + (part->frame > 0 ? (double)l->flex : 0.0) +
               (double)l->base_rotation * (reach + vec_norm(vec((double)o[0], (double)o[1], (double)o[2])));
  for (int32_t f = part->frame; f > 0; f = c->frames[f].parent) off += loss_of_axis(c, edge, l, part, f);
  return off + (double)l->object_rotation * greater((double)l->object_reach, (double)l->object_far + reach + off);
}

static double pair_loss(const cprox_edge_checker *c, const edge_motion *edge, const edge_losses *l,
                        const edge_pair *pair) {
  const edge_part *one = &c->parts[pair->a], *other = &c->parts[pair->b];
  double off = (double)l->flex * ((one->frame > 0) + (other->frame > 0));
  for (int32_t f = one->frame, g = other->frame; f != g;) {
    if (f > g)
      off += loss_of_axis(c, edge, l, one, f), f = c->frames[f].parent;
    else
      off += loss_of_axis(c, edge, l, other, g), g = c->frames[g].parent;
  }
  return off;
}

void edge_losses_over(const query *q, const cprox_edge_checker *c, const motion_interval *over, const edge_motion *edge,
                      edge_losses *l) {
  for (size_t f = 1; f < c->n_frames; f++) bound_axis(q, over, f, l);
  for (size_t i = 0; i < c->n_parts; i++) {
    const edge_part *part = &c->parts[i];
    l->slack[i] =
        above(EDGE_PLACE * part->farthest + ROUND_ARM * (double)edge->room[i] + ROUND_WORLD * vec_norm(c->base));
    l->standing[i] = above(ROUND_UP * standing_loss(c, edge, l, i));
  }
  for (size_t i = 0; i < c->n_lane_pairs; i++) l->pairs[i] = above(ROUND_UP * pair_loss(c, edge, l, &c->lane_pairs[i]));
}
