/* SPDX-License-Identifier: BSD-3-Clause */
/** A limit to what this process can be made to allocate. For the node; a nodelet shares its manager's memory. */
#ifndef CURVE_PROXIMITY_ROS_MEMORY_LIMIT_H
#define CURVE_PROXIMITY_ROS_MEMORY_LIMIT_H

namespace curve_proximity {

/** From now on allocations are counted and limited; 0: not. After ros::start(). What the process has resident beside
 * its allocations (programs, libraries, stacks) counts as it is now. memory_account.h sees the same count.
 *
 *  An allocation that is too much fails, as for want of memory: in C++ by std::bad_alloc in the callback, in the C core
 *  by a status; so it fails one call. roscpp takes its receive buffers by `new[]` in the thread that polls all
 *  connections, which would end the process if it threw. A buffer that is more than is left becomes memory that cannot
 *  be written: then recv() fails, and roscpp closes that connection alone. RLIMIT_AS draws no such line: under it a few
 *  connections that merely announce a gigabyte each, and send nothing, end the process. */
void limitMemory(int megabytes);

/** How many connections were closed because they announced too much. */
unsigned long connectionsClosed();

} // namespace curve_proximity
#endif
