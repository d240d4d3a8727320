/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>

#include "paper.h"

enum { MOST_DEPTH = 200 };

typedef struct subdivision {
  const paper_obstacle *obstacle;
  size_t degree;
  double epsilon;
  paper_answer *answer;
} subdivision;

/* Cuts the control points at s: `right` holds them on entry, and those of [s, 1] on return. */
static void cut(vec3 *left, vec3 *right, size_t degree, double s) {
  for (size_t level = 0; level <= degree; level++) {
    left[level] = right[0];
    for (size_t i = 0; i + level < degree; i++) right[i] = vec_lerp(right[i], right[i + 1], s);
  }
}

/* A point of the curve bounds the distance from above. */
static double see(const subdivision *d, vec3 point) {
  double unused;
  const double apart =
      paper_gjk(d->obstacle->vertex, d->obstacle->n, &point, 1, &unused, NULL, &d->answer->evaluations);
  d->answer->upper = fmin(d->answer->upper, apart);
  return apart;
}

static void visit(const subdivision *d, vec3 *points, int depth) {
  paper_answer *r = d->answer;
  double lower, at;
  r->nodes++;
  paper_gjk(d->obstacle->vertex, d->obstacle->n, points, d->degree + 1, &lower, &at, &r->evaluations);
  const bool over = depth == MOST_DEPTH || r->nodes >= PAPER_MAX_NODES;
  if (lower >= r->upper - d->epsilon || over) {
    r->ended = r->ended && !(over && lower < r->upper - d->epsilon);
    r->lower = fmin(r->lower, lower);
    return;
  }
  vec3 left[PAPER_MAX_DEGREE];
  cut(left, points, d->degree, fmin(fmax(at, 0.1), 0.9));
  see(d, points[0]);
  const bool right_first = see(d, points[d->degree]) < see(d, left[0]);
  visit(d, right_first ? points : left, depth + 1);
  visit(d, right_first ? left : points, depth + 1);
}

void paper_subdivide(const paper_bezier *bezier, const paper_obstacle *obstacle, double epsilon, paper_answer *answer) {
  *answer = (paper_answer){.lower = INFINITY, .upper = INFINITY, .ended = true};
  const subdivision d = {.obstacle = obstacle, .degree = bezier->degree, .epsilon = epsilon, .answer = answer};
  vec3 points[PAPER_MAX_DEGREE];
  for (size_t i = 0; i <= d.degree; i++) points[i] = bezier->points[i];
  see(&d, points[0]);
  see(&d, points[d.degree]);
  visit(&d, points, 0);
  answer->lower = fmin(answer->lower, answer->upper);
}
