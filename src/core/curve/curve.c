/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve/curve.h"

#include <stdlib.h>
#include <string.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "curve/rectifiable.h"

/* Some half a millisecond of pieces. */
enum { STOP_INTERVAL = 1024 };

/* [bytes] From here on calloc() makes the zeros: more than glibc's cache of the thread holds. */
enum { LARGE_BLOCK = 1 << 17 };

/* Zeros. calloc() does not take from that cache, which free() fills; but the pages of a large block it leaves untouched
 * until they are written, which is between questions whether to stop. */
static char *allocate_zeros(size_t bytes) {
  if (bytes >= LARGE_BLOCK) return calloc(bytes, 1);
  char *memory = malloc(bytes);
  if (memory) memset(memory, 0, bytes);
  return memory;
}

static size_t leaves_for(size_t n_pieces) {
  size_t n_leaves = 1;
  while (n_leaves < n_pieces) n_leaves *= 2;
  return n_leaves;
}

static size_t own_tables_size(size_t degree) {
  return degree > CURVE_LOW_DEGREE ? curve_tables_size(degree) : 0;
}

size_t curve_arrays_size(size_t degree, size_t n_pieces) {
  const size_t numbers = 3 * n_pieces * (degree + 1) + (n_pieces + 1) + n_pieces + own_tables_size(degree);
  return numbers * sizeof(double) + curve_radii_size(leaves_for(n_pieces)) * sizeof(float);
}

void curve_lay_out(cprox_curve *c, size_t degree, size_t n_pieces, void *memory) {
  c->degree = (uint32_t)degree;
  c->n_pieces = (uint32_t)n_pieces;
  c->n_leaves = (uint32_t)leaves_for(n_pieces);
  c->points = memory;
  c->breaks = (double *)(void *)(c->points + n_pieces * (degree + 1));
  c->error = c->breaks + n_pieces + 1;
}

/* One block: short curves are made and freed by the thousand. All is aligned as doubles are. */
cprox_curve *curve_allocate_with(size_t degree, size_t n_pieces, size_t room) {
  if (n_pieces > INT32_MAX / 2 || n_pieces > SIZE_MAX / 1024 / (degree + 1)) return NULL; /* sums would overflow */
  char *memory = allocate_zeros(sizeof(cprox_curve) + curve_arrays_size(degree, n_pieces) + room);
  if (!memory) return NULL;
  cprox_curve *c = (cprox_curve *)(void *)memory;
  curve_lay_out(c, degree, n_pieces, c + 1);
  return c;
}

cprox_curve *curve_allocate(size_t degree, size_t n_pieces) {
  return curve_allocate_with(degree, n_pieces, 0);
}

void *curve_room(const cprox_curve *c) {
  return (char *)c->points + curve_arrays_size(c->degree, c->n_pieces);
}

void cprox_curve_free(cprox_curve *curve) {
  if (!curve) return;
  free(curve->arcs);
  free(curve);
}

/* ---- checks ---- */

/* Finite, and small enough that squares do not overflow. */
static cprox_status check_finite(const char *name, const vec3 *values, size_t n, cprox_workspace *workspace) {
  for (size_t i = 0; i < n; i++) {
    const vec3 p = values[i];
    if (!vec_finite(p))
      return workspace_fail(workspace, CPROX_INVALID, "%s %zu is (%g, %g, %g), not finite", name, i, p.x, p.y, p.z);
    if (fabs(p.x) > CURVE_LARGEST || fabs(p.y) > CURVE_LARGEST || fabs(p.z) > CURVE_LARGEST)
      return workspace_fail(workspace, CPROX_INVALID, "%s %zu is (%g, %g, %g), beyond %g m", name, i, p.x, p.y, p.z,
                            CURVE_LARGEST);
  }
  return CPROX_OK;
}

cprox_status curve_check_points(const vec3 *points, size_t n, cprox_workspace *workspace) {
  if (n < 2) return workspace_fail(workspace, CPROX_INVALID, "a curve needs at least 2 control points, got %zu", n);
  if (!points) return workspace_fail(workspace, CPROX_INVALID, "the control points are NULL");
  return check_finite("control point", points, n, workspace);
}

cprox_status curve_check_values(const char *name, const vec3 *values, size_t n, size_t most,
                                cprox_workspace *workspace) {
  if (n < 1) return workspace_fail(workspace, CPROX_INVALID, "there is no %s; a curve needs at least 1", name);
  if (n > most) return workspace_fail(workspace, CPROX_INVALID, "there are %zu %ss, above %zu", n, name, most);
  if (!values) return workspace_fail(workspace, CPROX_INVALID, "the %ss are NULL", name);
  return check_finite(name, values, n, workspace);
}

cprox_status curve_check_range(double t0, double t1, cprox_workspace *workspace) {
  if (!(fabs(t0) <= CURVE_LARGEST && fabs(t1) <= CURVE_LARGEST))
    return workspace_fail(workspace, CPROX_INVALID, "the parameter range [%g, %g] is not finite or beyond %g", t0, t1,
                          CURVE_LARGEST);
  if (!(t0 < t1)) return workspace_fail(workspace, CPROX_INVALID, "t0 = %.17g is not below t1 = %.17g", t0, t1);
  return CPROX_OK;
}

cprox_status curve_check_sum(const vec3 *coefficients, size_t n, double t0, double t1, cprox_workspace *workspace) {
  const cprox_status status = curve_check_values("coefficient", coefficients, n, CPROX_MAX_DEGREE + 1, workspace);
  return status == CPROX_OK ? curve_check_range(t0, t1, workspace) : status;
}

/* ---- chord capsules ---- */

/* At least the distance from p to the segment from a to b. For any s in [0,1] the vector v = (p - a) - s (b - a) is no
 * shorter than it; the computed v is off by at most u(2|p-a| + 3|b-a|), its computed length by a relative 3u. Only
 * differences enter, so that a common offset costs nothing. */
static double distance_bound(vec3 p, vec3 a, vec3 b) {
  const vec3 w = vec_sub(p, a), d = vec_sub(b, a);
  const double along = vec_dot(w, d), length2 = vec_norm2(d);
  const double s = along <= 0.0 ? 0.0 : along >= length2 ? 1.0 : along / length2;
  const double distance = vec_norm(vec_axpy(w, -s, d));
  return ROUND_UP * (distance + 8.0 * ROUND_U * (vec_norm(w) + sqrt(length2))) + CURVE_LEAST;
}

/* Around one piece: its hull is that of its control points, and the exact curve is within the piece's error of it. */
static double piece_radius(const cprox_curve *c, size_t i) {
  const vec3 *p = curve_piece(c, i);
  double radius = 0.0;
  for (size_t k = 1; k < c->degree; k++) radius = greater(distance_bound(p[k], p[0], p[c->degree]), radius);
  return ROUND_UP * (radius + c->error[i]);
}

/* Rounded up to a float of the unit; one that is too large for that bounds nothing. */
static void set_radius(cprox_curve *c, size_t node, double radius) {
  if (node == 1) c->radius = radius;
  if (c->n_leaves == 1) return;
  float *kept = curve_radii(c) + node;
  *kept = (float)(radius / curve_unit(c));
  while (curve_unit(c) * (double)*kept < radius) *kept = nextafterf(*kept, INFINITY);
}

/* Round the nodes so many levels below: the distance to a segment is convex, so along a segment it is largest at an
 * end. */
static double join_capsules(const cprox_curve *c, size_t node, size_t levels) {
  const curve_ends whole = curve_ends_at(c, node);
  double joined = 0.0;
  for (size_t k = node << levels; k < (node + 1) << levels && !curve_is_empty_at(c, k); k++) {
    const curve_ends part = curve_ends_at(c, k);
    const double at_a = k > node << levels ? distance_bound(*part.a, *whole.a, *whole.b) : 0.0;
    const double at_b = part.b != whole.b ? distance_bound(*part.b, *whole.a, *whole.b) : 0.0;
    joined = greater(ROUND_UP * (curve_radius_at(c, k) + greater(at_a, at_b)), joined);
  }
  return joined;
}

/* From three levels below where there are so many: a radius that is made of fewer others is smaller. */
static bool build_tree(cprox_curve *c, cprox_workspace *workspace) {
  for (size_t i = 0; i < c->n_pieces; i++) {
    if (curve_stops(i, workspace)) return false;
    set_radius(c, c->n_leaves + i, piece_radius(c, i));
  }
  for (size_t k = c->n_leaves; k-- > 1;) {
    if (curve_stops(k, workspace)) return false;
    size_t levels = 1;
    while (levels < 3 && k << levels < c->n_leaves) levels++;
    if (!curve_is_empty_at(c, k)) set_radius(c, k, join_capsules(c, k, levels));
  }
  return true;
}

/* |x| + |y| + |z| is no less than |P|. */
static void measure_points(cprox_curve *c) {
  c->largest = 0.0;
  c->flat = true;
  for (size_t i = 0; i < c->n_pieces * (c->degree + 1); i++) {
    const vec3 p = c->points[i];
    c->largest = fmax(c->largest, ROUND_UP * (fabs(p.x) + fabs(p.y) + fabs(p.z)));
    c->flat = c->flat && p.z == c->points[0].z;
  }
}

static bool is_in_reach(const cprox_curve *c) {
  const curve_capsule all = curve_whole(c);
  const vec3 a = all.a, b = all.b;
  const double ends = fmax(fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z))), fmax(fabs(b.x), fmax(fabs(b.y), fabs(b.z))));
  return fmax(ends, all.radius) <= LENGTH_MOST;
}

static bool build(cprox_curve *c, cprox_workspace *workspace) {
  measure_points(c);
  if (c->degree > CURVE_LOW_DEGREE) curve_fill_tables(c->degree, (double *)curve_own_tables(c));
  const bool built = build_tree(c, workspace);
  c->in_reach = is_in_reach(c);
  return built;
}

void curve_build(cprox_curve *c) {
  build(c, NULL);
}

cprox_status curve_finish(cprox_curve *c, cprox_workspace *workspace, cprox_curve **curve) {
  if (!build(c, workspace)) return curve_stopped(c, workspace);
  *curve = c;
  return CPROX_OK;
}

double curve_error(const cprox_curve *c) {
  if (c->arcs) return c->arcs->error;
  double worst = 0.0;
  for (size_t i = 0; i < c->n_pieces; i++) worst = greater(c->error[i], worst);
  return worst;
}

bool curve_stops(size_t n_pieces, cprox_workspace *workspace) {
  return n_pieces % STOP_INTERVAL == STOP_INTERVAL - 1 && workspace_stops(workspace);
}

cprox_status curve_stopped(cprox_curve *c, cprox_workspace *workspace) {
  const size_t n = c->n_pieces;
  cprox_curve_free(c);
  return workspace_fail(workspace, CPROX_INVALID, "stopped while a curve of %zu pieces was being made", n);
}

/* ---- arithmetic ---- */

/* The weights of x between u[i] and u[j], each with three roundings: 1 - s would lose its accuracy near s = 1. */
typedef struct weights {
  double of_left, of_right;
} weights;

static weights weights_between(double left, double x, double right) {
  const double length = right - left;
  return (weights){(right - x) / length, (x - left) / length};
}

static vec3 combine(weights w, vec3 a, vec3 b) {
  return vec(w.of_left * a.x + w.of_right * b.x, w.of_left * a.y + w.of_right * b.y,
             w.of_left * a.z + w.of_right * b.z);
}

/* After l of the p arguments are given, point i depends on the knots u[i+l] … u[i+p-1]; giving the next argument x
 * combines the points i and i+1 of level l-1 with the weights of x between u[i+l-1] and u[i+p].
 *
 * Error: a weight has 3 roundings (difference, difference, quotient), product and sum one each: 5 a level, and the
 * combinations are convex, so after p levels |error| <= ((1+u)^(5p) - 1) max|d|, in every direction at once. */
void curve_blossom(const vec3 *d, const double *u, size_t p, double lo, double hi, vec3 *b) {
  vec3 row[CPROX_MAX_DEGREE + 1], high[CPROX_MAX_DEGREE + 1];
  weights towards_hi[CPROX_MAX_DEGREE * (CPROX_MAX_DEGREE + 1) / 2];

  /* the weights of hi, level by level */
  size_t n = 0;
  for (size_t l = 1; l <= p; l++)
    for (size_t i = 0; i + l <= p; i++) towards_hi[n++] = weights_between(u[i + l - 1], hi, u[i + p]);

  for (size_t i = 0; i <= p; i++) row[i] = d[i];
  const weights *first = towards_hi;
  for (size_t given = 0;; given++) {
    /* b_(p - given): lo has been given `given` times, the other arguments are hi */
    for (size_t i = 0; i + given <= p; i++) high[i] = row[i];
    const weights *w = first;
    for (size_t l = given + 1; l <= p; l++)
      for (size_t i = 0; i + l <= p; i++) high[i] = combine(*w++, high[i], high[i + 1]);
    b[p - given] = high[0];
    if (given == p) return;

    /* give lo once more */
    const size_t l = given + 1;
    for (size_t i = 0; i + l <= p; i++)
      row[i] = combine(weights_between(u[i + l - 1], lo, u[i + p]), row[i], row[i + 1]);
    first += p - given;
  }
}

/* ---- what users ask a curve ---- */

size_t curve_piece_at(const cprox_curve *c, double t) {
  size_t first = 0, end = c->n_pieces;
  while (end - first > 1) {
    const size_t middle = first + (end - first) / 2;
    if (c->breaks[middle] <= t)
      first = middle;
    else
      end = middle;
  }
  return first;
}

/* Counted from the nearer end s is within 2u of the exact one, within 1.5u below 1/2; times |dpsi/ds| <= 2n max|P| that
 * adds 4n (3n) u max|P| to the error of the evaluation, 2n + 4 (3n + 2), the difference 1 - s being exact from 1/2 on.
 */
static double local_parameter(double left, double t, double right) {
  const weights w = weights_between(left, t, right);
  return w.of_right <= w.of_left ? w.of_right : 1.0 - w.of_left;
}

static vec3 divide(vec3 a, double length) {
  return vec(a.x / length, a.y / length, a.z / length);
}

/* The same of a curve that is known by its arc length. */
static cprox_status evaluate_arcs(const cprox_curve *c, double t, cprox_workspace *workspace, vec3 *point, vec3 *first,
                                  const vec3 *second) {
  if (second || (first && !c->arcs->velocity))
    return workspace_fail(workspace, CPROX_INVALID, "the curve has no %s derivative", second ? "second" : "first");
  if (first) {
    vec3 velocity = vec(NAN, NAN, NAN);
    c->arcs->velocity(c->arcs->user, t, &velocity);
    if (!vec_finite(velocity))
      return workspace_fail(workspace, CPROX_INVALID, "at t = %.17g the curve's velocity is (%g, %g, %g), not finite",
                            t, velocity.x, velocity.y, velocity.z);
    *first = velocity;
  }
  vec3 unused;
  return rectifiable_point(c, t, workspace, point ? point : &unused);
}

cprox_status cprox_curve_evaluate(const cprox_curve *curve, double t, cprox_workspace *workspace, cprox_vec3 *point,
                                  cprox_vec3 *derivative, cprox_vec3 *second_derivative) {
  WORKSPACE_USE(workspace);
  workspace_clear(workspace);
  if (!curve) return workspace_fail(workspace, CPROX_INVALID, "the curve is NULL");
  const double t0 = curve->breaks[0], t1 = curve->breaks[curve->n_pieces];
  if (!(t0 <= t && t <= t1))
    return workspace_fail(workspace, CPROX_INVALID, "t = %.17g is outside the curve's range [%.17g, %.17g]", t, t0, t1);
  if (curve->arcs) return evaluate_arcs(curve, t, workspace, point, derivative, second_derivative);

  const size_t i = curve_piece_at(curve, t);
  const double left = curve->breaks[i], right = curve->breaks[i + 1], length = right - left;
  const double s = local_parameter(left, t, right);
  const vec3 *p = curve_piece(curve, i);
  curve_bezier_evaluate(&p->x, &p->y, &p->z, 3, curve->degree, curve_binomial(curve), s, point, derivative,
                        second_derivative);

  /* from ds to dt */
  if (derivative) *derivative = divide(*derivative, length);
  if (second_derivative) *second_derivative = divide(divide(*second_derivative, length), length);
  return CPROX_OK;
}

cprox_status cprox_curve_control_points(const cprox_curve *curve, double a, double b, cprox_workspace *workspace,
                                        cprox_vec3 *points) {
  WORKSPACE_USE(workspace);
  workspace_clear(workspace);
  if (!curve || !points)
    return workspace_fail(workspace, CPROX_INVALID, "the %s is NULL", curve ? "array for the points" : "curve");
  if (curve->arcs)
    return workspace_fail(workspace, CPROX_INVALID, "a curve known by its arc length has no control points");
  const double t0 = curve->breaks[0], t1 = curve->breaks[curve->n_pieces];
  if (!(a < b)) return workspace_fail(workspace, CPROX_INVALID, "a = %.17g is not below b = %.17g", a, b);
  if (!(t0 <= a && b <= t1))
    return workspace_fail(workspace, CPROX_INVALID, "[%.17g, %.17g] leaves the curve's range [%.17g, %.17g]", a, b, t0,
                          t1);
  const size_t i = curve_piece_at(curve, a), degree = curve->degree;
  const double left = curve->breaks[i], right = curve->breaks[i + 1];
  if (b > right)
    return workspace_fail(workspace, CPROX_INVALID, "two pieces join at %.17g, inside [%.17g, %.17g]", right, a, b);

  if (a == left && b == right) {
    memcpy(points, curve_piece(curve, i), (degree + 1) * sizeof *points);
    return CPROX_OK;
  }
  /* a Bézier piece is a spline whose knots all stand at its ends */
  double knots[2 * CPROX_MAX_DEGREE];
  for (size_t k = 0; k < degree; k++) {
    knots[k] = left;
    knots[degree + k] = right;
  }
  curve_blossom(curve_piece(curve, i), knots, degree, a, b, points);
  return CPROX_OK;
}

/* The box of the control points, wider by the error. Where the piece is exact so is its box; else an error that is a
 * little larger hides the rounding of the sums. */
static void find_piece_bounds(const cprox_curve *curve, size_t piece, vec3 *lowest, vec3 *highest) {
  const vec3 *p = curve_piece(curve, piece);
  vec3 low = p[0], high = p[0];
  for (size_t k = 1; k <= curve->degree; k++) {
    low = vec(lesser(p[k].x, low.x), lesser(p[k].y, low.y), lesser(p[k].z, low.z));
    high = vec(greater(p[k].x, high.x), greater(p[k].y, high.y), greater(p[k].z, high.z));
  }
  const double error = curve->error[piece];
  if (error > 0.0) {
    low = vec(nextafter(low.x - error, -INFINITY), nextafter(low.y - error, -INFINITY),
              nextafter(low.z - error, -INFINITY));
    high = vec(nextafter(high.x + error, INFINITY), nextafter(high.y + error, INFINITY),
               nextafter(high.z + error, INFINITY));
  }
  *lowest = low;
  *highest = high;
}

cprox_curve_piece_info cprox_curve_get_piece_info(const cprox_curve *curve, size_t piece) {
  cprox_curve_piece_info info = {
      .t0 = curve->breaks[piece], .t1 = curve->breaks[piece + 1], .error = curve->arcs ? 0.0 : curve->error[piece]};
  find_piece_bounds(curve, piece, &info.lowest, &info.highest);
  return info;
}

cprox_curve_info cprox_curve_get_info(const cprox_curve *curve) {
  cprox_curve_info info = {.kind = (cprox_curve_kind)curve->kind,
                           .degree = curve->arcs ? 0 : curve->degree,
                           .n_pieces = curve->n_pieces,
                           .error = curve_error(curve),
                           .dubins = {0}};
  if (curve->kind == CPROX_CURVE_DUBINS) info.dubins = *(const cprox_dubins_path *)curve_room(curve);
  curve_domain(curve, &info.t0, &info.t1);
  find_piece_bounds(curve, 0, &info.lowest, &info.highest);
  for (size_t i = 1; i < curve->n_pieces; i++) {
    vec3 low, high;
    find_piece_bounds(curve, i, &low, &high);
    info.lowest = vec(fmin(info.lowest.x, low.x), fmin(info.lowest.y, low.y), fmin(info.lowest.z, low.z));
    info.highest = vec(fmax(info.highest.x, high.x), fmax(info.highest.y, high.y), fmax(info.highest.z, high.z));
  }
  return info;
}
