/* SPDX-License-Identifier: BSD-3-Clause */
/* What a checker says of genuine and of tampered certificates, judged by the truth. */
#ifndef CHECK_TEST_MUTANTS_H
#define CHECK_TEST_MUTANTS_H

#include "check.h"

typedef struct mutants_tally {
  size_t genuine, tampered, accepted, failed;
} mutants_tally;

/* Genuine ones must be accepted, and of all that is accepted the claim must be true of a query whose distance lies in
 * the interval. done: "genuine", or what was done to it. bounded: the check took no more than it may. */
void mutants_judge(const finding *found, bool bounded, const double interval[2], const char *done, size_t query,
                   mutants_tally *sum);

/* Two lines; 1 where something failed, or nothing was tried. */
int mutants_report(const char *what, const mutants_tally *sum);

#endif
