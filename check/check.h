/* SPDX-License-Identifier: BSD-3-Clause */
/* Does a certificate prove what it claims about a query? */
#ifndef CHECK_CHECK_H
#define CHECK_CHECK_H

#include "problem.h"

typedef enum claim { CLAIM_NONE, CLAIM_APART, CLAIM_NEAR, CLAIM_BEFORE, CLAIM_DURING } claim;

typedef struct finding {
  claim claim;  /* what is proven; CLAIM_NONE: nothing */
  double delta; /* [m] of the claim */
  double from,
      until;  /* of CLAIM_DURING: from `from` on; of both: at all parameters up to `until` they are farther apart
                         than delta */
  bool meets; /* of CLAIM_BEFORE: and at some parameter up to meets_by no farther than meets_delta */
  double meets_by, meets_delta;
  size_t leaves; /* separating directions that were tried */
  double work;   /* that its arithmetic took: of iv_work(), and of robots the directions and places that were tried */
  const char *fault; /* why nothing is proven, or NULL */
} finding;

/* Of the problem's present mover. */
finding check(const problem *p, const unsigned char *bytes, size_t size);

#endif
