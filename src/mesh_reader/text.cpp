/* SPDX-License-Identifier: BSD-3-Clause */
#include "text.h"

#include <array>
#include <cstdlib>

namespace curve_proximity::mesh_reader {

void Words::endLine() {
  if (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++at_;
  ++at_;
  ++line_;
}

std::string_view Words::next() {
  while (!atEnd() && (isSpace(text_[at_]) || isLineEnd(text_[at_]))) {
    if (isLineEnd(text_[at_])) {
      endLine();
    } else {
      ++at_;
    }
  }
  return nextInLine();
}

std::string_view Words::nextInLine() {
  while (!atEnd() && isSpace(text_[at_])) ++at_;
  const std::size_t begin = at_;
  while (!atEnd() && !isSpace(text_[at_]) && !isLineEnd(text_[at_])) ++at_;
  return text_.substr(begin, at_ - begin);
}

bool Words::skipLine() {
  while (!atEnd() && !isLineEnd(text_[at_])) ++at_;
  if (atEnd()) return false;
  endLine();
  return true;
}

bool isWord(std::string_view word, std::string_view lower_case) {
  if (word.size() != lower_case.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if (lower(word[i]) != lower_case[i]) return false;
  return true;
}

std::optional<double> parseNumber(std::string_view word) {
  std::array<char, 400> text{}; /* longer than any double that is written out */
  if (word.empty() || word.size() >= text.size()) return std::nullopt;
  std::size_t commas = 0;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const char c = word[i];
    if (c == 'x' || c == 'X' || c == 'p' || c == 'P') return std::nullopt; /* hexadecimal */
    if (c == ',' || c == '.') ++commas;
    text[i] = c == ',' ? '.' : c;
  }
  if (commas > 1) return std::nullopt;
  char *end = nullptr;
  const double value = std::strtod(text.data(), &end);
  if (end != text.data() + word.size()) return std::nullopt;
  return value;
}

std::optional<std::int64_t> parseInteger(std::string_view word) {
  const bool negative = !word.empty() && word[0] == '-', sign = negative || (!word.empty() && word[0] == '+');
  if (sign) word.remove_prefix(1);
  constexpr std::size_t DIGITS = 18;
  if (word.empty() || word.size() > DIGITS) return std::nullopt;
  std::int64_t out = 0;
  for (const char c : word) {
    if (c < '0' || c > '9') return std::nullopt;
    out = 10 * out + (c - '0');
  }
  return negative ? -out : out;
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t LONGEST = 40;
  std::string out = "'";
  for (const char c : word.substr(0, LONGEST)) out += c >= ' ' && c <= '~' ? c : '?';
  return out + (word.size() > LONGEST ? "...'" : "'");
}

std::string count(std::uint64_t n, const std::string &what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

} // namespace curve_proximity::mesh_reader
