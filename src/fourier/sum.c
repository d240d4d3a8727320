/* SPDX-License-Identifier: BSD-3-Clause */
/* The sum over the lattice, LANES terms side by side. One body, compiled for the lane widths of the machines at hand;
 * every lane does the same operations in the same order in all of them, so that their results are the same bit for bit.
 */
#include "fourier/gap.h"

#define TAU 6.28318530717958647693

#define INLINE static inline __attribute__((always_inline))

/* Blocks between two looks at whether the sum may stop. */
enum { CHUNK = 4 };

/* exp(i k theta_j), theta_j = 2 pi w_j/L, k = -N … N + LANES, of one vector w. */
typedef struct phase {
  const double *re[3], *im[3]; /* at k = 0 */
} phase;

static void fill_axis(double theta, int N, double *re, double *im) {
  const int last = N + LANES;
  re[0] = 1.0, im[0] = 0.0;
  re[1] = cos(theta), im[1] = sin(theta);
  /* by doubling, so that the error grows as k u and not as k² u */
  for (int k = 2; k <= last; k++) {
    const int a = k / 2, b = k - a;
    re[k] = re[a] * re[b] - im[a] * im[b];
    im[k] = re[a] * im[b] + im[a] * re[b];
  }
  for (int k = 1; k <= N; k++) re[-k] = re[k], im[-k] = -im[k];
}

/* Takes the next tables of the job for the vector w. */
static phase make_phase(const gap_job *job, double **tables, vec3 w) {
  const int N = job->gap->N;
  const size_t width = 2 * (size_t)N + 2 * LANES;
  const double step = TAU / job->gap->info.period, theta[3] = {step * w.x, step * w.y, step * w.z};
  phase p;
  for (int j = 0; j < 3; j++) {
    double *re = *tables + N, *im = re + width;
    if (j < job->gap->info.dimension) fill_axis(theta[j], N, re, im);
    p.re[j] = re, p.im[j] = im;
    *tables += 2 * width;
  }
  return p;
}

/* cos(q·w) and sin(q·w) over the lanes of a block. */
INLINE void phase_lanes(const phase *p, const block *b, bool plane, double c[LANES], double s[LANES]) {
  double yr = p->re[1][b->k[1]], yi = p->im[1][b->k[1]];
  if (!plane) {
    const double zr = p->re[2][b->k[2]], zi = p->im[2][b->k[2]], r = yr * zr - yi * zi;
    yi = yr * zi + yi * zr, yr = r;
  }
  const double *xr = p->re[0] + b->k[0], *xi = p->im[0] + b->k[0];
#pragma omp simd
  for (int l = 0; l < LANES; l++) {
    c[l] = yr * xr[l] - yi * xi[l];
    s[l] = yr * xi[l] + yi * xr[l];
  }
}

/* sin(y)/y and its derivative from y, sin y and cos y; by series below 1/2, where the difference cancels. inverse: 1/y
 * there, anything else below. */
INLINE bool lane_is_small(double y) {
  return fabs(y) < 0.5;
}

INLINE double lane_inverse(double y) {
  return 1.0 / (lane_is_small(y) ? 1.0 : y);
}

INLINE double lane_sinc(double y, double inverse, double sine) {
  const double t = y * y;
  const double series =
      1.0 -
      t * (1.0 / 6.0) *
          (1.0 - t * (1.0 / 20.0) *
                     (1.0 - t * (1.0 / 42.0) *
                                (1.0 - t * (1.0 / 72.0) * (1.0 - t * (1.0 / 110.0) * (1.0 - t * (1.0 / 156.0))))));
  return lane_is_small(y) ? series : sine * inverse;
}

INLINE double lane_sinc_slope(double y, double inverse, double sinc, double cosine) {
  const double t = y * y;
  const double series =
      -y * (1.0 / 3.0) *
      (1.0 -
       t * (1.0 / 10.0) *
           (1.0 - t * (1.0 / 28.0) * (1.0 - t * (1.0 / 54.0) * (1.0 - t * (1.0 / 88.0) * (1.0 - t * (1.0 / 130.0))))));
  return lane_is_small(y) ? series : (cosine - sinc) * inverse;
}

/* A turned piece made ready for a pose: vectors in the fixed solid's frame. */
typedef struct turned_piece {
  const piece *p;
  vec3 axis[3]; /* its own */
  vec3 centre;
  bool centred;    /* the centre is the solid's own: its phase is 1 */
  phase phases[4]; /* of box and ellipsoid: about the axes, the centre */
  phase *edges;    /* of a polygon: middle and half of each edge */
  vec3 *ends;      /* the same as vectors */
  double measure;
} turned_piece;

/* Lanes of T and of H×q, H the gradient of T in the fixed frame. */
typedef struct lanes {
  double qx[LANES], qy, qz;
  double re[LANES], im[LANES];
  double kre[3][LANES], kim[3][LANES];
} lanes;

/* T += exp(-iq·c) f, H×q += exp(-iq·c)(g×q - i f c×q), f and g×q real. (c, s) = phase of the centre. */
INLINE void add_symmetric(lanes *o, bool gradient, bool plane, vec3 centre, const double c[LANES],
                          const double s[LANES], const double f[LANES], double m[3][LANES]) {
#pragma omp simd
  for (int l = 0; l < LANES; l++) {
    o->re[l] += c[l] * f[l];
    o->im[l] -= s[l] * f[l];
    if (gradient) {
      const double z = f[l] * (centre.x * o->qy - centre.y * o->qx[l]);
      o->kre[2][l] += c[l] * m[2][l] - s[l] * z;
      o->kim[2][l] -= s[l] * m[2][l] + c[l] * z;
      if (!plane) {
        const double x = f[l] * (centre.y * o->qz - centre.z * o->qy),
                     y = f[l] * (centre.z * o->qx[l] - centre.x * o->qz);
        o->kre[0][l] += c[l] * m[0][l] - s[l] * x;
        o->kim[0][l] -= s[l] * m[0][l] + c[l] * x;
        o->kre[1][l] += c[l] * m[1][l] - s[l] * y;
        o->kim[1][l] -= s[l] * m[1][l] + c[l] * y;
      }
    }
  }
}

/* The same of a piece about the solid's own centre. */
INLINE void add_centred(lanes *o, bool gradient, bool plane, const double f[LANES], double m[3][LANES]) {
#pragma omp simd
  for (int l = 0; l < LANES; l++) {
    o->re[l] += f[l];
    if (gradient) {
      o->kre[2][l] += m[2][l];
      if (!plane) o->kre[0][l] += m[0][l], o->kre[1][l] += m[1][l];
    }
  }
}

INLINE void add_piece(const turned_piece *t, const block *b, lanes *o, bool gradient, bool plane, const double f[LANES],
                      double m[3][LANES]) {
  if (t->centred) {
    add_centred(o, gradient, plane, f, m);
    return;
  }
  double c[LANES], s[LANES];
  phase_lanes(&t->phases[3], b, plane, c, s);
  add_symmetric(o, gradient, plane, t->centre, c, s, f, m);
}

/* What one axis of a box gives: p = q·axis, sinc(h p) and its slope. */
typedef struct box_axis {
  double p[LANES], sinc[LANES], slope[LANES];
} box_axis;

/* sinc y, and its slope, from the cosines c and sines s of y. */
INLINE void axis_series(const double y[LANES], const double c[LANES], const double s[LANES], bool gradient,
                        box_axis *out) {
#pragma omp simd
  for (int l = 0; l < LANES; l++) {
    const double inverse = lane_inverse(y[l]);
    out->sinc[l] = lane_sinc(y[l], inverse, s[l]);
    if (gradient) out->slope[l] = lane_sinc_slope(y[l], inverse, out->sinc[l], c[l]);
  }
}

/* The same where no lane is near 0: most blocks need no series. */
INLINE void axis_quotients(const double y[LANES], const double c[LANES], const double s[LANES], bool gradient,
                           box_axis *out) {
#pragma omp simd
  for (int l = 0; l < LANES; l++) {
    const double inverse = 1.0 / y[l];
    out->sinc[l] = s[l] * inverse;
    if (gradient) out->slope[l] = (c[l] - out->sinc[l]) * inverse;
  }
}

INLINE void axis_lanes(const phase *table, const block *b, vec3 axis, double h, bool gradient, bool plane,
                       const lanes *o, box_axis *out) {
  double c[LANES], s[LANES], y[LANES];
  phase_lanes(table, b, plane, c, s);
#pragma omp simd
  for (int l = 0; l < LANES; l++) {
    out->p[l] = axis.x * o->qx[l] + axis.y * o->qy + axis.z * o->qz;
    y[l] = out->p[l] * h;
  }
  const double first = y[0], last = y[LANES - 1]; /* in order, as q is */
  if (lane_is_small(first) || lane_is_small(last) || (first < 0.0) != (last < 0.0))
    axis_series(y, c, s, gradient, out);
  else
    axis_quotients(y, c, s, gradient, out);
}

INLINE void box_lanes(const turned_piece *t, const block *b, bool gradient, bool plane, lanes *o) {
  double f[LANES], m[3][LANES];
  box_axis a[3];
  const double *h = t->p->size, measure = t->measure;
  const vec3 u = t->axis[0], v = t->axis[1], w = t->axis[2];
  for (int j = 0; j < (plane ? 2 : 3); j++) axis_lanes(&t->phases[j], b, t->axis[j], h[j], gradient, plane, o, &a[j]);
#pragma omp simd
  for (int l = 0; l < LANES; l++) {
    const double s0 = a[0].sinc[l], s1 = a[1].sinc[l], s2 = plane ? 1.0 : a[2].sinc[l];
    f[l] = measure * s0 * s1 * s2;
    if (gradient) {
      const double p0 = a[0].p[l], p1 = a[1].p[l];
      const double g0 = measure * h[0] * a[0].slope[l] * s1 * s2, g1 = measure * h[1] * a[1].slope[l] * s0 * s2;
      const double n2 = g0 * p1 - g1 * p0;
      if (plane) {
        m[2][l] = n2;
      } else {
        const double p2 = a[2].p[l], g2 = measure * h[2] * a[2].slope[l] * s0 * s1;
        const double n0 = g1 * p2 - g2 * p1, n1 = g2 * p0 - g0 * p2;
        m[0][l] = u.x * n0 + v.x * n1 + w.x * n2;
        m[1][l] = u.y * n0 + v.y * n1 + w.y * n2;
        m[2][l] = u.z * n0 + v.z * n1 + w.z * n2;
      }
    }
  }
  add_piece(t, b, o, gradient, plane, f, m);
}

/* sin and cos of 0 <= y < 1e5, without branches: reduction by pi/2 in three parts, then series on [-pi/4, pi/4]. Within
 * 2u of 1. */
INLINE void lane_sincos(double y, double *sine, double *cosine) {
  const double n = nearbyint(y * 0.63661977236758134308);
  const double r =
      ((y - n * 1.57079632673412561417e+00) - n * 6.07710050630396597660e-11) - n * 2.02226624879595063154e-21;
  const double t = r * r;
  const double s =
      r - r * t * (1.0 / 6.0) *
              (1.0 - t * (1.0 / 20.0) *
                         (1.0 - t * (1.0 / 42.0) *
                                    (1.0 - t * (1.0 / 72.0) *
                                               (1.0 - t * (1.0 / 110.0) *
                                                          (1.0 - t * (1.0 / 156.0) * (1.0 - t * (1.0 / 210.0)))))));
  const double c =
      1.0 -
      t * (1.0 / 2.0) *
          (1.0 -
           t * (1.0 / 12.0) *
               (1.0 - t * (1.0 / 30.0) *
                          (1.0 - t * (1.0 / 56.0) *
                                     (1.0 - t * (1.0 / 90.0) *
                                                (1.0 - t * (1.0 / 132.0) *
                                                           (1.0 - t * (1.0 / 182.0) * (1.0 - t * (1.0 / 240.0))))))));
  const double half = 0.5 * n, quarter = 0.25 * n;
  const bool odd = half != floor(half);          /* sine and cosine change places */
  const double turn = floor(quarter) * -4.0 + n; /* n mod 4: 0, 1, 2, 3 */
  const double a = odd ? c : s, b = odd ? s : c;
  *sine = turn >= 2.0 ? -a : a;
  *cosine = turn == 1.0 || turn == 2.0 ? -b : b;
}

INLINE void ellipsoid_lanes(const turned_piece *t, const block *b, bool gradient, lanes *o) {
  double f[LANES], m[3][LANES];
  const double *a = t->p->size, measure = t->measure;
  const vec3 u = t->axis[0], v = t->axis[1], w = t->axis[2];
#pragma omp simd
  for (int l = 0; l < LANES; l++) {
    const double p0 = u.x * o->qx[l] + u.y * o->qy + u.z * o->qz, p1 = v.x * o->qx[l] + v.y * o->qy + v.z * o->qz;
    const double p2 = w.x * o->qx[l] + w.y * o->qy + w.z * o->qz;
    const double y0 = a[0] * p0, y1 = a[1] * p1, y2 = a[2] * p2, t2 = y0 * y0 + y1 * y1 + y2 * y2, y = sqrt(t2);
    double sine, cosine;
    lane_sincos(y, &sine, &cosine);
    const double big = t2 < 1.0 ? 1.0 : y, big2 = big * big;
    const double series =
        1.0 -
        t2 * (1.0 / 10.0) *
            (1.0 - t2 * (1.0 / 28.0) *
                       (1.0 - t2 * (1.0 / 54.0) *
                                  (1.0 - t2 * (1.0 / 88.0) *
                                             (1.0 - t2 * (1.0 / 130.0) *
                                                        (1.0 - t2 * (1.0 / 180.0) * (1.0 - t2 * (1.0 / 238.0)))))));
    const double profile = t2 < 1.0 ? series : 3.0 * (sine - big * cosine) / (big * big2);
    f[l] = measure * profile;
    if (gradient) {
      const double rise =
          -0.2 *
          (1.0 - t2 * (1.0 / 14.0) *
                     (1.0 - t2 * (1.0 / 36.0) *
                                (1.0 - t2 * (1.0 / 66.0) *
                                           (1.0 - t2 * (1.0 / 104.0) *
                                                      (1.0 - t2 * (1.0 / 150.0) * (1.0 - t2 * (1.0 / 204.0)))))));
      const double slope = measure * (t2 < 1.0 ? rise : 3.0 * (sine / big - profile) / big2);
      const double g0 = slope * a[0] * y0, g1 = slope * a[1] * y1, g2 = slope * a[2] * y2;
      const double n0 = g1 * p2 - g2 * p1, n1 = g2 * p0 - g0 * p2, n2 = g0 * p1 - g1 * p0;
      m[0][l] = u.x * n0 + v.x * n1 + w.x * n2;
      m[1][l] = u.y * n0 + v.y * n1 + w.y * n2;
      m[2][l] = u.z * n0 + v.z * n1 + w.z * n2;
    }
  }
  add_piece(t, b, o, gradient, false, f, m);
}

/* (i/|q|²) sum over the edges of (q×d) e^{-iq·m} sinc(q·d/2), d = 2h; the term of the gradient along q turns nothing.
 */
INLINE void polygon_lanes(const turned_piece *t, const block *b, bool gradient, lanes *o) {
  double are[LANES] = {0}, aim[LANES] = {0}, mre[LANES] = {0}, mim[LANES] = {0};
  const double qy = o->qy;
  for (size_t e = 0; e < t->p->n_corners; e++) {
    double cm[LANES], sm[LANES], ch[LANES], sh[LANES];
    phase_lanes(&t->edges[2 * e], b, true, cm, sm);
    phase_lanes(&t->edges[2 * e + 1], b, true, ch, sh);
    const vec3 m = t->ends[2 * e], h = t->ends[2 * e + 1];
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
      const double y = o->qx[l] * h.x + qy * h.y, cross = 2.0 * (o->qx[l] * h.y - qy * h.x);
      const double inverse = lane_inverse(y), s = lane_sinc(y, inverse, sh[l]), w = cross * s;
      are[l] += w * cm[l];
      aim[l] -= w * sm[l];
      if (gradient) {
        /* (∇A)×q: from e^{-iq·m}: -i w m×q; from the sinc: cross h×q, h×q = -cross/2; what q×d gives, 2y s e^{-iq·m},
         * is the difference of the phases at the edge's ends and adds up to 0 around the loop */
        const double turn = -0.5 * cross * cross * lane_sinc_slope(y, inverse, s, ch[l]);
        const double swing = w * (m.x * qy - m.y * o->qx[l]);
        mre[l] += turn * cm[l] - swing * sm[l];
        mim[l] -= turn * sm[l] + swing * cm[l];
      }
    }
  }
#pragma omp simd
  for (int l = 0; l < LANES; l++) {
    const double w = 1.0 / (o->qx[l] * o->qx[l] + qy * qy);
    o->re[l] -= w * aim[l];
    o->im[l] += w * are[l];
    if (gradient) {
      o->kre[2][l] -= w * mim[l];
      o->kim[2][l] += w * mre[l];
    }
  }
}

/* Any other kind, one frequency after the other. */
static void plain_lanes(const gap_job *job, const turned_piece *t, lanes *o) {
  for (int l = 0; l < LANES; l++) {
    const vec3 q = rotate_back(job->turn, vec(o->qx[l], o->qy, o->qz));
    wave_jet jet;
    piece_spectrum(t->p, job->gap->info.dimension, q, job->gradient, &jet);
    o->re[l] += jet.value.re, o->im[l] += jet.value.im;
    if (!job->gradient) continue;
    const vec3 re = rotate(job->turn, vec_cross(jet.re, q)), im = rotate(job->turn, vec_cross(jet.im, q));
    o->kre[0][l] += re.x, o->kre[1][l] += re.y, o->kre[2][l] += re.z;
    o->kim[0][l] += im.x, o->kim[1][l] += im.y, o->kim[2][l] += im.z;
  }
}

/* A tabulated solid, one frequency after the other; where the coefficients are 0 it is not looked up. */
INLINE void lookup_lanes(const gap_job *job, const double *coefficients, bool gradient, lanes *o) {
  for (int l = 0; l < LANES; l++) {
    if (coefficients[l] == 0.0 && coefficients[LANES + l] == 0.0) continue;
    const vec3 q = rotate_back(job->turn, vec(o->qx[l], o->qy, o->qz));
    wave_jet jet;
    lookup_at(job->gap->table, q, gradient, &jet);
    o->re[l] = jet.value.re, o->im[l] = jet.value.im;
    if (!gradient) continue;
    const vec3 re = rotate(job->turn, vec_cross(jet.re, q)), im = rotate(job->turn, vec_cross(jet.im, q));
    o->kre[0][l] = re.x, o->kre[1][l] = re.y, o->kre[2][l] = re.z;
    o->kim[0][l] = im.x, o->kim[1][l] = im.y, o->kim[2][l] = im.z;
  }
}

/* Sums of a chunk, a lane each. */
typedef struct totals {
  double v[LANES], x[3][LANES], m[3][LANES], energy[LANES];
} totals;

/* z = C conj(T) e^{iq·x}: adds Re z, -q Im z, Re(C e^{iq·x} conj(H×q)), |T|². real: T is, with its derivatives. */
INLINE void add_block(const double *coefficients, const double c[LANES], const double s[LANES], bool gradient,
                      bool plane, bool real, const lanes *o, totals *sum) {
#pragma omp simd
  for (int l = 0; l < LANES; l++) {
    const double are = coefficients[l] * c[l] - coefficients[LANES + l] * s[l];
    const double aim = coefficients[l] * s[l] + coefficients[LANES + l] * c[l];
    sum->v[l] += real ? are * o->re[l] : are * o->re[l] + aim * o->im[l];
    if (!gradient) sum->energy[l] += real ? o->re[l] * o->re[l] : o->re[l] * o->re[l] + o->im[l] * o->im[l];
    if (gradient) {
      const double zi = real ? aim * o->re[l] : aim * o->re[l] - are * o->im[l];
      sum->x[0][l] -= o->qx[l] * zi;
      sum->x[1][l] -= o->qy * zi;
      sum->m[2][l] += real ? are * o->kre[2][l] : are * o->kre[2][l] + aim * o->kim[2][l];
      if (!plane) {
        sum->x[2][l] -= o->qz * zi;
        sum->m[0][l] += real ? are * o->kre[0][l] : are * o->kre[0][l] + aim * o->kim[0][l];
        sum->m[1][l] += real ? are * o->kre[1][l] : are * o->kre[1][l] + aim * o->kim[1][l];
      }
    }
  }
}

/* What a sum works on besides the job. */
typedef struct ready {
  phase at;
  turned_piece *pieces;
  size_t n;
  bool real; /* every piece is symmetric about the solid's centre */
} ready;

INLINE void sum_block(const gap_job *job, const ready *r, const block *b, const double *coefficients, bool gradient,
                      bool plane, totals *sum) {
  const double step = TAU / job->gap->info.period;
  double c[LANES], s[LANES];
  lanes o;
  o.qy = step * b->k[1], o.qz = step * b->k[2];
  for (int l = 0; l < LANES; l++) {
    o.qx[l] = step * (b->k[0] + l);
    o.re[l] = r->n || job->gap->table ? 0.0 : 1.0;
    o.im[l] = 0.0;
    for (int j = 0; j < 3; j++) o.kre[j][l] = o.kim[j][l] = 0.0;
  }
  for (size_t i = 0; i < r->n; i++) {
    const turned_piece *t = &r->pieces[i];
    if (t->p->kind == PIECE_BOX)
      box_lanes(t, b, gradient, plane, &o);
    else if (t->p->kind == PIECE_ELLIPSOID && !plane)
      ellipsoid_lanes(t, b, gradient, &o);
    else if (t->p->kind == PIECE_POLYGON)
      polygon_lanes(t, b, gradient, &o);
    else
      plain_lanes(job, t, &o);
  }
  if (!plane && job->gap->table) lookup_lanes(job, coefficients, gradient, &o);
  phase_lanes(&r->at, b, plane, c, s);
  if (r->real)
    add_block(coefficients, c, s, gradient, plane, true, &o, sum);
  else
    add_block(coefficients, c, s, gradient, plane, false, &o, sum);
}

static double add_up(const double x[LANES]) {
  return ((x[0] + x[1]) + (x[2] + x[3])) + ((x[4] + x[5]) + (x[6] + x[7]));
}

/* What the blocks from `at` on can still add, by Cauchy-Schwarz from their coefficients' energy and what is left of the
 * turned solid's. The last term covers the rounding of the difference. */
static double tail_after(const cprox_gap *gap, size_t at, double energy) {
  if (gap->tail[at] == 0.0) return 0.0;
  const double left = fmax(0.0, gap->half_energy - energy) + 1e-12 * gap->half_energy;
  return gap->tail[at] * sqrt(left) * gap->inverse;
}

INLINE void sum_all(gap_job *job, const ready *r, bool gradient, bool plane) {
  const cprox_gap *gap = job->gap;
  const double slack = gap->info.rounding + 1e-12;
  double v = gap->constant, energy = 0.0;
  vec3 x = vec(0, 0, 0), m = x;
  size_t i = 0;
  job->tail = 0.0;
  while (i < gap->n_blocks) {
    totals sum = {.v = {0}};
    const size_t end = i + CHUNK < gap->n_blocks ? i + CHUNK : gap->n_blocks;
    for (; i < end; i++) sum_block(job, r, &gap->blocks[i], gap->c + 2 * LANES * i, gradient, plane, &sum);
    v += 2.0 * add_up(sum.v);
    if (gradient) {
      x = vec_add(x, vec(add_up(sum.x[0]), add_up(sum.x[1]), add_up(sum.x[2])));
      m = vec_add(m, vec(add_up(sum.m[0]), add_up(sum.m[1]), add_up(sum.m[2])));
    }
    if (!job->early) continue;
    energy += add_up(sum.energy);
    job->tail = tail_after(gap, i, energy);
    const double value = v * gap->inverse;
    if (value + job->tail < 1.0 - slack || value - job->tail > 1.0 + slack) break;
  }
  job->blocks = i;
  job->value = v * gap->inverse;
  job->position = vec_scale(2.0 * gap->inverse, x);
  job->moment = vec_scale(2.0 * gap->inverse, m);
}

INLINE void sum_kinds(gap_job *job, const ready *r) {
  const bool plane = job->gap->info.dimension == 2;
  if (plane)
    job->gradient ? sum_all(job, r, true, true) : sum_all(job, r, false, true);
  else
    job->gradient ? sum_all(job, r, true, false) : sum_all(job, r, false, false);
}

/* How a turned piece stands in the fixed frame, and its phase tables. */
static void prepare_piece(const gap_job *job, const piece *p, turned_piece *t, double **tables) {
  const int dimension = job->gap->info.dimension;
  double own[9];
  rotation_compose(job->turn, p->turn, own);
  t->p = p;
  t->measure = piece_measure(p, dimension);
  t->centre = rotate(job->turn, p->centre);
  const bool symmetric = p->kind == PIECE_BOX || (p->kind == PIECE_ELLIPSOID && dimension == 3);
  t->centred = symmetric && vec_norm2(p->centre) == 0.0;
  for (int j = 0; j < 3; j++) t->axis[j] = vec(own[j], own[3 + j], own[6 + j]);
  if (p->kind == PIECE_BOX)
    for (int j = 0; j < 3; j++) t->phases[j] = make_phase(job, tables, vec_scale(p->size[j], t->axis[j]));
  if (symmetric) t->phases[3] = make_phase(job, tables, t->centre);
  for (size_t e = 0; p->kind == PIECE_POLYGON && e < p->n_corners; e++) {
    const vec3 a = rotate(job->turn, p->corner[e]), b = rotate(job->turn, p->corner[(e + 1) % p->n_corners]);
    t->ends[2 * e] = vec_scale(0.5, vec_add(a, b));
    t->ends[2 * e + 1] = vec_scale(0.5, vec_sub(b, a));
    for (size_t j = 2 * e; j < 2 * e + 2; j++) t->edges[j] = make_phase(job, tables, t->ends[j]);
  }
}

static size_t edges_of(const cprox_solid *turned) {
  size_t n = 0;
  for (size_t i = 0; turned && i < turned->n; i++)
    if (turned->pieces[i].kind == PIECE_POLYGON) n += turned->pieces[i].n_corners;
  return n;
}

size_t gap_scratch_size(const cprox_gap *gap) {
  const cprox_solid *turned = gap->turned;
  size_t phases = 1 + 2 * edges_of(turned);
  for (size_t i = 0; turned && i < turned->n; i++)
    phases += turned->pieces[i].kind == PIECE_BOX ? 4 : turned->pieces[i].kind == PIECE_ELLIPSOID ? 1 : 0;
  return phases * 6 * (size_t)(2 * gap->N + 2 * LANES) * sizeof(double) +
         (turned ? turned->n : 0) * sizeof(turned_piece) + 2 * edges_of(turned) * (sizeof(phase) + sizeof(vec3));
}

/* Carves the scratch memory: pieces, phases and vectors of edges, tables. */
static ready prepare(const gap_job *job) {
  const cprox_solid *turned = job->gap->turned;
  ready r = {.pieces = job->scratch, .n = turned ? turned->n : 0, .real = !job->gap->table};
  phase *edges = (phase *)(r.pieces + r.n);
  vec3 *ends = (vec3 *)(edges + 2 * edges_of(turned));
  double *tables = (double *)(ends + 2 * edges_of(turned));
  r.at = make_phase(job, &tables, job->x);
  for (size_t i = 0; i < r.n; i++) {
    const piece *p = &turned->pieces[i];
    r.pieces[i].edges = edges, r.pieces[i].ends = ends;
    prepare_piece(job, p, &r.pieces[i], &tables);
    r.real = r.real && r.pieces[i].centred;
    if (p->kind == PIECE_POLYGON) edges += 2 * p->n_corners, ends += 2 * p->n_corners;
  }
  return r;
}

#ifdef SIMD_HAS_LEVELS
SIMD_TARGET_AVX512 static void sum_512(gap_job *job, const ready *r) {
  sum_kinds(job, r);
}

SIMD_TARGET_AVX2 static void sum_256(gap_job *job, const ready *r) {
  sum_kinds(job, r);
}
#endif

static void sum_128(gap_job *job, const ready *r) {
  sum_kinds(job, r);
}

void gap_sum(gap_job *job) {
  const ready r = prepare(job);
  switch (job->gap->simd) {
#ifdef SIMD_HAS_LEVELS
    case SIMD_AVX512: sum_512(job, &r); break;
    case SIMD_AVX2: sum_256(job, &r); break;
#endif
    default: sum_128(job, &r);
  }
}
