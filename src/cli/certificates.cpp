/* SPDX-License-Identifier: BSD-3-Clause */
#include "certificates.h"

#include <algorithm>
#include <new>

#include "failure.h"

namespace curve_proximity::cli {
namespace {

std::string recordOfBytes(const void *bytes, std::size_t size) {
  std::string record;
  for (int i = 0; i < 4; ++i) record += static_cast<char>(size >> (8 * i) & 255);
  return record.append(static_cast<const char *>(bytes), size);
}

void appendExactly(std::string &line, double value) {
  char text[40];
  std::snprintf(text, sizeof text, " %a", value);
  line += text;
}

/* An id is one word there. */
std::string wordOf(const std::string &id) {
  std::string word = id.empty() ? "-" : id;
  std::replace_if(
      word.begin(), word.end(), [](unsigned char c) { return c <= ' '; }, '_');
  return word;
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

} // namespace

std::string emptyRecord() {
  return recordOfBytes("", 0);
}

CertificateHandle makeCertificate() {
  CertificateHandle made(cprox_certificate_create(), cprox_certificate_free);
  if (!made) throw std::bad_alloc();
  return made;
}

std::string recordOf(const CertificateHandle &certificate) {
  const cprox_certificate_info info = cprox_certificate_get_info(certificate.get());
  return recordOfBytes(info.bytes, info.size);
}

std::string proofOf(const CertificateHandle &certificate) {
  switch (cprox_certificate_get_info(certificate.get()).claim) {
    case CPROX_CLAIM_APART: return "apart";
    case CPROX_CLAIM_NEAR: return "near";
    case CPROX_CLAIM_BEFORE: return "before";
    case CPROX_CLAIM_NONE: break;
  }
  return "none";
}

void warnOfUnprovable(const std::vector<std::string> &sentences, Warnings &warnings) {
  for (const std::string &sentence : sentences) warnings.add(sentence + "; no row can be proven");
}

std::string problemHead() {
  return "cprox-problem 1\n";
}

std::string curveTargetLines(const CurveDescription &curve) {
  std::string line = "targets 1\ntarget";
  appendExactly(line, curve.radius);
  return line + " 0 curve" + curveWords(curve) + "\n";
}

std::string moverLine(const CurveDescription &curve) {
  std::string line = "mover " + wordOf(curve.id);
  appendExactly(line, curve.radius);
  return line + curveWords(curve) + "\n";
}

void requireCheckable(const CurveDescription &curve) {
  static constexpr const char *bases[] = {"bezier", "bspline", "polynomial", "legendre", "lagrange", "trigonometric"};
  if (curve.restrict_t0 != 0.0 || curve.restrict_t1 != 0.0)
    throw BadInput("a curve that is restricted has no certificate; cut it by its t0 and t1 or its control points");
  if (!curve.radius_polynomial.empty()) throw BadInput("a curve whose radius changes has no certificate");
  for (const char *basis : bases)
    if (curve.basis == basis) return;
  throw BadInput("a " + curve.basis + " curve has no certificate");
}

std::string noMoverLine(const std::string &id) {
  return "none " + wordOf(id) + "\n";
}

} // namespace curve_proximity::cli
