/* SPDX-License-Identifier: BSD-3-Clause */
/* How random bodies are made. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bodies.h"

enum { GRID = 1 << 17 };

/* A power of two near x: products of grid numbers with it are exact. */
static double even_scale(double x) {
  return ldexp(1.0, ilogb(x));
}

static double grid(rng *r) {
  return (double)((int)rng_index(r, 2 * GRID + 1) - GRID) / GRID;
}

/* Sizes: mostly round, sometimes flat or thin. */
static vec3 sizes(rng *r, double scale) {
  const double least = rng_index(r, 8) ? 0.05 : 1e-3;
  return vec(scale * rng_log_uniform(r, least, 1.0), scale * rng_log_uniform(r, least, 1.0),
             scale * rng_log_uniform(r, least, 1.0));
}

/* ---- hulls ---- */

/* Every triple of points with all others on one side. Coordinates are on a grid on which this is exact. */
static void find_facets(part *f) {
  f->full = false;
  f->m = 0;
  for (size_t i = 0; i < f->n; i++)
    for (size_t j = i + 1; j < f->n; j++)
      for (size_t k = j + 1; k < f->n; k++) {
        const vec3l a = ref_vec(f->points[i]);
        const vec3l n = ref_cross(ref_sub(ref_vec(f->points[j]), a), ref_sub(ref_vec(f->points[k]), a));
        long double low = 0.0L, high = 0.0L;
        for (size_t v = 0; v < f->n; v++) {
          const long double d = ref_dot(n, ref_sub(ref_vec(f->points[v]), a));
          low = fminl(low, d);
          high = fmaxl(high, d);
        }
        if ((low < 0.0L && high > 0.0L) || ref_norm(n) == 0.0L) continue;
        f->full = f->full || low < 0.0L || high > 0.0L;
        const uint32_t order[3] = {(uint32_t)i, (uint32_t)(high > 0.0L ? k : j), (uint32_t)(high > 0.0L ? j : k)};
        memcpy(f->triangles[f->m++], order, sizeof order);
      }
}

/* Points of a hull: anything from one point to twelve, collinear, coplanar, bipyramids, some twice. */
static void hull_points(rng *r, double scale, part *f) {
  const double unit = even_scale(scale);
  const vec3 away =
      rng_index(r, 3) ? vec(0, 0, 0) : vec(2.0 * unit * grid(r), 2.0 * unit * grid(r), 2.0 * unit * grid(r));
  const vec3 aspect = vec(1.0, rng_index(r, 6) ? 1.0 : 0x1p-8, rng_index(r, 6) ? 1.0 : 0x1p-8);
  const size_t pattern = rng_index(r, 9);
  f->n = pattern == 0 ? 1 + rng_index(r, 3) : 4 + rng_index(r, BODY_POINTS - 3);
  if (pattern == 1) f->n = 6;
  for (size_t i = 0; i < f->n; i++) {
    vec3 p = vec(grid(r), grid(r), grid(r));
    if (pattern == 1)
      p = vec((i / 2 == 0) * (i % 2 ? -1.0 : 1.0), (i / 2 == 1) * (i % 2 ? -1.0 : 1.0),
              (i / 2 == 2) * (i % 2 ? -1.0 : 1.0));
    if (pattern == 2) p = vec(p.x, p.x, 0.5 * p.x);
    if (pattern == 3) p.z = 0.0;
    if (pattern == 4) p = vec(copysign(1.0, p.x), copysign(1.0, p.y), copysign(1.0, p.z));
    if (pattern == 5 && i > 3 && i % 2) p = vec(1, 0, 0);
    f->points[i] = vec(unit * (away.x / unit + p.x * aspect.x), unit * (away.y / unit + p.y * aspect.y),
                       unit * (away.z / unit + p.z * aspect.z));
  }
  find_facets(f);
}

static void make_hull(attack *a, rng *r, double scale, random_body *b) {
  part *f = b->parts;
  f->form = FORM_HULL;
  hull_points(r, scale, f);
  cprox_body_create_polytope(f->points, f->n, a->ws, &b->body);
  snprintf(b->name, sizeof b->name, f->full ? "polytope" : "flat polytope");
  b->depth = f->full;
}

static void make_polygon(attack *a, rng *r, double scale, random_body *b) {
  part *f = b->parts;
  double flat[BODY_POINTS][2];
  f->form = FORM_HULL;
  f->n = 3 + rng_index(r, BODY_POINTS - 3);
  const double unit = even_scale(scale) / GRID, turn = rng_index(r, 2) ? 1.0 : -1.0;
  const vec3 half = vec(GRID * rng_uniform(r, 0.05, 1.0), GRID * rng_uniform(r, 0.05, 1.0), 0.0);
  for (size_t i = 0; i < f->n; i++) {
    const double angle = turn * 6.283185307 * ((double)i + 0.4 * rng_uniform(r, 0.0, 1.0)) / (double)f->n;
    f->points[i] = vec(unit * nearbyint(half.x * cos(angle)), unit * nearbyint(half.y * sin(angle)), 0.0);
    flat[i][0] = f->points[i].x;
    flat[i][1] = f->points[i].y;
  }
  find_facets(f);
  cprox_body_create_polygon((const double(*)[2])flat, f->n, a->ws, &b->body);
  snprintf(b->name, sizeof b->name, "polygon");
}

/* ---- bodies about an axis, boxes, balls ---- */

static void make_round(attack *a, rng *r, double scale, random_body *b, form which) {
  part *f = b->parts;
  f->form = which;
  f->size = sizes(r, scale);
  const double radius = f->size.x, height = 2.0 * f->size.z;
  if (which == FORM_CAPSULE) cprox_body_create_capsule(height, radius, a->ws, &b->body);
  if (which == FORM_CYLINDER) cprox_body_create_cylinder(height, radius, a->ws, &b->body);
  if (which == FORM_CONE) cprox_body_create_cone(height, radius, a->ws, &b->body);
  snprintf(b->name, sizeof b->name, which == FORM_CAPSULE ? "capsule" : which == FORM_CYLINDER ? "cylinder" : "cone");
  b->depth = true;
}

static void make_balls(attack *a, rng *r, double scale, random_body *b, size_t n) {
  part *f = b->parts;
  f->form = FORM_BALLS;
  f->size = sizes(r, scale);
  if (n > 1 && rng_index(r, 4) == 0) f->size.x = 0.0;
  for (f->n = 0; f->n < n; f->n++) f->points[f->n] = n == 1 ? vec(0, 0, 0) : rng_in_cube(r, scale);
  if (n == 1)
    cprox_body_create_sphere(f->size.x, a->ws, &b->body);
  else
    cprox_body_create_points(f->points, n, f->size.x, SIZE_MAX, a->ws, &b->body);
  snprintf(b->name, sizeof b->name, n == 1 ? "sphere" : "points");
  b->depth = n == 1;
}

static void make_boxes(attack *a, rng *r, double scale, random_body *b, size_t n) {
  part *f = b->parts;
  f->form = FORM_BOXES;
  for (f->n = 0; f->n < n; f->n++) {
    const vec3 half = sizes(r, scale), centre = n == 1 ? vec(0, 0, 0) : rng_in_cube(r, scale);
    f->points[f->n] = vec_sub(centre, half);
    f->high[f->n] = vec_add(centre, half);
  }
  if (n == 1)
    cprox_body_create_box(vec_scale(2.0, f->high[0]), a->ws, &b->body);
  else
    cprox_body_create_boxes(f->points, f->high, n, SIZE_MAX, a->ws, &b->body);
  snprintf(b->name, sizeof b->name, n == 1 ? "box" : "boxes");
  b->depth = n == 1;
}

static void make_halfspace(attack *a, rng *r, double scale, random_body *b) {
  part *f = b->parts;
  f->form = FORM_HALFSPACE;
  f->size = vec_scale(rng_log_uniform(r, 1e-3, 1e3), rng_unit(r));
  f->offset = vec_norm(f->size) * rng_uniform(r, -scale, scale);
  cprox_body_create_halfspace(f->size, f->offset, a->ws, &b->body);
  snprintf(b->name, sizeof b->name, "halfspace");
  b->depth = true;
}

/* ---- ellipsoids, superquadrics, implicit bodies, callbacks ---- */

static void make_power(rng *r, double scale, random_body *b, bool round) {
  part *f = b->parts;
  f->form = FORM_POWER;
  f->size = sizes(r, scale);
  f->exponents = vec(2, 2, 2);
  if (!round)
    f->exponents =
        vec(rng_uniform(r, 1.0, 4.0), rng_uniform(r, 1.0, 4.0), rng_index(r, 3) ? 2.0 : rng_log_uniform(r, 1.0, 30.0));
  if (!round && rng_index(r, 6) == 0) f->exponents = vec(1, 1, 1);
}

static void make_ellipsoid(attack *a, rng *r, double scale, random_body *b) {
  make_power(r, scale, b, true);
  cprox_body_create_ellipsoid(b->parts->size, a->ws, &b->body);
  snprintf(b->name, sizeof b->name, "ellipsoid");
}

static void make_superquadric(attack *a, rng *r, double scale, random_body *b) {
  make_power(r, scale, b, false);
  cprox_body_create_superquadric(b->parts->size, b->parts->exponents, a->ws, &b->body);
  snprintf(b->name, sizeof b->name, "superquadric");
}

/* The rotation of a quaternion as a row-major matrix, times s. */
static void rotation_matrix(cprox_quat q, double s, double m[9]) {
  const cprox_pose pose = {.orientation = q};
  for (int c = 0; c < 3; c++) {
    const vec3l x = ref_to_world(&pose, (vec3l){c == 0, c == 1, c == 2});
    m[c] = (double)x.x * s;
    m[3 + c] = (double)x.y * s;
    m[6 + c] = (double)x.z * s;
  }
}

/* One hyperquadric under a rotation and a shift, a quadric, or the planes of a tetrahedron. */
static void make_implicit(attack *a, rng *r, double scale, random_body *b) {
  part *f = b->parts;
  make_power(r, scale, b, false);
  const size_t pattern = rng_index(r, 3);
  double terms[3][5] = {{1.0 / f->size.x, 0, 0, 0, f->exponents.x},
                        {0, 1.0 / f->size.y, 0, 0, f->exponents.y},
                        {0, 0, 1.0 / f->size.z, 0, f->exponents.z}};
  const cprox_hyperquadric power = {.terms = (const double(*)[5])terms, .n_terms = 3};
  const double quadric[10] = {1.0 / (f->size.x * f->size.x),
                              0,
                              0,
                              1.0 / (f->size.y * f->size.y),
                              0,
                              1.0 / (f->size.z * f->size.z),
                              0,
                              0,
                              0,
                              -1};
  const double unit = even_scale(scale);
  const double planes[4][4] = {{-1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, -1, 0}, {1, 1, 1, -unit}};
  cprox_implicit_description d = {.hyperquadrics = &power, .n_hyperquadrics = 1};
  if (pattern == 1) {
    f->exponents = vec(2, 2, 2);
    d = (cprox_implicit_description){.quadrics = (const double(*)[10])quadric, .n_quadrics = 1};
  }
  if (pattern == 2) {
    *f = (part){
        .form = FORM_HULL, .n = 4, .pose = f->pose, .points = {{0, 0, 0}, {unit, 0, 0}, {0, unit, 0}, {0, 0, unit}}};
    find_facets(f);
    d = (cprox_implicit_description){.planes = planes, .n_planes = 4};
  }
  cprox_affine map;
  f->pose = rng_pose(r, scale);
  rotation_matrix(f->pose.orientation, 1.0, map.linear);
  map.translation = f->pose.position;
  cprox_body_create_implicit(&d, &map, a->ws, &b->body);
  snprintf(b->name, sizeof b->name, "implicit");
  b->slack = 1e-11 * scale;
}

static void box_support(const void *user, const double d[3], double p[3]) {
  const double *half = user;
  for (int i = 0; i < 3; i++) p[i] = d[i] < 0.0 ? -half[i] : half[i];
}

static void ball_support(const void *user, const double d[3], double p[3]) {
  const double *radius = user, length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  for (int i = 0; i < 3; i++) p[i] = radius[0] * d[i] / length;
}

/* A box by its corners, or a ball, with or without a margin. */
static void make_support(attack *a, rng *r, double scale, random_body *b) {
  part *f = b->parts;
  const vec3 half = sizes(r, scale);
  const bool round = rng_index(r, 3) == 0;
  f->margin = rng_index(r, 2) ? 0.0 : scale * rng_uniform(r, 0.0, 0.5);
  f->form = round ? FORM_BALLS : FORM_BOXES;
  f->n = 1;
  f->size = half;
  if (!round) {
    f->points[0] = vec_neg(half);
    f->high[0] = half;
  }
  memcpy(b->callback, &half, sizeof half);
  cprox_body_create_support(round ? ball_support : box_support, b->callback, vec(0, 0, 0), 2.0 * scale,
                            round ? 1e-12 * scale : 0.0, f->margin, a->ws, &b->body);
  snprintf(b->name, sizeof b->name, "callback");
}

/* ---- meshes, compounds ---- */

static void make_mesh(attack *a, rng *r, double scale, random_body *b, bool lod) {
  part *f = b->parts;
  f->form = FORM_MESH;
  const bool solid = rng_index(r, 2);
  if (solid || lod) {
    do hull_points(r, scale, f);
    while (!f->full);
  }
  /* a hull's facets are closed where no four points lie in a plane; else the core makes a surface of it */
  if (!solid) {
    if (!lod)
      for (f->n = 0; f->n < BODY_POINTS; f->n++) f->points[f->n] = rng_in_cube(r, scale);
    f->m = 1 + rng_index(r, 16);
    for (size_t i = 0; i < f->m; i++)
      for (size_t k = 0; k < 3; k++) f->triangles[i][k] = (uint32_t)rng_index(r, f->n);
  }
  cprox_body *mesh = NULL;
  cprox_body_create_mesh(f->points, f->n, (const uint32_t(*)[3])f->triangles, f->m,
                         solid && !lod ? CPROX_MESH_FILL_SOLID : CPROX_MESH_FILL_SURFACE, SIZE_MAX, a->ws, &mesh);
  f->full = mesh && solid && !lod && cprox_body_get_info(mesh).is_solid;
  snprintf(b->name, sizeof b->name, lod ? "lod" : f->full ? "solid mesh" : "mesh");
  if (!lod) {
    b->body = mesh;
    return;
  }
  b->owned[0] = mesh;
  cprox_body_create_polytope(f->points, f->n, a->ws, &b->owned[1]);
  if (mesh && b->owned[1]) cprox_body_create_lod(b->owned[1], 0.0, mesh, a->ws, &b->body);
}

static void make_kind(attack *a, rng *r, size_t kind, double scale, random_body *b);

static void make_compound(attack *a, rng *r, double scale, random_body *b) {
  const cprox_body *parts[BODY_PARTS];
  cprox_pose poses[BODY_PARTS];
  const size_t n = 1 + rng_index(r, BODY_PARTS);
  b->depth = true;
  for (size_t i = 0; i < n; i++) {
    random_body one = {.n_parts = 1, .parts = {{.pose = CPROX_POSE_IDENTITY}}};
    make_kind(a, r, rng_index(r, 8), scale, &one);
    parts[i] = b->owned[i] = one.body;
    if (!one.body) return;
    b->parts[i] = one.parts[0];
    poses[i] = b->parts[i].pose = rng_pose(r, 2.0 * scale);
    b->depth = b->depth && one.depth;
  }
  b->n_parts = n;
  cprox_body_create_compound(parts, poses, n, a->ws, &b->body);
  snprintf(b->name, sizeof b->name, "compound");
}

/* The first eight may be parts of a compound, the first thirteen are convex and bounded. */
static void make_kind(attack *a, rng *r, size_t kind, double scale, random_body *b) {
  switch (kind) {
    case 0: make_balls(a, r, scale, b, 1); break;
    case 1: make_boxes(a, r, scale, b, 1); break;
    case 2: make_round(a, r, scale, b, FORM_CAPSULE); break;
    case 3: make_round(a, r, scale, b, FORM_CYLINDER); break;
    case 4: make_round(a, r, scale, b, FORM_CONE); break;
    case 5:
    case 6: make_hull(a, r, scale, b); break;
    case 7: make_ellipsoid(a, r, scale, b); break;
    case 8: make_polygon(a, r, scale, b); break;
    case 9: make_support(a, r, scale, b); break;
    case 10: make_superquadric(a, r, scale, b); break;
    case 11: make_implicit(a, r, scale, b); break;
    case 12:
      b->parts->form = FORM_HULL;
      b->parts->n = 1;
      b->parts->points[0] = rng_in_cube(r, scale);
      cprox_body_create_point(b->parts->points[0], a->ws, &b->body);
      snprintf(b->name, sizeof b->name, "point");
      break;
    case 13:
    case 14: make_compound(a, r, scale, b); break;
    case 15: make_halfspace(a, r, scale, b); break;
    case 16:
    case 17: make_mesh(a, r, scale, b, false); break;
    case 18: make_mesh(a, r, scale, b, true); break;
    case 19:
    case 20: make_balls(a, r, scale, b, 2 + rng_index(r, BODY_POINTS - 1)); break;
    case 21:
    case 22: make_boxes(a, r, scale, b, 2 + rng_index(r, BODY_POINTS - 1)); break;
    default: make_hull(a, r, scale, b); break;
  }
}

size_t body_carried_kind(rng *r) {
  return rng_index(r, 15);
}

/* How far the farthest point is from the origin, at most. */
static double extent_of(const random_body *b, double scale) {
  double most = scale;
  for (size_t i = 0; i < b->n_parts; i++) {
    const part *f = &b->parts[i];
    double far = f->form == FORM_HALFSPACE ? 0.0 : f->form == FORM_CAPSULE ? f->size.x + f->size.z : vec_norm(f->size);
    for (size_t v = 0; v < f->n; v++) {
      const vec3 p = f->points[v], q = f->form == FORM_BOXES ? f->high[v] : p;
      const vec3 corner = vec(fmax(fabs(p.x), fabs(q.x)), fmax(fabs(p.y), fabs(q.y)), fmax(fabs(p.z), fabs(q.z)));
      far = fmax(far, vec_norm(corner) + (f->form == FORM_BALLS ? f->size.x : 0.0));
    }
    far += f->margin;
    most = fmax(most, far + vec_norm(f->pose.position));
  }
  return most;
}

void body_make(attack *a, rng *r, size_t kind, double scale, random_body *b) {
  memset(b, 0, sizeof *b);
  b->n_parts = 1;
  for (size_t i = 0; i < BODY_PARTS; i++) b->parts[i].pose = CPROX_POSE_IDENTITY;
  make_kind(a, r, kind, scale, b);
  b->convex = kind < 13 || kind > 22;
  b->carried = kind < 15 || kind > 22;
  b->extent = extent_of(b, scale);
  if (!b->body) attack_fail(a, "%s was refused: %s", b->name, cprox_workspace_error(a->ws));
}
