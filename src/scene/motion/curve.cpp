/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves from their descriptions, and the boxes that the broadphase asks about. */
#include <algorithm>
#include <cmath>

#include <curve_proximity/query.hpp>

#include "curve_basis.h"

namespace curve_proximity {
namespace {

/* Boxes a curve is cut into: few enough to be cheap to ask about, enough to follow a bend. */
constexpr std::size_t BOXES = 8;
constexpr std::size_t MOST_BOXES = 32;

/* Control points of a part of a curve are within (12 degree + 20) 2^-53 of the largest coordinate, and those of a half
 * of it within degree 2^-53 more: of an eighth below 1e-13. */
constexpr double BOX_MARGIN = 1e-12;

/* The two halves of a Bézier curve of n control points, by de Casteljau's averages: the left one takes the curve's
 * place. */
void halve(cprox_vec3 *left, cprox_vec3 *right, std::size_t n) {
  std::copy(left, left + n, right);
  for (std::size_t k = 1; k < n; ++k) {
    for (std::size_t j = 0; j + k < n; ++j) {
      right[j] = {0.5 * (right[j].x + right[j + 1].x), 0.5 * (right[j].y + right[j + 1].y),
                  0.5 * (right[j].z + right[j + 1].z)};
    }
    left[k] = right[0];
  }
}

/* Cuts each of the intervals between the breaks into `parts`, a power of two; one box where they are too short to
 * cut. */
std::vector<Eigen::AlignedBox3d> cutBoxes(const cprox_curve *curve, const std::vector<double> &breaks,
                                          std::size_t parts) {
  const cprox_curve_info info = cprox_curve_get_info(curve);
  const Eigen::AlignedBox3d whole(toEigen(info.lowest), toEigen(info.highest));
  const double size = whole.min().cwiseAbs().cwiseMax(whole.max().cwiseAbs()).maxCoeff();
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(BOX_MARGIN * size + info.error);

  const std::size_t n = info.degree + 1;
  std::vector<cprox_vec3> points(parts * n); // of one part after the other
  std::vector<Eigen::AlignedBox3d> boxes;
  boxes.reserve(parts * (breaks.size() - 1));
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    if (!(breaks[i] < breaks[i + 1]) ||
        cprox_curve_control_points(curve, breaks[i], breaks[i + 1], nullptr, points.data()) != CPROX_OK)
      return {whole};
    for (std::size_t step = parts; step > 1; step /= 2) {
      for (std::size_t part = 0; part < parts; part += step)
        halve(&points[part * n], &points[(part + step / 2) * n], n);
    }
    for (auto first = points.begin(); first != points.end(); first += static_cast<std::ptrdiff_t>(n)) {
      Eigen::AlignedBox3d box;
      std::for_each_n(first, n, [&](const cprox_vec3 &p) { box.extend(toEigen(p)); });
      boxes.emplace_back(box.min() - margin, box.max() + margin);
    }
  }
  return boxes;
}

/* Boxes of a curve whose pieces are not the description's: each a few pieces, a single piece cut. */
std::vector<Eigen::AlignedBox3d> pieceBoxes(const cprox_curve *curve) {
  const cprox_curve_info info = cprox_curve_get_info(curve);
  const std::size_t n = info.n_pieces;
  if (n == 1) return cutBoxes(curve, {info.t0, info.t1}, BOXES);
  std::vector<Eigen::AlignedBox3d> boxes(std::min(n, MOST_BOXES));
  for (std::size_t i = 0; i < n; ++i) {
    const cprox_curve_piece_info piece = cprox_curve_get_piece_info(curve, i);
    boxes[i * boxes.size() / n].extend(Eigen::AlignedBox3d(toEigen(piece.lowest), toEigen(piece.highest)));
  }
  return boxes;
}

/* The spans of a B-spline that meet [t0, t1]: knots[j] < knots[j+1]. */
std::vector<std::size_t> spansOf(const CurveDescription &curve) {
  std::vector<std::size_t> spans;
  for (std::size_t j = curve.degree; j < static_cast<std::size_t>(curve.points.cols()); ++j) {
    const double from = curve.knots[j], to = curve.knots[j + 1];
    if (from < to && from <= curve.t1 && to >= curve.t0) spans.push_back(j);
  }
  return spans;
}

/* Span j lies in the hull of points j-degree … j, exactly: a box for every group of spans. */
std::vector<Eigen::AlignedBox3d> spanBoxes(const CurveDescription &curve, const std::vector<std::size_t> &spans) {
  std::vector<Eigen::AlignedBox3d> boxes;
  const std::size_t a_box = (spans.size() + MOST_BOXES - 1) / MOST_BOXES;
  for (std::size_t first = 0; first < spans.size(); first += a_box) {
    const std::size_t last = std::min(first + a_box, spans.size()) - 1;
    const auto from = static_cast<Eigen::Index>(spans[first] - curve.degree);
    const auto n = static_cast<Eigen::Index>(spans[last]) - from + 1;
    const auto points = curve.points.middleCols(from, n);
    boxes.emplace_back(points.rowwise().minCoeff(), points.rowwise().maxCoeff());
  }
  return boxes;
}

std::vector<Eigen::AlignedBox3d> splineBoxes(const CurveDescription &description, const cprox_curve *curve) {
  const std::vector<std::size_t> spans = spansOf(description);
  if (spans.size() > BOXES) return spanBoxes(description, spans);
  std::vector<double> breaks = {description.t0};
  for (const std::size_t j : spans) {
    const double knot = description.knots[j];
    if (knot > breaks.back() && knot < description.t1) breaks.push_back(knot);
  }
  breaks.push_back(description.t1);
  std::size_t parts = 1;
  while (parts * (breaks.size() - 1) < BOXES) parts *= 2;
  return cutBoxes(curve, breaks, parts);
}

/* As many points, knots and parameters as the basis takes. */
void checkCounts(const CurveDescription &curve) {
  const auto n = static_cast<std::size_t>(curve.points.cols());
  const CurveCounts needed = countsOf(curve.basis, curve.degree, n);
  const auto check = [&](const std::string &verb, const std::string &what, std::size_t wanted, std::size_t got) {
    if (got == wanted) return;
    const std::string degree = wanted > 0 && curve.degree > 0 ? " of degree " + std::to_string(curve.degree) : "";
    throw Error("a " + curve.basis + " curve" + degree + " " + verb + " " +
                (wanted > 0 ? std::to_string(wanted) : "no") + " " + what + ", got " + std::to_string(got));
  };
  check("has", "points", needed.points, n);
  check("takes", curve.basis == "lagrange" ? "nodes" : "knots", needed.knots, curve.knots.size());
  check("takes", "parameters", needed.parameters, curve.parameters.size());
}

cprox_dubins_word dubinsWordOf(const std::string &basis) {
  static constexpr std::pair<const char *, cprox_dubins_word> words[] = {
      {"dubins", CPROX_DUBINS_SHORTEST}, {"dubins_lsl", CPROX_DUBINS_LSL}, {"dubins_lsr", CPROX_DUBINS_LSR},
      {"dubins_rsl", CPROX_DUBINS_RSL},  {"dubins_rsr", CPROX_DUBINS_RSR}, {"dubins_rlr", CPROX_DUBINS_RLR},
      {"dubins_lrl", CPROX_DUBINS_LRL}};
  for (const auto &[name, word] : words)
    if (basis == name) return word;
  throw Error("basis '" + basis + "' is not available");
}

cprox_curve_kind kindOf(const std::string &basis) {
  static constexpr std::pair<const char *, cprox_curve_kind> kinds[] = {
      {"bezier", CPROX_CURVE_BEZIER},
      {"bspline", CPROX_CURVE_BSPLINE},
      {"polynomial", CPROX_CURVE_POLYNOMIAL},
      {"legendre", CPROX_CURVE_LEGENDRE},
      {"lagrange", CPROX_CURVE_LAGRANGE},
      {"trigonometric", CPROX_CURVE_TRIGONOMETRIC},
      {"clothoid", CPROX_CURVE_CLOTHOID},
      {"involute", CPROX_CURVE_INVOLUTE},
      {"pythagorean_hodograph", CPROX_CURVE_PYTHAGOREAN_HODOGRAPH},
      {"rational_bezier", CPROX_CURVE_RATIONAL_BEZIER},
      {"nurbs", CPROX_CURVE_NURBS}};
  for (const auto &[name, kind] : kinds)
    if (basis == name) return kind;
  return CPROX_CURVE_DUBINS;
}

/* What the core makes of a curve that is not piecewise, and whose counts are right; the numbers stay the curve's. */
cprox_curve_description descriptionOf(const CurveDescription &curve) {
  const std::vector<double> &p = curve.parameters;
  cprox_curve_description d = detail::describe(kindOf(curve.basis), curve.points, curve.t0, curve.t1);
  d.degree = curve.degree, d.knots = curve.knots.data(), d.n_knots = curve.knots.size();
  if (!isNamedBasis(curve.basis)) {
    d.weights = p.data();
    return d;
  }
  d.start = toVec3(curve.points.col(0));
  if (d.kind == CPROX_CURVE_PYTHAGOREAN_HODOGRAPH) {
    static_assert(sizeof(cprox_quat) == 4 * sizeof(double), "four numbers a quaternion, w first");
    d.preimage = reinterpret_cast<const cprox_quat *>(p.data()), d.n = p.size() / 4;
    return d;
  }
  d.heading = p[0];
  if (d.kind == CPROX_CURVE_CLOTHOID) d.curvature = p[1], d.curvature_rate = p[2];
  if (d.kind == CPROX_CURVE_INVOLUTE) d.radius = p[1];
  if (d.kind == CPROX_CURVE_DUBINS) {
    d.word = dubinsWordOf(curve.basis);
    d.end = toVec3(curve.points.col(1)), d.end_heading = p[1], d.radius = p[2];
  }
  return d;
}

CurveHandle makeWhole(const CurveDescription &curve, Workspace &workspace);

CurveHandle makeWithPlace(const CurveDescription &curve, Workspace &workspace) {
  CurveHandle whole = makeWhole(curve, workspace);
  const bool restricts = curve.restrict_t0 != 0.0 || curve.restrict_t1 != 0.0;
  if (!restricts && !curve.pose) return whole;
  const cprox_curve_info info = cprox_curve_get_info(whole.get());
  const double from = restricts ? curve.restrict_t0 : info.t0, to = restricts ? curve.restrict_t1 : info.t1;
  return restrictCurve(whole, from, to, curve.pose.value_or(Eigen::Isometry3d::Identity()));
}

CurveHandle joinPieces(const CurveDescription &curve, Workspace &workspace) {
  if (curve.parameters.size() > 1)
    throw Error("a piecewise curve takes one parameter, the gap, or none; got " +
                std::to_string(curve.parameters.size()));
  if (curve.degree != 0 || curve.points.cols() != 0 || !curve.knots.empty())
    throw Error("a piecewise curve has pieces, and no degree, points or knots of its own");
  std::vector<CurveHandle> handles;
  for (std::size_t i = 0; i < curve.pieces.size(); ++i) {
    try {
      if (curve.pieces[i].basis == "piecewise") throw Error("it is piecewise itself");
      handles.push_back(makeWithPlace(curve.pieces[i], workspace));
    } catch (const Error &error) {
      throw Error("piece " + std::to_string(i) + ": " + error.what(), error.status());
    }
  }
  return makePiecewise(handles, {}, curve.parameters.empty() ? 0.0 : curve.parameters.front());
}

/* Without restriction and pose. */
CurveHandle makeWhole(const CurveDescription &curve, Workspace &workspace) {
  if (curve.basis == "piecewise") return joinPieces(curve, workspace);
  if (!curve.pieces.empty())
    throw Error("a " + curve.basis + " curve has no pieces, got " + std::to_string(curve.pieces.size()));
  checkCounts(curve);
  return detail::createCurve(descriptionOf(curve), workspace);
}

/* What a radius that changes adds: a polynomial over the range of the curve, as the x of a curve. */
CurveHandle makeRadius(const std::vector<double> &coefficients, const CurveHandle &curve) {
  if (coefficients.empty()) return nullptr;
  const auto n = static_cast<Eigen::Index>(coefficients.size());
  if (n > CPROX_MAX_DEGREE)
    throw Error("radius_polynomial has " + std::to_string(n) + " coefficients, at most " +
                std::to_string(CPROX_MAX_DEGREE) + " are allowed");
  Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Zero(3, n + 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    points(0, i + 1) = coefficients[static_cast<std::size_t>(i)];
    if (!std::isfinite(points(0, i + 1)))
      throw Error("radius_polynomial: coefficient " + std::to_string(i) + " is not finite");
  }
  const cprox_curve_info info = cprox_curve_get_info(curve.get());
  return makePolynomial(points, info.t0, info.t1);
}

/* At the end of a Dubins path the parameter is its length, and so a radius that depends on it changes with what the
 * length depends on: by the step from the point that keeps its parameter to the end point, along the path. */
void takeGrowthAtEnd(const CurveDescription &curve, const cprox_curve_description &d, double t,
                     const Eigen::Vector3d &n, std::vector<cprox_vec3> &columns) {
  std::vector<cprox_vec3> kept(columns.size());
  if (!(n.squaredNorm() > 0.0)) return;
  if (cprox_curve_jacobian(&d, std::nextafter(t, 0.0), kept.data()) != CPROX_OK) return;
  double growth = 0.0; // of the radius, by t
  for (std::size_t k = curve.radius_polynomial.size(); k > 0; --k)
    growth = growth * t + static_cast<double>(k) * curve.radius_polynomial[k - 1];
  const Eigen::Vector3d tangent(std::cos(d.end_heading), std::sin(d.end_heading), 0.0);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const double longer = tangent.dot(toEigen(columns[i]) - toEigen(kept[i]));
    columns[i] = toVec3(toEigen(columns[i]) - growth * longer / n.squaredNorm() * n);
  }
}

void checkRadius(double radius) {
  if (!std::isfinite(radius) || radius < 0.0) throw Error("the radius must be finite and not below 0");
}

} // namespace

cprox_mover moverOf(const CompiledCurve &curve) {
  cprox_mover mover = along(curve.curve, curve.radius);
  mover.radius_curve = curve.radius_curve.get();
  return mover;
}

double radiusAt(const CompiledCurve &curve, double t) {
  cprox_vec3 more{};
  if (curve.radius_curve) cprox_curve_evaluate(curve.radius_curve.get(), t, nullptr, &more, nullptr, nullptr);
  return std::max(0.0, curve.radius + more.x);
}

void gradientByCurve(const CurveDescription &curve, double t, const Eigen::Vector3d &n, Eigen::Matrix3Xd &points,
                     Eigen::VectorXd &parameters) {
  points.resize(3, 0), parameters.resize(0);
  if (curve.basis == "piecewise") return;
  const cprox_curve_description d = descriptionOf(curve);
  const Eigen::Matrix3d turned = curve.pose.value_or(Eigen::Isometry3d::Identity()).linear();
  const Eigen::Vector3d own = turned.transpose() * n;
  const bool is_dubins = d.kind == CPROX_CURVE_DUBINS;
  thread_local std::vector<cprox_vec3> columns;
  columns.resize(curve.parameters.size() + (is_dubins ? 4 : 0));
  const bool differentiable = cprox_curve_jacobian(&d, t, columns.data()) == CPROX_OK;
  if (is_dubins && differentiable && !curve.radius_polynomial.empty()) takeGrowthAtEnd(curve, d, t, own, columns);
  const auto along = [&](std::size_t i) { return own.dot(toEigen(columns[i])); };
  if (is_dubins && !differentiable) return;
  if (differentiable) {
    parameters.resize(static_cast<Eigen::Index>(curve.parameters.size()));
    for (std::size_t i = 0; i < curve.parameters.size(); ++i) parameters[static_cast<Eigen::Index>(i)] = along(i);
  }
  points.resize(3, curve.points.cols());
  if (is_dubins) {
    points.col(0) = turned * Eigen::Vector3d(along(3), along(4), own.z());
    points.col(1) = turned * Eigen::Vector3d(along(5), along(6), 0.0);
    return;
  }
  /* the weights stand at the front of the matrix; from the back, a column covers none that is still to be read */
  double *weights = points.data();
  if (cprox_curve_weights(&d, t, weights) != CPROX_OK) weights[0] = 1.0; /* the start, with which all of it moves */
  for (Eigen::Index i = points.cols(); i-- > 0;) {
    const double w = weights[i];
    points.col(i) = w * n;
  }
}

CompiledCurve compile(const CurveDescription &curve, CurveBoxes boxes) {
  Workspace workspace;
  return compile(curve, boxes, workspace);
}

CompiledCurve compile(const std::string &id, const CurveHandle &curve, double radius, CurveBoxes boxes) {
  checkRadius(radius);
  CompiledCurve out;
  out.id = id, out.curve = curve, out.radius = out.reach = radius;
  if (boxes == CurveBoxes::MANY) out.boxes = pieceBoxes(curve.get());
  return out;
}

CompiledCurve compile(const CurveDescription &curve, CurveBoxes boxes, Workspace &workspace) {
  checkRadius(curve.radius);
  const CurveHandle handle = makeWithPlace(curve, workspace);
  const bool is_spline = cprox_curve_get_info(handle.get()).kind == CPROX_CURVE_BSPLINE;
  CompiledCurve out = compile(curve.id, handle, curve.radius, is_spline ? CurveBoxes::NONE : boxes);
  if (is_spline && boxes == CurveBoxes::MANY) out.boxes = splineBoxes(curve, handle.get());
  out.radius_curve = makeRadius(curve.radius_polynomial, handle);
  const double more = out.radius_curve ? cprox_curve_get_info(out.radius_curve.get()).highest.x : 0.0;
  if (more > 0.0) out.reach = (out.radius + more) * (1.0 + 1e-15);
  return out;
}

} // namespace curve_proximity
