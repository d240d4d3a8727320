/* SPDX-License-Identifier: BSD-3-Clause */
/** JSON: read as YAML is, for the lines of a dataset, which must cost little beside a search; and written, for
 * reports. */
#ifndef CURVE_PROXIMITY_CLI_JSON_H
#define CURVE_PROXIMITY_CLI_JSON_H

#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "../scene/yaml/yaml_value.h"
#include "exit_code.h"

namespace curve_proximity::cli {

/** A value to be written. */
struct Json {
  enum class Kind { NOTHING, TRUTH, NUMBER, TEXT, LIST, MAP };

  Kind kind = Kind::NOTHING;
  bool truth_value = false;
  double number_value = 0.0;
  std::string text_value;
  std::vector<Json> items;                           /**< of a list */
  std::vector<std::pair<std::string, Json>> members; /**< of a map, in the order of the text */

  Json() = default; /**< null */
  Json(std::string text) : kind(Kind::TEXT), text_value(std::move(text)) {}
  Json(const char *text) : Json(std::string(text)) {}
  Json(const std::vector<double> &numbers) : kind(Kind::LIST), items(numbers.begin(), numbers.end()) {}
  template <class T, class = std::enable_if_t<std::is_arithmetic_v<T>>>
  Json(T value)
      : kind(std::is_same_v<T, bool> ? Kind::TRUTH : Kind::NUMBER),
        truth_value(value != T()),
        number_value(static_cast<double>(value)) {}
  static Json listOf(std::vector<Json> items);
  static Json mapOf(std::vector<std::pair<std::string, Json>> members);

  /** The member of that name, null where it was not there. What is null becomes a map. */
  Json &operator[](const std::string &name);
};

/** The whole text as one value; its places have no lines. Throws BadInput: what is wrong, and at which character; a
 *  name that comes twice; more than 64 lists and maps in each other. */
YamlValue parseJson(std::string_view text);

/** The same without what the lists and maps inside hold: of {"a": 1, "b": {"c": [2]}} it is {"a": 1, "b": {}}. What is
 *  wrong in there is not found. */
YamlValue outlineOfJson(std::string_view text);

/** On one line; numbers that are not finite are null. */
std::string textOfJson(const Json &value);

} // namespace curve_proximity::cli
#endif
