/* SPDX-License-Identifier: BSD-3-Clause */
#include "messages/clearance_topics.h"

#include <curve_proximity/Clearance.h>
#include <curve_proximity/Proximity.h>

#include <algorithm>
#include <cctype>
#include <limits>

namespace curve_proximity {
namespace {

/** Profiles that wait for a subscriber which is slow. */
constexpr std::size_t PROFILES_KEPT = 10;

/** Graph names have letters, digits and underscores only. */
std::string graphName(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

/** Does a stamp hold it? */
bool isStamp(double seconds) {
  return seconds >= 0.0 && seconds < std::numeric_limits<std::uint32_t>::max();
}

} // namespace

ClearanceTopics::ClearanceTopics(const ros::NodeHandle &handle, std::size_t intervals, const Robot *robot,
                                 bool per_link) {
  ros::NodeHandle below(handle, "clearance");
  const auto advertise = [&](const std::string &name) {
    topics_[name] = below.advertise<Clearance>(name, static_cast<std::uint32_t>(2 * intervals * PROFILES_KEPT));
  };
  advertise(Proximity::KIND_CURVE);
  advertise(Proximity::KIND_MOVERS);
  if (!robot) return;
  for (const std::string &kind : {Proximity::KIND_ENVIRONMENT, Proximity::KIND_SELF}) {
    advertise(kind);
    for (const auto &[link, elements] : robot->links())
      if (per_link && !elements.empty()) advertise(kind + "/" + graphName(link));
  }
}

bool ClearanceTopics::isWatched() const {
  return std::any_of(topics_.begin(), topics_.end(),
                     [](const auto &topic) { return topic.second.getNumSubscribers() > 0; });
}

void ClearanceTopics::publish(const Profile &profile, const std_msgs::Header &begin) {
  const std::string &kind = profile.summary.kind;
  const auto topic = topics_.find(profile.link.empty() ? kind : kind + "/" + graphName(profile.link));
  if (topic == topics_.end()) return;
  Clearance message;
  message.header.frame_id = begin.frame_id;
  message.id = profile.summary.id;
  for (std::size_t i = 0; i < profile.t0.size(); ++i) {
    message.lower = profile.lower[i];
    message.upper = profile.upper[i];
    message.a = profile.a[i];
    message.b = profile.b[i];
    for (const double t : {profile.t0[i], profile.t1[i]}) {
      if (!isStamp(begin.stamp.toSec() + t)) continue;
      message.header.stamp = begin.stamp + ros::Duration(t);
      message.t = t;
      topic->second.publish(message);
    }
  }
}

} // namespace curve_proximity
