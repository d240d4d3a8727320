/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_yaml.h"

#include "bad_input.h"
#include "body_yaml.h"
#include "motion/curve_basis.h"

namespace curve_proximity::yaml {
namespace {

/* What a curve and a piece have in common. */
void readBasis(const YamlValue &value, CurveDescription &out) {
  out.basis = value.at("basis").text();
  out.t0 = out.t1 = 0.0;
  if (const auto degree = value.find("degree")) out.degree = degree->count();
  if (const auto t0 = value.find("t0")) out.t0 = t0->number();
  if (const auto t1 = value.find("t1")) out.t1 = t1->number();
  if (const auto knots = value.find("knots")) out.knots = knots->numbers();
  if (const auto parameters = value.find("parameters")) out.parameters = parameters->numbers();
  if (out.basis != "piecewise") out.points = readPoints(value, "points");
  try {
    takeWholeRange(out);
  } catch (const Error &error) {
    value.fail(error.what());
  }
}

} // namespace

CurveDescription readCurve(const YamlValue &value, Warnings &warnings) {
  value.warnOfOthers({"header", "id", "basis", "degree", "t0", "t1", "radius", "radius_polynomial", "points", "knots",
                      "parameters", "pieces", "restrict_t0", "restrict_t1"},
                     warnings);
  if (const auto header = value.find("header"))
    if (const auto frame = header->find("frame_id"))
      if (!frame->text().empty() && frame->text() != "world")
        value.fail("frame '" + frame->text() + "': a curve stands in the frame that it is a part of, '' or 'world'");
  CurveDescription out;
  readBasis(value, out);
  if (const auto id = value.find("id")) out.id = id->text();
  if (const auto radius = value.find("radius")) out.radius = radius->number();
  if (const auto more = value.find("radius_polynomial")) out.radius_polynomial = more->numbers();
  if (const auto from = value.find("restrict_t0")) out.restrict_t0 = from->number();
  if (const auto to = value.find("restrict_t1")) out.restrict_t1 = to->number();
  for (const YamlValue &piece : value.itemsOf("pieces")) {
    piece.warnOfOthers({"basis", "degree", "t0", "t1", "points", "knots", "parameters"}, warnings);
    out.pieces.emplace_back();
    readBasis(piece, out.pieces.back());
  }
  return out;
}

} // namespace curve_proximity::yaml
