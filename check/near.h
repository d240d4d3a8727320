/* SPDX-License-Identifier: BSD-3-Clause */
/* The claim that somewhere the distance is at most delta. */
#ifndef CHECK_NEAR_H
#define CHECK_NEAR_H

#include "bytes.h"
#include "problem.h"

/* NULL, or why it is not proven. */
const char *check_near(const problem *p, reader *in, double delta);

#endif
