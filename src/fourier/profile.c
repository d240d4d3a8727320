/* SPDX-License-Identifier: BSD-3-Clause */
/* j0 and j1 are POSIX's, not C11's; this macro, reserved for the purpose, is how POSIX has them asked for. */
#define _XOPEN_SOURCE 700 /* NOLINT(bugprone-reserved-identifier) */
#include "fourier/profile.h"

#include <math.h>

double profile_sinc(double y) {
  return y == 0.0 ? 1.0 : sin(y) / y;
}

/* (cos y - sin(y)/y)/y loses 1/y² of its digits to cancellation near 0, where its series takes over. */
double profile_sinc_slope(double y) {
  const double s = y * y;
  if (s < 1.0)
    return -y / 3.0 *
           (1.0 -
            s / 10.0 * (1.0 - s / 28.0 * (1.0 - s / 54.0 * (1.0 - s / 88.0 * (1.0 - s / 130.0 * (1.0 - s / 180.0))))));
  return (cos(y) - sin(y) / y) / y;
}

double profile_j0(double y) {
  return j0(y);
}

double profile_j1(double y) {
  return j1(y);
}

double profile_disc(double y) {
  const double s = y * y;
  if (s < 1e-2) return 1.0 - s / 8.0 * (1.0 - s / 24.0 * (1.0 - s / 48.0 * (1.0 - s / 80.0)));
  return 2.0 * j1(y) / y;
}

/* -2 J2(y)/y², J2 = 2 J1/y - J0 away from 0. */
double profile_disc_slope(double y) {
  const double s = y * y;
  if (s < 1.0)
    return -0.25 *
           (1.0 -
            s / 12.0 * (1.0 - s / 32.0 * (1.0 - s / 60.0 * (1.0 - s / 96.0 * (1.0 - s / 140.0 * (1.0 - s / 192.0))))));
  return -2.0 * (2.0 * j1(y) / y - j0(y)) / s;
}

double profile_ball(double y) {
  const double s = y * y;
  if (s < 1.0)
    return 1.0 -
           s / 10.0 *
               (1.0 -
                s / 28.0 *
                    (1.0 - s / 54.0 * (1.0 - s / 88.0 * (1.0 - s / 130.0 * (1.0 - s / 180.0 * (1.0 - s / 238.0))))));
  return 3.0 * (sin(y) - y * cos(y)) / (y * s);
}

double profile_ball_slope(double y) {
  const double s = y * y;
  if (s < 1.0)
    return -0.2 *
           (1.0 -
            s / 14.0 * (1.0 - s / 36.0 * (1.0 - s / 66.0 * (1.0 - s / 104.0 * (1.0 - s / 150.0 * (1.0 - s / 204.0))))));
  return 3.0 * (sin(y) / y - profile_ball(y)) / s;
}

double profile_i0(double y) {
  const double s = 0.25 * y * y;
  double term = 1.0, sum = 1.0;
  for (int k = 1; k < 2000 && term > 1e-17 * sum; k++) {
    term *= s / ((double)k * (double)k);
    sum += term;
  }
  return sum;
}
