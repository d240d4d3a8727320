/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves that are known by their arc length alone. The same Bézier curve is asked both ways: by its control points, and
 * by its points and sqrt((b - a) integral of |psi'|²); both answers are intervals that hold one true distance. */
#include <string.h>

#include "base/rounding.h"
#include "curve/rectifiable.h"
#include "curve_proximity/cprox.h"
#include "support/cases.h"
#include "support/curves.h"
#include "support/make_curve.h"
#include "support/of_list.h"
#include "support/reference.h"

/* ---- a Bézier curve on [0, 1] as a caller's functions ---- */

enum { MOST_DEGREE = 9 };

typedef struct bezier {
  vec3 p[MOST_DEGREE + 1];
  size_t degree;
  double scale, far;            /* its size, and how far from the origin it is */
  double nan_from;              /* points are no numbers from here on */
  double short_below, short_by; /* lengths of shorter intervals are said to be this part of what they are */
  unsigned long points, lengths;
} bezier;

static void point(void *user, double t, vec3 *x) {
  bezier *b = user;
  b->points++;
  const vec3l at = ref_bezier(b->p, b->degree, t, 0);
  *x = vec((double)at.x, (double)at.y, (double)at.z);
  if (t >= b->nan_from) x->y = NAN;
}

static void velocity(void *user, double t, vec3 *v) {
  const bezier *b = user;
  const vec3l at = ref_bezier(b->p, b->degree, t, 1);
  *v = vec((double)at.x, (double)at.y, (double)at.z);
}

/* u_psi by Gauss' rule with 10 nodes, exact for |psi'|² up to degree 19, in long double and rounded up. */
static double length(void *user, double from, double to) {
  static const long double node[5] = {0.14887433898163121089L, 0.43339539412924719080L, 0.67940956829902440623L,
                                      0.86506336668898451073L, 0.97390652851717172008L};
  static const long double weight[5] = {0.29552422471475287017L, 0.26926671930999635509L, 0.21908636251598204400L,
                                        0.14945134915058059315L, 0.06667134430868813759L};
  bezier *b = user;
  b->lengths++;
  const long double half = 0.5L * ((long double)to - from), middle = 0.5L * ((long double)to + from);
  long double sum = 0.0L;
  for (int i = 0; i < 10; i++) {
    const vec3l v = ref_bezier(b->p, b->degree, middle + (i < 5 ? 1 : -1) * half * node[i % 5], 1);
    sum += half * weight[i % 5] * ref_dot(v, v);
  }
  const long double exact = sqrtl(2.0L * half * sum) * (1.0L + 1e-18L);
  const double u = (double)exact;
  return (to - from < b->short_below ? b->short_by : 1.0) * ((long double)u < exact ? nextafter(u, INFINITY) : u);
}

static bezier random_bezier(rng *r) {
  bezier b = {.degree = 1 + rng_index(r, 8), .scale = 1.0, .nan_from = INFINITY};
  for (size_t i = 0; i <= b.degree; i++) b.p[i] = rng_in_cube(r, 1.0);
  return b;
}

static void scale_and_move(bezier *b, double scale, vec3 by) {
  for (size_t i = 0; i <= b->degree; i++) b->p[i] = vec_axpy(by, scale, b->p[i]);
  b->scale = scale, b->far = vec_norm(by);
}

/* Points are rounded once. */
static cprox_rectifiable_curve functions(bezier *b) {
  return (cprox_rectifiable_curve){
      .point = point, .length = length, .user = b, .error = 2.0 * ROUND_U * (b->scale + b->far)};
}

static cprox_curve *by_arcs(bezier *b) {
  const cprox_rectifiable_curve f = functions(b);
  cprox_curve *c = NULL;
  assert_int_equal(curve_from(describe_rectifiable(&f, 0.0, 1.0), NULL, &c), CPROX_OK);
  return c;
}

/* A derivative of degree n is 2n times as large as the points, at most, and rounded once. */
static cprox_curve *by_velocity(bezier *b) {
  cprox_rectifiable_curve f = functions(b);
  f.length = NULL;
  f.velocity = velocity;
  f.velocity_error = 40.0 * ROUND_U * (b->scale + b->far);
  cprox_curve *c = NULL;
  assert_int_equal(curve_from(describe_rectifiable(&f, 0.0, 1.0), NULL, &c), CPROX_OK);
  return c;
}

static cprox_curve *by_points(const bezier *b) {
  cprox_curve *c = NULL;
  assert_int_equal(curve_from(describe_bezier(b->p, b->degree + 1, 0.0, 1.0), NULL, &c), CPROX_OK);
  return c;
}

/* ---- the hull ---- */

static double least_of(const bezier *b, double from, double to, vec3 n) {
  const vec3l at = ref_vec(n);
  long double least = INFINITY;
  for (int i = 0; i <= 40; i++)
    least = fminl(least, ref_dot(at, ref_bezier(b->p, b->degree, from + (i / 40.0L) * ((long double)to - from), 0)));
  return (double)least;
}

/* A line at even speed whose points are exact, and its length to the last digit: products of numbers of 26 digits. */
static void exact_line(rng *r, bezier *b, double *from, double *to) {
  b->degree = 1;
  b->p[0] = vec(0, 0, 0);
  b->p[1] = vec((double)rng_index(r, 1 << 26), (double)rng_index(r, 1 << 26), 1.0 + (double)rng_index(r, 1 << 26));
  const double length = 1.0 + floor(rng_log_uniform(r, 1.0, 3e7)), most = ldexp(1.0, 26) - length;
  *from = ldexp(floor(rng_uniform(r, 0.0, most)), -26);
  *to = *from + ldexp(length, -26);
}

/* seed 641, 20000 intervals down to 1e-12 long, of which a third on exact lines at even speed: there W² - L² is all
 * rounding, and a normal across the chord shows it. The reach is within 8u of the sizes, as its header says; n's own
 * length is u from 1. */
CASE(no_ellipsoid_leaves_out_a_point) {
  rng r = rng_seed(641);
  double largest = -INFINITY;
  for (size_t i = test_cases(20000); i-- > 0;) {
    bezier b = random_bezier(&r);
    const double h = rng_log_uniform(&r, 1e-12, 1.0);
    double from = rng_uniform(&r, 0.0, 1.0 - h), to = from + h;
    cprox_rectifiable_curve f = functions(&b);
    if (i % 3 == 0) {
      exact_line(&r, &b, &from, &to);
      f.error = 0.0;
    }
    const cprox_curve c = {.arcs = (cprox_rectifiable_curve *)&f};
    vec3 ends[2];
    assert_int_equal(rectifiable_point(&c, from, NULL, &ends[0]), CPROX_OK);
    assert_int_equal(rectifiable_point(&c, to, NULL, &ends[1]), CPROX_OK);
    rectifiable_hull hull;
    assert_int_equal(rectifiable_hull_of(&c, from, to, ends[0], ends[1], f.error, NULL, &hull), CPROX_OK);

    /* across the chord, or nearly */
    vec3 n = vec_cross(vec_sub(ends[1], ends[0]), rng_unit(&r));
    if (rng_index(&r, 4) == 0 || vec_norm2(n) == 0.0) n = rng_unit(&r);
    n = vec_scale(1.0 / vec_norm(n), n);
    n = vec_axpy(n, rng_index(&r, 2) ? rng_log_uniform(&r, 1e-12, 1e-6) : 0.0, rng_unit(&r));
    n = vec_scale(1.0 / vec_norm(n), n);
    const double reach = rectifiable_reach(&hull, ends[0], ends[1], n), least = least_of(&b, from, to, n);
    const double size = hull.axis + fmax(vec_norm(ends[0]), vec_norm(ends[1]));
    if (!(reach <= least + 8.0 * ROUND_U * size))
      fail_msg("[%.17g, %.17g]: reach %.17g, but a point at %.17g", from, to, reach, least);
    /* and it is no wider than the capsule that it lies in */
    const double capsule = fmin(vec_dot(n, ends[0]), vec_dot(n, ends[1])) - hull.radius;
    assert_true(reach >= capsule - 8.0 * ROUND_U * size);
    largest = fmax(largest, (reach - least) / (8.0 * ROUND_U * size));
  }
  print_message("the tightest reach is %.3g of its rounding above a point\n", largest);
}

/* ---- queries ---- */

static cprox_body *random_body(rng *r, double scale) {
  cprox_body *body = NULL;
  cprox_status status = CPROX_OK;
  vec3 v[12];
  switch (rng_index(r, 5)) {
    case 0: status = cprox_body_create_point(vec(0, 0, 0), NULL, &body); break;
    case 4: {
      /* a surface that is no hull: two triangles with a fold */
      static const uint32_t triangles[2][3] = {{0, 1, 2}, {1, 2, 3}};
      for (int i = 0; i < 4; i++) v[i] = rng_in_cube(r, 0.4 * scale);
      status = cprox_body_create_mesh(v, 4, triangles, 2, CPROX_MESH_FILL_SURFACE, SIZE_MAX, NULL, &body);
      break;
    }
    case 1: status = cprox_body_create_sphere(scale * rng_uniform(r, 0.05, 0.5), NULL, &body); break;
    case 2:
      for (int i = 0; i < 3; i++) v[i] = vec(0, 0, scale * rng_uniform(r, 0.1, 1));
      status = cprox_body_create_box(vec(v[0].z, v[1].z, v[2].z), NULL, &body);
      break;
    default:
      for (int i = 0; i < 12; i++) v[i] = rng_in_cube(r, 0.4 * scale);
      status = cprox_body_create_polytope(v, 12, NULL, &body);
  }
  assert_int_equal(status, CPROX_OK);
  return body;
}

static cprox_pose random_pose(rng *r, double scale, vec3 about) {
  const vec3 axis = rng_unit(r);
  return (cprox_pose){.position = vec_add(about, rng_in_cube(r, 1.5 * scale)),
                      .orientation = {rng_uniform(r, -1, 1), axis.x, axis.y, axis.z}};
}

/* What both ways say of one distance. */
static void agree(const cprox_result *arcs, const cprox_result *points, double epsilon) {
  if (!(arcs->lower <= points->upper && points->lower <= arcs->upper))
    fail_msg("[%.17g, %.17g] by arcs, [%.17g, %.17g] by points", arcs->lower, arcs->upper, points->lower,
             points->upper);
  if (arcs->status == CPROX_OK && arcs->upper - arcs->lower > epsilon)
    fail_msg("ok, but %g wide", arcs->upper - arcs->lower);
}

/* The interval by arcs holds the distance that the other one holds, too; the verdicts follow. */
static void check_body(bezier *b, bool with_velocity, const cprox_obstacle *target, double radius, double epsilon,
                       cprox_workspace *ws, cprox_result *of_arcs) {
  cprox_curve *arcs = with_velocity ? by_velocity(b) : by_arcs(b), *points = by_points(b);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilon;
  cprox_result of_points;
  const cprox_status status = cprox_distance(cprox_tube_along(arcs, radius), *target, &options, ws, of_arcs);
  if (status < 0) fail_msg("%s", cprox_workspace_error(ws));
  assert_true(cprox_distance(cprox_tube_along(points, radius), *target, &options, ws, &of_points) >= 0);
  agree(of_arcs, &of_points, epsilon);
  for (int k = 0; k < 2; k++) {
    const double delta = of_points.lower * (k ? 1.01 : 0.99);
    cprox_result verdict;
    assert_true(cprox_tolerance(cprox_tube_along(arcs, radius), *target, delta, &options, ws, &verdict) >= 0);
    if (verdict.verdict == CPROX_VERDICT_CLEAR) assert_true(delta < of_points.upper);
    if (verdict.verdict == CPROX_VERDICT_VIOLATED) assert_true(delta >= of_points.lower);
    assert_true(verdict.verdict != CPROX_VERDICT_UNDECIDED || 0.01 * of_points.lower < 2.0 * epsilon);
  }
  cprox_curve_free(points);
  cprox_curve_free(arcs);
}

/* seed 642, 400 curves of 1e-6 … 1e6 m, half of them up to 1e6 m from the origin, every other one by Gauss and Kronrod.
 * Epsilon is 1e-6 of the size; where the points' own error of 2u at 1e6 m is not far below that, the answer may say so.
 */
CASE(distances_by_arcs_and_by_points_agree) {
  rng r = rng_seed(642);
  cprox_workspace *ws = cprox_workspace_create();
  unsigned long nodes = 0, most = 0, n = 0, not_ok = 0;
  for (size_t i = test_cases(400); i-- > 0;) {
    bezier b = random_bezier(&r);
    const double scale = rng_log_uniform(&r, 1e-6, 1e6);
    const vec3 by = rng_index(&r, 2) ? vec(0, 0, 0) : rng_in_cube(&r, 1e6);
    scale_and_move(&b, scale, by);
    cprox_body *body = random_body(&r, scale);
    const cprox_obstacle target =
        cprox_with_margin(cprox_obstacle_at(body, random_pose(&r, scale, by)), rng_index(&r, 2) ? 0.0 : 0.05 * scale);
    const double radius = rng_index(&r, 2) ? 0.0 : 0.02 * scale;
    cprox_result of_arcs;
    check_body(&b, i % 2, &target, radius, 1e-6 * scale, ws, &of_arcs);
    const bool precise = 2.0 * ROUND_U * b.far < 1e-9 * scale;
    not_ok += precise && of_arcs.status != CPROX_OK;
    n += precise;
    nodes += precise ? of_arcs.nodes : 0, most = precise && of_arcs.nodes > most ? of_arcs.nodes : most;
    cprox_body_free(body);
  }
  print_message("%lu nodes a distance on average, %lu at most; %lu of %lu not to epsilon\n", nodes / n, most, not_ok,
                n);
  assert_true(not_ok <= n / 50);
  cprox_workspace_free(ws);
}

/* (a cos t, b sin t, c t): |psi'|² has the integral (a² + b²)h/2 + c² h + (b² - a²)/2 cos(s) sin(h), h the difference
 * and s the sum of the ends. */
typedef struct helix {
  vec3 size, middle;
  unsigned long points, lengths;
} helix;

static void helix_point(void *user, double t, vec3 *x) {
  helix *h = user;
  h->points++;
  *x = vec_add(h->middle, vec(h->size.x * cos(t), h->size.y * sin(t), h->size.z * t));
}

static double helix_length(void *user, double from, double to) {
  helix *k = user;
  k->lengths++;
  const long double h = (long double)to - from, s = (long double)to + from, a = k->size.x, b = k->size.y, c = k->size.z;
  const long double energy = (0.5L * (a * a + b * b) + c * c) * h + 0.5L * (b * b - a * a) * cosl(s) * sinl(h);
  return (double)sqrtl(h * energy * (1.0L + 1e-14L));
}

/* Seed 407: 200 helices past a box, to 1e-10. Least distances are found by parabolas and bounded by parts that grow from
 * there: bisection at the middles takes 59 lengths, a search without parabolas 62 and 64 points. */
CASE(a_smooth_curve_takes_a_few_dozen_lengths) {
  rng r = rng_seed(407);
  cprox_workspace *w = cprox_workspace_create();
  unsigned long points = 0, lengths = 0, n = 0;
  cprox_body *body = NULL;
  const vec3 half = vec(0.5, 0.4, 0.3);
  assert_int_equal(cprox_body_create_box(vec_scale(2.0, half), w, &body), CPROX_OK);
  for (size_t i = 0; i < test_cases(200); i++) {
    helix h = {.size = vec(rng_uniform(&r, 0.5, 2.0), rng_uniform(&r, 0.5, 2.0), rng_uniform(&r, 0.0, 0.2))};
    h.middle = vec_scale(rng_uniform(&r, 3.0, 4.0), rng_unit(&r));
    const cprox_rectifiable_curve f = {.point = helix_point, .length = helix_length, .user = &h, .error = 2e-15};
    const cprox_curve_description d = {.kind = CPROX_CURVE_RECTIFIABLE, .t1 = 6.0, .rectifiable = &f};
    cprox_curve *curve = NULL;
    assert_int_equal(cprox_curve_create(&d, w, &curve), CPROX_OK);
    h.points = h.lengths = 0;
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-10;
    cprox_result result;
    assert_int_equal(
        cprox_distance(cprox_point_along(curve), cprox_obstacle_at(body, CPROX_POSE_IDENTITY), &options, w, &result),
        CPROX_OK);
    points += h.points, lengths += h.lengths, n++;
    double least = INFINITY;
    for (int k = 0; k <= 20000; k++) {
      vec3 x;
      helix_point(&h, 6.0 * k / 20000, &x);
      const vec3 out = vec(fmax(fabs(x.x) - half.x, 0.0), fmax(fabs(x.y) - half.y, 0.0), fmax(fabs(x.z) - half.z, 0.0));
      least = fmin(least, vec_norm(out));
    }
    assert_true(result.lower <= least + 1e-14 && least <= result.upper + 1e-6);
    cprox_curve_free(curve);
  }
  print_message("%lu points and %lu lengths on average\n", points / n, lengths / n);
  assert_true(lengths < 52 * n && points < 58 * n);
  cprox_body_free(body);
  cprox_workspace_free(w);
}

/* A polyline at the speed 1: its parameter is its length, and its kinks are known to nobody. */
enum { CORNERS = 12 };
typedef struct polyline {
  vec3 corner[CORNERS];
  double at[CORNERS]; /* the length up to a corner */
} polyline;

static void polyline_point(void *user, double t, vec3 *x) {
  const polyline *p = user;
  int i = 0;
  while (i < CORNERS - 2 && t > p->at[i + 1]) i++;
  *x = vec_lerp(p->corner[i], p->corner[i + 1], (t - p->at[i]) / (p->at[i + 1] - p->at[i]));
}

static double polyline_length(void *user, double from, double to) {
  (void)user;
  return (to - from) * (1.0 + 8.0 * ROUND_U) + 8.0 * ROUND_U * (double)CORNERS;
}

/* The least of a convex function on a segment, by thirds, in long double. */
static long double least_on(vec3 a, vec3 b, vec3 half) {
  long double from = 0.0L, to = 1.0L, least = INFINITY;
  for (int i = 0; i < 200; i++) {
    long double d[2];
    for (int k = 0; k < 2; k++) {
      const long double s = from + (to - from) * (1 + k) / 3.0L;
      const long double x = fmaxl(fabsl(a.x + s * ((long double)b.x - a.x)) - half.x, 0.0L),
                        y = fmaxl(fabsl(a.y + s * ((long double)b.y - a.y)) - half.y, 0.0L),
                        z = fmaxl(fabsl(a.z + s * ((long double)b.z - a.z)) - half.z, 0.0L);
      d[k] = sqrtl(x * x + y * y + z * z);
      least = fminl(least, d[k]);
    }
    if (d[0] < d[1])
      to = from + 2.0L * (to - from) / 3.0L;
    else
      from += (to - from) / 3.0L;
  }
  return least;
}

/* Seed 408: 300 polylines about a box or a point, to 1e-10. */
CASE(curves_with_kinks_end) {
  rng r = rng_seed(408);
  cprox_workspace *w = cprox_workspace_create();
  unsigned long nodes = 0, most = 0, n = 0;
  for (size_t i = 0; i < test_cases(300); i++) {
    polyline p = {.at = {0.0}};
    for (int k = 0; k < CORNERS; k++) {
      p.corner[k] = vec_axpy(rng_in_cube(&r, 0.5), rng_uniform(&r, 1.2, 2.0), rng_unit(&r));
      if (k > 0) p.at[k] = p.at[k - 1] + vec_norm(vec_sub(p.corner[k], p.corner[k - 1]));
    }
    const cprox_rectifiable_curve f = {.point = polyline_point, .length = polyline_length, .user = &p, .error = 1e-15};
    const cprox_curve_description d = {.kind = CPROX_CURVE_RECTIFIABLE, .t1 = p.at[CORNERS - 1], .rectifiable = &f};
    const vec3 half = i % 2 ? vec(0.3, 0.2, 0.25) : vec(0, 0, 0);
    cprox_curve *curve = NULL;
    cprox_body *body = NULL;
    assert_int_equal(cprox_curve_create(&d, w, &curve), CPROX_OK);
    assert_int_equal(
        i % 2 ? cprox_body_create_box(vec_scale(2.0, half), w, &body) : cprox_body_create_point(half, w, &body),
        CPROX_OK);
    long double truth = INFINITY;
    for (int k = 0; k + 1 < CORNERS; k++) truth = fminl(truth, least_on(p.corner[k], p.corner[k + 1], half));
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-10;
    cprox_result result;
    assert_true(cprox_distance(cprox_point_along(curve), cprox_obstacle_at(body, CPROX_POSE_IDENTITY), &options, w,
                               &result) >= 0);
    if (truth > 0.0L && result.status != CPROX_OK)
      fail_msg("case %zu: status %s, [%.12g, %.12g] of %.12Lg after %u nodes", i, cprox_status_name(result.status),
               result.lower, result.upper, truth, result.nodes);
    if (!(result.lower <= truth + 1e-15L && truth <= result.upper + 1e-15L))
      fail_msg("case %zu: [%.17g, %.17g] is not about %.17Lg", i, result.lower, result.upper, truth);
    if (truth > 0.0L) nodes += result.nodes, most = result.nodes > most ? result.nodes : most, n++;
    cprox_curve_free(curve);
    cprox_body_free(body);
  }
  print_message("%lu nodes a polyline on average, %lu at most\n", nodes / n, most);
  cprox_workspace_free(w);
}

/* seed 647, 200 curves: the time of contact by arcs is not after the one by points, nor before the free interval that
 * is proven; and every interval of the profile holds what the interval by points holds. */
CASE(times_of_contact_and_profiles_agree) {
  rng r = rng_seed(647);
  cprox_workspace *ws = cprox_workspace_create();
  unsigned long hits = 0;
  for (size_t i = test_cases(200); i-- > 0;) {
    bezier b = random_bezier(&r);
    cprox_curve *arcs = by_arcs(&b), *points = by_points(&b);
    cprox_body *body = random_body(&r, 1.0);
    const cprox_obstacle target = cprox_obstacle_at(body, random_pose(&r, 0.6, vec(0, 0, 0)));
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-6;
    cprox_result of_arcs, of_points;
    if (cprox_time_of_contact(cprox_point_along(arcs), target, &options, ws, &of_arcs) < 0)
      fail_msg("%s", cprox_workspace_error(ws));
    assert_true(cprox_time_of_contact(cprox_point_along(points), target, &options, ws, &of_points) >= 0);
    if (of_points.verdict == CPROX_VERDICT_VIOLATED) {
      hits++;
      assert_true(of_arcs.t_contact_lower <= of_points.t);
    }
    if (of_arcs.verdict == CPROX_VERDICT_VIOLATED) assert_true(of_points.t_contact_lower <= of_arcs.t);
    if (of_arcs.verdict == CPROX_VERDICT_CLEAR) assert_true(of_points.verdict != CPROX_VERDICT_VIOLATED);

    cprox_profile_interval by_arc[7], by_point[7];
    double breaks[8] = {0.0};
    for (int k = 0; k < 7; k++) breaks[k + 1] = (k + rng_uniform(&r, 0.5, 1.0)) / 7.0;
    assert_true(profile_of_list(cprox_point_along(arcs), &target, 1, breaks, 7, &options, ws, by_arc) >= 0);
    assert_true(profile_of_list(cprox_point_along(points), &target, 1, breaks, 7, &options, ws, by_point) >= 0);
    for (int k = 0; k < 7; k++)
      assert_true(by_arc[k].lower <= by_point[k].upper && by_point[k].lower <= by_arc[k].upper);
    cprox_body_free(body);
    cprox_curve_free(points);
    cprox_curve_free(arcs);
  }
  print_message("%lu contacts\n", hits);
  assert_true(hits > 10);
  cprox_workspace_free(ws);
}

/* seed 643, 60 pairs; 1e-4, both by arcs or one by points. */
CASE(curves_by_arcs_and_by_points_agree) {
  rng r = rng_seed(643);
  cprox_workspace *ws = cprox_workspace_create();
  unsigned long nodes = 0, n = 0, not_ok = 0;
  for (size_t i = test_cases(60); i-- > 0;) {
    bezier b[2] = {random_bezier(&r), random_bezier(&r)};
    const vec3 shift = rng_in_cube(&r, 1.5);
    for (size_t k = 0; k <= b[1].degree; k++) b[1].p[k] = vec_add(b[1].p[k], shift);
    cprox_curve *arcs[2] = {by_arcs(&b[0]), i % 3 ? by_arcs(&b[1]) : by_points(&b[1])};
    cprox_curve *points[2] = {by_points(&b[0]), by_points(&b[1])};
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-4;
    cprox_result of_arcs, of_points;
    const cprox_status status =
        cprox_distance(cprox_point_along(arcs[0]), cprox_obstacle_curve(arcs[1], 0.0), &options, ws, &of_arcs);
    if (status < 0) fail_msg("%s", cprox_workspace_error(ws));
    assert_true(cprox_distance(cprox_point_along(points[0]), cprox_obstacle_curve(points[1], 0.0), &options, ws,
                               &of_points) >= 0);
    agree(&of_arcs, &of_points, options.epsilon);
    not_ok += status != CPROX_OK;
    nodes += of_arcs.nodes, n++;
    for (int k = 0; k < 2; k++) {
      cprox_curve_free(arcs[k]);
      cprox_curve_free(points[k]);
    }
  }
  print_message("%lu nodes a pair of curves on average; %lu of %lu not to epsilon\n", nodes / n, not_ok, n);
  assert_true(not_ok <= n / 10);
  cprox_workspace_free(ws);
}

/* ---- what is wrong ---- */

CASE(what_contradicts_itself_is_refused_at_once) {
  rng r = rng_seed(644);
  cprox_workspace *ws = cprox_workspace_create();
  cprox_curve *c = NULL;
  bezier b = random_bezier(&r);
  b.nan_from = 0.7;
  cprox_rectifiable_curve f = functions(&b);
  assert_int_equal(curve_from(describe_rectifiable(&f, 0, 1), ws, &c), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "at t = 0.703125 the curve's point is ("));
  b.nan_from = INFINITY, b.short_below = 1.0, b.short_by = 0.9;
  assert_int_equal(curve_from(describe_rectifiable(&f, 0, 1), ws, &c), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "between t = 0 and 0.015625 the arc length is said to be at most"));
  b.short_by = NAN;
  assert_int_equal(curve_from(describe_rectifiable(&f, 0, 1), ws, &c), CPROX_INVALID);
  assert_string_equal(
      cprox_workspace_error(ws),
      "between t = 0 and 0.015625 the bound of the arc length is nan; it must be at least 0 and finite");
  b.short_below = 0.0;

  const cprox_rectifiable_curve good = f;
  f.point = NULL;
  assert_int_equal(curve_from(describe_rectifiable(&f, 0, 1), ws, &c), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "the function point is NULL");
  f = good, f.length = NULL;
  assert_int_equal(curve_from(describe_rectifiable(&f, 0, 1), ws, &c), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "the functions length and velocity are both NULL; one is needed");
  f = good, f.error = NAN;
  assert_int_equal(curve_from(describe_rectifiable(&f, 0, 1), ws, &c), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "error is nan; it must be at least 0 and finite");
  f = good, f.length = NULL, f.velocity = velocity, f.quadrature_error = -1.0;
  assert_int_equal(curve_from(describe_rectifiable(&f, 0, 1), ws, &c), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "quadrature_error is -1; it must be at least 0 and finite");
  assert_int_equal(curve_from(describe_rectifiable(&good, 1, 1), ws, &c), CPROX_INVALID);
  assert_int_equal(curve_from(describe_rectifiable(NULL, 0, 1), ws, &c), CPROX_INVALID);
  assert_null(c);
  cprox_workspace_free(ws);
}

/* Distances and times of contact with a curve whose functions go wrong after it was made: an honest status and message
 * and no result, or an answer that did not need to ask. */
CASE(what_goes_wrong_midway_ends_the_query) {
  rng r = rng_seed(645);
  cprox_workspace *ws = cprox_workspace_create();
  int asked = 0, refused = 0;
  for (int i = 0; i < 60; i++) {
    bezier b = random_bezier(&r), other = random_bezier(&r);
    cprox_curve *c = by_arcs(&b), *straight = by_points(&other);
    cprox_body *body = random_body(&r, 1.0);
    if (i % 2)
      b.nan_from = 0.0;
    else
      b.short_below = 0.01, b.short_by = 0.5;
    const char *reason = i % 2 ? "the curve's point is (" : "the arc length is said to be at most ";
    const cprox_mover mover = cprox_point_along(c);
    const cprox_obstacle targets[2] = {cprox_obstacle_at(body, random_pose(&r, 1.0, vec(0, 0, 0))),
                                       cprox_obstacle_curve(straight, 0.0)};
    for (int query_type = 0; query_type < 6; query_type++) {
      const cprox_obstacle target = targets[query_type % 2];
      cprox_options options = CPROX_OPTIONS_DEFAULT;
      options.epsilon = 1e-9;
      cprox_result result = {.t = -123.0};
      cprox_status status = CPROX_OK;
      if (query_type < 2) status = cprox_distance(mover, target, &options, ws, &result);
      if (query_type / 2 == 1) status = cprox_time_of_contact(mover, target, &options, ws, &result);
      if (query_type / 2 == 2)
        status = cprox_distance(cprox_point_along(straight), cprox_obstacle_curve(c, 0.0), &options, ws, &result);
      asked++;
      if (status >= 0) continue;
      refused++;
      assert_int_equal(status, CPROX_INVALID);
      if (!strstr(cprox_workspace_error(ws), reason))
        fail_msg("query %d: \"%s\"", query_type, cprox_workspace_error(ws));
      assert_true(result.t == -123.0);
    }
    /* and the workspace is as good as ever */
    cprox_result result;
    assert_true(cprox_distance(cprox_point_along(straight), targets[0], NULL, ws, &result) >= 0);
    cprox_body_free(body);
    cprox_curve_free(straight);
    cprox_curve_free(c);
  }
  print_message("%d of %d queries came by and were refused\n", refused, asked);
  assert_true(refused > asked / 2);
  cprox_workspace_free(ws);
}

/* What such a curve has not is said, and what it has is right. */
CASE(it_says_what_it_is) {
  rng r = rng_seed(646);
  bezier b = random_bezier(&r);
  cprox_workspace *ws = cprox_workspace_create();
  cprox_curve *c = by_arcs(&b), *v = by_velocity(&b), *whole = NULL;
  assert_int_equal(cprox_curve_get_info(c).degree, 0);
  assert_true(cprox_curve_get_info(c).error == 2.0 * ROUND_U);
  vec3 x, d, p[4];
  assert_int_equal(cprox_curve_evaluate(c, 0.25, ws, &x, NULL, NULL), CPROX_OK);
  vec3 should;
  point(&b, 0.25, &should);
  assert_true(vec_equal(x, should));
  assert_int_equal(cprox_curve_evaluate(c, 0.25, ws, &x, &d, NULL), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "the curve has no first derivative");
  assert_int_equal(cprox_curve_evaluate(v, 0.25, ws, &x, &d, NULL), CPROX_OK);
  velocity(&b, 0.25, &should);
  assert_true(vec_equal(d, should));
  assert_int_equal(cprox_curve_evaluate(v, 0.25, ws, NULL, NULL, &d), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "the curve has no second derivative");
  assert_int_equal(cprox_curve_control_points(c, 0, 0.001, ws, p), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "a curve known by its arc length has no control points");
  const cprox_curve *one[1] = {c};
  assert_int_equal(curve_from(describe_piecewise(one, 1, NULL, 0.0), ws, &whole), CPROX_INVALID);
  vec3 low, high;
  low = cprox_curve_get_info(c).lowest, high = cprox_curve_get_info(c).highest;
  for (double t = 0.0; t <= 1.0; t += 1.0 / 256.0) {
    point(&b, t, &x);
    assert_true(low.x <= x.x && low.y <= x.y && low.z <= x.z && x.x <= high.x && x.y <= high.y && x.z <= high.z);
  }
  cprox_curve_free(v);
  cprox_curve_free(c);
  cprox_workspace_free(ws);
}

int main(void) {
  return cases_run(NULL, NULL);
}
