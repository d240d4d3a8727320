/* SPDX-License-Identifier: BSD-3-Clause */
/* GrowthDistance of a robot along its trajectory: its bounds against growth distances at single times, its gradient
 * against central differences. */
#include <algorithm>
#include <cmath>
#include <curve_proximity/core.hpp>
#include <curve_proximity/motion.hpp>
#include <curve_proximity/scene.hpp>
#include <limits>

#include "support.h"

using namespace curve_proximity;

namespace {

constexpr const char *ARM = R"(<robot name="arm">
  <link name="base"/>
  <link name="upper"><collision><origin xyz="0.3 0 0"/><geometry><box size="0.6 0.1 0.1"/></geometry></collision></link>
  <link name="fore"><collision><origin xyz="0.2 0 0" rpy="0 1.5707963 0"/><geometry><cylinder length="0.4" radius="0.04"/></geometry></collision></link>
  <link name="hand"><collision><geometry><sphere radius="0.07"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.3"/>
    <axis xyz="0 0.6 0.8"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="0.6 0 0"/>
    <axis xyz="0.3 1 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="slide" type="prismatic"><parent link="fore"/><child link="hand"/><origin xyz="0.4 0 0"/>
    <axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>)";

const std::vector<std::string> JOINTS = {"shoulder", "elbow", "slide"};

/* The arm among a box and an ellipsoid somewhere near. */
struct Cell {
  explicit Cell(Random &random, const ShapeDescription &first = shape(ShapeType::BOX, {0.3, 0.2, 0.4}))
      : scene(Robot::fromUrdf(ARM)) {
    SceneChange change;
    const std::vector<ShapeDescription> shapes = {first, shape(ShapeType::ELLIPSOID, {0.3, 0.15, 0.2})};
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      Operation operation;
      operation.object.id = i == 0 ? "first" : "second";
      operation.object.shapes = {shapes[i]};
      operation.object.pose = Eigen::Translation3d(random.inCube(0.7)) * random.rotation();
      change.operations.push_back(operation);
    }
    EXPECT_TRUE(scene.apply(change).empty());
    robot = std::make_unique<PreparedRobot>(scene.snapshot());
    for (int i = 0; i < 3; ++i) {
      TrajectoryPoint point;
      point.time = 0.8 * i;
      for (std::size_t k = 0; k < JOINTS.size(); ++k) {
        point.positions.push_back(random.uniform(-1.0, 1.0) * (k == 2 ? 0.1 : 1.0));
        point.velocities.push_back(random.uniform(-0.5, 0.5) * (k == 2 ? 0.1 : 1.0));
      }
      trajectory.points.push_back(point);
    }
    trajectory.joints = JOINTS;
  }

  MotionValue evaluate(const ConstraintProvider &provider) const {
    const RobotMotion motion(*robot, trajectory);
    Workspace workspace;
    MotionValue value;
    provider.prepareMotion(*robot)->evaluate({trajectory, motion}, workspace, value);
    return value;
  }

  /* The least growth distance of links and objects at one time. */
  double leastAt(double t) const {
    const RobotMotion motion(*robot, trajectory);
    const LinkPoses poses = motion.linkPoses(t);
    Workspace workspace;
    double least = std::numeric_limits<double>::infinity();
    for (const char *link : {"upper", "fore", "hand"}) {
      for (const LinkGeometry &part : scene.snapshot()->linkGeometry(link)) {
        const Geometry body = makeGeometry(part.description);
        for (const auto &[id, object] : scene.snapshot()->objects()) {
          const Geometry other = makeGeometry(object->description.shapes.front());
          const auto at = [](const Eigen::Isometry3d &pose) {
            const Eigen::Quaterniond q(pose.linear());
            return cprox_pose{toVec3(pose.translation()), {q.w(), q.x(), q.y(), q.z()}};
          };
          const cprox_growth growth = growthDistance(cprox_obstacle_at(body.body.get(), at(poses.at(link) * part.pose)),
                                                     cprox_obstacle_at(other.body.get(), at(object->description.pose)),
                                                     CPROX_OPTIONS_DEFAULT, workspace);
          least = std::min(least, 0.5 * (growth.lower + growth.upper));
        }
      }
    }
    return least;
  }

  Scene scene;
  std::unique_ptr<PreparedRobot> robot;
  TrajectoryDescription trajectory;
};

} // namespace

/* Seed 91, 15 arms: the value is attained at the row's time and no time of 200 is below `lower`. 1e-5 of it: the
 * default epsilon of the reference is 1e-6. */
TEST(GrowthMotion, bounds_the_growth_distance_at_every_time) {
  Random random(91);
  const Loaded growth("curve_proximity/GrowthDistance", {{"against", std::string("environment")}});
  int in_contact = 0;
  for (int i = 0; i < 15; ++i) {
    const Cell cell(random);
    const MotionValue value = cell.evaluate(*growth.provider());
    ASSERT_EQ(value.rows.size(), 1u);
    ASSERT_TRUE(value.bounded);
    EXPECT_LE(value.upper - value.lower, 1e-8 * (1.0 + value.upper));
    EXPECT_NEAR(cell.leastAt(value.rows.front().t), 1.0 + value.value, 1e-5 * (2.0 + value.value));
    for (int k = 0; k <= 200; ++k) EXPECT_GE(cell.leastAt(1.6 * k / 200), (1.0 + value.lower) * (1.0 - 1e-5));
    in_contact += value.value < 0.0;
  }
  EXPECT_GE(in_contact, 3);
}

/* Seed 92, 30 arms against objects, a third of them also against themselves: every derivative by positions, velocities and the duration is the
 * central difference of the value, deep in contact as well (1e-5). */
TEST(GrowthMotion, has_the_gradient_of_its_value) {
  Random random(92);
  const Loaded whole("curve_proximity/GrowthDistance", {}),
      environment("curve_proximity/GrowthDistance", {{"against", std::string("environment")}});
  int valid = 0, deep = 0;
  for (int i = 0; i < 30; ++i) {
    const Loaded &growth = i % 3 ? environment : whole;
    Cell cell(random);
    const MotionValue value = cell.evaluate(*growth.provider());
    const MotionRow &row = value.rows.front();
    if (!row.valid) continue;
    ++valid, deep += value.value < -0.2;
    const auto difference = [&](double &number) {
      double best = std::numeric_limits<double>::infinity(), slope = 0.0;
      const double here = number;
      for (const double h : {1e-3, 1e-4}) {
        number = here + h;
        const double ahead = cell.evaluate(*growth.provider()).value;
        number = here - h;
        const double behind = cell.evaluate(*growth.provider()).value;
        if (std::abs(ahead - 2.0 * value.value + behind) / h < best) {
          best = std::abs(ahead - 2.0 * value.value + behind) / h;
          slope = (ahead - behind) / (2.0 * h);
        }
      }
      number = here;
      return slope;
    };
    for (Eigen::Index p = 0; p < 3; ++p) {
      TrajectoryPoint &point = cell.trajectory.points[static_cast<std::size_t>(p)];
      for (Eigen::Index k = 0; k < 3; ++k) {
        EXPECT_NEAR(row.positions(p, k), difference(point.positions[static_cast<std::size_t>(k)]), 2e-5) << i;
        EXPECT_NEAR(row.velocities(p, k), difference(point.velocities[static_cast<std::size_t>(k)]), 2e-5) << i;
      }
    }
  }
  EXPECT_GE(valid, 24);
  EXPECT_GE(deep, 4);
}

TEST(GrowthMotion, takes_meshes_by_their_hulls_where_it_is_asked_to) {
  Random random(93);
  ShapeDescription mesh;
  mesh.type = ShapeType::MESH;
  mesh.vertices.resize(3, 4);
  mesh.vertices << 0.2, 0.2, -0.2, -0.2, 0.2, -0.2, 0.2, -0.2, 0.2, -0.2, -0.2, 0.2;
  mesh.triangles.resize(3, 4);
  mesh.triangles << 0, 0, 0, 1, 2, 1, 3, 2, 1, 3, 2, 3;
  const Cell cell(random, mesh);
  const Loaded exact("curve_proximity/GrowthDistance", {}),
      hull("curve_proximity/GrowthDistance", {{"meshes", std::string("hull")}});
  try {
    cell.evaluate(*exact.provider());
    FAIL();
  } catch (const Error &error) {
    EXPECT_STREQ(error.what(), "'first' is a mesh, which has no growth distance: ask about its hull (max_lod)");
  }
  EXPECT_EQ(cell.evaluate(*hull.provider()).rows.size(), 1u);
}

TEST(GrowthMotion, waits_to_be_named) {
  Random random(94);
  const Cell cell(random);
  const Loaded growth("curve_proximity/GrowthDistance", {});
  const RobotMotion motion(*cell.robot, cell.trajectory);
  ConstraintMotion asked{cell.trajectory, motion};
  asked.is_named = false;
  Workspace workspace;
  MotionValue value;
  EXPECT_THROW(growth->prepareMotion(*cell.robot)->evaluate(asked, workspace, value), DoesNotApply);
  const Loaded smooth("curve_proximity/GrowthDistance", {{"smoothing", 0.01}});
  EXPECT_THROW(smooth->prepareMotion(*cell.robot), Error);
}
