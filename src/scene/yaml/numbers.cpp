/* SPDX-License-Identifier: BSD-3-Clause */
#include "numbers.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
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

  /* hexadecimal numbers, names and leading blanks, which strtod takes, are no decimal numbers */
  const std::size_t first = text.find_first_not_of('-');
  const bool decimal = first <= 1 && std::string_view(".0123456789").find(text[first]) != std::string_view::npos;
  if (!decimal) return std::nullopt;
#if defined(__cpp_lib_to_chars) /* libstdc++ from version 11; it has no answer for what rounds to 0 or a denormal */
  double quick = 0.0;
  const auto [read, error] = std::from_chars(text.data(), text.data() + text.size(), quick);
  if (error == std::errc() && read == text.data() + text.size()) return quick;
#endif
  if (text.find_first_of("xX") != std::string_view::npos) return std::nullopt;
  static const locale_t c_locale = newlocale(LC_ALL_MASK, "C", nullptr);
  const std::string ended(text);
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
