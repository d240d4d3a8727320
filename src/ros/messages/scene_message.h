/* SPDX-License-Identifier: BSD-3-Clause */
/** Changes of the scene and what it holds, both ways. Needs no node and no master. */
#ifndef CURVE_PROXIMITY_ROS_SCENE_MESSAGE_H
#define CURVE_PROXIMITY_ROS_SCENE_MESSAGE_H

#include <curve_proximity/ApplyScene.h>
#include <curve_proximity/CollisionObject.h>
#include <curve_proximity/GetScene.h>

#include <curve_proximity/scene.hpp>
#include <functional>
#include <string>
#include <vector>

namespace curve_proximity {

/** One operation on the scene; its object's pose is still the message's, in header.frame_id.
 *  Throws Error, which names the object and the shape: an unknown type or operation, poses that do not match the
 * shapes, triangles with an index that is none. Dimensions are left to the scene. */
Operation toOperation(const CollisionObject &object);

/** The whole request of ~apply_scene. The poses of objects are brought to the fixed frame by `to_fixed(header)`, which
 * may throw. An object that cannot be converted becomes a message in `faults`, and the others stay. */
using ToFixed = std::function<Eigen::Isometry3d(const std_msgs::Header &header)>;
SceneChange toSceneChange(const ApplySceneRequest &request, const ToFixed &to_fixed, std::vector<std::string> &faults);

/** What links are to carry, the same way. `before`: the scene that the attachments are for, since what is detached must
 * be known to stand on its link. */
using LinkToFixed = std::function<Eigen::Isometry3d(const std::string &link, const ros::Time &stamp)>;
void addAttachments(const ApplySceneRequest &request, const ToFixed &to_fixed, const LinkToFixed &link_to_fixed,
                    const Snapshot &before, SceneChange &change, std::vector<std::string> &faults);

/** An object as ~apply_scene would take it with operation ADD. Mesh files stay names of files. */
CollisionObject toMessage(const ObjectDescription &object);

/** The scene as ~get_scene gives it, in full or the named objects. Throws Error for a name that is not there. */
void toMessage(const Snapshot &snapshot, const std::vector<std::string> &ids, GetSceneResponse &response);

/** A change as ~apply_scene takes it: the way of a scene file to the node. The poses are in object.frame. */
ApplySceneRequest toMessage(const SceneChange &change);

} // namespace curve_proximity
#endif
