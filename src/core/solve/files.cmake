# The files of this room. A new file is one line here.
target_sources(cprox_objects PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/gradient.c
  ${CMAKE_CURRENT_LIST_DIR}/gradient_ties.c
  ${CMAKE_CURRENT_LIST_DIR}/growth_along.c
  ${CMAKE_CURRENT_LIST_DIR}/growth_motion.c
  ${CMAKE_CURRENT_LIST_DIR}/motion_derivatives.c
  ${CMAKE_CURRENT_LIST_DIR}/motion_gradient.c
  ${CMAKE_CURRENT_LIST_DIR}/motion_spot.c
  ${CMAKE_CURRENT_LIST_DIR}/robot_verdict.c
  ${CMAKE_CURRENT_LIST_DIR}/solve.c
  ${CMAKE_CURRENT_LIST_DIR}/time_of_contact.c
)
