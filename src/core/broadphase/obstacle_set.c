/* SPDX-License-Identifier: BSD-3-Clause */
/* Many obstacles in one BVH. */
#include "broadphase/obstacle_set.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "kinematics/link_model.h"
#include "problem/level_of_detail.h"
#include "problem/validate.h"
#include "shape/body.h"

/* The box of a target in the world, rounding included. False where it has none. */
static bool box_of(const cprox_obstacle *target, vec3 *low, vec3 *high) {
  if (target->synchronized) return false;
  const query q = {.targets = target, .n = 1};
  const candidate c = {0};
  if (!target->body) {
    double sizes;
    const candidate_ball round = candidate_bounding_ball(&q, &c, &sizes);
    const double r = round.radius + target->margin + 64.0 * ROUND_U * sizes;
    *low = vec_sub(round.centre, vec(r, r, r));
    *high = vec_add(round.centre, vec(r, r, r));
    return isfinite(r);
  }
  const cprox_body *body = target->body;
  if (!isfinite(body->ball_radius)) return false;
  const frame f = frame_create(&target->pose, vec(0, 0, 0));
  double reach[6];
  const double sizes = vec_norm(body->ball_centre) + body->ball_radius + vec_norm(f.position) + target->margin;
  for (int k = 0; k < 6; k++) {
    const double sign = k < 3 ? 1.0 : -1.0;
    const vec3 d = vec(k % 3 == 0 ? sign : 0.0, k % 3 == 1 ? sign : 0.0, k % 3 == 2 ? sign : 0.0);
    const double h = cprox_body_support(body, frame_turn_to_local(&f, d), NULL);
    reach[k] = h + vec_dot(d, f.position) + target->margin + body->shape.slack + 256.0 * ROUND_U * sizes;
  }
  *high = vec(reach[0], reach[1], reach[2]);
  *low = vec(-reach[3], -reach[4], -reach[5]);
  return vec_finite(*low) && vec_finite(*high);
}

static bool has_elements(const cprox_obstacle *target) {
  return target->body && model_has_tree(target->body, CPROX_LOD_MESH);
}

/* Boxes of targets that have one, the others apart. */
static void sort_targets(cprox_set *set) {
  vec3 low = vec(INFINITY, INFINITY, INFINITY), high = vec(-INFINITY, -INFINITY, -INFINITY);
  for (size_t i = 0; i < set->n; i++) {
    const cprox_obstacle *target = &set->targets[i];
    set->has_clock = set->has_clock || target->synchronized;
    set->has_elements = set->has_elements || has_elements(target);
    set->has_curves = set->has_curves || !target->body;
    set->has_solids = set->has_solids || (target->body && part_model_is_solid(target->body));
    vec3 *a = &set->low[set->n_boxes], *b = &set->high[set->n_boxes];
    if (!box_of(target, a, b)) {
      set->unbounded[set->n_unbounded++] = (uint32_t)i;
      continue;
    }
    low = vec(fmin(low.x, a->x), fmin(low.y, a->y), fmin(low.z, a->z));
    high = vec(fmax(high.x, b->x), fmax(high.y, b->y), fmax(high.z, b->z));
    set->of_box[set->n_boxes++] = (uint32_t)i;
  }
  if (set->n_boxes > 0) set->centre = vec_axpy(vec_scale(0.5, low), 0.5, high);
}

static cprox_set *allocate(size_t n) {
  cprox_set *set = calloc(1, sizeof *set);
  if (!set) return NULL;
  set->n = n;
  set->targets = calloc(n + 1, sizeof *set->targets);
  set->low = calloc(2 * n + 1, sizeof *set->low);
  set->of_box = calloc(2 * n + 1, sizeof *set->of_box);
  if (set->targets && set->low && set->of_box) {
    set->high = set->low + n;
    set->unbounded = set->of_box + n;
    return set;
  }
  cprox_set_free(set);
  return NULL;
}

cprox_status cprox_set_create(const cprox_obstacle *targets, size_t n, cprox_workspace *workspace, cprox_set **set) {
  if (!workspace) return CPROX_INVALID;
  workspace_clear(workspace);
  if (!set) return workspace_fail(workspace, CPROX_INVALID, "set is NULL: nowhere to put the handle");
  const cprox_status checked = arguments_check_targets(targets, n, workspace);
  if (checked != CPROX_OK) return checked;
  if (n > TREE_MOST_ELEMENTS)
    return workspace_fail(workspace, CPROX_INVALID, "%zu targets, at most %zu are possible", n, TREE_MOST_ELEMENTS);
  cprox_set *made = allocate(n);
  if (!made) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a set of %zu targets", n);
  if (n > 0) memcpy(made->targets, targets, n * sizeof *targets);
  sort_targets(made);
  if (made->n_boxes > 0) {
    const tree_source source = {
        .kind = TREE_BOXES, .n = made->n_boxes, .points = made->low, .high = made->high, .centre = made->centre};
    made->boxes = tree_create(&source, TREE_BY_AREA);
    if (!made->boxes) {
      cprox_set_free(made);
      return workspace_fail(workspace, CPROX_MEMORY, "no memory for a set of %zu targets", n);
    }
    for (size_t i = 0; i < made->n_boxes; i++) {
      made->low[i] = vec_sub(made->low[i], made->centre);
      made->high[i] = vec_sub(made->high[i], made->centre);
    }
  }
  *set = made;
  return CPROX_OK;
}

void cprox_set_free(cprox_set *set) {
  if (!set) return;
  free(set->targets);
  free(set->low);    /* high is in the same block */
  free(set->of_box); /* unbounded is in the same block */
  tree_free(set->boxes);
  free(set);
}

size_t cprox_set_size(const cprox_set *set) {
  return set->n;
}

size_t cprox_set_bytes(const cprox_set *set) {
  const size_t each = sizeof *set->targets + 2 * sizeof *set->low + 2 * sizeof *set->of_box;
  return sizeof *set + set->n * each + (set->boxes ? tree_bytes(set->boxes) : 0);
}
