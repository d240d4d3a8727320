/* SPDX-License-Identifier: BSD-3-Clause */
/* What the commands say that need ROS, in a build without it. */
#include "commands.h"
#include "exit_code.h"

namespace curve_proximity::cli {

int answerConstraints(const Arguments &, Console &) {
  throw BadUsage("constraints: providers are plugins of ROS, and this program was built without ROS");
}

int sendScene(const Arguments &, Console &) {
  throw BadUsage("send: this program was built without ROS");
}

} // namespace curve_proximity::cli
