/* SPDX-License-Identifier: BSD-3-Clause */
#include "kinematics/errors.h"

#include <math.h>

#include "base/rounding.h"
#include "kinematics/motion_rates.h"

static double bound_at(const double *bounds, int32_t variable) {
  return bounds ? bounds[variable] : 0.0;
}

deviation errors_of_axis(const cprox_motion *motion, const robot_errors *errors, int32_t index, size_t segment,
                         double u, const motion_interval *interval) {
  const cprox_error_bounds *b = errors->bounds;
  const robot_axis *axis = &motion->robot->axes[index];
  if (axis->kind >= AXIS_BALL) return (deviation){0.0, 0.0};
  const int32_t variable = axis->variable;
  const double speed = bound_at(b->speed, variable), acceleration = bound_at(b->acceleration, variable);
  double middle = bound_at(b->tracking, variable), most = middle;
  if ((speed > 0.0 || acceleration > 0.0) && motion->slot[variable] >= 0) {
    double here[2], over[2];
    motion_rates_at(motion, variable, segment, u, here);
    motion_rates_over(motion, variable, interval, over);
    most += speed * over[0] + acceleration * over[1];
    middle += speed * lesser(here[0], over[0]) + acceleration * lesser(here[1], over[1]);
  }
  const double factor = fabs(axis->multiplier) * errors->scale;
  return (deviation){factor * middle, factor * greater(most - middle, 0.0)};
}

axis_error errors_of_axis_over(const cprox_motion *motion, const robot_errors *errors, int32_t index,
                               const motion_interval *over) {
  const cprox_error_bounds *b = errors->bounds;
  const robot_axis *axis = &motion->robot->axes[index];
  const int32_t variable = axis->variable;
  const double speed = bound_at(b->speed, variable), acceleration = bound_at(b->acceleration, variable);
  double rates[2] = {0.0, 0.0};
  if ((speed > 0.0 || acceleration > 0.0) && motion->slot[variable] >= 0)
    motion_rates_over(motion, variable, over, rates);
  const double factor = errors->scale * fabs(axis->multiplier);
  const double still = ROUND_UP * (factor * (bound_at(b->tracking, variable) + acceleration * rates[1]));
  return (axis_error){
      .still = still, .by_speed = errors->scale * speed, .most = ROUND_UP * (still + factor * speed * rates[0])};
}

/* An axis that is off by e turns or shifts all that is on it by at most e times its lever arm. Over the node the lever
 * arm grows by what moves tipside of it. */
deviation errors_along_chain(const cprox_motion *motion, const axis_state *states, const axis_deviations *off,
                             int32_t from, int32_t to, vec3 centre, double radius, double *travel) {
  const robot_axis *axes = motion->robot->axes;
  double middle = 0.0, most = 0.0, moved = 0.0;
  for (int32_t i = from; i != to; i = axes[i].parent) {
    const axis_state *state = &states[i];
    double arm = 1.0, widest = 1.0;
    if (axes[i].kind != AXIS_PRISMATIC) {
      const vec3 away = vec_sub(centre, state->frame.p);
      arm = axes[i].kind == AXIS_REVOLUTE ? vec_norm(vec_cross(placement_turn(&state->frame, axes[i].z), away))
                                          : vec_norm(away);
      arm = ROUND_UP * (arm + radius);
      widest = arm + moved;
    }
    const deviation *e = &off[i].of;
    middle += e->middle * arm;
    most += (e->middle + e->growth) * widest;
    if (motion->axis_moves[i]) moved += state->shift * arm;
  }
  *travel = ROUND_UP * moved;
  return (deviation){ROUND_UP * middle, ROUND_UP * greater(most - middle, 0.0)};
}

deviation errors_of_base(const robot_errors *errors, vec3 centre, double radius, double travel) {
  const cprox_error_bounds *b = errors->bounds;
  const double arm = vec_norm(vec_sub(centre, b->base_origin)) + radius, scale = ROUND_UP * errors->scale;
  return (deviation){scale * (b->base_position + b->base_rotation * arm), scale * b->base_rotation * travel};
}
