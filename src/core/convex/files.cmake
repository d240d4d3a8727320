# The files of this room. A new file is one line here.
target_sources(cprox_objects PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/alternating_projections.c
  ${CMAKE_CURRENT_LIST_DIR}/box.c
  ${CMAKE_CURRENT_LIST_DIR}/capsule.c
  ${CMAKE_CURRENT_LIST_DIR}/cone.c
  ${CMAKE_CURRENT_LIST_DIR}/cylinder.c
  ${CMAKE_CURRENT_LIST_DIR}/depth.c
  ${CMAKE_CURRENT_LIST_DIR}/double_double_cross.c
  ${CMAKE_CURRENT_LIST_DIR}/ellipsoid.c
  ${CMAKE_CURRENT_LIST_DIR}/epa.c
  ${CMAKE_CURRENT_LIST_DIR}/epa_ring.c
  ${CMAKE_CURRENT_LIST_DIR}/feature.c
  ${CMAKE_CURRENT_LIST_DIR}/few_points.c
  ${CMAKE_CURRENT_LIST_DIR}/flat.c
  ${CMAKE_CURRENT_LIST_DIR}/gjk.c
  ${CMAKE_CURRENT_LIST_DIR}/halfspace.c
  ${CMAKE_CURRENT_LIST_DIR}/minkowski.c
  ${CMAKE_CURRENT_LIST_DIR}/pair.c
  ${CMAKE_CURRENT_LIST_DIR}/point.c
  ${CMAKE_CURRENT_LIST_DIR}/polygon.c
  ${CMAKE_CURRENT_LIST_DIR}/polytope.c
  ${CMAKE_CURRENT_LIST_DIR}/ray.c
  ${CMAKE_CURRENT_LIST_DIR}/simplex.c
  ${CMAKE_CURRENT_LIST_DIR}/sphere.c
  ${CMAKE_CURRENT_LIST_DIR}/support_callback.c
  ${CMAKE_CURRENT_LIST_DIR}/vertices.c
)
