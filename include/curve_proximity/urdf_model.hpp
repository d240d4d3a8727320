/* SPDX-License-Identifier: BSD-3-Clause */
/** A robot from a URDF that urdfdom has parsed. */
#ifndef CURVE_PROXIMITY_URDF_MODEL_HPP
#define CURVE_PROXIMITY_URDF_MODEL_HPP

#include <memory>

#include <urdf_model/model.h>

#include <curve_proximity/robot.hpp>

namespace curve_proximity {

/** As Robot::fromUrdf(), without a text in between. Collision elements that urdfdom has dropped are not seen. */
std::shared_ptr<const Robot> fromModel(const urdf::ModelInterface &model, const RobotOptions &options = {});

} // namespace curve_proximity
#endif
