/* SPDX-License-Identifier: BSD-3-Clause */
/* What changes in MoveIt's scene reaches the collision detector and the certifier, and what does not change is kept. */
#include <gtest/gtest.h>
#include <moveit/collision_detection/occupancy_map.h>
#include <tf2_eigen/tf2_eigen.h>

#include <thread>

#include "certifier.h"
#include "panda.h"

namespace {

namespace cd = collision_detection;
using curve_proximity::CollisionEnvCurveProximity;

/* A robot that stands. */
robot_trajectory::RobotTrajectory standing(const moveit::core::RobotState &state) {
  robot_trajectory::RobotTrajectory out(panda(), "panda_arm");
  out.addSuffixWayPoint(state, 0.0);
  return out;
}

bool isProven(const curve_proximity::Certifier &certifier, const planning_scene::PlanningScene &scene) {
  return certifier.certify(scene, standing(scene.getCurrentState()), {}).why.empty();
}

Eigen::Isometry3d at(double x, double y, double z) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << x, y, z;
  return pose;
}

const CollisionEnvCurveProximity &envOf(const planning_scene::PlanningScene &scene) {
  return dynamic_cast<const CollisionEnvCurveProximity &>(*scene.getCollisionEnv());
}

/* Is the made body of an object the same one in two environments' motions? */
const void *bodyOf(const planning_scene::PlanningScene &scene, const std::string &id) {
  const auto motion = envOf(scene).motion(curve_proximity::timed(standing(scene.getCurrentState())),
                                          scene.getCurrentState(), scene.getAllowedCollisionMatrix());
  return motion.snapshot()->objects().at(id)->shapes.at(0).geometry.body.get();
}

const curve_proximity::Snapshot *snapshotOf(const planning_scene::PlanningScene &scene) {
  return envOf(scene)
      .motion(curve_proximity::timed(standing(scene.getCurrentState())), scene.getCurrentState(),
              scene.getAllowedCollisionMatrix())
      .snapshot()
      .get();
}

std::shared_ptr<shapes::Mesh> tetrahedron(double size) {
  auto out = std::make_shared<shapes::Mesh>(4, 4);
  const double corners[12] = {0, 0, 0, size, 0, 0, 0, size, 0, 0, 0, size};
  std::copy(corners, corners + 12, out->vertices);
  const unsigned int triangles[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  std::copy(triangles, triangles + 12, out->triangles);
  return out;
}

void attach(moveit::core::RobotState &state, const std::string &id, const shapes::ShapeConstPtr &shape) {
  state.attachBody(id, Eigen::Isometry3d::Identity(), {shape}, {at(0.0, 0.0, 0.2)},
                   std::vector<std::string>{"panda_hand", "panda_leftfinger", "panda_rightfinger"}, "panda_hand");
  state.update();
}

} // namespace

/* MoveIt's monitor of octomaps changes the tree that the world has, and tells nobody. */
TEST(Changes, cells_of_an_octree_that_is_changed_in_place_are_seen) {
  for (const bool ours : {false, true}) {
    const auto scene = pandaScene(ours);
    const curve_proximity::Certifier certifier;
    const auto tree = std::make_shared<cd::OccMapTree>(0.05);
    const Eigen::Vector3d hand = ready().getGlobalLinkTransform("panda_hand").translation();
    tree->updateNode(octomap::point3d(2.0F, 0.0F, 0.5F), true);
    scene->processOctomapPtr(tree, Eigen::Isometry3d::Identity());
    EXPECT_FALSE(scene->isStateColliding(ready()));
    EXPECT_TRUE(isProven(certifier, *scene));
    const octomap::point3d there(static_cast<float>(hand.x()), static_cast<float>(hand.y()),
                                 static_cast<float>(hand.z()));
    for (const bool occupied : {true, false, true}) {
      tree->setNodeValue(there, occupied ? 2.0F : -2.0F);
      tree->updateInnerOccupancy();
      scene->processOctomapPtr(tree, Eigen::Isometry3d::Identity());
      EXPECT_EQ(isProven(certifier, *scene), !occupied) << ours;
      std::this_thread::sleep_for(std::chrono::milliseconds(110));
      EXPECT_EQ(scene->isStateColliding(ready()), occupied) << ours;
      EXPECT_EQ(scene->diff()->isStateColliding(ready()), occupied) << ours;
    }
  }
}

/* By the detector alone: no certificate has compared the tree. */
TEST(Changes, a_state_sees_changed_cells_after_a_tenth_of_a_second) {
  const auto scene = pandaScene(true);
  const auto tree = std::make_shared<cd::OccMapTree>(0.05);
  tree->updateNode(octomap::point3d(2.0F, 0.0F, 0.5F), true);
  scene->processOctomapPtr(tree, Eigen::Isometry3d::Identity());
  EXPECT_FALSE(scene->isStateColliding(ready()));
  const Eigen::Vector3f hand = ready().getGlobalLinkTransform("panda_hand").translation().cast<float>();
  tree->updateNode(octomap::point3d(hand.x(), hand.y(), hand.z()), true);
  std::this_thread::sleep_for(std::chrono::milliseconds(110));
  EXPECT_TRUE(scene->isStateColliding(ready()));
}

TEST(Changes, the_body_of_a_mesh_is_made_once_and_shared_by_copies) {
  const auto scene = pandaScene(true);
  const shapes::ShapeConstPtr mesh = tetrahedron(0.1);
  scene->getWorldNonConst()->addToObject("far", mesh, at(3.0, 0.0, 0.0));
  const void *first = bodyOf(*scene, "far");
  const auto copy = scene->diff();
  EXPECT_EQ(bodyOf(*copy, "far"), first);
  copy->getWorldNonConst()->removeObject("far");
  copy->getWorldNonConst()->addToObject("farther", mesh, at(4.0, 0.0, 0.0));
  EXPECT_EQ(bodyOf(*copy, "farther"), first) << "the same shape in another object";
  scene->getWorldNonConst()->removeObject("far");
  scene->getWorldNonConst()->addToObject("far", tetrahedron(0.1), at(3.0, 0.0, 0.0));
  EXPECT_NE(bodyOf(*scene, "far"), first) << "another shape";
}

TEST(Changes, robots_are_prepared_once_for_each_thing_attached_and_each_matrix) {
  const auto scene = pandaScene(true);
  scene->getWorldNonConst()->addToObject("far", std::make_shared<shapes::Box>(0.1, 0.1, 0.1), at(3.0, 0.0, 0.0));
  const shapes::ShapeConstPtr mesh = tetrahedron(0.05);
  const auto *without = snapshotOf(*scene);
  attach(scene->getCurrentStateNonConst(), "cup", mesh);
  const auto *with = snapshotOf(*scene);
  EXPECT_NE(with, without);
  for (int i = 0; i < 3; ++i) {
    scene->getCurrentStateNonConst().clearAttachedBody("cup");
    EXPECT_EQ(snapshotOf(*scene), without);
    attach(scene->getCurrentStateNonConst(), "cup", mesh);
    EXPECT_EQ(snapshotOf(*scene), with);
  }
  scene->getAllowedCollisionMatrixNonConst().setEntry("cup", "far", true);
  const auto *allowed = snapshotOf(*scene);
  EXPECT_NE(allowed, with);
  scene->getAllowedCollisionMatrixNonConst().setEntry("cup", "far", false);
  EXPECT_NE(snapshotOf(*scene), allowed);
  EXPECT_EQ(snapshotOf(*scene->diff()), snapshotOf(*scene)) << "a copy that has changed nothing";
}

/* A conditional entry or one that forbids does not let a default allow. */
TEST(Changes, defaults_of_the_matrix_count_as_moveit_counts_them) {
  const auto scene = pandaScene(true);
  const Eigen::Vector3d hand = ready().getGlobalLinkTransform("panda_hand").translation();
  scene->getWorldNonConst()->addToObject("zz", std::make_shared<shapes::Box>(0.02, 0.02, 0.02),
                                         at(hand.x(), hand.y(), hand.z()));
  const curve_proximity::Certifier certifier;
  auto &matrix = scene->getAllowedCollisionMatrixNonConst();
  const auto compare = [&](bool free) {
    EXPECT_EQ(scene->isStateColliding(ready()), !free);
    EXPECT_EQ(isProven(certifier, *scene), free);
  };
  compare(false);
  matrix.setDefaultEntry("zz", true); // sorted behind all other names
  compare(true);
  matrix.setDefaultEntry("panda_hand", false);
  compare(false);
  matrix.setDefaultEntry("panda_hand", true);
  compare(true);
  matrix.setEntry("panda_hand", "zz", false);
  compare(false);
}

/* What stood there before an object was replaced by one that cannot be used must not come back. */
TEST(Changes, an_object_that_cannot_be_used_stays_so_when_it_is_moved) {
  const auto scene = pandaScene(true);
  const curve_proximity::Certifier certifier;
  const auto world = scene->getWorldNonConst();
  world->addToObject("odd", std::make_shared<shapes::Box>(0.1, 0.1, 0.1), at(3.0, 0.0, 0.0));
  EXPECT_TRUE(isProven(certifier, *scene));
  world->removeObject("odd");
  world->addToObject("odd", std::make_shared<shapes::OcTree>(), at(3.0, 0.0, 0.0));
  EXPECT_FALSE(isProven(certifier, *scene));
  world->moveObject("odd", at(0.1, 0.0, 0.0));
  EXPECT_FALSE(isProven(certifier, *scene));
  EXPECT_TRUE(scene->isStateColliding(ready()));
  world->removeObject("odd");
  EXPECT_TRUE(isProven(certifier, *scene));
}

/* A scene that changes after a motion was made of it: the motion is about the scene before, the next one about the new. */
TEST(Changes, a_motion_is_about_the_scene_that_it_was_made_in) {
  const auto scene = pandaScene(true);
  const Eigen::Vector3d hand = ready().getGlobalLinkTransform("panda_hand").translation();
  const auto make = [&] {
    const auto plan = standing(ready());
    return envOf(*scene).motion(curve_proximity::timed(plan), ready(), scene->getAllowedCollisionMatrix());
  };
  const auto isClear = [](const curve_proximity::RobotMotion &motion) {
    curve_proximity::Query query;
    query.query_type = curve_proximity::QueryType::COLLISION;
    query.allow_empty = true;
    curve_proximity::Workspace workspace;
    return askEnvironment(motion, query, workspace).front().result.verdict == CPROX_VERDICT_CLEAR;
  };
  const curve_proximity::RobotMotion before = make();
  std::thread changes([&] {
    scene->getWorldNonConst()->addToObject("post", std::make_shared<shapes::Box>(0.05, 0.05, 0.05),
                                           at(hand.x(), hand.y(), hand.z()));
  });
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(isClear(before));
  changes.join();
  EXPECT_TRUE(isClear(before));
  EXPECT_FALSE(isClear(make()));
}

TEST(Changes, a_plan_of_a_group_without_a_joint_that_moves_is_refused_in_one_line) {
  moveit::core::RobotModelBuilder builder("crane", "base");
  builder.addChain("base->arm", "revolute");
  builder.addChain("arm->tool", "fixed");
  for (const char *link : {"base", "arm", "tool"})
    builder.addCollisionBox(link, {0.1, 0.1, 0.1}, tf2::toMsg(Eigen::Isometry3d::Identity()));
  builder.addGroup({}, {"arm-tool-joint"}, "mount");
  ASSERT_TRUE(builder.isValid());
  const moveit::core::RobotModelPtr model = builder.build();
  const planning_scene::PlanningScene scene(model);
  robot_trajectory::RobotTrajectory plan(model, "mount");
  plan.addSuffixWayPoint(scene.getCurrentState(), 0.0);
  const std::string why = curve_proximity::Certifier().certify(scene, plan, {}).why;
  EXPECT_NE(why.find("group 'mount' has no joint that can move"), std::string::npos) << why;
  EXPECT_EQ(why.find('\n'), std::string::npos);
}

/* One certifier, scenes of FCL's detector in turn. */
TEST(Changes, a_certifier_answers_each_scene_by_its_own_objects) {
  const curve_proximity::Certifier certifier;
  const auto free = pandaScene(false), blocked = pandaScene(false);
  const Eigen::Vector3d hand = ready().getGlobalLinkTransform("panda_hand").translation();
  for (const auto &scene : {free, blocked})
    scene->getWorldNonConst()->addToObject("post", std::make_shared<shapes::Box>(0.05, 0.05, 0.05), at(2.0, 0.0, 0.0));
  blocked->getWorldNonConst()->moveObject("post", at(hand.x() - 2.0, hand.y(), hand.z()));
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(isProven(certifier, *free));
    EXPECT_FALSE(isProven(certifier, *blocked));
    EXPECT_TRUE(isProven(certifier, *free->diff()));
  }
  free->getCollisionEnvNonConst()->setPadding(3.0);
  EXPECT_FALSE(isProven(certifier, *free)) << "padded as far as the post";
  EXPECT_FALSE(isProven(certifier, *blocked));
  free->getCollisionEnvNonConst()->setPadding(0.0);
  EXPECT_TRUE(isProven(certifier, *free));
}

int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::Time::init();
  return RUN_ALL_TESTS();
}
