/* SPDX-License-Identifier: BSD-3-Clause */
/* FCL and libccd agree with our answers about every kind of shape they know, and disagree with wrong ones. */
#include <cmath>
#include <cstdlib>

#include <curve_proximity/motion.hpp>

#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace {

constexpr Peer PEERS[] = {Peer::FCL, Peer::LIBCCD};

ShapeDescription cube(bool solid = false) {
  ShapeDescription out = shape(ShapeType::MESH, {});
  out.vertices.resize(3, 8);
  for (int i = 0; i < 8; ++i) out.vertices.col(i) << (i & 1) - 0.5, ((i >> 1) & 1) - 0.5, ((i >> 2) & 1) - 0.5;
  out.triangles.resize(3, 12);
  out.triangles << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1, /* */
      2, 3, 5, 7, 1, 5, 7, 6, 4, 6, 3, 7,              /* */
      3, 1, 7, 6, 5, 4, 3, 7, 6, 2, 7, 5;
  out.solid = solid;
  return out;
}

ShapeDescription ofVertices(ShapeType type, Random &random, int n, std::vector<double> dimensions = {}) {
  ShapeDescription out = shape(type, std::move(dimensions));
  out.vertices.resize(3, n);
  for (int i = 0; i < n; ++i) out.vertices.col(i) = random.vector(0.4);
  return out;
}

/* One of each kind that both peers know, of about half a metre. */
std::vector<ShapeDescription> kinds(Random &random) {
  const auto size = [&] { return random.uniform(0.1, 0.6); };
  ShapeDescription polygon = shape(ShapeType::POLYGON, {});
  polygon.vertices.resize(3, 4);
  polygon.vertices << -0.3, 0.4, 0.3, -0.2, /* */ -0.2, -0.3, 0.3, 0.2, /* */ 0, 0, 0, 0;
  return {shape(ShapeType::POINT, {}),
          shape(ShapeType::SPHERE, {size()}),
          shape(ShapeType::BOX, {size(), size(), size()}),
          shape(ShapeType::CAPSULE, {size(), size()}),
          shape(ShapeType::CYLINDER, {size(), size()}),
          shape(ShapeType::CONE, {size(), size()}),
          shape(ShapeType::ELLIPSOID, {size(), size(), size()}),
          ofVertices(ShapeType::POLYTOPE, random, 20),
          polygon,
          cube(),
          ofVertices(ShapeType::POINTS, random, 30, {0.02}),
          shape(ShapeType::HALFSPACE, {0.2, -0.3, 0.9, 1.5})};
}

cprox_result byUs(const ShapeDescription &a, const Eigen::Isometry3d &pose_a, const ShapeDescription &b,
                  const Eigen::Isometry3d &pose_b) {
  Workspace workspace;
  const Geometry one = makeGeometry(a), other = makeGeometry(b);
  return pair(at(one.body, pose_a), at(other.body, pose_b), CPROX_OPTIONS_DEFAULT, workspace);
}

} // namespace

/* Poses up to 1.5 m around: apart, near and overlapping. 1e-5 is the accuracy that the opinion grants. */
TEST(SecondOpinion, both_libraries_agree_about_pairs_of_all_kinds) {
  Random random(31);
  for (const Peer peer : PEERS) {
    const SecondOpinions opinions(peer);
    int measured = 0;
    for (int i = 0; i < cases(12); ++i) {
      const std::vector<ShapeDescription> shapes = kinds(random);
      for (std::size_t k = 0; k < shapes.size(); ++k) {
        for (std::size_t l = k; l < shapes.size(); ++l) {
          if (shapes[l].type == ShapeType::HALFSPACE && k + 3 >= shapes.size())
            continue; /* we have no distance of these */
          const Eigen::Isometry3d p = random.pose(1.5), q = random.pose(1.5);
          const cprox_result ours = byUs(shapes[k], p, shapes[l], q);
          ASSERT_GE(ours.status, 0);
          const SecondOpinion said = opinions.ofPair(shapes[k], p, shapes[l], q, ours.lower, ours.upper);
          const std::string who = std::string(peerName(peer)) + ": " + shapeTypeName(shapes[k].type) + " and " +
                                  shapeTypeName(shapes[l].type) + " " + std::to_string(i) + ": " + said.message;
          EXPECT_EQ(said.verdict, SecondOpinion::AGREES) << who;
          EXPECT_NEAR(said.distance, std::max(0.0, ours.upper), 5e-5) << who;
          measured += said.verdict == SecondOpinion::AGREES;
        }
      }
    }
    EXPECT_GT(measured, 500);
  }
}

TEST(SecondOpinion, intervals_that_are_wrong_are_disagreed_with) {
  for (const Peer peer : PEERS) {
    const SecondOpinions opinions(peer);
    const ShapeDescription box = shape(ShapeType::BOX, {1, 1, 1}), ball = shape(ShapeType::SPHERE, {0.25});
    const auto said = [&](double lower, double upper) {
      return opinions.ofPair(box, Eigen::Isometry3d::Identity(), ball, translation(2, 0, 0), lower, upper);
    };
    EXPECT_EQ(said(1.25, 1.25).verdict, SecondOpinion::AGREES);
    EXPECT_EQ(said(1.251, 1.252).verdict, SecondOpinion::DISAGREES);
    EXPECT_EQ(said(1.248, 1.249).verdict, SecondOpinion::DISAGREES);
    EXPECT_EQ(said(0.0, 0.0).verdict, SecondOpinion::DISAGREES);
    expectContains(said(1.251, 1.252).message, std::string(peerName(peer)) + " disagrees: it measures 1.25");
    expectContains(said(1.251, 1.252).message, "lower is 1.251 m");
    expectContains(said(1.248, 1.249).message, "upper is 1.249 m");
  }
}

TEST(SecondOpinion, what_a_library_does_not_know_is_unknown_and_said) {
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity(), there = translation(2, 0, 0);
  const ShapeDescription ball = shape(ShapeType::SPHERE, {0.1});
  for (const Peer peer : PEERS) {
    const SecondOpinions opinions(peer);
    const auto unknown = [&](const ShapeDescription &a, const Eigen::Isometry3d &pose, double upper) {
      const SecondOpinion said = opinions.ofPair(a, pose, ball, there, 0.0, upper);
      EXPECT_EQ(said.verdict, SecondOpinion::UNKNOWN);
      return said.message;
    };
    expectContains(unknown(shape(ShapeType::SUPERQUADRIC, {1, 1, 1, 4, 4, 4}), here, 1.0), "superquadric");
    expectContains(unknown(cube(true), there, 0.0), "inside");
    ShapeDescription missing = shape(ShapeType::MESH, {});
    missing.resource = "/nowhere/mesh.stl";
    expectContains(unknown(missing, here, 1.0), "/nowhere/mesh.stl");
  }
}

/* Needles of 10 m whose balls all overlap: libccd, without a tree, would measure each pair of them. */
TEST(SecondOpinion, nobody_waits_for_meshes_that_take_too_long) {
  ShapeDescription needles = shape(ShapeType::MESH, {});
  needles.vertices.resize(3, 600);
  needles.triangles.resize(3, 200);
  for (int i = 0; i < 200; ++i) {
    const double y = 0.001 * i;
    needles.vertices.block<3, 3>(0, 3 * i) << 0, 10, 5, /* */ y, y, y, /* */ 0, 0, 0.0005;
    needles.triangles.col(i) << 3 * i, 3 * i + 1, 3 * i + 2;
  }
  const auto said = [&](Peer peer) {
    return SecondOpinions(peer).ofPair(needles, Eigen::Isometry3d::Identity(), needles, translation(0, 0, 1), 0.9, 1.1);
  };
  EXPECT_EQ(said(Peer::FCL).verdict, SecondOpinion::AGREES);
  EXPECT_EQ(said(Peer::LIBCCD).verdict, SecondOpinion::UNKNOWN);
  expectContains(said(Peer::LIBCCD).message, "more than 20000 pairs");
}

/* The curve passes at .5 from the face of the padded box at t = .5, and begins farther away. */
TEST(SecondOpinion, answers_about_curves_carry_it) {
  Scene scene;
  ASSERT_TRUE(scene
                  .apply(change({add("box", {shape(ShapeType::BOX, {2, 2, 2})}, translation(0, 0, 0), 0.1),
                                 add("mesh", {cube()}, translation(0, 9, 0))}))
                  .empty());
  CurveDescription curve = line({-2, 0, 1.7}, {2, 0, 1.7});
  curve.radius = 0.1;
  Query query;
  EXPECT_EQ(askOne(scene, {}, curve, query).second_opinion.verdict, SecondOpinion::NONE);
  for (const Peer peer : PEERS) {
    query.second_opinion = std::make_shared<const SecondOpinions>(peer);
    for (const QueryType type : {QueryType::DISTANCE, QueryType::TOLERANCE, QueryType::COLLISION}) {
      query.query_type = type;
      query.delta = type == QueryType::TOLERANCE ? 0.6 : 0.0;
      const Answer answer = askOne(scene, {}, curve, query);
      if (type == QueryType::COLLISION && answer.second_opinion.verdict == SecondOpinion::UNKNOWN) {
        expectContains(answer.message, "no pair was measured"); /* balls alone decided */
        continue;
      }
      EXPECT_EQ(answer.second_opinion.verdict, SecondOpinion::AGREES) << answer.message;
      if (type != QueryType::DISTANCE) continue;
      EXPECT_NEAR(answer.second_opinion.distance, 0.5, 1e-5);
    }
    query.query_type = QueryType::DISTANCE;
    query.delta = 0.0;
    query.options.max_lod = CPROX_LOD_SPHERE;
    expectContains(askOne(scene, {}, curve, query).message, "bounding spheres have answered");
    query.options.max_lod = CPROX_LOD_MESH;
  }
}

/* The time is over after the search, and before the opinion. */
TEST(SecondOpinion, what_ends_the_query_ends_the_opinion) {
  struct Polls {
    int n = 0, most = 1000000;
  } polls;
  Scene scene;
  ASSERT_TRUE(scene.apply(change({add("box", {shape(ShapeType::BOX, {2, 2, 2})})})).empty());
  Query query;
  query.options.stop_user = &polls;
  query.options.stop = [](void *user) { return ++static_cast<Polls *>(user)->n > static_cast<Polls *>(user)->most; };
  const CurveDescription curve = line({-2, 0, 1.7}, {2, 0, 1.7});
  askOne(scene, {}, curve, query);
  polls.most = polls.n;
  polls.n = 0;
  query.second_opinion = std::make_shared<const SecondOpinions>(Peer::LIBCCD);
  const Answer answer = askOne(scene, {}, curve, query);
  EXPECT_EQ(answer.result.status, CPROX_OK);
  EXPECT_EQ(answer.second_opinion.verdict, SecondOpinion::UNKNOWN);
  expectContains(answer.message, "the query was ended");
}

/* A Panda among boxes and a mesh: the pairs of the scene, and those of the robot with itself, link meshes from files.
 */
TEST(SecondOpinion, answers_about_robots_carry_it) {
  Scene scene(dataRobot("panda"));
  ASSERT_TRUE(scene
                  .apply(change({add("shelf", {shape(ShapeType::BOX, {0.3, 1.0, 0.05})}, translation(0.6, 0, 0.5)),
                                 add("mesh", {cube()}, translation(0, 0.9, 0.5), 0.02)}))
                  .empty());
  Random random(32);
  Workspace workspace;
  for (int i = 0; i < cases(6); ++i) {
    TrajectoryDescription trajectory;
    for (int joint = 1; joint <= 7; ++joint) trajectory.joints.push_back("panda_joint" + std::to_string(joint));
    for (int point = 0; point < 3; ++point) {
      trajectory.points.emplace_back();
      trajectory.points.back().time = point;
      for (int joint = 0; joint < 7; ++joint)
        trajectory.points.back().positions.push_back(random.uniform(-0.8, 0.8) - (joint == 3 ? 1.5 : 0.0));
    }
    const RobotMotion motion(scene.snapshot(), trajectory, {});
    for (const Peer peer : PEERS) {
      Query query;
      query.second_opinion = std::make_shared<const SecondOpinions>(peer);
      std::vector<Answer> answers = askEnvironment(motion, query, workspace);
      answers.push_back(askSelf(motion, query, workspace));
      for (const Answer &answer : answers) {
        ASSERT_GE(answer.result.status, 0) << answer.message;
        EXPECT_EQ(answer.second_opinion.verdict, SecondOpinion::AGREES)
            << peerName(peer) << " " << answer.kind << " " << answer.a << " " << answer.b << ": " << answer.message;
      }
    }
  }
}
