/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/cull.h"

#include <math.h>

#include "base/rounding.h"
#include "broadphase/obstacle_set.h"
#include "simd/dispatch.h"

/* ---- pairs ---- */

int32_t cluster_pairs(robot_scene *s, int32_t part, uint32_t box, size_t *count) {
  const uint32_t target = s->q->set->of_box[box];
  *count = body_n_parts(s->q->targets[target].body);
  const int32_t known = pair_table_find(&s->met, MADE_PAIRS, part, target);
  if (known >= 0) return known;

  int32_t obstacle = pair_table_find(&s->met, MADE_OBSTACLES, 0, target);
  if (obstacle < 0) {
    obstacle = robot_scene_add_obstacles(s, target);
    if (obstacle < 0 || !pair_table_note(&s->met, s->q->workspace, MADE_OBSTACLES, 0, target, obstacle)) return -1;
  }
  int32_t first = -1;
  for (size_t i = 0; i < *count; i++) {
    const robot_pair pair = {.moving = part, .standing = obstacle + (int32_t)i, .element = {-1, -1}, .near = {-1, -1}};
    const int32_t added = robot_scene_add_pair(s, &pair);
    if (added < 0) return -1;
    if (i == 0) first = added;
  }
  return pair_table_note(&s->met, s->q->workspace, MADE_PAIRS, part, target, first) ? first : -1;
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
