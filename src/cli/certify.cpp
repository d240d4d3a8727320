/* SPDX-License-Identifier: BSD-3-Clause */
/* certify: the rows of a dataset, shard by shard, each into a file that is whole or not there. */
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "../scene/yaml/scene_change.h"
#include "../scene/yaml/trajectory_yaml.h"
#include "commands.h"
#include "csv.h"
#include "dataset.h"
#include "exit_code.h"
#include "finish.h"
#include "json.h"
#include "library.h"
#include "run.h"
#include "shard_file.h"
#include "trajectory.h"

namespace curve_proximity::cli {
namespace {

const char *kColumns = "row,id,kind,status,verdict,lower,upper,t,a,b,lod,nodes,distance_queries,message\n";

/* A field of one line. */
std::string field(std::string text) {
  for (char &c : text) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  return quotedField(text);
}

std::string numberField(double value) {
  char text[40];
  std::snprintf(text, sizeof text, ",%.17g", value);
  return text;
}

/* A row that has no answer: `status` is failed or missing. */
Outcome unanswered(std::size_t row, const std::string &id, const char *status, const std::string &why) {
  Outcome out;
  out.text = std::to_string(row) + ',' + field(id) + ",," + status + ",,,,,,,,,," + field(why) + '\n';
  out.error_messages.push_back("row " + std::to_string(row) + " (id '" + id + "'): " + why);
  return out;
}

void addAnswer(std::size_t row, const std::string &id, const Answer &answer, QueryType query_type, Outcome &out) {
  const cprox_result &result = answer.result;
  std::string line = std::to_string(row) + ',' + field(id) + ',' + answer.kind + ',';
  if (result.status < 0) {
    out.text += line + "failed,,,,,,,,,," + field(answer.message) + '\n';
    out.error_messages.push_back("row " + std::to_string(row) + " (id '" + id + "'): " + answer.message);
    return;
  }
  line += answer.status + ',';
  out.undecided = out.undecided || answer.gap;
  if (query_type != QueryType::DISTANCE) {
    line += cprox_verdict_name(result.verdict);
    out.violated = out.violated || result.verdict == CPROX_VERDICT_VIOLATED;
    out.undecided = out.undecided || result.verdict == CPROX_VERDICT_UNDECIDED;
  }
  line += numberField(result.lower) + numberField(result.upper);
  line += result.obstacle_index >= 0 ? numberField(result.t) : ",";
  line += ',' + field(answer.a) + ',' + field(answer.b) + ',' + cprox_lod_name(result.lod) + ',' +
          std::to_string(result.nodes) + ',' + std::to_string(result.distance_queries) + ',' + field(answer.message);
  out.text += line + '\n';
  out.against_nothing = out.against_nothing || answer.gap == Gap::EMPTY || std::isinf(result.lower);
}

/* A trajectory file: JSON where it begins with a brace, else YAML. */
TrajectoryDescription trajectoryOf(const std::string &path) {
  Warnings warnings;
  std::ifstream stream(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && text[first] == '{') {
    try {
      return readTrajectoryValue(parseJson(text), "", warnings);
    } catch (const BadInput &) {
      /* a file that is YAML in braces; or what is wrong is said with its line */
    }
  }
  return readTrajectory(path, warnings);
}

Outcome answerRow(const Dataset &dataset, const ManifestRow &manifest, const Arguments &arguments, Library &library,
                  Workspace &workspace) {
  std::string id;
  try {
    DatasetRow row = dataset.parse(manifest);
    id = row.id;
    const std::shared_ptr<const Place> place = library.place(row.files.robot, row.files.srdf, row.files.scene);
    if (!place->world) return unanswered(manifest.number, id, place->missing ? "missing" : "failed", place->fault);
    std::error_code error;
    if (!row.inline_trajectory && !std::filesystem::exists(row.files.trajectory, error))
      return unanswered(manifest.number, id, "missing", row.files.trajectory + ": there is no such file");

    const World &world = *place->world;
    TrajectoryDescription trajectory =
        row.inline_trajectory ? std::move(*row.inline_trajectory) : trajectoryOf(row.files.trajectory);
    trajectory.shortest_way = trajectory.shortest_way || arguments.shortest_way;
    if (world.snapshot->robot()) adoptBase(world.srdf.virtual_joints, *world.snapshot->robot(), trajectory);
    const Rest rest = restOf(trajectory, world);
    const RobotMotion motion(place->prepared(trajectory, rest.place), trajectory, rest.joints);
    Query query = arguments.query;
    query.query_type = row.query_type;
    query.delta = row.delta;
    Outcome out;
    Query around = query; // a row about the robot itself that names no scene means that there is none
    around.allow_empty = query.allow_empty || (row.self && row.files.scene.empty());
    addAnswer(manifest.number, id, askEnvironment(motion, around, workspace).front(), row.query_type, out);
    if (row.self) addAnswer(manifest.number, id, askSelf(motion, query, workspace), row.query_type, out);
    return out;
  } catch (const std::bad_alloc &) {
    return unanswered(manifest.number, id.empty() ? std::to_string(manifest.number) : id, "failed",
                      cprox_status_text(CPROX_MEMORY));
  } catch (const std::exception &e) {
    return unanswered(manifest.number, id.empty() ? dataset.idOf(manifest) : id, "failed", e.what());
  }
}

/* ---- what a shard is made of ---- */

/* All that an answer depends on beside the files that the rows name. */
std::string fingerprintOf(const Dataset &dataset, const Arguments &arguments) {
  const cprox_options &options = arguments.query.options;
  char text[120];
  std::snprintf(text, sizeof text, "%a %u %d %d", options.epsilon, static_cast<unsigned>(options.max_nodes),
                static_cast<int>(options.max_lod),
                (arguments.shortest_way ? 1 : 0) + (arguments.query.allow_empty ? 2 : 0));
  Hasher hasher;
  hasher.add(std::string(CPROX_VERSION)).add(std::string(kColumns)).add(std::string(text)).add(dataset.digest());
  return toHex(hasher.finish());
}

ShardHead headOf(const Dataset &dataset, const std::string &folder, const std::string &fingerprint, std::size_t shards,
                 std::size_t shard) {
  ShardHead head;
  head.fingerprint = fingerprint;
  head.shard = shard;
  head.shards = shards;
  head.range = cut(dataset.rows(), shards, shard);
  Hasher trajectories;
  const auto name = [&](const std::string &path) {
    return path.rfind(folder + "/", 0) == 0 ? path.substr(folder.size() + 1) : path;
  };
  const auto input = [&](const std::string &path, bool with_meshes) {
    if (path.empty() || head.inputs.count(name(path)) > 0) return;
    head.inputs[name(path)] = digestOfFile(path, with_meshes);
  };
  Dataset::Reader rows(dataset, head.range);
  while (const std::optional<ManifestRow> manifest = rows.next()) {
    try {
      const RowFiles files = dataset.filesOf(*manifest);
      input(files.robot, true);
      input(files.srdf, false);
      input(files.scene, true);
      if (!files.trajectory.empty()) trajectories.add(digestOfFile(files.trajectory, false));
    } catch (const BadInput &) {
      /* it will be a failed row; the fingerprint has its bytes */
    } catch (const Error &) {
    }
    if (interrupted(nullptr)) break;
  }
  head.trajectories = toHex(trajectories.finish());
  return head;
}

/* Whether a file holds this shard, whole. Says why not, where there is a file. */
bool isWhole(const std::string &path, const ShardHead &wanted, Console &console) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return false;
  try {
    std::string header;
    const ShardHead found = readShard(path, header, [](const std::string &) {});
    const bool same = found.fingerprint == wanted.fingerprint && found.shard == wanted.shard &&
                      found.shards == wanted.shards && found.range.first == wanted.range.first &&
                      found.range.last == wanted.range.last && found.inputs == wanted.inputs &&
                      found.trajectories == wanted.trajectories;
    if (!same) console.say(path + ": was made of other inputs, options or another version: it is done again");
    return same;
  } catch (const BadInput &e) {
    console.say(path + ": " + e.what() + "; it is done again");
    return false;
  }
}

/* ---- progress ---- */

class Progress {
 public:
  Progress(const Arguments &arguments, const ShardHead &head, Console &console)
      : as_json_(arguments.progress == "json"), head_(head), console_(console) {}

  void tell(const Tally &tally, bool at_end) {
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const std::size_t all = head_.range.last - head_.range.first;
    const double rate = seconds > 0.0 ? static_cast<double>(tally.rows) / seconds : 0.0;
    const double left = rate > 0.0 ? static_cast<double>(all - std::min(all, tally.rows)) / rate : 0.0;
    if (as_json_) {
      if (!at_end && std::chrono::duration<double>(now - told_).count() < 1.0) return;
      told_ = now;
      char text[320];
      std::snprintf(text, sizeof text,
                    "{\"shard\": %zu, \"shards\": %zu, \"rows\": %zu, \"done\": %zu, \"rate\": %.1f, \"eta\": %.1f, "
                    "\"violated\": %zu, \"undecided\": %zu, \"failed\": %zu}",
                    head_.shard, head_.shards, all, tally.rows, rate, left, tally.violated, tally.undecided,
                    tally.failed);
      console_.say(text);
      return;
    }
    char text[240];
    std::snprintf(text, sizeof text,
                  "shard %zu of %zu: %zu of %zu rows, %.0f a second, %.0f s to go, %zu violated, %zu undecided, "
                  "%zu failed",
                  head_.shard, head_.shards, tally.rows, all, rate, left, tally.violated, tally.undecided,
                  tally.failed);
    if (at_end)
      console_.say(text);
    else
      console_.progress(text);
  }

 private:
  using Clock = std::chrono::steady_clock;

  const bool as_json_;
  const ShardHead &head_;
  Console &console_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point told_ = start_;
};

/* Whether it came to its end. */
bool answerShard(const Dataset &dataset, const ShardHead &head, const Arguments &arguments, Library &library,
                 Console &console) {
  constexpr std::size_t kMostMessages = 10;
  ShardWriter file(shardPath(arguments.out, head.shard, head.shards), head, kColumns);
  Dataset::Reader reader(dataset, head.range);
  Progress progress(arguments, head, console);
  Rows rows;
  rows.next = [&]() -> std::optional<Task> {
    std::optional<ManifestRow> row = reader.next();
    if (!row) return std::nullopt;
    return [&, manifest = *std::move(row)](Workspace &workspace) {
      if (arguments.failed) return unanswered(manifest.number, dataset.idOf(manifest), "failed", *arguments.failed);
      return answerRow(dataset, manifest, arguments, library, workspace);
    };
  };
  rows.write = [&](const std::string &text) { file.write(text); };
  rows.progress = [&](const Tally &tally) { progress.tell(tally, false); };
  rows.most_messages = kMostMessages;
  const Tally tally = runRows(arguments.threads, rows, console);
  if (tally.interrupted) return false;
  file.finish();
  progress.tell(tally, true);
  return true;
}

} // namespace

int certifyDataset(const Arguments &arguments, Console &console) {
  const Dataset dataset(arguments.dataset);
  std::error_code error;
  std::filesystem::create_directories(arguments.out, error);
  if (!std::filesystem::is_directory(arguments.out, error))
    throw BadUsage("--out " + arguments.out + ": is no folder and cannot be made one");
  if (dataset.rows() == 0) {
    console.say("warning: the input has no rows");
    return kUnanswered;
  }
  catchInterrupts();
  const std::string fingerprint = fingerprintOf(dataset, arguments);
  const std::string folder = yaml::folderOf(arguments.dataset);
  Library library;
  const std::size_t first = arguments.shard.value_or(0), last = arguments.shard.value_or(arguments.shards - 1) + 1;
  for (std::size_t shard = first; shard < last; ++shard) {
    const ShardHead head = headOf(dataset, folder, fingerprint, arguments.shards, shard);
    const std::string name = "shard " + std::to_string(shard) + " of " + std::to_string(arguments.shards);
    if (!interrupted(nullptr) && isWhole(shardPath(arguments.out, shard, arguments.shards), head, console)) {
      console.say(name + " is whole: skipped");
      continue;
    }
    if (interrupted(nullptr) || !answerShard(dataset, head, arguments, library, console)) {
      console.say("interrupted: " + name + " is to be done again");
      return kInterrupted;
    }
  }
  return kAllAnswered;
}

} // namespace curve_proximity::cli
