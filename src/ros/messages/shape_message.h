/* SPDX-License-Identifier: BSD-3-Clause */
/** Shapes of objects and bodies, both ways. */
#ifndef CURVE_PROXIMITY_ROS_SHAPE_MESSAGE_H
#define CURVE_PROXIMITY_ROS_SHAPE_MESSAGE_H

#include <curve_proximity/Body.h>
#include <curve_proximity/CollisionObject.h>

#include <curve_proximity/scene.hpp>
#include <string>
#include <vector>

namespace curve_proximity {

/** Throws Error: an unknown type, a triangle with an index that is none, numbers that are not a whole number of rows.
 *  Dimensions are left to the scene. */
ShapeDescription toShape(const Body &body);

/** All shapes of an object in its frame: primitives, meshes, planes, bodies. Throws Error, which names the shape: as
 *  above; poses that do not match the shapes; a cloud in another frame than the object's. */
std::vector<ShapeDescription> toShapes(const CollisionObject &object);

/** An octree as it stands in a message: ours, or that of octomap_msgs. */
template <class Message>
OctreeData toOctree(const Message &octree) {
  return {octree.id, octree.resolution, octree.binary != 0, std::string(octree.data.begin(), octree.data.end())};
}
Octree toOctreeMessage(const OctreeData &octree);

/** One shape more, in the list of the message that can hold it. Mesh files stay names of files. */
void addShape(CollisionObject &message, const ShapeDescription &shape);

} // namespace curve_proximity
#endif
