/* SPDX-License-Identifier: BSD-3-Clause */
/* The letters are those of doc/robot-motion-bounds.md. */
#include "kinematics/bound.h"

#include <math.h>

#include "base/rounding.h"

size_t motion_chain(const cprox_motion *motion, int32_t from, int32_t to, chain_axis *chain) {
  const robot_axis *axes = motion->robot->axes;
  const int32_t common = robot_common_axis(motion->robot, from, to);
  size_t n = 0;
  for (int32_t i = from; i != common; i = axes[i].parent)
    if (motion->axis_moves[i]) chain[n++] = (chain_axis){.axis = i, .sign = -1.0};

  /* down to the tip: found from the tip up, then turned round */
  const size_t first = n;
  for (int32_t i = to; i != common; i = axes[i].parent)
    if (motion->axis_moves[i]) chain[n++] = (chain_axis){.axis = i, .sign = 1.0};
  for (size_t i = first, k = n; i + 1 < k; i++) {
    const chain_axis swapped = chain[i];
    chain[i] = chain[--k];
    chain[k] = swapped;
  }
  return n;
}

static bool turns(const axis_state *axis) {
  return axis->kind != AXIS_PRISMATIC;
}

static double lever_arm(const axis_state *axis, vec3 centre) {
  const vec3 from = vec_sub(centre, axis->frame.p);
  return axis->kind >= AXIS_BALL ? vec_norm(from) : vec_norm(vec_cross(axis->z, from));
}

/* Returns the displacement bound. r_k in the middle, then the greatest over the node (of a span, over its line): what
 * is tipside shifts the part under the axis. */
static double find_lever_arms(const axis_state *axes, const chain_axis *chain, size_t n, vec3 centre, double radius,
                              double *lever_arms) {
  double tipside = 0.0, displacement = 0.0;
  for (size_t i = n; i-- > 0;) {
    const axis_state *axis = &axes[chain[i].axis];
    const double at_middle = turns(axis) ? ROUND_UP * (lever_arm(axis, centre) + radius) : 1.0;
    lever_arms[i] = turns(axis) ? at_middle + tipside : 1.0;
    tipside += axis->line * at_middle;
    displacement += axis->shift * at_middle;
  }
  return ROUND_UP * displacement;
}

/* A sum over the chain in any order: up from both ends, always from the later axis, to the one above both. */
double motion_displacement(const cprox_motion *motion, const axis_state *axes, int32_t from, int32_t to, vec3 centre,
                           double radius) {
  const robot_axis *robot = motion->robot->axes;
  double displacement = 0.0;
  while (from != to) {
    int32_t *later = from > to ? &from : &to;
    const axis_state *axis = &axes[*later];
    if (motion->axis_moves[*later])
      displacement += axis->shift * (turns(axis) ? ROUND_UP * (lever_arm(axis, centre) + radius) : 1.0);
    *later = robot[*later].parent;
  }
  return ROUND_UP * displacement;
}

double motion_displacements(const cprox_motion *motion, const axis_state *axes, int32_t axis, size_t depth, vec3 centre,
                            double radius, double *displacements) {
  double displacement = 0.0;
  if (displacements) displacements[depth] = 0.0;
  for (; axis >= 0; axis = motion->robot->axes[axis].parent) {
    const axis_state *state = &axes[axis];
    if (motion->axis_moves[axis])
      displacement += state->shift * (turns(state) ? ROUND_UP * (lever_arm(state, centre) + radius) : 1.0);
    if (displacements) displacements[--depth] = ROUND_UP * displacement;
  }
  return ROUND_UP * displacement;
}

void motion_displacements_up(const cprox_motion *motion, const axis_state *axes, int32_t axis, int32_t from,
                             vec3 centre, double radius, double *displacements) {
  const robot_axis *robot = motion->robot->axes;
  size_t depth = robot_axis_depth(motion->robot, axis);
  double displacement = displacements[depth];
  for (; axis != from; axis = robot[axis].parent) {
    const axis_state *state = &axes[axis];
    if (motion->axis_moves[axis])
      displacement += state->shift * (turns(state) ? ROUND_UP * (lever_arm(state, centre) + radius) : 1.0);
    displacements[--depth] = ROUND_UP * displacement;
  }
}

/* Velocity and acceleration of the centre, from the base to the tip. */
static void find_rates(const axis_state *axes, const chain_axis *chain, size_t n, vec3 centre, chain_motion *m) {
  m->v = m->omega = m->a = m->alpha = vec(0, 0, 0);
  for (size_t i = 0; i < n; i++) {
    const axis_state *axis = &axes[chain[i].axis];
    const vec3 w = vec_scale(chain[i].sign, axis->velocity), dw = vec_scale(chain[i].sign, axis->acceleration);
    if (!turns(axis)) {
      m->a = vec_add(m->a, vec_axpy(dw, 2.0, vec_cross(m->omega, w)));
      m->v = vec_add(m->v, w);
      continue;
    }
    const vec3 from = vec_sub(centre, axis->frame.p), along = vec_cross(w, from);
    m->a = vec_add(m->a, vec_add(vec_cross(dw, from), vec_cross(w, along)));
    m->a = vec_axpy(m->a, 2.0, vec_cross(m->omega, along));
    m->v = vec_add(m->v, along);
    m->alpha = vec_add(m->alpha, vec_add(dw, vec_cross(m->omega, w)));
    m->omega = vec_add(m->omega, w);
  }
}

/* The axes that the chain passes from their tips to their bases come first. */
void motion_find_standing_rates(const axis_state *axes, const chain_axis *chain, size_t n, vec3 centre,
                                chain_motion *m) {
  size_t standing = 0;
  while (standing < n && chain[standing].sign < 0.0) standing++;
  chain_motion part;
  find_rates(axes, chain, standing, centre, &part);
  m->v_standing = part.v, m->omega_standing = part.omega;
}

/* A1 = sum r w, A2, A3. */
static void find_derivative_bounds(const axis_state *axes, const chain_axis *chain, size_t n, const double *lever_arms,
                                   chain_motion *m) {
  double s = 0.0, a = 0.0; /* of the turning axes so far */
  m->rate = m->second = m->third = m->error = m->stray = 0.0;
  for (size_t i = 0; i < n; i++) {
    const axis_state *axis = &axes[chain[i].axis];
    const double r = lever_arms[i], w = axis->w;
    m->rate += r * w;
    m->error += r * axis->error;
    m->stray += ROUND_UP * r * axis->stray;
    if (turns(axis)) {
      const double s1 = s + w, a1 = a + axis->a;
      m->second += r * (w * (s1 + s) + axis->a);
      m->third += r * (w * (s1 * s1 + s1 * s + s * s) + 3.0 * (s1 * axis->a + a * w) + axis->g);
      s = s1, a = a1;
    } else {
      m->second += axis->a + 2.0 * w * s;
      m->third += axis->g + 3.0 * w * s * s + 3.0 * (s * axis->a + a * w);
    }
  }
}

void motion_of_part(const axis_state *axes, const chain_axis *chain, size_t n, vec3 centre, double radius,
                    double *scratch, chain_motion *m) {
  m->displacement = find_lever_arms(axes, chain, n, centre, radius, scratch);
  find_rates(axes, chain, n, centre, m);
  find_derivative_bounds(axes, chain, n, scratch, m);
}

/* ---- sides that look the same all round an axis ---- */

/* How far a point of the side moves at most, for each radian that it turns about the axis, from where a turn about its
 * own axis would carry it: the difference of the two velocities. */
static double round_arm(const axis_state *axis, const bound_side *side, uint32_t steps) {
  const vec3 from = vec_sub(side->at.p, axis->frame.p), own = vec(side->at.r[2], side->at.r[5], side->at.r[8]);
  const double reach = greater(side->shape->scale - side->shape->margin, 0.0);
  const double tilt2 =
      lesser(vec_norm2(vec_sub(own, axis->z)), vec_norm2(vec_add(own, axis->z))); /* either way round */
  const double sizes = vec_norm(side->at.p) + vec_norm(axis->frame.p) + reach;
  const double rounding = 2.0 * side->error + ROUND_U * (ROUND_JOINT * (double)steps + 32.0) * sizes;
  return ROUND_UP * (vec_norm(vec_cross(axis->z, from)) + sqrt(tilt2) * reach + rounding);
}

/* How far the side strays if the axis is left out, or infinity where it is not to be: planes lose about a twelfth of
 * the cube of the angle. */
static double round_stray(const axis_state *axis, const bound_side *side, uint32_t steps) {
  if (!side || axis->kind != AXIS_REVOLUTE || !convex_is_round(side->shape)) return INFINITY;
  static const double PLANES_LOSE = 1.0 / 16, MOST = 0.25, HALF_TURN = 3.15;
  const double arm = round_arm(axis, side, steps), whole = lever_arm(axis, side->at.p) + side->shape->scale;
  if (!(arm <= whole * lesser(PLANES_LOSE * axis->w * axis->w, MOST))) return INFINITY;
  return ROUND_UP * lesser(axis->shift, HALF_TURN) * arm;
}

double motion_leave_out_round(const axis_state *axes, chain_axis *chain, size_t *n, const bound_side *moving,
                              const bound_side *standing, uint32_t steps) {
  double stray = 0.0;
  size_t first = 0;
  while (first < *n) {
    const double of_moving = round_stray(&axes[chain[*n - 1].axis], moving, steps);
    const double of_standing = round_stray(&axes[chain[first].axis], standing, steps);
    if (!isfinite(lesser(of_moving, of_standing))) break;
    stray += lesser(of_moving, of_standing);
    if (of_moving < of_standing)
      --*n;
    else
      first++;
  }
  *n -= first;
  for (size_t i = 0; i < *n && first > 0; i++) chain[i] = chain[i + first];
  return stray;
}

/* ---- planes ---- */

double bound_height(const bound_side *side, vec3 n) {
  return side->shape->ops->support(side->shape, placement_turn_back(&side->at, n), NULL, NULL) +
         vec_norm(n) * side->margin;
}

/* Polytopes of more vertices, triangles and the like apart, are asked by their boxes first. */
enum { FEW_VERTICES = 4 };

static bool has_quick_box(const bound_side *side) {
  return side->shape->n > FEW_VERTICES && vec_norm2(side->half) > 0.0;
}

/* min over the core of d·(x - c) at least, by the box round it; rounding included. */
static double lowest_of_box(const bound_side *side, vec3 d) {
  const vec3 e = placement_turn_back(&side->at, d), half = side->half;
  return vec_dot(e, side->middle) - fabs(e.x) * half.x - fabs(e.y) * half.y - fabs(e.z) * half.z -
         vec_norm(d) * 64.0 * ROUND_U * side->shape->scale - side->loss;
}

double bound_lowest(const bound_side *side, vec3 d) {
  const vec3 e = placement_turn_back(&side->at, d);
  if (!side->losses) return -side->shape->ops->support(side->shape, vec_neg(e), NULL, NULL) - side->loss;
  const convex *shape = side->shape;
  double least = INFINITY;
  for (int32_t i = 0; i < shape->n; i++)
    least = lesser(e.x * shape->x[i] + e.y * shape->y[i] + e.z * shape->z[i] - side->losses[i], least);
  return least;
}

/* The support functions do not take 0. */
static bool usable(vec3 d) {
  return vec_norm2(d) > 1e-200;
}

/* What rounding can take from a plane bound, without the size of the bound itself. */
static double plane_slack(const chain_motion *m, const bound_side *moving, const bound_side *standing, vec3 apart,
                          double normal_rate, uint32_t steps) {
  const double joints = ROUND_JOINT * (double)steps + 32.0;
  const double sizes =
      vec_norm(apart) + moving->shape->scale + moving->margin + standing->shape->scale + standing->margin;
  const double turned = (1.0 + normal_rate) * (1.0 + 0.5 * m->rate + 0.125 * m->second);
  const double rounding =
      12.0 * sizes * turned + (1.0 + normal_rate) * joints * (0.5 * m->rate + 0.25 * m->second + m->third / 24.0);
  return ROUND_UP * ((1.0 + normal_rate) * (moving->error + standing->error + m->error) + ROUND_U * rounding +
                     (moving->shape->slack + standing->shape->slack) * turned);
}

/* The least of (a + b theta) / sqrt(1 + k theta) for theta in [0, 1], k >= 0. */
static double least_quotient(double a, double b, double k) {
  if (a <= 0.0 || a + b <= 0.0) return fmin(a, a + b);
  const double end = (a + b) / sqrt(1.0 + k), slope = b - 0.5 * k * a;
  if (slope >= 0.0) return a;
  const double theta = b > 0.0 ? -2.0 * slope / (b * k) : 1.0;
  return theta < 1.0 ? (a + b * theta) / sqrt(1.0 + k * theta) : end;
}

double motion_plane_bound(const chain_motion *m, const bound_side *moving, const bound_side *standing, vec3 n,
                          vec3 normal_rate, const double heights[2], uint32_t steps, double goal, double *slack) {
  const vec3 apart = vec_sub(moving->at.p, standing->at.p);
  const double speed = vec_norm(normal_rate), k = 0.25 * speed * speed;
  *slack = plane_slack(m, moving, standing, apart, speed, steps);

  /* second order: the ends of tau, the node's half-width being 1/2 */
  const vec3 turn = vec_add(vec_cross(n, m->omega), normal_rate);
  const double along = vec_dot(n, m->v) + vec_dot(normal_rate, apart), start = vec_dot(n, apart);
  const vec3 ends[2] = {vec_axpy(n, -0.5, turn), vec_axpy(n, 0.5, turn)};
  if (!usable(ends[0]) || !usable(ends[1])) return -INFINITY;
  /* the margin does not turn: at either end the plane's own normal reaches through it */
  const double turning = moving->margin_turns ? moving->margin : 0.0,
               margin = (moving->margin - turning) * sqrt(1.0 + k);
  double first[2] = {0.0, 0.0}, second = -INFINITY, rounding = 0.0;
  for (int quick = has_quick_box(moving); quick >= 0; quick--) {
    for (int end = 0; end < 2; end++) {
      const double low = quick ? lowest_of_box(moving, ends[end]) : bound_lowest(moving, ends[end]);
      first[end] = start + (end == 0 ? -0.5 : 0.5) * along + low - margin - heights[end];
      if (turning > 0.0) first[end] -= turning * vec_norm(ends[end]);
    }
    const double least = lesser(first[0], first[1]);
    rounding = *slack + 16.0 * ROUND_U * fabs(least);
    second = least_quotient(least - 0.125 * m->second - 0.25 * speed * m->rate - rounding, 0.0, k) - m->stray;
    if (second > goal) break;
  }
  *slack = rounding;
  if (second > goal) return second;

  /* third order: the corners of (tau, sigma), sigma standing for tau² */
  const double speed_squared = vec_norm2(m->omega);
  const vec3 bend =
      vec_add(vec_cross(n, m->alpha), vec_axpy(vec_scale(vec_dot(n, m->omega), m->omega), -speed_squared, n));
  const vec3 bent = vec_axpy(vec_scale(0.125, bend), 0.25, vec_cross(normal_rate, m->omega));
  const double curve = 0.125 * vec_dot(n, m->a) + 0.25 * vec_dot(normal_rate, m->v);
  const double rest = m->third / 48.0 + speed * m->second / 16.0 + rounding;
  double third = INFINITY;
  for (int end = 0; end < 2; end++) {
    const double tau = end == 0 ? -0.5 : 0.5;
    const vec3 d = vec_add(ends[end], bent);
    if (!usable(d)) return second;
    const double low = bound_lowest(moving, d) - margin - (turning > 0.0 ? turning * vec_norm(d) : 0.0);
    const double far = start + tau * along + curve + low - heights[end];
    third = fmin(third, least_quotient(first[end] - rest, far - first[end], k));
  }
  return fmax(second, third - m->stray);
}

/* Along the straight line from the middle to two other times the first derivative is that of a point of the square of
 * both, and the second one at most a quarter of `second`. The least over the moving side is concave in the two times,
 * so it is at a corner of the polygon. */
double motion_plane_bound_of_two(const chain_motion *m, const two_times *times, const bound_side *moving,
                                 const bound_side *standing, vec3 n, double height, uint32_t steps, double *slack) {
  const vec3 apart = vec_sub(moving->at.p, standing->at.p);
  const vec3 v = vec_sub(m->v, m->v_standing), omega = vec_sub(m->omega, m->omega_standing);
  const vec3 turn_standing = vec_cross(n, m->omega_standing), turn = vec_cross(n, omega);
  const double start = vec_dot(n, apart);
  double least = INFINITY;
  for (size_t i = 0; i < times->n; i++) {
    const double at_standing = times->corner[i][times->standing], at = times->corner[i][1 - times->standing];
    const vec3 d = vec_axpy(vec_axpy(n, at_standing, turn_standing), at, turn);
    if (!usable(d)) return -INFINITY;
    const double margin = moving->margin * (moving->margin_turns ? vec_norm(d) : 1.0);
    const double along = at_standing * vec_dot(n, m->v_standing) + at * vec_dot(n, v);
    least = lesser(start + along + bound_lowest(moving, d) - margin - height, least);
  }
  *slack = plane_slack(m, moving, standing, apart, 0.0, steps) + 16.0 * ROUND_U * fabs(least);
  return least - 0.125 * m->second - *slack - m->stray;
}

/* doc/implicit.md, Along a robot's motion: over the node the scaled sides are apart by a number that is concave in tau,
 * less what is of second order, so that it is least at one end. */
double motion_growth_bound(const chain_motion *m, const bound_side *moving, const bound_side *standing, vec3 n,
                           uint32_t steps) {
  const vec3 apart = vec_sub(moving->at.p, standing->at.p), turn = vec_cross(n, m->omega);
  const double slack = plane_slack(m, moving, standing, apart, 0.0, steps) + m->stray;
  const double start = vec_dot(n, apart), along = vec_dot(n, m->v), height = bound_height(standing, n);
  double least = INFINITY;
  for (int end = 0; end < 2; end++) {
    const double tau = end == 0 ? -0.5 : 0.5;
    const vec3 d = vec_axpy(n, tau, turn);
    if (!usable(d)) return 0.0;
    const double between = start + tau * along - 0.125 * m->second - slack;
    if (!(between > 0.0)) return 0.0;
    const double margin = moving->margin * (moving->margin_turns ? vec_norm(d) : 1.0);
    const double reach = height - bound_lowest(moving, d) + margin + 0.25 * m->second + 2.0 * slack;
    least = lesser(between / reach, least);
  }
  return least * (1.0 - 16.0 * ROUND_U);
}
