/* SPDX-License-Identifier: BSD-3-Clause */
#define _POSIX_C_SOURCE 200809L
#include "problem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_DEGREE = 60 };

/* The words of a line, one after the other; once one is missing or wrong all that follow are. */
typedef struct words {
  char *rest;
  bool wrong;
} words;

static const char *word(words *w) {
  const char *found = w->wrong ? NULL : strtok_r(NULL, " \t\r\n", &w->rest);
  if (!found) w->wrong = true;
  return found ? found : "";
}

static double number(words *w) {
  const char *text = word(w);
  char *end;
  const double x = strtod(text, &end);
  if (end == text || *end || !isfinite(x)) w->wrong = true;
  return x;
}

/* A count of things that take at least two characters each. */
static size_t count(words *w) {
  const char *text = word(w);
  char *end;
  const unsigned long n = strtoul(text, &end, 10);
  if (end == text || *end || *text == '-') w->wrong = true;
  if (!w->wrong && n > strlen(w->rest) / 2 + 1) w->wrong = true;
  return w->wrong ? 0 : n;
}

static void numbers(words *w, size_t n, double *x) {
  for (size_t i = 0; i < n; i++) x[i] = number(w);
}

/* n things of the size, all 0. */
static void *room(words *w, size_t n, size_t size) {
  void *memory = calloc(n ? n : 1, size);
  if (!memory) w->wrong = true;
  return memory;
}

static size_t choose(words *w, const char *const *names, size_t n) {
  const char *name = word(w);
  for (size_t i = 0; i < n; i++)
    if (strcmp(name, names[i]) == 0) return i;
  w->wrong = true;
  return 0;
}

/* ---- curves ------------------------------------------------------------------------------------------------------------- */

/* Points and knots as many as the basis needs, the range inside the domain. */
static bool curve_fits(const curve *c) {
  if (c->degree > MAX_DEGREE || !(c->t0 < c->t1)) return false;
  if (c->basis == BSPLINE) {
    if (c->degree < 1 || c->n <= c->degree || c->n_knots != c->n + c->degree + 1) return false;
    for (size_t i = 1; i < c->n_knots; i++)
      if (!(c->knots[i - 1] <= c->knots[i])) return false;
    return c->knots[c->degree] <= c->t0 && c->t1 <= c->knots[c->n];
  }
  if (c->basis == TRIGONOMETRIC) return c->degree >= 1 && c->n == 2 * c->degree + 1 && c->n_knots == 0;
  if (c->n != c->degree + 1) return false;
  if (c->basis != LAGRANGE) return c->n_knots == 0;
  for (size_t i = 0; i < c->n; i++)
    for (size_t j = 0; j < i; j++)
      if (c->n_knots != c->n || c->knots[i] == c->knots[j]) return false;
  return c->n_knots == c->n;
}

/* BASIS DEGREE T0 T1 N x y z … K knot … */
static void read_curve(words *w, curve *c) {
  static const char *const names[] = {"bezier", "bspline", "polynomial", "legendre", "lagrange", "trigonometric"};
  c->basis = (basis)choose(w, names, 6);
  c->degree = count(w);
  c->t0 = number(w);
  c->t1 = number(w);
  c->n = count(w);
  c->points = room(w, c->n, sizeof *c->points);
  for (size_t i = 0; i < c->n && !w->wrong; i++) numbers(w, 3, c->points[i]);
  c->n_knots = count(w);
  c->knots = room(w, c->n_knots, sizeof *c->knots);
  if (!w->wrong) numbers(w, c->n_knots, c->knots);
  if (!w->wrong && !curve_fits(c)) w->wrong = true;
}

static void free_curve(curve *c) {
  free(c->points);
  free(c->knots);
  *c = (curve){0};
}

/* ---- targets ------------------------------------------------------------------------------------------------------------ */

static void read_set(words *w, set *s) {
  static const char *const names[] = {"point", "sphere",    "box",       "capsule",  "cylinder",
                                      "cone",  "ellipsoid", "halfspace", "polytope", "curve"};
  static const size_t sizes[] = {0, 1, 3, 2, 2, 2, 3, 4, 0, 0};
  s->padding = number(w);
  s->n_poses = count(w);
  if (!(s->padding >= 0.0) || s->n_poses > 2) w->wrong = true;
  for (size_t i = 0; i < s->n_poses && !w->wrong; i++) {
    numbers(w, 3, s->poses[i].x);
    numbers(w, 4, s->poses[i].q);
    const double *q = s->poses[i].q;
    if (q[0] == 0.0 && q[1] == 0.0 && q[2] == 0.0 && q[3] == 0.0) w->wrong = true;
  }
  s->kind = (kind)choose(w, names, 10);
  numbers(w, sizes[s->kind], s->size);
  for (size_t i = 0; s->kind != HALFSPACE && i < sizes[s->kind]; i++)
    if (!(s->size[i] >= 0.0)) w->wrong = true;
  if (s->kind == POINT || s->kind == POLYTOPE) numbers(w, 3, s->centre);
  if (s->kind == POLYTOPE) {
    s->n = count(w);
    if (s->n == 0) w->wrong = true;
    s->vertices = room(w, s->n, sizeof *s->vertices);
    for (size_t i = 0; i < s->n && !w->wrong; i++) numbers(w, 3, s->vertices[i]);
  }
  if (s->kind == CURVE) read_curve(w, &s->curve);
}

/* ---- lines -------------------------------------------------------------------------------------------------------------- */

/* The first word of the next line that is not empty, or NULL. */
static const char *next_line(problem *p, words *w) {
  const char *found = NULL;
  w->wrong = false;
  while (!found) {
    if (getline(&p->line, &p->capacity, p->in) < 0) return NULL;
    p->number++;
    found = strtok_r(p->line, " \t\r\n", &w->rest);
  }
  return found;
}

/* Nothing was wrong, and nothing is left. */
static bool line_is_good(problem *p, words *w) {
  if (!w->wrong && strtok_r(NULL, " \t\r\n", &w->rest)) w->wrong = true;
  if (w->wrong) snprintf(p->fault, sizeof p->fault, "line %zu of the problem is not understood", p->number);
  return !w->wrong;
}

static void free_sets(problem *p) {
  for (size_t i = 0; i < p->n_sets; i++) {
    free(p->sets[i].vertices);
    free_curve(&p->sets[i].curve);
  }
  free(p->sets);
  p->sets = NULL;
  p->n_sets = 0;
}

bool problem_open(problem *p, FILE *in) {
  *p = (problem){.in = in};
  words w = {0};
  const char *first = next_line(p, &w);
  if (!first || strcmp(first, "cprox-problem") != 0 || number(&w) != 1.0) w.wrong = true;
  return line_is_good(p, &w);
}

/* The N lines of targets, "targets" being read. */
static bool read_sets(problem *p, words *w) {
  const double n = number(w);
  if (!(n >= 0.0 && n <= 1e7 && n == floor(n))) w->wrong = true;
  if (!line_is_good(p, w)) return false;
  free_sets(p);
  p->sets = room(w, (size_t)n, sizeof *p->sets);
  while (!w->wrong && p->n_sets < (size_t)n) {
    const char *first = next_line(p, w);
    if (!first || strcmp(first, "target") != 0) w->wrong = true;
    read_set(w, &p->sets[p->n_sets++]);
    if (!line_is_good(p, w)) return false;
  }
  return !w->wrong;
}

bool problem_next(problem *p) {
  words w = {0};
  free_curve(&p->mover.curve);
  const char *first = next_line(p, &w);
  while (first && strcmp(first, "targets") == 0) {
    if (!read_sets(p, &w)) return false;
    first = next_line(p, &w);
  }
  if (!first) return false;
  p->mover.none = strcmp(first, "none") == 0;
  if (!p->mover.none && strcmp(first, "mover") != 0) w.wrong = true;
  snprintf(p->mover.id, sizeof p->mover.id, "%s", word(&w));
  if (!p->mover.none) {
    p->mover.radius = number(&w);
    if (!(p->mover.radius >= 0.0)) w.wrong = true;
    read_curve(&w, &p->mover.curve);
  }
  return line_is_good(p, &w);
}

void problem_close(problem *p) {
  free_sets(p);
  free_curve(&p->mover.curve);
  free(p->line);
  *p = (problem){0};
}
