/* SPDX-License-Identifier: BSD-3-Clause */
/** Files of certificates, and questions as cprox_check reads them. */
#ifndef CURVE_PROXIMITY_CLI_CERTIFICATES_H
#define CURVE_PROXIMITY_CLI_CERTIFICATES_H

#include <memory>
#include <string>
#include <vector>

#include <curve_proximity/query.hpp>

namespace curve_proximity::cli {

/** The record of one row: a certificate behind its length. Of length 0 where there is no answer or none can be proven. */
std::string emptyRecord();

/** A certificate that a query may leave, and its record. */
using CertificateHandle = std::unique_ptr<cprox_certificate, decltype(&cprox_certificate_free)>;
CertificateHandle makeCertificate();
std::string recordOf(const CertificateHandle &certificate);

/** The record of an answer. result.target_index is that among the targets. */
std::string certificateRecord(const CompiledCurve &curve, const std::vector<cprox_target> &targets,
                              const cprox_result &result, const Question &question, Workspace &workspace);

/** Lines of a problem, see doc/certificates.md. */
std::string problemHead();
std::string targetLines(
    const std::vector<cprox_target> &targets); /**< throws BadUsage for kinds without certificates */
std::string curveTargetLines(const CurveDescription &curve);
std::string moverLine(const CurveDescription &curve);
std::string noMoverLine(const std::string &id);

} // namespace curve_proximity::cli
#endif
