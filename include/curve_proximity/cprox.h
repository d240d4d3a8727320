/* SPDX-License-Identifier: BSD-3-Clause */
/** The whole C API of curve_proximity: how close a continuous motion comes to what is around it, with a certificate.
 *
 *  SI units, radians, right-handed frames. Planar problems live at z = 0. The library keeps no global state, prints
 *  nothing and never exits; what it allocates belongs to the handle it returns.
 */
#ifndef CURVE_PROXIMITY_CPROX_H
#define CURVE_PROXIMITY_CPROX_H

#include <curve_proximity/cprox/base.h>
#include <curve_proximity/cprox/body.h>
#include <curve_proximity/cprox/ccd.h>
#include <curve_proximity/cprox/certificate.h>
#include <curve_proximity/cprox/curve.h>
#include <curve_proximity/cprox/edges.h>
#include <curve_proximity/cprox/gradient.h>
#include <curve_proximity/cprox/implicit.h>
#include <curve_proximity/cprox/obstacles.h>
#include <curve_proximity/cprox/query.h>
#include <curve_proximity/cprox/robot.h>
#include <curve_proximity/cprox/robust.h>
#include <curve_proximity/cprox/translation.h>

#endif
