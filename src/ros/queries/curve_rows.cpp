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

/* Where a curve and all that it is measured against stand. */
struct Queries::CurvePlace {
  const Eigen::Isometry3d *frame = nullptr;
  const StampedObstacles::Stamped *stamped = nullptr;
  Coverage coverage;   /* of what is known of them and of its obstacles */
  std::string why_not; /* empty where all is known */
};

/** Ready for the next curve. */
Queries::CurveSearch &Queries::curveSearch(Work &work) {
  const bool by_joints = !work.joints.positions.empty();
  if (!work.search) {
    work.search.reset(new CurveSearch{StampedObstacles(work.snapshot, work.query, live_.srdf,
                                                       by_joints ? &work.joints.positions : nullptr, work.lookup),
                                      WorkspacePool::Lease(workspaces_),
                                      {},
                                      0,
                                      {},
                                      nullptr});
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
      answerPath(path, id, work);
      tellProgress(work);
      continue;
    }
    try {
      Curve curve = toCurve(path, parameters_.path_radius);
      curve.id = id;
      answerCurve(curve, search, work);
    } catch (const Error &error) {
      refuseCurve(id, error.what(), search, work);
    }
    tellProgress(work);
  }
}

Queries::CurvePlace Queries::place(const Curve &curve, CurveSearch &search, Work &work) {
  CurvePlace place;
  try {
    work.lookup.begin();
    place.frame = &work.lookup.toFixed(curve.header.frame_id, curve.header.stamp);
    const double age = work.lookup.age();
    place.stamped = &search.obstacles.at(curve.header.stamp);
    work.doubts.ages(std::fmax(age, place.stamped->age), search.obstacles.withRobot() ? work.joints.age : NAN);
    place.coverage = work.doubts.coverage();
  } catch (const Error &error) {
    place.why_not = error.what();
  }
  return place;
}

/** Adds the rows of one curve. What is wrong with it fails its row only. */
void Queries::answerCurve(const Curve &message, CurveSearch &search, Work &work) {
  if (work.request.turn) work.request.turn->yield();
  const Question &question = work.request.question;
  const CurvePlace where = place(message, search, work);
  try {
    if (!where.why_not.empty()) throw Error(where.why_not);
    Query of_place;
    if (!where.coverage.complete()) of_place = work.query, of_place.coverage = where.coverage;
    const Query &query = where.coverage.complete() ? work.query : of_place;
    const SceneObstacles &obstacles = where.stamped->obstacles;
    if (!work.request.problems && asksFor<question::Search, question::Gradient>(question) &&
        TimeBudget::isOver(query.options.stop_user)) {
      const Row row = stoppedCurve(message.id, question, query);
      fillRow(row.answer, query.query_type, work.response.add(toMessage(row)));
      ++search.curves;
      return;
    }
    toDescription(message, *where.frame, search.description);
    CompiledCurve curve = make(search.description, obstacles.boxes(), query.options, *search.workspace);
    const CurveSubject subject{obstacles, curve, &search.description};
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
      search.drawn = &where.stamped->links;
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
