# SPDX-License-Identifier: BSD-3-Clause
# The messages, services and actions of the package, in msg/, srv/ and action/, and its dynamic parameters, in cfg/.
foreach(kind msg srv action)
  file(GLOB definitions_${kind} CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/${kind} ${PROJECT_SOURCE_DIR}/${kind}/*.${kind})
endforeach()
add_message_files(DIRECTORY msg FILES ${definitions_msg})
add_service_files(DIRECTORY srv FILES ${definitions_srv})
add_action_files(DIRECTORY action FILES ${definitions_action})
generate_messages(DEPENDENCIES actionlib_msgs geometry_msgs nav_msgs sensor_msgs shape_msgs std_msgs trajectory_msgs)

# What may change while the server runs.
generate_dynamic_reconfigure_options(cfg/ProximityServer.cfg)

# Messages of packages that need not be installed: src/ros/foreign has their definitions as far as the node speaks them.
set(foreign_definitions ${CMAKE_CURRENT_SOURCE_DIR}/src/ros/foreign)
set(foreign_headers ${CMAKE_CURRENT_BINARY_DIR}/foreign_messages)
file(GLOB_RECURSE foreign_files CONFIGURE_DEPENDS ${foreign_definitions}/*)
add_custom_command(OUTPUT ${foreign_headers}/made
  COMMAND ${CATKIN_ENV} ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cmake/foreign_messages.py
    ${foreign_definitions} ${foreign_headers} ${GENCPP_TEMPLATE_DIR} ${MSG_I_FLAGS}
  COMMAND ${CMAKE_COMMAND} -E touch ${foreign_headers}/made
  DEPENDS cmake/foreign_messages.py ${foreign_files} COMMENT "Generating C++ code of src/ros/foreign")
add_custom_target(${PROJECT_NAME}_foreign_messages DEPENDS ${foreign_headers}/made)
