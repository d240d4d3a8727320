/* SPDX-License-Identifier: BSD-3-Clause */
/* Queries and answers: what is asked about, what comes back, what is refused. */
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace {

Query queryOf(QueryType query_type, double delta = 0.0) {
  Query query;
  query.query_type = query_type;
  query.delta = delta;
  return query;
}

/* A ball of 0.5 at x = 3, a box of 1 at x = -4, both at y = z = 0. */
void fill(Scene &scene) {
  ASSERT_TRUE(scene
                  .apply(change({add("ball", {shape(ShapeType::SPHERE, {0.5})}, translation(3, 0, 0)),
                                 add("crate", {shape(ShapeType::BOX, {1, 1, 1})}, translation(-4, 0, 0))}))
                  .empty());
}

const CurveDescription UPRIGHT = line({0, 0, -1}, {0, 0, 1});

std::string refusal(const CurveDescription &curve) {
  return errorOf([&] { compile(curve); });
}

} // namespace

TEST(Ask, the_nearest_object_is_named_with_both_points_and_the_parameter) {
  Scene scene;
  fill(scene);
  const Answer answer = askOne(scene, {}, UPRIGHT, Query());
  EXPECT_EQ(answer.status, "ok");
  EXPECT_EQ(answer.id, "line");
  EXPECT_EQ(answer.a, "line");
  EXPECT_EQ(answer.kind, "curve");
  EXPECT_EQ(answer.b, "ball");
  EXPECT_FALSE(answer.b_is_link);
  EXPECT_FALSE(answer.by_hull);
  EXPECT_LE(answer.result.lower, 2.5);
  EXPECT_GE(answer.result.upper, 2.5);
  EXPECT_LE(answer.result.upper - answer.result.lower, 1e-6);
  EXPECT_EQ(answer.result.obstacle_index, 0);
  EXPECT_NEAR(answer.result.witness_obstacle.x, 2.5, 1e-5);
  EXPECT_NEAR(answer.result.witness_mover.x, 0.0, 1e-12);
  EXPECT_NEAR(answer.result.t, 0.5, 1e-2);
  EXPECT_NEAR(answer.result.normal.x, -1.0, 1e-5);
  EXPECT_GT(answer.microseconds, 0.0);
}

TEST(Ask, per_object_answers_for_each_by_its_nearest_shape) {
  Scene scene;
  fill(scene);
  scene.apply(
      change({operation(Operation::Kind::APPEND, "crate", {shape(ShapeType::SPHERE, {0.25}, translation(2, 0, 0))})}));
  Query query;
  query.per_object = true;
  Workspace workspace;
  const std::vector<Answer> answers = ask(scene.snapshot(), {}, UPRIGHT, query, workspace);
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0].b, "ball");
  EXPECT_NEAR(answers[0].result.upper, 2.5, 1e-6);
  EXPECT_EQ(answers[1].b, "crate");
  EXPECT_EQ(answers[1].result.obstacle_index, 1); // the ball at x = -2
  EXPECT_NEAR(answers[1].result.upper, 1.75, 1e-6);
}

TEST(Ask, named_objects_alone_are_asked_about) {
  Scene scene(dataRobot("husky"));
  fill(scene);
  const LinkPoses poses = scene.snapshot()->robot()->linkPoses({});
  Query query;
  EXPECT_EQ(askOne(scene, poses, UPRIGHT, query).b, "base_link");
  query.objects = {"crate"};
  EXPECT_EQ(askOne(scene, poses, UPRIGHT, query).b, "crate");
  query.links = {"front_left_wheel_link"};
  const Answer wheel = askOne(scene, poses, UPRIGHT, query);
  EXPECT_EQ(wheel.b, "front_left_wheel_link");
  EXPECT_TRUE(wheel.b_is_link);
  query.objects = {"crate", "table"};
  const Answer refused = askOne(scene, poses, UPRIGHT, query);
  EXPECT_EQ(refused.status, "invalid");
  expectContains(refused.message, "'table'");
  query.objects = {};
  query.links = {"tail"};
  expectContains(askOne(scene, poses, UPRIGHT, query).message, "no link 'tail'");
  query.links = {"base_footprint"};
  expectContains(askOne(scene, poses, UPRIGHT, query).message, "no collision geometry");
}

TEST(Ask, a_link_whose_pose_is_unknown_never_reads_as_free) {
  Scene scene(dataRobot("husky"));
  LinkPoses poses = scene.snapshot()->robot()->linkPoses({});
  poses.erase("front_left_wheel_link");
  const Answer missing = askOne(scene, poses, UPRIGHT, Query());
  EXPECT_EQ(missing.status, "invalid");
  expectContains(missing.message, "front_left_wheel_link");
  Query query;
  query.links = {"base_link"};
  EXPECT_EQ(askOne(scene, poses, UPRIGHT, query).status, "ok");
  poses["base_link"].translation().x() = NAN;
  expectContains(askOne(scene, poses, UPRIGHT, query).message, "base_link");
  poses = {{"tail", Eigen::Isometry3d::Identity()}};
  expectContains(askOne(scene, poses, UPRIGHT, Query()).message, "no link 'tail'");
  expectContains(askOne(Scene(), poses, UPRIGHT, Query()).message, "no robot");
}

TEST(Ask, meshes_say_which_model_answered) {
  Scene scene(dataRobot("panda"));
  const LinkPoses poses = scene.snapshot()->robot()->linkPoses({});
  const char *words[] = {"bounding sphere", "convex hull", "mesh"};
  double above = 0.0;
  for (const cprox_lod lod : {CPROX_LOD_SPHERE, CPROX_LOD_HULL, CPROX_LOD_MESH}) {
    Query query;
    query.options.max_lod = lod;
    const Answer answer = askOne(scene, poses, line({1, 0, 0}, {1, 0, 1}), query);
    EXPECT_EQ(answer.status, "ok");
    EXPECT_EQ(answer.by_hull, lod != CPROX_LOD_MESH);
    EXPECT_TRUE(answer.b_is_link);
    EXPECT_EQ(answer.result.lod, lod);
    expectContains(answer.message, words[lod - CPROX_LOD_SPHERE]);
    EXPECT_GE(answer.result.lower, above - query.options.epsilon); // a finer model is contained in the coarser ones
    EXPECT_EQ(std::isinf(answer.result.upper), lod != CPROX_LOD_MESH);
    above = answer.result.lower;
  }
}

/* A bracket: three plates of a U that opens upwards, 2 wide and 1 high. A line runs between its arms, 1 from the floor
 * less 0.4. */
TEST(Ask, a_curve_in_the_hull_of_a_mesh_is_clear_of_the_mesh) {
  ShapeDescription bracket = shape(ShapeType::MESH, {});
  bracket.vertices.resize(3, 8);
  bracket.vertices << -1, -1, 1, 1, -1, -1, 1, 1, /**/ -1, 1, -1, 1, -1, 1, -1, 1, /**/ 1, 1, 1, 1, 0, 0, 0, 0;
  bracket.triangles.resize(3, 6);
  bracket.triangles << 0, 1, 2, 3, 4, 5, /**/ 1, 5, 3, 7, 5, 7, /**/ 4, 4, 6, 6, 6, 6;
  Scene scene;
  ASSERT_TRUE(scene.apply(change({add("bracket", {bracket})})).empty());
  const CurveDescription between = line({0, -3, 0.6}, {0, 3, 0.6});
  Query query;
  query.query_type = QueryType::COLLISION;
  Answer answer = askOne(scene, {}, between, query);
  EXPECT_EQ(answer.result.verdict, CPROX_VERDICT_CLEAR);
  EXPECT_EQ(answer.result.lod, CPROX_LOD_MESH);
  query.options.max_lod = CPROX_LOD_HULL;
  answer = askOne(scene, {}, between, query);
  EXPECT_EQ(answer.result.verdict, CPROX_VERDICT_UNDECIDED);
  EXPECT_EQ(answer.result.lod, CPROX_LOD_HULL);

  query = Query();
  answer = askOne(scene, {}, between, query);
  EXPECT_LE(answer.result.lower, 0.6);
  EXPECT_GE(answer.result.upper, 0.6);
  EXPECT_LE(answer.result.upper - answer.result.lower, 1.01e-6);
  expectContains(answer.message, "surface alone");
}

/* A closed box of triangles, one of them taken away or not, and a curve that stays inside it, 0.9 from its walls. */
TEST(Ask, the_inside_of_a_mesh_counts_where_it_is_asked_for_and_closed) {
  ShapeDescription cube = shape(ShapeType::MESH, {});
  cube.vertices.resize(3, 8);
  for (int i = 0; i < 8; ++i) cube.vertices.col(i) << 2 * (i & 1) - 1, (i & 2) - 1, (i >> 1 & 2) - 1;
  cube.triangles.resize(3, 12);
  cube.triangles << 0, 0, 1, 1, 0, 0, 2, 2, 0, 0, 4, 4, /**/ 4, 6, 3, 7, 1, 5, 6, 7, 2, 3, 5, 7, /**/ 6, 2, 7, 5, 5, 4,
      7, 3, 3, 1, 7, 6;
  const CurveDescription inside = line({-0.1, 0, 0}, {0.1, 0, 0});
  const auto ask = [&](bool solid, Eigen::Index triangles) {
    ShapeDescription shape = cube;
    shape.solid = solid;
    shape.triangles.conservativeResize(3, triangles);
    Scene scene;
    EXPECT_TRUE(scene.apply(change({add("cube", {shape})})).empty());
    return askOne(scene, {}, inside, Query());
  };
  EXPECT_NEAR(ask(false, 12).result.upper, 0.9, 1e-6);
  expectContains(ask(false, 12).message, "surface alone");
  EXPECT_EQ(ask(true, 12).result.upper, 0.0);
  expectContains(ask(true, 12).message, "closed mesh: its inside counts");
  EXPECT_NEAR(ask(true, 11).result.upper, 0.9, 1e-6);
  expectContains(ask(true, 11).message, "not closed");
  EXPECT_EQ(ask(true, 11).status, "partial");
  EXPECT_EQ(ask(true, 11).result.lower, 0.0);
  EXPECT_EQ(ask(false, 11).status, "ok");
}

TEST(Ask, with_nothing_to_measure_everything_is_far_if_the_caller_says_so) {
  const Scene scene;
  for (const bool per_object : {false, true}) {
    for (const QueryType query_type : {QueryType::DISTANCE, QueryType::TOLERANCE, QueryType::COLLISION}) {
      Query query = queryOf(query_type, query_type == QueryType::TOLERANCE ? 1.0 : 0.0);
      query.per_object = per_object;
      const Answer unsure = askOne(scene, {}, UPRIGHT, query);
      EXPECT_EQ(unsure.status, "empty");
      EXPECT_EQ(unsure.gap, Gap::EMPTY);
      EXPECT_EQ(unsure.result.lower, 0.0);
      EXPECT_EQ(unsure.result.upper, INFINITY);
      EXPECT_EQ(unsure.result.verdict, CPROX_VERDICT_UNDECIDED);
      expectContains(unsure.message, "there is no object");
      query.allow_empty = true;
      const Answer answer = askOne(scene, {}, UPRIGHT, query);
      EXPECT_EQ(answer.status, "ok");
      EXPECT_EQ(answer.b, "");
      EXPECT_EQ(answer.result.lower, INFINITY);
      EXPECT_EQ(answer.result.upper, INFINITY);
      EXPECT_EQ(answer.result.obstacle_index, -1);
      if (query_type == QueryType::TOLERANCE) {
        EXPECT_EQ(answer.result.verdict, CPROX_VERDICT_CLEAR);
      }
      if (query_type == QueryType::COLLISION) {
        EXPECT_EQ(answer.result.verdict, CPROX_VERDICT_CLEAR);
      }
    }
  }
}

TEST(Ask, verdicts_follow_from_the_distance) {
  Scene scene;
  fill(scene);
  EXPECT_EQ(askOne(scene, {}, UPRIGHT, queryOf(QueryType::TOLERANCE, 2.49)).result.verdict, CPROX_VERDICT_CLEAR);
  EXPECT_EQ(askOne(scene, {}, UPRIGHT, queryOf(QueryType::TOLERANCE, 2.51)).result.verdict, CPROX_VERDICT_VIOLATED);
  EXPECT_EQ(askOne(scene, {}, UPRIGHT, queryOf(QueryType::COLLISION)).result.verdict, CPROX_VERDICT_CLEAR);
  const Answer hit = askOne(scene, {}, line({0, 0, 0}, {9, 0, 0}), queryOf(QueryType::COLLISION));
  EXPECT_EQ(hit.result.verdict, CPROX_VERDICT_VIOLATED);
  EXPECT_EQ(hit.b, "ball");
  EXPECT_EQ(hit.result.upper, 0.0);
  CurveDescription tube = UPRIGHT;
  tube.radius = 2.6;
  EXPECT_EQ(askOne(scene, {}, tube, queryOf(QueryType::COLLISION)).result.verdict, CPROX_VERDICT_VIOLATED);
}

TEST(Ask, a_halfspace_is_seen_from_everywhere) {
  Scene scene;
  fill(scene);
  scene.apply(change({add("floor", {shape(ShapeType::HALFSPACE, {0, 0, 1, 2})})}));
  const Answer answer = askOne(scene, {}, UPRIGHT, Query());
  EXPECT_EQ(answer.b, "floor"); // z <= -2, 1 below the curve's end
  EXPECT_LE(answer.result.lower, 1.0);
  EXPECT_GE(answer.result.upper, 1.0);
}

TEST(Ask, bad_options_are_answers_and_the_next_query_is_answered) {
  Scene scene;
  fill(scene);
  std::vector<Operation> many;
  for (int i = 0; i < 30; ++i)
    many.push_back(add("o" + std::to_string(i), {shape(ShapeType::SPHERE, {0.1})}, translation(i, 5, 0)));
  Workspace workspace;
  for (const bool crowded : {false, true}) {
    if (crowded) scene.apply(change(many));
    for (const QueryType query_type : {QueryType::DISTANCE, QueryType::TOLERANCE, QueryType::COLLISION}) {
      const auto expectRefused = [&](const Query &query, const std::string &word) {
        const std::vector<Answer> answers = ask(scene.snapshot(), {}, UPRIGHT, query, workspace);
        ASSERT_EQ(answers.size(), 1u);
        EXPECT_EQ(answers[0].status, "invalid");
        EXPECT_LT(answers[0].result.status, 0);
        expectContains(answers[0].message, word);
      };
      Query query = queryOf(query_type);
      query.options.epsilon = NAN;
      expectRefused(query, "epsilon");
      query.options.epsilon = -1e-3;
      expectRefused(query, "epsilon");
      query = queryOf(query_type);
      query.options.max_nodes = 0;
      expectRefused(query, "nodes");
      if (query_type == QueryType::TOLERANCE) {
        for (const double delta : {-0.1, static_cast<double>(NAN)}) expectRefused(queryOf(query_type, delta), "delta");
      }
      EXPECT_EQ(ask(scene.snapshot(), {}, UPRIGHT, queryOf(query_type), workspace).at(0).status, "ok");
    }
  }
}

TEST(Ask, a_small_budget_still_gives_a_true_interval) {
  Scene scene;
  fill(scene);
  Random random(61);
  for (int i = 0; i < 200; ++i) {
    const CurveDescription curve = randomBezier(random, 12, 6.0);
    Query query;
    const Answer full = askOne(scene, {}, curve, query);
    query.options.max_nodes = 1;
    const Answer poor = askOne(scene, {}, curve, query);
    EXPECT_LE(poor.result.lower, full.result.upper);
    EXPECT_GE(poor.result.upper, full.result.lower);
    if (poor.status != "ok") {
      EXPECT_FALSE(poor.message.empty());
    }
  }
}

TEST(Ask, the_stop_function_ends_a_query) {
  Scene scene;
  fill(scene);
  Query query;
  query.options.epsilon = 0.0;
  query.options.stop = [](void *) { return true; };
  Random random(62);
  const Answer answer = askOne(scene, {}, randomBezier(random, 20, 6.0), query);
  EXPECT_GE(answer.result.status, 0);
  EXPECT_LE(answer.result.lower, answer.result.upper);
}

TEST(Nearest, shapes_come_in_order_and_within_the_limit) {
  Scene scene;
  fill(scene);
  const SceneObstacles targets(scene.snapshot(), {}, Query());
  const CompiledCurve curve = compile(UPRIGHT);
  Workspace workspace;
  std::vector<Answer> answers = nearestPairs(targets, curve, {}, Query(), workspace);
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0].b + " " + answers[1].b, "ball crate");
  EXPECT_EQ(answers[0].a, "line");
  EXPECT_NEAR(answers[0].result.upper, 2.5, 1e-6);
  EXPECT_NEAR(answers[1].result.upper, 3.5, 1e-6);
  EXPECT_LE(answers[1].result.lower, 3.5);
  EXPECT_EQ(nearestPairs(targets, curve, {10, 3.0}, Query(), workspace).size(), 1u);
  EXPECT_EQ(nearestPairs(targets, curve, {1, 100.0}, Query(), workspace).size(), 1u);
  EXPECT_TRUE(nearestPairs(targets, curve, {10, 1.0}, Query(), workspace).empty());
  expectContains(errorOf([&] { nearestPairs(targets, curve, {}, queryOf(QueryType::COLLISION), workspace); }),
                 "query_type");
  Query each;
  each.per_object = true;
  expectContains(errorOf([&] { nearestPairs(targets, curve, {}, each, workspace); }), "per_object");
  const Scene empty;
  const std::vector<Answer> none =
      nearestPairs(SceneObstacles(empty.snapshot(), {}, Query()), curve, {}, Query(), workspace);
  ASSERT_EQ(none.size(), 1u);
  EXPECT_EQ(none.front().gap, Gap::EMPTY);
}

TEST(Profile, each_interval_contains_the_least_distance) {
  constexpr int CASES = 40, INTERVALS = 7, SAMPLES = 60;
  Random random(20);
  Workspace workspace;
  for (int i = 0; i < CASES; ++i) {
    Scene scene;
    std::vector<Operation> objects;
    for (int k = 0; k < 4; ++k)
      objects.push_back(add("o" + std::to_string(k), {shape(ShapeType::SPHERE, {0.2})}, random.pose(2)));
    ASSERT_TRUE(scene.apply(change(objects)).empty());
    const SceneObstacles targets(scene.snapshot(), {}, Query());
    const CompiledCurve curve = compile(randomBezier(random, 4, 2.0));
    std::vector<double> breaks;
    for (int k = 0; k <= INTERVALS; ++k) breaks.push_back(k / static_cast<double>(INTERVALS));
    const auto profile = clearanceProfile(targets, curve, breaks, Query(), workspace);
    ASSERT_EQ(profile.size(), static_cast<std::size_t>(INTERVALS));
    double least = std::numeric_limits<double>::infinity();
    for (const ClearanceInterval &interval : profile) {
      EXPECT_LE(interval.upper - interval.lower, 1e-6);
      EXPECT_GE(interval.t, interval.t0);
      EXPECT_LE(interval.t, interval.t1);
      double sampled = std::numeric_limits<double>::infinity();
      for (int k = 0; k <= SAMPLES; ++k) {
        cprox_vec3 point;
        cprox_curve_evaluate(curve.curve.get(), interval.t0 + (interval.t1 - interval.t0) * k / SAMPLES,
                             workspace.get(), &point, nullptr, nullptr);
        for (const Operation &object : objects)
          sampled = std::min(sampled, std::max(0.0, (toEigen(point) - object.object.pose.translation()).norm() - 0.2));
      }
      EXPECT_LE(interval.lower, sampled + 1e-12) << i;
      least = std::min(least, interval.upper);
    }
    const double all = ask(targets, curve, Query(), workspace).front().result.upper;
    EXPECT_NEAR(least, all, 2e-6) << i;

    /* beyond a horizon clearance is only bounded */
    const double horizon = 1.5 * all;
    const auto near = clearanceProfile(targets, curve, breaks, Query(), workspace, horizon);
    for (std::size_t k = 0; k < near.size(); ++k) {
      EXPECT_EQ(near[k].status, CPROX_OK);
      EXPECT_TRUE(near[k].upper - near[k].lower <= 1e-6 || near[k].lower > horizon) << i;
      EXPECT_TRUE(near[k].lower <= profile[k].upper && profile[k].lower <= near[k].upper) << i;
    }
    EXPECT_THROW(clearanceProfile(targets, curve, breaks, Query(), workspace, -1.0), Error);
  }
}

TEST(Contact, no_sampled_contact_comes_before_the_time) {
  constexpr int CASES = 200, SAMPLES = 400;
  Random random(21);
  Workspace workspace;
  Query query = queryOf(QueryType::COLLISION);
  int contacts = 0;
  for (int i = 0; i < CASES; ++i) {
    Scene scene;
    const Operation ball = add("ball", {shape(ShapeType::SPHERE, {0.5})}, random.pose(1));
    ASSERT_TRUE(scene.apply(change({ball})).empty());
    const SceneObstacles targets(scene.snapshot(), {}, Query());
    const CompiledCurve curve = compile(randomBezier(random, 5, 2.0));
    const Answer answer = timeOfContact(targets, curve, query, workspace);
    ASSERT_GE(answer.result.status, 0) << answer.message;
    const Answer collides = ask(targets, curve, query, workspace).front();
    EXPECT_EQ(answer.result.verdict, collides.result.verdict) << i;
    contacts += answer.result.verdict == CPROX_VERDICT_VIOLATED;
    for (int k = 0; k < SAMPLES && answer.result.t_contact_lower > 0; ++k) { // at 0: it begins in contact
      const double t = answer.result.t_contact_lower * k / SAMPLES;
      cprox_vec3 point;
      cprox_curve_evaluate(curve.curve.get(), t, workspace.get(), &point, nullptr, nullptr);
      EXPECT_GT((toEigen(point) - ball.object.pose.translation()).norm(), 0.5 - 1e-14) << i;
    }
    if (answer.result.verdict == CPROX_VERDICT_VIOLATED) {
      cprox_vec3 point;
      cprox_curve_evaluate(curve.curve.get(), answer.result.t, workspace.get(), &point, nullptr, nullptr);
      EXPECT_LE((toEigen(point) - ball.object.pose.translation()).norm(), 0.5 + 1e-12) << i;
    }
  }
  EXPECT_GT(contacts, 20);
  query.query_type = QueryType::DISTANCE;
  Scene scene;
  fill(scene);
  expectContains(
      timeOfContact(SceneObstacles(scene.snapshot(), {}, Query()), compile(UPRIGHT), query, workspace).message,
      "query_type");
}

TEST(Compile, curves_that_are_none_are_told_in_a_message) {
  CurveDescription curve = UPRIGHT;
  curve.basis = "fourier";
  expectContains(refusal(curve), "basis 'fourier' is not available");
  curve = UPRIGHT;
  curve.degree = 3;
  expectContains(refusal(curve), "degree 3");
  curve = UPRIGHT;
  curve.knots = {0, 1};
  expectContains(refusal(curve), "no knots");
  for (const double radius : {-1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    curve = UPRIGHT;
    curve.radius = radius;
    expectContains(refusal(curve), "radius");
  }
  curve = UPRIGHT;
  curve.points.resize(3, 1);
  curve.points.setZero();
  EXPECT_FALSE(refusal(curve).empty());
  curve.points.resize(3, 0);
  EXPECT_FALSE(refusal(curve).empty());
  curve = UPRIGHT;
  curve.points(1, 1) = NAN;
  EXPECT_FALSE(refusal(curve).empty());
  curve = UPRIGHT;
  curve.t1 = curve.t0;
  EXPECT_FALSE(refusal(curve).empty());
  curve = UPRIGHT;
  curve.basis = "bspline";
  curve.degree = 1;
  EXPECT_FALSE(refusal(curve).empty()); // no knots
  curve.knots = {0, 1, 0.5, 1};
  expectContains(refusal(curve), "knot");
}

TEST(Compile, a_bad_curve_is_an_answer) {
  Scene scene;
  CurveDescription curve = UPRIGHT;
  curve.basis = "fourier";
  const Answer answer = askOne(scene, {}, curve, Query());
  EXPECT_EQ(answer.status, "invalid");
  EXPECT_EQ(answer.id, "line");
  expectContains(answer.message, "basis 'fourier' is not available");
}

/* One parabola, (t, t², 0) on [-1, 2], as every basis says it, and a circle: the nearest point to (0, -1, 0) is known.
 */
TEST(Compile, every_basis_describes_the_same_curve) {
  Scene scene;
  ASSERT_TRUE(scene.apply(change({add("point", {shape(ShapeType::POINT, {})}, translation(0, -1, 0))})).empty());
  CurveDescription d;
  d.degree = 2;
  d.t0 = -1.0;
  d.t1 = 2.0;
  const auto expectDistance = [&](const std::string &basis, std::initializer_list<double> points,
                                  const std::vector<double> &knots, double distance) {
    d.basis = basis;
    d.knots = knots;
    d.points = Eigen::Map<const Eigen::Matrix3Xd>(points.begin(), 3, static_cast<Eigen::Index>(points.size() / 3));
    const Answer answer = askOne(scene, {}, d, Query());
    EXPECT_EQ(answer.status, "ok") << basis << ": " << answer.message;
    EXPECT_LE(answer.result.lower, distance + 1e-13) << basis;
    EXPECT_GE(answer.result.upper, distance - 1e-13) << basis;
  };
  expectDistance("bezier", {-1, 1, 0, 0.5, -2, 0, 2, 4, 0}, {}, 1.0);
  expectDistance("bspline", {-1, 1, 0, 0.5, -2, 0, 2, 4, 0}, {-1, -1, -1, 2, 2, 2}, 1.0);
  expectDistance("polynomial", {0, 0, 0, 1, 0, 0, 0, 1, 0}, {}, 1.0);
  expectDistance("legendre", {0.5, 1, 0, 1.5, 1.5, 0, 0, 1.5, 0}, {}, 1.0);
  expectDistance("lagrange", {2, 4, 0, 0, 0, 0, -1, 1, 0}, {2, 0, -1}, 1.0);
  d.degree = 1;
  expectDistance("trigonometric", {0, 0, 0, 3, 0, 0, 0, 3, 0}, {},
                 std::hypot(3.0 * std::cos(-1.0), 1.0 + 3.0 * std::sin(-1.0)));
}

/* A half circle of radius 1 about (0, 1, 0) as Dubins path, rational curve and two pieces, turned upright by a pose and
 * restricted to its later half: from (0, 0, 1) it is as near as its end or its middle. */
TEST(Compile, named_curves_stand_where_their_pose_says) {
  Scene scene;
  ASSERT_TRUE(scene.apply(change({add("point", {shape(ShapeType::POINT, {})}, translation(0, 0, -1))})).empty());
  const double h = std::sqrt(0.5), pi = std::acos(-1.0);
  CurveDescription dubins;
  dubins.basis = "dubins";
  dubins.points.resize(3, 2);
  dubins.points << 0, 0, 0, 2, 0, 0;
  dubins.parameters = {0, pi, 1};
  CurveDescription nurbs;
  nurbs.basis = "nurbs";
  nurbs.degree = 2;
  nurbs.t1 = pi;
  nurbs.points.resize(3, 5);
  nurbs.points << 0, 1, 1, 1, 0, 0, 0, 1, 2, 2, 0, 0, 0, 0, 0;
  nurbs.knots = {0, 0, 0, pi / 2, pi / 2, pi, pi, pi};
  nurbs.parameters = {1, h, 1, h, 1};
  CurveDescription pieces;
  pieces.basis = "piecewise";
  pieces.pieces.resize(2, nurbs);
  pieces.pieces[0].restrict_t0 = 0.0, pieces.pieces[0].restrict_t1 = 1.0;
  pieces.pieces[1].restrict_t0 = 1.0, pieces.pieces[1].restrict_t1 = pi;
  for (CurveDescription d : {dubins, nurbs, pieces}) {
    /* y becomes z: the circle is about (0, 0, 1), the point two below its middle and one below its start */
    d.pose = Eigen::Isometry3d(Eigen::AngleAxisd(pi / 2, Eigen::Vector3d::UnitX()));
    const auto expectDistance = [&](double distance) {
      const Answer answer = askOne(scene, {}, d, Query());
      EXPECT_EQ(answer.status, "ok") << d.basis << ": " << answer.message;
      EXPECT_LE(answer.result.lower, distance + 1e-12) << d.basis;
      EXPECT_GE(answer.result.upper, distance - 1e-12) << d.basis;
    };
    expectDistance(1.0);
    d.restrict_t0 = pi / 2, d.restrict_t1 = 3.0;
    expectDistance(std::sqrt(5.0)); // from (1, 0, 1)
  }
}

TEST(Compile, coefficients_that_do_not_fit_the_basis_are_told_in_a_message) {
  CurveDescription curve = UPRIGHT;
  curve.degree = 2;
  for (const char *basis : {"polynomial", "legendre", "lagrange"}) {
    curve.basis = basis;
    expectContains(refusal(curve), "of degree 2 has 3 points, got 2");
  }
  curve.basis = "trigonometric";
  expectContains(refusal(curve), "of degree 2 has 5 points, got 2");
  curve.degree = 1;
  curve.basis = "lagrange";
  expectContains(refusal(curve), "takes 2 nodes, got 0");
  curve.basis = "legendre";
  curve.knots = {0, 1};
  expectContains(refusal(curve), "takes no knots, got 2");
  curve.degree = std::numeric_limits<std::size_t>::max();
  expectContains(refusal(curve), "above 60");
}

/* Seed 65, 100 curves of each basis: 50 points of each lie in the boxes, up to the rounding of those points. */
TEST(Compile, the_boxes_contain_curves_of_every_basis) {
  Random random(65);
  for (int i = 0; i < 400; ++i) {
    CurveDescription d = randomBezier(random, 1 + random.below(30), 1.0);
    d.basis = std::array<const char *, 4>{"polynomial", "legendre", "lagrange", "trigonometric"}[i % 4];
    d.degree = static_cast<std::size_t>(d.points.cols()) - 1;
    if (d.basis == "lagrange") {
      for (std::size_t k = 0; k <= d.degree; ++k) {
        d.knots.push_back(0.5 - 0.5 * std::cos(3.14159 * static_cast<double>(k) / static_cast<double>(d.degree)));
      }
    }
    if (d.basis == "trigonometric") {
      d.degree = 1 + random.below(8);
      d.t1 = random.uniform(1e-3, 7.0);
      d.points.resize(3, static_cast<Eigen::Index>(2 * d.degree + 1));
      for (Eigen::Index k = 0; k < d.points.cols(); ++k) d.points.col(k) = random.vector(1.0);
    }
    const CompiledCurve curve = compile(d);
    EXPECT_LE(curve.boxes.size(), 32u);
    for (int k = 0; k <= 50; ++k) {
      cprox_vec3 p;
      const double t = std::min(d.t1, d.t0 + (d.t1 - d.t0) * k / 50.0);
      ASSERT_EQ(cprox_curve_evaluate(curve.curve.get(), t, nullptr, &p, nullptr, nullptr), CPROX_OK);
      double least = INFINITY;
      for (const Eigen::AlignedBox3d &box : curve.boxes) least = std::min(least, box.exteriorDistance(toEigen(p)));
      EXPECT_LE(least, 1e-10) << d.basis << " " << i << " at " << t;
    }
  }
}

/* Seed 63, 400 curves: 50 points of each lie in the boxes, and the boxes' union in the curve's own bounds but for their
 * margin. */
TEST(Compile, the_boxes_contain_the_curve) {
  Random random(63);
  for (int i = 0; i < 400; ++i) {
    CurveDescription d = randomBezier(random, 1 + random.below(20), 3.0);
    if (i % 2) {
      d.basis = "bspline";
      d.degree = 1 + random.below(5);
      const std::size_t n = d.degree + 1 + random.below(80);
      d.points.resize(3, static_cast<Eigen::Index>(n));
      for (Eigen::Index k = 0; k < d.points.cols(); ++k) d.points.col(k) = random.vector(3.0);
      double knot = 0.0;
      for (std::size_t k = 0; k < n + d.degree + 1; ++k) {
        if (random.below(3)) knot += random.uniform(0.0, 1.0);
        d.knots.push_back(knot);
      }
      const double from = d.knots[d.degree], to = d.knots[n];
      if (!(from < to)) continue;
      d.t0 = from + (to - from) * random.uniform(0.0, 0.4);
      d.t1 = to - (to - from) * random.uniform(0.0, 0.4);
    }
    const CompiledCurve curve = compile(d);
    ASSERT_FALSE(curve.boxes.empty());
    EXPECT_LE(curve.boxes.size(), 32u);
    for (int k = 0; k <= 50; ++k) {
      const double t = std::min(d.t1, d.t0 + (d.t1 - d.t0) * k / 50.0);
      cprox_vec3 p;
      ASSERT_EQ(cprox_curve_evaluate(curve.curve.get(), t, nullptr, &p, nullptr, nullptr), CPROX_OK);
      double least = INFINITY;
      for (const Eigen::AlignedBox3d &box : curve.boxes) least = std::min(least, box.exteriorDistance(toEigen(p)));
      EXPECT_LE(least, 1e-12) << i << " at " << t;
    }
  }
}

TEST(Compile, a_spline_of_100000_points_is_compiled_and_answered) {
  CurveDescription d;
  d.id = "long";
  d.basis = "bspline";
  d.degree = 3;
  const int n = 100000;
  d.points.resize(3, n);
  for (int i = 0; i < n; ++i) d.points.col(i) << 1e-4 * i, std::sin(1e-3 * i), 1.0;
  for (int i = 0; i < n + 4; ++i) d.knots.push_back(std::min(std::max(i - 3, 0), n - 3));
  d.t0 = 0.0;
  d.t1 = n - 3;
  Scene scene;
  fill(scene);
  const Answer answer = askOne(scene, {}, d, Query());
  EXPECT_EQ(answer.status, "ok");
  EXPECT_EQ(answer.b, "ball");
}

/* ---- what does not apply ---- */

TEST(Options, what_does_not_apply_to_a_query_is_refused_and_named) {
  Scene scene;
  fill(scene);
  const CurveDescription curve = line({-3, 0, 3}, {3, 0.2, 3});
  const std::unique_ptr<cprox_certificate, void (*)(cprox_certificate *)> proof(cprox_certificate_create(),
                                                                                cprox_certificate_free);
  for (const QueryType query_type : {QueryType::DISTANCE, QueryType::TOLERANCE, QueryType::COLLISION}) {
    const auto expect = [&](const char *word, const std::function<void(Query &)> &set, bool applies) {
      Query query;
      query.query_type = query_type;
      set(query);
      Workspace workspace;
      const Answer answer = ask(scene.snapshot(), {}, curve, query, workspace).front();
      EXPECT_EQ(answer.result.status >= 0, applies) << word << ": " << answer.message;
      if (!applies) {
        EXPECT_NE(answer.message.find(word), std::string::npos) << answer.message;
        EXPECT_EQ(answer.result.verdict, CPROX_VERDICT_UNDECIDED); // never one that reads as clear
      }
    };
    expect(
        "delta", [](Query &q) { q.delta = 0.1; }, query_type == QueryType::TOLERANCE);
    expect(
        "signed_distance", [](Query &q) { q.options.signed_distance = true; }, query_type == QueryType::DISTANCE);
    expect(
        "certificate", [&](Query &q) { q.options.certificate = proof.get(); }, true);
    expect(
        "certificate",
        [&](Query &q) {
          q.options.certificate = proof.get();
          q.per_object = true;
        },
        false);
    expect(
        "relative_epsilon", [](Query &q) { q.options.relative_epsilon = 0.1; }, true);
    expect(
        "max_lod", [](Query &q) { q.options.max_lod = CPROX_LOD_SPHERE; }, true);
    expect(
        "per_object", [](Query &q) { q.per_object = true; }, true);
  }
}
