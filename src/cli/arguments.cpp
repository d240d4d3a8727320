/* SPDX-License-Identifier: BSD-3-Clause */
#include "arguments.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <thread>

#include "../scene/yaml/numbers.h"
#include "exit_code.h"
#include "options.h"

namespace curve_proximity::cli {
namespace {

constexpr const char *kDefaultNode = "/curve_proximity";
constexpr std::size_t kMostThreads = 256;
constexpr const char *kStandardInput = "/dev/stdin";

/* "distance, tolerance, …" */
std::string commandNames() {
  std::string names;
  for (const Command &command : commands()) names += (names.empty() ? "" : ", ") + std::string(command.word);
  return names;
}

/* "'tolerance', 'violations' and 'report'" */
std::string quoted(const std::vector<std::string> &words) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i)
    out += (i == 0 ? "'" : i + 1 == words.size() ? " and '" : ", '") + words[i] + "'";
  return out;
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

/* Throws for the first of these options that is given: `whose` takes none of them. */
void refuse(const Words &words, const std::string &whose, std::initializer_list<const char *> names,
            const std::string &why = "") {
  for (const char *name : names)
    if (words.has(name)) throw BadUsage(whose + " takes no " + name + why);
}

/* Takes one option off the words at `i`, with its value: "--name value" or "--name=value". */
void takeOption(const std::vector<std::string> &words, std::size_t &i, const Command &command, Words &out) {
  const std::size_t equals = words[i].find('=');
  const std::string name = words[i].substr(0, equals);

  /* is it an option of this command? */
  const Option *known = findOption(name);
  if (!known) throw BadUsage("unknown option " + name + " (see cprox " + command.word + " --help)");
  if (!takes(command, *known)) {
    constexpr std::size_t FEW = 3;
    const std::vector<std::string> theirs = commandsOf(*known);
    throw BadUsage("'" + std::string(command.word) + "' takes no " + name +
                   (theirs.size() <= FEW ? ": it is for " + quoted(theirs) : ""));
  }

  /* its value */
  std::string value;
  if (*known->value != '\0') {
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
      takeOption(words, i, command, out);
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

/* "arm_description=/data/arm, hand=/data/hand" */
std::map<std::string, std::string> readPackages(const Words &words) {
  std::map<std::string, std::string> out;
  for (const std::string &entry : readNames(words, "--package")) {
    const std::size_t equals = entry.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == entry.size())
      throw BadUsage(
          "--package is '" + words.text("--package") +
          "'; it must be names with their folders, and commas between them: \"arm=/data/arm, hand=/data/hand\"");
    const std::string folder = entry.substr(equals + 1);
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error)) throw BadUsage("--package: " + folder + " is no folder");
    if (!out.emplace(entry.substr(0, equals), std::filesystem::absolute(folder).string()).second)
      throw BadUsage("--package: '" + entry.substr(0, equals) + "' is given twice");
  }
  return out;
}

void readQuery(const Words &words, const Command &command, Query &query) {
  query.objects = readNames(words, "--objects");
  query.links = readNames(words, "--links");
  query.moving_only = words.has("--moving-links-only");
  if (query.moving_only && !words.has("--trajectory") && !words.has("--movers"))
    throw BadUsage("--moving-links-only is for --trajectory and --movers");
  if (words.has("--certificate"))
    refuse(words, "--certificate", {"--objects", "--links"}, ": it proves an answer about all of them");
  query.query_type = command.query_type;
  query.per_object = words.has("--per-object");
  query.allow_empty = words.has("--allow-empty");
  query.options.signed_distance = words.has("--signed");

  /* accuracy and budget */
  if (words.has("--epsilon")) {
    query.options.epsilon = readNumber(words, "--epsilon", 0.0, false, "above 0 (metres)");
  }
  if (words.has("--max-nodes")) {
    const std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
    query.options.max_nodes = static_cast<std::uint32_t>(readCount(words, "--max-nodes", most));
  }

  /* the limit of `tolerance` has no default: a clearance that nobody asked for means nothing */
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
void readSecondOpinion(const Words &words, Arguments &out) {
  if (!words.has("--second-opinion")) return;
  out.second_opinion = peerFromName(words.text("--second-opinion"));
  if (!out.second_opinion)
    throw BadUsage("--second-opinion is '" + words.text("--second-opinion") + "'; it must be fcl or libccd");
}

/* Options that are for one command alone. */
void readQuestion(const Words &words, const Command &command, Arguments &out) {
  out.has_delta = words.has("--delta");
  if (words.has("--intervals")) {
    constexpr std::uint64_t kMostIntervals = 1000000, kMostDrawn = 2000; /* a chart has no more pixels */
    constexpr std::uint64_t kMostLimits = 20000;                         /* speed looks from each ahead */
    if (words.has("--breaks")) throw BadUsage("--intervals and --breaks exclude each other");
    out.profile.intervals = static_cast<std::size_t>(readCount(words, "--intervals",
                                                               command.action == Action::REPORT  ? kMostDrawn
                                                               : command.action == Action::SPEED ? kMostLimits
                                                                                                 : kMostIntervals));
  }
  if (words.has("--breaks")) out.profile.breaks = readBreaks(words.text("--breaks"));
  if (words.has("--horizon")) out.profile.horizon = readNumber(words, "--horizon", 0.0, true, "of at least 0 (metres)");
  PairLimits &limits = out.nearest.limits;
  if (words.has("--pairs"))
    limits.count = static_cast<std::size_t>(readCount(words, "--pairs", std::numeric_limits<std::uint32_t>::max()));
  if (words.has("--within")) limits.within = readNumber(words, "--within", 0.0, true, "of at least 0 (metres)");
  out.question = command.question;
  if (asksFor<question::Profile>(out.question)) out.question = out.profile;
  if (asksFor<question::Nearest>(out.question)) out.question = out.nearest;
  if (words.has("--resolution") && command.action == Action::CURVES)
    out.question =
        question::Violations{readNumber(words, "--resolution", 0.0, false, "above 0, in units of the parameter")};
}

/* Curves against curves: there is no scene, and a row has one answer. */
void readAgainst(const Words &words, Arguments &out) {
  refuse(words, "--against",
         {"--scene", "--robot", "--srdf", "--state", "--per-object", "--skipped", "--timings", "--allow-empty",
          "--mesh-tolerance", "--max-lod", "--per-link", "--links", "--objects", "--second-opinion"},
         ": curves are measured against curves");
  if (out.action == Action::CURVES) out.action = Action::AGAINST;
  out.against = words.text("--against");
  out.synchronized = words.has("--synchronized");
}

/* What stands there, and the robot. */
void readWorldWords(const Words &words, Arguments &out) {
  for (const char *name : {"--state", "--srdf"})
    if (words.has(name) && !words.has("--robot")) throw BadUsage(std::string(name) + " needs --robot URDF");
  out.scene = words.text("--scene");
  out.robot = words.text("--robot");
  out.srdf = words.text("--srdf");
  out.state = words.text("--state");
}

/* The robot along a trajectory, instead of curves. */
void readTrajectoryWords(const Words &words, Arguments &out) {
  refuse(words, "--trajectory", {"--curves", "--against"});
  if (words.has("--signed") && !asksFor<question::Search>(out.question))
    throw BadUsage("'nearest' takes no --signed with --trajectory: ask for the 'distance'");
  if (!words.has("--robot")) throw BadUsage("--trajectory needs --robot URDF");
  if (out.action == Action::CURVES) out.action = Action::TRAJECTORY;
  out.trajectory = words.text("--trajectory");
  out.shortest_way = words.has("--shortest-way");
  out.self = words.has("--self");
  out.per_link = words.has("--per-link");
  if (out.per_link && words.has("--per-object")) throw BadUsage("--per-link and --per-object exclude each other");
  readWorldWords(words, out);
}

/* A robot along a trajectory, for every execution within bounds of its errors. */
void readErrorsWords(const Words &words, Arguments &out) {
  refuse(words, "--errors",
         {"--per-link", "--per-object", "--horizon", "--second-opinion", "--moving-links-only", "--certificate"});
  out.action = Action::ROBUST;
  out.errors = words.text("--errors");
}

/* What moves in the scene, without a robot of the command line. */
void readMoversWords(const Words &words, Arguments &out) {
  refuse(words, "--movers",
         {"--curves", "--against", "--trajectory", "--signed", "--robot", "--srdf", "--state", "--per-object",
          "--per-link", "--links", "--objects", "--second-opinion", "--errors"});
  if (!words.has("--scene")) throw BadUsage("--movers needs --scene SCENE.yaml: what moves in it is asked about");
  if (out.action == Action::CURVES) out.action = Action::MOVERS;
  out.scene = words.text("--scene");
  out.self = words.has("--self");
}

/* A body along a path, or a ball. A robot carries the body where it has no shapes of its own. */
void readPathWords(const Words &words, Arguments &out) {
  refuse(words, "--path",
         {"--curves", "--against", "--trajectory", "--movers", "--self", "--signed", "--per-link", "--links",
          "--second-opinion", "--errors"});
  if (!words.has("--scene")) throw BadUsage("--path needs --scene SCENE.yaml, what it is measured against");
  if (words.has("--radius") && words.has("--body"))
    throw BadUsage("--radius and --body exclude each other: a ball rides along the path, or the body");
  if (words.has("--radius")) out.radius = readNumber(words, "--radius", 0.0, true, "of at least 0 (metres)");
  if (out.action == Action::CURVES) out.action = Action::MOVERS;
  out.path = words.text("--path");
  out.body = words.text("--body");
  readWorldWords(words, out);
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
    readWorldWords(words, out);
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
        if (words.has("--errors")) readErrorsWords(words, out);
        break;
      }
      if (words.has("--errors")) throw BadUsage("--errors needs --trajectory T.yaml: the errors are a robot's");
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
      if (words.has("--errors") && (!words.has("--trajectory") || words.has("--moving-links-only")))
        throw BadUsage("--errors needs --trajectory T.yaml and takes no --moving-links-only");
      if (words.has("--trajectory")) {
        readTrajectoryWords(words, out);
        out.errors = words.text("--errors");
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
      readWorldWords(words, out);
      break;
    case Action::ROBUST:
      out.errors = required("--errors", "ERRORS.yaml, bounds of the errors of an execution");
      required("--trajectory", "T.yaml");
      readTrajectoryWords(words, out);
      break;
    case Action::SWEEP:
      required("--trajectory", "T.yaml");
      required("--out", "FILE.bt or FILE.stl");
      readTrajectoryWords(words, out);
      if (words.has("--resolution")) out.resolution = readNumber(words, "--resolution", 0.0, false, "above 0 (metres)");
      out.inside = words.text("--inside");
      break;
    case Action::ACM:
      out.robot = required("--robot", "URDF");
      required("--out", "NEW.srdf");
      out.srdf = words.text("--srdf");
      break;
    case Action::SPEED:
      out.separation = required("--separation", "SEPARATION.yaml, the speed of persons and how the robot stops");
      required("--objects", "LIST, the objects in which persons may be");
      out.errors = words.text("--errors");
      required("--trajectory", "T.yaml");
      readTrajectoryWords(words, out);
      out.question = question::Speed{{}, out.profile};
      break;
    case Action::MARGINS:
      if (out.nearest.limits.within == 0.0) throw BadUsage("--within is 0: how far objects are moved at most (metres)");
      out.question = words.has("--within") ? question::Margins{out.nearest.limits.within} : question::Margins{};
      required("--scene", "SCENE.yaml");
      required("--trajectory", "T.yaml");
      readTrajectoryWords(words, out);
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
                            &out.srdf, &out.pairs, &out.cases, &out.errors, &out.separation}) {
    if (*path != "-") continue;
    if (taken) throw BadUsage("'-', standard input, can be only one of the files");
    taken = true;
    *path = kStandardInput;
  }
}

} // namespace

Arguments parseArguments(const std::vector<std::string> &words) {
  Arguments out;
  out.words = words;
  if (words.empty()) throw BadUsage("no command; the commands are " + commandNames() + " (see --help)");

  /* help and version win over everything else on the line */
  const auto said = [&](const char *word) { return std::find(words.begin(), words.end(), word) != words.end(); };
  if (said("--help") || said("-h") || words.front() == "help") {
    for (const std::string &word : words)
      if (out.topic.empty() && findCommand(word)) out.topic = word;
    return out;
  }
  if (said("--version")) {
    out.action = Action::VERSION;
    return out;
  }

  if (words.front() == "completion") {
    if (words.size() != 2 || (words[1] != "bash" && words[1] != "zsh"))
      throw BadUsage("completion: 'completion bash' or 'completion zsh'");
    out.action = Action::COMPLETION;
    out.topic = words[1];
    return out;
  }

  if (words.front() == "man" && words.size() == 1) {
    out.action = Action::MANUAL;
    return out;
  }

  const Command *known = findCommand(words.front());
  if (!known)
    throw BadUsage("'" + words.front() + "' is no command; the commands are " + commandNames() + " (see --help)");
  const Command &command = *known;
  const Words split = splitWords(words, command);
  out.action = command.action;
  readQuery(split, command, out.query);
  readSecondOpinion(split, out);
  readQuestion(split, command, out);
  readFiles(split, command, out);
  readStandardInput(out);

  out.out = split.text("--out");
  if (split.has("--certificate")) out.certificate = split.text("--certificate");
  if (split.has("--certificate") && (out.query.per_object || out.per_link)) {
    throw BadUsage("--certificate takes no --per-object and no --per-link: a certificate is about all pairs at once");
  }
  out.json = split.has("--json");
  out.quiet = split.has("--quiet");
  out.verbose = split.has("-v");
  out.strict = split.has("--strict");
  if (out.quiet && out.verbose) throw BadUsage("--quiet and -v exclude each other");
  out.skipped = split.has("--skipped") || out.verbose;
  if (split.has("--shortest-way") && !out.shortest_way) throw BadUsage("--shortest-way needs --trajectory T.yaml");
  out.timings = split.has("--timings") || out.verbose;
  out.allow_missing_geometry = split.has("--allow-missing-geometry");
  out.packages = readPackages(split);
  if (split.has("--mesh-tolerance"))
    out.mesh_tolerance = readNumber(split, "--mesh-tolerance", 0.0, true, "of at least 0 (metres)");
  out.threads = std::max(1u, std::thread::hardware_concurrency());
  if (split.has("--threads")) out.threads = static_cast<std::size_t>(readCount(split, "--threads", kMostThreads));
  return out;
}

std::vector<std::string> inputsOf(const Arguments &arguments) {
  return {arguments.curves, arguments.against, arguments.trajectory, arguments.path,
          arguments.body,   arguments.scene,   arguments.robot,      arguments.srdf,
          arguments.pairs,  arguments.cases,   arguments.errors,     arguments.separation};
}

} // namespace curve_proximity::cli
