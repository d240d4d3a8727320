/* SPDX-License-Identifier: BSD-3-Clause */
/** YAML values that know where they stand, so that what is wrong with them can be told. */
#ifndef CURVE_PROXIMITY_YAML_YAML_VALUE_H
#define CURVE_PROXIMITY_YAML_YAML_VALUE_H

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <curve_proximity/core.hpp>
#include <curve_proximity/coverage.hpp>

namespace curve_proximity::yaml {

/** Sentences for a person, each once, in the order in which they were first said. */
class Warnings {
 public:
  /** Of what cannot change geometry. */
  void add(const std::string &sentence) {
    if (known_.insert(sentence).second) sentences_.push_back(sentence);
  }

  /** Of what is not used and could be geometry, or its place: what is read is then a part of what was given. */
  void leaveOut(const std::string &sentence) {
    add(sentence);
    coverage_.add(Gap::PARTIAL, sentence);
  }

  /** The sentences and the coverage of another reading. */
  void add(const Warnings &other) {
    for (const std::string &sentence : other.sentences_) add(sentence);
    coverage_.add(other.coverage_);
  }

  /** What leaveOut() said. */
  const Coverage &coverage() const {
    return coverage_;
  }
  const std::vector<std::string> &sentences() const {
    return sentences_;
  }

 private:
  std::set<std::string> known_;
  std::vector<std::string> sentences_;
  Coverage coverage_;
};

/** A value and its place ("world.collision_objects[2] 'Can1'.primitives[0]"). All functions throw BadInput with the
 * place where the value is not what they ask for. */
class YamlValue {
 public:
  YamlValue(YAML::Node node, std::string where) : node_(std::move(node)), where_(std::move(where)) {}

  const std::string &where() const {
    return where_;
  }
  /** A BadInput: the place, and what is wrong there. */
  [[noreturn]] void fail(const std::string &what) const;

  bool isEmpty() const {
    return node_.IsNull();
  }
  bool isMap() const {
    return node_.IsMap();
  }
  bool isSequence() const {
    return node_.IsSequence();
  }
  bool isScalar() const {
    return node_.IsScalar();
  }

  /** The value of a key of this map; nothing where it is not there or empty ("key:"). */
  std::optional<YamlValue> find(const char *key) const;
  /** The value of a key that must be there. */
  YamlValue at(const char *key) const;

  /** The values of this list; none for an empty value. */
  std::vector<YamlValue> items() const;
  /** The keys of this map with their values, in the order of the file. */
  std::vector<std::pair<std::string, YamlValue>> entries() const;
  /** The list under a key; none where the key is not there. */
  std::vector<YamlValue> itemsOf(const char *key) const;

  /** Says once which keys of this map are not among those known, and that they are ignored. */
  void warnOfOthers(std::initializer_list<const char *> known, Warnings &warnings) const;

  /** The same value, its place spelled with a name that helps to find it. */
  YamlValue named(const std::string &name) const {
    return YamlValue(node_, where_ + " '" + name + "'");
  }

  std::string text() const;
  double number() const;               /**< finite */
  std::size_t count() const;           /**< an integer >= 0 */
  bool truth() const;                  /**< true, false, 1, 0 */
  std::vector<double> numbers() const; /**< a list of finite numbers */

  /** Three coordinates [m], as a map x, y, z or as a list. */
  Eigen::Vector3d vector() const;

  /** A rotation, as a map x, y, z, w or a list in that order, as it stands: not normalised. Norm 0 fails, one beyond
   *  1e-3 from 1 warns. */
  Eigen::Quaterniond quaternion(Warnings &warnings) const;

  /** A pose or a transform: the values of the two keys; each may be absent (0, the identity). */
  cprox_pose pose(Warnings &warnings, const char *position = "position", const char *orientation = "orientation") const;

 private:
  YAML::Node node_;
  std::string where_;
};

/** The whole of a YAML file. Throws BadUsage where it cannot be read or is no YAML, with the line. */
YamlValue loadYaml(const std::string &path);

} // namespace curve_proximity::yaml
#endif
