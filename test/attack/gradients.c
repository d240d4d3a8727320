/* SPDX-License-Identifier: BSD-3-Clause */
/* Gradients of a robot's clearance along its motion, in turns with gradients of its depth, against central differences
 * of the certified distance (core/support/gradient_case.h): by waypoints or control points, their velocities and
 * accelerations, duration, base, obstacle and margin, along a random step of all of these at once. Their tolerance is
 * 1e-6 (1 + |derivative|): the differences are off by 1e-7 where their intervals are narrow enough. A gradient that is
 * missing where the distance has a slope is no fault; it is counted. */
#include <string.h>

#include "attack.h"
#include "support/builders.h"
#include "support/gradient_case.h"

static void one_case(attack *a, rng *r) {
  ws = a->ws;
  gradient_case p;
  gradient_judgement j;
  const bool is_signed = a->number % 2 == 1;
  gradient_case_make(r, is_signed, &p);
  const char *what = is_signed ? "depth" : "clearance";
  switch (gradient_case_judge(r, &p, &j)) {
    case GRADIENT_NOT_ASKED: attack_kind(a, "%s, none to speak of", what); break;
    case GRADIENT_FITS: attack_kind(a, "%s, gradient", what); break;
    case GRADIENT_BESIDE_TIE: attack_kind(a, "%s, gradient of one side of a tie", what); break;
    case GRADIENT_TIED: attack_kind(a, "%s, tied", what); break;
    case GRADIENT_MISSING: attack_kind(a, "%s, no tie: %s", what, j.why + strlen("no gradient: ")); break;
    case GRADIENT_UNKNOWN: attack_kind(a, "%s, differences do not tell", what); break;
    case GRADIENT_WRONG:
      attack_kind(a, "%s, gradient", what);
      attack_fail(a, "derivative %.17g at t %.17g, where the distance is %.17g: differences are off by %.17g",
                  j.expected, j.answer.gradient.t, j.answer.result.upper, j.fit.off);
      break;
  }
  gradient_case_free(&p);
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "gradients", one_case);
}
