/* SPDX-License-Identifier: BSD-3-Clause */
#include "fourier/error.h"

#include <stdarg.h>
#include <stdio.h>

cprox_status fourier_fail(cprox_workspace *workspace, cprox_status status, const char *format, ...) {
  char message[256];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  cprox_workspace_set_error(workspace, message);
  return status;
}

cprox_status fourier_stopped(cprox_workspace *workspace) {
  return fourier_fail(workspace, CPROX_INVALID, "the stop function ended the making of the gap");
}

void fourier_clear(cprox_workspace *workspace) {
  cprox_workspace_set_error(workspace, NULL);
}
