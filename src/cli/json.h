/* SPDX-License-Identifier: BSD-3-Clause */
/** JSON as values: for the lines of a dataset, which must cost little beside a search. */
#ifndef CURVE_PROXIMITY_CLI_JSON_H
#define CURVE_PROXIMITY_CLI_JSON_H

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "failure.h"

namespace curve_proximity::cli {

/** A value. The functions that take it for something throw BadInput where it is something else, and name it. */
struct Json {
  enum class Kind { NOTHING, TRUTH, NUMBER, TEXT, LIST, MAP };

  Kind kind = Kind::NOTHING;
  bool truth_value = false;
  double number_value = 0.0;
  std::string text_value;
  std::vector<Json> items;                           /**< of a list */
  std::vector<std::pair<std::string, Json>> members; /**< of a map, in the order of the text */

  /** The member of that name; null where it is not there. */
  const Json *member(std::string_view name) const;

  /** The same; null also where its value is null. */
  const Json *find(std::string_view name) const;

  const std::string &text(const char *what) const;
  double number(const char *what) const;
  bool truth(const char *what) const;
  std::vector<double> numbers(const char *what) const;
  const std::vector<Json> &list(const char *what) const;
};

/** The whole text as one value. Throws BadInput: what is wrong, and at which character; a name that comes twice; more
 *  than 64 lists and maps in each other. */
Json parseJson(std::string_view text);

/** The same without what the lists and maps inside hold: of {"a": 1, "b": {"c": [2]}} it is {"a": 1, "b": {}}. What is
 *  wrong in there is not found. */
Json outlineOfJson(std::string_view text);

} // namespace curve_proximity::cli
#endif
