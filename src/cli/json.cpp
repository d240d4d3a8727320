/* SPDX-License-Identifier: BSD-3-Clause */
#include "json.h"

#include <cstring>

#include "../scene/yaml/numbers.h"

namespace curve_proximity::cli {
namespace {

constexpr int kDeepest = 64;

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

void appendUtf8(unsigned code, std::string &out) {
  const auto put = [&](unsigned byte) { out += static_cast<char>(byte); };
  const auto rest = [&](unsigned bits) { put(0x80U | (bits & 0x3FU)); };
  if (code < 0x80U) {
    put(code);
  } else if (code < 0x800U) {
    put(0xC0U | code >> 6U), rest(code);
  } else if (code < 0x10000U) {
    put(0xE0U | code >> 12U), rest(code >> 6U), rest(code);
  } else {
    put(0xF0U | code >> 18U), rest(code >> 12U), rest(code >> 6U), rest(code);
  }
}

/* The bytes of the UTF-8 character at `at`, which is above 0x7F; 0: it is none (RFC 3629). */
std::size_t utf8Length(const char *at, const char *end) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(at[i]); };
  const unsigned first = byte(0);
  const std::size_t n = first >= 0xC2 && first < 0xE0 ? 2 : first >= 0xE0 && first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
  if (first < 0xC2 || n == 0 || static_cast<std::size_t>(end - at) < n) return 0;
  for (std::size_t i = 1; i < n; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  const bool overlong = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xF0 && byte(1) < 0x90);
  const bool beyond = (first == 0xED && byte(1) >= 0xA0) || (first == 0xF4 && byte(1) >= 0x90);
  return overlong || beyond ? 0 : n;
}

/* The grammar of RFC 8259, from left to right. */
class Parser {
 public:
  Parser(std::string_view text, bool outline)
      : begin_(text.data()), at_(begin_), end_(begin_ + text.size()), outline_(outline) {
    const std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.substr(0, byte_order_mark.size()) == byte_order_mark) at_ += byte_order_mark.size();
  }

  Json whole() {
    Json out;
    value(out, 0);
    blanks();
    if (at_ != end_) fail("something follows the value");
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string &what) const {
    throw BadInput("no JSON: " + what + " (character " + std::to_string(at_ - begin_ + 1) + ")");
  }

  void blanks() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\t' || *at_ == '\n' || *at_ == '\r')) ++at_;
  }

  bool take(char c) {
    blanks();
    if (at_ == end_ || *at_ != c) return false;
    ++at_;
    return true;
  }

  void need(char c, const char *where) {
    if (!take(c)) fail(std::string("there is no '") + c + "' " + where);
  }

  void word(const char *name) {
    const std::size_t n = std::strlen(name);
    if (static_cast<std::size_t>(end_ - at_) < n || std::memcmp(at_, name, n) != 0) fail("a value is missing");
    at_ += n;
  }

  void value(Json &out, int depth) {
    blanks();
    if (at_ == end_) fail("a value is missing at the end");
    switch (*at_) {
      case '{':
      case '[':
        if (depth == kDeepest) fail("it is nested too deep");
        out.kind = *at_ == '{' ? Json::Kind::MAP : Json::Kind::LIST;
        ++at_;
        if (outline_ && depth > 0) return skip();
        return out.kind == Json::Kind::MAP ? map(out, depth + 1) : list(out, depth + 1);
      case '"': out.kind = Json::Kind::TEXT; return text(out.text_value);
      case 't': out.kind = Json::Kind::TRUTH, out.truth_value = true; return word("true");
      case 'f': out.kind = Json::Kind::TRUTH; return word("false");
      case 'n': return word("null");
      default: out.kind = Json::Kind::NUMBER, out.number_value = number();
    }
  }

  void list(Json &out, int depth) {
    if (take(']')) return;
    constexpr std::size_t kUsual = 8; /* joints of an arm */
    out.items.reserve(kUsual);
    do {
      value(out.items.emplace_back(), depth);
    } while (take(','));
    need(']', "at the end of a list");
  }

  void map(Json &out, int depth) {
    if (take('}')) return;
    do {
      blanks();
      if (at_ == end_ || *at_ != '"') fail("the name of a member is missing");
      std::string name;
      text(name);
      if (out.member(name)) fail("'" + name + "' comes twice");
      need(':', "behind the name of a member");
      value(out.members.emplace_back(std::move(name), Json()).second, depth);
    } while (take(','));
    need('}', "at the end of a map");
  }

  /* To the end of a list or map that has begun. */
  void skip() {
    for (int open = 1; open > 0; ++at_) {
      if (at_ == end_) fail("a list or map does not end");
      if (*at_ == '"') {
        while (++at_ != end_ && *at_ != '"')
          if (*at_ == '\\' && ++at_ == end_) break;
        if (at_ == end_) fail("a text does not end");
      } else if (*at_ == '[' || *at_ == '{') {
        ++open;
      } else if (*at_ == ']' || *at_ == '}') {
        --open;
      }
    }
  }

  void text(std::string &out) {
    ++at_;
    for (;;) {
      const char *const plain = at_;
      while (at_ != end_ && *at_ != '"' && *at_ != '\\' && static_cast<signed char>(*at_) >= 0x20) ++at_;
      out.append(plain, at_);
      if (at_ == end_) fail("a text does not end");
      if (*at_ == '"') break;
      if (*at_ == '\\') {
        escaped(out);
      } else if (const std::size_t n = utf8Length(at_, end_)) {
        out.append(at_, n);
        at_ += n;
      } else {
        fail(static_cast<unsigned char>(*at_) < 0x20 ? "a control character stands in a text" : "this is no UTF-8");
      }
    }
    ++at_;
  }

  void escaped(std::string &out) {
    static const char names[] = "\"\\/bfnrt", meanings[] = "\"\\/\b\f\n\r\t";
    if (++at_ == end_) fail("a text does not end");
    if (*at_ != 'u') {
      const char *const found = *at_ ? std::strchr(names, *at_) : nullptr;
      if (!found) fail(std::string("'\\") + *at_ + "' means nothing");
      out += meanings[found - names];
      ++at_;
      return;
    }
    const auto isSurrogate = [](unsigned code, unsigned first) { return code >= first && code < first + 0x400U; };
    unsigned code = hexadecimal();
    if (isSurrogate(code, 0xD800)) {
      const unsigned second = end_ - at_ > 1 && at_[0] == '\\' && at_[1] == 'u' ? (++at_, hexadecimal()) : 0;
      if (!isSurrogate(second, 0xDC00)) fail("half a surrogate pair stands alone");
      code = 0x10000U + ((code - 0xD800U) << 10U) + (second - 0xDC00U);
    } else if (isSurrogate(code, 0xDC00)) {
      fail("half a surrogate pair stands alone");
    }
    appendUtf8(code, out);
  }

  /* The four digits behind the u at which it stands. */
  unsigned hexadecimal() {
    unsigned code = 0;
    ++at_;
    for (int i = 0; i < 4; ++i, ++at_) {
      const char c = at_ == end_ ? '-' : *at_;
      const char lower = static_cast<char>(c | 0x20);
      if (!isDigit(c) && (lower < 'a' || lower > 'f')) fail("\\u needs four hexadecimal digits");
      code = code << 4U | static_cast<unsigned>(isDigit(c) ? c - '0' : lower - 'a' + 10);
    }
    return code;
  }

  void digits() {
    if (at_ == end_ || !isDigit(*at_)) fail("a digit of a number is missing");
    while (at_ != end_ && isDigit(*at_)) ++at_;
  }

  double number() {
    const char *const first = at_;
    if (*at_ != '-' && !isDigit(*at_)) fail("a value is missing");
    if (*at_ == '-') ++at_;
    if (at_ != end_ && *at_ == '0')
      ++at_;
    else
      digits();
    if (at_ != end_ && *at_ == '.') ++at_, digits();
    if (at_ != end_ && (*at_ | 0x20) == 'e') {
      ++at_;
      if (at_ != end_ && (*at_ == '+' || *at_ == '-')) ++at_;
      digits();
    }
    const std::string_view text(first, static_cast<std::size_t>(at_ - first));
    const std::optional<double> value = yaml::parseFinite(text);
    if (!value) fail("the number " + std::string(text) + " is beyond the range of a double");
    return *value;
  }

  const char *begin_, *at_, *end_;
  bool outline_;
};

[[noreturn]] void failKind(const char *what, const char *wanted) {
  throw BadInput(std::string(what) + " must be " + wanted);
}

} // namespace

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
  return Parser(text, false).whole();
}

Json outlineOfJson(std::string_view text) {
  return Parser(text, true).whole();
}

} // namespace curve_proximity::cli
