/* SPDX-License-Identifier: BSD-3-Clause */
#include "gate/proof_check.h"

#include <cstddef>
#include <sstream>

#include "../../check/prove.h"

namespace curve_proximity {
namespace {

/** Why the row does not prove that the problem's mover stays farther than delta; empty: it does. */
std::string doubtOf(const Problem &problem, const Proximity &row, double delta) {
  if (!problem.doubt.empty()) return problem.doubt;
  if (problem.is_empty) return "";
  if (row.certificate.empty()) return row.message.empty() ? "it has no certificate" : row.message;
  const proof found = prove(problem.text.data(), problem.text.size(), row.certificate.data(), row.certificate.size());
  if (found.apart && found.delta >= delta) return "";
  std::ostringstream text;
  text.precision(4);
  if (found.apart)
    text << "its certificate proves " << found.delta << " m alone";
  else if (found.near)
    text << "its certificate proves that it comes as near as " << found.delta << " m";
  else
    text << "its certificate is refused: " << found.fault;
  if (row.problem_fingerprint != problem.fingerprint)
    text << "; the server's scene, robot or motion is not the gate's (another fingerprint)";
  return text.str();
}

} // namespace

std::string ProofCheck::doubt(const ProximityQuery &query, const std::vector<Proximity> &rows, double delta) const {
  const std::vector<Problem> wanted = problems(query);
  if (wanted.empty()) return "there is nothing to prove";
  if (wanted.size() != rows.size())
    return "the server has answered with " + std::to_string(rows.size()) + " rows, where " +
           std::to_string(wanted.size()) + " are to be proven";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string why = doubtOf(wanted[i], rows[i], delta);
    if (!why.empty()) return "row '" + rows[i].id + "' (" + rows[i].kind + ") is not proven: " + why;
  }
  return "";
}

} // namespace curve_proximity
