/* SPDX-License-Identifier: BSD-3-Clause */
/** ERRORS.yaml: bounds of the errors of an execution. */
#ifndef CURVE_PROXIMITY_YAML_ERRORS_YAML_H
#define CURVE_PROXIMITY_YAML_ERRORS_YAML_H

#include <string>

#include <curve_proximity/robust.hpp>

namespace curve_proximity::yaml {

/** Throws BadUsage naming the file, the place and the line: keys that are not known, numbers below 0, a file without
 *  any bound. */
ErrorBounds readErrors(const std::string &path);

} // namespace curve_proximity::yaml
#endif
