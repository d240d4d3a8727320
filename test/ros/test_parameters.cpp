/* SPDX-License-Identifier: BSD-3-Clause */
/** The documented parameters are the ones that are read. */
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <fstream>
#include <set>
#include <string>

#include "parameters/parameters.h"

namespace curve_proximity {
namespace {

/** Compares each of the code's defaults with the file's value. */
class Comparer {
 public:
  explicit Comparer(const YAML::Node &file) : file_(file) {}

  template <class Value>
  void operator()(const char *name, const Value &value) {
    EXPECT_EQ(documented(name).as<Value>(), value) << name;
  }

  template <class Value>
  void operator()(const char *name, const Value &value, const Range &range) {
    (*this)(name, value);
    EXPECT_TRUE(range.holds(value)) << name;
  }

  void operator()(const char *name, const std::vector<ProviderSpec> &value) {
    EXPECT_TRUE(documented(name).IsSequence()) << name;
    EXPECT_EQ(file_[name].size(), value.size()) << name;
  }

  void operator()(const char *name, const ObjectDescription &value) {
    EXPECT_EQ(documented(name).size(), 0u) << name;
    EXPECT_TRUE(value.id.empty()) << name;
  }

  std::set<std::string> names;

 private:
  YAML::Node documented(const std::string &name) {
    names.insert(name);
    EXPECT_TRUE(file_[name]) << name << " is not documented";
    return file_[name];
  }

  const YAML::Node &file_;
};

TEST(Parameters, the_documented_defaults_are_the_codes_and_none_is_missing) {
  const YAML::Node file = YAML::LoadFile(CURVE_PROXIMITY_DEFAULTS);
  Comparer comparer(file);
  const Parameters defaults;
  visitParameters(defaults, comparer);
  for (const auto &entry : file) EXPECT_TRUE(comparer.names.count(entry.first.as<std::string>())) << entry.first;
  EXPECT_EQ(file.size(), comparer.names.size());
}

TEST(Parameters, each_is_documented_with_its_unit_and_meaning) {
  std::ifstream file(CURVE_PROXIMITY_DEFAULTS);
  std::string line, comment;
  std::size_t parameters = 0;
  while (std::getline(file, line)) {
    if (!line.empty() && line[0] == '#') {
      comment += line + "\n";
    } else {
      if (line.find(':') != std::string::npos) {
        ++parameters;
        EXPECT_GT(comment.size(), 30u) << line;
        EXPECT_TRUE(comment.find('[') != std::string::npos || comment.find("The name") != std::string::npos) << line;
      }
      comment.clear();
    }
  }
  EXPECT_EQ(parameters, YAML::LoadFile(CURVE_PROXIMITY_DEFAULTS).size());
}

} // namespace
} // namespace curve_proximity
