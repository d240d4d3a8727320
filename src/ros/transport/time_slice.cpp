/* SPDX-License-Identifier: BSD-3-Clause */
#include "transport/time_slice.h"

#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>

namespace curve_proximity {
namespace {

/** The kernel's struct sched_attr, which glibc has from 2.41 on. */
struct Attributes {
  std::uint32_t size;
  std::uint32_t policy;
  std::uint64_t flags;
  std::int32_t nice;
  std::uint32_t priority;
  std::uint64_t runtime; /* [ns] the slice, of the policies that share by weight */
  std::uint64_t deadline;
  std::uint64_t period;
};

bool get(Attributes &out) noexcept {
  out = Attributes();
  return syscall(SYS_sched_getattr, 0, &out, sizeof out, 0) == 0;
}

bool sharesByWeight(const Attributes &of) noexcept {
  return of.policy == SCHED_OTHER || of.policy == SCHED_BATCH;
}

} // namespace

bool setTimeSlice(std::chrono::microseconds slice) noexcept {
  Attributes attributes;
  if (!get(attributes) || !sharesByWeight(attributes)) return false;
  attributes.runtime = static_cast<std::uint64_t>(std::chrono::nanoseconds(slice).count());
  return syscall(SYS_sched_setattr, 0, &attributes, 0) == 0;
}

std::chrono::microseconds timeSlice() noexcept {
  Attributes attributes;
  if (!get(attributes) || !sharesByWeight(attributes)) return std::chrono::microseconds(0);
  return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::nanoseconds(attributes.runtime));
}

} // namespace curve_proximity
