/* SPDX-License-Identifier: BSD-3-Clause */
/* The soft minimum of RobotDistance: between the least row and its stated error, and its gradient against differences.
 */
#include <cmath>
#include <curve_proximity/motion.hpp>
#include <curve_proximity/scene.hpp>

#include "support.h"

using namespace curve_proximity;

namespace {

constexpr const char *SLIDER = R"(<robot name="slider">
  <link name="base"/>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="tool"/><axis xyz="0 0 1"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
  <link name="tool"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
</robot>)";

constexpr double HORIZON = 0.6, SMOOTHING = 0.05, MARGIN = 0.1;

/* A ball of 0.1 at height q between a floor at 0 and a ceiling at 2, in each of two intervals. */
MotionValue evaluate(const ConstraintProvider &provider, const std::vector<double> &heights) {
  Scene scene(Robot::fromUrdf(SLIDER));
  SceneChange plates;
  for (const double height : {-0.1, 2.1}) {
    Operation operation;
    operation.object.id = height < 0.0 ? "floor" : "ceiling";
    operation.object.shapes = {shape(ShapeType::BOX, {2, 2, 0.2})};
    operation.object.pose.translation().z() = height;
    plates.operations.push_back(operation);
  }
  EXPECT_TRUE(scene.apply(plates).empty());
  const PreparedRobot robot(scene.snapshot(), {});
  TrajectoryDescription trajectory;
  trajectory.joints = {"lift"};
  for (std::size_t i = 0; i < heights.size(); ++i) {
    TrajectoryPoint point;
    point.time = static_cast<double>(i);
    point.positions = {heights[i]};
    trajectory.points.push_back(point);
  }
  const RobotMotion motion(robot, trajectory);
  Workspace workspace;
  MotionValue value;
  provider.prepareMotion(robot)->evaluate({trajectory, motion}, workspace, value);
  return value;
}

ParameterMap parameters(double smoothing) {
  ParameterMap out = {{"horizon", HORIZON}, {"margin", MARGIN}, {"per_pair", 100}};
  if (smoothing > 0.0) out["smoothing"] = smoothing;
  return out;
}

} // namespace

TEST(SoftMinimum, is_below_the_least_row_by_no_more_than_stated) {
  const Loaded hard("curve_proximity/RobotDistance", parameters(0.0)),
      soft("curve_proximity/RobotDistance", parameters(SMOOTHING));
  const double above = -std::log(1.0 - std::exp(-1.0));
  std::size_t compared = 0;
  for (const std::vector<double> &heights : {std::vector<double>{0.5, 1.6, 0.3}, {0.4, 1.75, 0.65}, {1.0, 1.0, 1.0}}) {
    const MotionValue rows = evaluate(*hard.provider(), heights), one = evaluate(*soft.provider(), heights);
    double sum = 1.0;
    for (const MotionRow &row : rows.rows) {
      const double x = (HORIZON - MARGIN - row.value) / SMOOTHING;
      sum += std::exp(x) - 1.0 - x;
    }
    const double n = static_cast<double>(std::max<std::size_t>(1, rows.rows.size()));
    EXPECT_NEAR(one.value, HORIZON - MARGIN - SMOOTHING * (std::log(sum) + above), 1e-12);
    EXPECT_LE(one.value, rows.value + 1e-12);
    EXPECT_GE(one.value, rows.value - SMOOTHING * (std::log(n) + above) - 1e-12);
    EXPECT_TRUE(one.lower <= one.value && one.value <= one.upper);
    EXPECT_EQ(one.rows.size(), rows.rows.empty() ? 0u : 1u);
    for (std::size_t i = 0; i < heights.size() && !one.rows.empty(); ++i) {
      constexpr double STEP = 1e-4;
      std::vector<double> moved = heights;
      moved[i] += STEP;
      const double ahead = evaluate(*soft.provider(), moved).value;
      moved[i] -= 2.0 * STEP;
      const double slope = (ahead - evaluate(*soft.provider(), moved).value) / (2.0 * STEP);
      EXPECT_NEAR(one.rows.front().positions(static_cast<Eigen::Index>(i), 0), slope, 1e-4);
      ++compared;
    }
  }
  EXPECT_EQ(compared, 6u);
}

TEST(SoftMinimum, needs_a_horizon) {
  const ParameterMap alone = {{"smoothing", SMOOTHING}};
  EXPECT_THROW(Loaded("curve_proximity/RobotDistance", alone), Error);
}
