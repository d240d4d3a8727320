/* SPDX-License-Identifier: BSD-3-Clause */
/* Points inside hulls: on faces, edges, vertices, diagonals, planes through vertices, or a hair beside them. The
 * reference is the nearest of the hull's planes in quadruple precision, which loses nothing of the products of doubles:
 * all planes through three vertices of small hulls that have the others on one side, the known faces of bipyramids and
 * their like of up to 600 vertices. */
#include <float.h>
#include <string.h>

#include "attack.h"
#include "base/rounding.h"
#include "support/make_curve.h"
#include "support/quad.h"
#include "support/reference.h"

enum { MOST_VERTICES = 602, MOST_FACES = 1200 };

typedef struct hull {
  const char *name;
  vec3 v[MOST_VERTICES];
  size_t n;
  int face[MOST_FACES][3]; /* known faces; none: all planes are tried */
  size_t n_faces;
  double size;     /* max |v| */
  double apart[3]; /* what its axes were scaled by */
  cprox_body *body;
} hull;

static quad3 q_sub(vec3 a, vec3 b) {
  return (quad3){{(quad)a.x - (quad)b.x, (quad)a.y - (quad)b.y, (quad)a.z - (quad)b.z}};
}
static quad q_dot(quad3 a, quad3 b) {
  return a.k[0] * b.k[0] + a.k[1] * b.k[1] + a.k[2] * b.k[2];
}
static quad3 q_cross(quad3 a, quad3 b) {
  return (quad3){
      {a.k[1] * b.k[2] - a.k[2] * b.k[1], a.k[2] * b.k[0] - a.k[0] * b.k[2], a.k[0] * b.k[1] - a.k[1] * b.k[0]}};
}

/* By Newton's method from a double: the libraries of quadruple precision are not everywhere. */
static quad q_root(quad x) {
  if (!(x > 0)) return 0;
  int exponent = 0;
  while (x > 1e200) x *= (quad)0x1p-200, exponent += 100;
  while (x < 1e-200) x *= (quad)0x1p200, exponent -= 100;
  quad root = (quad)sqrt((double)x);
  for (int i = 0; i < 3; i++) root = (root + x / root) / 2;
  return root * (quad)ldexp(1.0, exponent);
}

/* ---- hulls ---- */

/* Vertices, scaled along the axes, turned, and shifted; each is rounded, and the hull is that of the rounded ones. */
static void place(rng *r, hull *h) {
  const double scale = rng_log_uniform(r, 1e-4, 1e4), aspect = rng_index(r, 3) ? 4.0 : 1e3;
  const cprox_pose pose = rng_pose(r, rng_index(r, 3) ? 0.0 : 3.0 * scale);
  const bool turned = rng_index(r, 2) == 0;
  for (int i = 0; i < 3; i++) h->apart[i] = scale * rng_log_uniform(r, 1.0 / aspect, 1.0);
  if (rng_index(r, 3) == 0) h->apart[1] = h->apart[2] = h->apart[0];
  for (size_t i = 0; i < h->n; i++) {
    vec3 v = vec(h->v[i].x * h->apart[0], h->v[i].y * h->apart[1], h->v[i].z * h->apart[2]);
    const vec3l w = ref_to_world(&pose, ref_vec(v));
    if (turned) v = vec((double)w.x, (double)w.y, (double)w.z);
    h->v[i] = v;
    h->size = fmax(h->size, vec_norm(v));
  }
}

static void make_random(rng *r, hull *h) {
  h->name = "random";
  h->n = 4 + rng_index(r, 6);
  for (size_t i = 0; i < h->n; i++) h->v[i] = rng_index(r, 2) ? rng_unit(r) : rng_in_cube(r, 1.0);
}

static void make_box(hull *h) {
  h->name = "box";
  h->n = 8;
  for (int i = 0; i < 8; i++) h->v[i] = vec(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
}

/* Two apexes over and under a regular polygon. */
static void make_bipyramid(rng *r, hull *h) {
  const size_t k = rng_index(r, 50) == 0 ? 3 + rng_index(r, 598) : rng_index(r, 2) ? 4 : 3 + rng_index(r, 10);
  h->name = k > 100 ? "large bipyramid" : k == 4 ? "octahedron" : "bipyramid";
  for (size_t i = 0; i < k; i++) {
    const double angle = 6.283185307179586 * (double)i / (double)k;
    h->v[h->n++] = k == 4 ? vec(i == 0   ? 1
                                : i == 2 ? -1
                                         : 0,
                                i == 1   ? 1
                                : i == 3 ? -1
                                         : 0,
                                0)
                          : vec(cos(angle), sin(angle), 0);
  }
  h->v[h->n++] = vec(0, 0, 1);
  h->v[h->n++] = vec(0, 0, -1);
  for (size_t i = 0; i < 2 * k; i++) {
    int *face = h->face[h->n_faces++];
    face[0] = (int)(i % k), face[1] = (int)((i + 1) % k), face[2] = (int)(k + i / k);
  }
}

/* ---- the reference ---- */

/* The height of p over the plane, positive outside; false where vertices lie on both sides by more than quadruple
 * precision leaves open, or the plane is none. */
static bool height_over(const hull *h, const int face[3], bool known, vec3 p, quad *height) {
  const vec3 a = h->v[face[0]];
  const quad3 normal = q_cross(q_sub(h->v[face[1]], a), q_sub(h->v[face[2]], a));
  const quad length = q_root(q_dot(normal, normal));
  if (!(length > (quad)1e-20 * (quad)(h->size * h->size))) return false;
  const quad hair = (quad)1e-28 * (quad)h->size * length;
  bool above = false, below = false;
  for (size_t i = 0; i < h->n && !(known && (above || below)); i++) {
    const quad side = q_dot(normal, q_sub(h->v[i], a));
    above |= side > hair, below |= side < -hair;
  }
  if (above == below) return false;
  const quad side = q_dot(normal, q_sub(p, a)) / length;
  *height = below ? side : -side;
  return true;
}

/* The greatest height over a plane of the hull: minus the depth inside, at most the distance outside. False where the
 * hull is flat. */
static bool reference(const hull *h, vec3 p, quad *distance) {
  bool found = false;
  quad height = 0;
  *distance = -(quad)DBL_MAX;
  for (size_t f = 0; f < h->n_faces; f++)
    if (height_over(h, h->face[f], true, p, &height)) {
      found = true;
      if (height > *distance) *distance = height;
    }
  if (h->n_faces > 0) return found;
  for (int i = 0; i < (int)h->n; i++)
    for (int j = i + 1; j < (int)h->n; j++)
      for (int k = j + 1; k < (int)h->n; k++)
        if (height_over(h, (const int[3]){i, j, k}, false, p, &height)) {
          found = true;
          if (height > *distance) *distance = height;
        }
  return found;
}

/* ---- points ---- */

/* The mean of one to four vertices, or anything between them; or a hair beside that. */
static vec3 any_point(rng *r, const hull *h) {
  const size_t among = 1 + rng_index(r, 4);
  const bool even = rng_index(r, 4) != 0;
  vec3 p = vec(0, 0, 0);
  double sum = 0.0;
  for (size_t i = 0; i < among; i++) {
    const double weight = even ? 1.0 : rng_uniform(r, 0.0, 1.0);
    p = vec_axpy(p, weight, h->v[rng_index(r, h->n)]);
    sum += weight;
  }
  p = vec_scale(1.0 / sum, p);
  if (rng_index(r, 6) == 0) { /* the middle of all */
    p = vec(0, 0, 0);
    for (size_t i = 0; i < h->n; i++) p = vec_axpy(p, 1.0 / (double)h->n, h->v[i]);
  }
  if (rng_index(r, 2)) return p;
  return vec_axpy(p, fmin(h->apart[0], fmin(h->apart[1], h->apart[2])) * rng_log_uniform(r, 1e-16, 1e-1), rng_unit(r));
}

static void check_nearest(attack *t, const hull *h, vec3 p, quad wanted) {
  const double room = 64.0 * ROUND_U * (vec_norm(p) + h->size);
  vec3 at;
  const double d = cprox_body_nearest(h->body, p, &at);
  const double off = (double)((quad)d - wanted);
  if (!attack_check(t, wanted > 0 ? d > -room : fabs(off) <= room,
                    "nearest: %.17g, truth %.17g, off by %.3g units of 2^-53 (|p| + size), %zu vertices", d,
                    (double)wanted, off / (ROUND_U * (vec_norm(p) + h->size)), h->n))
    return;
  quad there;
  if (wanted > 0 || !reference(h, at, &there)) return;
  attack_check(t, fabs(vec_norm(vec_sub(at, p)) + d) <= 2.0 * room && fabs((double)there) <= 2.0 * room,
               "the nearest point is %.17g away and %.17g off the surface, distance %.17g", vec_norm(vec_sub(at, p)),
               (double)there, d);
}

/* A curve through the point: that it collides is proven at once. */
static void check_curve(attack *t, rng *r, const hull *h, vec3 p, quad wanted) {
  if (!(wanted < -(quad)(1e-9 * (h->size + vec_norm(p))))) return;
  const vec3 along = vec_scale(4.0 * h->size, rng_index(r, 2) ? rng_unit(r) : vec(0, 0, 1));
  const vec3 points[3] = {vec_sub(p, along), p, vec_add(p, along)};
  cprox_curve *curve = NULL;
  cprox_status status = curve_from(describe_bezier(points, 3, 0.0, 1.0), t->ws, &curve);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-9 * h->size;
  options.max_nodes = 2000;
  cprox_result result = {0};
  if (status >= 0)
    status = cprox_collision(cprox_point_along(curve), cprox_obstacle_at(h->body, CPROX_POSE_IDENTITY), &options, t->ws,
                             &result);
  attack_check(t, status == CPROX_OK && result.verdict == CPROX_VERDICT_VIOLATED,
               "curve: [%.17g, %.17g] after %u nodes, depth %.17g", result.lower, result.upper, (unsigned)result.nodes,
               (double)-wanted);
  cprox_curve_free(curve);
}

static void one_case(attack *t, rng *r) {
  static hull h;
  memset(&h, 0, sizeof h);
  switch (rng_index(r, 3)) {
    case 0: make_random(r, &h); break;
    case 1: make_box(&h); break;
    default: make_bipyramid(r, &h);
  }
  place(r, &h);
  attack_kind(t, "%s", h.name);
  const vec3 p = any_point(r, &h);
  quad wanted;
  if (cprox_body_create_polytope(h.v, h.n, t->ws, &h.body) < 0) {
    attack_fail(t, "%s", cprox_workspace_error(t->ws));
  } else if (reference(&h, p, &wanted)) {
    check_nearest(t, &h, p, wanted);
    if (rng_index(r, 4) == 0) check_curve(t, r, &h, p, wanted);
  } else {
    attack_count(t, "flat");
  }
  cprox_body_free(h.body);
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "inside", one_case);
}
