/* SPDX-License-Identifier: BSD-3-Clause */
/* For each segment of the motion a tree of intervals, cut in halves. On each, every pair that is still open is tried
 * with the last direction that the certificate gave for it, and with one that follows from its place: from the box
 * round what stands to the centre of what moves. What neither settles is open on both halves; an interval that is not
 * cut must settle all.
 *
 * A direction n, fixed in what stands, settles a pair if in the middle its plane parts the two by more than delta and
 * the way that points of the moving body may take (first order), or if the second or third order expansion of n·x over
 * the interval stays above delta. */
#include "robot_check.h"

#include <stdlib.h>

#include "kinematics.h"
#include "span.h"
#include "trajectory.h"

enum { MAX_DEPTH = 64 };

/* Of a direction: far from where squares underflow or overflow. */
#define SHORTEST 0x1p-100
#define LONGEST 0x1p100

typedef struct walk {
  robot *r;
  reader *in;
  uint32_t width;
  double delta;
  size_t degree, *tries;
  axis_state *states;
  place *places; /* of the bodies */
  int *chain;
  double *levers;

  /* the motion that was found last on this interval: pairs that differ in a body that stands share it */
  const body *mover;
  int seen_from; /* axis */
  body_motion motion;
} walk;

/* A pair over the interval, seen from what stands. */
typedef struct view {
  const body *moving, *standing;
  const place *at, *from;
  double pad; /* both margins */
  vec apart;  /* of the centres */
  const body_motion *motion;
} view;

/* min d·(x - centre) over the moving body, without margin. */
static num lowest(const view *v, const vec *d) {
  vec down = rot_turn(&v->at->r, d, true);
  for (int k = 0; k < 3; k++) down.m[k] = -down.m[k];
  return num_neg(span_along(v->moving->shape, v->moving->radius, &down));
}

/* f - rest |n| > delta |n| + the margins, whose share of n·x depends on what d is: |d| <= length. */
static bool is_beyond(num f, double rest) {
  return num_bottom(f) > rest;
}

static bool settles(const walk *w, const view *v, const double own[3]) {
  const vec n_own = vec_of(own), n = rot_turn(&v->from->r, &n_own, false);
  const double size = vec_top(&n_own), moving_pad = v->moving->shape->margin, standing_pad = v->standing->shape->margin;
  const num start = num_sub(vec_dot(&n, &v->apart), span_along(v->standing->shape, v->standing->radius, &n_own));
  const double limit = GROW((w->delta + standing_pad) * size);
  ++*w->tries;
  if (!(size > SHORTEST && size < LONGEST)) return false;

  /* in the middle, and the way from there */
  const double padded = GROW(limit + moving_pad * size);
  const num middle = num_add(start, lowest(v, &n));
  if (!is_beyond(middle, padded)) return false;
  if (is_beyond(middle, GROW(padded + v->motion->travel * size))) return true;

  /* both ends of tau; then the corners of (tau, tau²) */
  const body_motion *m = v->motion;
  const vec turn = vec_cross(&n, &m->omega), twist = vec_cross(&n, &m->alpha);
  const vec inwards = vec_scale(vec_dot(&m->omega, &n), &m->omega),
            outwards = vec_scale(vec_dot(&m->omega, &m->omega), &n);
  vec bend = vec_add(&twist, &inwards);
  bend = vec_sub(&bend, &outwards);
  const num along = vec_dot(&n, &m->v), faster = vec_dot(&n, &m->a);
  bool second = true, third = true;
  for (int end = 0; end < 2; end++) {
    const double tau = end == 0 ? -0.5 : 0.5;
    const vec d = vec_axpy(&n, tau, &turn), e = vec_axpy(&d, 0.125, &bend);
    const num there = num_add(start, num_mul(num_of(tau), along)), f = num_add(there, lowest(v, &d));
    const num g = num_add(num_add(there, num_mul(num_of(0.125), faster)), lowest(v, &e));
    const double below = GROW(limit + moving_pad * vec_top(&d)), beyond = GROW(limit + moving_pad * vec_top(&e));
    second = second && is_beyond(f, GROW(below + 0.125 * m->second * size));
    third = third && is_beyond(f, GROW(below + m->third * size / 48.0));
    third = third && is_beyond(g, GROW(beyond + m->third * size / 48.0));
    if (!second && !third) return false;
  }
  return true;
}

/* From the box round what stands to the centre of what moves, in the frame of what stands; a halfspace has its own
 * normal. */
static void default_normal(const view *v, double n[3]) {
  const vec y = rot_turn(&v->from->r, &v->apart, true);
  for (int k = 0; k < 3; k++) {
    const double from = y.m[k] - v->standing->middle[k], half = v->standing->half[k];
    n[k] = v->standing->shape->kind == HALFSPACE ? v->standing->shape->size[k]
           : from > half                         ? from - half
           : from < -half                        ? from + half
                                                 : 0.0;
  }
}

/* The last direction given, then the one that needs not be given. */
static bool is_settled(walk *w, const pair *p) {
  const body *bodies = w->r->bodies;
  view v = {.moving = &bodies[p->moving], .standing = &bodies[p->standing]};
  v.at = &w->places[p->moving], v.from = &w->places[p->standing];
  v.apart = vec_sub(&v.at->p, &v.from->p);
  v.motion = &w->motion;
  if (w->mover != v.moving || w->seen_from != v.standing->axis) {
    const double radius = GROW(v.moving->radius + v.moving->shape->margin);
    kinematics_motion(w->r, w->states, v.moving, v.at, radius, v.standing, w->chain, w->levers, &w->motion);
    w->mover = v.moving, w->seen_from = v.standing->axis;
  }
  double n[3];
  default_normal(&v, n);
  const bool flat = v.standing->shape->kind == HALFSPACE;
  return (p->given && !flat && settles(w, &v, p->normal)) || settles(w, &v, n);
}

/* COUNT × {u16 pair, n[3]}: from here on these are the directions of those pairs. */
static const char *read_directions(const walk *w, size_t count) {
  for (size_t i = 0; i < count; i++) {
    const size_t index = (size_t)reader_bits(w->in, 2);
    double n[3];
    reader_normal(w->in, w->width, n);
    if (w->in->bad || index >= w->r->n_pairs) return "it is cut off, or it speaks of no pair of these";
    pair *p = &w->r->pairs[index];
    for (int k = 0; k < 3; k++) p->normal[k] = n[k];
    p->given = true;
  }
  return NULL;
}

/* One interval: `open` pairs, n of them; points are overwritten. NODE: u16 2 × COUNT + (1 where it is cut), the
 * directions, and where it is cut the left and the right half. */
static const char *check_interval(walk *w, num *points, const size_t *open, size_t n, int depth) {
  const robot *r = w->r;
  const size_t head = (size_t)reader_bits(w->in, 2), room = r->n_variables * (ROBOT_MAX_DEGREE + 1);
  if (w->in->bad || depth > MAX_DEPTH) return "its tree is broken";
  const char *fault = read_directions(w, head / 2);
  if (fault) return fault;

  /* where nothing is open any more, what is left is read and not worked out */
  if (n == 0) {
    for (size_t half = 0; half < head % 2 * 2 && !fault; half++) fault = check_interval(w, points, open, 0, depth + 1);
    return fault;
  }
  kinematics_axes(r, w->degree, points, w->states);
  w->mover = NULL;
  for (size_t i = 0; i < r->n_bodies; i++) w->places[i] = kinematics_place(&r->bodies[i], w->states);
  size_t *left_open = malloc((n + 1) * sizeof *left_open), kept = 0;
  num *left = malloc((room + 1) * sizeof *left);
  if (!left_open || !left) fault = "memory is out";
  for (size_t i = 0; i < n && !fault; i++) {
    if (is_settled(w, &r->pairs[open[i]])) continue;
    left_open[kept++] = open[i];
    if (head % 2 == 0) fault = "a pair is not settled on an interval";
  }
  if (!fault && head % 2 == 1) {
    for (size_t v = 0; v < r->n_variables; v++)
      if (r->moved[v])
        trajectory_halve(points + v * (ROBOT_MAX_DEGREE + 1), w->degree, left + v * (ROBOT_MAX_DEGREE + 1));
    fault = check_interval(w, left, left_open, kept, depth + 1);
    if (!fault) fault = check_interval(w, points, left_open, kept, depth + 1);
  }
  free(left_open);
  free(left);
  return fault;
}

const char *robot_apart(robot *r, reader *in, uint32_t width, double delta, size_t *tries) {
  walk w = {.r = r, .in = in, .width = width, .delta = delta, .tries = tries};
  const size_t room = r->n_variables * (ROBOT_MAX_DEGREE + 1);
  w.states = malloc((r->n_axes + 1) * sizeof *w.states);
  w.places = malloc((r->n_bodies + 1) * sizeof *w.places);
  w.chain = malloc((r->n_axes + 1) * sizeof *w.chain);
  w.levers = malloc((r->n_axes + 1) * sizeof *w.levers);
  num *points = malloc((room + 1) * sizeof *points);
  size_t *all = malloc((r->n_pairs + 1) * sizeof *all);
  const char *fault = w.states && w.places && w.chain && w.levers && points && all ? NULL : "memory is out";
  for (size_t i = 0; i < r->n_pairs && !fault; i++) {
    all[i] = i;
    r->pairs[i].given = false;
  }
  for (size_t s = 0; s < r->n_segments && !fault; s++) {
    w.degree = r->degrees[s];
    for (size_t i = 0; i < room; i++) points[i] = robot_points(r, s, 0)[i];
    fault = check_interval(&w, points, all, r->n_pairs, 0);
  }
  free(w.states);
  free(w.places);
  free(w.chain);
  free(w.levers);
  free(points);
  free(all);
  return fault;
}
