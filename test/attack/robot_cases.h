/* SPDX-License-Identifier: BSD-3-Clause */
/* One robot, or several on one clock. */
#ifndef CPROX_ATTACK_ROBOT_CASES_H
#define CPROX_ATTACK_ROBOT_CASES_H

#include <stdbool.h>

#include "attack.h"

void robot_case(attack *a, rng *r, bool several);

#endif
