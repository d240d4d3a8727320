/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <sisl.h>
#include <stdlib.h>

#include "curve_peers.h"

static const double RESOLUTION = 1e-10;

static void *make(const double (*points)[3], size_t n, size_t degree, const double *knots) {
  double own[128];
  if (!knots && 2 * n > sizeof own / sizeof *own) return NULL;
  for (size_t i = 0; !knots && i < 2 * n; i++) own[i] = i < n ? 0.0 : 1.0;
  return newCurve((int)n, (int)degree + 1, (double *)(knots ? knots : own), (double *)points, 1, 3, 1);
}

static double to_point(const void *curve, const double point[3]) {
  double at, distance, own[3] = {point[0], point[1], point[2]};
  int status;
  s1957((SISLCurve *)curve, own, 3, RESOLUTION, RESOLUTION, &at, &distance, &status);
  return status < 0 ? NAN : distance;
}

static double between(const SISLCurve *a, double s, const SISLCurve *b, double t) {
  double p[3], q[3], square = 0.0;
  int left = 0, status, other;
  s1221((SISLCurve *)a, 0, s, &left, p, &status);
  left = 0;
  s1221((SISLCurve *)b, 0, t, &left, q, &other);
  if (status < 0 || other < 0) return NAN;
  for (int k = 0; k < 3; k++) square += (p[k] - q[k]) * (p[k] - q[k]);
  return sqrt(square);
}

static double to_curve(const void *a, const void *b) {
  const SISLCurve *first = a, *second = b;
  int points = 0, curves = 0, status;
  double *s = NULL, *t = NULL, least = INFINITY;
  SISLIntcurve **along = NULL;
  s1955((SISLCurve *)first, (SISLCurve *)second, RESOLUTION, RESOLUTION, &points, &s, &t, &curves, &along, &status);
  if (status >= 0) {
    for (int i = 0; i < points; i++) least = fmin(least, between(first, s[i], second, t[i]));
    for (int i = 0; i < curves; i++)
      least = fmin(least, between(first, along[i]->epar1[0], second, along[i]->epar2[0]));
  }
  free(s);
  free(t);
  if (along) freeIntcrvlist(along, curves);
  return isfinite(least) ? least : NAN;
}

static void drop(void *curve) {
  if (curve) freeCurve(curve);
}

const curve_peer curve_peer_sisl = {"SISL", make, to_point, to_curve, NULL, drop};
