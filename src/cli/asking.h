/* SPDX-License-Identifier: BSD-3-Clause */
/** Profiles, nearest pairs, times of contact and violations, of curves and of robots alike. */
#ifndef CURVE_PROXIMITY_CLI_ASKING_H
#define CURVE_PROXIMITY_CLI_ASKING_H

#include <array>
#include <string>
#include <vector>

#include <curve_proximity/motion.hpp>
#include <curve_proximity/query.hpp>

#include "arguments.h"
#include "results.h"
#include "run.h"

namespace curve_proximity::cli {

/** What moves, and what of it and of the scene is asked about. Immutable. */
class Subject {
 public:
  /** For the columns id and kind, and for complaints: "curves.csv: row 3 (line 5, id 'a')". */
  std::string id, kind, place;
  std::string link;   /**< rows are about this link or attached object alone; empty: about all */
  std::string object; /**< likewise: about this object, or this link that a curve meets */

  virtual ~Subject() = default;
  virtual std::array<double, 2> domain() const = 0;
  virtual std::vector<Answer> nearest(const PairLimits &limits, const Query &query, Workspace &workspace) const = 0;
  virtual std::vector<ClearanceInterval> profile(const std::vector<double> &breaks, double horizon, const Query &query,
                                                 Workspace &workspace) const = 0;
  virtual Answer contact(const Query &query, Workspace &workspace) const = 0;
  /** Distance, tolerance or collision: a row, or one for each object. */
  virtual std::vector<Answer> search(const Query &query, Workspace &workspace) const = 0;
  virtual Violations violations(double resolution, const Query &query, Workspace &workspace) const = 0;
};

/** A curve; both arguments are kept by reference. */
class CurveSubject : public Subject {
 public:
  CurveSubject(const Targets &targets, const CompiledCurve &curve) : targets_(targets), curve_(curve) {
    kind = "curve";
    id = curve.id;
  }
  std::array<double, 2> domain() const override;
  std::vector<Answer> nearest(const PairLimits &limits, const Query &query, Workspace &workspace) const override;
  std::vector<ClearanceInterval> profile(const std::vector<double> &breaks, double horizon, const Query &query,
                                         Workspace &workspace) const override;
  Answer contact(const Query &query, Workspace &workspace) const override;
  std::vector<Answer> search(const Query &query, Workspace &workspace) const override;
  Violations violations(double resolution, const Query &query, Workspace &workspace) const override;

 private:
  const Targets &targets_;
  const CompiledCurve &curve_;
};

/** A robot along a trajectory, against the scene or `self`; kept by reference. */
class MotionSubject : public Subject {
 public:
  MotionSubject(const RobotMotion &motion, bool self) : motion_(motion), self_(self) {
    kind = self ? "self" : "environment";
  }
  std::array<double, 2> domain() const override;
  std::vector<Answer> nearest(const PairLimits &limits, const Query &query, Workspace &workspace) const override;
  std::vector<ClearanceInterval> profile(const std::vector<double> &breaks, double horizon, const Query &query,
                                         Workspace &workspace) const override;
  Answer contact(const Query &query, Workspace &workspace) const override;
  std::vector<Answer> search(const Query &query, Workspace &workspace) const override;
  Violations violations(double resolution, const Query &query, Workspace &workspace) const override;

 private:
  Query named(const Query &query) const;

  const RobotMotion &motion_;
  const bool self_;
};

/** Where the intervals of a profile begin and end: --breaks, or --intervals of equal length, whose first and last are
 *  exactly those of the domain. */
std::vector<double> breaksOf(const Arguments &arguments, const std::array<double, 2> &domain);

/** The first line of the results, with its newline. */
std::string headerOf(const Arguments &arguments);

/** The columns that the results have beyond the common ones. */
Columns columnsOf(const Arguments &arguments);

/** The rows that arguments.asking asks for, without certificates, added to `out`. Never throws. */
void answer(const Subject &subject, const Arguments &arguments, const Query &query, Workspace &workspace, Outcome &out);

/** Adds a row without an answer, and the complaint that says why. */
void addFailure(const Subject &subject, const Arguments &arguments, cprox_status status, const std::string &why,
                Outcome &out);

/** In an answer about one link that link is side a. */
void putLinkFirst(const std::string &link, Answer &answer);

} // namespace curve_proximity::cli
#endif
