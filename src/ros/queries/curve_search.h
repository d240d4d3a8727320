/* SPDX-License-Identifier: BSD-3-Clause */
/** What all curves of a request share. */
#ifndef CURVE_PROXIMITY_ROS_CURVE_SEARCH_H
#define CURVE_PROXIMITY_ROS_CURVE_SEARCH_H

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "queries/queries.h"

namespace curve_proximity {

/** Everything that a query is measured against, for one stamp after the other. For one thread. */
class StampedObstacles {
 public:
  StampedObstacles(SnapshotPtr snapshot, const Query &query, const Srdf &srdf, const JointPositions *joints,
                   FrameLookup &lookup)
      : snapshot_(std::move(snapshot)), query_(query), srdf_(srdf), joints_(joints), lookup_(lookup) {
    const bool everything = query.objects.empty() && query.links.empty();
    if (!query.links.empty() && !snapshot_->robot())
      throw Error("link '" + query.links.front() + "': this server has no robot, only objects");
    const auto carried = [&](const std::string &id) { return snapshot_->attached().count(id) > 0; };
    carried_ =
        everything ? !snapshot_->attached().empty() : std::any_of(query.objects.begin(), query.objects.end(), carried);
    with_robot_ = snapshot_->robot() && (everything || carried_ || !query.links.empty());
  }

  bool withRobot() const {
    return with_robot_;
  }

  struct Stamped {
    LinkPoses links;
    SceneObstacles obstacles;
    double age; /* [s] of the transforms */
  };

  const Stamped &at(const ros::Time &stamp) {
    // Without a robot nothing depends on the stamp.
    const ros::Time key = with_robot_ ? stamp : ros::Time();
    auto found = stamped_.find(key);
    if (found == stamped_.end()) {
      lookup_.begin();
      LinkPoses links = with_robot_ ? linkPoses(stamp) : LinkPoses();
      SceneObstacles obstacles(snapshot_, links, query_);
      found = stamped_.emplace(key, Stamped{std::move(links), std::move(obstacles), lookup_.age()}).first;
    }
    return found->second;
  }

 private:
  /** From the joints of the request, if it has any; else every link by tf2. */
  LinkPoses linkPoses(const ros::Time &stamp) {
    const Robot &robot = *snapshot_->robot();
    if (joints_) return robot.linkPoses(*joints_, rootPose(robot, srdf_, stamp, lookup_));
    LinkPoses poses;
    if (query_.links.empty()) {
      for (const auto &link : robot.links()) {
        if (!link.second.empty()) poses[link.first] = lookup_.toFixed(link.first, stamp);
      }
    }
    for (const std::string &link : query_.links) {
      if (robot.links().count(link)) poses[link] = lookup_.toFixed(link, stamp);
    }
    for (const auto &object : snapshot_->attached()) {
      if (carried_) poses[object.second->link] = lookup_.toFixed(object.second->link, stamp);
    }
    return poses;
  }

  const SnapshotPtr snapshot_;
  const Query &query_;
  const Srdf &srdf_;
  const JointPositions *const joints_; /* null: tf2 tells */
  FrameLookup &lookup_;
  bool with_robot_ = false, carried_ = false;
  std::map<ros::Time, Stamped> stamped_;
};

/* What all curves of a request share. */
struct Queries::CurveSearch {
  StampedObstacles obstacles;
  WorkspacePool::Lease workspace;
  CurveDescription description = {}; /* of the curve at hand: its memory serves the next one */
  std::size_t curves = 0;            /* so far */
  Failures failures = {};
  const LinkPoses *drawn = nullptr; /* the robot of the last curve that is drawn; null: none is */

  void fail(const Proximity &row) {
    failures.count("curve " + std::to_string(curves) + " ('" + row.id + "'): " + row.message);
  }
};

} // namespace curve_proximity
#endif
