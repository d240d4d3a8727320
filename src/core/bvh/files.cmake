# The files of this room. A new file is one line here.
target_sources(cprox_objects PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/build.c
  ${CMAKE_CURRENT_LIST_DIR}/build_area.c
  ${CMAKE_CURRENT_LIST_DIR}/build_morton.c
  ${CMAKE_CURRENT_LIST_DIR}/family.c
  ${CMAKE_CURRENT_LIST_DIR}/kernel_avx2.c
  ${CMAKE_CURRENT_LIST_DIR}/kernel_avx512.c
  ${CMAKE_CURRENT_LIST_DIR}/kernel_plain.c
  ${CMAKE_CURRENT_LIST_DIR}/kernels.c
  ${CMAKE_CURRENT_LIST_DIR}/memory.c
  ${CMAKE_CURRENT_LIST_DIR}/nodes.c
  ${CMAKE_CURRENT_LIST_DIR}/query.c
  ${CMAKE_CURRENT_LIST_DIR}/slabs.c
  ${CMAKE_CURRENT_LIST_DIR}/update.c
  ${CMAKE_CURRENT_LIST_DIR}/winding.c
)
