# The files of this room. A new file is one line here.
target_sources(cprox_objects PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/candidates.c
  ${CMAKE_CURRENT_LIST_DIR}/carried_shape.c
  ${CMAKE_CURRENT_LIST_DIR}/level_of_detail.c
  ${CMAKE_CURRENT_LIST_DIR}/placed_pair.c
  ${CMAKE_CURRENT_LIST_DIR}/problem.c
  ${CMAKE_CURRENT_LIST_DIR}/radius.c
  ${CMAKE_CURRENT_LIST_DIR}/section.c
  ${CMAKE_CURRENT_LIST_DIR}/validate.c
  ${CMAKE_CURRENT_LIST_DIR}/values.c
)
