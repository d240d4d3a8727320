/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots from URDF: their collision elements, and where their links are. */
#include <cmath>

#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace {

std::size_t elements(const Robot &robot) {
  std::size_t n = 0;
  for (const auto &link : robot.links()) n += link.second.size();
  return n;
}

/* The published Denavit–Hartenberg table of the Panda (Craig's convention): a, d, alpha of joints 1 … 7 and flange. */
Eigen::Isometry3d pandaFlange(const std::vector<double> &q) {
  const double h = M_PI / 2;
  const double table[8][3] = {{0, 0.333, 0},        {0, 0, -h}, {0, 0.316, h}, {0.0825, 0, h},
                              {-0.0825, 0.384, -h}, {0, 0, h},  {0.088, 0, h}, {0, 0.107, 0}};
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < 8; ++i) {
    const double theta = i < 7 ? q[i] : 0.0;
    pose = pose * Eigen::AngleAxisd(table[i][2], Eigen::Vector3d::UnitX()) * translation(table[i][0], 0, 0) *
           Eigen::AngleAxisd(theta, Eigen::Vector3d::UnitZ()) * translation(0, 0, table[i][1]);
  }
  return pose;
}

std::shared_ptr<const Robot> robotOf(const std::string &body) {
  return Robot::fromUrdf("<robot name='r'>" + body + "</robot>");
}

/* Two links and a joint between them. */
std::shared_ptr<const Robot> oneJoint(const std::string &type, const std::string &inside) {
  return robotOf("<link name='base'/><link name='tip'/><joint name='j' type='" + type +
                 "'><parent link='base'/><child link='tip'/>" + inside + "</joint>");
}

double apart(const Eigen::Isometry3d &a, const Eigen::Isometry3d &b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

Eigen::Isometry3d turned(double angle, const Eigen::Vector3d &axis) {
  return Eigen::Isometry3d(Eigen::AngleAxisd(angle, axis.normalized()));
}

} // namespace

TEST(Robots, the_panda_is_there_with_all_its_links) {
  const auto panda = dataRobot("panda");
  EXPECT_EQ(panda->name(), "panda");
  EXPECT_EQ(panda->rootLink(), "panda_link0");
  EXPECT_EQ(elements(*panda), 11u);
  for (const auto &[name, geometries] : panda->links()) {
    for (const LinkGeometry &g : geometries) EXPECT_TRUE(g.geometry.is_mesh) << name;
  }
  EXPECT_TRUE(panda->links().at("panda_link8").empty());
  EXPECT_TRUE(panda->warnings().empty());
  EXPECT_TRUE(panda->hasJoint("panda_joint8")); // fixed
  EXPECT_FALSE(panda->hasJoint("panda_joint9"));
}

TEST(Robots, the_fanuc_is_there_with_all_its_links) {
  EXPECT_EQ(elements(*dataRobot("fanuc_m10ia")), 7u);
}

TEST(Robots, the_husky_is_there_with_both_boxes_of_its_base) {
  const auto husky = dataRobot("husky");
  EXPECT_EQ(elements(*husky), 7u);
  const std::vector<LinkGeometry> &base = husky->links().at("base_link");
  ASSERT_EQ(base.size(), 2u);
  EXPECT_EQ(base[0].description.type, ShapeType::BOX);
  EXPECT_EQ(base[1].pose.translation().z(), 0.17562499999999998);
  EXPECT_FALSE(base[0].geometry.is_mesh);
}

/* Tolerance: the URDF's quarter turns are written to 5e-12; eight of them over less than 1.5 m. */
TEST(Robots, the_pandas_flange_is_where_its_published_kinematics_say) {
  const auto panda = dataRobot("panda");
  Random random(41);
  for (int i = 0; i < 1000; ++i) {
    std::vector<double> q;
    JointPositions positions;
    for (int k = 1; k <= 7; ++k) {
      q.push_back(random.uniform(-3, 3));
      positions["panda_joint" + std::to_string(k)] = q.back();
    }
    const Eigen::Isometry3d base = random.pose(2.0);
    EXPECT_LE(apart(panda->linkPoses(positions, base).at("panda_link8"), base * pandaFlange(q)), 6e-11);
  }
}

TEST(Robots, fingers_follow_each_other) {
  const auto panda = dataRobot("panda");
  const LinkPoses poses = panda->linkPoses({{"panda_finger_joint1", 0.03}});
  const Eigen::Isometry3d hand = poses.at("panda_hand");
  EXPECT_NEAR((hand.inverse() * poses.at("panda_leftfinger")).translation().y(), 0.03, 1e-14);
  EXPECT_NEAR((hand.inverse() * poses.at("panda_rightfinger")).translation().y(), -0.03, 1e-14);

  // A value for the follower beside its leader's is not looked at; without, nobody knows what is meant.
  const LinkPoses both = panda->linkPoses({{"panda_finger_joint1", 0.03}, {"panda_finger_joint2", 0.01}});
  EXPECT_EQ(apart(both.at("panda_rightfinger"), poses.at("panda_rightfinger")), 0.0);
  expectContains(errorOf([&] { panda->linkPoses({{"panda_finger_joint2", 0.01}}); }), "panda_finger_joint1");
}

TEST(Joints, revolute_and_continuous_turn_about_their_axis) {
  const auto revolute = oneJoint("revolute",
                                 "<origin xyz='1 2 3' rpy='0 0 1.5'/><axis xyz='0 3 4'/>"
                                 "<limit lower='-1' upper='1' effort='1' velocity='1'/>");
  const Eigen::Isometry3d expected =
      translation(1, 2, 3) * turned(1.5, Eigen::Vector3d::UnitZ()) * turned(0.7, {0, 3, 4});
  EXPECT_LE(apart(revolute->linkPoses({{"j", 0.7}}).at("tip"), expected), 1e-15);
  const auto continuous = oneJoint("continuous", "<axis xyz='0 0 1'/>");
  EXPECT_LE(apart(continuous->linkPoses({{"j", 20.0}}).at("tip"), turned(20.0, Eigen::Vector3d::UnitZ())), 1e-15);
  EXPECT_LE(apart(oneJoint("continuous", "")->linkPoses({{"j", 1.0}}).at("tip"), turned(1.0, Eigen::Vector3d::UnitX())),
            1e-15); // URDF's default axis
}

TEST(Joints, prismatic_ones_slide_along_their_axis) {
  const auto robot = oneJoint("prismatic", "<axis xyz='0 0 -2'/><limit lower='0' upper='1' effort='1' velocity='1'/>");
  EXPECT_LE(apart(robot->linkPoses({{"j", 0.25}}).at("tip"), translation(0, 0, -0.25)), 1e-15);
}

TEST(Joints, fixed_ones_stay_whatever_is_said) {
  const auto robot = oneJoint("fixed", "<origin xyz='1 0 0'/>");
  EXPECT_LE(apart(robot->linkPoses({{"j", 3.0}}).at("tip"), translation(1, 0, 0)), 0.0);
  EXPECT_TRUE(robot->variables().empty());
}

TEST(Joints, planar_ones_move_in_the_plane_across_their_axis) {
  const auto flat = oneJoint("planar", "<axis xyz='0 0 1'/>");
  EXPECT_EQ(flat->variables(), (std::vector<std::string>{"j/x", "j/y", "j/theta"}));
  EXPECT_LE(apart(flat->linkPoses({{"j/x", 1.0}, {"j/y", 2.0}, {"j/theta", 0.5}}).at("tip"),
                  translation(1, 2, 0) * turned(0.5, Eigen::Vector3d::UnitZ())),
            1e-15);
  const auto tilted = oneJoint("planar", "<axis xyz='1 2 3'/>");
  const Eigen::Isometry3d tip = tilted->linkPoses({{"j/x", 1.0}, {"j/y", 2.0}, {"j/theta", 0.5}}).at("tip");
  EXPECT_NEAR(tip.translation().dot(Eigen::Vector3d(1, 2, 3)), 0.0, 1e-14);
  EXPECT_NEAR(tip.translation().norm(), std::sqrt(5.0), 1e-14);
  EXPECT_NEAR((tip.linear() * Eigen::Vector3d(1, 2, 3) - Eigen::Vector3d(1, 2, 3)).norm(), 0.0, 1e-14);
  expectContains(errorOf([&] { flat->linkPoses({{"j", 1.0}}); }), "j/theta");
}

TEST(Joints, floating_ones_go_anywhere) {
  const auto robot = oneJoint("floating", "");
  EXPECT_EQ(robot->variables().size(), 7u);
  const LinkPoses poses = robot->linkPoses(
      {{"j/trans_x", 1.0}, {"j/trans_y", 2.0}, {"j/trans_z", 3.0}, {"j/rot_z", 0.6}, {"j/rot_w", 0.8}});
  EXPECT_LE(apart(poses.at("tip"), translation(1, 2, 3) * turned(2 * std::atan2(0.6, 0.8), Eigen::Vector3d::UnitZ())),
            1e-15);
  EXPECT_LE(apart(robot->linkPoses({}).at("tip"), Eigen::Isometry3d::Identity()), 0.0);
  expectContains(errorOf([&] { robot->linkPoses({{"j/rot_w", 0.0}}); }), "joint 'j': the quaternion's norm is 0");
}

TEST(Joints, what_is_not_named_rests_at_0_or_mid_range) {
  const auto tip = [](const std::string &lower, const std::string &upper) {
    const auto robot = oneJoint(
        "prismatic", "<axis xyz='1 0 0'/><limit lower='" + lower + "' upper='" + upper + "' effort='1' velocity='1'/>");
    return robot->linkPoses({}).at("tip").translation().x();
  };
  EXPECT_EQ(tip("-1", "3"), 0.0);
  EXPECT_EQ(tip("1", "3"), 2.0);
  EXPECT_EQ(tip("-3", "-2"), -2.5);
}

TEST(Joints, values_beyond_the_limits_are_taken_as_they_are) {
  const auto panda = dataRobot("panda");
  const LinkPoses poses = panda->linkPoses({{"panda_finger_joint1", 0.065}});
  EXPECT_NEAR((poses.at("panda_hand").inverse() * poses.at("panda_leftfinger")).translation().y(), 0.065, 1e-14);
}

TEST(Joints, mimic_chains_reach_their_first_leader) {
  const std::string limits = "<limit lower='-9' upper='9' effort='1' velocity='1'/><axis xyz='1 0 0'/>";
  const auto slider = [&](const std::string &name, const std::string &child, const std::string &mimic) {
    return "<joint name='" + name + "' type='prismatic'><parent link='base'/><child link='" + child + "'/>" + limits +
           mimic + "</joint>";
  };
  const auto robot =
      robotOf("<link name='base'/><link name='a'/><link name='b'/><link name='c'/>" + slider("ja", "a", "") +
              slider("jb", "b", "<mimic joint='ja' multiplier='2' offset='1'/>") +
              slider("jc", "c", "<mimic joint='jb' multiplier='-1' offset='0.5'/>"));
  const LinkPoses poses = robot->linkPoses({{"ja", 0.25}});
  EXPECT_DOUBLE_EQ(poses.at("b").translation().x(), 1.5);
  EXPECT_DOUBLE_EQ(poses.at("c").translation().x(), -1.0);
}

TEST(Joints, a_mimic_tag_on_a_fixed_joint_means_nothing) {
  const auto robot = robotOf(
      "<link name='base'/><link name='tip'/><joint name='j' type='fixed'><parent link='base'/><child link='tip'/>"
      "<mimic joint='j'/></joint>");
  EXPECT_LE(apart(robot->linkPoses({}).at("tip"), Eigen::Isometry3d::Identity()), 0.0);
}

TEST(Joints, unknown_names_and_values_that_are_no_numbers_are_refused) {
  const auto panda = dataRobot("panda");
  expectContains(errorOf([&] { panda->linkPoses({{"elbow", 0.0}}); }), "joint 'elbow' is no joint of robot 'panda'");
  expectContains(errorOf([&] { panda->linkPoses({{"panda_joint1", NAN}}); }), "panda_joint1");
}
