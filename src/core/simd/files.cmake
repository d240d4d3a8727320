# The files of this room. A new file is one line here.
target_sources(cprox_objects PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/dispatch.c
)
