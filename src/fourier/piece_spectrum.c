/* SPDX-License-Identifier: BSD-3-Clause */
/* The closed-form spectra, a function a kind (doc/fourier.md, "Spectra"). Each works in the piece's own axes and about
 * its own centre; piece_spectrum() turns and shifts. */
#include "fourier/divided.h"
#include "fourier/piece.h"
#include "fourier/profile.h"

/* A real spectrum with its gradient: what bodies symmetric about their centre have. */
typedef struct real_jet {
  double value;
  vec3 gradient;
} real_jet;

static real_jet ellipsoid(const piece *p, int dimension, vec3 q) {
  const double ax = p->size[0], ay = p->size[1], az = dimension == 2 ? 0.0 : p->size[2];
  const double y = vec_norm(vec(ax * q.x, ay * q.y, az * q.z)), m = piece_measure(p, dimension);
  const double slope = m * (dimension == 2 ? profile_disc_slope(y) : profile_ball_slope(y));
  return (real_jet){m * (dimension == 2 ? profile_disc(y) : profile_ball(y)),
                    vec(slope * ax * ax * q.x, slope * ay * ay * q.y, slope * az * az * q.z)};
}

static real_jet box(const piece *p, int dimension, vec3 q) {
  const double *h = p->size, hz = dimension == 2 ? 0.0 : h[2], m = piece_measure(p, dimension);
  const double a = profile_sinc(q.x * h[0]), b = profile_sinc(q.y * h[1]), c = profile_sinc(q.z * hz);
  return (real_jet){m * a * b * c, vec(m * h[0] * profile_sinc_slope(q.x * h[0]) * b * c,
                                       m * h[1] * profile_sinc_slope(q.y * h[1]) * a * c,
                                       m * hz * profile_sinc_slope(q.z * hz) * a * b)};
}

/* The section of a capsule or cylinder across its axis: the transform of a disc (in space) or a segment (in the plane)
 * of radius s at the transverse frequency, and its derivative over that frequency. */
typedef struct section {
  double value, slope;
} section;

static section section_at(int dimension, double transverse, double s) {
  const double y = transverse * s;
  if (dimension == 2) {
    const double slope = profile_sinc_slope(y);
    return (section){2.0 * s * profile_sinc(y), 2.0 * s * s * (y == 0.0 ? -s / 3.0 : slope / transverse)};
  }
  const double m = ball_measure(2, s);
  return (section){m * profile_disc(y), m * s * s * profile_disc_slope(y)};
}

static real_jet cylinder(const piece *p, vec3 q) {
  const double h = p->size[1];
  const section disc = section_at(3, hypot(q.x, q.y), p->size[0]);
  const double along = 2.0 * h * profile_sinc(q.z * h), slope = 2.0 * h * h * profile_sinc_slope(q.z * h);
  return (real_jet){along * disc.value, vec(along * disc.slope * q.x, along * disc.slope * q.y, slope * disc.value)};
}

/* Gauss-Legendre on [-1, 1], 24 nodes: the positive half. */
enum { GAUSS_HALF = 12 };
static const double GAUSS_NODE[GAUSS_HALF] = {0.06405689286260562609, 0.19111886747361630916, 0.31504267969616337439,
                                              0.43379350762604513849, 0.54542147138883953566, 0.64809365193697556925,
                                              0.74012419157855436424, 0.82000198597390292195, 0.88641552700440103421,
                                              0.93827455200273275852, 0.97472855597130949820, 0.99518721999702136018};
static const double GAUSS_WEIGHT[GAUSS_HALF] = {0.12793819534675215697, 0.12583745634682829612, 0.12167047292780339120,
                                                0.11550566805372560135, 0.10744427011596563478, 0.09761865210411388827,
                                                0.08619016153195327592, 0.07334648141108030573, 0.05929858491543678075,
                                                0.04427743881741980617, 0.02853138862893366318, 0.01234122979998719955};

/* One slice of both caps: at height z = r sin phi above the cylinder, of radius r cos phi. */
static void add_cap_slice(int dimension, double r, double h, double along, double transverse, double phi, double weight,
                          double sum[3]) {
  const double z = h + r * sin(phi), s = r * cos(phi), w = 2.0 * weight * s;
  const section at = section_at(dimension, transverse, s);
  const double c = cos(along * z);
  sum[0] += w * c * at.value;
  sum[1] -= w * z * sin(along * z) * at.value;
  sum[2] += w * c * at.slope;
}

/* The cylinder between the caps in closed form, the caps by quadrature over their slices: half balls have no closed
 * form. A panel spans at most 16 rad of phase, which 24 nodes integrate to rounding. */
static real_jet capsule(const piece *p, int dimension, vec3 q) {
  const double r = p->size[0], h = p->size[1];
  const double along = dimension == 2 ? q.x : q.z, transverse = dimension == 2 ? q.y : hypot(q.x, q.y);
  const section middle = section_at(dimension, transverse, r);
  double sum[3] = {2.0 * h * profile_sinc(along * h) * middle.value,
                   2.0 * h * h * profile_sinc_slope(along * h) * middle.value,
                   2.0 * h * profile_sinc(along * h) * middle.slope};

  const double reach = vec_norm(q) * r;
  const int panels = reach < 1e4 ? 1 + (int)(reach / 10.0) : 1001;
  const double half = 0.78539816339744830962 / panels; /* (pi/2)/2 each */
  for (int k = 0; k < panels; k++)
    for (int i = 0; i < GAUSS_HALF; i++) {
      const double mid = (2 * k + 1) * half, d = half * GAUSS_NODE[i], w = half * GAUSS_WEIGHT[i];
      add_cap_slice(dimension, r, h, along, transverse, mid - d, w, sum);
      add_cap_slice(dimension, r, h, along, transverse, mid + d, w, sum);
    }
  if (dimension == 2) return (real_jet){sum[0], vec(sum[1], sum[2] * q.y, 0.0)};
  return (real_jet){sum[0], vec(sum[2] * q.x, sum[2] * q.y, sum[1])};
}

/* jet += (a + i b) times (value w, gradient vectors) helpers */
static void add_gradient(wave_jet *jet, wave w, vec3 along) {
  jet->re = vec_axpy(jet->re, w.re, along);
  jet->im = vec_axpy(jet->im, w.im, along);
}

/* Integral of exp(-iq·x) along the segment from a to b, over its length; with the gradient. */
static void add_segment(vec3 a, vec3 b, double scale, vec3 q, bool gradient, wave_jet *jet) {
  const vec3 d = vec_sub(b, a), m = vec_axpy(a, 0.5, d);
  const double y = 0.5 * vec_dot(q, d), s = scale * profile_sinc(y);
  const wave e = wave_back(vec_dot(q, m));
  jet->value.re += s * e.re, jet->value.im += s * e.im;
  if (!gradient) return;
  const double slope = 0.5 * scale * profile_sinc_slope(y);
  add_gradient(jet, (wave){s * e.im, -s * e.re}, m); /* -i m s e */
  add_gradient(jet, (wave){slope * e.re, slope * e.im}, d);
}

/* F = (i/|q|²) A, A = sum over the boundary: turns A and its gradient into F and its. */
static void over_boundary(vec3 q, bool gradient, wave_jet *jet) {
  const double w = 1.0 / vec_norm2(q);
  const wave a = jet->value;
  const vec3 re = jet->re, im = jet->im;
  jet->value = (wave){-w * a.im, w * a.re};
  if (!gradient) return;
  jet->re = vec_axpy(vec_scale(-w, im), -2.0 * w * jet->value.re, q);
  jet->im = vec_axpy(vec_scale(w, re), -2.0 * w * jet->value.im, q);
}

/* Below this |q| times the size the sums over the boundary cancel, and the sums over simplices from one corner take
 * over. */
#define FAR_FROM_ZERO 2.0

static void polygon_boundary(const piece *p, vec3 q, vec3 origin, bool gradient, wave_jet *jet) {
  for (size_t i = 0; i < p->n_corners; i++) {
    const vec3 a = vec_sub(p->corner[i], origin), b = vec_sub(p->corner[(i + 1) % p->n_corners], origin);
    const vec3 d = vec_sub(b, a);
    const double cross = q.x * d.y - q.y * d.x;
    wave_jet edge = {0};
    add_segment(a, b, 1.0, q, gradient, &edge);
    jet->value.re += cross * edge.value.re, jet->value.im += cross * edge.value.im;
    if (!gradient) continue;
    jet->re = vec_axpy(jet->re, cross, edge.re), jet->im = vec_axpy(jet->im, cross, edge.im);
    add_gradient(jet, edge.value, vec(d.y, -d.x, 0.0));
  }
  over_boundary(q, gradient, jet);
}

/* Adds scale times the integral of exp(-iq·x) over the standard simplex mapped to the corners 0, v[0] … v[n-1]. */
static void add_simplex(const vec3 *v, int n, double scale, vec3 q, bool gradient, wave_jet *jet) {
  double t[DIVIDED_MOST] = {0.0};
  for (int j = 0; j < n; j++) t[j + 1] = vec_dot(q, v[j]);
  wave g = divided_exponential(t, n + 1);
  /* over (-i)^n: n = 2 divides by -1, n = 3 by i */
  jet->value.re += n == 2 ? -scale * g.re : scale * g.im;
  jet->value.im += n == 2 ? -scale * g.im : -scale * g.re;
  for (int j = 0; gradient && j < n; j++) {
    t[n + 1] = t[j + 1];
    g = divided_exponential(t, n + 2);
    add_gradient(jet, n == 2 ? (wave){-scale * g.re, -scale * g.im} : (wave){scale * g.im, -scale * g.re}, v[j]);
  }
}

static void polygon(const piece *p, vec3 q, vec3 origin, bool gradient, wave_jet *jet) {
  const double size = piece_radius_about(p, 2, origin);
  if (vec_norm(q) * size > FAR_FROM_ZERO) {
    polygon_boundary(p, q, origin, gradient, jet);
    return;
  }
  for (size_t i = 1; i + 1 < p->n_corners; i++) {
    const vec3 v[2] = {vec_sub(p->corner[i], origin), vec_sub(p->corner[i + 1], origin)};
    add_simplex(v, 2, v[0].x * v[1].y - v[0].y * v[1].x, q, gradient, jet);
  }
}

/* (q·n) times minus the divided difference over a triangle's corners, n = (b-a)×(c-a). */
static void add_face(const vec3 v[3], vec3 q, bool gradient, wave_jet *jet) {
  const vec3 n = vec_cross(vec_sub(v[1], v[0]), vec_sub(v[2], v[0]));
  double t[4];
  for (int j = 0; j < 3; j++) t[j] = vec_dot(q, v[j]);
  const wave g = divided_exponential(t, 3);
  const double flux = -vec_dot(q, n);
  jet->value.re += flux * g.re, jet->value.im += flux * g.im;
  if (!gradient) return;
  add_gradient(jet, (wave){-g.re, -g.im}, n);
  for (int j = 0; j < 3; j++) {
    t[3] = t[j];
    const wave slope = divided_exponential(t, 4);
    add_gradient(jet, (wave){flux * slope.re, flux * slope.im}, v[j]);
  }
}

static void soup(const piece *p, vec3 q, vec3 origin, bool gradient, wave_jet *jet) {
  const bool boundary = vec_norm(q) * piece_radius_about(p, 3, origin) > FAR_FROM_ZERO;
  for (size_t i = 0; i < p->n_corners; i += 3) {
    vec3 v[3];
    for (int j = 0; j < 3; j++) v[j] = vec_sub(p->corner[i + (size_t)j], origin);
    if (boundary)
      add_face(v, q, gradient, jet);
    else
      add_simplex(v, 3, vec_dot(v[0], vec_cross(v[1], v[2])), q, gradient, jet);
  }
  if (boundary) over_boundary(q, gradient, jet);
}

static void sweep(const piece *p, int dimension, vec3 q, vec3 origin, bool gradient, wave_jet *jet) {
  for (size_t i = 0; i < p->n_corners; i += 2) {
    const vec3 a = vec_sub(p->corner[i], origin), b = vec_sub(p->corner[i + 1], origin);
    add_segment(a, b, vec_norm(vec_sub(b, a)), q, gradient, jet);
  }
  piece ball = piece_create(PIECE_ELLIPSOID);
  ball.size[0] = ball.size[1] = ball.size[2] = p->size[0];
  const real_jet b = ellipsoid(&ball, dimension, q);
  const wave line = jet->value;
  jet->value = (wave){b.value * line.re, b.value * line.im};
  jet->re = vec_axpy(vec_scale(b.value, jet->re), line.re, b.gradient);
  jet->im = vec_axpy(vec_scale(b.value, jet->im), line.im, b.gradient);
}

/* Runs of occupied cells along x are boxes. */
static void grid(const piece *p, int dimension, vec3 q, wave_jet *jet) {
  const double cell = p->size[0];
  const size_t nx = p->counts[0], rows = (size_t)p->counts[1] * p->counts[2];
  for (size_t row = 0; row < rows; row++) {
    const unsigned char *cells = p->cells + row * nx;
    const size_t y = row % p->counts[1], z = row / p->counts[1];
    for (size_t i = 0; i < nx; i++) {
      if (!cells[i]) continue;
      const size_t first = i;
      while (i < nx && cells[i]) i++;
      piece run = piece_create(PIECE_BOX);
      run.size[0] = 0.5 * cell * (double)(i - first), run.size[1] = run.size[2] = 0.5 * cell;
      const vec3 m = vec(0.5 * cell * (double)(first + i), cell * ((double)y + 0.5),
                         dimension == 2 ? 0.0 : cell * ((double)z + 0.5));
      const real_jet b = box(&run, dimension, q);
      const wave e = wave_back(vec_dot(q, m));
      jet->value.re += b.value * e.re, jet->value.im += b.value * e.im;
      add_gradient(jet, e, b.gradient);
      add_gradient(jet, (wave){b.value * e.im, -b.value * e.re}, m);
    }
  }
}

/* exp(-iq·c) F, its gradient exp(-iq·c)(∇F - i c F). */
static void shift(vec3 q, vec3 c, wave_jet *jet) {
  const wave e = wave_back(vec_dot(q, c)), f = jet->value;
  const vec3 re = vec_axpy(jet->re, f.im, c), im = vec_axpy(jet->im, -f.re, c);
  jet->value = wave_times(e, f);
  jet->re = vec_sub(vec_scale(e.re, re), vec_scale(e.im, im));
  jet->im = vec_add(vec_scale(e.re, im), vec_scale(e.im, re));
}

void piece_spectrum(const piece *p, int dimension, vec3 q, bool gradient, wave_jet *jet) {
  *jet = (wave_jet){0};
  if (p->corner) {
    /* about a corner, so that phases are those of the size and not of the position */
    const vec3 origin = p->corner[0];
    if (p->kind == PIECE_POLYGON)
      polygon(p, q, origin, gradient, jet);
    else if (p->kind == PIECE_SOUP)
      soup(p, q, origin, gradient, jet);
    else
      sweep(p, dimension, q, origin, gradient, jet);
    shift(q, origin, jet);
    return;
  }

  const vec3 own = rotate_back(p->turn, q);
  if (p->kind == PIECE_GRID) {
    grid(p, dimension, own, jet);
  } else {
    const real_jet real = p->kind == PIECE_ELLIPSOID  ? ellipsoid(p, dimension, own)
                          : p->kind == PIECE_BOX      ? box(p, dimension, own)
                          : p->kind == PIECE_CYLINDER ? cylinder(p, own)
                                                      : capsule(p, dimension, own);
    jet->value.re = real.value, jet->re = real.gradient;
  }
  jet->re = rotate(p->turn, jet->re), jet->im = rotate(p->turn, jet->im);
  shift(q, p->centre, jet);
}
