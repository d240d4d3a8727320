/* SPDX-License-Identifier: BSD-3-Clause */
/* Two closed bodies by their support functions: phi(u) = min of u·(x - y) over both, a lower bound for any unit u,
 * refined by Newton's method on the sphere. Where that overshoots, as it does on flats, the next direction is that of
 * the nearest point of the hull of what was seen (Gilbert, Johnson, Keerthi 1988). A third of the work of the interior
 * point method where it converges; where it stalls it says so soon, and the interior point method goes on from there.
 */
#include "base/rotation.h"
#include "base/rounding.h"
#include "convex/simplex.h"
#include "implicit/implicit.h"

enum { SEPARATE_STEPS = 20 };

/* An approach has stalled after more planes that do not part the bodies: at first, and from a normal of the interior
 * point method on. */
enum { APPROACH_BEHIND = 2, APPROACH_LATER = 12 };

/* Behind them, the next plane lies between the hull's and the last one that parted them, of which it takes this part. */
static const double APPROACH_BACK = 0.5;

/* An ascent whose gap shrinks less in two steps has stalled. */
static const double SEPARATE_GAIN = 0.25;

/* Between two bodies that are nearly polyhedra the ascent stalls: it is not tried. */
static const double SEPARATE_FLAT = 30.0;

/* How much of the gap the points are expected to move. */
static const double SEPARATE_CHANGE = 0.1;

/* phi beside the supports' own error, in u of both bodies' radii and their distance: M turns by 20, a product with it
 * costs 6, u·t 3, |u| 4, the sums 3. */
static const double SEPARATE_ROUND = 64.0;

typedef struct ascent {
  const implicit_query *q;
  double mu[2]; /* where Newton's method for the supports ended */
  vec3 u;       /* from b to a: the direction looked along */
  double phi;
  vec3 x, y, apart; /* the supports, in a's and b's frame, and x - (M y + t) */
  double h[2][6];   /* their derivatives */
  vec3 e, f;        /* across u */
} ascent;

static vec3 unit(vec3 v) {
  return vec_scale(1.0 / vec_norm(v), v);
}

static void look(ascent *c, vec3 u) {
  const implicit_query *q = c->q;
  c->u = u;
  const double ha = implicit_closed_support(q->a, vec_neg(u), &c->mu[0], &c->x, c->h[0]);
  const double hb = implicit_closed_support(q->b, rotate_back(q->m, u), &c->mu[1], &c->y, c->h[1]);
  c->phi = -ha - hb - vec_dot(u, q->t);
  c->apart = vec_sub(c->x, vec_add(rotate(q->m, c->y), q->t));
}

static double form(const double h[6], vec3 x, vec3 y) {
  return x.x * (h[0] * y.x + h[1] * y.y + h[2] * y.z) + x.y * (h[1] * y.x + h[3] * y.y + h[4] * y.z) +
         x.z * (h[2] * y.x + h[4] * y.y + h[5] * y.z);
}

/* Newton's step in the tangent plane: (K + d) step = tangential part of x - y, K the sum of both derivatives. */
static bool newton(ascent *c, double distance, double step[2]) {
  implicit_across(c->u, &c->e, &c->f);
  const double *m = c->q->m;
  const vec3 e = rotate_back(m, c->e), f = rotate_back(m, c->f);
  const double d = 0.5 * (fmax(c->phi, 0.0) + distance);
  const double ee = form(c->h[0], c->e, c->e) + form(c->h[1], e, e) + d;
  const double ef = form(c->h[0], c->e, c->f) + form(c->h[1], e, f);
  const double ff = form(c->h[0], c->f, c->f) + form(c->h[1], f, f) + d, det = ee * ff - ef * ef;
  if (!(det > 0.0)) return false;
  const double ge = vec_dot(c->apart, c->e), gf = vec_dot(c->apart, c->f);
  step[0] = (ff * ge - ef * gf) / det;
  step[1] = (ee * gf - ef * ge) / det;
  const double length = sqrt(step[0] * step[0] + step[1] * step[1]), most = 0.5;
  if (!isfinite(length)) return false;
  if (length > most) step[0] *= most / length, step[1] *= most / length;
  return true;
}

static bool has_flat(const implicit *body) {
  return fmax(body->term[0].p, fmax(body->term[1].p, body->term[2].p)) > SEPARATE_FLAT;
}

/* The point of a, or of b, that the nearest point of the hull is made of. */
static vec3 of_hull(const simplex *hull, bool second) {
  vec3 p = vec(0, 0, 0);
  for (int i = 0; i < hull->n; i++) p = vec_axpy(p, hull->weight[i], second ? hull->vertex[i].b : hull->vertex[i].a);
  return p;
}

/* Where a stalled search leaves the interior point method to go on: its gap is what may still change. */
static implicit_warm leave_off(const implicit_query *q, const implicit_answer *answer) {
  if (!(answer->lower > 0.0) || !isfinite(answer->upper)) return (implicit_warm){.usable = false};
  const vec3 apart = vec_sub(answer->x, vec_add(rotate(q->m, answer->y), q->t));
  const double change = SEPARATE_CHANGE * (answer->upper - answer->lower);
  return (implicit_warm){
      .usable = true, .x = answer->x, .y = answer->y, .apart = vec_axpy(apart, change, answer->normal)};
}

bool implicit_separate(const implicit_query *query, const implicit_goal *goal, implicit_warm *warm,
                       implicit_answer *answer) {
  const implicit_query *q = query;
  *answer = (implicit_answer){.lower = -INFINITY, .upper = INFINITY};
  const implicit_warm former = *warm;
  *warm = (implicit_warm){.usable = false};
  const double far = vec_norm(q->t), reach = q->a->radius + q->b->radius;
  if (!(far > 0.0) || (has_flat(q->a) && has_flat(q->b))) return false;
  /* the supports' own error, twice for the two ends, and that of turning and adding */
  const double rounding = q->a->give + q->b->give + ROUND_UP * SEPARATE_ROUND * ROUND_U * (reach + far);

  ascent c = {.q = q};
  simplex hull = {.n = 0};
  vec3 next = unit(former.usable ? former.apart : vec_neg(q->t));
  double before[2] = {INFINITY, INFINITY};
  for (int i = 0; i < SEPARATE_STEPS; i++) {
    look(&c, next);
    answer->steps++;
    const bool higher = c.phi - rounding > answer->lower;
    if (higher) {
      answer->lower = c.phi - rounding;
      answer->normal = c.u;
    }
    simplex_nearest nearest;
    if (!simplex_has(&hull, c.apart) && hull.n < 4)
      hull.vertex[hull.n++] = (simplex_vertex){.w = c.apart, .a = c.x, .b = c.y};
    simplex_reduce(&hull, &nearest);
    if (nearest.inside) break;
    if (nearest.distance + rounding < answer->upper) {
      answer->upper = nearest.distance + rounding;
      answer->x = of_hull(&hull, false);
      answer->y = of_hull(&hull, true);
    }
    const double gap = answer->upper - answer->lower;
    if (gap <= fmax(goal->epsilon, goal->relative_epsilon * answer->upper)) {
      answer->certified = true;
      break;
    }
    if (i > 3 && gap > SEPARATE_GAIN * before[0]) break;
    before[0] = before[1];
    before[1] = gap;

    /* higher than before: on by Newton's step; else from the hull of what was seen */
    double step[2];
    if (higher && newton(&c, answer->upper, step))
      next = unit(vec_axpy(vec_axpy(c.u, step[0], c.e), step[1], c.f));
    else if (nearest.distance > 0.0)
      next = unit(nearest.v);
    else
      break;
  }
  *warm = leave_off(q, answer);
  return answer->certified;
}

bool implicit_approach(const implicit_query *query, double epsilon, double lost, implicit_warm *warm,
                       implicit_answer *answer) {
  implicit_query moved = *query;
  const double far = vec_norm(query->t), reach = query->a->radius + query->b->radius, speed = vec_norm(query->velocity),
               passed = answer->time;
  const implicit_warm former = *warm;
  *warm = (implicit_warm){.usable = false};
  *answer = (implicit_answer){.lower = -INFINITY, .upper = INFINITY, .time = passed};
  if (!(far > 0.0) || !(speed > 0.0)) return false;
  const double rounding =
      query->a->give + query->b->give + ROUND_UP * SEPARATE_ROUND * ROUND_U * (reach + far + speed * query->duration);
  moved.t = vec_axpy(query->t, passed, query->velocity);

  ascent c = {.q = &moved};
  simplex hull = {.n = 0};
  vec3 next = unit(former.usable ? former.apart : vec_neg(moved.t)), parting = vec(0, 0, 0);
  for (int behind = 0; behind <= (former.usable ? APPROACH_LATER : APPROACH_BEHIND) && answer->steps < SEPARATE_STEPS;
       answer->steps++) {
    look(&c, next);
    const double between = c.phi - rounding - lost;
    if (between > 0.0) {
      const double towards = vec_dot(c.u, query->velocity);
      answer->normal = parting = c.u;
      const double step = between / (towards + ROUND_TOWARDS * ROUND_U * speed) * (1.0 - 1e-12),
                   then = fmax(nextafter(answer->time + step, -INFINITY), answer->time);
      if (towards <= -ROUND_TOWARDS * ROUND_U * speed || then >= query->duration) return false;
      const vec3 ahead = vec_scale(then - answer->time, query->velocity);
      answer->time = then;
      moved.t = vec_axpy(query->t, then, query->velocity);
      c.apart = vec_sub(c.apart, ahead);
      c.phi -= vec_dot(c.u, ahead);
      answer->lower = c.phi - rounding;
      for (int i = 0; i < hull.n; i++) hull.vertex[i].w = vec_sub(hull.vertex[i].w, ahead);
    } else {
      behind++;
    }
    simplex_nearest nearest;
    if (!simplex_has(&hull, c.apart) && hull.n < 4)
      hull.vertex[hull.n++] = (simplex_vertex){.w = c.apart, .a = c.x, .b = c.y};
    simplex_reduce(&hull, &nearest);
    if (nearest.inside || !(nearest.distance > 0.0)) return false;
    answer->upper = nearest.distance + rounding;
    answer->x = of_hull(&hull, false);
    answer->y = of_hull(&hull, true);
    *warm = (implicit_warm){.usable = true, .x = answer->x, .y = answer->y, .apart = nearest.v};
    answer->certified = answer->lower > 0.0 && answer->upper - lost <= epsilon;
    if (answer->certified) return true;
    double step[2];
    next = between > 0.0 && newton(&c, nearest.distance, step)
               ? unit(vec_axpy(vec_axpy(c.u, step[0], c.e), step[1], c.f))
               : unit(vec_axpy(unit(nearest.v), APPROACH_BACK, parting));
  }
  return false;
}
