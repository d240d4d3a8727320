/* SPDX-License-Identifier: BSD-3-Clause */
/** Typed parameters of constraint providers, from the parameter server, from YAML or from C++. */
#ifndef CURVE_PROXIMITY_CONSTRAINT_PARAMETERS_HPP
#define CURVE_PROXIMITY_CONSTRAINT_PARAMETERS_HPP

#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include <curve_proximity/core.hpp>

namespace curve_proximity {

/** The value of a parameter. An int is accepted where a double is expected. A list contains numbers only. */
using ParameterValue = std::variant<bool, int, double, std::string, std::vector<double>>;

/** Parameters by name. */
using ParameterMap = std::map<std::string, ParameterValue>;

/** Reads a parameter map and checks types and ranges.
 *
 *  Each function returns the value of a parameter, or `otherwise` if the parameter is missing. It throws Error for a
 *  wrong type or value; the message names the parameter and what is expected. end() refuses unknown parameters. */
class ParameterReader {
 public:
  /** map: kept by reference. */
  explicit ParameterReader(const ParameterMap &map) : map_(map) {}

  /** A finite number with least <= value <= most; with `open`, least < value. */
  double number(const std::string &name, double otherwise, double least, bool open = false,
                double most = std::numeric_limits<double>::infinity()) {
    const ParameterValue *given = find(name);
    if (!given) return otherwise;
    double value = 0.0;
    if (const int *whole = std::get_if<int>(given)) {
      value = *whole;
    } else if (const double *real = std::get_if<double>(given)) {
      value = *real;
    } else {
      wrong(name, "a number is expected");
    }
    const bool enough = open ? value > least : value >= least;
    if (!std::isfinite(value) || !enough || value > most)
      wrong(name, text(value) + " is not " + range(least, open, most));
    return value;
  }

  /** An integer with least <= value <= most. */
  int count(const std::string &name, int otherwise, int least, int most) {
    const ParameterValue *given = find(name);
    if (!given) return otherwise;
    const int *value = std::get_if<int>(given);
    if (!value) wrong(name, "a whole number is expected");
    if (*value < least || *value > most) wrong(name, std::to_string(*value) + " is not " + range(least, false, most));
    return *value;
  }

  /** true or false. */
  bool truth(const std::string &name, bool otherwise) {
    const ParameterValue *given = find(name);
    if (!given) return otherwise;
    const bool *value = std::get_if<bool>(given);
    if (!value) wrong(name, "true or false is expected");
    return *value;
  }

  /** One of the words. */
  std::string word(const std::string &name, const std::string &otherwise, std::initializer_list<const char *> words) {
    const ParameterValue *given = find(name);
    if (!given) return otherwise;
    std::string list;
    const std::string *value = std::get_if<std::string>(given);
    for (const char *word : words) {
      if (value && *value == word) return *value;
      list += (list.empty() ? "" : ", ") + std::string(word);
    }
    wrong(name, (value ? "'" + *value + "' is" : std::string("this is")) + " none of " + list);
  }

  /** Throws Error if the map contains a parameter that was not read, such as a misspelt one. */
  void end() const {
    for (const auto &entry : map_)
      if (!known_.count(entry.first)) wrong(entry.first, "there is no such parameter");
  }

 private:
  const ParameterValue *find(const std::string &name) {
    known_.insert(name);
    const auto given = map_.find(name);
    return given == map_.end() ? nullptr : &given->second;
  }

  [[noreturn]] static void wrong(const std::string &name, const std::string &what) {
    throw Error("parameter " + name + ": " + what);
  }

  static std::string text(double value) {
    char out[32];
    std::snprintf(out, sizeof out, "%g", value);
    return out;
  }

  static std::string range(double least, bool open, double most) {
    std::string out = std::isinf(least) ? "finite" : (open ? "above " : "at least ") + text(least);
    if (std::isfinite(most)) out += " and at most " + text(most);
    return out;
  }

  const ParameterMap &map_;
  std::set<std::string> known_;
};

} // namespace curve_proximity
#endif
