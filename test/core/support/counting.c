/* SPDX-License-Identifier: BSD-3-Clause */
#include "counting.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/* the linker's names */
void *__real_malloc(size_t size);
void *__real_calloc(size_t n, size_t size);
void *__real_realloc(void *old, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void __real_free(void *block);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t n, size_t size);
void *__wrap_realloc(void *old, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
void __wrap_free(void *block);

static atomic_size_t made, live;
static atomic_size_t allowed = SIZE_MAX; /* allocations that still succeed; SIZE_MAX: all */

size_t allocations_made(void) {
  return made;
}

size_t allocations_live(void) {
  return live;
}

void allocations_fail_after(size_t successes) {
  allowed = successes;
}

void allocations_allow(void) {
  allowed = SIZE_MAX;
}

/* Whether this allocation may succeed. */
static bool permit(void) {
  made++;
  if (allowed == SIZE_MAX) return true;
  if (allowed == 0) return false;
  allowed--;
  return true;
}

static void *track(void *block) {
  if (block) live++;
  return block;
}

void *__wrap_malloc(size_t size) {
  return permit() ? track(__real_malloc(size)) : NULL;
}

void *__wrap_calloc(size_t n, size_t size) {
  return permit() ? track(__real_calloc(n, size)) : NULL;
}

void *__wrap_aligned_alloc(size_t alignment, size_t size) {
  return permit() ? track(__real_aligned_alloc(alignment, size)) : NULL;
}

void *__wrap_realloc(void *old, size_t size) {
  if (!permit()) return NULL;
  return old ? __real_realloc(old, size) : track(__real_realloc(old, size));
}

void __wrap_free(void *block) {
  if (block) live--;
  __real_free(block);
}
