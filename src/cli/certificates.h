/* SPDX-License-Identifier: BSD-3-Clause */
/** Files of certificates, and queries as cprox_check reads them. */
#ifndef CURVE_PROXIMITY_CLI_CERTIFICATES_H
#define CURVE_PROXIMITY_CLI_CERTIFICATES_H

#include <memory>
#include <string>
#include <vector>

#include <curve_proximity/query.hpp>

#include "../scene/yaml/yaml_value.h"
#include "exit_code.h"

namespace curve_proximity::cli {

/** The record of one row: a certificate behind its length. Of length 0 where there is no answer or none can be proven.
 */
std::string emptyRecord();

/** A certificate that a query may leave, and its record. */
using CertificateHandle = std::unique_ptr<cprox_certificate, decltype(&cprox_certificate_free)>;
CertificateHandle makeCertificate();
std::string recordOf(const CertificateHandle &certificate);

/** The record of several certificates of one row; of length 0 where there is none. */
std::string recordOf(const std::vector<std::string> &certificates);

/** What it claims, for the column `proof`: "apart", "near", "before", or "none". */
std::string proofOf(const CertificateHandle &certificate);

/** What has no certificates (unprovable() of query.hpp and motion.hpp). */
void warnOfUnprovable(const std::vector<std::string> &messages, Warnings &warnings);

/** Throws BadInput for a curve that cprox_check cannot read: bases other than the six of sums, and restrictions. */
void requireCheckable(const CurveDescription &curve);

} // namespace curve_proximity::cli
#endif
