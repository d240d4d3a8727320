# The files of this room. A new file is one line here.
target_sources(cprox_objects PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/edge_bound.c
  ${CMAKE_CURRENT_LIST_DIR}/edge_checker.c
  ${CMAKE_CURRENT_LIST_DIR}/edge_model.c
  ${CMAKE_CURRENT_LIST_DIR}/edge_scene.c
  ${CMAKE_CURRENT_LIST_DIR}/first_level.c
  ${CMAKE_CURRENT_LIST_DIR}/kernel_avx2.c
  ${CMAKE_CURRENT_LIST_DIR}/kernel_plain.c
  ${CMAKE_CURRENT_LIST_DIR}/kernels.c
)
