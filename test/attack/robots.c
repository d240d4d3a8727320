/* SPDX-License-Identifier: BSD-3-Clause */
/* A robot along its motion: robot_cases.c says how it is held. */
#include "robot_cases.h"

static void one_case(attack *a, rng *r) {
  robot_case(a, r, false);
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "robots", one_case);
}
