/* SPDX-License-Identifier: BSD-3-Clause */
#include "gate/server_calls.h"

#include <ros/console.h>

#include <algorithm>
#include <curve_proximity/core.hpp>
#include <sstream>

#include "transport/guard.h"

namespace curve_proximity {

void logGateError(const std::string &why) {
  ROS_ERROR("gate: %s", why.c_str());
}

bool isClear(const Proximity &row, double delta, bool decided) {
  return (decided && row.verdict == Proximity::VERDICT_CLEAR) ||
         row.lower > delta; // without an answer: NaN, no verdict
}

Refusal refusalOf(const std::vector<Proximity> &rows, double delta, const SceneState &scene) {
  Refusal out;
  out.header.stamp = ros::Time::now();
  out.delta = delta;
  out.scene = scene;
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const Proximity &r) { return !isClear(r, delta, true); });
  if (row == rows.end()) {
    out.message = "it is not certified to be clear";
    return out;
  }
  out.row = *row;
  std::ostringstream text;
  text.precision(4);
  text << "'" << row->a << "' and '" << row->b << "' come to between " << row->lower << " and " << row->upper
       << " m at " << row->t << " (" << row->kind << ", " << row->status << "): more than " << delta
       << " m is not certified";
  if (!row->message.empty()) text << "; " << row->message;
  out.message = text.str();
  return out;
}

Refusal refusalBecause(const std::string &why, const SceneState &scene) {
  Refusal out;
  out.header.stamp = ros::Time::now();
  out.scene = scene;
  out.message = why;
  return out;
}

SceneState ServerCalls::scene(double patience) {
  Tolerance call;
  if (!tolerance_.call(call, patience)) throw Error("the server does not answer");
  return call.response.scene;
}

bool ServerCalls::isClear(const ProximityQuery &query, SeenScene &scene, Refusal &refusal) {
  Tolerance call;
  call.request.query = query;
  call.request.query.certificate = proofs_ != nullptr;
  call.request.delta = delta_;
  refusal = Refusal();
  refusal.header.stamp = ros::Time::now();
  refusal.delta = delta_;
  scene.read = read(); // what comes from now on is looked at again
  if (!tolerance_.call(call, PATIENCE)) {
    refusal.message = "the server does not answer";
    return false;
  }
  const std::vector<Proximity> &rows = call.response.results;
  const bool clear = call.response.success && !rows.empty() &&
                     std::all_of(rows.begin(), rows.end(),
                                 [&](const Proximity &r) { return curve_proximity::isClear(r, delta_, true); });
  refusal = refusalOf(rows, delta_, call.response.scene);
  scene.state = call.response.scene;
  if (!call.response.success) refusal.message = call.response.message;
  refusal.header.frame_id = call.response.frame_id;
  if (!clear || !proofs_) return clear;
  refusal.message = proofs_->doubt(query, rows, delta_);
  return refusal.message.empty();
}

bool ServerCalls::isStillClear(const std::function<const ProximityQuery &()> &query, bool recent, double patience,
                               SeenScene &scene, Refusal &refusal) {
  bool clear = false;
  guarded(
      [&] {
        const SceneState now = this->scene(patience);
        clear = recent && now.epoch == scene.state.epoch && now.version == scene.state.version && read() == scene.read;
        if (!clear) clear = isClear(query(), scene, refusal);
      },
      [&](const std::string &why) { refusal = refusalBecause(why, scene.state); });
  return clear;
}

} // namespace curve_proximity
