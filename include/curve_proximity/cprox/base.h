/* SPDX-License-Identifier: BSD-3-Clause */
/** Status codes, vectors, poses and the workspace: what every other header stands on. */
#ifndef CURVE_PROXIMITY_CPROX_BASE_H
#define CURVE_PROXIMITY_CPROX_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
/** Marks the functions that the library exports. */
#define CPROX_API
#else
/** Marks the functions that the library exports. */
#define CPROX_API __attribute__((visibility("default")))
#endif

/** The version of these headers. Before 1.0 a new minor version may break the ABI: the SONAME carries both numbers. */
#define CPROX_VERSION_MAJOR 0
/** The minor version. */
#define CPROX_VERSION_MINOR 2
/** The patch version. */
#define CPROX_VERSION_PATCH 0

/** The head of a value of a struct, before its braces, which C and C++ write differently. For constants of this API. */
#ifdef __cplusplus
#define CPROX_VALUE(type) type
#else
#define CPROX_VALUE(type) (type)
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** The version of the library that is loaded, as "MAJOR.MINOR.PATCH". Never NULL. */
CPROX_API const char *cprox_version(void);

/** Every status: code, value, short name, text. status >= 0: the result is valid. status < 0: an error; outputs are
 *  unchanged. */
#define CPROX_STATUS_LIST(X)                                                                      \
  X(CPROX_OK, 0, "ok", "answered to the accuracy asked")                                          \
  X(CPROX_BUDGET, 1, "budget", "out of nodes; the interval is true but wider")                    \
  X(CPROX_PRECISION, 2, "precision", "double arithmetic allows no narrower interval")             \
  X(CPROX_STOPPED, 3, "stopped", "the caller's stop function asked for it; the interval is true") \
  X(CPROX_OVERLAP, 4, "overlap", "they overlap; how deep was not measured, lower bounds it")      \
  X(CPROX_INEXACT, 5, "inexact", "the obstacle's own distances are not known more narrowly")      \
  X(CPROX_INVALID, -1, "invalid", "an argument is unusable; see the reason")                      \
  X(CPROX_MEMORY, -2, "memory", "an allocation failed")

typedef enum cprox_status {
/** Makes an enumerator of a row of CPROX_STATUS_LIST. */
#define CPROX_STATUS_ENUM(code, value, name, text) code = value,
  CPROX_STATUS_LIST(CPROX_STATUS_ENUM)
#undef CPROX_STATUS_ENUM
} cprox_status;

/** The short name of a status ("ok", "budget", …); "unknown" for a value that is none. Never NULL. */
CPROX_API const char *cprox_status_name(cprox_status status);

/** The text that belongs to a status. Never NULL. */
CPROX_API const char *cprox_status_text(cprox_status status);

/** A point or a direction, in metres where it is a point. */
typedef struct cprox_vec3 {
  /** The x coordinate. */
  double x;
  /** The y coordinate. */
  double y;
  /** The z coordinate. */
  double z;
} cprox_vec3;

/** A rotation as a quaternion. Any finite norm but 0 stands for the rotation of its direction: the rotation is
 *  R = 1 + (2/q·q)(w[v] + [v]²), v = (x, y, z), so it need not be normalised. */
typedef struct cprox_quat {
  /** The real part. */
  double w;
  /** The x part. */
  double x;
  /** The y part. */
  double y;
  /** The z part. */
  double z;
} cprox_quat;

/** Where a body's own frame stands in the world: p_world = R(orientation) p_body + position. */
typedef struct cprox_pose {
  /** [m] each coordinate at most 1e60 in size */
  cprox_vec3 position;
  /** not (0, 0, 0, 0) */
  cprox_quat orientation;
} cprox_pose;

/** The pose that changes nothing. */
#define CPROX_POSE_IDENTITY (CPROX_VALUE(cprox_pose){{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}})

/** All memory that queries need, and the reason of the last failure.
 *
 *  It grows to what the largest query so far has needed; from then on no query allocates. One workspace a thread: a
 *  workspace may be used by different threads, but never by two at once.
 *
 *  Functions that a query or a constructor calls (stop, support, distance, the functions of curves and solids) need a
 *  workspace of their own to ask anything: while a function with a workspace has not returned, every other one with the
 *  same workspace returns CPROX_INVALID, and cprox_workspace_error() says so. */
typedef struct cprox_workspace cprox_workspace;

/** A new, empty workspace, or NULL where memory is out. Owned by the caller: cprox_workspace_free(). */
CPROX_API cprox_workspace *cprox_workspace_create(void);

/** Frees a workspace; NULL is allowed. */
CPROX_API void cprox_workspace_free(cprox_workspace *workspace);

/** [bytes] The memory that a workspace holds: what its largest queries so far have needed. NULL: 0. */
CPROX_API size_t cprox_workspace_bytes(const cprox_workspace *workspace);

/** One line, for a person, that says why the last call with this workspace did not end with CPROX_OK
 *  ("knot 7 is 0.3, below knot 6 at 0.5"). "" where it did, with one exception: a query that was to leave a certificate
 *  and could not says why ("no certificate: obstacle 0 ..."), after its own reason where there is one; its status and
 *  result are those of the same query without a certificate. Valid until the next call with this workspace. */
CPROX_API const char *cprox_workspace_error(const cprox_workspace *workspace);

/** Sets the error message of a workspace; NULL or "": none. For libraries on top of this one, whose calls take the same
 *  workspace (libcprox_fourier is one). A message longer than 255 bytes is cut. */
CPROX_API void cprox_workspace_set_error(cprox_workspace *workspace, const char *message);

/** For libraries on top of this one: what each of their functions with a workspace begins with. False: another function
 *  has the workspace; then the caller returns CPROX_INVALID, and cprox_workspace_error() says why. True:
 *  cprox_workspace_leave() follows. NULL is allowed. */
CPROX_API bool cprox_workspace_enter(cprox_workspace *workspace);

/** Ends what cprox_workspace_enter() began. workspace: where the handle stands, for a cleanup attribute; *workspace may
 *  be NULL. */
CPROX_API void cprox_workspace_leave(cprox_workspace *const *workspace);

/** For libraries on top of this one: lends a workspace that they have entered to the next call of a function of this
 *  library; cprox_workspace_take_back() follows. NULL is allowed. */
CPROX_API void cprox_workspace_lend(cprox_workspace *workspace);

/** Ends what cprox_workspace_lend() began. status: of the call in between, which it returns. */
CPROX_API cprox_status cprox_workspace_take_back(cprox_workspace *workspace, cprox_status status);

/** A function that ends the making of bodies and curves with this workspace: while the BVH of a mesh, of points or of
 *  boxes is built, or a curve of many pieces, or a gap of libcprox_fourier, it is called every few milliseconds. Once
 *  it returns true the constructor fails with CPROX_INVALID and gives all memory back. Queries have a function of
 *  their own, cprox_options.stop.
 *
 *  stop  NULL: nothing ends it, as in a new workspace. It may be called by the thread that uses the workspace only.
 *  user  handed to it. */
CPROX_API void cprox_workspace_set_stop(cprox_workspace *workspace, bool (*stop)(void *user), void *user);

/** Whether that function wants an end, now or when it was last asked. For libraries on top of this one. */
CPROX_API bool cprox_workspace_wants_stop(cprox_workspace *workspace);

/** Memory of the caller in a workspace: at least `bytes`, NULL where memory is out. What it held stays. No query of
 *  this library uses it. Valid until the next call of this function; freed with the workspace. */
CPROX_API void *cprox_workspace_reserve(cprox_workspace *workspace, size_t bytes);

#ifdef __cplusplus
}
#endif
#endif
