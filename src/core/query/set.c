/* SPDX-License-Identifier: BSD-3-Clause */
/* Many targets in one tree of boxes. */
#include "curve_proximity/cprox/set.h"

#include <stdlib.h>
#include <string.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "body/body.h"
#include "curve_proximity/cprox/clearance.h"
#include "motion/part_model.h"
#include "query/answer.h"
#include "query/arguments.h"
#include "query/first_contact.h"
#include "query/model.h"
#include "query/robot_answer.h"
#include "query/set_walk.h"

/* ---- making ----------------------------------------------------------------------------------------------------------- */

/* The box of a target in the world, rounding included. False where it has none. */
static bool box_of(const cprox_target *target, vec3 *low, vec3 *high) {
  if (target->on_clock) return false;
  const question q = {.targets = target, .n = 1};
  const candidate c = {0};
  if (!target->body) {
    double sizes;
    const candidate_ball round = candidate_bounding_ball(&q, &c, &sizes);
    const double r = round.radius + target->padding + 64.0 * ROUND_U * sizes;
    *low = vec_sub(round.centre, vec(r, r, r));
    *high = vec_add(round.centre, vec(r, r, r));
    return isfinite(r);
  }
  const cprox_body *body = target->body;
  if (!isfinite(body->ball_radius)) return false;
  const frame f = frame_create(&target->pose, vec(0, 0, 0));
  double reach[6];
  const double sizes = vec_norm(body->ball_centre) + body->ball_radius + vec_norm(f.position) + target->padding;
  for (int k = 0; k < 6; k++) {
    const double sign = k < 3 ? 1.0 : -1.0;
    const vec3 d = vec(k % 3 == 0 ? sign : 0.0, k % 3 == 1 ? sign : 0.0, k % 3 == 2 ? sign : 0.0);
    const double h = cprox_body_support(body, frame_turn_to_local(&f, d), NULL);
    reach[k] = h + vec_dot(d, f.position) + target->padding + body->shape.slack + 256.0 * ROUND_U * sizes;
  }
  *high = vec(reach[0], reach[1], reach[2]);
  *low = vec(-reach[3], -reach[4], -reach[5]);
  return vec_finite(*low) && vec_finite(*high);
}

static bool has_elements(const cprox_target *target) {
  return target->body && model_has_tree(target->body, CPROX_RUNG_MESH);
}

/* Boxes of targets that have one, the others apart. */
static void sort_targets(cprox_set *set) {
  vec3 low = vec(INFINITY, INFINITY, INFINITY), high = vec(-INFINITY, -INFINITY, -INFINITY);
  for (size_t i = 0; i < set->n; i++) {
    const cprox_target *target = &set->targets[i];
    set->has_clock = set->has_clock || target->on_clock;
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

cprox_status cprox_set_create(const cprox_target *targets, size_t n, cprox_workspace *workspace, cprox_set **set) {
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

/* ---- asking ----------------------------------------------------------------------------------------------------------- */

/* The coarser a model, the farther it may reach out of the boxes. */
static bool boxes_hold(const question *q) {
  return q->options.max_rung == CPROX_RUNG_MESH;
}

static cprox_status begin(const cprox_set *set, question *q) {
  cprox_workspace *workspace = q->workspace;
  if (!workspace) return CPROX_INVALID;
  workspace_clear(workspace);
  if (!set) return workspace_fail(workspace, CPROX_INVALID, "set is NULL");
  /* the targets were checked when the set was made, but for what the mover must go with */
  const bool robot = q->mover.motion && (set->has_curves || set->has_solids || q->mover.self || q->mover.pairs);
  const bool all = set->has_clock || (q->mover.body && set->has_elements) || robot;
  const cprox_status checked =
      arguments_check_query(&q->mover, all ? set->targets : NULL, all ? set->n : 0, &q->options, workspace);
  if (checked != CPROX_OK) return checked;
  if (q->options.certificate)
    return workspace_fail(workspace, CPROX_INVALID, "a set leaves no certificates: ask about its targets for that");
  q->targets = set->targets;
  q->n = set->n;
  if (q->mover.motion && !q->mover.pairs && boxes_hold(q)) q->set = set;
  question_ask_whole(q);
  return CPROX_OK;
}

static cprox_status out_of_memory(const question *q) {
  return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for a list of targets");
}

static cprox_status answer(const cprox_set *set, question *q, cprox_result *result) {
  const cprox_status begun = begin(set, q);
  if (begun != CPROX_OK) return begun;
  if (q->mover.motion || !boxes_hold(q)) return question_answer(q, 0, q->n, INFINITY, result);
  set_walk walk;
  if (!set_walk_begin(&walk, set, q)) return out_of_memory(q);
  cprox_result all = question_nothing();
  cprox_status trouble = CPROX_OK;
  double rest = INFINITY;
  for (;;) {
    const bool answered = (!q->is_signed && all.upper <= fmax(q->limit, 0.0)) || trouble == CPROX_STOPPED;
    const double most = answered ? -INFINITY : question_wants_verdict(q) ? q->limit : all.upper;
    uint32_t target;
    if (!set_walk_next(&walk, most, &target, &rest)) return out_of_memory(q);
    if (target == UINT32_MAX || answered) break;
    cprox_result one = {0};
    const cprox_status status = question_answer(q, target, (size_t)target + 1, all.upper, &one);
    if (status < 0) return status;
    if (status != CPROX_OK) trouble = status;
    question_join(&all, &one);
  }
  all.lower = fmin(all.lower, q->is_signed ? rest : fmax(rest, 0.0));
  if (all.rung == CPROX_RUNG_NONE && q->n > 0) all.rung = CPROX_RUNG_SPHERE;
  question_conclude(q, INFINITY, trouble, &all);
  *result = all;
  return all.status;
}

cprox_status cprox_set_distance(const cprox_set *set, cprox_mover mover, const cprox_options *options,
                                cprox_workspace *workspace, cprox_result *result) {
  question q = question_create(mover, NULL, 0, -1.0, false, options, workspace);
  q.is_signed = q.options.signed_distance;
  return answer(set, &q, result);
}

cprox_status cprox_set_tolerance(const cprox_set *set, cprox_mover mover, double delta, const cprox_options *options,
                                 cprox_workspace *workspace, cprox_result *result) {
  const cprox_status checked = arguments_check_delta(delta, workspace);
  if (checked != CPROX_OK) return checked;
  question q = question_create(mover, NULL, 0, delta, true, options, workspace);
  return answer(set, &q, result);
}

cprox_status cprox_set_collision(const cprox_set *set, cprox_mover mover, const cprox_options *options,
                                 cprox_workspace *workspace, cprox_result *result) {
  question q = question_create(mover, NULL, 0, 0.0, false, options, workspace);
  return answer(set, &q, result);
}

cprox_status cprox_set_first_contact(const cprox_set *set, cprox_mover mover, const cprox_options *options,
                                     cprox_workspace *workspace, cprox_result *result) {
  question q = question_create(mover, NULL, 0, 0.0, false, options, workspace);
  const cprox_status begun = begin(set, &q);
  if (begun != CPROX_OK) return begun;
  if (q.set) return robot_first_contact(&q, result);
  if (q.mover.motion || !boxes_hold(&q))
    return cprox_first_contact_all(mover, set->targets, set->n, &q.options, workspace, result);
  set_walk walk;
  if (!set_walk_begin(&walk, set, &q)) return out_of_memory(&q);
  first_contact met = first_contact_begin();
  double rest;
  for (;;) {
    uint32_t target;
    if (!set_walk_next(&walk, 0.0, &target, &rest)) return out_of_memory(&q);
    if (target == UINT32_MAX) break;
    const cprox_status status = first_contact_with(&met, &q, target, (size_t)target + 1);
    if (status < 0) return status;
  }
  met.lower = fmin(met.lower, rest);
  return first_contact_conclude(&met, &q, result);
}

cprox_status cprox_set_nearest(const cprox_set *set, cprox_mover mover, size_t k, const cprox_options *options,
                               cprox_workspace *workspace, cprox_result *nearest, size_t *count) {
  question q = question_create(mover, NULL, 0, -1.0, false, options, workspace);
  const cprox_status begun = begin(set, &q);
  if (begun != CPROX_OK) return begun;
  if (k == 0) return workspace_fail(workspace, CPROX_INVALID, "k is 0: ask for at least one target");
  if (q.mover.motion || !boxes_hold(&q))
    return cprox_nearest(mover, set->targets, set->n, k, &q.options, workspace, nearest, count);
  set_walk walk;
  if (!set_walk_begin(&walk, set, &q)) return out_of_memory(&q);
  *count = 0;
  cprox_status trouble = CPROX_OK;
  while (trouble != CPROX_STOPPED) {
    const double ceiling = *count == k ? nearest[k - 1].upper : INFINITY;
    uint32_t target;
    double lower;
    if (!set_walk_next(&walk, ceiling, &target, &lower)) return out_of_memory(&q);
    if (target == UINT32_MAX) break;
    cprox_result r;
    const cprox_status status = question_answer(&q, target, (size_t)target + 1, ceiling, &r);
    if (status < 0) return status;
    if (trouble == CPROX_OK) trouble = status;
    question_rank(nearest, count, k, &r);
  }
  if (trouble != CPROX_OK) workspace_fail(workspace, trouble, "%s", question_shortfall(trouble));
  return trouble;
}
