/* SPDX-License-Identifier: BSD-3-Clause */
/* Error messages of this library, in the workspace of libcprox. */
#ifndef CPROX_FOURIER_ERROR_H
#define CPROX_FOURIER_ERROR_H

#include "curve_proximity/cprox/base.h"

/* Sets the error message, printf-like, and returns the status; a workspace of NULL is allowed. */
cprox_status fourier_fail(cprox_workspace *workspace, cprox_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Forgets the error message of the last call. */
/* A constructor that the stop function of the workspace ended: CPROX_INVALID. */
cprox_status fourier_stopped(cprox_workspace *workspace);

void fourier_clear(cprox_workspace *workspace);

#endif
