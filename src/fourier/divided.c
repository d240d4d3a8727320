/* SPDX-License-Identifier: BSD-3-Clause */
#include "fourier/divided.h"

#include "fourier/profile.h"

enum { SERIES = 18 };
#define SPREAD_OF_SERIES 0.6

/* exp(-im) sum over k >= n-1 of (-i)^k h_(k-n+1)(t - m)/k!, h_j the complete homogeneous symmetric polynomials. */
static wave by_series(const double *t, int n) {
  double m = 0.0;
  for (int i = 0; i < n; i++) m += t[i] / n;

  double h[SERIES] = {1.0};
  for (int i = 0; i < n; i++)
    for (int j = 1; j < SERIES; j++) h[j] += (t[i] - m) * h[j - 1];

  double factorial = 1.0;
  for (int k = 2; k < n; k++) factorial *= k;
  double part[4] = {0.0, 0.0, 0.0, 0.0}; /* of (-i)^0 … (-i)^3 */
  for (int j = 0; j < SERIES; j++) {
    const int k = j + n - 1;
    if (j > 0) factorial *= k;
    part[k & 3] += h[j] / factorial;
  }
  return wave_times((wave){part[0] - part[2], part[3] - part[1]}, wave_back(m));
}

static wave of_sorted(const double *t, int n) {
  if (n == 1) return wave_back(t[0]);
  if (n == 2) { /* -i exp(-i(a+b)/2) sinc((b-a)/2) */
    const double s = profile_sinc(0.5 * (t[1] - t[0]));
    const wave e = wave_back(0.5 * (t[0] + t[1]));
    return (wave){s * e.im, -s * e.re};
  }
  const double spread = t[n - 1] - t[0];
  if (spread < SPREAD_OF_SERIES) return by_series(t, n);
  const wave a = of_sorted(t, n - 1), b = of_sorted(t + 1, n - 1);
  return (wave){(b.re - a.re) / spread, (b.im - a.im) / spread};
}

wave divided_exponential(const double *nodes, int n) {
  double t[DIVIDED_MOST] = {0.0};
  for (int i = 0; i < n; i++) {
    int j = i;
    for (; j > 0 && t[j - 1] > nodes[i]; j--) t[j] = t[j - 1];
    t[j] = nodes[i];
  }
  return of_sorted(t, n);
}
