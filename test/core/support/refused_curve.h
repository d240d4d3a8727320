/* SPDX-License-Identifier: BSD-3-Clause */
/* Descriptions that must be refused, and the words that say why. */
#ifndef CPROX_TEST_REFUSED_CURVE_H
#define CPROX_TEST_REFUSED_CURVE_H

#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/cases.h"
#include "support/make_curve.h"

/* No curve comes of it, and the error message has these words. */
static inline void refuses_curve(cprox_curve_description description, const char *words) {
  cprox_workspace *ws = cprox_workspace_create();
  cprox_curve *curve = NULL;
  assert_int_equal(curve_from(description, ws, &curve), CPROX_INVALID);
  assert_null(curve);
  if (!strstr(cprox_workspace_error(ws), words)) fail_msg("'%s' lacks '%s'", cprox_workspace_error(ws), words);
  cprox_workspace_free(ws);
}

#endif
