/* SPDX-License-Identifier: BSD-3-Clause */
/* Our node answers about scenes that MoveIt's PlanningScene has written, full and diff, as MoveIt's FCL detector does.
 */
#include <moveit/utils/robot_model_test_utils.h>

#include "live_node.h"

TEST(Node, answers_about_full_scenes_and_diffs_of_MoveIt) {
  LiveNode live;
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<moveit_msgs::PlanningScene>("/curve_proximity/planning_scene", 1, true);
  const auto scene = std::make_shared<planning_scene::PlanningScene>(moveit::core::loadTestingRobotModel("panda"));
  makeReady(scene->getCurrentStateNonConst());
  const auto publish = [&](const moveit_msgs::PlanningScene &message) {
    publisher.publish(message);
    return live.agreesWith(*scene);
  };

  /* MoveIt's message has no default for a name that sorts behind those of all entries: "table" after "panda_..." */
  addObject(*scene, "board", std::make_shared<shapes::Box>(0.6, 1.0, 0.05), {0.6, 0.0, 0.1});
  addObject(*scene, "can", std::make_shared<shapes::Cylinder>(0.03, 0.12), {0.5, 0.3, 0.2});
  moveit_msgs::PlanningScene message;
  scene->getPlanningSceneMsg(message);
  const std::string first = publish(message);

  /* the nearest may be touched: another one is the nearest */
  scene->getAllowedCollisionMatrixNonConst().setDefaultEntry(first, true);
  scene->getPlanningSceneMsg(message);
  EXPECT_NE(publish(message), first);

  /* a diff, as a planning scene monitor sends it: a ball beside the hand */
  const auto diff = scene->diff();
  const Eigen::Vector3d beside =
      scene->getCurrentState().getGlobalLinkTransform("panda_hand").translation() + Eigen::Vector3d(0.0, 0.25, 0.0);
  addObject(*diff, "ball", std::make_shared<shapes::Sphere>(0.05), beside);
  diff->getPlanningSceneDiffMsg(message);
  EXPECT_TRUE(message.is_diff);
  addObject(*scene, "ball", std::make_shared<shapes::Sphere>(0.05), beside);
  EXPECT_EQ(publish(message), "ball");

  /* the hand takes it: attached, it is no object any more, and the can has the rest of the scene for itself */
  ASSERT_TRUE(scene->processAttachedCollisionObjectMsg(taken("ball")));
  scene->getPlanningSceneMsg(message);
  EXPECT_NE(publish(message), "ball");
}

int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_node");
  return RUN_ALL_TESTS();
}
