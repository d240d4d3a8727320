/* SPDX-License-Identifier: BSD-3-Clause */
/* What an answer does not cover: no gap of any origin leaves an answer 'clear', of any kind of query. */
#include <cmath>

#include <curve_proximity/movers.hpp>

#include "support.h"

namespace curve_proximity {
namespace {

using test::add;
using test::change;
using test::expectContains;
using test::line;
using test::shape;
using test::translation;

/* A ball on a rail along x, and a wall whose face is at x = 3. */
const char *RAIL = R"(<robot name="rail"><link name="base"/>
  <link name="ball"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="ball"/><axis xyz="1 0 0"/>
  <limit lower="-9" upper="9" effort="1" velocity="1"/></joint></robot>)";

SceneChange wall() {
  return change({add("wall", {shape(ShapeType::BOX, {1, 4, 4})}, translation(3.5, 0, 0))});
}

TrajectoryDescription slide(double to) {
  TrajectoryDescription out;
  out.joints = {"slide"};
  out.points = {{{0.0}, {}, {}, 0.0}, {{to}, {}, {}, 1.0}};
  return out;
}

Query queryOf(QueryType type) {
  Query out;
  out.query_type = type;
  if (type == QueryType::TOLERANCE) out.delta = 0.5;
  return out;
}

void expectUndecided(const Answer &answer, const char *status) {
  EXPECT_EQ(answer.status, status) << answer.message;
  EXPECT_EQ(answer.result.verdict, CPROX_VERDICT_UNDECIDED);
  EXPECT_EQ(answer.result.lower, 0.0);
  EXPECT_TRUE(std::isnan(answer.result.t_contact_lower));
}

TEST(Coverage, the_gravest_gap_names_the_status) {
  Coverage coverage;
  EXPECT_TRUE(coverage.complete() && coverage.status().empty() && coverage.provesContact());
  coverage.add(Gap::UNKNOWN, "a sensor sees nothing", Missing::GEOMETRY);
  EXPECT_TRUE(coverage.provesContact());
  coverage.add(Gap::PARTIAL, "a key is unknown");
  coverage.add(Gap::PARTIAL, "a key is unknown");
  EXPECT_EQ(coverage.status(), "unknown");
  EXPECT_FALSE(coverage.provesContact());
  EXPECT_EQ(coverage.message(), "a sensor sees nothing; a key is unknown");
  for (const Gap gap : {Gap::ROUNDED, Gap::PARTIAL, Gap::EMPTY, Gap::UNKNOWN, Gap::STALE})
    EXPECT_EQ(gapFromName(gapName(gap)), gap);
  EXPECT_EQ(gapFromName("ok"), std::nullopt);
}

/* Of scene, robot's motion and query; of curves, motions and movers. */
TEST(Coverage, no_answer_with_a_gap_is_clear) {
  Workspace workspace;
  const auto robot = Robot::fromUrdf(RAIL);
  for (const char *name : {"scene", "trajectory", "query"}) {
    const std::string origin = name;
    Scene scene(robot);
    SceneChange first = wall();
    TrajectoryDescription trajectory = slide(2.0);
    if (origin == "scene") first.coverage.add(Gap::PARTIAL, "a key is unknown");
    if (origin == "trajectory") trajectory.coverage.add(Gap::PARTIAL, "a key is unknown");
    ASSERT_TRUE(scene.apply(first).empty());
    const auto motion = std::make_shared<const RobotMotion>(scene.snapshot(), trajectory, JointPositions());
    const Movers movers(scene.snapshot(), {{"a", motion, 0.0, 0.0}}, {});
    for (const QueryType type : {QueryType::DISTANCE, QueryType::TOLERANCE, QueryType::COLLISION}) {
      Query query = queryOf(type);
      if (origin == "query") query.coverage.add(Gap::PARTIAL, "a key is unknown");
      expectUndecided(askEnvironment(*motion, query, workspace).front(), "partial");
      expectUndecided(ask(movers, Against::OBJECTS, query, workspace), "partial");
      if (type == QueryType::COLLISION) {
        expectUndecided(timeOfContact(*motion, false, query, workspace), "partial");
        expectUndecided(timeOfContact(movers, Against::OBJECTS, query, workspace), "partial");
      }
      if (type == QueryType::TOLERANCE) {
        const Violations found = violations(*motion, false, 1e-3, query, workspace);
        ASSERT_EQ(found.list.size(), 1u);
        EXPECT_EQ(found.list.front().enter_lower, 0.0);
        EXPECT_EQ(found.list.front().leave_upper, 1.0);
        EXPECT_EQ(found.list.front().verdict, CPROX_VERDICT_UNDECIDED);
      }
      if (type != QueryType::DISTANCE) continue;
      for (const ClearanceInterval &one : clearanceProfile(*motion, false, {0.0, 0.5, 1.0}, query, workspace))
        EXPECT_TRUE(one.lower == 0.0 && one.gap == Gap::PARTIAL);
      const std::vector<Answer> far = nearestPairs(*motion, false, {10, 0.1}, query, workspace);
      ASSERT_EQ(far.size(), 1u);
      expectUndecided(far.front(), "partial");
      EXPECT_FALSE(clearanceGradient(*motion, RobotPairs::ENVIRONMENT, query, workspace).gradient.valid);
    }
    if (origin == "trajectory") continue;
    Query query = queryOf(QueryType::COLLISION);
    if (origin == "query") query.coverage.add(Gap::PARTIAL, "a key is unknown");
    const SceneObstacles targets(scene.snapshot(), {}, query);
    const CompiledCurve curve = compile(line({0, 0, 0}, {1, 0, 0}));
    expectUndecided(ask(targets, curve, query, workspace).front(), "partial");
    expectUndecided(timeOfContact(targets, curve, query, workspace), "partial");
  }
}

TEST(Coverage, a_contact_stays_one_where_geometry_can_only_be_missing) {
  Workspace workspace;
  Scene scene(Robot::fromUrdf(RAIL));
  ASSERT_TRUE(scene.apply(wall()).empty());
  const RobotMotion motion(scene.snapshot(), slide(4.0), {});
  Query query = queryOf(QueryType::COLLISION);
  query.coverage.add(Gap::UNKNOWN, "a sensor sees nothing", Missing::GEOMETRY);
  EXPECT_EQ(askEnvironment(motion, query, workspace).front().result.verdict, CPROX_VERDICT_VIOLATED);
  query.coverage.add(Gap::STALE, "the wall is 9 s old");
  expectUndecided(askEnvironment(motion, query, workspace).front(), "stale");
}

TEST(Coverage, a_scene_keeps_its_gaps_until_it_is_cleared) {
  Scene scene;
  SceneChange first = wall();
  first.coverage.add(Gap::PARTIAL, "a key is unknown");
  ASSERT_TRUE(scene.apply(first).empty());
  ASSERT_TRUE(scene.apply(wall()).empty());
  EXPECT_EQ(scene.snapshot()->coverage().status(), "partial");
  EXPECT_EQ(scene.snapshot()->variant({})->coverage().status(), "partial");
  SceneChange anew = wall();
  anew.clear = true;
  ASSERT_TRUE(scene.apply(anew).empty());
  EXPECT_TRUE(scene.snapshot()->coverage().complete());
}

TEST(Coverage, a_selection_that_leaves_no_pair_is_empty) {
  Workspace workspace;
  Scene scene(Robot::fromUrdf(RAIL));
  ASSERT_TRUE(scene.apply(wall()).empty());
  const RobotMotion motion(scene.snapshot(), slide(2.0), {});
  Query query = queryOf(QueryType::COLLISION);
  const Answer self = askSelf(motion, query, workspace);
  expectUndecided(self, "empty");
  expectContains(self.message, "no pair");
  query.allow_empty = true;
  EXPECT_EQ(askSelf(motion, query, workspace).result.verdict, CPROX_VERDICT_CLEAR);
}

} // namespace
} // namespace curve_proximity
