/* SPDX-License-Identifier: BSD-3-Clause */
/** BODY: one shape and where it stands, as pairs and the `bodies` of collision objects write it. */
#ifndef CURVE_PROXIMITY_YAML_BODY_YAML_H
#define CURVE_PROXIMITY_YAML_BODY_YAML_H

#include <curve_proximity/description.hpp>

#include "yaml_value.h"

namespace curve_proximity::yaml {

/** {type, dimensions | vertices | mesh}: the shape; its pose is left to the caller.
 *  Throws BadInput for a type that is unknown or not available; what dimensions must be is left to makeGeometry(). */
ShapeDescription readBody(const YamlValue &value, Warnings &warnings);

/** vertices: points [m], one a column; none where the key is not there. */
Eigen::Matrix3Xd readVertices(const YamlValue &value);

/** The same under another key. */
Eigen::Matrix3Xd readPoints(const YamlValue &value, const char *key);

/** A mesh into `shape`: {vertices, triangles} or {resource}, either with a scale in `dimensions` or `scale`. */
void readMesh(const YamlValue &value, ShapeDescription &shape, Warnings &warnings);

} // namespace curve_proximity::yaml
#endif
