/* SPDX-License-Identifier: BSD-3-Clause */
#include "messages/cloud.h"

#include <algorithm>
#include <boost/endian/conversion.hpp>
#include <cstdint>
#include <string>

namespace curve_proximity {
namespace {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;

/** One coordinate, inside a point. */
struct Coordinate {
  std::size_t offset = 0;
  bool is_double = false;
  bool is_big_endian = false;

  double at(const std::uint8_t *point) const {
    return is_double ? read<double>(point + offset) : read<float>(point + offset);
  }

 private:
  template <class Number>
  Number read(const std::uint8_t *from) const {
    using boost::endian::endian_load, boost::endian::order;
    return is_big_endian ? endian_load<Number, sizeof(Number), order::big>(from)
                         : endian_load<Number, sizeof(Number), order::little>(from);
  }
};

Coordinate coordinateOf(const PointCloud2 &cloud, const std::string &name) {
  const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                  [&](const PointField &candidate) { return candidate.name == name; });
  if (field == cloud.fields.end()) {
    std::string names;
    for (const PointField &other : cloud.fields) names += (names.empty() ? "" : ", ") + other.name;
    throw Error("cloud has no field '" + name + "', only: " + (names.empty() ? "none" : names));
  }
  const bool is_double = field->datatype == PointField::FLOAT64;
  if (!is_double && field->datatype != PointField::FLOAT32) {
    throw Error("cloud field '" + name + "' has datatype " + std::to_string(field->datatype) +
                ": float32 (7) or float64 (8) is wanted");
  }
  const std::uint64_t end = std::uint64_t{field->offset} + (is_double ? sizeof(double) : sizeof(float));
  if (end > cloud.point_step) {
    throw Error("cloud field '" + name + "' ends at byte " + std::to_string(end) + " of a point, but point_step is " +
                std::to_string(cloud.point_step));
  }
  return {field->offset, is_double, cloud.is_bigendian != 0};
}

/** Throws where the rows do not lie within the data. All products are of two 32-bit numbers: none overflows. */
void checkSteps(const PointCloud2 &cloud) {
  const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
  if (cloud.height > 1 && cloud.row_step < row) {
    throw Error("cloud row_step is " + std::to_string(cloud.row_step) + ", but " + std::to_string(cloud.width) +
                " points of " + std::to_string(cloud.point_step) + " bytes are " + std::to_string(row));
  }
  const std::uint64_t before = std::uint64_t{cloud.height - 1} * cloud.row_step;
  if (before <= cloud.data.size() && row <= cloud.data.size() - before) return;
  throw Error("cloud has " + std::to_string(cloud.data.size()) + " bytes of data, too few for " +
              std::to_string(cloud.height) + " rows of " + std::to_string(cloud.width) + " points of " +
              std::to_string(cloud.point_step) + " bytes");
}

} // namespace

Cloud toCloud(const PointCloud2 &message) {
  Cloud out;
  if (message.width == 0 || message.height == 0) return out;
  checkSteps(message);
  const Coordinate x = coordinateOf(message, "x"), y = coordinateOf(message, "y"), z = coordinateOf(message, "z");

  const std::size_t most = std::size_t{message.width} * message.height;
  out.points.resize(3, static_cast<Eigen::Index>(most));
  Eigen::Index n = 0;
  for (std::size_t row = 0; row < message.height; ++row) {
    const std::uint8_t *point = message.data.data() + row * message.row_step;
    for (std::size_t i = 0; i < message.width; ++i, point += message.point_step) {
      const Eigen::Vector3d p(x.at(point), y.at(point), z.at(point));
      if (p.allFinite()) out.points.col(n++) = p;
    }
  }
  out.left_out = most - static_cast<std::size_t>(n);
  if (out.left_out > 0) out.points.conservativeResize(3, n);
  return out;
}

} // namespace curve_proximity
