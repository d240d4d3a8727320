/* SPDX-License-Identifier: BSD-3-Clause */
/* The same in C++ with Eigen. Errors are exceptions. */
#include <curve_proximity/core.hpp>
#include <iostream>

int main() {
  Eigen::Matrix3Xd points(3, 4);
  points << -1.0, -0.2, 0.3, 1.0, 0.0, 0.5, -0.4, 0.2, 0.6, 0.4, 0.9, 0.5; // a row of x, of y, of z
  const auto path = curve_proximity::makeBezier(points);
  const auto box = curve_proximity::makeBox({0.5, 0.5, 0.5});
  curve_proximity::Workspace workspace;
  const cprox_result r = curve_proximity::distance(curve_proximity::along(path, 0.02), curve_proximity::at(box),
                                                   CPROX_OPTIONS_DEFAULT, workspace);
  std::cout << r.lower << " <= distance <= " << r.upper << " m, at t = " << r.t << '\n';
}
