/* SPDX-License-Identifier: BSD-3-Clause */
/** Fourier gap functions: a smooth measure of how much two solids overlap, with its SE(2) or SE(3) gradient.
 *
 *  Solids are given by the closed-form Fourier transforms of their (offset) indicators. A gap is made once for a pair
 *  of solids and an accuracy; then each pose costs one short sum. The gap speaks of overlapping *interiors*: touching
 *  surfaces do not count, unlike in libcprox.
 *
 *  In the certified mode CPROX_GAP_VERDICT_CLEAR is a proof that the interiors do not overlap.
 *  CPROX_GAP_VERDICT_COLLIDE only says that they may: solids farther apart than cprox_gap_info.over_reach are never
 *  called so.
 *
 *  Dimension 2: the plane z = 0; poses turn about z only and have position.z = 0.
 *  The library is libcprox_fourier, on top of libcprox: link both. Solids and gaps are immutable once made and shared
 *  by any number of threads, each with its own workspace.
 *  Source: M. Lysenko, "Fourier Collision Detection", 2011, with the corrections of doc/fourier.md. */
#ifndef CURVE_PROXIMITY_CPROX_FOURIER_H
#define CURVE_PROXIMITY_CPROX_FOURIER_H

#include <stdbool.h>

#include <curve_proximity/cprox/base.h>
#include <curve_proximity/cprox/body.h>
#include <curve_proximity/cprox/curve.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Solids ---- */

/** A solid in the plane or in space, as a nonnegative function that is at least 1 on it: the indicator, or the sum of
 *  the indicators of its pieces. */
typedef struct cprox_solid cprox_solid;

/** The kinds of solids. Each comment names the members of cprox_solid_description that the kind reads. */
typedef enum cprox_solid_kind {
  /** A disc or ball about the origin: dimension, radius. */
  CPROX_SOLID_BALL,
  /** A rectangle or box about the origin: dimension, size. */
  CPROX_SOLID_BOX,
  /** An ellipse or ellipsoid about the origin: dimension, semi_axes. */
  CPROX_SOLID_ELLIPSOID,
  /** A solid cylinder about the z axis, |z| <= height/2, in space: height, radius. */
  CPROX_SOLID_CYLINDER,
  /** All points within radius of the segment of length height about the origin, along x in the plane, along z in space:
   *  dimension, height, radius. */
  CPROX_SOLID_CAPSULE,
  /** A simple polygon in the plane, convex or not: corners, n. */
  CPROX_SOLID_POLYGON,
  /** The inside of a closed triangle mesh in space, convex or not: points, n, triangles, n_triangles. Each edge belongs
   *  to two triangles, in opposite directions. The mesh must not pass through itself; that is not checked: what is
   *  inside twice counts twice. */
  CPROX_SOLID_MESH,
  /** All points within radius of a polyline, a sum of capsules: dimension, points, n, radius. */
  CPROX_SOLID_POLYLINE,
  /** A sphere of the radius swept along a curve (whole range of t), as one spectrum: dimension, curve, radius,
   *  tolerance. The curve becomes a polyline that is nowhere farther from it than the tolerance. The radius grows by as
   *  much, so that the guarantee is that of the curve itself. At most 1e6 segments, else CPROX_INVALID. The function is
   *  a line integral, not an indicator. A gap with such a solid has a threshold of its own, and at most one of its two
   *  solids may be swept. In the plane the curve must lie in z = 0. */
  CPROX_SOLID_SWEEP,
  /** The union of the occupied cells of a grid, for what has no formula: dimension, lowest, cell, counts, occupied. The
   *  union is what is certified: occupy every cell that the body meets. */
  CPROX_SOLID_GRID,
  /** The union of solids of one dimension, each at a pose: parts, poses, n. It is the sum of their functions (Prop. 2):
   *  overlaps count more than once; the guarantee stays, the over-reach grows. */
  CPROX_SOLID_UNION,
  /** The part of a solid inside a convex region: solid, region, n, body. It is the product of its function and the
   *  region's indicator (Prop. 2, Theorem 2). In a gap it localises the test: overlap counts only inside the region.
   * The product must not be empty. Boxes, polygons, meshes and unions of them; others are refused: give them as a
   * polygon or mesh that holds them. A body makes any convex set a solid: clip a box that contains it. */
  CPROX_SOLID_CLIPPED,
  /** The points of a box at which a function is at most 0, convex or not (Prop. 1): dimension, lowest, cell, counts,
   *  function, user, lipschitz. It is the grid of the cells that may meet the set: those with a value of at most
   *  lipschitz times half a cell's diagonal at their middle. One call a cell; what lies outside of the box is no part.
   */
  CPROX_SOLID_SUBLEVEL
} cprox_solid_kind;

/** What a solid is made of. Set all members to 0, then those that the kind reads: cprox_solid_kind lists them. Every
 *  length in metres, finite, and between 1e-100 and 1e100. Arrays and solids are copied. */
typedef struct cprox_solid_description {
  /** which members are read */
  cprox_solid_kind kind;
  /** 2: the plane z = 0; 3: space. Not read where the kind, or the solids it is made of, have one dimension only */
  int dimension;
  /** [m] > 0; of a sweep >= 0 */
  double radius;
  /** [m] > 0 of a cylinder or capsule */
  double height;
  /** [m] full edge lengths of a box, each > 0; z is not read in the plane */
  cprox_vec3 size;
  /** [m] of an ellipsoid, each > 0; z is not read in the plane */
  cprox_vec3 semi_axes;
  /** [m] corners of a polygon, 3 or more, counter-clockwise; edges do not meet but at their ends */
  const double (*corners)[2];
  /** [m] vertices of a mesh, or 2 points or more of a polyline */
  const cprox_vec3 *points;
  /** the number of corners, of points, of the parts of a union, or of the half-spaces of a region */
  size_t n;
  /** of a mesh: three indices below n each, counter-clockwise from outside */
  const uint32_t (*triangles)[3];
  /** the number of triangles */
  size_t n_triangles;
  /** of a sweep */
  const cprox_curve *curve;
  /** [m] > 0 of a sweep: how far the polyline may be from the curve */
  double tolerance;
  /** [m] of a grid or a sublevel set: the corner of cell (0, 0, 0) */
  cprox_vec3 lowest;
  /** [m] > 0 of a grid or a sublevel set: the edge length of a cell */
  double cell;
  /** of a grid or a sublevel set: cells along x, y, z, each >= 1, their product <= 2^30; counts[2] is 1 in the plane */
  uint32_t counts[3];
  /** of a grid: one byte a cell, x fastest; not 0: occupied. At least one is */
  const unsigned char *occupied;
  /** the parts of a union, 1 or more, of one dimension */
  const cprox_solid *const *parts;
  /** the pose of each part of a union */
  const cprox_pose *poses;
  /** what is clipped */
  const cprox_solid *solid;
  /** of a clipped solid: half-spaces a x + b y + c z <= d as {a, b, c, d} in the frame of the solid, (a, b, c) not 0,
   *  c = 0 in the plane; with a body it may be NULL, and n 0 */
  const double (*region)[4];
  /** of a clipped solid, or NULL: a bounded convex body of any kind in the frame of the solid, in the plane its shadow.
   *  Its tangents in 48 directions (32 in the plane) clip, which contain it: a ball with 10 % of its radius to spare.
   * In space it clips boxes only */
  const cprox_body *body;
  /** of a sublevel set: the value at a point [any unit], finite; z = 0 in the plane */
  double (*function)(void *user, cprox_vec3 point);
  /** of a sublevel set: handed to the function */
  void *user;
  /** [unit of the function/m] > 0 of a sublevel set: values at two points differ by at most this many times the way
   *  between them. Neighbouring cells whose values say otherwise are an error */
  double lipschitz;
} cprox_solid_description;

/** Makes a solid.
 *
 *  description  checked once; what is wrong, and where, stands in the error message of the workspace.
 *  workspace    may be NULL: then there is no error message.
 *  solid        receives the handle, owned by the caller: cprox_solid_free(). Untouched on failure.
 *
 *  Returns CPROX_OK, CPROX_INVALID or CPROX_MEMORY. */
CPROX_API cprox_status cprox_solid_create(const cprox_solid_description *description, cprox_workspace *workspace,
                                          cprox_solid **solid);

/** Frees a solid; NULL is allowed. Gaps keep what they need of it. */
CPROX_API void cprox_solid_free(cprox_solid *solid);

/** What is known of a solid. */
typedef struct cprox_solid_info {
  /** the kind that the solid was created as */
  cprox_solid_kind kind;
  /** 2 or 3 */
  int dimension;
  /** [m²] or [m³] the integral of the function: the measure where pieces do not overlap */
  double measure;
  /** [m] the centre of a ball that contains the solid, in its frame */
  cprox_vec3 centre;
  /** [m] the radius of that ball */
  double radius;
} cprox_solid_info;

/** What is known of a solid. */
CPROX_API cprox_solid_info cprox_solid_get_info(const cprox_solid *solid);

/** The transform F(q) = integral of f(y) exp(-i q·y) dy at an angular frequency q [rad/m], q.z = 0 in the plane.
 *
 *  value      real and imaginary part; within 1e-13 of the function's integral where |q| times the solid's size is
 *             below 1e3. gradient: dF/dq, real and imaginary part, NULL if not needed.
 *  CPROX_INVALID if q is not finite. */
CPROX_API cprox_status cprox_solid_spectrum(const cprox_solid *solid, cprox_vec3 q, cprox_workspace *workspace,
                                            double value[2], cprox_vec3 gradient[2]);

/* ---- Gaps ---- */

/** What a gap is for. */
typedef enum cprox_gap_mode {
  /** clear is a proof */
  CPROX_GAP_MODE_CERTIFIED = 0,
  /** two to three times as accurate, clear is not a proof: there are bodies that break it */
  CPROX_GAP_MODE_TUNED = 1,
  /** a smooth constraint for solvers, usable at every clearance, without a verdict */
  CPROX_GAP_MODE_SIGNAL = 2
} cprox_gap_mode;

/** Start from CPROX_GAP_OPTIONS_DEFAULT, which sets the size: later versions may add members. */
typedef struct cprox_gap_options {
  /** sizeof(cprox_gap_options), as CPROX_GAP_OPTIONS_DEFAULT sets it; any other size is refused */
  size_t size;
  /** What the gap is for. */
  cprox_gap_mode mode;
  /** [m] > 0: the largest clearance that may still be called a collision; chooses the samples. Default 0: samples
   *  must be given. Refused together with samples */
  double delta;
  /** n, odd, 3 … 1025: samples an axis; 0: the fewest for delta. Default 0 */
  uint32_t samples;
  /** [m] L, or 0 for the least that keeps images apart (default); a smaller one is refused */
  double period;
  /** bytes a gap may hold; beyond it CPROX_INVALID; the error message says how many it needs. Default 256 MiB */
  size_t memory_limit;
} cprox_gap_options;

/** The default of all options: certified, with samples or delta still to be given. */
#define CPROX_GAP_OPTIONS_DEFAULT \
  (CPROX_VALUE(cprox_gap_options){sizeof(cprox_gap_options), CPROX_GAP_MODE_CERTIFIED, 0.0, 0, 0.0, (size_t)256 << 20})

/** What a gap is made of. */
typedef struct cprox_gap_info {
  /** Certified, tuned or signal. */
  cprox_gap_mode mode;
  /** 2 or 3. */
  int dimension;
  /** n: samples an axis */
  uint32_t samples;
  /** L [m] */
  double period;
  /** rho [m], by which both solids are enlarged; 0 in the signal mode */
  double offset;
  /** t, in units of the measure squared over L^d; V_ref in the signal mode */
  double threshold;
  /** [m] solids farther apart than this are never called colliding. Certified: proven. Tuned: what was measured,
   *  times 1.25. To a clipped solid: from the solid or from one of its half-spaces, whichever is farthest. Infinity in
   * the signal mode, and where the gap is too coarse to say */
  double over_reach;
  /** clear is a proof */
  bool guaranteed;
  /** the first solid, the simpler one, is the one whose spectrum is turned */
  bool turned_first;
  /** of the sum */
  size_t terms;
  /** held by the gap */
  size_t bytes;
  /** bound on the error of a value V/t (of V/V_ref in the signal mode) by rounding */
  double rounding;
  /** [m] a scale: length times -log(V/t), of the signal length times c, has a slope near 1 where the solids touch (of
   *  the certified mode: where V/t = 1) */
  double length;
  /** signal: below this the interiors overlap. -infinity where that is unknown: in space where a solid is covered by
   *  cells or turned as a table, and where the largest value of neither function is known. 0 in the other modes */
  double touching_least;
  /** signal: above this the solids do not meet; infinity where nothing is known. Where they touch, touching_least <= c
   *  <= touching_most. 0 in the other modes */
  double touching_most;
} cprox_gap_info;

typedef enum cprox_gap_verdict {
  /** the interiors do not overlap */
  CPROX_GAP_VERDICT_CLEAR = 0,
  /** they may */
  CPROX_GAP_VERDICT_COLLIDE = 1,
  /** clear without V: by the bounding spheres, or for a verdict alone by directions that separate all parts */
  CPROX_GAP_VERDICT_FAR = 2,
  /** within rounding of the threshold, or the signal mode: counts as unsafe */
  CPROX_GAP_VERDICT_UNDECIDED = 3
} cprox_gap_verdict;

/** "clear", "collide", "far", "undecided". */
CPROX_API const char *cprox_gap_verdict_name(cprox_gap_verdict verdict);

/** The result of a gap query. */
typedef struct cprox_gap_result {
  /** See cprox_gap_verdict. */
  cprox_gap_verdict verdict;
  /** certified, tuned: V/t, overlap is possible from 1 on. Signal: c = -log(V/V_ref), the larger the freer. FAR: 0
   *  (signal: infinity) with gradients 0 */
  double value;
  /** |exact - value| at most: the rounding, and what an early exit left out. Of V/V_ref in the signal mode */
  double error;
  /** [m] FAR: the solids are at least so far apart, by their bounding spheres or by directions; else 0 */
  double clearance;
  /** summed */
  uint32_t terms;
  /** Gradients of value. Position: world frame [1/m]. Rotation: in the body's own frame, d/ds of the value for
   *  R exp(s[w]) is rotation·w [1/rad]; only z in the plane. 0 from cprox_gap_test(). */
  cprox_vec3 position_a;
  /** By the rotation of a. */
  cprox_vec3 rotation_a;
  /** By the position of b. */
  cprox_vec3 position_b;
  /** By the rotation of b. */
  cprox_vec3 rotation_b;
  /** The same of the relative pose (R, x): R = R_a^T R_b, x = R_a^T (x_b - x_a), x in the frame of a, the rotation in
   *  b's. */
  cprox_vec3 position;
  /** By the relative rotation. */
  cprox_vec3 rotation;
  /** 0: room for later members, so that the size of the struct stays */
  uint64_t reserved[4];
} cprox_gap_result;

/** A pair of solids made ready. */
typedef struct cprox_gap cprox_gap;

/** Makes a pair ready: chooses n, L, rho, the kernel and the threshold.
 *
 *  Certified: n is the least odd number whose proven over-reach is at most delta; kernel and offset are those that make
 *  the over-reach of bodies of ordinary proportions least. Returns CPROX_INVALID where delta cannot be had below the
 *  memory limit, with the n and the bytes it would need; where delta exceeds the size of the pair (nothing would be
 *  left to decide); for solids of different dimensions; where the function of cprox_workspace_set_stop() wants an
 *  end, which it is asked every few milliseconds. Cost: the spectrum of one solid at n^d/2 frequencies. */
CPROX_API cprox_status cprox_gap_create(const cprox_solid *a, const cprox_solid *b, const cprox_gap_options *options,
                                        cprox_workspace *workspace, cprox_gap **gap);

/** Frees a gap; NULL is allowed. */
CPROX_API void cprox_gap_free(cprox_gap *gap);

/** What a gap is made of. */
CPROX_API cprox_gap_info cprox_gap_get_info(const cprox_gap *gap);

/** The verdict alone, by bounds per direction first, then with early exit both ways. CPROX_INVALID for poses that are
 * none. No allocation once the workspace has grown. In the signal mode: the value without gradients, undecided. */
CPROX_API cprox_status cprox_gap_test(const cprox_gap *gap, const cprox_pose *pose_a, const cprox_pose *pose_b,
                                      cprox_workspace *workspace, cprox_gap_result *result);

/** Value, verdict and gradients: the whole sum. In the signal mode CPROX_PRECISION where V is not above its rounding:
 *  then value and gradients are those of the least V that can be told from 0, and say little. */
CPROX_API cprox_status cprox_gap_evaluate(const cprox_gap *gap, const cprox_pose *pose_a, const cprox_pose *pose_b,
                                          cprox_workspace *workspace, cprox_gap_result *result);

/* ---- From coarse to fine ---- */

/** Certified gaps of one pair with n = 9, 17, 33, … up to what the accuracy needs. */
typedef struct cprox_gap_cascade cprox_gap_cascade;

/** As cprox_gap_create(); options->mode must be CPROX_GAP_MODE_CERTIFIED. The memory limit holds for each level. */
CPROX_API cprox_status cprox_gap_cascade_create(const cprox_solid *a, const cprox_solid *b,
                                                const cprox_gap_options *options, cprox_workspace *workspace,
                                                cprox_gap_cascade **cascade);

/** Frees a cascade; NULL is allowed. */
CPROX_API void cprox_gap_cascade_free(cprox_gap_cascade *cascade);

/** The finest level: owned by the cascade. */
CPROX_API const cprox_gap *cprox_gap_cascade_finest(const cprox_gap_cascade *cascade);

/** As cprox_gap_test() of the finest level, but stops at the first level that proves the pair clear. terms: of all
 *  levels. */
CPROX_API cprox_status cprox_gap_cascade_test(const cprox_gap_cascade *cascade, const cprox_pose *pose_a,
                                              const cprox_pose *pose_b, cprox_workspace *workspace,
                                              cprox_gap_result *result);

/* ---- Along a curve ---- */

/** The second solid carried along a curve, its origin at psi(t). */
typedef struct cprox_gap_carried {
  /** kept by reference; any but one that is known by its arc length, in the plane for a planar gap */
  const cprox_curve *curve;
  /** how the solid is turned, not (0, 0, 0, 0) */
  cprox_quat orientation;
  /** how it turns on its way, or NULL: it does not. A curve over the same range whose point is a rotation vector [rad],
   *  along z for a planar gap: at t the solid is turned by `orientation` first, then about this vector by its length.
   *  Kept by reference; any but one that is known by its arc length */
  const cprox_curve *turning;
} cprox_gap_carried;

/** Value and gradient at a parameter of the curve: result as of cprox_gap_evaluate() at that pose.
 *
 *  derivative  d value/dt [1/unit of t], NULL if not needed.
 *  CPROX_INVALID if t is outside the curve's range, or the curve outside the plane of a planar gap. */
CPROX_API cprox_status cprox_gap_along(const cprox_gap *gap, const cprox_pose *pose_a, const cprox_gap_carried *carried,
                                       double t, cprox_workspace *workspace, cprox_gap_result *result,
                                       double *derivative);

/** The result of cprox_gap_along_test(). */
typedef struct cprox_gap_along_result {
  /** clear: at every t of the interval (a proof in the certified mode) */
  cprox_gap_verdict verdict;
  /** where the value below was met; collide, undecided: the first such t that was found */
  double t;
  /** the largest V/t met at the parameters looked at */
  double value;
  /** intervals looked at */
  uint32_t nodes;
  /** 0: room for later members, so that the size of the struct stays */
  uint64_t reserved[2];
} cprox_gap_along_result;

/** The verdict over the whole interval [t0, t1] of the curve: between the parameters looked at, value and gradient
 *  there and a bound of the second derivative keep V below t. max_nodes >= 1: CPROX_BUDGET beyond it, and undecided. */
CPROX_API cprox_status cprox_gap_along_test(const cprox_gap *gap, const cprox_pose *pose_a,
                                            const cprox_gap_carried *carried, double t0, double t1, uint32_t max_nodes,
                                            cprox_workspace *workspace, cprox_gap_along_result *result);

#ifdef __cplusplus
}
#endif
#endif
