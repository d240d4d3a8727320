/* SPDX-License-Identifier: BSD-3-Clause */
/* The service CertifyPath: trajectories beside an object that a waypoint does not touch. */
#include <gtest/gtest.h>
#include <moveit/collision_detection/occupancy_map.h>
#include <moveit/utils/robot_model_test_utils.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <thread>

#include <ros/package.h>

#include "certify_path.h"

namespace {

using curve_proximity::CertifyPath;

/* On a joint that is fixed in MoveIt's files, and was floating in earlier ones. */
moveit::core::RobotModelPtr pandaOn(const std::string &joint) {
  std::ifstream file(ros::package::getPath("moveit_resources_panda_moveit_config") + "/config/panda.srdf");
  std::string text(std::istreambuf_iterator<char>(file), {});
  const std::string fixed = "type=\"fixed\"";
  text.replace(text.find(fixed), fixed.size(), "type=\"" + joint + "\"");
  const auto urdf = moveit::core::loadModelInterface("panda");
  const auto srdf = std::make_shared<srdf::Model>();
  srdf->initString(*urdf, text);
  return std::make_shared<moveit::core::RobotModel>(urdf, srdf);
}

/* A Panda, and a post that its hand passes when joint 1 turns through .3 rad. */
class Path : public testing::Test {
 protected:
  explicit Path(const std::string &joint = "fixed")
      : scene_(std::make_shared<planning_scene::PlanningScene>(pandaOn(joint))) {
    moveit::core::RobotState &state = scene_->getCurrentStateNonConst();
    state.setToDefaultValues();
    state.setToDefaultValues(scene_->getRobotModel()->getJointModelGroup("panda_arm"), "ready");
    state.setVariablePosition("panda_joint1", 0.3);
    state.update();
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = state.getGlobalLinkTransform("panda_hand").translation();
    scene_->getWorldNonConst()->addToObject("post", std::make_shared<shapes::Box>(0.01, 0.01, 0.3), pose);
    state.setVariablePosition("panda_joint1", -0.8);
    state.update();
    scene_->setName("yard");
  }

  /* Joint 1 alone, from -.8 rad at 0 s to `angle` at 2 s. */
  static CertifyPath::Request turnTo(double angle) {
    CertifyPath::Request req;
    req.joint_trajectory.joint_names = {"panda_joint1"};
    req.joint_trajectory.points.resize(2);
    req.joint_trajectory.points[0].positions = {-0.8};
    req.joint_trajectory.points[1].positions = {angle};
    req.joint_trajectory.points[1].time_from_start = ros::Duration(2.0);
    return req;
  }

  CertifyPath::Response ask(const CertifyPath::Request &req) {
    CertifyPath::Response res;
    curve_proximity::certifyPath(req, *scene_, certifier_, res);
    EXPECT_EQ(res.scene, "yard");
    EXPECT_EQ(res.frame_id, scene_->getPlanningFrame());
    EXPECT_EQ(res.certified, res.message.empty());
    return res;
  }

  void refuses(const CertifyPath::Request &req, const std::string &why) {
    const CertifyPath::Response res = ask(req);
    EXPECT_FALSE(res.certified);
    EXPECT_NE(res.message.find(why), std::string::npos) << res.message;
    EXPECT_EQ(res.clear_until, 0.0);
  }

  planning_scene::PlanningScenePtr scene_;
  curve_proximity::Certifier certifier_;
};

/* An octree that says when its cells are compared: a certificate is then at work, and has its world. */
class WatchedTree : public collision_detection::OccMapTree {
 public:
  WatchedTree() : OccMapTree(0.05) {
    updateNode(octomap::point3d(5.0F, 0.0F, 0.5F), true);
  }

  std::size_t size() const override {
    if (on_compare) on_compare();
    return OccMapTree::size();
  }

  std::function<void()> on_compare;
};

class FloatingPath : public Path {
 protected:
  FloatingPath() : Path("floating") {}
};

} // namespace

/* Of a base that no motion of the group moves. */
TEST_F(FloatingPath, is_where_the_base_stands) {
  moveit::core::RobotState &state = scene_->getCurrentStateNonConst();
  for (const double x : {0.0, 3.0, 0.0}) {
    state.setVariablePosition("virtual_joint/trans_x", x);
    state.update();
    EXPECT_EQ(ask(turnTo(1.2)).certified, x > 0.0) << x;
  }
}

TEST_F(Path, is_certified_where_it_keeps_the_clearance) {
  EXPECT_TRUE(ask(turnTo(-0.4)).certified);
  CertifyPath::Request req = turnTo(-0.4);
  req.clearance = 0.02; // two links are .022 m from each other
  EXPECT_TRUE(ask(req).certified);
  req.clearance = 2.0;
  EXPECT_FALSE(ask(req).certified);
}

TEST_F(Path, through_an_object_is_not_and_the_answer_names_it) {
  const CertifyPath::Response res = ask(turnTo(1.2));
  EXPECT_FALSE(res.certified);
  ASSERT_EQ(res.violations.size(), 1u);
  EXPECT_EQ(res.violations[0].summary.b, "post");
  ASSERT_FALSE(res.violations[0].t.empty());
  EXPECT_GT(res.clear_until, 0.5) << "from -.8 rad at 1 rad/s to the post at .3 rad";
  EXPECT_LT(res.clear_until, 1.1);
  EXPECT_EQ(res.clear_until, res.violations[0].enter_lower[0]);
  scene_->getAllowedCollisionMatrixNonConst().setDefaultEntry("post", true);
  EXPECT_TRUE(ask(turnTo(1.2)).certified);
}

TEST_F(Path, begins_where_start_state_says) {
  CertifyPath::Request req = turnTo(1.2);
  req.start_state.name = {"panda_joint4"};
  req.start_state.position = {-0.2}; // stretched out: above the post
  EXPECT_TRUE(ask(req).certified);
}

TEST_F(Path, beyond_a_limit_is_certified_with_a_warning_that_names_the_joint) {
  EXPECT_TRUE(ask(turnTo(-0.4)).warnings.empty());
  const CertifyPath::Response res = ask(turnTo(-3.0)); // the limit is -2.9 rad
  EXPECT_TRUE(res.certified) << res.message;
  ASSERT_EQ(res.warnings.size(), 1u);
  EXPECT_NE(res.warnings[0].find("panda_joint1"), std::string::npos) << res.warnings[0];
  EXPECT_EQ(res.warnings[0].find('\n'), std::string::npos);
}

/* Another thread changes the scene while the certificate is at work. */
TEST_F(Path, is_certified_in_the_scene_that_the_answer_names) {
  const auto tree = std::make_shared<WatchedTree>();
  scene_->processOctomapPtr(tree, Eigen::Isometry3d::Identity());
  const auto post = scene_->getWorld()->getObject("post");
  const CertifyPath::Request req = turnTo(1.2);
  for (int i = 0; i < 3; ++i) {
    for (const bool removed : {true, false}) {
      int changes = 0;
      tree->on_compare = [&] {
        if (changes++ > 0) return;
        std::thread([&] {
          if (removed) {
            scene_->getWorldNonConst()->removeObject("post");
          } else {
            scene_->getWorldNonConst()->addToObject("post", post->pose_, post->shapes_, post->shape_poses_);
          }
          scene_->setName(removed ? "yard without the post" : "yard");
        }).join();
      };
      CertifyPath::Response res;
      curve_proximity::certifyPath(req, *scene_, certifier_, res);
      EXPECT_GE(changes, 1) << "the scene did not change";
      EXPECT_EQ(res.scene, removed ? "yard" : "yard without the post");
      EXPECT_EQ(res.certified, !removed) << res.message;
    }
  }
}

TEST_F(Path, compares_an_octree_once) {
  const auto tree = std::make_shared<WatchedTree>();
  scene_->processOctomapPtr(tree, Eigen::Isometry3d::Identity());
  EXPECT_TRUE(ask(turnTo(-0.4)).certified);
  int compared = 0;
  tree->on_compare = [&compared] { ++compared; };
  for (int i = 1; i <= 3; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(110)); // states would compare it again
    EXPECT_TRUE(ask(turnTo(-0.4)).certified);
    EXPECT_EQ(compared, i);
  }
}

TEST_F(Path, that_cannot_be_used_is_refused_in_one_line) {
  CertifyPath::Request req = turnTo(-0.4);
  req.clearance = -1.0;
  refuses(req, "the clearance is -1");
  req.clearance = std::numeric_limits<double>::quiet_NaN();
  refuses(req, "must be finite");
  req = turnTo(-0.4);
  req.joint_trajectory.joint_names = {"elbow"};
  refuses(req, "has no joint 'elbow'");
  req = turnTo(-0.4);
  req.joint_trajectory.points[1].positions.clear();
  refuses(req, "a point has 0 positions of 1 joints");
  req = turnTo(-0.4);
  req.joint_trajectory.points[1].time_from_start = ros::Duration(0.0);
  refuses(req, "not timed");
  refuses(CertifyPath::Request(), "no waypoint");
  req = turnTo(-0.4);
  req.start_state.name = {"panda_joint4"};
  refuses(req, "1 names and 0 positions");
  req.start_state.name = {"elbow"};
  req.start_state.position = {0.0};
  refuses(req, "elbow");
}

int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::Time::init();
  return RUN_ALL_TESTS();
}
