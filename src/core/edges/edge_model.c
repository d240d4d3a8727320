/* SPDX-License-Identifier: BSD-3-Clause */
#include "edges/edge_model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/workspace.h"
#include "problem/obstacles.h"

/* Entries of rotations below this are 0. */
#define EDGE_SNAP 1e-9

/* Coordinates in lanes are no larger [m]. */
#define EDGE_REACH_MOST 1e6

static float float_above(double x) {
  const float f = (float)x;
  return (double)f >= x ? f : nextafterf(f, INFINITY);
}

static float float_below(double x) {
  return -float_above(-x);
}

/* ---- frames ---- */

/* A rotation that takes the z axis to the unit vector z. */
static placement turn_to(vec3 z) {
  const vec3 side = fabs(z.x) < 0.6 ? vec(1, 0, 0) : vec(0, 1, 0);
  vec3 x = vec_axpy(side, -vec_dot(side, z), z);
  x = vec_scale(1.0 / vec_norm(x), x);
  const vec3 y = vec_cross(z, x);
  return (placement){.r = {x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z}};
}

static placement turn_of_axis(const robot_axis *axis) {
  static const placement HERE = {.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  return axis->along == 2 && axis->z.z > 0.0 ? HERE : turn_to(axis->z);
}

static placement turned_back(const placement *turn, const placement *at) {
  placement out = {.p = rotate_back(turn->r, at->p)};
  const double *t = turn->r;
  const double back[9] = {t[0], t[3], t[6], t[1], t[4], t[7], t[2], t[5], t[8]};
  rotation_compose(back, at->r, out.r);
  return out;
}

/* Entries as they go into lanes; whether only coordinates are exchanged. */
static bool snap(const double r[9], float out[9], int32_t from[3], float sign[3]) {
  bool exchanges = true;
  for (int k = 0; k < 9; k++) {
    const double x = fabs(r[k]) < EDGE_SNAP ? 0.0 : fabs(fabs(r[k]) - 1.0) < EDGE_SNAP ? copysign(1.0, r[k]) : r[k];
    out[k] = (float)x;
    exchanges = exchanges && (x == 0.0 || fabs(x) == 1.0);
  }
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < 3; k++)
      if (out[3 * k + c] != 0.0f) from[c] = k, sign[c] = out[3 * k + c];
  return exchanges;
}

/* ---- what is asked ---- */

static uint64_t *row_of(const edge_rows *rows, size_t geometry) {
  return rows->bits + geometry * rows->words;
}

static void note(const edge_rows *rows, int32_t geometry, size_t bit) {
  row_of(rows, (size_t)geometry)[bit / 64] |= (uint64_t)1 << (bit % 64);
}

static bool is_noted(const edge_rows *rows, int32_t geometry, size_t bit) {
  return row_of(rows, (size_t)geometry)[bit / 64] >> (bit % 64) & 1u;
}

static bool is_asked(const edge_rows *rows, size_t geometry) {
  for (size_t w = 0; w < rows->words; w++)
    if (row_of(rows, geometry)[w]) return true;
  return false;
}

static bool asks_about(const edge_rows *rows, int32_t geometry, size_t obstacle) {
  return is_noted(rows, geometry, rows->all ? 0 : obstacle);
}

static void note_two(const edge_rows *rows, int32_t geometry, int32_t other) {
  note(rows, geometry, rows->n_obstacles + (size_t)other);
  note(rows, other, rows->n_obstacles + (size_t)geometry);
}

/* Joints above a link. */
static size_t joints_between(const cprox_robot *robot, int32_t link_a, int32_t link_b) {
  const int32_t a = link_a < 0 ? -1 : robot->links[link_a].axis, b = link_b < 0 ? -1 : robot->links[link_b].axis;
  const int32_t common = robot_common_axis(robot, a, b);
  size_t n = 0;
  for (int32_t i = a; i != common; i = robot->axes[i].parent) n += robot->axes[i].first_of_joint;
  for (int32_t i = b; i != common; i = robot->axes[i].parent) n += robot->axes[i].first_of_joint;
  return n;
}

static bool is_worth_asking(const cprox_robot *robot, size_t g, size_t k) {
  return joints_between(robot, robot->given_geometries[g].link, robot->given_geometries[k].link) >= 2;
}

static edge_rows rows_of(const edge_asked *asked) {
  const bool all = !asked->pairs;
  const size_t columns = all ? 1 : asked->n_obstacles;
  return (edge_rows){.words = (columns + asked->robot->n_geometries) / 64 + 1, .n_obstacles = columns, .all = all};
}

static void fill_rows(const edge_rows *rows, const edge_asked *asked) {
  const size_t n = asked->robot->n_geometries;
  memset(rows->bits, 0, n * rows->words * sizeof *rows->bits);
  for (size_t g = 0; g < n && asked->about_obstacles && !asked->pairs; g++) note(rows, (int32_t)g, 0);
  for (size_t i = 0; i < asked->n_pairs && asked->about_obstacles && asked->pairs; i++)
    note(rows, asked->pairs[i].geometry, (size_t)asked->pairs[i].other);
  if (!asked->about_self) return;
  for (size_t i = 0; i < asked->n_self_pairs && asked->self_pairs; i++)
    note_two(rows, asked->self_pairs[i].geometry, asked->self_pairs[i].other);
  for (size_t g = 0; g < n && !asked->self_pairs; g++)
    for (size_t k = 0; k < g; k++)
      if (is_worth_asking(asked->robot, g, k)) note_two(rows, (int32_t)g, (int32_t)k);
}

/* Which axes carry anything that is asked about. */
static void mark_axes(const cprox_robot *robot, const edge_rows *rows, int32_t *frame_of) {
  for (size_t i = 0; i < robot->n_axes; i++) frame_of[i] = -1;
  for (size_t i = 0; i < robot->n_parts; i++)
    for (int32_t axis = is_asked(rows, (size_t)robot->parts[i].geometry) ? robot->parts[i].axis : -1;
         axis >= 0 && frame_of[axis] < 0; axis = robot->axes[axis].parent)
      frame_of[axis] = 0;
}

/* False: an axis is a ball. */
static bool fill_frames(cprox_edge_checker *c) {
  const cprox_robot *robot = c->robot;
  int32_t *frame_of = c->frame_of;
  c->frames[0] = (edge_frame){.parent = -1, .variable = -1};
  c->n_frames = 1;
  for (size_t i = 0; i < robot->n_axes; i++) {
    if (frame_of[i] < 0) continue;
    const robot_axis *axis = &robot->axes[i];
    if (axis->kind != AXIS_REVOLUTE && axis->kind != AXIS_PRISMATIC) return false;
    edge_frame *f = &c->frames[c->n_frames];
    frame_of[i] = (int32_t)c->n_frames++;
    placement at = axis->at;
    if (axis->parent < 0)
      at.p = vec_sub(at.p, c->base);
    else {
      const placement above = turn_of_axis(&robot->axes[axis->parent]);
      at = turned_back(&above, &at);
    }
    const placement own = turn_of_axis(axis);
    double r[9];
    rotation_compose(at.r, own.r, r);
    *f = (edge_frame){.parent = axis->parent < 0 ? 0 : frame_of[axis->parent],
                      .variable = axis->variable,
                      .shifts = axis->kind == AXIS_PRISMATIC,
                      .multiplier = axis->multiplier,
                      .offset = axis->offset,
                      .p = {(float)at.p.x, (float)at.p.y, (float)at.p.z},
                      .length = vec_norm(at.p)};
    if (!snap(r, f->r, f->from, f->sign)) f->from[0] = -1;
    f->fixed_reach = c->frames[f->parent].fixed_reach + f->length;
  }
  return true;
}

/* ---- parts ---- */

/* Where a part of the robot is in its frame as lanes have it. */
static placement place_in_frame(const cprox_edge_checker *c, const robot_part *part) {
  placement at = part->at;
  if (part->axis >= 0) {
    const placement turn = turn_of_axis(&c->robot->axes[part->axis]);
    return turned_back(&turn, &at);
  }
  at.p = vec_sub(at.p, c->base);
  return at;
}

static size_t blocks_of(size_t points) {
  return (points + EDGE_BLOCK - 1) / EDGE_BLOCK;
}

/* Point i of a hull; points are set in order. */
static void set_point(float *points, size_t i, vec3 p) {
  for (size_t k = i; k == i || k % EDGE_BLOCK != 0; k++) {
    float *to = points + edge_point_place(k);
    to[0] = (float)p.x, to[EDGE_BLOCK] = (float)p.y, to[2 * EDGE_BLOCK] = (float)p.z;
  }
}

static const float *points_of(const cprox_edge_checker *c, const edge_hull *hull) {
  return c->points + (size_t)hull->first * 3 * EDGE_BLOCK;
}

static vec3 point_at(const float *points, size_t i) {
  const float *p = points + edge_point_place(i);
  return vec((double)p[0], (double)p[EDGE_BLOCK], (double)p[2 * EDGE_BLOCK]);
}

/* A ball about the middle of their box that all points of a hull are in. */
static void enclose_points(edge_hull *hull, const float *points) {
  float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (uint32_t i = 0; i < hull->n; i++)
    for (size_t k = 0; k < 3; k++) {
      const float x = points[edge_point_place(i) + k * EDGE_BLOCK];
      low[k] = x < low[k] ? x : low[k], high[k] = x > high[k] ? x : high[k];
    }
  for (int k = 0; k < 3; k++) hull->centre[k] = 0.5f * low[k] + 0.5f * high[k];
  double core2 = 0.0;
  const vec3 centre = vec((double)hull->centre[0], (double)hull->centre[1], (double)hull->centre[2]);
  for (uint32_t i = 0; i < hull->n; i++) {
    const vec3 apart = vec_sub(point_at(points, i), centre);
    core2 = greater(vec_dot(apart, apart), core2);
  }
  hull->core = float_above(sqrt(core2) * (1.0 + 0x1p-40));
}

/* A hull of n points. */
static edge_hull *add_hull(cprox_edge_checker *c, const placement *at, const vec3 *points, size_t n, double margin,
                           double inner, int32_t geometry) {
  edge_hull *hull = &c->hulls[c->n_hulls++];
  float *own = c->points + c->n_blocks * 3 * EDGE_BLOCK;
  *hull = (edge_hull){.first = (uint32_t)c->n_blocks,
                      .n = (uint32_t)n,
                      .margin = float_above(margin),
                      .inner = float_below(inner),
                      .end = (uint32_t)c->n_hulls,
                      .geometry = geometry};
  for (size_t i = 0; i < n; i++) set_point(own, i, placement_apply(at, points[i]));
  c->n_blocks += blocks_of(n);
  enclose_points(hull, own);
  return hull;
}

static void add_balls(cprox_edge_checker *c, const robot_covers *covers, size_t i) {
  const robot_part *part = &c->robot->parts[i];
  const placement at = place_in_frame(c, part);
  for (size_t k = covers->first[i]; k < covers->first[i + 1]; k++) {
    const cover_ball *ball = &covers->balls[k];
    const vec3 p = placement_apply(&at, ball->centre);
    c->balls[c->n_balls++] = (edge_ball){.centre = {(float)p.x, (float)p.y, (float)p.z},
                                         .outer = float_above(ball->outer),
                                         .inner = float_below(ball->inner),
                                         .reach = float_above(vec_norm(p) * (1.0 + EDGE_U)),
                                         .geometry = part->geometry};
    if (covers->hulls.n > 0) add_hull(c, &at, &ball->centre, 1, ball->outer, ball->inner, part->geometry);
  }
}

static void add_hulls(cprox_edge_checker *c, const robot_covers *covers, size_t i) {
  const robot_part *part = &c->robot->parts[i];
  const placement at = place_in_frame(c, part);
  const uint32_t root = (uint32_t)c->n_hulls;
  for (size_t k = covers->first_hull[i]; k < covers->first_hull[i + 1]; k++) {
    const cover_hull *hull = &covers->hulls.hull[k];
    edge_hull *made =
        add_hull(c, &at, covers->hulls.point + hull->first, hull->n, hull->margin, hull->inner, part->geometry);
    made->child = root + hull->child, made->n_children = hull->n_children;
  }
  if (c->n_hulls > root) c->hulls[root].end = (uint32_t)c->n_hulls;
}

static vec3 centre_of(const edge_ball *ball) {
  return vec((double)ball->centre[0], (double)ball->centre[1], (double)ball->centre[2]);
}

static void take_in(edge_part *part, vec3 centre, vec3 p, double radius, double *outer, double *core) {
  const double apart = vec_norm(vec_sub(p, centre)), reach = vec_norm(p) * (1.0 + 0x1p-40);
  *outer = greater(apart + radius, *outer), *core = greater(apart, *core);
  part->farthest = greater(reach + radius, part->farthest);
  part->reach_of_centre = greater(reach, part->reach_of_centre);
}

/* A ball round all balls of a part and all hulls of whole covers, about the middle of their box. */
static void enclose(const cprox_edge_checker *c, edge_part *part) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (uint32_t i = part->first; i < part->first + part->n; i++)
    for (int k = 0; k < 3; k++) {
      low[k] = lesser(low[k], (double)(c->balls[i].centre[k] - c->balls[i].outer));
      high[k] = greater(high[k], (double)(c->balls[i].centre[k] + c->balls[i].outer));
    }
  for (uint32_t h = part->first_hull; h < part->end_hull; h = c->hulls[h].end) {
    const edge_hull *hull = &c->hulls[h];
    for (uint32_t i = 0; i < hull->n; i++)
      for (size_t k = 0; k < 3; k++) {
        const float x = points_of(c, hull)[edge_point_place(i) + k * EDGE_BLOCK];
        low[k] = lesser(low[k], (double)(x - hull->margin)), high[k] = greater(high[k], (double)(x + hull->margin));
      }
  }
  for (int k = 0; k < 3; k++) part->centre[k] = (float)(0.5 * (low[k] + high[k]));
  const vec3 centre = vec((double)part->centre[0], (double)part->centre[1], (double)part->centre[2]);
  double outer = 0.0, core = 0.0;
  for (uint32_t i = part->first; i < part->first + part->n; i++)
    take_in(part, centre, centre_of(&c->balls[i]), (double)c->balls[i].outer, &outer, &core);
  for (uint32_t h = part->first_hull; h < part->end_hull; h++) {
    const edge_hull *hull = &c->hulls[h];
    const vec3 own = vec((double)hull->centre[0], (double)hull->centre[1], (double)hull->centre[2]);
    part->reach_of_centre = greater(vec_norm(own) * (1.0 + 0x1p-40), part->reach_of_centre);
    for (uint32_t i = 0; i < hull->n; i++)
      take_in(part, centre, point_at(points_of(c, hull), i), (double)hull->margin, &outer, &core);
  }
  part->outer = float_above(outer * (1.0 + 0x1p-40)), part->core = float_above(core * (1.0 + 0x1p-40));
  part->reach = float_above(vec_norm(centre) * (1.0 + 0x1p-40));
  part->reach_of_centre = greater((double)part->reach, part->reach_of_centre);
}

/* All parts of a geometry, which stand side by side. */
static void add_geometry(cprox_edge_checker *c, const robot_covers *covers, int32_t geometry) {
  for (size_t i = 0; i < c->robot->n_parts; i++)
    if (c->robot->parts[i].geometry == geometry) {
      add_balls(c, covers, i);
      add_hulls(c, covers, i);
    }
  c->members[c->n_members++] = geometry;
}

/* Whether two geometries hang on one link and are asked about the same. */
static bool are_alike(const cprox_edge_checker *c, size_t i, size_t k) {
  const edge_rows *rows = &c->rows;
  return c->robot->given_geometries[k].link == c->robot->given_geometries[i].link &&
         memcmp(row_of(rows, i), row_of(rows, k), rows->words * sizeof *rows->bits) == 0;
}

static void fill_parts(cprox_edge_checker *c, const robot_covers *covers) {
  const cprox_robot *robot = c->robot;
  for (size_t i = 0; i < robot->n_geometries; i++) {
    const int32_t axis = robot->links[robot->given_geometries[i].link].axis;
    bool taken = !is_asked(&c->rows, i); /* by the part of one before it */
    for (size_t k = 0; k < i && !taken; k++) taken = are_alike(c, i, k);
    if (taken) continue;
    edge_part part = {.frame = axis < 0 ? 0 : c->frame_of[axis],
                      .first_member = (uint32_t)c->n_members,
                      .first = (uint32_t)c->n_balls,
                      .first_hull = (uint32_t)c->n_hulls};
    for (size_t k = i; k < robot->n_geometries; k++)
      if (are_alike(c, i, k)) add_geometry(c, covers, (int32_t)k);
    part.n_members = (uint32_t)c->n_members - part.first_member, part.n = (uint32_t)c->n_balls - part.first;
    part.end_hull = (uint32_t)c->n_hulls, part.by_hulls = part.end_hull - part.first_hull > part.n;
    enclose(c, &part);
    c->parts[c->n_parts++] = part;
  }
}

/* ---- obstacles ---- */

static bool exchanges_axes(const float r[9]) {
  for (int k = 0; k < 9; k++)
    if (r[k] != 0.0f && fabsf(r[k]) != 1.0f) return false;
  return true;
}

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

/* What a part of a target is made of, which stands in the frame f. All coordinates are within `extent` of its origin:
 * of each place lanes round its origin, its axes as any rotation, and what they turn. */
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
  snap(f->r, o->axes, from, sign);
  o->origin[0] = (float)seen.x, o->origin[1] = (float)seen.y, o->origin[2] = (float)seen.z;
  o->around = float_above(thick + growth), o->costs = float_above(4.0 * growth);
  o->within = by_tree && m->tree->kind == TREE_POINTS ? float_below(thick) : -1.0f;
  o->tree = by_tree ? m->tree : NULL;
  if (by_tree) return;
  float *corners = c->corners + c->n_corners * 3 * EDGE_BLOCK;
  o->hull = (edge_hull){.first = (uint32_t)c->n_corners, .n = (uint32_t)n, .inner = -1.0f};
  for (size_t i = 0; i < n; i++) set_point(corners, i, vec(m->shape->x[i], m->shape->y[i], m->shape->z[i]));
  c->n_corners += blocks_of(n);
  enclose_points(&o->hull, corners);
}

/* One part of a target. What its own numbers round: its place once, its axes as any rotation (7 u of a vector), its
 * sizes once; the vector from it is at most |p| and the reach of what is tested long, the latter being counted there.
 */
static void add_obstacle(cprox_edge_checker *c, const cprox_obstacle *target, size_t index, size_t part) {
  const vec3 base = c->base;
  const cprox_body *body = body_part_at(target->body, part);
  part_model m = part_model_of(body);
  cprox_pose pose = target->pose;
  double world = vec_norm(base) + vec_norm(target->pose.position) + vec_norm(m.centre); /* rounding in double */
  if (target->body->kind == CPROX_BODY_COMPOUND) {
    pose = frame_compose(&target->pose, &target->body->parts[part].pose);
    world += vec_norm(target->body->parts[part].pose.position);
  }
  const frame f = frame_create(&pose, m.centre);
  edge_obstacle o = {.target = (int32_t)index, .shape = EDGE_BALL};
  add_content(c, &m, &f, target->margin, world + vec_norm(m.tree_at), &o);
  const cprox_body_kind kind = m.shape->ops->kind;
  const double *size = m.shape->size, margin = m.margin + target->margin;
  vec3 p = frame_to_world(&f, vec(0, 0, 0));
  double sizes[3] = {margin, 0, 0}, extent = m.radius + target->margin;
  bool exact = !m.tree;
  switch (kind) {
    case CPROX_BODY_BOX: o.shape = EDGE_BOX, sizes[0] = size[0], sizes[1] = size[1], sizes[2] = size[2]; break;
    case CPROX_BODY_CAPSULE: o.shape = EDGE_CAPSULE, sizes[1] = size[1]; break;
    case CPROX_BODY_CYLINDER: o.shape = EDGE_CYLINDER, sizes[0] = size[0], sizes[1] = size[1]; break;
    case CPROX_BODY_CONE: o.shape = EDGE_CONE, sizes[0] = size[0], sizes[1] = size[1]; break;
    case CPROX_BODY_HALFSPACE: o.shape = EDGE_HALFSPACE, extent = 0.0; break;
    case CPROX_BODY_SPHERE: break;
    default:
      if (m.shape->ops == &convex_point) break;
      part_model_find_box(&m);
      exact = false, o.shape = EDGE_BOX;
      sizes[0] = m.half.x, sizes[1] = m.half.y, sizes[2] = m.half.z;
      p = frame_to_world(&f, m.middle);
      world += vec_norm(m.middle);
  }
  int32_t from[3] = {0};
  float sign[3];
  snap(f.r, o.r, from, sign);
  if (o.shape == EDGE_HALFSPACE) {
    const vec3 n = rotate(f.r, vec(size[0], size[1], size[2]));
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
  if (o.shape == EDGE_BOX && exchanges_axes(o.r)) {
    o.shape = EDGE_ALIGNED_BOX;
    double turned[3] = {0};
    for (int k = 0; k < 3; k++) turned[from[k]] = sizes[k];
    memcpy(sizes, turned, sizeof sizes);
  }
  o.margin = o.shape == EDGE_CONE || o.shape == EDGE_HALFSPACE ? float_above(margin + growth) : 0.0f;
  const double more = (grows_all ? margin : 0.0) + growth;
  const int grown = o.shape == EDGE_ALIGNED_BOX || o.shape == EDGE_BOX ? 3
                    : o.shape == EDGE_CYLINDER                         ? 2
                    : o.shape == EDGE_BALL || o.shape == EDGE_CAPSULE  ? 1
                                                                       : 0;
  for (int k = 0; k < 3; k++) o.size[k] = float_above(sizes[k] + (k < grown ? more : 0.0));
  if (o.shape == EDGE_CONE) o.size[2] = (float)(1.0 / (size[0] * size[0] + 4.0 * size[1] * size[1]));
  o.grown =
      exact ? float_above(4.0 * growth) : INFINITY; /* at a corner of a box the root of 3 of that; and both ways */
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

/* The same of a target's ball, before its parts are looked at. */
static double target_beyond(const cprox_edge_checker *c, double reach, const cprox_obstacle *target) {
  const cprox_body *body = target->body;
  if (!(body->ball_radius < INFINITY)) return -INFINITY;
  const frame f = frame_create(&target->pose, body->ball_centre);
  const double apart = vec_norm(vec_sub(frame_to_world(&f, vec(0, 0, 0)), c->base));
  const double world = vec_norm(c->base) + vec_norm(target->pose.position) + vec_norm(body->ball_centre);
  return left_of(c, apart - ROUND_WORLD * world, reach, body->ball_radius + target->margin);
}

/* ---- pairs ---- */

static void fill_near(cprox_edge_checker *c, const double *reach) {
  for (size_t i = 0; i < c->n_parts; i++) {
    edge_part *part = &c->parts[i];
    const double own = reach ? reach[i] : reach_of(c, part);
    part->first_near = (uint32_t)c->n_near;
    for (size_t k = 0; k < c->n_obstacles; k++) {
      if (!asks_about(&c->rows, c->members[part->first_member], (size_t)c->obstacles[k].target)) continue;
      const double left = obstacle_beyond(c, own, &c->obstacles[k]);
      if (left > 0.0)
        c->beyond = lesser(left, c->beyond);
      else
        c->near[c->n_near++] = (uint32_t)k;
    }
    part->n_near = (uint32_t)c->n_near - part->first_near;
  }
}

static bool is_above(const cprox_edge_checker *c, int32_t own, int32_t other) {
  while (other > own) other = c->frames[other].parent;
  return other == own;
}

static int32_t common_frame(const cprox_edge_checker *c, int32_t a, int32_t b) {
  while (!is_above(c, a, b)) a = c->frames[a].parent;
  return a;
}

static int32_t shift_of(const cprox_edge_checker *c, int32_t own) {
  return own > 0 && c->frames[own].shifts ? own : -1;
}

/* From b up to what is above both, then down to a. */
static void fill_relation(cprox_edge_checker *c, edge_relation *to) {
  const edge_frame *frames = c->frames;
  const int32_t common = common_frame(c, to->a, to->b);
  int32_t up = -1; /* the last axis on the way up */
  to->first = (uint32_t)c->n_steps;
  for (int32_t f = to->b; f != common; f = frames[f].parent) {
    c->steps[c->n_steps++] =
        (edge_step){.frame = f, .shifted = up < 0 ? -1 : shift_of(c, up), .length = up < 0 ? 0.0 : frames[up].length};
    up = f;
  }
  const uint32_t first_down = (uint32_t)c->n_steps;
  for (int32_t f = to->a; f != common; f = frames[f].parent) c->steps[c->n_steps++] = (edge_step){.frame = f};
  for (uint32_t i = first_down, k = (uint32_t)c->n_steps; i + 1 < k; i++) { /* from the top down */
    const edge_step swapped = c->steps[i];
    c->steps[i] = c->steps[--k], c->steps[k] = swapped;
  }
  for (uint32_t i = first_down; i < c->n_steps; i++) {
    edge_step *step = &c->steps[i];
    const edge_frame *f = &frames[step->frame];
    step->length = f->length, step->shifted = -1;
    if (i > first_down)
      step->shifted = shift_of(c, f->parent);
    else if (up >= 0) {
      const edge_frame *u = &frames[up];
      const vec3 apart =
          vec((double)u->p[0] - (double)f->p[0], (double)u->p[1] - (double)f->p[1], (double)u->p[2] - (double)f->p[2]);
      step->length = vec_norm(apart) + 2.0 * EDGE_U * (u->length + f->length), step->shifted = shift_of(c, up);
    }
  }
  to->n = (uint32_t)c->n_steps - to->first;
  to->last = to->a == common
                 ? (edge_step){.shifted = up < 0 ? -1 : shift_of(c, up), .length = up < 0 ? 0.0 : frames[up].length}
                 : (edge_step){.shifted = shift_of(c, to->a)};
}

static uint32_t relation_of(cprox_edge_checker *c, int32_t a, int32_t b) {
  for (size_t i = 0; i < c->n_relations; i++)
    if (c->relations[i].a == a && c->relations[i].b == b) return (uint32_t)i;
  edge_relation *made = &c->relations[c->n_relations];
  *made = (edge_relation){.a = a, .b = b};
  fill_relation(c, made);
  return (uint32_t)c->n_relations++;
}

/* Of two parts all geometries are asked about each other, or none are. */
static void fill_lane_pairs(cprox_edge_checker *c) {
  const edge_rows *rows = &c->rows;
  for (uint32_t x = 0; x < c->n_parts; x++)
    for (uint32_t y = 0; y < x; y++) {
      const int32_t one = c->members[c->parts[x].first_member], other = c->members[c->parts[y].first_member];
      if (!is_noted(rows, one, rows->n_obstacles + (size_t)other)) continue;
      const bool first_moves = c->parts[x].frame >= c->parts[y].frame;
      edge_pair pair = {.a = first_moves ? x : y, .b = first_moves ? y : x};
      pair.relation = relation_of(c, c->parts[pair.a].frame, c->parts[pair.b].frame);
      c->lane_pairs[c->n_lane_pairs++] = pair;
    }
}

/* All pairs that are asked about, in order; `to` NULL: their number. */
static size_t list_pairs(const cprox_robot *robot, const cprox_edge_query *q, cprox_robot_pair *to) {
  if (q->pairs) {
    if (to && q->n_pairs > 0) memcpy(to, q->pairs, q->n_pairs * sizeof *to);
    return q->n_pairs;
  }
  size_t n = 0;
  for (size_t g = 0; g < robot->n_geometries; g++)
    for (size_t k = 0; k < obstacles_count(q->obstacles); k++, n++)
      if (to) to[n] = (cprox_robot_pair){(int32_t)g, (int32_t)k};
  return n;
}

static size_t list_self_pairs(const cprox_robot *robot, const cprox_edge_query *q, cprox_robot_pair *to) {
  if (q->without_self) return 0;
  if (q->self_pairs) {
    if (to && q->n_self_pairs > 0) memcpy(to, q->self_pairs, q->n_self_pairs * sizeof *to);
    return q->n_self_pairs;
  }
  size_t n = 0;
  for (size_t g = 0; g < robot->n_geometries; g++)
    for (size_t k = 0; k < g; k++) {
      if (!is_worth_asking(robot, g, k)) continue;
      if (to) to[n] = (cprox_robot_pair){(int32_t)g, (int32_t)k};
      n++;
    }
  return n;
}

/* ---- making ---- */

static cprox_status check_pairs(const cprox_robot_pair *pairs, size_t n, size_t others, const char *what,
                                size_t geometries, cprox_workspace *workspace) {
  for (size_t i = 0; pairs && i < n; i++) {
    const cprox_robot_pair p = pairs[i];
    if (p.geometry < 0 || (size_t)p.geometry >= geometries)
      return workspace_fail(workspace, CPROX_INVALID, "pair %zu: there is no geometry %d: the robot has %zu", i,
                            (int)p.geometry, geometries);
    if (p.other < 0 || (size_t)p.other >= others)
      return workspace_fail(workspace, CPROX_INVALID, "pair %zu: there is no %s %d: there are %zu", i, what,
                            (int)p.other, others);
  }
  return CPROX_OK;
}

static cprox_status check(const cprox_robot *robot, const cprox_edge_query *q, cprox_workspace *workspace) {
  if (!(q->delta >= 0.0) || isinf(q->delta))
    return workspace_fail(workspace, CPROX_INVALID, "delta is %g, must be finite and >= 0", q->delta);
  if (!(q->rounding >= 0.0) || isinf(q->rounding))
    return workspace_fail(workspace, CPROX_INVALID, "rounding is %g, must be finite and >= 0", q->rounding);
  if ((q->n_pairs > 0 && !q->pairs) || (q->n_self_pairs > 0 && !q->self_pairs))
    return workspace_fail(workspace, CPROX_INVALID, "%s is NULL", q->n_pairs > 0 && !q->pairs ? "pairs" : "self_pairs");
  if (q->first && (q->delta > 0.0 || q->rounding > 0.0))
    return workspace_fail(workspace, CPROX_INVALID,
                          "the time of contact is that of collision: first needs delta = 0 and rounding = 0");
  for (size_t i = 0; i < obstacles_count(q->obstacles); i++) {
    const cprox_obstacle *o = &q->obstacles->targets[i];
    if (!o->body || o->curve || o->body->field)
      return workspace_fail(workspace, CPROX_INVALID, "obstacle %zu is %s: a robot is asked about bodies", i,
                            o->body && o->body->field ? "known by its distance alone" : "a curve");
  }
  const cprox_status status =
      check_pairs(q->pairs, q->n_pairs, obstacles_count(q->obstacles), "obstacle", robot->n_geometries, workspace);
  if (status != CPROX_OK) return status;
  for (size_t i = 0; i < q->n_self_pairs; i++)
    if (q->self_pairs[i].geometry == q->self_pairs[i].other)
      return workspace_fail(workspace, CPROX_INVALID, "pair %zu: geometry %d is asked about itself", i,
                            (int)q->self_pairs[i].other);
  return check_pairs(q->self_pairs, q->n_self_pairs, robot->n_geometries, "geometry", robot->n_geometries, workspace);
}

/* Arrays in one block; without a block their sizes are added up. */
typedef struct arena {
  char *at;
  size_t bytes;
} arena;

static void *take(arena *a, size_t n, size_t size) {
  void *here = a->at ? a->at + a->bytes : NULL;
  a->bytes += (n * size + 15) / 16 * 16;
  return here;
}

size_t edge_model_count_pairs(const edge_asked *asked) {
  const size_t n = asked->robot->n_geometries, all = n < 2 ? 0 : n * (n - 1) / 2;
  if (!asked->about_self) return 0;
  return asked->self_pairs && asked->n_self_pairs < all ? asked->n_self_pairs : all;
}

static void lay_out_robot(cprox_edge_checker *c, const edge_asked *asked, const robot_covers *covers, arena *a) {
  const cprox_robot *robot = asked->robot;
  const size_t frames = robot->n_axes + 1, pairs = edge_model_count_pairs(asked);
  size_t deepest = 0;
  for (size_t i = 0; i < robot->n_axes; i++) deepest = robot->axes[i].depth > deepest ? robot->axes[i].depth : deepest;
  const size_t different = pairs < frames * frames ? pairs : frames * frames;
  c->rows = rows_of(asked);
  c->rows.bits = take(a, robot->n_geometries * c->rows.words, sizeof *c->rows.bits);
  c->frames = take(a, frames, sizeof *c->frames);
  c->frame_of = take(a, frames, sizeof *c->frame_of);
  c->parts = take(a, robot->n_geometries, sizeof *c->parts);
  c->members = take(a, robot->n_geometries, sizeof *c->members);
  const size_t balls = covers->first[robot->n_parts], hulls = covers->hulls.n, alike = hulls > 0 ? balls : 0;
  c->balls = take(a, balls, sizeof *c->balls);
  c->hulls = take(a, hulls + alike, sizeof *c->hulls);
  size_t blocks = alike;
  for (size_t i = 0; i < hulls; i++) blocks += blocks_of(covers->hulls.hull[i].n);
  c->points = take(a, blocks * 3 * EDGE_BLOCK, sizeof *c->points);
  c->lane_pairs = take(a, pairs, sizeof *c->lane_pairs);
  c->relations = take(a, different, sizeof *c->relations);
  c->steps = take(a, different * 2 * (deepest + 1), sizeof *c->steps);
}

size_t edge_model_robot_size(const edge_asked *asked, const robot_covers *covers) {
  cprox_edge_checker none = {0};
  arena a = {0};
  lay_out_robot(&none, asked, covers, &a);
  return a.bytes;
}

void edge_model_fill_robot(cprox_edge_checker *c, const edge_asked *asked, const robot_covers *covers, char *memory) {
  const cprox_robot *robot = asked->robot;
  arena a = {.at = memory};
  lay_out_robot(c, asked, covers, &a);
  c->robot = robot;
  c->base = robot->n_axes > 0 ? robot->axes[0].at.p : vec(0, 0, 0);
  fill_rows(&c->rows, asked);
  mark_axes(robot, &c->rows, c->frame_of);
  c->in_lanes = fill_frames(c);
  if (!c->in_lanes) return;
  fill_parts(c, covers);
  fill_lane_pairs(c);
}

static void lay_out_scene(cprox_edge_checker *c, const cprox_obstacle *targets, size_t first, size_t last, arena *a) {
  size_t n_obstacles = 0, n_corners = 0;
  for (size_t i = first; i < last; i++)
    for (size_t k = 0; k < body_n_parts(targets[i].body); k++, n_obstacles++) {
      const part_model m = part_model_of(body_part_at(targets[i].body, k));
      n_corners += blocks_of(corners_of(&m));
    }
  c->obstacles = take(a, n_obstacles, sizeof *c->obstacles);
  c->near = take(a, c->n_parts * n_obstacles, sizeof *c->near);
  c->corners = take(a, n_corners * 3 * EDGE_BLOCK, sizeof *c->corners);
}

size_t edge_model_scene_size(const cprox_edge_checker *c, const cprox_obstacle *targets, size_t first, size_t last) {
  cprox_edge_checker none = {.n_parts = c->n_parts};
  arena a = {0};
  lay_out_scene(&none, targets, first, last, &a);
  return a.bytes + 16;
}

void edge_model_fill_scene(cprox_edge_checker *c, const cprox_obstacle *targets, size_t first, size_t last,
                           const double *reach, char *memory) {
  arena a = {.at = memory};
  double farthest = 0.0;
  for (size_t i = 0; i < c->n_parts; i++) farthest = greater(reach ? reach[i] : reach_of(c, &c->parts[i]), farthest);
  lay_out_scene(c, targets, first, last, &a);
  c->n_obstacles = c->n_near = c->n_corners = 0, c->obstacle_reach = 0.0, c->beyond = INFINITY;
  for (size_t i = first; i < last; i++) {
    const double left = target_beyond(c, farthest, &targets[i]);
    if (left > 0.0) c->beyond = lesser(left, c->beyond);
    for (size_t k = 0; !(left > 0.0) && k < body_n_parts(targets[i].body); k++) add_obstacle(c, &targets[i], i, k);
  }
  fill_near(c, reach);
  c->in_lanes = c->in_lanes && c->obstacle_reach <= EDGE_REACH_MOST;
}

/* A handle's two sides. */
static cprox_status fill(cprox_edge_checker *c, cprox_workspace *workspace) {
  const cprox_edge_query *q = &c->asked;
  const size_t n = obstacles_count(q->obstacles);
  const edge_asked asked = {.robot = c->robot,
                            .about_obstacles = true,
                            .about_self = true,
                            .pairs = q->pairs ? c->pairs : NULL,
                            .n_pairs = c->n_pairs,
                            .self_pairs = c->pairs + c->n_pairs,
                            .n_self_pairs = c->n_self_pairs,
                            .n_obstacles = n};
  const robot_covers *covers = robot_covers_of(c->robot);
  if (covers) c->memory[0] = malloc(edge_model_robot_size(&asked, covers) + 1);
  if (c->memory[0]) {
    edge_model_fill_robot(c, &asked, covers, c->memory[0]);
    c->memory[1] = malloc(edge_model_scene_size(c, obstacles_list(q->obstacles), 0, n) + 1);
  }
  if (!c->memory[1])
    return workspace_fail(workspace, CPROX_MEMORY, "no memory for %zu obstacles and %zu pairs", n, c->n_self_pairs);
  if (c->in_lanes) edge_model_fill_scene(c, obstacles_list(q->obstacles), 0, n, NULL, c->memory[1]);
  return CPROX_OK;
}

cprox_status cprox_edge_checker_create(const cprox_robot *robot, const cprox_edge_query *asked,
                                       cprox_workspace *workspace, cprox_edge_checker **checker) {
  WORKSPACE_USE(workspace);
  workspace_clear(workspace);
  if (!robot || !checker) return workspace_fail(workspace, CPROX_INVALID, "%s is NULL", robot ? "checker" : "robot");
  const cprox_edge_query q = asked ? *asked : (cprox_edge_query){0};
  cprox_status status = check(robot, &q, workspace);
  if (status != CPROX_OK) return status;
  cprox_edge_checker *c = calloc(1, sizeof *c);
  if (c) {
    *c = (cprox_edge_checker){.robot = robot, .asked = q, .clear_beyond = q.delta, .hit_within = q.delta};
    if (q.rounding > 0.0) { /* sums in double are rounded, too */
      c->clear_beyond = nextafter(q.delta + q.rounding, INFINITY);
      c->hit_within = greater(nextafter(q.delta - q.rounding, 0.0), 0.0);
    }
    c->n_pairs = list_pairs(robot, &q, NULL), c->n_self_pairs = list_self_pairs(robot, &q, NULL);
    c->pairs = calloc(c->n_pairs + c->n_self_pairs + 1, sizeof *c->pairs);
  }
  if (!c || !c->pairs) {
    free(c);
    return workspace_fail(workspace, CPROX_MEMORY, "no memory for a robot's pairs");
  }
  list_pairs(robot, &q, c->pairs), list_self_pairs(robot, &q, c->pairs + c->n_pairs);
  status = fill(c, workspace);
  if (status != CPROX_OK) {
    cprox_edge_checker_free(c);
    return status;
  }
  *checker = c;
  return CPROX_OK;
}

void cprox_edge_checker_free(cprox_edge_checker *checker) {
  if (!checker) return;
  free(checker->pairs);
  free(checker->memory[0]);
  free(checker->memory[1]);
  free(checker);
}
