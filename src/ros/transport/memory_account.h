/* SPDX-License-Identifier: BSD-3-Clause */
/** One account of the process's memory: what requests are going to take is entered before it is made. */
#ifndef CURVE_PROXIMITY_ROS_MEMORY_ACCOUNT_H
#define CURVE_PROXIMITY_ROS_MEMORY_ACCOUNT_H

#include <cstddef>

namespace curve_proximity::memory {

/** [bytes] About what a control point takes: its curve with boxes and tables, and what a search keeps of it. And a
 * joint value: its motion. */
constexpr std::size_t OF_POINT = 400, OF_VALUE = 128;

/** [bytes] The most that the process may take; 0: no limit. */
void setLimit(std::size_t bytes);

/** [bytes] What the process has resident now. */
std::size_t resident();

/** Bytes of the account, for as long as this lives. Below a megabyte nothing is entered. */
class Share {
 public:
  /** most: of one request; half of the limit, where that is less. Throws Error where a request is larger than that, and
   *  Busy where the account has no room for it now. Both name the figures. */
  Share(std::size_t bytes, std::size_t most);
  ~Share();

  Share(const Share &) = delete;
  Share &operator=(const Share &) = delete;

 private:
  std::size_t bytes_;
};

/** Gives memory back to the system, if a large share has ended since the last call and there is none now. */
void tidy();

} // namespace curve_proximity::memory
#endif
