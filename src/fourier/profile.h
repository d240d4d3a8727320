/* SPDX-License-Identifier: BSD-3-Clause */
/* The radial profiles that closed-form spectra are made of, each within a few u of 1, at every finite argument. */
#ifndef CPROX_FOURIER_PROFILE_H
#define CPROX_FOURIER_PROFILE_H

/* sin(y)/y, and its derivative. */
double profile_sinc(double y);
double profile_sinc_slope(double y);

/* Bessel functions of the first kind. */
double profile_j0(double y);
double profile_j1(double y);

/* 2 J1(y)/y, the transform of a disc of unit area measure; and its derivative over y. */
double profile_disc(double y);
double profile_disc_slope(double y);

/* 3 (sin y - y cos y)/y³, that of a ball; and its derivative over y. */
double profile_ball(double y);
double profile_ball_slope(double y);

/* The modified Bessel function I0, for Kaiser's window; 0 <= y < 700. */
double profile_i0(double y);

#endif
