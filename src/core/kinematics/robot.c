/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots from their description: checked, joints taken apart into axes, fixed transforms folded. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "kinematics/joint_tree.h"

enum { AXES_OF_FLOATING = 4 };

/* ---- checks ---- */

static size_t variables_of(cprox_joint_type type) {
  switch (type) {
    case CPROX_JOINT_FIXED: return 0;
    case CPROX_JOINT_REVOLUTE:
    case CPROX_JOINT_PRISMATIC: return 1;
    case CPROX_JOINT_PLANAR: return 3;
    case CPROX_JOINT_FLOATING: return 7;
    case CPROX_JOINT_ROTATION_VECTOR: return 6;
  }
  return 0;
}

static cprox_status check_link(const cprox_link *link, size_t i, size_t n_variables, cprox_workspace *workspace) {
  if (link->parent < -1 || (link->parent >= 0 && (size_t)link->parent >= i))
    return workspace_fail(workspace, CPROX_INVALID, "link %zu: its parent is %d; parents stand before their children",
                          i, (int)link->parent);
  const char *support_failed = frame_pose_error(&link->origin);
  if (support_failed)
    return workspace_fail(workspace, CPROX_INVALID, "link %zu: the joint's origin: %s", i, support_failed);
  if ((unsigned)link->type > CPROX_JOINT_ROTATION_VECTOR)
    return workspace_fail(workspace, CPROX_INVALID, "link %zu: %d is no type of joint", i, (int)link->type);
  const size_t needed = variables_of(link->type);
  if (needed == 0) return CPROX_OK;
  if (link->variable < 0 || (size_t)link->variable + needed > n_variables)
    return workspace_fail(workspace, CPROX_INVALID,
                          "link %zu: its joint needs %zu variables from number %d on, the robot has %zu", i, needed,
                          (int)link->variable, n_variables);
  if (needed > 1) return CPROX_OK;
  const double length2 = vec_norm2(link->axis);
  if (!(length2 > 1e-200 && length2 < 1e200))
    return workspace_fail(workspace, CPROX_INVALID, "link %zu: the joint's axis is (%g, %g, %g)", i, link->axis.x,
                          link->axis.y, link->axis.z);
  if (!isfinite(link->multiplier) || !isfinite(link->offset))
    return workspace_fail(workspace, CPROX_INVALID, "link %zu: multiplier %g and offset %g must be finite", i,
                          link->multiplier, link->offset);
  if (fmax(fabs(link->multiplier), fabs(link->offset)) > LENGTH_MOST)
    return workspace_fail(workspace, CPROX_INVALID, "link %zu: multiplier %g and offset %g must be at most %g", i,
                          link->multiplier, link->offset, LENGTH_MOST);
  return CPROX_OK;
}

size_t robot_sharing_link(const cprox_link *links, size_t n_links, int32_t floating, int32_t first, int32_t count) {
  for (size_t i = 0; i < n_links; i++) {
    const cprox_link *link = &links[i];
    const int32_t begin = link->variable, end = begin + (int32_t)variables_of(link->type);
    const bool is_same = link->type == CPROX_JOINT_FLOATING && begin == floating;
    if (!is_same && begin < end && begin < first + count && end > first) return i;
  }
  return n_links;
}

/* The numbers of a quaternion are one orientation, whatever their norm: as an angle or a length they would be another
 * thing. */
static cprox_status check_quaternions(const cprox_link *links, size_t n_links, cprox_workspace *workspace) {
  for (size_t i = 0; i < n_links; i++) {
    if (links[i].type != CPROX_JOINT_FLOATING) continue;
    const int32_t first = links[i].variable + 3;
    const size_t other = robot_sharing_link(links, n_links, links[i].variable, first, 4);
    if (other < n_links)
      return workspace_fail(workspace, CPROX_INVALID,
                            "link %zu: its joint shares a variable with the quaternion of link %zu, which is variables "
                            "%d to %d; only floating joints with the same seven variables may",
                            other, i, (int)first, (int)first + 3);
  }
  return CPROX_OK;
}

static cprox_status check_geometry(const cprox_link_geometry *g, size_t i, size_t n_links, cprox_workspace *workspace) {
  if (!g->body) return workspace_fail(workspace, CPROX_INVALID, "geometry %zu has no body", i);
  if (g->body->field)
    return workspace_fail(workspace, CPROX_INVALID, "geometry %zu is known by its distance alone: robots have shapes",
                          i);
  if (g->link < 0 || (size_t)g->link >= n_links)
    return workspace_fail(workspace, CPROX_INVALID, "geometry %zu: there is no link %d", i, (int)g->link);
  const char *support_failed = frame_pose_error(&g->pose);
  if (support_failed) return workspace_fail(workspace, CPROX_INVALID, "geometry %zu: %s", i, support_failed);
  if (!(g->margin >= 0.0) || !isfinite(g->margin))
    return workspace_fail(workspace, CPROX_INVALID, "geometry %zu: margin is %g, must be finite and 0 or more", i,
                          g->margin);
  if (!isfinite(g->body->ball_radius))
    return workspace_fail(workspace, CPROX_INVALID,
                          "geometry %zu: a halfspace, or a compound with one; must be bounded", i);
  if (g->margin > LENGTH_MOST || !body_is_in_reach(g->body))
    return workspace_fail(workspace, CPROX_INVALID, "geometry %zu: the body or its margin reaches farther than %g m", i,
                          LENGTH_MOST);
  return CPROX_OK;
}

static cprox_status check_robot(const cprox_link *links, size_t n_links, const cprox_link_geometry *geometries,
                                size_t n_geometries, cprox_robot **robot, size_t n_variables,
                                cprox_workspace *workspace) {
  if (!robot) return workspace_fail(workspace, CPROX_INVALID, "robot is NULL: nowhere to put the handle");
  if (!links || n_links == 0) return workspace_fail(workspace, CPROX_INVALID, "a robot needs at least one link");
  if (!geometries && n_geometries > 0)
    return workspace_fail(workspace, CPROX_INVALID, "geometries is NULL, but %zu are announced", n_geometries);
  if (n_links > INT32_MAX / 8 || n_geometries > INT32_MAX || n_variables > INT32_MAX)
    return workspace_fail(workspace, CPROX_INVALID, "%zu links, %zu geometries, %zu variables are too many", n_links,
                          n_geometries, n_variables);
  for (size_t i = 0; i < n_links; i++) {
    const cprox_status status = check_link(&links[i], i, n_variables, workspace);
    if (status != CPROX_OK) return status;
  }
  const cprox_status shared = check_quaternions(links, n_links, workspace);
  if (shared != CPROX_OK) return shared;
  for (size_t i = 0; i < n_geometries; i++) {
    const cprox_status status = check_geometry(&geometries[i], i, n_links, workspace);
    if (status != CPROX_OK) return status;
  }
  return CPROX_OK;
}

/* ---- axes ---- */

static const placement HERE = {.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}};

static placement placement_of(const cprox_pose *pose) {
  const frame f = frame_create(pose, vec(0, 0, 0));
  placement at = {.p = pose->position};
  for (int i = 0; i < 9; i++) at.r[i] = f.r[i];
  return at;
}

/* The end of a chain under construction: what the next axis, link or part hangs on. */
typedef struct chain_end {
  int32_t axis;
  placement at;
  uint32_t steps;
  double reach;
} chain_end;

static chain_end extend(const chain_end *end, const cprox_pose *pose) {
  const placement step = placement_of(pose);
  return (chain_end){.axis = end->axis,
                     .at = placement_compose(&end->at, &step),
                     .steps = end->steps + 1,
                     .reach = end->reach + vec_norm(pose->position)};
}

/* A unit vector. */
static int8_t coordinate_along(vec3 z) {
  if (z.y == 0.0 && z.z == 0.0) return 0;
  if (z.z == 0.0 && z.x == 0.0) return 1;
  return z.x == 0.0 && z.y == 0.0 ? 2 : -1;
}

static void add_axis(cprox_robot *robot, chain_end *end, axis_kind kind, vec3 z, int32_t variable, double multiplier,
                     double offset, bool first) {
  end->steps++;
  robot->axes[robot->n_axes] = (robot_axis){.kind = kind,
                                            .parent = end->axis,
                                            .variable = variable,
                                            .depth = robot_axis_depth(robot, end->axis) + 1,
                                            .multiplier = multiplier,
                                            .offset = offset,
                                            .at = end->at,
                                            .z = z,
                                            .along = coordinate_along(z),
                                            .first_of_joint = first,
                                            .steps = end->steps,
                                            .reach = end->reach};
  end->axis = (int32_t)robot->n_axes++;
  end->at = HERE;
}

static void add_joint(cprox_robot *robot, chain_end *end, const cprox_link *link) {
  const int32_t v = link->variable;
  switch (link->type) {
    case CPROX_JOINT_FIXED: break;
    case CPROX_JOINT_REVOLUTE:
    case CPROX_JOINT_PRISMATIC:
      add_axis(robot, end, link->type == CPROX_JOINT_REVOLUTE ? AXIS_REVOLUTE : AXIS_PRISMATIC,
               vec_scale(1.0 / vec_norm(link->axis), link->axis), v, link->multiplier, link->offset, true);
      break;
    case CPROX_JOINT_PLANAR:
      add_axis(robot, end, AXIS_PRISMATIC, vec(1, 0, 0), v, 1.0, 0.0, true);
      add_axis(robot, end, AXIS_PRISMATIC, vec(0, 1, 0), v + 1, 1.0, 0.0, false);
      add_axis(robot, end, AXIS_REVOLUTE, vec(0, 0, 1), v + 2, 1.0, 0.0, false);
      break;
    case CPROX_JOINT_FLOATING:
    case CPROX_JOINT_ROTATION_VECTOR:
      add_axis(robot, end, AXIS_PRISMATIC, vec(1, 0, 0), v, 1.0, 0.0, true);
      add_axis(robot, end, AXIS_PRISMATIC, vec(0, 1, 0), v + 1, 1.0, 0.0, false);
      add_axis(robot, end, AXIS_PRISMATIC, vec(0, 0, 1), v + 2, 1.0, 0.0, false);
      add_axis(robot, end, link->type == CPROX_JOINT_FLOATING ? AXIS_BALL : AXIS_VECTOR, vec(0, 0, 1), v + 3, 1.0, 0.0,
               false);
      break;
  }
}

static chain_end link_end(const robot_link *link) {
  return (chain_end){.axis = link->axis, .at = link->at, .steps = link->steps, .reach = link->reach};
}

static void add_link(cprox_robot *robot, const cprox_link *link) {
  const chain_end world = {.axis = -1, .at = HERE};
  const chain_end above = link->parent < 0 ? world : link_end(&robot->links[link->parent]);
  chain_end end = extend(&above, &link->origin);
  add_joint(robot, &end, link);
  robot->links[robot->n_links++] =
      (robot_link){.parent = link->parent, .axis = end.axis, .at = end.at, .steps = end.steps, .reach = end.reach};
}

/* Orders the axes so that all under an axis follow it without a gap. False where memory is out. */
static bool order_axes(cprox_robot *robot) {
  robot_axis *axes = robot->axes;
  int32_t *next =
      calloc(robot->n_axes + 1, sizeof *next); /* the first place free under the world, and under each axis */
  if (!next) return false;
  for (size_t i = 0; i < robot->n_axes; i++) axes[i].branch = 1;
  for (size_t i = robot->n_axes; i-- > 0;)
    if (axes[i].parent >= 0) axes[axes[i].parent].branch += axes[i].branch;
  for (size_t i = 0; i < robot->n_axes; i++) {
    int32_t *from = &next[axes[i].parent + 1];
    axes[i].order = *from;
    *from += axes[i].branch;
    next[i + 1] = axes[i].order + 1;
  }
  free(next);
  return true;
}

/* ---- parts ---- */

static void add_part(cprox_robot *robot, const chain_end *at, const cprox_body *body, double margin, size_t geometry,
                     int32_t link) {
  part_model model = part_model_of(body);
  part_model_find_box(&model);
  model.margin += margin, model.radius += margin, model.tree_margin += margin;
  const chain_end end =
      extend(at, &(cprox_pose){.position = model.centre, .orientation = {.w = 1.0}}); /* the shape's own origin */
  robot->parts[robot->n_parts++] = (robot_part){.model = model,
                                                .geometry = (int32_t)geometry,
                                                .link = link,
                                                .axis = end.axis,
                                                .at = end.at,
                                                .steps = end.steps,
                                                .reach = end.reach + model.radius};
}

static void add_geometry(cprox_robot *robot, const cprox_link_geometry *g, size_t i) {
  const chain_end link = link_end(&robot->links[g->link]), at = extend(&link, &g->pose);
  if (g->body->kind != CPROX_BODY_COMPOUND) {
    add_part(robot, &at, g->body, g->margin, i, g->link);
    return;
  }
  for (size_t k = 0; k < g->body->n_parts; k++) {
    const chain_end part = extend(&at, &g->body->parts[k].pose);
    add_part(robot, &part, g->body->parts[k].body, g->margin, i, g->link);
  }
}

/* ---- robots ---- */

cprox_status cprox_robot_create(const cprox_link *links, size_t n_links, const cprox_link_geometry *geometries,
                                size_t n_geometries, size_t n_variables, cprox_workspace *workspace,
                                cprox_robot **robot) {
  WORKSPACE_USE(workspace);
  workspace_clear(workspace);
  const cprox_status checked = check_robot(links, n_links, geometries, n_geometries, robot, n_variables, workspace);
  if (checked != CPROX_OK) return checked;
  size_t n_parts = 0;
  for (size_t i = 0; i < n_geometries; i++) n_parts += body_n_parts(geometries[i].body);

  cprox_robot *made = calloc(1, sizeof *made);
  if (made) {
    made->links = calloc(n_links, sizeof *made->links);
    made->axes = calloc(AXES_OF_FLOATING * n_links, sizeof *made->axes);
    made->parts = calloc(n_parts + 1, sizeof *made->parts);
    made->first_part = calloc(n_geometries + 1, sizeof *made->first_part);
    made->given_links = calloc(n_links, sizeof *made->given_links);
    made->given_geometries = calloc(n_geometries + 1, sizeof *made->given_geometries);
  }
  if (!made || !made->links || !made->axes || !made->parts || !made->first_part || !made->given_links ||
      !made->given_geometries) {
    cprox_robot_free(made);
    return workspace_fail(workspace, CPROX_MEMORY, "no memory for a robot of %zu links", n_links);
  }

  memcpy(made->given_links, links, n_links * sizeof *links);
  if (n_geometries > 0) memcpy(made->given_geometries, geometries, n_geometries * sizeof *geometries);
  made->n_variables = n_variables;
  made->n_geometries = n_geometries;
  for (size_t i = 0; i < n_links; i++) add_link(made, &links[i]);
  for (size_t i = 0; i < n_geometries; i++) {
    add_geometry(made, &geometries[i], i);
    made->first_part[i + 1] = made->n_parts;
  }
  if (!order_axes(made) || !part_groups_create(made, &made->groups)) {
    cprox_robot_free(made);
    return workspace_fail(workspace, CPROX_MEMORY, "no memory for a robot of %zu links", n_links);
  }
  *robot = made;
  return CPROX_OK;
}

/* ---- several robots ---- */

/* The numbers of links, geometries and variables before a robot's own. */
typedef struct robot_counts {
  size_t links, geometries, variables;
} robot_counts;

/* The base of a robot, its links, and its geometries, in the numbers of the joined robot. */
static void append_robot(const cprox_robot *robot, const cprox_pose *base, robot_counts *at, cprox_link *links,
                         cprox_link_geometry *geometries) {
  links[at->links++] = (cprox_link){.parent = -1, .type = CPROX_JOINT_FIXED, .origin = *base, .multiplier = 1.0};
  for (size_t i = 0; i < robot->n_links; i++) {
    cprox_link *link = &links[at->links + i];
    *link = robot->given_links[i];
    link->parent += (int32_t)at->links; /* -1 becomes the base */
    link->variable += (int32_t)at->variables;
  }
  for (size_t i = 0; i < robot->n_geometries; i++) {
    cprox_link_geometry *geometry = &geometries[at->geometries + i];
    *geometry = robot->given_geometries[i];
    geometry->link += (int32_t)at->links;
  }
  at->links += robot->n_links, at->geometries += robot->n_geometries, at->variables += robot->n_variables;
}

cprox_status cprox_robot_join(const cprox_robot *const *robots, const cprox_pose *bases, size_t n,
                              cprox_workspace *workspace, cprox_robot **robot) {
  WORKSPACE_USE(workspace);
  static const cprox_pose ORIGIN = {.orientation = {.w = 1.0}};
  workspace_clear(workspace);
  if (!robot) return workspace_fail(workspace, CPROX_INVALID, "robot is NULL: nowhere to put the handle");
  if (!robots || n == 0) return workspace_fail(workspace, CPROX_INVALID, "there is no robot to join");
  robot_counts all = {0};
  for (size_t i = 0; i < n; i++) {
    if (!robots[i]) return workspace_fail(workspace, CPROX_INVALID, "robot %zu is NULL", i);
    const char *wrong = bases ? frame_pose_error(&bases[i]) : NULL;
    if (wrong) return workspace_fail(workspace, CPROX_INVALID, "the base of robot %zu: %s", i, wrong);
    all.links += robots[i]->n_links + 1, all.geometries += robots[i]->n_geometries;
    all.variables += robots[i]->n_variables;
    if (all.links > INT32_MAX / 8 || all.geometries > INT32_MAX || all.variables > INT32_MAX)
      return workspace_fail(workspace, CPROX_INVALID, "the robots up to number %zu have too many links", i);
  }
  cprox_link *links = calloc(all.links, sizeof *links);
  cprox_link_geometry *geometries = calloc(all.geometries + 1, sizeof *geometries);
  robot_counts at = {0};
  for (size_t i = 0; links && geometries && i < n; i++)
    append_robot(robots[i], bases ? &bases[i] : &ORIGIN, &at, links, geometries);
  const cprox_status status =
      links && geometries ? WORKSPACE_LEND(workspace, cprox_robot_create(links, at.links, geometries, at.geometries,
                                                                         at.variables, workspace, robot))
                          : workspace_fail(workspace, CPROX_MEMORY, "no memory for a robot of %zu links", all.links);
  free(links);
  free(geometries);
  return status;
}

void cprox_robot_free(cprox_robot *robot) {
  if (!robot) return;
  free(robot->links);
  free(robot->axes);
  free(robot->parts);
  part_groups_free(&robot->groups);
  robot_covers_free(atomic_load(&robot->covers));
  free(robot->given_links);
  free(robot->given_geometries);
  free(robot->first_part);
  free(robot);
}
