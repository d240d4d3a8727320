/* SPDX-License-Identifier: BSD-3-Clause */
#include "prove.h"

#include <stdio.h>

#include "check.h"

/* Of the problem's only mover. */
static const char *prove_next(problem *p, const unsigned char *certificate, size_t size, proof *out) {
  if (!problem_next(p)) return "the problem has no mover";
  if (p->mover.none) return "the problem's mover cannot be asked about";
  const finding found = check(p, certificate, size);
  if (found.fault) return found.fault;
  if (problem_next(p)) return "the problem has more than one mover";
  out->apart = found.claim == CLAIM_APART;
  out->near = found.claim == CLAIM_NEAR;
  out->delta = found.delta;
  out->directions = found.leaves;
  return out->apart || out->near ? NULL : "it is about a part of the motion alone";
}

proof prove(const char *text, size_t length, const unsigned char *certificate, size_t size) {
  proof out = {0};
  problem p = {0};
  const char *fault = length == 0 ? "the problem is empty" : size == 0 ? "nothing is claimed" : NULL;
  FILE *in = fault ? NULL : fmemopen((void *)text, length, "r");
  if (!in && !fault) fault = "memory is out";
  if (in) {
    if (problem_open(&p, in)) fault = prove_next(&p, certificate, size, &out);
    if (p.fault[0]) fault = p.fault;
  }
  if (fault) {
    out = (proof){0};
    snprintf(out.fault, sizeof out.fault, "%s", fault);
  }
  if (in) {
    problem_close(&p);
    fclose(in);
  }
  return out;
}
