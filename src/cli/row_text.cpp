/* SPDX-License-Identifier: BSD-3-Clause */
#include "row_text.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <set>
#include <string_view>

#include "../scene/yaml/numbers.h"
#include "csv.h"
#include "json.h"

namespace curve_proximity::cli {
namespace {

constexpr int DIGITS = 6;

/* Columns whose fields are texts, also where they look like numbers. */
bool isText(const std::string &column) {
  static const std::set<std::string> names = {"id",         "kind",           "status", "verdict",  "a",
                                              "b",          "message",        "lod",    "proof",    "provider",
                                              "derivative", "second_opinion", "object", "direction"};
  return names.count(column) > 0;
}

bool endsWith(const std::string &text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/* Behind the last column that has a name, rows of constraints go on with points of three coordinates. */
std::string nameOf(const std::vector<std::string> &header, std::size_t column) {
  if (column < header.size()) return header[column];
  const std::size_t beyond = column - header.size();
  return "g" + std::to_string(1 + beyond / 3) + "xyz"[beyond % 3];
}

std::string withDigits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", DIGITS, value);
  return text;
}

/* Six digits; a bound stays on its side of the value. */
std::string shortened(const std::string &column, const std::string &field) {
  if (isText(column) || field.size() <= DIGITS || field.find_first_not_of("0123456789") == std::string::npos)
    return field;
  const std::optional<double> value = parseFinite(field);
  if (!value) return field;
  const bool down = endsWith(column, "lower") || column == "certified_scale" || column == "override" ||
                    column == "free" || column == "constant_override",
             up = endsWith(column, "upper") || column == "refused_scale" || column == "blocked" ||
                  column == "unwatched_override";
  std::string text = withDigits(*value);
  const double shown = std::stod(text);
  if ((down && shown > *value) || (up && shown < *value)) {
    const double digit = std::pow(10.0, std::floor(std::log10(std::fabs(*value))) - (DIGITS - 1));
    text = withDigits(down ? shown - digit : shown + digit);
  }
  return text;
}

std::string jsonOf(const std::string &column, const std::string &field) {
  if (field.empty()) return "null";
  if (!isText(column)) {
    if (field == "true" || field == "false" || parseFinite(field)) return field;
    if (field == "nan" || field == "-nan") return "null";
  }
  return textOfJson(Json(field));
}

/* Calls use(row) for each; a quoted field may hold the end of a line. */
template <typename Use>
void eachRow(const std::string &csv, const Use &use) {
  bool is_quoted = false;
  for (std::size_t i = 0, begin = 0; i < csv.size(); ++i) {
    if (csv[i] == '"') is_quoted = !is_quoted;
    if (csv[i] != '\n' || is_quoted) continue;
    use(std::string_view(csv).substr(begin, i - begin));
    begin = i + 1;
  }
}

} // namespace

RowForm rowForm(bool json, const std::string &file) {
  if (json) return RowForm::JSON;
  return file.empty() && isatty(STDOUT_FILENO) == 1 ? RowForm::SHORT : RowForm::CSV;
}

std::string RowText::written(const std::vector<std::string> &fields) const {
  std::string line = form_ == RowForm::JSON ? "{" : "";
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string column = nameOf(header_, i);
    if (form_ == RowForm::JSON)
      line += (i ? ", " : "") + textOfJson(Json(column)) + ": " + jsonOf(column, fields[i]);
    else
      line += (i ? "," : "") + quotedField(shortened(column, fields[i]));
  }
  return line + (form_ == RowForm::JSON ? "}\n" : "\n");
}

std::string RowText::operator()(const std::string &csv) {
  if (form_ == RowForm::CSV) return csv;
  std::string out;
  eachRow(csv, [&](std::string_view row) {
    std::vector<std::string> fields = splitFields(row);
    if (!header_.empty()) {
      out += written(fields);
      return;
    }
    header_ = std::move(fields);
    if (form_ == RowForm::SHORT) out += std::string(row) + "\n";
  });
  return out;
}

} // namespace curve_proximity::cli
