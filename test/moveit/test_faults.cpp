/* SPDX-License-Identifier: BSD-3-Clause */
/* What the collision detector cannot use counts as in collision, until it is gone; all else is answered as before. */
#include <gtest/gtest.h>
#include <moveit/planning_scene/planning_scene.h>
#include <moveit/robot_state/conversions.h>
#include <moveit/utils/robot_model_test_utils.h>

#include <limits>

#include "collision_env.h"

namespace {

namespace cd = collision_detection;

/* A Panda in its ready posture; nothing around it. */
class Faults : public testing::Test {
 protected:
  Faults()
      : model_(moveit::core::loadTestingRobotModel("panda")),
        scene_(std::make_shared<planning_scene::PlanningScene>(model_)) {
    scene_->setActiveCollisionDetector(curve_proximity::CollisionDetectorAllocatorCurveProximity::create(), true);
    state().setToDefaultValues();
    state().setToDefaultValues(model_->getJointModelGroup("panda_arm"), "ready");
    state().update();
  }

  moveit::core::RobotState &state() {
    return scene_->getCurrentStateNonConst();
  }

  bool collides(const moveit::core::RobotState &at) const {
    cd::CollisionResult res;
    scene_->checkCollision({}, res, at);
    return res.collision;
  }
  bool collides() {
    return collides(state());
  }

  double distance() {
    return scene_->getCollisionEnv()->distanceRobot(state(), scene_->getAllowedCollisionMatrix());
  }

  bool collidesOnTheWay(const moveit::core::RobotState &to) {
    cd::CollisionResult res;
    scene_->getCollisionEnv()->checkRobotCollision({}, res, state(), to, scene_->getAllowedCollisionMatrix());
    return res.collision;
  }

  void add(const std::string &id, const shapes::ShapeConstPtr &shape, double z) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() << 0.0, 0.0, z;
    scene_->getWorldNonConst()->addToObject(id, shape, pose);
  }

  /* An object that is far above, and that cannot be used. */
  void refuses(const shapes::ShapeConstPtr &shape) {
    add("board", std::make_shared<shapes::Box>(0.5, 0.5, 0.1), 3.0);
    ASSERT_FALSE(collides());
    const double before = distance();
    EXPECT_GT(before, 0.5);
    moveit::core::RobotState turned(state());
    turned.setVariablePosition("panda_joint1", 0.5);
    turned.update();
    ASSERT_FALSE(collidesOnTheWay(turned));

    add("odd", shape, 5.0);
    EXPECT_TRUE(collides());
    EXPECT_LE(distance(), 0.0);
    EXPECT_TRUE(collidesOnTheWay(turned));
    EXPECT_TRUE(scene_->diff()->isStateColliding(state()));
    cd::CollisionResult self;
    scene_->checkSelfCollision({}, self, state());
    EXPECT_FALSE(self.collision) << "the robot itself is known";

    scene_->getWorldNonConst()->removeObject("odd");
    EXPECT_FALSE(collides());
    EXPECT_EQ(distance(), before);
    EXPECT_FALSE(collidesOnTheWay(turned));
  }

  moveit::core::RobotModelPtr model_;
  planning_scene::PlanningScenePtr scene_;
};

std::shared_ptr<shapes::Mesh> triangle(double size, unsigned int last) {
  auto out = std::make_shared<shapes::Mesh>(3, 1);
  const double corners[9] = {0.0, 0.0, 0.0, size, 0.0, 0.0, 0.0, size, 0.0};
  std::copy(corners, corners + 9, out->vertices);
  const unsigned int triangle[3] = {0, 1, last};
  std::copy(triangle, triangle + 3, out->triangles);
  return out;
}

} // namespace

TEST_F(Faults, an_octree_without_its_tree_counts_as_in_collision_until_it_is_removed) {
  refuses(std::make_shared<shapes::OcTree>());
}

TEST_F(Faults, a_mesh_with_corners_that_are_no_numbers_counts_as_in_collision_until_it_is_removed) {
  refuses(triangle(std::numeric_limits<double>::quiet_NaN(), 2));
}

TEST_F(Faults, a_mesh_whose_triangles_name_corners_that_it_lacks_counts_as_in_collision_until_it_is_removed) {
  refuses(triangle(0.1, 7));
}

TEST_F(Faults, a_box_of_negative_size_counts_as_in_collision_until_it_is_removed) {
  const auto box = std::make_shared<shapes::Box>(0.1, 0.1, 0.1);
  box->size[0] = -0.1; // its constructor refuses that
  refuses(box);
}

TEST_F(Faults, an_octomap_of_another_type_leaves_the_scene_as_it_was) {
  add("board", std::make_shared<shapes::Box>(0.5, 0.5, 0.1), 3.0);
  const double before = distance();
  octomap_msgs::Octomap map;
  map.header.frame_id = scene_->getPlanningFrame();
  map.id = "CountingOcTree";
  map.binary = true;
  map.resolution = 0.1;
  map.data.assign(16, 1);
  scene_->processOctomapMsg(map);
  EXPECT_FALSE(collides());
  EXPECT_EQ(distance(), before);
}

TEST_F(Faults, what_is_attached_and_cannot_be_used_counts_as_in_collision_until_it_is_detached) {
  state().attachBody("odd", Eigen::Isometry3d::Identity(), {std::make_shared<shapes::OcTree>()},
                     {Eigen::Isometry3d::Identity()}, std::vector<std::string>{"panda_hand"}, "panda_hand");
  state().update();
  EXPECT_TRUE(collides());
  EXPECT_TRUE(collidesOnTheWay(state()));
  state().clearAttachedBody("odd");
  EXPECT_FALSE(collides());
}

TEST_F(Faults, a_state_of_another_robot_counts_as_in_collision) {
  moveit::core::RobotState other(moveit::core::loadTestingRobotModel("pr2"));
  other.setToDefaultValues();
  other.update();
  EXPECT_TRUE(collides(other));
  EXPECT_TRUE(collidesOnTheWay(other));
  EXPECT_FALSE(collides());
}

TEST_F(Faults, a_state_of_the_same_robot_read_twice_is_answered) {
  moveit::core::RobotState other(moveit::core::loadTestingRobotModel("panda"));
  ASSERT_NE(other.getRobotModel(), scene_->getRobotModel());
  for (const std::string &name : model_->getVariableNames())
    other.setVariablePosition(name, state().getVariablePosition(name));
  other.update();
  EXPECT_FALSE(collides(other));
}

TEST_F(Faults, names_that_nothing_has_change_nothing) {
  add("board", std::make_shared<shapes::Box>(0.5, 0.5, 0.1), 1.2);
  const double before = distance();
  auto &matrix = scene_->getAllowedCollisionMatrixNonConst();
  matrix.setEntry("no link", "no object", true);
  matrix.setEntry("no link", "board", true);
  scene_->getCollisionEnvNonConst()->setLinkPadding("no link", 0.3);
  scene_->getCollisionEnvNonConst()->setLinkScale("no link", 2.0);
  EXPECT_FALSE(collides());
  EXPECT_EQ(distance(), before);
  cd::CollisionRequest req;
  cd::CollisionResult res;
  req.group_name = "no group";
  add("post", std::make_shared<shapes::Box>(0.05, 0.05, 2.0), 0.5);
  scene_->checkCollision(req, res, state());
  EXPECT_TRUE(res.collision) << "a group that is not known means the whole robot, as for FCL";
}

TEST_F(Faults, a_scene_message_with_links_that_the_robot_lacks_is_used_but_for_these) {
  moveit_msgs::PlanningScene message;
  scene_->getPlanningSceneMsg(message);
  message.link_padding.emplace_back();
  message.link_padding.back().link_name = "no link";
  message.link_padding.back().padding = 0.1;
  moveit_msgs::AttachedCollisionObject attached;
  attached.link_name = "no link";
  attached.object.id = "cup";
  attached.object.header.frame_id = scene_->getPlanningFrame();
  attached.object.operation = moveit_msgs::CollisionObject::ADD;
  attached.object.primitives.resize(1);
  attached.object.primitives[0].type = shape_msgs::SolidPrimitive::SPHERE;
  attached.object.primitives[0].dimensions = {0.1};
  attached.object.primitive_poses.resize(1);
  attached.object.primitive_poses[0].orientation.w = 1.0;
  message.robot_state.attached_collision_objects.push_back(attached);
  attached.object.id = "board";
  attached.object.primitive_poses[0].position.z = 3.0;
  message.world.collision_objects.push_back(attached.object);
  scene_->setPlanningSceneMsg(message);
  EXPECT_FALSE(collides());
  EXPECT_GT(distance(), 0.5);
  EXPECT_LT(distance(), 3.0) << "the board is there";
}

int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
