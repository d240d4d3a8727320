/* SPDX-License-Identifier: BSD-3-Clause */
/* Robots whose links are triangle meshes with hulls that reach into each other: boxes that stick through each other,
 * plates, wires, loose triangles. Along random motions the links are held against each other and against a mesh that
 * stands.
 *
 * Reference: distances of all pairs of triangles at samples of the motion, in long double, by their vertices, edges and
 * crossings; the poses are those of support/robots.h. It is off by 1e-14 of the lengths that enter, which are below 10
 * m.
 */
#include <math.h>

#include "attack.h"
#include "solve/list.h"
#include "support/reference.h"
#include "support/robots.h"

enum { MOST_TRIANGLES = 160, SAMPLES = 14, BLOCK = 8, MOST_BLOCKS = MOST_TRIANGLES / BLOCK };

static const long double ROOM = 1e-13L;

typedef struct surface {
  size_t n; /* triangles */
  vec3 corner[MOST_TRIANGLES][3];
} surface;

typedef struct box {
  vec3l low, high;
} box;

typedef struct placed_surface {
  size_t n;
  vec3l corner[MOST_TRIANGLES][3];
  box triangle[MOST_TRIANGLES], block[MOST_BLOCKS]; /* about each triangle, and about BLOCK of them in turn */
} placed_surface;

/* ---- meshes ---- */

static void add_triangle(surface *s, vec3 a, vec3 b, vec3 c) {
  if (s->n == MOST_TRIANGLES) return;
  s->corner[s->n][0] = a, s->corner[s->n][1] = b, s->corner[s->n][2] = c;
  s->n++;
}

/* A parallelogram in m by m pieces. */
static void add_sheet(surface *s, vec3 at, vec3 u, vec3 v, int m) {
  const double step = 1.0 / m;
  for (int i = 0; i < m; i++) {
    for (int k = 0; k < m; k++) {
      vec3 p[4];
      for (int j = 0; j < 4; j++) p[j] = vec_axpy(vec_axpy(at, step * (i + (j & 1)), u), step * (k + (j >> 1)), v);
      add_triangle(s, p[0], p[1], p[3]);
      add_triangle(s, p[0], p[3], p[2]);
    }
  }
}

static void add_box(surface *s, vec3 middle, const vec3 half[3]) {
  for (int side = -1; side <= 1; side += 2) {
    for (int k = 0; k < 3; k++) {
      const vec3 u = vec_scale(2.0, half[(k + 1) % 3]), v = vec_scale(2.0, half[(k + 2) % 3]);
      const vec3 corner = vec_axpy(vec_axpy(vec_axpy(middle, side, half[k]), -0.5, u), -0.5, v);
      add_sheet(s, corner, u, v, 1);
    }
  }
}

static void draw_piece(rng *r, double size, surface *s) {
  const vec3 at = rng_in_cube(r, size), u = rng_unit(r), across = vec_cross(u, rng_unit(r));
  const vec3 v = vec_scale(1.0 / vec_norm(across), across), w = vec_cross(u, v);
  switch (rng_index(r, 4)) {
    case 0: /* a box, a plate or a wire */
      add_box(s, at,
              (const vec3[3]){vec_scale(rng_log_uniform(r, 1e-3, 1.0) * size, u),
                              vec_scale(rng_log_uniform(r, 1e-3, 1.0) * size, v),
                              vec_scale(rng_log_uniform(r, 1e-3, 1.0) * size, w)});
      return;
    case 1: add_sheet(s, at, vec_scale(size, u), vec_scale(rng_log_uniform(r, 0.1, 1.0) * size, v), 4); return;
    case 2: /* thin as a hair, and one that is all one line */
      add_triangle(s, at, vec_axpy(at, size, u), vec_axpy(at, rng_log_uniform(r, 1e-9, 1e-3) * size, v));
      add_triangle(s, at, vec_axpy(at, size, w), vec_axpy(at, 0.5 * size, w));
      return;
    default:
      for (int i = 0; i < 8; i++)
        add_triangle(s, vec_add(at, rng_in_cube(r, 0.3 * size)), vec_add(at, rng_in_cube(r, 0.3 * size)),
                     vec_add(at, rng_in_cube(r, 0.3 * size)));
  }
}

static surface draw_surface(rng *r, double size) {
  surface s = {.n = 0};
  const size_t pieces = 1 + rng_index(r, 4);
  for (size_t i = 0; i < pieces; i++) draw_piece(r, size, &s);
  return s;
}

/* With its hull or without one. */
static bool make_body(attack *a, const surface *s, bool with_hull, const cprox_body *made[3]) {
  uint32_t triangles[MOST_TRIANGLES][3];
  for (uint32_t i = 0; i < s->n; i++)
    for (uint32_t k = 0; k < 3; k++) triangles[i][k] = 3 * i + k;
  cprox_body *mesh = NULL, *hull = NULL, *lod = NULL;
  bool good = cprox_body_create_mesh(s->corner[0], 3 * s->n, (const uint32_t(*)[3])triangles, s->n,
                                     CPROX_MESH_FILL_SURFACE, SIZE_MAX, a->ws, &mesh) >= 0;
  if (good && with_hull)
    good = cprox_body_create_polytope(s->corner[0], 3 * s->n, a->ws, &hull) >= 0 &&
           cprox_body_create_lod(hull, 0.0, mesh, a->ws, &lod) >= 0;
  made[0] = with_hull ? lod : mesh, made[1] = with_hull ? mesh : NULL, made[2] = hull;
  return attack_check(a, good, "%s", cprox_workspace_error(a->ws));
}

/* ---- the truth ---- */

/* Two segments, where the feet of their common normal are inside both; elsewhere an end is nearest. */
static long double inner_segments(vec3l p, vec3l q, vec3l a, vec3l b) {
  const vec3l u = ref_sub(q, p), v = ref_sub(b, a), w = ref_sub(p, a);
  const long double uu = ref_dot(u, u), uv = ref_dot(u, v), vv = ref_dot(v, v), det = uu * vv - uv * uv;
  if (!(det > 0.0L)) return INFINITY;
  const long double s = (uv * ref_dot(v, w) - vv * ref_dot(u, w)) / det,
                    t = (uu * ref_dot(v, w) - uv * ref_dot(u, w)) / det;
  if (s < 0.0L || s > 1.0L || t < 0.0L || t > 1.0L) return INFINITY;
  return ref_norm(ref_sub(ref_add(w, ref_scale(s, u)), ref_scale(t, v)));
}

static bool crosses(vec3l p, vec3l q, const vec3l c[3]) {
  const vec3l n = ref_cross(ref_sub(c[1], c[0]), ref_sub(c[2], c[0]));
  const long double from = ref_dot(n, ref_sub(p, c[0])), to = ref_dot(n, ref_sub(q, c[0]));
  if (!((from > 0.0L && to < 0.0L) || (from < 0.0L && to > 0.0L))) return false;
  const vec3l x = ref_add(p, ref_scale(from / (from - to), ref_sub(q, p)));
  for (int k = 0; k < 3; k++)
    if (ref_dot(n, ref_cross(ref_sub(c[(k + 1) % 3], c[k]), ref_sub(x, c[k]))) < 0.0L) return false;
  return true;
}

static long double triangles_apart(const vec3l a[3], const vec3l b[3]) {
  long double least = INFINITY;
  for (int i = 0; i < 3; i++) {
    if (crosses(a[i], a[(i + 1) % 3], b) || crosses(b[i], b[(i + 1) % 3], a)) return 0.0L;
    least = fminl(least, ref_point_triangle(a[i], b[0], b[1], b[2]));
    least = fminl(least, ref_point_triangle(b[i], a[0], a[1], a[2]));
    for (int k = 0; k < 3; k++) least = fminl(least, inner_segments(a[i], a[(i + 1) % 3], b[k], b[(k + 1) % 3]));
  }
  return least;
}

/* About n points. */
static box box_about(const vec3l *points, size_t n) {
  box about = {points[0], points[0]};
  for (size_t i = 1; i < n; i++) {
    about.low =
        (vec3l){fminl(about.low.x, points[i].x), fminl(about.low.y, points[i].y), fminl(about.low.z, points[i].z)};
    about.high =
        (vec3l){fmaxl(about.high.x, points[i].x), fmaxl(about.high.y, points[i].y), fmaxl(about.high.z, points[i].z)};
  }
  return about;
}

static long double boxes_apart(const box *a, const box *b) {
  const vec3l gap = {fmaxl(a->low.x - b->high.x, b->low.x - a->high.x),
                     fmaxl(a->low.y - b->high.y, b->low.y - a->high.y),
                     fmaxl(a->low.z - b->high.z, b->low.z - a->high.z)};
  return ref_norm((vec3l){fmaxl(gap.x, 0.0L), fmaxl(gap.y, 0.0L), fmaxl(gap.z, 0.0L)});
}

static void place(const surface *s, const cprox_pose *offset, const ref_pose *link, placed_surface *out) {
  out->n = s->n;
  for (size_t i = 0; i < s->n; i++) {
    for (int k = 0; k < 3; k++)
      out->corner[i][k] = ref_pose_apply(link, ref_to_world(offset, ref_vec(s->corner[i][k])));
    out->triangle[i] = box_about(out->corner[i], 3);
  }
  for (size_t i = 0; i < s->n; i += BLOCK) {
    const size_t last = i + BLOCK < s->n ? i + BLOCK : s->n;
    out->block[i / BLOCK] = box_about(out->corner[i], 3 * (last - i));
  }
}

/* Two triangles, by their numbers. */
typedef struct triangle_pair {
  size_t of_a, of_b;
} triangle_pair;

static void keep_nearer(const placed_surface *a, const placed_surface *b, triangle_pair pair, long double *least,
                        triangle_pair *nearest) {
  if (!(boxes_apart(&a->triangle[pair.of_a], &b->triangle[pair.of_b]) < *least)) return;
  const long double apart = triangles_apart(a->corner[pair.of_a], b->corner[pair.of_b]);
  if (apart < *least) *least = apart, *nearest = pair;
}

/* All pairs of triangles whose boxes come nearer than the least distance so far: first the pair that was the nearest
 * one at another time, then all. */
static long double surfaces_apart(const placed_surface *a, const placed_surface *b, triangle_pair *nearest) {
  long double least = INFINITY;
  keep_nearer(a, b, *nearest, &least, nearest);
  for (size_t i = 0; i < a->n; i += BLOCK)
    for (size_t k = 0; k < b->n; k += BLOCK) {
      if (!(boxes_apart(&a->block[i / BLOCK], &b->block[k / BLOCK]) < least)) continue;
      for (size_t of_a = i; of_a < i + BLOCK && of_a < a->n; of_a++)
        for (size_t of_b = k; of_b < k + BLOCK && of_b < b->n; of_b++)
          keep_nearer(a, b, (triangle_pair){of_a, of_b}, &least, nearest);
    }
  return least;
}

/* ---- a case ---- */

typedef struct world {
  test_robot t;
  size_t moving, other; /* geometries */
  bool obstacle;        /* the other one stands in the world */
  cprox_pose at;
  surface surfaces[2];
  triangle_pair nearest; /* at the time that was looked at last */
} world;

static long double truth_at(world *w, double time) {
  static placed_surface a, b;
  const ref_pose world_frame = {.q = {0, 0, 0, 1}};
  long double values[TEST_MAX_VARIABLES];
  ref_pose links[TEST_MAX_LINKS];
  robot_ref_values(&w->t, time, values);
  robot_ref_links(&w->t, values, links);
  const cprox_link_geometry *g = w->t.geometries;
  place(&w->surfaces[0], &g[w->moving].pose, &links[g[w->moving].link], &a);
  if (w->obstacle)
    place(&w->surfaces[1], &w->at, &world_frame, &b);
  else
    place(&w->surfaces[1], &g[w->other].pose, &links[g[w->other].link], &b);
  return surfaces_apart(&a, &b, &w->nearest) - 2.0L * w->t.margin;
}

typedef enum asked { DISTANCE, TOLERANCE, COLLISION, CONTACT } asked;

static cprox_status ask(attack *a, const world *w, const cprox_body *standing, asked kind, double delta,
                        const cprox_options *options, cprox_result *result) {
  const cprox_robot_pair pair = {(int32_t)w->moving, w->obstacle ? 0 : (int32_t)w->other};
  const cprox_mover mover =
      w->obstacle ? cprox_robot_along(w->t.motion, &pair, 1) : cprox_robot_self(w->t.motion, &pair, 1);
  cprox_obstacle obstacle = cprox_obstacle_at(standing, w->at);
  obstacle.margin = w->t.margin;
  const size_t n = w->obstacle ? 1 : 0;
  switch (kind) {
    case DISTANCE: return list_distance(mover, &obstacle, n, options, a->ws, result, NULL);
    case TOLERANCE: return list_tolerance(mover, &obstacle, n, delta, options, a->ws, result, NULL);
    case COLLISION: return list_collision(mover, &obstacle, n, options, a->ws, result, NULL);
    case CONTACT: return list_time_of_contact(mover, &obstacle, n, options, a->ws, result);
  }
  return CPROX_INVALID;
}

/* The interval, the verdict and the witness's time against samples; true where it could be asked. */
static void check(attack *a, rng *r, world *w, const cprox_body *standing) {
  static const char *const NAMES[] = {"distance", "tolerance", "collision", "time of contact"};
  static const double EPSILONS[] = {1e-2, 1e-3, 1e-4, 1e-6};
  const double t0 = cprox_motion_get_info(w->t.motion).t0, t1 = cprox_motion_get_info(w->t.motion).t1;
  long double least = INFINITY, sampled[SAMPLES];
  double times[SAMPLES];
  for (int i = 0; i < SAMPLES; i++) {
    times[i] = i == 0 ? t0 : i == 1 ? t1 : rng_uniform(r, t0, t1);
    sampled[i] = truth_at(w, times[i]);
    least = fminl(least, fmaxl(sampled[i], 0.0L));
  }
  const asked kind = (asked)rng_index(r, 4);
  const double factors[] = {0.5, 0.9, 0.99, 1.0, 1.01}, delta = factors[rng_index(r, 5)] * (double)least;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = EPSILONS[rng_index(r, 4)];
  options.max_nodes = rng_index(r, 4) ? 300 : 10;
  attack_kind(a, "%s, %s", NAMES[kind], w->obstacle ? "a mesh that stands" : "two links");
  cprox_result x;
  const cprox_status status = ask(a, w, standing, kind, delta, &options, &x);
  if (!attack_check(a, status >= 0, "%s", cprox_workspace_error(a->ws))) return;
  if (kind == CONTACT) {
    for (int i = 0; i < SAMPLES; i++)
      attack_check(a, sampled[i] > ROOM || !(times[i] < x.t_contact_lower),
                   "contact from %.17g on, but at %.17g it is %.17Lg", x.t_contact_lower, times[i], sampled[i]);
  } else {
    attack_check(a, (long double)x.lower <= least + ROOM, "lower %.17g, but a sample has %.17Lg", x.lower, least);
  }
  if (x.verdict == CPROX_VERDICT_CLEAR && kind != DISTANCE)
    attack_check(a, least > (kind == TOLERANCE ? (long double)delta : 0.0L) - ROOM, "clear, but a sample has %.17Lg",
                 least);
  if (kind == DISTANCE && status == CPROX_OK)
    attack_check(a, x.upper - x.lower <= options.epsilon * (1.0 + 1e-12), "[%.17g, %.17g]", x.lower, x.upper);
  if (status == CPROX_BUDGET) attack_count(a, "budget");
  if (kind != DISTANCE && x.verdict == CPROX_VERDICT_CLEAR) attack_count(a, "clear");
  if (kind != DISTANCE && x.verdict == CPROX_VERDICT_VIOLATED) attack_count(a, "violated");
  if (x.mover_part < 0 || !isfinite(x.upper)) return;
  const long double there = fmaxl(truth_at(w, x.t), 0.0L);
  const long double turned = 1e-9L; /* what the pose at the rounded time may be off by */
  attack_check(a, there <= (long double)x.upper + turned, "upper %.17g at %.17g, where it is %.17Lg", x.upper, x.t,
               there);
  if (kind == DISTANCE)
    attack_check(a, (long double)x.lower <= there + turned, "lower %.17g, at %.17g it is %.17Lg", x.lower, x.t, there);
}

static void one_case(attack *a, rng *r) {
  static world w;
  robot_make(r, rng_log_uniform(r, 0.02, 1.0), &w.t);
  if (rng_index(r, 4) == 0) robot_draw_motion(r, 0.2, 6 + rng_index(r, 30), &w.t);
  w.moving = 1 + rng_index(r, w.t.n_links - 1), w.other = rng_index(r, w.moving);
  w.obstacle = rng_index(r, 3) == 0;
  w.at = rng_pose(r, 0.5);
  w.nearest = (triangle_pair){0, 0};
  const bool with_hull = rng_index(r, 4) != 0;
  const cprox_body *made[2][3] = {{NULL}}, *before[2];
  const size_t geometry[2] = {w.moving, w.other};
  bool good = true;
  for (int k = 0; k < 2 && good; k++) {
    w.surfaces[k] = draw_surface(r, rng_log_uniform(r, 0.03, 0.4));
    good = make_body(a, &w.surfaces[k], with_hull, made[k]);
    before[k] = w.t.geometries[geometry[k]].body;
    if (good && (k == 0 || !w.obstacle)) w.t.geometries[geometry[k]].body = made[k][0];
  }
  if (good) {
    robot_rebuild(&w.t);
    check(a, r, &w, made[1][0]);
  }
  for (int k = 0; k < 2 && good; k++) w.t.geometries[geometry[k]].body = before[k];
  robot_free(&w.t);
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < 3; i++) cprox_body_free((cprox_body *)made[k][i]);
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "links", one_case);
}
