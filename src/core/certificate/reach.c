/* SPDX-License-Identifier: BSD-3-Clause */
#include "certificate/reach.h"

#include "base/rounding.h"

/* The margin that is asked for, of the sizes that entered. */
#define MARGIN 0x1p-90

/* ---- arithmetic ---- */

static dd negate(dd a) {
  return (dd){-a.high, -a.low};
}

static dd subtract(dd a, dd b) {
  return dd_add(a, negate(b));
}

static bool is_less(dd a, dd b) {
  return a.high < b.high || (a.high == b.high && a.low < b.low);
}

static dd absolute(dd a) {
  return a.high < 0.0 ? negate(a) : a;
}

/* One step of Newton's from the double root: within 8 u². */
static dd root(dd a) {
  if (!(a.high > 0.0)) return dd_from(0.0);
  const double x = sqrt(a.high);
  return dd_fast_sum(x, subtract(a, dd_product(x, x)).high / (2.0 * x));
}

static dd dot(const reach_direction *n, vec3 p) {
  return dd_add(dd_add(dd_scale(n->k[0], p.x), dd_scale(n->k[1], p.y)), dd_scale(n->k[2], p.z));
}

static dd norm(dd x, dd y, dd z) {
  return root(dd_add(dd_add(dd_multiply(x, x), dd_multiply(y, y)), dd_multiply(z, z)));
}

static dd length(const reach_direction *n) {
  return norm(n->k[0], n->k[1], n->k[2]);
}

/* v × n for a double v. */
static reach_direction cross(vec3 v, const reach_direction *n) {
  return (reach_direction){{subtract(dd_scale(n->k[2], v.y), dd_scale(n->k[1], v.z)),
                            subtract(dd_scale(n->k[0], v.z), dd_scale(n->k[2], v.x)),
                            subtract(dd_scale(n->k[1], v.x), dd_scale(n->k[0], v.y))}};
}

/* R n = n + s(w v × n + v × (v × n)), s = 2/q·q; with -w for the inverse. */
static reach_direction turn(cprox_quat q, double w, const reach_direction *n) {
  const vec3 v = vec(q.x, q.y, q.z);
  if (v.x == 0.0 && v.y == 0.0 && v.z == 0.0) return *n;
  const dd square =
      dd_add(dd_add(dd_product(q.w, q.w), dd_product(q.x, q.x)), dd_add(dd_product(q.y, q.y), dd_product(q.z, q.z)));
  const dd s = dd_divide(dd_from(2.0), square);
  const reach_direction first = cross(v, n), second = cross(v, &first);
  reach_direction turned;
  for (int i = 0; i < 3; i++)
    turned.k[i] = dd_add(n->k[i], dd_multiply(s, dd_add(dd_scale(first.k[i], w), second.k[i])));
  return turned;
}

/* ---- bodies ---- */

/* In doubles n·p is within 5 u (|n1| + |n2| + |n3|) scale: double-double numbers are for those that may be the
 * farthest. */
static dd farthest_vertex(const convex *shape, const reach_direction *n) {
  const double a = n->k[0].high, b = n->k[1].high, c = n->k[2].high;
  const double unsure = 16.0 * ROUND_U * (fabs(a) + fabs(b) + fabs(c)) * shape->scale;
  double highest = -INFINITY;
  for (int32_t i = 0; i < shape->n; i++) {
    const double h = a * shape->x[i] + b * shape->y[i] + c * shape->z[i];
    highest = h > highest ? h : highest;
  }
  dd most = dd_from(-INFINITY);
  for (int32_t i = 0; i < shape->n; i++) {
    if (a * shape->x[i] + b * shape->y[i] + c * shape->z[i] < highest - unsure) continue;
    const dd h = dot(n, vec(shape->x[i], shape->y[i], shape->z[i]));
    if (is_less(most, h)) most = h;
  }
  return most;
}

/* The support function of the body about its centre, margins apart that are balls. A halfspace is only asked along its
 * normal. */
static dd height_of_core(const convex *shape, const reach_direction *n) {
  const double *size = shape->size;
  const dd x = n->k[0], y = n->k[1], z = n->k[2];
  switch (shape->ops->kind) {
    case CPROX_BODY_BOX:
      return dd_add(dd_add(dd_scale(absolute(x), size[0]), dd_scale(absolute(y), size[1])),
                    dd_scale(absolute(z), size[2]));
    case CPROX_BODY_CAPSULE: return dd_scale(absolute(z), size[1]);
    case CPROX_BODY_CYLINDER:
      return dd_add(dd_scale(norm(x, y, dd_from(0.0)), size[0]), dd_scale(absolute(z), size[1]));
    case CPROX_BODY_CONE: {
      const dd apex = dd_scale(z, size[1]);
      const dd rim = subtract(dd_scale(norm(x, y, dd_from(0.0)), size[0]), apex);
      return is_less(apex, rim) ? rim : apex;
    }
    case CPROX_BODY_ELLIPSOID: return norm(dd_scale(x, size[0]), dd_scale(y, size[1]), dd_scale(z, size[2]));
    case CPROX_BODY_HALFSPACE: return dd_from(-size[3]);
    case CPROX_BODY_POLYTOPE:
    case CPROX_BODY_POLYGON: return farthest_vertex(shape, n);
    default: return dd_from(0.0); /* a point, a sphere */
  }
}

/* Brings a direction from the world into the set's own frame; *far becomes n·(where the frame's origin stands). */
static reach_direction to_own_frame(const reach_set *set, const reach_direction *n, reach_value *far) {
  reach_direction own = *n;
  *far = (reach_value){.size = set->offset};
  for (int i = 0; i < set->poses; i++) {
    const cprox_pose *pose = set->pose[i];
    far->value = dd_add(far->value, dot(&own, pose->position));
    far->size += vec_norm(pose->position);
    own = turn(pose->orientation, -pose->orientation.w, &own);
  }
  return own;
}

reach_direction reach_along(vec3 n) {
  return (reach_direction){{dd_from(n.x), dd_from(n.y), dd_from(n.z)}};
}

static reach_direction to_world(const reach_set *set, reach_direction n) {
  for (int i = set->poses - 1; i >= 0; i--) n = turn(set->pose[i]->orientation, set->pose[i]->orientation.w, &n);
  return n;
}

reach_direction reach_of_halfspace(const reach_set *set) {
  const double *size = set->body->shape.size;
  return to_world(set, reach_along(vec(size[0], size[1], size[2])));
}

/* Adds how far the opposite of what is carried reaches. */
static reach_value with_carried(const reach_set *set, const reach_direction *n, reach_value far) {
  if (!set->carried) return far;
  const reach_direction back = {{negate(n->k[0]), negate(n->k[1]), negate(n->k[2])}};
  const reach_value more = reach_of_body(set->carried, &back);
  return (reach_value){dd_add(far.value, more.value), far.size + more.size};
}

reach_value reach_of_body(const reach_set *set, const reach_direction *n) {
  const cprox_body *body = set->body;
  reach_value far;
  const reach_direction own = to_own_frame(set, n, &far);
  const bool rounded = body->kind == CPROX_BODY_SPHERE || body->kind == CPROX_BODY_CAPSULE;
  const double ball = set->offset, margin = rounded ? body->shape.margin : 0.0;
  far.value = dd_add(far.value, dd_add(dot(&own, body->centre), height_of_core(&body->shape, &own)));
  far.value = dd_add(far.value, dd_multiply(length(n), dd_sum(ball, margin)));
  far.size += vec_norm(body->centre) + body->shape.scale;
  return with_carried(set, n, far);
}

reach_value reach_of_elements(const reach_set *set, const reach_direction *n, const element_order *order,
                              const element_range *range) {
  reach_value far;
  const reach_direction own = to_own_frame(set, n, &far);
  const vec3 d = vec(own.k[0].high, own.k[1].high, own.k[2].high);
  const double scale = order->t->scale, height = elements_reach(order, range, d, NULL);
  const dd most = dd_sum(height, 8.0 * ROUND_U * vec_norm(d) * scale);
  far.value = dd_add(far.value, dd_add(dot(&own, set->body->centre), most));
  far.value = dd_add(far.value, dd_scale(length(n), set->offset));
  far.size += vec_norm(set->body->centre) + scale;
  return far;
}

/* ---- bodies by inequalities ---- */

/* What multipliers make: a direction, a bound, and how large the numbers were that made the bound. */
typedef struct multiplied {
  reach_direction n;
  dd most;
  double sizes, unsure;
} multiplied;

static void add_linear(multiplied *m, vec3 b, double c, double l) {
  const double k[3] = {b.x, b.y, b.z};
  for (int i = 0; i < 3; i++) m->n.k[i] = dd_add(m->n.k[i], dd_product(k[i], l));
  m->most = dd_add(m->most, dd_product(-c, l));
  m->sizes += fabs(c * l);
}

/* g·z <= x'Qx - c, g = 2Qx + b */
static void add_quadric(multiplied *m, const implicit_quadric *quadric, vec3 x, double l) {
  const double *q = quadric->q, rows[3][3] = {{q[0], q[1], q[2]}, {q[1], q[3], q[4]}, {q[2], q[4], q[5]}};
  const double at[3] = {x.x, x.y, x.z};
  for (int i = 0; i < 3; i++) {
    dd turned = dd_from(0.0);
    for (int k = 0; k < 3; k++) turned = dd_add(turned, dd_product(rows[i][k], at[k]));
    m->n.k[i] = dd_add(m->n.k[i], dd_scale(turned, 2.0 * l));
    m->most = dd_add(m->most, dd_scale(dd_scale(turned, at[i]), l));
    m->sizes += fabs(turned.high * at[i] * l);
  }
  add_linear(m, quadric->b, quadric->c, l);
}

/* The most that w u - mu u^p can be for 0 <= u <= 1, within the roundings of powers. */
static void add_term(multiplied *m, const implicit_term *term, double mu, double l) {
  const double w = fabs(l), u = term->p > 1.0 && mu > 0.0 ? fmin(pow(w / (mu * term->p), term->slope), 1.0) : 1.0;
  m->most = dd_add(m->most, dd_from(fmax(fmax(w * u - mu * pow(u, term->p), w - mu), 0.0)));
  m->unsure += 16.0 * ROUND_U * (w + mu);
  add_linear(m, term->a, term->d, l);
}

reach_value reach_of_multipliers(const reach_set *set, const implicit_dual *dual, reach_direction *n) {
  const implicit *body = set->body->shape.implicit;
  const double *row = dual->row, *mu = row + body->n_planes + body->n_quadrics;
  multiplied m = {.n = reach_along(vec(0, 0, 0))};
  for (int32_t i = 0; i < body->n_planes; i++) add_linear(&m, body->plane[i].b, body->plane[i].c, row[i]);
  for (int32_t i = 0; i < body->n_quadrics; i++)
    if (row[body->n_planes + i] > 0.0) add_quadric(&m, &body->quadric[i], dual->x, row[body->n_planes + i]);
  for (int32_t k = 0; k < body->n_powers; k++) {
    m.most = dd_add(m.most, dd_from(mu[k]));
    const implicit_power *power = &body->power[k];
    for (int32_t i = power->first; i < power->first + power->n; i++)
      add_term(&m, &body->term[i], mu[k], mu[body->n_powers + i]);
  }
  *n = to_world(set, m.n);
  reach_value far;
  const reach_direction own = to_own_frame(set, n, &far);
  far.value = dd_add(far.value, dd_add(dot(&own, set->body->centre), m.most));
  far.value = dd_add(far.value, dd_scale(length(n), set->offset));
  far.value = dd_add(far.value, dd_from(m.unsure + MARGIN * m.sizes));
  far.size += vec_norm(set->body->centre) + set->body->shape.scale;
  return with_carried(set, n, far);
}

/* ---- curves ---- */

/* Row a becomes that of its part right of s (keep = false), or left of it. */
static void cut(dd *a, size_t degree, dd s, bool left) {
  const dd r = dd_add(dd_from(1.0), negate(s));
  for (size_t level = 1; level <= degree; level++) {
    if (left)
      for (size_t i = degree; i >= level; i--) a[i] = dd_add(dd_multiply(r, a[i - 1]), dd_multiply(s, a[i]));
    else
      for (size_t i = 0; i + level <= degree; i++) a[i] = dd_add(dd_multiply(r, a[i]), dd_multiply(s, a[i + 1]));
  }
}

/* The least ordinate n·P of a part of one piece, less what its conversion may have moved it. */
static dd least_of_piece(const cprox_curve *curve, const cprox_curve *radius, size_t piece, double s0, double s1,
                         const reach_direction *n, double *size) {
  dd a[CPROX_MAX_DEGREE + 1];
  const vec3 *p = curve_piece(curve, piece);
  for (size_t i = 0; i <= curve->degree; i++) {
    a[i] = dot(n, p[i]);
    *size = fmax(*size, vec_norm(p[i]));
    if (!radius) continue;
    const double thick = curve_piece(radius, piece)[i].x;
    a[i] = subtract(a[i], dd_scale(length(n), thick));
    *size = fmax(*size, fabs(thick));
  }
  if (s0 > 0.0) cut(a, curve->degree, dd_from(s0), false);
  if (s1 < 1.0) cut(a, curve->degree, s0 > 0.0 ? dd_divide(dd_sum(s1, -s0), dd_sum(1.0, -s0)) : dd_from(s1), true);
  dd least = a[0];
  for (size_t i = 1; i <= curve->degree; i++)
    if (is_less(a[i], least)) least = a[i];
  const dd moved = dd_scale(length(n), curve->error[piece] + (radius ? ROUND_UP * radius->error[piece] : 0.0));
  return subtract(least, moved);
}

/* The same in doubles, and how far it may be off. */
static double least_in_doubles(const cprox_curve *curve, size_t piece, double s0, double s1, const reach_direction *n,
                               double *off) {
  double a[CPROX_MAX_DEGREE + 1];
  const vec3 *p = curve_piece(curve, piece), d = vec(n->k[0].high, n->k[1].high, n->k[2].high);
  const double sum = fabs(d.x) + fabs(d.y) + fabs(d.z);
  double size = 0.0;
  const size_t degree = curve->degree;
  for (size_t i = 0; i <= degree; i++) {
    a[i] = vec_dot(d, p[i]);
    size = fmax(size, fmax(fmax(fabs(p[i].x), fabs(p[i].y)), fabs(p[i].z)));
  }
  for (size_t level = 1; level <= degree && s0 > 0.0; level++)
    for (size_t i = 0; i + level <= degree; i++) a[i] += s0 * (a[i + 1] - a[i]);
  const double end = s0 > 0.0 ? (s1 - s0) / (1.0 - s0) : s1;
  for (size_t level = 1; level <= degree && s1 < 1.0; level++)
    for (size_t i = degree; i >= level; i--) a[i] = a[i - 1] + end * (a[i] - a[i - 1]);
  double least = a[0];
  for (size_t i = 1; i <= degree; i++) least = a[i] < least ? a[i] : least;
  *off = sum * ((16.0 + 32.0 * (double)degree) * ROUND_U * size + ROUND_UP * curve->error[piece]);
  return least;
}

typedef struct piece_range {
  size_t first, end;
} piece_range;

static piece_range pieces_of(reach_part part) {
  return (piece_range){(size_t)floor(part.from), (size_t)ceil(part.to)};
}

static dd least_of(const cprox_curve *curve, const cprox_curve *radius, reach_part part, size_t piece,
                   const reach_direction *n, double *size) {
  const double k = (double)piece;
  return least_of_piece(curve, radius, piece, fmax(part.from - k, 0.0), fmin(part.to - k, 1.0), n, size);
}

reach_value reach_of_curve(const reach_set *set, const reach_direction *n, reach_part part) {
  reach_value far;
  const reach_direction own = to_own_frame(set, n, &far);
  const reach_direction back = {{negate(own.k[0]), negate(own.k[1]), negate(own.k[2])}};
  dd most = dd_from(-INFINITY);
  double size = 0.0;
  const piece_range range = pieces_of(part);
  for (size_t piece = range.first; piece < range.end; piece++) {
    const dd h = negate(least_of(set->curve, NULL, part, piece, &back, &size));
    if (is_less(most, h)) most = h;
  }
  far.value = dd_add(dd_add(far.value, most), dd_scale(length(n), set->offset));
  far.size += size;
  return with_carried(set, n, far);
}

/* Whether doubles see which side of the limit a piece is on. ABOVE: above it by more than the margin, too. */
typedef enum sign { BELOW, OPEN, ABOVE } sign;

static sign separates_in_doubles(const cprox_curve *curve, reach_part part, size_t piece, const reach_direction *n,
                                 dd long_n, dd limit, double sizes) {
  const double k = (double)piece;
  double off;
  const double least = least_in_doubles(curve, piece, fmax(part.from - k, 0.0), fmin(part.to - k, 1.0), n, &off);
  const double above = least - limit.high;
  const double unsure = 2.0 * off + 4.0 * ROUND_U * (fabs(least) + fabs(limit.high)) + 0x1p-80 * long_n.high * sizes;
  return above > unsure ? ABOVE : above < -unsure ? BELOW : OPEN;
}

bool reach_separates(const cprox_curve *curve, const cprox_curve *radius, reach_part part, const reach_direction *n,
                     const reach_value *reach, double delta) {
  const dd long_n = length(n), limit = dd_add(reach->value, dd_scale(long_n, delta));
  if (!(long_n.high > 0.0) || !isfinite(limit.high)) return false;
  const piece_range range = pieces_of(part);
  for (size_t piece = range.first; piece < range.end; piece++) {
    const sign rough = radius ? OPEN : separates_in_doubles(curve, part, piece, n, long_n, limit, reach->size + delta);
    if (rough == BELOW) return false;
    if (rough == ABOVE) continue;
    double size = 0.0;
    const dd least = least_of(curve, radius, part, piece, n, &size);
    const double margin = MARGIN * long_n.high * (size + reach->size + delta);
    if (!(subtract(least, limit).high > margin)) return false;
  }
  return true;
}
