/* SPDX-License-Identifier: BSD-3-Clause */
#include "gate/server_calls.h"

#include <ros/console.h>

#include <algorithm>
#include <curve_proximity/core.hpp>
#include <sstream>

#include "transport/guard.h"

namespace curve_proximity {

namespace {

constexpr double PATIENCE = 2.0;      /* [s] with a server that is not there */
constexpr double LOOK_PATIENCE = 0.1; /* [s] the same where a motion runs */

/** By the first row that is not certified to stay farther than delta: its pair, its time, its distance. */
Refusal refusalOf(const std::vector<Proximity> &rows, double delta, const SceneState &scene, bool &clear) {
  Refusal out = refusalBecause("it is not certified to be clear", scene);
  out.delta = delta;
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const Proximity &r) {
    return r.verdict != Proximity::VERDICT_CLEAR && !(r.lower > delta); // without an answer: NaN, no verdict
  });
  clear = !rows.empty() && row == rows.end();
  if (row == rows.end()) return out;
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

} // namespace

void logGateError(const std::string &why) {
  ROS_ERROR("gate: %s", why.c_str());
}

Refusal refusalBecause(const std::string &why, const SceneState &scene) {
  Refusal out;
  out.header.stamp = ros::Time::now();
  out.scene = scene;
  out.message = why;
  return out;
}

bool ServerCalls::isClear(const Asked &query, SeenScene &scene, Refusal &refusal) {
  bool passes = false;
  guarded(
      [&] {
        Tolerance call;
        const ProximityQuery &asked = query();
        call.request.query = asked;
        call.request.query.certificate = proofs_ != nullptr;
        call.request.delta = delta_;
        scene.read = read(); // what comes from now on is looked at again
        if (!tolerance_.call(call, PATIENCE)) throw Error("the server does not answer");
        const std::vector<Proximity> &rows = call.response.results;
        bool clear = false;
        refusal = refusalOf(rows, delta_, call.response.scene, clear);
        scene.state = call.response.scene;
        if (!call.response.success) refusal.message = call.response.message;
        refusal.header.frame_id = call.response.frame_id;
        if (!call.response.success || !clear) return;
        refusal.message = proofs_ ? proofs_->doubt(asked, rows, delta_) : "";
        passes = refusal.message.empty();
      },
      [&](const std::string &why) { refusal = refusalBecause(why, scene.state); });
  return passes;
}

bool ServerCalls::isStillClear(const Asked &query, bool recent, SeenScene &scene, Refusal &refusal) {
  bool clear = false;
  guarded(
      [&] {
        Tolerance call; // about nothing: its answer names the scene
        if (!tolerance_.call(call, LOOK_PATIENCE)) throw Error("the server does not answer");
        const SceneState &now = call.response.scene;
        clear = recent && now.epoch == scene.state.epoch && now.version == scene.state.version && read() == scene.read;
        if (!clear) clear = isClear(query, scene, refusal);
      },
      [&](const std::string &why) { refusal = refusalBecause(why, scene.state); });
  return clear;
}

} // namespace curve_proximity
