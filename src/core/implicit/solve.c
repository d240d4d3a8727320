/* SPDX-License-Identifier: BSD-3-Clause */
/* Primal-dual interior point method for implicit bodies (Chakraborty, Peng, Akella, Mitchell, IEEE Trans. Robotics
 * 24(1), 2008; LOQO: R. Vanderbei, D. Shanno, 1999).
 *
 *   1. Begin at a strictly feasible point between the centre and the surface of each body.
 *   2. Solve the Newton system of the optimality conditions for the present barrier parameter.
 *   3. Go along the step until the next constraint is close, and lower the barrier parameter.
 *   4. Now and then turn the multipliers into a separating plane: it proves a lower bound (support_height.c).
 *   5. End when this bound and the distance of the points are as close as asked.
 *
 * Departures: all points stay feasible, so each gives an upper bound. The search ends with a proven interval, not
 * with small residuals. What one set of settings cannot finish, the next one tries (doc/implicit.md). */
#include "base/rotation.h"
#include "base/rounding.h"
#include "implicit/barrier.h"

enum { SOLVE_MOST_VARIABLES = 7, SOLVE_BACKTRACKS = 60, SOLVE_CERTIFICATES = 12 };

/* How to run: centring of the first and of later steps, where to start between centre and surface, the start of the
 * barrier parameter as a fraction, and below which exponent terms are lifted. */
typedef struct solve_settings {
  double centring, centring_later, start, mu;
  double lift_below;
  uint32_t steps;
} solve_settings;

static const solve_settings SOLVE_SETTINGS[] = {
    {0.1, 0.01, 0.5, 0.1, INFINITY, 60}, {0.1, 0.1, 0.3, 0.1, INFINITY, 100}, {0.1, 0.1, 0.5, 0.1, 2.0, 100},
    {0.3, 0.3, 0.5, 1.0, INFINITY, 300}, {0.3, 0.3, 0.8, 0.01, 2.0, 300},
};
enum { SOLVE_SETTINGS_COUNT = sizeof SOLVE_SETTINGS / sizeof *SOLVE_SETTINGS };

/* The time of a moving body, 0 <= tau <= duration, as two constraints more. */
typedef struct solve_time {
  double tau, step, s[2], l[2], ds[2], dl[2];
} solve_time;

typedef struct solve {
  const implicit_query *q;
  implicit_answer *answer;
  int sides, n; /* bodies, variables */
  barrier side[2];
  solve_time time;
  vec3 e; /* x - (M y + t + velocity tau); for an extreme point: minus the direction */
  const implicit_goal *goal;
  double reach, scale;
  double floor; /* what rounding takes from the upper bound */
  double least; /* no interval can be asked to be narrower */
  vec3 axes[3]; /* far: those that matrix and rhs are seen along */
  double matrix[SOLVE_MOST_VARIABLES][SOLVE_MOST_VARIABLES];
  double rhs[SOLVE_MOST_VARIABLES];
} solve;

size_t implicit_memory(const implicit *a, const implicit *b) {
  size_t rows = (size_t)implicit_count(a), terms = (size_t)a->n_terms;
  if (b) {
    rows += (size_t)implicit_count(b);
    terms += (size_t)b->n_terms;
  }
  return rows * sizeof(barrier_row) + terms * sizeof(barrier_term);
}

/* ---- the problem ---- */

static vec3 solve_difference(const solve *s) {
  const implicit_query *q = s->q;
  if (q->far) return vec_neg(q->t);
  vec3 e = vec_sub(s->side[0].z, q->t);
  if (s->sides == 2) e = vec_sub(e, rotate(q->m, s->side[1].z));
  if (q->moving) e = vec_axpy(e, -s->time.tau, q->velocity);
  return e;
}

static double solve_distance(const solve *s) {
  return s->q->far ? 1.0 : vec_norm(s->e);
}

/* The share of each multiplier in a direction of length 1. */
static double solve_share(const solve *s) {
  return 1.0 / solve_distance(s);
}

static bool solve_begin_side(barrier *b, vec3 towards, double start, double mu, double lift_below) {
  const double norm = vec_norm(towards);
  if (norm > 0.0) {
    double length = fmin(norm, 2.0 * b->body->radius);
    for (int i = 0; i < 60; i++, length *= 0.7)
      if (implicit_value(b->body, vec_scale(length / norm, towards)) < 0.0) break;
    towards = vec_scale(start * length / norm, towards);
  }
  return barrier_begin(b, towards, mu, lift_below) || barrier_begin(b, vec(0, 0, 0), mu, lift_below);
}

static double start_mu(const solve *s, double factor) {
  const double rows = implicit_count(s->q->a) + (s->sides == 2 ? implicit_count(s->q->b) : 0);
  if (s->q->far) return factor * s->reach / rows;
  return factor * (vec_norm2(s->e) + 1e-4 * s->scale * s->scale) / rows;
}

static void time_begin(solve *s, double mu) {
  solve_time *time = &s->time;
  time->s[0] = time->tau;
  time->s[1] = s->q->duration - time->tau;
  for (int j = 0; j < 2; j++) time->l[j] = mu / time->s[j];
}

/* From scratch: each body from its centre towards the other one. */
static bool solve_begin(solve *s, const solve_settings *settings) {
  const implicit_query *q = s->q;
  s->time = (solve_time){.tau = 0.5 * q->duration};
  vec3 towards = q->t;
  if (q->far) towards = vec_scale(2.0 * q->a->radius, q->t);
  if (q->moving) towards = vec_axpy(towards, s->time.tau, q->velocity);
  const vec3 back = s->sides == 2 ? vec_neg(rotate_back(q->m, towards)) : vec(0, 0, 0);

  /* mu rests on the distance of the starting points */
  if (!solve_begin_side(&s->side[0], towards, settings->start, 1.0, settings->lift_below)) return false;
  if (s->sides == 2 && !solve_begin_side(&s->side[1], back, settings->start, 1.0, settings->lift_below)) return false;
  s->e = solve_difference(s);
  s->scale = q->far ? s->reach : vec_norm(s->e) + (s->sides == 2 ? fmin(q->a->radius, q->b->radius) : q->a->radius);
  const double mu = start_mu(s, settings->mu);
  for (int i = 0; i < s->sides; i++)
    if (!barrier_begin(&s->side[i], s->side[i].z, mu, settings->lift_below)) return false;
  if (q->moving) time_begin(s, mu);
  return true;
}

/* From where a search like this one ended, drawn in towards the centres by as much as things have changed since. */
static bool solve_begin_warm(solve *s, const implicit_warm *warm, const solve_settings *settings) {
  const implicit_query *q = s->q;
  s->time = (solve_time){.tau = 0.5 * q->duration};
  s->side[0].z = warm->x;
  s->side[1].z = warm->y;
  s->e = solve_difference(s);
  s->scale = vec_norm(s->e) + (s->sides == 2 ? fmin(q->a->radius, q->b->radius) : q->a->radius);
  const double change = vec_norm(vec_sub(s->e, warm->apart)) / s->scale;
  const double kappa = fmin(fmax(2.0 * change, 1e-3), 0.3);
  for (int i = 0; i < s->sides; i++) s->side[i].z = vec_scale(1.0 - kappa, s->side[i].z);
  s->e = solve_difference(s);
  const double mu = start_mu(s, fmin(kappa, 0.1));
  for (int i = 0; i < s->sides; i++)
    if (!barrier_begin(&s->side[i], s->side[i].z, mu, settings->lift_below)) return false;
  if (q->moving) time_begin(s, mu);
  return true;
}

/* ---- Newton's system ---- */

static void put3(double a[][SOLVE_MOST_VARIABLES], int at, const double h[6]) {
  a[at][at] = h[0];
  a[at + 1][at] = h[1];
  a[at + 2][at] = h[2];
  a[at + 1][at + 1] = h[3];
  a[at + 2][at + 1] = h[4];
  a[at + 2][at + 2] = h[5];
}

/* One rotation of Jacobi's method, in the plane of axes i and j. */
static void jacobi_turn(double h[3][3], vec3 axes[3], int i, int j) {
  if (h[i][j] == 0.0) return;
  const double theta = 0.5 * (h[j][j] - h[i][i]) / h[i][j];
  const double t = (theta >= 0.0 ? 1.0 : -1.0) / (fabs(theta) + sqrt(1.0 + theta * theta));
  const double c = 1.0 / sqrt(1.0 + t * t), sine = t * c;
  const int k = 3 - i - j;
  const double hik = h[i][k], hjk = h[j][k];
  h[i][i] -= t * h[i][j];
  h[j][j] += t * h[i][j];
  h[i][j] = h[j][i] = 0.0;
  h[i][k] = h[k][i] = c * hik - sine * hjk;
  h[j][k] = h[k][j] = sine * hik + c * hjk;
  const vec3 a = axes[i];
  axes[i] = vec_axpy(vec_scale(c, a), -sine, axes[j]);
  axes[j] = vec_axpy(vec_scale(c, axes[j]), sine, a);
}

static vec3 back_from_axes(const barrier *b) {
  const vec3 *axes = b->axes, v = b->along;
  return axes ? vec_axpy(vec_axpy(vec_scale(v.x, axes[0]), v.y, axes[1]), v.z, axes[2]) : v;
}

/* Of so small a part of the diagonal a Cholesky pivot is half rounding. */
static const double SOLVE_STEEP = 1e-8;

/* Is a part of the matrix lost beside the rest of it? */
static bool is_steep(const double m[6]) {
  const double first = m[0], l = m[1] / first, n = m[2] / first, second = m[3] - l * m[1], k = m[4] - n * m[1];
  const double third = m[5] - n * m[2] - k * k / second;
  return !(second > SOLVE_STEEP * m[3] && third > SOLVE_STEEP * m[5]);
}

/* Along a normal of a face or an edge, exactly or nearly, the extreme points are many. Towards the end the matrix is
 * 1e20 times as steep across the edge as along it, and in coordinates the latter part is lost in rounding. Along the
 * matrix's own axes it is not: the steep constraints have nothing but rounding there. */
static void see_along_its_axes(solve *s, double target, barrier_system *system) {
  enum { SWEEPS = 4 };
  const double *m = system->h;
  double h[3][3] = {{m[0], m[1], m[2]}, {m[1], m[3], m[4]}, {m[2], m[4], m[5]}};
  s->axes[0] = vec(1, 0, 0), s->axes[1] = vec(0, 1, 0), s->axes[2] = vec(0, 0, 1);
  for (int i = 0; i < SWEEPS; i++) {
    jacobi_turn(h, s->axes, 0, 1);
    jacobi_turn(h, s->axes, 0, 2);
    jacobi_turn(h, s->axes, 1, 2);
  }
  for (int i = 0; i < 3; i++) /* the steepest first, so that Cholesky's factor keeps the others */
    for (int j = i + 1; j < 3; j++)
      if (h[j][j] > h[i][i]) {
        const vec3 axis = s->axes[i];
        const double value = h[i][i];
        s->axes[i] = s->axes[j], s->axes[j] = axis;
        h[i][i] = h[j][j], h[j][j] = value;
      }
  *system = (barrier_system){.rhs = vec_neg(s->e)};
  s->side[0].axes = s->axes;
  barrier_assemble(&s->side[0], target, system);
  system->rhs = barrier_seen(&s->side[0], system->rhs);
}

/* The lower triangle of [[1 + Hx, -M], [-M', 1 + Hy]], bordered by the time's row, and minus the gradients. */
static void solve_assemble(solve *s, double target) {
  const implicit_query *q = s->q;
  const double curved = q->far ? 0.0 : 1.0;
  barrier_system system = {.h = {curved, 0, 0, curved, 0, curved}, .rhs = vec_neg(s->e)};
  s->side[0].axes = NULL;
  barrier_assemble(&s->side[0], target, &system);
  if (q->far && !s->goal->coarse && is_steep(system.h)) see_along_its_axes(s, target, &system);
  put3(s->matrix, 0, system.h);
  s->rhs[0] = system.rhs.x, s->rhs[1] = system.rhs.y, s->rhs[2] = system.rhs.z;
  if (s->sides == 1) return;

  system = (barrier_system){.h = {1, 0, 0, 1, 0, 1}, .rhs = rotate_back(q->m, s->e)};
  barrier_assemble(&s->side[1], target, &system);
  put3(s->matrix, 3, system.h);
  s->rhs[3] = system.rhs.x, s->rhs[4] = system.rhs.y, s->rhs[5] = system.rhs.z;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) s->matrix[3 + i][j] = -q->m[3 * j + i];
  if (!q->moving) return;

  const vec3 v = q->velocity, back = rotate_back(q->m, v);
  const solve_time *t = &s->time;
  const double row[6] = {-v.x, -v.y, -v.z, back.x, back.y, back.z};
  for (int j = 0; j < 6; j++) s->matrix[6][j] = row[j];
  s->matrix[6][6] = vec_norm2(v) + t->l[0] / t->s[0] + t->l[1] / t->s[1];
  s->rhs[6] = vec_dot(v, s->e) + target / t->s[0] - target / t->s[1];
}

/* Cholesky's factor, with the inverses of its diagonal in the diagonal's place. */
static void solve_factor(solve *s) {
  for (int j = 0; j < s->n; j++) {
    double *row = s->matrix[j], pivot = row[j];
    const double least = 1e-15 * pivot;
    for (int k = 0; k < j; k++) pivot -= row[k] * row[k];
    if (!(pivot > least)) pivot = least > 0.0 ? 11.0 * least : 1e-300;
    const double inverse = 1.0 / sqrt(pivot);
    row[j] = inverse;
    for (int i = j + 1; i < s->n; i++) {
      double v = s->matrix[i][j];
      for (int k = 0; k < j; k++) v -= s->matrix[i][k] * row[k];
      s->matrix[i][j] = v * inverse;
    }
  }
}

static void solve_substitute(const solve *s, double *b) {
  for (int i = 0; i < s->n; i++) {
    double v = b[i];
    for (int k = 0; k < i; k++) v -= s->matrix[i][k] * b[k];
    b[i] = v * s->matrix[i][i];
  }
  for (int i = s->n - 1; i >= 0; i--) {
    double v = b[i];
    for (int k = i + 1; k < s->n; k++) v -= s->matrix[k][i] * b[k];
    b[i] = v * s->matrix[i][i];
  }
}

/* ---- the time ---- */

static void limit(double value, double change, double *length) {
  if (change < 0.0 && -value > *length * change) *length = -value / change;
}

static void time_step(solve_time *t, double target, double *primal, double *dual) {
  for (int j = 0; j < 2; j++) {
    t->ds[j] = j == 0 ? t->step : -t->step;
    t->dl[j] = (target - t->l[j] * t->s[j] - t->l[j] * t->ds[j]) / t->s[j];
    limit(t->s[j], t->ds[j], primal);
    limit(t->l[j], t->dl[j], dual);
  }
}

static void time_go(solve_time *t, double duration, double primal, double dual, double least, double most) {
  t->tau += primal * t->step;
  t->s[0] = t->tau;
  t->s[1] = duration - t->tau;
  for (int j = 0; j < 2; j++) {
    const double l = t->l[j] + dual * t->dl[j], product = l * t->s[j];
    t->l[j] = product < least ? least / t->s[j] : product > most ? most / t->s[j] : l;
  }
}

/* ---- the certificate ---- */

/* How wide the interval may be, if its upper end is no more than d. */
static double solve_asked(const solve *s, double d) {
  const double upper = fmin(d, s->answer->upper);
  return fmax(fmax(s->goal->epsilon, s->goal->relative_epsilon * upper), s->least);
}

/* A lower bound along any direction: the bodies reach toward each other no farther than their heights. */
static void certify_along(solve *s, vec3 n, double share, barrier_reading reading) {
  const implicit_query *q = s->q;
  implicit_answer *answer = s->answer;
  const double ha = barrier_height(&s->side[0], n, share, reading, NULL);
  double apart = vec_dot(n, q->t), others = 0.0;
  if (q->moving) apart += fmin(0.0, vec_dot(n, q->velocity) * q->duration);
  if (s->sides == 2) others = barrier_height(&s->side[1], vec_neg(rotate_back(q->m, n)), share, reading, NULL);
  const double sizes = vec_norm(q->t) + fabs(ha) + fabs(others) + (s->sides == 2 ? q->b->radius : 0.0) +
                       (q->moving ? vec_norm(q->velocity) * q->duration : 0.0);
  const double lower = apart - ha - others - ROUND_UP * 8.0 * ROUND_U * sizes;
  if (!(lower > answer->lower)) return;
  answer->lower = lower;
  answer->normal = vec_neg(n);
  answer->height = ha;
}

/* From the points and multipliers at hand; keeps the best. True once it is as narrow as asked. */
static bool solve_certify(solve *s, barrier_reading reading) {
  const implicit_query *q = s->q;
  implicit_answer *answer = s->answer;
  const double d = solve_distance(s), share = solve_share(s);
  if (q->far) {
    const double height = barrier_height(&s->side[0], q->t, share, reading, NULL);
    if (q->dual && height < answer->upper) barrier_height(&s->side[0], q->t, share, reading, q->dual);
    const double attained = vec_dot(q->t, s->side[0].z);
    if (attained > answer->lower) {
      answer->lower = attained;
      answer->x = s->side[0].z;
    }
    answer->upper = fmin(answer->upper, height);
  } else {
    if (d > 0.0) certify_along(s, vec_scale(-share, s->e), share, reading);
    const double upper = d + s->floor;
    if (upper < answer->upper) {
      answer->upper = upper;
      answer->x = s->side[0].z;
      if (s->sides == 2) answer->y = s->side[1].z;
      answer->time = s->time.tau;
    }
  }
  return answer->upper - answer->lower <= solve_asked(s, answer->upper);
}

/* A common point: x, seen from b, is inside it too by more than rounding. */
static bool solve_overlaps(solve *s) {
  const implicit_query *q = s->q;
  if (s->sides != 2) return false;
  vec3 offset = q->t;
  if (q->moving) offset = vec_axpy(offset, s->time.tau, q->velocity);
  const vec3 x = vec_scale(0.5, vec_add(s->side[0].z, vec_add(rotate(q->m, s->side[1].z), offset)));
  /* drawn towards each centre's opposite by the floor, it would still be inside */
  const vec3 y = rotate_back(q->m, vec_sub(x, offset));
  const double grow_a = 1.0 + s->floor / q->a->inner, grow_b = 1.0 + s->floor / q->b->inner;
  if (!(implicit_value(q->a, vec_scale(grow_a, x)) < 0.0 && implicit_value(q->b, vec_scale(grow_b, y)) < 0.0))
    return false;
  s->answer->overlap = true;
  s->answer->x = x;
  s->answer->y = y;
  s->answer->time = s->time.tau;
  s->answer->lower = -s->reach;
  s->answer->upper = 0.0;
  return true;
}

/* ---- the loop ---- */

/* Bounds how far the objective (half the squared distance, or the height) is from its optimum, if the residuals are
 * true. */
static double solve_gap(solve *s, double *mu) {
  const implicit_query *q = s->q;
  barrier_state a = barrier_evaluate(&s->side[0]);
  vec3 residual = vec_add(s->e, a.force);
  double products = a.products, pairs = a.pairs, lifted = a.lifted;
  double gap = vec_norm(residual) * q->a->radius;
  if (s->sides == 2) {
    const barrier_state b = barrier_evaluate(&s->side[1]);
    residual = vec_sub(b.force, rotate_back(q->m, s->e));
    gap += vec_norm(residual) * q->b->radius;
    products += b.products;
    pairs += b.pairs;
    lifted = fmax(lifted, b.lifted);
  }
  if (q->moving) {
    const solve_time *t = &s->time;
    products += t->l[0] * t->s[0] + t->l[1] * t->s[1];
    pairs += 2;
    gap += fabs(-vec_dot(q->velocity, s->e) - t->l[0] + t->l[1]) * q->duration;
  }
  *mu = products / pairs;
  return products + gap + lifted;
}

/* One step towards the products' target; its primal length, 0 where none was possible. */
static double solve_step(solve *s, double target) {
  solve_assemble(s, target);
  solve_factor(s);
  double b[SOLVE_MOST_VARIABLES] = {0};
  for (int i = 0; i < s->n; i++) b[i] = s->rhs[i];
  solve_substitute(s, b);

  double primal = 1.0 / 0.99, dual = 1.0 / 0.99;
  for (int i = 0; i < s->sides; i++) {
    s->side[i].along = vec(b[3 * i], b[3 * i + 1], b[3 * i + 2]);
    s->side[i].dz = back_from_axes(&s->side[i]);
    if (!vec_finite(s->side[i].dz)) return 0.0;
    barrier_step(&s->side[i], target, &primal, &dual);
  }
  if (s->q->moving) {
    s->time.step = b[6];
    time_step(&s->time, target, &primal, &dual);
  }
  primal = fmin(1.0, 0.99 * primal);
  dual = fmin(1.0, 0.99 * dual);

  const double wanted = primal;
  int tries = 0;
  for (; tries < SOLVE_BACKTRACKS; tries++) {
    if (barrier_try(&s->side[0], primal) && (s->sides == 1 || barrier_try(&s->side[1], primal))) break;
    primal *= tries < 3 ? 0.8 : 0.5;
  }
  if (tries == SOLVE_BACKTRACKS) return 0.0;
  if (primal < 0.5 * wanted) dual = fmin(dual, fmax(primal, 0.1));

  const double least = 1e-2 * target, most = primal < 0.2 ? 10.0 * target : INFINITY;
  for (int i = 0; i < s->sides; i++) barrier_go(&s->side[i], primal, dual, least, most);
  if (s->q->moving) time_go(&s->time, s->q->duration, primal, dual, least, most);
  s->e = solve_difference(s);
  return primal;
}

/* Where the certificate does not close by itself, the other readings of the multipliers are tried, and then the
 * direction that the multipliers themselves push in: close together with many nearest points, that of x - y is
 * rounding. */
static bool solve_certify_all(solve *s) {
  if (solve_certify(s, BARRIER_MIXED) || solve_certify(s, BARRIER_LIFTED) || solve_certify(s, BARRIER_TANGENT))
    return true;
  if (s->q->far) return false;
  const vec3 force = barrier_evaluate(&s->side[0]).force;
  const double push = vec_norm(force);
  if (push > 0.0) certify_along(s, vec_scale(1.0 / push, force), 1.0 / push, BARRIER_MIXED);
  return s->answer->upper - s->answer->lower <= solve_asked(s, s->answer->upper);
}

static bool solve_run(solve *s, const solve_settings *settings, uint32_t most) {
  double length = 1.0, worth = INFINITY;
  int good = 0, certificates = 0;
  for (uint32_t i = 0; i < settings->steps && s->answer->steps < most; i++) {
    double mu;
    const double gap = solve_gap(s, &mu), d = solve_distance(s);
    const double asked = solve_asked(s, s->q->far ? s->reach : d), enough = s->q->far ? asked : asked * fmax(d, asked);
    if (!isfinite(gap)) break;
    if (gap <= enough) {
      if (solve_certify_all(s)) return true;
      /* no narrower than last time: rounding is all that is left */
      const double width = s->answer->upper - s->answer->lower;
      if (++certificates >= SOLVE_CERTIFICATES || (certificates > 3 && !(width < 0.9 * worth))) return false;
      worth = width;
    }
    if (s->sides == 2 && d < 0.05 * s->scale && solve_overlaps(s)) return true;

    double centring = settings->centring;
    if (length < 0.9)
      centring = fmax(centring, 0.1 + 0.9 * (1.0 - length) * (1.0 - length));
    else if (good >= 2)
      centring = settings->centring_later;
    s->answer->steps++;
    length = solve_step(s, centring * mu);
    if (length == 0.0) break;
    good = length >= 0.9 ? good + 1 : 0;
  }
  return solve_certify_all(s);
}

/* The second derivative of the distance of a point: x follows the point by the inverse of Newton's matrix. */
static void solve_hessian(const solve *s) {
  const double d = solve_distance(s);
  const vec3 n = s->answer->normal;
  double inverse[3][3];
  for (int j = 0; j < 3; j++) {
    for (int i = 0; i < 3; i++) inverse[j][i] = i == j;
    solve_substitute(s, inverse[j]);
  }
  double *h = s->answer->hessian;
  h[0] = (1.0 - inverse[0][0] - n.x * n.x) / d;
  h[1] = (-inverse[0][1] - n.x * n.y) / d;
  h[2] = (-inverse[0][2] - n.x * n.z) / d;
  h[3] = (1.0 - inverse[1][1] - n.y * n.y) / d;
  h[4] = (-inverse[1][2] - n.y * n.z) / d;
  h[5] = (1.0 - inverse[2][2] - n.z * n.z) / d;
}

/* What rounding and the bodies' give take from an upper bound. */
static double solve_floor(const implicit_query *q) {
  if (q->far) return q->a->give;
  const double sizes = q->a->radius + (q->b ? q->b->radius : 0.0) + vec_norm(q->t) +
                       (q->moving ? vec_norm(q->velocity) * q->duration : 0.0);
  return q->a->give + (q->b ? q->b->give : 0.0) + ROUND_UP * 8.0 * ROUND_U * sizes;
}

static void solve_place(solve *s, void *memory) {
  const implicit *body[2] = {s->q->a, s->q->b};
  barrier_row *row = memory;
  for (int i = 0; i < s->sides; i++) {
    s->side[i] = (barrier){.body = body[i], .row = row};
    row += implicit_count(body[i]);
  }
  barrier_term *term = (barrier_term *)(void *)row;
  for (int i = 0; i < s->sides; i++) {
    s->side[i].term = term;
    term += body[i]->n_terms;
  }
}

void implicit_solve(const implicit_query *query, const implicit_goal *goal, implicit_warm *warm, void *memory,
                    implicit_answer *answer) {
  const implicit_query *q = query;
  solve s = {.q = q, .answer = answer, .goal = goal, .sides = q->b ? 2 : 1};
  s.n = 3 * s.sides + (q->moving ? 1 : 0);
  s.reach = q->a->radius + (q->b ? q->b->radius : 0.0);
  s.floor = solve_floor(q);
  *answer =
      (implicit_answer){.lower = q->far ? -INFINITY : -s.reach, .upper = INFINITY, .attempt = SOLVE_SETTINGS_COUNT};
  solve_place(&s, memory);

  s.least = 4.0 * s.floor + 64.0 * ROUND_U * s.reach;
  const uint32_t most = goal->max_steps;
  for (int attempt = warm && warm->usable ? -1 : 0; attempt < SOLVE_SETTINGS_COUNT && answer->steps < most; attempt++) {
    const solve_settings *settings = &SOLVE_SETTINGS[attempt < 0 ? 0 : attempt];
    if (!(attempt < 0 ? solve_begin_warm(&s, warm, settings) : solve_begin(&s, settings))) continue;
    if (!solve_run(&s, settings, most)) continue;
    answer->attempt = attempt < 0 ? 0 : attempt;
    answer->certified = true;
    break;
  }
  if (!q->far && s.sides == 1 && vec_norm2(answer->normal) > 0.0) solve_hessian(&s);
  if (warm)
    *warm =
        (implicit_warm){.usable = answer->certified && !answer->overlap, .x = answer->x, .y = answer->y, .apart = s.e};
}
