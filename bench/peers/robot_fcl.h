/* SPDX-License-Identifier: BSD-3-Clause */
/* What a planner's edge check does: a robot of triangle meshes at one state after the other, by FCL as MoveIt sets it
 * up: a tree of OBBRSS boxes a mesh, a dynamic tree over the world. */
#ifndef CPROX_BENCH_ROBOT_FCL_H
#define CPROX_BENCH_ROBOT_FCL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "curve_proximity/cprox/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* NULL where FCL is not installed: then nothing else below does anything. */
const char *robot_fcl_name(void);

typedef struct robot_fcl robot_fcl;
robot_fcl *robot_fcl_create(void);
void robot_fcl_free(robot_fcl *r);

/* A part of the robot: m triangles, nine numbers each, or a box, a cylinder or capsule along z (the
 * height of its straight part), a sphere. Numbered as they come. */
void robot_fcl_add_mesh(robot_fcl *r, const double *corners, size_t m);
void robot_fcl_add_box(robot_fcl *r, cprox_vec3 edges);
void robot_fcl_add_cylinder(robot_fcl *r, double radius, double height);
void robot_fcl_add_capsule(robot_fcl *r, double radius, double height);
void robot_fcl_add_sphere(robot_fcl *r, double radius);

/* The part added last belongs to the world, and stands there. */
void robot_fcl_stand(robot_fcl *r, cprox_pose pose);

/* Two parts of the robot that are checked against each other. */
void robot_fcl_add_pair(robot_fcl *r, size_t a, size_t b);
void robot_fcl_ready(robot_fcl *r);

/* Where a part is now: x_world = rotation (row-major) x + position. */
void robot_fcl_place(robot_fcl *r, size_t part, cprox_vec3 position, const double rotation[9]);
/* Whether a part touches the world; or that, or a pair touches. */
bool robot_fcl_hits_world(robot_fcl *r);
bool robot_fcl_collides(robot_fcl *r);

/* The least distance of the parts to the world, or of the pairs. */
double robot_fcl_distance(robot_fcl *r, bool of_pairs);

#ifdef __cplusplus
}
#endif
#endif
