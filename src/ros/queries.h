/* SPDX-License-Identifier: BSD-3-Clause */
/** What a service call on curves does between its request and its response. */
#ifndef CURVE_PROXIMITY_ROS_QUERIES_H
#define CURVE_PROXIMITY_ROS_QUERIES_H

#include <curve_proximity/Curve.h>
#include <curve_proximity/Proximity.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <atomic>
#include <curve_proximity/query.hpp>
#include <curve_proximity/scene.hpp>
#include <curve_proximity/srdf.hpp>
#include <string>
#include <vector>

#include "frames.h"
#include "parameters.h"
#include "workspaces.h"

namespace curve_proximity {

/** The request that the three services share, by reference. */
struct QueryRequest {
  Verb verb;
  double delta; /**< [m] of TOLERANCE */
  const std::vector<Curve> &curves;
  const trajectory_msgs::JointTrajectory &trajectory;
  bool self_collision;
  const std::vector<std::string> &objects, &links;
  const sensor_msgs::JointState &joint_state;
  double epsilon;          /**< [m] 0: the server's */
  std::uint32_t max_nodes; /**< 0: the server's */
  bool per_object;
};

/** The response that they share. */
struct QueryResponse {
  bool success = true;
  std::string message;
  std::vector<Proximity> results;
};

/** What the markers show of a query. */
struct Drawing {
  struct Line {
    CompiledCurve curve;
    std::vector<Answer> answers;
  };
  std::vector<Line> lines; /**< of the first curves of the request */
  SnapshotPtr snapshot;
  LinkPoses links; /**< of the last of these curves */
};

/** Answers requests, from any number of threads at once. */
class Queries {
 public:
  /** All are kept by reference. stop: set, it ends running queries with the intervals that they have. */
  Queries(const Parameters &parameters, const Scene &scene, const Srdf &srdf, const Frames &frames,
          const std::atomic<bool> &stop)
      : parameters_(parameters), scene_(scene), srdf_(srdf), frames_(frames), stop_(stop) {}

  /** Fills the response and the drawing. Throws Error where nothing can be answered at all; what is
   *  wrong with one curve becomes its row. */
  void answer(const QueryRequest &request, QueryResponse &response, Drawing &drawing);

 private:
  Question toQuestion(const QueryRequest &request) const;
  void answerCurves(const QueryRequest &request, const Question &question, const SnapshotPtr &snapshot,
                    QueryResponse &response, Drawing &drawing);
  void answerTrajectory(const QueryRequest &request, const Question &question, const SnapshotPtr &snapshot,
                        QueryResponse &response);
  void checkLimits(const QueryRequest &request, const Snapshot &snapshot) const;

  const Parameters &parameters_;
  const Scene &scene_;
  const Srdf &srdf_;
  const Frames &frames_;
  const std::atomic<bool> &stop_;
  WorkspacePool workspaces_;
};

} // namespace curve_proximity
#endif
