# The files of this room. A new file is one line here.
target_sources(cprox_objects PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/answer.c
  ${CMAKE_CURRENT_LIST_DIR}/bound_node.c
  ${CMAKE_CURRENT_LIST_DIR}/cluster.c
  ${CMAKE_CURRENT_LIST_DIR}/deviation.c
  ${CMAKE_CURRENT_LIST_DIR}/element.c
  ${CMAKE_CURRENT_LIST_DIR}/flight.c
  ${CMAKE_CURRENT_LIST_DIR}/groups.c
  ${CMAKE_CURRENT_LIST_DIR}/inside.c
  ${CMAKE_CURRENT_LIST_DIR}/measure.c
  ${CMAKE_CURRENT_LIST_DIR}/oracle.c
  ${CMAKE_CURRENT_LIST_DIR}/pair_distance.c
  ${CMAKE_CURRENT_LIST_DIR}/pair_lists.c
  ${CMAKE_CURRENT_LIST_DIR}/pair_plan.c
  ${CMAKE_CURRENT_LIST_DIR}/pair_table.c
  ${CMAKE_CURRENT_LIST_DIR}/placed_robot_pair.c
  ${CMAKE_CURRENT_LIST_DIR}/prove_contact.c
  ${CMAKE_CURRENT_LIST_DIR}/rank.c
  ${CMAKE_CURRENT_LIST_DIR}/refine.c
  ${CMAKE_CURRENT_LIST_DIR}/robot_depth.c
  ${CMAKE_CURRENT_LIST_DIR}/robot_scene.c
  ${CMAKE_CURRENT_LIST_DIR}/settle_flight.c
  ${CMAKE_CURRENT_LIST_DIR}/starts.c
)
