/* SPDX-License-Identifier: BSD-3-Clause */
/* What others answer about curves and convex shapes, behind one face; each library is built where it is installed.
 * Distances are NAN, parameters -1, where a library gives none. */
#ifndef CPROX_BENCH_CURVE_PEERS_H
#define CPROX_BENCH_CURVE_PEERS_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Curves in space: Bézier curves (knots NULL) and uniform cubic B-splines. */
typedef struct curve_peer {
  const char *name;
  void *(*make)(const double (*points)[3], size_t n, size_t degree, const double *knots);
  double (*to_point)(const void *curve, const double point[3]);
  double (*to_curve)(const void *a, const void *b);
  double (*to_polygon)(const void *curve, const double (*vertices)[3],
                       size_t n); /* convex, filled; NULL: it has none */
  void (*drop)(void *curve);
} curve_peer;

extern const curve_peer curve_peer_occt; /* GeomAPI_ProjectPointOnCurve and both ends; BRepExtrema_DistShapeShape */
extern const curve_peer curve_peer_sisl; /* s1957, s1955 */

typedef enum solid_kind { SOLID_SPHERE, SOLID_BOX, SOLID_CAPSULE, SOLID_CYLINDER, SOLID_CONE, SOLID_KINDS } solid_kind;

/* Dimensions: radius; full edges; height and radius along z, a capsule's between the centres of its ends. */
typedef struct solid {
  solid_kind kind;
  double size[3], position[3], quaternion[4]; /* w x y z */
} solid;

/* A ball of the radius along a chain of points, past a solid. */
typedef struct path_peer {
  const char *name;
  void *(*make)(const solid *standing, double radius);
  double (*answer)(const void *self, const double (*points)[3], size_t n);
  void (*drop)(void *self);
} path_peer;

extern const path_peer path_peer_fcl; /* the least distance at the points */
extern const path_peer
    path_peer_bullet; /* continuous convex on each chord: where they first touch, counted in chords */

#ifdef __cplusplus
}
#endif
#endif
