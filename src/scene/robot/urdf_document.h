/* SPDX-License-Identifier: BSD-3-Clause */
/** A URDF's text: every element of it is read, refused, or named as left out. */
#ifndef CURVE_PROXIMITY_SCENE_URDF_DOCUMENT_H
#define CURVE_PROXIMITY_SCENE_URDF_DOCUMENT_H

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <urdf_model/model.h>

#include <curve_proximity/core.hpp>
#include <curve_proximity/description.hpp>

namespace curve_proximity {

/** A collision element: its shape, or why there is none. */
struct UrdfElement {
  ShapeDescription shape; /**< its pose is in the link's frame */
  std::string fault;      /**< empty: none */
};

/** By link; links without collision elements have an empty list. */
using UrdfElements = std::map<std::string, std::vector<UrdfElement>>;

struct UrdfDocument {
  std::shared_ptr<urdf::ModelInterface> model; /**< its tree, with joints, and links without their elements */
  UrdfElements elements;
  std::vector<std::string> unknown; /**< what is neither used nor known to carry no geometry, a message each */
};

/** Throws Error, which names link or joint and what is wrong: no XML, no URDF, elements that xacro has left, a tree
 * that is none, joints that cannot be used. Faults of collision elements are told in the elements. */
UrdfDocument readUrdf(const std::string &xml);

} // namespace curve_proximity
#endif
