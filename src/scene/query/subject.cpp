/* SPDX-License-Identifier: BSD-3-Clause */
#include "subject.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "answering.h"
#include "motion/motion_data.h"
#include "motion/movers_data.h"

namespace curve_proximity {
namespace {

/* Calls with what a function about the subject takes first. */
template <class Call>
auto about(const CurveSubject &subject, const Call &call) {
  return call(subject.obstacles, subject.curve);
}
template <class Call>
auto about(const MotionSubject &subject, const Call &call) {
  return call(subject.motion, subject.self);
}
template <class Call>
auto about(const MoversSubject &subject, const Call &call) {
  return call(subject.movers, subject.robot ? Whom(*subject.robot) : Whom(subject.against));
}

template <class Call>
auto about(const Subject &subject, const Call &call) {
  return std::visit([&](const auto &one) { return about(one, call); }, subject);
}

std::vector<Answer> searched(const CurveSubject &subject, const Query &query, Workspace &workspace) {
  return ask(subject.obstacles, subject.curve, query, workspace);
}
std::vector<Answer> searched(const MotionSubject &subject, const Query &query, Workspace &workspace) {
  if (subject.self) return {askSelf(subject.motion, query, workspace)};
  return askEnvironment(subject.motion, query, workspace);
}
std::vector<Answer> searched(const MoversSubject &subject, const Query &query, Workspace &workspace) {
  return {about(subject, [&](const auto &movers, const auto &whom) { return ask(movers, whom, query, workspace); })};
}

Row differentiated(const CurveSubject &subject, const Query &query, Workspace &workspace) {
  CurveClearance out = clearanceGradient(subject.obstacles, subject.curve, *subject.description, query, workspace);
  return {{}, std::move(out.answer), std::move(out.gradient)};
}
Row differentiated(const MotionSubject &subject, const Query &query, Workspace &workspace) {
  const RobotPairs pairs = subject.self ? RobotPairs::SELF : RobotPairs::ENVIRONMENT;
  ClearanceRow out = clearanceGradient(subject.motion, pairs, query, workspace);
  return {{}, std::move(out.answer), std::move(out.gradient)};
}
Row differentiated(const MoversSubject &subject, const Query &query, Workspace &workspace) {
  if (!subject.robot) throw Error("gradients among what moves are by a trajectory of the robot: ask about one");
  ClearanceRow out = clearanceGradient(subject.movers, *subject.robot, query, workspace);
  return {{}, std::move(out.answer), std::move(out.gradient)};
}

/* The query of one part. */
void narrow(const CurveSubject &, const Part &, const Question &question, Query &query) {
  if (!asksFor<question::Search>(question)) query.per_object = false;
}
void narrow(const MotionSubject &subject, const Part &part, const Question &question, Query &query) {
  if (subject.self) query.objects.clear(); // the robot itself is none of them, and is one row
  if (subject.self || !asksFor<question::Search>(question)) query.per_object = false;
  if (!part.link.empty()) query.links = {part.link};
  if (!part.object.empty()) query.objects = {part.object};
}
void narrow(const MoversSubject &subject, const Part &part, const Question &question, Query &query) {
  query.per_object = false;
  if (!part.link.empty()) query.links = {part.link};
  if (!part.object.empty()) query.objects = {part.object};
  if (subject.body.empty()) return;
  query.links = {subject.body};
  const bool has_breaks = asksFor<question::Profile>(question); // they say which times
  if (subject.times[0] < subject.times[1] && !has_breaks) query.options.interval = subject.times.data();
}

/* What a part can be measured against by name. */
std::vector<std::string> objectsOf(const CurveSubject &, const Query &) {
  return {""};
}
std::vector<std::string> objectsOf(const MotionSubject &subject, const Query &query) {
  std::vector<std::string> out = query.objects;
  if (out.empty())
    for (const auto &object : subject.motion.snapshot()->objects()) out.push_back(object.first);
  if (out.empty()) out.emplace_back();
  return out;
}
std::vector<std::string> objectsOf(const MoversSubject &subject, const Query &query) {
  if (!query.objects.empty()) return query.objects;
  std::vector<std::string> out;
  const Movers::Data &data = subject.movers.data();
  for (const auto &object : data.snapshot->objects()) out.push_back(object.first);
  for (const auto &object : data.snapshot->moving()) out.push_back(object.first);
  for (const std::string &robot : data.robot_names)
    if (!subject.robot || robot != subject.robot->name) out.push_back(robot);
  return out;
}

std::vector<std::string> linksOf(const CurveSubject &, const Query &) {
  return {""};
}
std::vector<std::string> linksOf(const MotionSubject &subject, const Query &query) {
  std::vector<std::string> out =
      query.links.empty() ? askedNames(subject.motion, subject.self, query.moving_only) : query.links;
  if (out.empty()) out.emplace_back();
  return out;
}
std::vector<std::string> linksOf(const MoversSubject &subject, const Query &query) {
  if (!subject.robot) return {""};
  return query.links.empty() ? movingNames(*subject.robot->motion) : query.links;
}

/* Does a search have a row for each object by itself? */
bool partsObjects(const Subject &subject, const Question &question) {
  const auto *motion = std::get_if<MotionSubject>(&subject);
  if (motion && motion->self) return true;
  return asksFor<question::Search>(question) && !std::holds_alternative<MoversSubject>(subject);
}

std::array<double, 2> domain(const CurveSubject &subject) {
  const cprox_curve_info info = cprox_curve_get_info(subject.curve.curve.get());
  return {info.t0, info.t1};
}
std::array<double, 2> domain(const MotionSubject &subject) {
  return subject.motion.domain();
}
std::array<double, 2> domain(const MoversSubject &subject) {
  if (subject.times[0] < subject.times[1]) return subject.times;
  if (!subject.robot || subject.robot->motion->stands()) return subject.movers.domain();
  const std::array<double, 2> own = subject.robot->motion->domain();
  return {own[0] + subject.robot->start, own[1] + subject.robot->start};
}

/* The profile of what no search was begun for. */
std::vector<ClearanceInterval> unmeasured(const std::vector<double> &breaks, const Answer &answer) {
  std::vector<ClearanceInterval> out = profileOfNothing(breaks);
  for (ClearanceInterval &one : out) one.lower = answer.result.lower, one.status = CPROX_STOPPED, one.gap = answer.gap;
  return out;
}

/* The motion that questions about a robot among objects that stand are about. */
const RobotMotion &motionAmongObjects(const Subject &subject, const char *question) {
  const auto *motion = std::get_if<MotionSubject>(&subject);
  if (!motion || motion->self)
    throw Error(std::string(question) + " are about a robot along a trajectory and objects that stand");
  return motion->motion;
}

/* The cover, or that there is none. */
Row swept(const RobotMotion &motion, SweepOptions options, const Query &query) {
  const Clock::time_point start = Clock::now();
  options.stop = query.options.stop, options.stop_user = query.options.stop_user;
  Row out;
  Answer &answer = out.answer;
  answer.kind = "environment";
  answer.result.obstacle_index = -1;
  answer.result.upper = INFINITE;
  answer.result.verdict = CPROX_VERDICT_UNDECIDED;
  try {
    out.detail = sweptVolume(motion, options);
  } catch (const Error &error) {
    if (error.status() != CPROX_STOPPED) throw;
    answer.result.status = CPROX_STOPPED;
    SweptVolume nothing;
    nothing.resolution = options.resolution;
    nothing.gap = INFINITE;
    out.detail = std::move(nothing);
  }
  answer.status = cprox_status_name(answer.result.status);
  answer.microseconds = microsecondsSince(start);
  applyCoverage(coverageOf(query, motion.data().coverage, ""), query, answer);
  return out;
}

/* The rows of one question about one part of a subject. */
class Answering {
 public:
  Answering(const Subject &subject, const Part &part, const Query &query, Beside beside, Workspace &workspace)
      : subject_(subject), part_(part), query_(query), beside_(beside), workspace_(workspace) {
    const auto *motion = std::get_if<MotionSubject>(&subject);
    if (motion && motion->errors) erring_ = motion;
  }

  void operator()(const question::Search &) {
    if (!erring_) return add(search());
    RobustAnswer found = askRobust(erring_->motion, erring_->self, *erring_->errors, query_, workspace_);
    rows_.push_back({part_, std::move(found.answer), RobustScale{found.certified, found.refused}});
  }
  void operator()(const question::Gradient &) {
    refuseErrors("a gradient");
    rows_.push_back(
        std::visit([&](const auto &subject) { return differentiated(subject, query_, workspace_); }, subject_));
    rows_.back().part = part_;
  }
  void operator()(const question::Nearest &nearest) {
    refuseErrors("a list of nearest pairs");
    std::vector<Answer> pairs = about(subject_, [&](const auto &what, const auto &whom) {
      return nearestPairs(what, whom, nearest.limits, query_, workspace_);
    });
    const bool by_search = pairs.empty() && beside_ == Beside::SEARCH && !std::isfinite(nearest.limits.within);
    add(by_search ? search() : std::move(pairs));
  }
  void operator()(const question::Contact &) {
    if (erring_) {
      constexpr double PART = 1e-4; // of the duration: how near the time is searched for
      const std::array<double, 2> all = erring_->motion.domain();
      const double resolution = all[1] > all[0] ? PART * (all[1] - all[0]) : 1.0;
      return add(
          {robustTimeOfContact(erring_->motion, erring_->self, *erring_->errors, resolution, query_, workspace_)});
    }
    add({about(subject_,
               [&](const auto &what, const auto &whom) { return timeOfContact(what, whom, query_, workspace_); })});
  }
  void operator()(const question::Profile &profile) {
    addDetail([&] { return profiled(profile); });
  }
  void operator()(const question::Violations &violations) {
    refuseErrors("a list of violations");
    constexpr double PART = 1e-3;
    const std::array<double, 2> all = domainOf(subject_);
    const double resolution = violations.resolution > 0.0 ? violations.resolution : PART * (all[1] - all[0]);
    addDetail([&] {
      return about(subject_, [&](const auto &what, const auto &whom) {
        return curve_proximity::violations(what, whom, resolution, query_, workspace_);
      });
    });
  }
  void operator()(const question::Speed &speed) {
    motionAmongObjects(subject_, "limits of the speed");
    addDetail([&] { return limitSpeed(profiled(speed.profile), speed.separation); });
  }
  void operator()(const question::Margins &margins) {
    const RobotMotion &motion = motionAmongObjects(subject_, "margins");
    refuseErrors("a list of margins");
    addDetail([&] { return objectMargins(motion, margins.within, query_, workspace_); });
  }
  void operator()(const question::Sweep &sweep) {
    refuseErrors("a swept volume");
    rows_.push_back(swept(motionAmongObjects(subject_, "swept volumes"), sweep.options, query_));
    rows_.back().part = part_;
  }

  std::vector<Row> rows() {
    return std::move(rows_);
  }

 private:
  void refuseErrors(const char *what) const {
    if (erring_) throw Error(std::string("errors do not apply to ") + what);
  }
  std::vector<ClearanceInterval> profiled(const question::Profile &profile) const {
    const std::vector<double> breaks = breaksOf(profile, domainOf(subject_));
    if (erring_ && profile.horizon == INFINITE)
      return robustProfile(erring_->motion, erring_->self, *erring_->errors, breaks, query_, workspace_);
    if (erring_) throw Error("errors do not apply with a horizon");
    return about(subject_, [&](const auto &what, const auto &whom) {
      return clearanceProfile(what, whom, breaks, query_, workspace_, profile.horizon);
    });
  }
  std::vector<Answer> search() const {
    if (erring_) return {askRobust(erring_->motion, erring_->self, *erring_->errors, query_, workspace_).answer};
    return std::visit([&](const auto &subject) { return searched(subject, query_, workspace_); }, subject_);
  }
  void add(std::vector<Answer> answers) {
    rows_.reserve(rows_.size() + answers.size());
    for (Answer &answer : answers) rows_.push_back({part_, std::move(answer), {}});
  }
  template <class Call>
  void addDetail(const Call &call) {
    Answer summary;
    if (beside_ == Beside::SEARCH) summary = std::move(search().front());
    rows_.push_back({part_, std::move(summary), call()});
  }

  const Subject &subject_;
  const Part &part_;
  const Query &query_;
  const Beside beside_;
  Workspace &workspace_;
  const MotionSubject *erring_ = nullptr; /* null: without errors */
  std::vector<Row> rows_;
};

} // namespace

std::optional<QueryType> queryTypeFromName(const std::string &name) {
  if (name == "distance") return QueryType::DISTANCE;
  if (name == "tolerance") return QueryType::TOLERANCE;
  if (name == "collision") return QueryType::COLLISION;
  return std::nullopt;
}

std::vector<double> breaksOf(const question::Profile &profile, const std::array<double, 2> &domain) {
  if (!profile.breaks.empty()) return profile.breaks;
  std::vector<double> out;
  for (std::size_t i = 0; i < profile.intervals; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(profile.intervals);
    const double next = domain[0] * (1.0 - part) + domain[1] * part;
    if (out.empty() || next > out.back()) out.push_back(next); // a domain may have fewer numbers than intervals
  }
  out.front() = domain[0];
  while (out.size() > 1 && out.back() >= domain[1]) out.pop_back();
  out.push_back(domain[1]);
  return out;
}

std::array<double, 2> domainOf(const Subject &subject) {
  return std::visit([](const auto &one) { return domain(one); }, subject);
}

std::vector<Part> partsOf(const Subject &subject, const Question &question, const Query &query, bool per_link) {
  std::vector<std::string> links{""}, objects{""};
  if (per_link) links = std::visit([&](const auto &one) { return linksOf(one, query); }, subject);
  if (query.per_object && !partsObjects(subject, question))
    objects = std::visit([&](const auto &one) { return objectsOf(one, query); }, subject);
  std::vector<Part> out;
  for (const std::string &link : links)
    for (const std::string &object : objects) out.push_back({link, object});
  return out;
}

Row stoppedCurve(const std::string &curve, const Question &question, const Query &query) {
  Row row{{}, unasked(curve, "curve", query), {}};
  row.answer.a = curve;
  applyCoverage(query.coverage, query, row.answer);
  if (!asksFor<question::Gradient>(question)) return row;
  CurveGradient none;
  none.reason = row.answer.message;
  row.detail = std::move(none);
  return row;
}

std::vector<Row> answerParts(const Subject &subject, const std::vector<Part> &parts, const Question &question,
                             const Query &query, Beside beside, Workspace &workspace) {
  if (parts.size() == 1) return answer(subject, parts.front(), question, query, beside, workspace);
  std::vector<Row> out;
  out.reserve(parts.size());
  for (const Part &part : parts) {
    const bool ended = !out.empty() && query.options.stop && query.options.stop(query.options.stop_user);
    if (ended && asksFor<question::Search, question::Profile>(question)) {
      Row row{part, unasked(out.back().answer.id, out.back().answer.kind, query), {}};
      if (out.back().answer.gap && out.back().answer.gap != Gap::EMPTY) { // this part may have what that one lacks
        row.answer.gap = out.back().answer.gap;
        row.answer.status = out.back().answer.status;
      }
      if (const auto *profile = std::get_if<question::Profile>(&question))
        row.detail = unmeasured(breaksOf(*profile, domainOf(subject)), row.answer);
      out.push_back(std::move(row));
      continue;
    }
    for (Row &row : answer(subject, part, question, query, beside, workspace)) out.push_back(std::move(row));
  }
  return out;
}

std::vector<Row> answer(const Subject &subject, const Part &part, const Question &question, const Query &query,
                        Beside beside, Workspace &workspace) {
  Query own;
  const bool is_whole = std::holds_alternative<CurveSubject>(subject) && !query.per_object;
  if (!is_whole) {
    own = query;
    std::visit([&](const auto &one) { narrow(one, part, question, own); }, subject);
  }
  Answering answering(subject, part, is_whole ? query : own, beside, workspace);
  std::visit(answering, question);
  return answering.rows();
}

} // namespace curve_proximity
