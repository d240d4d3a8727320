/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef CURVE_PROXIMITY_BENCH_MOVEIT_SEEDED_NUMBERS_H
#define CURVE_PROXIMITY_BENCH_MOVEIT_SEEDED_NUMBERS_H

/* The seed of the next random_numbers::RandomNumberGenerator; those after it have the numbers after it. */
void seedNumbers(unsigned int seed);

#endif
