/* SPDX-License-Identifier: BSD-3-Clause */
/* Gradients and rows of a robot's clearance along a trajectory, against central differences and single queries. */
#include <curve_proximity/motion.hpp>

#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace {

const std::vector<std::string> JOINTS = {"panda_joint1", "panda_joint2",        "panda_joint3",
                                         "panda_joint4", "panda_joint5",        "panda_joint6",
                                         "panda_joint7", "panda_finger_joint1", "panda_finger_joint2"};

std::shared_ptr<const Robot> panda() {
  static const std::shared_ptr<const Robot> robot = dataRobot("panda");
  return robot;
}

const Srdf &pandaSrdf() {
  static const Srdf srdf = parseSrdf(readText(TEST_DATA_DIR "/robots/panda/panda.srdf"));
  return srdf;
}

/* A Panda beside a box and a capsule at poses of their own; each shape stands beside its object's origin. */
struct Objects {
  Eigen::Isometry3d box = translation(0.7, 0.5, 0.6), capsule = translation(0.2, -0.8, 0.9);
};

SnapshotPtr snapshotOf(const Objects &objects) {
  Scene out(panda(), {}, allowedPairs(pandaSrdf()));
  EXPECT_TRUE(
      out
          .apply(change(
              {add("box", {shape(ShapeType::BOX, {0.2, 0.3, 0.4}, translation(0.1, 0.2, 0.0))}, objects.box, 0.01),
               add("capsule", {shape(ShapeType::CAPSULE, {0.3, 0.1}, translation(0.0, 0.1, 0.1))}, objects.capsule)}))
          .empty());
  return out.snapshot();
}

PreparedRobot prepared(const Objects &objects = Objects(),
                       const Eigen::Isometry3d &base = Eigen::Isometry3d::Identity()) {
  return PreparedRobot(snapshotOf(objects), pandaSrdf().disabled, {}, {}, base);
}

/* A few points with as many derivatives as wanted, the fingers among the joints: one of them follows the other. */
TrajectoryDescription randomTrajectory(Random &random, int derivatives, std::size_t n_points = 4) {
  TrajectoryDescription out;
  out.id = "random";
  out.joints = JOINTS;
  for (std::size_t i = 0; i < n_points; ++i) {
    TrajectoryPoint point;
    point.time = static_cast<double>(i) * 0.7;
    for (const double middle : {0.0, 0.0, 0.0, -1.5, 0.0, 1.8, 0.8, 0.02, 0.02}) {
      const double size = middle == 0.02 ? 0.01 : 0.8;
      point.positions.push_back(middle + random.uniform(-size, size));
      if (derivatives > 0) point.velocities.push_back(random.uniform(-size, size));
      if (derivatives > 1) point.accelerations.push_back(random.uniform(-size, size));
    }
    out.points.push_back(std::move(point));
  }
  return out;
}

Query fineQuery() {
  Query query;
  query.options.epsilon = 1e-10;
  return query;
}

double distanceOf(const RobotMotion &motion, RobotPairs against, Workspace &workspace) {
  const Query query = fineQuery();
  double out = INFINITY;
  if (against != RobotPairs::SELF) out = askEnvironment(motion, query, workspace).front().result.upper;
  if (against != RobotPairs::ENVIRONMENT) out = std::min(out, askSelf(motion, query, workspace).result.upper);
  return out;
}

/* Distances are known to 1e-10: that is 5e-7 of a slope. */
constexpr double STEP = 2e-4;
/* What differences tell beside that: a third derivative of some ten times the step's square. */
constexpr double MISFIT = 5e-6;

/* The slope of a function at 0. */
template <class Function>
double slopeOf(const Function &function) {
  return (function(STEP) - function(-STEP)) / (2.0 * STEP);
}

/* The same; NaN where the slope at half the step is another one, since within a step another pair is nearer. */
template <class Function>
double smoothSlopeOf(const Function &function) {
  const double slope = slopeOf(function), half = slopeOf([&](double step) { return 2.0 * function(0.5 * step); });
  return std::fabs(slope - half) < MISFIT ? slope : NAN;
}

using List = std::vector<double> TrajectoryPoint::*;

/* The matrix of derivatives by one list of numbers of all points, by differences. */
Eigen::MatrixXd differences(const PreparedRobot &robot, const TrajectoryDescription &trajectory, RobotPairs against,
                            List list, Workspace &workspace) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(trajectory.points.size()),
                                              static_cast<Eigen::Index>(trajectory.joints.size()));
  for (std::size_t i = 0; i < trajectory.points.size(); ++i)
    for (std::size_t k = 0; k < trajectory.joints.size(); ++k)
      out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = slopeOf([&](double step) {
        TrajectoryDescription moved = trajectory;
        (moved.points[i].*list)[k] += step;
        return distanceOf(RobotMotion(robot, moved), against, workspace);
      });
  return out;
}

/* The same of a rigid step of something: linear, then angular. */
template <class Function>
Eigen::Matrix<double, 6, 1> rigidDifferences(const Function &distance) {
  Eigen::Matrix<double, 6, 1> out;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis);
    out[axis] = smoothSlopeOf([&](double step) { return distance(step * unit, Eigen::Matrix3d::Identity()); });
    out[3 + axis] = smoothSlopeOf([&](double step) {
      return distance(Eigen::Vector3d::Zero(), Eigen::AngleAxisd(step, unit).toRotationMatrix());
    });
  }
  return out;
}

Eigen::Matrix<double, 6, 1> joined(const Eigen::Vector3d &linear, const Eigen::Vector3d &angular) {
  Eigen::Matrix<double, 6, 1> out;
  out << linear, angular;
  return out;
}

double largest(const Eigen::MatrixXd &matrix) {
  return matrix.size() == 0 ? 0.0 : matrix.cwiseAbs().maxCoeff();
}

/* How much a gradient is off, where differences tell; those are counted. */
double misfitOf(const Eigen::Matrix<double, 6, 1> &gradient, const Eigen::Matrix<double, 6, 1> &differences,
                int &told) {
  double most = 0.0;
  for (int i = 0; i < 6; ++i) {
    if (std::isnan(differences[i])) continue;
    ++told;
    most = std::max(most, std::fabs(gradient[i] - differences[i]));
  }
  return most;
}

} // namespace

/* 9 trajectories (seed 81): linear, cubic and quintic, against the objects, the robot and both. */
TEST(MotionGradient, is_that_of_differences_by_points_velocities_and_accelerations) {
  Random random(81);
  const PreparedRobot robot = prepared();
  Workspace workspace;
  int valid = 0;
  for (int i = 0; i < 9; ++i) {
    const RobotPairs against = static_cast<RobotPairs>(i % 3);
    const TrajectoryDescription trajectory = randomTrajectory(random, i / 3, i < 3 ? 3 : 2);
    const auto n_points = static_cast<Eigen::Index>(trajectory.points.size());
    const RobotMotion motion(robot, trajectory);
    const ClearanceRow row = clearanceGradient(motion, against, fineQuery(), workspace);
    const double distance = distanceOf(motion, against, workspace);
    EXPECT_LE(row.answer.result.lower, distance);
    EXPECT_NEAR(row.answer.result.upper, distance, 1e-9);
    EXPECT_EQ(row.gradient.velocities.rows(), i / 3 > 0 ? n_points : 0);
    EXPECT_EQ(row.gradient.accelerations.rows(), i / 3 > 1 ? n_points : 0);
    EXPECT_EQ(row.gradient.positions.rows(), n_points);
    EXPECT_EQ(row.gradient.positions.cols(), 9);
    EXPECT_TRUE(row.gradient.valid || !row.gradient.reason.empty());
    if (!row.gradient.valid) continue;
    ++valid;
    const auto misfit = [&](const Eigen::MatrixXd &gradient, List list) {
      return largest(gradient - differences(robot, trajectory, against, list, workspace));
    };
    EXPECT_LT(misfit(row.gradient.positions, &TrajectoryPoint::positions), MISFIT) << i;
    EXPECT_EQ(largest(row.gradient.positions.col(8)), 0.0); // it follows the other finger
    if (i / 3 > 0) {
      EXPECT_LT(misfit(row.gradient.velocities, &TrajectoryPoint::velocities), MISFIT) << i;
    }
    if (i / 3 > 1) {
      EXPECT_LT(misfit(row.gradient.accelerations, &TrajectoryPoint::accelerations), MISFIT) << i;
    }
  }
  EXPECT_GE(valid, 6);
}

/* 5 cubic trajectories (seed 82). */
TEST(MotionGradient, is_that_of_differences_by_the_duration_the_base_and_the_object) {
  Random random(82);
  Workspace workspace;
  int valid = 0, told = 0;
  for (int i = 0; i < 5; ++i) {
    const TrajectoryDescription trajectory = randomTrajectory(random, 1, 3);
    const ClearanceRow row =
        clearanceGradient(RobotMotion(prepared(), trajectory), RobotPairs::ENVIRONMENT, fineQuery(), workspace);
    if (!row.gradient.valid) continue;
    ++valid;
    const auto distance = [&](const PreparedRobot &robot, const TrajectoryDescription &moved) {
      return distanceOf(RobotMotion(robot, moved), RobotPairs::ENVIRONMENT, workspace);
    };
    const double end = trajectory.points.back().time;
    EXPECT_NEAR(row.gradient.duration, slopeOf([&](double step) {
                  TrajectoryDescription stretched = trajectory;
                  for (TrajectoryPoint &point : stretched.points) point.time *= (end + step) / end;
                  return distance(prepared(), stretched);
                }),
                MISFIT);
    const auto by_base = rigidDifferences([&](const Eigen::Vector3d &shift, const Eigen::Matrix3d &turn) {
      Eigen::Isometry3d base = Eigen::Isometry3d::Identity();
      base.linear() = turn;
      base.translation() = shift;
      return distance(prepared(Objects(), base), trajectory);
    });
    EXPECT_LT(misfitOf(joined(row.gradient.base_linear, row.gradient.base_angular), by_base, told), MISFIT);
    const auto by_object = rigidDifferences([&](const Eigen::Vector3d &shift, const Eigen::Matrix3d &turn) {
      Objects objects;
      Eigen::Isometry3d &pose = row.answer.b == "box" ? objects.box : objects.capsule;
      pose.linear() = turn * pose.linear();
      pose.translation() += shift;
      return distance(prepared(objects), trajectory);
    });
    EXPECT_LT(misfitOf(joined(row.gradient.object_linear, row.gradient.object_angular), by_object, told), MISFIT);
    EXPECT_EQ(row.gradient.margin, -1.0);
  }
  EXPECT_GE(valid, 3);
  EXPECT_GE(told, 40);
}

/* 6 states (seed 83), as trajectories of one point and by name. */
TEST(MotionGradient, of_a_state_is_that_by_its_joints) {
  Random random(83);
  const PreparedRobot robot = prepared();
  Workspace workspace;
  int valid = 0;
  for (int i = 0; i < 6; ++i) {
    const TrajectoryDescription state = randomTrajectory(random, 0, 1);
    const ClearanceRow row = clearanceGradient(RobotMotion(robot, state), RobotPairs::WHOLE, fineQuery(), workspace);
    EXPECT_EQ(row.gradient.positions.rows(), 1);
    if (!row.gradient.valid) continue;
    ++valid;
    EXPECT_LT(largest(row.gradient.positions -
                      differences(robot, state, RobotPairs::WHOLE, &TrajectoryPoint::positions, workspace)),
              MISFIT);
    JointPositions named;
    for (std::size_t k = 0; k + 1 < JOINTS.size(); ++k) named[JOINTS[k]] = state.points[0].positions[k];
    const ClearanceRow by_name =
        clearanceGradient(RobotMotion(robot, named), RobotPairs::WHOLE, fineQuery(), workspace);
    EXPECT_EQ(by_name.gradient.positions.size(), 0);
    for (std::size_t k = 0; k + 1 < JOINTS.size(); ++k)
      EXPECT_NEAR(by_name.gradient.joints.at(JOINTS[k]), row.gradient.positions(0, static_cast<Eigen::Index>(k)), 1e-7);
  }
  EXPECT_GE(valid, 3);
}

/* 3 trajectories (seed 84): each row is the least distance of its pair between its breaks, and the nearest row is the
 * least distance of all. */
TEST(MotionGradient, rows_are_the_least_distances_of_pairs_within_the_horizon) {
  Random random(84);
  const PreparedRobot robot = prepared();
  Workspace workspace;
  for (int i = 0; i < 3; ++i) {
    const RobotMotion motion(robot, randomTrajectory(random, i % 2, 4));
    RowLimits limits;
    limits.horizon = 0.4;
    limits.per_pair = 2;
    const ClearanceRows rows = clearanceRows(motion, RobotPairs::WHOLE, limits, fineQuery(), workspace);
    EXPECT_EQ(rows.status, CPROX_OK) << rows.message;
    double least = INFINITY;
    for (const ClearanceRow &row : rows.rows) {
      EXPECT_LE(row.answer.result.lower, 0.4 + 1e-6);
      EXPECT_LE(row.t0, row.answer.result.t);
      EXPECT_GE(row.t1, row.answer.result.t);
      EXPECT_TRUE(row.gradient.valid || !row.gradient.reason.empty());
      least = std::min(least, row.answer.result.upper);
      Query query = fineQuery();
      query.links = {row.answer.a};
      if (row.answer.kind == "environment") query.objects = {row.answer.b};
      const std::vector<ClearanceInterval> profile =
          clearanceProfile(motion, row.answer.kind == "self", {row.t0, row.t1}, query, workspace);
      EXPECT_LE(profile.front().lower, row.answer.result.upper); // the link may have nearer elements and pairs
    }
    const double all = distanceOf(motion, RobotPairs::WHOLE, workspace);
    if (all < 0.4) {
      EXPECT_NEAR(least, all, 1e-8);
    } else {
      EXPECT_GE(least, 0.4);
    }

    limits.most = 1;
    const ClearanceRows few = clearanceRows(motion, RobotPairs::WHOLE, limits, fineQuery(), workspace);
    EXPECT_EQ(few.rows.size(), std::min<std::size_t>(1, rows.rows.size()));
    if (rows.rows.size() > 1) {
      EXPECT_EQ(few.status, CPROX_BUDGET);
      expectContains(few.message, "row");
    }
  }
}

/* What a gradient with signed_distance is about: of meshes that overlap the depth of their hulls. */
double valueOf(const Answer &answer) {
  return answer.result.status == CPROX_OVERLAP ? answer.result.lower : answer.result.upper;
}

/* A ball of 0.2 that the arm reaches into: a step along the gradient is as much shallower, and the rows say so as well.
 */
TEST(MotionGradient, of_overlaps_leads_out) {
  Random random(86);
  Scene scene(panda(), {}, allowedPairs(pandaSrdf()));
  ASSERT_TRUE(
      scene.apply(change({add("ball", {shape(ShapeType::SPHERE, {0.2})}, translation(0.45, 0.1, 0.5))})).empty());
  const PreparedRobot robot(scene.snapshot(), pandaSrdf().disabled);
  Workspace workspace;
  Query query = fineQuery();
  query.options.signed_distance = true;
  std::size_t deep = 0;
  for (int i = 0; i < 12; ++i) {
    TrajectoryDescription trajectory = randomTrajectory(random, 0);
    const auto depthOf = [&](const TrajectoryDescription &at) {
      const Answer answer = askEnvironment(RobotMotion(robot, at), query, workspace).front();
      EXPECT_EQ(answer.by_hull, answer.result.status == CPROX_OVERLAP) << answer.message;
      return valueOf(answer);
    };
    const RobotMotion motion(robot, trajectory);
    const ClearanceRow row = clearanceGradient(motion, RobotPairs::ENVIRONMENT, query, workspace);
    if (!(valueOf(row.answer) < -0.02) || !row.gradient.valid) continue;
    EXPECT_TRUE(row.answer.by_hull && row.answer.result.upper == 0.0) << row.answer.message; // links are meshes
    ++deep;
    constexpr double LENGTH = 1e-5;
    const double norm = row.gradient.positions.norm();
    for (std::size_t p = 0; p < trajectory.points.size(); ++p)
      for (std::size_t k = 0; k < JOINTS.size(); ++k)
        trajectory.points[p].positions[k] +=
            LENGTH / norm * row.gradient.positions(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(k));
    EXPECT_NEAR((depthOf(trajectory) - valueOf(row.answer)) / LENGTH, norm, 1e-3 * norm);

    RowLimits limits;
    limits.horizon = 0.01;
    const ClearanceRows rows = clearanceRows(motion, RobotPairs::ENVIRONMENT, limits, query, workspace);
    double least = INFINITY;
    for (const ClearanceRow &one : rows.rows) least = std::min(least, valueOf(one.answer));
    EXPECT_NEAR(least, valueOf(row.answer), 1e-6);
  }
  EXPECT_GT(deep, 3u);
}

TEST(MotionGradient, refuses_what_it_would_not_heed) {
  Random random(85);
  const PreparedRobot robot = prepared();
  const RobotMotion motion(robot, randomTrajectory(random, 0));
  Workspace workspace;
  const auto refused = [&](const Query &query, RobotPairs against = RobotPairs::ENVIRONMENT) {
    return errorOf([&] { clearanceGradient(motion, against, query, workspace); });
  };
  Query query;
  query.query_type = QueryType::TOLERANCE;
  EXPECT_NE(refused(query), "");
  query = Query();
  query.objects = {"box"};
  expectContains(refused(query, RobotPairs::SELF), "objects");
  query.objects = {"ghost"};
  expectContains(refused(query), "ghost");
  RowLimits limits;
  limits.horizon = INFINITY;
  expectContains(errorOf([&] { clearanceRows(motion, RobotPairs::WHOLE, limits, Query(), workspace); }), "horizon");
  limits = RowLimits();
  limits.per_pair = 0;
  expectContains(errorOf([&] { clearanceRows(motion, RobotPairs::WHOLE, limits, Query(), workspace); }), "per_pair");
}

/* A robot among no objects is measured against itself alone, and without anything to measure the distance is infinite.
 */
TEST(MotionGradient, without_objects_there_is_the_robot_itself) {
  Random random(86);
  const PreparedRobot robot(Scene(panda(), {}, allowedPairs(pandaSrdf())).snapshot(), pandaSrdf().disabled);
  const RobotMotion motion(robot, randomTrajectory(random, 0));
  Workspace workspace;
  const ClearanceRow whole = clearanceGradient(motion, RobotPairs::WHOLE, fineQuery(), workspace);
  EXPECT_EQ(whole.answer.kind, "self");
  EXPECT_NEAR(whole.answer.result.upper, distanceOf(motion, RobotPairs::SELF, workspace), 1e-9);
  const ClearanceRow nothing = clearanceGradient(motion, RobotPairs::ENVIRONMENT, fineQuery(), workspace);
  EXPECT_EQ(nothing.answer.status, "empty");
  EXPECT_EQ(nothing.answer.result.upper, INFINITY);
  EXPECT_FALSE(nothing.gradient.valid);
  EXPECT_EQ(nothing.gradient.positions.rows(), 4);
  const ClearanceRows rows = clearanceRows(motion, RobotPairs::ENVIRONMENT, RowLimits(), Query(), workspace);
  EXPECT_TRUE(rows.rows.empty());
  EXPECT_EQ(rows.gap, Gap::EMPTY);
}
