/* SPDX-License-Identifier: BSD-3-Clause */
/* Where links are, against KDL: the robots of test/data at 200 random postures each, and along a motion through two of
 * them. 1e-12: both round a dozen transforms of lengths below 3 m in double. */
#include <kdl/tree.hpp>
#include <kdl/treefksolverpos_recursive.hpp>
#include <kdl_parser/kdl_parser.hpp>

#include <curve_proximity/motion.hpp>

#include "support.h"

namespace curve_proximity {
namespace {

/* The value of every joint that moves, followers included. */
JointPositions randomPosture(test::Random &random, const Robot &robot) {
  JointPositions out;
  for (const Robot::Joint &joint : robot.joints())
    if (joint.type != Robot::JointType::FIXED && joint.leader.empty()) out[joint.name] = random.uniform(-2.0, 2.0);
  return out;
}

KDL::JntArray toKdl(const KDL::Tree &tree, const Robot &robot, const JointPositions &posture) {
  KDL::JntArray out(tree.getNrOfJoints());
  for (const auto &[name, element] : tree.getSegments()) {
    const KDL::Joint &moved = element.segment.getJoint();
    if (moved.getType() == KDL::Joint::None) continue;
    for (const Robot::Joint &joint : robot.joints()) {
      if (joint.name != moved.getName()) continue;
      const double value = posture.at(joint.leader.empty() ? joint.name : joint.leader);
      out(element.q_nr) = joint.multiplier * value + joint.offset;
    }
  }
  return out;
}

void expectSame(const KDL::Tree &tree, const Robot &robot, const JointPositions &posture, const LinkPoses &poses) {
  KDL::TreeFkSolverPos_recursive solver(tree);
  const KDL::JntArray joints = toKdl(tree, robot, posture);
  std::size_t compared = 0;
  for (const auto &[link, pose] : poses) {
    KDL::Frame frame;
    if (link == robot.rootLink() || solver.JntToCart(joints, frame, link) < 0) continue;
    ++compared;
    for (int row = 0; row < 3; ++row) {
      EXPECT_NEAR(frame.p(row), pose.translation()[row], 1e-12) << link;
      for (int column = 0; column < 3; ++column)
        EXPECT_NEAR(frame.M(row, column), pose.linear()(row, column), 1e-12) << link;
    }
  }
  EXPECT_GE(compared + 1, poses.size());
}

void compare(const std::string &name) {
  const std::shared_ptr<const Robot> robot = test::dataRobot(name);
  KDL::Tree tree;
  ASSERT_TRUE(kdl_parser::treeFromString(test::readText(TEST_DATA_DIR "/robots/" + name + "/" + name + ".urdf"), tree));
  test::Random random(17);
  for (int k = 0; k < 200; ++k) {
    const JointPositions posture = randomPosture(random, *robot);
    expectSame(tree, *robot, posture, robot->linkPoses(posture));
  }

  /* the core's own, at both ends of a motion */
  const JointPositions from = randomPosture(random, *robot), to = randomPosture(random, *robot);
  TrajectoryDescription t;
  t.points.resize(2);
  t.points[1].time = 1.0;
  for (const auto &[joint, value] : from) {
    t.joints.push_back(joint);
    t.points[0].positions.push_back(value);
    t.points[1].positions.push_back(to.at(joint));
  }
  Scene scene(robot);
  const RobotMotion motion(scene.snapshot(), t, {});
  expectSame(tree, *robot, from, motion.linkPoses(0.0));
  expectSame(tree, *robot, to, motion.linkPoses(1.0));
}

TEST(Kinematics, the_panda_stands_where_kdl_has_it) {
  compare("panda");
}

TEST(Kinematics, the_fanuc_stands_where_kdl_has_it) {
  compare("fanuc_m10ia");
}

} // namespace
} // namespace curve_proximity
