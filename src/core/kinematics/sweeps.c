/* SPDX-License-Identifier: BSD-3-Clause */
#include "kinematics/sweeps.h"

#include <math.h>
#include <stdlib.h>

#include "base/rounding.h"
#include "kinematics/motion.h"

/* Of all sums here, per unit of the sizes that enter. */
#define SWEEP_ERROR (64.0 * ROUND_U)

/* Between the least and the largest coefficient is every value. */
static void value_range(const cprox_motion *m, size_t axis, double *low, double *high) {
  const robot_axis *of = &m->robot->axes[axis];
  const int32_t slot = m->slot[of->variable];
  const motion_track *t = &m->tracks[m->track_of[of->variable]];
  double least = slot < 0 ? m->rest[of->variable] : INFINITY, most = slot < 0 ? least : -INFINITY;
  for (size_t s = 0; s < t->n_segments && slot >= 0; s++) {
    const double *c = t->coefficients + (s * t->n_moving + (size_t)slot - t->first_slot) * t->stride;
    for (size_t i = 0; i <= t->degree[s]; i++) least = lesser(c[i], least), most = greater(c[i], most);
  }
  const double arcs = m->arc_of ? m->sagitta[axis] : 0.0;
  const double a = of->multiplier * least + of->offset, b = of->multiplier * most + of->offset;
  *low = lesser(a, b) - arcs, *high = greater(a, b) + arcs;
}

/* A box from where its origin can be, by shifts alone. */
static void shift_box(vec3 along, double low, double high, vec3 *least, vec3 *most) {
  const vec3 a = vec_scale(low, along), b = vec_scale(high, along);
  *least = vec_add(*least, vec(lesser(a.x, b.x), lesser(a.y, b.y), lesser(a.z, b.z)));
  *most = vec_add(*most, vec(greater(a.x, b.x), greater(a.y, b.y), greater(a.z, b.z)));
}

/* From the world to the first axis that turns: the frame is known but for shifts. All that hangs on that axis is within
 * a ball about its origin. `chain` has room for all axes. */
static part_sweep sweep_of(const cprox_motion *m, size_t index, int32_t *chain) {
  const cprox_robot *robot = m->robot;
  const robot_part *part = &robot->parts[index];
  size_t n = 0;
  for (int32_t i = part->axis; i >= 0; i = robot->axes[i].parent) chain[n++] = i;
  placement at = {.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  vec3 low = vec(0, 0, 0), high = vec(0, 0, 0);
  double shifts = 0.0; /* behind the first axis that turns */
  int32_t turns = -1;
  while (n > 0) {
    const int32_t i = chain[--n];
    const robot_axis *axis = &robot->axes[i];
    double from, to;
    if (turns >= 0) {
      if (axis->kind != AXIS_PRISMATIC) continue;
      value_range(m, (size_t)i, &from, &to);
      shifts += greater(fabs(from), fabs(to));
    } else if (!m->axis_moves[i]) {
      at = placement_compose(&at, &m->still[i]);
    } else {
      at = placement_compose(&at, &axis->at);
      if (axis->kind != AXIS_PRISMATIC) {
        turns = i;
        continue;
      }
      value_range(m, (size_t)i, &from, &to);
      shift_box(placement_turn(&at, axis->z), from, to, &low, &high);
    }
  }
  const vec3 origin = turns < 0 ? placement_apply(&at, part->at.p) : at.p;
  const double behind = turns < 0 ? part->model.radius : part->reach - robot->axes[turns].reach + shifts;
  const double sizes = part->reach + shifts + vec_norm(low) + vec_norm(high);
  return (part_sweep){.low = vec_add(origin, low),
                      .high = vec_add(origin, high),
                      .radius = ROUND_UP * (behind + m->part_error[index] + SWEEP_ERROR * sizes)};
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

double part_sweeps_apart(const part_sweep *a, const part_sweep *b) {
  const double x = beside(a->low.x, a->high.x, b->low.x, b->high.x),
               y = beside(a->low.y, a->high.y, b->low.y, b->high.y),
               z = beside(a->low.z, a->high.z, b->low.z, b->high.z);
  return (1.0 - 8.0 * ROUND_U) * sqrt(x * x + y * y + z * z) - ROUND_UP * (a->radius + b->radius);
}
