/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/robot_case.h"

#include <stdlib.h>
#include <string.h>

static bool numbers(FILE *f, double *x, size_t n) {
  for (size_t i = 0; i < n; i++)
    if (fscanf(f, "%lf", &x[i]) != 1) return false;
  return true;
}

static bool read_pose(FILE *f, cprox_pose *pose) {
  double x[7];
  if (!numbers(f, x, 7)) return false;
  *pose = (cprox_pose){.position = {x[0], x[1], x[2]}, .orientation = {x[3], x[4], x[5], x[6]}};
  return true;
}

/* The hull of a mesh, and its surface. */
static cprox_body *read_mesh(FILE *f, const cprox_body **surface) {
  size_t n, m;
  if (fscanf(f, "%zu %zu", &n, &m) != 2 || n > 100000 || m > 100000) return NULL;
  cprox_body *hull = NULL, *mesh = NULL;
  cprox_vec3 *v = calloc(n, sizeof *v);
  uint32_t(*t)[3] = calloc(m, sizeof *t);
  bool good = v && t;
  for (size_t i = 0; i < n && good; i++) good = fscanf(f, "%lf %lf %lf", &v[i].x, &v[i].y, &v[i].z) == 3;
  for (size_t i = 0; i < m && good; i++) good = fscanf(f, "%u %u %u", &t[i][0], &t[i][1], &t[i][2]) == 3;
  if (good && cprox_body_create_mesh(v, n, (const uint32_t(*)[3])t, m, CPROX_MESH_FILL_SURFACE, SIZE_MAX, NULL,
                                     &mesh) == CPROX_OK)
    cprox_body_create_polytope(v, n, NULL, &hull);
  *surface = mesh;
  free(t);
  free(v);
  return hull;
}

static cprox_body *read_body(FILE *f, const cprox_body **surface) {
  char kind[24];
  double x[3];
  cprox_body *body = NULL;
  *surface = NULL;
  if (fscanf(f, "%23s", kind) != 1) return NULL;
  if (strcmp(kind, "mesh") == 0) return read_mesh(f, surface);
  if (strcmp(kind, "box") == 0 && numbers(f, x, 3))
    cprox_body_create_box((cprox_vec3){x[0], x[1], x[2]}, NULL, &body);
  else if (strcmp(kind, "sphere") == 0 && numbers(f, x, 1))
    cprox_body_create_sphere(x[0], NULL, &body);
  else if (strcmp(kind, "cylinder") == 0 && numbers(f, x, 2))
    cprox_body_create_cylinder(x[0], x[1], NULL, &body);
  return body;
}

/* A geometry by its hull; *finer with the mesh under it, where there is one. */
static bool read_geometry(FILE *f, robot_case *c, size_t i, cprox_link_geometry *by_hull, cprox_link_geometry *finer) {
  *by_hull = (cprox_link_geometry){0};
  if (fscanf(f, "%d", &by_hull->link) != 1 || !read_pose(f, &by_hull->pose)) return false;
  by_hull->body = c->bodies[i] = read_body(f, &c->surfaces[i]);
  c->links[i] = by_hull->link, c->poses[i] = by_hull->pose;
  *finer = *by_hull;
  if (!c->surfaces[i] || !c->bodies[i]) return c->bodies[i] != NULL;
  cprox_body *lod = NULL;
  cprox_body_create_lod(c->bodies[i], 0.0, c->surfaces[i], NULL, &lod);
  finer->body = c->lods[i] = lod;
  return lod != NULL;
}

/* Links, geometries, and which pairs of links are disabled. */
static bool read_robot(FILE *f, robot_case *c, size_t *n_variables, bool disabled[CASE_MAX_LINKS][CASE_MAX_LINKS]) {
  cprox_link links[CASE_MAX_LINKS];
  cprox_link_geometry geometries[CASE_MAX_GEOMETRIES], finer[CASE_MAX_GEOMETRIES];
  size_t n_links, n_disabled;
  if (fscanf(f, "%zu %zu %zu", &n_links, n_variables, &c->n_geometries) != 3 || n_links > CASE_MAX_LINKS ||
      c->n_geometries > CASE_MAX_GEOMETRIES || *n_variables > CASE_MAX_VARIABLES)
    return false;
  for (size_t i = 0; i < n_links; i++) {
    int parent, type, variable;
    double x[3], y[2];
    if (fscanf(f, "%39s %d %d", c->link_names[i], &parent, &type) != 3 || !read_pose(f, &links[i].origin) ||
        !numbers(f, x, 3) || fscanf(f, "%d", &variable) != 1 || !numbers(f, y, 2))
      return false;
    links[i].parent = parent, links[i].type = (cprox_joint_type)type, links[i].variable = variable;
    links[i].axis = (cprox_vec3){x[0], x[1], x[2]}, links[i].multiplier = y[0], links[i].offset = y[1];
  }
  memcpy(c->tree, links, n_links * sizeof *links);
  c->n_links = n_links;
  for (size_t i = 0; i < c->n_geometries; i++)
    if (!read_geometry(f, c, i, &geometries[i], &finer[i])) return false;
  if (fscanf(f, "%zu", &n_disabled) != 1) return false;
  for (size_t i = 0; i < n_disabled; i++) {
    size_t a, b;
    if (fscanf(f, "%zu %zu", &a, &b) != 2 || a >= n_links || b >= n_links) return false;
    disabled[a][b] = disabled[b][a] = true;
  }
  return cprox_robot_create(links, n_links, geometries, c->n_geometries, *n_variables, NULL, &c->robot) == CPROX_OK &&
         cprox_robot_create(links, n_links, finer, c->n_geometries, *n_variables, NULL, &c->mesh_robot) == CPROX_OK;
}

static bool read_motion(FILE *f, robot_case *c, size_t n_variables) {
  double rest[CASE_MAX_VARIABLES], positions[CASE_MAX_POINTS][CASE_MAX_VARIABLES],
      velocities[CASE_MAX_POINTS][CASE_MAX_VARIABLES];
  int32_t variables[CASE_MAX_VARIABLES];
  cprox_waypoint points[CASE_MAX_POINTS];
  size_t n, n_points;
  if (!numbers(f, rest, n_variables) || fscanf(f, "%zu %zu", &n, &n_points) != 2 || n > CASE_MAX_VARIABLES ||
      n_points > CASE_MAX_POINTS)
    return false;
  for (size_t i = 0; i < n; i++)
    if (fscanf(f, "%d", &variables[i]) != 1) return false;
  for (size_t i = 0; i < n_points; i++) {
    points[i] = (cprox_waypoint){.positions = positions[i], .velocities = velocities[i]};
    if (!numbers(f, &points[i].time, 1) || !numbers(f, positions[i], n) || !numbers(f, velocities[i], n)) return false;
  }
  const cprox_motion_description d = {.kind = CPROX_MOTION_WAYPOINTS,
                                      .variables = variables,
                                      .n_variables = n,
                                      .waypoints = points,
                                      .n_waypoints = n_points,
                                      .interpolation = CPROX_INTERPOLATION_CUBIC,
                                      .rest = rest};
  return cprox_motion_create(c->robot, &d, NULL, &c->motion) == CPROX_OK &&
         cprox_motion_create(c->mesh_robot, &d, NULL, &c->mesh_motion) == CPROX_OK;
}

static bool read_scene(FILE *f, robot_case *c) {
  if (fscanf(f, "%zu", &c->n_targets) != 1 || c->n_targets > CASE_MAX_OBJECTS) return false;
  for (size_t i = 0; i < c->n_targets; i++) {
    char id[80];
    cprox_pose pose;
    if (fscanf(f, "%79s", id) != 1 || !read_pose(f, &pose)) return false;
    const cprox_body *surface;
    c->targets[i] = cprox_obstacle_at(read_body(f, &surface), pose);
    if (!c->targets[i].body || surface) return false;
  }
  if (fscanf(f, "%zu", &c->n_answers) != 1 || c->n_answers > 2) return false;
  for (size_t i = 0; i < c->n_answers; i++) {
    char kind[24];
    case_answer *a = &c->answers[i];
    if (fscanf(f, "%23s %lf %lf %lf", kind, &a->lower, &a->upper, &a->sampled) != 4) return false;
    a->self = strcmp(kind, "self") == 0;
  }
  return true;
}

static bool read_robot_file(const char *folder, robot_case *c, bool disabled[CASE_MAX_LINKS][CASE_MAX_LINKS]) {
  char path[400];
  snprintf(path, sizeof path, "%s/%s.robot", folder, c->robot_name);
  FILE *f = fopen(path, "r");
  const bool good = f && read_robot(f, c, &c->n_variables, disabled);
  if (f) fclose(f);
  return good;
}

static void list_self_pairs(robot_case *c, bool disabled[CASE_MAX_LINKS][CASE_MAX_LINKS]) {
  for (size_t i = 0; i < c->n_geometries; i++)
    for (size_t k = 0; k < i; k++) {
      const size_t a = (size_t)c->links[i], b = (size_t)c->links[k];
      const cprox_link_info between = cprox_motion_get_link_info(c->motion, c->links[i], c->links[k]);
      if (disabled[a][b] || between.n_joints < 2 || between.n_moved == 0) continue;
      c->self_pairs[c->n_self_pairs++] = (cprox_robot_pair){(int32_t)i, (int32_t)k};
    }
}

bool robot_case_read(FILE *cases, const char *folder, robot_case *c) {
  bool disabled[CASE_MAX_LINKS][CASE_MAX_LINKS] = {{false}};
  memset(c, 0, sizeof *c);
  if (fscanf(cases, "%79s %39s", c->name, c->robot_name) != 2) return false;
  if (!read_robot_file(folder, c, disabled) || !read_motion(cases, c, c->n_variables) || !read_scene(cases, c)) {
    fprintf(stderr, "%s: not a robot case\n", c->name);
    return false;
  }
  list_self_pairs(c, disabled);
  return true;
}

bool robot_case_read_robot(const char *folder, const char *robot, robot_case *c) {
  bool disabled[CASE_MAX_LINKS][CASE_MAX_LINKS] = {{false}};
  memset(c, 0, sizeof *c);
  snprintf(c->robot_name, sizeof c->robot_name, "%s", robot);
  double positions[2][CASE_MAX_VARIABLES] = {{0.0}};
  int32_t variables[CASE_MAX_VARIABLES];
  for (int i = 0; i < CASE_MAX_VARIABLES; i++) variables[i] = i, positions[1][i] = 1.0;
  const cprox_waypoint points[2] = {{.positions = positions[0]}, {.time = 1.0, .positions = positions[1]}};
  cprox_motion_description d = {
      .variables = variables, .waypoints = points, .n_waypoints = 2, .interpolation = CPROX_INTERPOLATION_LINEAR};
  bool good = read_robot_file(folder, c, disabled);
  d.n_variables = c->n_variables;
  good = good && cprox_motion_create(c->robot, &d, NULL, &c->motion) == CPROX_OK &&
         cprox_motion_create(c->mesh_robot, &d, NULL, &c->mesh_motion) == CPROX_OK;
  if (good) list_self_pairs(c, disabled);
  if (!good) fprintf(stderr, "%s: not a robot\n", robot);
  return good;
}

void robot_case_free(robot_case *c) {
  cprox_motion_free(c->motion);
  cprox_motion_free(c->mesh_motion);
  cprox_robot_free(c->robot);
  cprox_robot_free(c->mesh_robot);
  for (size_t i = 0; i < c->n_geometries; i++) {
    cprox_body_free((cprox_body *)c->lods[i]);
    cprox_body_free((cprox_body *)c->surfaces[i]);
    cprox_body_free((cprox_body *)c->bodies[i]);
  }
  for (size_t i = 0; i < c->n_targets; i++) cprox_body_free((cprox_body *)c->targets[i].body);
}
