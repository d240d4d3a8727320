/* SPDX-License-Identifier: BSD-3-Clause */
/* Replaces the process's operator new and delete; so it belongs to a program, never to a library. */
#include "memory_limit.h"

#include <malloc.h>
#include <ros/poll_manager.h>
#include <sys/mman.h>

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

#include "memory_account.h"

namespace {

/** Smaller allocations are not counted: what a request takes of them is bounded by its estimate. */
constexpr std::size_t COUNTED = 1024;

/** An allocation of this size may throw wherever it happens. */
constexpr std::size_t LARGE = std::size_t{1} << 20;

/** Buffers of this size and more, together, get three quarters of the limit: the rest is for small requests. */
constexpr std::size_t LARGE_BUFFER = std::size_t{8} << 20;

/** roscpp itself drops a connection that announces more than a billion bytes. */
constexpr std::size_t NOWHERE_SIZE = std::size_t{1} << 30;

std::atomic<std::size_t> limit{std::numeric_limits<std::size_t>::max()};
std::atomic<std::size_t> held{0};    /* by counted allocations of `new` */
std::atomic<std::size_t> buffers{0}; /* by those of `new[]`: what roscpp receives and sends */
std::atomic<char *> nowhere{nullptr};
std::atomic<unsigned long> closed{0};
thread_local bool polls = false; /* this is roscpp's thread that polls all connections */

void *allocate(std::size_t size) {
  void *memory = std::malloc(size ? size : 1);
  if (!memory) throw std::bad_alloc();
  return memory;
}

/** Counts what has been allocated, or frees it and throws, at a request or from this size on. */
void *counted(void *memory, std::atomic<std::size_t> &account, std::size_t may_throw_from) {
  const std::size_t usable = malloc_usable_size(memory); // as delete will see it
  if (usable < COUNTED) return memory;
  account += usable;
  if (held + buffers <= limit) return memory;
  if (usable < may_throw_from && !curve_proximity::memory::at_request) return memory;
  account -= usable;
  std::free(memory); // untouched as yet, so that it has cost nothing
  throw std::bad_alloc();
}

void release(void *memory, std::atomic<std::size_t> &account) {
  if (!memory) return;
  const std::size_t usable = malloc_usable_size(memory);
  if (usable >= COUNTED) account -= usable;
  std::free(memory);
}

bool isNowhere(const void *memory) {
  const char *begin = nowhere.load(std::memory_order_relaxed);
  const auto *at = static_cast<const char *>(memory);
  return begin && at >= begin && at < begin + NOWHERE_SIZE;
}

/** Is a buffer of this size more than is left for what others send? */
bool isTooMuch(std::size_t size) {
  const std::size_t most = limit;
  if (size < COUNTED || most == std::numeric_limits<std::size_t>::max()) return false;
  return held + buffers + size > (size >= LARGE_BUFFER ? most - most / 4 : most);
}

} // namespace

namespace curve_proximity {

void limitMemory(int megabytes) {
  mallopt(M_MMAP_THRESHOLD, static_cast<int>(LARGE)); // what is large goes back to the system as soon as it is freed
  if (megabytes <= 0) return;
  limit = static_cast<std::size_t>(megabytes) << 20;
  void *unusable = mmap(nullptr, NOWHERE_SIZE, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (unusable == MAP_FAILED) return;
  nowhere = static_cast<char *>(unusable);
  ros::PollManager::instance()->addPollThreadListener([] { polls = true; });
}

unsigned long connectionsClosed() {
  return closed;
}

} // namespace curve_proximity

void *operator new(std::size_t size) {
  return counted(allocate(size), held, LARGE);
}

void operator delete(void *memory) noexcept {
  release(memory, held);
}

void operator delete(void *memory, std::size_t) noexcept {
  release(memory, held);
}

void *operator new[](std::size_t size) {
  if (polls && isTooMuch(size) && nowhere && size < NOWHERE_SIZE) {
    ++closed;
    return nowhere;
  }
  return counted(allocate(size), buffers, std::numeric_limits<std::size_t>::max());
}

void operator delete[](void *memory) noexcept {
  if (!isNowhere(memory)) release(memory, buffers);
}

void operator delete[](void *memory, std::size_t) noexcept {
  if (!isNowhere(memory)) release(memory, buffers);
}
