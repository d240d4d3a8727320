/* SPDX-License-Identifier: BSD-3-Clause */
/** package:// without a master and without ROS libraries. */
#ifndef CURVE_PROXIMITY_CLI_PACKAGES_H
#define CURVE_PROXIMITY_CLI_PACKAGES_H

#include <functional>
#include <string>

namespace curve_proximity::cli {

/** Finds the folder of a ROS package, "" if there is none of that name: the folders above `beside` first (a URDF often
 *  lies in the package that it names), then ROS_PACKAGE_PATH, then share/ of CMAKE_PREFIX_PATH and of /usr. */
std::function<std::string(const std::string &)> packageFinder(const std::string &beside);

} // namespace curve_proximity::cli
#endif
