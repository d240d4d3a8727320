# The files of this room. A new file is one line here.
target_sources(cprox_objects PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/ccd.c
  ${CMAKE_CURRENT_LIST_DIR}/convex_mesh.c
  ${CMAKE_CURRENT_LIST_DIR}/formula.c
  ${CMAKE_CURRENT_LIST_DIR}/growth.c
  ${CMAKE_CURRENT_LIST_DIR}/mesh_mesh.c
  ${CMAKE_CURRENT_LIST_DIR}/relative_pose.c
  ${CMAKE_CURRENT_LIST_DIR}/static_pair.c
  ${CMAKE_CURRENT_LIST_DIR}/translation.c
)
