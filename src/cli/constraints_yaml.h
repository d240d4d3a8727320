/* SPDX-License-Identifier: BSD-3-Clause */
/** CASES.yaml: the request of ~evaluate_constraints. */
#ifndef CURVE_PROXIMITY_CLI_CONSTRAINTS_YAML_H
#define CURVE_PROXIMITY_CLI_CONSTRAINTS_YAML_H

#include <string>
#include <vector>

#include <curve_proximity/scene.hpp>

#include "../providers/constraint_case.h"
#include "../scene/yaml/yaml_value.h"
#include "exit_code.h"
#include "world_files.h"

namespace curve_proximity::cli {

/** The entries of `cases`, each still as YAML. Throws BadUsage where there is no such list. */
std::vector<YamlValue> readCases(const std::string &path, Warnings &warnings);

/** The id of an entry, "" where it has none. Never throws. */
std::string caseId(const YamlValue &entry);

/** One entry; sides without shapes are objects of the scene, links, or what links carry. All stands in the fixed frame,
 * '' or 'world'. The entry's `providers` are not read. Throws BadInput and Error with what is wrong. */
ConstraintCase parseCase(const YamlValue &entry, const World &world, Warnings &warnings);

/** "mode: signal, samples: 9" as parameters. Throws BadUsage. */
ParameterMap parseParameters(const std::string &text);

} // namespace curve_proximity::cli
#endif
