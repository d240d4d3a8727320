/* SPDX-License-Identifier: BSD-3-Clause */
/** What is wrong with an input file. */
#ifndef CURVE_PROXIMITY_YAML_BAD_INPUT_H
#define CURVE_PROXIMITY_YAML_BAD_INPUT_H

#include <stdexcept>

namespace curve_proximity::yaml {

/** Options or input files that cannot be used as a whole: what() is one line that names the file. */
class BadUsage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/** A row, or a value in a file, that cannot be used: what() names what and where within it. A row becomes an invalid
 *  row and the others are answered; a scene becomes BadUsage, for a scene that lacks an object answers wrongly. */
class BadInput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

} // namespace curve_proximity::yaml
#endif
