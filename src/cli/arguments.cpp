/* SPDX-License-Identifier: BSD-3-Clause */
#include "arguments.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <thread>

#include "../scene/yaml/numbers.h"
#include "failure.h"

namespace curve_proximity::cli {
namespace {

constexpr const char *kDefaultNode = "/curve_proximity";
constexpr std::size_t kMostThreads = 256;
constexpr const char *kStandardInput = "/dev/stdin";

/* For which actions an option is meant, and whether a value follows it. */
struct Option {
  bool has_value;
  std::vector<Action> actions;
};

const std::map<std::string, Option> &options() {
  static const std::map<std::string, Option> table = {
      {"--curves", {true, {Action::CURVES, Action::REPORT, Action::CHECK}}},
      {"--against", {true, {Action::CURVES, Action::CHECK}}},
      {"--synchronized", {false, {Action::CURVES}}},
      {"--trajectory", {true, {Action::CURVES, Action::REPORT, Action::CONSTRAINTS, Action::CHECK}}},
      {"--movers", {false, {Action::CURVES}}},
      {"--path", {true, {Action::CURVES}}},
      {"--body", {true, {Action::CURVES}}},
      {"--radius", {true, {Action::CURVES}}},
      {"--self", {false, {Action::CURVES, Action::REPORT, Action::CHECK}}},
      {"--shortest-way",
       {false, {Action::CURVES, Action::REPORT, Action::CHECK, Action::CERTIFY, Action::CONSTRAINTS}}},
      {"--signed", {false, {Action::CURVES}}},
      {"--scene", {true, {Action::CURVES, Action::REPORT, Action::CONSTRAINTS, Action::CHECK}}},
      {"--robot", {true, {Action::CURVES, Action::REPORT, Action::CONSTRAINTS, Action::CHECK}}},
      {"--srdf", {true, {Action::CURVES, Action::REPORT, Action::CONSTRAINTS, Action::CHECK}}},
      {"--state", {true, {Action::CURVES, Action::REPORT, Action::CONSTRAINTS, Action::CHECK}}},
      {"--certificate", {true, {Action::CURVES, Action::REPORT}}},
      {"--in", {true, {Action::PAIRS, Action::CONSTRAINTS}}},
      {"--provider", {true, {Action::CONSTRAINTS}}},
      {"--parameters", {true, {Action::CONSTRAINTS}}},
      {"--check-gradient", {false, {Action::CONSTRAINTS}}},
      {"--node", {true, {Action::SEND}}},
      {"--replace", {false, {Action::SEND}}},
      {"--add", {false, {Action::SEND}}},
      {"--dataset", {true, {Action::CERTIFY}}},
      {"--shards", {true, {Action::CERTIFY}}},
      {"--shard", {true, {Action::CERTIFY}}},
      {"--failed", {true, {Action::CERTIFY}}},
      {"--progress", {true, {Action::CERTIFY}}},
      {"--epsilon", {true, {Action::CURVES, Action::REPORT, Action::PAIRS, Action::CERTIFY}}},
      {"--delta", {true, {Action::CURVES, Action::REPORT}}},
      {"--max-nodes", {true, {Action::CURVES, Action::REPORT, Action::PAIRS, Action::CERTIFY}}},
      {"--threads", {true, {Action::CURVES, Action::PAIRS, Action::CONSTRAINTS, Action::CERTIFY, Action::CHECK}}},
      {"--per-object", {false, {Action::CURVES}}},
      {"--allow-empty", {false, {Action::CURVES, Action::REPORT, Action::CERTIFY}}},
      {"--links", {true, {Action::CURVES, Action::REPORT}}},
      {"--moving-links-only", {false, {Action::CURVES, Action::REPORT}}},
      {"--objects", {true, {Action::CURVES, Action::REPORT}}},
      {"--second-opinion", {true, {Action::CURVES, Action::PAIRS}}},
      {"--max-lod", {true, {Action::CURVES, Action::REPORT, Action::PAIRS, Action::CERTIFY}}},
      {"--skipped", {false, {Action::CURVES, Action::PAIRS}}},
      {"--timings", {false, {Action::CURVES}}},
      {"--mesh-tolerance", {true, {Action::CURVES, Action::REPORT}}},
      {"--per-link", {false, {Action::CURVES}}},
      {"--intervals", {true, {Action::CURVES, Action::REPORT}}},
      {"--breaks", {true, {Action::CURVES, Action::REPORT}}},
      {"--horizon", {true, {Action::CURVES}}},
      {"--pairs", {true, {Action::CURVES, Action::REPORT}}},
      {"--within", {true, {Action::CURVES}}},
      {"--resolution", {true, {Action::CURVES}}},
      {"--out",
       {true, {Action::CURVES, Action::REPORT, Action::PAIRS, Action::CONSTRAINTS, Action::CERTIFY, Action::MERGE}}},
  };
  return table;
}

struct Command {
  const char *word;
  Action action;
  QueryType query_type;
  Question question = {};
};
const Command kCommands[] = {
    {"distance", Action::CURVES, QueryType::DISTANCE},
    {"tolerance", Action::CURVES, QueryType::TOLERANCE},
    {"collision", Action::CURVES, QueryType::COLLISION},
    {"profile", Action::CURVES, QueryType::DISTANCE, question::Profile{}},
    {"nearest", Action::CURVES, QueryType::DISTANCE, question::Nearest{}},
    {"time-of-contact", Action::CURVES, QueryType::COLLISION, question::Contact{}},
    {"violations", Action::CURVES, QueryType::TOLERANCE, question::Violations{}},
    {"pairs", Action::PAIRS, QueryType::DISTANCE},
    {"constraints", Action::CONSTRAINTS, QueryType::DISTANCE},
    {"report", Action::REPORT, QueryType::DISTANCE},
    {"send", Action::SEND, QueryType::DISTANCE},
    {"check", Action::CHECK, QueryType::DISTANCE},
    {"certify", Action::CERTIFY, QueryType::DISTANCE},
    {"merge", Action::MERGE, QueryType::DISTANCE},
};

/* "distance, tolerance, …" */
std::string commandNames() {
  std::string names;
  for (const Command &command : kCommands) names += (names.empty() ? "" : ", ") + std::string(command.word);
  return names;
}

const Command &findCommand(const std::string &word) {
  for (const Command &command : kCommands) {
    if (word == command.word) return command;
  }
  throw BadUsage("'" + word + "' is no command; the commands are " + commandNames() + " (see --help)");
}

/* The words behind the command: options with their values, and what is no option. */
struct Words {
  std::map<std::string, std::string> given;
  std::vector<std::string> plain;

  std::string text(const std::string &name) const {
    const auto it = given.find(name);
    return it == given.end() ? "" : it->second;
  }
  bool has(const std::string &name) const {
    return given.count(name) > 0;
  }
};

/* Takes one option off the words at `i`, with its value: "--name value" or "--name=value". */
void takeOption(const std::vector<std::string> &words, std::size_t &i, const std::string &command, Action action,
                Words &out) {
  const std::size_t equals = words[i].find('=');
  const std::string name = words[i].substr(0, equals);

  /* is it an option of this command? */
  const auto known = options().find(name);
  if (known == options().end()) throw BadUsage("unknown option " + name + " (see --help)");
  const std::vector<Action> &actions = known->second.actions;
  if (std::find(actions.begin(), actions.end(), action) == actions.end()) {
    throw BadUsage("'" + command + "' takes no " + name);
  }

  /* its value */
  std::string value;
  if (known->second.has_value) {
    if (equals != std::string::npos) {
      value = words[i].substr(equals + 1);
    } else if (i + 1 < words.size() && words[i + 1].rfind("--", 0) != 0) {
      value = words[++i];
    }
    if (value.empty()) throw BadUsage(name + " needs a value");
  } else if (equals != std::string::npos) {
    throw BadUsage(name + " takes no value");
  }

  if (!out.given.emplace(name, value).second) throw BadUsage(name + " is given twice");
}

Words splitWords(const std::vector<std::string> &words, const Command &command) {
  Words out;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i].size() > 1 && words[i][0] == '-') {
      takeOption(words, i, command.word, command.action, out);
    } else {
      out.plain.push_back(words[i]);
    }
  }
  return out;
}

double readNumber(const Words &words, const std::string &name, double least, bool least_allowed,
                  const std::string &range) {
  const std::string text = words.text(name);
  const std::optional<double> value = parseFinite(text);
  if (!value || *value < least || (*value == least && !least_allowed)) {
    throw BadUsage(name + " is '" + text + "'; it must be a finite number " + range);
  }
  return *value;
}

std::uint64_t readCount(const Words &words, const std::string &name, std::uint64_t most) {
  const std::string text = words.text(name);
  const std::optional<std::uint64_t> value = parseCount(text);
  if (!value || *value < 1 || *value > most) {
    throw BadUsage(name + " is '" + text + "'; it must be an integer from 1 to " + std::to_string(most));
  }
  return *value;
}

/* Parameters that ascend. */
std::vector<double> readBreaks(const std::string &text) {
  std::vector<double> out;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::optional<double> value = parseFinite(std::string(trimmed(text.substr(begin, comma - begin))));
    if (!value || (!out.empty() && *value <= out.back()))
      throw BadUsage("--breaks is '" + text + "'; it must be finite numbers that ascend: \"0, 0.5, 1\"");
    out.push_back(*value);
    begin = comma + 1;
  }
  if (out.size() < 2) throw BadUsage("--breaks needs at least two numbers: where intervals begin and end");
  return out;
}

/* "shelf, table" */
std::vector<std::string> readNames(const Words &words, const std::string &option) {
  std::vector<std::string> out;
  const std::string text = words.text(option);
  for (std::size_t begin = 0; words.has(option) && begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    out.emplace_back(trimmed(text.substr(begin, comma - begin)));
    if (out.back().empty())
      throw BadUsage(option + " is '" + text + "'; it must be names with commas between them: \"shelf, table\"");
    begin = comma + 1;
  }
  return out;
}

void readQuery(const Words &words, const Command &command, Query &query) {
  query.objects = readNames(words, "--objects");
  query.links = readNames(words, "--links");
  query.moving_only = words.has("--moving-links-only");
  if (query.moving_only && !words.has("--trajectory") && !words.has("--movers"))
    throw BadUsage("--moving-links-only is for --trajectory and --movers");
  for (const char *name : {"--objects", "--links"})
    if (words.has(name) && words.has("--certificate"))
      throw BadUsage("--certificate takes no " + std::string(name) + ": it proves an answer about all of them");
  query.query_type = command.query_type;
  query.per_object = words.has("--per-object");
  query.allow_empty = words.has("--allow-empty");
  query.options.signed_distance = words.has("--signed");
  const bool has_depth = command.query_type == QueryType::DISTANCE && !asksFor<question::Profile>(command.question);
  if (words.has("--signed") && !has_depth) throw BadUsage("--signed is for 'distance' and 'nearest'");

  /* accuracy and budget */
  if (words.has("--epsilon")) {
    query.options.epsilon = readNumber(words, "--epsilon", 0.0, false, "above 0 (metres)");
  }
  if (words.has("--max-nodes")) {
    const std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
    query.options.max_nodes = static_cast<std::uint32_t>(readCount(words, "--max-nodes", most));
  }

  /* the limit of `tolerance` has no default: a clearance that nobody asked for means nothing */
  const bool takes_delta = command.query_type == QueryType::TOLERANCE || command.action == Action::REPORT;
  if (words.has("--delta") && !takes_delta)
    throw BadUsage("--delta is for 'tolerance', 'violations' and 'report': it is the clearance that is asked for");
  if (words.has("--delta")) query.delta = readNumber(words, "--delta", 0.0, true, "of at least 0 (metres)");
  if (command.action == Action::CURVES && command.query_type == QueryType::TOLERANCE && !words.has("--delta")) {
    throw BadUsage("'" + std::string(command.word) + "' needs --delta D, the clearance that is asked for, in metres");
  }

  /* the finest model that may answer */
  if (words.has("--max-lod")) {
    const std::optional<cprox_lod> lod = lodFromName(words.text("--max-lod"));
    if (!lod) throw BadUsage("--max-lod is '" + words.text("--max-lod") + "'; it must be sphere, hull or mesh");
    query.options.max_lod = *lod;
  }
}

/* Who measures the pairs again. */
void readSecondOpinion(const Words &words, const Command &command, Arguments &out) {
  if (!words.has("--second-opinion")) return;
  out.second_opinion = peerFromName(words.text("--second-opinion"));
  if (!out.second_opinion)
    throw BadUsage("--second-opinion is '" + words.text("--second-opinion") + "'; it must be fcl or libccd");
  if (asksFor<question::Profile, question::Violations>(command.question))
    throw BadUsage("'" + std::string(command.word) + "' takes no --second-opinion: its rows name no pair");
}

/* Options that are for one command alone. */
void readQuestion(const Words &words, const Command &command, Arguments &out) {
  const auto only = [&](const char *name, const std::string &word) {
    if (words.has(name) && command.word != word && command.action != Action::REPORT)
      throw BadUsage(std::string(name) + " is for '" + word + "'");
    return words.has(name);
  };
  out.has_delta = words.has("--delta");
  if (only("--intervals", "profile")) {
    constexpr std::uint64_t kMostIntervals = 1000000, kMostDrawn = 2000; /* a chart has no more pixels */
    if (words.has("--breaks")) throw BadUsage("--intervals and --breaks exclude each other");
    out.profile.intervals = static_cast<std::size_t>(
        readCount(words, "--intervals", command.action == Action::REPORT ? kMostDrawn : kMostIntervals));
  }
  if (only("--breaks", "profile")) out.profile.breaks = readBreaks(words.text("--breaks"));
  if (only("--horizon", "profile"))
    out.profile.horizon = readNumber(words, "--horizon", 0.0, true, "of at least 0 (metres)");
  PairLimits &limits = out.nearest.limits;
  if (only("--pairs", "nearest"))
    limits.count = static_cast<std::size_t>(readCount(words, "--pairs", std::numeric_limits<std::uint32_t>::max()));
  if (only("--within", "nearest")) limits.within = readNumber(words, "--within", 0.0, true, "of at least 0 (metres)");
  out.question = command.question;
  if (asksFor<question::Profile>(out.question)) out.question = out.profile;
  if (asksFor<question::Nearest>(out.question)) out.question = out.nearest;
  if (only("--resolution", "violations"))
    out.question =
        question::Violations{readNumber(words, "--resolution", 0.0, false, "above 0, in units of the parameter")};
  if (asksFor<question::Search>(out.question)) return;
  for (const char *name : {"--against", "--certificate"}) {
    if (words.has(name)) throw BadUsage("'" + std::string(command.word) + "' takes no " + name);
  }
}

/* Curves against curves: there is no scene, and a row has one answer. */
void readAgainst(const Words &words, Arguments &out) {
  for (const char *name :
       {"--scene", "--robot", "--srdf", "--state", "--per-object", "--skipped", "--timings", "--allow-empty",
        "--mesh-tolerance", "--max-lod", "--per-link", "--links", "--objects", "--second-opinion"}) {
    if (words.has(name))
      throw BadUsage("--against takes no " + std::string(name) + ": curves are measured against curves");
  }
  if (out.action == Action::CURVES) out.action = Action::AGAINST;
  out.against = words.text("--against");
  out.synchronized = words.has("--synchronized");
}

/* The robot along a trajectory, instead of curves. */
void readTrajectoryWords(const Words &words, Arguments &out) {
  for (const char *name : {"--curves", "--against"}) {
    if (words.has(name)) throw BadUsage("--trajectory takes no " + std::string(name));
  }
  if (words.has("--signed") && !asksFor<question::Search>(out.question))
    throw BadUsage("'nearest' takes no --signed with --trajectory: ask for the 'distance'");
  if (!words.has("--robot")) throw BadUsage("--trajectory needs --robot URDF");
  if (out.action == Action::CURVES) out.action = Action::TRAJECTORY;
  out.trajectory = words.text("--trajectory");
  out.shortest_way = words.has("--shortest-way");
  out.self = words.has("--self");
  out.per_link = words.has("--per-link");
  if (out.per_link && words.has("--per-object")) throw BadUsage("--per-link and --per-object exclude each other");
  out.scene = words.text("--scene");
  out.robot = words.text("--robot");
  out.srdf = words.text("--srdf");
  out.state = words.text("--state");
}

/* What moves in the scene, without a robot of the command line. */
void readMoversWords(const Words &words, Arguments &out) {
  for (const char *name : {"--curves", "--against", "--trajectory", "--signed", "--robot", "--srdf", "--state",
                           "--per-object", "--per-link", "--links", "--objects", "--certificate", "--second-opinion"}) {
    if (words.has(name)) throw BadUsage("--movers takes no " + std::string(name));
  }
  if (!words.has("--scene")) throw BadUsage("--movers needs --scene SCENE.yaml: what moves in it is asked about");
  out.action = Action::MOVERS;
  out.scene = words.text("--scene");
  out.self = words.has("--self");
}

/* A body along a path, or a ball. A robot carries the body where it has no shapes of its own. */
void readPathWords(const Words &words, Arguments &out) {
  for (const char *name : {"--curves", "--against", "--trajectory", "--movers", "--self", "--signed", "--per-link",
                           "--links", "--certificate", "--second-opinion"}) {
    if (words.has(name)) throw BadUsage("--path takes no " + std::string(name));
  }
  if (!words.has("--scene")) throw BadUsage("--path needs --scene SCENE.yaml, what it is measured against");
  if (words.has("--radius") && words.has("--body"))
    throw BadUsage("--radius and --body exclude each other: a ball rides along the path, or the body");
  if (words.has("--radius")) out.radius = readNumber(words, "--radius", 0.0, true, "of at least 0 (metres)");
  for (const char *name : {"--srdf", "--state"})
    if (words.has(name) && !words.has("--robot")) throw BadUsage(std::string(name) + " needs --robot URDF");
  out.action = Action::MOVERS;
  out.path = words.text("--path");
  out.body = words.text("--body");
  out.scene = words.text("--scene");
  out.robot = words.text("--robot");
  out.srdf = words.text("--srdf");
  out.state = words.text("--state");
}

/* The number of a shard, from 0. */
std::size_t readShardNumber(const Words &words, std::size_t shards) {
  const std::optional<std::uint64_t> shard = parseCount(words.text("--shard"));
  if (shard && *shard < shards) return static_cast<std::size_t>(*shard);
  throw BadUsage("--shard is '" + words.text("--shard") + "'; of " + std::to_string(shards) +
                 " shards it must be an integer from 0 to " + std::to_string(shards - 1));
}

/* The files that a command cannot do without, and words that it does not understand. */
void readFiles(const Words &words, const Command &command, Arguments &out) {
  const auto required = [&](const std::string &name, const std::string &what) {
    if (!words.has(name)) throw BadUsage("'" + std::string(command.word) + "' needs " + name + " " + what);
    return words.text(name);
  };
  /* what curves are measured against */
  const auto readSurroundings = [&] {
    if (!words.has("--robot")) required("--scene", "SCENE.yaml");
    out.scene = words.text("--scene");
    out.robot = words.text("--robot");
    out.srdf = words.text("--srdf");
    out.state = words.text("--state");
    if (out.robot.empty() && !out.state.empty()) throw BadUsage("--state needs --robot URDF");
    if (out.robot.empty() && !out.srdf.empty()) throw BadUsage("--srdf needs --robot URDF");
  };
  std::vector<std::string> plain = words.plain;

  switch (command.action) {
    case Action::CHECK:
      if (plain.empty()) throw BadUsage("'check' needs a file: cprox check FILE with the inputs of the query");
      out.certificate = plain.front();
      plain.erase(plain.begin());
      [[fallthrough]];
    case Action::CURVES:
      if (words.has("--synchronized") && !words.has("--against"))
        throw BadUsage("--synchronized needs --against: it is about two curves on one clock");
      if (words.has("--path")) {
        readPathWords(words, out);
        break;
      }
      if (words.has("--body")) throw BadUsage("--body needs --path PATH.yaml");
      if (words.has("--radius")) throw BadUsage("--radius needs --path PATH.yaml: curves have theirs in their rows");
      if (words.has("--movers")) {
        readMoversWords(words, out);
        break;
      }
      if (words.has("--trajectory")) {
        readTrajectoryWords(words, out);
        break;
      }
      if (words.has("--self")) throw BadUsage("--self needs --trajectory T.yaml");
      if (words.has("--per-link"))
        throw BadUsage("--per-link needs --trajectory T.yaml; --per-object has a row for each link that a curve meets");
      out.curves = required("--curves", "CURVES.csv");
      if (words.has("--against")) {
        readAgainst(words, out);
        break;
      }
      readSurroundings();
      break;
    case Action::REPORT:
      required("--out", "REPORT.html");
      if (words.has("--trajectory")) {
        readTrajectoryWords(words, out);
        break;
      }
      if (words.has("--self")) throw BadUsage("--self needs --trajectory T.yaml");
      out.curves = required("--curves", "CURVES.csv, or --trajectory T.yaml");
      readSurroundings();
      break;
    case Action::CERTIFY: {
      constexpr std::uint64_t kMostShards = 1000000;
      out.dataset = required("--dataset", "MANIFEST, JSON Lines or CSV");
      required("--out", "FOLDER, where the shards go");
      out.shortest_way = words.has("--shortest-way");
      if (words.has("--shards")) out.shards = static_cast<std::size_t>(readCount(words, "--shards", kMostShards));
      if (words.has("--shard")) out.shard = readShardNumber(words, out.shards);
      if (words.has("--failed") && !out.shard) throw BadUsage("--failed needs --shard I: it gives up one shard");
      if (words.has("--failed")) out.failed = words.text("--failed");
      out.progress = words.has("--progress") ? words.text("--progress") : "line";
      if (out.progress != "line" && out.progress != "json")
        throw BadUsage("--progress is '" + out.progress + "'; it must be line or json");
      break;
    }
    case Action::MERGE:
      if (plain.empty()) throw BadUsage("'merge' needs a folder: cprox merge FOLDER, where 'certify' left its shards");
      out.shard_folder = plain.front();
      plain.erase(plain.begin());
      break;
    case Action::PAIRS: out.pairs = required("--in", "PAIRS.yaml"); break;
    case Action::CONSTRAINTS:
      out.provider = required("--provider", "NAME, such as curve_proximity/CurveDistance");
      out.parameters = words.text("--parameters");
      out.check_gradient = words.has("--check-gradient");
      if (words.has("--trajectory")) {
        if (words.has("--in")) throw BadUsage("--trajectory takes no --in");
        readTrajectoryWords(words, out);
        break;
      }
      out.cases = required("--in", "CASES.yaml, or --trajectory T.yaml");
      out.scene = words.text("--scene");
      out.robot = words.text("--robot");
      out.srdf = words.text("--srdf");
      out.state = words.text("--state");
      for (const char *name : {"--srdf", "--state"})
        if (words.has(name) && out.robot.empty()) throw BadUsage(std::string(name) + " needs --robot URDF");
      break;
    case Action::SEND:
      if (plain.empty()) throw BadUsage("'send' needs a file: cprox send SCENE.yaml");
      out.scene = plain.front();
      out.node = words.has("--node") ? words.text("--node") : kDefaultNode;
      if (words.has("--replace") && words.has("--add")) throw BadUsage("--replace and --add exclude each other");
      if (words.has("--replace") || words.has("--add")) out.replace = words.has("--replace");
      plain.erase(plain.begin());
      break;
    default: break;
  }
  if (!plain.empty()) throw BadUsage("'" + plain.front() + "' is not understood (see --help)");
}

/* "-" is standard input, for one file. */
void readStandardInput(Arguments &out) {
  bool taken = false;
  for (std::string *path : {&out.curves, &out.against, &out.trajectory, &out.path, &out.body, &out.scene, &out.robot,
                            &out.srdf, &out.pairs, &out.cases}) {
    if (*path != "-") continue;
    if (taken) throw BadUsage("'-', standard input, can be only one of the files");
    taken = true;
    *path = kStandardInput;
  }
}

} // namespace

Arguments parseArguments(const std::vector<std::string> &words) {
  Arguments out;
  if (words.empty()) throw BadUsage("no command; the commands are " + commandNames() + " (see --help)");

  /* help and version win over everything else on the line */
  const auto said = [&](const char *word) { return std::find(words.begin(), words.end(), word) != words.end(); };
  if (said("--help") || said("-h") || words.front() == "help") return out;
  if (said("--version")) {
    out.action = Action::VERSION;
    return out;
  }

  const Command &command = findCommand(words.front());
  const Words split = splitWords(words, command);
  out.action = command.action;
  readQuery(split, command, out.query);
  readSecondOpinion(split, command, out);
  readQuestion(split, command, out);
  readFiles(split, command, out);
  readStandardInput(out);

  out.out = split.text("--out");
  if (split.has("--certificate")) out.certificate = split.text("--certificate");
  if (split.has("--certificate") && (out.query.per_object || out.per_link)) {
    throw BadUsage("--certificate takes no --per-object and no --per-link: a certificate is about all pairs at once");
  }
  out.skipped = split.has("--skipped");
  if (split.has("--shortest-way") && !out.shortest_way) throw BadUsage("--shortest-way needs --trajectory T.yaml");
  out.timings = split.has("--timings");
  if (split.has("--mesh-tolerance"))
    out.mesh_tolerance = readNumber(split, "--mesh-tolerance", 0.0, true, "of at least 0 (metres)");
  out.threads = std::max(1u, std::thread::hardware_concurrency());
  if (split.has("--threads")) out.threads = static_cast<std::size_t>(readCount(split, "--threads", kMostThreads));
  return out;
}

std::vector<std::string> inputsOf(const Arguments &arguments) {
  return {arguments.curves, arguments.against, arguments.trajectory, arguments.path,  arguments.body,
          arguments.scene,  arguments.robot,   arguments.srdf,       arguments.pairs, arguments.cases};
}

std::string helpText() {
  return R"(cprox: how close a continuous motion comes to the things around it, as intervals that contain the true value

cprox distance  --curves CURVES.csv --scene SCENE.yaml [--robot URDF [--srdf SRDF] [--state "joint: value, ..."]]
cprox distance  --curves A.csv --against B.csv    row i of A against row i of B, each anywhere on its curve
cprox distance  --robot URDF [--srdf SRDF] --trajectory T.yaml [--scene SCENE.yaml] [--self]
                                        the robot along a joint trajectory: a row of kind environment, one of kind self
cprox distance  --scene SCENE.yaml --movers [--self]   what moves in the scene: objects with a trajectory, moving_robots
cprox distance  --path PATH.yaml [--radius R | --body BODY.yaml] --scene SCENE.yaml
                                        a point, a ball or a body along a nav_msgs/Path; the body turns as its poses say
cprox tolerance --delta D  (as above)   verdict: clear (farther than D everywhere), violated or undecided
cprox collision            (as above)   verdict: clear (no common point), violated (a common point) or undecided
cprox time-of-contact      (as distance, without --against)   where along the curve or trajectory the first contact is
cprox profile              (as distance, without --against)   the clearance on each interval of the parameter
cprox violations --delta D (as distance, without --against)   all intervals of the parameter within D of something
cprox nearest              (as distance, without --against)   the pairs that come closest, nearest first
cprox pairs     --in PAIRS.yaml         signed distance of static pairs of bodies
cprox constraints --provider NAME --in CASES.yaml [--scene SCENE.yaml] [--parameters "name: value, ..."]
                                        value and gradient of clearance constraints by a plugin
                (or --trajectory T.yaml --robot URDF [--srdf SRDF --state TEXT], instead of --in)   of a robot along a trajectory
                --check-gradient        holds the gradients against central differences
cprox report    (the inputs of distance, without --against) [--delta D] --out REPORT.html
                                        one page to look at: verdict, clearance over time per link, closest pairs, 3-D view
cprox send      SCENE.yaml [--replace | --add] [--node NAME]   hands a scene file to a running node
cprox check     FILE  (the inputs of the query)  what the certificates in FILE prove
cprox certify   --dataset MANIFEST --out FOLDER [--shards N [--shard I]]   answers the rows of a dataset, shard by shard
cprox merge     FOLDER                  all shards as one table; refuses gaps and shards of different runs

  --curves FILE     one curve a row: id,basis,degree,t0,t1,radius,n,x0,y0,z0,...[,knots][,parameters]
                    [,restrict_t0,restrict_t1]; basis bezier, bspline, polynomial, legendre, lagrange (nodes for
                    knots), trigonometric, rational_bezier, nurbs (weights for parameters), clothoid, dubins,
                    involute, pythagorean_hodograph or piecewise (the next n rows); doc/formats.md has them all.
                    A radius that changes has the coefficients of 1, t, t², ..., separated by blanks.
                    Lines that begin with # and a header row are skipped
  --against FILE    curves, too: instead of a scene
  --synchronized    with --against: both curves are at the same parameter, so that they may cross each other's way
  --scene FILE      moveit_msgs/PlanningScene as YAML; may be left out where there is a robot
  --robot FILE      a URDF: its links are objects, too; meshes answer as meshes (see --max-lod)
  --trajectory FILE a joint trajectory: joint_trajectory, interpolation, fixed_joints, virtual_joint
  --movers          what moves in the scene, instead of curves or a robot: against what stands there, and against each other
  --path FILE       nav_msgs/Path, as rostopic prints it: straight from pose to pose, turning at a constant rate, at the
                    times of the stamps; where these do not ascend, t counts poses
  --body FILE       with --path: {id, pose, padding, primitives, meshes, bodies, ...} as an object of a scene; with an id
                    alone: the object of that id that a link of --robot carries, along poses of the link
  --radius R        with --path, instead of --body: a ball of R metres (default 0, a point)
  --self            how close the robot comes to itself, too
  --shortest-way    continuous joints turn the shorter way between two waypoints, from 3.1 to -3.1 by 0.083 rad
  --signed          distances inside a body are negative: minus the deepest penetration (of meshes a bound, by their hulls)
  --srdf FILE       links that are not checked against each other, and the frame in which the robot stands
                    (its virtual joint's parent_frame)
  --state TEXT      joint values in radians or metres; others as in the scene's robot_state, else 0
                    (mid-range where 0 is beyond the limits)
  --in FILE         a list of {id, a: BODY, b: BODY}; of 'constraints' the request of ~evaluate_constraints:
                    cases: [{id, a: {pose, bodies: [BODY], ...} or {id: an object of --scene}, b, curve}]
                    Each FILE that is read may be -, standard input. doc/formats.md shows all formats
  --provider NAME   curve_proximity/CurveDistance, .../SuperquadricDistance, .../FourierGap, .../GrowthDistance,
                    .../RobotDistance (of trajectories), or another package's
  --certificate FILE  writes proofs of the answers to FILE, which 'check' verifies, and adds the column proof: apart, near or none.
                    The answers are the same as without. A mesh is taken by its convex hull: that it is far can be proven, that
                    it is near cannot. Superquadrics and other implicit bodies, clouds and octrees have no proofs
  --epsilon E       width of the intervals asked for, metres, above 0 (default 1e-06)
  --delta D         the clearance asked of 'tolerance' and 'violations', and of 'report' if its verdict is wanted, metres
  --max-nodes N     budget for each result, in distance queries (default 500000: about 1 s)
  --threads N       how many rows are worked on at once (default: the machine's cores); the answers do not depend on it
  --per-object      rows for each curve and object or link, not for the nearest alone
  --per-link        with --trajectory: rows for each link and each object that a link carries
  --allow-empty     nothing to measure is an answer: clear, at an infinite distance. Without it such a row has the status
                    'empty', and its verdict is undecided
  --objects LIST    these objects alone, "shelf, table"; with --curves and --links also those links
  --links LIST      with --curves: these links of --robot alone. With --trajectory: what these links do, or objects that they
                    carry; with --self pairs of which they are one
  --moving-links-only  with --trajectory, --movers: links that the motion does not move are left out, with --self pairs that it
                    does not move against each other; else all count. The rows' messages say so
  --intervals N     'profile', 'report': N intervals of equal length (default 100)
  --breaks LIST     'profile', 'report': where intervals begin and end instead, "0, 0.5, 2"
  --horizon H       'profile': clearance beyond H metres is only bounded: lower > H, which is less work
  --pairs K         'nearest', 'report': at most K pairs for each curve or trajectory (default 10)
  --resolution R    'violations': how finely the ends are searched, in units of the parameter (default: a thousandth of
                    all of it)
  --within D        'nearest': only pairs that come within D metres
  --second-opinion PEER  fcl or libccd: the pair of each row is measured again by this library, at the row's t and at both
                    ends; the columns second_opinion (agrees, disagrees or unknown) and second_distance are added
  --max-lod R       the finest model that may answer: mesh (default), hull (meshes by their convex hulls) or sphere (bodies
                    by their bounding spheres); a coarser one is never farther away
  --dataset FILE    JSON Lines, or CSV with a header: id, robot, srdf, scene, trajectory, query, delta, self a row
  --shards N        'certify': the dataset is cut into N parts of equal length (default 1)
  --shard I         'certify': part I alone, from 0 to N-1 (default: all of them). A part that is whole is skipped
  --failed WHY      'certify', of --shard I: answers no row; each becomes a row 'failed' with this message. For whoever drives
                    shards and has seen one crash: 'merge' then has no gap
  --progress P      'certify': line (default, on a terminal) or json, a line a second on standard error
  --skipped         tell on standard error what takes no part, and why
  --timings         tell on standard error how long loading the robot and the scene takes, mesh by mesh
  --mesh-tolerance M  replace meshes by ones with fewer triangles that contain them: nothing is clear that the mesh would
                    hit; what is closer than 2 M metres may read as a hit
  --out FILE        the results, instead of standard output; of 'certify' the folder of the shards, of 'report' the page
  --replace         'send': the file takes the place of the node's scene (default, unless the file says is_diff: true)
  --add             'send': the file is added to the node's scene
  --node NAME       the node that 'send' talks to (default )" +
         std::string(kDefaultNode) + R"()
  --help, --version

Results, a CSV row each: id,kind,status,verdict,lower,upper,t,a_x,a_y,a_z,b_x,b_y,b_z,a,b,nodes,distance_queries,microseconds,
t_b,lod,message. With --second-opinion also
second_opinion,second_distance. Of 'time-of-contact' also t_contact_lower: there is no contact at any smaller parameter. Of 'profile':
id,kind,status,t0,t1,lower,upper,t,a_x,a_y,a_z,b_x,b_y,b_z,a,b,message, a row an interval. Of 'violations':
id,kind,status,verdict,enter_lower,enter_upper,leave_lower,leave_upper,upper,t,a,b,message, a row each: farther than D before
enter_lower and after leave_upper, within D from enter_upper to leave_lower; or one row 'clear' without numbers. Of 'constraints': id,provider,status,value,lower,upper,valid,t,
gradients ga_ and gb_ by a step of side a and b (v: position, w: turning), a_, b_ and n_ (nearest points, normal), g_radius,
microseconds,message,n,g0x,g0y,g0z,... by the curve's points. Of trajectories: t0,t1,kind,a,b (as above), g_duration, g_start, and a
column for each number of each point: q0_JOINT, v0_JOINT, a0_JOINT by its position, velocity and acceleration; ga_ is by a step of the
robot's base, gb_ by one of the object b. With --check-gradient: id,provider,status,verdict,derivatives (how many were compared),
derivative (the one that fits least),gradient,difference,misfit,doubt,message; verdict: clear (all agree within 1e-3 of 1 + the
difference), violated (one does not, by more than four times what a smaller step changes: doubt) or undecided. Metres and radians. A row that fails has the status 'invalid',
and its column message says why.
Exit code of every command: 0 everything is answered, and nothing of it is violated, undecided or unproven; 1 a verdict is
violated, or 'check' finds a certificate that does not prove its answer; 2 a row has no answer, there is no row, or the
command line or a file cannot be used; 3 a verdict is undecided, an answer does
not cover all that was given, or a second opinion disagrees; 130 interrupted. Of several, 2 comes before 1, and 1 before
3. Only 0 says that all is well, so that a shell can gate on it. Of 'certify' 0 says that its shards are whole, whatever their
rows say: 'merge' tells.
)";
}

} // namespace curve_proximity::cli
