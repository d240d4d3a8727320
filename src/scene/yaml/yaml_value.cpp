/* SPDX-License-Identifier: BSD-3-Clause */
#include "yaml_value.h"

#include <yaml-cpp/eventhandler.h>

#include <curve_proximity/nearest_name.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "bad_input.h"
#include "numbers.h"

namespace curve_proximity::yaml {
namespace {

std::string join(const std::string &where, const std::string &key) {
  return where.empty() ? key : where + "." + key;
}

/* The place without what counts list entries, so that a hundred objects give one warning. */
std::string withoutNumbers(const std::string &where) {
  std::string out;
  bool inside = false;
  for (std::size_t i = 0; i < where.size(); ++i) {
    if (where[i] == '[' || where.compare(i, 2, " '") == 0) inside = true;
    if (!inside) out += where[i];
    if (where[i] == ']' || (where[i] == '\'' && where[i - 1] != ' ')) inside = false;
  }
  return out;
}

using Kind = YamlNode::Kind;

int lineOf(const YAML::Mark &mark) {
  return mark.is_null() ? 0 : mark.line + 1;
}

std::string atLine(int line) {
  return "line " + std::to_string(line) + ": ";
}

/* Each key of a map is a word, and stands there once. */
void checkKeys(const YamlNode &map) {
  std::vector<const YamlNode *> keys;
  for (std::size_t i = 0; i < map.items.size(); i += 2) {
    const YamlNode &key = *map.items[i];
    if (key.kind != Kind::SCALAR) throw BadInput(atLine(key.line) + "a key that is no word");
    if (key.scalar == "<<") throw BadInput(atLine(key.line) + "'<<': maps are not merged; write the keys out");
    keys.push_back(&key);
  }
  std::stable_sort(keys.begin(), keys.end(),
                   [](const YamlNode *a, const YamlNode *b) { return a->scalar < b->scalar; });
  const auto twice = std::adjacent_find(keys.begin(), keys.end(),
                                        [](const YamlNode *a, const YamlNode *b) { return a->scalar == b->scalar; });
  if (twice == keys.end()) return;
  throw BadInput(atLine(twice[1]->line) + "the key '" + twice[1]->scalar + "' stands twice: in line " +
                 std::to_string(twice[0]->line) + ", too");
}

/* Takes what the parser finds, document by document. */
class TreeBuilder : public YAML::EventHandler {
 public:
  std::shared_ptr<const YamlDocument> take() {
    return std::move(document_);
  }

  void OnDocumentStart(const YAML::Mark &mark) override {
    if (mark.pos == begun_) throw BadInput(atLine(lineOf(mark)) + "what stands here belongs to nothing before it");
    begun_ = mark.pos;
    document_ = std::make_shared<YamlDocument>();
    anchors_.clear();
    open_.clear();
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark &mark, YAML::anchor_t anchor) override {
    place(make(mark, anchor, Kind::NOTHING));
  }
  void OnAlias(const YAML::Mark &mark, YAML::anchor_t anchor) override {
    const YamlNode *node = anchors_.at(anchor);
    if (std::find(open_.begin(), open_.end(), node) != open_.end())
      throw BadInput(atLine(lineOf(mark)) + "an alias of what it stands in");
    place(node);
  }
  void OnScalar(const YAML::Mark &mark, const std::string &, YAML::anchor_t anchor, const std::string &value) override {
    YamlNode *node = make(mark, anchor, Kind::SCALAR);
    node->scalar = value;
    place(node);
  }
  void OnSequenceStart(const YAML::Mark &mark, const std::string &, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(make(mark, anchor, Kind::LIST));
  }
  void OnSequenceEnd() override {
    open_.pop_back();
  }
  void OnMapStart(const YAML::Mark &mark, const std::string &, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(make(mark, anchor, Kind::MAP));
  }
  void OnMapEnd() override {
    checkKeys(*open_.back());
    open_.pop_back();
  }

 private:
  YamlNode *make(const YAML::Mark &mark, YAML::anchor_t anchor, Kind kind) {
    document_->nodes.emplace_back();
    YamlNode &node = document_->nodes.back();
    node.kind = kind;
    node.line = lineOf(mark);
    if (anchor) anchors_[anchor] = &node;
    return &node;
  }
  void place(const YamlNode *node) {
    if (open_.empty())
      document_->root = node;
    else
      open_.back()->items.push_back(node);
  }
  void open(YamlNode *node) {
    place(node);
    open_.push_back(node);
  }

  std::shared_ptr<YamlDocument> document_;
  std::vector<YamlNode *> open_; /* lists and maps that have not ended */
  std::map<YAML::anchor_t, const YamlNode *> anchors_;
  int begun_ = -1; /* where the document before began: the parser stays where it cannot go on */
};

const YamlNode *copy(const YAML::Node &from, YamlDocument &to) {
  to.nodes.emplace_back();
  YamlNode &out = to.nodes.back();
  out.line = lineOf(from.Mark());
  switch (from.Type()) {
    case YAML::NodeType::Undefined:
    case YAML::NodeType::Null: break;
    case YAML::NodeType::Scalar:
      out.kind = Kind::SCALAR;
      out.scalar = from.Scalar();
      break;
    case YAML::NodeType::Sequence:
      out.kind = Kind::LIST;
      for (const YAML::Node &item : from) out.items.push_back(copy(item, to));
      break;
    case YAML::NodeType::Map:
      out.kind = Kind::MAP;
      for (const auto &entry : from) {
        out.items.push_back(copy(entry.first, to));
        out.items.push_back(copy(entry.second, to));
      }
      break;
  }
  return &out;
}

std::shared_ptr<const YamlDocument> copy(const YAML::Node &from) {
  auto out = std::make_shared<YamlDocument>();
  out->root = copy(from, *out);
  return out;
}

std::string unknownKey(const std::string &key, const std::string &where, std::initializer_list<const char *> known) {
  return "unknown key '" + join(where, key) + "'" + didYouMean(key, {known.begin(), known.end()});
}

} // namespace

YamlValue::YamlValue(const YAML::Node &node, std::string where) : YamlValue(copy(node), std::move(where)) {}

void YamlValue::fail(const std::string &what) const {
  const std::string line = node_->line > 0 ? " (line " + std::to_string(node_->line) + ")" : "";
  throw BadInput((where_.empty() ? "the file" : where_) + line + ": " + what);
}

bool YamlValue::has(const char *key) const {
  if (!isMap()) fail("must be a map");
  for (std::size_t i = 0; i < node_->items.size(); i += 2)
    if (node_->items[i]->scalar == key) return true;
  return false;
}

std::optional<YamlValue> YamlValue::find(const char *key) const {
  if (!isMap()) fail("must be a map");
  for (std::size_t i = 0; i + 1 < node_->items.size(); i += 2) {
    if (node_->items[i]->scalar != key) continue;
    const YamlNode *value = node_->items[i + 1];
    if (value->kind == Kind::NOTHING) return std::nullopt;
    return inside(value, join(where_, key));
  }
  return std::nullopt;
}

YamlValue YamlValue::at(const char *key) const {
  std::optional<YamlValue> value = find(key);
  if (!value) fail("has no '" + std::string(key) + "'");
  return *std::move(value);
}

std::vector<YamlValue> YamlValue::items() const {
  if (isEmpty()) return {};
  if (!isSequence()) fail("must be a list");
  std::vector<YamlValue> out;
  out.reserve(node_->items.size());
  for (const YamlNode *item : node_->items)
    out.push_back(inside(item, where_ + "[" + std::to_string(out.size()) + "]"));
  return out;
}

std::vector<std::pair<std::string, YamlValue>> YamlValue::entries() const {
  if (isEmpty()) return {};
  if (!isMap()) fail("must be a map");
  std::vector<std::pair<std::string, YamlValue>> out;
  for (std::size_t i = 0; i < node_->items.size(); i += 2) {
    const std::string key = inside(node_->items[i], where_).text();
    out.emplace_back(key, inside(node_->items[i + 1], join(where_, key)));
  }
  return out;
}

std::vector<YamlValue> YamlValue::itemsOf(const char *key) const {
  const std::optional<YamlValue> value = find(key);
  return value ? value->items() : std::vector<YamlValue>{};
}

std::vector<const YamlNode *> YamlValue::others(std::initializer_list<const char *> known) const {
  if (!isMap()) fail("must be a map");
  std::vector<const YamlNode *> out;
  for (std::size_t i = 0; i < node_->items.size(); i += 2) {
    const YamlNode *key = node_->items[i];
    if (std::find(known.begin(), known.end(), key->scalar) == known.end()) out.push_back(key);
  }
  return out;
}

void YamlValue::warnOfOthers(std::initializer_list<const char *> known, Warnings &warnings) const {
  for (const YamlNode *key : others(known))
    warnings.leaveOut(unknownKey(key->scalar, withoutNumbers(where_), known) + " is ignored");
}

void YamlValue::refuseOthers(std::initializer_list<const char *> known) const {
  for (const YamlNode *key : others(known)) inside(key, where_).fail(unknownKey(key->scalar, "", known));
}

std::string YamlValue::text() const {
  if (!isScalar()) fail("must be a word");
  return node_->scalar;
}

double YamlValue::number() const {
  const std::optional<double> value = isScalar() ? parseFinite(node_->scalar) : std::nullopt;
  if (!value) fail((isScalar() ? "'" + node_->scalar + "' is" : "is") + " not a finite number");
  return *value;
}

std::size_t YamlValue::count() const {
  const std::optional<std::uint64_t> value = isScalar() ? parseCount(node_->scalar) : std::nullopt;
  if (!value) fail((isScalar() ? "'" + node_->scalar + "' is" : "is") + " not a whole number from 0");
  return static_cast<std::size_t>(*value);
}

bool YamlValue::truth() const {
  bool value = false;
  if (isScalar() && (node_->scalar == "1" || node_->scalar == "0")) return node_->scalar == "1";
  if (!isScalar() || !YAML::convert<bool>::decode(YAML::Node(node_->scalar), value)) fail("must be true or false");
  return value;
}

std::vector<double> YamlValue::numbers() const {
  std::vector<double> out;
  if (isEmpty()) return out;
  if (!isSequence()) fail("must be a list of numbers");
  out.reserve(node_->items.size());
  for (const YamlNode *item : node_->items) {
    const std::optional<double> value = item->kind == Kind::SCALAR ? parseFinite(item->scalar) : std::nullopt;
    if (value)
      out.push_back(*value);
    else
      inside(item, where_ + "[" + std::to_string(out.size()) + "]").number(); /* says so */
  }
  return out;
}

Eigen::Vector3d YamlValue::vector() const {
  if (isMap()) {
    refuseOthers({"x", "y", "z"});
    return {at("x").number(), at("y").number(), at("z").number()};
  }
  if (!isSequence() || node_->items.size() != 3) fail("must be [x, y, z] or a map of x, y and z");
  const std::vector<double> v = numbers();
  return {v[0], v[1], v[2]};
}

Eigen::Quaterniond YamlValue::quaternion(Warnings &warnings) const {
  Eigen::Quaterniond q;
  if (isMap()) {
    refuseOthers({"x", "y", "z", "w"});
    q.coeffs() << at("x").number(), at("y").number(), at("z").number(), at("w").number();
  } else {
    if (!isSequence() || node_->items.size() != 4) fail("must be [x, y, z, w] or a map of x, y, z and w");
    const std::vector<double> v = numbers();
    q.coeffs() << v[0], v[1], v[2], v[3];
  }

  /* the norm, of quaternions whose squares leave the range of a double, too */
  const double norm = q.coeffs().stableNorm();
  if (!(norm > 0.0)) fail("the quaternion's norm is 0");
  if (std::abs(norm - 1.0) > 1e-3) {
    warnings.add(where_ + ": the quaternion's norm is " + std::to_string(norm) + "; it is normalised");
  }
  return q;
}

cprox_pose YamlValue::pose(Warnings &warnings, const char *position, const char *orientation) const {
  warnOfOthers({position, orientation}, warnings);
  cprox_pose out = CPROX_POSE_IDENTITY;
  if (const auto p = find(position)) out.position = toVec3(p->vector());
  if (const auto o = find(orientation)) {
    const Eigen::Quaterniond q = o->quaternion(warnings);
    out.orientation = {q.w(), q.x(), q.y(), q.z()};
  }
  return out;
}

YamlValue loadYaml(const std::string &path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw BadUsage(path + ": is a folder, not a file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw BadUsage(path + ": cannot be read");

  std::shared_ptr<const YamlDocument> out;
  try {
    YAML::Parser parser(stream);
    TreeBuilder builder;
    while (parser.HandleNextDocument(builder)) {
      std::shared_ptr<const YamlDocument> document = builder.take();
      if (document->root->kind == Kind::NOTHING && out) continue;
      if (out && out->root->kind != Kind::NOTHING)
        throw BadInput(atLine(document->root->line) +
                       "a second document ('---'): a file holds one; give each a file of its own, or print one with "
                       "rostopic echo -n1");
      out = std::move(document);
    }
  } catch (const YAML::ParserException &e) {
    throw BadUsage(path + ": line " + std::to_string(e.mark.line + 1) + ": no YAML: " + e.msg);
  } catch (const YAML::Exception &e) {
    throw BadUsage(path + ": no YAML: " + e.msg);
  } catch (const BadInput &e) {
    throw BadUsage(path + ": " + e.what());
  }
  return out ? YamlValue(std::move(out), "") : YamlValue(YAML::Node(), "");
}

} // namespace curve_proximity::yaml
