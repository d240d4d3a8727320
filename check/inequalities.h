/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies given by inequalities about their centre: planes b·x + c <= 0, quadrics x'Qx + b·x + c <= 0, and sums of terms
 * sum |a·x + d|^p <= 1. How far they reach is bounded by multipliers that a certificate names (doc/proofs.md). */
#ifndef CHECK_INEQUALITIES_H
#define CHECK_INEQUALITIES_H

#include "bytes.h"
#include "interval.h"
#include "problem.h"

/* Passes over MULTIPLIERS. */
void inequalities_skip(const set *s, uint32_t width, reader *in);

/* The direction n that MULTIPLIERS make, and an upper bound of n·x over the body, both in its own frame, the centre
 * added. False: they prove nothing. */
bool inequalities_reach(iv n[3], iv *most, const set *s, uint32_t width, reader *in);

/* The greatest of all inequalities at a point of the body's own frame: not above 0 inside. */
void inequalities_value(iv *out, const set *s, const iv y[3]);

#endif
