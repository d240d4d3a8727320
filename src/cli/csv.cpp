/* SPDX-License-Identifier: BSD-3-Clause */
#include "csv.h"

#include <algorithm>
#include <filesystem>

#include "../scene/yaml/numbers.h"
#include "failure.h"

namespace curve_proximity::cli {
namespace {

constexpr std::size_t kFirstPoint = 7; /* the column of x0 */

bool isBlank(std::string_view text) {
  return trimmed(text).empty();
}

/* The names of the columns: spreadsheets and data frames write them above the rows. */
bool isHeader(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return false;
  const auto name = [](std::string_view field) {
    field = trimmed(field);
    const bool quoted = field.size() > 1 && field.front() == '"' && field.back() == '"';
    return quoted ? field.substr(1, field.size() - 2) : field;
  };
  const std::string_view rest = text.substr(comma + 1);
  return name(text.substr(0, comma)) == "id" && name(rest.substr(0, rest.find(','))) == "basis";
}

/* "column 9 (y0)": where a number stands that is wrong. */
std::string columnName(std::size_t column, std::size_t n) {
  static const char *const kHead[] = {"id", "basis", "degree", "t0", "t1", "radius", "n"};
  std::string name;
  if (column < kFirstPoint) {
    name = kHead[column];
  } else if (column < kFirstPoint + 3 * n) {
    const std::size_t coordinate = column - kFirstPoint;
    name = "xyz"[coordinate % 3] + std::to_string(coordinate / 3);
  } else {
    name = "knot" + std::to_string(column - kFirstPoint - 3 * n);
  }
  return "column " + std::to_string(column + 1) + " (" + name + ")";
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

/* The number of knots that basis and degree ask for; what is wrong with the degree is said here. */
std::size_t knotsNeeded(const CurveDescription &curve, std::size_t n) {
  if (curve.basis == "bezier") {
    if (curve.degree < 1) throw BadInput("a curve of degree 0 is a point; the degree of a bezier is at least 1");
    if (n != curve.degree + 1) {
      throw BadInput("a bezier of degree " + std::to_string(curve.degree) + " has " + std::to_string(curve.degree + 1) +
                     " points; n is " + std::to_string(n));
    }
    return 0;
  }
  if (curve.basis == "bspline") {
    if (curve.degree < 1) throw BadInput("the degree of a bspline is at least 1");
    if (n <= curve.degree) {
      throw BadInput("a bspline of degree " + std::to_string(curve.degree) + " needs at least " +
                     std::to_string(curve.degree + 1) + " points; n is " + std::to_string(n));
    }
    return n + curve.degree + 1;
  }
  const bool trigonometric = curve.basis == "trigonometric", lagrange = curve.basis == "lagrange";
  if (!trigonometric && !lagrange && curve.basis != "polynomial" && curve.basis != "legendre") {
    throw BadInput("column 2 (basis) is " + shown(curve.basis) +
                   "; it must be bezier, bspline, polynomial, legendre, lagrange or trigonometric");
  }
  const std::size_t needed = trigonometric ? 2 * curve.degree + 1 : curve.degree + 1;
  if (n != needed) {
    throw BadInput("a " + curve.basis + " curve of degree " + std::to_string(curve.degree) + " has " +
                   std::to_string(needed) + " points; n is " + std::to_string(n));
  }
  return lagrange ? n : 0;
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
  while (std::getline(stream_, text)) {
    ++line_;
    read_ += text.size() + 1;

    /* what is no row: a carriage return, the byte order mark that spreadsheets leave, comments, blank lines */
    if (!text.empty() && text.back() == '\r') text.pop_back();
    if (line_ == 1 && text.rfind("\xEF\xBB\xBF", 0) == 0) text.erase(0, 3);
    if (isBlank(text) || text.front() == '#' || isHeader(text)) continue;

    ++row_;
    return CsvRow{row_, line_, std::move(text)};
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

CurveDescription parseCurve(const std::string &text) {
  std::vector<std::string> fields = splitFields(text);

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
  curve.radius = number(fields, 5, 0);

  /* as many columns as basis, degree and n ask for, before anything is allocated by n */
  const std::size_t n = count(fields, 6);
  const std::size_t n_knots = knotsNeeded(curve, n);
  const std::size_t needed = kFirstPoint + 3 * n + n_knots;
  if (fields.size() != needed) {
    throw BadInput("the row has " + std::to_string(fields.size()) + " columns; a " + curve.basis +
                   " with n = " + std::to_string(n) + (n_knots ? " and degree " + std::to_string(curve.degree) : "") +
                   " has " + std::to_string(needed));
  }

  curve.points.resize(3, static_cast<Eigen::Index>(n));
  for (std::size_t k = 0; k < 3 * n; ++k) curve.points.data()[k] = number(fields, kFirstPoint + k, n);
  curve.knots.resize(n_knots);
  for (std::size_t k = 0; k < n_knots; ++k) curve.knots[k] = number(fields, kFirstPoint + 3 * n + k, n);
  return curve;
}

} // namespace curve_proximity::cli
