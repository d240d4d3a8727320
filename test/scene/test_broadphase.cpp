/* SPDX-License-Identifier: BSD-3-Clause */
/* The broadphase saves work and changes no answer. */
#include <chrono>
#include <cmath>

#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace {

/* An object of a random class within a cube, of 5 cm to 1 m. */
Operation randomObject(Random &random, int number, double half) {
  const auto size = [&] { return random.uniform(0.05, 1.0); };
  ShapeDescription s;
  switch (random.below(8)) {
    case 0: s = shape(ShapeType::SPHERE, {size()}); break;
    case 1: s = shape(ShapeType::BOX, {size(), size(), size()}); break;
    case 2: s = shape(ShapeType::CAPSULE, {size(), size()}); break;
    case 3: s = shape(ShapeType::CYLINDER, {size(), size()}); break;
    case 4: s = shape(ShapeType::CONE, {size(), size()}); break;
    case 5: s = shape(ShapeType::ELLIPSOID, {size(), size(), size()}); break;
    case 6: s = shape(ShapeType::POINT, {}); break;
    default:
      s = shape(ShapeType::POLYTOPE, {});
      s.vertices.resize(3, 8);
      for (int i = 0; i < 8; ++i) s.vertices.col(i) = random.vector(0.5);
  }
  const double padding = random.below(3) == 0 ? random.uniform(0.0, 0.2) : 0.0;
  s.pose = random.pose(0.2);
  return add("o" + std::to_string(number), {s}, random.pose(half), padding);
}

/* Each target on its own by the core, none left out. */
cprox_result byHand(const Snapshot &snapshot, const CompiledCurve &curve, const cprox_options &options,
                    std::string &nearest) {
  Workspace workspace;
  cprox_result best{};
  best.lower = best.upper = INFINITY;
  for (const auto &[id, object] : snapshot.objects()) {
    for (const ObjectShape &s : object->shapes) {
      const cprox_result r = distance(along(curve.curve, curve.radius), s.placed.obstacle, options, workspace);
      const double lower = std::min(best.lower, r.lower);
      if (r.upper < best.upper) {
        best = r;
        nearest = id;
      }
      best.lower = lower;
    }
  }
  return best;
}

} // namespace

/* Seed 71: 1000 scenes of 30 objects, curves of degree 1 to 9, half of them tubes. The intervals overlap; the object
 * named is nearest but for the sum of both widths, 2 epsilon. */
TEST(Broadphase, never_changes_a_distance) {
  Random random(71);
  Workspace workspace;
  for (int i = 0; i < 1000; ++i) {
    Scene scene;
    SceneChange world;
    const double half = std::pow(10.0, random.uniform(0.0, 1.5));
    for (int k = 0; k < 30; ++k) world.operations.push_back(randomObject(random, k, half));
    ASSERT_TRUE(scene.apply(world).empty());
    CurveDescription d = randomBezier(random, 1 + random.below(9), half);
    if (i % 2) d.radius = random.uniform(0.0, 0.3);
    const CompiledCurve curve = compile(d);

    Query query;
    const Answer answer = askOne(scene, {}, d, query);
    ASSERT_GE(answer.result.status, 0) << answer.message;
    std::string nearest;
    const cprox_result expected = byHand(*scene.snapshot(), curve, query.options, nearest);
    EXPECT_LE(answer.result.lower, expected.upper) << i;
    EXPECT_GE(answer.result.upper, expected.lower) << i;
    if (answer.b != nearest) {
      EXPECT_NEAR(answer.result.upper, expected.upper, 2e-6) << i;
    }

    // And the verdicts at limits around it.
    for (const double factor : {0.5, 0.99, 1.01, 2.0}) {
      query.query_type = QueryType::TOLERANCE;
      query.delta = expected.upper * factor;
      const Answer verdict = askOne(scene, {}, d, query);
      ASSERT_GE(verdict.result.status, 0);
      if (query.delta < expected.lower - 2e-6) {
        EXPECT_EQ(verdict.result.verdict, CPROX_VERDICT_CLEAR) << i;
      }
      if (query.delta > expected.upper + 2e-6) {
        EXPECT_EQ(verdict.result.verdict, CPROX_VERDICT_VIOLATED) << i;
      }
      EXPECT_LE(verdict.result.lower, expected.upper) << i;
      EXPECT_GE(verdict.result.upper, expected.lower) << i;
      if (verdict.result.verdict == CPROX_VERDICT_CLEAR) {
        EXPECT_GT(verdict.result.lower, query.delta);
      }
    }
    query.query_type = QueryType::COLLISION;
    query.delta = 0.0;
    const Answer hit = askOne(scene, {}, d, query);
    if (expected.lower > 2e-6) {
      EXPECT_EQ(hit.result.verdict, CPROX_VERDICT_CLEAR) << i;
    }
    EXPECT_LE(hit.result.lower, expected.upper) << i;
    EXPECT_GE(hit.result.upper, expected.lower) << i;
    if (hit.result.verdict == CPROX_VERDICT_CLEAR) {
      EXPECT_GT(hit.result.lower, 0.0);
    }
  }
}

/* Seed 72: halfspaces and the links of a robot beside 20 objects. */
TEST(Broadphase, forgets_neither_halfspaces_nor_links) {
  Random random(72);
  const auto husky = dataRobot("husky");
  Workspace workspace;
  for (int i = 0; i < 200; ++i) {
    Scene scene(husky);
    SceneChange world;
    for (int k = 0; k < 20; ++k) world.operations.push_back(randomObject(random, k, 4.0));
    world.operations.push_back(add("plane", {shape(ShapeType::HALFSPACE, {0, 0, 1, random.uniform(0, 3)})}));
    world.default_link_padding = 0.02;
    ASSERT_TRUE(scene.apply(world).empty());
    const LinkPoses poses = husky->linkPoses({}, random.pose(3.0));
    const CurveDescription d = randomBezier(random, 5, 4.0);

    Query query;
    query.per_object = true;
    double lower = INFINITY, upper = INFINITY;
    const std::vector<Answer> each = ask(scene.snapshot(), poses, d, query, workspace);
    EXPECT_EQ(each.size(), 21u + 6u); // six of the Husky's links have geometry
    for (const Answer &a : each) {
      lower = std::min(lower, a.result.lower);
      upper = std::min(upper, a.result.upper);
    }
    query.per_object = false;
    const Answer all = askOne(scene, poses, d, query);
    EXPECT_LE(all.result.lower, upper);
    EXPECT_GE(all.result.upper, lower);
  }
}

/* Seed 73: the boxes that everything else relies on contain their padded bodies. 2000 bodies, 20 directions each. */
TEST(Broadphase, boxes_contain_their_bodies) {
  Random random(73);
  for (int i = 0; i < 2000; ++i) {
    Scene scene;
    ASSERT_TRUE(scene.apply(change({randomObject(random, 0, std::pow(10.0, random.uniform(-3, 4)))})).empty());
    const PlacedShape &placed = scene.snapshot()->objects().at("o0")->shapes[0].placed;
    const Eigen::Isometry3d pose = toIsometry(placed.obstacle.pose);
    for (int k = 0; k < 20; ++k) {
      const Eigen::Vector3d d = random.vector(1.0);
      cprox_vec3 at;
      cprox_body_support(placed.obstacle.body, toVec3(d), &at);
      const Eigen::Vector3d surface = pose * toEigen(at) + (pose.linear() * d).normalized() * placed.obstacle.margin;
      EXPECT_TRUE(placed.box.contains(surface));
    }
  }
}

TEST(Broadphase, objects_at_enormous_distances_are_found) {
  Scene scene;
  SceneChange world;
  for (int k = 0; k < 20; ++k) {
    world.operations.push_back(
        add("o" + std::to_string(k), {shape(ShapeType::SPHERE, {1.0})}, translation(1e200, k, 0)));
  }
  scene.apply(world);
  const Answer far = askOne(scene, {}, line({0, 0, 0}, {1, 0, 0}), Query());
  EXPECT_TRUE(far.result.status < 0 || far.result.upper >= 0.9e200) << far.message;
}
