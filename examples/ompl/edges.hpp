/* SPDX-License-Identifier: BSD-3-Clause */
/** Edges of a roadmap as OMPL sees them: a straight line between two joint positions, free or not. */
#ifndef EXAMPLES_OMPL_EDGES_HPP
#define EXAMPLES_OMPL_EDGES_HPP

#include <ompl/base/MotionValidator.h>
#include <ompl/base/StateValidityChecker.h>

#include <curve_proximity/roadmap.hpp>
#include <memory>
#include <string>
#include <vector>

/** What is planned, and what all checks share: a robot in a scene, its joints, how far away everything must stay. */
struct Task {
  std::vector<std::string> joints;
  curve_proximity::JointPositions rest; /**< of the other joints */
  double clearance = 0.001;             /**< [m] from the scene and between links */
  std::vector<double> start, goal;      /**< of the joints */
  std::shared_ptr<const curve_proximity::EdgeChecker> checker;
};

/** Is the robot farther than the clearance from the scene and from itself, everywhere between two joint positions?
 *  Proven, not sampled: undecided counts as no. */
bool isClear(const Task &task, const double *from, const double *to, curve_proximity::Workspace &workspace);

/** The same at states alone, from the end to the beginning, at most `step` rad apart: what planners usually ask. */
bool isClearAtSamples(const Task &task, const double *from, const double *to, double step,
                      curve_proximity::Workspace &workspace);

/** The continuous check, for ompl::base::SpaceInformation::setMotionValidator(). */
class CertifiedMotionValidator : public ompl::base::MotionValidator {
 public:
  CertifiedMotionValidator(const ompl::base::SpaceInformationPtr &information, const Task &task)
      : MotionValidator(information), task_(task) {}

  bool checkMotion(const ompl::base::State *from, const ompl::base::State *to) const override;

  /** The last valid state is always `from`: what is proven is proven of whole edges. */
  bool checkMotion(const ompl::base::State *from, const ompl::base::State *to,
                   std::pair<ompl::base::State *, double> &last_valid) const override;

 private:
  const Task &task_;
  mutable curve_proximity::Workspace workspace_;
};

/** The check of a single state: an edge of length 0. OMPL's own validator samples edges with it. */
class StateChecker : public ompl::base::StateValidityChecker {
 public:
  StateChecker(const ompl::base::SpaceInformationPtr &information, const Task &task)
      : StateValidityChecker(information), task_(task) {}

  bool isValid(const ompl::base::State *state) const override;

 private:
  const Task &task_;
  mutable curve_proximity::Workspace workspace_;
};

#endif
