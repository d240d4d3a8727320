/* SPDX-License-Identifier: BSD-3-Clause */
#include "peers/lane_sampling.h"

#ifdef SIMD_HAS_LEVELS
#define EDGE_TARGET SIMD_TARGET_AVX2
#define EDGE_AVX2
#define EDGE_KERNEL edge_kernel_of_samples
#include "edges/kernel.h"

bool lane_sampling_exists(void) {
  return simd_of_machine() >= SIMD_AVX2;
}

SIMD_TARGET_AVX2 static bool part_hits(lane_batch *b, size_t i) {
  const edge_part *part = &b->c->parts[i];
  const lane_frame *own = &b->frames[part->frame];
  b->parts[i].centre = lane3_add(own->o, lane_turn(own, part->centre));
  for (uint32_t k = part->first_near; k < part->first_near + part->n_near; k++) {
    const edge_obstacle *o = &b->c->obstacles[b->c->near[k]];
    if (!within_still(distance2_from(o, b->parts[i].centre), part->outer)) continue;
    for (uint32_t l = part->first; l < part->first + part->n; l++) {
      const edge_ball *ball = &b->c->balls[l];
      if (within_still(distance2_from(o, lane3_add(own->o, lane_turn(own, ball->centre))), ball->outer)) return true;
    }
  }
  return false;
}

SIMD_TARGET_AVX2 static bool pair_hits(lane_batch *b, size_t i) {
  const cprox_edge_checker *c = b->c;
  const edge_part *first = &c->parts[c->lane_pairs[i].a], *second = &c->parts[c->lane_pairs[i].b];
  const lane_frame *own = &b->frames[first->frame], *other = &b->frames[second->frame];
  const lane3 apart = lane3_sub(b->parts[c->lane_pairs[i].a].centre, b->parts[c->lane_pairs[i].b].centre);
  if (!within_still(lane3_norm2(apart), first->outer + second->outer)) return false;
  for (uint32_t k = first->first; k < first->first + first->n; k++) {
    const lane3 at = lane3_add(own->o, lane_turn(own, c->balls[k].centre));
    const lane3 from = lane3_sub(at, b->parts[c->lane_pairs[i].b].centre);
    if (!within_still(lane3_norm2(from), c->balls[k].outer + second->outer)) continue;
    for (uint32_t l = second->first; l < second->first + second->n; l++) {
      const lane3 its = lane3_add(other->o, lane_turn(other, c->balls[l].centre));
      if (within_still(lane3_norm2(lane3_sub(at, its)), c->balls[k].outer + c->balls[l].outer)) return true;
    }
  }
  return false;
}

SIMD_TARGET_AVX2 bool lane_sampling_hits(const cprox_edge_checker *c, const double *from, const double *to,
                                         double per_radian, char *lanes, char *memory) {
  edge_motion motion = edge_motion_in(c, memory);
  double length = 0.0;
  for (size_t i = 1; i < c->n_frames; i++) {
    const edge_frame *f = &c->frames[i];
    const double way = f->multiplier * (to[f->variable] - from[f->variable]);
    motion.middle[i] = (float)(f->multiplier * 0.5 * (from[f->variable] + to[f->variable]) + f->offset);
    motion.rate[i] = (float)way;
    length += way * way;
  }
  lane_batch b = {.c = c, .motion = &motion};
  b.frames = (lane_frame *)(void *)lanes;
  b.parts = (lane_part *)(void *)(b.frames + c->n_frames);
  memset(&b.frames[0], 0, sizeof b.frames[0]);
  for (int k = 0; k < 9; k += 4) b.frames[0].r[k] = lane_all(1.0f);
  const double wanted = ceil(sqrt(length) * per_radian / EDGE_LANES);
  const int n = wanted > 1.0 ? (int)wanted : 1;
  for (int i = 0; i < n; i++) { /* spread over the whole edge each time, its end first */
    for (int l = 0; l < EDGE_LANES; l++) b.middle[l] = (float)((l + 1) * n - i) / (float)(EDGE_LANES * n) - 0.5f;
    for (size_t k = 1; k < c->n_frames; k++) place_frame(&b, k);
    for (size_t k = 0; k < c->n_parts; k++)
      if (part_hits(&b, k)) return true;
    for (size_t k = 0; k < c->n_lane_pairs; k++)
      if (pair_hits(&b, k)) return true;
  }
  return false;
}
#else
bool lane_sampling_exists(void) {
  return false;
}

bool lane_sampling_hits(const cprox_edge_checker *c, const double *from, const double *to, double per_radian,
                        char *lanes, char *motion) {
  (void)c, (void)from, (void)to, (void)per_radian, (void)lanes, (void)motion;
  return false;
}
#endif
