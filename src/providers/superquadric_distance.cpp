/* SPDX-License-Identifier: BSD-3-Clause */
/* curve_proximity/SuperquadricDistance: the signed distance of standing convex bodies, each as it is, or by a
 * superquadric that encloses it. */
#include <pluginlib/class_list_macros.hpp>

#include <algorithm>
#include <array>
#include <limits>

#include "distance_constraints.h"
#include "outline.h"

namespace curve_proximity {
namespace {

/* Two steps, in sizes and in radians: a jump stays as it is from one to the other, what is smooth shrinks to a
 * hundredth. */
constexpr double NEAR = 1e-6, FAR = 1e-4, LEAST_LEFT = 0.25;

/* What is rounding: of nearest points in sizes, of normals, of distances in sizes. */
constexpr double POINT_NOISE = 1e-6, NORMAL_NOISE = 2e-5, ALIKE = 1e-9;

/* A difference that is a jump at every step. */
constexpr double NOT_FOUND = std::numeric_limits<double>::max();

/* Narrower than a tenth of the least step: not where the budget or rounding ended the search long before. */
bool isFound(const cprox_result &result, double size) {
  return result.upper - result.lower <= 0.1 * NEAR * size;
}

bool isJump(double near, double far, double noise) {
  return near > noise && near > LEAST_LEFT * far;
}

/* Edges cross where their angle's sine is above this. */
constexpr double CROSSING = 1e-2;

/* Where a convex body meets the plane across a direction that supports it. */
struct Touch {
  bool is_point = false;                          /* as a jump is told: small turns of the plane move it a little */
  Eigen::Vector3d edge = Eigen::Vector3d::Zero(); /* [m] along the edge, or 0 where it meets in a face */
};

/* Of these kinds a support point is the nearest point of a plane outside. */
bool isConvexKind(const cprox_body *body) {
  switch (cprox_body_get_info(body).kind) {
    case CPROX_BODY_BOX:
    case CPROX_BODY_CAPSULE:
    case CPROX_BODY_CYLINDER:
    case CPROX_BODY_CONE:
    case CPROX_BODY_POLYTOPE: return true;
    default: return false;
  }
}

/* outward: unit. The plane is turned to both sides about two axes, as a body is by `spread`. */
Touch touchOf(const cprox_body *body, const cprox_pose &pose, const Eigen::Vector3d &outward, double noise) {
  const cprox_quat &q = pose.orientation;
  const Eigen::Quaterniond turn = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
  const Eigen::Vector3d u = turn.conjugate() * outward, across = u.unitOrthogonal(), other = u.cross(across);
  const auto between = [&](const Eigen::Vector3d &step) {
    cprox_vec3 one, two;
    cprox_body_support(body, toVec3(u + step), &one);
    cprox_body_support(body, toVec3(u - step), &two);
    return Eigen::Vector3d(toEigen(one) - toEigen(two));
  };
  const Eigen::Vector3d first = between(NEAR * across), second = between(NEAR * other);
  const double near = std::max(first.norm(), second.norm());
  Touch out;
  out.is_point =
      near <= noise || !isJump(near, std::max(between(FAR * across).norm(), between(FAR * other).norm()), noise);
  const Eigen::Vector3d &longer = first.norm() > second.norm() ? first : second;
  if (!out.is_point && first.cross(second).norm() <= noise * longer.norm()) out.edge = turn * longer;
  return out;
}

using Parameters = StandingDistanceParameters;

/* A part as single bodies. */
struct Element {
  BodyHandle body;          /* what is measured */
  BodyHandle hull;          /* contains it; what is measured where depths are asked for */
  BodyHandle shape;         /* the part itself, or null where it is not known: what bounds the distance from above */
  bool may_be_flat = false; /* there may be faces or edges, or surfaces that are all but flat */
  /* of a superquadric: its axes in the side's frame, each as long as the semi-axis; 0 where none are */
  Eigen::Matrix3d rows = Eigen::Matrix3d::Zero();
  std::array<bool, 3> is_flat_across{}; /* across the axis, where the normal has hardly a part along it */

  bool isMesh() const {
    return body != hull;
  }
};

/* A side, and how far its bodies stand out of what was described. */
struct Side {
  std::vector<Element> elements;
  double size = 0.0; /* [m] of the smallest of them: the radius of a ball that contains it; infinite of halfspaces */
  double padding = 0.0, excess = 0.0, missing = 0.0; /* [m]; missing: of hulls that are measured */
};

/* Exponents between these give a surface that is curved nearly everywhere. Above the third it has spots at which a turn
 * of NEAR moves the extreme point by more than LEAST_LEFT of what one of FAR does: (NEAR/FAR)^(1/(p-1)) at exponent p. */
constexpr double LEAST_ROUND = 1.05, MOST_ROUND = 64.0, MOST_CURVED = 4.3;

/* Those are where the normal's part along the axis is less than this of its largest part. */
constexpr double FLAT_PART = 10.0 * FAR;

bool mayBeFlat(const ShapeDescription &shape) {
  if (shape.type == ShapeType::POINT || shape.type == ShapeType::SPHERE || shape.type == ShapeType::ELLIPSOID)
    return false;
  if (shape.type != ShapeType::SUPERQUADRIC || shape.deformed) return true;
  for (std::size_t i = 3; i < 6; ++i)
    if (shape.dimensions[i] < LEAST_ROUND || shape.dimensions[i] > MOST_ROUND) return true;
  return false;
}

void findFlatSpots(const ShapeDescription &shape, Element &out) {
  out.may_be_flat = mayBeFlat(shape);
  if (out.may_be_flat || shape.type != ShapeType::SUPERQUADRIC) return;
  const std::vector<double> &d = shape.dimensions;
  out.rows = Eigen::Vector3d(d[0], d[1], d[2]).asDiagonal() * shape.pose.linear().transpose();
  for (std::size_t i = 0; i < 3; ++i) out.is_flat_across[i] = d[3 + i] > MOST_CURVED;
}

/* Whether its surface may be flat where its normal is along n. */
bool isFlatAlong(const Element &element, const cprox_pose &pose, const Eigen::Vector3d &n) {
  if (element.may_be_flat) return true;
  const cprox_quat &q = pose.orientation;
  const Eigen::Quaterniond turn = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
  const Eigen::Vector3d part = (element.rows * (turn.conjugate() * n)).cwiseAbs();
  for (Eigen::Index i = 0; i < 3; ++i)
    if (element.is_flat_across[static_cast<std::size_t>(i)] && part[i] < FLAT_PART * part.maxCoeff()) return true;
  return false;
}

double sizeOf(const BodyHandle &body) {
  return cprox_body_get_info(body.get()).radius;
}

/* An ellipsoid is a superquadric; two of these are searched by their second derivatives. */
ConstraintBody::Part asItIs(const ConstraintBody::Part &part) {
  ConstraintBody::Part out = part;
  if (part.shape.type != ShapeType::ELLIPSOID) return out;
  const std::vector<double> &d = part.shape.dimensions;
  out.body = makeSuperquadric({d.at(0), d.at(1), d.at(2)}, Eigen::Vector3d::Constant(2.0));
  return out;
}

bool isSmooth(ShapeType type) {
  return type == ShapeType::POINT || type == ShapeType::SPHERE || type == ShapeType::HALFSPACE ||
         type == ShapeType::SUPERQUADRIC || type == ShapeType::IMPLICIT || type == ShapeType::ELLIPSOID;
}

/* A superquadric round it, in the part's frame, with the frame's pose in the side's. */
ConstraintBody::Part enclosed(const ConstraintBody::Part &part, const SuperquadricFitOptions &options, double &excess) {
  try {
    ConstraintBody::Part out = part;
    const SuperquadricFit fit = fitSuperquadric(part.body, options);
    out.body = fit.body;
    out.shape.pose = part.shape.pose * fit.pose;
    excess = std::max(excess, fit.excess);
    out.shape.type = ShapeType::SUPERQUADRIC;
    out.shape.dimensions = {fit.semi_axes[0], fit.semi_axes[1], fit.semi_axes[2],
                            fit.exponents[0], fit.exponents[1], fit.exponents[2]};
    return out;
  } catch (const Error &error) {
    throw Error(std::string(shapeTypeName(part.shape.type)) + ": " + error.what(), error.status());
  }
}

/* One part as a body. */
BodyHandle bodyOf(const ConstraintBody::Part &part, bool exact) {
  ConstraintBody alone;
  alone.parts = {part};
  return joinedBody(alone, exact);
}

Element makeElement(const ConstraintBody::Part &part, const Parameters &parameters, const char *name, Side &side) {
  const bool enclose = parameters.fit && !isSmooth(part.shape.type), is_convex = !isHull(part);
  const bool exact = parameters.meshes == Meshes::EXACT && !enclose;
  double unused = 0.0; // a mesh bounds its distance from above itself
  const ConstraintBody::Part hull =
      enclose ? enclosed(part, *parameters.fit, is_convex ? side.excess : unused) : asItIs(part);
  if (exact && !is_convex && !part.exact)
    throw Error(std::string("side ") + name +
                ": a mesh that was simplified has no exact distance: ask with meshes: hull, or without a tolerance");
  if (!is_convex) side.missing = std::max(side.missing, part.excess);
  Element out;
  findFlatSpots(hull.shape, out);
  out.hull = bodyOf(hull, false);
  out.body = is_convex || !exact ? out.hull : bodyOf(part, true);
  if (is_convex)
    out.shape = out.hull;
  else if (part.exact)
    out.shape = bodyOf(part, true);
  return out;
}

Side makeSide(const ConstraintBody &described, const Parameters &parameters, const char *name) {
  if (described.parts.empty()) throw Error(std::string("side ") + name + " has no shape");
  Side side;
  side.padding = described.padding;
  side.size = std::numeric_limits<double>::infinity();
  for (const ConstraintBody::Part &part : described.parts) {
    side.elements.push_back(makeElement(part, parameters, name, side));
    side.size = std::min(side.size, sizeOf(side.elements.back().hull));
  }
  return side;
}

class SuperquadricConstraint : public Constraint {
 public:
  SuperquadricConstraint(const Parameters &parameters, const ConstraintPair &pair)
      : parameters_(parameters), a_(makeSide(pair.a, parameters, "a")), b_(makeSide(pair.b, parameters, "b")) {}

  void evaluate(const ConstraintPlace &place, Workspace &workspace, ConstraintValue &out) const override {
    if (place.curve) throw Error("there is a curve, and the pair is not along one");

    // The nearest of all pairs of parts, and the next. Of a single pair the search goes on from where it ended before.
    const bool single = a_.elements.size() == 1 && b_.elements.size() == 1;
    constexpr double INFINITE = std::numeric_limits<double>::infinity();
    Nearest best;
    double lower = INFINITE, upper = INFINITE, next = INFINITE;
    for (const Element &a : a_.elements) {
      for (const Element &b : b_.elements) {
        cprox_pair_start fresh{};
        const Nearest found = ask(a, b, place, single ? out.start : fresh, workspace);
        lower = std::min(lower, found.result.lower);
        upper = std::min(upper, found.upper);
        next = std::min(next, std::max(found.value(), best.value()));
        if (!best.a || found.value() < best.value()) best = found;
      }
    }
    fill(best, lower, upper, place, out);
    check(best, next, place, workspace, out);
  }

 private:
  /* A pair of parts: the bodies that were measured, what they say, and what the parts themselves do not exceed. The
   * result's upper is the value, whose gradient is known. */
  struct Nearest {
    const cprox_body *a = nullptr, *b = nullptr;
    const Element *part_a = nullptr, *part_b = nullptr;
    cprox_result result{};
    double upper = std::numeric_limits<double>::infinity();
    bool is_mesh = false; /* not convex: there may be several nearest points */
    bool is_known = true; /* false: the value says nothing of how deep they overlap */
    double shift = 0.0;   /* [m] by which either body may move without another way out; 0: not known */
    Nearest() {
      result.upper = std::numeric_limits<double>::infinity();
    }
    double value() const {
      return result.upper;
    }
  };

  cprox_result measure(const cprox_body *a, const cprox_body *b, const ConstraintPlace &place,
                       const cprox_options &options, Workspace &workspace) const {
    cprox_result result{};
    require(
        cprox_pair(cprox_with_margin(cprox_obstacle_at(a, place.a), a_.padding),
                   cprox_with_margin(cprox_obstacle_at(b, place.b), b_.padding), &options, workspace.get(), &result),
        workspace);
    return result;
  }

  /* Apart, meshes have their own distance. Where they overlap, their hulls say how deep at most. */
  Nearest ask(const Element &a, const Element &b, const ConstraintPlace &place, cprox_pair_start &start,
              Workspace &workspace) const {
    cprox_options options = parameters_.options;
    options.start = &start;
    const bool meshes = a.isMesh() || b.isMesh();
    Nearest out;
    out.a = a.body.get();
    out.b = b.body.get();
    out.part_a = &a;
    out.part_b = &b;
    out.result = measure(out.a, out.b, place, options, workspace);
    out.shift = start.shift;
    out.is_mesh = meshes && out.result.upper > 0.0;
    out.is_known = out.result.status != CPROX_OVERLAP || out.result.upper < 0.0;
    out.upper = out.result.upper + a_.excess + b_.excess;
    if (meshes && !out.is_mesh) {
      out.a = a.hull.get();
      out.b = b.hull.get();
      out.result = measure(out.a, out.b, place, options, workspace);
      out.shift = start.shift;
      out.result.lower -= a_.missing + b_.missing;
      out.is_known = out.result.status != CPROX_OVERLAP;
      out.result.status = CPROX_OVERLAP;
    } else if (a.shape != a.body || b.shape != b.body) { /* a hull stands for a shape */
      out.result.lower -= a_.missing + b_.missing;
      out.upper = std::numeric_limits<double>::infinity();
      options.start = nullptr;
      if (a.shape && b.shape)
        out.upper = measure(a.shape.get(), b.shape.get(), place, options, workspace).upper + a_.excess + b_.excess;
    }
    return out;
  }

  /* d = max over unit n of -h_A(-n) - h_B(n) is minus the depth inside, the distance outside: by the support points, a
   * turn w of a changes it by w·((p_a - x_a) x n), one of b by -w·((p_b - x_b) x n). */
  void fill(const Nearest &best, double lower, double upper, const ConstraintPlace &place, ConstraintValue &out) const {
    const cprox_result &r = best.result;
    out.status = r.status;
    out.value = std::min(best.value(), upper) - parameters_.margin;
    out.bounded = true;
    out.lower = lower - parameters_.margin;
    out.upper = upper - parameters_.margin;
    out.has_points = true;
    out.witness_a = toEigen(r.witness_mover);
    out.witness_b = toEigen(r.witness_obstacle);
    out.normal = toEigen(r.normal);
    out.a.linear = out.normal;
    out.b.linear = -out.normal;
    out.a.angular = (out.witness_a - toEigen(place.a.position)).cross(out.normal);
    out.b.angular = out.normal.cross(out.witness_b - toEigen(place.b.position));
    out.points.resize(3, 0), out.parameters.resize(0);
    out.radius = out.range_start = out.range_end = 0.0;
    out.t = std::numeric_limits<double>::quiet_NaN();
  }

  /* Is the gradient that of one minimiser alone? */
  void check(const Nearest &best, double next, const ConstraintPlace &place, Workspace &workspace,
             ConstraintValue &out) const {
    const double size = std::min(a_.size, b_.size);
    out.valid = false;
    if (!best.is_known) {
      out.reason = "how deep they overlap is not known";
    } else if (out.normal.isZero(0.0)) {
      out.reason = "there is no normal";
    } else if (next <= best.result.upper + 2.0 * parameters_.options.epsilon + ALIKE * size) {
      out.reason = "two pairs of parts are equally near";
    } else if (best.result.upper < ALIKE * size && !wayOutIsAlone(best, place, size, workspace)) {
      out.reason = "there is more than one way out";
    } else if (best.is_mesh && !wayOutIsAlone(best, place, size, workspace)) {
      out.reason = "the nearest points are not the only ones";
    } else if (isFlatAlong(*best.part_a, place.a, out.normal) && isFlatAlong(*best.part_b, place.b, out.normal) &&
               !nearestIsAlone(best, place, size, workspace)) {
      out.reason = "the nearest points are not the only ones";
    } else {
      out.reason.clear();
      out.valid = true;
    }
  }

  cprox_result pairAt(const Nearest &best, const cprox_pose &a, const cprox_pose &b, Workspace &workspace) const {
    // A turn of 1e-6 rad changes the distance by so much less than epsilon that it would not be seen.
    cprox_options exact = parameters_.options;
    exact.epsilon = std::min(exact.epsilon, 1e-13 * std::min(a_.size, b_.size));
    ConstraintPlace place;
    place.a = a;
    place.b = b;
    return measure(best.a, best.b, place, exact, workspace);
  }

  /* Inside and in contact the way out may change from one side to another: then the normal jumps nearby. So it does
   * where a mesh has two nearest points. The search itself mostly tells that no other way out is as near. */
  bool wayOutIsAlone(const Nearest &best, const ConstraintPlace &place, double size, Workspace &workspace) const {
    if (best.shift > NEAR * size) return true;
    const double near = lean(best, place, NEAR * size, workspace);
    return near <= NORMAL_NOISE || !isJump(near, lean(best, place, FAR * size, workspace), NORMAL_NOISE);
  }

  /* How much the normal differs a step to either side, along the axis where that is most; NOT_FOUND where a search does
   * not find the way out. */
  double lean(const Nearest &best, const ConstraintPlace &place, double step, Workspace &workspace) const {
    double most = 0.0;
    for (int i = 0; i < 3; ++i) {
      std::array<Eigen::Vector3d, 2> normals;
      for (std::size_t k = 0; k < 2; ++k) {
        cprox_pose moved = place.a;
        moved.position = toVec3(toEigen(moved.position) + (k ? step : -step) * Eigen::Vector3d::Unit(i));
        const cprox_result found = pairAt(best, moved, place.b, workspace);
        if (!isFound(found, std::min(a_.size, b_.size))) return NOT_FOUND;
        normals[k] = toEigen(found.normal);
      }
      most = std::max(most, (normals[1] - normals[0]).norm());
    }
    return most;
  }

  /* Two flat faces, or an edge along a face: a turn to either side moves the nearest points to either end. Where one of
   * two convex bodies touches in a point, or both in edges that cross, the nearest points are alone without a look. */
  bool nearestIsAlone(const Nearest &best, const ConstraintPlace &place, double size, Workspace &workspace) const {
    const double noise = POINT_NOISE * size;
    if (isConvexKind(best.a) && isConvexKind(best.b)) {
      const cprox_result here = pairAt(best, place.a, place.b, workspace); // whose normal is exact enough
      const Eigen::Vector3d n = toEigen(here.normal);
      if (isFound(here, size) && !n.isZero(0.0)) {
        const Touch a = touchOf(best.a, place.a, -n, noise), b = touchOf(best.b, place.b, n, noise);
        if (a.is_point || b.is_point || a.edge.cross(b.edge).norm() > CROSSING * a.edge.norm() * b.edge.norm())
          return true;
      }
    }
    const double near = spread(best, place, NEAR, workspace);
    return near <= noise || !isJump(near, spread(best, place, FAR, workspace), noise);
  }

  /* How far apart b's nearest points are when it has turned about its own to one side and to the other, about the axis
   * across the normal where that is most; NOT_FOUND as above. */
  double spread(const Nearest &best, const ConstraintPlace &place, double turn, Workspace &workspace) const {
    const Eigen::Vector3d n = toEigen(best.result.normal), centre = toEigen(best.result.witness_obstacle);
    const Eigen::Vector3d across = n.unitOrthogonal(), other = n.cross(across);
    const cprox_quat &q = place.b.orientation;
    double most = 0.0;
    for (const Eigen::Vector3d &axis : {across, other}) {
      std::array<Eigen::Vector3d, 2> points;
      for (std::size_t k = 0; k < 2; ++k) {
        const Eigen::Quaterniond by(Eigen::AngleAxisd(k ? turn : -turn, axis));
        const Eigen::Quaterniond turned = by * Eigen::Quaterniond(q.w, q.x, q.y, q.z);
        const cprox_pose b = {toVec3(centre + by * (toEigen(place.b.position) - centre)),
                              {turned.w(), turned.x(), turned.y(), turned.z()}};
        const cprox_result found = pairAt(best, place.a, b, workspace);
        if (!isFound(found, std::min(a_.size, b_.size))) return NOT_FOUND;
        points[k] = toEigen(found.witness_obstacle);
      }
      most = std::max(most, (points[1] - points[0]).norm());
    }
    return most;
  }

  const Parameters parameters_;
  const Side a_, b_;
};

} // namespace

std::unique_ptr<const Constraint> standingDistance(const StandingDistanceParameters &parameters,
                                                   const ConstraintPair &pair) {
  return std::make_unique<SuperquadricConstraint>(parameters, pair);
}

class SuperquadricDistance : public ConstraintProvider {
 public:
  void initialise(const ParameterMap &parameters) override {
    ParameterReader reader(parameters);
    parameters_.options.epsilon = reader.number("epsilon", 1e-9, 0.0);
    parameters_.margin = reader.number("margin", 0.0, 0.0);
    parameters_.meshes = readMeshes(reader);
    const double most_exponent = reader.number("most_exponent", 0.0, 2.0, false, 1000.0);
    reader.end();
    if (most_exponent == 0.0) return; /* not given */
    parameters_.fit.emplace();
    parameters_.fit->most_exponent = most_exponent;
  }

  std::unique_ptr<const Constraint> prepare(const ConstraintPair &pair) const override {
    if (!pair.along_curve) return standingDistance(parameters_, pair);
    if (!pair.is_named) throw DoesNotApply("CurveDistance answers about curves");
    if (parameters_.fit) throw Error("most_exponent is about standing bodies: bodies along curves are as they are");
    CurveDistanceParameters along;
    along.options.epsilon = parameters_.options.epsilon;
    along.options.signed_distance = true;
    along.margin = parameters_.margin;
    along.meshes = parameters_.meshes;
    return curveDistance(along, pair);
  }

 private:
  Parameters parameters_;
};

} // namespace curve_proximity

PLUGINLIB_EXPORT_CLASS(curve_proximity::SuperquadricDistance, curve_proximity::ConstraintProvider)
