/* SPDX-License-Identifier: BSD-3-Clause */
/** The one shell round every callback: whatever is thrown inside becomes a sentence. */
#ifndef CURVE_PROXIMITY_ROS_GUARD_H
#define CURVE_PROXIMITY_ROS_GUARD_H

#include <exception>
#include <new>
#include <string>

namespace curve_proximity {

/** Runs `work`; hands a sentence to `failed` if it throws anything at all. roscpp ends the process for what leaves a
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

/** A service handler: always true, since `return false` reaches the client as an empty sentence. */
template <class Response, class Work>
bool answered(Response &response, Work &&work) {
  guarded(work, [&](const std::string &why) {
    response = Response();
    response.success = false;
    response.message = why;
  });
  return true;
}

} // namespace curve_proximity
#endif
