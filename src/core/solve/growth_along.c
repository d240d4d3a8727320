/* SPDX-License-Identifier: BSD-3-Clause */
/* The least growth distance of a body that a curve carries, from one that stands (doc/implicit.md, Along a curve).
 *
 * With the direction n from a to b and h what both bodies reach along it, n·(c_b - c_a) / h bounds the growth distance
 * from below wherever a stands: over an interval of the curve by its control points. */
#include <math.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "branch_and_bound/search.h"
#include "convex/feature.h"
#include "curve/curve_side.h"
#include "narrowphase/growth.h"

/* The part of the width that may be left where the centres meet and a relative width is none. */
static const double AT_CENTRES = 1e-3;

/* Of the range: the first step away from the minimiser, near the root of rounding, and where steps end that grow. */
static const double FIRST_STEP = 1e-8, LAST_STEP = 0.05;

/* How near another minimiser must not come, as a part of the value; the neighbourhoods of the minimiser that are tried,
 * as fractions of the curve, until all beyond is greater, and by how much their ends are; where within them the value
 * must fall towards the minimiser. */
static const double APART = 1e-9, NEIGHBOURHOOD[] = {1e-4, 1e-3, 1e-2, 3e-2}, FARTHER = 4.0, INSIDE = 0.25;

/* The most nodes of each search for another minimiser: what it leaves open counts as one. */
enum { MOST_NODES = 1000, NEIGHBOURHOODS = sizeof NEIGHBOURHOOD / sizeof *NEIGHBOURHOOD };

enum { ROOT_SLOT, RESERVED_SLOTS };

/* The direction that bounds best at one place of the curve. */
typedef struct plane {
  vec3 n;   /* unit within 4 u, from a to b; (0,0,0): none */
  double h; /* not below what both bodies reach along it */
} plane;

/* What is seen from a point of the curve. */
typedef struct place {
  size_t piece;
  double s, slope; /* slope: by the curve's parameter; NaN of curves that have no derivative */
  cprox_growth growth;
  double lower, upper; /* of the value at the exact point */
  plane seen;
} place;

typedef struct along {
  growing g;
  vec3 offset; /* from the curve's point to a's position */
  vec3 meet;   /* the curve's point where both centres coincide, within `missed` */
  double missed;
  curve_side side; /* seen from `meet` */
  points_pool pool;
  double from, to; /* the parameters that are asked about */
  place best, last;
  uint32_t known; /* counts the best places; 0: none */
  uint32_t work;  /* places measured */
  double epsilon; /* the width that is asked for, a part of the value; places are measured more narrowly */
  cprox_workspace *workspace;
} along;

typedef struct along_node {
  curve_interval at;
  uint32_t known;
} along_node;

static along_node *own(search_node *node) {
  _Static_assert(sizeof(along_node) <= sizeof(search_payload), "a node's payload holds it");
  return (along_node *)node->payload.bytes;
}

/* ---- places ---- */

/* What the two bodies reach along the direction from a to b, from above. */
static plane plane_of(const growing *g, vec3 n) {
  if (!(vec_norm2(n) > 0.0)) return (plane){.n = vec(0, 0, 0)};
  const convex *const shape[2] = {g->x.shape, g->y.shape};
  const double margin[2] = {g->x.margin, g->y.margin};
  plane p = {.n = n};
  for (int k = 0; k < 2; k++) {
    convex_hint hint = {0};
    const vec3 local = frame_turn_to_local(k ? &g->y.f : &g->x.f, k ? vec_neg(n) : n);
    const double size = shape[k]->scale + margin[k];
    p.h += shape[k]->ops->support(shape[k], local, &hint, NULL) + margin[k] + shape[k]->slack;
    p.h += ROUND_UP * (ROUND_SUPPORT + ROUND_ROTATION + 8.0) * ROUND_U * size;
  }
  p.h += g->x.error + g->y.error;
  return p;
}

/* The body a where the curve is at `local`, and the value there. */
static cprox_status measure(along *o, vec3 local, double error, place *p) {
  const vec3 at = frame_to_world(&o->side.frame, local);
  o->g.a.pose.position = vec_add(at, o->offset);
  growing_place(&o->g);
  o->work++;
  ray_answer ray;
  const cprox_status status = growing_measure(&o->g, false, o->workspace, &p->growth, &ray);
  if (status < 0) return status;
  /* a body that is moved by e contains what is drawn to its centre by e over the ball in it */
  const double rounded = error + ROUND_UP * 8.0 * ROUND_U * (vec_norm(at) + vec_norm(o->offset) + vec_norm(o->meet));
  const double moved = ROUND_UP * rounded / (o->g.inner_a + o->g.inner_b);
  p->lower = fmax(p->growth.lower - moved, 0.0), p->upper = p->growth.upper + moved;
  p->seen = plane_of(&o->g, vec_neg(p->growth.normal));
  return isnan(p->seen.h) ? workspace_fail(o->workspace, CPROX_INVALID, CONVEX_NO_SUPPORT) : CPROX_OK;
}

static cprox_status measure_at(along *o, size_t piece, double s, place *p) {
  curve_side *side = &o->side;
  curve_side_load(side, piece);
  vec3 at, velocity = vec(NAN, NAN, NAN);
  if (side->curve->arcs) {
    at = curve_side_point(side, s);
  } else {
    const size_t degree = side->curve->degree;
    const double *x = points_pool_at(&o->pool, ROOT_SLOT), *y = x + degree + 1, *z = y + degree + 1;
    curve_bezier_evaluate(x, y, z, 1, degree, curve_binomial(side->curve), s, &at, &velocity, NULL);
  }
  cprox_status status = curve_side_status(side);
  if (status < 0) return status;
  *p = (place){.piece = piece, .s = s};
  status = measure(o, at, curve_side_point_error(side), p);
  const double length = side->curve->breaks[piece + 1] - side->curve->breaks[piece];
  p->slope = p->seen.h > 0.0 ? -vec_dot(p->seen.n, velocity) / (p->seen.h * length) : 0.0;
  return status;
}

/* At a parameter; from_left: of a break, the end of the piece before it. */
static cprox_status look_at(along *o, double t, bool from_left, place *p) {
  const cprox_curve *c = o->side.curve;
  size_t piece = 0;
  while (piece + 1 < c->n_pieces && (from_left ? c->breaks[piece + 1] < t : c->breaks[piece + 1] <= t)) piece++;
  const double s = (t - c->breaks[piece]) / (c->breaks[piece + 1] - c->breaks[piece]);
  return measure_at(o, piece, fmin(fmax(s, 0.0), 1.0), p);
}

/* ---- the search ---- */

/* Raises a node's bound by the plane of a place. */
static void bound_by(const along *o, search_node *node, const plane *p) {
  if (!(p->h > 0.0)) return;
  const curve_reach reach = curve_side_reach(&o->side, &own(node)->at, vec_neg(p->n));
  const double slack = ROUND_UP * (reach.error + o->missed + 16.0 * ROUND_U * reach.magnitude);
  const double bound = (reach.least - slack) / p->h * (1.0 - 4.0 * ROUND_U);
  node->lower = greater(bound, node->lower);
  node->slack = slack / p->h;
}

static bool is_piece(const along *o, search_node *node) {
  return curve_side_is_piece(&o->side, &own(node)->at);
}

static double filter(void *self, search_node *node, double goal) {
  along *o = self;
  (void)goal;
  if (o->known == 0 || own(node)->known == o->known) return node->lower;
  if (own(node)->at.slot >= 0) curve_side_load(&o->side, curve_side_piece(&o->side, &own(node)->at));
  own(node)->known = o->known;
  bound_by(o, node, &o->best.seen);
  return node->lower;
}

/* A place nearer to an end, by the interval, does not cut it. */
static const double CUT_INSIDE = 1e-3;

/* Where the best place cuts the node's interval; -1: it does not. */
static double best_inside(const along *o, search_node *node) {
  const curve_interval *at = &own(node)->at;
  if (o->known == 0 || curve_side_piece(&o->side, at) != o->best.piece) return -1.0;
  const double s = (o->best.s - at->a) / (at->b - at->a);
  return s > CUT_INSIDE && s < 1.0 - CUT_INSIDE ? s : -1.0;
}

/* Where the control point lies that reaches farthest towards b, but well inside. */
static double promising(const along *o, search_node *node) {
  const curve_interval *at = &own(node)->at;
  const size_t degree = o->side.curve->degree;
  double fraction = 0.5;
  if (o->known > 0 && !o->side.curve->arcs)
    fraction = (double)curve_side_lowest(&o->side, at, vec_neg(o->best.seen.n)) / (double)degree;
  return at->a + fmin(fmax(fraction, 0.125), 0.875) * (at->b - at->a);
}

/* Adopts the last place where it is better. */
static void adopt(along *o, search_best *best) {
  if (!(o->last.upper < best->upper)) return;
  o->best = o->last;
  o->known++;
  *best = (search_best){.upper = o->last.upper, .slack = o->last.upper - o->last.lower, .at = INFINITY};
}

static cprox_status probe(void *self, search_node *node, search_best *best) {
  along *o = self;
  cprox_status status;
  if (is_piece(o, node)) {
    if (!curve_side_materialise(&o->side, &own(node)->at)) return curve_side_failure(&o->side);
    const size_t piece = curve_side_piece(&o->side, &own(node)->at);
    status = best_inside(o, node) < 0.0 ? measure_at(o, piece, promising(o, node), &o->last) : CPROX_OK;
  } else {
    size_t piece;
    double s, error;
    (void)curve_side_junction(&o->side, &own(node)->at, &piece, &s, &error);
    const double t = curve_side_parameter(&o->side, piece, s);
    status = look_at(o, fmin(fmax(t, o->from), o->to), false, &o->last);
  }
  if (status < 0) return status;
  adopt(o, best);
  if (is_piece(o, node)) curve_side_load(&o->side, curve_side_piece(&o->side, &own(node)->at));
  bound_by(o, node, &o->last.seen);
  bound_by(o, node, &o->best.seen);
  own(node)->known = o->known;
  return CPROX_OK;
}

/* Cuts a piece's interval down to what is asked about; false: nothing is left. */
static bool clip(const along *o, curve_interval *at) {
  const size_t piece = curve_side_piece(&o->side, at);
  const double *breaks = o->side.curve->breaks, length = breaks[piece + 1] - breaks[piece];
  const double a = fmax((o->from - breaks[piece]) / length, 0.0), b = fmin((o->to - breaks[piece]) / length, 1.0);
  if (!(a < b)) return false;
  *at = curve_side_section(o->side.curve, piece, a, b);
  return true;
}

/* Does a range have parameters that are asked about? */
static bool is_asked(const along *o, const curve_interval *range) {
  const cprox_curve *c = o->side.curve;
  size_t first = range->part, last = range->part;
  while (first < c->n_leaves) first *= 2, last = 2 * last + 1;
  first -= c->n_leaves, last -= c->n_leaves;
  if (last >= c->n_pieces) last = c->n_pieces - 1;
  return c->breaks[first] < o->to && c->breaks[last + 1] > o->from;
}

static int split_range(along *o, search_node *node, search_node *child) {
  curve_interval half[2];
  curve_side_cut_range(&own(node)->at, half);
  int n = 0;
  for (int k = 0; k < 2; k++) {
    if (curve_side_is_empty(&o->side, &half[k]) || !is_asked(o, &half[k])) continue;
    if (curve_side_is_piece(&o->side, &half[k]) && !clip(o, &half[k])) continue;
    child[n] = *node;
    own(&child[n])->at = half[k];
    bound_by(o, &child[n++], &o->best.seen);
  }
  return n;
}

static int split(void *self, search_node *node, search_node *child) {
  along *o = self;
  if (!is_piece(o, node)) return split_range(o, node, child);
  curve_interval *at = &own(node)->at, half[2];
  const double inside = best_inside(o, node), s = inside < 0.0 ? 0.5 : inside, cut = at->a + s * (at->b - at->a);
  if (!(at->a < cut && cut < at->b)) return 0;
  if (!curve_side_cut_piece(&o->side, at, cut, s, half)) return (int)curve_side_failure(&o->side);
  for (int k = 0; k < 2; k++) {
    child[k] = *node;
    own(&child[k])->at = half[k];
    bound_by(o, &child[k], &o->last.seen);
    bound_by(o, &child[k], &o->best.seen);
  }
  return 2;
}

static void release(void *self, const search_node *node) {
  along *o = self;
  points_pool_release(&o->pool, ((const along_node *)node->payload.bytes)->at.slot);
}

/* The least value over [from, to], or whether any is at most `limit`, where that is >= 0. */
static cprox_status search(along *o, double from, double to, double limit, uint32_t most, search_outcome *found) {
  o->from = from, o->to = to, o->known = 0, o->work = 0;
  search_node root = {.lower = 0.0};
  *own(&root) = (along_node){.at = curve_side_whole()};
  if (is_piece(o, &root) && !clip(o, &own(&root)->at)) return CPROX_OK;
  search_goal goal = {.order = SEARCH_BEST_FIRST,
                      .limit = limit,
                      .cutoff = INFINITY,
                      .time_cutoff = INFINITY,
                      .epsilon = limit < 0.0 ? AT_CENTRES * o->epsilon : 0.0,
                      .relative_epsilon = o->epsilon,
                      .max_nodes = most,
                      .stop = o->g.asked.stop,
                      .stop_user = o->g.asked.stop_user};
  const search_oracle oracle = {
      .self = o, .work = &o->work, .filter = filter, .probe = probe, .split = split, .release = release};
  const cprox_status status = search_run(&goal, &oracle, root, o->workspace, found);
  if (status == CPROX_MEMORY) return workspace_fail(o->workspace, status, "no memory for the open intervals");
  return status;
}

/* ---- the minimiser ---- */

static double parameter_of(const along *o, const place *p) {
  return curve_side_parameter(&o->side, p->piece, p->s);
}

/* Between left, where the value falls, and right, where it grows (Illinois). */
static cprox_status find_root(along *o, double left, double right, double fa, double fb, double *t) {
  enum { MOST_STEPS = 100 };
  int side = 0;
  for (int i = 0; i < MOST_STEPS; i++) {
    double next = i % 4 == 3 ? 0.5 * (left + right) : (left * fb - right * fa) / (fb - fa);
    if (!(next > left && next < right)) next = 0.5 * (left + right);
    if (!(next > left && next < right)) return CPROX_OK;
    place p;
    const cprox_status status = look_at(o, next, false, &p);
    if (status < 0) return status;
    *t = next;
    if (p.slope == 0.0) return CPROX_OK;
    const int now = p.slope < 0.0 ? -1 : 1;
    if (now < 0)
      left = next, fa = p.slope, fb *= side < 0 ? 0.5 : 1.0;
    else
      right = next, fb = p.slope, fa *= side > 0 ? 0.5 : 1.0;
    side = now;
  }
  return CPROX_OK;
}

/* The minimiser near *t, as exactly as its slope tells it. */
static cprox_status refine(along *o, double t0, double t1, double *t) {
  const double range = t1 - t0;
  double step = FIRST_STEP * range;
  while (step < LAST_STEP * range) {
    const double left = fmax(*t - step, t0), right = fmin(*t + step, t1);
    place a, b;
    cprox_status status = look_at(o, left, true, &a);
    if (status >= 0) status = look_at(o, right, false, &b);
    if (status < 0) return status;
    if (left == t0 && (a.slope > 0.0 || (a.slope == 0.0 && b.slope > 0.0))) return *t = t0, CPROX_OK;
    if (right == t1 && (b.slope < 0.0 || (b.slope == 0.0 && a.slope < 0.0))) return *t = t1, CPROX_OK;
    if (a.slope < 0.0 && b.slope > 0.0) return find_root(o, left, right, a.slope, b.slope, t);
    step *= 8.0;
  }
  return CPROX_OK;
}

/* Whether the value is greater than at t all over [from, to]. */
static cprox_status is_greater(along *o, double from, double to, double value, bool *greater_there) {
  search_outcome found = {.lower = INFINITY};
  *greater_there = true;
  if (!(from < to)) return CPROX_OK;
  const double limit = value * (1.0 + APART);
  const cprox_status status = search(o, from, to, limit, MOST_NODES, &found);
  *greater_there = found.lower > limit;
  return status;
}

/* Whether the value falls towards t from the end of a neighbourhood on this side, and is greater there. */
static cprox_status rises_towards(along *o, double t, double end, double value, bool *rises) {
  *rises = true;
  if (end == t) return CPROX_OK;
  place p;
  cprox_status status = look_at(o, end, end > t, &p);
  if (status < 0) return status;
  *rises = p.lower >= value * (1.0 + FARTHER * APART);
  status = look_at(o, t + INSIDE * (end - t), end > t, &p);
  if (status >= 0) *rises = *rises && (end > t ? p.slope > 0.0 : p.slope < 0.0);
  return status;
}

static cprox_status is_alone(along *o, double t0, double t1, double t, double value, bool *alone) {
  *alone = false;
  for (int k = 0; k < NEIGHBOURHOODS && !*alone; k++) {
    const double width = NEIGHBOURHOOD[k] * (t1 - t0), left = fmax(t - width, t0), right = fmin(t + width, t1);
    bool good[4];
    cprox_status status = rises_towards(o, t, left, value, &good[0]);
    if (status >= 0) status = rises_towards(o, t, right, value, &good[1]);
    if (status >= 0 && good[0] && good[1]) {
      status = is_greater(o, t0, left, value, &good[2]);
      if (status >= 0) status = is_greater(o, right, t1, value, &good[3]);
      *alone = status >= 0 && good[2] && good[3];
    }
    if (status < 0) return status;
  }
  return CPROX_OK;
}

/* ---- the query ---- */

static cprox_status begin(along *o, const cprox_curve *curve, const cprox_options *options) {
  cprox_workspace *workspace = o->workspace;
  if (!curve) return workspace_fail(workspace, CPROX_INVALID, "curve is NULL");
  const cprox_status status = growing_begin(&o->g, options, workspace);
  if (status) return status;
  if (!curve->in_reach) return workspace_fail(workspace, CPROX_INVALID, "the curve leaves what queries can hold");
  growing *g = &o->g;
  o->epsilon = g->asked.epsilon;
  g->asked.epsilon *= 0.1;
  o->offset = g->a.pose.position;
  const vec3 centre_a = frame_turn_to_world(&g->x.f, g->x.f.centre),
             centre_b = frame_turn_to_world(&g->y.f, g->y.f.centre);
  const vec3 positions = vec_sub(g->b.pose.position, o->offset);
  o->meet = vec_add(positions, vec_sub(centre_b, centre_a));
  o->missed = ROUND_UP * ROUND_U *
              (vec_norm(g->b.pose.position) + vec_norm(o->offset) + 4.0 * vec_norm(positions) +
               2.0 * vec_norm(o->meet) + (ROUND_ROTATION + 2.0) * (vec_norm(centre_a) + vec_norm(centre_b)));
  const frame seen = frame_create(&(cprox_pose){o->meet, {1, 0, 0, 0}}, vec(0, 0, 0));
  curve_side_begin(&o->side, curve, &seen, &o->pool, ROOT_SLOT);
  if (!points_pool_begin(&o->pool, curve->degree, RESERVED_SLOTS, workspace))
    return workspace_fail(workspace, CPROX_MEMORY, "no memory for a curve's points");
  return CPROX_OK;
}

/* The derivatives at the minimiser; *why: NULL, or why there are none. */
static cprox_status differentiate(along *o, double t0, double t1, double *t, cprox_growth *growth,
                                  cprox_growth_derivatives *derivatives, const char **why) {
  bool alone = false;
  if (!o->side.curve->arcs) {
    place p;
    double refined = *t;
    cprox_status status = refine(o, t0, t1, &refined);
    if (status >= 0) status = look_at(o, refined, refined > t0 && refined == t1, &p);
    if (status < 0) return status;
    if (p.growth.status == CPROX_OK && p.upper <= growth->upper * (1.0 + 1e-12)) *t = refined;
    status = look_at(o, *t, *t == t1, &p);
    if (status >= 0) status = is_alone(o, t0, t1, *t, p.upper, &alone);
    if (status < 0) return status;
  }
  place p;
  cprox_status status = look_at(o, *t, *t == t1, &p);
  if (status < 0) return status;
  ray_answer ray;
  cprox_growth here;
  status = growing_measure(&o->g, true, o->workspace, &here, &ray);
  if (status < 0) return status;
  *why = growing_differentiate(&o->g, &here, &ray, derivatives);
  growth->normal = here.normal;
  growth->upper = fmin(growth->upper, p.upper);
  if (!alone && !*why) {
    derivatives->valid = derivatives->valid_position = false;
    *why = o->side.curve->arcs ? "the curve is known by its arc length alone"
                               : "the growth distance is as small elsewhere along the curve";
  }
  return CPROX_OK;
}

cprox_status cprox_growth_along(cprox_obstacle a, const cprox_curve *curve, cprox_obstacle b,
                                const cprox_options *options, cprox_workspace *workspace, cprox_growth *growth,
                                double *t, cprox_growth_derivatives *derivatives) {
  WORKSPACE_USE(workspace);
  workspace_clear(workspace);
  along o = {.g = {.a = a, .b = b}, .workspace = workspace};
  cprox_status status = begin(&o, curve, options);
  if (status) return status;
  if (!growth || !t)
    return workspace_fail(workspace, CPROX_INVALID, "%s is NULL: nowhere to put the answer", growth ? "t" : "growth");
  double t0, t1;
  curve_domain(curve, &t0, &t1);
  search_outcome found = {.lower = INFINITY};
  status = search(&o, t0, t1, -1.0, o.g.asked.max_nodes, &found);
  if (status < 0) return status;
  cprox_growth answer = o.best.growth;
  answer.lower = fmin(fmax(found.lower, 0.0), o.best.upper), answer.upper = o.best.upper;
  answer.pairs = o.work;
  answer.status = status;
  double at = parameter_of(&o, &o.best);
  const char *why = NULL;
  cprox_growth_derivatives d;
  if (derivatives) {
    const cprox_status differentiated = differentiate(&o, t0, t1, &at, &answer, &d, &why);
    if (differentiated < 0) return differentiated;
    *derivatives = d;
  }
  *growth = answer, *t = at;
  workspace_clear(workspace);
  if (status != CPROX_OK)
    workspace_fail(workspace, status, "%s", cprox_status_text(status));
  else if (why)
    workspace_fail(workspace, CPROX_OK, "no gradient: %s", why);
  return status;
}
