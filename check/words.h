/* SPDX-License-Identifier: BSD-3-Clause */
/* The words of a line of a problem, one after the other; once one is missing or wrong all that follow are. */
#ifndef CHECK_WORDS_H
#define CHECK_WORDS_H

#include "problem.h"

typedef struct words {
  char *rest;
  bool wrong, starved; /* starved: memory was out */
} words;

/* The first word of the next line that is not empty, or NULL. */
const char *words_line(problem *p, words *w);

/* Nothing was wrong, and nothing is left; else a message stands in fault. */
bool words_end(problem *p, words *w);

/* The next line begins with the word. */
bool words_begin(problem *p, words *w, const char *first);

const char *words_next(words *w);

/* The next word where there is one, else NULL. */
const char *words_optional(words *w);

double words_number(words *w);
void words_numbers(words *w, size_t n, double *x);

/* A count of things that take at least two characters each of this line. */
size_t words_count(words *w);

/* A whole number from 0 to 1e7. */
size_t words_size(words *w);

/* Which of the names stands there. */
size_t words_choose(words *w, const char *const *names, size_t n);

/* n things of the size, all 0. */
void *words_room(words *w, size_t n, size_t size);

/* PADDING P POSE×P KIND SIZES; to be freed in any case. */
void words_set(words *w, set *s);
void set_free(set *s);

#endif
