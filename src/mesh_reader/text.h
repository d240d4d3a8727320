/* SPDX-License-Identifier: BSD-3-Clause */
/* Lines, words and numbers of a text that may hold any bytes. */
#ifndef CURVE_PROXIMITY_MESH_READER_TEXT_H
#define CURVE_PROXIMITY_MESH_READER_TEXT_H

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "mesh_builder.h"

namespace curve_proximity::mesh_reader {

/* A line break, a space, or the zero bytes with which some programs fill the end of a file. */
inline bool isLineEnd(char c) {
  return c == '\n' || c == '\r';
}
inline bool isSpace(char c) {
  return c == ' ' || c == '\t' || c == '\f' || c == '\v' || c == '\0';
}

/* An ASCII letter in lower case, any other character as it is. */
inline char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/* The mark with which some programs begin a text of UTF-8. */
constexpr std::string_view BYTE_ORDER_MARK = "\xef\xbb\xbf";

/* Word after word, with the number of the line; without the byte order mark. */
class Words {
 public:
  explicit Words(std::string_view text, std::uint64_t line = 1)
      : text_(text),
        at_(text.substr(0, BYTE_ORDER_MARK.size()) == BYTE_ORDER_MARK ? BYTE_ORDER_MARK.size() : 0),
        line_(line) {}

  /* The next word; empty at the end. */
  std::string_view next();

  /* The next word where it is in this line; empty where the line ends first. */
  std::string_view nextInLine();

  /* Goes to the beginning of the next line. False where there is none. */
  bool skipLine();

  bool atEnd() const {
    return at_ == text_.size();
  }
  /* Of the last word, or where skipLine() went. */
  std::uint64_t line() const {
    return line_;
  }
  std::size_t position() const {
    return at_;
  }
  [[noreturn]] void fail(const std::string &what) const {
    throw Fault("line " + std::to_string(line_) + ": " + what);
  }

 private:
  void endLine();

  std::string_view text_;
  std::size_t at_;
  std::uint64_t line_;
};

/* Whether a word is this one, given in lower case; letters count in either case. */
bool isWord(std::string_view word, std::string_view lower_case);

/* The double nearest to a decimal number (a decimal comma is a point); none where the word is something else. May be
 * infinite or NaN. */
std::optional<double> parseNumber(std::string_view word);

/* Digits with or without a sign; none where it does not fit into 62 bits. */
std::optional<std::int64_t> parseInteger(std::string_view word);

/* A word for a message: short, printable. */
std::string in_quotes(std::string_view word);

/* "1 triangle", "2 triangles". */
std::string count(std::uint64_t n, const std::string &what);

/* The next three words as finite coordinates; fails at `words`. */
template <class Next>
Point readPoint(Next next, const Words &words) {
  Point out{};
  for (double &x : out) {
    const std::string_view word = next();
    const std::optional<double> number = parseNumber(word);
    if (!number)
      words.fail("a vertex needs three numbers" + (word.empty() ? std::string() : ": " + in_quotes(word) + " is none"));
    if (!std::isfinite(*number)) words.fail("a vertex is not finite");
    x = *number;
  }
  return out;
}

} // namespace curve_proximity::mesh_reader
#endif
