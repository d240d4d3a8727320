/* SPDX-License-Identifier: BSD-3-Clause */
#include "numbers.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>

#include <locale.h>

namespace curve_proximity::yaml {

std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<double> parseFinite(std::string_view text) {
  text = trimmed(text);
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1); /* "+-1" is no number */

  /* strtod of the C locale: libstdc++ before version 11 has no from_chars for doubles. Its hexadecimal numbers, names
   * and leading blanks are no decimal numbers. */
  static const locale_t c_locale = newlocale(LC_ALL_MASK, "C", nullptr);
  const std::string ended(text);
  const std::size_t first = ended.find_first_not_of('-');
  const bool decimal = first <= 1 && std::strchr(".0123456789", ended[first]) != nullptr;
  if (!decimal || ended.find_first_of("xX") != std::string::npos) return std::nullopt;
  char *stop = nullptr;
  const double value = strtod_l(ended.c_str(), &stop, c_locale);
  if (stop != ended.c_str() + ended.size() || !std::isfinite(value)) return std::nullopt;
  return value; /* what is too small for a double rounds to 0 or a denormal */
}

std::optional<std::uint64_t> parseCount(std::string_view text) {
  text = trimmed(text);
  std::uint64_t value = 0;
  const char *const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (stop != end || error != std::errc() || text.empty() || value > (std::uint64_t{1} << 53)) return std::nullopt;
  return value;
}

} // namespace curve_proximity::yaml
