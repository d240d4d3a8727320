/* SPDX-License-Identifier: BSD-3-Clause */
/* Proofs of robots' answers, for write.c, which proves all others. */
#ifndef CPROX_CERTIFICATE_WRITE_H
#define CPROX_CERTIFICATE_WRITE_H

#include "certificate/certificate.h"
#include "curve_proximity/cprox/robot.h"

/* Parameters from here on do not count: INFINITY for all. */
typedef struct claim_wanted {
  double delta, before;
} claim_wanted;

/* Proves an answer of a robot along a motion whose arguments were checked; the reason is told of CPROX_INVALID alone,
 * and what failed may have left something in the certificate. */
cprox_status certify_robot(const cprox_mover *mover, const cprox_obstacle *targets, size_t n, claim_wanted wanted,
                           const cprox_result *answer, const cprox_options *options, cprox_workspace *workspace,
                           cprox_certificate *certificate);

/* The first geometry of the robot's links that certificates do not know; their number, where they know all. */
size_t describe_unknown_geometry(const cprox_robot *robot);

#endif
