# The files of this room. A new file is one line here.
target_sources(cprox_objects PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/bent_pieces.c
  ${CMAKE_CURRENT_LIST_DIR}/contact_bvh.c
  ${CMAKE_CURRENT_LIST_DIR}/contact_convex.c
  ${CMAKE_CURRENT_LIST_DIR}/contact_curve.c
  ${CMAKE_CURRENT_LIST_DIR}/crossing.c
  ${CMAKE_CURRENT_LIST_DIR}/curve_bvh.c
  ${CMAKE_CURRENT_LIST_DIR}/curve_convex.c
  ${CMAKE_CURRENT_LIST_DIR}/curve_curve.c
  ${CMAKE_CURRENT_LIST_DIR}/curve_distance.c
  ${CMAKE_CURRENT_LIST_DIR}/newton_convex.c
  ${CMAKE_CURRENT_LIST_DIR}/newton_curves.c
  ${CMAKE_CURRENT_LIST_DIR}/report.c
  ${CMAKE_CURRENT_LIST_DIR}/search_candidate.c
  ${CMAKE_CURRENT_LIST_DIR}/search_kernel.c
)
