/* SPDX-License-Identifier: BSD-3-Clause */
/* The bound itself: whatever intervals the oracle makes, and whatever normals it uses, no bound lies above the distance
 * of any point in its interval, and the best upper bound is never below the distance at its own point. The distances
 * are those of the long double references, which know nothing of the search. */
#include "curve/curve.h"
#include "curve_query/curve_convex.h"
#include "support/cases.h"
#include "support/make_curve.h"
#include "support/random.h"
#include "support/reference.h"

enum { MAX_DEGREE = 20, MAX_PIECES = 70, LOW_DEGREE = 4, MAX_POINTS = MAX_PIECES * LOW_DEGREE + 1 };
enum { MAX_OPEN = 64, STEPS = 30, INTERVALS = 120000 };

typedef enum shape_kind {
  SHAPE_POINT,
  SHAPE_SPHERE,
  SHAPE_BOX,
  SHAPE_CAPSULE,
  SHAPE_POLYGON,
  SHAPE_HULL,
  SHAPES
} shape_kind;

/* One random problem: a curve of one Bézier piece or of many end to end, a posed body, an offset. Sizes of the order
 * `scale`, everything `away` from the origin, on a grid on which points - position is exact: so the reference starts
 * from `nearby`, where long double has digits to spare. */
typedef struct problem {
  size_t degree, pieces;
  vec3 points[MAX_POINTS], nearby[MAX_POINTS];
  shape_kind kind;
  vec3 size;
  vec3 vertex[6];
  cprox_pose pose;
  double offset;
  cprox_curve *curve;
  cprox_body *body;
} problem;

static vec3 on_grid(vec3 p, double step) {
  return vec(step * nearbyint(p.x / step), step * nearbyint(p.y / step), step * nearbyint(p.z / step));
}

/* A spline whose knots have the multiplicity of the degree: its de Boor points are those of its pieces. */
static cprox_status make_curve(problem *p, cprox_workspace *ws) {
  const size_t n = p->pieces * p->degree + 1;
  if (p->pieces == 1) return curve_from(describe_bezier(p->points, n, 0.0, 1.0), ws, &p->curve);
  double knots[MAX_POINTS + LOW_DEGREE + 1];
  for (size_t i = 0; i < n + p->degree + 1; i++)
    knots[i] = i == 0 ? 0.0 : fmin((double)((i - 1) / p->degree), (double)p->pieces);
  return curve_from(describe_bspline(p->points, n, p->degree, knots, n + p->degree + 1, 0.0, (double)p->pieces), ws,
                    &p->curve);
}

/* A walk, or points all over the place. */
static void make_points(problem *p, rng *r, double scale, vec3 away) {
  const size_t n = p->pieces * p->degree + 1;
  const bool walk = p->pieces > 1 && rng_index(r, 2);
  vec3 at = rng_in_cube(r, 2.0 * scale);
  for (size_t i = 0; i < n; i++) {
    at = walk ? vec_add(at, rng_in_cube(r, 0.3 * scale)) : rng_in_cube(r, 2.0 * scale);
    p->points[i] = vec_add(away, at);
  }
  if (rng_index(r, 8) == 0) p->points[n - 1] = p->points[0];
}

static problem problem_random(rng *r, cprox_workspace *ws) {
  problem p = {0};
  const double scale = rng_log_uniform(r, 1e-6, 1e6);
  const vec3 away = rng_in_cube(r, rng_index(r, 2) ? 0.0 : scale * rng_log_uniform(r, 1.0, 1e6));
  p.degree = 1 + rng_index(r, rng_index(r, 4) ? 6 : MAX_DEGREE);
  p.pieces = rng_index(r, 2) ? 1 : 2 + rng_index(r, MAX_PIECES - 1);
  if (p.pieces > 1) p.degree = 1 + rng_index(r, LOW_DEGREE);
  const size_t n = p.pieces * p.degree + 1;
  make_points(&p, r, scale, away);
  p.pose = rng_pose(r, scale);
  p.pose.position = vec_add(p.pose.position, away);
  const double step = ldexp(1.0, ilogb(fmax(scale, vec_norm(away))) - 50);
  p.pose.position = on_grid(p.pose.position, step);
  for (size_t i = 0; i < n; i++) {
    p.points[i] = on_grid(p.points[i], step);
    p.nearby[i] = vec_sub(p.points[i], p.pose.position);
  }
  if (rng_index(r, 4) == 0) p.pose.orientation = (cprox_quat){1, 0, 0, 0};
  p.offset = rng_index(r, 2) ? 0.0 : rng_uniform(r, 0.0, 0.1 * scale);
  p.size = vec(rng_log_uniform(r, 1e-3, 1.0) * scale, rng_log_uniform(r, 1e-3, 1.0) * scale,
               rng_uniform(r, 0.1, 1.0) * scale);
  p.kind = (shape_kind)rng_index(r, SHAPES);

  cprox_status status = CPROX_OK;
  switch (p.kind) {
    case SHAPE_POINT: status = cprox_body_create_point(vec(0, 0, 0), ws, &p.body); break;
    case SHAPE_SPHERE: status = cprox_body_create_sphere(p.size.x, ws, &p.body); break;
    case SHAPE_BOX: status = cprox_body_create_box(vec_scale(2.0, p.size), ws, &p.body); break;
    case SHAPE_CAPSULE: status = cprox_body_create_capsule(2.0 * p.size.z, p.size.x, ws, &p.body); break;
    case SHAPE_POLYGON: {
      double flat[6][2];
      for (int i = 0; i < 6; i++) {
        const double angle = 2.0 * 3.14159265358979 * (i + rng_uniform(r, 0.0, 0.8)) / 6.0;
        p.vertex[i] = vec(flat[i][0] = p.size.x * cos(angle), flat[i][1] = p.size.y * sin(angle), 0.0);
      }
      status = cprox_body_create_polygon((const double(*)[2])flat, 6, ws, &p.body);
      break;
    }
    default:
      for (int i = 0; i < 6; i++) p.vertex[i] = rng_in_cube(r, p.size.z);
      status = cprox_body_create_polytope(p.vertex, 6, ws, &p.body);
  }
  if (status != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  status = make_curve(&p, ws);
  if (status != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  return p;
}

static void problem_free(problem *p) {
  cprox_body_free(p->body);
  cprox_curve_free(p->curve);
}

/* The distance at s of a piece, less the offset; 0 inside the body, so at least -offset. */
static long double true_distance(const problem *p, size_t piece, double s) {
  const cprox_pose turn = {.orientation = p->pose.orientation};
  const vec3l y = ref_to_local(&turn, ref_bezier(p->nearby + piece * p->degree, p->degree, s, 0));
  long double d = 0;
  switch (p->kind) {
    case SHAPE_POINT:
    case SHAPE_SPHERE: d = ref_norm(y) - (p->kind == SHAPE_POINT ? 0.0L : (long double)p->size.x); break;
    case SHAPE_BOX: d = ref_point_box(y, p->size); break;
    case SHAPE_CAPSULE:
      d = ref_point_segment(y, (vec3l){0, 0, -p->size.z}, (vec3l){0, 0, p->size.z}) - (long double)p->size.x;
      break;
    case SHAPE_POLYGON: d = ref_point_polygon(y, p->vertex, 6); break;
    default: d = ref_point_hull(y, p->vertex, 6);
  }
  return (d > 0 ? d : 0) - (long double)p->offset;
}

/* The pieces that a node has a share in. */
static void pieces_of(const curve_convex *o, const search_node *node, size_t *first, size_t *end) {
  const cprox_curve *c = o->side.curve;
  size_t low = curve_convex_known(node)->at.part, high = low + 1;
  while (low < c->n_leaves) low *= 2, high *= 2;
  *first = low - c->n_leaves;
  *end = high - c->n_leaves < c->n_pieces ? high - c->n_leaves : c->n_pieces;
}

static bool touches_best(const curve_convex *o, const search_node *node) {
  const curve_convex_node *payload = curve_convex_known(node);
  size_t first, end;
  pieces_of(o, node, &first, &end);
  return first <= o->best.piece && o->best.piece < end && payload->at.a <= o->best.s && o->best.s <= payload->at.b;
}

/* Two points well inside the interval: its ends are labels in double, the pieces themselves are cut exactly. */
static size_t check_node(const problem *p, rng *r, const search_node *node, const curve_convex *o) {
  const curve_convex_node *payload = curve_convex_known(node);
  if (payload->at.b - payload->at.a < 1e-9) return 0;
  for (int k = 0; k < 2; k++) {
    size_t first, end;
    pieces_of(o, node, &first, &end);
    const size_t piece = first + rng_index(r, end - first);
    const double s = payload->at.a + rng_uniform(r, 1e-3, 1.0 - 1e-3) * (payload->at.b - payload->at.a);
    const long double d = true_distance(p, piece, s);
    if ((long double)node->lower > d && (long double)node->lower > -(long double)p->offset)
      fail_msg("kind %d degree %zu: bound %.17g above the distance %.17Lg at s = %.17g of [%g, %g]", p->kind, p->degree,
               node->lower, d, s, payload->at.a, payload->at.b);
  }
  const long double best = true_distance(p, o->best.piece, o->best.s);
  if (o->incumbent > 0 && (long double)o->best_bound.upper < best && best > -(long double)p->offset)
    fail_msg("kind %d degree %zu: upper bound %.17g below the distance %.17Lg at s = %.17g", p->kind, p->degree,
             o->best_bound.upper, best, o->best.s);
  return 1;
}

/* Filters, distance queries and splits nodes, and checks every node after every step: nodes in random order, or always
 * one that touches the best point, whose bound comes closest to the truth. */
static size_t attack(const problem *p, rng *r, cprox_workspace *ws) {
  curve_convex o;
  assert_true(
      curve_convex_begin(&o, p->curve, &p->body->shape, frame_create(&p->pose, p->body->centre), p->offset, ws));
  o.effort.good_enough = rng_index(r, 2) ? -INFINITY : INFINITY;
  const search_oracle oracle = curve_convex_oracle(&o);
  const bool chase = rng_index(r, 2);
  search_node open[MAX_OPEN + SEARCH_MAX_CHILDREN];
  search_best best = {.upper = INFINITY};
  size_t n = 1, checked = 0;
  open[0] = curve_convex_root(&o);
  for (int step = 0; step < STEPS && n > 0 && n < MAX_OPEN; step++) {
    size_t i = rng_index(r, n);
    for (size_t k = 0; chase && o.incumbent > 0 && k < n; k++)
      if (touches_best(&o, &open[k])) i = k;
    search_node *node = &open[i];
    oracle.filter(oracle.self, node, INFINITY);
    checked += check_node(p, r, node, &o);
    assert_int_equal(oracle.probe(oracle.self, node, &best), CPROX_OK);
    oracle.filter(oracle.self, node, INFINITY);
    checked += check_node(p, r, node, &o);
    search_node child[SEARCH_MAX_CHILDREN];
    const int children = oracle.split(oracle.self, node, child);
    if (children < 1) break;
    open[i] = child[0];
    for (int k = 1; k < children; k++) open[n++] = child[k];
    for (int k = 0; k < children; k++) checked += check_node(p, r, &child[k], &o);
  }
  return checked;
}

/* Seed 1, 120,000 intervals, each at two random points. Tolerance 0: the slack is in the bound. */
CASE(no_bound_lies_above_the_distance_and_no_best_point_below_it) {
  rng r = rng_seed(1);
  cprox_workspace *ws = cprox_workspace_create();
  for (size_t checked = 0; checked < test_cases(INTERVALS);) {
    problem p = problem_random(&r, ws);
    checked += attack(&p, &r, ws);
    problem_free(&p);
  }
  cprox_workspace_free(ws);
}

int main(void) {
  return cases_run(NULL, NULL);
}
