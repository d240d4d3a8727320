/* SPDX-License-Identifier: BSD-3-Clause */
/* Allocation failures: every allocation of every constructor and of every query on a random scene fails once, the
 * first, then the second, until the call gets by. A call that fails says so by its status, gives back all it took and
 * leaves its output untouched; one that does without the memory answers as truly as before; the next call with the same
 * workspace answers as if nothing had been. */
#include <math.h>
#include <string.h>

#include "curve_proximity/cprox_fourier.h"
#include "scenes.h"
#include "support/counting.h"
#include "support/make_curve.h"
#include "support/of_list.h"

enum { MOST = 2000, POINTS = 8 };

/* ---- constructors ---- */

typedef struct material {
  vec3 points[POINTS];
  double flat[POINTS][2], knots[2 * POINTS];
  uint32_t triangles[POINTS][3];
  cprox_body *ball, *hull, *mesh, *quadric, *cloud;
  cprox_curve *line;
} material;

typedef union handle {
  void *any;
  cprox_body *body;
  cprox_curve *curve;
  cprox_obstacles *set;
  cprox_obstacles *batch;
  cprox_solid *solid;
} handle;

static void box_support(const void *user, const double d[3], double p[3]) {
  (void)user;
  for (int i = 0; i < 3; i++) p[i] = copysign(1.0, d[i]);
}

static void line_point(void *user, double t, cprox_vec3 *p) {
  (void)user;
  *p = vec(t, 0, 0);
}

static double line_length(void *user, double a, double b) {
  (void)user;
  return b - a;
}

static void line_jet(void *user, double t, cprox_vec3 jet[3]) {
  (void)user;
  jet[0] = vec(t, 0, 0);
  jet[1] = vec(1, 0, 0);
  jet[2] = vec(0, 0, 0);
}

static double line_sixth(void *user, double a, double b) {
  (void)user;
  (void)a;
  (void)b;
  return 0.0;
}

static void free_body(void *x) {
  cprox_body_free(x);
}

static void free_curve(void *x) {
  cprox_curve_free(x);
}

static void free_solid(void *x) {
  cprox_solid_free(x);
}

static void free_set(void *x) {
  cprox_obstacles_free(x);
}

static void free_batch(void *x) {
  cprox_obstacles_free(x);
}

enum { N_BODIES = 19, N_CURVES = 13, N_OTHERS = 9 };

static cprox_status make_body(size_t which, const material *m, cprox_workspace *ws, cprox_body **b) {
  const cprox_body *parts[2] = {m->ball, m->hull};
  const cprox_pose poses[2] = {CPROX_POSE_IDENTITY, CPROX_POSE_IDENTITY};
  const double planes[4][4] = {{-1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, -1, 0}, {1, 1, 1, -1}};
  const cprox_implicit_description d = {.planes = planes, .n_planes = 4};
  const uint32_t changed[2] = {1, 3};
  const cprox_affine map = {.linear = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  vec3 high[POINTS];
  for (int i = 0; i < POINTS; i++) high[i] = vec_add(m->points[i], vec(1, 1, 1));
  switch (which) {
    case 0: return cprox_body_create_point(m->points[0], ws, b);
    case 1: return cprox_body_create_sphere(1.0, ws, b);
    case 2: return cprox_body_create_box(vec(1, 2, 3), ws, b);
    case 3: return cprox_body_create_capsule(1, 2, ws, b);
    case 4: return cprox_body_create_cylinder(1, 2, ws, b);
    case 5: return cprox_body_create_cone(1, 2, ws, b);
    case 6: return cprox_body_create_ellipsoid(vec(1, 2, 3), ws, b);
    case 7: return cprox_body_create_halfspace(vec(0, 0, 1), 1.0, ws, b);
    case 8: return cprox_body_create_polytope(m->points, POINTS, ws, b);
    case 9: return cprox_body_create_polygon(m->flat, POINTS, ws, b);
    case 10: return cprox_body_create_compound(parts, poses, 2, ws, b);
    case 11: return cprox_body_create_support(box_support, NULL, vec(0, 0, 0), 2.0, 0.0, 0.0, ws, b);
    case 12: return cprox_body_create_superquadric(vec(1, 2, 3), vec(2, 3, 4), ws, b);
    case 13: return cprox_body_create_implicit(&d, &map, ws, b);
    case 14: return cprox_body_create_implicit(&(cprox_implicit_description){.deformed = m->quadric}, &map, ws, b);
    case 15:
      return cprox_body_create_mesh(m->points, POINTS, (const uint32_t(*)[3])m->triangles, POINTS,
                                    CPROX_MESH_FILL_SOLID, SIZE_MAX, ws, b);
    case 16: return cprox_body_create_points(m->points, POINTS, 0.1, SIZE_MAX, ws, b);
    case 17: return cprox_body_create_boxes(m->points, high, POINTS, SIZE_MAX, ws, b);
    default: return cprox_body_update_points(m->cloud, changed, high, 2, NULL, ws, b);
  }
}

static cprox_status make_curve(size_t which, const material *m, cprox_workspace *ws, cprox_curve **c) {
  const cprox_rectifiable_curve by_length = {.point = line_point, .length = line_length, .error = 1e-9};
  const cprox_smooth_curve smooth = {.evaluate = line_jet, .sixth = line_sixth, .accuracy = 1e-9};
  const cprox_quat preimage[3] = {{1, 0, 0, 0}, {0.5, 1, 0, 0}, {0, 1, 0.5, 0}};
  const cprox_curve *lines[2] = {m->line, m->line};
  const double ends[3] = {0, 1, 2};
  switch (which) {
    case 0: return curve_from(describe_bezier(m->points, POINTS, 0, 1), ws, c);
    case 1: return curve_from(describe_bspline(m->points, POINTS, 3, m->knots, POINTS + 4, 3, POINTS), ws, c);
    case 2: return curve_from(describe_polynomial(m->points, POINTS, 0, 1), ws, c);
    case 3: return curve_from(describe_legendre(m->points, POINTS, 0, 1), ws, c);
    case 4: return curve_from(describe_lagrange(m->points, m->knots, POINTS, 0, 3), ws, c);
    case 5: return curve_from(describe_trigonometric(m->points, POINTS - 1, 0, 6), ws, c);
    case 6: return curve_from(describe_clothoid(m->points[0], 0, 1, 1, 0, 2), ws, c);
    case 7: return curve_from(describe_dubins(vec(0, 0, 0), 0, vec(3, 1, 0), 1, 0.5, CPROX_DUBINS_SHORTEST), ws, c);
    case 8: return curve_from(describe_involute(m->points[0], 1, 0, 0, 3), ws, c);
    case 9: return curve_from(describe_pythagorean_hodograph(m->points[0], preimage, 3, 0, 1), ws, c);
    case 10: return curve_from(describe_smooth(&smooth, 0, 1), ws, c);
    case 11: return curve_from(describe_rectifiable(&by_length, 0, 1), ws, c);
    default: return curve_from(describe_piecewise(lines, 2, ends, INFINITY), ws, c);
  }
}

static cprox_status make_other(size_t which, const material *m, cprox_workspace *ws, handle *h) {
  const cprox_obstacle targets[2] = {cprox_obstacle_at(m->hull, CPROX_POSE_IDENTITY),
                                     cprox_obstacle_at(m->mesh, CPROX_POSE_IDENTITY)};
  switch (which) {
    case 0: return cprox_obstacles_create(targets, 2, CPROX_INDEX_BVH, ws, &h->set);
    case 1: return cprox_obstacles_create(targets, 2, CPROX_INDEX_BATCH, ws, &h->batch);
    case 2:
      return cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = 3, .radius = 1.0}, ws,
                                &h->solid);
    case 3:
      return cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 2, .size = vec(1, 2, 3)}, ws, &h->solid);
    case 4:
      return cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_ELLIPSOID, .dimension = 3, .semi_axes = vec(1, 2, 3)}, ws,
          &h->solid);
    case 5:
      return cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_CYLINDER, .height = 1, .radius = 2}, ws,
                                &h->solid);
    case 6:
      return cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_POLYGON, .corners = m->flat, .n = POINTS}, ws, &h->solid);
    case 7:
      return cprox_solid_create(
          &(cprox_solid_description){
              .kind = CPROX_SOLID_POLYLINE, .dimension = 3, .points = m->points, .n = POINTS, .radius = 0.1},
          ws, &h->solid);
    default:
      return cprox_solid_create(
          &(cprox_solid_description){
              .kind = CPROX_SOLID_SWEEP, .dimension = 3, .curve = m->line, .radius = 0.1, .tolerance = 1e-3},
          ws, &h->solid);
  }
}

static cprox_status make_any(size_t which, const material *m, cprox_workspace *ws, handle *h) {
  if (which < N_BODIES) return make_body(which, m, ws, &h->body);
  if (which < N_BODIES + N_CURVES) return make_curve(which - N_BODIES, m, ws, &h->curve);
  return make_other(which - N_BODIES - N_CURVES, m, ws, h);
}

static void (*release_of(size_t which))(void *) {
  if (which < N_BODIES) return free_body;
  if (which < N_BODIES + N_CURVES) return free_curve;
  which -= N_BODIES + N_CURVES;
  return which == 0 ? free_set : which == 1 ? free_batch : free_solid;
}

static void starve_constructor(attack *a, size_t which, const material *m) {
  attack_kind(a, "constructor %zu", which);
  for (size_t k = 0; k < MOST; k++) {
    /* the workspace is made while there is memory, and what the call leaves in it is freed with it */
    const size_t before = allocations_live();
    cprox_workspace *ws = cprox_workspace_create();
    handle h = {.any = NULL};
    allocations_fail_after(k);
    const cprox_status status = make_any(which, m, ws, &h);
    allocations_allow();
    attack_check(a, status == CPROX_OK || status == CPROX_MEMORY, "constructor %zu, allocation %zu: %s (%s)", which, k,
                 cprox_status_name(status), cprox_workspace_error(ws));
    attack_check(a, (status == CPROX_OK) == (h.any != NULL), "constructor %zu, allocation %zu: %s with handle %d",
                 which, k, cprox_status_name(status), h.any != NULL);
    if (status == CPROX_MEMORY)
      attack_check(a, cprox_workspace_error(ws)[0], "constructor %zu, allocation %zu: no reason", which, k);
    if (h.any) release_of(which)(h.any);
    cprox_workspace_free(ws);
    attack_check(a, allocations_live() == before, "constructor %zu, allocation %zu: %zd blocks are left", which, k,
                 (ptrdiff_t)(allocations_live() - before));
    if (status == CPROX_OK || attack_failed(a)) return;
  }
}

static bool make_material(attack *a, rng *r, material *m) {
  memset(m, 0, sizeof *m);
  for (int i = 0; i < POINTS; i++) {
    m->points[i] = rng_in_cube(r, 1.0);
    m->flat[i][0] = cos(6.28 * i / POINTS);
    m->flat[i][1] = sin(6.28 * i / POINTS);
    for (int k = 0; k < 3; k++) m->triangles[i][k] = (uint32_t)rng_index(r, POINTS);
  }
  for (int i = 0; i < 2 * POINTS; i++) m->knots[i] = i;
  const vec3 ends[2] = {m->points[0], m->points[1]};
  cprox_body_create_sphere(1.0, a->ws, &m->ball);
  cprox_body_create_polytope(m->points, POINTS, a->ws, &m->hull);
  cprox_body_create_mesh(m->points, POINTS, (const uint32_t(*)[3])m->triangles, POINTS, CPROX_MESH_FILL_SURFACE,
                         SIZE_MAX, a->ws, &m->mesh);
  cprox_body_create_superquadric(vec(1, 2, 3), vec(2, 3, 4), a->ws, &m->quadric);
  cprox_body_create_points(m->points, POINTS, 0.0, SIZE_MAX, a->ws, &m->cloud);
  curve_from(describe_bezier(ends, 2, 0, 1), a->ws, &m->line);
  return m->ball && m->hull && m->mesh && m->quadric && m->cloud && m->line;
}

static void free_material(material *m) {
  cprox_body_free(m->ball);
  cprox_body_free(m->hull);
  cprox_body_free(m->mesh);
  cprox_body_free(m->quadric);
  cprox_body_free(m->cloud);
  cprox_curve_free(m->line);
}

/* ---- queries ---- */

enum { N_QUERIES = 9, NEAREST = 4 };

static cprox_status ask(const scene *s, size_t query, const cprox_options *o, cprox_workspace *ws,
                        cprox_result x[SCENE_OBSTACLES]) {
  size_t count = 0;
  cprox_options with = *o;
  switch (query) {
    case 0: return cprox_distance(s->mover, s->targets[0], o, ws, x);
    case 1: return tolerance_of_list(s->mover, s->targets, s->n, s->scale, o, ws, x, NULL);
    case 2: return collision_of_list(s->mover, s->targets, s->n, o, ws, x, NULL);
    case 3: return time_of_contact_of_list(s->mover, s->targets, s->n, o, ws, x);
    case NEAREST: return nearest_of_list(s->mover, s->targets, s->n, 1, o, ws, x, &count);
    case 5: return distance_of_list(s->mover, s->targets, s->n, o, ws, x, NULL);
    case 6: with.signed_distance = true; return cprox_distance(s->mover, s->targets[0], &with, ws, x);
    case 7: {
      cprox_certificate *certificate = cprox_certificate_create();
      with.certificate = certificate;
      const cprox_status status =
          certificate ? distance_of_list(s->mover, s->targets, s->n, &with, ws, x, NULL) : CPROX_MEMORY;
      cprox_certificate_free(certificate);
      return status;
    }
    default: return cprox_pair(s->targets[0], s->targets[s->n - 1], o, ws, x);
  }
}

static void starve_query(attack *a, const scene *s, size_t query, const cprox_options *o) {
  attack_kind(a, "query %zu", query);
  cprox_result full[SCENE_OBSTACLES], x[SCENE_OBSTACLES], untouched[SCENE_OBSTACLES];
  memset(untouched, 0xA5, sizeof untouched);
  memset(full, 0xA5, sizeof full);
  cprox_workspace *fresh = cprox_workspace_create();
  const cprox_status asked = fresh ? ask(s, query, o, fresh, full) : CPROX_INVALID;
  cprox_workspace_free(fresh);
  if (asked < 0) {
    attack_count(a, "refused");
    return;
  }
  for (size_t k = 0; k < MOST; k++) {
    const size_t before = allocations_live();
    cprox_workspace *ws = cprox_workspace_create();
    memcpy(x, untouched, sizeof x);
    const size_t made = allocations_made();
    allocations_fail_after(k);
    const cprox_status status = ask(s, query, o, ws, x);
    allocations_allow();
    const bool starved = allocations_made() - made > k;
    if (status == CPROX_MEMORY) {
      attack_check(a, memcmp(x, untouched, sizeof x) == 0,
                   "query %zu, allocation %zu: memory, but the result was written", query, k);
      attack_check(a, ask(s, query, o, ws, x) == asked, "query %zu, allocation %zu: the next query is not answered",
                   query, k);
    } else if (status < 0 && strstr(cprox_workspace_error(ws), "support")) {
      /* without its tables the search asks in other directions, and an implicit body may know no support along one of
       * them */
      attack_count(a, "no support of an implicit body");
      memcpy(x, full, sizeof x);
    } else {
      attack_check(a, status >= 0, "query %zu, allocation %zu: %s (%s)", query, k, cprox_status_name(status),
                   cprox_workspace_error(ws));
    }
    /* which obstacle is the nearest is told up to epsilon */
    const double either = query == NEAREST ? o->epsilon : 0.0;
    attack_check(a, x->lower <= full->upper + either && full->lower <= x->upper + either,
                 "query %zu, allocation %zu: [%.17g, %.17g], and with memory [%.17g, %.17g]", query, k, x->lower,
                 x->upper, full->lower, full->upper);
    cprox_workspace_free(ws);
    attack_check(a, allocations_live() == before, "query %zu, allocation %zu: %zd blocks are left", query, k,
                 (ptrdiff_t)(allocations_live() - before));
    if (!starved || attack_failed(a)) return;
  }
}

static void one_case(attack *a, rng *r) {
  static scene s;
  static material m;
  if (rng_index(r, 4) == 0) {
    if (make_material(a, r, &m)) starve_constructor(a, rng_index(r, N_BODIES + N_CURVES + N_OTHERS), &m);
    free_material(&m);
    return;
  }
  if (scene_make(a, r, &s)) {
    cprox_options o = CPROX_OPTIONS_DEFAULT;
    o.epsilon = 1e-3 * s.scale;
    o.max_nodes = 100;
    starve_query(a, &s, rng_index(r, N_QUERIES), &o);
  }
  scene_free(&s);
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "starve", one_case);
}
