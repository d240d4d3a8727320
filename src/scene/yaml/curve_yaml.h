/* SPDX-License-Identifier: BSD-3-Clause */
/** CURVE: a curve as msg/Curve.msg names its members. */
#ifndef CURVE_PROXIMITY_YAML_CURVE_YAML_H
#define CURVE_PROXIMITY_YAML_CURVE_YAML_H

#include <curve_proximity/description.hpp>

#include "yaml_value.h"

namespace curve_proximity::yaml {

/** {basis, degree, t0, t1, radius, points, …}; its frame may only be '' or 'world'. A range of zeros is that of the
 *  whole curve. What is wrong with the curve itself is left to compile(). */
CurveDescription readCurve(const YamlValue &value, Warnings &warnings);

} // namespace curve_proximity::yaml
#endif
