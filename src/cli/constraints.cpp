/* SPDX-License-Identifier: BSD-3-Clause */
#include <cstdio>

#include "../providers/constraint_case.h"
#include "../scene/yaml/scene_change.h"
#include "../scene/yaml/scene_yaml.h"
#include "commands.h"
#include "constraints_yaml.h"
#include "csv.h"
#include "failure.h"
#include "finish.h"
#include "packages.h"
#include "results.h"
#include "run.h"
#include "world.h"

namespace curve_proximity::cli {
namespace {

const char *kHeader =
    "id,provider,status,value,lower,upper,valid,t,ga_vx,ga_vy,ga_vz,ga_wx,ga_wy,ga_wz,gb_vx,gb_vy,gb_vz,gb_wx,gb_wy,"
    "gb_wz,a_x,a_y,a_z,b_x,b_y,b_z,n_x,n_y,n_z,g_radius,microseconds,message,n,g0x,g0y,g0z\n";

/* A number and the comma before it. */
void append(std::string &line, double value) {
  char text[40];
  std::snprintf(text, sizeof text, ",%.17g", value);
  line += text;
}

void append(std::string &line, const Eigen::Vector3d &v, bool known = true) {
  for (int i = 0; i < 3; ++i) {
    if (known)
      append(line, v[i]);
    else
      line += ',';
  }
}

/* A row without an answer has a status and a message alone. */
std::string toLine(const ConstraintRow &row) {
  const ConstraintValue &value = row.value;
  std::string line = quotedField(row.id) + ',' + quotedField(row.provider) + ',' + cprox_status_name(row.status);
  if (row.status < 0) return line + std::string(29, ',') + quotedField(row.message) + ",,,,\n";
  append(line, value.value);
  if (value.bounded) {
    append(line, value.lower);
    append(line, value.upper);
  } else {
    line += ",,";
  }
  line += value.valid ? ",true" : ",false";
  const bool along = value.points.cols() > 0;
  if (along)
    append(line, value.t);
  else
    line += ',';
  for (const ConstraintGradient *side : {&value.a, &value.b}) {
    append(line, side->linear);
    append(line, side->angular);
  }
  for (const Eigen::Vector3d *point : {&value.witness_a, &value.witness_b, &value.normal})
    append(line, *point, value.has_points);
  append(line, value.radius);
  char time[40];
  std::snprintf(time, sizeof time, ",%.1f,", row.microseconds);
  line += time + quotedField(row.message) + ',' + std::to_string(value.points.cols());
  for (Eigen::Index i = 0; i < value.points.cols(); ++i) append(line, value.points.col(i));
  return line + (along ? "\n" : ",,,\n");
}

/* The objects of --scene; none without. */
SnapshotPtr readObjects(const Arguments &arguments, const ResourceOptions &resources, Warnings &warnings) {
  if (!arguments.scene.empty()) return readWorld(arguments, warnings).snapshot;
  return Scene(nullptr, resources).snapshot();
}

/* The one provider. Whatever is wrong with it, there is nothing to answer. */
std::unique_ptr<ProviderSet> loadProvider(const Arguments &arguments) {
  std::unique_ptr<ProviderSet> set;
  const std::string why = sentenceOf([&] {
    const std::vector<ProviderSpec> specs = {
        {arguments.provider, arguments.provider, parseParameters(arguments.parameters)}};
    set = std::make_unique<ProviderSet>(specs);
  });
  if (!set) throw BadUsage("--provider " + arguments.provider + ": " + why);
  const LoadedProvider &loaded = set->all().front();
  if (!loaded.provider) throw BadUsage("--provider " + arguments.provider + " failed to load: " + loaded.failure);
  return set;
}

/* Answers a case, or says why it cannot be asked about. */
Outcome answerOne(ProviderSet &providers, ConstraintCase described, const std::string &fault,
                  const std::string &provider, const std::string &place, const ResourceOptions &resources,
                  Workspace &workspace) {
  ConstraintRow row = failedRow(described.id, fault);
  if (fault.empty()) {
    described.providers = {provider};
    row = answerCase(providers, described, resources, workspace).front();
  }
  row.provider = provider;
  Outcome out;
  out.text = toLine(row);
  if (row.status < 0) out.complaints.push_back(place + ": " + row.message);
  return out;
}

} // namespace

int answerConstraints(const Arguments &arguments, Console &console) {
  Warnings warnings;
  const std::vector<YamlValue> entries = readCases(arguments.cases, warnings);
  ResourceOptions resources;
  resources.base_dir = folderOf(arguments.cases);
  resources.find_package = packageFinder(resources.base_dir);
  const SnapshotPtr snapshot = readObjects(arguments, resources, warnings);
  const std::unique_ptr<ProviderSet> providers = loadProvider(arguments);
  ResultsFile results(arguments.out, {arguments.cases, arguments.scene});

  /* case by case; a warning is told when it first comes up */
  catchInterrupts();
  results.write(kHeader);
  std::size_t given = 0, warned = 0;
  Rows rows;
  rows.next = [&]() -> std::optional<Task> {
    if (given == entries.size()) return std::nullopt;
    const YamlValue &entry = entries[given++];
    ConstraintCase described;
    described.id = caseId(entry);
    const std::string place = arguments.cases + ": case " + std::to_string(given) + " (id '" + described.id + "')";
    const std::string fault = sentenceOf([&] { described = parseCase(entry, *snapshot, warnings); });
    for (; warned < warnings.sentences().size(); ++warned) console.say("warning: " + warnings.sentences()[warned]);
    return [&, described, fault, place](Workspace &workspace) {
      return answerOne(*providers, described, fault, arguments.provider, place, resources, workspace);
    };
  };
  rows.write = [&](const std::string &text) { results.write(text); };
  rows.portion = [&]() -> std::optional<double> {
    return entries.empty() ? 1.0 : static_cast<double>(given) / static_cast<double>(entries.size());
  };
  return finish(runRows(arguments.threads, rows, console), console);
}

} // namespace curve_proximity::cli
