/* SPDX-License-Identifier: BSD-3-Clause */
/** What a service call does between its request and its response: queries.cpp for all, curve_rows.cpp for curves,
 *  motion_rows.cpp for what moves otherwise. */
#ifndef CURVE_PROXIMITY_ROS_QUERIES_H
#define CURVE_PROXIMITY_ROS_QUERIES_H

#include <curve_proximity/Curve.h>
#include <curve_proximity/Proximity.h>
#include <curve_proximity/ProximityQuery.h>
#include <curve_proximity/SceneState.h>
#include <nav_msgs/Path.h>
#include <trajectory_msgs/JointTrajectory.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <atomic>
#include <boost/range/iterator_range.hpp>
#include <curve_proximity/motion.hpp>
#include <curve_proximity/query.hpp>
#include <curve_proximity/scene.hpp>
#include <curve_proximity/srdf.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../scene/query/certificate_problem.h"
#include "../scene/query/subject.h"
#include "parameters/parameters.h"
#include "parameters/tuning.h"
#include "queries/row_message.h"
#include "queries/surroundings.h"
#include "transport/statistics.h"
#include "transport/turns.h"
#include "transport/workspaces.h"
#include "world/doubts.h"
#include "world/frames.h"
#include "world/live_scene.h"

namespace curve_proximity {

/** Messages that somebody else holds. */
template <class Message>
using List = boost::iterator_range<const Message *>;

template <class Message>
List<Message> listOf(const std::vector<Message> &messages) {
  return {messages.data(), messages.data() + messages.size()};
}

struct PathPoses;
struct QueryResponse;

/** Told of the rows so far, and how many curves, paths and trajectories are done. */
using Progress = std::function<void(const QueryResponse &response, std::size_t done)>;

/** What services, topics and the action ask, by reference. */
struct QueryRequest {
  QueryType query_type;
  double delta; /**< [m] of TOLERANCE */
  List<Curve> curves;
  List<nav_msgs::Path> paths;
  List<trajectory_msgs::JointTrajectory> trajectories;
  List<trajectory_msgs::MultiDOFJointTrajectory> multi_dof_trajectories;
  Question question;          /**< its query_type is that of the above */
  bool per_link = false;      /**< rows for each link of a motion */
  const ProximityQuery &more; /**< all else; what stands in the four lists above is not looked at */
  Coverage coverage;          /**< what of the trajectories' source is not in them */
  double budget_ms = 0.0;     /**< 0: the server's */
  std::chrono::steady_clock::time_point arrival = std::chrono::steady_clock::now(); /**< when the budget begins */
  std::function<bool()> cancelled; /**< once true, it ends this query; empty: nobody can */
  Progress progress;               /**< called after each curve and trajectory; empty: nobody is told */
  std::vector<Problem> *problems =
      nullptr;          /**< not null: the rows are not answered, but told as the checker reads them */
  Turn *turn = nullptr; /**< given back to others now and then; may be null */

  QueryRequest(QueryType type, double limit, const ProximityQuery &query)
      : query_type(type),
        delta(limit),
        curves(listOf(query.curves)),
        paths(listOf(query.paths)),
        trajectories(listOf(query.trajectories)),
        multi_dof_trajectories(listOf(query.multi_dof_trajectories)),
        more(query) {}

  /** Curves, paths and trajectories. */
  std::size_t size() const {
    return curves.size() + paths.size() + trajectories.size() + multi_dof_trajectories.size();
  }
};

/** The response that they share. */
struct QueryResponse {
  bool success = true;
  std::string message;
  std::vector<std::string> warnings;
  SceneState scene;
  std::vector<Proximity> results;
  std::vector<DetailMessage> details; /**< of the results; may be shorter: those behind have none */

  /** Adds a row, to be filled. */
  Proximity &add(DetailMessage detail = {}) {
    results.emplace_back();
    if (!std::holds_alternative<std::monostate>(detail)) {
      details.resize(results.size());
      details.back() = std::move(detail);
    }
    return results.back();
  }

  /** The details of all rows, which are of one kind; rows without an answer have an empty one. */
  template <class Message>
  std::vector<Message> takeDetails() {
    details.resize(results.size());
    std::vector<Message> out;
    for (DetailMessage &detail : details) {
      auto *found = std::get_if<Message>(&detail);
      out.push_back(found ? std::move(*found) : Message());
    }
    return out;
  }
};

/** The details, each with its row as its summary. */
template <class Message>
std::vector<Message> takeSummed(QueryResponse &answer) {
  std::vector<Message> out = answer.takeDetails<Message>();
  for (std::size_t i = 0; i < out.size(); ++i) out[i].summary = std::move(answer.results[i]);
  return out;
}
std::vector<SpeedProfile> takeSpeeds(QueryResponse &answer);
std::vector<ViolationIntervals> takeViolations(QueryResponse &answer);

/** What the markers show of a query. */
struct Drawing {
  struct Line {
    CompiledCurve curve;
    std::vector<Answer> answers;
  };
  std::size_t most_lines = 100; /**< no more than a person can tell apart; 0: nobody will look at them */
  std::vector<Line> lines;      /**< of the first curves of the request */
  SnapshotPtr snapshot;
  LinkPoses links; /**< of the last of these curves; without curves those of the motion at its closest moment */

  /** Of the last trajectory of the request; without one of all that moves, or of the last body along a path. */
  struct Motion {
    std::shared_ptr<const RobotMotion> robot; /**< along the trajectory; null: none */
    std::shared_ptr<const Movers> movers;     /**< what moved beside it; null: nothing */
    std::vector<MovingRobot> others;          /**< of these, without `robot` */
    std::optional<ObjectDescription> rider;   /**< of these: the body along a path, which is none of the scene */
    std::vector<Answer> answers;
  } motion;

  bool hasRoom() const {
    return lines.size() < most_lines;
  }
};

/** Answers requests, from any number of threads at once. */
class Queries {
 public:
  /** All but robots and second_opinions are kept by reference. stop: set, it ends running queries with the intervals
   * that they have. */
  Queries(const Parameters &parameters, const Tuning &tuning, const LiveScene &live, const Frames &frames,
          Statistics &statistics, const std::atomic<bool> &stop, FurtherRobots robots = {},
          std::shared_ptr<const SecondOpinions> second_opinions = {})
      : parameters_(parameters),
        tuning_(tuning),
        live_(live),
        frames_(frames),
        statistics_(statistics),
        stop_(stop),
        robots_(std::move(robots)),
        second_opinions_(std::move(second_opinions)) {}

  const FurtherRobots &robots() const {
    return robots_;
  }

  /** Fills the response and the drawing. Throws Error where nothing can be answered at all; what is
   *  wrong with one curve becomes its row. */
  void answer(const QueryRequest &request, QueryResponse &response, Drawing &drawing);

 private:
  struct CurveSearch;

  /* A request on its way: what was asked, of which scene, and what the answer rests on. */
  struct Work {
    const QueryRequest &request;
    const SnapshotPtr snapshot;
    const std::optional<ErrorBounds> errors;
    Query query;
    FrameLookup lookup;
    CurrentJoints joints;
    Doubts doubts;
    QueryResponse &response;
    Drawing &drawing;
    std::unique_ptr<CurveSearch> search; /* null as long as there is no curve */
    std::size_t done = 0;                /* of the request's curves, paths and trajectories */
    std::size_t trajectories = 0;        /* of the robot, so far */
    std::unique_ptr<cprox_certificate, decltype(&cprox_certificate_free)> certificate{
        nullptr, cprox_certificate_free}; /* of the latest row; null: none is asked for */
  };

  std::size_t mostBytes() const; /* that a request may take */
  Query toQuery(const QueryRequest &request, const Snapshot &snapshot) const;
  std::size_t checkLimits(const QueryRequest &request, const Snapshot &snapshot) const; /* bytes */
  void answerAll(const QueryRequest &request, QueryResponse &response, Drawing &drawing);
  void answerCurves(Work &work);
  CurveSearch &curveSearch(Work &work);
  static void answerCurve(const Curve &message, CurveSearch &search, Work &work);
  static void refuseCurve(const std::string &id, const std::string &why, CurveSearch &search, Work &work);
  void answerTrajectories(Work &work);
  void answerMultiDofTrajectories(Work &work);
  void answerFlight(const trajectory_msgs::MultiDOFJointTrajectory &trajectory, Work &work);
  bool carriesBody(const QueryRequest &request) const;
  MovingObject toRider(const ProximityQuery &query, const Snapshot &snapshot, std::vector<TimedPose> poses) const;
  void answerRide(const std::string &id, const std::string &frame, const std::function<PathPoses()> &poses, Work &work);
  struct Moving;
  void answerMoving(const std::string &id, const std::vector<std::string> &kinds, Work &work,
                    const std::function<void(Workspace &, Moving &)> &ask);
  std::string trajectoryName(Work &work) const;
  void answerState(Work &work);
  void answerMovers(Work &work);
  static Query covered(Query query, double joints, bool with_objects, Work &work);
  static void tellProgress(Work &work);
  static std::string numbered(const std::string &name, std::size_t i, std::size_t all); /* the name of one of several */
  using MakeTrajectory = std::function<TrajectoryDescription(std::string &remark)>;
  void answerMotion(const std::string &id, const ros::Time &stamp, const MakeTrajectory &make, Work &work);
  void describe(Work &work) const;

  const Parameters &parameters_;
  const Tuning &tuning_;
  const LiveScene &live_;
  const Frames &frames_;
  Statistics &statistics_;
  const std::atomic<bool> &stop_;
  const FurtherRobots robots_;
  const std::shared_ptr<const SecondOpinions> second_opinions_; /* null: none are asked for */
  WorkspacePool workspaces_;
};

} // namespace curve_proximity
#endif
