/* SPDX-License-Identifier: BSD-3-Clause */
/* Test cases that register themselves: CASE(a_fact) { assertions } states a fact, and main() runs every CASE of the
 * program: int main(void) { return cases_run(NULL, NULL); } Includes cmocka, whose macros (fail, skip) break headers of
 * C++ that come later: in C++ this header is the last one. */
#ifndef CPROX_TEST_CASES_H
#define CPROX_TEST_CASES_H

/* what cmocka.h needs before it */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#include <cmocka.h>

typedef struct test_case {
  const char *name, *file;
  int line;
  CMUnitTestFunction run;
  struct test_case *next;
} test_case;

/* A function that cmocka runs. Its argument `state` is what the group's setup function left. */
#define CASE(title)                                                    \
  static void title(void **state);                                     \
  __attribute__((constructor)) static void register_##title(void) {    \
    static test_case self = {#title, __FILE__, __LINE__, title, NULL}; \
    case_register(&self);                                              \
  }                                                                    \
  static void title(__attribute__((unused)) void **state)

/* For CASE. */
void case_register(test_case *added);

/* Puts a case into a list that is ordered by file and line. */
void case_insert(test_case **list, test_case *added);

/* Why a list cannot be run: it is empty, or two cases have one name. NULL if it can. */
const char *cases_fault(const test_case *list);

/* Runs the program's cases in the order of their lines, between the group's two functions, which may be NULL.
 * Returns main()'s exit code. A list with a fault is a failure. */
int cases_run(CMFixtureFunction setup, CMFixtureFunction teardown);

#ifdef __cplusplus
}
#endif

#endif
