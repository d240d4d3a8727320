/* SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>

#include "paper.h"

/* ---- the hull of an interval (Theorem 1) ---- */

typedef struct hull {
  size_t n;
  vec3 vertex[PAPER_MAX_HULL];
} hull;

/* The points centre + x e + y f + z g of a circumscribed octagon, or of its counterpart with 16 vertices in space. */
static void surround(vec3 centre, vec3 e, double major, double minor, bool planar, hull *h) {
  const double k = 0.41421356237309503; /* tan(pi/8): the sides touch the circle */
  const vec3 aside = fabs(e.x) < 0.9 ? vec(1, 0, 0) : vec(0, 1, 0);
  vec3 f = planar ? vec(-e.y, e.x, 0) : vec_cross(e, aside);
  f = vec_scale(1.0 / vec_norm(f), f);
  const vec3 g = vec_cross(e, f);
  h->n = 0;
  for (int i = 0; i < 16; i++) {
    const double x = (i & 1 ? -1.0 : 1.0) * (i & 8 ? k : 1.0), y = (i & 2 ? -1.0 : 1.0) * (i & 8 ? 1.0 : k);
    const double z = (i & 4 ? -1.0 : 1.0) * (i & 8 ? 1.0 : k);
    if (planar && (i & 4)) continue;
    vec3 p = vec_axpy(vec_axpy(centre, major * x, e), minor * y, f);
    if (!planar) p = vec_axpy(p, minor * z, g);
    h->vertex[h->n++] = p;
  }
}

static void hull_of(const paper_curve *c, double a, double b, hull *h) {
  const vec3 p = c->point(c->self, a), q = c->point(c->self, b), chord = vec_sub(q, p);
  const double energy = c->energy(c->self, b) - c->energy(c->self, a), length = vec_norm(chord);
  const double u = energy > 0.0 ? sqrt((b - a) * energy) : 0.0;
  if (0.5 * (u - length) > DBL_EPSILON) {
    const vec3 e = length > 0.0 ? vec_scale(1.0 / length, chord) : vec(1, 0, 0);
    surround(vec_lerp(p, q, 0.5), e, 0.5 * u, 0.5 * sqrt(fmax(u * u - length * length, 0.0)), c->planar, h);
  } else {
    *h = (hull){.n = 2, .vertex = {p, q}};
  }
}

/* ---- best first ---- */

static void push(paper_node *heap, uint32_t *count, paper_node node) {
  uint32_t i = (*count)++;
  for (; i > 0 && heap[(i - 1) / 2].lower > node.lower; i = (i - 1) / 2) heap[i] = heap[(i - 1) / 2];
  heap[i] = node;
}

static paper_node pop(paper_node *heap, uint32_t *count) {
  const paper_node top = heap[0], last = heap[--*count];
  uint32_t i = 0;
  for (uint32_t child = 1; child < *count; child = 2 * i + 1) {
    if (child + 1 < *count && heap[child + 1].lower < heap[child].lower) child++;
    if (heap[child].lower >= last.lower) break;
    heap[i] = heap[child];
    i = child;
  }
  heap[i] = last;
  return top;
}

/* One side, or two. */
typedef struct problem {
  const paper_curve *curve[2]; /* the second NULL: an obstacle */
  const paper_obstacle *obstacle;
} problem;

/* Bounds over a node: GJK between hulls, and between the points at the middles. */
static double bound(const problem *p, paper_node *node, double upper, uint32_t *evaluations) {
  hull h[2];
  vec3 middle[2];
  for (int k = 0; k < 2 && p->curve[k]; k++) {
    hull_of(p->curve[k], node->a[k], node->b[k], &h[k]);
    middle[k] = p->curve[k]->point(p->curve[k]->self, 0.5 * (node->a[k] + node->b[k]));
  }
  double lower, unused;
  if (p->curve[1]) {
    paper_gjk(h[1].vertex, h[1].n, h[0].vertex, h[0].n, &lower, NULL, evaluations);
    upper = fmin(upper, vec_norm(vec_sub(middle[0], middle[1])));
  } else {
    paper_gjk(p->obstacle->vertex, p->obstacle->n, h[0].vertex, h[0].n, &lower, NULL, evaluations);
    upper = fmin(upper, paper_gjk(p->obstacle->vertex, p->obstacle->n, &middle[0], 1, &unused, NULL, evaluations));
  }
  node->lower = fmax(node->lower, lower);
  return upper;
}

/* Whether the two bounds answer the query (the loop conditions of Algorithms 1, 3 and 4). */
static bool answered(const paper_query *q, double lower, double upper, bool *verdict) {
  if (q->query_type == PAPER_DISTANCE) return upper - lower <= q->epsilon;
  const double delta = q->query_type == PAPER_TOLERANCE ? q->delta : 0.0;
  if (lower > delta) {
    *verdict = q->query_type == PAPER_TOLERANCE;
    return true;
  }
  *verdict = q->query_type == PAPER_COLLISION;
  return upper - delta <= q->epsilon;
}

static void search(const problem *p, const paper_query *q, paper_node *heap, paper_answer *r) {
  uint32_t count = 0;
  *r = (paper_answer){.upper = INFINITY};
  paper_node root = {.lower = 0.0};
  for (int k = 0; k < 2 && p->curve[k]; k++) root.a[k] = p->curve[k]->t0, root.b[k] = p->curve[k]->t1;
  r->upper = bound(p, &root, r->upper, &r->evaluations);
  r->nodes = 1;
  push(heap, &count, root);
  for (;;) {
    r->lower = heap[0].lower;
    r->ended = answered(q, r->lower, r->upper, &r->verdict);
    if (r->ended || r->nodes + 2 > q->max_nodes || r->nodes + 2 > PAPER_MAX_NODES) return;

    /* the longer of the two intervals is halved */
    const paper_node node = pop(heap, &count);
    const int k = p->curve[1] && node.b[1] - node.a[1] > node.b[0] - node.a[0] ? 1 : 0;
    for (int half = 0; half < 2; half++) {
      paper_node child = node;
      const double middle = 0.5 * (node.a[k] + node.b[k]);
      *(half ? &child.a[k] : &child.b[k]) = middle;
      r->upper = bound(p, &child, r->upper, &r->evaluations);
      push(heap, &count, child);
      r->nodes++;
    }
  }
}

void paper_search(const paper_curve *curve, const paper_obstacle *obstacle, const paper_query *q, paper_node *heap,
                  paper_answer *answer) {
  search(&(problem){.curve = {curve, NULL}, .obstacle = obstacle}, q, heap, answer);
}

void paper_search_curves(const paper_curve *first, const paper_curve *second, const paper_query *q, paper_node *heap,
                         paper_answer *answer) {
  search(&(problem){.curve = {first, second}}, q, heap, answer);
}
