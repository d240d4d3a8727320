/* SPDX-License-Identifier: BSD-3-Clause */
/** Two bodies, as the command line and the node are asked about them. */
#ifndef CURVE_PROXIMITY_SCENE_PAIR_QUERY_H
#define CURVE_PROXIMITY_SCENE_PAIR_QUERY_H

#include <optional>
#include <string>

#include <curve_proximity/query.hpp>

namespace curve_proximity {

/** A body as written: its shape in its own frame (shape.pose is not used), and where it stands. The pose is kept as it
 * was written, for a quaternion that goes through a matrix does not come back the same to the last bit. */
struct PlacedBody {
  ShapeDescription shape;
  cprox_pose pose = CPROX_POSE_IDENTITY;
};

struct PairDescription {
  /** DISTANCE: signed, of bodies that stand; GROWTH: the factor at which they touch; the others: bodies that translate
   */
  enum Asked { DISTANCE, GROWTH, TRANSLATING_DISTANCE, TRANSLATING_CONTACT } asked = DISTANCE;
  std::string id;
  PlacedBody a, b;
  Eigen::Vector3d velocity_a = Eigen::Vector3d::Zero(), velocity_b = Eigen::Vector3d::Zero(); /**< [m/s] */
  double duration = 0.0;                                                                      /**< [s] */
};

/** "distance", "growth", "translating_distance", "translating_contact"; also of "" DISTANCE, nothing of another word.
 */
std::optional<PairDescription::Asked> pairQuestion(const std::string &name);

/** The kind of its row: "pair", or its name. */
const char *pairKind(PairDescription::Asked asked);

/** Do bodies move in it? */
bool isTranslating(PairDescription::Asked asked);

/** The answer: id and both sides have the pair's id; of GROWTH lower and upper alone are set. Throws Error where there
 *  is none. */
Answer askPair(const PairDescription &pair, const Query &query, const ResourceOptions &resources, Workspace &workspace);

} // namespace curve_proximity
#endif
