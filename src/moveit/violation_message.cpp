/* SPDX-License-Identifier: BSD-3-Clause */
#include "violation_message.h"

#include <limits>

namespace curve_proximity {
namespace {

constexpr double LINE = 0.005, POINT = 0.03, LETTERS = 0.05; /* [m] */

geometry_msgs::Point toPoint(const cprox_vec3 &point) {
  geometry_msgs::Point out;
  out.x = point.x;
  out.y = point.y;
  out.z = point.z;
  return out;
}

Proximity toRow(const Answer &answer) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const cprox_result &result = answer.result;
  Proximity out;
  out.id = answer.id;
  out.kind = answer.kind;
  out.status = answer.status;
  out.verdict = cprox_verdict_name(result.verdict);
  out.lower = result.lower;
  out.upper = result.upper;
  out.t = result.t;
  out.t_b = out.t_contact_lower = out.certified_scale = out.refused_scale = out.second_distance = none;
  out.witness_a = toPoint(result.witness_mover);
  out.witness_b = toPoint(result.witness_obstacle);
  out.normal.x = result.normal.x;
  out.normal.y = result.normal.y;
  out.normal.z = result.normal.z;
  out.a = answer.a;
  out.b = answer.b;
  out.nodes = result.nodes;
  out.distance_queries = result.distance_queries;
  out.microseconds = answer.microseconds;
  out.lod = cprox_lod_name(result.lod);
  out.message = answer.message;
  return out;
}

visualization_msgs::Marker markerOf(const std::string &frame, int id, int type) {
  visualization_msgs::Marker out;
  out.header.frame_id = frame;
  out.ns = "not_proven";
  out.id = id;
  out.type = type;
  out.pose.orientation.w = 1.0;
  out.color.r = out.color.a = 1.0F;
  return out;
}

} // namespace

ViolationIntervals toMessage(const Doubt &doubt) {
  ViolationIntervals out;
  out.summary = toRow(doubt.answer);
  for (const Violation &one : doubt.where.list) {
    out.enter_lower.push_back(one.enter_lower);
    out.enter_upper.push_back(one.enter_upper);
    out.leave_lower.push_back(one.leave_lower);
    out.leave_upper.push_back(one.leave_upper);
    out.verdict.emplace_back(cprox_verdict_name(one.verdict));
    out.upper.push_back(one.upper);
    out.t.push_back(one.t);
    out.a.push_back(one.a);
    out.b.push_back(one.b);
  }
  return out;
}

visualization_msgs::MarkerArray toMarkers(const std::vector<Doubt> &doubts, const std::string &frame) {
  visualization_msgs::MarkerArray out;
  out.markers.push_back(markerOf(frame, 0, 0));
  out.markers.back().action = visualization_msgs::Marker::DELETEALL;
  for (const Doubt &doubt : doubts) {
    const Answer &answer = doubt.answer;
    if (answer.b.empty()) continue; // no witness points
    const int id = static_cast<int>(out.markers.size());
    const geometry_msgs::Point a = toPoint(answer.result.witness_mover), b = toPoint(answer.result.witness_obstacle);
    visualization_msgs::Marker line = markerOf(frame, id, visualization_msgs::Marker::LINE_LIST);
    line.scale.x = LINE;
    line.points = {a, b};
    visualization_msgs::Marker points = markerOf(frame, id + 1, visualization_msgs::Marker::SPHERE_LIST);
    points.scale.x = points.scale.y = points.scale.z = POINT;
    points.points = {a, b};
    visualization_msgs::Marker names = markerOf(frame, id + 2, visualization_msgs::Marker::TEXT_VIEW_FACING);
    names.scale.z = LETTERS;
    names.pose.position = a;
    names.text = answer.a + " | " + answer.b;
    out.markers.insert(out.markers.end(), {line, points, names});
  }
  return out;
}

} // namespace curve_proximity
