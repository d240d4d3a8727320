/* SPDX-License-Identifier: BSD-3-Clause */
/* The constraints of one body as the interior point method sees them (doc/implicit.md): slacks, multipliers, and for
 * each lifted term |u|^p the variable t >= |u|^p with the pair of constraints +-u <= G(t) = t^(1/p). The lifted
 * variables are eliminated from Newton's system in closed form, so that a body adds a 3 x 3 matrix and a right-hand
 * side to it. */
#ifndef CPROX_IMPLICIT_BARRIER_H
#define CPROX_IMPLICIT_BARRIER_H

#include "implicit/implicit.h"

/* A constraint f <= 0: slack s = -f, multiplier l. */
typedef struct barrier_row {
  double s, l;
  vec3 g;             /* gradient of the part that is not lifted */
  double omega, beta; /* dl = omega (reduced·dz + beta) */
  vec3 reduced;       /* the gradient with the lifted variables eliminated */
  double ds, dl;
  double next; /* s at the trial point */
} barrier_row;

typedef struct barrier_term {
  bool lifted;
  double u;
  /* t, the slacks G -+ u of the pair and their multipliers; lifted terms only */
  double t, g, g1, s[2], l[2];
  double d, e, k[2], rho;
  double du, dt, ds[2], dl[2];
  double next_g; /* G at the trial point */
} barrier_term;

typedef struct barrier {
  const implicit *body;
  barrier_row *row;   /* planes, quadrics, powers */
  barrier_term *term; /* all terms of the powers */
  vec3 z, dz;         /* the point, strictly inside, and its step */
  const vec3 *axes;   /* three orthonormal ones that Newton's system is seen along; NULL: the coordinates' */
  vec3 along;         /* the step along them */
  vec3 next;          /* the trial point */
} barrier;

/* A vector along the barrier's axes. */
static inline vec3 barrier_seen(const barrier *b, vec3 v) {
  const vec3 *a = b->axes;
  return a ? vec(vec_dot(a[0], v), vec_dot(a[1], v), vec_dot(a[2], v)) : v;
}

/* A symmetric matrix (xx, xy, xz, yy, yz, zz), along the barrier's axes, and a vector that bodies add to. */
typedef struct barrier_system {
  double h[6];
  vec3 rhs;
} barrier_system;

/* What the multipliers say at the current point. */
typedef struct barrier_state {
  double products; /* sum of slack times multiplier */
  int32_t pairs;   /* how many */
  vec3 force;      /* sum of multiplier times gradient: cancels the objective's gradient in the end */
  double lifted;   /* largest residual in a lifted variable, times it */
} barrier_state;

/* Puts the body's point at z, slacks and multipliers mu/s at their start; terms with p < lift_below are lifted. False
 * where z is not strictly inside. */
bool barrier_begin(barrier *b, vec3 z, double mu, double lift_below);

barrier_state barrier_evaluate(const barrier *b);

/* Adds the body's part of Newton's system for the target product `target` of slack and multiplier. */
void barrier_assemble(barrier *b, double target, barrier_system *system);

/* All steps from dz and along, and how long primal and dual ones may be before a slack or a multiplier is 0. */
void barrier_step(barrier *b, double target, double *primal, double *dual);

/* Tries the primal step of the length: false where a slack would fall below a fraction of what it is. */
bool barrier_try(barrier *b, double length);

/* Goes there, with the dual step of its own length, and keeps each product of slack and multiplier within [least,
 * most]. */
void barrier_go(barrier *b, double primal, double dual, double least, double most);

/* Which multipliers the bound on the support function takes: those of the lifted pairs where p < 2 or everywhere, or
 * the tangents of the constraints alone. */
typedef enum barrier_reading { BARRIER_MIXED, BARRIER_LIFTED, BARRIER_TANGENT } barrier_reading;

/* max of n·x over the body, from above whatever the multipliers are, rounding included: the multipliers times `share`
 * say how n splits over the constraints, and what is left of n costs its length times the radius. dual: receives the
 * multipliers that were taken in the end; or NULL. */
double barrier_height(const barrier *b, vec3 n, double share, barrier_reading reading, implicit_dual *dual);

#endif
