/* SPDX-License-Identifier: BSD-3-Clause */
/* The broadphase saves work and changes no answer. */
#include <chrono>
#include <cmath>

#include "support.h"
#include "world/world.h"

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

namespace {

/* What the world's trees find, against all boxes one by one. */
void expectFound(const World &world, const Eigen::AlignedBox3d &box, double reach) {
  double nearest = INFINITY;
  std::vector<std::uint32_t> found, wanted;
  for (const std::uint32_t item : world.bounded()) {
    const double gap = boxGap(world.items()[item].shape->box, box);
    nearest = std::min(nearest, gap);
    if (gap <= reach) wanted.push_back(item);
  }
  const NearestBox best = world.nearest({box});
  EXPECT_EQ(std::isfinite(best.gap), !world.bounded().empty());
  if (std::isfinite(nearest)) {
    EXPECT_NEAR(best.gap, nearest, 1e-12 * nearest);
    EXPECT_EQ(best.gap, boxGap(world.items().at(best.id).shape->box, box));
  }
  world.within({box}, reach, found);
  std::sort(found.begin(), found.end());
  EXPECT_TRUE(std::includes(found.begin(), found.end(), wanted.begin(), wanted.end()));
  // the box grows by the reach: its corners are farther away
  for (const std::uint32_t item : found)
    EXPECT_LE(boxGap(world.items().at(item).shape->box, box), std::sqrt(3.0) * reach + 1e-9);
}

} // namespace

/* Seed 74: 60 scenes of up to 40 objects of one to three shapes and a halfspace, 60 changes each: added, replaced, moved,
 * appended to, removed, all gone. Asked after each change in half of the scenes, after some in the
 * others. */
TEST(Broadphase, trees_are_right_after_any_changes) {
  Random random(74);
  for (int i = 0; i < 60; ++i) {
    Scene scene;
    for (int k = 0; k < 60; ++k) {
      SceneChange step;
      for (std::size_t n = 1 + random.below(4); n > 0; --n) {
        const int number = static_cast<int>(random.below(40));
        const std::string id = "o" + std::to_string(number);
        Operation next = randomObject(random, number, 5.0);
        switch (random.below(12)) {
          case 0: next = operation(Operation::Kind::REMOVE, id); break;
          case 1: next = operation(Operation::Kind::MOVE, id, {}, random.pose(5.0)); break;
          case 2:
            next = operation(Operation::Kind::APPEND, id, {shape(ShapeType::SPHERE, {0.3}, random.pose(1.0))});
            break;
          case 3: next = add(id, {shape(ShapeType::HALFSPACE, {0, 0, 1, -9})}); break;
          case 4: next.object.shapes.push_back(shape(ShapeType::BOX, {0.1, 0.2, 0.3}, random.pose(1.0))); break;
          default: break;
        }
        step.operations.push_back(next);
      }
      step.clear_objects = random.below(40) == 0;
      scene.apply(step);
      if (i % 2 == 0 || random.below(5) == 0) {
        const Eigen::Vector3d at = random.vector(6.0);
        const SnapshotPtr now = scene.snapshot();
        expectFound(now->world(), {at, at + random.vector(1.0).cwiseAbs()}, random.uniform(0.0, 4.0));
      }
    }
  }
}

/* 4096 objects, and one more, one moved or one replaced after the other: each is asked about. */
TEST(Broadphase, a_change_costs_few_boxes_and_not_all) {
  Scene scene;
  SceneChange all;
  const auto ball = [](int n, double z) {
    return add("o" + std::to_string(n), {shape(ShapeType::SPHERE, {0.1})}, translation(n % 64, n / 64 % 64, z));
  };
  for (int n = 0; n < 4096; ++n) all.operations.push_back(ball(n, 0.0));
  ASSERT_TRUE(scene.apply(all).empty());
  const auto indexed = [&] {
    const SnapshotPtr now = scene.snapshot();
    now->world().nearest({Eigen::AlignedBox3d(Eigen::Vector3d::Zero())});
    return now->world().indexed();
  };
  EXPECT_EQ(indexed(), 4096u);
  EXPECT_EQ(indexed(), 4096u); // of the same world

  std::size_t added = 0, changed = 0, moved = 0;
  for (int n = 0; n < 1000; ++n) {
    ASSERT_TRUE(scene.apply(change({ball(5000 + n, 1.0)})).empty());
    added += indexed();
  }
  EXPECT_LE(added, 10000u); // log2 of their number, each
  for (int n = 0; n < 1000; ++n) {
    ASSERT_TRUE(scene.apply(change({ball(4 * n, 2.0)})).empty());
    changed += indexed();
  }
  EXPECT_LE(changed, 12000u);
  for (int n = 0; n < 100; ++n) {
    ASSERT_TRUE(scene.apply(change({operation(Operation::Kind::MOVE, "o7", {}, translation(n, 0, 3))})).empty());
    if (n > 0) moved = std::max(moved, indexed());
  }
  EXPECT_LE(moved, 4u);
  ASSERT_TRUE(scene.apply(change({operation(Operation::Kind::REMOVE, "o7")})).empty());
  EXPECT_EQ(indexed(), 0u);
}
