# The files of this room. A new file is one line here.
target_sources(cprox_objects PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/batch.c
  ${CMAKE_CURRENT_LIST_DIR}/clusters.c
  ${CMAKE_CURRENT_LIST_DIR}/cull.c
  ${CMAKE_CURRENT_LIST_DIR}/curve_points.c
  ${CMAKE_CURRENT_LIST_DIR}/obb.c
  ${CMAKE_CURRENT_LIST_DIR}/obstacle_batch.c
  ${CMAKE_CURRENT_LIST_DIR}/prefilter.c
)
