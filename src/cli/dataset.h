/* SPDX-License-Identifier: BSD-3-Clause */
/** The manifest of a dataset: a row a query, as JSON Lines or as CSV with a header. */
#ifndef CURVE_PROXIMITY_CLI_DATASET_H
#define CURVE_PROXIMITY_CLI_DATASET_H

#include <cstddef>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <curve_proximity/query.hpp>
#include <curve_proximity/trajectory.hpp>

#include "../scene/yaml/yaml_value.h"
#include "exit_code.h"

namespace curve_proximity::cli {

/** The files that a row names, absolute, or relative to the manifest's folder made so; '': none. */
struct RowFiles {
  std::string robot, srdf, scene;
  std::string trajectory; /**< '' where the trajectory stands in the row */
};

/** One row. */
struct DatasetRow {
  std::string id; /**< of the row; absent: its number */
  RowFiles files;
  std::optional<TrajectoryDescription> inline_trajectory; /**< instead of the file */
  QueryType query_type = QueryType::DISTANCE;
  double delta = 0.0;
  bool self = false; /**< the robot against itself, too */
};

/** A row of the manifest as it stands there. */
struct ManifestRow {
  std::size_t number = 0; /**< from 0 */
  std::string text;
};

/** The rows [first, last) of shard `shard` of `shards`: the same cut for the same numbers. */
struct ShardRange {
  std::size_t first = 0, last = 0;
};
ShardRange cut(std::size_t rows, std::size_t shards, std::size_t shard);

/** A manifest. Blank lines, and in CSV lines that begin with #, are no rows. */
class Dataset {
 public:
  /** Reads the file once, to count its rows and for its digest. Throws BadUsage: it cannot be read, or is a CSV file
   *  whose header has a column that is not known or none for robot and trajectory. */
  explicit Dataset(const std::string &path);

  std::size_t rows() const {
    return rows_;
  }
  /** Of all lines of the file. */
  const std::string &digest() const {
    return digest_;
  }
  /** Reads the rows of a range one after the other. */
  class Reader {
   public:
    Reader(const Dataset &dataset, const ShardRange &range);
    std::optional<ManifestRow> next();

   private:
    const Dataset &dataset_;
    std::ifstream stream_;
    std::size_t at_ = 0;
    const ShardRange range_;
  };

  /** Reads the text of a row. Throws BadInput with what is wrong. Any number of threads. */
  DatasetRow parse(const ManifestRow &row) const;

  /** Its files alone, without reading a trajectory in it: a small part of the cost of parse(). Throws BadInput. */
  RowFiles filesOf(const ManifestRow &row) const;

  /** The id of a row, as far as it can be read. Never throws. */
  std::string idOf(const ManifestRow &row) const;

 private:
  bool isRow(const std::string &line) const;
  YamlValue valueOf(const std::string &text) const;
  RowFiles filesIn(const YamlValue &row) const;
  std::string fileOf(const YamlValue &row, const char *key) const;

  const std::string path_, folder_;
  bool is_csv_ = false;
  std::vector<std::string> columns_; /* of CSV */
  std::size_t rows_ = 0;
  std::string digest_;
};

} // namespace curve_proximity::cli
#endif
