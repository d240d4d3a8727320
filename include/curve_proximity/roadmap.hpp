/* SPDX-License-Identifier: BSD-3-Clause */
/** Many straight motions between postures, the edges of a roadmap, in one scene after the other. */
#ifndef CURVE_PROXIMITY_ROADMAP_HPP
#define CURVE_PROXIMITY_ROADMAP_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <curve_proximity/coverage.hpp>
#include <curve_proximity/motion.hpp>
#include <curve_proximity/parallel.hpp>

namespace curve_proximity {

/** Postures, and which of them are joined by straight motions in the space of the joints. */
struct Roadmap {
  std::vector<std::string> joints;                 /**< those that move; others are at rest */
  Eigen::MatrixXd vertices;                        /**< [rad], [m] a posture a column, a joint a row */
  std::vector<std::array<std::uint32_t, 2>> edges; /**< the columns of both ends, which may be one */
  JointPositions rest;                             /**< of the other joints */
  /** Continuous joints turn the shorter way along an edge; otherwise as their values say: from 3.1 to -3.1 by 6.2. */
  bool shortest_way = false;
};

/** Straight motions whose ends stand in the caller's memory, which is not copied. */
struct EdgeList {
  /** No edges, until all members have their values. */
  EdgeList() = default;

  /** The edges of a roadmap, which must outlive the list. Throws Error where its joints are not its rows. */
  EdgeList(const Roadmap &roadmap); // NOLINT(google-explicit-constructor)

  std::vector<std::string> joints;                    /**< as of a Roadmap */
  JointPositions rest;                                /**< likewise */
  bool shortest_way = false;                          /**< likewise */
  const double *from = nullptr;                       /**< [rad], [m] n_rows rows of a value for each joint */
  const double *to = nullptr;                         /**< likewise; of a roadmap both are its vertices */
  std::size_t n_rows = 0;                             /**< of `from`, and of `to` */
  const std::array<std::uint32_t, 2> *ends = nullptr; /**< the rows of both ends; nullptr: edge i has row i of each */
  std::size_t n = 0;                                  /**< edges; without ends n_rows */
};

/** A warning for each continuous joint that turns by more than half a turn on the first edge that has one; none with
 *  shortest_way. As longWays() of a trajectory. */
std::vector<std::string> longWays(const Robot &robot, const EdgeList &edges);

/** Is the robot farther than query.delta from the objects, from itself, or from both, everywhere on each edge? As
 *  askEnvironment() and askSelf() answer for the edge as a motion of its own.
 *
 *  robot    prepared in a scene; all threads share it.
 *  edges    names that the robot does not have, a vertex that is not there, numbers that are not finite are an Error
 *           that names them. A Roadmap is such a list.
 *  query    TOLERANCE or COLLISION; no per_object, no certificate.
 *  known    empty, or a verdict for each edge: one that is not CPROX_VERDICT_CLEAR is kept and not asked again. So the
 *           answers for the robot itself, which are the same in all scenes, are found once and handed to each.
 *
 *  Returns a verdict for each edge; what could not be decided within epsilon or the budget is undecided. Cost: some
 *  microseconds an edge by cprox_robot_edges(), which decides most; a motion for each other one; memory: a few bytes an
 *  edge. */
std::vector<cprox_verdict> edgeVerdicts(const PreparedRobot &robot, const EdgeList &edges, RobotPairs against,
                                        const Query &query, const std::vector<cprox_verdict> &known, Pool &pool);

/** Straight motions that come one at a time, as a planner asks: all that edgeVerdicts() prepares, kept. Immutable: any
 *  number of threads may use it, each with its own workspace. */
class EdgeChecker {
 public:
  /** joints   those that move: an edge has a value for each; others are at `rest`.
   *  against  the objects, the robot itself, or both in one verdict.
   *  query    TOLERANCE or COLLISION; no per_object, no certificate, no signed distance: these are an Error. */
  EdgeChecker(const PreparedRobot &robot, const std::vector<std::string> &joints, const JointPositions &rest,
              RobotPairs against, const Query &query);
  ~EdgeChecker();
  /** The one that was moved from can only be destroyed or assigned to. */
  EdgeChecker(EdgeChecker &&) noexcept;
  /** Likewise. */
  EdgeChecker &operator=(EdgeChecker &&) noexcept;

  /** The verdict of from + t (to - from), t in [0, 1]; an edge with from = to is a state. Both have a finite value for
   *  each joint. All pairs count, those too that this edge does not move. Undecided: within epsilon, out of budget, or
   *  not covered. Cost: some microseconds. */
  cprox_verdict ask(const double *from, const double *to, Workspace &workspace) const;

  /** What verdicts do not cover: none is `clear` unless it is complete. */
  const Coverage &coverage() const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

} // namespace curve_proximity
#endif
