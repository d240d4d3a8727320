/* SPDX-License-Identifier: BSD-3-Clause */
#include "problem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "interval.h"
#include "robot.h"
#include "winding.h"
#include "words.h"

enum { MAX_DEGREE = 60 };

const char *words_next(words *w) {
  const char *found = w->wrong ? NULL : strtok_r(NULL, " \t\r\n", &w->rest);
  if (!found) w->wrong = true;
  return found ? found : "";
}

const char *words_optional(words *w) {
  return w->wrong ? NULL : strtok_r(NULL, " \t\r\n", &w->rest);
}

double words_number(words *w) {
  const char *text = words_next(w);
  char *end;
  const double x = strtod(text, &end);
  if (end == text || *end || !isfinite(x)) w->wrong = true;
  return x;
}

size_t words_count(words *w) {
  const char *text = words_next(w);
  char *end;
  const unsigned long n = strtoul(text, &end, 10);
  if (end == text || *end || *text == '-') w->wrong = true;
  if (!w->wrong && n > strlen(w->rest) / 2 + 1) w->wrong = true;
  return w->wrong ? 0 : n;
}

void words_numbers(words *w, size_t n, double *x) {
  for (size_t i = 0; i < n; i++) x[i] = words_number(w);
}

void *words_room(words *w, size_t n, size_t size) {
  void *memory = calloc(n ? n : 1, size);
  if (!memory) w->wrong = w->starved = true;
  return memory;
}

size_t words_size(words *w) {
  const double n = words_number(w);
  if (!(n >= 0.0 && n <= 1e7 && n == floor(n))) w->wrong = true;
  return w->wrong ? 0 : (size_t)n;
}

size_t words_choose(words *w, const char *const *names, size_t n) {
  const char *name = words_next(w);
  for (size_t i = 0; i < n; i++)
    if (strcmp(name, names[i]) == 0) return i;
  w->wrong = true;
  return 0;
}

/* ---- curves ---- */

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
  c->basis = (basis)words_choose(w, names, 6);
  c->degree = words_count(w);
  c->t0 = words_number(w);
  c->t1 = words_number(w);
  c->n = words_count(w);
  c->points = words_room(w, c->n, sizeof *c->points);
  for (size_t i = 0; i < c->n && !w->wrong; i++) words_numbers(w, 3, c->points[i]);
  c->n_knots = words_count(w);
  c->knots = words_room(w, c->n_knots, sizeof *c->knots);
  if (!w->wrong) words_numbers(w, c->n_knots, c->knots);
  if (!w->wrong && !curve_fits(c)) w->wrong = true;
}

static void free_curve(curve *c) {
  free(c->points);
  free(c->knots);
  *c = (curve){0};
}

void set_free(set *s) {
  free(s->vertices);
  free(s->rows.planes);
  free(s->rows.quadrics);
  free(s->rows.terms);
  free(s->rows.sum_of);
  free_curve(&s->curve);
  free_curve(&s->ride);
  free_curve(&s->growth);
}

/* ---- obstacles ---- */

set set_group(const set *s, size_t begin, size_t end) {
  set group = *s;
  group.kind = s->kind == POINTS ? HULL : POLYTOPE;
  group.vertices = s->vertices + begin * s->corners;
  group.n = (end - begin) * s->corners;
  group.corners = 0;
  return group;
}

void set_box(const set *s, size_t begin, size_t end, double low[3], double high[3]) {
  for (int k = 0; k < 3; k++) low[k] = INFINITY, high[k] = -INFINITY;
  for (size_t i = begin * s->corners; i < end * s->corners; i++)
    for (int k = 0; k < 3; k++) {
      const double x = s->vertices[i][k];
      if (x < low[k]) low[k] = x;
      if (x > high[k]) high[k] = x;
    }
}

/* N elements: three corners of a triangle, a point, the two corners of a cell, which become eight. */
static void read_elements(words *w, set *s) {
  s->corners = s->kind == POINTS ? 1 : s->kind == CELLS ? 8 : 3;
  const size_t n = words_count(w);
  if (n == 0) w->wrong = true;
  s->vertices = words_room(w, w->wrong ? 1 : n, s->corners * sizeof *s->vertices);
  for (size_t i = 0; i < n && !w->wrong; i++) {
    double(*v)[3] = s->vertices + i * s->corners, ends[2][3];
    words_numbers(w, s->kind == CELLS ? 6 : 3 * s->corners, s->kind == CELLS ? ends[0] : v[0]);
    for (size_t k = 0; s->kind == CELLS && k < 24; k++) v[k / 3][k % 3] = ends[k / 3 >> k % 3 & 1][k % 3];
  }
  s->n = w->wrong ? 0 : n * s->corners;
  set_box(s, 0, set_elements(s), s->low, s->high);
  if (s->kind != SOLID || w->wrong) return;
  winding_edge *edges = words_room(w, s->n, sizeof *edges);
  if (!edges || !winding_is_closed(s, edges)) w->wrong = true;
  free(edges);
}

/* PLANES (4 numbers)×PLANES QUADRICS (10)×QUADRICS SUMS TERMS (sum, 5)×TERMS */
static void read_inequalities(words *w, inequalities *r) {
  r->n_planes = words_count(w);
  r->planes = words_room(w, r->n_planes, sizeof *r->planes);
  for (size_t i = 0; i < r->n_planes && !w->wrong; i++) words_numbers(w, 4, r->planes[i]);
  r->n_quadrics = words_count(w);
  r->quadrics = words_room(w, r->n_quadrics, sizeof *r->quadrics);
  for (size_t i = 0; i < r->n_quadrics && !w->wrong; i++) words_numbers(w, 10, r->quadrics[i]);
  r->n_sums = words_count(w);
  if (r->n_sums > IV_MOST) w->wrong = true;
  r->n_terms = words_count(w);
  r->terms = words_room(w, r->n_terms, sizeof *r->terms);
  r->sum_of = words_room(w, r->n_terms, sizeof *r->sum_of);
  for (size_t i = 0; i < r->n_terms && !w->wrong; i++) {
    r->sum_of[i] = words_size(w);
    words_numbers(w, 5, r->terms[i]);
    if (r->sum_of[i] >= r->n_sums || !(r->terms[i][4] >= 1.0)) w->wrong = true;
  }
}

void words_set(words *w, set *s) {
  static const char *const names[] = {"point",     "sphere",    "box",      "capsule", "cylinder", "cone",
                                      "ellipsoid", "halfspace", "polytope", "hull",    "implicit", "curve",
                                      "triangles", "solid",     "points",   "cells"};
  static const size_t sizes[] = {0, 1, 3, 2, 2, 2, 3, 4, 0, 1, 0, 0, 0, 0, 1, 0};
  s->margin = words_number(w);
  s->n_poses = words_count(w);
  if (!(s->margin >= 0.0) || s->n_poses > 2) w->wrong = true;
  for (size_t i = 0; i < s->n_poses && !w->wrong; i++) {
    words_numbers(w, 3, s->poses[i].x);
    words_numbers(w, 4, s->poses[i].q);
    const double *q = s->poses[i].q;
    if (q[0] == 0.0 && q[1] == 0.0 && q[2] == 0.0 && q[3] == 0.0) w->wrong = true;
  }
  s->kind = (kind)words_choose(w, names, sizeof names / sizeof *names);
  words_numbers(w, sizes[s->kind], s->size);
  for (size_t i = 0; s->kind != HALFSPACE && i < sizes[s->kind]; i++)
    if (!(s->size[i] >= 0.0)) w->wrong = true;
  const bool elements = s->kind > CURVE;
  const bool centred = s->kind == POINT || s->kind == POLYTOPE || s->kind == HULL || s->kind == IMPLICIT || elements;
  if (centred) words_numbers(w, 3, s->centre);
  if (s->kind == IMPLICIT) read_inequalities(w, &s->rows);
  if (s->kind == POLYTOPE || s->kind == HULL) {
    s->n = words_count(w);
    if (s->n == 0) w->wrong = true;
    s->vertices = words_room(w, s->n, sizeof *s->vertices);
    for (size_t i = 0; i < s->n && !w->wrong; i++) words_numbers(w, 3, s->vertices[i]);
  }
  if (s->kind == CURVE) read_curve(w, &s->curve);
  if (elements && !w->wrong) read_elements(w, s);
}

/* ---- lines ---- */

const char *words_line(problem *p, words *w) {
  const char *found = NULL;
  w->wrong = w->starved;
  p->first = NULL;
  while (!found) {
    if (getline(&p->line, &p->capacity, p->in) < 0) return NULL;
    p->number++;
    found = strtok_r(p->line, " \t\r\n", &w->rest);
  }
  p->first = found;
  return found;
}

bool words_end(problem *p, words *w) {
  if (words_optional(w)) w->wrong = true;
  if (w->starved)
    snprintf(p->fault, sizeof p->fault, "memory is out");
  else if (w->wrong && !p->first)
    snprintf(p->fault, sizeof p->fault, "the problem ends too early, after line %zu", p->number);
  else if (w->wrong)
    snprintf(p->fault, sizeof p->fault, "line %zu of the problem, '%.40s ...', is not understood", p->number, p->first);
  return !w->wrong;
}

static void free_sets(problem *p) {
  for (size_t i = 0; i < p->n_sets; i++) set_free(&p->sets[i]);
  free(p->sets);
  p->sets = NULL;
  p->n_sets = 0;
}

bool problem_open(problem *p, FILE *in) {
  *p = (problem){.in = in};
  words w = {0};
  const char *first = words_line(p, &w);
  if (!first) {
    snprintf(p->fault, sizeof p->fault, "the problem is empty: its first line is missing, 'cprox-problem 1'");
    return false;
  }
  if (strcmp(first, "cprox-problem") != 0 || words_number(&w) != 1.0 || words_optional(&w)) {
    snprintf(p->fault, sizeof p->fault, "line %zu of the problem must be 'cprox-problem 1'", p->number);
    return false;
  }
  return true;
}

bool words_begin(problem *p, words *w, const char *first) {
  const char *found = words_line(p, w);
  if (!found || strcmp(found, first) != 0) w->wrong = true;
  return !w->wrong;
}

static void read_once(words *w, curve *c) {
  if (curve_is_there(c))
    w->wrong = true;
  else
    read_curve(w, c);
}

/* [riding CURVE] [growing CURVE] [called NAME] */
static void read_more(words *w, set *s) {
  for (const char *word = words_optional(w); word; word = words_optional(w)) {
    if (strcmp(word, "riding") == 0)
      read_once(w, &s->ride);
    else if (strcmp(word, "growing") == 0)
      read_once(w, &s->growth);
    else if (strcmp(word, "called") == 0)
      snprintf(s->name, sizeof s->name, "%s", words_next(w));
    else
      w->wrong = true;
  }
}

/* The N lines of obstacles, "targets" being read. */
static bool read_sets(problem *p, words *w) {
  const size_t n = words_size(w);
  if (!words_end(p, w)) return false;
  free_sets(p);
  p->sets = words_room(w, n, sizeof *p->sets);
  if (w->wrong) return words_end(p, w);
  while (!w->wrong && p->n_sets < n) {
    words_begin(p, w, "target");
    set *s = &p->sets[p->n_sets++];
    words_set(w, s);
    read_more(w, s);
    if (!words_end(p, w)) return false;
  }
  return !w->wrong;
}

static void free_mover(mover *m) {
  free_curve(&m->curve);
  free_curve(&m->growth);
  for (size_t i = 0; i < m->n_carried; i++) set_free(&m->carried[i]);
  free(m->carried);
  m->carried = NULL;
  m->n_carried = 0;
  robot_forget(m->robot);
  m->robot = NULL;
}

/* [growing CURVE] [carrying N], and N lines `carried PADDING P POSE×P KIND SIZES`, convex and bounded. */
static bool read_load(problem *p, words *w, mover *m) {
  size_t n = 0;
  for (const char *word = words_optional(w); word; word = words_optional(w)) {
    if (strcmp(word, "growing") == 0)
      read_once(w, &m->growth);
    else if (strcmp(word, "carrying") == 0 && n == 0)
      n = words_size(w);
    else
      w->wrong = true;
  }
  if (!words_end(p, w)) return false;
  if (n == 0) return true;
  m->carried = words_room(w, n, sizeof *m->carried);
  while (!w->wrong && m->n_carried < n) {
    set *s = &m->carried[m->n_carried++];
    if (words_begin(p, w, "carried")) words_set(w, s);
    if (s->kind == HALFSPACE || s->kind >= IMPLICIT) w->wrong = true;
    if (!words_end(p, w)) return false;
  }
  return !w->wrong || words_end(p, w);
}

/* The line of a mover, its first word being read. */
static bool read_mover(problem *p, words *w, const char *first) {
  mover *m = &p->mover;
  const bool moves = strcmp(first, "robot") == 0;
  m->none = strcmp(first, "none") == 0;
  if (!m->none && !moves && strcmp(first, "mover") != 0) w->wrong = true;
  snprintf(m->id, sizeof m->id, "%s", words_next(w));
  if (moves) {
    m->robot = robot_read(p, w);
    return m->robot != NULL;
  }
  if (!m->none) {
    m->radius = words_number(w);
    if (!(m->radius >= 0.0)) w->wrong = true;
    read_curve(w, &m->curve);
    return read_load(p, w, m);
  }
  return words_end(p, w);
}

bool problem_next(problem *p) {
  words w = {0};
  free_mover(&p->mover);
  const char *first = words_line(p, &w);
  while (first && strcmp(first, "targets") == 0) {
    if (!read_sets(p, &w)) return false;
    first = words_line(p, &w);
  }
  return first && read_mover(p, &w, first);
}

void problem_close(problem *p) {
  free_sets(p);
  free_mover(&p->mover);
  free(p->line);
  *p = (problem){0};
}
