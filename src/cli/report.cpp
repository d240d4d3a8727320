/* SPDX-License-Identifier: BSD-3-Clause */
/* report: one page that shows how close a trajectory, or curves, come to what is around them. */
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <set>

#include <curve_proximity/robust.hpp>

#include "../scene/base/digest.h"
#include "../scene/yaml/errors_yaml.h"
#include "../scene/yaml/numbers.h"
#include "answers.h"
#include "certificates.h"
#include "commands.h"
#include "csv.h"
#include "exit_code.h"
#include "library.h"
#include "moving_world.h"
#include "report_drawing.h"
#include "report_page.h"
#include "results.h"
#include "trajectory.h"
#include "world_files.h"

namespace curve_proximity::cli {
namespace {

constexpr std::size_t kMostCurves = 50; /* more lines than a chart shows */
constexpr int kMoments = 100;           /* at which the robot is drawn, beside those of the closest pairs */

/* The page's data as they are gathered, and the exit code that they deserve. */
class Report {
 public:
  Report(const Arguments &arguments, const Warnings &warnings, Console &console)
      : arguments_(arguments), warnings_(warnings), console_(console) {
    if (!arguments.errors.empty()) errors_ = yaml::readErrors(arguments.errors);
    for (const char *list : {"verdicts", "profiles", "pairs", "curves", "notes"}) data_[list] = Json::listOf({});
  }

  /** Searches, profiles and pairs of one thing. A part that fails is a note on the page and an error message. */
  void ask(const Asked &asked, Workspace &workspace) {
    attempt(asked, "", [&] { addVerdicts(asked, workspace); });
    const bool is_curve = std::holds_alternative<CurveSubject>(asked.subject);
    for (const Part &part : partsOf(asked.subject, arguments_.profile, arguments_.query, true))
      if (is_curve || !part.link.empty()) attempt(asked, part.link, [&] { addProfile(asked, part, workspace); });
    attempt(asked, "closest pairs", [&] {
      for (const Row &row : answer(asked, {}, arguments_.nearest, plainQuery(), workspace))
        if (!row.answer.b.empty()) addPair(asked, row.answer);
    });
  }

  void addCurve(const CompiledCurve &curve, Workspace &workspace) {
    data_["curves"].items.push_back(drawCurve(curve, workspace));
  }

  void note(const std::string &message) {
    data_["notes"].items.emplace_back(message);
  }

  void failed(const std::string &error_message) {
    failed_ = true;
    note(error_message);
    console_.say(error_message);
  }

  /** The records of all certificates, in the order of the verdicts. */
  const std::string &certificates() const {
    return certificates_;
  }

  /** The moments at which the robot is drawn: evenly, and where a verdict or pair has its witness. */
  std::vector<double> moments(const std::array<double, 2> &domain) const {
    std::set<double> out = witnesses_;
    for (int i = 0; i <= kMoments; ++i) {
      const double share = static_cast<double>(i) / kMoments;
      out.insert(domain[0] * (1.0 - share) + domain[1] * share);
    }
    return {out.lower_bound(domain[0]), out.upper_bound(domain[1])};
  }

  Json &data() {
    return data_;
  }

  int exitCode() {
    if (failed_ || data_["verdicts"].items.empty()) return kUnanswered;
    if (violated_) return kSomeViolated;
    return undecided_ ? kSomeUndecided : kAllAnswered;
  }

 private:
  /* The query of distances. */
  Query plainQuery() const {
    Query query = arguments_.query;
    query.delta = 0.0;
    query.options.stop = interrupted;
    query.coverage = warnings_.coverage();
    return query;
  }

  static std::vector<Row> answer(const Asked &asked, const Part &part, const Question &question, const Query &query,
                                 Workspace &workspace) {
    return curve_proximity::answer(asked.subject, part, question, query, Beside::NOTHING, workspace);
  }

  template <class Step>
  void attempt(const Asked &asked, const std::string &what, const Step &step) {
    try {
      step();
    } catch (const std::bad_alloc &) {
      throw;
    } catch (const std::exception &e) {
      failed(asked.place + ": " + (what.empty() ? "" : what + ": ") + e.what());
    }
  }

  void addVerdicts(const Asked &asked, Workspace &workspace) {
    const bool with_proof = !arguments_.certificate.empty();
    std::vector<QueryType> types{QueryType::DISTANCE};
    if (arguments_.has_delta) types.insert(types.begin(), QueryType::TOLERANCE);
    for (const QueryType type : types) {
      Query query = plainQuery();
      query.query_type = type;
      if (type == QueryType::TOLERANCE) query.delta = arguments_.query.delta;

      // A certificate is about the first query: the verdict, if there is one.
      const CertificateHandle proof = makeCertificate();
      const bool proves = with_proof && type == types.front();
      if (proves) query.options.certificate = proof.get();
      const Answer found = answer(asked, {}, question::Search{}, query, workspace).at(0).answer;
      Json row = toJson(toRow(found, type), asked);
      row["query"] = type == QueryType::TOLERANCE ? "tolerance" : "distance";
      if (proves) {
        const std::string record = recordOf(proof);
        certificates_ += record;
        row["proof"] = proofOf(proof);
        row["certificate"] = toHex(digestOf(record.data(), record.size()));
        if (!found.unproven.empty()) failedProof(asked, found.unproven);
      }
      violated_ = violated_ || row["verdict"].text_value == "violated";
      undecided_ = undecided_ || row["verdict"].text_value == "undecided" || found.gap;
      if (found.result.status < 0) failed(asked.place + ": " + found.message);
      if (found.gap) note(asked.place + ": " + found.message);
      data_["verdicts"].items.push_back(std::move(row));
    }
  }

  void failedProof(const Asked &asked, const std::string &why) {
    failed(asked.place + ": no certificate: " + why);
  }

  void addProfile(const Asked &asked, const Part &part, Workspace &workspace) {
    question::Profile profile = arguments_.profile;
    profile.breaks = breaksOf(profile, domainOf(asked.subject));
    const Row row = answer(asked, part, profile, plainQuery(), workspace).at(0);
    std::vector<double> t, lower, upper;
    std::vector<Json> against;
    std::string ended;
    for (const ClearanceInterval &interval : std::get<std::vector<ClearanceInterval>>(row.detail)) {
      t.push_back(interval.t0);
      lower.push_back(interval.lower);
      upper.push_back(interval.upper);
      against.emplace_back(interval.b == part.link && !part.link.empty() ? interval.a : interval.b);
      if (interval.status != CPROX_OK) ended = cprox_status_text(interval.status);
    }
    t.push_back(profile.breaks.back());
    if (errors_) lowerByErrors(std::get<MotionSubject>(asked.subject), part, profile.breaks, workspace, lower);
    const std::string name = part.link.empty() ? asked.id : part.link;
    if (!ended.empty()) note(asked.place + ": " + name + ": the profile is wider than epsilon: " + ended);
    data_["profiles"].items.push_back(Json::mapOf({{"name", name},
                                                   {"kind", asked.kind},
                                                   {"t", t},
                                                   {"lower", lower},
                                                   {"upper", upper},
                                                   {"against", Json::listOf(std::move(against))}}));
  }

  /* The band of a link goes down to what is certified for every execution. */
  void lowerByErrors(const MotionSubject &subject, const Part &part, const std::vector<double> &breaks,
                     Workspace &workspace, std::vector<double> &lower) const {
    Query query = plainQuery();
    query.links = {part.link};
    const std::vector<ClearanceInterval> robust =
        robustProfile(subject.motion, subject.self, *errors_, breaks, query, workspace);
    for (std::size_t i = 0; i < lower.size(); ++i) lower[i] = std::min(lower[i], robust[i].lower);
  }

  void addPair(const Asked &asked, const Answer &answer) {
    data_["pairs"].items.push_back(toJson(toRow(answer, QueryType::DISTANCE), asked));
  }

  Json toJson(const ResultRow &row, const Asked &asked) {
    const auto point = [](const cprox_vec3 &p) { return Json::listOf({p.x, p.y, p.z}); };
    const bool answered = row.result.status >= 0;
    Json out = Json::mapOf({{"id", asked.id}, {"kind", asked.kind}, {"a", row.a}, {"b", row.b}});
    out["status"] = statusOf(row.result.status, row.gap);
    out["verdict"] = row.has_verdict && answered ? Json(cprox_verdict_name(row.result.verdict)) : Json();
    out["lower"] = answered ? Json(row.result.lower) : Json();
    out["upper"] = answered ? Json(row.result.upper) : Json();
    out["t"] = answered && row.has_t ? Json(row.result.t) : Json();
    if (answered && row.has_points) {
      out["points"] = Json::listOf({point(row.result.witness_mover), point(row.result.witness_obstacle)});
      if (row.has_t && std::isfinite(row.result.t)) witnesses_.insert(row.result.t);
    }
    out["nodes"] = row.result.nodes;
    out["microseconds"] = row.microseconds;
    out["message"] = row.message;
    return out;
  }

  const Arguments &arguments_;
  const Warnings &warnings_;
  Console &console_;
  std::optional<ErrorBounds> errors_;
  Json data_ = Json::mapOf({});
  std::string certificates_;
  std::set<double> witnesses_;
  bool failed_ = false, violated_ = false, undecided_ = false;
};

std::string fileName(const std::string &path) {
  return std::filesystem::path(path).filename().string();
}

/* "panda.urdf along reach.yaml in shelf.yaml" */
std::string titleOf(const Arguments &arguments) {
  std::string out = fileName(arguments.curves);
  if (!arguments.trajectory.empty()) out = fileName(arguments.robot) + " along " + fileName(arguments.trajectory);
  if (!arguments.scene.empty()) out += " in " + fileName(arguments.scene);
  return out;
}

/* As a shell takes it: what it would read otherwise stands in quotes. */
std::string shellWord(const std::string &word) {
  const auto plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("-_./=:,+@%", c); };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string commandOf(const Arguments &arguments) {
  std::string out = "cprox";
  for (const std::string &word : arguments.words) out += " " + shellWord(word);
  return out;
}

/* Now, or where pages are to be the same again SOURCE_DATE_EPOCH. */
std::string dateNow() {
  const char *fixed = std::getenv("SOURCE_DATE_EPOCH");
  const std::optional<std::uint64_t> epoch = fixed ? yaml::parseCount(fixed) : std::nullopt;
  const std::time_t now = epoch ? static_cast<std::time_t>(*epoch) : std::time(nullptr);
  std::tm parts{};
  char text[32] = "";
  if (gmtime_r(&now, &parts)) std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S UTC", &parts);
  return text;
}

std::string hostName() {
  char name[256] = "";
  return gethostname(name, sizeof name - 1) == 0 && *name ? name : "an unnamed host";
}

/* What the answers rest on: the files by their content, and what was asked. */
void addBasis(const Arguments &arguments, const World &world, Report &report) {
  Json &data = report.data();
  data["title"] = titleOf(arguments);
  data["version"] = CPROX_VERSION;
  data["date"] = dateNow();
  data["host"] = hostName();
  data["command"] = commandOf(arguments);
  data["epsilon"] = arguments.query.options.epsilon;
  data["delta"] = arguments.has_delta ? Json(arguments.query.delta) : Json();
  data["unit"] = arguments.trajectory.empty() ? "" : "s";
  data["self"] = arguments.self;
  data["errors"] = !arguments.errors.empty();
  data["objects"] = world.snapshot->objects().size() + world.snapshot->moving().size();
  data["inputs"] = Json::listOf({});
  const std::pair<const char *, const std::string *> inputs[] = {
      {"robot", &arguments.robot},   {"SRDF", &arguments.srdf},   {"trajectory", &arguments.trajectory},
      {"curves", &arguments.curves}, {"scene", &arguments.scene}, {"errors", &arguments.errors}};
  for (const auto &[what, path] : inputs) {
    if (path->empty()) continue;
    data["inputs"].items.push_back(
        Json::mapOf({{"what", what}, {"file", *path}, {"digest", digestOfFile(*path, true)}}));
  }
  for (const std::string &message : world.skipped) report.note(message);
}

void askTrajectory(const Arguments &arguments, const World &world, Report &report, Warnings &warnings) {
  const auto motion = std::make_shared<const RobotMotion>(readMotion(arguments, world, warnings));
  for (const std::string &message : motion->warnings()) report.note(message);
  for (const std::string &message : motion->skipped()) report.note(message);
  std::optional<MovingWorld> moving;
  if (world.moves()) moving = gatherMovers(arguments, world, motion);
  Workspace workspace;
  if (moving)
    report.ask(askedAmong(*moving, arguments), workspace);
  else if (!arguments.scene.empty() || !arguments.self)
    report.ask(askedAlong(*motion, false, arguments), workspace);
  if (arguments.self) report.ask(askedAlong(*motion, true, arguments), workspace);
  const std::array<double, 2> domain = motion->domain();
  const std::vector<double> moments = report.moments(domain);
  report.data()["domain"] = Json::listOf({domain[0], domain[1]});
  drawWorld(world, motion.get(), moments, report.data());
  if (moving) drawMovers(world, *moving, moments, report.data());
}

void askCurves(const Arguments &arguments, const World &world, Report &report) {
  const SceneObstacles obstacles(world.snapshot, world.links, arguments.query);
  Workspace workspace;
  CsvFile file(arguments.curves);
  std::array<double, 2> all{INFINITY, -INFINITY};
  std::size_t count = 0;
  while (const std::optional<CsvRow> row = file.next()) {
    if (++count > kMostCurves)
      throw BadUsage(arguments.curves + ": a report shows at most " + std::to_string(kMostCurves) + " curves");
    const std::string place = placeOf(*row, arguments.curves);
    try {
      const CurveDescription description = parseCurve(row->text);
      if (!arguments.certificate.empty()) requireCheckable(description);
      const CompiledCurve curve = compile(description);
      const Asked asked{CurveSubject{obstacles, curve}, curve.id, "curve", place, {}};
      report.ask(asked, workspace);
      report.addCurve(curve, workspace);
      const std::array<double, 2> domain = domainOf(asked.subject);
      all = {std::min(all[0], domain[0]), std::max(all[1], domain[1])};
    } catch (const Error &e) {
      report.failed(place + ": " + e.what());
    } catch (const BadInput &e) {
      report.failed(place + ": " + e.what());
    }
  }
  if (count == 0) throw BadUsage(arguments.curves + ": there is no curve in it");
  if (all[0] > all[1]) all = {0.0, 1.0};
  report.data()["domain"] = Json::listOf({all[0], all[1]});
  drawWorld(world, nullptr, {all[0]}, report.data());
}

} // namespace

int writeReport(const Arguments &arguments, Console &console) {
  Warnings warnings;
  const bool standing = arguments.trajectory.empty() || !arguments.certificate.empty() || !arguments.errors.empty();
  const char *what = arguments.trajectory.empty()    ? "a report of curves"
                     : arguments.certificate.empty() ? "--errors"
                                                     : "--certificate";
  const World world = standing ? readStandingWorld(arguments, what, warnings) : readWorld(arguments, warnings);
  reportPage("", ""); /* before any search: is all there that the page needs? */
  ResultsFile page(arguments.out, inputsOf(arguments));
  std::optional<ResultsFile> certificates;
  if (!arguments.certificate.empty()) certificates.emplace(arguments.certificate, inputsOf(arguments), "--certificate");

  catchInterrupts();
  Report report(arguments, warnings, console);
  addBasis(arguments, world, report);
  if (arguments.trajectory.empty()) {
    askCurves(arguments, world, report);
  } else {
    askTrajectory(arguments, world, report, warnings);
  }
  console.warn(warnings);
  for (const std::string &message : warnings.messages()) report.note(message);
  if (interrupted(nullptr)) {
    console.say("interrupted: there is no page");
    return kInterrupted;
  }
  if (certificates) certificates->write(report.certificates());
  page.write(reportPage(titleOf(arguments), textOfJson(report.data())));
  return report.exitCode();
}

} // namespace curve_proximity::cli
