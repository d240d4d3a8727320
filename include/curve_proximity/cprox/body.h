/* SPDX-License-Identifier: BSD-3-Clause */
/** Bodies: compact sets (and halfspaces) in their own frame; immutable once made, shared by any number of threads.
 *
 *  Bodies are closed sets: touching counts as collision. Constructors copy what they are given and check it once; they
 *  return CPROX_INVALID with a message in the workspace (which may be NULL: then without a message), or
 *  CPROX_MEMORY, and leave *body untouched on failure. The handle is the caller's: cprox_body_free(). */
#ifndef CURVE_PROXIMITY_CPROX_BODY_H
#define CURVE_PROXIMITY_CPROX_BODY_H

#include <stdbool.h>

#include <curve_proximity/cprox/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A body: a set of points in its own frame. */
typedef struct cprox_body cprox_body;

typedef enum cprox_body_kind {
  CPROX_BODY_POINT,
  CPROX_BODY_SPHERE,
  CPROX_BODY_BOX,
  CPROX_BODY_CAPSULE,
  CPROX_BODY_CYLINDER,
  CPROX_BODY_CONE,
  CPROX_BODY_ELLIPSOID,
  CPROX_BODY_HALFSPACE,
  CPROX_BODY_POLYTOPE,
  CPROX_BODY_POLYGON,
  CPROX_BODY_COMPOUND,
  CPROX_BODY_SUPPORT,
  CPROX_BODY_SUPERQUADRIC,
  CPROX_BODY_IMPLICIT,
  CPROX_BODY_MESH,
  CPROX_BODY_POINTS,
  CPROX_BODY_OCTREE,
  CPROX_BODY_LOD,
  CPROX_BODY_DISTANCE,
  CPROX_BODY_DISTANCE_GRID
} cprox_body_kind;

/** One point [m], finite. */
CPROX_API cprox_status cprox_body_create_point(cprox_vec3 point, cprox_workspace *workspace, cprox_body **body);

/** A ball about the origin. radius > 0 [m]. */
CPROX_API cprox_status cprox_body_create_sphere(double radius, cprox_workspace *workspace, cprox_body **body);

/** A box about the origin, axes along x, y, z. size: full edge lengths, each > 0 [m]. */
CPROX_API cprox_status cprox_body_create_box(cprox_vec3 size, cprox_workspace *workspace, cprox_body **body);

/** All points within radius of the segment from (0, 0, -height/2) to (0, 0, height/2). height, radius > 0 [m];
 *  height is that between the centres of the hemispheres. */
CPROX_API cprox_status cprox_body_create_capsule(double height, double radius, cprox_workspace *workspace,
                                                 cprox_body **body);

/** A solid cylinder about the z axis, |z| <= height/2. height, radius > 0 [m]. */
CPROX_API cprox_status cprox_body_create_cylinder(double height, double radius, cprox_workspace *workspace,
                                                  cprox_body **body);

/** A solid cone about the z axis: apex at (0, 0, height/2), base disc of the radius at z = -height/2.
 *  height, radius > 0 [m]. */
CPROX_API cprox_status cprox_body_create_cone(double height, double radius, cprox_workspace *workspace,
                                              cprox_body **body);

/** The ellipsoid sum (x_i/semi_axis_i)² <= 1; each semi-axis > 0 [m], the largest at most 1e6 times the least. */
CPROX_API cprox_status cprox_body_create_ellipsoid(cprox_vec3 semi_axes, cprox_workspace *workspace, cprox_body **body);

/** The halfspace normal·x + offset <= 0; normal not 0, of any length. */
CPROX_API cprox_status cprox_body_create_halfspace(cprox_vec3 normal, double offset, cprox_workspace *workspace,
                                                   cprox_body **body);

/** The convex hull of n vertices in any order and of any dimension [m]: one point, collinear and coplanar vertices are
 * a point, a segment, a flat polygon. n >= 1, finite. Vertices that are not extreme are allowed and cost time. */
CPROX_API cprox_status cprox_body_create_polytope(const cprox_vec3 *vertices, size_t n, cprox_workspace *workspace,
                                                  cprox_body **body);

/** A planar convex polygon in the plane z = 0: vertices [m] in counter-clockwise or clockwise order, n >= 3, every turn
 * to the same side (collinear neighbours allowed), area > 0. Its nearest point has a closed form. Against a curve that
 * itself lies in the plane, the inside of the polygon counts as inside: planar problems get planar answers. */
CPROX_API cprox_status cprox_body_create_polygon(const double (*vertices)[2], size_t n, cprox_workspace *workspace,
                                                 cprox_body **body);

/** The union of convex bodies, each at a pose in the frame of the union. n >= 1. The parts are kept by reference and
 * must outlive the compound; a part may not be a compound itself. */
CPROX_API cprox_status cprox_body_create_compound(const cprox_body *const *parts, const cprox_pose *poses, size_t n,
                                                  cprox_workspace *workspace, cprox_body **body);

/** The callback of a convex shape of one's own, with the signature of libccd's ccd_support_fn on doubles: writes to
 *  point[3] a point of the shape that is farthest along direction[3] (which is not 0 and need not be a unit vector). */
typedef void (*cprox_support_fn)(const void *shape, const double direction[3], double point[3]);

/** A convex shape given by its support callback, enlarged by a margin.
 *
 *  shape        handed to the callback, kept by reference: must outlive the body.
 *  centre       a point of the shape [m]; radius: every point of the shape is within it of the centre [m], > 0.
 *  slack        [m] >= 0: how far the callback's points may be from the shape and from its maximum; widens intervals.
 *  margin       [m] >= 0: a ball added to the shape.
 *
 *  Queries detect NaN and points outside the ball, and return CPROX_INVALID. They do not detect a callback that is not
 *  the support function of a convex shape: then the intervals mean nothing. Thread safety: as the callback's.
 */
CPROX_API cprox_status cprox_body_create_support(cprox_support_fn support, const void *shape, cprox_vec3 centre,
                                                 double radius, double slack, double margin, cprox_workspace *workspace,
                                                 cprox_body **body);

/** The callback of a set that is known by its distance alone: the distance from point[3] to the set [m]; inside, 0 or
 *  minus the depth. */
typedef double (*cprox_distance_fn)(const void *shape, const double point[3]);

/** Any compact set, given by its distance function.
 *
 *  shape      handed to the callback, kept by reference: must outlive the body.
 *  centre     [m]; radius: the set lies within it of the centre [m], > 0.
 *  lipschitz  values at two points differ by at most this many times the way between them, > 0; 1 for true distances;
 *             INFINITY where it is not known (values that are rounded to steps, for example).
 *  error      how far a value may be from the distance [m], >= 0.
 *
 *  Answers are certified relative to `error`: the interval is wider by twice that, and where that is more than epsilon,
 *  the status is CPROX_INEXACT. Contact is proven only by values below -error: a callback that answers 0 inside
 * leaves it undecided. Balls on curves are held against such bodies, standing or on the clock; robots, carried bodies,
 *  compounds, pairs, gradients and certificates are refused. A value that is not finite, or that contradicts another
 *  one, `lipschitz`, or `radius`, gives CPROX_INVALID: 256 places are tried at once, and every value of a query is
 *  compared with the one before. What no sample shows is not caught. Witness points on the set are suggestions.
 *  cprox_body_support() is that of the ball. Thread safety: as the callback's. Source: doc/distance-functions.md. */
CPROX_API cprox_status cprox_body_create_distance(cprox_distance_fn distance, const void *shape, cprox_vec3 centre,
                                                  double radius, double lipschitz, double error,
                                                  cprox_workspace *workspace, cprox_body **body);

/** A grid of distances: an ESDF. */
typedef struct cprox_distance_grid {
  /** the points along x, y, z, each at least 2 */
  size_t n[3];
  /** [m] where the first one stands */
  cprox_vec3 origin;
  /** [m] the way from one to the next, > 0 */
  double cell;
  /** [m] n[0] n[1] n[2] distances, x running fastest, then y; negative inside; copied */
  const double *values;
  /** [m] how far a value may be from the distance of its point, >= 0 */
  double error;
  /** [m] values from here on say "at least so far", > 0; INFINITY: none does */
  double truncated_at;
} cprox_distance_grid;

/** The set that a grid of distances describes. Space outside the grid's box is free.
 *
 *  Between the points the value is trilinear, clipped to what the eight corners prove of a distance. The rest of what
 *  that may be off by counts like the `error` of cprox_body_create_distance(): at most error + 0.87 cell, 0 more than
 *  `error` at a grid point. Neighbours that differ by more than cell + 2 error are refused. What holds for bodies by a
 *  distance function holds here, too. */
CPROX_API cprox_status cprox_body_create_distance_grid(const cprox_distance_grid *grid, cprox_workspace *workspace,
                                                       cprox_body **body);

/** What the inside of a mesh is. */
typedef enum cprox_mesh_fill {
  /** nothing: the mesh is its triangles */
  CPROX_MESH_FILL_SURFACE = 0,
  /** part of the body, if the mesh is closed; see cprox_body_info.is_solid */
  CPROX_MESH_FILL_SOLID = 1
} cprox_mesh_fill;

/** A triangle mesh.
 *
 *  vertices      n of them [m], finite, at most 1e60 m from the origin; duplicates are allowed
 *  triangles     m of them, each three indices below n; degenerate and repeated triangles are allowed
 *  fill          CPROX_MESH_FILL_SOLID asks for the inside, too (winding number: Jacobson et al. 2013). It
 *                is granted where the mesh is closed: every edge run through as often one way as the other, vertices
 *                with equal coordinates being one. Where it is not, the body is the surface, and
 *                cprox_body_info.is_solid says so.
 *  memory_limit  the most bytes that the body may take, SIZE_MAX: any. Beyond it CPROX_MEMORY, and the reason names the
 *                bytes.
 *
 *  A mesh can be an obstacle for curves, tubes and convex bodies. It cannot be carried along a curve. A surface has no
 *  inside, so depth is not measured: what overlaps a surface has distance 0. Both arrays are copied. Cost: n
 *  log n. Source: doc/non-convex.md. */
CPROX_API cprox_status cprox_body_create_mesh(const cprox_vec3 *vertices, size_t n, const uint32_t (*triangles)[3],
                                              size_t m, cprox_mesh_fill fill, size_t memory_limit,
                                              cprox_workspace *workspace, cprox_body **body);

/** Heights over a grid: an elevation map. */
typedef struct cprox_height_field {
  /** the points along x and y, each at least 2 */
  size_t n[2];
  /** [m] where the first one stands in the plane z = 0 */
  double origin[2];
  /** [m] the way from one to the next along x and along y, > 0 */
  double cell[2];
  /** [m] n[0] n[1] heights, x running fastest; copied */
  const double *heights;
  /** [m] the ground reaches down to this height, which is below all others; NAN: it is the surface alone */
  double floor;
} cprox_height_field;

/** The mesh of a height field: two triangles a cell, which meet along the diagonal from its least x and y. It is solid
 *  down to the floor, if there is one. The BVH of the mesh is the pyramid of least and greatest heights. A bilinear
 *  surface through the same heights is within |h00 - h01 - h10 + h11|/4 of it in each cell. A height that is not finite
 *  is refused: give cells that are not known a height, or leave them out. memory_limit as for meshes. */
CPROX_API cprox_status cprox_body_create_height_field(const cprox_height_field *field, size_t memory_limit,
                                                      cprox_workspace *workspace, cprox_body **body);

/** The surface of a mesh: the mesh without its inside. The triangles are shared, so `mesh` must outlive the body. */
CPROX_API cprox_status cprox_body_create_surface(const cprox_body *mesh, cprox_workspace *workspace, cprox_body **body);

/** Points, each a ball of the radius [m] >= 0. n >= 1, finite. memory_limit as for meshes. Built for speed: for what a
 *  sensor measures thirty times a second. */
CPROX_API cprox_status cprox_body_create_points(const cprox_vec3 *points, size_t n, double radius, size_t memory_limit,
                                                cprox_workspace *workspace, cprox_body **body);

/** The points of `previous`, but that its point changed[i] stands at points[i] now: for maps of which a part changes,
 *  thirty times a second, while queries run on the body as it was. `previous` stays as it is.
 *
 *  changed, points  n of them; numbers as the points were given first, positions finite. Of one named twice the last
 *                   counts.
 *  retired          a body made from the same points by updates, which no query uses any more, or NULL. On success
 *                   its memory is reused and the handle becomes invalid: with two bodies in turns only the changes are
 *                   written.
 *
 *  Cost: blocks of 4096 neighbouring points with a change in them are sorted anew; without `retired` the rest is
 *  copied. Points that wander far make wide boxes and slow queries, never wrong ones: make the body anew then. */
CPROX_API cprox_status cprox_body_update_points(const cprox_body *previous, const uint32_t *changed,
                                                const cprox_vec3 *points, size_t n, cprox_body *retired,
                                                cprox_workspace *workspace, cprox_body **body);

/** Boxes along the axes, from low[i] to high[i], low <= high, as an octree's occupied leaves are. n >= 1, finite. They
 *  may overlap. Each is solid. memory_limit as for meshes. */
CPROX_API cprox_status cprox_body_create_boxes(const cprox_vec3 *low, const cprox_vec3 *high, size_t n,
                                               size_t memory_limit, cprox_workspace *workspace, cprox_body **body);

/** A level-of-detail body of models of one set: the mesh, and a convex hull of it that answers what does not need the
 *  mesh.
 *
 *  hull    convex: a polytope, or any other convex body but a halfspace.
 *  excess  [m] >= 0: no point of the mesh is farther than this from the hull. 0 for its convex hull, made of its own
 *          vertices. Checked along 26 directions only: a hull that leaves out more would make answers wrong.
 *  mesh    a mesh, points or boxes.
 *
 *  Both are kept by reference, stand in the frame of the level-of-detail body, and must outlive it. A level-of-detail
 *  body may be part of a compound. Queries climb from the hull to the mesh where the hull cannot decide;
 *  cprox_options.max_lod ends the refinement before, and cprox_result.lod says how far it went. Its support,
 *  nearest point and bounding sphere are the mesh's. */
CPROX_API cprox_status cprox_body_create_lod(const cprox_body *hull, double excess, const cprox_body *mesh,
                                             cprox_workspace *workspace, cprox_body **body);

/** Frees a body; NULL is allowed. No query and no compound may be using it. */
CPROX_API void cprox_body_free(cprox_body *body);

/** What is known of a body. */
typedef struct cprox_body_info {
  /** the kind that the body was created as */
  cprox_body_kind kind;
  /** whether the inside belongs to the body: false for mesh surfaces only */
  bool is_solid;
  /** the bytes that a mesh, a set of points or a set of boxes takes; 0 for other kinds */
  size_t bytes;
  /** [m] the centre of a ball that contains the body, in the frame of the body */
  cprox_vec3 centre;
  /** [m] the radius of that ball, rounding included; infinity for a halfspace */
  double radius;
} cprox_body_info;

/** What is known of a body. */
CPROX_API cprox_body_info cprox_body_get_info(const cprox_body *body);

/** The name of a kind ("sphere", "polytope", …). Never NULL. */
CPROX_API const char *cprox_body_kind_name(cprox_body_kind kind);

/** The support function h(d) = max over the body of d·x, for any finite d that is not 0 (infinity for most directions
 * of a halfspace), and a point of the body that attains it, NULL if not needed. */
CPROX_API double cprox_body_support(const cprox_body *body, cprox_vec3 direction, cprox_vec3 *point);

/** The nearest point of the body to a point of its frame, and the distance to it: negative inside (minus the distance
 * to the surface) for the kinds that can tell, else 0. nearest NULL if not needed. Accuracy: 64 2^-53 (|point| + size);
 * inside support bodies, superquadrics and implicit bodies whatever 400 support queries tell. A plain evaluation:
 * certified answers come from the queries. Inside polytopes of more than 400 vertices it allocates memory while it
 * runs. */
CPROX_API double cprox_body_nearest(const cprox_body *body, cprox_vec3 point, cprox_vec3 *nearest);

#ifdef __cplusplus
}
#endif
#endif
