# SPDX-License-Identifier: BSD-3-Clause
# What the core's own tests stand on: cprox_cmocka, and cprox_ccd as a second opinion beside our pair solver.
if(NOT TARGET cprox_ccd)
  pkg_check_modules(PC_CCD REQUIRED ccd)
  add_library(cprox_ccd INTERFACE)
  target_include_directories(cprox_ccd SYSTEM INTERFACE ${PC_CCD_INCLUDEDIR} ${PC_CCD_INCLUDE_DIRS})
  target_link_libraries(cprox_ccd INTERFACE ${PC_CCD_LINK_LIBRARIES})
endif()
pkg_check_modules(PC_CMOCKA REQUIRED cmocka)
add_library(cprox_cmocka INTERFACE)
target_include_directories(cprox_cmocka SYSTEM INTERFACE ${PC_CMOCKA_INCLUDEDIR} ${PC_CMOCKA_INCLUDE_DIRS})
target_link_libraries(cprox_cmocka INTERFACE ${PC_CMOCKA_LINK_LIBRARIES})
