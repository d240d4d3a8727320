/* SPDX-License-Identifier: BSD-3-Clause */
/* A curve against a convex body: leaves from left to right, then neighbours joined as long as one normal serves both.
 */
#include "certificate/partition.h"

enum { MAX_OPEN = 128, MAX_PASSES = 8 };

/* A normal to be tried, and how far the body reaches along it. */
typedef struct trial {
  vec3 n;
  reach_direction direction;
  reach_value reach;
} trial;

typedef struct leaf {
  double end;
  vec3 n;
} leaf;

vec3 partition_point(const cprox_curve *curve, double sigma) {
  const double last = (double)(curve->n_pieces - 1), piece = fmin(floor(sigma), last);
  const vec3 *p = curve_piece(curve, (size_t)piece);
  vec3 point;
  curve_bezier_evaluate(&p->x, &p->y, &p->z, 3, curve->degree, curve_binomial(curve), sigma - piece, &point, NULL,
                        NULL);
  return point;
}

double partition_cut(const cover *c, reach_part part, double witness) {
  const double length = part.to - part.from, middle = part.from + 0.5 * length;
  if (witness > part.from + 1e-9 * length && witness < part.to - 1e-9 * length) return witness;
  const double joint = floor(middle + 0.5);
  if (joint > part.from && joint < part.to) return joint;
  return length > c->shortest && middle > part.from && middle < part.to ? middle : NAN;
}

/* ---- normals ---- */

static trial try_normal(const cover *c, vec3 n) {
  trial t = {.n = n};
  if (c->set.body->shape.implicit) {
    const frame f = frame_create(&c->pose, c->set.body->centre);
    implicit_dual dual;
    t.direction = reach_along(vec(0, 0, 0));
    if (vec_norm2(n) > 0.0 &&
        multipliers_find(c->set.body, frame_turn_to_local(&f, n), c->certificate, c->workspace, &dual))
      t.reach = reach_of_multipliers(&c->set, &dual, &t.direction);
    return t;
  }
  if (c->set.body->kind == CPROX_BODY_HALFSPACE) {
    /* it has one normal, which the checker knows */
    t.n = vec(0, 0, 0);
    t.direction = reach_of_halfspace(&c->set);
  } else {
    t.n = certificate_round(c->certificate, n);
    t.direction = reach_along(t.n);
  }
  t.reach = reach_of_body(&c->set, &t.direction);
  return t;
}

static bool separates(const cover *c, const trial *t, reach_part part) {
  return reach_separates(c->curve, c->radius, part, &t->direction, &t->reach, c->delta);
}

const convex *partition_shape(const cover *c, frame *placed) {
  *placed = c->carried.body ? c->joined.placed : frame_create(&c->pose, c->set.body->centre);
  return c->carried.body ? &c->joined.shape : &c->set.body->shape;
}

/* The direction away from the body at a point of the curve; (0,0,0) inside, where there may be none. */
static vec3 normal_at(const cover *c, const frame *f, double sigma, convex_hint *hint) {
  frame unused;
  const convex *shape = partition_shape(c, &unused);
  double error = 0.0;
  convex_near near;
  shape->ops->nearest(shape, frame_to_local(f, partition_point(c->curve, sigma), &error), hint, &near);
  return near.distance > 0.0 ? frame_turn_to_world(f, near.normal) : vec(0, 0, 0);
}

/* ---- leaves ---- */

static leaf *leaves_reserve(const cover *c, size_t n) {
  return workspace_reserve(c->workspace, WORKSPACE_COVER, n * sizeof(leaf));
}

/* Lays the leaves; *n is their number. */
static cprox_status lay(cover *c, const frame *f, size_t *n) {
  reach_part open[MAX_OPEN];
  size_t n_open = 1;
  open[0] = (reach_part){c->from, c->until};
  const trial witness = try_normal(c, c->normal);
  convex_hint hint = {0};
  *n = 0;
  while (n_open > 0) {
    if (c->budget == 0) return CPROX_BUDGET;
    c->budget--;
    const reach_part part = open[--n_open];
    leaf *leaves = leaves_reserve(c, *n + 1);
    if (!leaves) return CPROX_MEMORY;

    /* the best point's normal, then that of the middle */
    trial used = witness;
    if (!separates(c, &used, part)) {
      const vec3 normal = normal_at(c, f, part.from + 0.5 * (part.to - part.from), &hint);
      if (vec_norm2(normal) == 0.0) return CPROX_PRECISION;
      used = try_normal(c, normal);
      if (!separates(c, &used, part)) {
        const double cut = partition_cut(c, part, c->witness);
        if (isnan(cut) || n_open + 2 > MAX_OPEN) return CPROX_PRECISION;
        open[n_open++] = (reach_part){cut, part.to};
        open[n_open++] = (reach_part){part.from, cut};
        continue;
      }
    }
    leaves[(*n)++] = (leaf){part.to, used.n};
  }
  return CPROX_OK;
}

/* A normal that serves two neighbours at once: either's, or that of where they meet. */
static bool join(const cover *c, const frame *f, reach_part both, const leaf *left, const leaf *right, vec3 *n) {
  convex_hint hint = {0};
  const vec3 between[3] = {left->n, right->n, normal_at(c, f, left->end, &hint)};
  for (int i = 0; i < 3; i++) {
    const trial t = try_normal(c, between[i]);
    if (!separates(c, &t, both)) continue;
    *n = t.n;
    return true;
  }
  return false;
}

static void join_neighbours(const cover *c, const frame *f, size_t *n) {
  leaf *leaves = leaves_reserve(c, *n);
  for (int pass = 0; pass < MAX_PASSES; pass++) {
    size_t kept = 0;
    double from = c->from;
    for (size_t i = 1; i < *n; i++) {
      vec3 normal;
      if (join(c, f, (reach_part){from, leaves[i].end}, &leaves[kept], &leaves[i], &normal)) {
        leaves[kept] = (leaf){leaves[i].end, normal};
      } else {
        from = leaves[kept].end;
        leaves[++kept] = leaves[i];
      }
    }
    if (kept + 1 == *n) return;
    *n = kept + 1;
  }
}

cprox_status partition_convex(cover *c) {
  frame f;
  partition_shape(c, &f);
  size_t n;
  const cprox_status status = lay(c, &f, &n);
  if (status != CPROX_OK) return status;
  join_neighbours(c, &f, &n);

  const leaf *leaves = leaves_reserve(c, n);
  certificate_byte(c->certificate, SECTION_CONVEX);
  certificate_count(c->certificate, (uint32_t)n);
  for (size_t i = 0; i < n; i++) {
    certificate_number(c->certificate, leaves[i].end);
    if (!c->set.body->shape.implicit) {
      certificate_normal(c->certificate, leaves[i].n);
      continue;
    }
    const frame own = frame_create(&c->pose, c->set.body->centre);
    implicit_dual dual;
    if (!multipliers_find(c->set.body, frame_turn_to_local(&own, leaves[i].n), c->certificate, c->workspace, &dual))
      return CPROX_MEMORY;
    multipliers_write(c->set.body, c->certificate, &dual);
  }
  return CPROX_OK;
}
