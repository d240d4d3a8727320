/* SPDX-License-Identifier: BSD-3-Clause */
/** Rows of answers. */
#ifndef CURVE_PROXIMITY_ROS_ROW_MESSAGE_H
#define CURVE_PROXIMITY_ROS_ROW_MESSAGE_H

#include <curve_proximity/Gradient.h>
#include <curve_proximity/ObjectMargins.h>
#include <curve_proximity/Profile.h>
#include <curve_proximity/Proximity.h>
#include <curve_proximity/SpeedProfile.h>
#include <curve_proximity/SweptCells.h>
#include <curve_proximity/ViolationIntervals.h>

#include <cstdint>
#include <curve_proximity/query.hpp>
#include <string>
#include <variant>
#include <vector>

#include "../scene/query/certificate_problem.h"
#include "../scene/query/subject.h"

namespace curve_proximity {

/** What a row has beside its results message; nothing for rows without an answer. Summaries are not filled in. */
using DetailMessage =
    std::variant<std::monostate, Gradient, Profile, ViolationIntervals, SpeedProfile, ObjectMargins, SweptCells>;

/** So many violations of one curve or motion are listed at most; where there are more, that is an error. */
constexpr std::size_t MOST_VIOLATIONS = 256;

/** Fills one row of the results, which is as it was made. What has no answer has NaN for numbers. */
void fillRow(const Answer &answer, const Question &question, QueryType query_type, Proximity &message);

/** The detail of a row. trajectory: of a motion whose gradient it is. Throws Error for too many violations. */
DetailMessage toMessage(const Row &row, const TrajectoryDescription *trajectory = nullptr);

/** The row of a curve or motion that could not be asked about. */
Proximity toFailedRow(const std::string &id, const std::string &kind, const std::string &why);

/** Counts the rows that have no answer, and keeps why the first one has none. */
class Failures {
 public:
  void count(const std::string &what) {
    if (failed_++ == 0) first_ = what;
  }

  template <class Response>
  void tell(Response &response) const {
    if (failed_ == 0) return;
    response.success = false;
    response.message =
        std::to_string(failed_) + " of " + std::to_string(response.results.size()) + " rows failed; " + first_;
  }

 private:
  std::size_t failed_ = 0;
  std::string first_;
};

/** A certificate and the fingerprint of what it is about, or why there is none. */
struct Proof {
  std::vector<std::uint8_t> certificate;
  std::uint64_t fingerprint = 0;
  std::string unproven;
};

/** The query, without a certificate where the subject has none. */
Query provable(const Subject &subject, Query query);

/** The proof of a row about a subject: of a profile or of violations those of its parts, else what
 *  query.options.certificate holds. */
Proof takeProof(const Subject &subject, const Query &query, const Row &row);

/** Fills in what a row says of it. */
void addProof(Proof proof, Proximity &row);

/** The problem of a row that could not be asked about. */
Problem doubtful(const std::string &why);

} // namespace curve_proximity
#endif
