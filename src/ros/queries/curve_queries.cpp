/* SPDX-License-Identifier: BSD-3-Clause */
/* The rows of a request's curves, by one thread or several. */
#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <iterator>
#include <mutex>
#include <thread>

#include "messages/curve_message.h"
#include "messages/gradient_message.h"
#include "messages/topics.h"
#include "queries/curve_search.h"
#include "queries/row_message.h"
#include "queries/time_budget.h"
#include "transport/guard.h"

namespace curve_proximity {
namespace {

/** Curves that a thread takes at a time. */
constexpr std::size_t A_PART = 8;

/** [bytes] A curve takes no less in a request. */
constexpr std::size_t LEAST_CURVE = 128;

CompiledCurve make(const CurveDescription &curve, CurveBoxes boxes, const cprox_options &options,
                   Workspace &workspace) {
  const WayWhileMaking way(workspace, options);
  return compile(curve, boxes, workspace);
}

} // namespace

/* Where a curve and all that it is measured against stand. */
struct Queries::CurvePlace {
  const Eigen::Isometry3d *frame = nullptr;
  const StampedTargets::Stamped *stamped = nullptr;
  Coverage coverage;   /* of what is known of them and of its obstacles */
  std::string why_not; /* empty where all is known */
};

/* The rows of some curves. */
struct Queries::CurveRows {
  Proximity *in_place = nullptr; /* in the response, which has room for one a curve; null: in `rows` */
  std::vector<Proximity> rows;
  std::vector<std::size_t> counts;            /* of rows, for each curve */
  std::vector<Drawing::Line> lines;           /* of those that are drawn */
  std::vector<Profile> profiles;              /* of Asking::PROFILE: one for each row */
  std::vector<Gradient> gradients;            /* of Asking::GRADIENT likewise */
  std::vector<ViolationIntervals> violations; /* of Asking::VIOLATIONS likewise */

  /* One more, for the curve after those that are counted. */
  Proximity &add() {
    return in_place ? in_place[counts.size()] : rows.emplace_back();
  }

  void fail(const std::string &id, const std::string &why, const Asking &asking) {
    add() = toFailedRow(id, Proximity::KIND_CURVE, why);
    if (asking.kind == Asking::PROFILE) profiles.emplace_back();
    if (asking.kind == Asking::GRADIENT) gradients.emplace_back();
    if (asking.kind == Asking::VIOLATIONS) violations.emplace_back();
  }
};

void Queries::expect(std::size_t bytes) {
  if (bytes >= MANY_CURVES * LEAST_CURVE) crew_.rouse();
}

/** Ready for the next curve. */
Queries::CurveSearch &Queries::curveSearch(Work &work) {
  if (!work.search) {
    const bool by_joints = !work.joints.positions.empty();
    work.search.reset(new CurveSearch{StampedTargets(work.snapshot, work.query, live_.srdf,
                                                     by_joints ? &work.joints.positions : nullptr, work.lookup),
                                      WorkspacePool::Lease(workspaces_),
                                      {},
                                      0,
                                      {},
                                      nullptr});
  }
  work.doubts.objects(work.query);
  return *work.search;
}

void Queries::answerCurves(Work &work) {
  const QueryRequest &request = work.request;
  if (request.curves.size() + request.paths.size() == 0) return;
  CurveSearch &search = curveSearch(work);
  work.response.results.reserve(request.curves.size() + request.paths.size());
  if (request.progress || request.curves.size() < MANY_CURVES) {
    for (const Curve &curve : request.curves) {
      answerCurve(curve, search, work);
      tellProgress(work);
    }
  } else {
    answerManyCurves(search, work);
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
    place.stamped = &search.targets.at(curve.header.stamp);
    work.doubts.ages(std::fmax(age, place.stamped->age), search.targets.withRobot() ? work.joints.age : NAN);
    place.coverage = work.doubts.coverage();
  } catch (const Error &error) {
    place.why_not = error.what();
  }
  return place;
}

/** What is wrong with a curve fails its row only. Any number of threads, each with its own query and workspace. */
void Queries::search(const Curve &message, const CurvePlace &place, const Query &of_all, const Asking &asking,
                     bool drawn, Workspace &workspace, CurveScratch &scratch, CurveRows &out) {
  std::vector<Answer> &answers = scratch.answers;
  answers.clear();
  std::size_t count = 1;
  try {
    if (!place.why_not.empty()) throw Error(place.why_not);
    Query of_place;
    if (!place.coverage.complete()) of_place = of_all, of_place.coverage = place.coverage;
    const Query &query = place.coverage.complete() ? of_all : of_place;
    const Targets &targets = place.stamped->targets;
    toDescription(message, *place.frame, scratch.curve);
    CompiledCurve curve = make(scratch.curve, targets.boxes(), query.options, workspace);
    if (asking.kind == Asking::GRADIENT) {
      CurveClearance clearance = clearanceGradient(targets, curve, scratch.curve, query, workspace);
      answers.push_back(std::move(clearance.answer));
      out.gradients.push_back(toMessage(clearance.gradient));
    } else {
      askCurve(targets, curve, query, asking, workspace, answers);
    }
    if (asking.kind == Asking::PROFILE) out.profiles.push_back(profileOf(targets, curve, query, asking, workspace));
    if (asking.kind == Asking::VIOLATIONS)
      out.violations.push_back(violationsOf(targets, curve, query, asking, workspace));
    for (const Answer &answer : answers) fillRow(answer, query, asking, out.add());
    count = answers.size();
    if (drawn) out.lines.push_back({std::move(curve), std::move(answers)});
  } catch (const Error &error) {
    out.fail(message.id, error.what(), asking);
  }
  out.counts.push_back(count);
}

/** Hands the rows of some curves over, in their order. */
void Queries::gather(const CurvePlace *places, CurveRows &&found, CurveSearch &search, Work &work) {
  Proximity *row = found.in_place ? found.in_place : found.rows.data();
  for (const std::size_t count : found.counts) {
    const CurvePlace &place = *places++;
    for (std::size_t i = 0; i < count; ++i, ++row) {
      if (std::isnan(row->lower)) search.failures.count(*row, search.curves);
      if (!found.in_place) work.response.results.push_back(std::move(*row));
    }
    ++search.curves;
    if (place.stamped && work.drawing.hasRoom()) search.drawn = &place.stamped->links;
  }
  std::move(found.lines.begin(), found.lines.end(), std::back_inserter(work.drawing.lines));
  std::move(found.profiles.begin(), found.profiles.end(), std::back_inserter(work.response.profiles));
  std::move(found.gradients.begin(), found.gradients.end(), std::back_inserter(work.response.gradients));
  std::move(found.violations.begin(), found.violations.end(), std::back_inserter(work.response.violations));
}

void Queries::answerCurve(const Curve &message, CurveSearch &search, Work &work) {
  if (work.request.turn) work.request.turn->yield();
  const CurvePlace where = place(message, search, work);
  CurveRows found;
  Queries::search(message, where, work.query, work.request.asking, work.drawing.hasRoom(), *search.workspace,
                  search.scratch, found);
  gather(&where, std::move(found), search, work);
}

/** The row of what could not be made a curve. */
void Queries::refuseCurve(const std::string &id, const std::string &why, CurveSearch &search, Work &work) {
  CurveRows found;
  found.fail(id, why, work.request.asking);
  found.counts.push_back(1);
  const CurvePlace nowhere;
  gather(&nowhere, std::move(found), search, work);
}

/* Parts of a request's curves that several threads answer. It outlives the request where a thread comes too late. */
struct Queries::SharedRows {
  explicit SharedRows(std::size_t n) : parts(n) {}

  /* The next part that nobody has begun; the request then waits until finish() is called for it. */
  bool claim(std::size_t &part) {
    part = next++;
    return part < parts.size();
  }

  void finish() {
    const std::lock_guard<std::mutex> lock(mutex);
    if (++finished == parts.size()) all_finished.notify_all();
  }

  /* The part at hand cannot be answered, and no other shall be. */
  void fail(const std::string &why) {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      failure = why;
    }
    finish();
    for (std::size_t part; claim(part);) finish();
  }

  /* turn: may be null. */
  void wait(Turn *turn) {
    const auto done = [this] { return finished == parts.size(); };
    // A part takes some 20 us: to sleep meanwhile, and to be woken, takes longer.
    const auto soon = std::chrono::steady_clock::now() + std::chrono::microseconds(100);
    while (std::chrono::steady_clock::now() < soon) {
      if (done()) return;
      std::this_thread::yield();
    }
    std::unique_lock<std::mutex> lock(mutex);
    if (all_finished.wait_for(lock, std::chrono::milliseconds(1), done)) return;
    lock.unlock();
    const Turn::Pause pause(turn); // one that is not done may wait for a turn
    lock.lock();
    all_finished.wait(lock, done);
  }

  std::vector<CurveRows> parts;
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::condition_variable all_finished;
  std::atomic<std::size_t> finished{0};
  std::string failure;
};

/** By several threads, as long as turns are free: each takes the next few curves. */
void Queries::answerManyCurves(CurveSearch &search, Work &work) {
  const List<Curve> &curves = work.request.curves;
  std::vector<CurvePlace> places;
  places.reserve(curves.size());
  for (const Curve &curve : curves) {
    const Curve *before = places.empty() ? nullptr : &curve - 1;
    const bool same =
        before && before->header.frame_id == curve.header.frame_id && before->header.stamp == curve.header.stamp;
    if (same) {
      places.push_back(places.back());
    } else {
      places.push_back(place(curve, search, work));
    }
  }

  const Asking &asking = work.request.asking;
  std::vector<Proximity> &results = work.response.results;
  const std::size_t before = results.size();
  const std::size_t most_drawn = work.drawing.most_lines;
  const bool one_row_each = !work.query.per_object && asking.kind != Asking::NEAREST;
  if (one_row_each) results.resize(before + curves.size());
  const auto rows = std::make_shared<SharedRows>((curves.size() + A_PART - 1) / A_PART);
  const auto answerParts = [&, rows = rows.get()](std::size_t part, const Query &query, Turn *turn,
                                                  Workspace &workspace, CurveScratch &scratch) {
    for (bool claimed = true; claimed;) {
      const std::size_t first = part * A_PART, last = std::min(first + A_PART, curves.size());
      CurveRows &out = rows->parts[part];
      if (one_row_each) out.in_place = &results[before + first];
      out.counts.reserve(last - first);
      if (first < most_drawn) out.lines.reserve(last - first);
      for (std::size_t i = first; i < last; ++i) {
        if (turn) turn->yield();
        Queries::search(curves.begin()[i], places[i], query, asking, i < most_drawn, workspace, scratch, out);
      }
      claimed = rows->claim(part); // before the request may go on without this thread
      rows->finish();
    }
  };
  const auto fail = [rows](const std::string &why) { rows->fail(why); };

  // What belongs to this request is touched by those alone that it waits for: they have claimed a part.
  Turn *const own = work.request.turn;
  const auto help = [&, this](std::size_t part, Turn *turn) {
    TimeBudget budget(work.budget_ms, work.request, stop_, turn);
    Query query = work.query;
    query.options.stop_user = &budget;
    const WorkspacePool::Lease workspace(workspaces_);
    CurveScratch scratch;
    answerParts(part, query, turn, *workspace, scratch);
  };
  const std::size_t most = own ? std::min(crew_.most(), 2 * curves.size() / MANY_CURVES - 1) : 0;
  for (std::size_t i = 0; i < most; ++i) {
    const bool offered = crew_.offer([rows, fail, &help, others = own->others()] {
      if (rows->next >= rows->parts.size()) return;
      const std::unique_ptr<Turn> turn = others();
      std::size_t part = 0;
      if (turn && rows->claim(part)) guarded([&] { help(part, turn.get()); }, fail);
    });
    if (!offered) break;
  }
  guarded(
      [&] {
        std::size_t part = 0;
        if (rows->claim(part)) answerParts(part, work.query, own, *search.workspace, search.scratch);
      },
      fail);
  rows->wait(own);
  if (!rows->failure.empty()) {
    results.resize(before);
    throw Error(rows->failure);
  }
  for (std::size_t part = 0; part < rows->parts.size(); ++part)
    gather(&places[part * A_PART], std::move(rows->parts[part]), search, work);
}

} // namespace curve_proximity
