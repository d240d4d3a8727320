/* SPDX-License-Identifier: BSD-3-Clause */
/* The letters are those of doc/robot-poses.md, Control poses. */
#include "robot_query/flight.h"

#include <math.h>

#include "base/rounding.h"

/* ---- the pair ---- */

/* Support values of callbacks and of implicit bodies cost too much to be asked for at every control pose. */
static bool is_quick(const robot_body *body) {
  return !body->tree && !body->side.shape->implicit && body->side.shape->ops != &convex_support_callback;
}

/* The core lies in a ball of this radius about its frame; a halfspace does not move. */
static double size_of(const robot_body *body) {
  return body->side.shape->scale;
}

bool flight_begin(flight *f, const cprox_motion *motion, const robot_body *const body[2], bool rides,
                  const motion_interval *over, double tolerance, cprox_workspace *workspace) {
  f->motion = motion, f->segment = over->first, f->a = over->a, f->b = over->b;
  f->body[0] = *body[0], f->body[1] = *body[1], f->rides = rides;
  if (!is_quick(&f->body[0]) || !is_quick(&f->body[1])) return false;
  for (int k = 0; k <= f->rides; k++)
    if (!pose_chain_of(f->motion, (size_t)f->body[k].part, &f->chain[k])) return false;

  pose_remainder remainder[2];
  size_t degree = 0;
  for (int k = 0; k <= f->rides; k++) {
    const size_t least =
        pose_remainder_find(&f->chain[k], f->segment, f->a, f->b, size_of(&f->body[k]), tolerance, &remainder[k]);
    if (least == 0) return false;
    if (least > degree) degree = least;
  }
  f->basis = pose_basis_of(degree, workspace);
  if (!f->basis) return false;
  double between = 0.0;
  f->error = 0.0;
  for (int k = 0; k <= f->rides; k++) {
    pose_fit_make(&f->chain[k], &remainder[k], f->basis, &f->fit[k]);
    f->error += f->fit[k].turn_error * size_of(&f->body[k]) + f->fit[k].place_error;
  }
  f->origin = f->rides ? f->fit[1].at[degree / 2].p : f->body[1].side.at.p;
  for (int k = 0; k <= f->rides; k++)
    for (size_t i = 0; i <= degree; i++) between = greater(vec_norm(vec_sub(f->fit[k].at[i].p, f->origin)), between);
  const convex *shape[2] = {f->body[0].side.shape, f->body[1].side.shape};
  f->margin = f->body[0].side.margin + f->body[1].side.margin;
  f->sizes = shape[0]->scale + shape[1]->scale + f->margin;
  /* values through which the polynomials go are as exact as places are; Lebesgue's constant is below 3 */
  const double places = 3.0 * (f->body[0].side.error + f->body[1].side.error);
  const double coefficients = f->basis->error + 20.0 * (double)degree * ROUND_U * f->basis->growth;
  f->error = ROUND_UP * (f->error + places + shape[0]->slack + shape[1]->slack +
                         coefficients * (2.0 * (1.0 + f->rides) * between + 2.0 * f->sizes) +
                         32.0 * ROUND_U * f->basis->growth * (f->sizes + between));
  return f->error <= 5.0 * tolerance;
}

void flight_place(flight *f, double x) {
  const double u = x >= 1.0 ? f->b : f->a + (f->b - f->a) * x;
  for (int k = 0; k <= f->rides; k++) f->body[k].side.at = pose_chain_at(&f->chain[k], f->segment, u);
}

/* ---- bounds ---- */

void flight_plane_make(const flight *f, vec3 n, double at, flight_plane *plane) {
  plane->n = n, plane->at = at, plane->rate = vec(0, 0, 0);
  for (int k = 0; k <= f->rides; k++) pose_fit_along(&f->fit[k], f->basis, n, f->origin, &plane->rows[k]);
}

void flight_plane_turn(const flight *f, vec3 rate, flight_plane *plane) {
  plane->rate = rate;
  for (int k = 0; k <= f->rides; k++) pose_fit_along(&f->fit[k], f->basis, rate, f->origin, &plane->rates[k]);
}

static vec3 direction_in(const pose_rows *rows, size_t j) {
  return vec(rows->c[j][0], rows->c[j][1], rows->c[j][2]);
}

static double support_of(const convex *shape, vec3 d) {
  return vec_norm2(d) > 1e-200 ? shape->ops->support(shape, d, NULL, NULL) : 0.0;
}

/* min over the moving core of d·x - max over the standing one of e·x; boxes first, which cost nothing: what they say is
 * no greater. */
static double box_height(const bound_side *side, vec3 d) {
  const vec3 half = side->half;
  return vec_dot(d, side->middle) + fabs(d.x) * half.x + fabs(d.y) * half.y + fabs(d.z) * half.z +
         64.0 * ROUND_U * vec_norm(d) * side->shape->scale;
}

enum { FEW_VERTICES = 4 };

static bool has_quick_box(const bound_side *side) {
  return side->shape->n > FEW_VERTICES && vec_norm2(side->half) > 0.0;
}

/* Coefficient j of the square of the linear function from p to q, of degree n. */
static double square_coefficient(double p, double q, size_t n, size_t j) {
  const double before = (double)j, left = (double)(n - j), all = (double)n * ((double)n - 1.0);
  return (left * (left - 1.0) * p * p + 2.0 * before * left * p * q + before * (before - 1.0) * q * q) / all;
}

/* The polynomial of these coefficients is above 0 from x = 0 up to here: where the hull of the points (j/n, c_j) begins
 * to reach down to 0. */
static double first_crossing(const double *c, size_t n) {
  if (!(c[0] > 0.0)) return 0.0;
  double first = (double)n;
  bool crosses = false;
  for (size_t j = 1; j <= n; j++) {
    if (c[j] > 0.0) continue;
    crosses = true;
    for (size_t i = 0; i < j; i++)
      if (c[i] > 0.0) first = lesser((double)i + (double)(j - i) * c[i] / (c[i] - c[j]), first);
  }
  return crosses ? (1.0 - 1e-12) * first / (double)n : 1.0;
}

void flight_bound_over(const flight *f, const flight_plane *plane, bool turning, double from, double to, double goal,
                       double level, flight_bound *bound) {
  const bound_side *side[2] = {&f->body[0].side, &f->body[1].side};
  pose_rows rows[2];
  const double begin = from - plane->at, end = to - plane->at;
  for (int k = 0; k <= f->rides; k++) {
    rows[k] = plane->rows[k];
    pose_rows_cut(&rows[k], from, to);
    if (!turning) continue;
    pose_rows rates = plane->rates[k];
    pose_rows_cut(&rates, from, to);
    pose_rows_add_turning(&rows[k], &rates, begin, end);
  }
  const size_t n = rows[0].degree;
  const double speed = turning ? vec_norm(plane->rate) : 0.0, half = 0.5 * speed * speed;
  const double reach = turning ? speed * greater(fabs(begin), fabs(end)) : 0.0;
  const bool quick = has_quick_box(side[0]);
  const double standing = f->rides || turning ? 0.0 : robot_pair_height(&f->body[1], plane->n) - side[1]->margin;
  const double error = f->error * (1.0 + reach);
  bound->slack = error, bound->lower = INFINITY, bound->lowest = 0.5, bound->clear = 1.0;
  double above[POSE_FIT_POINTS + 1];
  for (size_t j = 0; j <= n; j++) {
    const double square = turning ? 1.0 + half * square_coefficient(begin, end, n, j) : 1.0;
    const double enough = (goal + f->margin + error) * greater(square, 1.0);
    double height = rows[0].c[j][3];
    if (f->rides) {
      height -= rows[1].c[j][3] + support_of(side[1]->shape, direction_in(&rows[1], j));
    } else if (turning) {
      const double tau = begin + (end - begin) * (double)j / (double)n;
      height -= robot_pair_height(&f->body[1], vec_axpy(plane->n, tau, plane->rate)) -
                vec_norm(vec_axpy(plane->n, tau, plane->rate)) * side[1]->margin;
    } else {
      height -= standing;
    }
    const vec3 down = vec_neg(direction_in(&rows[0], j));
    double low = quick ? height - box_height(side[0], down) : -INFINITY;
    if (!(low > enough)) low = height - support_of(side[0]->shape, down);
    const double least = (low > 0.0 && square > 1.0 ? low / square : low) - f->margin - error;
    if (least < bound->lower) bound->lower = least, bound->lowest = (double)j / (double)n;

    above[j] = low - (level + f->margin + error) * square;
  }
  bound->clear = first_crossing(above, n);
}
