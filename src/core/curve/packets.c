/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve/packets.h"

#include "base/rounding.h"
#include "base/workspace.h"
#include "simd/dispatch.h"

enum { SAMPLES = CHORDS + LANES };
/* Below this the square of a length may have lost its digits, and its reciprocal overflows. */
static const double LEAST_SQUARE = 1e-280;

SIMD_CLONES
void packet_ball_bounds(const packet_balls *balls, const curve_capsule *capsule, double radius, double *lower) {
  const double *restrict x = balls->x, *restrict y = balls->y, *restrict z = balls->z;
  const double *restrict reach = balls->reach, *restrict sizes = balls->sizes;
  double *restrict out = lower;
  const vec3 a = capsule->a, ab = vec_sub(capsule->b, a);
  /* a chord whose square would underflow is a point and a little more */
  const double length2 = vec_norm2(ab), per_length2 = length2 > LEAST_SQUARE ? 1.0 / length2 : 0.0;
  const double own = capsule->radius + radius + (length2 > LEAST_SQUARE ? 0.0 : 1e-140);
  const vec3 b = capsule->b; /* sums of coordinates are no less than lengths */
  const double own_sizes = fabs(a.x) + fabs(a.y) + fabs(a.z) + fabs(b.x) + fabs(b.y) + fabs(b.z) + own;
  for (size_t i = 0; i < balls->padded; i += CLUSTER) {
#pragma omp simd
    for (size_t l = 0; l < CLUSTER; l++) {
      /* the nearest point of the chord; any other would only lie farther away, by no more than the rounding of s */
      const size_t k = i + l;
      const double px = x[k] - a.x, py = y[k] - a.y, pz = z[k] - a.z;
      double s = (px * ab.x + py * ab.y + pz * ab.z) * per_length2;
      s = s < 0.0 ? 0.0 : s;
      s = s > 1.0 ? 1.0 : s;
      const double dx = px - s * ab.x, dy = py - s * ab.y, dz = pz - s * ab.z;
      const double distance = sqrt(dx * dx + dy * dy + dz * dz);
      out[k] = distance - (own + reach[k]) - ROUND_BALLS * ROUND_U * (own_sizes + sizes[k]);
    }
  }
}

/* At s = from + k step; both are multiples of 1/CHORDS^2, so that s and 1 - s are exact. */
static void fill_basis(size_t degree, double from, double step, double *basis) {
  for (size_t k = 0; k < CHORDS; k++) {
    const double s = from + (double)k * step, r = 1.0 - s;
    basis[k] = 1.0;
    for (size_t n = 1; n <= degree; n++) {
      /* B(n, j) = r B(n-1, j) + s B(n-1, j-1), from above so that one row is enough */
      basis[n * CHORDS + k] = s * basis[(n - 1) * CHORDS + k];
      for (size_t j = n - 1; j > 0; j--)
        basis[j * CHORDS + k] = r * basis[j * CHORDS + k] + s * basis[(j - 1) * CHORDS + k];
      basis[k] *= r;
    }
  }
}

/* The buffer begins with the degree that its table is of. */
static const double *basis_in(workspace_buffer which, size_t degree, cprox_workspace *workspace) {
  const bool fresh = !workspace_reserve(workspace, which, 0);
  double *buffer = workspace_reserve(workspace, which, (1 + CHORDS * (degree + 1)) * sizeof(double));
  if (!buffer) return NULL;
  if (fresh || buffer[0] != (double)degree) {
    fill_basis(degree, 0.0, 1.0 / CHORDS, buffer + 1);
    buffer[0] = (double)degree;
  }
  return buffer + 1;
}

const double *packet_basis(size_t degree, cprox_workspace *workspace) {
  return basis_in(WORKSPACE_BASIS, degree, workspace);
}

bool packet_bases(const size_t degree[2], cprox_workspace *workspace, const double *basis[2]) {
  basis[0] = basis_in(WORKSPACE_BASIS, degree[0], workspace);
  basis[1] = degree[1] == degree[0] ? basis[0] : basis_in(WORKSPACE_BASIS_OF_SECOND, degree[1], workspace);
  return basis[0] && basis[1];
}

/* This one begins with the degree and with which chords' tables are there, a bit each: most are never asked for. */
const double *packet_fine_basis(size_t degree, size_t chord, cprox_workspace *workspace) {
  enum { HEAD = 2 };
  const size_t each = CHORDS * (degree + 1);
  const bool fresh = !workspace_reserve(workspace, WORKSPACE_FINE_BASIS, 0);
  double *buffer = workspace_reserve(workspace, WORKSPACE_FINE_BASIS, (HEAD + CHORDS * each) * sizeof(double));
  if (!buffer) return NULL;
  if (fresh || buffer[0] != (double)degree) buffer[0] = (double)degree, buffer[1] = 0.0;
  const uint32_t there = (uint32_t)buffer[1], own = 1u << chord;
  double *basis = buffer + HEAD + chord * each;
  if (!(there & own)) {
    fill_basis(degree, (double)chord / CHORDS, 1.0 / (CHORDS * CHORDS), basis);
    buffer[1] = (double)(there | own);
  }
  return basis;
}

/* Of LANES squares the least; which one has it, the first of several, without branches: nobody can foretell it. */
static inline double least_of(const double square[LANES], uint32_t *which) {
  double best[LANES];
#pragma omp simd
  for (int k = 0; k < LANES; k++) best[k] = square[k];
  for (int half = LANES / 2; half > 0; half /= 2)
    for (int k = 0; k < half; k++) best[k] = best[k] < best[k + half] ? best[k] : best[k + half];
  uint32_t first = LANES - 1;
  for (uint32_t k = LANES - 1; k-- > 0;) first = square[k] == best[0] ? k : first;
  *which = first;
  return best[0];
}

SIMD_CLONES
double packet_points(const double *basis, const vec3 *points, size_t degree, bool flat, uint32_t first, vec3 from,
                     packet_chords *chords, uint32_t *nearest) {
  /* begun by their first terms: so many sums stay in registers */
  double x[LANES], y[LANES], z[LANES], square[LANES];
  const double *restrict b = basis + first;
#pragma omp simd
  for (int k = 0; k < LANES; k++) {
    x[k] = b[k] * points[0].x;
    y[k] = b[k] * points[0].y;
  }
  for (size_t j = 1; j <= degree; j++) {
    const double *restrict next = b + j * CHORDS;
    const vec3 p = points[j];
#pragma omp simd
    for (int k = 0; k < LANES; k++) {
      x[k] += next[k] * p.x;
      y[k] += next[k] * p.y;
    }
  }
#pragma omp simd
  for (int k = 0; k < LANES; k++) z[k] = flat ? points[0].z : b[k] * points[0].z;
  for (size_t j = 1; j <= degree && !flat; j++) {
    const double *restrict next = b + j * CHORDS;
    const double pz = points[j].z;
#pragma omp simd
    for (int k = 0; k < LANES; k++) z[k] += next[k] * pz;
  }
#pragma omp simd
  for (int k = 0; k < LANES; k++) {
    const double dx = from.x - x[k], dy = from.y - y[k], dz = from.z - z[k];
    square[k] = dx * dx + dy * dy + dz * dz;
  }
  for (size_t k = 0; k < LANES; k++) {
    chords->x[first + k] = x[k];
    chords->y[first + k] = y[k];
    chords->z[first + k] = z[k];
  }
  chords->x[CHORDS] = points[degree].x;
  chords->y[CHORDS] = points[degree].y;
  chords->z[CHORDS] = points[degree].z;
  return least_of(square, nearest);
}

SIMD_CLONES
void packet_join(packet_chords *chords) {
#pragma omp simd
  for (int k = 0; k < CHORDS; k++) {
    const double dx = chords->x[k + 1] - chords->x[k], dy = chords->y[k + 1] - chords->y[k];
    const double dz = chords->z[k + 1] - chords->z[k], length2 = dx * dx + dy * dy + dz * dz;
    chords->dx[k] = dx;
    chords->dy[k] = dy;
    chords->dz[k] = dz;
    chords->per_length2[k] = length2 > LEAST_SQUARE ? 1.0 / length2 : 0.0;
  }
}

SIMD_CLONES
double packet_nearest_point(const packet_chords *c, uint32_t first, vec3 from, uint32_t *nearest) {
  double square[LANES];
  const double *restrict x = c->x + first, *restrict y = c->y + first, *restrict z = c->z + first;
#pragma omp simd
  for (int k = 0; k < LANES; k++) {
    const double dx = from.x - x[k], dy = from.y - y[k], dz = from.z - z[k];
    square[k] = dx * dx + dy * dy + dz * dz;
  }
  return least_of(square, nearest);
}

/* The square distances from the origin of LANES points in one half of a piece: t = (first + k)/CHORDS from its
 * beginning (step 1) or its end (step -1). With the degree n and c_j = C(n, j) P_j, counted from there, a point is
 * (1 - t)^n sum c_j (t/(1 - t))^j, by Horner's rule: no table of weights is needed, and t/(1 - t) is at most 1. */
static inline void half_of_piece(const double *c[3], size_t degree, ptrdiff_t step, double first,
                                 double square[LANES]) {
  double ratio[LANES], power[LANES], base[LANES], x[LANES], y[LANES], z[LANES];
  const ptrdiff_t last = (ptrdiff_t)degree;
  const size_t end = step > 0 ? degree : 0;
#pragma omp simd
  for (int k = 0; k < LANES; k++) {
    const double t = (first + (double)k) / CHORDS;
    ratio[k] = t / (1.0 - t), base[k] = 1.0 - t, power[k] = 1.0;
    x[k] = c[0][end], y[k] = c[1][end], z[k] = c[2][end];
  }
  for (ptrdiff_t j = 1; j <= last; j++) {
    const ptrdiff_t at = (ptrdiff_t)end - j * step;
    const double px = c[0][at], py = c[1][at], pz = c[2][at];
#pragma omp simd
    for (int k = 0; k < LANES; k++) {
      x[k] = x[k] * ratio[k] + px;
      y[k] = y[k] * ratio[k] + py;
      z[k] = z[k] * ratio[k] + pz;
    }
  }
  for (size_t n = degree; n > 0; n /= 2) {
#pragma omp simd
    for (int k = 0; k < LANES; k++) {
      power[k] *= n % 2 ? base[k] : 1.0;
      base[k] *= base[k];
    }
  }
#pragma omp simd
  for (int k = 0; k < LANES; k++) {
    x[k] *= power[k], y[k] *= power[k], z[k] *= power[k];
    square[k] = x[k] * x[k] + y[k] * y[k] + z[k] * z[k];
  }
}

SIMD_CLONES
double packet_nearest_sample(const double *binomial, const double *x, const double *y, const double *z, size_t degree) {
  double own[CPROX_MAX_DEGREE + 1], cx[CPROX_MAX_DEGREE + 1], cy[CPROX_MAX_DEGREE + 1], cz[CPROX_MAX_DEGREE + 1];
  double square[CHORDS + 1], upper[LANES];
  curve_own_binomials(binomial, degree, own);
  for (size_t j = 0; j <= degree; j++) cx[j] = own[j] * x[j], cy[j] = own[j] * y[j], cz[j] = own[j] * z[j];
  const double *c[3] = {cx, cy, cz};
  /* s = k/16 from the beginning; from the end, 1 - s = (k + 1)/16 */
  half_of_piece(c, degree, 1, 0.0, square);
  half_of_piece(c, degree, -1, 1.0, upper);
  for (int k = 0; k < LANES; k++) square[LANES + k] = upper[LANES - 1 - k];
  square[CHORDS] = x[degree] * x[degree] + y[degree] * y[degree] + z[degree] * z[degree];
  uint32_t low, high;
  const double left_half = least_of(square, &low), right_half = least_of(square + LANES, &high);
  uint32_t nearest = right_half < left_half ? LANES + high : low;
  if (square[CHORDS] < lesser(left_half, right_half)) nearest = CHORDS;
  if (nearest == 0 || nearest == CHORDS) return (double)nearest / CHORDS;

  /* the lowest point of the parabola through three of them */
  const double left = square[nearest - 1] - square[nearest], right = square[nearest + 1] - square[nearest];
  const double shift = left + right > 0.0 ? 0.5 * (left - right) / (left + right) : 0.0;
  return ((double)nearest + shift) / CHORDS;
}

/* CHORDS + 1 points of a piece, and copies of the last to fill LANES. */
static inline void sample(const double *basis, const double *points, size_t degree, double at[3][SAMPLES]) {
  for (size_t first = 0; first < CHORDS; first += LANES) {
    double sum[3][LANES] = {{0}};
    for (size_t j = 0; j <= degree; j++) {
      const double *restrict b = basis + j * CHORDS + first;
      const double px = points[j], py = points[degree + 1 + j], pz = points[2 * (degree + 1) + j];
#pragma omp simd
      for (int k = 0; k < LANES; k++) {
        sum[0][k] += b[k] * px;
        sum[1][k] += b[k] * py;
        sum[2][k] += b[k] * pz;
      }
    }
    for (int c = 0; c < 3; c++)
      for (size_t k = 0; k < LANES; k++) at[c][first + k] = sum[c][k];
  }
  for (size_t c = 0; c < 3; c++)
    for (size_t k = CHORDS; k < SAMPLES; k++) at[c][k] = points[c * (degree + 1) + degree];
}

SIMD_CLONES
void packet_first_pair(const packet_piece *first, const packet_piece *second, double s[2]) {
  double p[3][SAMPLES], q[3][SAMPLES], least[LANES], which[LANES];
  sample(first->basis, first->points, first->degree, p);
  sample(second->basis, second->points, second->degree, q);
  for (int k = 0; k < LANES; k++) least[k] = INFINITY, which[k] = 0.0;
  for (size_t i = 0; i <= CHORDS; i++) {
    const double x = p[0][i], y = p[1][i], z = p[2][i];
    for (size_t j = 0; j < SAMPLES; j += LANES) {
      const double number = (double)(i * SAMPLES + j);
      const double *restrict qx = q[0] + j, *restrict qy = q[1] + j, *restrict qz = q[2] + j;
#pragma omp simd
      for (int k = 0; k < LANES; k++) {
        const double dx = x - qx[k], dy = y - qy[k], dz = z - qz[k], square = dx * dx + dy * dy + dz * dz;
        which[k] = square < least[k] ? number : which[k];
        least[k] = square < least[k] ? square : least[k];
      }
    }
  }
  int nearest = 0;
  for (int k = 1; k < LANES; k++)
    if (least[k] < least[nearest]) nearest = k;
  const size_t number = (size_t)which[nearest] + (size_t)nearest, i = number / SAMPLES, j = number % SAMPLES;
  s[0] = (double)i / CHORDS;
  s[1] = j < CHORDS ? (double)j / CHORDS : 1.0;
}

SIMD_CLONES
double packet_closest(const packet_chords *c, vec3 point, size_t *chord, double *along) {
  double square[CHORDS], at[CHORDS];
#pragma omp simd
  for (int k = 0; k < CHORDS; k++) {
    const double px = point.x - c->x[k], py = point.y - c->y[k], pz = point.z - c->z[k];
    double s = (px * c->dx[k] + py * c->dy[k] + pz * c->dz[k]) * c->per_length2[k];
    s = s < 0.0 ? 0.0 : s;
    s = s > 1.0 ? 1.0 : s;
    const double dx = px - s * c->dx[k], dy = py - s * c->dy[k], dz = pz - s * c->dz[k];
    at[k] = s;
    square[k] = dx * dx + dy * dy + dz * dz;
  }
  double least[LANES];
#pragma omp simd
  for (int k = 0; k < LANES; k++) least[k] = square[k] < square[k + LANES] ? square[k] : square[k + LANES];
  for (int half = LANES / 2; half > 0; half /= 2)
    for (int k = 0; k < half; k++) least[k] = least[k] < least[k + half] ? least[k] : least[k + half];
  size_t first = 0;
  while (first + 1 < CHORDS && square[first] != least[0]) first++;
  *chord = first;
  *along = at[first];
  return least[0];
}

double packet_bend2(const vec3 *p, size_t degree) {
  double most = 0.0;
  for (size_t i = 0; i + 2 <= degree; i++) {
    const double x = p[i].x - 2.0 * p[i + 1].x + p[i + 2].x, y = p[i].y - 2.0 * p[i + 1].y + p[i + 2].y;
    const double z = p[i].z - 2.0 * p[i + 1].z + p[i + 2].z;
    const double square = x * x + y * y + z * z;
    most = square > most ? square : most;
  }
  return most;
}
