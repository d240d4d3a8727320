/* SPDX-License-Identifier: BSD-3-Clause */
/* Scene, trajectory, URDF and SRDF files: each part of them is used, refused, or makes the answers partial. */
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include <urdf_parser/urdf_parser.h>

#include <curve_proximity/files.hpp>
#include <curve_proximity/motion.hpp>
#include <curve_proximity/urdf_model.hpp>

#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace fs = std::filesystem;

namespace {

/* A file of its own, away when the test is over. */
class TextFile {
 public:
  explicit TextFile(const std::string &text)
      : path_((fs::temp_directory_path() / ("files_" + std::to_string(::getpid()) + ".yaml")).string()) {
    std::ofstream(path_) << text;
  }
  ~TextFile() {
    std::error_code error;
    fs::remove(path_, error);
  }
  const std::string &path() const {
    return path_;
  }

 private:
  std::string path_;
};

/* A box, and an arm on it that turns about z. */
std::shared_ptr<const Robot> armRobot(const std::string &type = "revolute") {
  return Robot::fromUrdf(
      "<robot name='m'><link name='base'><collision><geometry><box size='0.4 0.4 0.4'/></geometry></collision></link>"
      "<link name='l'><collision><origin xyz='0 0 0.5'/><geometry><box size='0.1 0.1 "
      "0.4'/></geometry></collision></link>"
      "<joint name='j' type='" +
      type +
      "'><parent link='base'/><child link='l'/><axis xyz='0 0 1'/><limit lower='-4' upper='4'/></joint></robot>");
}

Srdf baseJoint(const std::string &type) {
  return parseSrdf("<robot name='m'><virtual_joint name='world_joint' type='" + type +
                   "' parent_frame='world' child_link='base'/></robot>");
}

SceneFileContents readScene(const std::string &text, const Robot *robot = nullptr, const Srdf &srdf = {}) {
  return loadSceneFile(TextFile(text).path(), robot, srdf);
}
std::string whyScene(const std::string &text, const Robot *robot = nullptr, const Srdf &srdf = {}) {
  return errorOf([&] { readScene(text, robot, srdf); });
}
TrajectoryDescription readTrajectory(const std::string &text) {
  std::vector<std::string> warnings;
  TrajectoryDescription out = loadTrajectoryFile(TextFile(text).path(), &warnings);
  EXPECT_EQ(warnings.empty(), out.coverage.complete());
  return out;
}
std::string whyTrajectory(const std::string &text) {
  return errorOf([&] { readTrajectory(text); });
}

std::string ball(const std::string &id, const std::string &at, const std::string &frame = "") {
  return "{id: " + id + ", header: {frame_id: '" + frame +
         "'}, primitives: [{type: 2, dimensions: [0.1]}], primitive_poses: [{position: [" + at + "]}]}";
}
std::string scene(const std::string &objects) {
  return "world: {collision_objects: [" + objects + "]}\n";
}

/* A JointTrajectory of two points. */
std::string joints(double from, double to, const std::string &indent = "", const std::string &second = "secs") {
  std::ostringstream out;
  out << indent << "joint_names: [j]\n" << indent << "points:\n";
  out << indent << "- {positions: [" << from << "], time_from_start: {" << second << ": 0}}\n";
  out << indent << "- {positions: [" << to << "], time_from_start: {" << second << ": 2}}\n";
  return out.str();
}
std::string arm(double from, double to) {
  return "joint_trajectory:\n" + joints(from, to, "  ");
}
std::string poseAt(const std::string &translation, const std::string &rotation = "0, 0, 0, 1") {
  return "{translation: [" + translation + "], rotation: [" + rotation + "]}";
}
/* A MultiDOFJointTrajectory of two points. */
std::string base(const std::string &from, const std::string &to, const std::string &frame = "world",
                 const std::string &joint = "world_joint") {
  return "multi_dof_joint_trajectory:\n  header: {frame_id: " + frame + "}\n  joint_names: [" + joint +
         "]\n  points:\n  - {transforms: [" + from + "], time_from_start: {secs: 0}}\n  - {transforms: [" + to +
         "], time_from_start: {secs: 2}}\n";
}

/* The robot along a trajectory, in a scene. */
RobotMotion moveIn(const Scene &in, TrajectoryDescription trajectory, const Srdf &srdf,
                   const Eigen::Isometry3d &place = Eigen::Isometry3d::Identity()) {
  adoptBase(srdf.virtual_joints, *in.snapshot()->robot(), trajectory);
  JointPositions rest = trajectory.fixed_joints;
  const Eigen::Isometry3d at = placeOf(trajectory, place, rest);
  return RobotMotion(in.snapshot(), trajectory, rest, srdf.disabled, at);
}
RobotMotion move(const std::string &trajectory, const Srdf &srdf = {}) {
  return moveIn(Scene(armRobot()), readTrajectory(trajectory), srdf);
}

double distanceOf(const RobotMotion &motion) {
  Workspace workspace;
  Query query;
  query.options.epsilon = 1e-9;
  const Answer answer = askEnvironment(motion, query, workspace).front();
  EXPECT_EQ(answer.result.status, CPROX_OK) << answer.message;
  EXPECT_LE(answer.result.upper - answer.result.lower, 1e-9);
  return answer.result.upper;
}

std::string link(const std::string &inside, const std::string &more = "", const std::string &attributes = "") {
  return "<robot name='r' " + attributes + "><link name='arm'>" + inside + "</link>" + more + "</robot>";
}
std::string collision(const std::string &geometry, const std::string &more = "") {
  return "<collision>" + more + "<geometry>" + geometry + "</geometry></collision>";
}
std::string whyUrdf(const std::string &xml) {
  return errorOf([&] { Robot::fromUrdf(xml); });
}
const std::string BOX = collision("<box size='0.1 0.1 1'/>");

/* The distance of a point from the arm's elements, at their poses. */
double distanceFrom(const Eigen::Vector3d &point, const std::string &inside, const std::string &attributes = "") {
  Scene around(Robot::fromUrdf(link(inside, "", attributes)));
  CurveDescription still = line(point, point + Eigen::Vector3d(0, 0, 1e-12));
  Query query;
  query.options.epsilon = 1e-9;
  const Answer answer = askOne(around, around.snapshot()->robot()->linkPoses({}), still, query);
  EXPECT_EQ(answer.result.status, CPROX_OK) << answer.message;
  return answer.result.upper;
}

} // namespace

/* ---- YAML: documents and keys ---- */

TEST(Files, a_second_document_is_refused_with_its_line) {
  const std::string one = scene(ball("a", "3, 0, 0"));
  for (const std::string &why :
       {whyScene(one + "---\n" + scene(ball("b", "1, 0, 0"))), whyScene("---\n" + one + "...\n---\n# more\nname: b\n")})
    expectContains(why, "a second document");
  expectContains(whyScene(one + "---\n" + one), "line 3");
  expectContains(whyTrajectory(arm(0, 1) + "---\n" + arm(0, 2)), "line 7: a second document");
  expectContains(whyScene(one + "---\nworld: ["), "no YAML"); // what is no YAML behind it, too
}

TEST(Files, empty_documents_around_a_message_are_as_rostopic_prints_it) {
  for (const std::string text : {"---\n", "---\n---\n", "---\n# end\n", "...\n"})
    EXPECT_EQ(readScene(scene(ball("a", "3, 0, 0")) + text).change.operations.size(), 1u);
  EXPECT_EQ(readTrajectory("---\n---\n" + arm(0, 1) + "---\n").points.size(), 2u);
  expectContains(whyScene("---\n---\n"), "empty");
}

TEST(Files, a_key_that_stands_twice_is_refused_with_both_lines) {
  const std::string one = scene(ball("a", "3, 0, 0"));
  expectContains(whyScene(one + one), "line 2: the key 'world' stands twice: in line 1, too");
  expectContains(whyScene("world:\n  collision_objects: []\n  octomap: {}\n  collision_objects: []\n"),
                 "line 4: the key 'collision_objects' stands twice: in line 2");
  expectContains(whyScene("world: {collision_objects: [{id: a, id: b}]}"), "'id' stands twice");
  expectContains(whyTrajectory(arm(0, 1) + "interpolation: linear\ninterpolation: cubic\n"), "line 7");
}

TEST(Files, aliases_are_read_and_merges_are_refused) {
  const SceneFileContents read = readScene("world: {collision_objects: [" + ball("a", "3, 0, 0") +
                                           ", {id: b, primitives: [{type: 2, dimensions: &d [0.5]}]}, "
                                           "{id: c, primitives: [{type: 2, dimensions: *d}]}]}");
  EXPECT_EQ(read.change.operations.at(2).object.shapes.at(0).dimensions, std::vector<double>{0.5});
  expectContains(whyScene("a: &a {id: b}\nworld: {collision_objects: [{<<: *a}]}"), "merged");
  expectContains(whyScene("world: &w {collision_objects: [*w]}"), "alias");
  expectContains(whyScene("world: {[1]: 2}"), "a key that is no word");
}

TEST(Files, unknown_keys_make_what_is_read_partial) {
  const std::string plain = scene(ball("a", "3, 0, 0"));
  EXPECT_TRUE(readScene(plain).change.coverage.complete());
  for (const std::string &text : std::vector<std::string>{
           plain + "worlds: {}\n", "world: {collision_objects: [], colision_objects: [" + ball("b", "1, 0, 0") + "]}",
           "world: {collision_objects: [{id: a, primitives: [{type: 2, dimensions: [1]}], primitive_pose: [{}]}]}",
           "world: {collision_objects: [{id: a, primitives: [{type: 2, dimensions: [1], pose: {}}]}]}"}) {
    const SceneFileContents read = readScene(text);
    EXPECT_EQ(read.change.coverage.status(), "partial") << text;
    ASSERT_EQ(read.warnings.size(), 1u);
    EXPECT_EQ(read.warnings, read.change.coverage.messages());
  }
  expectContains(readScene(plain + "worlds: {}\n").warnings.front(), "'worlds' (did you mean 'world'?)");
  EXPECT_EQ(readTrajectory(arm(0, 1) + "fixed_joint: {k: 1}\n").coverage.status(), "partial");
}

TEST(Files, what_is_no_scene_is_refused_with_the_cure) {
  const std::string cure = "objects stand under world: collision_objects";
  for (const std::string &text :
       std::vector<std::string>{std::string("objects: [") + ball("a", "3, 0, 0") + "]", ball("a", "3, 0, 0"),
                                "collision_objects: [" + ball("a", "3, 0, 0") + "]", std::string("{}"), arm(0, 1),
                                "world: {}\ncollision_objects: []"})
    expectContains(whyScene(text), cure);
}

TEST(Files, points_and_times_have_no_further_keys) {
  expectContains(
      whyScene("world: {collision_objects: [{id: a, primitives: [{type: 2, dimensions: [1]}], pose: {position: "
               "{x: 1, y: 2, z: 3, w: 4}}}]}"),
      "unknown key 'w'");
  expectContains(
      whyTrajectory("joint_trajectory: {joint_names: [j], points: [{positions: [1], time_from_start: {secs: 0, "
                    "nanosec: 5}}]}"),
      "unknown key 'secs'");
}

TEST(Files, what_stands_twice_in_a_message_is_refused_or_partial) {
  const auto robot = armRobot();
  expectContains(whyScene("robot_state: {joint_state: {name: [j, j], position: [0, 1]}}", robot.get()),
                 "'j' is named twice");
  expectContains(whyScene("link_padding: [{link_name: l, padding: 0.1}, {link_name: l, padding: 0.2}]"), "already");
  expectContains(whyScene("link_scale: [{link_name: l, scale: 1}, {link_name: l, scale: 2}]"), "already");
  EXPECT_EQ(readScene(scene(ball("a", "3, 0, 0") + ", " + ball("a", "1, 0, 0"))).change.coverage.status(), "partial");
  const std::string frames =
      "fixed_frame_transforms: [{child_frame_id: f, transform: {translation: [1, 0, 0]}}, "
      "{child_frame_id: f, transform: {translation: [2, 0, 0]}}]\n";
  EXPECT_EQ(readScene(frames).change.coverage.status(), "partial");
  const std::string moved = "fixed_frame_transforms: [{child_frame_id: world, transform: {translation: [1, 0, 0]}}]";
  EXPECT_EQ(readScene(moved).change.coverage.status(), "partial");
}

TEST(Files, joints_that_the_robot_does_not_have_make_its_own_scene_partial) {
  const auto robot = armRobot();
  const std::string state = "robot_state: {joint_state: {name: [j, k], position: [1, 2]}}\n";
  EXPECT_EQ(readScene(state, robot.get()).change.coverage.status(), "partial");
  EXPECT_TRUE(readScene("robot_model_name: fetch\n" + state, robot.get()).change.coverage.complete());
}

TEST(Files, bytes_of_an_octomap_are_bytes) {
  for (const std::string byte : {"300", "-129", "1.5"})
    expectContains(
        whyScene("world: {octomap: {octomap: {binary: true, id: OcTree, resolution: 0.1, data: [" + byte + "]}}}"),
        "is no byte");
}

/* ---- trajectories as ROS 1 and ROS 2 print them ---- */

TEST(Files, trajectories_are_read_as_ros_prints_them) {
  const std::vector<std::string> texts = {
      arm(0, 0.5),
      joints(0, 0.5),
      "header: {seq: 1, stamp: {secs: 0, nsecs: 0}, frame_id: ''}\n" + joints(0, 0.5, "", "sec"),
      "joint_trajectory:\n" + joints(0, 0.5, "  ", "sec") +
          "multi_dof_joint_trajectory: {header: {}, joint_names: [], points: []}\n",
      "model_id: m\ntrajectory:\n- joint_trajectory:\n" + joints(0, 0.5, "    "),
      "goal:\n  trajectory:\n" + joints(0, 0.5, "    ") +
          "  path_tolerance: []\n  goal_tolerance: []\n  goal_time_tolerance: {secs: 1, nsecs: 0}\n",
      "header: {}\ngoal_id: {stamp: {secs: 0, nsecs: 0}, id: ''}\ngoal:\n  trajectory:\n" + joints(0, 0.5, "    "),
      "trajectory:\n" + joints(0, 0.5, "  ", "sec") +
          "multi_dof_trajectory: {header: {}, joint_names: [], points: []}\ncomponent_path_tolerance: []\n",
      "group_name: arm\nplanning_time: 1\nerror_code: {val: 1}\ntrajectory_start: {is_diff: true}\ntrajectory:\n  "
      "joint_trajectory:\n" +
          joints(0, 0.5, "    ")};
  for (const std::string &text : texts) {
    const TrajectoryDescription read = readTrajectory(text);
    EXPECT_TRUE(read.coverage.complete()) << text;
    EXPECT_EQ(read.joints, std::vector<std::string>{"j"}) << text;
    ASSERT_EQ(read.points.size(), 2u) << text;
    EXPECT_EQ(read.points[1].time, 2.0) << text;
    EXPECT_EQ(read.points[1].positions, std::vector<double>{0.5}) << text;
  }
}

TEST(Files, a_file_with_several_trajectories_is_refused) {
  const std::string part = "- joint_trajectory:\n" + joints(0, 1, "    ");
  expectContains(whyTrajectory("trajectory:\n" + part + part), "has 2 trajectories");
  expectContains(whyTrajectory("trajectory: []\n"), "has 0 trajectories");
}

TEST(Files, a_trajectory_begins_at_its_start) {
  const std::string start = "trajectory_start:\n  joint_state: {name: [j, k], position: [0.25, 2]}\n";
  TrajectoryDescription read = readTrajectory(start + "trajectory:\n  joint_trajectory:\n" + joints(0, 1, "    "));
  EXPECT_EQ(read.fixed_joints.at("k"), 2.0);
  EXPECT_EQ(read.points.size(), 2u);
  read = readTrajectory(start +
                        "trajectory:\n  joint_trajectory: {joint_names: [j], points: [{positions: [1], "
                        "time_from_start: 1}]}");
  ASSERT_EQ(read.points.size(), 2u);
  EXPECT_EQ(read.points[0].positions, std::vector<double>{0.25});
  EXPECT_EQ(read.points[0].time, 0.0);
}

TEST(Files, what_a_link_carries_at_the_start_must_be_in_the_scene) {
  const std::string text =
      "trajectory_start: {attached_collision_objects: [{link_name: l, object: {id: tool}}]}\ntrajectory:\n- "
      "joint_trajectory:\n" +
      joints(0, 1, "    ");
  Scene with(armRobot());
  expectContains(errorOf([&] { moveIn(with, readTrajectory(text), {}); }), "carries 'tool'");
  SceneChange carries;
  Attachment tool;
  tool.link = "l";
  tool.object.id = "tool";
  tool.object.shapes.push_back(shape(ShapeType::SPHERE, {0.1}));
  carries.attachments.push_back(tool);
  EXPECT_TRUE(with.apply(carries).empty());
  moveIn(with, readTrajectory(text), {});
}

/* ---- bases by poses ---- */

TEST(Files, a_base_that_moves_by_poses_moves_the_robot) {
  const std::string text = arm(0, 0.5) + base(poseAt("0, 0, 0"), poseAt("6, 0, 0"));
  for (const std::string type : {"planar", "floating"}) {
    const RobotMotion motion = move(text, baseJoint(type));
    EXPECT_NEAR(motion.linkPoses(1.0).at("base").translation().x(), 3.0, 1e-12);
    EXPECT_NEAR(motion.linkPoses(1.0).at("l").linear()(1, 0), std::sin(0.25), 1e-12);
    Scene around(armRobot());
    around.apply(readScene(scene(ball("a", "3, 0.5, 0"))).change); // beside the way of the base: 0.5 - 0.2 - 0.1
    EXPECT_NEAR(distanceOf(moveIn(around, readTrajectory(text), baseJoint(type))), 0.2, 1e-9);
  }
  const RobotMotion alone =
      move("header: {frame_id: world}\njoint_names: [world_joint]\npoints: [{transforms: [" + poseAt("0, 0, 0") +
               "], time_from_start: 0}, {transforms: [" + poseAt("6, 0, 0") + "], time_from_start: 2}]",
           baseJoint("planar"));
  EXPECT_NEAR(alone.linkPoses(1.0).at("l").translation().x(), 3.0, 1e-12);
}

TEST(Files, a_base_turns_by_its_quaternions) {
  const std::string quarter = "0, 0, 0.70710678118654752, 0.70710678118654752";
  for (const std::string type : {"planar", "floating"}) {
    const RobotMotion motion = move(arm(0, 0) + base(poseAt("1, 2, 0"), poseAt("1, 2, 0", quarter)), baseJoint(type));
    EXPECT_NEAR(motion.linkPoses(2.0).at("base").linear()(1, 0), 1.0, 1e-12);
    EXPECT_NEAR(motion.linkPoses(2.0).at("base").translation().y(), 2.0, 1e-12);
  }
}

TEST(Files, a_base_that_stands_by_poses_stands_there_and_keeps_the_velocities) {
  const std::string text =
      "joint_trajectory: {joint_names: [j], points: [{positions: [0], velocities: [0], time_from_start: 0}, "
      "{positions: [1], velocities: [0], time_from_start: 2}]}\n";
  TrajectoryDescription read = readTrajectory(text + base(poseAt("3, 1, 0"), poseAt("3, 1, 0")));
  const RobotMotion motion = moveIn(Scene(armRobot()), read, baseJoint("planar"));
  EXPECT_NEAR(motion.linkPoses(0.7).at("base").translation().x(), 3.0, 1e-12);
  const double s = 0.35, cubic = s * s * (3 - 2 * s);
  EXPECT_NEAR(motion.linkPoses(0.7).at("l").linear()(1, 0), std::sin(cubic), 1e-12);

  /* a base that moves leaves the velocities out, and that is told unless it is meant */
  read = readTrajectory(text + base(poseAt("0, 0, 0"), poseAt("3, 1, 0")));
  adoptBase(baseJoint("planar").virtual_joints, *armRobot(), read);
  EXPECT_EQ(read.coverage.status(), "partial");
  read = readTrajectory(text + base(poseAt("0, 0, 0"), poseAt("3, 1, 0")) + "interpolation: linear\n");
  adoptBase(baseJoint("planar").virtual_joints, *armRobot(), read);
  EXPECT_TRUE(read.coverage.complete());
}

TEST(Files, poses_that_cannot_be_used_are_refused) {
  const auto why = [](const std::string &more, const Srdf &srdf) {
    return errorOf([&] { move(arm(0, 1) + more, srdf); });
  };
  const std::string away = poseAt("6, 0, 0"), here = poseAt("0, 0, 0");
  expectContains(why(base(here, away), {}), "is the SRDF given?");
  expectContains(why(base(here, away), baseJoint("fixed")), "world_joint");
  expectContains(why(base(here, away, "world", "wold_joint"), baseJoint("planar")),
                 "'wold_joint' is not at the identity");
  expectContains(why(base(here, away, "map"), baseJoint("planar")), "frame 'map', it moves in 'world'");
  expectContains(why(base(here, poseAt("0, 0, 1")), baseJoint("planar")), "plane");
  expectContains(why(base(here, poseAt("0, 0, 0", "0.6, 0, 0, 0.8")), baseJoint("planar")), "plane");
  expectContains(whyTrajectory(arm(0, 1) + "multi_dof_joint_trajectory: {joint_names: [w], points: []}"), "0 points");
  std::string late = base(here, away);
  late.replace(late.rfind("secs: 2"), 7, "secs: 3");
  expectContains(whyTrajectory(arm(0, 1) + late), "its time is 3");
  move(arm(0, 1) + base(here, here), {}); // the identity of a joint that is not there moves nothing
  move(arm(0, 1) + base(here, here, "odom", "other"), baseJoint("planar"));
  const auto unresolved = [&] {
    RobotMotion(Scene(armRobot()).snapshot(), readTrajectory(arm(0, 1) + base(here, away)), {}, {});
  };
  expectContains(errorOf(unresolved), "adoptBase()");
}

TEST(Files, planar_and_floating_joints_of_the_robot_move_by_poses) {
  const auto cart = [](const std::string &type) {
    return Robot::fromUrdf("<robot name='m'><link name='rail'/><link name='base'>" + BOX +
                           "</link><joint name='cart' type='" + type +
                           "'><parent link='rail'/><child link='base'/><axis xyz='0 0 1'/></joint></robot>");
  };
  for (const std::string type : {"planar", "floating"}) {
    const RobotMotion motion =
        moveIn(Scene(cart(type)), readTrajectory(base(poseAt("0, 0, 0"), poseAt("4, 2, 0"), "rail", "cart")), {});
    EXPECT_NEAR(motion.linkPoses(1.0).at("base").translation().y(), 1.0, 1e-12);
    const SceneFileContents read = readScene(
        "robot_state: {multi_dof_joint_state: {joint_names: [cart], transforms: [" + poseAt("4, 2, 0") + "]}}",
        cart(type).get());
    EXPECT_NEAR(cart(type)->linkPoses(read.joints).at("base").translation().x(), 4.0, 1e-12);
  }
}

TEST(Files, a_scene_puts_the_base_where_its_robot_state_says) {
  const auto robot = armRobot();
  const std::string state =
      "robot_state: {multi_dof_joint_state: {header: {frame_id: world}, joint_names: [world_joint], transforms: [" +
      poseAt("3, 0, 0") + "]}}\n";
  const Srdf srdf = baseJoint("planar");
  const std::string objects = scene(ball("in_world", "3, 1, 0.5") + ", " + ball("on_link", "0, 2, 0", "l") + ", " +
                                    ball("on_root", "1, 0, 0", "base"));
  const SceneFileContents read = readScene(state + objects, robot.get(), srdf);
  EXPECT_EQ(read.base.translation().x(), 3.0);
  const auto at = [&](std::size_t i) {
    return Eigen::Vector3d(read.change.operations.at(i).object.pose *
                           read.change.operations.at(i).object.shapes[0].pose.translation());
  };
  EXPECT_EQ(at(0), Eigen::Vector3d(3, 1, 0.5));
  EXPECT_EQ(at(1), Eigen::Vector3d(3, 2, 0)); // a frame of a link, whose root has moved
  EXPECT_EQ(at(2), Eigen::Vector3d(4, 0, 0)); // the root link is then not the fixed frame

  Scene around(robot);
  around.apply(readScene(state + scene(ball("a", "3.5, 0, 0.5")), robot.get(), srdf).change);
  EXPECT_NEAR(distanceOf(moveIn(around, readTrajectory(arm(0, 0.01)), srdf, read.base)), std::sqrt(0.18) - 0.1, 2e-3);
  /* a trajectory of the base says better where it is */
  const RobotMotion moved =
      moveIn(around, readTrajectory(arm(0, 1) + base(poseAt("0, 0, 0"), poseAt("1, 0, 0"))), srdf, read.base);
  EXPECT_NEAR(moved.linkPoses(2.0).at("base").translation().x(), 1.0, 1e-12);

  expectContains(whyScene(state, robot.get()), "is the SRDF given?");
  expectContains(whyScene(state, robot.get(), baseJoint("fixed")), "world_joint");
  std::string unmoved = state;
  unmoved.replace(unmoved.find("3, 0, 0"), 7, "0, 0, 0");
  EXPECT_TRUE(readScene(unmoved, robot.get()).change.coverage.complete());
}

/* ---- continuous joints ---- */

TEST(Files, a_continuous_joint_that_turns_the_long_way_is_told) {
  const Scene around(armRobot("continuous"));
  const RobotMotion far = moveIn(around, readTrajectory(arm(3.1, -3.1)), {});
  ASSERT_EQ(far.warnings().size(), 1u);
  expectContains(far.warnings().front(),
                 "continuous joint 'j' turns by -6.2 rad from point 0 to point 1; the short way is 0.08319");
  EXPECT_NEAR(far.linkPoses(1.0).at("l").linear()(0, 0), 1.0, 1e-12); // by 0
  EXPECT_TRUE(moveIn(around, readTrajectory(arm(-1.5, 1.5)), {}).warnings().empty());
  EXPECT_TRUE(moveIn(Scene(armRobot("revolute")), readTrajectory(arm(3.1, -3.1)), {}).warnings().empty());

  const RobotMotion near = moveIn(around, readTrajectory(arm(3.1, -3.1) + "shortest_way: true\n"), {});
  EXPECT_TRUE(near.warnings().empty());
  EXPECT_NEAR(near.linkPoses(1.0).at("l").linear()(0, 0), -1.0, 1e-12); // by pi
  EXPECT_NEAR(near.linkPoses(2.0).at("l").linear()(1, 0), std::sin(-3.1), 1e-12);

  const std::string drive =
      "joint_trajectory: {joint_names: [world_joint/x, world_joint/y, world_joint/theta], points: [{positions: "
      "[0, 0, 3.1], time_from_start: 0}, {positions: [0, 0, -3.1], time_from_start: 1}]}\n";
  ASSERT_EQ(move(drive, baseJoint("planar")).warnings().size(), 1u);
  EXPECT_NEAR(move(drive + "shortest_way: true\n", baseJoint("planar")).linkPoses(0.5).at("base").linear()(0, 0), -1.0,
              1e-12);
}

TEST(Files, the_shortest_way_keeps_followers_where_they_are_or_is_refused) {
  const auto follower = [](const std::string &multiplier) {
    return Robot::fromUrdf(
        "<robot name='m'><link name='a'/><link name='b'>" + BOX + "</link><link name='c'>" + BOX +
        "</link><joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint>"
        "<joint name='k' type='continuous'><parent link='b'/><child link='c'/><mimic joint='j' multiplier='" +
        multiplier + "'/></joint></robot>");
  };
  const std::string text = arm(3.1, -3.1) + "shortest_way: true\n";
  expectContains(errorOf([&] { moveIn(Scene(follower("0.5")), readTrajectory(text), {}); }), "'k' follows joint 'j'");
  moveIn(Scene(follower("-2")), readTrajectory(text), {});
}

/* ---- URDF ---- */

TEST(Files, what_xacro_has_left_is_refused) {
  const std::string space = "xmlns:xacro='http://www.ros.org/wiki/xacro'", cure = "this is xacro: expand it first";
  for (const std::string &xml : std::vector<std::string>{
           link(BOX, "<xacro:hand parent='arm'/>", space), link(BOX, "<xacro:include filename='hand.xacro'/>", space),
           link(BOX + "<xacro:if value='1'><collision/></xacro:if>", "", space),
           link(BOX, "<x:hand/>", "xmlns:x='http://ros.org/wiki/xacro'"), link(collision("<box size='${w} 1 1'/>")),
           link(BOX, "<joint name='$(arg p)j' type='fixed'/>"), link(BOX, "<macro name='hand'/>"),
           link(BOX, "<include filename='a'/>"), link(BOX, "<gazebo><xacro:a/></gazebo>", space),
           std::string("<robot name='${name}'><link name='a'/></robot>"),
           link(BOX + "<visual xacro:if='1'/>", "", space)})
    expectContains(whyUrdf(xml), cure);
  expectContains(whyUrdf("<robot name='r'>\n<link name='a'/>\n<xacro:hand/></robot>"), "line 3: <xacro:hand>");
  EXPECT_TRUE(Robot::fromUrdf(link(BOX, "<gazebo><plugin name='a'><p>$(find b)</p></plugin></gazebo>", space))
                  ->coverage()
                  .complete());
  expectContains(errorOf([&] { parseSrdf("<robot name='r'><xacro:arm/></robot>"); }), cure);
  expectContains(errorOf([&] { parseSrdf("<robot name='r'><disable_collisions link1='${a}' link2='b'/></robot>"); }),
                 cure);
}

TEST(Files, misspelt_elements_of_an_srdf_are_refused) {
  expectContains(errorOf([&] { parseSrdf("<robot name='r'>\n<enable_colisions link1='a' link2='b'/></robot>"); }),
                 "line 2: <enable_colisions> is not known (did you mean 'enable_collisions'?)");
  expectContains(errorOf([&] { parseSrdf("<robot name='r'><group name='a'><lnk name='b'/></group></robot>"); }),
                 "<lnk>");
  parseSrdf(
      "<robot name='r'><group_state name='home' group='a'/><end_effector name='e' parent_link='a' group='b'/>"
      "<passive_joint name='j'/><joint_property joint_name='j' property_name='p' value='1'/>"
      "<link_sphere_approximation link='a'/><rotor_params/><gripper/></robot>");
}

/* A box of 0.1 x 0.1 x 1 m, laid along x; a point at x = 1: 0.5 m. */
TEST(Files, quaternions_of_origins_are_used) {
  const std::string quat = "quat_xyzw='0 0.7071067811865476 0 0.7071067811865476'";
  const auto laid = [&](const std::string &attributes) {
    return collision("<box size='0.1 0.1 1'/>", "<origin xyz='0 0 0' " + attributes + "/>");
  };
  for (const std::string version : {"", "version='1.0'", "version='1.1'"}) {
    EXPECT_NEAR(distanceFrom({1, 0, 0}, laid("rpy='0 1.5707963267948966 0'"), version), 0.5, 1e-9);
    EXPECT_NEAR(distanceFrom({1, 0, 0}, laid(quat), version), 0.5, 1e-9);
  }
  expectContains(whyUrdf(link(laid(quat + " rpy='0 0 0'"))), "both rpy and quat_xyzw");
  expectContains(whyUrdf(link(laid("quat_xyzw='0 0 0 0'"))), "its norm is not 1");
  expectContains(whyUrdf(link(laid("quat_xyzw='0 0 1'"))), "4 finite numbers");
  expectContains(whyUrdf(link(BOX, "", "version='2.0'")), "version '2.0'");

  const auto robot = Robot::fromUrdf(
      "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='fixed'><parent link='a'/>"
      "<child link='b'/><origin xyz='1 0 0' " +
      quat + "/></joint></robot>");
  EXPECT_NEAR(robot->linkPoses({}).at("b").linear()(0, 2), 1.0, 1e-12);
}

TEST(Files, capsules_are_used) {
  for (const std::string version : {"", "version='1.1'"})
    EXPECT_NEAR(distanceFrom({0, 0, 1}, collision("<capsule radius='0.05' length='0.9'/>"), version), 0.5, 1e-9);
  expectContains(whyUrdf(link(collision("<capsule radius='0.05'/>"))), "capsule has no length");
}

TEST(Files, shapes_of_size_0_are_points_lines_and_discs) {
  EXPECT_NEAR(distanceFrom({1, 2, 2}, collision("<box size='0 0 0'/>")), 3.0, 1e-9);
  EXPECT_NEAR(distanceFrom({1, 2, 2}, collision("<sphere radius='0'/>")), 3.0, 1e-9);
  EXPECT_NEAR(distanceFrom({3, 2, 4}, collision("<box size='0 4 0'/>")), 5.0, 1e-9); // a line
  EXPECT_NEAR(distanceFrom({3, 2, 4}, collision("<box size='6 4 0'/>")), 4.0, 1e-9); // a rectangle
  EXPECT_NEAR(distanceFrom({5, 2, 4}, collision("<box size='4 4 0'/>")), 5.0, 1e-9);
  EXPECT_NEAR(distanceFrom({3, 4, 2}, collision("<cylinder length='4' radius='0'/>")), 5.0, 1e-9);
  EXPECT_NEAR(distanceFrom({0, 5, 4}, collision("<cylinder length='0' radius='2'/>")), 5.0, 1e-9); // a disc
  EXPECT_NEAR(distanceFrom({0, 1, 4}, collision("<cylinder length='0' radius='2'/>")), 4.0, 1e-9);
  EXPECT_NEAR(distanceFrom({0, 3, 6}, collision("<capsule length='4' radius='0'/>")), 5.0, 1e-9);
  EXPECT_NEAR(distanceFrom({0, 3, 0}, collision("<capsule length='0' radius='1'/>")), 2.0, 1e-9);
  for (const std::string bad : {"<box size='-1 1 1'/>", "<sphere radius='-1'/>", "<cylinder length='-1' radius='1'/>"})
    expectContains(whyUrdf(link(collision(bad))), "below 0");
}

TEST(Files, limits_need_no_effort_and_no_velocity) {
  for (const std::string rest : {"", " effort='inf' velocity='inf'", " effort='' velocity='1'", " effort='none'"}) {
    const auto robot = Robot::fromUrdf(
        "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='revolute'><parent link='a'/>"
        "<child link='b'/><limit lower='-1' upper='2'" +
        rest + "/></joint></robot>");
    EXPECT_EQ(robot->joints().front().lower, -1.0);
    EXPECT_EQ(robot->joints().front().upper, 2.0);
  }
}

TEST(Files, a_second_geometry_or_origin_is_refused) {
  expectContains(whyUrdf(link(collision("<box size='1 1 1'/><sphere radius='9'/>"))),
                 "two geometries, <box> and <sphere>");
  expectContains(
      whyUrdf(link(
          "<collision><geometry><box size='1 1 1'/></geometry><geometry><box size='2 1 1'/></geometry></collision>")),
      "two of <geometry>");
  expectContains(whyUrdf(link(collision("<box size='1 1 1'/>", "<origin/><origin xyz='1 0 0'/>"))), "two of <origin>");
  expectContains(whyUrdf("<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='fixed'><parent "
                         "link='a'/><child link='b'/>"
                         "<origin/><origin xyz='1 0 0'/></joint></robot>"),
                 "joint 'j': it has two of <origin>");
  expectContains(whyUrdf(link(BOX) + link(BOX)), "second element");
}

TEST(Files, unknown_elements_of_a_urdf_make_the_robot_partial) {
  for (const std::string &xml : std::vector<std::string>{
           link(BOX, "<lnk name='b'/>"), link(BOX + "<colision/>"), link(BOX, "<loop_joint name='j'/>"),
           link(collision("<box size='1 1 1'/>", "<orign xyz='1 0 0'/>")),
           link(collision("<box size='1 1 1'/>", "<origin xzy='1 0 0'/>")),
           link(collision("<box size='1 1 1' scale='2'/>"))}) {
    const auto robot = Robot::fromUrdf(xml);
    EXPECT_EQ(robot->coverage().status(), "partial") << xml;
    EXPECT_EQ(robot->warnings().size(), 1u) << xml;
  }
  expectContains(Robot::fromUrdf(link(BOX + "<colision/>"))->warnings().front(),
                 "link 'arm': <colision> (line 1) is not known (did you mean 'collision'?)");
}

TEST(Files, the_reason_is_that_of_the_fault) {
  expectContains(whyUrdf("<robot name='r'><link name='a'/><link name='b'/></robot>"),
                 "Two root links found: [a] and [b]");
  expectContains(whyUrdf("<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='revolute'><parent "
                         "link='a'/><child link='b'/>"
                         "<limit lower='x' upper='1'/></joint></robot>"),
                 "joint 'j': limit lower='x' is not one finite number");
}

/* urdfdom reads the robots of test/data apart from this reader. */
TEST(Files, robots_are_as_urdfdom_reads_them) {
  for (const std::string name : {"panda", "fanuc_m10ia", "husky", "ur5"}) {
    RobotOptions options;
    options.resources.base_dir = TEST_DATA_DIR "/robots/" + name;
    const auto model = urdf::parseURDF(readText(options.resources.base_dir + "/" + name + ".urdf"));
    ASSERT_TRUE(model) << name;
    const auto theirs = fromModel(*model, options), ours = dataRobot(name);
    EXPECT_TRUE(ours->coverage().complete()) << name;
    ASSERT_EQ(ours->joints().size(), theirs->joints().size()) << name;
    for (std::size_t i = 0; i < ours->joints().size(); ++i) {
      const Robot::Joint &a = ours->joints()[i], &b = theirs->joints()[i];
      EXPECT_EQ(a.name, b.name);
      EXPECT_EQ(a.type, b.type);
      EXPECT_EQ(a.origin.matrix(), b.origin.matrix()) << a.name;
      EXPECT_EQ(a.axis, b.axis) << a.name;
      EXPECT_EQ(a.lower, b.lower) << a.name;
      EXPECT_EQ(a.upper, b.upper) << a.name;
      EXPECT_EQ(a.leader, b.leader) << a.name;
      EXPECT_EQ(a.multiplier, b.multiplier) << a.name;
    }
    for (const auto &[link, geometries] : ours->links()) {
      const std::vector<LinkGeometry> &other = theirs->links().at(link);
      ASSERT_EQ(geometries.size(), other.size()) << link;
      for (std::size_t i = 0; i < geometries.size(); ++i) {
        EXPECT_EQ(geometries[i].description.type, other[i].description.type) << link;
        EXPECT_EQ(geometries[i].description.dimensions, other[i].description.dimensions) << link;
        EXPECT_EQ(geometries[i].pose.matrix(), other[i].pose.matrix()) << link;
      }
    }
  }
}

/* ---- what is right goes through without a word ---- */

TEST(Files, scenes_and_trajectories_of_the_data_are_read_without_a_warning) {
  const auto panda = dataRobot("panda");
  const Srdf srdf = parseSrdf(readText(TEST_DATA_DIR "/robots/panda/panda.srdf"));
  std::size_t scenes = 0, trajectories = 0;
  for (const fs::directory_entry &entry : fs::recursive_directory_iterator(TEST_DATA_DIR "/scenes")) {
    const std::string path = entry.path().string(), name = entry.path().filename().string();
    if (entry.path().extension() != ".yaml" || name.rfind("request", 0) == 0) continue;
    if (path.find("/mbm/") != std::string::npos && path.find("_ur5/") != std::string::npos) {
      EXPECT_TRUE(loadSceneFile(path).change.coverage.complete()) << path; // of a robot that has a gripper, too
      continue;
    }
    const bool of_panda = path.find("/mbm/") != std::string::npos;
    if (!of_panda && readText(path).find("frame_id: base_link") != std::string::npos)
      continue; // of robots that are not here
    const SceneFileContents read = of_panda ? loadSceneFile(path, panda.get(), srdf) : loadSceneFile(path);
    EXPECT_EQ(read.warnings, std::vector<std::string>()) << path;
    EXPECT_TRUE(read.change.coverage.complete()) << path;
    ++scenes;
  }
  for (const fs::directory_entry &entry : fs::directory_iterator(TEST_DATA_DIR "/trajectories")) {
    std::vector<std::string> warnings;
    EXPECT_TRUE(loadTrajectoryFile(entry.path().string(), &warnings).coverage.complete());
    EXPECT_EQ(warnings, std::vector<std::string>()) << entry.path();
    ++trajectories;
  }
  EXPECT_GE(scenes, 20u);
  EXPECT_GE(trajectories, 20u);
}

/* A PlanningScene as `ros2 topic echo` prints one. */
TEST(Files, a_scene_of_ros_2_is_read_without_a_warning) {
  const SceneFileContents read = readScene(R"(name: ''
robot_state:
  joint_state: {header: {stamp: {sec: 0, nanosec: 0}, frame_id: ''}, name: [], position: [], velocity: [], effort: []}
  multi_dof_joint_state: {header: {stamp: {sec: 0, nanosec: 0}, frame_id: ''}, joint_names: [], transforms: [], twist: [], wrench: []}
  attached_collision_objects: []
  is_diff: false
robot_model_name: p
fixed_frame_transforms: []
allowed_collision_matrix: {entry_names: [], entry_values: [], default_entry_names: [], default_entry_values: []}
link_padding: []
link_scale: []
object_colors: []
world:
  collision_objects:
  - header: {stamp: {sec: 12, nanosec: 3}, frame_id: world}
    pose: {position: {x: 3.0, y: 0.0, z: 0.0}, orientation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}}
    id: b
    type: {key: '', db: ''}
    primitives: [{type: 1, dimensions: [1.0, 1.0, 1.0], polygon: {points: []}}]
    primitive_poses: [{position: {x: 0.0, y: 0.0, z: 0.0}, orientation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}}]
    meshes: []
    mesh_poses: []
    planes: []
    plane_poses: []
    subframe_names: []
    subframe_poses: []
    operation: 0
  octomap:
    header: {stamp: {sec: 0, nanosec: 0}, frame_id: ''}
    origin: {position: {x: 0.0, y: 0.0, z: 0.0}, orientation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}}
    octomap: {header: {stamp: {sec: 0, nanosec: 0}, frame_id: ''}, binary: false, id: '', resolution: 0.0, data: []}
is_diff: false
---
)",
                                           armRobot().get());
  EXPECT_EQ(read.warnings, std::vector<std::string>());
  EXPECT_EQ(read.change.operations.size(), 1u);
}
