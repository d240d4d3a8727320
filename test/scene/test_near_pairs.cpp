/* SPDX-License-Identifier: BSD-3-Clause */
/* Pairs of a standing robot against every pair placed by hand; variants of a snapshot; robots of parsed models and of
 * shapes in memory. */
#include <curve_proximity/near_pairs.hpp>
#include <curve_proximity/urdf_model.hpp>

#include <tuple>

#include <urdf_parser/urdf_parser.h>

#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

std::shared_ptr<const Robot> panda() {
  static const std::shared_ptr<const Robot> robot = dataRobot("panda");
  return robot;
}

JointPositions randomState(Random &random) {
  const double middle[] = {0.0, 0.0, 0.0, -1.5, 0.0, 1.8, 0.8};
  JointPositions out;
  for (int i = 0; i < 7; ++i) out["panda_joint" + std::to_string(i + 1)] = middle[i] + random.uniform(-1.2, 1.2);
  return out;
}

RobotPlacement placed(const Robot &robot, const JointPositions &state) {
  RobotPlacement out;
  for (const auto &[name, pose] : robot.linkPoses(state)) out.links.push_back(pose);
  return out;
}

/* A Panda with a padded hand among twelve shapes of several kinds. */
SnapshotPtr randomScene(Random &random) {
  Scene scene(panda());
  SceneChange out;
  const std::vector<ShapeDescription> kinds = {shape(ShapeType::BOX, {0.2, 0.1, 0.3}), shape(ShapeType::SPHERE, {0.1}),
                                               shape(ShapeType::CYLINDER, {0.3, 0.05}),
                                               shape(ShapeType::CONE, {0.2, 0.1})};
  for (std::size_t i = 0; i < 12; ++i)
    out.operations.push_back(add("object" + std::to_string(i), {kinds[i % 4]}, random.pose(0.9)));
  out.default_link_padding = 0.02;
  out.link_padding["panda_hand"] = 0.01;
  EXPECT_TRUE(scene.apply(out).empty());
  return scene.snapshot();
}

using Name = std::tuple<std::string, int, std::string, int>;

/* Every pair by its own pose and pair(): no boxes, no tree, no order. */
std::map<Name, cprox_result> everyPair(const Snapshot &scene, const LinkPoses &poses, Workspace &workspace) {
  struct One {
    std::string name;
    int part;
    cprox_obstacle body;
  };
  std::vector<One> robot, objects, unpadded; /* among themselves links have no padding */
  for (const auto &[link, geometries] : scene.robot()->links())
    for (std::size_t i = 0; i < geometries.size(); ++i) {
      const Eigen::Isometry3d pose = poses.at(link) * geometries[i].pose;
      const auto part = static_cast<int>(i);
      robot.push_back({link, part, at(geometries[i].geometry.surface, pose, scene.linkPadding(link))});
      unpadded.push_back({link, part, at(geometries[i].geometry.surface, pose, 0.0)});
    }
  for (const auto &[id, object] : scene.objects())
    for (std::size_t i = 0; i < object->shapes.size(); ++i)
      objects.push_back({id, static_cast<int>(i), object->shapes[i].placed.obstacle});
  std::map<Name, cprox_result> out;
  const auto measure = [&](const One &a, const One &b) {
    out[{a.name, a.part, b.name, b.part}] = pair(a.body, b.body, CPROX_OPTIONS_DEFAULT, workspace);
  };
  for (std::size_t i = 0; i < robot.size(); ++i) {
    for (const One &object : objects) measure(robot[i], object);
    for (std::size_t k = i + 1; k < robot.size(); ++k)
      if (robot[i].name != robot[k].name) measure(unpadded[i], unpadded[k]);
  }
  return out;
}

std::map<Name, NearPair> visited(const StandingRobot &robot, const RobotPlacement &placement,
                                 const NearPairsQuery &query, Workspace &workspace) {
  std::map<Name, NearPair> out;
  robot.visit(placement, query, workspace, [&](const NearPair &near) {
    const bool is_new = out.emplace(Name(*near.a.name, near.a.part, *near.b.name, near.b.part), near).second;
    EXPECT_TRUE(is_new) << *near.a.name << " and " << *near.b.name << " came twice";
    return query.reach;
  });
  return out;
}

std::set<std::string> names(const std::map<Name, NearPair> &pairs) {
  std::set<std::string> out;
  for (const auto &[name, near] : pairs) out.insert(std::get<0>(name) + " " + std::get<2>(name));
  return out;
}

/* A box in the hand's frame. */
std::shared_ptr<const AttachedObject> tool(const std::string &link, std::vector<std::string> touch_links,
                                           const Eigen::Isometry3d &pose) {
  Attachment out;
  out.link = link;
  out.touch_links = std::move(touch_links);
  out.object.id = "tool";
  out.object.pose = pose;
  out.object.shapes = {shape(ShapeType::BOX, {0.04, 0.04, 0.2})};
  return attachedObject(out);
}

} // namespace

/* 25 states (seed 81), each with three reaches: what is within reach is visited and nothing that is farther; intervals
 * meet, epsilon 1e-6 of both. */
TEST(NearPairs, are_those_within_reach_of_every_pair) {
  Random random(81);
  const SnapshotPtr scene = randomScene(random);
  const StandingRobot robot(scene);
  Workspace workspace;
  std::size_t touching = 0, apart = 0;
  for (int i = 0; i < 25; ++i) {
    const JointPositions state = randomState(random);
    const auto all = everyPair(*scene, panda()->linkPoses(state), workspace);
    for (const double reach : {0.0, 0.15, INFINITE}) {
      NearPairsQuery query;
      query.reach = reach;
      query.may_touch = [](const std::string &, const std::string &) { return false; };
      const auto near = visited(robot, placed(*panda(), state), query, workspace);
      for (const auto &[name, expected] : all) {
        const auto it = near.find(name);
        if (it == near.end()) {
          EXPECT_GT(expected.upper, reach) << std::get<0>(name) << " and " << std::get<2>(name);
          continue;
        }
        const cprox_result &result = it->second.result;
        EXPECT_LE(result.lower, reach);
        EXPECT_LE(result.lower, expected.upper);
        if (expected.status != CPROX_OVERLAP) {
          EXPECT_GE(result.upper, expected.lower);
        }
        EXPECT_EQ(result.verdict == CPROX_VERDICT_VIOLATED, expected.upper <= 0.0);
        (expected.upper <= 0.0 ? touching : apart) += 1;
      }
      if (std::isinf(reach)) {
        EXPECT_EQ(near.size(), all.size());
      }
    }
  }
  EXPECT_GT(touching, 100u);
  EXPECT_GT(apart, 4000u);
}

/* A sphere of .1 m with a padding of .05 m, and a box whose face is .01 m on either side of the reach. The box of the
 * sphere ends where the padded sphere does: without the padding the box is not looked at. */
TEST(NearPairs, the_padding_of_a_link_reaches_as_far_as_it_is) {
  const std::shared_ptr<const Robot> ball = Robot::fromUrdf(
      "<robot name='m'><link name='ball'><collision><geometry><sphere radius='0.1'/></geometry></collision></link>"
      "</robot>");
  Workspace workspace;
  for (const double reach : {0.0, 0.3}) {
    for (const double gap : {-0.01, 0.01}) {
      Scene scene(ball);
      SceneChange all = change(
          {add("box", {shape(ShapeType::BOX, {0.5, 0.5, 0.5})}, translation(0.1 + 0.05 + reach + gap + 0.25, 0, 0))});
      all.link_padding["ball"] = 0.05;
      ASSERT_TRUE(scene.apply(all).empty());
      NearPairsQuery query;
      query.reach = reach;
      const auto near = visited(StandingRobot(scene.snapshot()), placed(*ball, {}), query, workspace);
      EXPECT_EQ(near.size(), gap < 0.0 ? 1u : 0u) << reach << " " << gap;
    }
  }
}

/* 40 states (seed 82): a visitor that narrows its reach finds what askEnvironment() and askSelf() find by joint values.
 */
TEST(NearPairs, the_nearest_is_that_of_the_state_by_joint_values) {
  Random random(82);
  const SnapshotPtr scene = randomScene(random);
  const Srdf srdf = parseSrdf(readText(TEST_DATA_DIR "/robots/panda/panda.srdf"));
  const SnapshotPtr allowing = scene->variant({std::nullopt, allowedPairs(srdf)});
  const StandingRobot robot(allowing);
  const PreparedRobot prepared(allowing);
  Workspace workspace;
  for (int i = 0; i < 40; ++i) {
    const JointPositions state = randomState(random);
    const RobotMotion motion(prepared, state);
    for (const RobotPairs pairs : {RobotPairs::ENVIRONMENT, RobotPairs::SELF}) {
      const bool self = pairs == RobotPairs::SELF;
      double lower = INFINITE, upper = INFINITE;
      std::size_t count = 0;
      NearPairsQuery query;
      query.pairs = pairs;
      query.reach = INFINITE;
      robot.visit(placed(*panda(), state), query, workspace, [&](const NearPair &near) {
        EXPECT_EQ(near.b.owner, self ? BodyOwner::LINK : BodyOwner::OBJECT);
        lower = std::min(lower, std::max(0.0, near.result.lower));
        upper = std::min(upper, std::max(0.0, near.result.upper));
        ++count;
        return upper;
      });
      const Answer answer =
          self ? askSelf(motion, Query(), workspace) : askEnvironment(motion, Query(), workspace).front();
      EXPECT_LE(lower, answer.result.upper);
      EXPECT_GE(upper, answer.result.lower);
      EXPECT_LT(count, self ? 30u : 60u); // of 45 and 132
    }
  }
}

/* 60 states (seed 83): the coarse widths are left as soon as a verdict is certain, and no verdict changes. */
TEST(NearPairs, verdicts_are_those_of_the_fine_intervals) {
  Random random(83);
  const SnapshotPtr scene = randomScene(random);
  const StandingRobot robot(scene);
  Workspace workspace;
  for (int i = 0; i < 60; ++i) {
    const RobotPlacement placement = placed(*panda(), randomState(random));
    NearPairsQuery query;
    query.reach = 0.05;
    const auto fine = visited(robot, placement, query, workspace);
    query.verdicts_only = true;
    const auto coarse = visited(robot, placement, query, workspace);
    for (const auto &[name, near] : fine) {
      ASSERT_EQ(coarse.count(name), 1u);
      EXPECT_EQ(coarse.at(name).result.verdict, near.result.verdict);
    }
  }
}

TEST(NearPairs, links_and_rules_leave_pairs_out) {
  Random random(84);
  const StandingRobot robot(randomScene(random));
  const RobotPlacement placement = placed(*panda(), {});
  Workspace workspace;
  NearPairsQuery query;
  query.reach = INFINITE;
  query.links = {"panda_hand"};
  for (const auto &[name, near] : visited(robot, placement, query, workspace))
    EXPECT_TRUE(std::get<0>(name) == "panda_hand" || std::get<2>(name) == "panda_hand");

  query.links.clear();
  query.may_touch = [](const std::string &a, const std::string &b) { return a == "panda_link0" || b == "panda_link0"; };
  const std::set<std::string> left = names(visited(robot, placement, query, workspace));
  EXPECT_EQ(left.count("panda_link0 object0"), 0u);
  EXPECT_EQ(left.count("panda_link1 object0"), 1u);

  query.may_touch = nullptr;
  query.reach = 0.0;
  int seen = 0;
  robot.visit(placement, query, workspace, [&](const NearPair &) { return ++seen, -1.0; });
  EXPECT_EQ(seen, 1) << "a reach below 0 ends the visit";
}

/* The same scene for a hand that carries a tool and for one that does not; MoveIt's rule about the link that carries.
 */
TEST(NearPairs, what_is_carried_belongs_to_the_state) {
  Random random(85);
  const StandingRobot robot(randomScene(random));
  Workspace workspace;
  RobotPlacement placement = placed(*panda(), {});
  NearPairsQuery query;
  query.reach = INFINITE;
  EXPECT_EQ(names(visited(robot, placement, query, workspace)).count("tool object0"), 0u);

  placement.attached = {{"tool", tool("panda_hand", {"panda_leftfinger"}, translation(0.0, 0.0, 0.1))}};
  std::set<std::string> seen = names(visited(robot, placement, query, workspace));
  EXPECT_EQ(seen.count("tool object0"), 1u);
  EXPECT_EQ(seen.count("panda_rightfinger tool"), 1u);
  EXPECT_EQ(seen.count("panda_leftfinger tool"), 0u) << "it is a touch link";
  EXPECT_EQ(seen.count("panda_hand tool"), 0u) << "the hand carries it";
  query.carriers = true;
  seen = names(visited(robot, placement, query, workspace));
  EXPECT_EQ(seen.count("panda_hand tool"), 1u);

  placement.attached = {{"tool", tool("panda_hand", {"panda_hand"}, Eigen::Isometry3d::Identity())}};
  EXPECT_EQ(names(visited(robot, placement, query, workspace)).count("panda_hand tool"), 0u);

  placement.attached = {{"tool", tool("no_link", {}, Eigen::Isometry3d::Identity())}};
  expectContains(errorOf([&] { visited(robot, placement, query, workspace); }), "has no link 'no_link'");
  placement.attached.clear();
  placement.links.pop_back();
  expectContains(errorOf([&] { visited(robot, placement, query, workspace); }), "poses were given");
}

/* Boxes by hand: a hand's box is 10 mm deep in an object; surfaces have the depth of their hulls. */
TEST(NearPairs, contacts_have_a_depth_and_a_normal) {
  const std::string urdf =
      "<robot name='r'><link name='base'/><link name='plate'/><joint name='j' type='fixed'>"
      "<parent link='base'/><child link='plate'/></joint></robot>";
  ShapeDescription cube = shape(ShapeType::MESH, {});
  cube.vertices.resize(3, 8);
  for (int i = 0; i < 8; ++i) cube.vertices.col(i) << (i & 1) - 0.5, ((i >> 1) & 1) - 0.5, ((i >> 2) & 1) - 0.5;
  cube.triangles.resize(3, 12);
  cube.triangles << 0, 3, 4, 7, 0, 5, 2, 7, 0, 6, 1, 7, /**/ 2, 1, 5, 6, 1, 4, 6, 3, 4, 2, 3, 5, /**/ 1, 2, 6, 5, 5, 0,
      3, 6, 2, 4, 7, 3;
  for (const ShapeDescription &of_plate : {shape(ShapeType::BOX, {1.0, 1.0, 1.0}), cube}) {
    RobotOptions options;
    options.link_shapes["plate"] = {of_plate};
    const auto robot = Robot::fromUrdf(urdf, options);
    Scene scene(robot);
    ASSERT_TRUE(scene
                    .apply(change({add("block", {shape(ShapeType::BOX, {1.0, 1.0, 1.0})}, translation(0.99, 0.1, 0.0)),
                                   add("floor", {shape(ShapeType::HALFSPACE, {0.0, 0.0, 1.0, 0.48})})}))
                    .empty());
    Workspace workspace;
    RobotPlacement placement;
    placement.links.assign(2, Eigen::Isometry3d::Identity());
    const auto near = visited(StandingRobot(scene.snapshot()), placement, {}, workspace);
    ASSERT_EQ(near.size(), 2u);
    const cprox_result &block = near.at({"plate", 0, "block", 0}).result,
                       &floor = near.at({"plate", 0, "floor", 0}).result;
    EXPECT_NEAR(block.lower, -0.01, 1e-6);
    EXPECT_EQ(block.verdict, CPROX_VERDICT_VIOLATED);
    EXPECT_NEAR(std::abs(block.normal.x), 1.0, 1e-6);
    EXPECT_LT(block.normal.x, 0.0) << "from b to a";
    EXPECT_NEAR(floor.lower, -0.02, 1e-9);
    EXPECT_NEAR(floor.normal.z, 1.0, 1e-9);
  }
}

/* 12 motions (seed 86): a variant answers as a scene that was changed for good. */
TEST(SceneVariants, answer_as_a_scene_that_was_changed) {
  Random random(86);
  Scene scene(panda());
  const SnapshotPtr before = randomScene(random);
  SceneChange objects;
  for (const auto &[id, object] : before->objects())
    objects.operations.push_back({Operation::Kind::ADD, object->description});
  ASSERT_TRUE(scene.apply(objects).empty());
  const SnapshotPtr plain = scene.snapshot();
  const Eigen::Isometry3d pose = translation(0.0, 0.0, 0.15);

  SceneChange changed;
  Attachment attach;
  attach.link = "panda_hand";
  attach.object.id = "tool";
  attach.object.pose = pose;
  attach.object.shapes = {shape(ShapeType::BOX, {0.04, 0.04, 0.2})};
  changed.attachments = {attach};
  changed.allowed = {{"panda_link0", "object1", true}, {"object2", "", true}};
  ASSERT_TRUE(scene.apply(changed).empty());
  const SnapshotPtr variant =
      plain->variant({AttachedObjects{{"tool", tool("panda_hand", {}, pose)}}, changed.allowed});
  EXPECT_EQ(&variant->world(), &plain->world()) << "objects and their tree are shared";
  EXPECT_TRUE(plain->attached().empty());

  Workspace workspace;
  for (int i = 0; i < 12; ++i) {
    TrajectoryDescription path;
    path.points.resize(2);
    path.points[1].time = 1.0;
    for (TrajectoryPoint &point : path.points)
      for (const auto &[joint, value] : randomState(random)) {
        if (&point == &path.points[0]) path.joints.push_back(joint);
        point.positions.push_back(value);
      }
    const Answer a = askEnvironment(RobotMotion(variant, path, {}), Query(), workspace).front();
    const Answer b = askEnvironment(RobotMotion(scene.snapshot(), path, {}), Query(), workspace).front();
    EXPECT_EQ(a.result.lower, b.result.lower);
    EXPECT_EQ(a.a, b.a);
    EXPECT_EQ(a.b, b.b);
  }
}

TEST(SceneVariants, refuse_what_a_scene_refuses) {
  Random random(87);
  const SnapshotPtr scene = randomScene(random);
  const auto with = [&](const std::string &id, const std::string &link) {
    return scene->variant({AttachedObjects{{id, tool(link, {}, Eigen::Isometry3d::Identity())}}, std::nullopt});
  };
  expectContains(errorOf([&] { with("object1", "panda_hand"); }), "an object of the scene has the same id");
  expectContains(errorOf([&] { with("tool", "panda_hnd"); }), "has no link 'panda_hnd'");
  expectContains(errorOf([&] {
                   scene->variant({std::nullopt, std::vector<AllowedPair>{{"", "a", true}}});
                 }),
                 "no first name");
  Attachment nameless;
  nameless.object.shapes = {shape(ShapeType::SPHERE, {0.1})};
  expectContains(errorOf([&] { attachedObject(nameless); }), "it has no id");
}

/* The robot of a parsed model is that of its text: link by link, joint by joint. */
TEST(ParsedModels, give_the_robot_of_their_text) {
  RobotOptions options;
  options.resources.base_dir = TEST_DATA_DIR "/robots/panda";
  const auto model = urdf::parseURDF(readText(options.resources.base_dir + "/panda.urdf"));
  ASSERT_TRUE(model);
  const auto robot = fromModel(*model, options);
  EXPECT_EQ(robot->name(), panda()->name());
  EXPECT_EQ(robot->rootLink(), panda()->rootLink());
  EXPECT_EQ(robot->variables(), panda()->variables());
  ASSERT_EQ(robot->joints().size(), panda()->joints().size());
  for (std::size_t i = 0; i < robot->joints().size(); ++i) {
    EXPECT_EQ(robot->joints()[i].name, panda()->joints()[i].name);
    EXPECT_EQ(robot->joints()[i].lower, panda()->joints()[i].lower);
    EXPECT_EQ(robot->joints()[i].origin.matrix(), panda()->joints()[i].origin.matrix());
  }
  ASSERT_EQ(robot->links().size(), panda()->links().size());
  for (const auto &[name, geometries] : panda()->links()) {
    ASSERT_EQ(robot->links().at(name).size(), geometries.size());
    for (std::size_t i = 0; i < geometries.size(); ++i) {
      const auto of = [](const LinkGeometry &g) { return cprox_body_get_info(g.geometry.body.get()).radius; };
      EXPECT_EQ(of(robot->links().at(name)[i]), of(geometries[i]));
      EXPECT_EQ(robot->links().at(name)[i].pose.matrix(), geometries[i].pose.matrix());
    }
  }

  options.link_shapes["panda_hand"] = {shape(ShapeType::SPHERE, {0.1}), shape(ShapeType::BOX, {0.1, 0.1, 0.1})};
  const auto replaced = fromModel(*model, options);
  EXPECT_EQ(replaced->links().at("panda_hand").size(), 2u);
  EXPECT_EQ(replaced->links().at("panda_link5").size(), panda()->links().at("panda_link5").size());

  options.link_shapes = {{"hand", {}}};
  expectContains(errorOf([&] { fromModel(*model, options); }), "has no link 'hand'");
  options.link_shapes = {{"panda_hand", {shape(ShapeType::SPHERE, {-0.1})}}};
  expectContains(errorOf([&] { fromModel(*model, options); }), "link 'panda_hand': sphere");
  expectContains(errorOf([&] { fromModel(urdf::ModelInterface(), {}); }), "no root link");
}
