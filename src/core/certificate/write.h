/* SPDX-License-Identifier: BSD-3-Clause */
/* Proofs of robots' answers, for write.c, which proves all others. */
#ifndef CPROX_CERTIFICATE_WRITE_H
#define CPROX_CERTIFICATE_WRITE_H

#include "certificate/certificate.h"
#include "curve_proximity/cprox/robot.h"

/* A claim about a part of the range gives away at most this much of a piece or a segment at an end. */
#define CLAIM_MOST_BACK 0x1p-10

/* What is claimed apart: all parameters, those before t1, or those of [t0, t1]. */
typedef struct claim_wanted {
  cprox_claim apart; /* APART, BEFORE or DURING */
  double delta, t0, t1;
} claim_wanted;

/* Proves an answer of a robot along a motion whose arguments were checked; the reason is told of CPROX_INVALID alone,
 * and what failed may have left something in the certificate. */
cprox_status certify_robot(const cprox_mover *mover, const cprox_obstacle *obstacles, size_t n, claim_wanted wanted,
                           const cprox_result *answer, const cprox_options *options, cprox_workspace *workspace,
                           cprox_certificate *certificate);

/* The first geometry of the robot's links that certificates do not know; their number, where they know all. */
size_t describe_unknown_geometry(const cprox_robot *robot);

#endif
