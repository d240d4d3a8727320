/* SPDX-License-Identifier: BSD-3-Clause */
#include "csv.h"

#include <algorithm>
#include <curve_proximity/core.hpp>
#include <filesystem>
#include <sstream>

#include "../scene/motion/curve_basis.h"
#include "../scene/yaml/numbers.h"
#include "exit_code.h"

namespace curve_proximity::cli {
namespace {

constexpr std::size_t kFirstPoint = 7; /* the column of x0 */
constexpr std::size_t kMostPieces = 65536;

bool isBlank(std::string_view text) {
  return trimmed(text).empty();
}

/* The name of a column from `id` to the last coordinate. */
std::string nameOf(std::size_t column) {
  static const char *const kHead[] = {"id", "basis", "degree", "t0", "t1", "radius", "n"};
  if (column < kFirstPoint) return kHead[column];
  const std::size_t coordinate = column - kFirstPoint;
  return "xyz"[coordinate % 3] + std::to_string(coordinate / 3);
}

/* Is it x, y or z with a number? */
bool isCoordinate(const std::string &name) {
  return name.size() > 1 && std::string_view("xyz").find(name[0]) != std::string_view::npos &&
         parseCount(name.substr(1)).has_value();
}

/* The names of the columns: spreadsheets and data frames write them above the rows. Throws BadInput where they are in
 * another order than that by which rows are read. */
bool isHeader(const std::string &text) {
  if (trimmed(text).substr(0, 4).find("id") == std::string_view::npos) return false;
  std::vector<std::string> names;
  for (const std::string &field : splitFields(text)) names.emplace_back(trimmed(field));
  if (names.size() < 2 || names[0] != "id" || names[1] != "basis") return false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == nameOf(i) || (i >= kFirstPoint && !isCoordinate(names[i]))) continue;
    throw BadInput("the header's column " + std::to_string(i + 1) + " is '" + names[i] + "': rows are read as " +
                   nameOf(i) + " there");
  }
  return true;
}

/* "column 9 (y0)": where a number stands that is wrong. */
std::string columnName(std::size_t column, std::size_t n) {
  const bool is_named = column < kFirstPoint + 3 * n || column < kFirstPoint;
  return "column " + std::to_string(column + 1) + " (" +
         (is_named ? nameOf(column) : "knot" + std::to_string(column - kFirstPoint - 3 * n)) + ")";
}

/* A field as it may be shown: short, whatever it holds. */
std::string shown(const std::string &field) {
  return "'" + (field.size() > 40 ? field.substr(0, 40) + "…" : field) + "'";
}

double number(const std::vector<std::string> &fields, std::size_t column, std::size_t n) {
  const std::optional<double> value = parseFinite(fields[column]);
  if (!value) throw BadInput(columnName(column, n) + " is " + shown(fields[column]) + ", not a finite number");
  return *value;
}

std::size_t count(const std::vector<std::string> &fields, std::size_t column) {
  const std::optional<std::uint64_t> value = parseCount(fields[column]);
  if (!value) throw BadInput(columnName(column, 0) + " is " + shown(fields[column]) + ", not a whole number from 0");
  return static_cast<std::size_t>(*value);
}

/* The points, knots and parameters that basis and degree ask for; what is wrong with the degree is said here. */
CurveCounts needed(const CurveDescription &curve, std::size_t n) {
  if (curve.basis == "bezier" && curve.degree < 1)
    throw BadInput("a curve of degree 0 is a point; the degree of a bezier is at least 1");
  const CurveCounts counts = countsOf(curve.basis, curve.degree, n);
  if (counts.points == n) return counts;
  throw BadInput("a " + curve.basis + " curve of degree " + std::to_string(curve.degree) + " has " +
                 std::to_string(counts.points) + " points; n is " + std::to_string(n));
}

/* n of a row `id,piecewise,…,n,…`: the next n rows are its pieces. 0 for other rows, and for those that cannot be read.
 */
std::size_t rowsOfPieces(const std::string &text) {
  if (text.find("piecewise") == std::string::npos) return 0;
  try {
    const std::vector<std::string> fields = splitFields(text);
    if (fields.size() < kFirstPoint || trimmed(fields[1]) != "piecewise") return 0;
    const std::size_t n = static_cast<std::size_t>(parseCount(fields[kFirstPoint - 1]).value_or(0));
    return n <= kMostPieces ? n : 0;
  } catch (const BadInput &) {
    return 0;
  }
}

/* What is left of a row after `column`: one number or none, and two that restrict the curve or none. */
void readRest(const std::vector<std::string> &fields, std::size_t column, std::size_t n, CurveDescription &curve) {
  if (fields.size() < column + 2) return;
  curve.restrict_t0 = number(fields, fields.size() - 2, n);
  curve.restrict_t1 = number(fields, fields.size() - 1, n);
  if (!(curve.restrict_t0 < curve.restrict_t1)) {
    throw BadInput("the last two columns restrict the curve: " + shown(fields[fields.size() - 2]) + " is not below " +
                   shown(fields.back()));
  }
}

void checkOwnRange(const CurveDescription &curve) {
  if (hasOwnRange(curve.basis) && (curve.t0 != 0.0 || curve.t1 != 0.0)) {
    throw BadInput("a " + curve.basis + " curve has a range of its own: t0 and t1 must be 0");
  }
}

} // namespace

CsvFile::CsvFile(const std::string &path) : path_(path), stream_(path, std::ios::binary) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw BadUsage(path + ": is a folder, not a file");
  if (!stream_) throw BadUsage(path + ": cannot be read");
  if (std::filesystem::is_regular_file(path, error)) size_ = std::filesystem::file_size(path, error);
  if (error) size_ = 0;
}

std::optional<CsvRow> CsvFile::next() {
  std::string text;
  CsvRow row{0, 0, ""}; // with the rows of its pieces, if it is piecewise
  while (std::getline(stream_, text)) {
    ++line_;
    read_ += text.size() + 1;

    /* what is no row: a carriage return, the byte order mark that spreadsheets leave, comments, blank lines */
    if (!text.empty() && text.back() == '\r') text.pop_back();
    if (line_ == 1 && text.rfind("\xEF\xBB\xBF", 0) == 0) text.erase(0, 3);
    if (isBlank(text) || text.front() == '#') continue;
    try {
      if (isHeader(text)) continue;
    } catch (const BadInput &e) {
      throw BadUsage(path_ + ": line " + std::to_string(line_) + ": " + e.what());
    }

    ++row_;
    if (pieces_ > 0) {
      --pieces_;
      row.text += '\n' + text;
    } else {
      row = CsvRow{row_, line_, std::move(text)};
      pieces_ = rowsOfPieces(row.text);
    }
    if (pieces_ == 0) return row;
  }
  if (!row.text.empty() && !stream_.bad()) {
    pieces_ = 0;
    return row;
  }
  if (stream_.bad()) throw BadUsage(path_ + ": reading failed after line " + std::to_string(line_));
  return std::nullopt;
}

std::optional<double> CsvFile::portion() const {
  if (size_ == 0) return std::nullopt;
  return std::min(1.0, static_cast<double>(read_) / static_cast<double>(size_));
}

std::vector<std::string> splitFields(std::string_view line) {
  std::vector<std::string> fields;
  std::size_t i = 0;
  while (true) {
    std::string field;
    if (i < line.size() && line[i] == '"') {
      /* quoted: up to the quote that is not doubled; what stands between it and the comma is kept */
      std::size_t quote = line.find('"', ++i);
      while (quote != std::string_view::npos && line.substr(quote + 1, 1) == "\"") {
        field.append(line, i, quote + 1 - i);
        i = quote + 2;
        quote = line.find('"', i);
      }
      if (quote == std::string_view::npos) {
        throw BadInput("column " + std::to_string(fields.size() + 1) + " begins with a quote that does not end");
      }
      field.append(line, i, quote - i);
      i = quote + 1;
    }
    const std::size_t comma = std::min(line.find(',', i), line.size());
    field.append(line, i, comma - i);
    fields.push_back(std::move(field));
    if (comma == line.size()) return fields;
    i = comma + 1;
  }
}

void appendField(std::string &line, double value, bool known) {
  if (!known) {
    line += ',';
    return;
  }
  char text[40];
  std::snprintf(text, sizeof text, ",%.17g", value);
  line += text;
}

std::string quotedField(const std::string &text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

std::string placeOf(const CsvRow &row, const std::string &file) {
  return file + ": row " + std::to_string(row.number) + " (line " + std::to_string(row.line) + ", id '" +
         rowId(row.text) + "')";
}

std::string rowId(const std::string &text) {
  if (text.empty() || text.front() != '"') return std::string(trimmed(text.substr(0, text.find(','))));
  try {
    return splitFields(text).front();
  } catch (const BadInput &) {
    return "";
  }
}

namespace {

/* The coefficients of 1, t, t², …, separated by blanks; one alone does not change. */
void readRadius(const std::vector<std::string> &fields, CurveDescription &curve) {
  constexpr std::size_t kRadius = 5;
  std::istringstream text(fields[kRadius]);
  std::vector<std::string> words;
  for (std::string word; text >> word;) words.push_back(word);
  if (words.size() < 2) {
    curve.radius = number(fields, kRadius, 0);
    return;
  }
  for (const std::string &word : words) {
    const std::optional<double> value = parseFinite(word);
    if (!value) throw BadInput(columnName(kRadius, 0) + ": " + shown(word) + " is not a finite number");
    curve.radius_polynomial.push_back(*value);
  }
  curve.radius = curve.radius_polynomial.front();
  curve.radius_polynomial.erase(curve.radius_polynomial.begin());
}

/* The columns from `id` to `n`. */
CurveDescription readHead(std::vector<std::string> &fields) {
  /* empty fields at the end: spreadsheets make all rows as long as the longest */
  while (!fields.empty() && isBlank(fields.back())) fields.pop_back();
  if (fields.size() < kFirstPoint) {
    throw BadInput("the row has " + std::to_string(fields.size()) +
                   " columns; at least id,basis,degree,t0,t1,radius,n are needed");
  }
  CurveDescription curve;
  curve.id = std::string(trimmed(fields[0]));
  curve.basis = std::string(trimmed(fields[1]));
  curve.degree = count(fields, 2);
  curve.t0 = number(fields, 3, 0);
  curve.t1 = number(fields, 4, 0);
  readRadius(fields, curve);
  return curve;
}

CurveDescription parseRow(const std::string &text) {
  std::vector<std::string> fields = splitFields(text);
  CurveDescription curve = readHead(fields);
  if (curve.basis == "piecewise") throw BadInput("a piece cannot be piecewise itself");

  /* as many columns as basis, degree and n ask for, before anything is allocated by n */
  const std::size_t n = count(fields, 6);
  const CurveCounts counts = needed(curve, n);
  const std::size_t columns = kFirstPoint + 3 * n + counts.knots + counts.parameters;
  if (fields.size() != columns && fields.size() != columns + 2) {
    const bool by_degree = counts.knots > 0 || counts.parameters > 0;
    throw BadInput("the row has " + std::to_string(fields.size()) + " columns; a " + curve.basis +
                   " with n = " + std::to_string(n) + (by_degree ? " and degree " + std::to_string(curve.degree) : "") +
                   " has " + std::to_string(columns));
  }
  checkOwnRange(curve);

  curve.points.resize(3, static_cast<Eigen::Index>(n));
  for (std::size_t k = 0; k < 3 * n; ++k) curve.points.data()[k] = number(fields, kFirstPoint + k, n);
  std::size_t column = kFirstPoint + 3 * n;
  for (std::size_t k = 0; k < counts.knots; ++k) curve.knots.push_back(number(fields, column++, n));
  for (std::size_t k = 0; k < counts.parameters; ++k) curve.parameters.push_back(number(fields, column++, n));
  readRest(fields, column, n, curve);
  return curve;
}

/* id,piecewise,0,0,0,radius,n[,gap][,restrict_t0,restrict_t1], and n rows. */
CurveDescription parsePieces(const std::vector<std::string> &rows) {
  std::vector<std::string> fields = splitFields(rows.front());
  CurveDescription curve = readHead(fields);
  const std::size_t n = count(fields, 6), more = fields.size() - kFirstPoint;
  if (rows.size() != n + 1) {
    throw BadInput("a piecewise curve with n = " + std::to_string(n) + " is followed by so many rows; there are " +
                   std::to_string(rows.size() - 1));
  }
  if (more > 3) {
    throw BadInput("the row has " + std::to_string(fields.size()) +
                   " columns; a piecewise curve has 7 to 10: gap, restrict_t0, restrict_t1 after n");
  }
  checkOwnRange(curve);
  const std::size_t gaps = more % 2;
  if (gaps > 0) curve.parameters.push_back(number(fields, kFirstPoint, 0));
  readRest(fields, kFirstPoint + gaps, 0, curve);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    try {
      curve.pieces.push_back(parseRow(rows[i]));
    } catch (const Error &error) {
      throw BadInput("piece " + std::to_string(i - 1) + ": " + error.what());
    } catch (const BadInput &error) {
      throw BadInput("piece " + std::to_string(i - 1) + ": " + error.what());
    }
    if (curve.pieces.back().radius != 0.0 || !curve.pieces.back().radius_polynomial.empty()) {
      throw BadInput("piece " + std::to_string(i - 1) + ": its radius must be 0; that of the piecewise row counts");
    }
  }
  return curve;
}

} // namespace

CurveDescription parseCurve(const std::string &text) {
  std::vector<std::string> rows;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    rows.push_back(text.substr(from, end - from));
    from = end + 1;
  }
  const std::vector<std::string> first = splitFields(rows.front());
  const bool pieces = first.size() > 1 && trimmed(first[1]) == "piecewise";
  return pieces ? parsePieces(rows) : parseRow(text);
}

} // namespace curve_proximity::cli
