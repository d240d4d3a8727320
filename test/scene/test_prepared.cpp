/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions and states of a prepared robot: the same answers as those of a robot that is not prepared. */
#include <curve_proximity/motion.hpp>

#include "query/near_items.h"
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

constexpr double SLIDE_RADIUS = 0.1, SLIDE_PADDING = 0.05; /* [m] */

/* A sphere that a prismatic joint moves along the base's x axis, among objects. The link's
 * padding counts, for what it carries, too. */
PreparedRobot slideAmong(const Eigen::Isometry3d &base, const std::vector<Operation> &objects,
                         const std::vector<Attachment> &carried = {}) {
  static const std::shared_ptr<const Robot> robot = Robot::fromUrdf(
      "<robot name='slide'><link name='base'/><link name='ball'><collision><geometry><sphere radius='0.1'/></geometry>"
      "</collision></link><joint name='j' type='prismatic'><parent link='base'/><child link='ball'/>"
      "<axis xyz='1 0 0'/><limit lower='-9' upper='9'/></joint></robot>");
  Scene world(robot);
  SceneChange change;
  change.operations = objects;
  change.attachments = carried;
  change.link_padding["ball"] = SLIDE_PADDING;
  EXPECT_TRUE(world.apply(change).empty());
  return PreparedRobot(world.snapshot(), {}, {}, {}, base);
}

TrajectoryDescription slide(double from, double to) {
  TrajectoryDescription out;
  out.id = "slide";
  out.joints = {"j"};
  out.points.resize(2);
  out.points[0].positions = {from};
  out.points[1].positions = {to};
  out.points[1].time = 1.0;
  return out;
}

/* With all named objects at once; with none named, with all of the scene. */
cprox_result resultOf(const RobotMotion &motion, Query query, const std::vector<std::string> &objects = {}) {
  Workspace workspace;
  query.objects = objects;
  return askEnvironment(motion, query, workspace).front().result;
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

/* One of 81 boxes stands where the way of 2 m, or a robot that stands at its end, comes within .01 m of the limit. The
 * way's box is as large as the way, the sphere and the padding make it, to some roundings: without one of these the box
 * at the end is left out. A small sphere in a corner of the way's box, farther than the limit, is always nearer to what
 * is left of that: were it not there, the box would be asked about as the nearest of what is far. */
TEST(PreparedRobots, the_one_near_object_of_many_counts_at_the_end_of_the_way) {
  for (const double delta : {0.0, 0.3}) {
    for (const double gap : {-0.01, 0.01}) {
      const double face = 2.0 + SLIDE_RADIUS + SLIDE_PADDING + delta + gap;
      const ShapeDescription box = shape(ShapeType::BOX, {0.5, 0.5, 0.5});
      const double corner = 0.12 + 0.75 * delta;
      std::vector<Operation> objects = {
          add("near", {box}, translation(face + 0.25, 0, 0)),
          add("corner", {shape(ShapeType::SPHERE, {0.005})}, translation(2.0 + corner, corner, corner))};
      for (int i = 0; i < 80; ++i) objects.push_back(add("far" + std::to_string(i), {box}, translation(i, 20, 0)));
      const PreparedRobot robot = slideAmong(Eigen::Isometry3d::Identity(), objects);
      Query query;
      query.query_type = delta > 0.0 ? QueryType::TOLERANCE : QueryType::COLLISION;
      query.delta = delta;
      const cprox_verdict expected = gap < 0.0 ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR;
      EXPECT_EQ(resultOf(RobotMotion(robot, slide(0.0, 2.0)), query).verdict, expected) << delta << " " << gap;
      EXPECT_EQ(resultOf(RobotMotion(robot, slide(2.0, 0.0)), query).verdict, expected) << delta << " " << gap;
      const RobotMotion stands(robot, JointPositions{{"j", 2.0}});
      EXPECT_EQ(resultOf(stands, query).verdict, expected) << delta << " " << gap;
    }
  }
}

/* The sphere carries a cube of .04 m whose vertices are .6 m ahead of its frame, and its base is turned by a quarter: so
 * the cube is in the middle of its body neither along the base's x axis nor along that of the world. The small sphere is
 * as above. */
TEST(PreparedRobots, a_carried_body_far_from_its_frame_counts_where_it_is) {
  Attachment cube;
  cube.link = "ball";
  cube.object.id = "cube";
  cube.object.shapes = {shape(ShapeType::POLYTOPE, {})};
  Eigen::Matrix3Xd &vertices = cube.object.shapes.front().vertices;
  vertices.resize(3, 8);
  for (int i = 0; i < 8; ++i) vertices.col(i) << 0.58 + 0.04 * (i & 1), 0.04 * (i >> 1 & 1), 0.04 * (i >> 2);
  Eigen::Isometry3d base = Eigen::Isometry3d::Identity();
  base.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  Query query;
  query.query_type = QueryType::COLLISION;
  for (const double gap : {-0.01, 0.01}) {
    const ShapeDescription box = shape(ShapeType::BOX, {0.5, 0.5, 0.5});
    std::vector<Operation> objects = {add("near", {box}, translation(0, 1.0 + 0.62 + SLIDE_PADDING + gap + 0.25, 0)),
                                      add("corner", {shape(ShapeType::SPHERE, {0.005})}, translation(0.06, 1.6, 0.1))};
    for (int i = 0; i < 80; ++i) objects.push_back(add("far" + std::to_string(i), {box}, translation(i, 20, 0)));
    const PreparedRobot robot = slideAmong(base, objects, {cube});
    const cprox_verdict expected = gap < 0.0 ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR;
    EXPECT_EQ(resultOf(RobotMotion(robot, slide(0.0, 1.0)), query).verdict, expected) << gap;
    EXPECT_EQ(resultOf(RobotMotion(robot, JointPositions{{"j", 1.0}}), query).verdict, expected) << gap;
  }
}

/* 1000 ways (seed 75), half of them along a coordinate axis, a fifth of them a robot that stands, a third there and
 * back. 69 spheres are anywhere, one is within .02 m of the limit, to either side: all at once leave out what is far, 35
 * at a time nothing. The distance of a sphere from the way is that of its centre from a segment, less radii and padding.
 */
TEST(PreparedRobots, verdicts_that_leave_out_what_is_far_are_those_of_all) {
  Random random(75);
  int violated = 0;
  const int n = cases(1000);
  for (int i = 0; i < n; ++i) {
    Eigen::Isometry3d base = random.pose(1.0);
    if (i % 2 == 0) {
      const Eigen::Vector3d x = Eigen::Vector3d::Unit(i / 2 % 3) * (i / 6 % 2 == 0 ? 1.0 : -1.0);
      base.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), x).toRotationMatrix();
    }
    const double from = random.uniform(-2.0, 2.0), to = i % 5 == 0 ? from : random.uniform(-2.0, 2.0);
    Query query;
    query.query_type = i % 4 < 2 ? QueryType::COLLISION : QueryType::TOLERANCE;
    query.delta = i % 4 < 2 ? 0.0 : random.uniform(0.0, 0.2);

    std::vector<Operation> objects;
    std::vector<std::string> halves[2];
    const double limit = SLIDE_RADIUS + SLIDE_PADDING + query.delta;
    double least = INFINITY; /* distance from the way, less the limit */
    for (int k = 0; k < 70; ++k) {
      double radius = random.uniform(0.01, 0.1);
      Eigen::Vector3d at = random.vector(4.0); /* in the base's frame */
      if (k == 0) {
        const double turn = random.below(3) == 0 ? random.uniform(0.0, 1.5) : 0.0; /* from straight ahead */
        const double away = limit + radius + random.uniform(-0.02, 0.02);
        at = {to + std::copysign(away * std::cos(turn), to - from), away * std::sin(turn), 0.0};
      }
      const Eigen::Vector3d nearest(std::clamp(at.x(), std::min(from, to), std::max(from, to)), 0.0, 0.0);
      least = std::min(least, (at - nearest).norm() - radius - limit);
      halves[k % 2].push_back("o" + std::to_string(k));
      const Eigen::Vector3d there = base * at;
      objects.push_back(add(halves[k % 2].back(), {shape(ShapeType::SPHERE, {radius})},
                            translation(there.x(), there.y(), there.z())));
    }
    if (std::abs(least) < 1e-5) continue; /* epsilon is 1e-6 */
    TrajectoryDescription way = slide(from, to);
    if (i % 3 == 0) { /* and back, and stay there */
      way.points.insert(way.points.end(), 2, way.points.front());
      way.points[2].time = 2.0, way.points[3].time = 3.0;
    }
    const RobotMotion motion(slideAmong(base, objects), way);
    const cprox_result all = resultOf(motion, query);
    ASSERT_EQ(all.verdict, least < 0.0 ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR) << i << " " << least;
    ASSERT_LE(all.lower, std::max(0.0, least + query.delta) + 1e-12) << i;
    const bool either = resultOf(motion, query, halves[0]).verdict == CPROX_VERDICT_VIOLATED ||
                        resultOf(motion, query, halves[1]).verdict == CPROX_VERDICT_VIOLATED;
    ASSERT_EQ(either, least < 0.0) << i << " " << least;
    violated += least < 0.0;
  }
  EXPECT_GT(violated, n / 5);
  EXPECT_LT(violated, n - n / 5);
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

/* A collision query among 100 objects far away: to leave them out must cost little beside a budget, whatever the robot
 * and its way. The boxes of a chain of links cost as the square of their number. */
TEST(PreparedRobots, far_objects_are_left_out_where_that_is_cheap) {
  std::vector<Operation> objects;
  for (int i = 0; i < 100; ++i)
    objects.push_back(add("far" + std::to_string(i), {shape(ShapeType::SPHERE, {0.1})}, translation(i, 2000, 0)));
  Query query;
  query.query_type = QueryType::COLLISION;
  Workspace workspace;
  for (const int links : {20, 1000}) {
    std::string text = "<robot name='chain'><link name='l0'/>";
    TrajectoryDescription way;
    for (int i = 1; i <= links; ++i) {
      const std::string name = std::to_string(i);
      text += "<link name='l" + name + "'><collision><geometry><sphere radius='0.1'/></geometry></collision></link>";
      text += "<joint name='j" + name + "' type='prismatic'><parent link='l" + std::to_string(i - 1);
      text += "'/><child link='l" + name + "'/><axis xyz='1 0 0'/><limit lower='-9' upper='9'/></joint>";
      way.joints.push_back("j" + name);
    }
    Scene world(Robot::fromUrdf(text + "</robot>"));
    SceneChange change;
    change.operations = objects;
    ASSERT_TRUE(world.apply(change).empty());
    for (const int segments : {1, 100}) {
      way.points.assign(static_cast<std::size_t>(segments) + 1, {});
      for (std::size_t i = 0; i < way.points.size(); ++i) {
        way.points[i].time = static_cast<double>(i);
        way.points[i].positions.assign(way.joints.size(), 1e-3 * static_cast<double>(i % 7));
      }
      const RobotMotion motion(PreparedRobot(world.snapshot()), way);
      std::vector<std::size_t> all(100);
      for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
      const NearItems near = nearItems(motion.data(), all, query, workspace);
      EXPECT_EQ(near.items.size(), links == 20 ? 1u : 100u) << links << " links, " << segments << " segments";
    }
  }
}
