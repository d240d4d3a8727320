/* SPDX-License-Identifier: BSD-3-Clause */
/** PAIRS.yaml: a list of {id, a: BODY, b: BODY}, and what is asked of them. */
#ifndef CURVE_PROXIMITY_CLI_PAIRS_YAML_H
#define CURVE_PROXIMITY_CLI_PAIRS_YAML_H

#include <string>
#include <vector>

#include "../scene/query/pair_query.h"
#include "../scene/yaml/yaml_value.h"
#include "exit_code.h"

namespace curve_proximity::cli {

/** The entries of the list, each still as YAML. Throws BadUsage where the file is no list. */
std::vector<YamlValue> readPairs(const std::string &path);

/** The id of an entry, "" where it has none. Never throws. */
std::string pairId(const YamlValue &entry);

/** One entry. Throws BadInput with what is wrong, and where. */
PairDescription parsePair(const YamlValue &entry, Warnings &warnings);

} // namespace curve_proximity::cli
#endif
