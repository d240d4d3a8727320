/* SPDX-License-Identifier: BSD-3-Clause */
/** Which links of a robot can touch each other within the limits of the joints: a proven allowed collision matrix. */
#ifndef CURVE_PROXIMITY_COLLISION_MATRIX_HPP
#define CURVE_PROXIMITY_COLLISION_MATRIX_HPP

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <curve_proximity/robot.hpp>
#include <curve_proximity/scene.hpp>
#include <curve_proximity/srdf.hpp>

namespace curve_proximity {

/** What is known of two links, for all values of the joints within their limits. */
struct LinkContact {
  std::string a;         /**< a link with collision geometry */
  std::string b;         /**< another one */
  bool adjacent = false; /**< at most one joint between them moves, and no link between them has geometry */
  bool rigid = false;    /**< no joint between them moves: they touch always or never */
  cprox_result result{}; /**< of cprox_robot_box_collision(): clear means never, violated that they can touch */
  JointPositions
      posture;         /**< where their distance is result.upper: the joints between them that do not follow others */
  std::string message; /**< why the verdict is undecided; else empty. Of a robot whose geometry was not all read it is
                            never clear */
};

/** "never", "always", "possible" or "undecided". */
const char *contactName(const LinkContact &contact);

/** Asks for all pairs of links. Immutable; shared by any number of threads, each with a workspace of its own. */
class CollisionMatrix {
 public:
  /** The links of the snapshot's robot, without paddings and without what they carry. Continuous joints turn from -pi
   *  to pi. Throws Error: a snapshot without a robot. */
  explicit CollisionMatrix(SnapshotPtr snapshot);
  ~CollisionMatrix();

  /** All pairs of links with collision geometry, sorted by name. */
  const std::vector<std::array<std::string, 2>> &pairs() const;

  /** The answer for pairs()[pair]. options: epsilon, max_nodes, stop and max_lod. Throws Error: a joint of
   *  several values between the two links. */
  LinkContact ask(std::size_t pair, const cprox_options &options, Workspace &workspace) const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

/** A pair of links that an SRDF disables, and why: MoveIt's words are Never, Adjacent, Always, Default and User. */
struct DisabledPair {
  std::array<std::string, 2> links; /**< in any order */
  std::string reason;               /**< as in the file; may be empty */
};

/** The pairs that an SRDF disables, with their reasons, in the order of the file. Throws Error as parseSrdf(). */
std::vector<DisabledPair> disabledPairs(const std::string &srdf_xml);

/** An SRDF with these disabled pairs instead of its own; all else stays. srdf_xml empty: a new SRDF of the robot. */
std::string withDisabledPairs(const std::string &srdf_xml, const std::string &robot,
                              const std::vector<DisabledPair> &pairs);

} // namespace curve_proximity
#endif
