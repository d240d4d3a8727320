/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/cases.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static test_case *registered;

/* Whether a stands before b. Constructors run in an order that the compiler chooses; lines do not change. */
static int before(const test_case *a, const test_case *b) {
  const int files = strcmp(a->file, b->file);
  return files != 0 ? files < 0 : a->line < b->line;
}

void case_insert(test_case **list, test_case *added) {
  while (*list && before(*list, added)) list = &(*list)->next;
  added->next = *list;
  *list = added;
}

void case_register(test_case *added) {
  case_insert(&registered, added);
}

const char *cases_fault(const test_case *list) {
  if (!list) return "no test case is registered";
  for (const test_case *a = list; a; a = a->next)
    for (const test_case *b = a->next; b; b = b->next)
      if (strcmp(a->name, b->name) == 0) return "two test cases have the same name";
  return NULL;
}

int cases_run(CMFixtureFunction setup, CMFixtureFunction teardown) {
  const char *support_failed = cases_fault(registered);
  size_t n = 0;
  for (const test_case *c = registered; c; c = c->next) n++;
  struct CMUnitTest *tests = support_failed ? NULL : (struct CMUnitTest *)calloc(n, sizeof *tests);
  if (!tests) {
    fprintf(stderr, "%s\n", support_failed ? support_failed : "out of memory");
    return EXIT_FAILURE;
  }
  size_t i = 0;
  for (const test_case *c = registered; c; c = c->next)
    tests[i++] = (struct CMUnitTest){.name = c->name, .test_func = c->run};
  const int failed = _cmocka_run_group_tests("cases", tests, n, setup, teardown);
  free(tests);
  return failed;
}
