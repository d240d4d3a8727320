# The files of this room. A new file is one line here.
target_sources(cprox_objects PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/certificate.c
  ${CMAKE_CURRENT_LIST_DIR}/describe.c
  ${CMAKE_CURRENT_LIST_DIR}/describe_robot.c
  ${CMAKE_CURRENT_LIST_DIR}/element_order.c
  ${CMAKE_CURRENT_LIST_DIR}/multipliers.c
  ${CMAKE_CURRENT_LIST_DIR}/partition.c
  ${CMAKE_CURRENT_LIST_DIR}/partition_curves.c
  ${CMAKE_CURRENT_LIST_DIR}/partition_elements.c
  ${CMAKE_CURRENT_LIST_DIR}/partition_robot.c
  ${CMAKE_CURRENT_LIST_DIR}/reach.c
  ${CMAKE_CURRENT_LIST_DIR}/write.c
  ${CMAKE_CURRENT_LIST_DIR}/write_near.c
  ${CMAKE_CURRENT_LIST_DIR}/write_robot.c
  ${CMAKE_CURRENT_LIST_DIR}/write_robot_near.c
)
