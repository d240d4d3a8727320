/* SPDX-License-Identifier: BSD-3-Clause */
/** package:// without a master and without ROS libraries. */
#ifndef CURVE_PROXIMITY_CLI_PACKAGES_H
#define CURVE_PROXIMITY_CLI_PACKAGES_H

#include <functional>
#include <map>
#include <string>

namespace curve_proximity::cli {

/** Folders of packages by name (--package), for all finders from here on. Called once, before any thread. */
void namePackages(const std::map<std::string, std::string> &folders);

/** Finds the folder of a ROS package, "" if there is none of that name: what namePackages() says first, then the
 *  folders above `beside` (a URDF often lies in the package that it names), then ROS_PACKAGE_PATH, then share/ of
 *  CMAKE_PREFIX_PATH and of /usr. */
std::function<std::string(const std::string &)> packageFinder(const std::string &beside);

} // namespace curve_proximity::cli
#endif
