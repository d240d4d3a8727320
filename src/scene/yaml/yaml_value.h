/* SPDX-License-Identifier: BSD-3-Clause */
/** YAML values that know where they stand, so that what is wrong with them can be told. */
#ifndef CURVE_PROXIMITY_YAML_YAML_VALUE_H
#define CURVE_PROXIMITY_YAML_YAML_VALUE_H

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <deque>
#include <initializer_list>
#include <memory>
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
  void add(const std::string &message) {
    if (known_.insert(message).second) messages_.push_back(message);
  }

  /** Of what is not used and could be geometry, or its place: what is read is then a part of what was given. */
  void leaveOut(const std::string &message, Missing missing = Missing::ANYTHING) {
    add(message);
    coverage_.add(Gap::PARTIAL, message, missing);
  }

  /** The messages and the coverage of another reading. */
  void add(const Warnings &other) {
    for (const std::string &message : other.messages_) add(message);
    coverage_.add(other.coverage_);
  }

  /** What leaveOut() said. */
  const Coverage &coverage() const {
    return coverage_;
  }
  const std::vector<std::string> &messages() const {
    return messages_;
  }

 private:
  std::set<std::string> known_;
  std::vector<std::string> messages_;
  Coverage coverage_;
};

/** A value as it stands in a text. `items` are the entries of a list; of a map its keys, which are scalars, each with
 *  its value behind it. */
struct YamlNode {
  enum class Kind { NOTHING, SCALAR, LIST, MAP };

  Kind kind = Kind::NOTHING;
  int line = 0; /**< from 1; 0: no text */
  std::string scalar;
  std::vector<const YamlNode *> items;
};

/** A YAML text's values. Nodes that are aliases of each other are one. */
struct YamlDocument {
  std::deque<YamlNode> nodes;
  const YamlNode *root = nullptr;
};

/** A value and its place ("world.collision_objects[2] 'Can1'.primitives[0]"). All functions throw BadInput with the
 * place where the value is not what they ask for. */
class YamlValue {
 public:
  YamlValue(std::shared_ptr<const YamlDocument> document, std::string where)
      : document_(std::move(document)), node_(document_->root), where_(std::move(where)) {}
  /** A value that was made in memory. */
  YamlValue(const YAML::Node &node, std::string where);

  const std::string &where() const {
    return where_;
  }
  /** A BadInput: the place, and what is wrong there. */
  [[noreturn]] void fail(const std::string &what) const;

  bool isEmpty() const {
    return node_->kind == YamlNode::Kind::NOTHING;
  }
  bool isMap() const {
    return node_->kind == YamlNode::Kind::MAP;
  }
  bool isSequence() const {
    return node_->kind == YamlNode::Kind::LIST;
  }
  bool isScalar() const {
    return node_->kind == YamlNode::Kind::SCALAR;
  }

  /** Whether this map has the key, with a value or without. */
  bool has(const char *key) const;
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

  /** Says once which keys of this map are not among those known: they are left out, and what was read is partial. */
  void warnOfOthers(std::initializer_list<const char *> known, Warnings &warnings) const;

  /** Fails where a key of this map is not among those known. */
  void refuseOthers(std::initializer_list<const char *> known) const;

  /** The same value, its place spelled with a name that helps to find it. */
  YamlValue named(const std::string &name) const {
    return YamlValue(document_, node_, where_ + " '" + name + "'");
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
  YamlValue(std::shared_ptr<const YamlDocument> document, const YamlNode *node, std::string where)
      : document_(std::move(document)), node_(node), where_(std::move(where)) {}
  YamlValue inside(const YamlNode *node, std::string where) const {
    return {document_, node, std::move(where)};
  }

  /* the keys of this map that are not known */
  std::vector<const YamlNode *> others(std::initializer_list<const char *> known) const;

  std::shared_ptr<const YamlDocument> document_;
  const YamlNode *node_;
  std::string where_;
};

/** The whole of a YAML file. Throws BadUsage, with the line, where it cannot be read or is no YAML, where a key stands
 *  twice in a map, and where further documents (`---`) hold anything: empty ones may follow. */
YamlValue loadYaml(const std::string &path);

} // namespace curve_proximity::yaml
#endif
