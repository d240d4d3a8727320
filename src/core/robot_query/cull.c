/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/cull.h"

#include <math.h>
#include <string.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "broadphase/obstacle_set.h"
#include "simd/dispatch.h"

/* ---- which pairs there are already ---- */

/* Of a part and a target their first pair, of the part -1 the target's first obstacle. An open table, at most half
 * full. */
struct cluster_slot {
  int32_t part, first; /* first < 0: nothing is here */
  uint32_t target;
};

enum { FIRST_ROOM = 64 };

static struct cluster_slot *slot_of(struct cluster_slot *table, size_t room, int32_t part, uint32_t target) {
  const uint64_t key = ((uint64_t)(uint32_t)part << 32 | target) * 0x9e3779b97f4a7c15u;
  size_t i = (size_t)(key >> 32) & (room - 1);
  while (table[i].first >= 0 && (table[i].part != part || table[i].target != target)) i = (i + 1) & (room - 1);
  return &table[i];
}

static void empty(struct cluster_slot *table, size_t room) {
  for (size_t i = 0; i < room; i++) table[i].first = -1;
}

/* Room for one more; the larger table is made behind the old one, then takes its place. */
static bool make_room(robot_scene *s) {
  const size_t old = s->cluster_room, room = old ? 2 * old : FIRST_ROOM;
  if (old && 2 * s->cluster_count < old) return true;
  struct cluster_slot *table =
      workspace_reserve(s->q->workspace, WORKSPACE_ROBOT_CLUSTER, (old + room) * sizeof *table);
  if (!table) return false;
  empty(table + old, room);
  for (size_t i = 0; i < old; i++)
    if (table[i].first >= 0) *slot_of(table + old, room, table[i].part, table[i].target) = table[i];
  memmove(table, table + old, room * sizeof *table);
  s->cluster_table = table;
  s->cluster_room = room;
  return true;
}

static void note(robot_scene *s, int32_t part, uint32_t target, int32_t first) {
  *slot_of(s->cluster_table, s->cluster_room, part, target) =
      (struct cluster_slot){.part = part, .first = first, .target = target};
  s->cluster_count++;
}

int32_t cluster_pairs(robot_scene *s, int32_t part, uint32_t box, size_t *count) {
  const uint32_t target = s->q->set->of_box[box];
  *count = body_n_parts(s->q->targets[target].body);
  if (!make_room(s)) return -1;
  const int32_t known = slot_of(s->cluster_table, s->cluster_room, part, target)->first;
  if (known >= 0) return known;

  int32_t obstacle = slot_of(s->cluster_table, s->cluster_room, -1, target)->first;
  if (obstacle < 0) {
    obstacle = robot_scene_add_obstacles(s, target);
    if (obstacle < 0) return -1;
    note(s, -1, target, obstacle);
    if (!make_room(s)) return -1;
  }
  int32_t first = -1;
  for (size_t i = 0; i < *count; i++) {
    const robot_pair pair = {.moving = part, .standing = obstacle + (int32_t)i, .element = {-1, -1}, .near = {-1, -1}};
    const int32_t added = robot_scene_add_pair(s, &pair);
    if (added < 0) return -1;
    if (i == 0) first = added;
  }
  note(s, part, target, first);
  return first;
}

/* ---- boxes ---- */

/* Of a point from eight boxes: their least coordinates, then their greatest, a row for each axis. */
SIMD_CLONES
static void from_boxes(const double *rows, vec3 p, double *distance) {
  const double *restrict r = rows;
  double *restrict out = distance;
#pragma omp simd
  for (int l = 0; l < TREE_LANES; l++) {
    double x = greater(r[l] - p.x, p.x - r[3 * TREE_LANES + l]);
    double y = greater(r[TREE_LANES + l] - p.y, p.y - r[4 * TREE_LANES + l]);
    double z = greater(r[2 * TREE_LANES + l] - p.z, p.z - r[5 * TREE_LANES + l]);
    x = greater(x, 0.0), y = greater(y, 0.0), z = greater(z, 0.0);
    out[l] = sqrt(x * x + y * y + z * z);
  }
}

void cluster_measure(robot_scene *s, int32_t part, uint32_t at, double displacement, cluster_lanes *lanes) {
  const obstacle_bvh *set = s->q->set;
  const tree *t = set->boxes;
  const robot_pair any = {.moving = part, .element = {-1, -1}};
  const robot_body *body = robot_scene_moving(s, &any);
  const vec3 centre = vec_sub(body->side.at.p, set->centre);
  const bool leaf = (at & TREE_LEAF) != 0;
  const uint32_t pack = at & ~TREE_LEAF;
  from_boxes(leaf ? t->packs + (size_t)pack * tree_pack_size(TREE_BOXES) : t->nodes[at].low[0], centre, lanes->apart);

  const double sizes = vec_norm(body->side.at.p) + vec_norm(set->centre) + t->scale + body->radius;
  const double off = body->radius + ROUND_UP * (body->side.error + TREE_ROUND * ROUND_U * sizes);
  lanes->live = leaf ? 0 : t->nodes[at].lanes;
  for (uint32_t l = 0; l < TREE_LANES; l++) {
    lanes->apart[l] -= off;
    lanes->lower[l] = lanes->apart[l] - displacement;
    lanes->under[l] = leaf ? tree_element(t, (tree_place){pack, l}) : t->nodes[at].child[l];
    if (leaf && (l == 0 || lanes->under[l] != lanes->under[l - 1])) lanes->live |= 1u << l;
  }
}
