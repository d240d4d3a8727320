/* SPDX-License-Identifier: BSD-3-Clause */
/* The gradient of a curve's clearance, by its control points and by what it is near. */
#include <curve_proximity/query.hpp>

#include "answering.h"
#include "scene_obstacles.h"

namespace curve_proximity {
namespace {

/* By what defines the curve, and by the curve as a whole: its point at t changes by them, and the clearance by n for
 * that point. */
void fillCurve(const CurveDescription &curve, const cprox_gradient &in, CurveGradient &out) {
  const Eigen::Vector3d n = toEigen(in.mover);
  out.linear = n;
  gradientByCurve(curve, in.t, n, out.points, out.parameters);
  out.range_start = in.t0, out.range_end = in.t1;
}

/* The core turns an obstacle about its own position, we the object about its origin. */
void fillObject(const SceneObstacles &obstacles, const Item &item, const cprox_gradient &in, CurveGradient &out) {
  if (item.is_link) return;
  const Eigen::Vector3d origin = obstacles.data().snapshot->objects().at(*item.owner)->description.pose.translation();
  out.object_linear = toEigen(in.position);
  out.object_angular =
      toEigen(in.rotation) + (toEigen(item.shape->obstacle.pose.position) - origin).cross(out.object_linear);
}

/* Whether a second shape is as near as the nearest, as far as intervals tell: then the least of both has no gradient.
 */
std::string tieOf(const SceneObstacles &obstacles, const CompiledCurve &curve, const Answer &answer, const Query &query,
                  Workspace &workspace) {
  if (obstacles.data().items.size() < 2) return "";
  const PairLimits two{2, answer.result.upper};
  const std::vector<Answer> nearest = nearestPairs(obstacles, curve, two, query, workspace);
  if (!nearest.empty() && nearest.back().is_unlisted) return "the search ended before all that is as near was found";
  return nearest.size() < 2 ? "" : "'" + nearest[0].b + "' and '" + nearest[1].b + "' are equally near";
}

} // namespace

CurveClearance clearanceGradient(const SceneObstacles &obstacles, const CompiledCurve &curve,
                                 const CurveDescription &description, const Query &query, Workspace &workspace) {
  if (query.per_object) throw Error("per_object does not apply: there is one gradient a curve");
  if (query.query_type != QueryType::DISTANCE) throw Error("a gradient is that of a distance");
  CurveClearance out;
  out.answer = ask(obstacles, curve, query, workspace).front();
  CurveGradient &gradient = out.gradient;
  const std::int32_t nearest = coreObstacleOf(obstacles, out.answer);
  if (out.answer.result.status < 0) {
    gradient.reason = out.answer.message;
  } else if (nearest < 0) {
    gradient.reason = "there is nothing to measure against";
  } else {
    const Item &item = obstacles.data().items[static_cast<std::size_t>(nearest)];
    const cprox_mover mover = moverOf(curve);
    cprox_result result{};
    cprox_gradient found{};
    cprox_status status = cprox_distance(mover, item.shape->obstacle, &query.options, workspace.get(), &result);
    if (status >= 0)
      status = cprox_distance_gradient(mover, item.shape->obstacle, &query.options, &result, workspace.get(), &found);
    if (status < 0) {
      gradient.reason = workspace.reason();
      return out;
    }
    gradient.valid = found.valid;
    if (!found.valid) gradient.reason = workspace.reason();
    gradient.t = found.t;
    gradient.radius = found.radius;
    fillCurve(description, found, gradient);
    gradient.angular = toEigen(result.witness_mover).cross(gradient.linear); // the radius lies along it
    fillObject(obstacles, item, found, gradient);
    const std::string tie = tieOf(obstacles, curve, out.answer, query, workspace);
    if (!tie.empty()) gradient.valid = false, gradient.reason = tie;
  }
  applyGap(out.answer, gradient);
  return out;
}

} // namespace curve_proximity
