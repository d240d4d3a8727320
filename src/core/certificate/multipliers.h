/* SPDX-License-Identifier: BSD-3-Clause */
/* Multipliers of bodies by inequalities: certificates have them in place of directions. */
#ifndef CPROX_CERTIFICATE_MULTIPLIERS_H
#define CPROX_CERTIFICATE_MULTIPLIERS_H

#include "base/workspace.h"
#include "certificate/certificate.h"
#include "certificate/reach.h"

/* Those of a direction in the body's frame, or nearly, rounded to the width of the certificate; false: none were found.
 * They are in the workspace until the next call. */
bool multipliers_find(const cprox_body *body, vec3 own, const cprox_certificate *certificate,
                      cprox_workspace *workspace, implicit_dual *dual);

void multipliers_write(const cprox_body *body, cprox_certificate *certificate, const implicit_dual *dual);

/* The unit direction that they make, in the body's frame, and how far the body reaches along it about its centre, both
 * within rounding. */
vec3 multipliers_direction(const cprox_body *body, const implicit_dual *dual, double *height);

#endif
