/* SPDX-License-Identifier: BSD-3-Clause */
/* The service CertifyPath in a planning scene. */
#ifndef CURVE_PROXIMITY_MOVEIT_CERTIFY_PATH_H
#define CURVE_PROXIMITY_MOVEIT_CERTIFY_PATH_H

#include <curve_proximity/CertifyPath.h>

#include "certifier.h"

namespace curve_proximity {

/* All of the answer but scene_stamp. Throws nothing: a request that cannot be used is not certified, and message says
 * why. The scene must not change meanwhile. */
void certifyPath(const CertifyPath::Request &req, const planning_scene::PlanningScene &scene,
                 const Certifier &certifier, CertifyPath::Response &res);

} // namespace curve_proximity
#endif
