/* SPDX-License-Identifier: BSD-3-Clause */
/** A URDF, its SRDF, the boxes and cylinders of a planning scene's YAML, and the ends of a trajectory. */
#ifndef EXAMPLES_OMPL_READING_HPP
#define EXAMPLES_OMPL_READING_HPP

#include <string>

#include "edges.hpp"

/** Throws std::exception with one line. */
Task readTask(const std::string &urdf, const std::string &srdf, const std::string &scene,
              const std::string &trajectory);

#endif
