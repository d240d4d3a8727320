/* SPDX-License-Identifier: BSD-3-Clause */
/* What the scene's tests share: random numbers that are the same everywhere, descriptions, the robots of test/data. */
#ifndef CURVE_PROXIMITY_TEST_SCENE_SUPPORT_H
#define CURVE_PROXIMITY_TEST_SCENE_SUPPORT_H

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <curve_proximity/query.hpp>

namespace curve_proximity {
namespace test {

/* splitmix64: the same numbers on every machine, which <random>'s distributions do not promise. */
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53;
  }

  std::size_t below(std::size_t n) {
    return static_cast<std::size_t>(bits() % n);
  }

  Eigen::Vector3d vector(double half) {
    const double x = uniform(-half, half), y = uniform(-half, half), z = uniform(-half, half);
    return {x, y, z};
  }

  Eigen::Isometry3d pose(double half) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    Eigen::Vector3d axis = vector(1.0);
    while (axis.norm() < 0.1) axis = vector(1.0);
    pose.linear() = Eigen::AngleAxisd(uniform(-3.0, 3.0), axis.normalized()).toRotationMatrix();
    pose.translation() = vector(half);
    return pose;
  }

 private:
  std::uint64_t state_;
};

/* CI asks few cases; CPROX_TEST_SCALE raises the number. */
inline int cases(int n) {
  const char *scale = std::getenv("CPROX_TEST_SCALE");
  return scale ? n * std::max(1, std::atoi(scale)) : n;
}

inline std::string readText(const std::string &path) {
  std::ifstream file(path);
  EXPECT_TRUE(file.good()) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/* A robot of test/data/robots: "panda" of panda/panda.urdf. */
inline std::shared_ptr<const Robot> dataRobot(const std::string &name) {
  RobotOptions options;
  options.resources.base_dir = TEST_DATA_DIR "/robots/" + name;
  return Robot::fromUrdf(readText(options.resources.base_dir + "/" + name + ".urdf"), options);
}

inline Eigen::Isometry3d translation(double x, double y, double z) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

inline ShapeDescription shape(ShapeType type, std::vector<double> dimensions,
                              const Eigen::Isometry3d &pose = Eigen::Isometry3d::Identity()) {
  ShapeDescription out;
  out.type = type;
  out.dimensions = std::move(dimensions);
  out.pose = pose;
  return out;
}

inline Operation operation(Operation::Kind kind, const std::string &id, std::vector<ShapeDescription> shapes = {},
                           const Eigen::Isometry3d &pose = Eigen::Isometry3d::Identity(), double padding = 0.0) {
  Operation out;
  out.kind = kind;
  out.object.id = id;
  out.object.pose = pose;
  out.object.shapes = std::move(shapes);
  out.object.padding = padding;
  return out;
}

inline Operation add(const std::string &id, std::vector<ShapeDescription> shapes,
                     const Eigen::Isometry3d &pose = Eigen::Isometry3d::Identity(), double padding = 0.0) {
  return operation(Operation::Kind::ADD, id, std::move(shapes), pose, padding);
}

inline SceneChange change(std::vector<Operation> operations) {
  SceneChange out;
  out.operations = std::move(operations);
  return out;
}

/* A straight Bézier curve from a to b. */
inline CurveDescription line(const Eigen::Vector3d &a, const Eigen::Vector3d &b) {
  CurveDescription out;
  out.id = "line";
  out.points.resize(3, 2);
  out.points << a, b;
  return out;
}

inline CurveDescription randomBezier(Random &random, std::size_t degree, double half) {
  CurveDescription out;
  out.id = "random";
  out.points.resize(3, static_cast<Eigen::Index>(degree) + 1);
  for (Eigen::Index i = 0; i < out.points.cols(); ++i) out.points.col(i) = random.vector(half);
  return out;
}

/* Runs a call that must fail and hands its message back. */
template <typename Call>
std::string errorOf(Call call) {
  try {
    call();
  } catch (const Error &error) {
    EXPECT_LT(error.status(), 0);
    return error.what();
  }
  ADD_FAILURE() << "it was accepted";
  return "";
}

inline void expectContains(const std::string &text, const std::string &part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
}

/* The one answer to a query about everything, or what is named. */
inline Answer askOne(const Scene &scene, const LinkPoses &links, const CurveDescription &curve, const Query &query) {
  Workspace workspace;
  const std::vector<Answer> answers = ask(scene.snapshot(), links, curve, query, workspace);
  EXPECT_EQ(answers.size(), 1u);
  return answers.empty() ? Answer() : answers.front();
}

} // namespace test
} // namespace curve_proximity
#endif
