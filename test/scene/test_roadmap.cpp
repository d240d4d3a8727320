/* SPDX-License-Identifier: BSD-3-Clause */
/* Edges of a roadmap: the verdicts of the motions that they are, for any number of threads. */
#include <curve_proximity/roadmap.hpp>

#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace {

constexpr double DELTA = 0.02;

struct Case {
  SnapshotPtr snapshot;
  Srdf srdf;
  Roadmap roadmap;
};

/* A Panda among boxes, postures about its middle, and edges between random ones. */
Case makeCase(std::uint32_t seed, int vertices, int edges) {
  static const std::shared_ptr<const Robot> panda = dataRobot("panda");
  Random random(seed);
  Case out;
  out.srdf = parseSrdf(readText(TEST_DATA_DIR "/robots/panda/panda.srdf"));
  Scene scene(panda, {}, allowedPairs(out.srdf));
  SceneChange change;
  for (int i = 0; i < 4; ++i) {
    const std::string id = "box" + std::to_string(i);
    change.operations.push_back(add(id, {shape(ShapeType::BOX, {0.1, 0.2, 0.3})}, random.pose(1.0)));
  }
  EXPECT_TRUE(scene.apply(change).empty());
  out.snapshot = scene.snapshot();
  out.roadmap.vertices.resize(7, vertices);
  const double middle[] = {0.0, 0.0, 0.0, -1.5, 0.0, 1.8, 0.8};
  for (int k = 0; k < 7; ++k) {
    out.roadmap.joints.push_back("panda_joint" + std::to_string(k + 1));
    for (int i = 0; i < vertices; ++i) out.roadmap.vertices(k, i) = middle[k] + random.uniform(-1.3, 1.3);
  }
  const auto column = [&] { return static_cast<std::uint32_t>(random.uniform(0.0, vertices - 1e-9)); };
  for (int i = 0; i < edges; ++i) out.roadmap.edges.push_back({column(), column()});
  return out;
}

Query tolerance() {
  Query query;
  query.query_type = QueryType::TOLERANCE;
  query.delta = DELTA;
  return query;
}

TrajectoryDescription edgeOf(const Roadmap &roadmap, const std::array<std::uint32_t, 2> &edge) {
  TrajectoryDescription out;
  out.joints = roadmap.joints;
  for (int k = 0; k < 2; ++k) {
    const Eigen::VectorXd at = roadmap.vertices.col(edge[static_cast<std::size_t>(k)]);
    TrajectoryPoint point;
    point.time = k;
    point.positions.assign(at.data(), at.data() + at.size());
    out.points.push_back(point);
  }
  return out;
}

std::string refusalOf(const Roadmap &roadmap, const Case &c, const Query &query = tolerance(),
                      const std::vector<cprox_verdict> &known = {}) {
  Pool pool(1);
  try {
    edgeVerdicts(PreparedRobot(c.snapshot, c.srdf.disabled), roadmap, RobotPairs::ENVIRONMENT, query, known, pool);
  } catch (const Error &error) {
    return error.what();
  }
  return "";
}

} // namespace

/* 200 edges (seed 91), one thread and three: each as a motion of its own, against the boxes and itself, which they
 * touch where the elbow is bent most. */
TEST(Roadmaps, edges_have_the_verdicts_of_their_motions) {
  const Case c = makeCase(91, 60, 200);
  const PreparedRobot robot(c.snapshot, c.srdf.disabled);
  for (const bool self : {false, true}) {
    std::vector<cprox_verdict> expected;
    Workspace workspace;
    std::map<cprox_verdict, int> count;
    for (const auto &edge : c.roadmap.edges) {
      const RobotMotion motion(c.snapshot, edgeOf(c.roadmap, edge), {}, c.srdf.disabled);
      const Answer answer =
          self ? askSelf(motion, tolerance(), workspace) : askEnvironment(motion, tolerance(), workspace).front();
      expected.push_back(answer.result.verdict);
      ++count[answer.result.verdict];
    }
    EXPECT_GT(count[CPROX_VERDICT_CLEAR], 20);
    EXPECT_GT(count[CPROX_VERDICT_VIOLATED], self ? 0 : 20);
    for (const unsigned threads : {1U, 3U}) {
      Pool pool(threads);
      EXPECT_EQ(
          edgeVerdicts(robot, c.roadmap, self ? RobotPairs::SELF : RobotPairs::ENVIRONMENT, tolerance(), {}, pool),
          expected);
    }
  }
}

/* One verdict of both is clear where both are; else it is the first of them that is not (seed 91). */
TEST(Roadmaps, the_verdict_of_objects_and_robot_is_that_of_both) {
  const Case c = makeCase(91, 60, 200);
  const PreparedRobot robot(c.snapshot, c.srdf.disabled);
  Pool pool(1);
  const auto of = [&](RobotPairs against, const std::vector<cprox_verdict> &known) {
    return edgeVerdicts(robot, c.roadmap, against, tolerance(), known, pool);
  };
  const std::vector<cprox_verdict> whole = of(RobotPairs::WHOLE, {});
  EXPECT_EQ(whole, of(RobotPairs::SELF, of(RobotPairs::ENVIRONMENT, {})));

  /* and one edge at a time, which asks all pairs, also those that do not move */
  const EdgeChecker checker(robot, c.roadmap.joints, c.roadmap.rest, RobotPairs::WHOLE, tolerance());
  EXPECT_TRUE(checker.coverage().complete());
  Workspace workspace;
  std::map<cprox_verdict, int> count;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const auto [from, to] = c.roadmap.edges[i];
    if (from == to) continue;
    EXPECT_EQ(checker.ask(c.roadmap.vertices.col(from).data(), c.roadmap.vertices.col(to).data(), workspace), whole[i]);
    ++count[whole[i]];
  }
  EXPECT_GT(count[CPROX_VERDICT_CLEAR], 10);
  EXPECT_GT(count[CPROX_VERDICT_VIOLATED], 20);
}

/* Rows of both ends, which stand in the caller's memory, are the same edges (seed 91). */
TEST(Roadmaps, edges_by_their_ends_have_the_verdicts_of_the_roadmap) {
  const Case c = makeCase(91, 60, 200);
  const PreparedRobot robot(c.snapshot, c.srdf.disabled);
  Eigen::MatrixXd from(7, 200), to(7, 200);
  for (Eigen::Index i = 0; i < 200; ++i) {
    const auto [begin, end] = c.roadmap.edges[static_cast<std::size_t>(i)];
    from.col(i) = c.roadmap.vertices.col(begin), to.col(i) = c.roadmap.vertices.col(end);
  }
  EdgeList list;
  list.joints = c.roadmap.joints, list.from = from.data(), list.to = to.data(), list.n_rows = list.n = 200;
  for (const bool shortest_way : {false, true})
    for (const unsigned threads : {1U, 3U}) {
      Pool pool(threads);
      Roadmap roadmap = c.roadmap;
      roadmap.shortest_way = list.shortest_way = shortest_way;
      EXPECT_EQ(edgeVerdicts(robot, list, RobotPairs::WHOLE, tolerance(), {}, pool),
                edgeVerdicts(robot, roadmap, RobotPairs::WHOLE, tolerance(), {}, pool));
    }
  to(3, 17) = NAN;
  Pool pool(1);
  try {
    edgeVerdicts(robot, list, RobotPairs::WHOLE, tolerance(), {}, pool);
    FAIL();
  } catch (const Error &error) {
    EXPECT_STREQ(error.what(), "the end of edge 17 is not finite");
  }
}

/* Without objects nothing was measured. A robot alone is no objects. */
TEST(Roadmaps, no_edge_is_clear_of_a_scene_that_is_not_covered) {
  const Case c = makeCase(91, 4, 4);
  const Scene empty(c.snapshot->robot());
  const PreparedRobot alone(empty.snapshot(), c.srdf.disabled), among(c.snapshot, c.srdf.disabled);
  Query query = tolerance();
  const EdgeChecker nothing(alone, c.roadmap.joints, {}, RobotPairs::ENVIRONMENT, query);
  query.coverage.add(Gap::PARTIAL, "something was left out");
  const EdgeChecker partial(among, c.roadmap.joints, {}, RobotPairs::ENVIRONMENT, query);
  EXPECT_EQ(nothing.coverage().status(), "empty");
  EXPECT_EQ(partial.coverage().status(), "partial");
  Workspace workspace;
  for (const EdgeChecker *checker : {&nothing, &partial})
    for (int i = 0; i < 4; ++i) {
      const double *at = c.roadmap.vertices.col(i).data();
      EXPECT_EQ(checker->ask(at, at, workspace), CPROX_VERDICT_UNDECIDED);
    }
}

TEST(Roadmaps, an_edge_checker_refuses_what_it_cannot_answer) {
  const Case c = makeCase(91, 4, 4);
  const PreparedRobot robot(c.snapshot, c.srdf.disabled);
  const auto refuses = [&](const Query &query) {
    EXPECT_THROW(EdgeChecker(robot, c.roadmap.joints, {}, RobotPairs::WHOLE, query), Error);
  };
  Query query = tolerance();
  query.query_type = QueryType::DISTANCE;
  refuses(query);
  query = tolerance();
  query.per_object = true;
  refuses(query);
  query = tolerance();
  query.options.signed_distance = true;
  refuses(query);
}

/* What is known stands; the rest is asked (seed 92). */
TEST(Roadmaps, what_is_known_is_not_asked_again) {
  const Case c = makeCase(92, 20, 40);
  const PreparedRobot robot(c.snapshot, c.srdf.disabled);
  Pool pool(1);
  const std::vector<cprox_verdict> plain =
      edgeVerdicts(robot, c.roadmap, RobotPairs::ENVIRONMENT, tolerance(), {}, pool);
  std::vector<cprox_verdict> known(plain.size(), CPROX_VERDICT_CLEAR);
  for (std::size_t i = 0; i < known.size(); i += 3) known[i] = CPROX_VERDICT_UNDECIDED;
  const std::vector<cprox_verdict> joined =
      edgeVerdicts(robot, c.roadmap, RobotPairs::ENVIRONMENT, tolerance(), known, pool);
  for (std::size_t i = 0; i < known.size(); ++i) EXPECT_EQ(joined[i], i % 3 == 0 ? CPROX_VERDICT_UNDECIDED : plain[i]);
}

TEST(Roadmaps, an_edge_without_a_budget_is_undecided) {
  const Case c = makeCase(91, 60, 200);
  Query query = tolerance();
  query.options.stop = [](void *) { return true; };
  Pool pool(1);
  const PreparedRobot robot(c.snapshot, c.srdf.disabled);
  const std::vector<cprox_verdict> all = edgeVerdicts(robot, c.roadmap, RobotPairs::ENVIRONMENT, tolerance(), {}, pool),
                                   stopped = edgeVerdicts(robot, c.roadmap, RobotPairs::ENVIRONMENT, query, {}, pool);
  int undecided = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    undecided += stopped[i] == CPROX_VERDICT_UNDECIDED;
    if (stopped[i] == CPROX_VERDICT_UNDECIDED) continue;
    EXPECT_EQ(stopped[i], all[i]);
  }
  EXPECT_GT(undecided, 10);
}

TEST(Roadmaps, bad_ones_are_refused_by_name) {
  const Case c = makeCase(93, 5, 5);
  Roadmap bad = c.roadmap;
  bad.edges[3][1] = 5;
  EXPECT_EQ(refusalOf(bad, c), "edge 3 ends at vertex 5, there are 5");
  bad = c.roadmap;
  bad.vertices(2, 4) = NAN;
  EXPECT_EQ(refusalOf(bad, c), "vertex 4 is not finite");
  bad = c.roadmap;
  bad.joints.pop_back();
  EXPECT_EQ(refusalOf(bad, c), "vertices have 7 rows, there are 6 joints");
  bad = c.roadmap;
  bad.joints[0] = "elbow";
  EXPECT_NE(refusalOf(bad, c).find("elbow"), std::string::npos);
  EXPECT_NE(refusalOf(c.roadmap, c, tolerance(), {CPROX_VERDICT_CLEAR}).find("known"), std::string::npos);
  EXPECT_NE(refusalOf(c.roadmap, c, Query()).find("tolerance or collision"), std::string::npos);
}
