/* SPDX-License-Identifier: BSD-3-Clause */
/* Continuous collision detection of a vertex and a face, and of two edges.
 *
 * Both are one problem: when does a flat convex polygon, whose corners move linearly, come to the origin? The corners
 * are those of the Minkowski difference: face less vertex, three, or second edge less first, four.
 *
 *  - Conservative advancement (Mirtich 1996): the plane of the nearest point at t bounds the distance from below for as
 *    long as all corners are beyond it. A corner's height above a fixed plane is linear in t, so the time at which the
 *    first corner falls to a part of the clearance is a division. Nothing depends on how good the plane is.
 *  - Contact with a margin: a point of the polygon that is as near.
 *  - Contact without: m is the polygon's normal at ta. Seen along m the origin is inside the polygon over [ta, tb]: for
 *    each side m . (w_k x w_k+1) > 0, a quadratic whose three Bernstein coefficients are positive. Then the line along
 *    m meets the polygon in one point, at a height that is continuous in t. It is above the origin at ta, where a plane
 *    whose normal has a positive product with m separates, and below it at tb, where one with -m does. So it is 0 in
 *    between.
 *
 * Rounding: a corner is a difference of two coordinates that were given, so that its error is relative to itself. At
 * any t it is computed within `error` of the real one; everything else is a dot or a cross product of corners. */
#include "curve_proximity/cprox/ccd.h"

#include <float.h>

#include "base/rounding.h"
#include "base/vec.h"
#include "base/workspace.h"
#include "problem/validate.h"

enum {
  CCD_CORNERS = 4,
  CCD_LAST = 16, /* planes that are tried where contact is looked for */
  CCD_TRIES = 4  /* ends of an interval in which contact may be proven */
};

/* A step goes until this part of the clearance is left: what `lower` says of a step that is clear. */
#define CCD_LEFT 0.125

/* Contact is looked for within epsilon of the margin, and where rounding leaves so little to go that this is some times
 * what a plane's height is off by. */
#define CCD_CLOSE 64.0

/* The moving polygon: corner k is at[k] + t by[k]. */
typedef struct ccd_polygon {
  vec3 at[CCD_CORNERS], by[CCD_CORNERS];
  size_t n;
  vec3 size;  /* no corner's coordinate is larger */
  vec3 error; /* nor farther from the real one, at any t */
} ccd_polygon;

/* The point of the polygon nearest to the origin. */
typedef struct ccd_near {
  double weights[CCD_CORNERS];
  vec3 point, normal; /* unit, from the origin to it, or 0 */
  double upper;       /* the distance is at most this */
} ccd_near;

static vec3 ccd_size(vec3 a) {
  return vec(fabs(a.x), fabs(a.y), fabs(a.z));
}

static vec3 ccd_greater(vec3 a, vec3 b) {
  return vec(greater(a.x, b.x), greater(a.y, b.y), greater(a.z, b.z));
}

static size_t ccd_next(const ccd_polygon *p, size_t k) {
  return k + 1 < p->n ? k + 1 : 0;
}

/* start[k], end[k]: the corners, rounded once. By at most u each, and (1 - t) start + t end by as much. Then 2 u for
 * the rounding of end - start, 2 u of the product with t, 1 u of the sum: 6 u of the size. */
static void ccd_polygon_set(const vec3 *start, const vec3 *end, size_t n, ccd_polygon *p) {
  p->n = n;
  p->size = vec(0, 0, 0);
  for (size_t k = 0; k < n; k++) {
    p->at[k] = start[k];
    p->by[k] = vec_sub(end[k], start[k]);
    p->size = ccd_greater(p->size, ccd_greater(ccd_size(start[k]), ccd_size(end[k])));
  }
  p->error = vec_axpy(vec(DBL_MIN, DBL_MIN, DBL_MIN), ROUND_UP * 6.0 * ROUND_U, p->size);
}

static void ccd_corners(const ccd_polygon *p, double t, vec3 *c) {
  for (size_t k = 0; k < p->n; k++) c[k] = vec_axpy(p->at[k], t, p->by[k]);
}

/* normal . corner is computed within this of the real product, for each corner at any t: the corner's error, and 3 u of
 * the dot product. */
static double ccd_slack(const ccd_polygon *p, vec3 normal) {
  const vec3 each = vec_axpy(p->error, 4.0 * ROUND_U, p->size);
  return ROUND_UP * vec_dot(ccd_size(normal), each) + DBL_MIN;
}

static double ccd_lowest(const ccd_polygon *p, const vec3 *c, vec3 normal) {
  double lowest = vec_dot(normal, c[0]);
  for (size_t k = 1; k < p->n; k++) lowest = lesser(lowest, vec_dot(normal, c[k]));
  return lowest;
}

/* The polygon is at least this far from the origin, where it is above 0. A computed unit vector is 1 within 4 u. */
static double ccd_height(const ccd_polygon *p, const vec3 *c, vec3 normal) {
  return (ccd_lowest(p, c, normal) - ccd_slack(p, normal)) * (1.0 - 8.0 * ROUND_U);
}

/* ---- the nearest point ---- */

/* A unit vector along a, or 0 where its length is not a normal number. */
static vec3 ccd_unit(vec3 a) {
  const double length = vec_norm(a);
  return length > 1e-150 ? vec_scale(1.0 / length, a) : vec(0, 0, 0);
}

/* By its diagonals, or the sides of a triangle. */
static vec3 ccd_normal(const ccd_polygon *p, const vec3 *c) {
  return p->n == 3 ? vec_cross(vec_sub(c[1], c[0]), vec_sub(c[2], c[0]))
                   : vec_cross(vec_sub(c[2], c[0]), vec_sub(c[3], c[1]));
}

/* Where the origin is beside the polygon; false where it is not, or where the polygon has no normal. */
static bool ccd_near_inside(const ccd_polygon *p, const vec3 *c, ccd_near *near) {
  const vec3 m = ccd_unit(ccd_normal(p, c));
  double side[CCD_CORNERS] = {0};
  for (size_t k = 0; k < p->n; k++) {
    side[k] = vec_dot(m, vec_cross(c[k], c[ccd_next(p, k)]));
    if (!(side[k] >= 0.0)) return false;
  }
  double *w = near->weights;
  if (p->n == 3) {
    w[0] = side[1], w[1] = side[2], w[2] = side[0], w[3] = 0.0;
  } else {
    /* the triangle on either side of the diagonal */
    const double across = vec_dot(m, vec_cross(c[0], c[2]));
    if (across <= 0.0)
      w[0] = side[1], w[1] = -across, w[2] = side[0], w[3] = 0.0;
    else
      w[0] = side[2], w[1] = 0.0, w[2] = side[3], w[3] = across;
  }
  const double all = w[0] + w[1] + w[2] + w[3];
  if (!(all > DBL_MIN)) return false;
  near->point = vec(0, 0, 0);
  for (size_t k = 0; k < p->n; k++) w[k] /= all, near->point = vec_axpy(near->point, w[k], c[k]);
  near->normal = vec_dot(m, near->point) < 0.0 ? vec_neg(m) : m;
  return true;
}

static void ccd_near_side(const ccd_polygon *p, const vec3 *c, ccd_near *near) {
  double least = INFINITY, at = 0.0;
  size_t best = 0;
  for (size_t k = 0; k < p->n; k++) {
    const vec3 along = vec_sub(c[ccd_next(p, k)], c[k]);
    const double length2 = vec_norm2(along);
    const double s = length2 > DBL_MIN ? greater(lesser(-vec_dot(c[k], along) / length2, 1.0), 0.0) : 0.0;
    const double d2 = vec_norm2(vec_axpy(c[k], s, along));
    if (d2 < least) least = d2, at = s, best = k;
  }
  const size_t next = ccd_next(p, best);
  const vec3 along = vec_sub(c[next], c[best]);
  for (size_t k = 0; k < CCD_CORNERS; k++) near->weights[k] = 0.0;
  near->weights[best] = 1.0 - at;
  near->weights[next] = at;
  near->point = vec_axpy(c[best], at, along);
  /* along the side both ends have one height: what rounding left of the side in a short normal goes */
  const double length2 = vec_norm2(along);
  const bool within = at > 0.0 && at < 1.0 && length2 > DBL_MIN;
  const double rest = within ? -vec_dot(near->point, along) / length2 : 0.0;
  near->normal = ccd_unit(vec_axpy(near->point, rest, along));
}

/* A point of the polygon is computed within a corner's error and 12 u of the size: weights, products, sums. */
static void ccd_near_measure(const ccd_polygon *p, ccd_near *near) {
  const vec3 off = vec_axpy(p->error, 12.0 * ROUND_U, p->size);
  near->upper = ROUND_UP * vec_norm(vec_add(ccd_size(near->point), off));
}

static void ccd_nearest(const ccd_polygon *p, const vec3 *c, ccd_near *near) {
  const bool inside = ccd_near_inside(p, c, near);
  const double height = inside ? ccd_lowest(p, c, near->normal) : 0.0;
  /* the normal of a polygon that is almost a segment may be none */
  if (!inside || height < 0.5 * vec_norm(near->point)) {
    ccd_near side;
    ccd_near_side(p, c, &side);
    if (!inside || ccd_lowest(p, c, side.normal) > height) *near = side;
  }
  ccd_near_measure(p, near);
}

/* ---- contact ---- */

/* The product of two directions is above 0. */
static bool ccd_agree(vec3 a, vec3 b) {
  return vec_dot(a, b) > 8.0 * ROUND_U * vec_dot(ccd_size(a), ccd_size(b)) + DBL_MIN;
}

/* Seen along m, turned so that the polygon is counter-clockwise, the origin is inside the polygon at each time between
 * those at which the corners are a and b. A product of coordinates is off by the errors of both corners, and by 12 u of
 * its size for the cross product, the dot product and the mean. */
static bool ccd_stays_inside(const ccd_polygon *p, const vec3 *a, const vec3 *b, vec3 m) {
  vec3 most = vec(0, 0, 0);
  for (size_t k = 0; k < p->n; k++) most = ccd_greater(most, ccd_greater(ccd_size(a[k]), ccd_size(b[k])));
  const vec3 e = p->error, s = ccd_size(m);
  const double of_x = 2.0 * (e.y * most.z + most.y * e.z + e.y * e.z) + 16.0 * ROUND_U * most.y * most.z;
  const double of_y = 2.0 * (e.z * most.x + most.z * e.x + e.z * e.x) + 16.0 * ROUND_U * most.z * most.x;
  const double of_z = 2.0 * (e.x * most.y + most.x * e.y + e.x * e.y) + 16.0 * ROUND_U * most.x * most.y;
  const double slack = ROUND_UP * vec_dot(s, vec(of_x, of_y, of_z)) + 1e-300;
  for (size_t k = 0; k < p->n; k++) {
    const size_t l = ccd_next(p, k);
    const double begin = vec_dot(m, vec_cross(a[k], a[l])), end = vec_dot(m, vec_cross(b[k], b[l]));
    const double middle = 0.5 * vec_dot(m, vec_add(vec_cross(a[k], b[l]), vec_cross(b[k], a[l])));
    if (!(begin > slack && middle > slack && end > slack)) return false;
  }
  return true;
}

/* How fast the point with these weights moves along a direction. */
static double ccd_rate(const ccd_polygon *p, const double *weights, vec3 direction) {
  double rate = 0.0;
  for (size_t k = 0; k < p->n; k++) rate += weights[k] * vec_dot(direction, p->by[k]);
  return rate;
}

/* At t the polygon is beyond the plane, which separates it from the origin, and close to the margin. Does it
 * come to the margin within a little time? Then *until is when it has. */
static bool ccd_comes(const ccd_polygon *p, double t, vec3 plane, double margin, const ccd_near *near, double *until) {
  vec3 a[CCD_CORNERS], b[CCD_CORNERS];
  ccd_corners(p, t, a);
  const vec3 up = ccd_unit(ccd_normal(p, a)); /* sees the corners counter-clockwise */
  const bool flipped = vec_dot(up, plane) < 0.0;
  const vec3 m = margin > 0.0 ? near->normal : flipped ? vec_neg(up) : up;
  if (margin == 0.0 && !ccd_agree(m, plane)) return false;
  const double rate = ccd_rate(p, near->weights, m);
  const double height = margin > 0.0 ? near->upper - margin : vec_dot(m, near->point);
  double step = rate < 0.0 ? (height + 4.0 * ccd_slack(p, m)) / -rate : INFINITY;
  for (int i = 0; i < CCD_TRIES && step < INFINITY && *until < 1.0; i++, step *= 2.0) {
    *until = lesser(t + step, 1.0);
    ccd_corners(p, *until, b);
    if (margin > 0.0) {
      ccd_near there;
      ccd_nearest(p, b, &there);
      if (there.upper <= margin) return true;
      continue;
    }
    const vec3 there = ccd_unit(ccd_normal(p, b));
    const vec3 down = flipped ? there : vec_neg(there);
    if (ccd_agree(vec_neg(m), down) && ccd_height(p, b, down) > 0.0 && ccd_stays_inside(p, a, b, up)) return true;
  }
  return false;
}

/* ---- the search ---- */

/* The plane is above all corners at t by `height`. Until when is a part of its clearance left, as far as is known? */
static double ccd_advance(const ccd_polygon *p, const vec3 *c, double t, vec3 plane, double height, double margin) {
  const double level = margin + ccd_slack(p, plane) + CCD_LEFT * (height - margin);
  double step = 2.0;
  for (size_t k = 0; k < p->n; k++) {
    const double rate = vec_dot(plane, p->by[k]), above = vec_dot(plane, c[k]) - level;
    if (above + rate * step < 0.0) step = above / -rate;
  }
  return lesser(t + step, 1.0);
}

static void ccd_search(const ccd_polygon *p, double margin, const cprox_options *options, ccd_near *best,
                       cprox_ccd *r) {
  vec3 c[CCD_CORNERS], plane = vec(0, 0, 0);
  double t = 0.0, held = -INFINITY, lower = INFINITY;
  uint32_t last = 0;
  bool spent = false;
  ccd_corners(p, t, c);
  *best = (ccd_near){.upper = INFINITY};
  *r = (cprox_ccd){.verdict = CPROX_VERDICT_UNDECIDED};
  while (t < 1.0) {
    ccd_near near;
    ccd_nearest(p, c, &near);
    r->nodes++;
    if (near.upper < best->upper) *best = near, r->t = t;
    if (near.upper <= margin) {
      r->verdict = CPROX_VERDICT_VIOLATED;
      break;
    }
    const double height = ccd_height(p, c, near.normal);
    if (height > held) plane = near.normal, held = height;
    if (!(held > margin)) break;
    if (near.upper - margin <= options->epsilon || held - margin <= CCD_CLOSE * ccd_slack(p, plane)) {
      double until = t;
      if (ccd_comes(p, t, plane, margin, &near, &until)) {
        r->verdict = CPROX_VERDICT_VIOLATED;
        r->t = until;
        *best = near;
        break;
      }
      if (++last > CCD_LAST) break;
    }
    if ((spent = r->nodes >= options->max_nodes)) break;
    const double next = ccd_advance(p, c, t, plane, held, margin);
    lower = lesser(lower, held);
    ccd_corners(p, next, c);
    held = ccd_height(p, c, plane);
    if (!(next > t && held > margin)) break; /* nothing is known beyond t */
    t = next;
    lower = lesser(lower, held);
  }
  r->t_contact_lower = t;
  /* t is 1 without contact: the plane is beyond the margin at the end of the last step */
  if (t == 1.0 && r->verdict != CPROX_VERDICT_VIOLATED) r->verdict = CPROX_VERDICT_CLEAR;
  if (r->verdict == CPROX_VERDICT_CLEAR) r->lower = (lower - margin) * (1.0 - 4.0 * ROUND_U);
  if (r->verdict != CPROX_VERDICT_VIOLATED) r->upper = greater(best->upper - margin, 0.0) * (1.0 + 4.0 * ROUND_U);
  if (r->verdict == CPROX_VERDICT_UNDECIDED && !(r->upper <= options->epsilon))
    r->status = spent ? CPROX_BUDGET : CPROX_PRECISION;
}

/* ---- the queries ---- */

static cprox_status ccd_validate_points(const char *when, const vec3 *points, cprox_workspace *workspace) {
  if (!points) return workspace_fail(workspace, CPROX_INVALID, "the points at the %s are NULL", when);
  for (size_t i = 0; i < 4; i++) {
    const vec3 size = ccd_size(points[i]);
    if (!(size.x <= LENGTH_MOST && size.y <= LENGTH_MOST && size.z <= LENGTH_MOST))
      return workspace_fail(workspace, CPROX_INVALID,
                            "point %zu at the %s is (%g, %g, %g), must be finite and at most %g in size", i, when,
                            points[i].x, points[i].y, points[i].z, LENGTH_MOST);
  }
  return CPROX_OK;
}

static cprox_status ccd_validate(const vec3 *start, const vec3 *end, double margin, const cprox_options *options,
                                 const cprox_ccd *ccd, cprox_workspace *workspace) {
  if (!ccd) return workspace_fail(workspace, CPROX_INVALID, "ccd is NULL: nowhere to put the answer");
  cprox_status status = validate_options(options, (arguments_query){"continuous collision detection", 0}, workspace);
  if (status == CPROX_OK) status = validate_length("margin", margin, workspace);
  if (status == CPROX_OK) status = ccd_validate_points("start", start, workspace);
  if (status == CPROX_OK) status = ccd_validate_points("end", end, workspace);
  return status;
}

static cprox_status ccd_conclude(cprox_ccd *found, const ccd_near *near, cprox_workspace *workspace, cprox_ccd *ccd) {
  found->normal = vec_neg(near->normal);
  *ccd = *found;
  if (ccd->status != CPROX_OK) workspace_fail(workspace, ccd->status, "%s", cprox_status_text(ccd->status));
  return ccd->status;
}

cprox_status cprox_ccd_vertex_face(const cprox_vec3 start[4], const cprox_vec3 end[4], double margin,
                                   const cprox_options *options, cprox_workspace *workspace, cprox_ccd *ccd) {
  WORKSPACE_USE(workspace);
  workspace_clear(workspace);
  const cprox_options asked = validate_defaults(options);
  const cprox_status status = ccd_validate(start, end, margin, &asked, ccd, workspace);
  if (status != CPROX_OK) return status;
  vec3 from[3], to[3];
  for (size_t k = 0; k < 3; k++) from[k] = vec_sub(start[k + 1], start[0]), to[k] = vec_sub(end[k + 1], end[0]);
  ccd_polygon p;
  ccd_polygon_set(from, to, 3, &p);
  ccd_near near;
  cprox_ccd found;
  ccd_search(&p, margin, &asked, &near, &found);
  found.weights[0] = 1.0;
  for (size_t k = 0; k < 3; k++) found.weights[k + 1] = near.weights[k];
  return ccd_conclude(&found, &near, workspace, ccd);
}

/* The corners of the difference, round it: of the ends of the second edge and those of the first. */
static void ccd_edges(const vec3 *points, vec3 *corners) {
  corners[0] = vec_sub(points[2], points[0]);
  corners[1] = vec_sub(points[3], points[0]);
  corners[2] = vec_sub(points[3], points[1]);
  corners[3] = vec_sub(points[2], points[1]);
}

cprox_status cprox_ccd_edge_edge(const cprox_vec3 start[4], const cprox_vec3 end[4], double margin,
                                 const cprox_options *options, cprox_workspace *workspace, cprox_ccd *ccd) {
  WORKSPACE_USE(workspace);
  workspace_clear(workspace);
  const cprox_options asked = validate_defaults(options);
  const cprox_status status = ccd_validate(start, end, margin, &asked, ccd, workspace);
  if (status != CPROX_OK) return status;
  vec3 from[4], to[4];
  ccd_edges(start, from);
  ccd_edges(end, to);
  ccd_polygon p;
  ccd_polygon_set(from, to, 4, &p);
  ccd_near near;
  cprox_ccd found;
  ccd_search(&p, margin, &asked, &near, &found);
  const double *w = near.weights;
  found.weights[0] = w[0] + w[1], found.weights[1] = w[2] + w[3];
  found.weights[2] = w[0] + w[3], found.weights[3] = w[1] + w[2];
  return ccd_conclude(&found, &near, workspace, ccd);
}
