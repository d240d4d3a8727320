/* SPDX-License-Identifier: BSD-3-Clause */
/** The time that a request may take. */
#ifndef CURVE_PROXIMITY_ROS_TIME_BUDGET_H
#define CURVE_PROXIMITY_ROS_TIME_BUDGET_H

#include <algorithm>
#include <atomic>
#include <chrono>
#include <curve_proximity/core.hpp>
#include <functional>
#include <sstream>
#include <string>
#include <utility>

#include "transport/turns.h"

namespace curve_proximity {

/** Ends a query when its time is over or the server goes, and makes way for others meanwhile. */
class TimeBudget {
 public:
  using Clock = std::chrono::steady_clock;

  /** begin: of the time. turn: of the thread that asks; may be null. cancelled: once true, it ends the query; may be
   *  empty. */
  TimeBudget(double milliseconds, Clock::time_point begin, const std::atomic<bool> &stop, Turn *turn,
             std::function<bool()> cancelled)
      : milliseconds_(milliseconds),
        deadline_(after(begin, milliseconds)),
        stop_(stop),
        cancelled_(std::move(cancelled)),
        turn_(turn) {}

  /** In the shape of cprox_options.stop. */
  static bool isOver(void *user) {
    const TimeBudget &budget = *static_cast<const TimeBudget *>(user);
    if (budget.turn_) budget.turn_->yield();
    return budget.isReached();
  }

  /** Once reached it stays so. */
  bool isReached() const {
    return stop_ || isCancelled() || Clock::now() >= deadline_;
  }

  /** Throws Error where it is reached. */
  void demand() const {
    if (isReached()) throw Error(stop_ ? "the server is shutting down" : "~budget_ms are over");
  }

  std::string reason() const {
    if (stop_) return "the server is shutting down";
    if (isCancelled()) return "cancelled";
    std::ostringstream text;
    text << "~budget_ms = " << milliseconds_ << " are over";
    return text.str();
  }

  static Clock::time_point after(Clock::time_point begin, double milliseconds) {
    constexpr double FOREVER = 1e12; /* [ms] decades: within what the clock can count */
    const std::chrono::duration<double, std::milli> wait(std::min(milliseconds, FOREVER));
    return begin + std::chrono::duration_cast<Clock::duration>(wait);
  }

 private:
  bool isCancelled() const {
    return cancelled_ && cancelled_();
  }

  const double milliseconds_;
  const Clock::time_point deadline_;
  const std::atomic<bool> &stop_;
  const std::function<bool()> cancelled_;
  Turn *const turn_;
};

/** While this lives, the making of a curve makes way for others as a query does. The budget does not end it; the query
 *  after it ends at once. */
class WayWhileMaking {
 public:
  /** options: those of the query, whose stop function is a TimeBudget's. */
  WayWhileMaking(Workspace &workspace, const cprox_options &options) : workspace_(workspace) {
    cprox_workspace_set_stop(workspace_.get(), options.stop_user ? makeWay : nullptr, options.stop_user);
  }
  ~WayWhileMaking() {
    cprox_workspace_set_stop(workspace_.get(), nullptr, nullptr);
  }
  WayWhileMaking(const WayWhileMaking &) = delete;
  WayWhileMaking &operator=(const WayWhileMaking &) = delete;

 private:
  static bool makeWay(void *budget) {
    TimeBudget::isOver(budget);
    return false;
  }

  Workspace &workspace_;
};

} // namespace curve_proximity
#endif
