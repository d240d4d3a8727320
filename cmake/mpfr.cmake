# SPDX-License-Identifier: BSD-3-Clause
# MPFR, for the checker of certificates and the tests of the rounding bounds: always with ROS or tests, else where it is found.
if(CPROX_ROS OR CPROX_TESTS)
  pkg_check_modules(PC_MPFR REQUIRED mpfr)
else()
  #catkin_lint: ignore_once duplicate_find
  find_package(PkgConfig QUIET)
  if(PKG_CONFIG_FOUND)
    pkg_check_modules(PC_MPFR QUIET mpfr)
  endif()
endif()
if(PC_MPFR_FOUND)
  add_library(cprox_mpfr INTERFACE)
  target_include_directories(cprox_mpfr SYSTEM INTERFACE ${PC_MPFR_INCLUDEDIR} ${PC_MPFR_INCLUDE_DIRS})
  target_link_libraries(cprox_mpfr INTERFACE ${PC_MPFR_LINK_LIBRARIES})
endif()
