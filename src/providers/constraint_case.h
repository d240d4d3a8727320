/* SPDX-License-Identifier: BSD-3-Clause */
/** One case of a request for constraints, from its description to its answers: beneath the service and the command
 * line. */
#ifndef CURVE_PROXIMITY_PROVIDERS_CONSTRAINT_CASE_H
#define CURVE_PROXIMITY_PROVIDERS_CONSTRAINT_CASE_H

#include <curve_proximity/constraint_provider.hpp>
#include <curve_proximity/coverage.hpp>
#include <curve_proximity/geometry.hpp>
#include <curve_proximity/scene.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "provider_set.h"

namespace curve_proximity {

/** The scene's robot along a trajectory. */
struct MotionCase {
  std::shared_ptr<const PreparedRobot> robot;
  TrajectoryDescription trajectory;
  JointPositions rest;                   /**< of joints that the trajectory does not name */
  std::vector<MovingRobot> other_robots; /**< that move at the same time; objects that do are those of the scene */
  std::int64_t origin = 0;               /**< [ns] when the trajectory begins, on the clock of the objects' stamps */

  bool isAmongMovers() const {
    return !other_robots.empty() || !robot->snapshot()->moving().empty();
  }
};

/** What is asked, all poses in the fixed frame. */
struct ConstraintCase {
  std::string id;
  std::vector<std::string> providers;                      /**< by name; none: every one that applies */
  ObjectDescription a, b;                                  /**< shapes, pose, padding */
  std::optional<ResourceOptions> resources_a, resources_b; /**< where its mesh files are, if not where all are */
  std::optional<CurveDescription> curve;                   /**< a rides it; a may then have no shape */
  std::optional<MotionCase> motion;                        /**< this, and neither a, b nor curve */
  bool (*stop)(void *user) = nullptr;                      /**< as ConstraintMotion::stop */
  void *stop_user = nullptr;
  Coverage coverage; /**< what of its source is not used; those of a motion's scene, robot and trajectory come to it */
};

/** A side that is named. */
struct ConstraintSide {
  ObjectDescription object;
  std::optional<ResourceOptions> resources; /**< of a link: where its mesh files are */
  bool is_on_robot = false;                 /**< a link, or what one carries: its pose is that of the link */
};

/** Where a link is. May throw Error. */
using LinkPlaces = std::function<Eigen::Isometry3d(const std::string &link)>;

/** The object of the scene with that name, at its pose; else what a link carries, or the link, with padding and scale
 *  of the link. Throws Error: there is none; a link without geometry. */
ConstraintSide sideOf(const Snapshot &scene, const std::string &id, const LinkPlaces &places);

/** One provider's answer. */
struct ConstraintRow {
  std::string id, provider;
  cprox_status status = CPROX_INVALID; /**< negative: no answer, and message says why */
  std::string message;
  std::optional<Gap> gap;                       /**< the row does not cover all that was given: it has no bounds */
  ConstraintValue value;                        /**< of a trajectory: its nearest row, and the least of all values */
  std::optional<MotionValue> motion;            /**< of a trajectory */
  double microseconds = 0.0;                    /**< of the evaluation */
  std::shared_ptr<const Constraint> constraint; /**< the pair made ready; null where it could not be */
};

/** gapName(gap) if there is a gap, else the name of the status. */
const char *statusName(const ConstraintRow &row);

/** A row for each provider that the case names, in that order. Never throws but for memory. */
std::vector<ConstraintRow> answerCase(ProviderSet &providers, const ConstraintCase &asked,
                                      const ResourceOptions &resources, Workspace &workspace);

/** The geometry of a side's shape. Unlike makeGeometry() it takes outlines that are not convex, by triangles, and
 * refuses octrees without an occupied cell. */
Geometry sideGeometry(const ShapeDescription &shape, const ResourceOptions &resources);

/** A row that says why a case could not even be asked about. */
ConstraintRow failedRow(const std::string &id, const std::string &why, cprox_status status = CPROX_INVALID);

} // namespace curve_proximity
#endif
