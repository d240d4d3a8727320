/* SPDX-License-Identifier: BSD-3-Clause */
/** How soon a thread runs that has just woken, by Linux's scheduler. */
#ifndef CURVE_PROXIMITY_ROS_TIME_SLICE_H
#define CURVE_PROXIMITY_ROS_TIME_SLICE_H

#include <chrono>

namespace curve_proximity {

/** In what pieces the calling thread gets its share of the processor, which stays the same. A thread that wakes runs at
 *  once in place of one with a longer slice. Behind one with the same slice it waits for the rest of that, which is
 * some milliseconds.
 *
 *  slice: .1 to 100 ms; 0: the system's own. Needs no privilege, and lasts until the next call. For Linux from 6.12 on;
 *  on older ones the call does nothing. False: the thread's policy has no slices, or the call is forbidden.
 *
 *  Earliest eligible virtual deadline first (I. Stoica, H. Abdel-Wahab, TR-95-22, 1995); sched_setattr(2). */
bool setTimeSlice(std::chrono::microseconds slice) noexcept;

/** Of the calling thread; 0 where it is not known. */
std::chrono::microseconds timeSlice() noexcept;

/** Of threads that take requests. The system's own slice is 1 to 3 ms, many times what a small request takes. */
constexpr std::chrono::microseconds SHORT_SLICE{100};

} // namespace curve_proximity
#endif
