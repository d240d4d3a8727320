/* SPDX-License-Identifier: BSD-3-Clause */
/* Lines, words and numbers of a text that may hold any bytes. */
#ifndef CURVE_PROXIMITY_MESH_READER_TEXT_H
#define CURVE_PROXIMITY_MESH_READER_TEXT_H

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "check.h"

namespace curve_proximity::mesh_reader {

/* A line break, a space, or the zero bytes with which some programs fill the end of a file. */
inline bool isLineEnd(char c) {
  return c == '\n' || c == '\r';
}
inline bool isSpace(char c) {
  return c == ' ' || c == '\t' || c == '\f' || c == '\v' || c == '\0';
}

/* Word after word, with the number of the line. */
class Words {
 public:
  explicit Words(std::string_view text, std::uint64_t line = 1) : text_(text), line_(line) {}

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
  std::size_t at_ = 0;
  std::uint64_t line_;
};

/* A number as libassimp takes it (a decimal comma is a point); none where the word is something else. May be infinite
 * or NaN. */
std::optional<double> parseNumber(std::string_view word);

/* Digits with or without a sign; none where it does not fit into 62 bits. */
std::optional<std::int64_t> parseInteger(std::string_view word);

/* A word for a sentence: short, printable. */
std::string in_quotes(std::string_view word);

/* "1 triangle", "2 triangles". */
std::string count(std::uint64_t n, const std::string &what);

} // namespace curve_proximity::mesh_reader
#endif
