/* SPDX-License-Identifier: BSD-3-Clause */
/** PAIRS.yaml: a list of {id, a: BODY, b: BODY}, and what is asked of them. */
#ifndef CURVE_PROXIMITY_CLI_PAIRS_YAML_H
#define CURVE_PROXIMITY_CLI_PAIRS_YAML_H

#include <string>
#include <vector>

#include <curve_proximity/core.hpp>
#include <curve_proximity/description.hpp>

#include "../scene/yaml/yaml_value.h"
#include "failure.h"

namespace curve_proximity::cli {

/** A body as written: its shape in its own frame (shape.pose is not used), and where it stands. The pose is kept as it
 * was written, for a quaternion that goes through a matrix does not come back the same to the last bit. */
struct PlacedShape {
  ShapeDescription shape;
  cprox_pose pose = CPROX_POSE_IDENTITY;
};

struct PairDescription {
  /** DISTANCE: signed, of bodies that stand; GROWTH: the factor at which they touch; the others: bodies that translate
   */
  enum Asked { DISTANCE, GROWTH, TRANSLATING_DISTANCE, TRANSLATING_CONTACT } asked = DISTANCE;
  std::string id;
  PlacedShape a, b;
  Eigen::Vector3d velocity_a = Eigen::Vector3d::Zero(), velocity_b = Eigen::Vector3d::Zero(); /**< [m/s] */
  double duration = 0.0;                                                                      /**< [s] */
};

/** The entries of the list, each still as YAML. Throws BadUsage where the file is no list. */
std::vector<YamlValue> readPairs(const std::string &path);

/** The id of an entry, "" where it has none. Never throws. */
std::string pairId(const YamlValue &entry);

/** One entry. Throws BadInput with what is wrong, and where. */
PairDescription parsePair(const YamlValue &entry, Warnings &warnings);

} // namespace curve_proximity::cli
#endif
