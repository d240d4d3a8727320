/* SPDX-License-Identifier: BSD-3-Clause */
/* Counts what the code under test allocates, and makes allocations fail on demand. Works by the linker's --wrap, which
 * cprox_core_test() sets for every test: the calls of the core and of the test itself are seen, those of libc are not.
 */
#ifndef CPROX_TEST_COUNTING_H
#define CPROX_TEST_COUNTING_H

#include <stddef.h>

/* Calls of malloc, calloc, realloc and aligned_alloc so far. */
size_t allocations_made(void);

/* Blocks that are allocated now. Only differences mean something. */
size_t allocations_live(void);

/* The next `successes` allocations succeed, all later ones fail, until allocations_allow(). */
void allocations_fail_after(size_t successes);
void allocations_allow(void);

#endif
