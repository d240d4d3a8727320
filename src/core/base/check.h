/* SPDX-License-Identifier: BSD-3-Clause */
/* What must hold whatever is asked: checked in the builds of tests and sanitizers (CPROX_CHECKED), which end there;
 * free elsewhere. */
#ifndef CPROX_BASE_CHECK_H
#define CPROX_BASE_CHECK_H

#if defined(CPROX_CHECKED)
#include <stdio.h>
#include <stdlib.h>

#define CORE_CHECK(condition, ...)                                                  \
  do {                                                                              \
    if (!(condition)) {                                                             \
      fprintf(stderr, "%s:%d: %s does not hold: ", __FILE__, __LINE__, #condition); \
      fprintf(stderr, __VA_ARGS__);                                                 \
      fputc('\n', stderr);                                                          \
      abort();                                                                      \
    }                                                                               \
  } while (0)
#else
#define CORE_CHECK(condition, ...) ((void)sizeof(condition))
#endif

#endif
