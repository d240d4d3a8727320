/* SPDX-License-Identifier: BSD-3-Clause */
/* moveit_msgs/PlanningScene as changes of a scene, by the rules of MoveIt's PlanningScene. Messages are the recorded
 * ones of test/data/moveit, about the robot of data/arm.urdf, or made here. */
#include "moveit/planning_scene.h"

#include <foreign/control_msgs/FollowJointTrajectoryAction.h>
#include <foreign/octomap_msgs/Octomap.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>

#include "messages/geometry_message.h"
#include "transport/checked_stream.h"

namespace curve_proximity {
namespace {

using moveit::PlanningScene;
using Bytes = std::vector<std::uint8_t>;

template <class Content>
Content contentOf(const std::string &path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file.good()) << path;
  return Content(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
}

/* A message that moveit_msgs's own classes wrote. */
Bytes recorded(const std::string &name) {
  return contentOf<Bytes>(CURVE_PROXIMITY_MOVEIT_DATA "/" + name + ".bin");
}

/* Throws ros::serialization::StreamOverrunException. */
PlanningScene read(Bytes bytes) {
  PlanningScene message;
  CheckedStream stream(bytes.data(), bytes.size());
  stream.next(message);
  return message;
}

Eigen::Isometry3d translation(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

geometry_msgs::Pose poseAt(double x, double y, double z) {
  return toMessage(translation(x, y, z));
}

moveit::CollisionObject named(const std::string &id, std::int8_t operation) {
  moveit::CollisionObject object;
  object.id = id;
  object.header.frame_id = "world";
  object.operation = operation;
  return object;
}

moveit::CollisionObject ball(const std::string &id, double radius, const geometry_msgs::Pose &pose,
                             std::int8_t operation = moveit::CollisionObject::ADD) {
  moveit::CollisionObject object = named(id, operation);
  object.pose = pose;
  object.primitives.resize(1);
  object.primitives[0].type = shape_msgs::SolidPrimitive::SPHERE;
  object.primitives[0].dimensions.assign(1, radius);
  return object;
}

PlanningScene diff(std::vector<moveit::CollisionObject> objects = {}) {
  PlanningScene scene;
  scene.is_diff = scene.robot_state.is_diff = 1;
  scene.world.collision_objects = std::move(objects);
  return scene;
}

/* What a link is to carry, or to let go. */
PlanningScene attaching(const std::string &link, moveit::CollisionObject object) {
  PlanningScene scene = diff();
  scene.robot_state.attached_collision_objects.resize(1);
  scene.robot_state.attached_collision_objects[0].link_name = link;
  scene.robot_state.attached_collision_objects[0].object = std::move(object);
  return scene;
}

void turnTo(double angle, PlanningScene &scene) {
  scene.robot_state.joint_state.name = {"turn"};
  scene.robot_state.joint_state.position = {angle};
}

/* A scene that follows. The arm stands in `world`, where its base is. */
struct Planning : ::testing::Test {
  const std::shared_ptr<const Robot> robot = Robot::fromUrdf(contentOf<std::string>(CURVE_PROXIMITY_ARM));
  Scene scene{robot};
  PlanningSceneState state;
  std::set<std::string> kept;
  std::vector<std::string> wrong;

  PlanningSceneContext context(const Snapshot &before) {
    PlanningSceneContext out{before, state, kept, false, {}, {}};
    out.to_fixed = [](const std::string &frame) -> Eigen::Isometry3d {
      if (frame.empty() || frame == "world") return Eigen::Isometry3d::Identity();
      throw Error("no transform from frame '" + frame + "'");
    };
    out.link_to_fixed = [this](const std::string &link, const JointPositions &joints) {
      return robot->linkPoses(joints).at(link);
    };
    return out;
  }

  PlanningSceneChange take(const PlanningScene &message) {
    const SnapshotPtr before = scene.snapshot();
    PlanningSceneChange change = toSceneChange(message, context(*before));
    state = change.state;
    wrong = change.wrong;
    for (const std::string &fault : scene.apply(change.change)) wrong.push_back(fault);
    return change;
  }

  /* Nothing is refused. */
  PlanningSceneChange use(const PlanningScene &message) {
    PlanningSceneChange change = take(message);
    EXPECT_TRUE(wrong.empty()) << wrong.front();
    return change;
  }

  bool has(const std::string &id) const {
    return scene.snapshot()->objects().count(id) > 0;
  }

  const ObjectDescription &object(const std::string &id) const {
    return scene.snapshot()->objects().at(id)->description;
  }

  void expectAt(const std::string &id, const Eigen::Isometry3d &pose) const {
    ASSERT_TRUE(has(id)) << id;
    EXPECT_TRUE(object(id).pose.isApprox(pose, 1e-12)) << id << "\n" << object(id).pose.matrix();
  }
};

TEST_F(Planning, a_recorded_full_scene_is_all_there) {
  const PlanningSceneChange change = use(read(recorded("planning_scene_full")));
  const SnapshotPtr now = scene.snapshot();
  EXPECT_EQ(now->objects().size(), 4u);
  expectAt("table", translation(3, 0, 0));
  EXPECT_EQ(object("table").shapes.size(), 4u);
  expectAt("floor", translation(0, 0, -3));
  expectAt("cup", translation(0, 0, 2)); // in the frame `shelf` of fixed_frame_transforms
  EXPECT_TRUE(object("cup").shapes[0].pose.isApprox(translation(1, 0, 0)));
  expectAt(MOVEIT_OCTOMAP, translation(0, 5, 0));

  ASSERT_EQ(now->attached().count("tool"), 1u);
  const AttachedObject &tool = *now->attached().at("tool");
  EXPECT_EQ(tool.link, "arm");
  EXPECT_EQ(tool.touch_links, (std::vector<std::string>{"slider", "base"}));
  EXPECT_TRUE(tool.description.pose.isApprox(translation(0.5, 0, 0.2)));

  EXPECT_TRUE(now->mayTouch("slider", "arm"));
  EXPECT_TRUE(now->mayTouch("base", "table"));
  EXPECT_FALSE(now->mayTouch("slider", "table")); // the entry, against slider's default
  EXPECT_TRUE(now->mayTouch("slider", "cup"));    // by default
  EXPECT_FALSE(now->mayTouch("table", "cup"));
  EXPECT_TRUE(change.change.clear_allowed);
  EXPECT_EQ(now->linkPadding("arm"), 0.01);
  EXPECT_EQ(now->linkScales().at("arm"), 1.5);
  EXPECT_EQ(state.joints.at("turn"), 0.25);
}

TEST_F(Planning, a_recorded_diff_changes_what_it_names) {
  use(read(recorded("planning_scene_full")));
  use(read(recorded("planning_scene_diff")));
  const SnapshotPtr now = scene.snapshot();
  EXPECT_EQ(now->objects().size(), 4u);
  EXPECT_FALSE(has("floor"));
  EXPECT_FALSE(has(MOVEIT_OCTOMAP));
  expectAt("table", translation(4, 0, 0));
  expectAt("plate", translation(4, 0, 0.56)); // its one shape's pose, in the subframe table/top
  EXPECT_EQ(object("cup").shapes.size(), 2u);
  expectAt("tool", translation(0.5, 0.5, 0.7)); // detached, and then put elsewhere
  EXPECT_TRUE(now->attached().empty());
  EXPECT_TRUE(now->mayTouch("slider", "arm"));
  EXPECT_EQ(now->linkPadding("arm"), 0.01);
}

TEST_F(Planning, a_full_scene_replaces_the_world_but_not_what_sensors_keep) {
  use(diff({ball("cloud", 1, poseAt(0, 0, 9)), ball("old", 1, poseAt(0, 0, 5))}));
  kept = {"cloud"};
  PlanningScene full;
  turnTo(0.0, full);
  use(full);
  EXPECT_TRUE(has("cloud"));
  EXPECT_FALSE(has("old"));
  use(diff({named("", moveit::CollisionObject::REMOVE)}));
  EXPECT_TRUE(has("cloud"));
}

TEST_F(Planning, attaching_and_detaching_follow_the_links) {
  use(diff({ball("cup", 0.1, poseAt(0.5, 0, 1))}));
  use(attaching("arm", named("cup", moveit::CollisionObject::ADD)));
  EXPECT_FALSE(has("cup"));
  EXPECT_TRUE(scene.snapshot()->attached().at("cup")->description.pose.isApprox(translation(0.5, 0, 0.5)));

  // more shapes at the same pose; the joints have moved when it is put down: the link's frame has turned by 90 degrees
  PlanningScene more = attaching("arm", ball("cup", 0.2, geometry_msgs::Pose(), moveit::CollisionObject::APPEND));
  more.robot_state.attached_collision_objects[0].object.header.frame_id = "arm";
  more.robot_state.attached_collision_objects[0].touch_links = {"base"};
  use(more);
  EXPECT_EQ(scene.snapshot()->attached().at("cup")->description.shapes.size(), 2u);
  EXPECT_TRUE(scene.snapshot()->attached().at("cup")->description.pose.isApprox(translation(0.5, 0, 0.5)));

  PlanningScene release = attaching("", named("cup", moveit::CollisionObject::REMOVE));
  turnTo(M_PI / 2, release);
  use(release);
  ASSERT_TRUE(has("cup"));
  EXPECT_TRUE(object("cup").pose.translation().isApprox(Eigen::Vector3d(0, 0.5, 1), 1e-12));
}

TEST_F(Planning, a_full_state_lets_go_of_what_links_carry_and_a_diff_does_not) {
  use(attaching("arm", ball("cup", 0.1, poseAt(0, 0, 0))));
  PlanningScene moved = diff();
  turnTo(1.0, moved);
  use(moved);
  EXPECT_EQ(scene.snapshot()->attached().size(), 1u);
  moved.robot_state.is_diff = 0;
  use(moved);
  EXPECT_TRUE(scene.snapshot()->attached().empty());
  EXPECT_FALSE(has("cup"));
}

TEST_F(Planning, moving_takes_poses_of_the_object_and_of_its_shapes) {
  moveit::CollisionObject two = ball("two", 0.1, poseAt(1, 0, 0));
  two.primitives.push_back(two.primitives[0]);
  two.primitive_poses = {poseAt(0, 0, 0), poseAt(0, 1, 0)};
  use(diff({two}));
  moveit::CollisionObject there = named("two", moveit::CollisionObject::MOVE);
  there.pose = poseAt(2, 0, 0);
  use(diff({there}));
  expectAt("two", translation(2, 0, 0));
  EXPECT_TRUE(object("two").shapes[1].pose.isApprox(translation(0, 1, 0)));
  there.primitive_poses = {poseAt(0, 0, 0), poseAt(0, 2, 0)};
  use(diff({there}));
  EXPECT_TRUE(object("two").shapes[1].pose.isApprox(translation(0, 2, 0)));
  there.primitive_poses.pop_back();
  take(diff({there}));
  ASSERT_EQ(wrong.size(), 1u);
  EXPECT_NE(wrong[0].find("1 poses of shapes, the object has 2 shapes"), std::string::npos) << wrong[0];
}

TEST_F(Planning, poses_that_are_left_out_mean_what_they_mean_to_moveit) {
  // a single shape of an object without a pose gives the object its pose; missing poses are the identity
  moveit::CollisionObject one = ball("one", 0.1, geometry_msgs::Pose());
  one.primitive_poses = {poseAt(1, 2, 3)};
  one.subframe_names = {"tip"};
  one.subframe_poses = {poseAt(0, 0, 1)};
  moveit::CollisionObject on_tip = ball("on_tip", 0.1, poseAt(0, 0, 1));
  on_tip.header.frame_id = "/one/tip";
  moveit::CollisionObject two = ball("two", 0.1, poseAt(0, 0, 0));
  two.primitives.push_back(two.primitives[0]);
  two.primitive_poses = {poseAt(0, 0, 5)};
  two.pose.orientation.w = 0.0;
  two.pose.position.x = 1.0; // a quaternion of zeros is no rotation
  use(diff({one, on_tip, two}));
  expectAt("one", translation(1, 2, 3));
  expectAt("on_tip", translation(1, 2, 5));
  expectAt("two", translation(1, 0, 0));
  EXPECT_TRUE(object("two").shapes[1].pose.isApprox(Eigen::Isometry3d::Identity()));
}

TEST_F(Planning, the_matrix_replaces_the_one_before_and_forgets_removed_objects) {
  PlanningScene first = diff({ball("cup", 0.1, poseAt(5, 0, 0))});
  auto &matrix = first.allowed_collision_matrix;
  matrix.entry_names = {"arm", "base", "cup"};
  matrix.entry_values.resize(3);
  for (auto &row : matrix.entry_values) row.enabled = {1, 1, 1};
  use(first);
  EXPECT_TRUE(scene.snapshot()->mayTouch("cup", "arm"));
  use(diff({named("cup", moveit::CollisionObject::REMOVE)}));
  EXPECT_FALSE(scene.snapshot()->mayTouch("cup", "arm"));
  EXPECT_TRUE(scene.snapshot()->mayTouch("base", "arm"));
  PlanningScene second = diff();
  second.allowed_collision_matrix.entry_names = {"arm"};
  second.allowed_collision_matrix.entry_values.resize(1);
  second.allowed_collision_matrix.entry_values[0].enabled = {0};
  use(second);
  EXPECT_FALSE(scene.snapshot()->mayTouch("base", "arm"));
}

TEST_F(Planning, differences_are_told_and_equal_scenes_have_none) {
  const PlanningScene full = read(recorded("planning_scene_full"));
  use(full);
  const auto told = [&](const PlanningScene &message) {
    const SnapshotPtr now = scene.snapshot();
    return differences(message, context(*now), 9);
  };
  EXPECT_TRUE(told(full).empty()) << told(full).front();

  PlanningScene other = full;
  other.world.collision_objects[0].pose.position.x += 1e-5;
  other.world.collision_objects.pop_back();
  other.world.collision_objects.push_back(ball("new", 1, poseAt(0, 0, 0)));
  other.robot_state.attached_collision_objects.clear();
  other.link_padding[0].padding = 0.02;
  other.allowed_collision_matrix.entry_values[0].enabled[3] = 1;
  const std::vector<std::string> found = told(other);
  ASSERT_EQ(found.size(), 6u);
  EXPECT_EQ(found[0], "object 'new' is missing here");
  EXPECT_EQ(found[1], "object 'table' stands elsewhere");
  EXPECT_EQ(found[2], "object 'cup' is here alone");
  EXPECT_EQ(found[3], "object 'tool' on link 'arm' is here alone");
  EXPECT_EQ(found[4], "link 'arm' has another padding");
  EXPECT_EQ(found[5], "the allowed collision matrix is another one");
  EXPECT_EQ(scene.snapshot()->version(), 1u) << "comparing changes nothing";
}

TEST(ForeignMessages, definitions_are_the_published_ones) {
  using ros::message_traits::md5sum;
  EXPECT_STREQ(md5sum<moveit::PlanningScene>(), "acfc50bcfd6c7b978066bfa7c786002c");
  EXPECT_STREQ(md5sum<moveit::RobotTrajectory>(), "dfa9556423d709a3729bcef664bddf67");
  EXPECT_STREQ(md5sum<moveit::DisplayTrajectory>(), "41936b74e168ba754279ae683ce3f121");
  EXPECT_STREQ(md5sum<moveit::ContactInformation>(), "116228ca08b0c286ec5ca32a50fdc17b");
  EXPECT_STREQ(ros::service_traits::md5sum<moveit::GetPlanningScene>(), "65cf69d3e7a0342e16374024d4eeef65");
  EXPECT_STREQ(md5sum<control_msgs::FollowJointTrajectoryAction>(), "bc4f9b743838566551c0390c65f1a248");
  EXPECT_STREQ(md5sum<octomap_msgs::Octomap>(), "9a45536b45c5e409cd49f04bb2d9999f");
}

/* Each four bytes of a message as the count of something: no more is allocated than the bytes can hold. */
TEST(ForeignMessages, counts_that_lie_take_no_memory) {
  const Bytes bytes = recorded("planning_scene_full");
  for (const std::uint32_t lie : {0xffffffffu, 0x7fffffffu, 0x10000000u, 1000000u}) {
    for (std::size_t at = 0; at + sizeof lie <= bytes.size(); ++at) {
      Bytes wrong = bytes;
      std::memcpy(wrong.data() + at, &lie, sizeof lie);
      try {
        EXPECT_LE(read(wrong).world.collision_objects.capacity(), bytes.size());
      } catch (const ros::serialization::StreamOverrunException &) { // as it should be, where it is a count
      }
    }
  }
}

/* Recorded messages with random bytes, or cut: whatever they say by then, the scene stays one, and its poses finite. */
TEST_F(Planning, damaged_messages_leave_a_sound_scene) {
  std::uint64_t seed = 20260725;
  const auto random = [&seed] {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::uint32_t>(seed >> 33);
  };
  const Bytes sound[] = {recorded("planning_scene_full"), recorded("planning_scene_diff")};
  int understood = 0;
  for (int i = 0; i < 5000; ++i) {
    Bytes bytes = sound[random() % 2];
    const int flips = 1 + static_cast<int>(random() % 8);
    for (int k = 0; k < flips; ++k) bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1u << (random() % 8));
    if (i % 8 == 0) bytes.resize(random() % bytes.size());
    try {
      take(read(bytes));
      ++understood;
    } catch (const ros::serialization::StreamOverrunException &) {
      continue;
    }
    for (const auto &[id, object] : scene.snapshot()->objects())
      ASSERT_TRUE(object->description.pose.matrix().allFinite()) << id;
  }
  EXPECT_GT(understood, 1000);
}

} // namespace
} // namespace curve_proximity
