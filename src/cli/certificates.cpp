/* SPDX-License-Identifier: BSD-3-Clause */
#include "certificates.h"

#include <new>

#include "../scene/query/certificate_problem.h"
#include "exit_code.h"

namespace curve_proximity::cli {
namespace {

std::string recordOfBytes(const void *bytes, std::size_t size) {
  std::string record;
  for (int i = 0; i < 4; ++i) record += static_cast<char>(size >> (8 * i) & 255);
  return record.append(static_cast<const char *>(bytes), size);
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

std::string recordOf(const std::vector<std::string> &certificates) {
  const std::string all = recordOfParts(certificates);
  return recordOfBytes(all.data(), all.size());
}

std::string proofOf(const CertificateHandle &certificate) {
  switch (cprox_certificate_get_info(certificate.get()).claim) {
    case CPROX_CLAIM_APART: return "apart";
    case CPROX_CLAIM_NEAR: return "near";
    case CPROX_CLAIM_BEFORE: return "before";
    case CPROX_CLAIM_DURING: return "during";
    case CPROX_CLAIM_NONE: break;
  }
  return "none";
}

void warnOfUnprovable(const std::vector<std::string> &messages, Warnings &warnings) {
  for (const std::string &message : messages) warnings.add(message + "; no row can be proven");
}

void requireCheckable(const CurveDescription &curve) {
  const std::string why = unprovable(curve);
  if (!why.empty()) throw BadInput(why);
}

} // namespace curve_proximity::cli
