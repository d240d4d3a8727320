/* SPDX-License-Identifier: BSD-3-Clause */
/** The file that holds the results of one shard: a head, rows of CSV, an end that says that it is whole.
 *
 *    # cprox shard 1
 *    # fingerprint HEX                    manifest, options, version
 *    # shard I of N, rows FIRST to LAST   LAST is the first row of the next shard
 *    # input HEX FILE                     a line for each robot, SRDF and scene
 *    # trajectories HEX                   of all trajectory files of the shard
 *    id,…                                 the rows, the same bytes however the dataset is cut
 *    # end HEX                            of all bytes before this line */
#ifndef CURVE_PROXIMITY_CLI_SHARD_FILE_H
#define CURVE_PROXIMITY_CLI_SHARD_FILE_H

#include <cstdio>
#include <functional>
#include <map>
#include <string>

#include "../scene/base/digest.h"
#include "dataset.h"

namespace curve_proximity::cli {

/** What a shard was made of. */
struct ShardHead {
  std::string fingerprint;
  std::size_t shard = 0, shards = 1;
  ShardRange range;
  std::map<std::string, std::string> inputs; /**< digest by file; of robots, SRDFs, scenes */
  std::string trajectories;                  /**< digest */
};

/** DIR/shard-00003-of-00064.csv */
std::string shardPath(const std::string &folder, std::size_t shard, std::size_t shards);

/** A file that is written beside its place, and put there when it is whole. Not put there, it is removed. */
class ShardWriter {
 public:
  /** Throws BadUsage where the file cannot be written. */
  ShardWriter(std::string path, const ShardHead &head, const std::string &header);
  ~ShardWriter();
  ShardWriter(const ShardWriter &) = delete;
  ShardWriter &operator=(const ShardWriter &) = delete;

  /** Throws std::runtime_error where the disk is full. */
  void write(const std::string &lines);

  /** Writes the end, and puts the file in its place, on the disk before its name. */
  void finish();

 private:
  void put(const std::string &text);
  [[noreturn]] void fail() const;

  const std::string path_, beside_;
  std::FILE *file_ = nullptr;
  Hasher hasher_;
};

/** Reads a whole shard: its head, its header of columns, and each line of its rows. Throws BadInput where the file is
 *  torn, no shard, or cannot be read; then some lines may have been handed out. */
ShardHead readShard(const std::string &path, std::string &header, const std::function<void(const std::string &)> &row);

} // namespace curve_proximity::cli
#endif
