/* SPDX-License-Identifier: BSD-3-Clause */
#include "kinematics.h"

#include "trajectory.h"

enum { ORDERS = 3, ROOM = ROBOT_MAX_DEGREE + 1 };

/* A polynomial over the interval: value, first and second derivative in the middle; what the points of its derivatives
 * are at most. */
typedef struct jet {
  num at[ORDERS];
  double most[ORDERS + 1]; /* from 1 */
  double shift;
} jet;

/* The points of the derivative take the place of those of the polynomial. */
static void derive(num *c, size_t degree) {
  for (size_t i = 0; i < degree; i++) c[i] = num_mul(num_of((double)degree), num_sub(c[i + 1], c[i]));
}

static num in_middle(const num *c, size_t degree) {
  num all[ROOM], left[ROOM];
  for (size_t i = 0; i <= degree; i++) all[i] = c[i];
  trajectory_halve(all, degree, left);
  return all[0];
}

static jet jet_of(const num *points, size_t degree) {
  jet j = {.at = {in_middle(points, degree)}};
  num c[ROOM];
  for (size_t i = 0; i <= degree; i++) {
    c[i] = points[i];
    j.shift = fmax(j.shift, num_size(num_sub(c[i], j.at[0])));
  }
  for (size_t order = 1; order <= ORDERS && order <= degree; order++) {
    derive(c, degree - order + 1);
    if (order < ORDERS) j.at[order] = in_middle(c, degree - order);
    for (size_t i = 0; i + order <= degree; i++) j.most[order] = fmax(j.most[order], num_size(c[i]));
  }
  return j;
}

/* ---- axes ---- */

static vec vec_of_numbers(num x, num y, num z) {
  const double e[3] = {x.e, y.e, z.e};
  return (vec){{x.m, y.m, z.m}, GROW(length_of(e))};
}

/* arc: of an axis that turns by slerp. */
static void line_state(const robot *r, const axis *a, const slerp_arc *arc, size_t degree, const num *points,
                       const place *before, axis_state *s) {
  jet j = {.at = {num_of(r->rest[a->variable])}};
  if (a->moves) j = jet_of(points + a->variable * ROOM, degree);
  const num factor = num_of(a->multiplier), value = num_add(num_mul(factor, j.at[0]), num_of(a->offset));
  const num *about = a->kind == AXIS_ARC ? arc->z : a->z;
  const vec z = vec_of_numbers(about[0], about[1], about[2]);
  place moved = {.r = {.m = {1, 0, 0, 0, 1, 0, 0, 0, 1}}};
  if (a->kind == AXIS_SHIFT)
    moved.p = vec_scale(value, &z);
  else
    moved.r = rot_about(about, value);
  if (a->kind == AXIS_ARC) moved.r = rot_product(&moved.r, &arc->start);
  s->frame = place_product(before, &moved);
  s->z = rot_turn(&before->r, &z, false);
  s->velocity = vec_scale(num_mul(factor, j.at[1]), &s->z);
  s->acceleration = vec_scale(num_mul(factor, j.at[2]), &s->z);
  const double size = fabs(a->multiplier);
  s->w = GROW(size * j.most[1]), s->a = GROW(size * j.most[2]), s->g = GROW(size * j.most[3]);
  s->shift = GROW(size * j.shift);
}

/* 2 vec(p q*) / |q|² of quaternions x, y, z, w. */
static vec twice_ratio(const num p[4], const num q[4], num square) {
  const vec u = vec_of_numbers(p[0], p[1], p[2]), v = vec_of_numbers(q[0], q[1], q[2]);
  const vec a = vec_scale(q[3], &u), b = vec_scale(p[3], &v), c = vec_cross(&u, &v);
  const vec ab = vec_sub(&a, &b), abc = vec_sub(&ab, &c);
  return vec_scale(num_div(num_of(2.0), square), &abc);
}

/* omega = 2 vec(p' p*) / |p|², alpha = 2 vec(p'' p*) / |p|² - 2 omega (p·p') / |p|²; the bounds are those of
 * doc/robot-motion-bounds.md. */
static void quaternion_state(const robot *r, const axis *a, size_t degree, const num *points, const place *before,
                             axis_state *s) {
  num p[ORDERS][4], square = num_of(0.0), along = num_of(0.0), c[4][ROOM];
  for (size_t k = 0; k < 4; k++) {
    for (size_t i = 0; i <= degree; i++)
      c[k][i] = r->moved[a->variable + k] ? points[(a->variable + k) * ROOM + i] : num_of(r->rest[a->variable + k]);
    const jet j = jet_of(c[k], degree);
    for (int order = 0; order < ORDERS; order++) p[order][k] = j.at[order];
    square = num_add(square, num_mul(p[0][k], p[0][k]));
    along = num_add(along, num_mul(p[0][k], p[1][k]));
  }
  double rate[ORDERS + 1] = {0};
  for (size_t order = 1; order <= ORDERS && order <= degree; order++) {
    for (size_t k = 0; k < 4; k++) derive(c[k], degree - order + 1);
    for (size_t i = 0; i + order <= degree; i++) {
      double sum = 0.0;
      for (size_t k = 0; k < 4; k++) sum += num_size(c[k][i]) * num_size(c[k][i]);
      rate[order] = fmax(rate[order], GROW(sqrt(sum)));
    }
    rate[order] = GROW(rate[order] / a->least);
  }
  s->w = GROW(2.0 * rate[1]);
  s->a = GROW(2.0 * rate[2] + 4.0 * rate[1] * rate[1]);
  s->g = GROW(2.0 * rate[3] + 14.0 * rate[1] * rate[2] + 20.0 * rate[1] * rate[1] * rate[1]);
  s->shift = 0.5 * s->w;

  const vec omega = twice_ratio(p[1], p[0], square), bent = twice_ratio(p[2], p[0], square);
  const vec slowed = vec_scale(num_div(num_mul(num_of(-2.0), along), square), &omega);
  const vec alpha = vec_add(&bent, &slowed);
  const num q[4] = {p[0][3], p[0][0], p[0][1], p[0][2]};
  const place moved = {.r = rot_of_quaternion(q)};
  s->frame = place_product(before, &moved);
  s->velocity = rot_turn(&before->r, &omega, false);
  s->acceleration = rot_turn(&before->r, &alpha, false);
  s->z = (vec){{0.0, 0.0, 0.0}, 0.0};
}

void kinematics_axes(const robot *r, size_t segment, const num *points, axis_state *states) {
  const size_t degree = r->degrees[segment];
  for (size_t i = 0; i < r->n_axes; i++) {
    const axis *a = &r->axes[i];
    const place before = a->parent < 0 ? a->at : place_product(&states[a->parent].frame, &a->at);
    if (a->kind == AXIS_QUATERNION)
      quaternion_state(r, a, degree, points, &before, &states[i]);
    else
      line_state(r, a, &r->arcs[segment * r->n_axes + i], degree, points, &before, &states[i]);
  }
}

place kinematics_place(const body *b, const axis_state *states) {
  return b->axis < 0 ? b->at : place_product(&states[b->axis].frame, &b->at);
}

/* ---- bodies ---- */

/* The axes that move on the way from what stands up to the axis above both, and down to what moves: numbers from the
 * base to the tip, the first *up of them passed from tip to base. */
static size_t find_chain(const robot *r, int standing, int moving, int *chain, size_t *up) {
  size_t n = 0, down = 0;
  int a = standing, b = moving;
  while (a != b) { /* parents have lower numbers */
    if (a > b) {
      if (r->axes[a].moves) chain[n++] = a;
      a = r->axes[a].parent;
    } else {
      down += r->axes[b].moves;
      b = r->axes[b].parent;
    }
  }
  *up = n;
  n += down;
  for (int i = moving; i != a; i = r->axes[i].parent)
    if (r->axes[i].moves) chain[*up + --down] = i;
  return n;
}

/* From the tip to the base: the lever of each axis over the interval, and how far the body travels. */
static void find_levers(const robot *r, const axis_state *states, const int *chain, size_t n, const vec *centre,
                        double radius, double *levers, double *travel) {
  *travel = 0.0;
  for (size_t i = n; i-- > 0;) {
    const axis_state *s = &states[chain[i]];
    const axis_kind passed = r->axes[chain[i]].kind;
    const vec from = vec_sub(centre, &s->frame.p), across = vec_cross(&s->z, &from);
    const vec *arm = passed == AXIS_QUATERNION ? &from : &across;
    const double middle = passed == AXIS_SHIFT ? 1.0 : GROW(vec_top(arm) + radius);
    levers[i] = passed == AXIS_SHIFT ? 1.0 : GROW(middle + *travel);
    *travel = GROW(*travel + s->shift * middle);
  }
}

/* One more axis towards the tip: what it adds to the motion of the centre. */
static void add_rates(body_motion *m, const axis_state *s, bool shifts, double sign, const vec *centre) {
  static const vec ZERO = {{0.0, 0.0, 0.0}, 0.0};
  const vec w = vec_axpy(&ZERO, sign, &s->velocity), dw = vec_axpy(&ZERO, sign, &s->acceleration);
  const vec turned = vec_cross(&m->omega, &w);
  if (shifts) {
    m->a = vec_add(&m->a, &dw);
    m->a = vec_axpy(&m->a, 2.0, &turned);
    m->v = vec_add(&m->v, &w);
    return;
  }
  const vec from = vec_sub(centre, &s->frame.p), along = vec_cross(&w, &from);
  const vec faster = vec_cross(&dw, &from), inwards = vec_cross(&w, &along), carried = vec_cross(&m->omega, &along);
  m->a = vec_add(&m->a, &faster);
  m->a = vec_add(&m->a, &inwards);
  m->a = vec_axpy(&m->a, 2.0, &carried);
  m->v = vec_add(&m->v, &along);
  m->alpha = vec_add(&m->alpha, &dw);
  m->alpha = vec_add(&m->alpha, &turned);
  m->omega = vec_add(&m->omega, &w);
}

void kinematics_motion(const robot *r, const axis_state *states, const body *moving, const place *at, double radius,
                       const body *standing, int *chain, double *levers, body_motion *m) {
  size_t up;
  const size_t n = find_chain(r, standing->axis, moving->axis, chain, &up);
  *m = (body_motion){.travel = 0.0};
  find_levers(r, states, chain, n, &at->p, GROW(radius + at->p.e + at->r.e * radius), levers, &m->travel);
  double turning = 0.0, speeding = 0.0; /* sums of w and of a over the rotations so far */
  for (size_t i = 0; i < n; i++) {
    const axis_state *s = &states[chain[i]];
    const bool shifts = r->axes[chain[i]].kind == AXIS_SHIFT;
    add_rates(m, s, shifts, i < up ? -1.0 : 1.0, &at->p);
    const double l = levers[i], w = s->w, S = turning, T = turning + w, A = speeding, B = speeding + s->a;
    if (shifts) {
      m->second = GROW(m->second + s->a + 2.0 * w * S);
      m->third = GROW(m->third + s->g + 3.0 * w * S * S + 3.0 * (S * s->a + A * w));
    } else {
      m->second = GROW(m->second + l * (w * (T + S) + s->a));
      m->third = GROW(m->third + l * (w * (T * T + T * S + S * S) + 3.0 * (T * s->a + A * w) + s->g));
      turning = GROW(T), speeding = GROW(B);
    }
  }
}

/* De Casteljau at u: all points become the value there, as if the variable stood still. */
static void hold_at(num *c, size_t degree, double u) {
  const num s = num_of(u);
  for (size_t level = 1; level <= degree; level++)
    for (size_t i = 0; i + level <= degree; i++) c[i] = num_add(c[i], num_mul(s, num_sub(c[i + 1], c[i])));
  for (size_t i = 1; i <= degree; i++) c[i] = c[0];
}

void kinematics_hold(const robot *r, size_t segment, double u, num *points, axis_state *states, place *places) {
  const size_t row = ROBOT_MAX_DEGREE + 1;
  for (size_t i = 0; i < r->n_variables * row; i++) points[i] = robot_points(r, segment, 0)[i];
  for (size_t v = 0; v < r->n_variables; v++)
    if (r->moved[v]) hold_at(points + v * row, r->degrees[segment], u);
  kinematics_axes(r, segment, points, states);
  for (size_t i = 0; i < r->n_bodies; i++) places[i] = kinematics_place(&r->bodies[i], states);
}
