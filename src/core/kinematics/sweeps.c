/* SPDX-License-Identifier: BSD-3-Clause */
#include "kinematics/sweeps.h"

#include <math.h>
#include <stdlib.h>

#include "base/rounding.h"
#include "kinematics/motion.h"

/* Of all sums here, per unit of the sizes that enter. */
#define SWEEP_ERROR (64.0 * ROUND_U)

/* Between the least and the largest coefficient is every value. */
static void value_range(const cprox_motion *m, size_t axis, size_t first, size_t last, double *low, double *high) {
  const robot_axis *of = &m->robot->axes[axis];
  const int32_t slot = m->slot[of->variable];
  const motion_track *t = &m->tracks[m->track_of[of->variable]];
  double least = m->rest[of->variable], most = least;
  if (slot >= 0) motion_track_range(t, (size_t)slot - t->first_slot, first, last, &least, &most);
  const double arcs = m->arc_of ? m->sagitta[axis] : 0.0;
  const double a = of->multiplier * least + of->offset, b = of->multiplier * most + of->offset;
  *low = lesser(a, b) - arcs, *high = greater(a, b) + arcs;
}

static void range_of_all(const cprox_motion *m, size_t axis, double *low, double *high) {
  value_range(m, axis, 0, motion_track_of(m, axis)->n_segments, low, high);
}

/* A box from where its origin can be, by shifts alone. */
static void shift_box(vec3 along, double low, double high, sweep_box *box) {
  const vec3 a = vec_scale(low, along), b = vec_scale(high, along);
  box->low = vec_add(box->low, vec(lesser(a.x, b.x), lesser(a.y, b.y), lesser(a.z, b.z)));
  box->high = vec_add(box->high, vec(greater(a.x, b.x), greater(a.y, b.y), greater(a.z, b.z)));
}

sweep_box motion_sweep_over(const cprox_motion *m, const part_sweep *sweep, size_t first, size_t last) {
  if (sweep->n_shifts == 0) return sweep->box;
  sweep_box box = {sweep->origin, sweep->origin};
  for (size_t k = 0; k < sweep->n_shifts; k++) {
    double low, high;
    value_range(m, sweep->axes[k], first, last, &low, &high);
    shift_box(sweep->along[k], low, high, &box);
  }
  return box;
}

/* One more axis shifts the part: by so much at most. */
static double add_shift(const cprox_motion *m, size_t axis, vec3 along, part_sweep *sweep) {
  const size_t n = sweep->n_shifts++;
  double from, to;
  range_of_all(m, axis, &from, &to);
  shift_box(along, from, to, &sweep->box);
  if (n < SWEEP_SHIFTS) sweep->along[n] = along, sweep->axes[n] = axis;
  if (motion_track_of(m, sweep->axes[0]) != motion_track_of(m, axis)) sweep->n_shifts = SWEEP_SHIFTS + 1;
  return greater(fabs(from), fabs(to));
}

/* From the world to the first axis that turns: the frame is known but for shifts. All that hangs on that axis is within
 * a ball about its origin. `chain` has room for all axes. */
static part_sweep sweep_of(const cprox_motion *m, size_t index, int32_t *chain) {
  const cprox_robot *robot = m->robot;
  const robot_part *part = &robot->parts[index];
  size_t n = 0;
  for (int32_t i = part->axis; i >= 0; i = robot->axes[i].parent) chain[n++] = i;
  placement at = {.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  part_sweep sweep = {.radius = 0.0};
  double shifts = 0.0, sizes = part->reach; /* behind the first axis that turns; of all that is summed up */
  int32_t turns = -1;
  while (n > 0) {
    const int32_t i = chain[--n];
    const robot_axis *axis = &robot->axes[i];
    if (turns >= 0) {
      double from, to;
      if (axis->kind != AXIS_PRISMATIC) continue;
      range_of_all(m, (size_t)i, &from, &to);
      shifts += greater(fabs(from), fabs(to));
    } else if (!m->axis_moves[i]) {
      at = placement_compose(&at, &m->still[i]);
    } else {
      at = placement_compose(&at, &axis->at);
      if (axis->kind == AXIS_PRISMATIC)
        sizes += add_shift(m, (size_t)i, placement_turn(&at, axis->z), &sweep);
      else
        turns = i;
    }
  }
  if (sweep.n_shifts > SWEEP_SHIFTS) sweep.n_shifts = 0;
  sweep.origin = turns < 0 ? placement_apply(&at, part->at.p) : at.p;
  const double behind = turns < 0 ? part->model.radius : part->reach - robot->axes[turns].reach + shifts;
  sweep.box = (sweep_box){vec_add(sweep.origin, sweep.box.low), vec_add(sweep.origin, sweep.box.high)};
  sweep.radius = ROUND_UP * (behind + m->part_error[index] + SWEEP_ERROR * (sizes + shifts));
  return sweep;
}

bool motion_sweeps_make(cprox_motion *m) {
  int32_t *chain = malloc((m->robot->n_axes + 1) * sizeof *chain);
  m->sweeps = malloc((m->robot->n_parts + 1) * sizeof *m->sweeps);
  for (size_t i = 0; i < m->robot->n_parts && chain && m->sweeps; i++) m->sweeps[i] = sweep_of(m, i, chain);
  const bool made = chain && m->sweeps;
  free(chain);
  return made;
}

static double beside(double low, double high, double other_low, double other_high) {
  return greater(greater(other_low - high, low - other_high), 0.0);
}

double sweep_boxes_apart(const sweep_box *a, const sweep_box *b, double radii) {
  const double x = beside(a->low.x, a->high.x, b->low.x, b->high.x),
               y = beside(a->low.y, a->high.y, b->low.y, b->high.y),
               z = beside(a->low.z, a->high.z, b->low.z, b->high.z);
  return (1.0 - ROUND_LENGTH * ROUND_U) * sqrt(x * x + y * y + z * z) - ROUND_UP * radii;
}

double part_sweeps_apart(const part_sweep *a, const part_sweep *b) {
  return sweep_boxes_apart(&a->box, &b->box, a->radius + b->radius);
}
