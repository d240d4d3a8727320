# SPDX-License-Identifier: BSD-3-Clause
# The messages and services of the package, in msg/ and srv/.
set(CURVE_PROXIMITY_MESSAGES
  AllowedContact.msg
  AttachedCollisionObject.msg
  Body.msg
  CollisionObject.msg
  ConstraintQuery.msg
  ConstraintResult.msg
  Curve.msg
  Hyperquadric.msg
  LinkPadding.msg
  LinkScale.msg
  Octree.msg
  Proximity.msg
)
set(CURVE_PROXIMITY_SERVICES
  ApplyScene.srv
  Collision.srv
  Distance.srv
  EvaluateConstraints.srv
  GetScene.srv
  Tolerance.srv
)

add_message_files(DIRECTORY msg FILES ${CURVE_PROXIMITY_MESSAGES})
add_service_files(DIRECTORY srv FILES ${CURVE_PROXIMITY_SERVICES})
generate_messages(DEPENDENCIES geometry_msgs sensor_msgs shape_msgs std_msgs trajectory_msgs)
