/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/cluster.h"

#include <math.h>

#include "base/rounding.h"
#include "broadphase/obstacle_set.h"
#include "robot_query/deviation.h"
#include "simd/dispatch.h"

static const double LANE_BITS[TREE_LANES] = {1, 2, 4, 8, 16, 32, 64, 128};

/* ---- pairs ---- */

int32_t cluster_pairs(robot_scene *s, int32_t part, uint32_t box, size_t *count) {
  const uint32_t obstacle = s->q->set->of_box[box];
  *count = body_n_parts(s->q->obstacles[obstacle].body);
  const int32_t known = pair_table_find(&s->met, MADE_PAIRS, part, obstacle);
  if (known >= 0) return known;

  int32_t element = pair_table_find(&s->met, MADE_OBSTACLES, 0, obstacle);
  if (element < 0) {
    element = robot_scene_add_obstacles(s, obstacle);
    if (element < 0 || !pair_table_note(&s->met, s->q->workspace, MADE_OBSTACLES, 0, obstacle, element)) return -1;
  }
  int32_t first = -1;
  for (size_t i = 0; i < *count; i++) {
    const planned_pair two = {.moving = part, .standing = element + (int32_t)i};
    const robot_pair pair = robot_scene_pair_of(s, &two, false);
    const int32_t added = robot_scene_add_pair(s, &pair);
    if (added < 0) return -1;
    if (i == 0) first = added;
  }
  return pair_table_note(&s->met, s->q->workspace, MADE_PAIRS, part, obstacle, first) ? first : -1;
}

/* ---- boxes ---- */

/* What a search knows of the lanes when they are `apart` in the middle. `below` gets a bit for each lane under the bar;
 * numbers as the vector units like them. */
static inline __attribute__((always_inline)) void settle(const cluster_view *v, double bar, cluster_lanes *lanes) {
  const double displacement = v->displacement;
  const double *restrict apart = lanes->apart;
  double *restrict lower = lanes->lower;
  double below = 0.0, dropped = INFINITY;
#pragma omp simd reduction(+ : below) reduction(min : dropped)
  for (int l = 0; l < TREE_LANES; l++) {
    const double bound = apart[l] - displacement, above = bound < bar ? INFINITY : bound;
    lower[l] = bound;
    below += bound < bar ? LANE_BITS[l] : 0.0;
    dropped = above < dropped ? above : dropped;
  }
  lanes->live &= (uint32_t)below;
  lanes->dropped = lesser(dropped, lanes->dropped);
}

/* The centre from eight boxes: their least coordinates, then their greatest, a row for each axis. */
SIMD_CLONES
static void from_boxes(const double *rows, const cluster_view *v, double bar, cluster_lanes *lanes) {
  const double *restrict r = rows;
  double *restrict out = lanes->apart;
  const vec3 p = v->centre;
  const double beyond = v->beyond_ball;
#pragma omp simd
  for (int l = 0; l < TREE_LANES; l++) {
    double x = greater(r[l] - p.x, p.x - r[3 * TREE_LANES + l]);
    double y = greater(r[TREE_LANES + l] - p.y, p.y - r[4 * TREE_LANES + l]);
    double z = greater(r[2 * TREE_LANES + l] - p.z, p.z - r[5 * TREE_LANES + l]);
    x = greater(x, 0.0), y = greater(y, 0.0), z = greater(z, 0.0);
    out[l] = sqrt(x * x + y * y + z * z) - beyond;
  }
  settle(v, bar, lanes);
}

/* The same of the box round the part, which stands along the part's axes. What parts two boxes along three axes that
 * are orthogonal to each other parts them by the root of the squares. */
SIMD_CLONES
static void from_turned_boxes(const double *rows, const cluster_view *v, double bar, cluster_lanes *lanes) {
  const double *restrict r = rows;
  double *restrict out = lanes->apart;
  const vec3 p = v->centre, middle = v->middle, half = v->half;
  const double *a = v->r, beyond = v->beyond_box;
#pragma omp simd
  for (int l = 0; l < TREE_LANES; l++) {
    const double low_x = r[l], low_y = r[TREE_LANES + l], low_z = r[2 * TREE_LANES + l];
    const double high_x = r[3 * TREE_LANES + l], high_y = r[4 * TREE_LANES + l], high_z = r[5 * TREE_LANES + l];
    const double c_x = 0.5 * (low_x + high_x) - p.x, c_y = 0.5 * (low_y + high_y) - p.y,
                 c_z = 0.5 * (low_z + high_z) - p.z;
    const double e_x = 0.5 * (high_x - low_x), e_y = 0.5 * (high_y - low_y), e_z = 0.5 * (high_z - low_z);
    double x = fabs(a[0] * c_x + a[3] * c_y + a[6] * c_z - middle.x) - half.x -
               (fabs(a[0]) * e_x + fabs(a[3]) * e_y + fabs(a[6]) * e_z);
    double y = fabs(a[1] * c_x + a[4] * c_y + a[7] * c_z - middle.y) - half.y -
               (fabs(a[1]) * e_x + fabs(a[4]) * e_y + fabs(a[7]) * e_z);
    double z = fabs(a[2] * c_x + a[5] * c_y + a[8] * c_z - middle.z) - half.z -
               (fabs(a[2]) * e_x + fabs(a[5]) * e_y + fabs(a[8]) * e_z);
    x = greater(x, 0.0), y = greater(y, 0.0), z = greater(z, 0.0);
    out[l] = greater(sqrt(x * x + y * y + z * z) - beyond, out[l]);
  }
  settle(v, bar, lanes);
}

cluster_view cluster_see(robot_scene *s, int32_t part, bool moves) {
  const obstacle_bvh *set = s->q->set;
  const robot_body *body = robot_scene_part(s, part);
  const double sizes = vec_norm(body->side.at.p) + vec_norm(set->centre) + set->boxes->scale + body->radius;
  const double ball = TREE_ROUND * ROUND_U, box = (3.0 * TREE_ROUND + ROUND_JOINT * (body->steps + 1.0)) * ROUND_U;
  const deviation off = s->q->errors ? deviation_of_cluster(s, part) : (deviation){0.0, 0.0};
  cluster_view v = {.part = part,
                    .boxes = set->boxes,
                    .centre = vec_sub(body->side.at.p, set->centre),
                    .middle = body->side.middle,
                    .half = body->side.half,
                    .radius = body->radius + off.middle,
                    .displacement = moves ? robot_scene_part_displacement(s, part) + off.growth : 0.0,
                    .beyond_ball = body->radius + off.middle + ROUND_UP * (body->side.error + ball * sizes),
                    .beyond_box = body->side.margin + off.middle + ROUND_UP * (body->side.error + box * sizes)};
  for (int i = 0; i < 9; i++) v.r[i] = body->side.at.r[i];
  return v;
}

static const double *rows_of(const tree *t, uint32_t at) {
  const bool leaf = (at & TREE_LEAF) != 0;
  return leaf ? t->packs + (size_t)(at & ~TREE_LEAF) * tree_pack_size(TREE_BOXES) : t->nodes[at].low[0];
}

void cluster_measure(const cluster_view *v, uint32_t at, double bar, cluster_lanes *lanes) {
  const tree *t = v->boxes;
  lanes->dropped = INFINITY;
  if (at & TREE_LEAF) {
    const uint32_t *id = t->ids + (size_t)(at & ~TREE_LEAF) * TREE_LANES;
    lanes->live = 1;
    for (uint32_t l = 1; l < TREE_LANES; l++) lanes->live |= (uint32_t)(id[l] != id[l - 1]) << l;
    lanes->under = id;
  } else {
    lanes->live = t->nodes[at].lanes;
    lanes->under = t->nodes[at].child;
  }
  from_boxes(rows_of(t, at), v, bar, lanes);
}

void cluster_measure_boxes(const cluster_view *v, uint32_t at, double bar, cluster_lanes *lanes) {
  from_turned_boxes(rows_of(v->boxes, at), v, bar, lanes);
}
