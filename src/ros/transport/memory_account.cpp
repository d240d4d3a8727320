/* SPDX-License-Identifier: BSD-3-Clause */
#include "transport/memory_account.h"

#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <curve_proximity/core.hpp>
#include <mutex>
#include <string>

#include "transport/turns.h"

namespace curve_proximity::memory {
namespace {

constexpr std::size_t MEGABYTE = std::size_t{1} << 20;

/** Less than this is not worth the look at what is resident. */
constexpr std::size_t SMALL = MEGABYTE;

/** Large requests leave this part of the limit to small ones, which are not entered. */
constexpr std::size_t SMALL_PART = 4;

/** After a share of this size memory is given back to the system. */
constexpr std::size_t LARGE = 4 * MEGABYTE;

std::atomic<std::size_t> most{0};
std::mutex mutex;
std::size_t reserved = 0;
std::atomic<bool> untidy{false};

std::string megabytes(std::size_t bytes) {
  return std::to_string((bytes + MEGABYTE - 1) / MEGABYTE) + " MB";
}

/** Of all, and what is promised. The lock is held. */
std::size_t taken() {
  return resident() + reserved;
}

} // namespace

void setLimit(std::size_t bytes) {
  most = bytes;
}

std::size_t resident() {
  // The second number of /proc/self/statm, in pages; read without an allocation.
  char text[128];
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  const ssize_t n = read(file, text, sizeof text - 1);
  close(file);
  if (n <= 0) return 0;
  text[n] = '\0';
  char *next = text;
  std::strtoul(next, &next, 10);
  return std::strtoul(next, nullptr, 10) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

Share::Share(std::size_t bytes, std::size_t most_of_request) : bytes_(bytes < SMALL ? 0 : bytes) {
  if (bytes_ == 0) return;
  const std::size_t all = most;
  const std::size_t least = all > 0 ? std::min(most_of_request, all / 2) : most_of_request;
  if (bytes_ > least)
    throw Error("too large: the request would take about " + megabytes(bytes_) + ", more than the " + megabytes(least) +
                " that one may take (~max_request_mb, half of ~memory_limit_mb)");
  const std::lock_guard<std::mutex> lock(mutex);
  const std::size_t room = all - all / SMALL_PART;
  if (all > 0 && taken() + bytes_ > room) {
    malloc_trim(0);
    const std::size_t now = taken();
    if (now + bytes_ > room)
      throw Busy("busy: the request would take about " + megabytes(bytes_) + ", and " + megabytes(now) +
                 " of ~memory_limit_mb = " + megabytes(all) + " are taken; large requests leave a quarter of it");
  }
  reserved += bytes_;
}

Share::~Share() {
  if (bytes_ == 0) return;
  const std::lock_guard<std::mutex> lock(mutex);
  reserved -= bytes_;
  if (bytes_ >= LARGE) untidy = true;
}

void tidy() {
  {
    const std::lock_guard<std::mutex> lock(mutex);
    if (reserved > 0) return; // what is free now is wanted again in a moment
  }
  if (untidy.exchange(false)) malloc_trim(0);
}

} // namespace curve_proximity::memory
