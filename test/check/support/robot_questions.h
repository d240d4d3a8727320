/* SPDX-License-Identifier: BSD-3-Clause */
/* Questions about robots as text, and random ones with bodies of every kind that certificates know. */
#ifndef CHECK_TEST_ROBOT_QUESTIONS_H
#define CHECK_TEST_ROBOT_QUESTIONS_H

#include <stdio.h>

#include "check.h"
#include "curve_proximity/cprox.h"
#include "support/questions.h"
#include "support/robots.h"

enum {
  ROBOT_QUESTION_MOST = 64,
  ROBOT_QUESTION_TARGETS = 4,
  ROBOT_QUESTION_BODIES = TEST_MAX_LINKS + ROBOT_QUESTION_TARGETS,
  ROBOT_QUESTION_LOOSE = 2 * ROBOT_QUESTION_BODIES
};

typedef struct robot_question {
  test_robot robot;
  cprox_target targets[ROBOT_QUESTION_TARGETS];
  size_t n;
  cprox_body *loose[ROBOT_QUESTION_LOOSE]; /* what unions are made of */
  size_t n_loose;
  question_mesh mesh[ROBOT_QUESTION_BODIES]; /* their bodies are those of links and targets */
  size_t n_meshes;
  cprox_mover mover; /* along, or against itself */
} robot_question;

/* speed: as robot_make(). apart: how far the targets are from the robot's base [m]. meshes: a third of the bodies. */
void robot_question_random(robot_question *q, rng *r, double speed, double apart, bool meshes, cprox_workspace *ws);
void robot_question_free(robot_question *q);

/* The head and the targets; then a robot. */
void robot_write_targets(const cprox_target *targets, size_t n, FILE *out);
void robot_write_mover(const cprox_mover *along, const cprox_target *targets, size_t n, const char *id,
                       cprox_workspace *ws, FILE *out);

/* A question that the checker has read. */
typedef struct robot_text {
  problem read;
  FILE *file;
} robot_text;

robot_text robot_text_of(const cprox_mover *along, const cprox_target *targets, size_t n, cprox_workspace *ws);
finding robot_text_check(const robot_text *text, const void *bytes, size_t size);
void robot_text_free(robot_text *text);

#endif
