/* SPDX-License-Identifier: BSD-3-Clause */
/* What others answer about the first contact of a body that moves with one that stands, behind one face; each library
 * is built where it is installed. */
#ifndef CPROX_BENCH_CONTACT_PEERS_H
#define CPROX_BENCH_CONTACT_PEERS_H

#include "curve_proximity/cprox/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Edge 1; radius .5; height 1 and radius .5 (a capsule's height between the centres of its ends, radius .4); tips .6
 * from the middle. */
typedef enum contact_shape {
  CONTACT_BOX,
  CONTACT_SPHERE,
  CONTACT_CAPSULE,
  CONTACT_CYLINDER,
  CONTACT_OCTAHEDRON
} contact_shape;

typedef enum contact_path {
  CONTACT_STRAIGHT, /* from pose to pose, turning by slerp */
  CONTACT_SCREW,
  CONTACT_BEZIER /* the origin along a cubic, without turning */
} contact_path;

/* From time 0 to 1. */
typedef struct contact_scene {
  const char *name;
  contact_shape moving, standing;
  contact_path path;
  cprox_pose from, to;
  const cprox_vec3 *control; /* four points */
  cprox_pose at;             /* of the one that stands */
} contact_scene;

typedef struct contact_peer {
  const char *name;
  void *(*make)(const contact_scene *scene); /* NULL: it does not take such bodies or motions */
  double (*answer)(void *self);              /* the time of contact; INFINITY: none; NAN: it gave up */
  void (*drop)(void *self);
} contact_peer;

/* Bézier curves on 100 chords: btContinuousConvexCollision, which btCollisionWorld's sweep tests take, and
 * btSubsimplexConvexCast, which does not turn. */
extern const contact_peer contact_peer_bullet_convex, contact_peer_bullet_subsimplex;

/* continuousCollide(): conservative advancement to 1e-6 by libccd, and by FCL's own GJK; its defaults, 10 samples. */
extern const contact_peer contact_peer_fcl_advancement, contact_peer_fcl_other_solver, contact_peer_fcl_defaults;

#ifdef __cplusplus
}
#endif
#endif
