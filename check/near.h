/* SPDX-License-Identifier: BSD-3-Clause */
/* The claim that somewhere the distance is at most delta. */
#ifndef CHECK_NEAR_H
#define CHECK_NEAR_H

#include "bytes.h"
#include "interval.h"
#include "problem.h"

/* NULL, or why it is not proven. */
const char *check_near(const problem *p, reader *in, double delta);

/* Whether the last check_near() refused what more bits may accept. */
bool near_left_open(void);

/* With y = the mover's point in the frame of the set, and `apart` the balls: what the certificate says of it. y and
 * apart are used up. */
const char *near_check_point(const set *s, iv *y, iv *apart, reader *in, bool left);

/* The point of the set's own frame that a certificate names; false where it is none of the set's. */
bool near_read_point(iv x[3], const set *s, reader *in);

#endif
