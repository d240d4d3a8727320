/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots and objects that move at the same time. Distances and times are computed by hand. */
#include <cmath>

#include <curve_proximity/movers.hpp>

#include "support.h"

namespace curve_proximity {
namespace {

using test::add;
using test::change;
using test::dataRobot;
using test::errorOf;
using test::expectContains;
using test::shape;
using test::translation;

/* A cart of edge 0.2 on a rail along x. */
const char *CART = R"(<robot name="cart">
  <link name="rail"/>
  <link name="cart"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <joint name="slide" type="prismatic"><parent link="rail"/><child link="cart"/><axis xyz="1 0 0"/><limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
</robot>)";

/* From one place to another in one second. */
std::shared_ptr<const RobotMotion> slide(const SnapshotPtr &snapshot, double from, double to, double x, double y = 0) {
  TrajectoryDescription t;
  t.id = "slide";
  t.joints = {"slide"};
  t.points = {{{from}, {}, {}, 0.0}, {{to}, {}, {}, 1.0}};
  return std::make_shared<const RobotMotion>(snapshot, t, JointPositions{}, std::vector<std::array<std::string, 2>>{},
                                             translation(x, y, 0));
}

MovingObject mover(const std::string &id, std::vector<ShapeDescription> shapes, std::vector<TimedPose> poses) {
  MovingObject out;
  out.object.id = id;
  out.object.shapes = std::move(shapes);
  out.poses = std::move(poses);
  return out;
}

Query collision() {
  Query query;
  query.query_type = QueryType::COLLISION;
  return query;
}

struct Movement : ::testing::Test {
  Scene carts{Robot::fromUrdf(CART)};
  Scene world;
  Workspace workspace;

  void SetUp() override {
    ASSERT_TRUE(world.apply(change({add("wall", {shape(ShapeType::BOX, {1, 9, 9})}, translation(0, 0, 6))})).empty());
  }

  void expectDistance(const Answer &answer, double distance) {
    ASSERT_EQ(answer.status, "ok") << answer.message;
    EXPECT_LE(answer.result.lower, distance + 1e-12);
    EXPECT_GE(answer.result.upper, distance - 1e-12);
    EXPECT_LE(answer.result.upper - answer.result.lower, 1.01e-6);
  }
};

/* One goes from 0 to 2 along x, the other, 0.5 m beside it, from 4 to 2 and half a second later. */
TEST_F(Movement, carts_meet_when_the_later_one_has_come) {
  const auto there = slide(carts.snapshot(), 0, 2, 0), back = slide(carts.snapshot(), 0, -2, 4, 0.5);
  const Movers movers(world.snapshot(), {{"a", there, 10.0}, {"b", back, 10.5}}, {});
  EXPECT_EQ(movers.domain(), (std::array<double, 2>{10.0, 11.5}));
  const Answer answer = ask(movers, Against::MOVERS, Query(), workspace);
  expectDistance(answer, 0.3); /* side by side at x = 2 */
  EXPECT_EQ(answer.kind, "movers");
  EXPECT_EQ(answer.a, "a/cart");
  EXPECT_EQ(answer.b, "b/cart");
  EXPECT_TRUE(answer.b_is_link);
  EXPECT_GT(answer.result.t, 11.39); /* from where they are side by side */

  /* the wall is 5.4 m above all of them */
  expectDistance(ask(movers, Against::OBJECTS, Query(), workspace), 1.4);
  EXPECT_EQ(ask(movers, Against::OBJECTS, Query(), workspace).b, "wall");
  EXPECT_EQ(ask(movers, Against::BOTH, Query(), workspace).kind, "movers");
}

/* The same two: each interval of a profile is as the interval asked alone, and all of it together as the query. */
TEST_F(Movement, clearance_over_time_is_that_of_each_interval) {
  const auto there = slide(carts.snapshot(), 0, 2, 0), back = slide(carts.snapshot(), 0, -2, 4, 0.5);
  const MovingRobot a{"a", there, 10.0}, b{"b", back, 10.5};
  const Movers movers(world.snapshot(), {a, b}, {});
  const std::vector<double> breaks{10.0, 10.4, 10.9, 11.2, 11.5};
  for (const Against against : {Against::OBJECTS, Against::MOVERS, Against::BOTH}) {
    const std::vector<ClearanceInterval> profile = clearanceProfile(movers, against, breaks, Query(), workspace);
    ASSERT_EQ(profile.size(), breaks.size() - 1);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < profile.size(); ++i) {
      Query query;
      query.options.interval = &breaks[i];
      const Answer alone = ask(movers, against, query, workspace);
      EXPECT_LE(profile[i].upper - profile[i].lower, 1.01e-6);
      EXPECT_NEAR(profile[i].upper, alone.result.upper, 2e-6);
      EXPECT_NEAR((toEigen(profile[i].witness_a) - toEigen(profile[i].witness_b)).norm(), profile[i].upper, 1e-6);
      least = std::min(least, profile[i].upper);
    }
    EXPECT_NEAR(least, ask(movers, against, Query(), workspace).result.upper, 2e-6);
  }
  /* seen by the second one, whose times are from 10.5 on; there the wall is farther than the other cart */
  const ClearanceInterval last = clearanceProfile(movers, b, {11.2, 11.5}, Query(), workspace).front();
  EXPECT_NEAR(last.upper, 0.3, 1e-6);
  EXPECT_EQ(last.a, "cart");
  EXPECT_EQ(last.b, "a/cart");
  EXPECT_NEAR(toEigen(last.witness_a).y() - toEigen(last.witness_b).y(), 0.3, 1e-6);
  const ClearanceInterval beyond = clearanceProfile(movers, b, {10.5, 10.6}, Query(), workspace, 0.5).front();
  EXPECT_GT(beyond.lower, 0.5);
  EXPECT_EQ(beyond.status, CPROX_OK);

  const std::vector<Answer> pairs = nearestPairs(movers, b, {}, Query(), workspace);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].b, "a/cart");
  EXPECT_EQ(pairs[1].b, "wall");
  expectDistance(pairs[0], 0.3);
  EXPECT_EQ(nearestPairs(movers, Against::BOTH, {1}, Query(), workspace).size(), 1u);

  /* 0.5 m apart where 0.4 m are between them along x: 3.8 - 2 (t - 10.5) - 2 = 0.4 */
  Query near;
  near.query_type = QueryType::TOLERANCE;
  near.delta = 0.5;
  const Violations found = violations(movers, b, 1e-6, near, workspace);
  ASSERT_EQ(found.list.size(), 1u);
  EXPECT_LE(found.list[0].enter_lower, 11.2 + 1e-9);
  EXPECT_GE(found.list[0].enter_upper, 11.2 - 1e-9);
  EXPECT_LT(found.list[0].enter_upper - found.list[0].enter_lower, 1e-3);
  EXPECT_NEAR(found.list[0].leave_upper, 11.5, 1e-9);
  near.delta = 0.2;
  EXPECT_TRUE(violations(movers, Against::MOVERS, 1e-6, near, workspace).list.empty());

  Query one;
  one.objects = {"a"};
  expectDistance(ask(movers, b, one, workspace), 0.3);
  one.objects = {"wall"};
  EXPECT_EQ(ask(movers, b, one, workspace).b, "wall");
  EXPECT_THROW(clearanceProfile(movers, Against::BOTH, {11.0, 10.0}, Query(), workspace), Error);
  EXPECT_THROW(violations(movers, b, 1e-6, Query(), workspace), Error);
}

/* A mesh of closed boxes of edge 2 about these places on the x axis. */
ShapeDescription boxes(const std::vector<double> &places, bool solid) {
  ShapeDescription out = shape(ShapeType::MESH, {});
  out.solid = solid;
  const auto n = static_cast<Eigen::Index>(places.size());
  out.vertices.resize(3, 8 * n);
  out.triangles.resize(3, 12 * n);
  Eigen::Matrix<int, 3, 12> sides;
  sides << 0, 0, 1, 1, 0, 0, 2, 2, 0, 0, 4, 4, /**/ 4, 6, 3, 7, 1, 5, 6, 7, 2, 3, 5, 7, /**/ 6, 2, 7, 5, 5, 4, 7, 3, 3,
      1, 7, 6;
  for (Eigen::Index k = 0; k < n; ++k) {
    for (int i = 0; i < 8; ++i)
      out.vertices.col(8 * k + i) << (i & 4 ? 1 : -1) + places[static_cast<std::size_t>(k)], (i & 2 ? 1 : -1),
          (i & 1 ? 1 : -1);
    for (Eigen::Index i = 0; i < 12; ++i)
      out.triangles.col(12 * k + i) = sides.col(i).array() + static_cast<int>(8 * k);
  }
  return out;
}

/* A cart within a closed box, 0.8 from its walls in the end, or as near to one of two, in the hull of both. */
TEST_F(Movement, of_solid_meshes_the_inside_counts_and_not_the_hull) {
  const auto ask = [&](const std::vector<double> &places, bool solid, bool open, bool moving) {
    ShapeDescription mesh = boxes(places, solid);
    if (open) mesh.triangles.conservativeResize(3, mesh.triangles.cols() - 1);
    Scene scene{Robot::fromUrdf(CART)};
    EXPECT_TRUE(moving || scene.apply(change({add("boxes", {mesh})})).empty());
    const auto cart = slide(scene.snapshot(), 0, 0.1, 0);
    if (!moving) return askEnvironment(*cart, Query(), workspace).at(0);
    const MovingRobot robot{"a", cart, 0.0};
    const Movers movers(scene.snapshot(), {robot},
                        {mover("boxes", {mesh}, {{0.0, translation(0, 0, 0)}, {1.0, translation(0, 0, 0.1)}})});
    return curve_proximity::ask(movers, robot, Query(), workspace);
  };
  for (const bool moving : {false, true}) {
    EXPECT_NEAR(ask({0}, false, false, moving).result.upper, 0.8, 1e-6);
    EXPECT_EQ(ask({0}, true, false, moving).result.upper, 0.0);
    EXPECT_EQ(ask({5, 0}, true, false, moving).result.upper, 0.0);
    EXPECT_NEAR(ask({-2, 2}, true, false, moving).result.lower, 0.8, 1e-5);
    EXPECT_NEAR(ask({0}, true, true, moving).result.upper, 0.8, 1e-6);
  }
  EXPECT_FALSE(ask({-2, 2}, true, false, false).by_hull);
  expectContains(ask({0}, true, true, false).message, "not closed");
}

/* A cart goes from 0 to 2 along x in a second. A ball ahead of it comes from 3 to 2.5 in half a second and leaves: they
 * are nearest when the ball turns back. A wall stands far above. */
TEST_F(Movement, the_gradient_of_a_robot_knows_that_others_move) {
  const MovingRobot cart{"a", slide(carts.snapshot(), 0, 2, 0), 10.0};
  const MovingRobot other{"b", slide(carts.snapshot(), 0, 1, 0, 5), 10.0};
  MovingObject ball = mover("ball", {shape(ShapeType::SPHERE, {0.1})},
                            {{0.0, translation(3, 0, 0)}, {0.5, translation(2.5, 0, 0)}, {1.0, translation(4, 0, 0)}});
  ball.start = 10.0;
  for (const bool first : {true, false}) {
    const Movers movers(world.snapshot(), first ? std::vector<MovingRobot>{cart, other} : std::vector{other, cart},
                        {ball});
    const ClearanceRow row = clearanceGradient(movers, cart, Query(), workspace);
    const ClearanceGradient &g = row.gradient;
    ASSERT_TRUE(g.valid) << g.reason;
    expectDistance(row.answer, 1.3);
    EXPECT_EQ(row.answer.a, "cart");
    EXPECT_EQ(row.answer.b, "ball");
    EXPECT_NEAR(g.t, 10.5, 1e-9);
    ASSERT_EQ(g.positions.rows(), 2);
    EXPECT_NEAR(g.positions(0, 0), -0.5, 1e-9);
    EXPECT_NEAR(g.positions(1, 0), -0.5, 1e-9);
    EXPECT_NEAR(g.joints.at("slide"), -1.0, 1e-9);
    EXPECT_NEAR(g.start, 2.0, 1e-9); /* it is at 2 m/s less far */
    EXPECT_NEAR(g.base_linear.x(), -1.0, 1e-9);
    EXPECT_NEAR(g.object_linear.x(), 1.0, 1e-9);
    EXPECT_NEAR(g.object_angular.norm(), 0.0, 1e-9); /* a ball about its middle */
    EXPECT_NEAR(g.duration, 1.0, 1e-9);              /* 2 (t - 10)/T m at half of T = 1 s */
  }
  const Movers movers(world.snapshot(), {other}, {ball});
  expectContains(errorOf([&] { clearanceGradient(movers, cart, Query(), workspace); }), "'a'");
  ball.tolerance = 0.1;
  const Movers vague(world.snapshot(), {cart}, {ball});
  expectContains(errorOf([&] { clearanceGradient(vague, cart, Query(), workspace); }), "tolerance");
}

/* Balls on tables: three robots of two joints each, and a ball that is fixed beside the middle of a moving object. */
struct Tables {
  static constexpr std::size_t ROBOTS = 3;
  std::vector<Eigen::MatrixXd> positions, velocities; /* a row a point, a column a joint */
  std::vector<Eigen::Vector3d> shift, turn; /* of the robots' bases, of the object's poses; rotation vectors */
  std::vector<double> start, duration;      /* of all four */

  Tables() : shift(4), turn(4, Eigen::Vector3d::Zero()), start(4, 0.0), duration(4, 1.0) {
    const double x[ROBOTS][3] = {{-1.0, 0.1, 1.1}, {0.9, 0.0, -1.0}, {-0.9, 0.2, 1.0}};
    const double y[ROBOTS][3] = {{0.0, 0.2, -0.1}, {-0.3, -0.2, -0.4}, {0.1, 0.0, 0.2}};
    for (std::size_t i = 0; i < ROBOTS; ++i) {
      positions.emplace_back(3, 2), velocities.emplace_back(3, 2);
      for (Eigen::Index k = 0; k < 3; ++k) {
        positions[i].row(k) << x[i][k], y[i][k];
        velocities[i].row(k) << 2.0 - 0.3 * static_cast<double>(k), 0.1 * static_cast<double>(k);
      }
      shift[i] = Eigen::Vector3d(0.0, 1.2 * static_cast<double>(i), 0.1 * static_cast<double>(i));
    }
    velocities[1] *= -1.0;
    shift[3].setZero();
  }

  Eigen::Matrix3d turned(std::size_t i) const {
    const double angle = turn[i].norm();
    return angle > 0.0 ? Eigen::AngleAxisd(angle, turn[i] / angle).toRotationMatrix() : Eigen::Matrix3d::Identity();
  }

  std::vector<MovingRobot> robots() const {
    static const Scene table{Robot::fromUrdf(R"(<robot name="table"><link name="table"/><link name="beam"/>
      <link name="ball"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
      <joint name="x" type="prismatic"><parent link="table"/><child link="beam"/><axis xyz="1 0 0"/><limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
      <joint name="y" type="prismatic"><parent link="beam"/><child link="ball"/><axis xyz="0 1 0"/><limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
    </robot>)")};
    std::vector<MovingRobot> out;
    for (std::size_t i = 0; i < ROBOTS; ++i) {
      TrajectoryDescription t;
      t.id = "slide", t.joints = {"x", "y"};
      for (Eigen::Index k = 0; k < 3; ++k) {
        const Eigen::RowVector2d at = positions[i].row(k), by = velocities[i].row(k);
        t.points.push_back({{at.x(), at.y()}, {by.x(), by.y()}, {}, 0.5 * static_cast<double>(k) * duration[i]});
      }
      Eigen::Isometry3d base = Eigen::Isometry3d::Identity();
      base.linear() = turned(i), base.translation() = turned(i) * shift[i];
      out.push_back({"r" + std::to_string(i),
                     std::make_shared<const RobotMotion>(table.snapshot(), t, JointPositions{},
                                                         std::vector<std::array<std::string, 2>>{}, base),
                     start[i]});
    }
    return out;
  }

  /* "r0", "r1", "r2" and "lamp". */
  Movers join(const std::vector<MovingRobot> &robots) const {
    ShapeDescription ball = shape(ShapeType::SPHERE, {0.1});
    ball.pose = translation(0.2, 0.1, 0.05);
    std::vector<TimedPose> poses;
    for (int k = 0; k < 3; ++k) {
      Eigen::Isometry3d pose = translation(0.5 - 0.7 * k, 1.5 + 0.1 * k, 0.9);
      pose.linear() = turned(3) * Eigen::AngleAxisd(0.4 * k, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      pose.translation() += shift[3];
      poses.push_back({(k == 1 ? 0.6 : 0.5 * k) * duration[3], pose});
    }
    MovingObject lamp = mover("lamp", {ball}, poses);
    lamp.start = start[3];
    return Movers(Scene().snapshot(), robots, {lamp});
  }
};

/* Central differences of the distance that ask() tells, by every number of all four. */
TEST_F(Movement, the_gradients_by_all_motions_are_those_of_differences_and_of_each_motion_alone) {
  constexpr double STEP = 1e-5,
                   TOLERANCE = 1e-6; /* the search converges to about 1e-13, the third derivatives are about 1e2 */
  const std::vector<std::array<std::string, 2>> cases = {{"", ""}, {"r1", "r2"}, {"lamp", "r0"}, {"r2", "lamp"}};
  for (const auto &[link, object] : cases) {
    Query query;
    query.options.epsilon = 1e-9;
    if (!link.empty()) query.links = {link}, query.objects = {object};
    Query fine = query;
    fine.options.epsilon = 1e-12;
    Tables tables;
    const std::vector<MovingRobot> robots = tables.robots();
    const Movers movers = tables.join(robots);
    const MoversClearance found = clearanceGradients(movers, Against::OTHERS, query, workspace);
    ASSERT_EQ(found.gradients.size(), 4u);
    ASSERT_TRUE(found.gradients[0].gradient.valid) << found.gradients[0].gradient.reason;
    EXPECT_EQ(found.answer.kind, "movers");
    EXPECT_GT(found.answer.result.t, 0.05);
    EXPECT_LT(found.answer.result.t, 0.95);
    const double least = ask(movers, Against::OTHERS, query, workspace).result.upper;
    EXPECT_NEAR(found.answer.result.upper, least, 1e-9);
    const auto slope = [&](double &number) {
      const double before = number;
      double ends[2];
      for (int side = 0; side < 2; ++side) {
        number = before + (side == 0 ? -STEP : STEP);
        ends[side] = ask(tables.join(tables.robots()), Against::OTHERS, fine, workspace).result.upper;
      }
      number = before;
      return (ends[1] - ends[0]) / (2 * STEP);
    };
    const std::string sides = found.answer.a + " " + found.answer.b;
    std::size_t of_the_pair = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const ClearanceGradient &g = found.gradients[i].gradient;
      const std::string &name = found.gradients[i].name;
      SCOPED_TRACE(name + " of " + sides);
      ASSERT_EQ(name, i < Tables::ROBOTS ? "r" + std::to_string(i) : "lamp");
      EXPECT_NEAR(g.t, found.answer.result.t, 1e-6);
      const bool is_robot = i < Tables::ROBOTS, takes_part = sides.find(name) != std::string::npos;
      of_the_pair += takes_part;
      EXPECT_EQ(is_robot ? g.positions.rows() : 3, 3);
      for (Eigen::Index k = 0; k < g.positions.size(); ++k) {
        EXPECT_NEAR(g.positions(k), slope(tables.positions[i](k)), TOLERANCE) << "position " << k;
        EXPECT_NEAR(g.velocities(k), slope(tables.velocities[i](k)), TOLERANCE) << "velocity " << k;
      }
      EXPECT_NEAR(g.start, slope(tables.start[i]), TOLERANCE);
      EXPECT_NEAR(g.duration, slope(tables.duration[i]), TOLERANCE);
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(is_robot ? g.base_linear(k) : g.object_linear(k), slope(tables.shift[i](k)), TOLERANCE) << k;
        EXPECT_NEAR(is_robot ? g.base_angular(k) : g.object_angular(k), slope(tables.turn[i](k)), TOLERANCE) << k;
      }
      EXPECT_NEAR((is_robot ? g.base_linear : g.object_linear).norm(), takes_part ? 1.0 : 0.0, 1e-12);
      if (!is_robot || !takes_part) continue;
      /* the same motion asked by itself, about the other side alone */
      const std::string other = sides.find(name) == 0 ? found.answer.b : found.answer.a;
      Query alone = query;
      alone.links = {}, alone.objects = {other.substr(0, other.find('/'))};
      const ClearanceRow row = clearanceGradient(movers, robots[i], alone, workspace);
      EXPECT_NEAR(row.answer.result.upper, found.answer.result.upper, 1e-12);
      EXPECT_TRUE(row.gradient.positions.isApprox(g.positions, TOLERANCE));
      EXPECT_TRUE(row.gradient.velocities.isApprox(g.velocities, TOLERANCE));
      for (const auto &[joint, by] : row.gradient.joints) EXPECT_NEAR(g.joints.at(joint), by, TOLERANCE);
      EXPECT_NEAR(row.gradient.start, g.start, TOLERANCE);
      EXPECT_NEAR(row.gradient.duration, g.duration, TOLERANCE);
      EXPECT_TRUE(row.gradient.base_linear.isApprox(g.base_linear, TOLERANCE));
      EXPECT_TRUE(row.gradient.base_angular.isApprox(g.base_angular, TOLERANCE));
      EXPECT_TRUE((row.gradient.object_linear - g.object_linear).isZero(TOLERANCE));
      EXPECT_TRUE((row.gradient.object_angular - g.object_angular).isZero(TOLERANCE));
    }
    EXPECT_EQ(of_the_pair, 2u);
  }
}

/* A robot that meets itself, an object that meets what stands, and no pair at all. */
TEST_F(Movement, the_gradients_by_all_motions_of_other_pairs) {
  const MovingRobot cart{"a", slide(carts.snapshot(), 0, 2, 0), 0.0};
  const MovingObject ball =
      mover("ball", {shape(ShapeType::SPHERE, {0.1})},
            {{0.0, translation(0, 0, -1)}, {0.5, translation(0, 0, 1)}, {1.0, translation(0, 0, 0.5)}});
  const Movers movers(world.snapshot(), {cart}, {ball});
  Query query;
  query.links = {"ball"}, query.objects = {"wall"};
  const MoversClearance found = clearanceGradients(movers, Against::BOTH, query, workspace);
  EXPECT_EQ(found.answer.a + " " + found.answer.b + " " + found.answer.kind, "ball wall environment");
  const ClearanceGradient &a = found.gradients.at(0).gradient, &b = found.gradients.at(1).gradient;
  ASSERT_TRUE(b.valid) << b.reason;
  EXPECT_NEAR(found.answer.result.t, 0.5, 1e-9);
  EXPECT_TRUE(a.positions.rows() == 2 && a.positions.isZero(0.0) && a.base_linear.isZero(0.0) && a.start == 0.0);
  EXPECT_TRUE(b.positions.size() == 0 && b.object_linear.isApprox(-Eigen::Vector3d::UnitZ(), 1e-9));
  EXPECT_TRUE(b.start == 0.0 && b.base_linear.isZero(0.0));

  query.links = {"a"}, query.objects = {"wall"};
  const Movers none(world.snapshot(), {cart}, {ball}, {{"a", "wall"}});
  const MoversClearance nothing = clearanceGradients(none, Against::BOTH, query, workspace);
  EXPECT_TRUE(nothing.answer.gap == Gap::EMPTY && nothing.gradients.size() == 2);
  EXPECT_FALSE(nothing.gradients[0].gradient.valid);
  expectContains(nothing.gradients[0].gradient.reason, "nothing");
  EXPECT_TRUE(nothing.gradients[0].gradient.positions.isZero(0.0));

  query.query_type = QueryType::TOLERANCE;
  EXPECT_THROW(clearanceGradients(movers, Against::BOTH, query, workspace), Error);
  MovingRobot late = cart;
  late.tolerance = 0.1;
  const Movers vague(world.snapshot(), {late}, {ball});
  expectContains(errorOf([&] { clearanceGradients(vague, Against::BOTH, Query(), workspace); }), "tolerance");
}

/* A cart leaves the wall when two others begin, too: they are no kinks of its distance. */
TEST_F(Movement, the_starts_of_others_do_not_matter_where_a_robot_is_nearest_at_its_own) {
  ASSERT_TRUE(world.apply(change({add("post", {shape(ShapeType::SPHERE, {0.1})}, translation(-1, 0, 0))})).empty());
  const MovingRobot a{"a", slide(carts.snapshot(), 0, 2, 0), 0.0}, b{"b", slide(carts.snapshot(), 0, 1, 4), 0.0};
  const MovingObject ball =
      mover("ball", {shape(ShapeType::SPHERE, {0.1})}, {{0.0, translation(4, 4, 0)}, {1.0, translation(5, 4, 0)}});
  const Movers movers(world.snapshot(), {a, b}, {ball});
  Query query;
  query.links = {"a"}, query.objects = {"post"};
  const MoversClearance found = clearanceGradients(movers, Against::OTHERS, query, workspace);
  expectDistance(found.answer, 0.8);
  ASSERT_TRUE(found.gradients[0].gradient.valid) << found.gradients[0].gradient.reason;
  EXPECT_NEAR(found.gradients[0].gradient.positions(0, 0), 1.0, 1e-9);
  for (const MoverGradient &by : found.gradients) {
    EXPECT_EQ(by.gradient.start, 0.0) << by.name;
    EXPECT_EQ(by.gradient.duration, 0.0) << by.name;
  }
  EXPECT_EQ(clearanceGradient(movers, a, query = Query(), workspace).gradient.start, 0.0);
}

/* One cart follows the other on the same way: their motion may be the same object. */
TEST_F(Movement, robots_that_share_a_motion_are_told_apart) {
  const auto shared = slide(carts.snapshot(), 0, 2, 0);
  const MovingObject ball =
      mover("ball", {shape(ShapeType::SPHERE, {0.1})},
            {{0.0, translation(1.1, 0.9, 0)}, {0.75, translation(1, 0.5, 0)}, {1.5, translation(0.7, 1.5, 0)}});
  const auto derive = [&](const std::shared_ptr<const RobotMotion> &second) {
    const MovingRobot a{"a", shared, 0.0}, b{"b", second, 0.4};
    Query query;
    query.objects = {"ball"};
    return clearanceGradient(Movers(world.snapshot(), {a, b}, {ball}), b, query, workspace).gradient;
  };
  const ClearanceGradient same = derive(shared), apart = derive(slide(carts.snapshot(), 0, 2, 0));
  EXPECT_GT(apart.positions.norm(), 0.05);
  EXPECT_TRUE(same.positions.isApprox(apart.positions, 1e-12));
  EXPECT_TRUE(same.start == apart.start && same.duration == apart.duration);
}

/* Both at 2 m/s on one rail, 4 m apart: faces meet when the way is 3.8 m; the later one starts after half a second. */
TEST_F(Movement, contact_is_never_told_late) {
  const auto there = slide(carts.snapshot(), 0, 2, 0), back = slide(carts.snapshot(), 0, -2, 4);
  const Movers movers(world.snapshot(), {{"a", there, 0.0}, {"b", back, 0.5}}, {});
  const Answer answer = timeOfContact(movers, Against::BOTH, collision(), workspace);
  const double truth = 1.4; /* the first one stands at 2 from t = 1 on, the second one is at 4 - 2 (t - 0.5) */
  EXPECT_NE(answer.result.verdict, CPROX_VERDICT_CLEAR);
  EXPECT_LE(answer.result.t_contact_lower, truth);
  EXPECT_GE(answer.result.t_contact_lower, truth - 1e-6);
}

/* A box of edge 0.4 falls and turns by a right angle about x, past a shelf; its corner is nearest on the way. */
TEST_F(Movement, an_object_that_falls_and_turns_passes_a_shelf) {
  ASSERT_TRUE(
      world.apply(change({add("shelf", {shape(ShapeType::BOX, {1, 1, 0.1})}, translation(0, -0.8, 0))})).empty());
  Eigen::Isometry3d end = translation(0, 0, -2);
  end.linear() = Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitX()).toRotationMatrix();
  MovingObject box = mover("box", {shape(ShapeType::BOX, {0.4, 0.4, 0.4})}, {{0, translation(0, 0, 2)}, {1, end}});
  const Movers movers(world.snapshot(), {}, {box}, {{"box", "wall"}});
  const Answer answer = ask(movers, Against::OBJECTS, Query(), workspace);
  /* beside the shelf it has turned by 45°: half its diagonal is 0.2828 */
  expectDistance(answer, 0.3 - 0.2 * std::sqrt(2.0));
  EXPECT_EQ(answer.a, "box");
  EXPECT_EQ(answer.b, "shelf");
  EXPECT_NEAR(answer.result.t, 0.5, 0.02);
  /* a constant twist takes its centre 0.83 m aside: into the shelf */
  box.turning = Turning::SCREW;
  const Movers twisting(world.snapshot(), {}, {box}, {{"box", "wall"}});
  EXPECT_EQ(ask(twisting, Against::OBJECTS, collision(), workspace).result.verdict, CPROX_VERDICT_VIOLATED);
}

/* Whoever waits may end the joining of many; names that may touch are left out, and only these. */
TEST_F(Movement, the_joining_of_many_can_be_stopped) {
  std::vector<MovingObject> balls;
  for (int i = 0; i < 60; ++i) {
    const double t = 0.001 * i, x = i < 2 ? 0.3 * i : 10.0 * i;
    balls.push_back(mover("ball" + std::to_string(i), {shape(ShapeType::SPHERE, {0.1})},
                          {{t, translation(x, 0, 0)}, {t + 1.0, translation(x, 1, 0)}}));
  }
  int asked = 0;
  const Movers movers(world.snapshot(), {}, balls, {}, {}, [&] { return ++asked > 1000000; });
  EXPECT_GT(asked, 60);
  const Answer nearest = ask(movers, Against::MOVERS, Query(), workspace);
  EXPECT_EQ(nearest.a, "ball0");
  EXPECT_EQ(nearest.b, "ball1");
  const Movers others(world.snapshot(), {}, balls, {{"ball0", "ball1"}});
  EXPECT_GT(ask(others, Against::MOVERS, Query(), workspace).result.lower, 9.0);
  const int all = asked;
  for (const int last : {0, 1, 30, all - 2}) {
    asked = 0;
    expectContains(errorOf([&] { Movers(world.snapshot(), {}, balls, {}, {}, [&] { return ++asked > last; }); }),
                   "stopped while");
  }
}

/* Ten metres apart, two arms are as near to themselves as each is alone; beside each other they are nearer to the other
 * one. */
TEST_F(Movement, two_arms_far_apart_are_as_near_as_each_to_itself) {
  Scene pandas(dataRobot("panda"));
  TrajectoryDescription t;
  t.id = "reach";
  t.joints = {"panda_joint1", "panda_joint2", "panda_joint4"};
  t.points = {{{-1.0, 0.0, -2.0}, {}, {}, 0.0}, {{1.0, 0.8, -1.2}, {}, {}, 1.0}};
  const auto at = [&](double x, double turn) {
    Eigen::Isometry3d base = translation(x, 0, 0);
    base.linear() = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return std::make_shared<const RobotMotion>(pandas.snapshot(), t, JointPositions{},
                                               std::vector<std::array<std::string, 2>>{}, base);
  };
  Query query;
  query.options.epsilon = 1e-5;
  query.options.max_lod = CPROX_LOD_HULL;
  const auto left = at(0, 0);
  const Answer alone = askSelf(*left, query, workspace);
  const Movers far(world.snapshot(), {{"left", left}, {"right", at(10, 3.1)}}, {});
  const Answer both = ask(far, Against::MOVERS, query, workspace);
  ASSERT_EQ(both.status, "ok") << both.message;
  EXPECT_NEAR(both.result.lower, alone.result.lower, 2.0 * query.options.epsilon);
  EXPECT_EQ(both.result.upper, INFINITY); // hulls bound from below
  const Movers near(world.snapshot(), {{"left", left}, {"right", at(1.6, 3.1)}}, {});
  const Answer nearest = ask(near, Against::MOVERS, query, workspace);
  EXPECT_LE(nearest.result.lower, both.result.lower + query.options.epsilon);
}

TEST_F(Movement, what_cannot_be_is_refused_by_name) {
  const auto there = slide(carts.snapshot(), 0, 2, 0);
  const auto box = [](const std::string &id, std::vector<TimedPose> poses) {
    return mover(id, {shape(ShapeType::BOX, {1, 1, 1})}, std::move(poses));
  };
  const Eigen::Isometry3d here = translation(0, 0, 0);
  const auto refuse = [&](const std::vector<MovingRobot> &robots, const std::vector<MovingObject> &objects,
                          const std::string &because) {
    expectContains(errorOf([&] { Movers(world.snapshot(), robots, objects); }), because);
  };
  refuse({}, {}, "there is no mover");
  refuse({{"a", there}, {"a", there}}, {}, "two movers are named 'a'");
  refuse({{"wall", there}}, {}, "'wall' is a mover and an object that stands");
  refuse({{"a/b", there}}, {}, "it contains '/'");
  refuse({{"a", nullptr}}, {}, "robot 'a' has no motion");
  refuse({}, {box("ball", {})}, "object 'ball': it has no poses");
  refuse({}, {box("ball", {{0, here}})}, "nothing moves: each mover has one pose, 'ball' among them");
  refuse({}, {mover("ball", {}, {{0, here}})}, "object 'ball': it has no shapes");
  refuse({}, {box("ball", {{1, here}, {1, here}})}, "object 'ball': waypoint 0 is at 1 s, waypoint 1 at 1 s");
  refuse({}, {mover("floor", {shape(ShapeType::HALFSPACE, {0, 0, 1, 0})}, {{0, here}, {1, here}})}, "a halfspace");
  refuse({{"a", there, 0.0}, {"b", there, 100.0}}, {}, "the clocks do not overlap: motion 1 begins at 100 s, 99 s");
  refuse({{"a", there, 0.0}, {"b", there, 100.0}}, {}, "1 = 'b'");

  const Movers movers(world.snapshot(), {{"a", there}}, {});
  Query query;
  query.objects = {"wal"};
  expectContains(ask(movers, Against::OBJECTS, query, workspace).message, "there is no object 'wal'");
  query.objects.clear();
  query.links = {"cart"};
  expectContains(ask(movers, Against::OBJECTS, query, workspace).message, "'cart' is no mover, and no link of one");
  expectContains(timeOfContact(movers, Against::OBJECTS, Query(), workspace).message, "a query of type collision");
  EXPECT_EQ(ask(movers, Against::MOVERS, Query(), workspace).status, "empty"); /* nothing to measure */
}

/* A cart that slides, two balls that fall: who is named is asked about. */
TEST_F(Movement, links_of_a_query_name_movers_and_their_links) {
  const auto there = slide(carts.snapshot(), 0, 2, 0);
  const auto ball = [](const std::string &id, double y) {
    return mover(id, {shape(ShapeType::SPHERE, {0.1})}, {{0, translation(0, y, 0)}, {1, translation(2, y, 0)}});
  };
  const Movers movers(world.snapshot(), {{"a", there}}, {ball("near", 0.5), ball("far", 0.65)});
  const auto distance = [&](const std::vector<std::string> &names) {
    Query query;
    query.links = names;
    return ask(movers, Against::OTHERS, query, workspace);
  };
  expectDistance(distance({}), 0.0); /* of the balls */
  expectDistance(distance({"a"}), 0.3);
  expectDistance(distance({"a/cart"}), 0.3);
  EXPECT_EQ(distance({"a"}).b, "near");
  expectDistance(distance({"far"}), 0.0);
}

/* A cart goes through a post and past a ball that moves. Both have a default that allows contact, and an entry of the
 * pair that forbids it: the motion and the movers see the same. */
TEST_F(Movement, an_entry_of_a_pair_wins_over_the_defaults_of_its_names) {
  SceneChange all = change({add("post", {shape(ShapeType::BOX, {0.2, 0.2, 0.2})}, translation(1, 0, 0))});
  all.allowed = {{"post", "", true}, {"ball", "", true}};
  for (const bool forbidden : {false, true}) {
    if (forbidden) all.allowed.insert(all.allowed.end(), {{"cart", "post", false}, {"cart", "ball", false}});
    all.clear = true;
    ASSERT_TRUE(carts.apply(all).empty());
    const auto there = slide(carts.snapshot(), 0, 2, 0);
    const MovingObject ball =
        mover("ball", {shape(ShapeType::SPHERE, {0.1})}, {{0, translation(2, 0, 0)}, {1, translation(0, 0, 0)}});
    const Movers movers(carts.snapshot(), {{"a", there}}, {ball});
    Query query = collision();
    query.allow_empty = true;
    const cprox_verdict expected = forbidden ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR;
    EXPECT_EQ(askEnvironment(*there, query, workspace).front().result.verdict, expected);
    query.links = {"a"};
    EXPECT_EQ(ask(movers, Against::OBJECTS, query, workspace).result.verdict, expected);
    EXPECT_EQ(ask(movers, Against::MOVERS, query, workspace).result.verdict, expected);
  }
}

/* ---- the scene holds what moves ---- */

Operation launch(const std::string &id, std::vector<TimedPose> poses, double radius = 0.1) {
  Operation out = add(id, {shape(ShapeType::SPHERE, {radius})});
  out.trajectory = ObjectTrajectory{std::move(poses), Turning::SLERP, 0};
  return out;
}

TEST_F(Movement, a_scene_keeps_what_moves_apart_from_what_stands) {
  const std::vector<TimedPose> way{{0, translation(0, 1, 0)}, {1, translation(0, 3, 0)}};
  ASSERT_TRUE(world.apply(change({launch("ball", way)})).empty());
  EXPECT_EQ(world.snapshot()->moving().size(), 1u);
  EXPECT_EQ(world.snapshot()->objects().count("ball"), 0u);
  const Movers movers(world.snapshot(), {{"a", slide(carts.snapshot(), 0, 0, 0)}}, movingObjects(*world.snapshot()));
  expectDistance(ask(movers, Against::MOVERS, Query(), workspace), 1.0 - 0.1 - 0.1);

  /* what does not know movers refuses, unless it names what stands */
  const std::string because = "object 'ball' moves along a trajectory";
  Query query;
  expectContains(errorOf([&] { SceneObstacles(world.snapshot(), {}, query); }), because);
  query.objects = {"ball"};
  expectContains(errorOf([&] { SceneObstacles(world.snapshot(), {}, query); }), because);
  query.objects = {"wall"};
  EXPECT_NO_THROW(SceneObstacles(world.snapshot(), {}, query));
  ASSERT_TRUE(carts.apply(change({launch("ball", way)})).empty());
  const auto motion = slide(carts.snapshot(), 0, 1, 0);
  query.objects.clear();
  expectContains(errorOf([&] { askEnvironment(*motion, query, workspace); }), because);
  expectContains(errorOf([&] { nearestPairs(*motion, false, {}, query, workspace); }), because);
  expectContains(errorOf([&] { clearanceProfile(*motion, false, {0, 1}, query, workspace); }), because);
  expectContains(errorOf([&] { clearanceGradient(*motion, RobotPairs::WHOLE, query, workspace); }), because);
  expectContains(errorOf([&] { timeOfContact(*motion, false, collision(), workspace); }), because);
  EXPECT_EQ(askSelf(*motion, query, workspace).status, "empty"); /* a cart has no pair of its own */
  expectContains(errorOf([&] { Movers(carts.snapshot(), {{"a", motion}}, {}); }), "'ball' moves in the scene");

  /* it is replaced and removed as others are */
  const auto faultOf = [&](Operation::Kind kind) {
    Operation operation = add("ball", {shape(ShapeType::SPHERE, {0.1})});
    operation.kind = kind;
    const std::vector<std::string> faults = world.apply(change({operation}));
    return faults.empty() ? "" : faults.front();
  };
  expectContains(faultOf(Operation::Kind::MOVE), "it moves along a trajectory");
  expectContains(faultOf(Operation::Kind::APPEND), "it moves along a trajectory");
  EXPECT_EQ(faultOf(Operation::Kind::ADD), "");
  EXPECT_TRUE(world.snapshot()->moving().empty());
  ASSERT_TRUE(world.apply(change({launch("ball", way)})).empty());
  EXPECT_EQ(world.snapshot()->objects().count("ball"), 0u);
  EXPECT_EQ(faultOf(Operation::Kind::REMOVE), "");
  EXPECT_TRUE(world.snapshot()->moving().empty());
}

TEST_F(Movement, a_trajectory_that_cannot_be_leaves_the_scene_as_it_was) {
  const auto fault = [&](const Operation &operation) {
    const std::vector<std::string> faults = world.apply(change({operation}));
    return faults.size() == 1 ? faults.front() : "";
  };
  expectContains(fault(launch("ball", {})), "object 'ball': it has no poses");
  expectContains(fault(launch("ball", {{1, translation(0, 0, 0)}, {1, translation(0, 0, 1)}})), "waypoint 1 at 1 s");
  expectContains(fault(launch("ball", {{1, translation(0, 0, 0)}, {2, translation(0, NAN, 1)}})), "waypoint 1");
  Operation both = launch("ball", {{0, translation(0, 0, 0)}});
  both.object.pose = translation(0, 0, 1);
  expectContains(fault(both), "a pose and a trajectory");
  EXPECT_TRUE(world.snapshot()->moving().empty());
}

/* Stamps of 2033: a start is a difference of nanoseconds, and no rounding of seconds since 1970. */
TEST_F(Movement, stamps_are_put_on_one_clock) {
  Operation ball = launch("ball", {{0, translation(0, 1, 0)}, {1, translation(0, 3, 0)}});
  ball.trajectory->start = 2000000000000000123;
  ASSERT_TRUE(world.apply(change({ball})).empty());
  const std::int64_t origin = 1999999999000000000;
  const std::vector<MovingObject> objects = movingObjects(*world.snapshot(), origin);
  EXPECT_DOUBLE_EQ(objects.front().start, 1.000000123);
  const auto cart = slide(carts.snapshot(), 0, 1, 0);
  const MovingRobot early{"a", cart, -0.5}, late{"a", cart, 3.0};
  EXPECT_NO_THROW(checkClocks({"a", cart, 0.5}, {}, objects));
  expectContains(errorOf([&] { checkClocks(early, {}, objects); }), "it begins 0.5 s after that of 'a' has ended");
  expectContains(errorOf([&] { checkClocks(late, {}, objects); }), "stale: it ends 1 s before that of 'a' begins");
}

/* ---- what is not checked yet ---- */

TEST_F(Movement, trajectories_whose_points_lack_values_have_no_long_ways) {
  const Robot &robot = *carts.snapshot()->robot();
  TrajectoryDescription t;
  t.joints = {"slide"};
  t.points = {{{}, {}, {}, 0.0}, {{9.0}, {}, {}, 1.0}};
  EXPECT_TRUE(longWays(robot, t).empty());
  t.points = {{{0.0}, {}, {}, 0.0}, {{}, {}, {}, 1.0}};
  EXPECT_TRUE(longWays(robot, t).empty());
  t.shortest_way = true;
  EXPECT_FALSE(errorOf([&] { RobotMotion(carts.snapshot(), t, {}, {}, translation(0, 0, 0)); }).empty());
}

} // namespace
} // namespace curve_proximity
