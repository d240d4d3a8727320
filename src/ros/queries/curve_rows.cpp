/* SPDX-License-Identifier: BSD-3-Clause */
/* The rows of a request's curves. */
#include <cmath>

#include "messages/curve_message.h"
#include "messages/topics.h"
#include "queries/curve_search.h"
#include "queries/time_budget.h"

namespace curve_proximity {
namespace {

CompiledCurve make(const CurveDescription &curve, CurveBoxes boxes, const cprox_options &options,
                   Workspace &workspace) {
  const WayWhileMaking way(workspace, options);
  return compile(curve, boxes, workspace);
}

} // namespace

/** Ready for the next curve. */
Queries::CurveSearch &Queries::curveSearch(Work &work) {
  const bool by_joints = !work.joints.positions.empty();
  if (!work.search) {
    work.search.reset(new CurveSearch{StampedObstacles(work.snapshot, work.query, live_.srdf,
                                                       by_joints ? &work.joints.positions : nullptr, work.lookup),
                                      WorkspacePool::Lease(workspaces_)});
  }
  work.doubts.objects(work.query);
  const bool placed = by_joints && work.search->obstacles.withRobot();
  work.doubts.joints(
      placed ? unknownJoints(*work.snapshot->robot(), {}, work.joints.positions, parameters_.assumed_joints) : "");
  return *work.search;
}

void Queries::answerCurves(Work &work) {
  const QueryRequest &request = work.request;
  if (request.curves.size() + request.paths.size() == 0) return;
  CurveSearch &search = curveSearch(work);
  work.response.results.reserve(request.curves.size() + request.paths.size());
  for (const Curve &curve : request.curves) {
    answerCurve(curve, search, work);
    tellProgress(work);
  }
  for (const nav_msgs::Path &path : request.paths) {
    const auto i = static_cast<std::size_t>(&path - request.paths.begin());
    const std::string id = numbered("path", i, request.paths.size());
    if (carriesBody(request)) {
      answerRide(
          id, path.header.frame_id, [&] { return toPoses(path); }, work);
    } else {
      try {
        Curve curve = toCurve(path, parameters_.path_radius);
        curve.id = id;
        answerCurve(curve, search, work);
      } catch (const Error &error) {
        refuseCurve(id, error.what(), search, work);
      }
    }
    tellProgress(work);
  }
}

/** Adds the rows of one curve. What is wrong with it fails its row only. */
void Queries::answerCurve(const Curve &message, CurveSearch &search, Work &work) {
  if (work.request.turn) work.request.turn->yield();
  const Question &question = work.request.question;
  const Query &query = work.query;
  try {
    // Where the curve and all that it is measured against stand, and what is known of them.
    work.lookup.begin();
    const Eigen::Isometry3d &frame = work.lookup.toFixed(message.header.frame_id, message.header.stamp);
    const double age = work.lookup.age();
    const StampedObstacles::Stamped &stamped = search.obstacles.at(message.header.stamp);
    work.doubts.ages(std::fmax(age, stamped.age), search.obstacles.withRobot() ? work.joints.age : NAN);
    work.query.coverage = work.doubts.coverage();
    if (!work.request.problems && asksFor<question::Search, question::Gradient>(question) &&
        TimeBudget::isOver(query.options.stop_user)) {
      const Row row = stoppedCurve(message.id, question, query);
      fillRow(row.answer, question, query.query_type, work.response.add(toMessage(row)));
      ++search.curves;
      return;
    }
    toDescription(message, frame, search.description);
    CompiledCurve curve = make(search.description, stamped.obstacles.boxes(), query.options, *search.workspace);
    const CurveSubject subject{stamped.obstacles, curve, &search.description};
    if (work.request.problems) {
      work.request.problems->push_back(problemOf(subject, query));
      ++search.curves;
      return;
    }
    Query bare;
    if (work.certificate) bare = provable(subject, query);
    std::vector<Row> rows = curve_proximity::answer(subject, {}, question, work.certificate ? bare : query,
                                                    Beside::SEARCH, *search.workspace);
    std::vector<Answer> answers;
    for (Row &found : rows) {
      Proximity &row = work.response.add(toMessage(found));
      fillRow(found.answer, question, query.query_type, row);
      if (work.certificate) addProof(takeProof(subject, query, found), row);
      if (std::isnan(row.lower)) search.fail(row);
      answers.push_back(std::move(found.answer));
    }
    if (work.drawing.hasRoom()) {
      search.drawn = &stamped.links;
      work.drawing.lines.push_back({std::move(curve), std::move(answers)});
    }
  } catch (const Error &error) {
    return refuseCurve(message.id, error.what(), search, work);
  }
  ++search.curves;
}

/** The row of what could not be made a curve, or of a curve that cannot be answered. */
void Queries::refuseCurve(const std::string &id, const std::string &why, CurveSearch &search, Work &work) {
  if (work.request.problems) work.request.problems->push_back(doubtful(why));
  work.response.add() = toFailedRow(id, Proximity::KIND_CURVE, why);
  search.fail(work.response.results.back());
  ++search.curves;
}

} // namespace curve_proximity
