/* SPDX-License-Identifier: BSD-3-Clause */
/* Random robots on random motions among random bodies, and gradients of their clearance, depth or growth distance
 * against central differences of the certified value. Uses the workspace of builders.h. */
#ifndef CPROX_TEST_GRADIENT_CASE_H
#define CPROX_TEST_GRADIENT_CASE_H

#include <stdbool.h>

#include "base/vec.h"
#include "curve_proximity/cprox.h"
#include "support/random.h"
#include "support/robots.h"

/* Of 1 + |derivative|: what a derivative may differ from a difference. */
#define GRADIENT_TOLERANCE 1e-6

enum { GRADIENT_TARGETS = 3 };

typedef struct gradient_case {
  test_robot robot;
  cprox_obstacle targets[GRADIENT_TARGETS];
  cprox_mover_kind kind;
  bool indexed, is_signed;
  bool growth;                  /* of the growth distance instead: without margins */
  const cprox_robot_pair *pair; /* asked about alone, between two breaks; NULL: all pairs, all the time */
  double breaks[2];
} gradient_case;

typedef struct gradient_answer {
  cprox_result result;
  cprox_motion_gradient gradient;
  double variables[TEST_MAX_VARIABLES];
  double rows[3][TEST_WAYPOINTS * TEST_MAX_VARIABLES];
} gradient_answer;

/* One direction in the space of all parameters. */
typedef struct gradient_step {
  double rows[3][TEST_WAYPOINTS][TEST_MAX_VARIABLES];
  double stretch, margin;
  vec3 base, base_turn, position, turn;
} gradient_step;

/* A derivative beside four central differences with one extrapolation each. */
typedef struct gradient_fit {
  double off;        /* how far it is from what the nearest of those are known to be; infinite: none is known well */
  double kink;       /* how much the slopes to either side differ, where distances are known well enough */
  double least_kink; /* the same of all differences */
  double one_sided;  /* how far it is from the nearer one of these */
  bool is_known;     /* one of them within a tenth of the tolerance: distances are intervals */
} gradient_fit;

typedef enum gradient_verdict {
  GRADIENT_NOT_ASKED,  /* nearer than 0.01 to contact, or nothing to measure */
  GRADIENT_FITS,       /* valid, and within the tolerance */
  GRADIENT_BESIDE_TIE, /* valid, and that of one side of a tie which is nearer than the differences reach */
  GRADIENT_TIED,       /* not valid, and the slopes to either side differ by 1e-4, or the distance is attained again */
  GRADIENT_MISSING,    /* not valid, without such a tie */
  GRADIENT_UNKNOWN,    /* the distance is not known well enough to tell */
  GRADIENT_WRONG
} gradient_verdict;

typedef struct gradient_judgement {
  gradient_answer answer;
  double expected, off; /* the derivative; how far off, as a fraction of 1 + |expected| */
  gradient_fit fit;
  char why[160]; /* it is not valid */
} gradient_judgement;

/* Random; signed ones overlap more often and have no meshes. */
void gradient_case_make(rng *r, bool is_signed, gradient_case *p);
void gradient_case_free(gradient_case *p);

/* The middle of the distance's interval, and with an answer its gradient. Without one the interval is as narrow as
 * arithmetic allows. */
double gradient_case_ask(const gradient_case *p, gradient_answer *a);

/* The least growth distance of all pairs at one time, by kinematics in long double. */
double gradient_case_growth_at(const gradient_case *p, double t);

gradient_step gradient_step_random(rng *r, const gradient_case *p);

/* The derivative along the step, by the gradient. */
double gradient_derivative(const gradient_case *p, const gradient_answer *a, const gradient_step *d);

/* Differences along the step beside the derivative that was expected. */
gradient_fit gradient_compare(const gradient_case *p, const gradient_answer *a, const gradient_step *d,
                              double expected);

/* Asks for the gradient, and compares it along a random step. */
gradient_verdict gradient_case_judge(rng *r, const gradient_case *p, gradient_judgement *j);

#endif
