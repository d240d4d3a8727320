/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_proximity/cprox/base.h"

#define TEXT_OF(number) #number
#define TEXT(number) TEXT_OF(number)

const char *cprox_version(void) {
  return TEXT(CPROX_VERSION_MAJOR) "." TEXT(CPROX_VERSION_MINOR) "." TEXT(CPROX_VERSION_PATCH);
}

#undef TEXT
#undef TEXT_OF

const char *cprox_status_name(cprox_status status) {
  switch (status) {
#define NAME(code, value, name, text) \
  case code: return name;
    CPROX_STATUS_LIST(NAME)
#undef NAME
  }
  return "unknown";
}

const char *cprox_status_text(cprox_status status) {
  switch (status) {
#define TEXT(code, value, name, text) \
  case code: return text;
    CPROX_STATUS_LIST(TEXT)
#undef TEXT
  }
  return "unknown status";
}
