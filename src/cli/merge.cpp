/* SPDX-License-Identifier: BSD-3-Clause */
/* merge: all shards of a dataset as one table, the same bytes however it was cut. */
#include <algorithm>
#include <filesystem>
#include <map>

#include <curve_proximity/coverage.hpp>

#include "commands.h"
#include "csv.h"
#include "exit_code.h"
#include "results.h"
#include "row_text.h"
#include "run.h"
#include "shard_file.h"

namespace curve_proximity::cli {
namespace {

struct Shard {
  std::string path, header, digest; /* digest: of the rows */
  ShardHead head;
};

struct Counts {
  std::size_t rows = 0;
  std::size_t uncovered = 0; /* rows that do not cover what was given */
  std::map<std::string, std::size_t> verdicts, statuses;
};

/* The columns status and verdict of a row. */
void count(const std::string &row, Counts &counts) {
  constexpr std::size_t kStatus = 3, kVerdict = 4;
  const std::vector<std::string> fields = splitFields(row);
  if (fields.size() <= kVerdict) throw BadInput("a row is too short: '" + row + "'");
  ++counts.rows;
  ++counts.statuses[fields[kStatus]];
  if (!fields[kVerdict].empty()) ++counts.verdicts[fields[kVerdict]];
  if (gapFromName(fields[kStatus])) ++counts.uncovered;
}

Shard readOne(const std::string &path, Counts &counts) {
  Shard out;
  out.path = path;
  Hasher hasher;
  try {
    out.head = readShard(path, out.header, [&](const std::string &row) {
      hasher.add(row);
      count(row, counts);
    });
  } catch (const BadInput &e) {
    throw BadUsage(path + ": " + e.what());
  }
  out.digest = toHex(hasher.finish());
  return out;
}

/* Two shards of one run: what they have in common is the same. */
void requireSameRun(const Shard &a, const Shard &b) {
  if (a.head.fingerprint != b.head.fingerprint)
    throw BadUsage(b.path + ": its fingerprint is not that of " + a.path +
                   ": another manifest, other options or another version");
  if (a.head.shards != b.head.shards || a.header != b.header)
    throw BadUsage(b.path + ": is one of " + std::to_string(b.head.shards) + " shards, " + a.path + " one of " +
                   std::to_string(a.head.shards));
}

std::map<std::size_t, Shard> readAll(const std::string &folder, Counts &counts) {
  std::error_code error;
  std::vector<std::string> paths;
  for (std::filesystem::directory_iterator it(folder, error), end; it != end && !error; it.increment(error)) {
    if (it->path().extension() == ".csv") paths.push_back(it->path().string());
  }
  if (error) throw BadUsage(folder + ": cannot be read: " + error.message());
  std::sort(paths.begin(), paths.end());
  std::map<std::size_t, Shard> shards;
  std::map<std::string, std::pair<std::string, std::string>> inputs; /* digest, and whose, by file */
  for (const std::string &path : paths) {
    if (interrupted(nullptr)) return shards;
    Counts own;
    const Shard shard = readOne(path, own);
    if (!shards.empty()) requireSameRun(shards.begin()->second, shard);
    for (const auto &[file, digest] : shard.head.inputs) {
      const auto [it, is_new] = inputs.emplace(file, std::make_pair(digest, path));
      if (!is_new && it->second.first != digest)
        throw BadUsage(path + ": '" + file + "' was another file when " + it->second.second + " was made");
    }
    const auto [it, is_new] = shards.emplace(shard.head.shard, shard);
    if (!is_new && it->second.digest != shard.digest)
      throw BadUsage(path + ": has other rows than " + it->second.path + ", which is the same shard");
    if (!is_new) continue;
    counts.rows += own.rows;
    counts.uncovered += own.uncovered;
    for (const auto &[name, n] : own.verdicts) counts.verdicts[name] += n;
    for (const auto &[name, n] : own.statuses) counts.statuses[name] += n;
  }
  return shards;
}

/* Every shard is there, and each begins where the one before ends. */
void requireAll(const std::map<std::size_t, Shard> &shards, const std::string &folder) {
  if (shards.empty()) throw BadUsage(folder + ": holds no shard");
  const std::size_t n = shards.begin()->second.head.shards;
  constexpr std::size_t kMostNamed = 10;
  std::string missing;
  std::size_t named = 0;
  for (std::size_t i = 0; i < n && shards.size() < n && named < kMostNamed; ++i) {
    if (shards.count(i) > 0) continue;
    missing += (named++ ? ", " : "") + std::to_string(i);
  }
  if (shards.size() < n)
    throw BadUsage(folder + ": " + std::to_string(n - shards.size()) + " of " + std::to_string(n) +
                   " shards are missing: " + missing + (n - shards.size() > named ? ", …" : ""));
  std::size_t row = 0;
  for (const auto &[number, shard] : shards) {
    if (shard.head.range.first != row)
      throw BadUsage(shard.path + ": begins at row " + std::to_string(shard.head.range.first) + ", not at row " +
                     std::to_string(row));
    row = shard.head.range.last;
  }
}

std::size_t of(const std::map<std::string, std::size_t> &counts, const char *name) {
  const auto it = counts.find(name);
  return it == counts.end() ? 0 : it->second;
}

} // namespace

int mergeShards(const Arguments &arguments, Console &console) {
  catchInterrupts();
  Counts counts;
  const std::map<std::size_t, Shard> shards = readAll(arguments.shard_folder, counts);
  if (interrupted(nullptr)) return kInterrupted;
  requireAll(shards, arguments.shard_folder);

  /* beside its place first: what stands there is whole */
  const std::string beside = arguments.out.empty() ? "" : arguments.out + ".part";
  {
    ResultsFile results(beside, {});
    RowText form(rowForm(arguments.json, arguments.out));
    std::string lines = shards.begin()->second.header + "\n";
    constexpr std::size_t kBlock = 1 << 16;
    for (const auto &[number, shard] : shards) {
      std::string header;
      readShard(shard.path, header, [&](const std::string &row) {
        lines += row + "\n";
        if (lines.size() < kBlock) return;
        results.write(form(lines));
        lines.clear();
      });
      if (!interrupted(nullptr)) continue;
      if (!beside.empty()) std::remove(beside.c_str());
      return kInterrupted;
    }
    results.write(form(lines));
  }
  std::error_code error;
  if (!beside.empty()) std::filesystem::rename(beside, arguments.out, error);
  if (error) throw BadUsage("--out " + arguments.out + ": cannot be written: " + error.message());

  const std::size_t failed = of(counts.statuses, "failed"), missing = of(counts.statuses, "missing");
  const std::size_t violated = of(counts.verdicts, "violated"), undecided = of(counts.verdicts, "undecided");
  console.say(std::to_string(counts.rows) + " rows: " + std::to_string(of(counts.verdicts, "clear")) + " clear, " +
              std::to_string(violated) + " violated, " + std::to_string(undecided) + " undecided, " +
              std::to_string(failed) + " failed, " + std::to_string(missing) + " missing" +
              (counts.uncovered ? ", " + std::to_string(counts.uncovered) + " not covered" : ""));
  if (failed + missing > 0 || counts.rows == 0) return kUnanswered;
  if (violated > 0) return kSomeViolated;
  return undecided + counts.uncovered > 0 ? kSomeUndecided : kAllAnswered;
}

} // namespace curve_proximity::cli
