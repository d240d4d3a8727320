/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/implicit_problems.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/frame.h"
#include "shape/body.h"

static cprox_body *make(const cprox_implicit_description *description) {
  cprox_workspace *workspace = cprox_workspace_create();
  cprox_body *body = NULL;
  if (cprox_body_create_implicit(description, NULL, workspace, &body) != CPROX_OK) {
    fprintf(stderr, "%s\n", cprox_workspace_error(workspace));
    exit(1);
  }
  cprox_workspace_free(workspace);
  return body;
}

static cprox_body *superquadric(vec3 semi_axes, vec3 exponents) {
  cprox_body *body = NULL;
  if (cprox_body_create_superquadric(semi_axes, exponents, NULL, &body) != CPROX_OK) exit(1);
  return body;
}

cprox_body *implicit_object(int object) {
  static const double mouse[3][5] = {{0.5, 0, 0, 0, 23.0 / 11}, {0, 1, 0, 0, 11.0 / 5}, {0, 0, 1 / 1.7, 0, 17.0 / 7}};
  static const double cuts[4][4] = {{-1, 0, 0, -0.5}, {1, 0, 0, -0.5}, {0, -1, 0, -0.75}, {0, 0, -1, 0.4}};
  static const double nut[4][5] = {{0, 1, 0, 0, 16}, {1, 0.5, 0, 0, 16}, {1, -0.5, 0, 0, 16}, {0, 0, 2.5, 0, 2}};
  static const double pyramid[5][5] = {
      {1, 0, 1, 0, 16}, {0, 1, 1, 0, 16}, {0, 0, 1, 0, 16}, {1, 0, -1, 0, 16}, {0, 1, -1, 0, 16}};
  const cprox_hyperquadric list[3] = {{mouse, 3}, {nut, 4}, {pyramid, 5}};
  cprox_implicit_description d = {.n_hyperquadrics = 1};
  switch (object) {
    case 1: return superquadric(vec(1, 0.7, 1.5), vec(4.0 / 3, 7.0 / 5, 15.0 / 13));
    case 2: return superquadric(vec(1, 1, 1.7), vec(23.0 / 11, 11.0 / 5, 179.0 / 13));
    case 3: return superquadric(vec(1, 1, 1.5), vec(76.0 / 9, 71.0 / 5, 179.0 / 13));
    case 4: d.planes = cuts, d.n_planes = 4, d.hyperquadrics = &list[0]; return make(&d);
    case 5: d.hyperquadrics = &list[1]; return make(&d);
    default: d.hyperquadrics = &list[2]; return make(&d);
  }
}

void implicit_problem_place(implicit_problem *p, cprox_pose pose) {
  const frame f = frame_create(&pose, vec(0, 0, 0));
  p->pose = pose;
  p->query = (implicit_query){.a = p->a->shape.implicit, .b = p->b->shape.implicit};
  for (int i = 0; i < 9; i++) p->query.m[i] = f.r[i];
  p->query.t = vec_sub(frame_to_world(&f, p->b->centre), p->a->centre);
}

implicit_problem *implicit_problems_make(const cprox_body *a, const cprox_body *b, double near, double far,
                                         uint64_t seed, size_t n) {
  rng r = rng_seed(seed);
  implicit_problem *problems = calloc(n, sizeof *problems);
  void *memory = malloc(implicit_memory(a->shape.implicit, b->shape.implicit));
  if (!problems || !memory) exit(1);
  for (size_t i = 0; i < n;) {
    implicit_problem *p = &problems[i];
    *p = (implicit_problem){.a = a, .b = b};
    const vec3 position = vec_scale(rng_uniform(&r, near, far), rng_unit(&r));
    implicit_problem_place(p, (cprox_pose){.position = position, .orientation = rng_quat(&r)});
    const implicit_goal goal = {.epsilon = 1e-6, .max_steps = 2000};
    implicit_answer answer;
    implicit_solve(&p->query, &goal, NULL, memory, &answer);
    i += answer.lower > 1e-3;
  }
  free(memory);
  return problems;
}

double *implicit_problems_truth(const implicit_problem *problems, size_t n) {
  double *truth = malloc(n * sizeof *truth);
  void *memory = malloc(implicit_memory(problems->query.a, problems->query.b));
  if (!truth || !memory) exit(1);
  for (size_t i = 0; i < n; i++) {
    const implicit_goal goal = {.relative_epsilon = 1e-11, .max_steps = 2000};
    implicit_answer answer;
    implicit_solve(&problems[i].query, &goal, NULL, memory, &answer);
    truth[i] = 0.5 * (answer.lower + answer.upper);
  }
  free(memory);
  return truth;
}

cprox_body *implicit_body_of_many(implicit_many kind, size_t n, uint64_t seed) {
  rng r = rng_seed(seed);
  double(*planes)[4] = calloc(n, sizeof *planes), (*quadrics)[10] = calloc(n + 1, sizeof *quadrics);
  double(*terms)[5] = calloc(3 * n, sizeof *terms);
  cprox_hyperquadric *lists = calloc(n, sizeof *lists);
  for (size_t i = 0; i < n; i++) {
    const vec3 u = rng_unit(&r);
    vec3 e, f;
    implicit_across(u, &e, &f);
    planes[i][0] = u.x, planes[i][1] = u.y, planes[i][2] = u.z, planes[i][3] = -1;

    /* a ball of radius 4 about -3u */
    double *q = quadrics[i];
    q[0] = q[3] = q[5] = 1;
    q[6] = 6 * u.x, q[7] = 6 * u.y, q[8] = 6 * u.z, q[9] = 9 - 16;

    /* semi-axis 1 along u, 3 across */
    const vec3 rows[3] = {u, vec_scale(1.0 / 3, e), vec_scale(1.0 / 3, f)};
    static const double exponents[3] = {2.5, 1.6, 7.0};
    for (int k = 0; k < 3; k++) {
      double *t = terms[3 * i + (size_t)k];
      t[0] = rows[k].x, t[1] = rows[k].y, t[2] = rows[k].z, t[4] = exponents[k];
    }
    lists[i] = (cprox_hyperquadric){.terms = (const double(*)[5])(terms + 3 * i), .n_terms = 3};
  }
  cprox_implicit_description d = {.quadrics = (const double(*)[10])quadrics,
                                  .n_quadrics = kind == MANY_QUADRICS ? n : 0};
  if (kind == MANY_PLANES) {
    double *ball = quadrics[0]; /* keeps a body of few planes bounded */
    ball[6] = ball[7] = ball[8] = 0, ball[9] = -1.3 * 1.3;
    d.n_quadrics = 1;
    d.planes = (const double(*)[4])planes;
    d.n_planes = n - 1;
  } else if (kind == MANY_SUPERQUADRICS) {
    d.hyperquadrics = lists;
    d.n_hyperquadrics = n;
  }
  cprox_body *body = make(&d);
  free(planes);
  free(quadrics);
  free(terms);
  free(lists);
  return body;
}

/* ---- reference files (test/data/README.md) ---- */

/* A body from `H:…|P:…|Q:…`. */
static cprox_body *read_body(const char *text) {
  static const size_t width[3] = {5, 4, 10};
  double numbers[3][256];
  size_t n[3] = {0, 0, 0}, lists = 0;
  cprox_hyperquadric list[8];
  while (*text) {
    const int kind = *text == 'H' ? 0 : *text == 'P' ? 1 : 2;
    const size_t first = n[kind];
    text++;
    while (*text == ':' && n[kind] < 256) {
      char *end;
      numbers[kind][n[kind]++] = strtod(text + 1, &end);
      text = end;
    }
    if (kind == 0 && lists < 8)
      list[lists++] = (cprox_hyperquadric){(const double(*)[5])(void *)&numbers[0][first], (n[0] - first) / 5};
    if (*text == '|') text++;
  }
  const cprox_implicit_description d = {.hyperquadrics = list,
                                        .n_hyperquadrics = lists,
                                        .planes = (const double(*)[4])(void *)numbers[1],
                                        .n_planes = n[1] / width[1],
                                        .quadrics = (const double(*)[10])(void *)numbers[2],
                                        .n_quadrics = n[2] / width[2]};
  return make(&d);
}

static cprox_pose read_pose(char **field) {
  double p[7];
  for (int i = 0; i < 7; i++) p[i] = strtod(field[i], NULL);
  return (cprox_pose){.position = {p[4], p[5], p[6]}, .orientation = {p[0], p[1], p[2], p[3]}};
}

/* b as a sees it. */
static cprox_pose relative(const cprox_pose *a, const cprox_pose *b) {
  const cprox_pose turned = {
      .orientation = {a->orientation.w, -a->orientation.x, -a->orientation.y, -a->orientation.z}};
  const cprox_pose moved = {.position = vec_sub(b->position, a->position), .orientation = b->orientation};
  return frame_compose(&turned, &moved);
}

size_t implicit_problems_read(const char *path, const char *tag, implicit_problem **problems, double **truth) {
  enum { MOST = 400, FIELDS = 22 };
  FILE *file = fopen(path, "r");
  *problems = calloc(MOST, sizeof **problems);
  *truth = calloc(MOST, sizeof **truth);
  if (!file || !*problems || !*truth) exit(1);
  static char line[8192];
  size_t n = 0;
  while (n < MOST && fgets(line, sizeof line, file)) {
    char *field[FIELDS], *cursor = line;
    for (int i = 0; i < FIELDS; i++) {
      field[i] = cursor;
      cursor += strcspn(cursor, ",\n");
      if (*cursor) *cursor++ = '\0';
    }
    const double distance = strtod(field[21], NULL);
    if ((tag && strcmp(field[1], tag) != 0) || !(distance > 0.0)) continue;
    const cprox_pose a = read_pose(field + 6), b = read_pose(field + 13);
    implicit_problem *p = &(*problems)[n];
    *p = (implicit_problem){.a = read_body(field[4]), .b = read_body(field[5])};
    implicit_problem_place(p, relative(&a, &b));
    (*truth)[n++] = distance;
  }
  fclose(file);
  return n;
}
