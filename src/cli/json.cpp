/* SPDX-License-Identifier: BSD-3-Clause */
#include "json.h"

#include <rapidjson/error/en.h>
#include <rapidjson/memorystream.h>
#include <rapidjson/reader.h>
#include <rapidjson/stringbuffer.h>
#include <rapidjson/writer.h>

#include <cmath>
#include <memory>

#include "../scene/yaml/numbers.h"

namespace curve_proximity::cli {
namespace {

constexpr std::size_t kDeepestNesting = 64;

/* Takes what the parser finds, in the order of the text. The names are those that the parser asks for. */
class Builder : public rapidjson::BaseReaderHandler<rapidjson::UTF8<>, Builder> {
 public:
  /* outline: what lists and maps inside hold is left out. */
  Builder(const rapidjson::MemoryStream &at, bool outline, YamlDocument &whole)
      : at_(at), outline_(outline), whole_(whole) {}

  bool Null() {
    return put(Kind::NOTHING, "");
  }
  bool Bool(bool value) {
    return put(Kind::SCALAR, value ? "true" : "false");
  }
  bool RawNumber(const char *text, rapidjson::SizeType length, bool) {
    if (!parseFinite({text, length})) fail(rapidjson::GetParseError_En(rapidjson::kParseErrorNumberTooBig));
    return put(Kind::SCALAR, {text, length});
  }
  bool String(const char *text, rapidjson::SizeType length, bool) {
    return put(Kind::SCALAR, {text, length});
  }
  bool StartObject() {
    return open(Kind::MAP);
  }
  bool Key(const char *text, rapidjson::SizeType length, bool) {
    if (leftOut()) return true;
    const std::vector<const YamlNode *> &known = open_.back()->items;
    for (std::size_t i = 0; i < known.size(); i += 2)
      if (known[i]->scalar == std::string_view(text, length)) fail("'" + known[i]->scalar + "' comes twice");
    return put(Kind::SCALAR, {text, length});
  }
  bool EndObject(rapidjson::SizeType) {
    return close();
  }
  bool StartArray() {
    return open(Kind::LIST);
  }
  bool EndArray(rapidjson::SizeType) {
    return close();
  }

  /* Ends with BadInput: what is wrong, and before which character. */
  [[noreturn]] void fail(const std::string &what) const {
    throw BadInput("no JSON: " + what + " (character " + std::to_string(at_.Tell() + 1) + ")");
  }

 private:
  using Kind = YamlNode::Kind;

  bool leftOut() const {
    return outline_ && depth_ > 1;
  }
  YamlNode *place(Kind kind, std::string_view text) {
    YamlNode &node = whole_.nodes.emplace_back();
    node.kind = kind;
    node.scalar = text;
    if (open_.empty())
      whole_.root = &node;
    else
      open_.back()->items.push_back(&node);
    return &node;
  }
  bool put(Kind kind, std::string_view text) {
    if (!leftOut()) place(kind, text);
    return true;
  }
  bool open(Kind kind) {
    if (depth_ == kDeepestNesting) fail("it is nested too deep");
    if (!leftOut()) open_.push_back(place(kind, ""));
    ++depth_;
    return true;
  }
  bool close() {
    --depth_;
    if (!leftOut()) open_.pop_back();
    return true;
  }

  const rapidjson::MemoryStream &at_;
  bool outline_;
  YamlDocument &whole_;
  std::vector<YamlNode *> open_; /* lists and maps that have not ended */
  std::size_t depth_ = 0;
};

YamlValue parse(std::string_view text, bool outline) {
  auto out = std::make_shared<YamlDocument>();
  rapidjson::MemoryStream in(text.data(), text.size());
  const std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.substr(0, byte_order_mark.size()) == byte_order_mark)
    for (std::size_t i = 0; i < byte_order_mark.size(); ++i) in.Take();
  Builder builder(in, outline, *out);
  rapidjson::Reader reader;
  constexpr unsigned kFlags = rapidjson::kParseNumbersAsStringsFlag | rapidjson::kParseValidateEncodingFlag;
  const rapidjson::ParseResult result = reader.Parse<kFlags>(in, builder);
  if (result.IsError()) builder.fail(rapidjson::GetParseError_En(result.Code()));
  if (in.Tell() < text.size()) builder.fail("a byte 0"); /* with which the text would end */
  return {std::move(out), ""};
}

using Writer = rapidjson::Writer<rapidjson::StringBuffer>;

void writeNumber(double value, Writer &out) {
  constexpr double kWhole = 9007199254740992.0; /* 2^53 */
  if (!std::isfinite(value))
    out.Null();
  else if (value == std::floor(value) && std::abs(value) < kWhole)
    out.Int64(static_cast<std::int64_t>(value));
  else
    out.Double(value);
}

/* What is no UTF-8 becomes U+FFFD. */
void writeText(const std::string &text, Writer &out) {
  rapidjson::MemoryStream in(text.data(), text.size());
  std::string valid;
  while (in.Tell() < text.size()) {
    rapidjson::StringBuffer letter;
    if (rapidjson::UTF8<>::Validate(in, letter))
      valid.append(letter.GetString(), letter.GetSize());
    else
      valid += "\xEF\xBF\xBD";
  }
  out.String(valid.data(), static_cast<rapidjson::SizeType>(valid.size()));
}

void write(const Json &value, Writer &out) {
  switch (value.kind) {
    case Json::Kind::NOTHING: out.Null(); return;
    case Json::Kind::TRUTH: out.Bool(value.truth_value); return;
    case Json::Kind::NUMBER: return writeNumber(value.number_value, out);
    case Json::Kind::TEXT: return writeText(value.text_value, out);
    case Json::Kind::LIST:
      out.StartArray();
      for (const Json &item : value.items) write(item, out);
      out.EndArray();
      return;
    case Json::Kind::MAP:
      out.StartObject();
      for (const auto &[name, member] : value.members) {
        writeText(name, out);
        write(member, out);
      }
      out.EndObject();
  }
}

} // namespace

Json Json::listOf(std::vector<Json> items) {
  Json out;
  out.kind = Kind::LIST;
  out.items = std::move(items);
  return out;
}

Json Json::mapOf(std::vector<std::pair<std::string, Json>> members) {
  Json out;
  out.kind = Kind::MAP;
  out.members = std::move(members);
  return out;
}

Json &Json::operator[](const std::string &name) {
  kind = Kind::MAP;
  for (auto &[known, value] : members)
    if (known == name) return value;
  return members.emplace_back(name, Json()).second;
}

YamlValue parseJson(std::string_view text) {
  return parse(text, false);
}

YamlValue outlineOfJson(std::string_view text) {
  return parse(text, true);
}

std::string textOfJson(const Json &value) {
  rapidjson::StringBuffer text;
  Writer out(text);
  write(value, out);
  return {text.GetString(), text.GetSize()};
}

} // namespace curve_proximity::cli
