/* SPDX-License-Identifier: BSD-3-Clause */
#include "peers/robot_states.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/frame.h"
#include "bvh/bvh.h"
#include "kinematics/motion.h"
#include "peers/two_ended.h"
#include "shape/body.h"

static void add_shape(robot_fcl *fcl, const cprox_body *body, const cprox_body *surface) {
  const double *size = body->shape.size;
  if (surface) {
    const tree *t = surface->tree;
    double *corners = calloc(9 * (size_t)TREE_LANES * t->n_packs, sizeof *corners), *at = corners;
    for (uint32_t pack = 0; pack < t->n_packs; pack++) {
      for (uint32_t lane = 0; lane < TREE_LANES; lane++) {
        const tree_place place = {pack, lane};
        if (lane > 0 && tree_element(t, place) == tree_element(t, (tree_place){pack, lane - 1})) break;
        vec3 v[3];
        tree_corners(t, place, v);
        for (int k = 0; k < 3; k++, at += 3)
          at[0] = v[k].x + surface->centre.x, at[1] = v[k].y + surface->centre.y, at[2] = v[k].z + surface->centre.z;
      }
    }
    robot_fcl_add_mesh(fcl, corners, (size_t)(at - corners) / 9);
    free(corners);
  } else if (body->kind == CPROX_BODY_BOX) {
    robot_fcl_add_box(fcl, (cprox_vec3){2.0 * size[0], 2.0 * size[1], 2.0 * size[2]});
  } else if (body->kind == CPROX_BODY_CYLINDER) {
    robot_fcl_add_cylinder(fcl, size[0], 2.0 * size[1]);
  } else if (body->kind == CPROX_BODY_CAPSULE) {
    robot_fcl_add_capsule(fcl, size[0], 2.0 * size[1]);
  } else {
    robot_fcl_add_sphere(fcl, body->shape.margin);
  }
}

robot_fcl *robot_states_fcl(const robot_case *c) {
  robot_fcl *fcl = robot_fcl_create();
  for (size_t i = 0; i < c->n_targets; i++) {
    add_shape(fcl, c->targets[i].body, NULL);
    robot_fcl_stand(fcl, c->targets[i].pose);
  }
  for (size_t i = 0; i < c->n_geometries; i++) add_shape(fcl, c->bodies[i], c->surfaces[i]);
  for (size_t i = 0; i < c->n_self_pairs; i++)
    robot_fcl_add_pair(fcl, (size_t)c->self_pairs[i].geometry, (size_t)c->self_pairs[i].other);
  robot_fcl_ready(fcl);
  return fcl;
}

void robot_states_place(robot_fcl *fcl, const robot_case *c, const double *values) {
  placement axes[CASE_MAX_LINKS];
  robot_place_axes(c->robot, values, axes);
  for (size_t g = 0; g < c->n_geometries; g++) {
    const robot_link *link = &c->robot->links[c->links[g]];
    const frame own = frame_create(&c->poses[g], (cprox_vec3){0, 0, 0});
    placement here = {.p = c->poses[g].position};
    memcpy(here.r, own.r, sizeof here.r);
    here = placement_compose(&link->at, &here);
    if (link->axis >= 0) here = placement_compose(&axes[link->axis], &here);
    robot_fcl_place(fcl, g, here.p, here.r);
  }
}

double robot_states_distance(robot_fcl *fcl, const robot_case *c, double step, bool of_pairs, uint32_t *states) {
  double least = INFINITY, values[CASE_MAX_VARIABLES];
  *states = 0;
  for (size_t segment = 0; segment < c->motion->n_segments; segment++) {
    const int count = sampled_steps(c->motion, segment, step);
    for (int i = segment == 0 ? 0 : 1; i <= count; i++) {
      cprox_motion_evaluate(c->motion, motion_time(c->motion, segment, (double)i / count), values);
      robot_states_place(fcl, c, values);
      least = fmin(least, robot_fcl_distance(fcl, of_pairs));
      (*states)++;
    }
  }
  return least;
}
