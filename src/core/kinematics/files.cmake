# The files of this room. A new file is one line here.
target_sources(cprox_objects PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/arcs.c
  ${CMAKE_CURRENT_LIST_DIR}/bound.c
  ${CMAKE_CURRENT_LIST_DIR}/errors.c
  ${CMAKE_CURRENT_LIST_DIR}/given.c
  ${CMAKE_CURRENT_LIST_DIR}/jacobian.c
  ${CMAKE_CURRENT_LIST_DIR}/joint_tree.c
  ${CMAKE_CURRENT_LIST_DIR}/link_model.c
  ${CMAKE_CURRENT_LIST_DIR}/motion.c
  ${CMAKE_CURRENT_LIST_DIR}/motion_axes.c
  ${CMAKE_CURRENT_LIST_DIR}/motion_create.c
  ${CMAKE_CURRENT_LIST_DIR}/motion_join.c
  ${CMAKE_CURRENT_LIST_DIR}/motion_rates.c
  ${CMAKE_CURRENT_LIST_DIR}/motion_turning.c
  ${CMAKE_CURRENT_LIST_DIR}/part_cover.c
  ${CMAKE_CURRENT_LIST_DIR}/part_cover_hulls.c
  ${CMAKE_CURRENT_LIST_DIR}/part_groups.c
  ${CMAKE_CURRENT_LIST_DIR}/pose_fit.c
  ${CMAKE_CURRENT_LIST_DIR}/robot.c
  ${CMAKE_CURRENT_LIST_DIR}/spans.c
  ${CMAKE_CURRENT_LIST_DIR}/sweeps.c
)
