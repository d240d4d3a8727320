# The messages and services of the package, in msg/ and srv/.
set(CURVE_PROXIMITY_MESSAGES
  AllowedPair.msg
  Body.msg
  CollisionObject.msg
  Curve.msg
  LinkPadding.msg
  Proximity.msg
)
set(CURVE_PROXIMITY_SERVICES
  ApplyScene.srv
  Collision.srv
  Distance.srv
  GetScene.srv
  Tolerance.srv
)
