/* SPDX-License-Identifier: BSD-3-Clause */
#include "certificate_problem.h"

#include <array>
#include <cstdio>
#include <cstring>

#include "answering.h"
#include "asked_pairs.h"
#include "base/digest.h"
#include "motion/movers_data.h"
#include "proving.h"
#include "scene_obstacles.h"

namespace curve_proximity {
namespace {

void appendExactly(std::string &line, double value) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), " %a", value);
  line += text.data();
}

std::string curveWords(const CurveDescription &curve) {
  const Eigen::Index n = curve.points.cols();
  const std::size_t degree = curve.basis == "bezier" ? static_cast<std::size_t>(n) - 1 : curve.degree;
  std::string line = " " + curve.basis + " " + std::to_string(degree);
  appendExactly(line, curve.t0);
  appendExactly(line, curve.t1);
  line += " " + std::to_string(n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (int k = 0; k < 3; ++k) appendExactly(line, curve.points(k, i));
  line += " " + std::to_string(curve.knots.size());
  for (const double knot : curve.knots) appendExactly(line, knot);
  return line;
}

/* What a radius that changes adds. */
std::string growthWords(const CurveDescription &curve) {
  if (curve.radius_polynomial.empty()) return {};
  CurveDescription growth;
  growth.basis = "polynomial";
  growth.degree = curve.radius_polynomial.size();
  growth.t0 = curve.t0;
  growth.t1 = curve.t1;
  growth.points = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(growth.degree) + 1);
  for (std::size_t i = 0; i < growth.degree; ++i)
    growth.points(0, static_cast<Eigen::Index>(i) + 1) = curve.radius_polynomial[i];
  return " growing" + curveWords(growth);
}

/* What is said of the coverage, and of bodies without certificates. */
void addDoubts(const Coverage &coverage, const std::vector<std::string> &unprovable, Problem &out) {
  if (!coverage.complete())
    out.doubt = coverage.message();
  else if (!unprovable.empty())
    out.doubt = unprovable.front();
}

Problem problemFor(const CurveSubject &subject, const Query &query) {
  Problem out;
  const SceneObstacles::Data &data = subject.obstacles.data();
  addDoubts(coverageOf(query, data.coverage, data.items.empty() ? NO_OBJECT : ""), unprovable(subject.obstacles), out);
  if (!out.doubt.empty()) return out;
  out.is_empty = data.items.empty();
  out.text = describeQuery(subject.obstacles, *subject.description);
  return out;
}

Problem problemFor(const MotionSubject &subject, const Query &query) {
  Query of_part = query;
  if (subject.self) of_part.objects.clear();
  Problem out;
  const Asked asked = askedOf(subject.motion, againstOf(subject.self), of_part);
  addDoubts(coverageOf(of_part, asked), unprovable(subject.motion, subject.self, of_part), out);
  if (!out.doubt.empty()) return out;
  out.is_empty = asked.pairs.empty();
  if (!out.is_empty) out.text = problemHead() + describeQuery(subject.motion, subject.self, of_part);
  return out;
}

Problem problemFor(const MoversSubject &subject, const Query &query) {
  Query of_part = query;
  if (!subject.body.empty()) of_part.links = {subject.body};
  const Whom whom = subject.robot ? Whom(*subject.robot) : Whom(subject.against);
  Problem out;
  const Movers::Data &data = subject.movers.data();
  addDoubts(coverageOf(of_part, data.coverage, ""), {}, out);
  if (!out.doubt.empty()) return out;
  out.text = describeQuery(subject.movers, whom, of_part);
  if (out.text.empty())
    out.doubt = "there is nothing to measure, or something is of a kind that has no certificates";
  else
    out.text = problemHead() + out.text;
  return out;
}

} // namespace

std::string describeQuery(const SceneObstacles &obstacles, const CurveDescription &curve) {
  if (!unprovable(curve).empty() || !unprovable(obstacles).empty()) return {};
  return problemHead() + describeObstacles(obstacles) + moverLine(curve);
}

std::string recordOfParts(const std::vector<std::string> &certificates) {
  if (certificates.empty()) return {};
  const auto number = [](std::size_t n) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(n >> (8 * i) & 255);
    return bytes;
  };
  std::string all = "CPCP" + number(certificates.size());
  for (const std::string &one : certificates) all += number(one.size()) + one;
  return all;
}

std::string problemHead() {
  return "cprox-problem 1\n";
}

std::string curveObstacleLines(const CurveDescription &curve, bool synchronized) {
  std::string line = "targets 1\ntarget";
  appendExactly(line, curve.radius);
  if (synchronized) return line + " 0 point 0 0 0 riding" + curveWords(curve) + growthWords(curve) + "\n";
  return line + " 0 curve" + curveWords(curve) + "\n";
}

std::string moverLine(const CurveDescription &curve) {
  std::string line = "mover " + wordOf(curve.id);
  appendExactly(line, curve.radius);
  return line + curveWords(curve) + growthWords(curve) + "\n";
}

std::string noMoverLine(const std::string &id) {
  return "none " + wordOf(id) + "\n";
}

std::string unprovable(const CurveDescription &curve) {
  static constexpr std::array<const char *, 6> bases = {"bezier",   "bspline",  "polynomial",
                                                        "legendre", "lagrange", "trigonometric"};
  if (curve.restrict_t0 != 0.0 || curve.restrict_t1 != 0.0)
    return "a curve that is restricted has no certificate; cut it by its t0 and t1 or its control points";
  for (const char *basis : bases)
    if (curve.basis == basis) return {};
  return "a " + curve.basis + " curve has no certificate";
}

std::string unprovable(const Subject &subject) {
  const auto *motion = std::get_if<MotionSubject>(&subject);
  if (motion && motion->errors) return "an answer about errors has no certificate";
  const auto *curve = std::get_if<CurveSubject>(&subject);
  return curve ? unprovable(*curve->description) : "";
}

Problem problemOf(const Subject &subject, const Query &query) {
  Problem out;
  out.doubt = unprovable(subject);
  if (!out.doubt.empty()) return out;
  out = std::visit([&](const auto &one) { return problemFor(one, query); }, subject);
  if (out.text.empty()) return out;
  const Digest digest = digestOf(out.text.data(), out.text.size());
  std::memcpy(&out.fingerprint, digest.data(), sizeof out.fingerprint);
  return out;
}

} // namespace curve_proximity
