/* SPDX-License-Identifier: BSD-3-Clause */
/* Affine maps of the nodes of a scene. */
#ifndef CURVE_PROXIMITY_MESH_READER_POSE_H
#define CURVE_PROXIMITY_MESH_READER_POSE_H

#include <array>

#include "mesh_builder.h"

namespace curve_proximity::mesh_reader {

/* x -> M x + p, rows of (M | p). */
struct Pose {
  std::array<std::array<double, 4>, 3> rows{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  Point operator()(const Point &x) const {
    Point out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = rows[i][0] * x[0] + rows[i][1] * x[1] + rows[i][2] * x[2] + rows[i][3];
    return out;
  }

  Pose operator*(const Pose &b) const {
    Pose out;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 4; ++k)
        out.rows[i][k] = rows[i][0] * b.rows[0][k] + rows[i][1] * b.rows[1][k] + rows[i][2] * b.rows[2][k] +
                         (k == 3 ? rows[i][3] : 0.0);
    return out;
  }

  /* Whether what was counter-clockwise becomes clockwise. */
  bool mirrors() const {
    const auto &[a, b, c] = rows;
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]) <
           0.0;
  }

  static Pose translation(double x, double y, double z) {
    return {{{{1, 0, 0, x}, {0, 1, 0, y}, {0, 0, 1, z}}}};
  }
  static Pose scaling(double x, double y, double z) {
    return {{{{x, 0, 0, 0}, {0, y, 0, 0}, {0, 0, z, 0}}}};
  }
};

} // namespace curve_proximity::mesh_reader
#endif
