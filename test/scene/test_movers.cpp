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
  EXPECT_LE(both.result.lower, alone.result.upper + 1e-9);
  EXPECT_LE(alone.result.lower, both.result.upper + 1e-9);
  const Movers near(world.snapshot(), {{"left", left}, {"right", at(1.6, 3.1)}}, {});
  const Answer nearest = ask(near, Against::MOVERS, query, workspace);
  EXPECT_LE(nearest.result.lower, both.result.upper);
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
  refuse({}, {box("ball", {})}, "object 'ball' has no poses");
  refuse({}, {mover("ball", {}, {{0, here}})}, "object 'ball' has no shapes");
  refuse({}, {box("ball", {{1, here}, {1, here}})}, "object 'ball': waypoint 0 is at 1 s, waypoint 1 at 1 s");
  refuse({}, {mover("floor", {shape(ShapeType::HALFSPACE, {0, 0, 1, 0})}, {{0, here}, {1, here}})}, "a halfspace");
  refuse({{"a", there, 0.0}, {"b", there, 100.0}}, {}, "the clocks do not overlap: motion 1 begins at 100 s, 99 s");
  refuse({{"a", there, 0.0}, {"b", there, 100.0}}, {}, "1 = 'b'");

  const Movers movers(world.snapshot(), {{"a", there}}, {});
  Query query;
  query.objects = {"wall"};
  expectContains(ask(movers, Against::OBJECTS, query, workspace).message, "objects do not apply to movers");
  query.objects.clear();
  query.links = {"cart"};
  expectContains(ask(movers, Against::OBJECTS, query, workspace).message, "links do not apply to movers");
  expectContains(timeOfContact(movers, Against::OBJECTS, Query(), workspace).message, "a query of type collision");
  EXPECT_EQ(ask(movers, Against::MOVERS, Query(), workspace).result.lower, INFINITY); /* nothing to measure */
}

} // namespace
} // namespace curve_proximity
