/* SPDX-License-Identifier: BSD-3-Clause */
#include "diagnostics.h"

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <ros/console.h>

#include <algorithm>
#include <boost/algorithm/string/join.hpp>

#include "transport/guard.h"
#include "transport/memory_account.h"

namespace curve_proximity {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr double REPORT_PERIOD = 1.0; /* [s] */

} // namespace

Diagnostics::Diagnostics(const ros::NodeHandle &handle, Statistics &statistics, Turns &turns, const Pipeline &pipeline,
                         const PlanningSceneTopic &planning_scene, const LiveScene &live)
    : statistics_(statistics),
      turns_(turns),
      pipeline_(pipeline),
      planning_scene_(planning_scene),
      live_(live),
      handle_(handle),
      updater_(ros::NodeHandle(), handle, handle.getNamespace()) {
  updater_.setHardwareID("none");
  updater_.add("queries", this, &Diagnostics::queries);
  updater_.add("sensors", this, &Diagnostics::sensors);
  updater_.add("planning_scene", this, &Diagnostics::planningScene);

  // By the wall clock: the updater's own period counts in ROS time, which may stand still.
  timer_ = handle_.createWallTimer(ros::WallDuration(REPORT_PERIOD), [this](const ros::WallTimerEvent &) {
    memory::tidy();
    guarded([this] { updater_.force_update(); },
            [](const std::string &why) { ROS_ERROR("diagnostics: %s", why.c_str()); });
  });
}

void Diagnostics::queries(Status &status) {
  const Summary s = statistics_.take();
  const double seconds = std::max(s.seconds, 1e-3);
  const std::uint64_t dropped = pipeline_.dropped();
  if (s.disputed > 0) {
    status.summary(DiagnosticStatus::WARN, "second opinions disagree: the log says of what");
  } else if (s.failed_calls > 0) {
    status.summary(DiagnosticStatus::WARN, "requests failed");
  } else if (s.undecided > 0) {
    status.summary(DiagnosticStatus::WARN, "verdicts are undecided");
  } else if (dropped > dropped_) {
    status.summary(DiagnosticStatus::WARN, "messages are dropped: they come faster than they are answered");
  } else {
    status.summary(DiagnosticStatus::OK, s.calls > 0 ? "answering" : "idle");
  }
  status.addf("requests per second", "%.1f", static_cast<double>(s.calls) / seconds);
  status.addf("rows per second", "%.1f", static_cast<double>(s.rows) / seconds);
  status.addf("mean time of a request [us]", "%.0f",
              1e6 * s.busy / static_cast<double>(std::max<std::uint64_t>(s.calls, 1)));
  status.addf("longest time of a request [us]", "%.0f", 1e6 * s.longest);
  status.add("requests that wait", turns_.waiting());
  status.add("resident memory [MB]", memory::resident() >> 20);
  status.add("undecided rows", s.undecided);
  status.add("failed rows", s.failed);
  status.add("failed requests", s.failed_calls);
  status.add("rows with a second opinion", s.opinions);
  status.add("second opinions that disagree, ever", s.all_disputed);
  status.add("messages dropped", dropped);
  dropped_ = dropped;
}

void Diagnostics::sensors(Status &status) {
  const std::vector<SensorState> sensors = live_.sensors.states();
  status.summary(DiagnosticStatus::OK, sensors.empty() ? "nothing came" : "listening");
  for (const SensorState &sensor : sensors) {
    status.addf(sensor.id + ": age [s]", "%.3f", sensor.age);
    if (!sensor.unknown) continue;
    status.add(sensor.id, "unknown");
    status.summary(DiagnosticStatus::WARN,
                   "what is at an object is unknown: its sensor sees nothing, or what it sent cannot be used");
  }
}

void Diagnostics::planningScene(Status &status) {
  const PlanningSceneReport report = planning_scene_.report();
  const std::string differences = boost::algorithm::join(report.differences, "; ");
  if (!differences.empty()) {
    status.summary(DiagnosticStatus::WARN, "the scene differs from that of ~get_planning_scene");
  } else if (!report.unused.empty()) {
    status.summary(DiagnosticStatus::WARN, "not all of the scene is used");
  } else if (report.full == 0 && report.diffs > 0) {
    status.summary(DiagnosticStatus::WARN, "diffs came, and no full scene");
  } else {
    status.summary(DiagnosticStatus::OK, report.full > 0 ? "following" : "nothing came");
  }
  if (report.full + report.diffs == 0 && report.unused.empty()) return;
  status.add("full scenes", report.full);
  status.addf("fingerprint of the last full scene", "%016lx", report.fingerprint);
  status.add("diffs since then", report.diffs_since_full);
  status.addf("fingerprint of the last diff", "%016lx", report.diff_fingerprint);
  status.add("comparisons with ~get_planning_scene", report.checks);
  status.add("scenes replaced after a comparison", report.replaced);
  if (!differences.empty()) status.add("differences", differences);
  if (!report.unused.empty()) status.add("not used", boost::algorithm::join(report.unused, "; "));
}

} // namespace curve_proximity
