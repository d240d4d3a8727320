/* SPDX-License-Identifier: BSD-3-Clause */
/** A misspelt name, and the one that was probably meant. */
#ifndef CURVE_PROXIMITY_NEAREST_NAME_HPP
#define CURVE_PROXIMITY_NEAREST_NAME_HPP

#include <string>
#include <vector>

namespace curve_proximity {

/** " (did you mean 'X'?)" for the name that takes the fewest edits from `wrong`, if they are at most a third of its
 *  letters; else "". Letters of another case count half. At most a few thousand names are compared. */
std::string didYouMean(const std::string &wrong, const std::vector<std::string> &names);

/** The keys of a map. */
template <class Map>
std::vector<std::string> namesOf(const Map &map) {
  std::vector<std::string> out;
  for (const auto &entry : map) out.push_back(entry.first);
  return out;
}

} // namespace curve_proximity
#endif
