# The files of this room. A new file is one line here.
target_sources(cprox_objects PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/distance.c
  ${CMAKE_CURRENT_LIST_DIR}/edges.c
  ${CMAKE_CURRENT_LIST_DIR}/joint_box.c
  ${CMAKE_CURRENT_LIST_DIR}/motion_gradient.c
  ${CMAKE_CURRENT_LIST_DIR}/motion_rows.c
  ${CMAKE_CURRENT_LIST_DIR}/nearest.c
  ${CMAKE_CURRENT_LIST_DIR}/nearest_pairs.c
  ${CMAKE_CURRENT_LIST_DIR}/obstacle_bvh.c
  ${CMAKE_CURRENT_LIST_DIR}/obstacles.c
  ${CMAKE_CURRENT_LIST_DIR}/profile.c
  ${CMAKE_CURRENT_LIST_DIR}/robust.c
  ${CMAKE_CURRENT_LIST_DIR}/states.c
  ${CMAKE_CURRENT_LIST_DIR}/sweep.c
  ${CMAKE_CURRENT_LIST_DIR}/time_of_contact.c
  ${CMAKE_CURRENT_LIST_DIR}/violations.c
)
