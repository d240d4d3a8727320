/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/nearest_name.hpp>

#include <algorithm>
#include <cctype>

namespace curve_proximity {
namespace {

constexpr std::size_t MOST_NAMES = 4096, MOST_LETTERS = 256;

/* The Levenshtein distance; letters of either case are the same at half a price, so counts are in halves. */
std::size_t halfEdits(const std::string &a, const std::string &b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t k = 0; k <= b.size(); ++k) row[k] = 2 * k;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = 2 * (i + 1);
    for (std::size_t k = 0; k < b.size(); ++k) {
      const bool alike =
          std::tolower(static_cast<unsigned char>(a[i])) == std::tolower(static_cast<unsigned char>(b[k]));
      const std::size_t change = diagonal + (a[i] == b[k] ? 0 : alike ? 1 : 2);
      diagonal = row[k + 1];
      row[k + 1] = std::min({change, row[k] + 2, diagonal + 2});
    }
  }
  return row.back();
}

} // namespace

std::string didYouMean(const std::string &wrong, const std::vector<std::string> &names) {
  if (wrong.empty() || wrong.size() > MOST_LETTERS) return "";
  const std::string *nearest = nullptr;
  std::size_t least = std::max<std::size_t>(2, 2 * (wrong.size() / 3)) + 1;
  for (std::size_t i = 0; i < std::min(names.size(), MOST_NAMES); ++i) {
    if (names[i].size() > MOST_LETTERS) continue;
    const std::size_t edits = halfEdits(wrong, names[i]);
    if (edits >= least) continue;
    least = edits;
    nearest = &names[i];
  }
  return nearest ? " (did you mean '" + *nearest + "'?)" : "";
}

} // namespace curve_proximity
