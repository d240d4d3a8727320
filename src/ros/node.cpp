/* SPDX-License-Identifier: BSD-3-Clause */
/** The server as a process: signals; all else is ProximityServer. */
#include <malloc.h>
#include <ros/console.h>
#include <ros/init.h>
#include <signal.h>

#include <chrono>
#include <exception>
#include <thread>

#include "parameters/parameters.h"
#include "server.h"

namespace {

constexpr int EXIT_WRONG = 1; /* parameters or robot are unusable */

volatile sig_atomic_t interrupted = 0;

void onSignal(int) {
  interrupted = 1;
}

/** roscpp would cut connections off on SIGINT before running queries have ended. */
void catchSignals() {
  struct sigaction action = {};
  action.sa_handler = onSignal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

/**
 * What a large request has taken goes back to the system as it ends. By itself glibc raises both thresholds with the
 * blocks that are freed, to 32 and 64 MB, and keeps up to the latter at the end of each thread's arena, where
 * malloc_trim() leaves it.
 */
void giveMemoryBack() {
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
  mallopt(M_TRIM_THRESHOLD, 2 << 20);
}

} // namespace

int main(int argc, char **argv) {
  ros::init(argc, argv, "curve_proximity", ros::init_options::NoSigintHandler);
  catchSignals();
  giveMemoryBack();
  const ros::NodeHandle handle("~"); // outlives the messages below: without any handle roscpp logs no more
  int code = EXIT_WRONG;
  try {
    const curve_proximity::Parameters parameters = curve_proximity::readParameters(handle);
    const curve_proximity::ProximityServer server(handle, parameters);
    while (ros::ok() && !interrupted) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    code = 0;
  } catch (const std::exception &error) {
    ROS_FATAL("%s", error.what());
  }
  ros::shutdown();
  return code;
}
