/* SPDX-License-Identifier: BSD-3-Clause */
/* Replaces the process's malloc and free, of which its operator new is made; so it belongs to a program, never to a
 * library. glibc names its own functions __libc_malloc() and so on for this. */
#include "transport/memory_limit.h"

#include <malloc.h>
#include <ros/poll_manager.h>
#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>

#include "transport/memory_account.h"

extern "C" {
void *__libc_malloc(std::size_t size);
void *__libc_calloc(std::size_t count, std::size_t size);
void *__libc_realloc(void *memory, std::size_t size);
void *__libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void *memory);
}

namespace {

using curve_proximity::memory::at_request;

/** Smaller allocations are not counted: what a request takes of them is bounded by its estimate. */
constexpr std::size_t COUNTED = 1024;

/** An allocation of this size may fail wherever it happens. */
constexpr std::size_t LARGE = std::size_t{1} << 20;

/** Buffers of LARGE and more take at most half of what nothing else holds, with those of this size three quarters. */
constexpr std::size_t MEDIUM_BUFFER = std::size_t{64} << 10;

/** roscpp itself drops a connection that announces more than a billion bytes. */
constexpr std::size_t NOWHERE_SIZE = std::size_t{1} << 30;

constexpr std::size_t NONE = std::numeric_limits<std::size_t>::max();

std::atomic<std::size_t> limit{NONE};
std::atomic<std::size_t> held{0};    /* by all counted allocations */
std::atomic<std::size_t> buffers{0}; /* by those of `new[]` among them: what roscpp receives and sends */
std::atomic<std::size_t> besides{0}; /* programs, libraries, stacks: what is resident and not allocated */
std::atomic<char *> nowhere{nullptr};
std::atomic<unsigned long> closed{0};
thread_local bool polls = false; /* this is roscpp's thread that polls all connections */

/** What a block counts for; free() must see what malloc() saw. */
std::size_t countOf(void *memory) {
  const std::size_t usable = memory ? malloc_usable_size(memory) : 0;
  return usable < COUNTED ? 0 : usable;
}

/** Counts what has been allocated, or frees it and returns null: at a request, or from a size on. */
void *counted(void *memory, std::size_t may_fail_from = LARGE) {
  const std::size_t count = countOf(memory);
  if (count == 0 || (held += count) <= limit) return memory;
  if (count < may_fail_from && !at_request) return memory;
  held -= count;
  __libc_free(memory); // untouched as yet, so that it has cost nothing
  errno = ENOMEM;
  return nullptr;
}

void *orThrow(void *memory) {
  if (!memory) throw std::bad_alloc();
  return memory;
}

bool isNowhere(const void *memory) {
  const char *begin = nowhere.load(std::memory_order_relaxed);
  const auto *at = static_cast<const char *>(memory);
  return begin && at >= begin && at < begin + NOWHERE_SIZE;
}

/** Is a buffer of this size more than is left for what others send? */
bool isTooMuch(std::size_t size) {
  if (size < COUNTED || limit == NONE) return false;
  const std::size_t in_buffers = buffers, others = held - std::min<std::size_t>(held, in_buffers);
  const std::size_t room = limit - std::min<std::size_t>(limit, others);
  const std::size_t part = size >= LARGE ? room / 2 : size >= MEDIUM_BUFFER ? room - room / 4 : room;
  return in_buffers + size > part;
}

} // namespace

namespace curve_proximity {

void limitMemory(int megabytes) {
  mallopt(M_MMAP_THRESHOLD, static_cast<int>(LARGE)); // what is large goes back to the system as soon as it is freed
  if (megabytes <= 0) return;
  const std::size_t most = static_cast<std::size_t>(megabytes) << 20, resident = memory::resident(), counts = held;
  besides = resident > counts ? resident - counts : 0;
  limit = most > besides ? most - besides : 0;
  memory::setTaken([] { return held + besides; });
  void *unusable = mmap(nullptr, NOWHERE_SIZE, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (unusable == MAP_FAILED) return;
  nowhere = static_cast<char *>(unusable);
  ros::PollManager::instance()->addPollThreadListener([] { polls = true; });
}

unsigned long connectionsClosed() {
  return closed;
}

} // namespace curve_proximity

extern "C" {

void *malloc(std::size_t size) {
  return counted(__libc_malloc(size));
}

void *calloc(std::size_t count, std::size_t size) {
  return counted(__libc_calloc(count, size));
}

void free(void *memory) {
  if (const std::size_t count = countOf(memory)) held -= count;
  __libc_free(memory);
}

void *realloc(void *memory, std::size_t size) {
  const std::size_t before = countOf(memory);
  const bool forbidden = size > before && held + (size - before) > limit;
  if (forbidden && (size >= LARGE || (size >= COUNTED && at_request))) {
    errno = ENOMEM;
    return nullptr;
  }
  void *moved = __libc_realloc(memory, size);
  if (!moved && size > 0) return nullptr; // the old block stays
  const std::size_t after = countOf(moved);
  if (after != before) held += after - before; // modulo 2^64
  return moved;
}

void *memalign(std::size_t alignment, std::size_t size) {
  return counted(__libc_memalign(alignment, size));
}

void *aligned_alloc(std::size_t alignment, std::size_t size) {
  return memalign(alignment, size);
}

int posix_memalign(void **out, std::size_t alignment, std::size_t size) {
  if (alignment % sizeof(void *) != 0 || (alignment & (alignment - 1)) != 0 || alignment == 0) return EINVAL;
  void *memory = memalign(alignment, size);
  if (!memory) return ENOMEM;
  *out = memory;
  return 0;
}

} // extern "C"

void *operator new(std::size_t size) {
  return orThrow(malloc(size ? size : 1));
}

void operator delete(void *memory) noexcept {
  free(memory);
}

void operator delete(void *memory, std::size_t) noexcept {
  free(memory);
}

/** What roscpp receives and sends. Its poll thread must not see an exception. */
void *operator new[](std::size_t size) {
  if (polls && isTooMuch(size) && nowhere && size < NOWHERE_SIZE) {
    ++closed;
    return nowhere;
  }
  void *memory = orThrow(counted(__libc_malloc(size ? size : 1), NONE));
  buffers += countOf(memory);
  return memory;
}

void operator delete[](void *memory) noexcept {
  if (isNowhere(memory)) return;
  buffers -= countOf(memory);
  free(memory);
}

void operator delete[](void *memory, std::size_t) noexcept {
  operator delete[](memory);
}
