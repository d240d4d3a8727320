/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/builders.h"
#include "support/make_curve.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

cprox_workspace *ws;

int workspace_setup(void **state) {
  (void)state;
  ws = cprox_workspace_create();
  return ws ? 0 : 1;
}

int workspace_teardown(void **state) {
  (void)state;
  cprox_workspace_free(ws);
  return 0;
}

cprox_curve *bezier(const vec3 *points, size_t n) {
  cprox_curve *curve = NULL;
  if (curve_from(describe_bezier(points, n, 0.0, 1.0), ws, &curve) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
  return curve;
}

cprox_options accurate(double epsilon) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilon;
  return options;
}
