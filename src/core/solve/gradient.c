/* SPDX-License-Identifier: BSD-3-Clause */
/* Danskin: where the minimiser is one alone, the derivatives of the minimum are
 * those of the distance there. */
#include "curve_proximity/cprox/gradient.h"

#include "base/workspace.h"
#include "curve/relative_curve.h"
#include "curve_query/report.h"
#include "problem/carried_shape.h"
#include "problem/level_of_detail.h"
#include "problem/radius.h"
#include "problem/validate.h"
#include "shape/body.h"
#include "solve/gradient_ties.h"
#include "solve/list.h"
#include "solve/solve.h"

/* How near another minimiser must not come, in lengths of the curve, unless
 * epsilon is less still. */
static const double APART = 1e-9;

/* The neighbourhoods of the minimiser that are tried, as fractions of the
 * range, until everything beyond is farther. */
static const double NEIGHBOURHOOD[] = {1e-4, 1e-3, 1e-2, 3e-2};

/* And nearer to it, until the distance there is greater by more than its
 * rounding. */
static const double NEARBY[] = {1e-6, 1e-5, 1e-4, 1e-3};

/* Of the range: the first step away from the minimiser, near the root of rounding, and where steps end that grow. */
static const double FIRST_STEP = 1e-8, LAST_STEP = 0.05;

/* How narrowly those are searched, in lengths of the curve and distances. */
static const double HARDLY = 1e-14;

/* The most nodes of each of these searches: what it leaves open counts as near. A depth may not be known that narrowly.
 */
static const uint32_t MOST_NODES = 1000;

static cprox_status invalid(cprox_workspace *workspace, cprox_gradient *g, const char *why) {
  g->valid = false;
  workspace_fail(workspace, CPROX_OK, "no gradient: %s", why);
  return CPROX_OK;
}

/* ---- the minimiser along the curve ---- */

/* What is measured along the curve: a convex shape, or the elements of a tree. */
typedef struct beside {
  bool is_tree;
  union {
    curve_convex convex;
    curve_tree tree;
  } of;
} beside;

/* What is seen from a point of the curve, in the frame of what stands. */
typedef struct look {
  union {
    curve_sample convex;
    tree_sample tree;
  } sample;
  size_t piece;
  double s;
  vec3 y, normal;
  double distance; /* without margins; */
  double radius;   /* what changes of the radius, and is not in the offset */
  double slope;    /* how fast the distance less the radius changes along the curve */
  double slack;    /* of the distance */
} look;

static bool beside_begin(beside *o, const query *q, const placed_pair *p) {
  o->is_tree = p->shape->tree != NULL;
  if (o->is_tree) return curve_tree_begin_pair(&o->of.tree, q, p);
  if (!curve_convex_begin_pair(&o->of.convex, q, p)) return false;
  o->of.convex.effort.is_signed = q->is_signed;
  o->of.convex.effort.epsilon = q->options.epsilon;
  return true;
}

static curve_side *side_of(beside *o) {
  return o->is_tree ? &o->of.tree.side : &o->of.convex.side;
}

static double offset_of(const beside *o) {
  return o->is_tree ? o->of.tree.offset : o->of.convex.offset;
}

static double size_of(const beside *o) {
  if (o->is_tree) return o->of.tree.tree->scale + o->of.tree.body->shape.margin;
  return o->of.convex.shape->scale + o->of.convex.shape->margin;
}

static cprox_status look_from(beside *o, size_t piece, double s, vec3 y, double error, look *seen) {
  *seen = (look){.piece = piece, .s = s, .y = y, .radius = curve_side_thickness(side_of(o), piece, s).value};
  if (o->is_tree) {
    tree_sample *sample = &seen->sample.tree;
    const tree_hit hit = tree_nearest(o->of.tree.tree, y, INFINITY);
    seen->slack = curve_tree_measure(&o->of.tree, hit.at, piece, s, y, error, sample).slack;
    seen->normal = sample->near.normal;
    seen->distance = curve_tree_holds(&o->of.tree, y) ? 0.0 : sample->near.distance;
    return CPROX_OK;
  }
  curve_sample *sample = &seen->sample.convex;
  search_best bound;
  const cprox_status status = curve_convex_measure(&o->of.convex, piece, s, y, error, sample, &bound);
  seen->slack = bound.slack;
  seen->normal = sample->normal, seen->distance = sample->near.distance;
  return status;
}

static cprox_status look_at(beside *o, double t, bool from_left, look *seen) {
  curve_side *side = side_of(o);
  const cprox_curve *c = side->curve;
  size_t piece = 0;
  while (piece + 1 < c->n_pieces && (from_left ? c->breaks[piece + 1] < t : c->breaks[piece + 1] <= t)) piece++;
  const double length = c->breaks[piece + 1] - c->breaks[piece];
  const double s = fmin(fmax((t - c->breaks[piece]) / length, 0.0), 1.0);
  curve_side_load(side, piece);
  const double *x = points_pool_at(o->is_tree ? &o->of.tree.pool : &o->of.convex.pool, side->root_slot),
               *y = x + c->degree + 1, *z = y + c->degree + 1;
  vec3 at, velocity;
  curve_bezier_evaluate(x, y, z, 1, c->degree, curve_binomial(c), s, &at, &velocity, NULL);
  const cprox_status status = look_from(o, piece, s, at, curve_side_point_error(side), seen);
  seen->slope = (vec_dot(seen->normal, velocity) - curve_side_thickness(side, piece, s).slope) / length;
  return status;
}

/* As the search would report it. */
static void finding_of(beside *o, const look *seen, curve_finding *finding) {
  const search_best bound = {.upper = seen->distance - offset_of(o) - seen->radius};
  if (o->is_tree) {
    o->of.tree.best = seen->sample.tree, o->of.tree.best_bound = bound, o->of.tree.found = true;
    curve_tree_finding(&o->of.tree, finding);
    return;
  }
  curve_convex_adopt(&o->of.convex, &seen->sample.convex, bound);
  curve_convex_finding(&o->of.convex, finding);
}

/* Between left, where the distance falls, and right, where it grows: where it
 * does neither (Illinois). */
static cprox_status find_root(beside *o, double left, double right, look *a, look *b, double *t) {
  enum { MOST_STEPS = 100 };
  double fa = a->slope, fb = b->slope;
  int side = 0;
  *t = left;
  for (int i = 0; i < MOST_STEPS; i++) {
    double next = i % 4 == 3 ? 0.5 * (left + right) : (left * fb - right * fa) / (fb - fa);
    if (!(next > left && next < right)) next = 0.5 * (left + right);
    if (!(next > left && next < right)) return CPROX_OK;
    *t = next;
    look seen;
    const cprox_status status = look_at(o, next, false, &seen);
    if (status < 0) return status;
    if (seen.slope == 0.0) return CPROX_OK;
    if (seen.slope < 0.0) {
      left = next, fa = seen.slope;
      if (side < 0) fb *= 0.5;
      side = -1;
    } else {
      right = next, fb = seen.slope;
      if (side > 0) fa *= 0.5;
      side = 1;
    }
  }
  return CPROX_OK;
}

/* The minimiser near t, to the last digits; *end: -1 or 1 where it is an end of
 * the range. */
static cprox_status refine(beside *o, double t0, double t1, double *t, int *end) {
  enum { MOST_STEPS = 8 };
  const double range = t1 - t0;
  *end = 0;
  double step = FIRST_STEP * range;
  for (int i = 0; i < MOST_STEPS && step < LAST_STEP * range; i++, step *= 8.0) {
    const double left = fmax(*t - step, t0), right = fmin(*t + step, t1);
    look a = {.slope = 0.0}, b = {.slope = 0.0};
    cprox_status status = look_at(o, left, true, &a);
    if (status == CPROX_OK) status = look_at(o, right, false, &b);
    if (status < 0) return status;
    /* an end at rest has no slope: then that of the other side tells */
    if (left == t0 && (a.slope > 0.0 || (a.slope == 0.0 && b.slope > 0.0))) {
      *t = t0, *end = -1;
      return CPROX_OK;
    }
    if (right == t1 && (b.slope < 0.0 || (b.slope == 0.0 && a.slope < 0.0))) {
      *t = t1, *end = 1;
      return CPROX_OK;
    }
    if (a.slope < 0.0 && b.slope > 0.0) return find_root(o, left, right, &a, &b, t);
  }
  return CPROX_OK; /* as it was: the checks that follow will find it flat */
}

/* ---- the minimiser on two curves ---- */

typedef struct curve_jet {
  vec3 x, d1, d2;
} curve_jet;

static void jet_of(const cprox_curve *curve, const frame *f, double t, cprox_workspace *workspace, curve_jet *j) {
  (void)WORKSPACE_LEND(workspace, cprox_curve_evaluate(curve, t, workspace, &j->x, &j->d1, &j->d2));
  if (!f) return;
  j->x = frame_to_world(f, j->x);
  j->d1 = frame_turn_to_world(f, j->d1), j->d2 = frame_turn_to_world(f, j->d2);
}

static double clamp(double x, double least, double most) {
  return x < least ? least : x > most ? most : x;
}

/* Newton on |psi(t) - phi(u)|²/2 from a minimiser that is nearly one; where a radius changes on the distance less the
 * radius, times the distance. Parameters at an end stay there. */
static void refine_pair(const cprox_mover *mover, const cprox_obstacle *obstacle, cprox_workspace *workspace, double *t,
                        double *u) {
  enum { MOST_STEPS = 12 };
  const frame f = frame_create(&obstacle->pose, vec(0, 0, 0));
  double t0, t1, u0, u1;
  curve_domain(mover->curve, &t0, &t1);
  curve_domain(obstacle->curve, &u0, &u1);
  for (int i = 0; i < MOST_STEPS; i++) {
    curve_jet x, y;
    jet_of(mover->curve, NULL, *t, workspace, &x);
    jet_of(obstacle->curve, &f, *u, workspace, &y);
    const vec3 w = vec_sub(x.x, y.x);
    double gt = vec_dot(w, x.d1), gu = -vec_dot(w, y.d1), cross = -vec_dot(x.d1, y.d1);
    double htt = vec_norm2(x.d1) + vec_dot(w, x.d2), huu = vec_norm2(y.d1) - vec_dot(w, y.d2);
    const double apart = vec_norm(w);
    if (mover->radius_curve && apart > 0.0) {
      curve_jet r;
      jet_of(mover->radius_curve, NULL, *t, workspace, &r);
      const double xn = gt / apart, yn = -gu / apart;
      htt -= xn * xn + apart * r.d2.x, huu -= yn * yn, cross += xn * yn;
      gt -= apart * r.d1.x;
    }
    const bool hold_t = (*t <= t0 && gt > 0.0) || (*t >= t1 && gt < 0.0);
    const bool hold_u = (*u <= u0 && gu > 0.0) || (*u >= u1 && gu < 0.0);
    const double det = htt * huu - cross * cross;
    double dt = 0.0, du = 0.0;
    if (!hold_t && !hold_u && det > 0.0)
      dt = (cross * gu - huu * gt) / det, du = (cross * gt - htt * gu) / det;
    else if (!hold_t && hold_u && htt > 0.0)
      dt = -gt / htt;
    else if (!hold_u && hold_t && huu > 0.0)
      du = -gu / huu;
    const double next_t = clamp(*t + dt, t0, t1), next_u = clamp(*u + du, u0, u1);
    const bool still = next_t == *t && next_u == *u;
    *t = next_t, *u = next_u;
    if (still) return;
  }
}

/* ---- is it the only one? ---- */

/* Whether the mover is farther than `distance` by more than epsilon in
 * [breaks[0], breaks[1]] and [breaks[2], breaks[3]]. */
static cprox_status is_farther(cprox_mover mover, const cprox_obstacle *obstacle, const cprox_options *options,
                               const double breaks[4], double distance, cprox_workspace *workspace, bool *farther) {
  cprox_options few = *options;
  if (few.max_nodes > MOST_NODES) few.max_nodes = MOST_NODES;
  const double horizon = fmax(distance + options->epsilon, 0.0);
  *farther = true;
  for (int i = 0; i < 4 && *farther; i += 2) {
    if (!(breaks[i] < breaks[i + 1])) continue;
    cprox_profile_interval interval;
    const cprox_status status = list_profile(mover, obstacle, 1, &breaks[i], 1, horizon, &few, workspace, &interval);
    if (status < 0) return status;
    *farther = interval.lower > distance + options->epsilon;
  }
  return CPROX_OK;
}

/* Whether the mover is farther than `distance` wherever it is not near t, and
 * closer to t at least not as near. */
static cprox_status is_alone(cprox_mover mover, const cprox_obstacle *obstacle, const cprox_options *options, double t,
                             double distance, cprox_workspace *workspace, bool *alone) {
  double t0, t1, outer = 0.0;
  curve_domain(mover.curve, &t0, &t1);
  *alone = false;
  for (size_t k = 0; k < sizeof NEIGHBOURHOOD / sizeof *NEIGHBOURHOOD && !*alone; k++) {
    outer = NEIGHBOURHOOD[k] * (t1 - t0);
    const double breaks[4] = {t0, t - outer, t + outer, t1};
    const cprox_status status = is_farther(mover, obstacle, options, breaks, distance, workspace, alone);
    if (status < 0) return status;
  }
  if (!*alone) return CPROX_OK;

  cprox_options fine = *options;
  const curve_capsule whole = curve_whole(mover.curve), *all = &whole;
  fine.epsilon = HARDLY * (vec_norm(vec_sub(all->b, all->a)) + 2.0 * all->radius + fabs(distance));
  *alone = false;
  for (size_t k = 0; k < sizeof NEARBY / sizeof *NEARBY && !*alone; k++) {
    const double inner = NEARBY[k] * (t1 - t0);
    const double breaks[4] = {fmax(t - outer, t0), t - inner, t + inner, fmin(t + outer, t1)};
    const cprox_status status = is_farther(mover, obstacle, &fine, breaks, distance, workspace, alone);
    if (status < 0) return status;
  }
  return CPROX_OK;
}

/* What stands when the mover is stopped where psi is `at`, seen by an obstacle
 * curve that moves instead. */
static cprox_obstacle stopped(const cprox_mover *mover, const cprox_obstacle *obstacle, vec3 at, double radius) {
  const frame f = frame_create(&obstacle->pose, vec(0, 0, 0));
  const cprox_quat q = obstacle->pose.orientation;
  double unused = 0.0;
  return (cprox_obstacle){.body = mover->body ? mover->body : &carried_point,
                          .pose = {.position = frame_to_local(&f, at, &unused), .orientation = {q.w, -q.x, -q.y, -q.z}},
                          .margin = radius};
}

/* Whether no other pair of parts is as near at the minimiser. */
static cprox_status part_is_alone(const query *q, const placed_pair *best, double t, double distance, bool *alone) {
  const size_t parts = body_n_parts(q->obstacles[0].body), own = body_n_parts(q->mover.body);
  *alone = true;
  for (size_t i = 0; i < parts * own && *alone; i++) {
    const candidate c = {.part = (int32_t)(i / own), .mover_part = (int32_t)(i % own)};
    if (c.part == best->which.part && c.mover_part == best->which.mover_part) continue;
    beside o;
    const placed_pair other = placed_pair_resolve(q, &c);
    if (!beside_begin(&o, q, &other)) return CPROX_MEMORY;
    look seen;
    const cprox_status status = look_at(&o, t, false, &seen);
    if (status < 0) return status;
    *alone = seen.distance - offset_of(&o) - seen.radius > distance + 2.0 * q->options.epsilon;
  }
  return CPROX_OK;
}

/* How much the normal differs a step to either side, along the axis where that
 * is most. */
static cprox_status lean_of(beside *o, const look *here, double step, double *lean) {
  *lean = 0.0;
  for (int i = 0; i < 3; i++) {
    look seen[2];
    for (int k = 0; k < 2; k++) {
      const double d = k ? step : -step;
      const vec3 y = vec_add(here->y, vec(i == 0 ? d : 0.0, i == 1 ? d : 0.0, i == 2 ? d : 0.0));
      const cprox_status status = look_from(o, here->piece, here->s, y, 0.0, &seen[k]);
      if (status < 0) return status;
    }
    *lean = fmax(vec_norm(vec_sub(seen[1].normal, seen[0].normal)), *lean);
  }
  return CPROX_OK;
}

/* Inside, and where that cannot be told, the way out may change from one face to another, and of many elements another
 * may be as near: then the normal jumps nearby. */
static cprox_status normal_is_alone(beside *o, const look *here, bool *alone) {
  static const double NOISE = 2e-5; /* normals of carried bodies are known to
                                       the root of what depths are */
  *alone = true;
  if (!o->is_tree && here->distance > 2.0 * here->slack) return CPROX_OK;
  double near, far = 0.0;
  cprox_status status = lean_of(o, here, TIES_NEAR * size_of(o), &near);
  if (status >= 0 && near > NOISE) status = lean_of(o, here, TIES_FAR * size_of(o), &far);
  *alone = !ties_is_jump(near, far, NOISE);
  return status < 0 ? status : CPROX_OK;
}

/* The mover at t, and what stands, or is on its clock, where it is then. */
static placed_bodies bodies_at(const query *q, const placed_pair *c, double t) {
  placed_bodies p = {.b = q->obstacles[0],
                     .part_a = (size_t)c->which.mover_part,
                     .part_b = (size_t)c->which.part,
                     .finest = q->options.max_lod,
                     .depth = q->is_signed,
                     .workspace = q->workspace};
  p.a = (cprox_obstacle){.body = q->mover.body ? q->mover.body : &carried_point,
                         .pose = {.orientation = {1, 0, 0, 0}},
                         .margin = q->mover.radius + radius_at(q->mover.radius_curve, t, false, q->workspace)};
  p.b.margin += radius_at(p.b.radius_curve, t, false, q->workspace);
  (void)WORKSPACE_LEND(q->workspace,
                       cprox_curve_evaluate(q->mover.curve, t, q->workspace, &p.a.pose.position, NULL, NULL));
  if (!p.b.synchronized) return p;
  p.b.pose.position = relative_position(p.b.curve, &p.b.pose, t, false, q->workspace);
  if (!p.b.body) p.b.body = &carried_point;
  return p;
}

static bool is_round(const cprox_body *body) {
  return !body || body->kind == CPROX_BODY_POINT || body->kind == CPROX_BODY_SPHERE;
}

/* A ball has one nearest point where it has one normal. Two other bodies may
 * meet along an edge or a face. */
static cprox_status nearest_is_alone(const query *q, const placed_pair *c, double t, bool *alone) {
  const cprox_body *standing = c->shape, *carried = c->carried;
  *alone = true;
  if (is_round(standing) || is_round(carried)) return CPROX_OK;
  placed_bodies p = bodies_at(q, c, t);
  p.size = carried->shape.scale + carried->shape.margin;
  if (standing->kind != CPROX_BODY_HALFSPACE) p.size = fmin(p.size, standing->shape.scale + standing->shape.margin);
  return ties_point_is_alone(&p, alone);
}

/* ---- the gradient ---- */

static void fill(const cprox_obstacle *obstacle, vec3 n, vec3 witness_obstacle, cprox_gradient *g) {
  const frame f = frame_create(&obstacle->pose, vec(0, 0, 0));
  g->mover = n;
  g->position = vec_neg(n);
  g->rotation = vec_cross(n, vec_sub(witness_obstacle, obstacle->pose.position));
  g->obstacle_point = obstacle->curve ? frame_turn_to_local(&f, vec_neg(n)) : vec(0, 0, 0);
  g->radius = g->margin = -1.0;
}

static cprox_status gradient_of_body(const query *q, const placed_pair *c, cprox_gradient *g) {
  beside o;
  if (!beside_begin(&o, q, c)) return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for a gradient");
  if (!o.is_tree) o.of.convex.effort.epsilon = 1e-3 * q->options.epsilon;
  int end;
  cprox_status status = refine(&o, q->t0, q->t1, &g->t, &end);
  look here = {.slope = 0.0};
  if (status == CPROX_OK) status = look_at(&o, g->t, end > 0, &here);
  if (status < 0) return status;
  const double distance = here.distance - offset_of(&o) - here.radius;
  if (end < 0) g->t0 = here.slope;
  if (end > 0) g->t1 = here.slope;

  cprox_result r = {.t_obstacle = NAN};
  curve_finding seen;
  finding_of(&o, &here, &seen);
  status = report_finding(q, c, &seen, &r);
  if (status < 0) return status;
  fill(&q->obstacles[0], r.normal, r.witness_obstacle, g);
  if (q->obstacles[0].synchronized) g->t_obstacle = g->t;
  if (vec_norm2(r.normal) == 0.0) return invalid(q->workspace, g, "there is no normal");
  if ((!q->is_signed || o.is_tree) && !(distance > here.slack)) return invalid(q->workspace, g, "the distance is 0");

  bool alone = true;
  status = normal_is_alone(&o, &here, &alone);
  if (status < 0) return status;
  if (!alone)
    return invalid(q->workspace, g,
                   o.is_tree ? "the nearest points are not the only ones" : "there is more than one way out");
  status = nearest_is_alone(q, c, g->t, &alone);
  if (status < 0) return status;
  if (!alone) return invalid(q->workspace, g, "the nearest points are not the only ones");
  status = part_is_alone(q, c, g->t, distance, &alone);
  if (status < 0) return status;
  if (!alone) return invalid(q->workspace, g, "two parts are equally near");
  status = is_alone(q->mover, q->obstacles, &q->options, g->t, distance, q->workspace, &alone);
  if (status < 0) return status;
  if (!alone) return invalid(q->workspace, g, "the distance is as small elsewhere along the curve");
  g->valid = true;
  return CPROX_OK;
}

/* A carried body may leave the curve that crosses it by more than one side. */
static cprox_status carried_way_out_is_alone(const query *q, const placed_pair *c, vec3 on_curve, double t,
                                             double distance, bool *alone) {
  *alone = true;
  placed_bodies p = {.b = q->obstacles[0]};
  if (q->mover.body) p = bodies_at(q, c, t);
  if (!q->mover.body || !(distance + p.a.margin + q->obstacles[0].margin <= 0.0)) return CPROX_OK;
  p.b = (cprox_obstacle){.body = &carried_point, .pose = {on_curve, {1, 0, 0, 0}}, .margin = q->obstacles[0].margin};
  p.part_b = 0;
  p.size = q->mover.body->ball_radius;
  return ties_normal_is_alone(&p, alone);
}

static cprox_status gradient_of_curve(const query *q, const placed_pair *c, const cprox_result *result,
                                      cprox_gradient *g) {
  const cprox_obstacle *obstacle = &q->obstacles[0];
  if (!q->mover.body) refine_pair(&q->mover, obstacle, q->workspace, &g->t, &g->t_obstacle);
  const frame f = frame_create(&obstacle->pose, vec(0, 0, 0));
  curve_jet x, y;
  jet_of(q->mover.curve, NULL, g->t, q->workspace, &x);
  jet_of(obstacle->curve, &f, g->t_obstacle, q->workspace, &y);
  vec3 n = vec_sub(x.x, y.x);
  curve_jet thickness = {.x = vec(0, 0, 0)};
  if (q->mover.radius_curve) jet_of(q->mover.radius_curve, NULL, g->t, q->workspace, &thickness);
  const double radius = q->mover.radius + thickness.x.x;
  double distance = vec_norm(n) - radius - obstacle->margin;
  n = vec_norm(n) > 0.0 ? vec_scale(1.0 / vec_norm(n), n) : n;
  if (q->mover.body) n = result->normal, distance = result->upper;
  fill(obstacle, n, y.x, g);
  double t0, t1;
  curve_domain(q->mover.curve, &t0, &t1);
  if (g->t == t0) g->t0 = fmax(vec_dot(n, x.d1) - thickness.d1.x, 0.0);
  if (g->t == t1) g->t1 = fmin(vec_dot(n, x.d1) - thickness.d1.x, 0.0);
  if (vec_norm2(n) == 0.0) return invalid(q->workspace, g, "there is no normal");
  if (!q->is_signed && !(distance > 0.0)) return invalid(q->workspace, g, "the distance is 0");

  bool alone = true;
  cprox_status status = carried_way_out_is_alone(q, c, y.x, g->t, distance, &alone);
  if (status < 0) return status;
  if (!alone) return invalid(q->workspace, g, "there is more than one way out");
  status = is_alone(q->mover, obstacle, &q->options, g->t, distance, q->workspace, &alone);
  if (status < 0) return status;
  if (!alone) return invalid(q->workspace, g, "the distance is as small elsewhere along the curve");
  const cprox_obstacle other = stopped(&q->mover, obstacle, x.x, radius);
  const cprox_mover moved = cprox_tube_along(obstacle->curve, obstacle->margin);
  status = is_alone(moved, &other, &q->options, g->t_obstacle, distance, q->workspace, &alone);
  if (status < 0) return status;
  if (!alone) return invalid(q->workspace, g, "another point of the obstacle's curve is as near");
  g->valid = true;
  return CPROX_OK;
}

cprox_status cprox_distance_gradient(cprox_mover mover, cprox_obstacle obstacle, const cprox_options *options,
                                     const cprox_result *result, cprox_workspace *workspace, cprox_gradient *gradient) {
  WORKSPACE_USE(workspace);
  query q = query_create(mover, &obstacle, 1, -1.0, options, workspace);
  workspace_clear(workspace);
  if (mover.motion) return workspace_fail(workspace, CPROX_INVALID, "no gradient is known along a robot's motion");
  const arguments_query asked = {"a gradient", ARGUMENTS_SEARCH | ARGUMENTS_SIGNED | ARGUMENTS_RADIUS};
  const cprox_status checked = validate_query(&mover, &obstacle, 1, &q.options, asked, workspace);
  if (checked != CPROX_OK) return checked;
  if (!result || !gradient)
    return workspace_fail(workspace, CPROX_INVALID, "%s is NULL", result ? "gradient" : "result");
  const candidate c = {.part = result->obstacle_part, .mover_part = result->mover_part};
  if (result->obstacle_index < 0 || !isfinite(result->upper))
    return workspace_fail(workspace, CPROX_INVALID, "the result has no witness: ask for a distance");
  const bool is_field = obstacle.body && obstacle.body->field;
  if (mover.curve->arcs || (obstacle.curve && obstacle.curve->arcs) || is_field)
    return workspace_fail(workspace, CPROX_INVALID, "no gradient is known for %s",
                          is_field ? "sets known by their distance" : "a curve without derivatives");
  query_ask_whole(&q);
  if (!(q.t0 <= result->t && result->t <= q.t1))
    return workspace_fail(workspace, CPROX_INVALID, "the result's t = %.17g is not on the mover's curve", result->t);
  if (obstacle.body && obstacle.body->kind == CPROX_BODY_COMPOUND &&
      !(result->obstacle_part >= 0 && (size_t)result->obstacle_part < obstacle.body->n_parts))
    return workspace_fail(workspace, CPROX_INVALID, "the result's obstacle_part %d is no part of the obstacle",
                          result->obstacle_part);

  /* the whole curve is searched as narrowly as other minimisers are to be told
   * apart */
  q.is_signed = q.options.signed_distance;
  const curve_capsule whole = curve_whole(mover.curve), *all = &whole;
  const double length = vec_norm(vec_sub(all->b, all->a)) + 2.0 * all->radius;
  q.options.epsilon = fmin(q.options.epsilon, APART * length);
  q.options.relative_epsilon = 0.0;
  cprox_gradient g = {.t = result->t, .t_obstacle = NAN};
  cprox_status status;
  const placed_pair placed = placed_pair_resolve(&q, &c);
  if (placed.shape) {
    status = gradient_of_body(&q, &placed, &g);
  } else {
    g.t_obstacle = result->t_obstacle;
    status = gradient_of_curve(&q, &placed, result, &g);
  }
  if (status == CPROX_OK) *gradient = g;
  return status;
}
