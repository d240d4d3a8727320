/* SPDX-License-Identifier: BSD-3-Clause */
#include "numbers.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>

namespace curve_proximity::yaml {

std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<double> parseFinite(std::string_view text) {
  text = trimmed(text);

  /* from_chars knows no leading plus, and "+-1" shall not become a number either */
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);

  double value = 0.0;
  const char *const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (stop != end || text.empty()) return std::nullopt;

  /* "out of range" is said of numbers that are too small, too: those round to 0 or a denormal as anywhere else */
  if (error == std::errc::result_out_of_range) {
    value = std::strtod(std::string(text).c_str(), nullptr);
    return std::abs(value) < 1.0 ? std::optional<double>(value) : std::nullopt;
  }
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  return value;
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
