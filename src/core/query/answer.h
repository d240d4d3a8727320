/* SPDX-License-Identifier: BSD-3-Clause */
/* One question, one answer: the union of some of its targets, searched nearest ball first. */
#ifndef CPROX_QUERY_ANSWER_H
#define CPROX_QUERY_ANSWER_H

#include "query/candidates.h"

/* options NULL: the default. Nothing is checked. */
question question_create(cprox_mover mover, const cprox_target *targets, size_t n, double limit, bool farther_is_yes,
                         const cprox_options *options, cprox_workspace *workspace);

/* What a status above CPROX_OK means to the caller. */
const char *question_shortfall(cprox_status status);

/* The verdict that the result's interval gives; undecided for distances. */
cprox_verdict question_verdict(const question *q, const cprox_result *r);

/* Against nothing: infinitely far. */
cprox_result question_nothing(void);

/* Adds the answer against another set to the union's: the least of both ends, with the witness of the upper one. */
void question_join(cprox_result *all, const cprox_result *one);

/* Puts a result where it belongs among the k nearest so far, ascending by upper. */
void question_rank(cprox_result *nearest, size_t *count, size_t k, const cprox_result *r);

/* The union is complete: its status (`trouble` is the last that a search had), verdict and reason. */
cprox_status question_conclude(const question *q, double ceiling, cprox_status trouble, cprox_result *all);

/* The answer against the union of targets first … last - 1. Distances beyond `ceiling` are of no interest: the search ends when
 * lower has come that far, and upper is then infinity or any distance measured on the way. */
cprox_status question_answer(const question *q, size_t first, size_t last, double ceiling, cprox_result *result);

#endif
