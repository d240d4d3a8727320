# The files of this room. A new file is one line here.
target_sources(cprox_objects PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/body.c
  ${CMAKE_CURRENT_LIST_DIR}/boxes.c
  ${CMAKE_CURRENT_LIST_DIR}/cluster_hulls.c
  ${CMAKE_CURRENT_LIST_DIR}/compound.c
  ${CMAKE_CURRENT_LIST_DIR}/convex_function.c
  ${CMAKE_CURRENT_LIST_DIR}/distance_field.c
  ${CMAKE_CURRENT_LIST_DIR}/elements.c
  ${CMAKE_CURRENT_LIST_DIR}/height_field.c
  ${CMAKE_CURRENT_LIST_DIR}/implicit_body.c
  ${CMAKE_CURRENT_LIST_DIR}/kinds.c
  ${CMAKE_CURRENT_LIST_DIR}/lod_body.c
  ${CMAKE_CURRENT_LIST_DIR}/mesh.c
  ${CMAKE_CURRENT_LIST_DIR}/places.c
  ${CMAKE_CURRENT_LIST_DIR}/points.c
)
