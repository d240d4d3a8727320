/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/mutants.h"

#include <stdio.h>
#include <string.h>

/* Is what was found true of a query whose distance lies in the interval? */
static bool is_true(const finding *found, const double interval[2]) {
  if (found->claim == CLAIM_APART) return found->delta < interval[1];
  return found->claim == CLAIM_NONE || found->delta >= interval[0];
}

void mutants_judge(const finding *found, bool bounded, const double interval[2], const char *done, size_t query,
                   mutants_tally *sum) {
  const bool genuine = strcmp(done, "genuine") == 0, proven = found->claim != CLAIM_NONE;
  sum->genuine += genuine;
  sum->tampered += !genuine;
  sum->accepted += !genuine && proven;
  if (genuine && !proven) {
    printf("FAILED query %zu: a genuine certificate was refused: %s\n", query, found->fault);
    sum->failed++;
  } else if (!is_true(found, interval)) {
    printf("FAILED query %zu (%s): %s %.17g was accepted, but the distance is in [%.17g, %.17g]\n", query, done,
           found->claim == CLAIM_APART ? "apart" : "near", found->delta, interval[0], interval[1]);
    sum->failed++;
  } else if (!bounded) {
    printf("FAILED query %zu (%s): %zu directions were tried\n", query, done, found->leaves);
    sum->failed++;
  }
}

int mutants_report(const char *what, const mutants_tally *sum) {
  printf("%s: %zu genuine certificates, %zu mutants, of which %zu prove something true\n", what, sum->genuine,
         sum->tampered, sum->accepted - (sum->failed < sum->accepted ? sum->failed : sum->accepted));
  printf("%zu passed, %zu failed\n", sum->genuine + sum->tampered - sum->failed, sum->failed);
  return sum->failed > 0 || sum->genuine == 0;
}
