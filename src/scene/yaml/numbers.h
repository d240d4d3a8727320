/* SPDX-License-Identifier: BSD-3-Clause */
/** Decimal text to numbers: the whole text or nothing, whatever the locale. */
#ifndef CURVE_PROXIMITY_YAML_NUMBERS_H
#define CURVE_PROXIMITY_YAML_NUMBERS_H

#include <cstdint>
#include <optional>
#include <string_view>

namespace curve_proximity::yaml {

/** The text without blanks and tabs at its ends. */
std::string_view trimmed(std::string_view text);

/** A finite double; nothing for "nan", "inf", text that is no number, and numbers beyond the range of a double. */
std::optional<double> parseFinite(std::string_view text);

/** An integer from 0 to 2^53. */
std::optional<std::uint64_t> parseCount(std::string_view text);

} // namespace curve_proximity::yaml
#endif
