/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions and states of a prepared robot: the same answers as those of a robot that is not prepared. */
#include <curve_proximity/motion.hpp>

#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace {

const std::vector<std::string> JOINTS = {"panda_joint1", "panda_joint2", "panda_joint3", "panda_joint4",
                                         "panda_joint5", "panda_joint6", "panda_joint7"};

std::shared_ptr<const Robot> panda() {
  static const std::shared_ptr<const Robot> robot = dataRobot("panda");
  return robot;
}

Srdf pandaSrdf() {
  return parseSrdf(readText(TEST_DATA_DIR "/robots/panda/panda.srdf"));
}

/* A Panda among eight boxes, one of which a link may touch. */
SnapshotPtr scene(Random &random) {
  const Srdf srdf = pandaSrdf();
  Scene out(panda(), {}, allowedPairs(srdf));
  SceneChange change;
  for (int i = 0; i < 8; ++i) {
    const std::string id = "box" + std::to_string(i);
    change.operations.push_back(add(id, {shape(ShapeType::BOX, {0.1, 0.2, 0.3})}, random.pose(1.0)));
  }
  change.allowed.push_back({"box3", "panda_link2", true});
  EXPECT_TRUE(out.apply(change).empty());
  return out.snapshot();
}

std::vector<double> randomState(Random &random) {
  std::vector<double> out;
  for (const double middle : {0.0, 0.0, 0.0, -1.5, 0.0, 1.8, 0.8}) out.push_back(middle + random.uniform(-1.0, 1.0));
  return out;
}

TrajectoryDescription edge(const std::vector<double> &from, const std::vector<double> &to) {
  TrajectoryDescription out;
  out.id = "edge";
  out.joints = JOINTS;
  out.points.resize(2);
  out.points[0].positions = from;
  out.points[1].positions = to;
  out.points[1].time = 1.0;
  return out;
}

JointPositions byName(const std::vector<double> &values) {
  JointPositions out;
  for (std::size_t i = 0; i < values.size(); ++i) out[JOINTS[i]] = values[i];
  return out;
}

void expectSame(const Answer &a, const Answer &b) {
  EXPECT_EQ(a.result.lower, b.result.lower);
  EXPECT_EQ(a.result.upper, b.result.upper);
  EXPECT_EQ(a.a, b.a);
  EXPECT_EQ(a.b, b.b);
  EXPECT_EQ(a.id, b.id);
}

} // namespace

/* 30 edges (seed 71), of all joints, of one, and of none but the hand's. */
TEST(PreparedRobots, motions_answer_as_those_of_the_snapshot) {
  Random random(71);
  const Srdf srdf = pandaSrdf();
  const SnapshotPtr snapshot = scene(random);
  const PreparedRobot robot(snapshot, srdf.disabled);
  Workspace workspace;
  for (int i = 0; i < 30; ++i) {
    const std::vector<double> from = randomState(random);
    std::vector<double> to = randomState(random);
    for (std::size_t k = 0; k < to.size() && i % 3 > 0; ++k)
      if (i % 3 == 2 || k != static_cast<std::size_t>(i) % to.size()) to[k] = from[k];
    const JointPositions rest = {{"panda_finger_joint1", 0.02}};
    const RobotMotion plain(snapshot, edge(from, to), rest, srdf.disabled), prepared(robot, edge(from, to), rest);
    EXPECT_EQ(plain.skipped(), prepared.skipped());
    EXPECT_EQ(plain.warnings(), prepared.warnings());
    expectSame(askSelf(plain, Query(), workspace), askSelf(prepared, Query(), workspace));
    expectSame(askEnvironment(plain, Query(), workspace).front(), askEnvironment(prepared, Query(), workspace).front());
  }
}

/* 60 states (seed 72): the interval of a state meets that of an edge through the state at its middle, which is never
 * farther: epsilon 1e-6 of both. */
TEST(PreparedRobots, a_state_is_a_motion_that_stands_still) {
  Random random(72);
  const Srdf srdf = pandaSrdf();
  const SnapshotPtr snapshot = scene(random);
  const PreparedRobot robot(snapshot, srdf.disabled);
  Workspace workspace;
  int hits = 0;
  for (int i = 0; i < 60; ++i) {
    const std::vector<double> at = randomState(random);
    std::vector<double> from = at, to = at;
    for (std::size_t k = 0; k < at.size(); ++k) {
      from[k] -= 1e-7;
      to[k] += 1e-7;
    }
    const RobotMotion state(robot, byName(at), "here"), motion(robot, edge(from, to));
    const Answer of_state = askEnvironment(state, Query(), workspace).front(),
                 of_motion = askEnvironment(motion, Query(), workspace).front();
    const Answer self = askSelf(state, Query(), workspace), self_motion = askSelf(motion, Query(), workspace);
    EXPECT_EQ(of_state.id, "here");
    EXPECT_LE(of_motion.result.lower, of_state.result.upper);
    EXPECT_NEAR(of_motion.result.upper, of_state.result.upper, 4e-6);
    EXPECT_LE(self_motion.result.lower, self.result.upper);
    EXPECT_NEAR(self_motion.result.upper, self.result.upper, 4e-6);
    EXPECT_EQ(state.linkPoses(0.5).at("panda_link7").matrix(), state.linkPoses(0.0).at("panda_link7").matrix());
    hits += of_state.result.upper == 0.0;
  }
  EXPECT_GT(hits, 3);
  EXPECT_LT(hits, 57);
}

TEST(PreparedRobots, what_cannot_be_meant_is_refused) {
  Random random(73);
  const PreparedRobot robot(scene(random));
  expectContains(errorOf([&] { RobotMotion(robot, JointPositions{{"elbow", 0.0}}); }), "'elbow'");
  expectContains(errorOf([&] { RobotMotion(robot, JointPositions{{"panda_joint1", NAN}}); }), "not finite");
  expectContains(errorOf([&] { RobotMotion(robot, TrajectoryDescription()); }), "joint");
  expectContains(errorOf([&] { PreparedRobot(Scene().snapshot()); }), "the scene has none");
}

/* 200 boxes, 60 motions (seed 73): verdicts of all objects at once leave out what is far. They are those of the union of
 * each object alone, which leaves out nothing; so are lower bounds, at most the distance of every object. */
TEST(PreparedRobots, verdicts_among_many_objects_are_those_of_each_alone) {
  Random random(73);
  Scene world(panda(), {}, allowedPairs(pandaSrdf()));
  SceneChange change;
  for (int i = 0; i < 200; ++i)
    change.operations.push_back(
        add("box" + std::to_string(i), {shape(ShapeType::BOX, {0.02, 0.05, 0.04})}, random.pose(2.0)));
  change.link_padding["panda_link5"] = 0.03;
  change.allowed.push_back({"panda_link1", "", true});
  ASSERT_TRUE(world.apply(change).empty());
  const PreparedRobot robot(world.snapshot(), pandaSrdf().disabled);
  Workspace workspace;
  int verdicts[3] = {0, 0, 0}, contacts[3] = {0, 0, 0};
  for (int i = 0; i < 60; ++i) {
    const std::vector<double> from = randomState(random);
    std::vector<double> to = from;
    for (double &value : to) value += random.uniform(-0.1, 0.1);
    TrajectoryDescription path = edge(from, to);
    if (i % 2 == 1) {
      path.points.insert(path.points.begin() + 1, path.points.front());
      path.points[1].time = 0.5;
      for (double &value : path.points[1].positions) value += random.uniform(-0.2, 0.2);
    }
    const RobotMotion motion(robot, path);
    Query query;
    query.query_type = i % 4 < 2 ? QueryType::COLLISION : QueryType::TOLERANCE;
    query.delta = i % 4 < 2 ? 0.0 : random.uniform(0.0, 0.2);
    const Answer all = askEnvironment(motion, query, workspace).front();
    query.per_object = true;
    bool clear = true, violated = false;
    Query distance;
    distance.per_object = true;
    for (const Answer &alone : askEnvironment(motion, query, workspace)) {
      clear = clear && alone.result.verdict == CPROX_VERDICT_CLEAR;
      violated = violated || alone.result.verdict == CPROX_VERDICT_VIOLATED;
    }
    ASSERT_TRUE(clear || violated) << i;
    EXPECT_EQ(all.result.verdict, violated ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR) << i;
    for (const Answer &alone : askEnvironment(motion, distance, workspace))
      EXPECT_LE(all.result.lower, alone.result.upper) << i << " " << alone.b;
    ++verdicts[all.result.verdict];
    if (i % 5 > 0) continue;
    query = Query();
    query.query_type = QueryType::COLLISION;
    const Answer contact = timeOfContact(motion, false, query, workspace);
    double first = INFINITY;
    for (const auto &[id, object] : robot.snapshot()->objects()) {
      query.objects = {id};
      const Answer alone = timeOfContact(motion, false, query, workspace);
      if (alone.result.verdict == CPROX_VERDICT_VIOLATED) first = std::min(first, alone.result.t);
    }
    EXPECT_EQ(contact.result.verdict, first < INFINITY ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR) << i;
    EXPECT_LE(contact.result.t_contact_lower, first) << i;
    ++contacts[contact.result.verdict];
  }
  EXPECT_GT(verdicts[CPROX_VERDICT_CLEAR], 5);
  EXPECT_GT(verdicts[CPROX_VERDICT_VIOLATED], 5);
  EXPECT_GT(contacts[CPROX_VERDICT_CLEAR], 1);
  EXPECT_GT(contacts[CPROX_VERDICT_VIOLATED], 1);
}

/* Changes of objects, of the matrix, of a padding, of a scale and of what is attached, in turn. */
TEST(PreparedRobots, in_another_snapshot_answer_as_if_made_of_it) {
  Random random(74);
  Scene world(scene(random));
  const Srdf srdf = pandaSrdf();
  auto prepared = std::make_unique<const PreparedRobot>(world.snapshot(), srdf.disabled);
  Workspace workspace;
  for (int i = 0; i < 20; ++i) {
    SceneChange change;
    if (i % 5 == 0)
      change.operations.push_back(add("box1", {shape(ShapeType::BOX, {0.2, 0.1, 0.1})}, random.pose(1.0)));
    if (i % 5 == 1) change.allowed.push_back({"box2", "panda_link5", i < 10});
    if (i % 5 == 2) change.link_padding["panda_link4"] = random.uniform(0.0, 0.05);
    if (i % 5 == 3) change.link_scale["panda_link3"] = random.uniform(1.0, 1.2);
    if (i % 5 == 4) {
      Attachment cup;
      cup.link = "panda_hand";
      cup.object.id = "cup";
      cup.object.shapes = {shape(ShapeType::SPHERE, {random.uniform(0.01, 0.1)})};
      change.attachments.push_back(cup);
    }
    ASSERT_TRUE(world.apply(change).empty()) << i;
    prepared = std::make_unique<const PreparedRobot>(*prepared, world.snapshot());
    const PreparedRobot fresh(world.snapshot(), srdf.disabled);
    for (int k = 0; k < 3; ++k) {
      const TrajectoryDescription path = edge(randomState(random), randomState(random));
      const RobotMotion plain(fresh, path), shared(*prepared, path);
      EXPECT_EQ(plain.skipped(), shared.skipped());
      expectSame(askSelf(plain, Query(), workspace), askSelf(shared, Query(), workspace));
      expectSame(askEnvironment(plain, Query(), workspace).front(), askEnvironment(shared, Query(), workspace).front());
    }
  }
}

/* A collision query among 101 objects, of which one is none that robots are asked about, 50 m away. */
TEST(PreparedRobots, a_distance_grid_among_many_objects_is_refused_wherever_it_stands) {
  Scene world(panda());
  SceneChange change;
  for (int i = 0; i < 100; ++i)
    change.operations.push_back(
        add("box" + std::to_string(i), {shape(ShapeType::BOX, {0.1, 0.1, 0.1})}, translation(i, 20, 0)));
  ShapeDescription grid = shape(ShapeType::DISTANCE_GRID, {0.5, 2, 2, 2, 0.01});
  for (int i = 0; i < 8; ++i) grid.values.push_back(0.5 * Eigen::Vector3d(i % 2, i / 2 % 2, i / 4).norm());
  change.operations.push_back(add("grid", {grid}, translation(50, 0, 0)));
  ASSERT_TRUE(world.apply(change).empty());
  const PreparedRobot robot(world.snapshot());
  Random random(74);
  const RobotMotion motion(robot, edge(randomState(random), randomState(random)));
  Query query;
  query.query_type = QueryType::COLLISION;
  Workspace workspace;
  expectContains(errorOf([&] { askEnvironment(motion, query, workspace); }), "object 'grid' is a distance_grid");
}
