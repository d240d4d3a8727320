/* SPDX-License-Identifier: BSD-3-Clause */
/** Pushes a spline out of collision: NLopt's SLSQP, with value and gradient by the provider
 * curve_proximity/CurveDistance.
 *
 *      push_out SCENE.yaml [OUT.csv]
 *
 *  A ball of 3 cm is to go along a cubic B-spline from one end to the other, as smoothly as can be and 1 cm clear of
 * every object. The variables are the inner control points; the constraints are the signed distances of eight intervals
 * of the spline to each object. At the end the whole spline is asked about once more: its clearance is then proven, not
 *  sampled. OUT.csv gets the spline before and after as CURVES.csv has them, for `cprox` and for draw_push_out.py. */
#include <nlopt.h>
#include <pluginlib/class_loader.hpp>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <curve_proximity/constraint_provider.hpp>
#include <curve_proximity/query.hpp>

#include "../src/scene/yaml/scene_change.h"

using namespace curve_proximity;

namespace {

constexpr Eigen::Index kPoints = 12;
constexpr int kIntervals = 8;
constexpr double kRadius = 0.03, kClearance = 0.01;

/* The problem: the spline, and what it is to stay clear of. */
struct Problem {
  CurveDescription spline;
  std::vector<std::unique_ptr<const Constraint>> objects;
  std::vector<cprox_pose> poses;
  Workspace workspace;
  ConstraintValue value;
  unsigned evaluations = 0;
  nlopt_opt optimiser = nullptr;
  std::string failure; /* no exception may pass through NLopt */
};

CurveDescription straightSpline(const Eigen::Vector3d &from, const Eigen::Vector3d &to) {
  CurveDescription c;
  c.id = "before";
  c.basis = "bspline";
  c.degree = 3;
  c.radius = kRadius;
  c.points.resize(3, kPoints);
  for (Eigen::Index i = 0; i < kPoints; ++i)
    c.points.col(i) = from + (to - from) * static_cast<double>(i) / static_cast<double>(kPoints - 1);
  const int inner = static_cast<int>(kPoints) - 4;
  c.knots.assign(4, 0.0);
  for (int i = 1; i <= inner; ++i) c.knots.push_back(i / (inner + 1.0));
  c.knots.insert(c.knots.end(), 4, 1.0);
  return c;
}

/* Both ends stay where they are; what lies between are the variables. */
Eigen::Map<const Eigen::Matrix3Xd> innerOf(const double *x) {
  return {x, 3, kPoints - 2};
}

CurveDescription splineAt(const Problem &problem, const double *x) {
  CurveDescription c = problem.spline;
  c.points.middleCols(1, kPoints - 2) = innerOf(x);
  return c;
}

/* How far the control polygon is from even: the sum of its squared second differences. */
double smoothness(unsigned n, const double *x, double *gradient, void *data) {
  const CurveDescription c = splineAt(*static_cast<const Problem *>(data), x);
  Eigen::Matrix3Xd by_points = Eigen::Matrix3Xd::Zero(3, kPoints);
  double sum = 0.0;
  for (Eigen::Index i = 1; i + 1 < kPoints; ++i) {
    const Eigen::Vector3d second = c.points.col(i - 1) - 2.0 * c.points.col(i) + c.points.col(i + 1);
    sum += second.squaredNorm();
    by_points.col(i - 1) += 2.0 * second;
    by_points.col(i) -= 4.0 * second;
    by_points.col(i + 1) += 2.0 * second;
  }
  if (gradient) Eigen::Map<Eigen::VectorXd>(gradient, n) = Eigen::Map<const Eigen::VectorXd>(by_points.data() + 3, n);
  return sum;
}

/* The provider's values, a row for each object and interval, and their gradients by the inner control points. */
void clearances(Problem &problem, unsigned n, const double *x, double *result, double *gradient) {
  ConstraintCurve part{splineAt(problem, x), nullptr};
  for (int k = 0; k < kIntervals; ++k) {
    part.description.t0 = k / static_cast<double>(kIntervals);
    part.description.t1 = (k + 1) / static_cast<double>(kIntervals);
    part.curve = compile(part.description).curve;
    for (std::size_t i = 0; i < problem.objects.size(); ++i) {
      ConstraintPlace place;
      place.b = problem.poses[i];
      place.curve = &part;
      problem.objects[i]->evaluate(place, problem.workspace, problem.value);
      ++problem.evaluations;
      *result++ = problem.value.value;
      if (!gradient) continue;
      Eigen::Map<Eigen::VectorXd>(gradient, n) = Eigen::Map<const Eigen::VectorXd>(problem.value.points.data() + 3, n);
      gradient += n;
    }
  }
}

/* NLopt wants c(x) <= 0: minus the values. */
void tooNear(unsigned m, double *result, unsigned n, const double *x, double *gradient, void *data) {
  Problem &problem = *static_cast<Problem *>(data);
  try {
    clearances(problem, n, x, result, gradient);
  } catch (const std::exception &error) {
    problem.failure = error.what();
    nlopt_force_stop(problem.optimiser);
  }
  for (unsigned i = 0; i < m; ++i) result[i] = -result[i];
  for (unsigned i = 0; gradient && i < m * n; ++i) gradient[i] = -gradient[i];
}

/* What is proven of the whole spline against all objects. */
Answer clearance(const SnapshotPtr &snapshot, const CurveDescription &spline) {
  Query query;
  query.options.epsilon = 1e-6;
  Workspace workspace;
  return ask(snapshot, {}, spline, query, workspace).front();
}

void writeRow(std::FILE *file, const CurveDescription &c) {
  std::fprintf(file, "%s,bspline,3,0,1,%g,%d", c.id.c_str(), c.radius, static_cast<int>(kPoints));
  for (Eigen::Index i = 0; i < c.points.size(); ++i) std::fprintf(file, ",%.17g", c.points.data()[i]);
  for (const double knot : c.knots) std::fprintf(file, ",%.17g", knot);
  std::fprintf(file, "\n");
}

SnapshotPtr readScene(const std::string &path) {
  yaml::Warnings warnings;
  Scene scene;
  for (const std::string &fault : scene.apply(yaml::toChange(yaml::readScene(path, warnings), path, warnings)))
    throw Error(fault);
  return scene.snapshot();
}

int run(const std::string &scene_file, const char *out) {
  const SnapshotPtr snapshot = readScene(scene_file);
  pluginlib::ClassLoader<ConstraintProvider> plugins("curve_proximity", "curve_proximity::ConstraintProvider");
  const auto provider = plugins.createUniqueInstance("curve_proximity/CurveDistance");
  provider->initialise({{"margin", kClearance}});

  // Each object once, ready for any spline.
  Problem problem;
  problem.spline = straightSpline({0.16, 0.36, 0.36}, {0.62, 1.16, 0.40});
  for (const auto &object : snapshot->objects()) {
    ConstraintPair pair;
    pair.along_curve = true;
    for (const ShapeDescription &shape : object.second->description.shapes)
      pair.b.parts.push_back({shape, makeGeometry(shape).body, 0.0, {}});
    problem.objects.push_back(provider->prepare(pair));
    problem.poses.push_back(toPose(object.second->description.pose));
  }

  // From the straight spline to the smoothest one that is clear.
  const unsigned n = 3 * (kPoints - 2), m = static_cast<unsigned>(problem.objects.size()) * kIntervals;
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> optimiser(nlopt_create(NLOPT_LD_SLSQP, n), nlopt_destroy);
  problem.optimiser = optimiser.get();
  const std::vector<double> tolerances(m, 1e-6);
  nlopt_set_min_objective(optimiser.get(), smoothness, &problem);
  nlopt_add_inequality_mconstraint(optimiser.get(), m, tooNear, &problem, tolerances.data());
  nlopt_set_maxeval(optimiser.get(), 200);
  nlopt_set_xtol_abs1(optimiser.get(), 1e-6);
  const double *first = problem.spline.points.col(1).data();
  std::vector<double> x(first, first + n);
  double least = 0.0;
  const nlopt_result result = nlopt_optimize(optimiser.get(), x.data(), &least);
  if (!problem.failure.empty()) throw Error(problem.failure);
  CurveDescription after = splineAt(problem, x.data());
  after.id = "after";

  const Answer was = clearance(snapshot, problem.spline), is = clearance(snapshot, after);
  std::printf("before: at least %.6f m from %s\n", was.result.lower, was.b.c_str());
  std::printf("after:  at least %.6f m from %s, proven; %d steps, %u evaluations, NLopt said %d\n", is.result.lower,
              is.b.c_str(), nlopt_get_numevals(optimiser.get()), problem.evaluations, static_cast<int>(result));
  if (out) {
    std::FILE *file = std::fopen(out, "w");
    if (!file) throw Error(std::string(out) + " cannot be written");
    writeRow(file, problem.spline);
    writeRow(file, after);
    std::fclose(file);
  }
  return is.result.lower >= kClearance - 1e-5 ? 0 : 1;
}

} // namespace

int main(int argc, char **argv) {
  if (argc != 2 && argc != 3) {
    std::fprintf(stderr, "usage: %s SCENE.yaml [OUT.csv]\n", argv[0]);
    return 2;
  }
  try {
    return run(argv[1], argc == 3 ? argv[2] : nullptr);
  } catch (const std::exception &error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
}
