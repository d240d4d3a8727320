/* SPDX-License-Identifier: BSD-3-Clause */
/** The one shell round every callback: whatever is thrown inside becomes a message. */
#ifndef CURVE_PROXIMITY_ROS_GUARD_H
#define CURVE_PROXIMITY_ROS_GUARD_H

#include <exception>
#include <new>
#include <string>

#include "transport/turns.h"

namespace curve_proximity {

/** Runs `work`; hands a message to `failed` if it throws anything at all. roscpp ends the process for what leaves a
 *  topic or timer callback, and for a thrown int in a service. */
template <class Work, class Failed>
void guarded(Work &&work, Failed &&failed) {
  try {
    work();
  } catch (const std::bad_alloc &) {
    failed("out of memory");
  } catch (const std::exception &error) {
    failed(error.what());
  } catch (...) {
    failed("an unknown failure");
  }
}

/** Sets the status of a response that has one. */
template <class Response>
auto markBusy(Response &response, int) -> decltype(response.status, void()) {
  response.status = Response::BUSY;
}
template <class Response>
void markBusy(Response &, long) {}

/** A service handler: always true, since `return false` reaches the client as an empty message. */
template <class Response, class Work>
bool answered(Response &response, Work &&work) {
  const auto fail = [&](const std::string &why) {
    response = Response();
    response.success = false;
    response.message = why;
  };
  guarded(
      [&] {
        try {
          work();
        } catch (const Busy &busy) {
          fail(busy.what());
          markBusy(response, 0);
        }
      },
      fail);
  return true;
}

} // namespace curve_proximity
#endif
