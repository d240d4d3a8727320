# SPDX-License-Identifier: BSD-3-Clause
# The messages, services and actions of the package, in msg/, srv/ and action/, and its dynamic parameters, in cfg/.
set(CURVE_PROXIMITY_MESSAGES
  AllowedContact.msg
  AttachedCollisionObject.msg
  Body.msg
  Clearance.msg
  CollisionObject.msg
  ConstraintQuery.msg
  ConstraintResult.msg
  Curve.msg
  CurvePiece.msg
  ExecutionErrors.msg
  Gradient.msg
  Hyperquadric.msg
  LinkPadding.msg
  LinkPair.msg
  LinkScale.msg
  ObjectMargins.msg
  Octree.msg
  PairQuery.msg
  PoseTrajectory.msg
  Profile.msg
  Proximity.msg
  ProximityQuery.msg
  ProximityResults.msg
  Refusal.msg
  RobotTrajectory.msg
  SceneState.msg
  SensorState.msg
  SpeedProfile.msg
  SweptCells.msg
  TrajectoryConstraint.msg
  ViolationIntervals.msg
  Waypoint.msg
)
set(CURVE_PROXIMITY_SERVICES
  ApplyScene.srv
  CertifyPath.srv
  ClearanceProfile.srv
  Collision.srv
  Distance.srv
  EvaluateConstraints.srv
  GetScene.srv
  LimitSpeed.srv
  ListLinkPairs.srv
  ListMargins.srv
  ListViolations.srv
  MeasurePairs.srv
  NearestPairs.srv
  SweepVolume.srv
  TimeOfContact.srv
  Tolerance.srv
)

set(CURVE_PROXIMITY_ACTIONS
  Query.action
)

add_message_files(DIRECTORY msg FILES ${CURVE_PROXIMITY_MESSAGES})
add_service_files(DIRECTORY srv FILES ${CURVE_PROXIMITY_SERVICES})
add_action_files(DIRECTORY action FILES ${CURVE_PROXIMITY_ACTIONS})
generate_messages(DEPENDENCIES actionlib_msgs geometry_msgs nav_msgs sensor_msgs shape_msgs std_msgs trajectory_msgs)

# What may change while the server runs.
generate_dynamic_reconfigure_options(cfg/ProximityServer.cfg)

# Messages of packages that need not be installed: src/ros/foreign has their definitions as far as the node speaks them.
set(foreign_definitions ${CMAKE_CURRENT_SOURCE_DIR}/src/ros/foreign)
set(foreign_headers ${CMAKE_CURRENT_BINARY_DIR}/foreign_messages)
file(GLOB_RECURSE foreign_files CONFIGURE_DEPENDS ${foreign_definitions}/*)
add_custom_command(OUTPUT ${foreign_headers}/made
  COMMAND ${CATKIN_ENV} ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cmake/foreign_messages.py
    ${foreign_definitions} ${foreign_headers} ${GENCPP_TEMPLATE_DIR} ${MSG_I_FLAGS}
  COMMAND ${CMAKE_COMMAND} -E touch ${foreign_headers}/made
  DEPENDS cmake/foreign_messages.py ${foreign_files} COMMENT "Generating C++ code of src/ros/foreign")
add_custom_target(${PROJECT_NAME}_foreign_messages DEPENDS ${foreign_headers}/made)
