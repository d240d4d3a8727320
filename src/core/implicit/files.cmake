# The files of this room. A new file is one line here.
target_sources(cprox_objects PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/barrier.c
  ${CMAKE_CURRENT_LIST_DIR}/build.c
  ${CMAKE_CURRENT_LIST_DIR}/centre.c
  ${CMAKE_CURRENT_LIST_DIR}/closed.c
  ${CMAKE_CURRENT_LIST_DIR}/constraint.c
  ${CMAKE_CURRENT_LIST_DIR}/dual.c
  ${CMAKE_CURRENT_LIST_DIR}/ellipsoid.c
  ${CMAKE_CURRENT_LIST_DIR}/power.c
  ${CMAKE_CURRENT_LIST_DIR}/separate.c
  ${CMAKE_CURRENT_LIST_DIR}/solve.c
  ${CMAKE_CURRENT_LIST_DIR}/support_height.c
)
