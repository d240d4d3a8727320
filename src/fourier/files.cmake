# The files of this room. A new file is one line here.
target_sources(cprox_objects PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/along.c
  ${CMAKE_CURRENT_LIST_DIR}/cascade.c
  ${CMAKE_CURRENT_LIST_DIR}/chain.c
  ${CMAKE_CURRENT_LIST_DIR}/clip.c
  ${CMAKE_CURRENT_LIST_DIR}/clipped.c
  ${CMAKE_CURRENT_LIST_DIR}/divided.c
  ${CMAKE_CURRENT_LIST_DIR}/energy.c
  ${CMAKE_CURRENT_LIST_DIR}/gap.c
  ${CMAKE_CURRENT_LIST_DIR}/grid.c
  ${CMAKE_CURRENT_LIST_DIR}/kernel.c
  ${CMAKE_CURRENT_LIST_DIR}/mesh.c
  ${CMAKE_CURRENT_LIST_DIR}/offset.c
  ${CMAKE_CURRENT_LIST_DIR}/offset_mesh.c
  ${CMAKE_CURRENT_LIST_DIR}/piece.c
  ${CMAKE_CURRENT_LIST_DIR}/piece_spectrum.c
  ${CMAKE_CURRENT_LIST_DIR}/plan.c
  ${CMAKE_CURRENT_LIST_DIR}/polygon.c
  ${CMAKE_CURRENT_LIST_DIR}/profile.c
  ${CMAKE_CURRENT_LIST_DIR}/query.c
  ${CMAKE_CURRENT_LIST_DIR}/solid.c
  ${CMAKE_CURRENT_LIST_DIR}/sum.c
)
