/* SPDX-License-Identifier: BSD-3-Clause */
#define _POSIX_C_SOURCE 200809L
#include "support/queries.h"
#include "support/make_curve.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "shape/body.h"
#include "support/meshes.h"

/* ---- curves ---- */

static void points_random(given_curve *g, rng *r, size_t n, double scale, vec3 middle) {
  const bool flat = rng_index(r, 3) == 0;
  g->n = n;
  for (size_t i = 0; i < n; i++) {
    vec3 p = rng_in_cube(r, 2.0 * scale);
    if (flat) p.z = 0.0;
    g->points[i] = vec_add(middle, p);
  }
}

static cprox_status make_bezier(given_curve *g, rng *r, double scale, vec3 middle, cprox_workspace *ws) {
  g->basis = "bezier";
  g->degree = 1 + rng_index(r, rng_index(r, 4) ? 6 : 12);
  points_random(g, r, g->degree + 1, scale, middle);
  return curve_from(describe_bezier(g->points, g->n, g->t0, g->t1), ws, &g->curve);
}

static cprox_status make_bspline(given_curve *g, rng *r, double scale, vec3 middle, cprox_workspace *ws) {
  g->basis = "bspline";
  g->degree = 1 + rng_index(r, 5);
  points_random(g, r, g->degree + 1 + rng_index(r, 12), scale, middle);
  g->n_knots = g->n + g->degree + 1;
  double knot = g->t0 - rng_uniform(r, 0.0, 1.0);
  for (size_t i = 0; i < g->n_knots; i++) {
    g->knots[i] = knot;
    if (rng_index(r, 4) || i == g->degree) knot += rng_uniform(r, 0.1, 1.0);
  }
  g->t0 = g->knots[g->degree];
  g->t1 = g->knots[g->n];
  if (rng_index(r, 3) == 0) g->t1 = g->t0 + 0.7 * (g->t1 - g->t0);
  return curve_from(describe_bspline(g->points, g->n, g->degree, g->knots, g->n_knots, g->t0, g->t1), ws, &g->curve);
}

/* The higher terms are small, so that the curve is not. */
static void terms_random(given_curve *g, rng *r, double scale, vec3 middle, double ratio) {
  double size = scale;
  for (size_t i = 0; i < g->n; i++) {
    g->points[i] = rng_in_cube(r, size);
    size *= ratio;
  }
  g->points[0] = vec_add(g->points[0], middle);
}

static cprox_status make_polynomial(given_curve *g, rng *r, double scale, vec3 middle, cprox_workspace *ws) {
  g->basis = "polynomial";
  g->degree = 1 + rng_index(r, 8);
  g->n = g->degree + 1;
  terms_random(g, r, scale, middle, 0.5);
  return curve_from(describe_polynomial(g->points, g->n, g->t0, g->t1), ws, &g->curve);
}

static cprox_status make_legendre(given_curve *g, rng *r, double scale, vec3 middle, cprox_workspace *ws) {
  g->basis = "legendre";
  g->degree = 1 + rng_index(r, 14);
  g->n = g->degree + 1;
  terms_random(g, r, scale, middle, 0.8);
  return curve_from(describe_legendre(g->points, g->n, g->t0, g->t1), ws, &g->curve);
}

static cprox_status make_lagrange(given_curve *g, rng *r, double scale, vec3 middle, cprox_workspace *ws) {
  g->basis = "lagrange";
  g->degree = 1 + rng_index(r, 7);
  points_random(g, r, g->degree + 1, scale, middle);
  g->n_knots = g->n;
  for (size_t i = 0; i < g->n; i++)
    g->knots[i] = g->t0 + (g->t1 - g->t0) * ((double)i + rng_uniform(r, -0.3, 0.3)) / (double)g->degree;
  return curve_from(describe_lagrange(g->points, g->knots, g->n, g->t0, g->t1), ws, &g->curve);
}

static cprox_status make_trigonometric(given_curve *g, rng *r, double scale, vec3 middle, cprox_workspace *ws) {
  g->basis = "trigonometric";
  g->degree = 1 + rng_index(r, 2);
  g->n = 2 * g->degree + 1;
  g->t1 = g->t0 + rng_uniform(r, 0.2, 1.5);
  terms_random(g, r, scale, middle, 0.7);
  return curve_from(describe_trigonometric(g->points, g->n, g->t0, g->t1), ws, &g->curve);
}

static void curve_random(given_curve *g, rng *r, bool bezier_only, double scale, vec3 middle, cprox_workspace *ws) {
  static cprox_status (*const make[])(given_curve *, rng *, double, vec3, cprox_workspace *) = {
      make_bezier, make_bezier, make_bspline, make_polynomial, make_legendre, make_lagrange, make_trigonometric};
  *g = (given_curve){0};
  g->t0 = rng_index(r, 2) ? 0.0 : rng_uniform(r, -2.0, 2.0);
  g->t1 = rng_index(r, 2) ? g->t0 + 1.0 : g->t0 + rng_uniform(r, 0.5, 3.0);
  const size_t choice = bezier_only ? 0 : rng_index(r, 7);
  if (make[choice](g, r, scale, middle, ws) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
}

/* Over the same parameters as another, with its knots or of another basis. */
static void curve_beside(given_curve *g, rng *r, const given_curve *like, double scale, cprox_workspace *ws) {
  *g = *like;
  g->curve = NULL;
  if (strcmp(like->basis, "bspline") != 0 || rng_index(r, 2)) {
    g->basis = "bezier";
    g->degree = 1 + rng_index(r, 6);
    g->n = g->degree + 1;
    g->n_knots = 0;
  }
  for (size_t i = 0; i < g->n; i++) g->points[i] = rng_in_cube(r, scale);
  const cprox_status status =
      g->n_knots > 0
          ? curve_from(describe_bspline(g->points, g->n, g->degree, g->knots, g->n_knots, g->t0, g->t1), ws, &g->curve)
          : curve_from(describe_bezier(g->points, g->n, g->t0, g->t1), ws, &g->curve);
  if (status != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
}

static void growth_random(given_curve *g, rng *r, const given_curve *like, double scale, cprox_workspace *ws) {
  *g = (given_curve){.basis = "bezier", .degree = 1 + rng_index(r, 4), .t0 = like->t0, .t1 = like->t1};
  g->n = g->degree + 1;
  for (size_t i = 0; i < g->n; i++) g->points[i] = vec(rng_uniform(r, 0.0, 0.1 * scale), rng_uniform(r, 0.0, 1.0), 0.0);
  if (curve_from(describe_bezier(g->points, g->n, g->t0, g->t1), ws, &g->curve) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
}

static void curve_write(const given_curve *g, FILE *out) {
  fprintf(out, " %s %zu %a %a %zu", g->basis, g->degree, g->t0, g->t1, g->n);
  for (size_t i = 0; i < g->n; i++) fprintf(out, " %a %a %a", g->points[i].x, g->points[i].y, g->points[i].z);
  fprintf(out, " %zu", g->n_knots);
  for (size_t i = 0; i < g->n_knots; i++) fprintf(out, " %a", g->knots[i]);
}

/* ---- bodies ---- */

cprox_body *query_body(rng *r, double scale, bool polytope_only, cprox_workspace *ws) {
  const vec3 size = vec(rng_log_uniform(r, 0.05, 1.0) * scale, rng_log_uniform(r, 0.05, 1.0) * scale,
                        rng_log_uniform(r, 0.05, 1.0) * scale);
  vec3 vertex[12];
  const size_t n = 4 + rng_index(r, 8);
  for (size_t i = 0; i < 12; i++) vertex[i] = rng_in_cube(r, 0.5 * scale);
  cprox_body *body = NULL;
  cprox_status status = CPROX_OK;
  switch (polytope_only ? 8 : rng_index(r, 10)) {
    case 0: status = cprox_body_create_point(rng_in_cube(r, scale), ws, &body); break;
    case 1: status = cprox_body_create_sphere(size.x, ws, &body); break;
    case 2: status = cprox_body_create_box(size, ws, &body); break;
    case 3: status = cprox_body_create_capsule(size.x, size.y, ws, &body); break;
    case 4: status = cprox_body_create_cylinder(size.x, size.y, ws, &body); break;
    case 5: status = cprox_body_create_cone(size.x, size.y, ws, &body); break;
    case 6: status = cprox_body_create_ellipsoid(size, ws, &body); break;
    case 7: status = cprox_body_create_halfspace(rng_unit(r), rng_uniform(r, 1.0, 4.0) * scale, ws, &body); break;
    case 8: status = cprox_body_create_polytope(vertex, n, ws, &body); break;
    default: {
      const double square[4][2] = {{-size.x, -size.y}, {size.x, -size.y}, {size.x, size.y}, {-size.x, size.y}};
      status = cprox_body_create_polygon(square, 4, ws, &body);
    }
  }
  if (status != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  return body;
}

/* 1: corners; 2: round; between: edges; 30: all but flat. */
static double exponent_random(rng *r) {
  static const double some[] = {1.0, 1.05, 1.5, 2.0, 2.0, 3.0, 4.5, 8.0, 30.0};
  return some[rng_index(r, 9)];
}

static cprox_status create_intersection(rng *r, double scale, cprox_workspace *ws, cprox_body **body) {
  double planes[3][4], quadrics[2][10] = {{0}}, terms[4][5];
  for (int i = 0; i < 3; i++) {
    const vec3 n = rng_unit(r);
    planes[i][0] = n.x, planes[i][1] = n.y, planes[i][2] = n.z;
    planes[i][3] = -rng_uniform(r, 0.2, 0.6) * scale;
  }
  for (int i = 0; i < 2; i++) {
    double *q = quadrics[i];
    q[0] = q[3] = q[5] = 1.0;
    if (rng_index(r, 2)) q[0] = 3.0, q[1] = rng_uniform(r, -0.5, 0.5);
    if (rng_index(r, 3) == 0) q[5] = 0.0; /* a cylinder */
    for (int k = 6; k < 9; k++) q[k] = rng_uniform(r, -0.2, 0.2) * scale;
    q[9] = -0.2 * scale * scale;
  }
  for (int i = 0; i < 4; i++) {
    const vec3 a = vec_scale(rng_uniform(r, 1.0, 3.0) / scale, rng_unit(r));
    terms[i][0] = a.x, terms[i][1] = a.y, terms[i][2] = a.z;
    terms[i][3] = rng_uniform(r, -0.1, 0.1);
    terms[i][4] = exponent_random(r);
  }
  const cprox_hyperquadric power = {(const double(*)[5])terms, 4};
  cprox_implicit_description d = {.hyperquadrics = &power, .n_hyperquadrics = 1};
  if (rng_index(r, 3)) d.planes = (const double(*)[4])planes, d.n_planes = rng_index(r, 4);
  if (rng_index(r, 3)) d.quadrics = (const double(*)[10])quadrics, d.n_quadrics = rng_index(r, 3);
  if (d.n_quadrics > 0 && rng_index(r, 3) == 0) {
    quadrics[0][5] = 1.0; /* bounded by itself */
    d.n_hyperquadrics = 0;
  }
  return cprox_body_create_implicit(&d, NULL, ws, body);
}

cprox_body *query_implicit(rng *r, double scale, cprox_workspace *ws) {
  cprox_body *body = NULL;
  for (int tries = 0; tries < 100 && !body; tries++) {
    const vec3 axes = vec(rng_uniform(r, 0.1, 0.6) * scale, rng_uniform(r, 0.1, 0.6) * scale, 0.3 * scale);
    const vec3 exponents = vec(exponent_random(r), exponent_random(r), exponent_random(r));
    if (rng_index(r, 2))
      cprox_body_create_superquadric(axes, exponents, ws, &body);
    else
      create_intersection(r, scale, ws, &body); /* it may be empty */
  }
  assert_non_null(body);
  return body;
}

/* A torus with bumps, or triangles anywhere; the hull may be smaller than it by what it is told to be. */
query_mesh query_mesh_random(rng *r, double scale, cprox_mesh_fill fill, cprox_workspace *ws) {
  const double size = rng_uniform(r, 0.2, 0.5) * scale;
  test_mesh mesh =
      fill == CPROX_MESH_FILL_SOLID || rng_index(r, 2)
          ? mesh_torus(6 + rng_index(r, 8), 4 + rng_index(r, 4), size, size * rng_uniform(r, 0.1, 0.5), 0.1)
          : mesh_soup(r, 3 + rng_index(r, 20), 0.5 * size, size);
  query_mesh made = {.mesh = mesh_body(&mesh, fill, ws), .surface = mesh};
  const double excess = rng_index(r, 2) ? 0.0 : 0.01 * size;
  vec3 *inner = calloc(mesh.n, sizeof *inner);
  assert_non_null(inner);
  for (size_t i = 0; i < mesh.n; i++) inner[i] = vec_scale(1.0 - 0.2 * excess / size, mesh.vertices[i]);
  if (cprox_body_create_polytope(inner, mesh.n, ws, &made.hull) != CPROX_OK ||
      cprox_body_create_lod(made.hull, excess, made.mesh, ws, &made.body) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
  free(inner);
  return made;
}

/* Boxes of any size, on a grid or not. */
static void cells_random(query_mesh *made, rng *r, double size, size_t n, cprox_workspace *ws) {
  vec3 low[20], high[20];
  test_mesh *mesh = &made->surface;
  *mesh = (test_mesh){.n = 0, .m = 0, .vertices = calloc(8 * n, sizeof(vec3)), .triangles = calloc(12 * n, 12)};
  assert_true(mesh->vertices && mesh->triangles);
  for (size_t i = 0; i < n; i++) {
    const vec3 half = vec(rng_uniform(r, 0.02, 0.2) * size, rng_uniform(r, 0.02, 0.2) * size, 0.1 * size);
    const vec3 at = rng_in_cube(r, size);
    low[i] = vec_sub(at, half), high[i] = vec_add(at, half);
    test_mesh box = mesh_box(half);
    for (size_t k = 0; k < box.m; k++, mesh->m++)
      for (int j = 0; j < 3; j++) mesh->triangles[mesh->m][j] = box.triangles[k][j] + (uint32_t)mesh->n;
    for (size_t k = 0; k < box.n; k++) mesh->vertices[mesh->n++] = vec_add(at, box.vertices[k]);
    mesh_free(&box);
  }
  made->cells = true;
  if (cprox_body_create_boxes(low, high, n, SIZE_MAX, ws, &made->body) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
}

static void points_body(query_mesh *made, rng *r, double size, size_t n, cprox_workspace *ws) {
  test_mesh *mesh = &made->surface;
  *mesh = (test_mesh){.n = n, .m = n, .vertices = calloc(n, sizeof(vec3)), .triangles = calloc(n, 12)};
  assert_true(mesh->vertices && mesh->triangles);
  for (size_t i = 0; i < n; i++) {
    mesh->vertices[i] = rng_in_cube(r, size);
    for (int j = 0; j < 3; j++) mesh->triangles[i][j] = (uint32_t)i;
  }
  made->radius = rng_index(r, 2) ? 0.0 : 0.1 * size;
  if (cprox_body_create_points(mesh->vertices, n, made->radius, SIZE_MAX, ws, &made->body) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
}

query_mesh query_elements_random(rng *r, double scale, cprox_workspace *ws) {
  query_mesh made = {.radius = 0.0};
  const double size = rng_uniform(r, 0.2, 0.5) * scale;
  switch (rng_index(r, 4)) {
    case 0: points_body(&made, r, size, 1 + rng_index(r, 200), ws); break;
    case 1: cells_random(&made, r, size, 1 + rng_index(r, 20), ws); break;
    case 2:
      made.surface = mesh_torus(6 + rng_index(r, 30), 4 + rng_index(r, 20), size, size * rng_uniform(r, 0.1, 0.5), 0.1);
      made.body = mesh_body(&made.surface, rng_index(r, 2) ? CPROX_MESH_FILL_SOLID : CPROX_MESH_FILL_SURFACE, ws);
      break;
    default:
      made.surface = mesh_soup(r, 3 + rng_index(r, 50), 0.5 * size, size);
      made.body = mesh_body(&made.surface, CPROX_MESH_FILL_SURFACE, ws);
  }
  return made;
}

double query_mesh_distance(const query_mesh *mesh, vec3l p) {
  const cprox_body *body = mesh->mesh ? mesh->mesh : mesh->body;
  const double d = (double)mesh_distance(&mesh->surface, p);
  if (mesh->cells) {
    for (size_t i = 0; i < mesh->surface.m; i += 12) {
      const test_mesh box = {
          .n = 8, .m = 12, .vertices = mesh->surface.vertices, .triangles = mesh->surface.triangles + i};
      if (fabsl(mesh_winding(&box, p)) > 0.5L) return 0.0;
    }
    return d;
  }
  const bool solid =
      cprox_body_get_info(body).is_solid && mesh->surface.m > 1 && cprox_body_get_info(body).kind == CPROX_BODY_MESH;
  return solid && fabsl(mesh_winding(&mesh->surface, p)) > 0.5L ? 0.0 : fmax(d - mesh->radius, 0.0);
}

static cprox_body *body_random(asked *q, rng *r, bool polytope_only, cprox_workspace *ws) {
  cprox_body *body = query_body(r, q->scale, polytope_only, ws);
  q->bodies[q->n_bodies++] = body;
  return body;
}

static cprox_body *compound_random(asked *q, rng *r, cprox_workspace *ws) {
  const cprox_body *parts[2] = {body_random(q, r, false, ws), body_random(q, r, false, ws)};
  const cprox_pose poses[2] = {rng_pose(r, 0.3 * q->scale), rng_pose(r, 0.3 * q->scale)};
  cprox_body *body = NULL;
  if (cprox_body_create_compound(parts, poses, 2, ws, &body) != CPROX_OK) return q->bodies[0];
  /* the union goes before its parts */
  for (size_t i = q->n_bodies++; i > 0; i--) q->bodies[i] = q->bodies[i - 1];
  q->bodies[0] = body;
  return body;
}

/* What moves beside the curve. */
static void clock_random(asked *q, rng *r, cprox_workspace *ws) {
  if (rng_index(r, 2)) growth_random(&q->growth, r, &q->mover, q->scale, ws);
  cprox_obstacle *first = &q->targets[0];
  if (rng_index(r, 3)) {
    curve_beside(&q->ride, r, &q->mover, q->scale, ws);
    first->curve = q->ride.curve;
    first->synchronized = true;
    if (rng_index(r, 4) == 0) first->body = NULL;
    if (rng_index(r, 3) == 0) growth_random(&q->swell, r, &q->mover, q->scale, ws);
    first->radius_curve = q->swell.curve;
  }
}

static bool is_carried(const cprox_body *body) {
  for (size_t i = 0; i < body->n_parts; i++)
    if (!is_carried(body->parts[i].body)) return false;
  return isfinite(cprox_body_get_info(body).radius);
}

static void curve_stay(given_curve *g, cprox_workspace *ws) {
  for (size_t i = 1; i < g->n; i++) g->points[i] = g->points[0];
  cprox_curve_free(g->curve);
  if (curve_from(describe_bezier(g->points, g->n, g->t0, g->t1), ws, &g->curve) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
}

void asked_random(asked *q, rng *r, asked_kinds kinds, double scale, double away, cprox_workspace *ws) {
  *q = (asked){.scale = scale};
  const vec3 middle = rng_in_cube(r, away);
  curve_random(&q->mover, r, kinds.bezier_only || kinds.stays, scale, middle, ws);
  if (kinds.stays) curve_stay(&q->mover, ws);
  q->radius = rng_index(r, 2) ? 0.0 : rng_uniform(r, 0.0, 0.1 * scale);
  q->n = kinds.polytope_only || kinds.curve_target ? 1 : 1 + rng_index(r, QUERY_MAX_TARGETS);
  for (size_t i = 0; i < q->n; i++) {
    cprox_obstacle *t = &q->targets[i];
    const vec3 beside = vec_scale(rng_uniform(r, 1.0, 4.0) * scale, rng_unit(r));
    if (kinds.curve_target) {
      curve_random(&q->target_curve, r, kinds.bezier_only, scale, middle, ws);
      *t = cprox_obstacle_curve(q->target_curve.curve, 0.0);
      if (rng_index(r, 2)) t->pose = (cprox_pose){beside, {1, 0, 0, 0}};
      continue;
    }
    if (kinds.meshes && rng_index(r, 2)) {
      q->mesh[i] =
          kinds.elements && rng_index(r, 2)
              ? query_elements_random(r, scale, ws)
              : query_mesh_random(r, scale, rng_index(r, 3) ? CPROX_MESH_FILL_SURFACE : CPROX_MESH_FILL_SOLID, ws);
      *t = cprox_obstacle_at(q->mesh[i].body, (cprox_pose){vec_add(middle, beside), rng_quat(r)});
      if (rng_index(r, 3) == 0) *t = cprox_with_margin(*t, 0.05 * scale);
      continue;
    }
    const bool compound = !kinds.polytope_only && q->n_bodies == 0 && rng_index(r, 5) == 0;
    const cprox_body *body = compound ? compound_random(q, r, ws) : NULL;
    if (!body && kinds.implicit && rng_index(r, 2)) body = q->bodies[q->n_bodies++] = query_implicit(r, scale, ws);
    if (!body) body = body_random(q, r, kinds.polytope_only, ws);
    *t = cprox_obstacle_at(body, (cprox_pose){vec_add(middle, beside), rng_quat(r)});
    if (rng_index(r, 3) == 0) t->pose.orientation = (cprox_quat){1, 0, 0, 0};
    if (rng_index(r, 3) == 0) *t = cprox_with_margin(*t, 0.05 * scale);
  }
  if (kinds.carried) {
    const cprox_body *body = q->n_bodies == 0 && rng_index(r, 3) == 0 ? compound_random(q, r, ws) : NULL;
    while (!body || !is_carried(body)) body = body_random(q, r, false, ws);
    q->carried = body;
  }
  if (kinds.clock) clock_random(q, r, ws);
}

cprox_mover asked_mover(const asked *q) {
  cprox_mover m =
      q->carried ? cprox_body_along(q->carried, q->mover.curve) : cprox_tube_along(q->mover.curve, q->radius);
  m.radius = q->radius;
  m.radius_curve = q->growth.curve;
  return m;
}

void query_mesh_free(query_mesh *mesh) {
  cprox_body_free(mesh->body);
  cprox_body_free(mesh->mesh);
  cprox_body_free(mesh->hull);
  mesh_free(&mesh->surface);
}

void asked_free(asked *q) {
  for (size_t i = 0; i < q->n; i++) query_mesh_free(&q->mesh[i]);
  for (size_t i = 0; i < q->n_bodies; i++) cprox_body_free(q->bodies[i]);
  cprox_curve_free(q->mover.curve);
  cprox_curve_free(q->target_curve.curve);
  cprox_curve_free(q->growth.curve);
  cprox_curve_free(q->ride.curve);
  cprox_curve_free(q->swell.curve);
}

/* ---- text ---- */

static void write_curve_as(const char *word, const given_curve *g, FILE *out) {
  if (!g->curve) return;
  fprintf(out, " %s", word);
  curve_write(g, out);
}

/* Lines of the body, the first word of each being another, and what the first target rides behind them. */
static void write_lines(const asked *q, const cprox_obstacle *t, const char *word, FILE *out) {
  const size_t size = cprox_obstacle_describe(t, NULL, 0) + 1;
  char *text = malloc(size), *rest = text;
  assert_non_null(text);
  cprox_obstacle_describe(t, text, size);
  for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
    fprintf(out, "%s%s", word, strchr(line, ' '));
    if (t->synchronized) write_curve_as("riding", &q->ride, out);
    if (t->radius_curve) write_curve_as("growing", &q->swell, out);
    fputs("\n", out);
  }
  free(text);
}

static void write_target(const asked *q, const cprox_obstacle *t, FILE *out) {
  if (t->curve && !t->synchronized) {
    const cprox_quat o = t->pose.orientation;
    fprintf(out, "target %a 1 %a %a %a %a %a %a %a curve", t->margin, t->pose.position.x, t->pose.position.y,
            t->pose.position.z, o.w, o.x, o.y, o.z);
    curve_write(&q->target_curve, out);
    fputs("\n", out);
    return;
  }
  write_lines(q, t, "target", out);
}

static size_t sections_of(const cprox_obstacle *t) {
  return t->body && t->body->kind == CPROX_BODY_COMPOUND ? t->body->n_parts : 1;
}

void asked_write_targets(const asked *q, FILE *out) {
  size_t sections = 0;
  for (size_t i = 0; i < q->n; i++) sections += sections_of(&q->targets[i]);
  fprintf(out, "cprox-problem 1\ntargets %zu\n", sections);
  for (size_t i = 0; i < q->n; i++) write_target(q, &q->targets[i], out);
}

void asked_write_mover(const asked *q, const char *id, FILE *out) {
  fprintf(out, "mover %s %a", id, q->radius);
  curve_write(&q->mover, out);
  write_curve_as("growing", &q->growth, out);
  if (q->carried) fprintf(out, " carrying %zu", q->carried->n_parts > 0 ? q->carried->n_parts : 1);
  fputs("\n", out);
  const cprox_obstacle load = cprox_obstacle_at(q->carried, CPROX_POSE_IDENTITY);
  if (q->carried) write_lines(q, &load, "carried", out);
}

asked_text asked_text_of(const asked *q) {
  asked_text t = {.text = NULL};
  size_t length = 0;
  FILE *out = open_memstream(&t.text, &length);
  assert_non_null(out);
  asked_write_targets(q, out);
  asked_write_mover(q, "mover", out);
  fclose(out);
  t.file = fmemopen(t.text, length, "r");
  assert_non_null(t.file);
  if (!problem_open(&t.read, t.file) || !problem_next(&t.read)) fail_msg("%s in\n%s", t.read.fault, t.text);
  return t;
}

void asked_text_free(asked_text *t) {
  problem_close(&t->read);
  fclose(t->file);
  free(t->text);
}

finding asked_check(const asked *q, const void *bytes, size_t size) {
  asked_text t = asked_text_of(q);
  const finding found = check(&t.read, bytes, size);
  asked_text_free(&t);
  return found;
}
