/* SPDX-License-Identifier: BSD-3-Clause */
/* MoveIt's planning scene monitor publishes as in move_group, and moveit.launch follows it: by service at the start,
 * then by diffs. The node answers as MoveIt's FCL detector does. */
#include <moveit/planning_scene_monitor/planning_scene_monitor.h>

#include "live_node.h"

namespace {

namespace psm = planning_scene_monitor;

constexpr char TOPIC[] = "/move_group/monitored_planning_scene";

/* Changes the monitor's scene and has it published as a diff. */
template <class Change>
void change(const psm::PlanningSceneMonitorPtr &monitor, const Change &apply) {
  {
    psm::LockedPlanningSceneRW locked(monitor);
    const planning_scene::PlanningScenePtr &scene = locked;
    apply(*scene);
  }
  monitor->triggerSceneUpdateEvent(psm::PlanningSceneMonitor::UPDATE_GEOMETRY);
}

} // namespace

TEST(Monitor, is_followed_by_the_node_of_moveit_launch) {
  const auto monitor = std::make_shared<psm::PlanningSceneMonitor>("robot_description");
  ASSERT_TRUE(monitor->getPlanningScene());
  {
    psm::LockedPlanningSceneRW locked(monitor);
    const planning_scene::PlanningScenePtr &scene = locked;
    makeReady(scene->getCurrentStateNonConst());
    addObject(*scene, "board", std::make_shared<shapes::Box>(0.6, 1.0, 0.05), {0.6, 0.0, 0.1});
  }
  monitor->providePlanningSceneService();
  monitor->setPlanningScenePublishingFrequency(20.0);
  monitor->startPublishingPlanningScene(psm::PlanningSceneMonitor::UPDATE_SCENE, TOPIC);
  LiveNode live;
  const auto copy = [&] { // the monitor publishes nothing while its scene is locked
    const psm::LockedPlanningSceneRO locked(monitor);
    return planning_scene::PlanningScene::clone(locked);
  };
  const auto agrees = [&] { return live.agreesWith(*copy()); };
  EXPECT_EQ(agrees(), "board") << "by the service";
  ros::NodeHandle node;
  ros::Publisher same = node.advertise<moveit_msgs::PlanningScene>(TOPIC, 1); // tells who hears the monitor
  for (const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(LiveNode::PATIENCE);
       same.getNumSubscribers() == 0 && ros::WallTime::now() < end;)
    ros::WallDuration(0.1).sleep();
  ASSERT_GT(same.getNumSubscribers(), 0u);

  change(monitor, [](planning_scene::PlanningScene &scene) {
    const Eigen::Vector3d hand = scene.getCurrentState().getGlobalLinkTransform("panda_hand").translation();
    addObject(scene, "ball", std::make_shared<shapes::Sphere>(0.05), hand + Eigen::Vector3d(0.0, 0.25, 0.0));
    addObject(scene, "can", std::make_shared<shapes::Cylinder>(0.03, 0.12), hand + Eigen::Vector3d(0.0, -0.5, 0.0));
  });
  EXPECT_EQ(agrees(), "ball") << "by a diff";

  change(monitor, [](planning_scene::PlanningScene &scene) { scene.getWorldNonConst()->removeObject("board"); });
  change(monitor, [](planning_scene::PlanningScene &scene) {
    EXPECT_TRUE(scene.processAttachedCollisionObjectMsg(taken("ball")));
  });
  EXPECT_EQ(agrees(), "can") << "the ball hangs on the hand, the board is gone";

  const double before = LiveNode::distanceIn(*copy());
  change(monitor, [](planning_scene::PlanningScene &scene) { scene.getCollisionEnvNonConst()->setPadding(0.02); });
  EXPECT_EQ(live.says(before - 0.02, *copy()), "can") << "a ball round each link; FCL moves faces, a millimetre less";

  change(monitor, [](planning_scene::PlanningScene &scene) { scene.getCollisionEnvNonConst()->setPadding(0.0); });
  EXPECT_EQ(live.says(before, *copy()), "can");
  same.shutdown();
  monitor->stopPublishingPlanningScene();
  change(monitor, [](planning_scene::PlanningScene &scene) {
    const Eigen::Vector3d hand = scene.getCurrentState().getGlobalLinkTransform("panda_hand").translation();
    addObject(scene, "tin", std::make_shared<shapes::Box>(0.1, 0.1, 0.1), hand + Eigen::Vector3d(0.0, -0.3, 0.0));
  });
  ros::WallDuration(0.5).sleep(); // the node sees that the publisher is gone
  monitor->startPublishingPlanningScene(psm::PlanningSceneMonitor::UPDATE_SCENE, TOPIC);
  EXPECT_EQ(agrees(), "tin") << "by the service: what was published before the topic was connected is lost";
}

int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_monitor");
  ros::AsyncSpinner spinner(2);
  spinner.start();
  return RUN_ALL_TESTS();
}
