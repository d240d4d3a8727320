/* SPDX-License-Identifier: BSD-3-Clause */
/* Replaces the process's operator new and delete; so it belongs to a program, never to a library. */
#include "memory_limit.h"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

namespace {

/** Smaller allocations go by unseen: no request becomes large by them alone, as the limits on counts see to. */
constexpr std::size_t LARGE = std::size_t{1} << 20;

std::atomic<std::size_t> limit{std::numeric_limits<std::size_t>::max()};
std::atomic<std::size_t> held{0}; /* by large allocations */

void *allocate(std::size_t size) {
  void *memory = std::malloc(size ? size : 1);
  if (!memory) throw std::bad_alloc();
  return memory;
}

} // namespace

namespace curve_proximity {

void limitMemory(int megabytes) {
  limit = megabytes > 0 ? static_cast<std::size_t>(megabytes) << 20 : std::numeric_limits<std::size_t>::max();
}

} // namespace curve_proximity

void *operator new(std::size_t size) {
  void *memory = allocate(size);
  const std::size_t usable = malloc_usable_size(memory); // as delete will see it
  if (usable < LARGE) return memory;
  if (held.fetch_add(usable) + usable > limit) {
    held -= usable;
    std::free(memory); // untouched as yet, so that it has cost nothing
    throw std::bad_alloc();
  }
  return memory;
}

void operator delete(void *memory) noexcept {
  if (!memory) return;
  const std::size_t usable = malloc_usable_size(memory);
  if (usable >= LARGE) held -= usable;
  std::free(memory);
}

void operator delete(void *memory, std::size_t) noexcept {
  operator delete(memory);
}

void *operator new[](std::size_t size) {
  return allocate(size);
}

void operator delete[](void *memory) noexcept {
  std::free(memory);
}

void operator delete[](void *memory, std::size_t) noexcept {
  std::free(memory);
}
