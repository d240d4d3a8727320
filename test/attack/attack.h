/* SPDX-License-Identifier: BSD-3-Clause */
/* What every attack begins with: random cases of one family, each held against a reference that shares no code with the
 * core.
 *
 *   PROGRAM [SIZE] [SEED] [--case N] [--seconds S]
 *
 * Case N of a seed has random numbers of its own, so that it can be run again alone. A wrong case is one line with the
 * command that repeats it; the last line is `N passed, N failed`. Exit code 1 where a case failed or none was run.
 * README.md has more. */
#ifndef CPROX_TEST_ATTACK_H
#define CPROX_TEST_ATTACK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "curve_proximity/cprox.h"
#include "support/random.h"

typedef struct attack {
  const char *family;
  uint64_t seed;
  size_t number;       /* of the case that runs */
  cprox_workspace *ws; /* kept from case to case */
  bool alone;          /* --case: a family may print what it does */
} attack;

/* One random case; all its randomness comes from r. */
typedef void (*attack_case)(attack *a, rng *r);

/* main() of a family: return attack_main(argc, argv, "NAME", one_case); */
int attack_main(int argc, char **argv, const char *family, attack_case one);

/* Names the kind of this case, such as "box, cone": the summary counts by kind. At most once a case. */
void attack_kind(attack *a, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Counts something that is no fault, such as "undecided": the summary shows it. */
void attack_count(attack *a, const char *what);

/* This case is wrong: what was asked, what was answered, what is true (%.17g). Later faults of the same case are not
 * printed. */
void attack_fail(attack *a, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* attack_fail() where the condition does not hold. Returns the condition. */
#define attack_check(a, condition, ...) ((condition) ? true : (attack_fail((a), __VA_ARGS__), false))

/* Has this case failed? */
bool attack_failed(const attack *a);

#endif
