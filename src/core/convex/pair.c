/* SPDX-License-Identifier: BSD-3-Clause */
/* Distance or depth of two convex cores: GJK with a Newton method on the dual (doc/convex-pairs.md).
 *
 * Two bounds meet. Above: the distance from 0 of a simplex in the Minkowski difference M = A - B, as in GJK (gjk.c).
 * Below: phi(u) = min of u·m over M, concave, whose greatest value over unit u is the distance.
 *   1. Alternating projections (alternating_projections.c), where both cores allow them.
 *   2. Else GJK: look along u for phi(u) and for a new vertex of the simplex; reduce the simplex.
 *   3. Where the shapes are curved, u comes from Newton's method on phi: the vertices of the simplex follow u on
 *      their smooth pieces, whose curvatures give the second derivative. A step that keeps more than 0.7 of the
 *      gap has failed, and GJK's direction comes next.
 *   4. If 0 lies inside, EPA measures the depth (epa.c).
 *
 * Departure: GJK ends at its own accuracy. Here the search ends when both bounds, rounding included, are as close as
 * the goal asks, and the interval is what is returned. */
#include "convex/pair.h"

#include "base/rotation.h"
#include "base/rounding.h"
#include "convex/alternating_projections.h"
#include "convex/epa.h"
#include "convex/feature.h"
#include "convex/simplex.h"
#include "convex/vertices.h"

enum {
  PAIR_MAX_STEPS = 256,
  PAIR_NEWTON_FROM = 2, /* plain steps first: far away the curvature is not that of the answer */
  PAIR_NEWTON_FROM_MET =
      12, /* where they overlap: vertices moved along their pieces lie close, a worse beginning for a depth */
  PAIR_PATIENCE_CURVED = 24, /* steps without a gain */
  PAIR_PATIENCE_FLAT = 6,
  PAIR_MAX_IDLE = 8,
  PAIR_ROUNDS = 6 /* of drawing overlapping shapes apart */
};

/* Rounding of the bounds for shapes of size S, in units of u S: a crude sum of the steps gives 24. */
static const double PAIR_ROUNDING = 32.0;

/* Overlaps that are no deeper, in units of a bound's rounding, are not searched for beyond the simplices. */
static const double PAIR_SHALLOW = 8.0;

/* A simplex that holds 0 so much less deep than M may hold it says too little. */
static const double PAIR_THIN = 1e-6;

/* A way out is alone where it stays the nearest while the bodies move by this part of the smaller one's size. */
static const double PAIR_SHIFT = 2e-6;

/* A Newton step has failed if more than this is left of the gap. */
static const double PAIR_NEWTON_GAIN = 0.7;

typedef struct pair {
  const convex *a, *b;
  const double *r;
  vec3 t;
  bool curved, support_failed;
  bool met;                 /* the cores have a point in common within the tolerance */
  double rounding;          /* of either bound */
  double contact_tolerance; /* distances that differ by less are the same */
  uint32_t steps, supports;

  /* the primal side: the simplex and its nearest point to 0 */
  simplex s;
  simplex_nearest nearest;
  double least; /* the shortest distance so far */
  int idle;     /* simplices since that got shorter by more than the tolerance */
  /* the dual side: the best direction and its phi */
  vec3 u;
  double lower;
} pair;

/* b is kept in its own frame: a direction there, and a point of b from there. */
static vec3 pair_turn_to_b(const pair *p, vec3 v) {
  return rotate_back(p->r, v);
}

static vec3 pair_from_b(const pair *p, vec3 b) {
  return vec_add(rotate(p->r, b), p->t);
}

static vec3 pair_difference(const pair *p, vec3 a, vec3 b) {
  return vec_sub(a, pair_from_b(p, b));
}

/* Adds a vertex unless it is there already. */
static bool pair_add(simplex *s, const simplex_vertex *x) {
  if (simplex_has(s, x->w)) return false;
  s->vertex[s->n++] = *x;
  return true;
}

/* What a support point fails to reach of the support value along d. An implicit shape's value is a bound from above;
 * its point is one of the body, and may stay behind where exponents are near 1. */
static double missed(const convex *shape, double value, vec3 d, vec3 at) {
  return shape->implicit ? fmax(value - vec_dot(d, at), 0.0) : 0.0;
}

/* A polytope that is given by its vertices; the hull of a mesh is known by its support function alone. */
static bool has_vertices(const convex *shape) {
  return shape->ops->kind == CPROX_BODY_POLYTOPE && shape->n > 0;
}

/* The support function, and the number of the vertex where the shape is a polytope. */
static double support_of(const convex *shape, vec3 d, vec3 *at, int32_t *id) {
  if (!has_vertices(shape)) return shape->ops->support(shape, d, NULL, at);
  double h;
  *id = vertices_extreme(shape, d, &h);
  *at = vertices_at(shape, *id);
  return h;
}

/* The point of M that is least along u. */
static simplex_vertex pair_extreme(pair *p, vec3 u) {
  simplex_vertex x = {.id = -1, .id_b = -1};
  const vec3 da = vec_neg(u), db = pair_turn_to_b(p, u);
  const double ha = support_of(p->a, da, &x.a, &x.id);
  const double hb = support_of(p->b, db, &x.b, &x.id_b);
  if (isnan(ha) || isnan(hb)) p->support_failed = true;
  x.w = pair_difference(p, x.a, x.b);
  x.behind = missed(p->a, ha, da, x.a) + missed(p->b, hb, db, x.b);
  p->supports++;
  return x;
}

static void pair_raise_lower(pair *p, vec3 u, double phi) {
  if (!(phi > p->lower)) return;
  p->lower = phi;
  p->u = u;
}

/* Takes a grown simplex over if it is nearer than the one at hand; as far away within the tolerance will do for a
 * while, since at a flat corner no step is longer. */
static bool pair_accept(pair *p, simplex *grown) {
  simplex_nearest found;
  simplex_reduce(grown, &found);
  if (!found.inside && !(found.distance < p->least + p->contact_tolerance)) return false;
  p->idle = found.inside || found.distance < p->least - p->contact_tolerance ? 0 : p->idle + 1;
  if (p->idle > PAIR_MAX_IDLE) return false;
  p->least = fmin(p->least, found.distance);
  p->s = *grown;
  p->nearest = found;
  return true;
}

/* ---- the second-order step of the dual ---- */

/* The smooth pieces of M's boundary on which the simplex's vertices lie, seen along one direction. */
typedef struct pair_pieces {
  int n;
  simplex_vertex y[4];
  double weight[4];
  double kee, kef, kff; /* weighted curvature in the tangent basis */
} pair_pieces;

/* The extreme point of the piece that x lies on, or x itself where that would carry it far round a rim: seen along its
 * axis a disc's rim is extreme everywhere, and its points must not run together. */
static bool piece_follow(const convex *shape, vec3 d, vec3 *x) {
  if (!shape->ops->follow) return false;
  const vec3 moved = shape->ops->follow(shape, d, *x), step = vec_sub(moved, *x);
  const double far = 0.3 * shape->scale;
  if (vec_norm2(step) > far * far) return false;
  *x = moved;
  return true;
}

static void pieces_add_curvature(pair_pieces *pieces, double weight, const double h[6], vec3 e, vec3 f) {
  pieces->kee += weight * feature_quadratic(h, e, e);
  pieces->kef += weight * feature_quadratic(h, e, f);
  pieces->kff += weight * feature_quadratic(h, f, f);
}

/* The simplex's vertices moved to where u finds them on their pieces; those that fall together are one. e and f NULL:
 * their curvature is not asked for. */
static pair_pieces pair_follow(const pair *p, vec3 u, const vec3 *e, const vec3 *f) {
  const vec3 da = vec_neg(u), db = pair_turn_to_b(p, u);
  const double same = 1e-12 * (p->a->scale + p->b->scale);
  pair_pieces pieces = {0};
  for (int i = 0; i < p->s.n; i++) {
    simplex_vertex y = p->s.vertex[i];
    const double weight = p->s.weight[i];
    double h[6];
    if (piece_follow(p->a, da, &y.a) && e) {
      p->a->ops->curvature(p->a, da, y.a, h);
      pieces_add_curvature(&pieces, weight, h, *e, *f);
    }
    if (piece_follow(p->b, db, &y.b) && e) {
      p->b->ops->curvature(p->b, db, y.b, h);
      pieces_add_curvature(&pieces, weight, h, pair_turn_to_b(p, *e), pair_turn_to_b(p, *f));
    }
    y.w = pair_difference(p, y.a, y.b);
    int twin = 0;
    while (twin < pieces.n && vec_norm2(vec_sub(pieces.y[twin].w, y.w)) > same * same) twin++;
    if (twin == pieces.n) {
      pieces.y[pieces.n] = y;
      pieces.weight[pieces.n++] = 0.0;
    }
    pieces.weight[twin] += weight;
  }
  return pieces;
}

/* One piece: grad phi = y, and its second derivative is -(K + d), d the distance, minus the depth. */
static bool newton_one(const pair_pieces *k, double d, vec3 e, vec3 f, double delta[2]) {
  const double a = k->kee + d, b = k->kef, c = k->kff + d, det = a * c - b * b;
  if (!(det > 0.0) || !(a > 0.0)) return false;
  const double ge = vec_dot(k->y[0].w, e), gf = vec_dot(k->y[0].w, f);
  delta[0] = (c * ge - b * gf) / det;
  delta[1] = (a * gf - b * ge) / det;
  return true;
}

/* Two pieces: along the ridge where they are equal, Newton on their weighted mean. */
static bool newton_two(const pair_pieces *k, double d, vec3 u, vec3 e, vec3 f, double delta[2]) {
  const vec3 apart = vec_sub(k->y[1].w, k->y[0].w);
  const vec3 mean = vec_axpy(vec_scale(k->weight[0], k->y[0].w), k->weight[1], k->y[1].w);
  const double pe = vec_dot(apart, e), pf = vec_dot(apart, f), square = pe * pe + pf * pf;
  if (!(square > 0.0)) return false;
  const double across = -vec_dot(u, apart) / square, norm = sqrt(square);
  const double de = across * pe, df = across * pf, ne = -pf / norm, nf = pe / norm;
  const double curvature = ne * ne * k->kee + 2.0 * ne * nf * k->kef + nf * nf * k->kff + d;
  if (!(curvature > 0.0)) return false;
  const double coupled = ne * (k->kee * de + k->kef * df) + nf * (k->kef * de + k->kff * df);
  const double along = (ne * vec_dot(mean, e) + nf * vec_dot(mean, f) - coupled) / curvature;
  delta[0] = de + along * ne;
  delta[1] = df + along * nf;
  return true;
}

/* Where Newton's method sends the best direction, at a distance d; false where it has no say. */
static bool pair_newton(const pair *p, double d, vec3 *next) {
  vec3 e, f;
  feature_tangents(p->u, &e, &f);
  const pair_pieces pieces = pair_follow(p, p->u, &e, &f);
  double delta[2];
  if (pieces.n == 1) {
    if (!newton_one(&pieces, d, e, f, delta)) return false;
  } else if (pieces.n == 2) {
    if (!newton_two(&pieces, d, p->u, e, f, delta)) return false;
  } else {
    const vec3 y0 = pieces.y[0].w;
    vec3 normal;
    feature_unit(vec_cross(vec_sub(pieces.y[1].w, y0), vec_sub(pieces.y[2].w, y0)), &normal);
    *next = vec_dot(normal, p->u) < 0.0 ? vec_neg(normal) : normal;
    return vec_norm2(normal) > 0.0;
  }
  const double length = feature_hypot(delta[0], delta[1]), limit = 0.5;
  if (!isfinite(length)) return false;
  const double scale = length > limit ? limit / length : 1.0;
  feature_unit(vec_axpy(vec_axpy(p->u, scale * delta[0], e), scale * delta[1], f), next);
  return true;
}

/* ---- the search ---- */

bool pair_is_reached(const pair_goal *goal, double margins, double rounding, double lower, double upper) {
  if (goal->verdict && (lower - margins - rounding > goal->limit || upper - margins + rounding <= goal->limit))
    return true;
  const double above = lower - margins - rounding - goal->floor;
  const double relative = goal->relative_epsilon * greater(upper - margins, 0.0);
  const double asked = greater(greater(goal->epsilon, relative), goal->fraction * above);
  return upper - lower <= greater(asked - 2.0 * rounding, 0.25 * rounding);
}

/* The simplex's vertices where u finds them on their pieces. */
static simplex pair_moved(const pair *p, vec3 u) {
  const pair_pieces pieces = pair_follow(p, u, NULL, NULL);
  simplex moved = {0};
  for (int i = 0; i < pieces.n && i < 3; i++) moved.vertex[moved.n++] = pieces.y[i];
  return moved;
}

/* Looks along u: a lower bound, and a vertex that may bring the simplex nearer; on curved shapes its other vertices are
 * moved along their pieces as well, since the old ones would hold it back. True where one of the bounds got better. */
static bool pair_support_step(pair *p, vec3 u, bool follow) {
  const simplex_vertex x = pair_extreme(p, u);
  const double lower = p->lower;
  pair_raise_lower(p, u, vec_dot(u, x.w) - x.behind);
  bool nearer = false;
  if (follow) {
    simplex moved = pair_moved(p, u);
    pair_add(&moved, &x);
    nearer = pair_accept(p, &moved);
  }
  if (!nearer && p->s.n < 4) {
    simplex grown = p->s;
    nearer = pair_add(&grown, &x) && pair_accept(p, &grown);
  }
  return nearer || p->lower > lower;
}

/* One step: Newton's direction if there is one, else the simplex's own normal, else that of its nearest point. Two
 * plain directions, since the normal is exact where v is all rounding, and v where the simplex is a sliver. */
static bool pair_step(pair *p, bool newton) {
  vec3 u;
  /* a negative phi would make a valley of a peak */
  const double d = 0.5 * (fmax(p->lower, 0.0) + p->nearest.distance);
  if (newton && pair_newton(p, d, &u)) return pair_support_step(p, u, true);
  const vec3 normal = p->nearest.normal;
  if (vec_norm2(normal) > 0.0 && pair_support_step(p, normal, false)) return true;
  if (p->nearest.inside || p->support_failed) return true;
  feature_unit(p->nearest.v, &u);
  return vec_norm2(u) > 0.0 && !vec_equal(u, normal) && pair_support_step(p, u, false);
}

/* Starts again from all round. */
static void pair_restart(pair *p) {
  simplex s = {0};
  for (int i = 0; i < 4; i++) {
    vec3 u;
    feature_unit(simplex_spread[i], &u);
    const simplex_vertex x = pair_extreme(p, u);
    pair_raise_lower(p, u, vec_dot(u, x.w) - x.behind);
    pair_add(&s, &x);
  }
  p->least = INFINITY;
  p->idle = 0;
  pair_accept(p, &s);
}

/* ---- vertices of a former answer ---- */

static bool vertex_of(const convex *shape, int32_t id, vec3 *at) {
  if (has_vertices(shape) && id >= 0 && id < shape->n) {
    *at = vertices_at(shape, id);
    return true;
  }
  if (shape->ops != &convex_box || id < 0 || id > 7) return false;
  const double *h = shape->size;
  *at = vec(id & 1 ? h[0] : -h[0], id & 2 ? h[1] : -h[1], id & 4 ? h[2] : -h[2]);
  return true;
}

static int32_t number_of(const convex *shape, vec3 at, int32_t id) {
  if (shape->ops != &convex_box) return id;
  const double *h = shape->size;
  if (fabs(at.x) != h[0] || fabs(at.y) != h[1] || fabs(at.z) != h[2]) return -1;
  return (int32_t)(at.x > 0.0) | (int32_t)(at.y > 0.0) << 1 | (int32_t)(at.z > 0.0) << 2;
}

static void pair_keep_vertices(const pair *p, pair_vertices *kept) {
  kept->n = 0;
  if (p->nearest.inside || p->s.n > 3) return;
  for (int i = 0; i < p->s.n; i++) {
    kept->a[i] = number_of(p->a, p->s.vertex[i].a, p->s.vertex[i].id);
    kept->b[i] = number_of(p->b, p->s.vertex[i].b, p->s.vertex[i].id_b);
    if (kept->a[i] < 0 || kept->b[i] < 0) return;
  }
  kept->n = p->s.n;
}

/* The simplex of a former answer where the shapes are now, and the extreme point along its normal: if that feature is
 * still the nearest, both bounds meet there. */
static bool pair_begin_known(pair *p, const pair_vertices *known) {
  simplex s = {0};
  for (int i = 0; i < known->n && i < 3; i++) {
    simplex_vertex x = {.id = known->a[i], .id_b = known->b[i]};
    if (!vertex_of(p->a, x.id, &x.a) || !vertex_of(p->b, x.id_b, &x.b)) return false;
    x.w = pair_difference(p, x.a, x.b);
    pair_add(&s, &x);
  }
  if (s.n == 0) return false;
  simplex_reduce(&s, &p->nearest);
  if (p->nearest.inside || p->nearest.distance <= p->contact_tolerance || !(vec_norm2(p->nearest.normal) > 0.0))
    return false;
  p->s = s;
  p->least = p->nearest.distance;
  p->u = p->nearest.normal;
  p->lower = -INFINITY;
  pair_support_step(p, p->u, false);
  return true;
}

/* From the extreme point along u until the bounds are within what is asked for, or stop moving. */
static void pair_search(pair *p, vec3 u, double margins, const pair_goal *goal) {
  const uint32_t most = goal->max_steps < PAIR_MAX_STEPS ? goal->max_steps : PAIR_MAX_STEPS;
  const int patience = p->curved ? PAIR_PATIENCE_CURVED : PAIR_PATIENCE_FLAT;
  int stalled = 0, failures = 0, plain = p->met ? PAIR_NEWTON_FROM_MET : PAIR_NEWTON_FROM;
  bool restarted = false;

  p->idle = 0;
  if (!goal->known || !pair_begin_known(p, goal->known)) {
    p->s.n = 1;
    p->s.vertex[0] = pair_extreme(p, u);
    p->u = u;
    p->lower = vec_dot(u, p->s.vertex[0].w) - p->s.vertex[0].behind;
    simplex_reduce(&p->s, &p->nearest);
    p->least = p->nearest.distance;
  }

  for (p->steps++; p->steps < most && !p->support_failed && !p->nearest.inside; p->steps++) {
    const double gap = p->nearest.distance - p->lower;
    if (pair_is_reached(goal, margins, p->rounding, p->lower, p->nearest.distance)) return;

    /* 0 on a feature of the simplex: they touch, or overlap with 0 there by chance */
    if (p->nearest.distance <= p->contact_tolerance) {
      if (restarted) return;
      restarted = true;
      pair_restart(p);
      continue;
    }

    /* a Newton step that gains little is followed by plain ones, by one more after each further failure */
    const bool newton = p->curved && plain == 0;
    const bool gained = pair_step(p, newton);
    const double left = (p->nearest.distance - p->lower) / gap;
    if (!newton) {
      if (!gained && stalled > PAIR_PATIENCE_FLAT) return;
      plain = plain > 0 ? plain - 1 : 0;
    } else if (left > PAIR_NEWTON_GAIN) {
      plain = ++failures;
    } else {
      failures = 0;
    }
    stalled = left < 0.98 ? 0 : stalled + 1;
    if (stalled > patience || (!gained && !p->curved)) return;
  }
}

/* Where the shapes touch or overlap the simplex has no direction to offer. So b is drawn back along the best direction
 * until it is free, and the direction of the distance there is tried here; closer and closer, since where they are
 * curved the direction found is only as good as the distance was short. */
static void pair_separate_slightly(pair *p, double size, const pair_goal *goal) {
  double clear = 1e-3 * size;
  for (int round = 0;
       round < PAIR_ROUNDS && p->lower < -p->rounding && !p->support_failed && p->steps < goal->max_steps;
       round++, clear *= 1e-2) {
    pair q = *p;
    q.t = vec_axpy(p->t, p->lower - clear, p->u);
    q.met = false;
    const pair_goal enough = {.relative_epsilon = 1e-6, .max_steps = goal->max_steps};
    pair_search(&q, p->u, 0.0, &enough);
    p->supports = q.supports;
    p->steps = q.steps;
    p->support_failed = q.support_failed;

    const double before = p->lower;
    const simplex_vertex x = pair_extreme(p, q.u);
    pair_raise_lower(p, q.u, vec_dot(q.u, x.w) - x.behind);
    if (!(p->lower > 0.99 * before)) return;
  }
}

/* The points of the cores that make up the nearest point of the simplex. */
static void pair_core_points(const pair *p, vec3 *a, vec3 *b) {
  *a = *b = vec(0, 0, 0);
  for (int i = 0; i < p->s.n; i++) {
    *a = vec_axpy(*a, p->s.weight[i], p->s.vertex[i].a);
    *b = vec_axpy(*b, p->s.weight[i], p->s.vertex[i].b);
  }
  *b = pair_from_b(p, *b);
}

/* Draws what belongs to implicit cores into them; the distance of the two points, which is not less than the cores'. */
static double pair_draw(const pair *p, vec3 *a, vec3 *b) {
  if (p->a->drawn == 0.0 && p->b->drawn == 0.0) return p->nearest.distance;
  *a = convex_drawn(p->a, *a);
  *b = vec_axpy(*b, -p->b->drawn, vec_sub(*b, p->t));
  return vec_norm(vec_sub(*a, *b));
}

/* Those points, and the margins beyond them; how far apart the cores' are. */
static double pair_points(const pair *p, double margin_a, double margin_b, pair_answer *answer) {
  vec3 a, b, along;
  pair_core_points(p, &a, &b);
  const double apart = p->nearest.inside ? 0.0 : pair_draw(p, &a, &b);
  const vec3 core = a;
  if (p->nearest.inside) { /* 0 = sum of weight (a - b): the same point but for rounding, of both */
    a = b = vec_axpy(vec_scale(0.5, a), 0.5, b);
  } else { /* out of the cores along the line between the two, so that what is left of it is upper */
    if (feature_unit(apart == p->nearest.distance ? p->nearest.v : vec_sub(a, b), &along) == 0.0) along = p->u;
    a = vec_axpy(a, -margin_a, along);
    b = vec_axpy(b, margin_b, along);
  }
  answer->on_a = a;
  answer->on_b = b;
  /* the ball round b reaches a, or the two balls reach each other */
  answer->common = p->nearest.inside || apart > margin_b ? b : core;
  answer->normal = p->nearest.inside ? vec(0, 0, 0) : p->u;
  return apart;
}

/* The distance d has the second derivative (K + d)^-1 in the tangent plane, and none along a ridge or a face. */
static void pair_describe(const pair *p, pair_feature *feature) {
  *feature = (pair_feature){.flat = !p->curved, .n = p->s.n};
  if (feature->flat) {
    for (int i = 0; i < p->s.n && i < 3; i++) feature->w[i] = p->s.vertex[i].w, feature->b[i] = p->s.vertex[i].b;
    return;
  }
  vec3 e, f;
  feature_tangents(p->u, &e, &f);
  const pair_pieces pieces = pair_follow(p, p->u, &e, &f);
  const double a = pieces.kee + p->nearest.distance, b = pieces.kef, c = pieces.kff + p->nearest.distance;
  double ee = 0.0, ef = 0.0, ff = 0.0;
  if (pieces.n == 1) {
    const double det = a * c - b * b;
    if (det > 0.0) ee = c / det, ef = -b / det, ff = a / det;
  } else if (pieces.n == 2) { /* across the ridge only */
    const vec3 apart = vec_sub(pieces.y[1].w, pieces.y[0].w);
    const double pe = vec_dot(apart, e), pf = vec_dot(apart, f), square = pe * pe + pf * pf;
    const double across = pf * pf * a - 2.0 * pe * pf * b + pe * pe * c;
    if (across > 0.0) ee = pf * pf / across, ef = -pe * pf / across, ff = pe * pe / across;
    if (!(square > 0.0)) ee = ef = ff = 0.0;
  }
  const double x[3] = {e.x, e.y, e.z}, y[3] = {f.x, f.y, f.z};
  for (int i = 0, k = 0; i < 3; i++)
    for (int j = i; j < 3; j++)
      feature->hessian[k++] = ee * x[i] * x[j] + ef * (x[i] * y[j] + y[i] * x[j]) + ff * y[i] * y[j];
}

static simplex_vertex pair_farthest(void *self, vec3 n) {
  return pair_extreme(self, vec_neg(n));
}

/* How far a point of b is moved at most if b's axis is laid on a's; infinity where one of them has none. */
static double pair_misalignment(const pair *p) {
  if (!convex_is_round(p->a) || !convex_is_round(p->b)) return INFINITY;
  const double tilt = feature_hypot(p->r[2], p->r[5]); /* the sine; the chord is at most sqrt(2) times as long */
  return 1.5 * tilt * p->b->scale + feature_hypot(p->t.x, p->t.y);
}

/* Where 0 lies on a plane through vertices of M, no simplex of theirs may have it inside. A place beside 0 lies on none
 * by chance: it is enclosed, and the surface round it grows until it holds 0 as well. The farther the place the clearer
 * it is of all planes; what is less deep is missed. */
static bool pair_expand_beside(pair *p, const epa_goal *goal, epa_depth *depth) {
  static const double beside[] = {1024.0, 64.0, 16.0, 8.0};
  const epa_set set = {.self = p, .farthest = pair_farthest};
  epa_goal left = *goal;
  for (int round = 0; round < 8 && left.max_steps > 1; round++) { /* twice each, not in the same direction */
    const double far = beside[round / 2] * p->rounding;
    if (!(p->lower < -2.0 * far)) continue;
    vec3 shift, inwards; /* M lies about -t */
    feature_unit(vec_norm(p->t) > p->a->scale * 1e-3 ? vec_neg(p->t) : vec(0, 0, 0), &inwards);
    feature_unit(vec_axpy(inwards, 0.5, simplex_spread[(round + round / 4) % 4]), &shift);
    shift = vec_scale(far, shift);
    pair q = *p;
    q.t = vec_add(p->t, shift);
    q.met = true;
    q.steps = 0;
    const pair_goal inside = {.max_steps = left.max_steps};
    pair_search(&q, p->u, 0.0, &inside);
    p->supports = q.supports;
    p->steps += q.steps;
    p->support_failed = q.support_failed;
    if (p->support_failed) return false;
    left.max_steps -= q.steps < left.max_steps ? q.steps : left.max_steps;
    if (!epa_beside(&set, &q.s, shift, &left, depth)) continue;
    if (far < p->nearest.distance) p->s = q.s;
    return true;
  }
  return false;
}

/* Coaxial bodies may be as deep all round a ring: their profile is a problem of the plane. What are nearly coaxial are
 * so but for `off`. */
static bool pair_expand(pair *p, const epa_goal *goal, epa_depth *depth) {
  const epa_set set = {.self = p, .farthest = pair_farthest};
  const double off = pair_misalignment(p);
  if (off <= 0.25 * goal->width && epa_ring(&set, off, goal, depth)) return true;
  if (!epa_from(&set, &p->s, goal, depth)) return false;
  epa_depth ring, other;
  double width = depth->most - depth->least;

  /* where rounding has ended it early, a facet passes too near to 0 */
  const bool ended = !depth->exhausted && width > goal->width && depth->most > 4.0 * depth->least;
  if (ended && pair_expand_beside(p, goal, &other) && other.most - other.least < width) {
    *depth = other;
    width = depth->most - depth->least;
  }
  if (depth->exhausted && 2.0 * off < width && epa_ring(&set, off, goal, &ring) && ring.most - ring.least < width)
    *depth = ring;
  return true;
}

typedef bool (*pair_expander)(pair *p, const epa_goal *goal, epa_depth *depth);

static uint32_t pair_steps_left(const pair *p, const pair_goal *goal) {
  return goal->max_steps > p->steps ? goal->max_steps - p->steps : 0;
}

/* That they overlap, and no more. */
static void pair_prove_overlap(pair *p, const pair_goal *goal, pair_expander expand, pair_answer *answer) {
  const epa_goal inner = {.rounding = p->rounding, .rough = true, .max_steps = pair_steps_left(p, goal)};
  epa_depth depth;
  if (!expand(p, &inner, &depth) || !(depth.least > p->rounding)) return;
  p->steps += depth.steps;
  p->nearest.depth = p->nearest.inside ? fmax(depth.least, p->nearest.depth) : depth.least;
  p->nearest.inside = true;
  answer->overlap = true;
}

/* A depth that is known within e tells the way out of curved pieces within about the root of e; Newton's method tells
 * it as exactly as rounding allows. */
static void pair_sharpen_way_out(pair *p, epa_depth *depth) {
  enum { MOST_STEPS = 8 };
  static const double still = 1e-12;
  pair q = *p;
  q.s = depth->touch, q.u = vec_neg(depth->normal);
  double step = INFINITY;
  for (int i = 0; i < MOST_STEPS && step > still; i++) {
    const double before = step;
    vec3 next;
    if (!pair_newton(&q, -depth->most, &next)) return;
    step = vec_norm(vec_sub(next, q.u));
    if (!(step < before)) return;
    q.u = next;
    q.s = pair_moved(&q, next);
    simplex_reduce(&q.s, &q.nearest);
  }
  const simplex_vertex x = pair_extreme(p, q.u);
  const double reach = x.behind - vec_dot(q.u, x.w);
  if (!(step <= still) || !(reach <= fmin(depth->most, -p->lower) + p->rounding)) return;
  /* farther: beside the foot of 0, as points of a disc's rim along its axis are not told apart; or `least` is less than
   * the depth, and these points would not attain it */
  if (!(q.nearest.distance <= depth->least + p->rounding)) return;
  depth->most = reach;
  depth->normal = vec_neg(q.u);
  depth->touch = q.s;
  p->u = q.u, p->lower = -reach; /* the normal proves what `lower` says */
}

/* 0 is inside the simplex, or on it; it expands until it has found the nearest way out of M. */
static void pair_measure_depth(pair *p, double margin_a, double margin_b, const pair_goal *goal, pair_expander expand,
                               pair_answer *answer) {
  const double relative = goal->relative_epsilon * (p->nearest.depth + margin_a + margin_b);
  epa_goal inner = {.rounding = p->rounding,
                    .width = fmax(fmax(goal->epsilon, relative) - 2.0 * p->rounding, 0.25 * p->rounding),
                    .max_steps = pair_steps_left(p, goal),
                    .room = goal->room,
                    .shift = goal->wants_shift ? PAIR_SHIFT * fmin(p->a->scale, p->b->scale) : 0.0};
  if (inner.shift > 0.0) inner.width = fmax(fmin(inner.width, 0.05 * EPA_ALIKE * inner.shift), 0.25 * p->rounding);
  epa_depth depth;
  if (!expand(p, &inner, &depth) || !(depth.most < INFINITY)) return;
  answer->shift = depth.shift;
  p->steps += depth.steps;
  p->nearest.inside = true;
  p->nearest.depth = depth.least;
  if (p->curved) pair_sharpen_way_out(p, &depth);
  pair_raise_lower(p, vec_neg(depth.normal), -depth.most);
  answer->overlap = answer->measured = true;
  answer->exhausted = depth.exhausted;

  /* the nearest point of M's surface, as far as it is known, and the way out past both margins */
  p->s = depth.touch;
  pair_core_points(p, &answer->on_a, &answer->on_b);
  vec3 along;
  feature_unit(vec_sub(answer->on_b, answer->on_a), &along);
  answer->on_a = vec_axpy(answer->on_a, -margin_a, along);
  answer->on_b = vec_axpy(answer->on_b, margin_b, along);
  answer->normal = p->u;
  if (!goal->wants_feature) return;
  p->nearest.distance = -depth.least;
  pair_describe(p, &answer->feature);
}

/* By projections or by Newton's method alone, where both cores allow it; one step is left to the search. */
static bool pair_approach(pair *p, double margins, const pair_goal *goal, vec3 start, pair_feature *feature,
                          alternating_answer *found) {
  const bool smooth = p->a->ops->smooth && p->b->ops->smooth;
  *found = (alternating_answer){.reached = false};
  if (!smooth && (!p->a->ops->project || !p->b->ops->project)) return false;
  const alternating_task task = {
      p->a, p->b, p->r, p->t, goal, margins, p->rounding, p->contact_tolerance, goal->wants_feature ? feature : NULL};
  if (smooth)
    alternating_smooth(&task, start, found);
  else
    alternating_search(&task, found);
  p->steps += found->looks;
  p->supports += found->looks;
  if (!found->reached) return false;
  p->u = found->u;
  p->lower = found->lower;
  p->s = (simplex){.n = 1, .vertex = {found->pair}, .weight = {1.0}};
  p->nearest = (simplex_nearest){.v = found->pair.w, .distance = found->distance, .normal = found->u};
  return true;
}

/* A verdict needs no more than a point of both cores, and how far it is inside: a ball of the sum of both depths about
 * 0 lies in M. */
static bool pair_meets_at(pair *p, const simplex_vertex *common) {
  if (!p->a->ops->closed_form || !p->b->ops->closed_form) return false;
  const vec3 y = pair_turn_to_b(p, vec_sub(common->a, p->t));
  convex_near in_a, in_b;
  p->a->ops->nearest(p->a, common->a, NULL, &in_a);
  p->b->ops->nearest(p->b, y, NULL, &in_b);
  const double off = ROUND_UP * ROUND_U *
                         (p->a->ops->near_rounding * (vec_norm(common->a) + p->a->scale) +
                          p->b->ops->near_rounding * (vec_norm(y) + p->b->scale)) +
                     p->rounding;
  /* how deep it is in each core; of one that it misses, minus by how much */
  const double of_a = -in_a.distance - p->a->margin, of_b = -in_b.distance - p->b->margin;
  if (!(of_a + of_b > 2.0 * off)) return false;
  p->s = (simplex){.n = 1, .vertex = {*common}, .weight = {1.0}};
  p->nearest = (simplex_nearest){.inside = true, .depth = of_a + of_b - off};
  p->lower = -ROUND_UP * (p->a->scale + p->b->scale); /* the line of the centres leads out of M */
  return true;
}

/* Whatever is quickest, from the direction u on; and the feature, if the goal asks for it and the cores are apart. */
static void pair_find(pair *p, vec3 u, double margins, const pair_goal *goal, pair_feature *feature) {
  alternating_answer found;
  if (!pair_approach(p, margins, goal, u, feature, &found)) {
    p->met = found.met;
    if (found.met && goal->verdict && goal->limit >= 0.0 && pair_meets_at(p, &found.pair)) return;
    pair_search(p, found.lower > 0.0 ? found.u : u, margins, goal);
  }
  if (goal->wants_feature && !found.described && !p->nearest.inside && !p->support_failed) pair_describe(p, feature);
}

/* Neither apart nor overlapping is proven by more than a few roundings, or the depth is wanted; and no direction yet
 * tells that there is nothing to prove. */
static bool pair_is_open(const pair *p, double margins, const pair_goal *goal) {
  const double shallow = PAIR_SHALLOW * p->rounding;
  if (p->support_failed || p->steps >= goal->max_steps || !(p->lower < -2.0 * shallow)) return false;
  if (p->nearest.inside)
    return goal->wants_depth || !(p->nearest.depth + margins > fmax(shallow, -PAIR_THIN * p->lower));
  if (p->nearest.distance <= p->rounding) return true;
  return !pair_is_reached(goal, margins, p->rounding, p->lower, p->nearest.distance);
}

/* What the search leaves where the cores overlap, or touch, or 0 lies on a plane through vertices of M. */
static void pair_go_inside(pair *p, double margin_a, double margin_b, double size, const pair_goal *goal,
                           pair_answer *answer) {
  const double margins = margin_a + margin_b;
  const bool on = p->nearest.inside || p->nearest.distance <= p->contact_tolerance;
  const bool open = pair_is_open(p, margins, goal);
  if (!on && !open) return;
  if (goal->wants_depth)
    pair_measure_depth(p, margin_a, margin_b, goal, pair_expand, answer);
  else if (open)
    pair_prove_overlap(p, goal, pair_expand, answer);
  if (answer->measured) return;

  const bool settled = goal->verdict && goal->limit >= 0.0 && answer->overlap;
  if (!settled) pair_separate_slightly(p, size, goal);
  if (!settled && pair_is_open(p, margins, goal)) {
    if (goal->wants_depth)
      pair_measure_depth(p, margin_a, margin_b, goal, pair_expand_beside, answer);
    else
      pair_prove_overlap(p, goal, pair_expand_beside, answer);
  }
  if (answer->measured) return;
  if (open && answer->overlap) pair_points(p, margin_a, margin_b, answer);
  if (!p->nearest.inside) answer->normal = p->u;
}

void pair_separate(const convex *a, double margin_a, const convex *b, double margin_b, const pair_placement *place,
                   const pair_goal *goal, pair_answer *answer) {
  *answer = (pair_answer){0};
  pair p = {.a = a, .b = b, .r = place->r, .t = place->t, .lower = -INFINITY};
  p.curved = a->ops->curvature || b->ops->curvature;
  const double margins = margin_a + margin_b, distance = vec_norm(p.t);
  const double size = a->scale + b->scale + distance + margins;
  const double rounding = PAIR_ROUNDING * ROUND_U * size + place->error;
  p.rounding = ROUND_UP * (rounding + 2.0 * (a->slack + b->slack));
  p.contact_tolerance = 4.0 * ROUND_U * size;
  if (goal->plain) p.rounding = p.contact_tolerance + 2.0 * (a->slack + b->slack);
  answer->above = lesser(ROUND_UP * (rounding + 2.0 * (a->outside + b->outside)), p.rounding);

  /* from what is known on, or the line of the centres */
  vec3 u = goal->start;
  if (!(vec_norm2(u) > 0.0)) feature_unit(vec_neg(p.t), &u);
  if (!(vec_norm2(u) > 0.0)) u = vec(1, 0, 0);
  pair_find(&p, u, margins, goal, &answer->feature);
  answer->exhausted = p.steps >= goal->max_steps || p.steps >= PAIR_MAX_STEPS;
  answer->overlap = p.nearest.inside && p.nearest.depth + margins > p.rounding;
  const double apart = pair_points(&p, margin_a, margin_b, answer);
  pair_go_inside(&p, margin_a, margin_b, size, goal, answer);

  if (goal->wants_vertices && !p.curved) pair_keep_vertices(&p, &answer->vertices);
  answer->support_failed = p.support_failed;
  answer->steps = p.steps;
  answer->supports = p.supports;
  answer->rounding = p.rounding;
  answer->depth = p.nearest.inside ? p.nearest.depth : 0.0;
  if (!p.nearest.inside) answer->shift = greater(p.lower - p.rounding, 0.0);
  if (p.nearest.inside) answer->above = p.rounding;
  answer->upper = (p.nearest.inside ? 0.0 : apart) - margins + answer->above;
  if (answer->overlap) answer->upper = answer->measured ? fmin(p.rounding - p.nearest.depth - margins, 0.0) : 0.0;
  answer->lower = fmin(p.lower - margins - p.rounding, answer->upper);
}
