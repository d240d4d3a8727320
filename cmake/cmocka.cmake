# SPDX-License-Identifier: BSD-3-Clause
# cprox_cmocka: the test library of the core, from whatever the distribution offers; cprox_ccd beside it, as a second
# opinion in tests.
find_package(PkgConfig REQUIRED)
pkg_check_modules(CMOCKA REQUIRED cmocka)
add_library(cprox_cmocka INTERFACE)
target_include_directories(cprox_cmocka SYSTEM INTERFACE ${CMOCKA_INCLUDE_DIRS})
target_link_libraries(cprox_cmocka INTERFACE ${CMOCKA_LINK_LIBRARIES})

if(NOT TARGET cprox_ccd)
  pkg_check_modules(CPROX_CCD REQUIRED ccd)
  add_library(cprox_ccd INTERFACE)
  target_include_directories(cprox_ccd SYSTEM INTERFACE ${CPROX_CCD_INCLUDE_DIRS})
  target_link_libraries(cprox_ccd INTERFACE ${CPROX_CCD_LINK_LIBRARIES})
endif()
