/* SPDX-License-Identifier: BSD-3-Clause */
/** CURVES.csv, a row at a time. */
#ifndef CURVE_PROXIMITY_CLI_CSV_H
#define CURVE_PROXIMITY_CLI_CSV_H

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <curve_proximity/description.hpp>

namespace curve_proximity::cli {

/** A line of the file that is a row: neither blank, nor a comment, nor a header (id,basis,…). A piecewise row holds the
 *  lines of its pieces, too. */
struct CsvRow {
  std::size_t number = 0; /**< among the rows, from 1 */
  std::size_t line = 0;   /**< in the file, from 1 */
  std::string text;
};

/** Reads rows one after the other, so that a file need not fit into memory. LF and CRLF end a line. */
class CsvFile {
 public:
  /** Throws BadUsage where the file cannot be read. */
  explicit CsvFile(const std::string &path);

  /** The next row, nothing at the end. Throws BadUsage where reading fails midway. */
  std::optional<CsvRow> next();

  /** How much of the file has been read, 0 to 1; nothing where its size is not known (a pipe). */
  std::optional<double> portion() const;

 private:
  std::string path_;
  std::ifstream stream_;
  std::uint64_t size_ = 0, read_ = 0;
  std::size_t row_ = 0, line_ = 0;
  std::size_t pieces_ = 0; /* rows that still belong to the row before */
};

/** The fields of a line, split at commas; one that begins with a quote ends at the next quote (a doubled quote is one)
 *  and may contain commas. Throws BadInput for a quote that does not end. */
std::vector<std::string> splitFields(std::string_view line);

/** The text as one field: quoted if it needs to be. */
std::string quotedField(const std::string &text);

/** A comma, and the number with all its digits where it is known. */
void appendField(std::string &line, double value, bool known = true);

/** Where a row stands, for a message: "curves.csv: row 3 (line 5, id 'a')". */
std::string placeOf(const CsvRow &row, const std::string &file);

/** The id of a row, as far as it can be read: also of rows that are no curve. */
std::string rowId(const std::string &text);

/** The row as a curve: id,basis,degree,t0,t1,radius,n,x0,y0,z0,…[,knot0,…][,parameter0,…][,restrict_t0,restrict_t1] (a
 * lagrange curve's nodes stand as knots); of a piecewise curve a line for it, and a line for each piece.
 * Empty fields at the end are left out. Throws BadInput, naming the column: a field that is not a finite number, too
 * few or too many columns, a degree that does not fit. What needs geometry to judge (knots that descend, t0 >= t1) is
 * left to compile(). */
CurveDescription parseCurve(const std::string &text);

} // namespace curve_proximity::cli
#endif
