/* SPDX-License-Identifier: BSD-3-Clause */
/* Two or three robots and bodies on pose splines, each with its own motion, start and base: robot_cases.c says how they
 * are held. */
#include "robot_cases.h"

static void one_case(attack *a, rng *r) {
  robot_case(a, r, true);
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "movers", one_case);
}
