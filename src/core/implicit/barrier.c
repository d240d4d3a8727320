/* SPDX-License-Identifier: BSD-3-Clause */
#include "implicit/barrier.h"

#include "base/rounding.h"

/* A slack may not fall below this fraction of itself in one step. */
static const double BARRIER_LEAST = 0.005;

static void add_outer(const barrier *b, double h[6], double scale, vec3 a) {
  a = barrier_seen(b, a);
  const vec3 s = vec_scale(scale, a);
  h[0] += s.x * a.x;
  h[1] += s.x * a.y;
  h[2] += s.x * a.z;
  h[3] += s.y * a.y;
  h[4] += s.y * a.z;
  h[5] += s.z * a.z;
}

/* Adds scale times the symmetric matrix q. */
static void add_matrix(const barrier *b, double h[6], double scale, const double q[6]) {
  if (!b->axes) {
    for (int i = 0; i < 6; i++) h[i] += scale * q[i];
    return;
  }
  vec3 turned[3];
  for (int i = 0; i < 3; i++) {
    const vec3 a = b->axes[i];
    turned[i] = barrier_seen(b, vec(q[0] * a.x + q[1] * a.y + q[2] * a.z, q[1] * a.x + q[3] * a.y + q[4] * a.z,
                                    q[2] * a.x + q[4] * a.y + q[5] * a.z));
  }
  const double seen[6] = {turned[0].x, turned[0].y, turned[0].z, turned[1].y, turned[1].z, turned[2].z};
  for (int i = 0; i < 6; i++) h[i] += scale * seen[i];
}

/* ---- start ---- */

static void row_begin(barrier_row *row, double value, vec3 gradient, double mu) {
  row->s = -value;
  row->l = mu / row->s;
  row->g = gradient;
}

/* The room that the constraint leaves is shared out among the lifted variables and the slack. */
static double power_begin(const barrier *b, const implicit_power *power, double mu, double lift_below) {
  double room = 1.0;
  int lifted = 0;
  for (int32_t i = power->first; i < power->first + power->n; i++) {
    barrier_term *w = &b->term[i];
    const implicit_term *term = &b->body->term[i];
    w->u = implicit_row(term, b->z);
    w->lifted = term->p < lift_below;
    lifted += w->lifted;
    w->t = implicit_raise(term, fabs(w->u));
    room -= w->t;
  }
  const double share = room / (lifted + 1);
  for (int32_t i = power->first; i < power->first + power->n; i++) {
    barrier_term *w = &b->term[i];
    if (!w->lifted) continue;
    w->t += share;
    w->g = pow(w->t, b->body->term[i].root);
    w->s[0] = w->g - w->u;
    w->s[1] = w->g + w->u;
    w->l[0] = mu / w->s[0];
    w->l[1] = mu / w->s[1];
    if (!(w->s[0] > 0.0 && w->s[1] > 0.0)) return 1.0;
  }
  return lifted > 0 ? -share : -room;
}

bool barrier_begin(barrier *b, vec3 z, double mu, double lift_below) {
  const implicit *body = b->body;
  b->z = z;
  barrier_row *row = b->row;
  for (int32_t k = 0; k < body->n_planes; k++, row++)
    row_begin(row, vec_dot(body->plane[k].b, z) + body->plane[k].c, body->plane[k].b, mu);
  for (int32_t k = 0; k < body->n_quadrics; k++, row++) {
    vec3 gradient;
    const double value = implicit_quadric_at(&body->quadric[k], z, &gradient);
    row_begin(row, value, gradient, mu);
  }
  for (int32_t k = 0; k < body->n_powers; k++, row++)
    row_begin(row, power_begin(b, &body->power[k], mu, lift_below), vec(0, 0, 0), mu);
  for (const barrier_row *r = b->row; r < row; r++)
    if (!(r->s > 0.0)) return false;
  return true;
}

/* ---- the state ---- */

barrier_state barrier_evaluate(const barrier *b) {
  const implicit *body = b->body;
  barrier_state state = {.pairs = implicit_count(body)};
  for (int32_t k = 0; k < state.pairs; k++) {
    const barrier_row *row = &b->row[k];
    state.products += row->s * row->l;
    if (k < body->n_planes + body->n_quadrics) state.force = vec_axpy(state.force, row->l, row->g);
  }
  const barrier_row *row = b->row + body->n_planes + body->n_quadrics;
  for (int32_t k = 0; k < body->n_powers; k++, row++) {
    const implicit_power *power = &body->power[k];
    for (int32_t i = power->first; i < power->first + power->n; i++) {
      const barrier_term *w = &b->term[i];
      const implicit_term *term = &body->term[i];
      if (!w->lifted) {
        const double u = fabs(w->u);
        if (u > 0.0) state.force = vec_axpy(state.force, row->l * term->p * implicit_raise(term, u) / w->u, term->a);
        continue;
      }
      state.pairs += 2;
      state.products += w->s[0] * w->l[0] + w->s[1] * w->l[1];
      state.force = vec_axpy(state.force, w->l[0] - w->l[1], term->a);
      const double g1 = w->g * term->root / w->t;
      state.lifted = fmax(state.lifted, fabs(row->l - g1 * (w->l[0] + w->l[1])) * w->t);
    }
  }
  return state;
}

/* ---- Newton's system ---- */

/* The part of one term: what it adds to the row's reduced gradient, 1/omega and beta, and to the system. */
static void term_assemble(const barrier *side, barrier_term *w, const implicit_term *term, double target,
                          const barrier_row *row, double *over, double *beta, vec3 *reduced, barrier_system *system) {
  if (!w->lifted) {
    const double u = fabs(w->u), power = implicit_raise(term, u);
    const double slope = u > 0.0 ? term->p * power / w->u : 0.0;
    const double bend = u > 0.0 ? term->p * (term->p - 1.0) * power / (u * u) : term->p == 2.0 ? 2.0 : 0.0;
    *reduced = vec_axpy(*reduced, slope, term->a);
    add_outer(side, system->h, row->l * bend, term->a);
    system->rhs = vec_axpy(system->rhs, -row->l * slope, term->a);
    return;
  }
  const double a = w->l[0] / w->s[0], b = w->l[1] / w->s[1], g1 = w->g * term->root / w->t;
  const double g2 = w->g * term->root * (term->root - 1.0) / (w->t * w->t);
  const double c = -(w->l[0] + w->l[1]) * g2, d = c + g1 * g1 * (a + b), e = g1 * (a - b);
  w->g1 = g1;
  w->d = d;
  w->e = e;
  w->k[0] = -(w->l[0] * w->s[0] - target) / w->s[0];
  w->k[1] = -(w->l[1] * w->s[1] - target) / w->s[1];
  w->rho = -(row->l - g1 * (w->l[0] + w->l[1])) + g1 * (w->k[0] + w->k[1]);
  *over += 1.0 / d;
  *beta += w->rho / d;
  *reduced = vec_axpy(*reduced, e / d, term->a);
  add_outer(side, system->h, ((a + b) * c + 4.0 * a * b * g1 * g1) / d, term->a);
  system->rhs = vec_axpy(system->rhs, -((w->l[0] - w->l[1]) + (w->k[0] - w->k[1]) - e * w->rho / d), term->a);
}

void barrier_assemble(barrier *b, double target, barrier_system *system) {
  const implicit *body = b->body;
  const int32_t first_power = body->n_planes + body->n_quadrics, n = implicit_count(body);
  for (int32_t k = 0; k < n; k++) {
    barrier_row *row = &b->row[k];
    double over = row->s / row->l, beta = -(row->l * row->s - target) / row->l;
    vec3 reduced = row->g;
    if (k >= first_power) {
      const implicit_power *power = &body->power[k - first_power];
      reduced = vec(0, 0, 0);
      for (int32_t i = power->first; i < power->first + power->n; i++)
        term_assemble(b, &b->term[i], &body->term[i], target, row, &over, &beta, &reduced, system);
    } else {
      system->rhs = vec_axpy(system->rhs, -row->l, row->g);
      if (k >= body->n_planes) add_matrix(b, system->h, 2.0 * row->l, body->quadric[k - body->n_planes].q);
    }
    row->omega = 1.0 / over;
    row->beta = beta;
    row->reduced = reduced;
    add_outer(b, system->h, row->omega, reduced);
    system->rhs = vec_axpy(system->rhs, -row->omega * beta, reduced);
  }
}

/* ---- steps ---- */

static void limit(double value, double change, double *length) {
  if (change < 0.0 && -value > *length * change) *length = -value / change;
}

void barrier_step(barrier *b, double target, double *primal, double *dual) {
  const implicit *body = b->body;
  const int32_t first_power = body->n_planes + body->n_quadrics, n = implicit_count(body);
  for (int32_t k = 0; k < n; k++) {
    barrier_row *row = &b->row[k];
    row->dl = row->omega * (vec_dot(barrier_seen(b, row->reduced), b->along) + row->beta);
    row->ds = -(row->l * row->s - target + row->s * row->dl) / row->l;
    limit(row->s, row->ds, primal);
    limit(row->l, row->dl, dual);
    if (k < first_power) continue;
    const implicit_power *power = &body->power[k - first_power];
    for (int32_t i = power->first; i < power->first + power->n; i++) {
      barrier_term *w = &b->term[i];
      w->du = vec_dot(barrier_seen(b, body->term[i].a), b->along);
      if (!w->lifted) continue;
      w->dt = (w->rho + w->e * w->du - row->dl) / w->d;
      w->ds[0] = w->g1 * w->dt - w->du;
      w->ds[1] = w->g1 * w->dt + w->du;
      limit(w->t, w->dt, primal);
      for (int j = 0; j < 2; j++) {
        w->dl[j] = w->k[j] - w->l[j] / w->s[j] * w->ds[j];
        limit(w->s[j], w->ds[j], primal);
        limit(w->l[j], w->dl[j], dual);
      }
    }
  }
}

/* The slack of a power at the trial point, negative where a lifted pair has come too near. */
static double power_try(const barrier *b, const implicit_power *power, double length) {
  double room = 1.0;
  for (int32_t i = power->first; i < power->first + power->n; i++) {
    barrier_term *w = &b->term[i];
    const implicit_term *term = &b->body->term[i];
    const double u = implicit_row(term, b->next);
    if (!w->lifted) {
      room -= implicit_raise(term, fabs(u));
      continue;
    }
    const double t = w->t + length * w->dt;
    if (!(t > 0.0)) return -1.0;
    room -= t;
    w->next_g = pow(t, term->root);
    if (!(w->next_g - u >= BARRIER_LEAST * w->s[0] && w->next_g + u >= BARRIER_LEAST * w->s[1])) return -1.0;
  }
  return room;
}

bool barrier_try(barrier *b, double length) {
  const implicit *body = b->body;
  b->next = vec_axpy(b->z, length, b->dz);
  barrier_row *row = b->row;
  for (int32_t k = 0; k < body->n_planes; k++, row++) {
    row->next = -(vec_dot(body->plane[k].b, b->next) + body->plane[k].c);
    if (!(row->next > BARRIER_LEAST * row->s)) return false;
  }
  for (int32_t k = 0; k < body->n_quadrics; k++, row++) {
    row->next = -implicit_quadric_at(&body->quadric[k], b->next, NULL);
    if (!(row->next > BARRIER_LEAST * row->s)) return false;
  }
  for (int32_t k = 0; k < body->n_powers; k++, row++) {
    row->next = power_try(b, &body->power[k], length);
    if (!(row->next > BARRIER_LEAST * row->s)) return false;
  }
  return true;
}

static double held(double l, double s, double least, double most) {
  const double product = l * s;
  return product < least ? least / s : product > most ? most / s : l;
}

void barrier_go(barrier *b, double primal, double dual, double least, double most) {
  const implicit *body = b->body;
  const int32_t n = implicit_count(body);
  b->z = b->next;
  for (int32_t k = 0; k < n; k++) {
    barrier_row *row = &b->row[k];
    row->s = row->next;
    row->l = held(row->l + dual * row->dl, row->s, least, most);
    if (k >= body->n_planes && k < body->n_planes + body->n_quadrics)
      implicit_quadric_at(&body->quadric[k - body->n_planes], b->z, &row->g);
  }
  for (int32_t i = 0; i < body->n_terms; i++) {
    barrier_term *w = &b->term[i];
    w->u = implicit_row(&body->term[i], b->z);
    if (!w->lifted) continue;
    w->t += primal * w->dt;
    w->g = w->next_g;
    w->s[0] = w->g - w->u;
    w->s[1] = w->g + w->u;
    for (int j = 0; j < 2; j++) w->l[j] = held(w->l[j] + dual * w->dl[j], w->s[j], least, most);
  }
}
