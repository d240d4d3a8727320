/* SPDX-License-Identifier: BSD-3-Clause */
#include "json.h"

#include <rapidjson/error/en.h>
#include <rapidjson/memorystream.h>
#include <rapidjson/reader.h>
#include <rapidjson/stringbuffer.h>
#include <rapidjson/writer.h>

#include <cmath>

namespace curve_proximity::cli {
namespace {

constexpr std::size_t kDeepestNesting = 64;

/* Receives what the parser finds, in the order of the text. The names are those that the parser asks for. */
class Builder {
 public:
  /* outline: what lists and maps inside hold is left out. */
  Builder(const rapidjson::MemoryStream &at, bool outline, Json &whole) : at_(at), outline_(outline), next_(&whole) {}

  bool Null() {
    return leftOut() || put({});
  }
  bool Bool(bool value) {
    return leftOut() || put(value);
  }
  bool Int(int value) {
    return Double(value);
  }
  bool Uint(unsigned value) {
    return Double(value);
  }
  bool Int64(std::int64_t value) {
    return Double(static_cast<double>(value));
  }
  bool Uint64(std::uint64_t value) {
    return Double(static_cast<double>(value));
  }
  bool Double(double value) {
    return leftOut() || put(value);
  }
  bool RawNumber(const char *, rapidjson::SizeType, bool) {
    return false; /* is not asked for */
  }
  bool String(const char *text, rapidjson::SizeType length, bool) {
    return leftOut() || put(std::string(text, length));
  }
  bool StartObject() {
    return open(Json::Kind::MAP);
  }
  bool Key(const char *text, rapidjson::SizeType length, bool) {
    if (leftOut()) return true;
    std::string name(text, length);
    if (open_.back()->member(name)) fail("'" + name + "' comes twice");
    next_ = &open_.back()->members.emplace_back(std::move(name), Json()).second;
    return true;
  }
  bool EndObject(rapidjson::SizeType) {
    return close();
  }
  bool StartArray() {
    return open(Json::Kind::LIST);
  }
  bool EndArray(rapidjson::SizeType) {
    return close();
  }

  /* Ends with BadInput: what is wrong, and before which character. */
  [[noreturn]] void fail(const std::string &what) const {
    throw BadInput("no JSON: " + what + " (character " + std::to_string(at_.Tell() + 1) + ")");
  }

 private:
  bool leftOut() const {
    return outline_ && depth_ > 1;
  }
  /* Where the value that was found belongs. */
  Json &take() {
    if (open_.empty() || open_.back()->kind == Json::Kind::MAP) return *next_;
    return open_.back()->items.emplace_back();
  }
  bool put(Json value) {
    take() = std::move(value);
    return true;
  }
  bool open(Json::Kind kind) {
    constexpr std::size_t kUsual = 8; /* joints of an arm */
    if (depth_ == kDeepestNesting) fail("it is nested too deep");
    if (!leftOut()) {
      Json &out = take();
      out.kind = kind;
      if (kind == Json::Kind::LIST && !outline_) out.items.reserve(kUsual);
      open_.push_back(&out);
    }
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
  Json *next_;               /* the whole, or the member whose name came last */
  std::vector<Json *> open_; /* lists and maps that have not ended; only the last one grows, so that none moves */
  std::size_t depth_ = 0;
};

Json parse(std::string_view text, bool outline) {
  Json out;
  rapidjson::MemoryStream in(text.data(), text.size());
  const std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.substr(0, byte_order_mark.size()) == byte_order_mark)
    for (std::size_t i = 0; i < byte_order_mark.size(); ++i) in.Take();
  Builder builder(in, outline, out);
  rapidjson::Reader reader;
  constexpr unsigned kFlags = rapidjson::kParseFullPrecisionFlag | rapidjson::kParseValidateEncodingFlag;
  const rapidjson::ParseResult result = reader.Parse<kFlags>(in, builder);
  if (result.IsError()) builder.fail(rapidjson::GetParseError_En(result.Code()));
  if (in.Tell() < text.size()) builder.fail("a byte 0"); /* with which the text would end */
  return out;
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

[[noreturn]] void failKind(const char *what, const char *wanted) {
  throw BadInput(std::string(what) + " must be " + wanted);
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

const Json *Json::member(std::string_view name) const {
  for (const auto &member : members) {
    if (member.first == name) return &member.second;
  }
  return nullptr;
}

const Json *Json::find(std::string_view name) const {
  const Json *found = member(name);
  return found && found->kind != Kind::NOTHING ? found : nullptr;
}

const std::string &Json::text(const char *what) const {
  if (kind != Kind::TEXT) failKind(what, "a text");
  return text_value;
}

double Json::number(const char *what) const {
  if (kind != Kind::NUMBER) failKind(what, "a number");
  return number_value;
}

bool Json::truth(const char *what) const {
  if (kind != Kind::TRUTH) failKind(what, "true or false");
  return truth_value;
}

const std::vector<Json> &Json::list(const char *what) const {
  if (kind != Kind::LIST) failKind(what, "a list");
  return items;
}

std::vector<double> Json::numbers(const char *what) const {
  std::vector<double> out;
  out.reserve(list(what).size());
  for (const Json &item : items) {
    if (item.kind != Kind::NUMBER) failKind(what, "a list of numbers");
    out.push_back(item.number_value);
  }
  return out;
}

Json parseJson(std::string_view text) {
  return parse(text, false);
}

Json outlineOfJson(std::string_view text) {
  return parse(text, true);
}

std::string textOfJson(const Json &value) {
  rapidjson::StringBuffer text;
  Writer out(text);
  write(value, out);
  return {text.GetString(), text.GetSize()};
}

} // namespace curve_proximity::cli
