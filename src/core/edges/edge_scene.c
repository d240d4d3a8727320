/* SPDX-License-Identifier: BSD-3-Clause */
/* The scene's side of a model: what stands, and which parts can reach it. */
#include <math.h>
#include <string.h>

#include "edges/edge_build.h"

/* Coordinates in lanes are no larger [m]. */
#define EDGE_REACH_MOST 1e6

/* Corners that are looked at one by one, at most. */
enum { MOST_CORNERS = 256 };

static size_t corners_of(const part_model *m) {
  return m->shape->ops == &convex_polytope && m->shape->n <= MOST_CORNERS ? (size_t)m->shape->n : 0;
}

/* Whether finer models than hulls may answer. */
static bool wants_finest(const cprox_edge_checker *c) {
  const cprox_options *options = c->asked.options;
  return !options || options->max_lod == CPROX_LOD_NONE || options->max_lod == CPROX_LOD_MESH;
}

/* What a part of an obstacle is made of, which stands in the frame f. All coordinates are within `extent` of its
 * origin: of each place lanes round its origin, its axes as any rotation, and what they turn. */
static void add_content(cprox_edge_checker *c, const part_model *m, const frame *f, double margin, double world,
                        edge_obstacle *o) {
  const bool by_tree = m->tree && !m->winding && wants_finest(c);
  const size_t n = by_tree ? 0 : corners_of(m);
  if (n == 0 && !by_tree) return;
  const vec3 at = by_tree ? m->tree_at : vec(0, 0, 0), p = frame_to_world(f, at), seen = vec_sub(p, c->base);
  const double extent = by_tree ? m->tree->scale : m->shape->scale;
  const double thick = margin + (by_tree ? m->tree_margin : m->margin + m->shape->slack);
  const double growth = (1.0 + 1e-6) * EDGE_U * (20.0 * vec_norm(seen) + 32.0 * extent + 4.0 * thick) +
                        ROUND_WORLD * (world + vec_norm(p) + extent);
  int32_t from[3] = {0};
  float sign[3];
  edge_snap(f->r, o->axes, from, sign);
  o->origin[0] = (float)seen.x, o->origin[1] = (float)seen.y, o->origin[2] = (float)seen.z;
  o->around = edge_float_above(thick + growth), o->costs = edge_float_above(4.0 * growth);
  o->within = by_tree && m->tree->kind == TREE_POINTS ? edge_float_below(thick) : -1.0f;
  o->tree = by_tree ? m->tree : NULL;
  if (by_tree) return;
  float *corners = c->corners + c->n_corners * 3 * EDGE_BLOCK;
  o->hull = (edge_hull){.first = (uint32_t)c->n_corners, .n = (uint32_t)n, .inner = -1.0f};
  for (size_t i = 0; i < n; i++) edge_set_point(corners, i, vec(m->shape->x[i], m->shape->y[i], m->shape->z[i]));
  c->n_corners += edge_blocks_of(n);
  edge_enclose_points(&o->hull, corners);
}

/* One part of an obstacle. What its own numbers round: its place once, its axes as any rotation (7 u of a vector), its
 * sizes once; the vector from it is at most |p| and the reach of what is tested long, the latter being counted there.
 */
static void add_obstacle(cprox_edge_checker *c, const cprox_obstacle *obstacle, size_t index, size_t part) {
  const vec3 base = c->base;
  const cprox_body *body = body_part_at(obstacle->body, part);
  part_model m = part_model_of(body);
  const double *size = m.shape->size, margin = m.margin + obstacle->margin;
  edge_shape shape = EDGE_BALL;
  vec3 middle = vec(0, 0, 0); /* of what lanes see */
  double sizes[3] = {margin, 0, 0}, extent = m.radius + obstacle->margin;
  bool exact = !m.tree;
  switch (m.shape->ops->kind) {
    case CPROX_BODY_BOX: shape = EDGE_BOX, sizes[0] = size[0], sizes[1] = size[1], sizes[2] = size[2]; break;
    case CPROX_BODY_CAPSULE: shape = EDGE_CAPSULE, sizes[1] = size[1]; break;
    case CPROX_BODY_CYLINDER: shape = EDGE_CYLINDER, sizes[0] = size[0], sizes[1] = size[1]; break;
    case CPROX_BODY_CONE: shape = EDGE_CONE, sizes[0] = size[0], sizes[1] = size[1]; break;
    case CPROX_BODY_HALFSPACE: shape = EDGE_HALFSPACE, extent = 0.0; break;
    case CPROX_BODY_SPHERE: break;
    default:
      if (m.shape->ops == &convex_point) break;
      part_model_find_box(&m);
      exact = false, shape = EDGE_BOX, middle = m.middle;
      sizes[0] = m.half.x, sizes[1] = m.half.y, sizes[2] = m.half.z;
  }
  cprox_pose pose = obstacle->pose;
  double world = vec_norm(base) + vec_norm(obstacle->pose.position) + vec_norm(m.centre); /* rounding in double */
  if (obstacle->body->kind == CPROX_BODY_COMPOUND) {
    pose = frame_compose(&obstacle->pose, &obstacle->body->parts[part].pose);
    world += vec_norm(obstacle->body->parts[part].pose.position);
  }
  const frame f = frame_create(&pose, m.centre);
  vec3 p = frame_to_world(&f, middle);
  const vec3 n = shape == EDGE_HALFSPACE ? frame_turn_to_world(&f, vec(size[0], size[1], size[2])) : middle;
  edge_obstacle o = {.obstacle = (int32_t)index, .shape = shape};
  add_content(c, &m, &f, obstacle->margin, world + vec_norm(m.tree_at), &o);
  world += vec_norm(middle);
  int32_t from[3] = {0};
  float sign[3];
  const bool exchanges = edge_snap(f.r, o.r, from, sign);
  if (o.shape == EDGE_HALFSPACE) {
    o.r[0] = (float)n.x, o.r[3] = (float)n.y, o.r[6] = (float)n.z;
    world += fabs(size[3]) + vec_norm(p);
    p = vec_axpy(p, -size[3], n); /* of the plane: that nearest to the base */
    p = vec_axpy(base, -vec_dot(n, vec_sub(base, p)), n);
    sizes[0] = 0.0;
  }
  const bool grows_all = o.shape == EDGE_BOX || o.shape == EDGE_CYLINDER; /* the margin goes into the sizes, outwards */
  if (grows_all && margin > 0.0) exact = false;
  const vec3 seen = vec_sub(p, base);
  const double far = vec_norm(seen),
               growth = (1.0 + 1e-6) * EDGE_U *
                            (14.0 * far + 4.0 * (fabs(sizes[0]) + fabs(sizes[1]) + fabs(sizes[2]) + margin)) +
                        ROUND_WORLD * (world + vec_norm(p));
  o.p[0] = (float)seen.x, o.p[1] = (float)seen.y, o.p[2] = (float)seen.z;
  if (o.shape == EDGE_BOX && exchanges) {
    o.shape = EDGE_ALIGNED_BOX;
    double turned[3] = {0};
    for (int k = 0; k < 3; k++) turned[from[k]] = sizes[k];
    memcpy(sizes, turned, sizeof sizes);
  }
  o.margin = o.shape == EDGE_CONE || o.shape == EDGE_HALFSPACE ? edge_float_above(margin + growth) : 0.0f;
  const double more = (grows_all ? margin : 0.0) + growth;
  const int grown = o.shape == EDGE_ALIGNED_BOX || o.shape == EDGE_BOX ? 3
                    : o.shape == EDGE_CYLINDER                         ? 2
                    : o.shape == EDGE_BALL || o.shape == EDGE_CAPSULE  ? 1
                                                                       : 0;
  for (int k = 0; k < 3; k++) o.size[k] = edge_float_above(sizes[k] + (k < grown ? more : 0.0));
  if (o.shape == EDGE_CONE) o.size[2] = (float)(1.0 / (size[0] * size[0] + 4.0 * size[1] * size[1]));
  o.grown =
      exact ? edge_float_above(4.0 * growth) : INFINITY; /* at a corner of a box the root of 3 of that; and both ways */
  c->obstacle_reach = greater(far + extent, c->obstacle_reach);
  c->obstacles[c->n_obstacles++] = o;
}

/* How far a part is from the base at most. Shifts have no bounds. */
static double reach_of(const cprox_edge_checker *c, const edge_part *part) {
  for (int32_t f = part->frame; f > 0; f = c->frames[f].parent)
    if (c->frames[f].shifts) return INFINITY;
  return c->frames[part->frame].fixed_reach + part->farthest;
}

/* How much of the way to what lies within `extent` about a point is left beyond `reach`; rounded down. Not above 0: it
 * may be in reach. */
static double left_of(const cprox_edge_checker *c, double apart, double reach, double extent) {
  return apart - (reach + c->clear_beyond + extent) * (1.0 + 1e-4) - 1e-30;
}

static double obstacle_beyond(const cprox_edge_checker *c, double reach, const edge_obstacle *o) {
  const vec3 p = vec((double)o->p[0], (double)o->p[1], (double)o->p[2]);
  double extent = (double)o->margin;
  for (int k = 0; k < 3; k++) extent += (double)o->size[k];
  return o->shape == EDGE_HALFSPACE ? -INFINITY : left_of(c, vec_norm(p), reach, extent);
}

/* The same of an obstacle's ball, before its parts are looked at. */
static double ball_beyond(const cprox_edge_checker *c, double reach, const cprox_obstacle *obstacle) {
  const cprox_body *body = obstacle->body;
  if (!(body->ball_radius < INFINITY)) return -INFINITY;
  const frame f = frame_create(&obstacle->pose, body->ball_centre);
  const double apart = vec_norm(vec_sub(frame_to_world(&f, vec(0, 0, 0)), c->base));
  const double world = vec_norm(c->base) + vec_norm(obstacle->pose.position) + vec_norm(body->ball_centre);
  return left_of(c, apart - ROUND_WORLD * world, reach, body->ball_radius + obstacle->margin);
}

static void fill_near(cprox_edge_checker *c, const double *reach) {
  for (size_t i = 0; i < c->n_parts; i++) {
    edge_part *part = &c->parts[i];
    const double own = reach ? reach[i] : reach_of(c, part);
    part->first_near = (uint32_t)c->n_near;
    for (size_t k = 0; k < c->n_obstacles; k++) {
      if (!edge_asks_about(&c->rows, c->members[part->first_member], (size_t)c->obstacles[k].obstacle)) continue;
      const double left = obstacle_beyond(c, own, &c->obstacles[k]);
      if (left > 0.0)
        c->beyond = lesser(left, c->beyond);
      else
        c->near[c->n_near++] = (uint32_t)k;
    }
    part->n_near = (uint32_t)c->n_near - part->first_near;
  }
}

static void lay_out_scene(cprox_edge_checker *c, const cprox_obstacle *obstacles, size_t first, size_t last,
                          edge_arena *a) {
  size_t n_obstacles = 0, n_corners = 0;
  for (size_t i = first; i < last; i++)
    for (size_t k = 0; k < body_n_parts(obstacles[i].body); k++, n_obstacles++) {
      const part_model m = part_model_of(body_part_at(obstacles[i].body, k));
      n_corners += edge_blocks_of(corners_of(&m));
    }
  c->obstacles = edge_take(a, n_obstacles, sizeof *c->obstacles);
  c->near = edge_take(a, c->n_parts * n_obstacles, sizeof *c->near);
  c->corners = edge_take(a, n_corners * 3 * EDGE_BLOCK, sizeof *c->corners);
}

size_t edge_model_scene_size(const cprox_edge_checker *c, const cprox_obstacle *obstacles, size_t first, size_t last) {
  cprox_edge_checker none = {.n_parts = c->n_parts};
  edge_arena a = {0};
  lay_out_scene(&none, obstacles, first, last, &a);
  return a.bytes + 16;
}

void edge_model_fill_scene(cprox_edge_checker *c, const cprox_obstacle *obstacles, size_t first, size_t last,
                           const double *reach, char *memory) {
  edge_arena a = {.at = memory};
  double farthest = 0.0;
  for (size_t i = 0; i < c->n_parts; i++) farthest = greater(reach ? reach[i] : reach_of(c, &c->parts[i]), farthest);
  lay_out_scene(c, obstacles, first, last, &a);
  c->n_obstacles = c->n_near = c->n_corners = 0, c->obstacle_reach = 0.0, c->beyond = INFINITY;
  for (size_t i = first; i < last; i++) {
    const double left = ball_beyond(c, farthest, &obstacles[i]);
    if (left > 0.0) c->beyond = lesser(left, c->beyond);
    for (size_t k = 0; !(left > 0.0) && k < body_n_parts(obstacles[i].body); k++) add_obstacle(c, &obstacles[i], i, k);
  }
  fill_near(c, reach);
  c->in_lanes = c->in_lanes && c->obstacle_reach <= EDGE_REACH_MOST;
}
