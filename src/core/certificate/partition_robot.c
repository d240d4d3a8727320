/* SPDX-License-Identifier: BSD-3-Clause */
/* Of every pair the last normal that was written stays in force (robot_pair.normal, in the frame of what stands), and
 * beside it the one from the box round what stands to the centre of what moves, which need not be written. Only where
 * neither parts the pair is a distance measured, and its normal written where that settles the pair. */
#include "certificate/partition_robot.h"

#include <math.h>

#include "base/rounding.h"

enum { MOST_WRITTEN = 0x7fff };

/* The checker's own rounding is up to ten times as large as ours; what it finds must still be beyond delta. */
static const double SLACKS = 32.0;

/* Parts that move farther than their own size, and than this fraction of their distance, are not measured: halves tell
 * more. */
static const double MOST_DISPLACEMENT = 0.25;
#define SHORT_INTERVAL 0x1p-8

/* The normal that is not written is computed once here and once by the checker: it may differ by this, of the sizes. */
#define UNSURE 0x1p-46

typedef enum outcome { SETTLED, WRITTEN, OPEN, TOO_NEAR } outcome;

static bool is_halfspace(const placed_robot_pair *v) {
  return robot_body_is_halfspace(v->standing);
}

/* Does a normal in the frame of what stands settle the pair? unsure: by how much it may be off. */
static bool settles(const robot_cover *c, const placed_robot_pair *v, vec3 own, double unsure) {
  vec3 n = placement_turn(&v->standing->side.at, own);
  const double length = vec_norm(n);
  if (!(length > 0.0) || !isfinite(length)) return false;
  n = vec_scale(1.0 / length, n);
  n = vec_scale(1.0 / vec_norm(n), n);
  const double height = robot_pair_height(v->standing, n), heights[2] = {height, height};
  const vec3 apart = vec_sub(v->moving->side.at.p, v->standing->side.at.p);
  const double middle = vec_dot(n, apart) - bound_height(&v->moving->side, vec_neg(n)) - height;
  if (!(middle > c->delta)) return false;
  double slack;
  const double bound = motion_plane_bound(v->motion, &v->moving->side, &v->standing->side, n, vec(0, 0, 0), heights,
                                          v->moving->steps + v->standing->steps, INFINITY, &slack);
  const double sizes = vec_norm(apart) + v->moving->radius;
  const double needed = c->delta + SLACKS * slack + unsure * sizes;
  return middle - v->motion->displacement > needed || bound > needed;
}

static outcome settle(const robot_cover *c, const placed_robot_pair *v, double width, vec3 *written) {
  if (v->pair->normal_known && settles(c, v, v->pair->normal, 0.0)) return SETTLED;

  /* from the box to the centre */
  const vec3 apart = vec_sub(v->moving->side.at.p, v->standing->side.at.p);
  const vec3 y = vec_sub(placement_turn_back(&v->standing->side.at, apart), v->standing->side.middle);
  const bool rounded = v->standing->side.shape->ops->kind == CPROX_BODY_ELLIPSOID; /* the box is that of its core */
  const double more = rounded ? v->standing->side.shape->margin : 0.0;
  const vec3 h = vec_add(v->standing->side.half, vec(more, more, more));
  vec3 out = vec(copysign(fmax(fabs(y.x) - h.x, 0.0), y.x), copysign(fmax(fabs(y.y) - h.y, 0.0), y.y),
                 copysign(fmax(fabs(y.z) - h.z, 0.0), y.z));
  const double *normal = v->standing->side.shape->size;
  if (is_halfspace(v)) out = vec(normal[0], normal[1], normal[2]);
  const double length = vec_norm(out), unsure = is_halfspace(v) ? 0.0 : UNSURE * (vec_norm(y) + vec_norm(h)) / length;
  if (length > 0.0 && settles(c, v, out, unsure)) return SETTLED;

  const double size = fmax(v->moving->radius, MOST_DISPLACEMENT * (length - v->moving->radius));
  if (is_halfspace(v) || (v->motion->displacement > size && width > SHORT_INTERVAL)) return OPEN;
  robot_gap gap;
  const robot_accuracy accuracy = {.floor = c->delta, .fraction = 0.01};
  robot_pair_measure(v->moving, v->standing, accuracy, &gap);
  if (gap.support_failed || !(gap.upper > c->delta) || !(vec_norm2(gap.normal) > 0.0)) return TOO_NEAR;
  *written = certificate_round(c->certificate, placement_turn_back(&v->standing->side.at, gap.normal));
  return settles(c, v, *written, 0.0) ? WRITTEN : OPEN;
}

static int32_t *reserve(const robot_cover *c, size_t n) {
  return workspace_reserve(c->scene->q->workspace, WORKSPACE_COVER, (n + 1) * sizeof(int32_t));
}

/* The pairs that an interval leaves open come to stand behind `to`; their number is *kept. Writes the head and the
 * normals. */
static cprox_status certify_open_pairs(robot_cover *c, size_t from, size_t to, double width, size_t *kept) {
  const size_t head = certificate_short(c->certificate, 0);
  unsigned count = 0;
  *kept = 0;
  for (size_t i = from; i < to; i++) {
    int32_t *open = reserve(c, to + *kept + 1);
    if (!open) return CPROX_MEMORY;
    placed_robot_pair v;
    placed_robot_pair_at(c->scene, open[i], &v);
    placed_robot_pair_move(&v);
    vec3 written = vec(0, 0, 0);
    const outcome out = settle(c, &v, width, &written);
    if (out == TOO_NEAR) return CPROX_PRECISION;
    if (out == OPEN || (out == WRITTEN && count == MOST_WRITTEN)) open[to + (*kept)++] = open[i];
    if (out != WRITTEN || count == MOST_WRITTEN) continue;
    v.pair->normal = written;
    v.pair->normal_known = true;
    certificate_short(c->certificate, (uint16_t)open[i]);
    certificate_normal(c->certificate, written);
    count++;
  }
  certificate_restate_short(c->certificate, head, (uint16_t)(2 * count + (*kept > 0)));
  return CPROX_OK;
}

/* The interval [a, b] of a segment and the pairs at from … to - 1 of the list. Its depth is that of halves of 1. */
static cprox_status lay(robot_cover *c, size_t segment, double a, double b, size_t from, size_t to) {
  if (c->budget == 0) return CPROX_BUDGET;
  c->budget--;
  robot_scene_enter(c->scene, segment, a, b);
  size_t kept;
  cprox_status status = certify_open_pairs(c, from, to, b - a, &kept);
  if (status != CPROX_OK || kept == 0) return status;
  if (!(b - a > c->shortest)) return CPROX_PRECISION;
  const double middle = 0.5 * (a + b);
  status = lay(c, segment, a, middle, to, to + kept);
  return status == CPROX_OK ? lay(c, segment, middle, b, to, to + kept) : status;
}

cprox_status partition_robot(robot_cover *c) {
  const size_t n = c->scene->n_pairs;
  cprox_status status = CPROX_OK;
  int32_t *open = reserve(c, n);
  if (!open) return CPROX_MEMORY;
  for (size_t i = 0; i < n; i++) {
    open[i] = (int32_t)i;
    c->scene->pairs[i].normal_known = false;
  }
  for (size_t s = 0; s < c->scene->motion->n_segments && status == CPROX_OK; s++) status = lay(c, s, 0.0, 1.0, 0, n);
  return status;
}
