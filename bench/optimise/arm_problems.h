/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions of a Panda to be made smooth and clear, in the scenes of MotionBenchMaker under test/data. */
#ifndef CPROX_BENCH_ARM_PROBLEMS_H
#define CPROX_BENCH_ARM_PROBLEMS_H

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "../../examples/arm_spline.h"

namespace curve_proximity {

/* [m] What is to be proven, and how far the ends of a motion are clear at least: else no motion between them is. */
constexpr double kClear = 0.01, kEndsClear = 0.012;

struct ArmScene {
  SnapshotPtr snapshot;
  Srdf srdf;
  std::unique_ptr<PreparedRobot> robot;
  TrajectoryDescription path; /* an RRT's, of the scene's own request */
  JointPositions rest;
};

struct ArmProblem {
  std::shared_ptr<const ArmScene> scene;
  Eigen::MatrixXd control; /* of the spline that the optimiser begins with */
};

/* The families of scenes: "bookshelf_small", ... */
extern const std::vector<std::string> kFamilies;

/* n problems of a family. They take its three scenes in turn, and each scene's RRT path and the straight line between
 * the path's ends in turn. The ends are those of the path, moved by random steps of the joints: problems 0 to 5 only
 * where they are not clear as they are. Throws Error where no clear ends are found. */
std::vector<ArmProblem> arm_problems(const std::string &family, int n, std::uint64_t seed);

} // namespace curve_proximity
#endif
