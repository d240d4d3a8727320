/* SPDX-License-Identifier: BSD-3-Clause */
/* What links of the robot carry, and links at their scale. */
#ifndef CURVE_PROXIMITY_SCENE_ATTACHING_H
#define CURVE_PROXIMITY_SCENE_ATTACHING_H

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <curve_proximity/scene.hpp>

namespace curve_proximity {

/* The object on its link at the link's scale. Throws Error, without naming the object. */
std::shared_ptr<const AttachedObject> carried(const Attachment &given, double link_scale,
                                              const ResourceOptions &resources);

/* The same object at another scale of its link. */
std::shared_ptr<const AttachedObject> rescaled(const AttachedObject &object, double link_scale,
                                               const ResourceOptions &resources);

/* The collision elements of a link of the robot at a scale. Throws Error. */
std::shared_ptr<const std::vector<LinkGeometry>> scaledLink(const Robot &robot, const std::string &link, double scale);

/* Throws Error for a scale that is not finite and above 0, and a link that the robot does not have. */
void checkLinkScales(const std::map<std::string, double> &scales, const Robot *robot);

/* Throws Error, naming the link, where it is not the robot's. what: how the message begins. */
void checkLink(const std::string &link, const Robot *robot, const char *what = "");

/* Where the attachment says that the link is. Throws Error where it does not. */
const Eigen::Isometry3d &poseOfLink(const Attachment &given, const std::string &link);

} // namespace curve_proximity
#endif
