/* SPDX-License-Identifier: BSD-3-Clause */
/** How rows are written: CSV, JSON, or CSV for people. */
#ifndef CURVE_PROXIMITY_CLI_ROW_TEXT_H
#define CURVE_PROXIMITY_CLI_ROW_TEXT_H

#include <string>
#include <vector>

namespace curve_proximity::cli {

/** CSV    every digit
 *  SHORT  CSV with six digits: lower bounds are rounded down, upper bounds up, all else to the nearest
 *  JSON   an object a row on a line of its own, by the names of the CSV's columns. Numbers have every digit; infinite
 *         ones are the texts "inf" and "-inf", fields without a value are null. */
enum class RowForm { CSV, SHORT, JSON };

/** JSON where it is asked for; SHORT on a terminal, where there is no file; else CSV. */
RowForm rowForm(bool json, const std::string &file);

/** Turns CSV into a form. Columns of text are known by their names. */
class RowText {
 public:
  explicit RowText(RowForm form) : form_(form) {}

  /** The text in the form. The first line of all texts is the header; each text ends with a line. */
  std::string operator()(const std::string &csv);

 private:
  std::string written(const std::vector<std::string> &fields) const;

  const RowForm form_;
  std::vector<std::string> header_;
};

} // namespace curve_proximity::cli
#endif
