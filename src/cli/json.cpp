/* SPDX-License-Identifier: BSD-3-Clause */
#include "json.h"

#include <nlohmann/json.hpp>

namespace curve_proximity::cli {
namespace {

using Parsed = nlohmann::json;

constexpr std::size_t kDeepest = 64;

[[noreturn]] void fail(const std::string &what) {
  throw BadInput("no JSON: " + what);
}

/* Receives what the parser finds, in the order of the text. The names are those that the parser asks for. */
class Builder {
 public:
  explicit Builder(Json &whole) : next_(&whole) {}

  bool null() {
    take();
    return true;
  }
  bool boolean(bool value) {
    Json &out = take();
    out.kind = Json::Kind::TRUTH, out.truth_value = value;
    return true;
  }
  bool number_integer(Parsed::number_integer_t value) {
    return number(static_cast<double>(value));
  }
  bool number_unsigned(Parsed::number_unsigned_t value) {
    return number(static_cast<double>(value));
  }
  bool number_float(Parsed::number_float_t value, const std::string &) {
    return number(value);
  }
  bool string(std::string &value) {
    Json &out = take();
    out.kind = Json::Kind::TEXT, out.text_value = std::move(value);
    return true;
  }
  template <typename Binary>
  bool binary(Binary &) {
    fail("bytes"); // of other formats; the parser of older versions does not know them
  }
  bool start_object(std::size_t) {
    return open(Json::Kind::MAP);
  }
  bool key(std::string &name) {
    for (const auto &member : open_.back()->members) {
      if (member.first == name) fail("'" + name + "' comes twice");
    }
    open_.back()->members.emplace_back(std::move(name), Json());
    next_ = &open_.back()->members.back().second;
    return true;
  }
  bool end_object() {
    return close();
  }
  bool start_array(std::size_t) {
    return open(Json::Kind::LIST);
  }
  bool end_array() {
    return close();
  }
  bool parse_error(std::size_t position, const std::string &, const Parsed::exception &error) {
    const std::string what = error.what(); // "[json.exception.parse_error.101] parse error at line 1, column 2: why"
    const std::size_t why = what.find(": ");
    fail((why == std::string::npos ? what : what.substr(why + 2)) + " (character " + std::to_string(position) + ")");
  }

 private:
  /* Where the value that was found belongs. */
  Json &take() {
    if (open_.empty() || open_.back()->kind == Json::Kind::MAP) return *next_;
    open_.back()->items.emplace_back();
    return open_.back()->items.back();
  }
  bool number(double value) {
    Json &out = take();
    out.kind = Json::Kind::NUMBER, out.number_value = value;
    return true;
  }
  bool open(Json::Kind kind) {
    if (open_.size() == kDeepest) fail("it is nested too deep");
    Json &out = take();
    out.kind = kind;
    open_.push_back(&out);
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  Json *next_;               // the whole, or the member whose name came last
  std::vector<Json *> open_; // lists and maps that have not ended; only the last one grows, so that none moves
};

[[noreturn]] void failKind(const char *what, const char *wanted) {
  throw BadInput(std::string(what) + " must be " + wanted);
}

} // namespace

const Json *Json::find(std::string_view name) const {
  for (const auto &member : members) {
    if (member.first == name) return member.second.kind == Kind::NOTHING ? nullptr : &member.second;
  }
  return nullptr;
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

std::string withoutNested(std::string_view text) {
  std::string out;
  int depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool opens = !in_text && (c == '{' || c == '['), closes = !in_text && (c == '}' || c == ']');
    if (closes) --depth;
    if (depth < 2) out += c;
    if (opens) ++depth;
    if (c == '"') in_text = !in_text;
    if (in_text && c == '\\' && i + 1 < text.size() && depth < 2) out += text[i + 1];
    if (in_text && c == '\\') ++i;
  }
  return out;
}

Json parseJson(std::string_view text) {
  Json whole;
  Builder builder(whole);
  Parsed::sax_parse(text.begin(), text.end(), &builder);
  return whole;
}

} // namespace curve_proximity::cli
