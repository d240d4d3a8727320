/* SPDX-License-Identifier: BSD-3-Clause */
/* What a search found, in the terms of the caller: parameters, witness points and normal. */
#ifndef CPROX_CURVE_QUERY_REPORT_H
#define CPROX_CURVE_QUERY_REPORT_H

#include "curve_query/search_kernel.h"

/* Fills in what belongs to the place; without one *r stays as it is. CPROX_OK, or a negative status. */
cprox_status report_finding(const query *q, const placed_pair *p, const curve_finding *seen, cprox_result *r);

#endif
