/* SPDX-License-Identifier: BSD-3-Clause */
/* The queries to a gap: poses in, verdict, value and gradients out. */
#include "base/rounding.h"
#include "base/workspace.h"
#include "fourier/gap.h"

const char *cprox_gap_verdict_name(cprox_gap_verdict verdict) {
  static const char *const names[] = {"clear", "collide", "far", "undecided"};
  return (unsigned)verdict < 4 ? names[verdict] : "unknown";
}

cprox_status gap_check_pose(const char *name, const cprox_pose *pose, int dimension, cprox_workspace *workspace) {
  if (!pose) return fourier_fail(workspace, CPROX_INVALID, "%s is NULL", name);
  const char *support_failed = frame_pose_error(pose);
  if (!support_failed && dimension == 2 && (pose->orientation.x != 0.0 || pose->orientation.y != 0.0))
    support_failed = "a planar pose turns about z only";
  if (!support_failed && dimension == 2 && pose->position.z != 0.0) support_failed = "a planar pose has z = 0";
  return support_failed ? fourier_fail(workspace, CPROX_INVALID, "%s: %s", name, support_failed) : CPROX_OK;
}

/* Both frames, and the relative pose of the turned solid in the fixed one's frame. */
typedef struct relative {
  frame fixed, turned;
  vec3 fixed_centre, turned_centre;
  vec3 x;
  double turn[9];
} relative;

static relative relate(const cprox_gap *gap, const cprox_pose *a, const cprox_pose *b) {
  const bool first = gap->info.turned_first;
  relative r = {.fixed = frame_create(first ? b : a, vec(0, 0, 0)),
                .turned = frame_create(first ? a : b, vec(0, 0, 0)),
                .fixed_centre = first ? gap->centre_b : gap->centre_a,
                .turned_centre = first ? gap->centre_a : gap->centre_b};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      r.turn[3 * i + j] =
          r.fixed.r[i] * r.turned.r[j] + r.fixed.r[3 + i] * r.turned.r[3 + j] + r.fixed.r[6 + i] * r.turned.r[6 + j];
  const vec3 origin = rotate_back(r.fixed.r, vec_sub(r.turned.position, r.fixed.position));
  r.x = vec_sub(vec_add(origin, rotate(r.turn, r.turned_centre)), r.fixed_centre);
  return r;
}

/* Gradients by both poses from those by the relative one. The turned body's centre moves with its rotation, the fixed
 * body turns everything else the other way: dV/dw_fixed = -R m' - origin × V_x with all of it about the fixed body's
 * own origin. */
static void spread_gradients(const cprox_gap *gap, const relative *r, vec3 by_x, vec3 moment,
                             cprox_gap_result *result) {
  /* about the turned body's origin, in the fixed frame */
  const vec3 arm = rotate(r->turn, r->turned_centre);
  const vec3 torque = vec_add(moment, vec_cross(arm, by_x));
  const vec3 position = rotate(r->fixed.r, by_x), rotation = rotate_back(r->turn, torque);
  /* turning the fixed body by w moves the turned one, seen from it, by -w about its own origin */
  const vec3 origin = vec_add(vec_sub(r->x, arm), r->fixed_centre);
  const vec3 reaction = vec_neg(vec_add(torque, vec_cross(origin, by_x)));
  if (gap->info.turned_first) {
    result->position_a = position, result->rotation_a = rotation;
    result->position_b = vec_neg(position), result->rotation_b = reaction;
  } else {
    result->position_b = position, result->rotation_b = rotation;
    result->position_a = vec_neg(position), result->rotation_a = reaction;
  }
}

static void scale_gradients(cprox_gap_result *result, double s) {
  vec3 *const all[] = {&result->position_a, &result->rotation_a, &result->position_b, &result->rotation_b};
  for (int i = 0; i < 4; i++) *all[i] = vec_scale(s, *all[i]);
}

/* Turns V/V_ref into c = -log(V/V_ref). */
static cprox_status answer_signal(const cprox_gap *gap, cprox_workspace *workspace, cprox_gap_result *result) {
  const double least = 2.0 * gap->info.rounding, v = fmax(result->value, least);
  const bool lost = !(result->value > least);
  result->verdict = CPROX_GAP_VERDICT_UNDECIDED;
  result->value = -log(v);
  scale_gradients(result, -1.0 / v);
  return lost ? fourier_fail(workspace, CPROX_PRECISION, "the signal is below its rounding at this pose") : CPROX_OK;
}

static void answer_far(const cprox_gap *gap, cprox_gap_result *result) {
  result->verdict = CPROX_GAP_VERDICT_FAR;
  result->value = gap->info.mode == CPROX_GAP_MODE_SIGNAL ? INFINITY : 0.0;
  result->error = 0.0;
}

static cprox_gap_verdict decide(double value, double error) {
  if (value + error < 1.0 - 1e-12) return CPROX_GAP_VERDICT_CLEAR;
  return value - error > 1.0 ? CPROX_GAP_VERDICT_COLLIDE : CPROX_GAP_VERDICT_UNDECIDED;
}

/* The distance between the bounding spheres, or a bound of that of the solids by directions that separate them; 0:
 * there is neither. Relative to the sizes that went into it, the distance of the spheres is within 1e-14. */
static double clearance_of(const cprox_gap *gap, const relative *r, bool by_directions) {
  const double away = vec_norm(r->x), centres = vec_norm(r->fixed_centre) + vec_norm(r->turned_centre);
  const double spheres = away - gap->radius_a - gap->radius_b - 1e-14 * (away + centres);
  if (spheres > 0.0) return spheres;
  if (!by_directions) return 0.0;
  const bool first = gap->info.turned_first;
  return enclosures_apart(first ? &gap->bounds_b : &gap->bounds_a, first ? &gap->bounds_a : &gap->bounds_b,
                          gap->info.dimension, r->turn, r->x, centres + gap->radius_a + gap->radius_b);
}

double gap_clearance(const cprox_gap *gap, const cprox_pose *a, const cprox_pose *b) {
  const relative r = relate(gap, a, b);
  return clearance_of(gap, &r, true);
}

static cprox_status ask(const cprox_gap *gap, const cprox_pose *a, const cprox_pose *b, bool gradient,
                        cprox_workspace *workspace, cprox_gap_result *result) {
  fourier_clear(workspace);
  if (!gap || !workspace || !result)
    return fourier_fail(workspace, CPROX_INVALID, "%s is NULL", !gap ? "gap" : !workspace ? "workspace" : "result");
  cprox_status status = gap_check_pose("pose_a", a, gap->info.dimension, workspace);
  if (status == CPROX_OK) status = gap_check_pose("pose_b", b, gap->info.dimension, workspace);
  if (status != CPROX_OK) return status;

  const relative r = relate(gap, a, b);
  const bool verdict_alone = !gradient && gap->info.mode != CPROX_GAP_MODE_SIGNAL;
  cprox_gap_result out = {.clearance = clearance_of(gap, &r, verdict_alone)};
  if (out.clearance > 0.0) {
    answer_far(gap, &out);
    *result = out;
    return CPROX_OK;
  }

  gap_job job = {.gap = gap, .x = r.x, .gradient = gradient, .early = verdict_alone};
  for (int i = 0; i < 9; i++) job.turn[i] = r.turn[i];
  job.scratch = cprox_workspace_reserve(workspace, gap_scratch_size(gap));
  if (!job.scratch) return fourier_fail(workspace, CPROX_MEMORY, "no memory for a gap's tables");
  gap_sum(&job);

  out.value = job.value;
  out.error = gap->info.rounding + job.tail;
  out.terms = (uint32_t)(job.blocks * LANES);
  if (gradient) spread_gradients(gap, &r, job.position, job.moment, &out);
  if (gap->info.mode == CPROX_GAP_MODE_SIGNAL)
    status = answer_signal(gap, workspace, &out);
  else
    out.verdict = decide(out.value, out.error);
  const frame first = gap->info.turned_first ? r.turned : r.fixed;
  out.position = rotate_back(first.r, out.position_b);
  out.rotation = out.rotation_b;
  *result = out;
  return status;
}

cprox_status cprox_gap_test(const cprox_gap *gap, const cprox_pose *pose_a, const cprox_pose *pose_b,
                            cprox_workspace *workspace, cprox_gap_result *result) {
  WORKSPACE_USE(workspace);
  return ask(gap, pose_a, pose_b, false, workspace, result);
}

cprox_status cprox_gap_evaluate(const cprox_gap *gap, const cprox_pose *pose_a, const cprox_pose *pose_b,
                                cprox_workspace *workspace, cprox_gap_result *result) {
  WORKSPACE_USE(workspace);
  return ask(gap, pose_a, pose_b, true, workspace, result);
}
