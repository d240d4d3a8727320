/* SPDX-License-Identifier: BSD-3-Clause */
/* A URDF whose geometry would go missing is refused, and the message names the link. */
#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace {

std::string urdf(const std::string &body) {
  return "<?xml version='1.0'?><robot name='r'>" + body + "</robot>";
}

std::string collision(const std::string &geometry, const std::string &more = "") {
  return "<collision>" + more + "<geometry>" + geometry + "</geometry></collision>";
}

std::string link(const std::string &inside) {
  return "<link name='arm'>" + inside + "</link>";
}

std::string why(const std::string &xml, const RobotOptions &options = {}) {
  return errorOf([&] { Robot::fromUrdf(xml, options); });
}

std::string whyLink(const std::string &inside) {
  const std::string reason = why(urdf(link(inside)));
  expectContains(reason, "link 'arm'");
  return reason;
}

std::string joint(const std::string &type, const std::string &inside,
                  const std::string &ends = "<parent link='a'/><child link='b'/>") {
  return urdf("<link name='a'/><link name='b'/><joint name='elbow' type='" + type + "'>" + ends + inside + "</joint>");
}

const std::string BOX = collision("<box size='1 1 1'/>");
const std::string LIMIT = "<limit lower='-1' upper='1' effort='1' velocity='1'/>";

} // namespace

TEST(BadRobots, what_is_no_urdf_is_refused) {
  expectContains(why(""), "no XML");
  expectContains(why("hello"), "XML");
  expectContains(why("<robot name='r'><link name='a'>"), "no XML");
  expectContains(why("<sdf/>"), "an SDF file");
  expectContains(why("<mujoco/>"), "MJCF");
  expectContains(why("<model/>"), "no <robot>");
  expectContains(why("<robot><link name='a'/></robot>"), "no name");
  expectContains(why(urdf("")), "no links");
}

TEST(BadRobots, geometries_that_cannot_be_used_are_refused_by_link) {
  expectContains(whyLink(collision("<torus length='1' radius='1'/>")), "'torus' is not known");
  expectContains(whyLink(BOX + collision("<torus length='1' radius='1'/>")), "collision element 2");
  expectContains(whyLink(collision("<torus length='1' radius='1'/>") + BOX), "collision element 1");
  expectContains(whyLink("<collision/>"), "no geometry");
  expectContains(whyLink(collision("")), "no geometry");
  expectContains(whyLink(collision("<box size='1 1'/>")), "box");
  expectContains(whyLink(collision("<box size='1 one 1'/>")), "box");
  expectContains(whyLink(collision("<sphere/>")), "sphere");
  expectContains(whyLink(collision("<cylinder length='1'/>")), "cylinder");
}

TEST(BadRobots, dimensions_must_be_finite_and_not_negative) {
  for (const std::string bad : {"-1", "nan", "inf", "-inf", "1e999"}) {
    whyLink(collision("<sphere radius='" + bad + "'/>"));
    whyLink(collision("<cylinder length='" + bad + "' radius='1'/>"));
    whyLink(collision("<cylinder length='1' radius='" + bad + "'/>"));
    whyLink(collision("<box size='1 " + bad + " 1'/>"));
  }
}

TEST(BadRobots, origins_must_be_finite) {
  whyLink(collision("<sphere radius='1'/>", "<origin xyz='nan 0 0'/>"));
  whyLink(collision("<sphere radius='1'/>", "<origin rpy='0 inf 0'/>"));
  expectContains(why(joint("fixed", "<origin xyz='0 0 nan'/>")), "elbow");
}

TEST(BadRobots, meshes_must_be_there_and_usable) {
  RobotOptions options;
  options.resources.base_dir = TEST_DATA_DIR "/robots/panda";
  const auto whyMesh = [&](const std::string &attributes) {
    const std::string reason = why(urdf(link(collision("<mesh " + attributes + "/>"))), options);
    expectContains(reason, "link 'arm'");
    return reason;
  };
  expectContains(whyMesh("filename='meshes/none.stl'"), "meshes/none.stl");
  expectContains(whyMesh("filename='panda.srdf'"), "panda.srdf"); // not a mesh
  expectContains(whyMesh("filename='http://example.org/a.stl'"), "http");
  expectContains(whyMesh("filename='package://nobody/a.stl'"), "nobody");
  expectContains(whyMesh("filename='meshes/finger.stl' scale='1 0 1'"), "scale");
  expectContains(whyMesh("filename='meshes/finger.stl' scale='1 nan 1'"), "finite");
  whyMesh("filename='meshes/finger.stl' scale='1 1'");
  whyMesh("filename=''");
  whyMesh("");
}

TEST(BadRobots, missing_geometry_can_be_insisted_on) {
  RobotOptions options;
  options.allow_missing_geometry = true;
  const auto robot = Robot::fromUrdf(
      urdf(link(BOX + collision("<sphere radius='-1'/>") + collision("<torus radius='1' length='1'/>"))), options);
  EXPECT_EQ(robot->links().at("arm").size(), 1u);
  ASSERT_EQ(robot->warnings().size(), 2u);
  expectContains(robot->warnings()[0], "link 'arm', collision element 2");
  expectContains(robot->warnings()[1], "link 'arm', collision element 3");
  EXPECT_FALSE(robot->coverage().complete()); // what is asked of it is never clear
}

TEST(BadRobots, what_does_not_collide_does_not_matter) {
  const auto robot = Robot::fromUrdf(urdf(link("<visual><geometry><capsule/></geometry></visual>"
                                               "<inertial><mass value='none'/></inertial>" +
                                               BOX) +
                                          "<gazebo/><transmission/><material name='m'/>"));
  EXPECT_EQ(robot->links().at("arm").size(), 1u);
}

TEST(BadRobots, trees_must_be_trees) {
  expectContains(why(urdf("<link name='a'/><link name='a'/>")), "link 'a' occurs twice");
  expectContains(why(urdf("<link/>")), "no name");
  EXPECT_FALSE(why(urdf("<link name='a'/><link name='b'/>")).empty()); // two roots
  expectContains(why(joint("fixed", "", "<parent link='a'/><child link='c'/>")), "child link 'c' does not exist");
  expectContains(why(joint("fixed", "", "<child link='b'/>")), "no parent link");
  expectContains(why(joint("fixed", "", "<parent link='a'/>")), "no child link");
  const std::string fixed = " type='fixed'><parent link='a'/><child link='b'/></joint>";
  expectContains(why(urdf("<link name='a'/><link name='b'/><joint name='j'" + fixed + "<joint name='j'" + fixed)),
                 "joint 'j' occurs twice");
  expectContains(why(urdf("<link name='a'/><link name='b'/><joint name='j'" + fixed + "<joint name='k'" + fixed)),
                 "child of two joints");
  expectContains(why(urdf("<link name='r'/><link name='a'/><link name='b'/>"
                          "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"
                          "<joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint>")),
                 "not connected");
}

TEST(BadRobots, joints_must_be_usable) {
  expectContains(why(joint("hinge", "")), "joint 'elbow': its type 'hinge'");
  expectContains(why(joint("revolute", "<axis xyz='0 0 1'/>")), "elbow': a revolute joint needs limits");
  expectContains(why(joint("continuous", "<axis xyz='0 0 0'/>")), "elbow': its axis");
  expectContains(why(joint("prismatic", LIMIT + "<axis xyz='0 nan 1'/>")), "elbow': axis xyz='0 nan 1'");
  expectContains(why(joint("prismatic", "<limit lower='2' upper='1' effort='1' velocity='1'/>")), "elbow");
  expectContains(why(joint("prismatic", "<limit lower='nan' upper='1' effort='1' velocity='1'/>")), "elbow");
  EXPECT_FALSE(why(joint("continuous", "<axis xyz='0 1'/>")).empty());
}

TEST(BadRobots, mimic_joints_need_a_leader) {
  expectContains(why(joint("continuous", "<mimic joint='shoulder'/>")), "joint 'shoulder', which does not exist");
  expectContains(why(joint("continuous", "<mimic joint='elbow'/>")), "ring");
  expectContains(
      why(urdf("<link name='a'/><link name='b'/><link name='c'/>"
               "<joint name='j' type='continuous'><parent link='a'/><child link='b'/><mimic joint='k'/></joint>"
               "<joint name='k' type='continuous'><parent link='b'/><child link='c'/><mimic joint='j'/></joint>")),
      "ring");
  expectContains(why(joint("floating", "<mimic joint='elbow'/>")), "elbow");
}

/* Seed 51, 3000 damaged copies of the Husky: each is read or refused; nothing else may happen. */
TEST(BadRobots, damaged_files_are_read_or_refused) {
  const std::string whole = readText(TEST_DATA_DIR "/robots/husky/husky.urdf");
  RobotOptions options;
  options.resources.base_dir = TEST_DATA_DIR "/robots/husky";
  Random random(51);
  std::size_t refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string xml = whole;
    for (std::size_t k = 0; k <= random.below(3); ++k) {
      const std::size_t at = random.below(xml.size());
      if (random.below(4) == 0) {
        xml.resize(at);
      } else {
        xml[at] = static_cast<char>(random.below(256));
      }
      if (xml.empty()) xml = " ";
    }
    try {
      const auto robot = Robot::fromUrdf(xml, options);
      EXPECT_FALSE(robot->links().empty());
      robot->linkPoses({});
    } catch (const Error &error) {
      ++refused;
      EXPECT_FALSE(std::string(error.what()).empty());
    }
  }
  EXPECT_GT(refused, 0u);
  EXPECT_LT(refused, 3000u);
}
