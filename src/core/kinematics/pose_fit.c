/* SPDX-License-Identifier: BSD-3-Clause */
/* The letters are those of doc/robot-poses.md, Control poses. */
#include "kinematics/pose_fit.h"

#include <math.h>

#include "base/rounding.h"
#include "simd/dispatch.h"

/* ---- chains ---- */

static const placement STRAIGHT = {.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}};

static bool is_straight(const placement *at) {
  for (int i = 0; i < 9; i++)
    if (at->r[i] != STRAIGHT.r[i]) return false;
  return true;
}

bool pose_chain_of(const cprox_motion *m, size_t part, pose_chain *chain) {
  enum { MOST_AXES = 32 };
  const robot_axis *axes = m->robot->axes;
  const robot_part *p = &m->robot->parts[part];
  int32_t up[MOST_AXES], n = 0, screw = -1;
  for (int32_t i = p->axis; i >= 0; i = axes[i].parent) {
    if (n == MOST_AXES) return false;
    up[n++] = i;
  }
  *chain = (pose_chain){.motion = m, .turn = -1, .track = -1};
  placement at = STRAIGHT;
  while (n > 0) {
    const int32_t i = up[--n];
    const robot_axis *axis = &axes[i];
    if (!m->axis_moves[i]) {
      at = placement_compose(&at, &m->still[i]);
      continue;
    }
    const int32_t track = m->track_of[axis->variable];
    if (chain->turn >= 0 || (chain->track >= 0 && chain->track != track)) return false;
    chain->track = track;
    at = placement_compose(&at, &axis->at);
    if (axis->kind == AXIS_PRISMATIC && m->arc_of && m->arc_of[i] >= 0) {
      screw = m->arc_of[i]; /* the ball has its place */
      continue;
    }
    if (axis->kind == AXIS_PRISMATIC) {
      if (chain->n_shifts == sizeof chain->shift / sizeof *chain->shift) return false;
      chain->along[chain->n_shifts] = placement_turn(&at, axis->z);
      chain->shift[chain->n_shifts++] = i;
      continue;
    }
    chain->turn = i, chain->base = at;
    at = STRAIGHT;
  }
  at = placement_compose(&at, &p->at);
  if (chain->turn < 0)
    chain->base = at;
  else
    chain->tip = at, chain->arm = vec_norm(at.p);
  chain->base_is_straight = is_straight(&chain->base), chain->tip_is_straight = is_straight(&chain->tip);
  return chain->track >= 0 && (screw < 0 || (chain->turn >= 0 && m->arc_of[chain->turn] == screw));
}

/* ---- poses ---- */

static void turn_by_quaternion(const double q[4], double r[9]) {
  const double x = q[0], y = q[1], z = q[2], w = q[3], s = 2.0 / (x * x + y * y + z * z + w * w);
  const double xx = s * x * x, yy = s * y * y, zz = s * z * z, xy = s * x * y, xz = s * x * z, yz = s * y * z,
               wx = s * w * x, wy = s * w * y, wz = s * w * z;
  const double turned[9] = {1.0 - (yy + zz), xy - wz, xz + wy, xy + wz,        1.0 - (xx + zz),
                            yz - wx,         xz - wy, yz + wx, 1.0 - (xx + yy)};
  for (int i = 0; i < 9; i++) r[i] = turned[i];
}

static void turn_at(const pose_chain *chain, size_t own, double u, double r[9], vec3 *shift) {
  const cprox_motion *m = chain->motion;
  const robot_axis *axis = &m->robot->axes[chain->turn];
  double values[4] = {0};
  if (m->arc_of && m->arc_of[chain->turn] >= 0) {
    const motion_arc *arc = motion_arc_at(m, (size_t)chain->turn, own);
    const double s = arc->from + (arc->to - arc->from) * u;
    arc_orientation(arc, s, values);
    turn_by_quaternion(values, r);
    if (!arc->screw) return;
    vec3 p[3];
    arc_position(arc, s, p);
    *shift = p[0];
    return;
  }
  for (int32_t k = 0; k < axis_variables(axis->kind); k++) values[k] = motion_value(m, axis->variable + k, own, u);
  if (axis->kind == AXIS_REVOLUTE) {
    placement moved;
    robot_axis_advance(axis, &STRAIGHT, axis->multiplier * values[0] + axis->offset, &moved);
    for (int i = 0; i < 9; i++) r[i] = moved.r[i];
  } else if (axis->kind == AXIS_VECTOR) {
    double quaternion[4];
    rotation_vector_quaternion(values, quaternion);
    turn_by_quaternion(quaternion, r);
  } else {
    turn_by_quaternion(values, r);
  }
}

/* At u of the segment `own` of the part's track. */
static placement pose_at(const pose_chain *chain, size_t own, double u) {
  const cprox_motion *m = chain->motion;
  placement at = chain->base;
  for (size_t k = 0; k < chain->n_shifts; k++) {
    const robot_axis *axis = &m->robot->axes[chain->shift[k]];
    const double value = motion_value(m, axis->variable, own, u);
    at.p = vec_axpy(at.p, axis->multiplier * value + axis->offset, chain->along[k]);
  }
  if (chain->turn < 0) return at;
  double r[9], turned[9];
  vec3 shift = vec(0, 0, 0);
  turn_at(chain, own, u, r, &shift);
  if (!vec_equal(shift, vec(0, 0, 0))) at.p = vec_add(at.p, placement_turn(&chain->base, shift));
  if (!chain->base_is_straight) {
    rotation_compose(chain->base.r, r, turned);
    for (int i = 0; i < 9; i++) r[i] = turned[i];
  }
  if (chain->arm > 0.0) at.p = vec_add(at.p, rotate(r, chain->tip.p));
  if (chain->tip_is_straight)
    for (int i = 0; i < 9; i++) at.r[i] = r[i];
  else
    rotation_compose(r, chain->tip.r, at.r);
  return at;
}

placement pose_chain_at(const pose_chain *chain, size_t segment, double u) {
  const motion_track *t = &chain->motion->tracks[chain->track];
  const size_t own = motion_track_place(chain->motion, t, segment, &u);
  return pose_at(chain, own, u);
}

/* ---- the remainder ---- */

/* Bounds on the derivatives of what turns by x in [-1, 1], the first `n` of them; all others are 0. */
typedef struct turn_rates {
  double w[MOTION_MAX_DEGREE + 1]; /* w[k]: of the k-th; w[0] is not used */
  size_t n;
  bool quaternion; /* they are those of a quaternion of norm 1 and more */
  double shift[2]; /* of a screw's place: its speed, straight and round */
} turn_rates;

/* sum of w_k z^k / k! */
static double grown(const turn_rates *rates, double z) {
  double sum = 0.0;
  for (size_t k = rates->n; k > 0; k--) sum = (sum + rates->w[k]) * z / (double)k;
  return sum;
}

static turn_rates rates_of(const pose_chain *chain, const motion_interval *own) {
  const cprox_motion *m = chain->motion;
  turn_rates rates = {0};
  if (chain->turn < 0) return rates;
  const robot_axis *axis = &m->robot->axes[chain->turn];
  if (m->arc_of && m->arc_of[chain->turn] >= 0) {
    const motion_arc *arc = motion_arc_at(m, (size_t)chain->turn, own->first);
    const double half = 0.5 * (arc->to - arc->from) * (own->b - own->a);
    rates.n = 1, rates.w[1] = ROUND_UP * half * arc->angle;
    if (arc->screw) {
      rates.shift[0] = ROUND_UP * half * arc_speed(arc, &rates.shift[1]);
      rates.shift[1] *= ROUND_UP * half;
    }
    return rates;
  }
  rates.quaternion = axis->kind == AXIS_BALL;
  rates.n = motion_derivative_bounds(m, chain->turn, own, rates.w);
  const double unit = rates.quaternion              ? 1.0 / m->norm[chain->turn]
                      : axis->kind == AXIS_REVOLUTE ? fabs(axis->multiplier)
                                                    : 1.0;
  double half = unit;
  for (size_t k = 1; k <= rates.n; k++) half *= 0.5, rates.w[k] *= ROUND_UP * half;
  return rates;
}

/* What the turn, and a screw's place, are at most in the ellipse about [-1, 1] whose half axes are `across` and
 * `along`; infinity where that is not known. */
static double largest_turn(const turn_rates *rates, double across, double along) {
  const double beside = grown(rates, across);
  if (!rates->quaternion) return exp(beside) * lesser(1.0, grown(rates, along));
  const double least = 1.0 - beside * (2.0 + beside);
  return least > 0.0 ? (1.0 + beside) * (1.0 + beside) / least : INFINITY;
}

static double largest_place(const turn_rates *rates, double across, double along) {
  return along * (rates->shift[0] + rates->shift[1] * exp(grown(rates, across)));
}

enum { ELLIPSES = 9 };

/* The remainders of both by degree 4, 6, 8 …; what they are at most in an ellipse of the parameter rho shrinks by rho a
 * degree. */
static void remainders(const pose_chain *chain, const motion_interval *own, double turn[], double place[]) {
  const turn_rates rates = rates_of(chain, own);
  for (int d = 0; d < POSE_FIT_DEGREES; d++) turn[d] = place[d] = rates.n > 0 ? INFINITY : 0.0;
  if (rates.n == 0) return;
  double rho = 2.0;
  for (int k = 0; k < ELLIPSES; k++, rho *= 1.6) {
    const double across = 0.5 * (rho - 1.0 / rho), along = 0.5 * (rho + 1.0 / rho), square = 1.0 / (rho * rho);
    double of_turn = 4.0 / (rho - 1.0) * square * square, of_place = of_turn;
    of_turn *= largest_turn(&rates, across, along);
    of_place *= rates.shift[0] > 0.0 ? largest_place(&rates, across, along) : 0.0;
    for (int d = 0; d < POSE_FIT_DEGREES; d++, of_turn *= square, of_place *= square)
      turn[d] = lesser(ROUND_UP * of_turn, turn[d]), place[d] = lesser(ROUND_UP * of_place, place[d]);
  }
}

static motion_interval own_interval(const pose_chain *chain, size_t segment, double a, double b) {
  const motion_interval over = {.a = a, .b = b, .first = segment, .last = segment + 1};
  return motion_track_interval(chain->motion, &chain->motion->tracks[chain->track], &over);
}

size_t pose_remainder_find(const pose_chain *chain, size_t segment, double a, double b, double size, double tolerance,
                           pose_remainder *of) {
  of->own = own_interval(chain, segment, a, b);
  remainders(chain, &of->own, of->turn, of->place);
  size_t degree = POSE_FIT_LEAST;
  const size_t least = chain->n_shifts > 0 ? chain->motion->tracks[chain->track].degree[of->own.first] : 0;
  for (int d = 0; degree <= POSE_FIT_MOST; d++, degree += 2)
    if (degree >= least && of->turn[d] * (size + chain->arm) + of->place[d] <= tolerance) return degree;
  return 0;
}

void pose_fit_make(const pose_chain *chain, const pose_remainder *of, const pose_basis *basis, pose_fit *fit) {
  const size_t d = (basis->degree - POSE_FIT_LEAST) / 2;
  fit->degree = basis->degree;
  fit->turn_error = of->turn[d], fit->place_error = of->place[d] + of->turn[d] * chain->arm;
  for (size_t i = 0; i <= basis->degree; i++)
    fit->at[i] = pose_at(chain, of->own.first, of->own.a + (of->own.b - of->own.a) * basis->x[i]);
}

/* ---- Bernstein form ---- */

static double choose(size_t n, size_t k) {
  double c = 1.0;
  for (size_t i = 0; i < k; i++) c = c * (double)(n - i) / (double)(i + 1);
  return c;
}

/* Coefficient j, of degree n, of the Chebyshev polynomial T_k on [0, 1]. Of degree k it is (-1)^(k-m) C(2k, 2m) / C(k,
 * m). */
static double chebyshev_coefficient(size_t k, size_t n, size_t j) {
  double sum = 0.0;
  for (size_t m = j + k > n ? j + k - n : 0; m <= k && m <= j; m++)
    sum += ((k - m) & 1 ? -1.0 : 1.0) * choose(2 * k, 2 * m) * choose(n - k, j - m);
  return sum / choose(n, j);
}

/* The polynomial through values v_i at the points is the sum of b_k T_k, b_k = 2/n sum of v_i T_k(x_i), both ends of i
 * and of k by half. */
static void fill_basis(size_t n, pose_basis *basis) {
  const double pi = 3.14159265358979323846;
  double size = 0.0;
  *basis = (pose_basis){.degree = n};
  for (size_t i = 0; i <= n; i++) {
    const double half = sin(0.5 * pi * (double)i / (double)n);
    basis->x[i] = i == n ? 1.0 : half * half;
  }
  for (size_t j = 0; j <= n; j++) {
    double row = 0.0, terms = 0.0;
    for (size_t k = 0; k <= n; k++) {
      const double c = chebyshev_coefficient(k, n, j) * (k == 0 || k == n ? 1.0 : 2.0) / (double)n;
      terms += fabs(c);
      for (size_t i = 0; i <= n; i++)
        basis->values[i][j] += c * (i == 0 || i == n ? 0.5 : 1.0) * (k & 1 ? -1.0 : 1.0) *
                               cos(pi * fmod((double)(k * i), 2.0 * (double)n) / (double)n);
    }
    for (size_t i = 0; i <= n; i++) row += fabs(basis->values[i][j]);
    basis->growth = greater(row, basis->growth);
    size = greater(terms, size);
  }
  /* each entry is off by 2n + 16 units of the sum of its terms' sizes, and n + 1 products are added */
  basis->error = ROUND_UP * ROUND_U * ((double)((n + 1) * (2 * n + 16)) * size + (double)(n + 2) * basis->growth);
}

const pose_basis *pose_basis_of(size_t degree, cprox_workspace *workspace) {
  const bool fresh = !workspace_reserve(workspace, WORKSPACE_POSE_BASIS, 0);
  pose_basis *all = workspace_reserve(workspace, WORKSPACE_POSE_BASIS, POSE_FIT_DEGREES * sizeof *all);
  if (!all) return NULL;
  for (int k = 0; fresh && k < POSE_FIT_DEGREES; k++) all[k].degree = 0;
  pose_basis *basis = &all[(degree - POSE_FIT_LEAST) / 2];
  if (basis->degree == 0) fill_basis(degree, basis);
  return basis;
}

SIMD_CLONES
static void convert(const pose_basis *basis, const double values[][4], double rows[][4]) {
  const size_t n = basis->degree;
  for (size_t j = 0; j <= n; j++) {
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    for (size_t i = 0; i <= n; i++)
#pragma omp simd
      for (int l = 0; l < 4; l++) sum[l] += basis->values[i][j] * values[i][l];
    for (int l = 0; l < 4; l++) rows[j][l] = sum[l];
  }
}

void pose_fit_along(const pose_fit *fit, const pose_basis *basis, vec3 n, vec3 origin, pose_rows *rows) {
  double values[POSE_FIT_POINTS][4];
  rows->degree = fit->degree, rows->height = 0.0;
  for (size_t i = 0; i <= fit->degree; i++) {
    const vec3 turned = placement_turn_back(&fit->at[i], n);
    values[i][0] = turned.x, values[i][1] = turned.y, values[i][2] = turned.z;
    values[i][3] = vec_dot(n, vec_sub(fit->at[i].p, origin));
    rows->height = greater(fabs(values[i][3]), rows->height);
  }
  convert(basis, (const double(*)[4])values, rows->c);
}

SIMD_CLONES
static void cut(double c[][4], size_t degree, double from, double to) {
  if (from > 0.0)
    for (size_t r = 1; r <= degree; r++)
      for (size_t i = 0; i + r <= degree; i++)
#pragma omp simd
        for (int l = 0; l < 4; l++) c[i][l] = (1.0 - from) * c[i][l] + from * c[i + 1][l];
  if (to >= 1.0) return;
  const double s = (to - from) / (1.0 - from);
  for (size_t r = 1; r <= degree; r++)
    for (size_t i = degree; i >= r; i--)
#pragma omp simd
      for (int l = 0; l < 4; l++) c[i][l] = s * c[i][l] + (1.0 - s) * c[i - 1][l];
}

void pose_rows_cut(pose_rows *rows, double from, double to) {
  cut(rows->c, rows->degree, from, to);
}

/* (n + 1) times coefficient j of a polynomial times the linear function from p to q is (n + 1 - j) p c_j + j q c_(j-1).
 */
void pose_rows_add_turning(pose_rows *rows, const pose_rows *rates, double from, double to) {
  const size_t n = rows->degree;
  const double part = 1.0 / (double)(n + 1);
  for (int l = 0; l < 4; l++) rows->c[n + 1][l] = 0.0;
  for (size_t j = n + 1; j <= n + 1; j--) {
    const double own = (double)(n + 1 - j) * part, before = (double)j * part;
    for (int l = 0; l < 4; l++) {
      double sum = j <= n ? own * (rows->c[j][l] + from * rates->c[j][l]) : 0.0;
      if (j > 0) sum += before * (rows->c[j - 1][l] + to * rates->c[j - 1][l]);
      rows->c[j][l] = sum;
    }
  }
  rows->degree = n + 1;
}
