/* SPDX-License-Identifier: BSD-3-Clause */
/* Support functions: how far posed sets reach along a direction of any length. */
#ifndef CHECK_SUPPORT_H
#define CHECK_SUPPORT_H

#include "interval.h"
#include "problem.h"

/* The world direction n in the set's own frame, and n·(where that frame's origin stands). */
void support_of_frame(iv *far, iv own[3], const set *s, const iv n[3]);

/* max n·x over the body in its own frame, without margin. */
void support_of_body(iv *out, const set *s, const iv n[3]);

/* A direction of the set's own frame in the world. */
void support_to_world(iv n[3], const set *s);

/* A world point in the set's own frame, while what the set rides is at `ride`; NULL: it stands. */
void support_point_to_frame(iv own[3], const set *s, const iv p[3], const iv *ride);

/* A point of the set's own frame in the world. */
void support_point_to_world(iv p[3], const set *s, const iv own[3]);

/* The set as its first pose places it. */
set support_outermost(const set *s);

#endif
