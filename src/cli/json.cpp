/* SPDX-License-Identifier: BSD-3-Clause */
#include "json.h"

#include <charconv>
#include <cmath>
#include <cstdint>

namespace curve_proximity::cli {
namespace {

constexpr int kDeepest = 64;

void appendUtf8(std::uint32_t code, std::string &out) {
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xC0 | (code >> 6));
    out += static_cast<char>(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    out += static_cast<char>(0xE0 | (code >> 12));
    out += static_cast<char>(0x80 | ((code >> 6) & 0x3F));
    out += static_cast<char>(0x80 | (code & 0x3F));
  } else {
    out += static_cast<char>(0xF0 | (code >> 18));
    out += static_cast<char>(0x80 | ((code >> 12) & 0x3F));
    out += static_cast<char>(0x80 | ((code >> 6) & 0x3F));
    out += static_cast<char>(0x80 | (code & 0x3F));
  }
}

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Json whole() {
    Json out = value(0);
    skipBlanks();
    if (at_ != text_.size()) fail("something follows the value");
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string &what) const {
    throw BadInput("no JSON: " + what + " (character " + std::to_string(at_ + 1) + ")");
  }

  void skipBlanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r'))
      ++at_;
  }

  bool take(char c) {
    skipBlanks();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  void expect(char c) {
    if (!take(c)) fail(std::string("'") + c + "' is expected");
  }

  bool takeWord(std::string_view word) {
    if (text_.substr(at_, word.size()) != word) return false;
    at_ += word.size();
    return true;
  }

  Json value(int depth) {
    if (depth > kDeepest) fail("it is nested too deep");
    skipBlanks();
    if (at_ == text_.size()) fail("it ends early");
    Json out;
    const char c = text_[at_];
    if (c == '{') {
      readMap(depth, out);
    } else if (c == '[') {
      readList(depth, out);
    } else if (c == '"') {
      out.kind = Json::Kind::TEXT;
      out.text_value = readText();
    } else if (takeWord("true") || takeWord("false")) {
      out.kind = Json::Kind::TRUTH;
      out.truth_value = c == 't';
    } else if (!takeWord("null")) {
      readNumber(out);
    }
    return out;
  }

  void readMap(int depth, Json &out) {
    out.kind = Json::Kind::MAP;
    expect('{');
    if (take('}')) return;
    do {
      skipBlanks();
      if (at_ == text_.size() || text_[at_] != '"') fail("a name in quotes is expected");
      std::string name = readText();
      for (const auto &member : out.members) {
        if (member.first == name) fail("'" + name + "' comes twice");
      }
      expect(':');
      out.members.emplace_back(std::move(name), value(depth + 1));
    } while (take(','));
    expect('}');
  }

  void readList(int depth, Json &out) {
    out.kind = Json::Kind::LIST;
    expect('[');
    if (take(']')) return;
    do out.items.push_back(value(depth + 1));
    while (take(','));
    expect(']');
  }

  void readNumber(Json &out) {
    const char *begin = text_.data() + at_, *end = text_.data() + text_.size();
    const std::from_chars_result found = std::from_chars(begin, end, out.number_value);
    const bool proper = begin < end && (*begin == '-' || (*begin >= '0' && *begin <= '9'));
    if (!proper || found.ec != std::errc() || !std::isfinite(out.number_value)) fail("no value that is known");
    out.kind = Json::Kind::NUMBER;
    at_ += static_cast<std::size_t>(found.ptr - begin);
  }

  std::uint32_t readHex() {
    std::uint32_t code = 0;
    if (at_ + 4 > text_.size()) fail("a \\u needs four digits");
    const char *begin = text_.data() + at_;
    if (std::from_chars(begin, begin + 4, code, 16).ptr != begin + 4) fail("a \\u needs four digits");
    at_ += 4;
    return code;
  }

  void readEscape(std::string &out) {
    const char c = at_ < text_.size() ? text_[at_++] : '\0';
    switch (c) {
      case '"':
      case '\\':
      case '/': out += c; return;
      case 'b': out += '\b'; return;
      case 'f': out += '\f'; return;
      case 'n': out += '\n'; return;
      case 'r': out += '\r'; return;
      case 't': out += '\t'; return;
      case 'u': break;
      default: fail("no escape that is known");
    }
    std::uint32_t code = readHex();
    if (code >= 0xD800 && code < 0xDC00) { // the first of two
      if (!takeWord("\\u")) fail("half of a character");
      const std::uint32_t low = readHex();
      if (low < 0xDC00 || low >= 0xE000) fail("half of a character");
      code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
    } else if (code >= 0xDC00 && code < 0xE000) {
      fail("half of a character");
    }
    appendUtf8(code, out);
  }

  std::string readText() {
    std::string out;
    ++at_; // the quote
    while (true) {
      const std::size_t next = text_.find_first_of("\"\\", at_);
      if (next == std::string_view::npos) fail("a text that does not end");
      out.append(text_.substr(at_, next - at_));
      at_ = next + 1;
      if (text_[next] == '"') break;
      readEscape(out);
    }
    return out;
  }

  const std::string_view text_;
  std::size_t at_ = 0;
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

Json parseJson(std::string_view text) {
  return Parser(text).whole();
}

} // namespace curve_proximity::cli
