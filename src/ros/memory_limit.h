/* SPDX-License-Identifier: BSD-3-Clause */
/** A limit to what requests can make this process allocate. For the node; a nodelet shares its manager's memory. */
#ifndef CURVE_PROXIMITY_ROS_MEMORY_LIMIT_H
#define CURVE_PROXIMITY_ROS_MEMORY_LIMIT_H

namespace curve_proximity {

/** From now on an allocation throws std::bad_alloc that would bring the large ones together above this; 0: no limit.
 *
 *  roscpp resizes vectors to whatever count a request claims, before it looks at the bytes: thirty of them can ask for
 *  hundreds of gigabytes. Counted are allocations of a megabyte and more by `operator new`, which is where vectors come
 *  from: those throw inside a callback, where it fails one call. Not counted is `operator new[]`, from which roscpp
 *  takes its receive buffers in a thread that would end the process if it threw; the system backs them only as bytes
 *  really arrive. RLIMIT_AS draws no such line: under it a few connections that merely announce a gigabyte each, and
 *  send nothing, end the process. */
void limitMemory(int megabytes);

} // namespace curve_proximity
#endif
