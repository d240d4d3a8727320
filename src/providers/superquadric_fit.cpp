/* SPDX-License-Identifier: BSD-3-Clause */
#include <algorithm>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>

#include <curve_proximity/superquadric_fit.hpp>

namespace curve_proximity {
namespace {

/* Directions in which the body is looked at before anything is proven. */
constexpr int DIRECTIONS = 400;

/* The least half extent, as a fraction of the largest: a flat body gets a superquadric with an inside. */
constexpr double THINNEST = 1e-3;

/* The widths of the proofs, as fractions of the body's size. */
constexpr double ENCLOSED_WITHIN = 1e-4, EXCESS_WITHIN = 2e-3;

/* More than the rounding of support functions, poses and gauges, as a fraction of the size. */
constexpr double ROUNDING = 1e-10;

constexpr double SQRT3 = 1.7320508075688772;

SupportFunction supportOf(const BodyHandle &body, const Eigen::Isometry3d &pose) {
  return [body, pose](const Eigen::Vector3d &direction, Eigen::Vector3d &point) {
    cprox_vec3 at;
    cprox_body_support(body.get(), toVec3(pose.linear().transpose() * direction), &at);
    point = pose * toEigen(at);
    return direction.dot(point);
  };
}

/* Points of a body, each the farthest in a direction; a Fibonacci sphere. */
struct Samples {
  Eigen::Matrix3Xd directions, points;
  Eigen::VectorXd heights;
};

Samples sample(const SupportFunction &support) {
  Samples out{Eigen::Matrix3Xd(3, DIRECTIONS), Eigen::Matrix3Xd(3, DIRECTIONS), Eigen::VectorXd(DIRECTIONS)};
  const double golden = M_PI * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < DIRECTIONS; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / DIRECTIONS, r = std::sqrt(1.0 - z * z);
    out.directions.col(i) << r * std::cos(golden * i), r * std::sin(golden * i), z;
    Eigen::Vector3d point;
    out.heights[i] = support(out.directions.col(i), point);
    out.points.col(i) = point;
  }
  return out;
}

/* A superquadric that is being looked for. */
struct Candidate {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Eigen::Vector3d semi_axes, exponents;
  double excess = 0.0; /* met in the sampled directions */
};

double gauge(const Eigen::Vector3d &x, const Eigen::Vector3d &a, const Eigen::Vector3d &n) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) sum += std::pow(std::abs(x[i]) / a[i], n[i]);
  return sum;
}

/* The semi-axes: the half extents, each longer by the same least length that takes all points in. */
Eigen::Vector3d leastAxes(const Eigen::Matrix3Xd &points, const Eigen::Vector3d &extents, const Eigen::Vector3d &n) {
  const auto holds = [&](double more) {
    const Eigen::Vector3d a = extents.array() + more;
    for (Eigen::Index i = 0; i < points.cols(); ++i)
      if (gauge(points.col(i), a, n) > 1.0) return false;
    return true;
  };
  double low = 0.0, high = 2.0 * extents.maxCoeff();
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? high : low) = middle;
  }
  return extents.array() + high;
}

/* The superquadric's height: the norm dual to its gauge where the exponents are alike, else by the core. */
double worstExcess(const Candidate &candidate, const Samples &samples) {
  const SupportFunction support = supportOf(makeSuperquadric(candidate.semi_axes, candidate.exponents), candidate.pose);
  double worst = 0.0;
  Eigen::Vector3d point;
  for (Eigen::Index i = 0; i < samples.directions.cols(); ++i)
    worst = std::max(worst, support(samples.directions.col(i), point) - samples.heights[i]);
  return worst;
}

/* The axes in which the body is looked at: its own, and those of its sampled points' spread. */
std::vector<Eigen::Matrix3d> framesOf(const Samples &samples) {
  const Eigen::Vector3d mean = samples.points.rowwise().mean();
  const Eigen::Matrix3Xd from_mean = samples.points.colwise() - mean;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(from_mean * from_mean.transpose());
  Eigen::Matrix3d axes = spread.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(0) *= -1.0;
  return {Eigen::Matrix3d::Identity(), axes};
}

Candidate bestCandidate(const SupportFunction &support, const Samples &samples, double most_exponent) {
  std::vector<double> exponents;
  for (double n = 2.0; n < most_exponent; n *= 1.5) exponents.push_back(n);
  exponents.push_back(most_exponent);

  std::optional<Candidate> best;
  for (const Eigen::Matrix3d &axes : framesOf(samples)) {
    // The middle and half the extents along these axes.
    Eigen::Vector3d middle, extents, point;
    for (int i = 0; i < 3; ++i) {
      const double high = support(axes.col(i), point), low = -support(-axes.col(i), point);
      middle[i] = 0.5 * (low + high);
      extents[i] = 0.5 * (high - low);
    }
    extents = extents.cwiseMax(THINNEST * extents.maxCoeff());
    Candidate candidate;
    candidate.pose.linear() = axes;
    candidate.pose.translation() = axes * middle;
    const Eigen::Matrix3Xd local = candidate.pose.inverse() * samples.points;

    // Alike along all axes, or round about one of them.
    for (const double n : exponents) {
      for (int round = -1; round < (n > 2.0 ? 3 : 0); ++round) {
        candidate.exponents = round < 0 ? Eigen::Vector3d::Constant(n) : Eigen::Vector3d::Constant(2.0);
        if (round >= 0) candidate.exponents[round] = n;
        candidate.semi_axes = leastAxes(local, extents, candidate.exponents);
        candidate.excess = worstExcess(candidate, samples);
        if (!best || candidate.excess < 0.999 * best->excess) best = candidate;
      }
    }
  }
  return *best;
}

/* A superquadric holds the octahedron of its semi-axes, and that a ball. */
double innerRadius(const Eigen::Vector3d &semi_axes) {
  return semi_axes.minCoeff() / SQRT3;
}

void requireKind(const BodyHandle &body) {
  const cprox_body_kind kind = cprox_body_get_info(body.get()).kind;
  switch (kind) {
    case CPROX_BODY_SPHERE:
    case CPROX_BODY_BOX:
    case CPROX_BODY_CAPSULE:
    case CPROX_BODY_CYLINDER:
    case CPROX_BODY_CONE:
    case CPROX_BODY_ELLIPSOID:
    case CPROX_BODY_POLYTOPE:
    case CPROX_BODY_POLYGON:
    case CPROX_BODY_SUPPORT:
    case CPROX_BODY_SUPERQUADRIC:
    case CPROX_BODY_IMPLICIT: return;
    default:
      throw Error(std::string("no superquadric is fitted to bodies of the kind '") + cprox_body_kind_name(kind) + "'");
  }
}

} // namespace

SuperquadricFit fitSuperquadric(const BodyHandle &body, const SuperquadricFitOptions &options) {
  requireKind(body);
  if (!(options.most_exponent >= 2.0 && options.most_exponent <= 1000.0) || options.cells < 8)
    throw Error("a fit needs a largest exponent of 2 … 1000 and at least 8 cells");
  const SupportFunction support = supportOf(body, Eigen::Isometry3d::Identity());
  const Samples samples = sample(support);
  const Candidate candidate = bestCandidate(support, samples, options.most_exponent);
  const double size = candidate.semi_axes.maxCoeff();
  const double rounding = ROUNDING * (size + candidate.pose.translation().norm());

  // Enclosed: what stands out by d in some direction is taken in by a scaling of 1 + d/r.
  SuperquadricFit fit{candidate.semi_axes, candidate.exponents, candidate.pose, nullptr, 0.0};
  const SupportFunction first = supportOf(makeSuperquadric(fit.semi_axes, fit.exponents), fit.pose);
  const double out = supportGap(support, first, ENCLOSED_WITHIN * size, options.cells) + rounding;
  if (out > 0.0) fit.semi_axes *= 1.0 + out / innerRadius(fit.semi_axes);
  fit.body = makeSuperquadric(fit.semi_axes, fit.exponents);

  // By how much.
  fit.excess =
      rounding + std::max(0.0, supportGap(supportOf(fit.body, fit.pose), support, EXCESS_WITHIN * size, options.cells));
  return fit;
}

} // namespace curve_proximity
