/* SPDX-License-Identifier: BSD-3-Clause */
#include "edges/edge_model.h"

#include <math.h>
#include <string.h>

#include "edges/edge_build.h"

/* ---- frames ---- */

static placement turned_back(const placement *turn, const placement *at) {
  placement out = {.p = rotate_back(turn->r, at->p)};
  const double *t = turn->r;
  const double back[9] = {t[0], t[3], t[6], t[1], t[4], t[7], t[2], t[5], t[8]};
  rotation_compose(back, at->r, out.r);
  return out;
}

/* ---- what is asked ---- */

static void note(const edge_rows *rows, int32_t geometry, size_t bit) {
  edge_row_of(rows, (size_t)geometry)[bit / 64] |= (uint64_t)1 << (bit % 64);
}

static bool is_asked(const edge_rows *rows, size_t geometry) {
  for (size_t w = 0; w < rows->words; w++)
    if (edge_row_of(rows, geometry)[w]) return true;
  return false;
}

static void note_two(const edge_rows *rows, int32_t geometry, int32_t other) {
  note(rows, geometry, rows->n_obstacles + (size_t)other);
  note(rows, other, rows->n_obstacles + (size_t)geometry);
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
      if (robot_is_worth_asking(asked->robot, g, k)) note_two(rows, (int32_t)g, (int32_t)k);
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
      const placement above = edge_turn_of_axis(&robot->axes[axis->parent]);
      at = turned_back(&above, &at);
    }
    const placement own = edge_turn_of_axis(axis);
    double r[9];
    rotation_compose(at.r, own.r, r);
    *f = (edge_frame){.parent = axis->parent < 0 ? 0 : frame_of[axis->parent],
                      .variable = axis->variable,
                      .shifts = axis->kind == AXIS_PRISMATIC,
                      .multiplier = axis->multiplier,
                      .offset = axis->offset,
                      .p = {(float)at.p.x, (float)at.p.y, (float)at.p.z},
                      .length = vec_norm(at.p)};
    if (!edge_snap(r, f->r, f->from, f->sign)) f->from[0] = -1;
    f->fixed_reach = c->frames[f->parent].fixed_reach + f->length;
  }
  return true;
}

/* ---- parts ---- */

/* Where a part of the robot is in its frame as lanes have it. */
static placement place_in_frame(const cprox_edge_checker *c, const robot_part *part) {
  placement at = part->at;
  if (part->axis >= 0) {
    const placement turn = edge_turn_of_axis(&c->robot->axes[part->axis]);
    return turned_back(&turn, &at);
  }
  at.p = vec_sub(at.p, c->base);
  return at;
}

static const float *points_of(const cprox_edge_checker *c, const edge_hull *hull) {
  return c->points + (size_t)hull->first * 3 * EDGE_BLOCK;
}

/* A hull of n points. */
static edge_hull *add_hull(cprox_edge_checker *c, const placement *at, const vec3 *points, size_t n, double margin,
                           double inner, int32_t geometry) {
  edge_hull *hull = &c->hulls[c->n_hulls++];
  float *own = c->points + c->n_blocks * 3 * EDGE_BLOCK;
  *hull = (edge_hull){.first = (uint32_t)c->n_blocks,
                      .n = (uint32_t)n,
                      .margin = edge_float_above(margin),
                      .inner = edge_float_below(inner),
                      .end = (uint32_t)c->n_hulls,
                      .geometry = geometry};
  for (size_t i = 0; i < n; i++) edge_set_point(own, i, placement_apply(at, points[i]));
  c->n_blocks += edge_blocks_of(n);
  edge_enclose_points(hull, own);
  return hull;
}

static void add_balls(cprox_edge_checker *c, const robot_covers *covers, size_t i) {
  const robot_part *part = &c->robot->parts[i];
  const placement at = place_in_frame(c, part);
  for (size_t k = covers->first[i]; k < covers->first[i + 1]; k++) {
    const cover_ball *ball = &covers->balls[k];
    const vec3 p = placement_apply(&at, ball->centre);
    c->balls[c->n_balls++] = (edge_ball){.centre = {(float)p.x, (float)p.y, (float)p.z},
                                         .outer = edge_float_above(ball->outer),
                                         .inner = edge_float_below(ball->inner),
                                         .reach = edge_float_above(vec_norm(p) * (1.0 + EDGE_U)),
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
      take_in(part, centre, edge_point(points_of(c, hull), i), (double)hull->margin, &outer, &core);
  }
  part->outer = edge_float_above(outer * (1.0 + 0x1p-40)), part->core = edge_float_above(core * (1.0 + 0x1p-40));
  part->reach = edge_float_above(vec_norm(centre) * (1.0 + 0x1p-40));
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
         memcmp(edge_row_of(rows, i), edge_row_of(rows, k), rows->words * sizeof *rows->bits) == 0;
}

static int32_t frame_of_geometry(const cprox_edge_checker *c, size_t i) {
  const int32_t axis = c->robot->links[c->robot->given_geometries[i].link].axis;
  return axis < 0 ? 0 : c->frame_of[axis];
}

/* The part of a geometry and of all like it that come after it. */
static void add_part(cprox_edge_checker *c, const robot_covers *covers, size_t i) {
  edge_part part = {.frame = frame_of_geometry(c, i),
                    .first_member = (uint32_t)c->n_members,
                    .first = (uint32_t)c->n_balls,
                    .first_hull = (uint32_t)c->n_hulls};
  for (size_t k = i; k < c->robot->n_geometries; k++)
    if (are_alike(c, i, k)) add_geometry(c, covers, (int32_t)k);
  part.n_members = (uint32_t)c->n_members - part.first_member, part.n = (uint32_t)c->n_balls - part.first;
  part.end_hull = (uint32_t)c->n_hulls, part.by_hulls = part.end_hull - part.first_hull > part.n;
  enclose(c, &part);
  c->parts[c->n_parts++] = part;
}

/* From the base to the tips, in whatever order a robot's file lists its links: pairs are asked in this order, so that
 * contact is found as soon. */
static void fill_parts(cprox_edge_checker *c, const robot_covers *covers) {
  for (size_t f = 0; f < c->n_frames; f++)
    for (size_t i = 0; i < c->robot->n_geometries; i++) {
      if (!is_asked(&c->rows, i) || frame_of_geometry(c, i) != (int32_t)f) continue;
      bool taken = false; /* by the part of one before it */
      for (size_t k = 0; k < i && !taken; k++) taken = are_alike(c, i, k);
      if (!taken) add_part(c, covers, i);
    }
}

/* ---- pairs ---- */

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
      if (!edge_is_noted(rows, one, rows->n_obstacles + (size_t)other)) continue;
      const bool first_moves = c->parts[x].frame >= c->parts[y].frame;
      edge_pair pair = {.a = first_moves ? x : y, .b = first_moves ? y : x};
      pair.relation = relation_of(c, c->parts[pair.a].frame, c->parts[pair.b].frame);
      c->lane_pairs[c->n_lane_pairs++] = pair;
    }
}

/* ---- making ---- */

size_t edge_model_count_pairs(const edge_asked *asked) {
  const size_t n = asked->robot->n_geometries, all = n < 2 ? 0 : n * (n - 1) / 2;
  if (!asked->about_self) return 0;
  return asked->self_pairs && asked->n_self_pairs < all ? asked->n_self_pairs : all;
}

static void lay_out_robot(cprox_edge_checker *c, const edge_asked *asked, const robot_covers *covers, edge_arena *a) {
  const cprox_robot *robot = asked->robot;
  const size_t frames = robot->n_axes + 1, pairs = edge_model_count_pairs(asked);
  size_t deepest = 0;
  for (size_t i = 0; i < robot->n_axes; i++) deepest = robot->axes[i].depth > deepest ? robot->axes[i].depth : deepest;
  const size_t different = pairs < frames * frames ? pairs : frames * frames;
  c->rows = rows_of(asked);
  c->rows.bits = edge_take(a, robot->n_geometries * c->rows.words, sizeof *c->rows.bits);
  c->frames = edge_take(a, frames, sizeof *c->frames);
  c->frame_of = edge_take(a, frames, sizeof *c->frame_of);
  c->parts = edge_take(a, robot->n_geometries, sizeof *c->parts);
  c->members = edge_take(a, robot->n_geometries, sizeof *c->members);
  const size_t balls = covers->first[robot->n_parts], hulls = covers->hulls.n, alike = hulls > 0 ? balls : 0;
  c->balls = edge_take(a, balls, sizeof *c->balls);
  c->hulls = edge_take(a, hulls + alike, sizeof *c->hulls);
  size_t blocks = alike;
  for (size_t i = 0; i < hulls; i++) blocks += edge_blocks_of(covers->hulls.hull[i].n);
  c->points = edge_take(a, blocks * 3 * EDGE_BLOCK, sizeof *c->points);
  c->lane_pairs = edge_take(a, pairs, sizeof *c->lane_pairs);
  c->relations = edge_take(a, different, sizeof *c->relations);
  c->steps = edge_take(a, different * 2 * (deepest + 1), sizeof *c->steps);
}

size_t edge_model_robot_size(const edge_asked *asked, const robot_covers *covers) {
  cprox_edge_checker none = {0};
  edge_arena a = {0};
  lay_out_robot(&none, asked, covers, &a);
  return a.bytes;
}

void edge_model_fill_robot(cprox_edge_checker *c, const edge_asked *asked, const robot_covers *covers, char *memory) {
  const cprox_robot *robot = asked->robot;
  edge_arena a = {.at = memory};
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

/* ---- the robot's side, kept ---- */

/* Beyond these the trees and groups of the search find what is near sooner than lanes do. */
enum { MOST_PAIRS = 4096, MOST_PARTS = 1024 };

/* One of so many parts may have a cover that tells little. */
enum { MOST_COARSE = 4 };

/* The robot's side stays in the workspace from query to query. It is the same model as long as the robot's
 * signature and what is asked about are the same, byte by byte, whatever handles they came with. */
typedef struct kept_model {
  cprox_edge_checker model;
  size_t n_key;
  edge_asked asked;
} kept_model;

static bool is_same_list(const cprox_robot_pair *a, const char *b, size_t n) {
  return n == 0 || (a && memcmp(a, b, n * sizeof *a) == 0);
}

static bool is_kept(const kept_model *kept, const edge_asked *asked, const robot_covers *covers) {
  const edge_asked *old = &kept->asked;
  const size_t pairs = asked->n_pairs * sizeof *asked->pairs, selves = asked->n_self_pairs * sizeof *asked->pairs;
  if (kept->n_key != covers->n_signature + pairs + selves || old->n_pairs != asked->n_pairs ||
      old->n_self_pairs != asked->n_self_pairs || old->n_obstacles != asked->n_obstacles ||
      old->about_obstacles != asked->about_obstacles || old->about_self != asked->about_self ||
      !old->pairs != !asked->pairs || !old->self_pairs != !asked->self_pairs)
    return false;
  const char *key = (const char *)(kept + 1);
  return memcmp(covers->signature, key, covers->n_signature) == 0 &&
         is_same_list(asked->pairs, key + covers->n_signature, asked->n_pairs) &&
         is_same_list(asked->self_pairs, key + covers->n_signature + pairs, asked->n_self_pairs);
}

static void write_key(kept_model *kept, const edge_asked *asked, const robot_covers *covers) {
  const size_t pairs = asked->n_pairs * sizeof *asked->pairs, selves = asked->n_self_pairs * sizeof *asked->pairs;
  char *key = (char *)(kept + 1);
  memcpy(key, covers->signature, covers->n_signature);
  if (pairs > 0) memcpy(key + covers->n_signature, asked->pairs, pairs);
  if (selves > 0) memcpy(key + covers->n_signature + pairs, asked->self_pairs, selves);
  kept->n_key = covers->n_signature + pairs + selves;
}

/* Balls that are not the part itself tell little of what is near, and there are many of them: such parts are left to
 * the search where their own ball comes near something. A robot with more than a few of them is left to it
 * altogether. */
static void mark_coarse(cprox_edge_checker *c) {
  size_t n = 0;
  for (size_t i = 0; i < c->n_parts; i++) {
    edge_part *part = &c->parts[i];
    for (uint32_t k = part->first; k < part->first + part->n; k++)
      part->coarse = part->coarse || cover_is_coarse((double)c->balls[k].outer, (double)c->balls[k].inner);
    n += part->coarse;
  }
  c->in_lanes = c->in_lanes && MOST_COARSE * n <= c->n_parts;
}

cprox_edge_checker *edge_model_keep(const edge_asked *asked, cprox_workspace *workspace, workspace_buffer buffer) {
  if (asked->robot->n_parts > MOST_PARTS || edge_model_count_pairs(asked) > MOST_PAIRS) return NULL;
  const robot_covers *covers = robot_covers_of(asked->robot);
  if (!covers || MOST_COARSE * covers->n_coarse > asked->robot->n_parts) return NULL;
  kept_model *kept = workspace_filled(workspace, buffer);
  if (kept && is_kept(kept, asked, covers)) {
    kept->model.robot = asked->robot;
    return &kept->model;
  }
  const size_t bytes = edge_model_robot_size(asked, covers);
  const size_t pairs = (asked->n_pairs + asked->n_self_pairs) * sizeof *asked->pairs;
  const size_t key = (sizeof *kept + covers->n_signature + pairs + 63) / 64 * 64;
  kept = workspace_reserve(workspace, buffer, key + bytes);
  if (!kept) return NULL;
  memset(kept, 0, sizeof *kept);
  kept->asked = *asked;
  write_key(kept, asked, covers);
  edge_model_fill_robot(&kept->model, asked, covers, (char *)kept + key);
  mark_coarse(&kept->model);
  return &kept->model;
}
