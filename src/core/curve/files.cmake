# The files of this room. A new file is one line here.
target_sources(cprox_objects PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/bezier.c
  ${CMAKE_CURRENT_LIST_DIR}/bspline.c
  ${CMAKE_CURRENT_LIST_DIR}/clothoid.c
  ${CMAKE_CURRENT_LIST_DIR}/compile.c
  ${CMAKE_CURRENT_LIST_DIR}/control.c
  ${CMAKE_CURRENT_LIST_DIR}/convert.c
  ${CMAKE_CURRENT_LIST_DIR}/curve.c
  ${CMAKE_CURRENT_LIST_DIR}/dubins.c
  ${CMAKE_CURRENT_LIST_DIR}/evaluate.c
  ${CMAKE_CURRENT_LIST_DIR}/heading.c
  ${CMAKE_CURRENT_LIST_DIR}/involute.c
  ${CMAKE_CURRENT_LIST_DIR}/lagrange.c
  ${CMAKE_CURRENT_LIST_DIR}/legendre.c
  ${CMAKE_CURRENT_LIST_DIR}/pack.c
  ${CMAKE_CURRENT_LIST_DIR}/packets.c
  ${CMAKE_CURRENT_LIST_DIR}/packets_clusters.c
  ${CMAKE_CURRENT_LIST_DIR}/packets_obb.c
  ${CMAKE_CURRENT_LIST_DIR}/piecewise.c
  ${CMAKE_CURRENT_LIST_DIR}/polynomial.c
  ${CMAKE_CURRENT_LIST_DIR}/pythagorean.c
  ${CMAKE_CURRENT_LIST_DIR}/rectifiable.c
  ${CMAKE_CURRENT_LIST_DIR}/relative_curve.c
  ${CMAKE_CURRENT_LIST_DIR}/smooth.c
  ${CMAKE_CURRENT_LIST_DIR}/subcurve.c
  ${CMAKE_CURRENT_LIST_DIR}/trigonometric.c
)
