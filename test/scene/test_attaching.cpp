/* SPDX-License-Identifier: BSD-3-Clause */
/* What links carry, and links at another size. Distances are computed by hand. */
#include <curve_proximity/motion.hpp>
#include <curve_proximity/movers.hpp>
#include <curve_proximity/near_pairs.hpp>

#include "geometry/scaling.h"
#include "support.h"

namespace curve_proximity {
namespace {

using test::add;
using test::change;
using test::expectContains;
using test::shape;
using test::translation;

/* A cart on a rail along x, an arm on it that swings about y. */
const char *SLIDER = R"(<robot name="slider">
  <link name="rail"/>
  <link name="cart"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="arm"/>
  <joint name="slide" type="prismatic"><parent link="rail"/><child link="cart"/><axis xyz="1 0 0"/><limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
  <joint name="swing" type="continuous"><parent link="cart"/><child link="arm"/><origin xyz="0 0 1"/><axis xyz="0 1 0"/></joint>
</robot>)";

struct Slider : ::testing::Test {
  Scene scene{Robot::fromUrdf(SLIDER)};
  Workspace workspace;

  void SetUp() override {
    EXPECT_TRUE(scene.apply(change({add("wall", {shape(ShapeType::BOX, {1, 4, 4})}, translation(3.5, 0, 0))})).empty());
  }

  static Attachment attachment(const std::string &id, const std::string &link, std::vector<ShapeDescription> shapes,
                               const Eigen::Isometry3d &pose) {
    Attachment out;
    out.link = link;
    out.object = add(id, std::move(shapes), pose).object;
    return out;
  }

  std::vector<std::string> attach(Attachment attachment) {
    SceneChange c;
    c.attachments.push_back(std::move(attachment));
    return scene.apply(c);
  }

  RobotMotion slide(double from, double to) const {
    TrajectoryDescription t;
    t.id = "slide";
    t.joints = {"slide"};
    t.points = {{{from}, {}, {}, 0.0}, {{to}, {}, {}, 1.0}};
    return RobotMotion(scene.snapshot(), t, {});
  }

  void expectNearest(const std::string &a, double distance) {
    const Answer answer = askEnvironment(slide(0, 2), Query(), workspace).front();
    EXPECT_EQ(answer.status, "ok") << answer.message;
    EXPECT_EQ(answer.a, a);
    EXPECT_NEAR(answer.result.upper, distance, 1e-6);
    EXPECT_LE(answer.result.lower, distance + 1e-12);
  }
};

TEST_F(Slider, what_a_link_carries_rides_along_and_is_padded_with_it) {
  expectNearest("cart", 0.9);
  ASSERT_TRUE(attach(attachment("held", "cart", {shape(ShapeType::SPHERE, {0.1})}, translation(0.4, 0, 0))).empty());
  expectNearest("held", 0.5);
  SceneChange padding;
  padding.link_padding["cart"] = 0.05;
  ASSERT_TRUE(scene.apply(padding).empty());
  expectNearest("held", 0.45);
}

/* Two balls of 0.1 on rails along x, 2 m apart in y; a wall at x = 3. The right one carries a ball of 0.1 with a padding of
 * its own, 0.5 ahead of it in y. */
TEST(LinkPadding, counts_against_everything_but_the_robot_itself) {
  const auto ball = [](const std::string &name, const std::string &y) {
    return "<link name='" + name +
           "'><collision><geometry><sphere radius='0.1'/></geometry></collision></link><joint name='" + name +
           "_slides' type='prismatic'><parent link='rails'/><child link='" + name + "'/><origin xyz='0 " + y +
           " 0'/><axis xyz='1 0 0'/><limit lower='-9' upper='9' effort='1' velocity='1'/></joint>";
  };
  const std::string urdf =
      "<robot name='pair'><link name='rails'/>" + ball("left", "2") + ball("right", "0") + "</robot>";
  Workspace workspace;
  const auto check = [&](double padding, double among, bool carries) {
    Scene scene(Robot::fromUrdf(urdf));
    SceneChange c = change({add("wall", {shape(ShapeType::BOX, {1, 9, 4})}, translation(3.5, 0, 0))});
    c.default_link_padding = padding;
    if (carries) {
      Attachment held;
      held.link = "right";
      held.object = add("held", {shape(ShapeType::SPHERE, {0.1})}, translation(0, 0.5, 0)).object;
      held.object.padding = 0.25;
      c.attachments.push_back(held);
    }
    ASSERT_TRUE(scene.apply(c).empty());
    TrajectoryDescription t;
    t.joints = {"left_slides", "right_slides"};
    t.points = {{{-1, 1}, {}, {}, 0.0}, {{1, -1}, {}, {}, 1.0}};
    const auto motion = std::make_shared<const RobotMotion>(scene.snapshot(), t, JointPositions{});
    Query query;
    query.second_opinion = std::make_shared<const SecondOpinions>(Peer::FCL);
    const Answer self = askSelf(*motion, query, workspace);
    EXPECT_EQ(self.status, "ok") << self.message;
    EXPECT_NEAR(self.result.upper, among, 1e-6);
    EXPECT_NEAR(self.second_opinion.distance, among, 1e-4);
    const Answer world = askEnvironment(*motion, query, workspace).front();
    const double ahead = carries ? 0.35 : 0.1;
    EXPECT_NEAR(world.result.upper, 2.0 - ahead - padding, 1e-6);
    const Movers movers(Scene().snapshot(), {{"one", motion}}, {});
    EXPECT_NEAR(ask(movers, Against::MOVERS, Query(), workspace).result.upper, among, 1e-6);
    const auto other = std::make_shared<const RobotMotion>(
        scene.snapshot(), t, JointPositions{}, std::vector<std::array<std::string, 2>>{}, translation(0, 3, 0));
    /* the right one of the other robot and the left one of this robot pass each other 1 m apart */
    const Movers two(Scene().snapshot(), {{"one", motion}, {"two", other}}, {});
    EXPECT_NEAR(ask(two, Against::MOVERS, Query(), workspace).result.upper, std::min(among, 0.8 - 2.0 * padding), 1e-6);

    const StandingRobot standing(scene.snapshot());
    const LinkPoses poses = scene.snapshot()->robot()->linkPoses({});
    RobotPlacement placement;
    for (const auto &[name, link] : scene.snapshot()->robot()->links()) placement.links.push_back(poses.at(name));
    for (const auto &[id, object] : scene.snapshot()->attached()) placement.attached[id] = object;
    NearPairsQuery near;
    near.pairs = RobotPairs::SELF, near.reach = 9.0;
    double least = INFINITY;
    standing.visit(placement, near, workspace, [&](const NearPair &pair) {
      least = std::min(least, pair.result.upper);
      return near.reach;
    });
    EXPECT_NEAR(least, among, 1e-6);
  };
  for (const double padding : {0.0, 0.05, 0.3}) {
    check(padding, 1.8, false);
    check(padding, 1.05, true);
  }
}

TEST_F(Slider, options_that_do_not_apply_to_a_robot_are_refused_and_named) {
  const RobotMotion motion = slide(0, 2);
  const auto expect = [&](const char *word, bool environment, bool self, bool distances, const auto &set) {
    Query query;
    set(query);
    Answer answer = askEnvironment(motion, query, workspace).front();
    EXPECT_EQ(answer.result.status >= 0, environment) << word << ": " << answer.message;
    if (!environment) expectContains(answer.message, word);
    answer = askSelf(motion, query, workspace);
    EXPECT_EQ(answer.result.status >= 0, self) << word << ": " << answer.message;
    if (!self) expectContains(answer.message, word);
    const auto pairs = [&] { nearestPairs(motion, false, {}, query, workspace); };
    const auto profile = [&] { clearanceProfile(motion, false, {0, 1}, query, workspace); };
    if (distances) {
      EXPECT_NO_THROW(pairs()) << word;
      EXPECT_NO_THROW(profile()) << word;
    } else {
      expectContains(test::errorOf(pairs), word);
      expectContains(test::errorOf(profile), word);
    }
  };
  expect("nothing", true, true, true, [](Query &) {});
  expect("signed_distance", true, true, false, [](Query &q) { q.options.signed_distance = true; });
  expect("links", true, true, true, [](Query &q) { q.links = {"cart"}; });
  expect("delta", false, false, false, [](Query &q) { q.delta = 0.1; });
  expect("per_object", true, false, false, [](Query &q) { q.per_object = true; });
  expect("objects", true, false, true, [](Query &q) { q.objects = {"wall"}; });
  expect("query_type", true, true, false, [](Query &q) { q.query_type = QueryType::COLLISION; });
}

TEST_F(Slider, links_and_what_they_carry_are_asked_about_by_name) {
  ASSERT_TRUE(attach(attachment("held", "cart", {shape(ShapeType::SPHERE, {0.1})}, translation(0.4, 0, 0))).empty());
  const RobotMotion motion = slide(0, 2);
  EXPECT_EQ(movingNames(motion), (std::vector<std::string>{"cart", "held"}));
  EXPECT_EQ(askedNames(motion, false), movingNames(motion));
  EXPECT_TRUE(askedNames(motion, true).empty());
  const auto nearest = [&](const std::vector<std::string> &links) {
    Query query;
    query.links = links;
    return askEnvironment(motion, query, workspace).front();
  };
  EXPECT_NEAR(nearest({"cart"}).result.upper, 0.9, 1e-6);
  EXPECT_EQ(nearest({"cart"}).a, "cart");
  EXPECT_NEAR(nearest({"held"}).result.upper, 0.5, 1e-6);
  EXPECT_EQ(nearest({"cart", "held"}).a, "held");
  expectContains(test::errorOf([&] { nearest({"card"}); }), "'card' (did you mean 'cart'?)");
  expectContains(test::errorOf([&] { nearest({"arm"}); }), "'arm'");

  Query cart;
  cart.links = {"cart"};
  EXPECT_EQ(nearestPairs(motion, false, {}, cart, workspace).size(), 1u);
  for (const ClearanceInterval &interval : clearanceProfile(motion, false, {0, 0.5, 1}, cart, workspace)) {
    EXPECT_EQ(interval.a, "cart");
    EXPECT_NEAR(interval.upper, 2.9 - 2 * interval.t1, 1e-6);
  }
}

TEST_F(Slider, the_time_of_contact_is_never_late) {
  Query query;
  query.query_type = QueryType::COLLISION;
  Answer answer = timeOfContact(slide(0, 4), false, query, workspace); // the cart's face is at 0.1 + 4 t, the wall at 3
  EXPECT_EQ(answer.result.verdict, CPROX_VERDICT_VIOLATED);
  EXPECT_LE(answer.result.t_contact_lower, 2.9 / 4 + 1e-15);
  EXPECT_GE(answer.result.t_contact_lower, 2.9 / 4 - 1e-6);
  EXPECT_NEAR(answer.result.t, 2.9 / 4, 1e-6);
  EXPECT_EQ(answer.a + answer.b, "cartwall");

  answer = timeOfContact(slide(0, 2), false, query, workspace);
  EXPECT_EQ(answer.result.verdict, CPROX_VERDICT_CLEAR);
  EXPECT_EQ(answer.result.t_contact_lower, 1.0);
  EXPECT_EQ(timeOfContact(slide(0, 2), true, query, workspace).gap, Gap::EMPTY); // there is no pair
  query.allow_empty = true;
  answer = timeOfContact(slide(0, 2), true, query, workspace);
  EXPECT_EQ(answer.result.verdict, CPROX_VERDICT_CLEAR);
  EXPECT_EQ(answer.result.t_contact_lower, 1.0);
  query.query_type = QueryType::DISTANCE;
  expectContains(timeOfContact(slide(0, 2), false, query, workspace).message, "query_type");
}

TEST(Folding, an_arm_meets_itself_no_earlier_than_told) {
  /* two rods; at the angle 2 asin(0.1 / 0.8) from folded the balls at the ends of the second touch the base's ball */
  const char *folding = R"(<robot name="folding">
    <link name="base"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
    <link name="upper"/>
    <link name="lower"><collision><origin xyz="0 0 0.8"/><geometry><sphere radius="0.1"/></geometry></collision></link>
    <joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/></joint>
    <joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/><origin xyz="0 0 0.8"/><axis xyz="0 1 0"/></joint>
  </robot>)";
  Scene scene{Robot::fromUrdf(folding)};
  TrajectoryDescription t;
  t.id = "fold";
  t.joints = {"shoulder", "elbow"};
  t.points = {{{0, 0}, {}, {}, 0.0}, {{1, M_PI}, {}, {}, 1.0}};
  const RobotMotion motion(scene.snapshot(), t, {});
  Query query;
  query.query_type = QueryType::COLLISION;
  Workspace workspace;
  const Answer answer = timeOfContact(motion, true, query, workspace);
  const double contact = (M_PI - 2 * std::asin(0.1 / 0.8)) / M_PI; // centres 0.2 apart on a circle of radius 0.8
  EXPECT_EQ(answer.kind, "self");
  EXPECT_EQ(answer.result.verdict, CPROX_VERDICT_VIOLATED) << answer.message;
  EXPECT_LE(answer.result.t_contact_lower, contact + 1e-14);
  EXPECT_GE(answer.result.t_contact_lower, contact - 1e-5);
}

TEST_F(Slider, a_curve_meets_what_a_link_carries_where_the_link_is) {
  ASSERT_TRUE(attach(attachment("held", "cart", {shape(ShapeType::SPHERE, {0.1})}, translation(0.4, 0, 0))).empty());
  LinkPoses poses = scene.snapshot()->robot()->linkPoses({{"slide", 1.0}});
  Query query;
  query.objects = {"held"};
  const Answer answer = test::askOne(scene, poses, test::line({1.4, -1, 0.5}, {1.4, 1, 0.5}), query);
  EXPECT_EQ(answer.b, "held");
  EXPECT_NEAR(answer.result.upper, 0.4, 1e-6);
  expectContains(test::askOne(scene, {}, test::line({0, 0, 0}, {1, 0, 0}), query).message, "'cart'");
}

TEST_F(Slider, an_object_of_the_scene_is_taken_up_and_put_down_where_it_is) {
  ASSERT_TRUE(
      scene.apply(change({add("box", {shape(ShapeType::BOX, {0.2, 0.2, 0.2})}, translation(1.5, 0, 0))})).empty());
  Attachment up;
  up.link = "cart";
  up.object.id = "box";
  expectContains(attach(up).at(0), "where link 'cart' is");
  up.link_poses["cart"] = translation(1, 0, 0);
  ASSERT_TRUE(attach(up).empty());
  EXPECT_EQ(scene.snapshot()->objects().count("box"), 0u);
  expectNearest("box", 3 - 2 - 0.6);
  expectContains(scene.apply(change({add("box", {shape(ShapeType::SPHERE, {1})})})).at(0), "'cart' carries it");

  Attachment down = up;
  down.kind = Attachment::Kind::DETACH;
  down.link.clear();
  down.link_poses["cart"] = translation(0, 2, 0);
  ASSERT_TRUE(attach(down).empty());
  EXPECT_TRUE(scene.snapshot()->attached().empty());
  const Eigen::Vector3d at = scene.snapshot()->objects().at("box")->description.pose.translation();
  EXPECT_LT((at - Eigen::Vector3d(0.5, 2, 0)).norm(), 1e-12);
}

TEST_F(Slider, attachments_may_come_before_the_operations_and_be_cleared_apart) {
  const Attachment up = attachment("box", "cart", {shape(ShapeType::BOX, {1, 1, 1})}, translation(0.5, 0, 0));
  ASSERT_TRUE(attach(up).empty());
  SceneChange put_elsewhere = change({add("box", {shape(ShapeType::SPHERE, {1})}, translation(7, 7, 7))});
  put_elsewhere.attachments.push_back(up);
  put_elsewhere.attachments[0].kind = Attachment::Kind::DETACH;
  put_elsewhere.attachments[0].link_poses["cart"] = translation(0, 2, 0);
  expectContains(scene.apply(put_elsewhere).at(0), "'cart' carries it"); /* its turn comes before the detaching */
  ASSERT_TRUE(attach(up).empty());
  put_elsewhere.attachments_first = true;
  ASSERT_TRUE(scene.apply(put_elsewhere).empty());
  EXPECT_TRUE(scene.snapshot()->attached().empty());
  EXPECT_EQ(scene.snapshot()->objects().at("box")->description.pose.translation(), Eigen::Vector3d(7, 7, 7));

  ASSERT_TRUE(attach(up).empty());
  SceneChange away;
  away.clear_attached = true;
  ASSERT_TRUE(scene.apply(away).empty());
  EXPECT_TRUE(scene.snapshot()->attached().empty());
  EXPECT_EQ(scene.snapshot()->objects().count("box"), 0u);
}

TEST_F(Slider, what_is_carried_is_checked_against_links_that_one_joint_moves_unless_it_may_touch_them) {
  Attachment held = attachment("held", "arm", {shape(ShapeType::SPHERE, {0.1})}, translation(0.5, 0, 0));
  TrajectoryDescription t;
  t.joints = {"swing"};
  t.points = {{{0.0}, {}, {}, 0.0}, {{M_PI}, {}, {}, 1.0}}; /* the ball passes below the axis, above the cart */
  ASSERT_TRUE(attach(held).empty());
  Answer answer = askSelf(RobotMotion(scene.snapshot(), t, {}), Query(), workspace);
  EXPECT_EQ(answer.a, "cart");
  EXPECT_EQ(answer.b, "held");
  EXPECT_FALSE(answer.b_is_link);
  EXPECT_NEAR(answer.result.upper, 1.0 - 0.1 - 0.5 - 0.1, 1e-6);

  held.touch_links = {"cart"};
  ASSERT_TRUE(attach(held).empty());
  const RobotMotion motion(scene.snapshot(), t, {});
  answer = askSelf(motion, Query(), workspace);
  EXPECT_EQ(answer.b, "");
  std::string skipped;
  for (const std::string &message : motion.skipped()) skipped += message + "\n";
  expectContains(skipped, "touch_links");
}

TEST_F(Slider, a_scale_enlarges_a_link_and_what_it_carries_before_the_padding) {
  ASSERT_TRUE(attach(attachment("held", "cart", {shape(ShapeType::SPHERE, {0.1})}, translation(0.4, 0, 0))).empty());
  SceneChange c;
  c.link_scale["cart"] = 2.0;
  c.link_padding["cart"] = 0.01;
  ASSERT_TRUE(scene.apply(c).empty());
  expectNearest("held", 3 - 2 - 0.4 - 0.2 - 0.01);
  EXPECT_EQ(scene.snapshot()->linkScales().at("cart"), 2.0);
  EXPECT_EQ(scene.snapshot()->linkGeometry("cart").front().description.dimensions.front(), 0.4);
  c = SceneChange();
  c.link_scale["cart"] = 1.0;
  ASSERT_TRUE(scene.apply(c).empty());
  expectNearest("held", 3 - 2 - 0.4 - 0.1 - 0.01);
  EXPECT_TRUE(scene.snapshot()->linkScales().empty());
}

TEST_F(Slider, what_cannot_be_carried_or_scaled_is_told_by_name_and_changes_nothing) {
  const auto ball = shape(ShapeType::SPHERE, {0.1});
  expectContains(attach(attachment("held", "leg", {ball}, translation(0, 0, 0))).at(0), "'leg'");
  expectContains(attach(attachment("", "cart", {ball}, translation(0, 0, 0))).at(0), "id");
  expectContains(attach(attachment("held", "cart", {}, translation(0, 0, 0))).at(0), "no shapes");
  expectContains(
      attach(attachment("held", "cart", {shape(ShapeType::HALFSPACE, {0, 0, 1, 0})}, translation(0, 0, 0))).at(0),
      "halfspace");
  expectContains(attach(attachment("held", "cart", {ball}, translation(NAN, 0, 0))).at(0), "not finite");
  Attachment down = attachment("held", "", {}, translation(0, 0, 0));
  down.kind = Attachment::Kind::DETACH;
  expectContains(attach(down).at(0), "no link carries");
  for (const double scale : {0.0, -1.0, double(NAN), double(INFINITY)}) {
    SceneChange c;
    c.link_scale["cart"] = scale;
    expectContains(scene.apply(c).at(0), "'cart'");
  }
  SceneChange c;
  c.link_scale["leg"] = 2.0;
  expectContains(scene.apply(c).at(0), "'leg'");
  EXPECT_TRUE(scene.snapshot()->attached().empty());
  EXPECT_TRUE(scene.snapshot()->linkScales().empty());
}

/* The support function of every type at scale 1.7 is 1.7 times its own, about its origin; 1e-9 for the solver of
 * implicit bodies. */
TEST(Scaling, enlarges_every_type_of_shape_about_its_origin) {
  ShapeDescription polytope = shape(ShapeType::POLYTOPE, {}), mesh = shape(ShapeType::MESH, {2, 1, 1}),
                   implicit = shape(ShapeType::IMPLICIT, {}), point = shape(ShapeType::POINT, {}),
                   points = shape(ShapeType::POINTS, {0.05});
  polytope.vertices.resize(3, 4);
  polytope.vertices << 0.1, 0.5, 0, 0, 0, 0, 0.4, 0, 0, 0, 0, 0.3;
  point.vertices = Eigen::Vector3d(0.1, 0.2, 0.3);
  points.vertices = polytope.vertices;
  mesh.vertices = polytope.vertices;
  mesh.triangles.resize(3, 2);
  mesh.triangles << 0, 0, 1, 2, 2, 3;
  implicit.quadrics = {{1, 0, 0, 2, 0, 3, 0.1, 0, 0, -1}};
  implicit.planes = {{0, 0, 1, -0.2}};
  implicit.hyperquadrics = {{{1, 0, 0, 0, 4}, {0, 1, 0, 0.1, 4}, {0, 0, 1, 0, 4}}};
  const std::vector<ShapeDescription> shapes = {point,
                                                shape(ShapeType::SPHERE, {0.3}),
                                                shape(ShapeType::BOX, {0.3, 0.4, 0.5}),
                                                shape(ShapeType::CAPSULE, {0.3, 0.1}),
                                                shape(ShapeType::CYLINDER, {0.3, 0.1}),
                                                shape(ShapeType::CONE, {0.3, 0.1}),
                                                shape(ShapeType::ELLIPSOID, {0.3, 0.4, 0.5}),
                                                shape(ShapeType::SUPERQUADRIC, {0.3, 0.4, 0.5, 3, 4, 2}),
                                                polytope,
                                                points,
                                                mesh,
                                                implicit};
  test::Random random(5);
  for (const ShapeDescription &one : shapes) {
    const ShapeDescription larger = scaledShape(one, 1.7, {});
    const Geometry a = makeGeometry(one), b = makeGeometry(larger);
    Eigen::Vector3d about = Eigen::Vector3d::Zero(); /* of a mesh the mean, at its own scale */
    if (one.type == ShapeType::MESH) about = Eigen::Vector3d(0.3, 0.1, 0.075);
    for (int k = 0; k < 50; ++k) {
      const Eigen::Vector3d n = random.vector(1.0).normalized();
      const double before = cprox_body_support(a.body.get(), toVec3(n), nullptr);
      const double after = cprox_body_support(b.body.get(), toVec3(n), nullptr) + n.dot(larger.pose.translation());
      EXPECT_NEAR(after, 1.7 * before - 0.7 * n.dot(about), 1e-9) << shapeTypeName(one.type);
    }
  }
  const ShapeDescription half = scaledShape(shape(ShapeType::HALFSPACE, {0, 0, 1, -0.5}), 2.0, {});
  EXPECT_EQ(half.dimensions, (std::vector<double>{0, 0, 1, -1.0}));
}

} // namespace
} // namespace curve_proximity
