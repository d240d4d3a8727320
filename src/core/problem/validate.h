/* SPDX-License-Identifier: BSD-3-Clause */
/* The arguments of the queries: defaults, names, and the error messages for those that are unusable. */
#ifndef CPROX_PROBLEM_VALIDATE_H
#define CPROX_PROBLEM_VALIDATE_H

#include "curve_proximity/cprox/query.h"

/* The options that not every query has. epsilon and max_nodes go with all of them. */
typedef enum arguments_option {
  ARGUMENTS_SIGNED = 1,      /* signed_distance */
  ARGUMENTS_CERTIFICATE = 2, /* certificate */
  ARGUMENTS_STOP = 4,        /* stop */
  ARGUMENTS_RELATIVE = 8,    /* relative_epsilon */
  ARGUMENTS_LOD = 16,        /* max_lod */
  ARGUMENTS_WHOLE = 32,      /* robots against obstacles and themselves at once */
  ARGUMENTS_INTERVAL = 64,   /* interval, of robots */
  ARGUMENTS_SHARE = 128,     /* share, of robots */
  ARGUMENTS_RADIUS = 256,    /* a radius that changes */
  ARGUMENTS_START = 512,     /* start, of pairs */
  ARGUMENTS_SEARCH = ARGUMENTS_STOP | ARGUMENTS_RELATIVE | ARGUMENTS_LOD
} arguments_option;

/* A query as its messages call it, and those of the options that it has: the others are refused where they are set. */
typedef struct arguments_query {
  const char *name;
  unsigned has;
} arguments_query;

/* A copy of the caller's options, of NULL the default. Options of another size are not read: the copy is the default
 * with their size, which validate_options() refuses. */
cprox_options validate_defaults(const cprox_options *options);

/* These return CPROX_OK, or CPROX_INVALID with an error message that names the argument. */
cprox_status validate_options(const cprox_options *options, arguments_query asked, cprox_workspace *workspace);
/* Finite, 0 or more, and no longer than powers can hold. */
cprox_status validate_length(const char *name, double value, cprox_workspace *workspace);
cprox_status validate_delta(double delta, cprox_workspace *workspace);
cprox_status validate_obstacle(const cprox_obstacle *obstacle, size_t index, cprox_workspace *workspace);
cprox_status validate_obstacles(const cprox_obstacle *obstacles, size_t n, cprox_workspace *workspace);
cprox_status validate_query(const cprox_mover *mover, const cprox_obstacle *obstacles, size_t n,
                            const cprox_options *options, arguments_query asked, cprox_workspace *workspace);

#endif
