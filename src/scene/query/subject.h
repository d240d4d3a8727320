/* SPDX-License-Identifier: BSD-3-Clause */
/** What moves, and the one way from a question about it to the rows that answer it. */
#ifndef CURVE_PROXIMITY_SCENE_SUBJECT_H
#define CURVE_PROXIMITY_SCENE_SUBJECT_H

#include <array>
#include <string>
#include <variant>
#include <vector>

#include <curve_proximity/margins.hpp>
#include <curve_proximity/motion.hpp>
#include <curve_proximity/movers.hpp>
#include <curve_proximity/query.hpp>
#include <curve_proximity/robust.hpp>

#include "question.h"

namespace curve_proximity {

/** A curve. A subject refers to what it is about. */
struct CurveSubject {
  const SceneObstacles &obstacles;
  const CompiledCurve &curve;
  const CurveDescription *description = nullptr; /**< what the curve was compiled from: a gradient needs it */
};

/** A robot along a trajectory, or at a state: against the objects, or against itself. */
struct MotionSubject {
  const RobotMotion &motion;
  bool self;
  const ErrorBounds *errors = nullptr; /**< not null: every execution of the motion within these bounds */
};

/** What moves on one clock: one of the robots or a body along its poses against all others, or all of them. */
struct MoversSubject {
  const Movers &movers;
  const MovingRobot *robot = nullptr; /**< the robot, one of the movers; null: see below */
  Against against = Against::OTHERS;  /**< without a robot */
  std::string body;                   /**< the body, one of the movers; empty: without it */
  std::array<double, 2> times{};      /**< [s] from when to when the body is on its way */
};

using Subject = std::variant<CurveSubject, MotionSubject, MoversSubject>;

/** The parameters of the curve, or the times [s], that a profile or a list of violations is about. */
std::array<double, 2> domainOf(const Subject &subject);

/** A part of a subject, and what it is measured against. */
struct Part {
  std::string link;   /**< this link or attached object alone; empty: all that the query names */
  std::string object; /**< likewise */
};

/** The parts that have rows of their own: each link (per_link), each object (Query::per_object), or one for all. A
 *  curve has one: its obstacles say what it is measured against. A search for a curve or a robot among objects that
 *  stand is one part, with a row an object. */
std::vector<Part> partsOf(const Subject &subject, const Question &question, const Query &query, bool per_link);

/** By how much bounds of errors may grow: as in RobustAnswer. */
struct RobustScale {
  double certified, refused;
};

/** What a row has beside its answer; it depends on the question. */
using Detail = std::variant<std::monostate, CurveGradient, ClearanceGradient, std::vector<ClearanceInterval>,
                            Violations, RobustScale, SpeedLimits, std::vector<ObjectMargin>, SweptVolume>;

/** One row of an answer. */
struct Row {
  Part part;     /**< whom it is about */
  Answer answer; /**< as the function that answers the question gives it */
  Detail detail; /**< of all but searches without errors, nearest pairs and times of contact */
};

/** What rows have beside the answer to their question. */
enum class Beside {
  NOTHING, /**< of profiles, violations, speeds and margins Row::answer is as it was made */
  SEARCH   /**< these have the answer of Search, too; an empty list of nearest pairs without a limit is that answer */
};

/** The rows of all parts. The stop function is asked between two of them. Where it wants an end, rows of searches and
 *  profiles of further parts have the status stopped, and know nothing. */
std::vector<Row> answerParts(const Subject &subject, const std::vector<Part> &parts, const Question &question,
                             const Query &query, Beside beside, Workspace &workspace);

/** The row of a curve whose search or gradient does not begin, since the stop function has ended the query before. */
Row stoppedCurve(const std::string &curve, const Question &question, const Query &query);

/** The rows of one part. Throws Error as the function that answers the question for the subject does, and where the
 *  subject has no answer to it. Cost: that of the function. */
std::vector<Row> answer(const Subject &subject, const Part &part, const Question &question, const Query &query,
                        Beside beside, Workspace &workspace);

} // namespace curve_proximity
#endif
