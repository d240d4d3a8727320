/* SPDX-License-Identifier: BSD-3-Clause */
#include "broadphase/obstacle_set.h"

#include "base/rounding.h"
#include "base/workspace.h"
#include "problem/radius.h"
#include "shape/body.h"

/* ---- the heap ---- */

static set_entry *heap_of(const set_traversal *w, size_t n) {
  return workspace_reserve(w->q->workspace, WORKSPACE_SET, n * sizeof(set_entry));
}

static bool push(set_traversal *w, set_entry entry) {
  set_entry *heap = heap_of(w, w->count + 1);
  if (!heap) return false;
  size_t i = w->count++;
  for (; i > 0 && heap[(i - 1) / 2].lower > entry.lower; i = (i - 1) / 2) heap[i] = heap[(i - 1) / 2];
  heap[i] = entry;
  return true;
}

static set_entry pop(set_traversal *w) {
  set_entry *heap = heap_of(w, w->count);
  const set_entry top = heap[0];
  const set_entry moved = heap[--w->count];
  size_t i = 0;
  for (size_t child = 1; child < w->count; child = 2 * i + 1) {
    if (child + 1 < w->count && heap[child + 1].lower < heap[child].lower) child++;
    if (heap[child].lower >= moved.lower) break;
    heap[i] = heap[child];
    i = child;
  }
  heap[i] = moved;
  return top;
}

/* ---- bounds ---- */

static double bound_of(const set_traversal *w, double distance) {
  const double lower = distance - w->offset - w->slack;
  return w->q->is_signed && lower <= 0.0 ? -INFINITY : lower; /* boxes do not know how deep */
}

/* From a box to the least of the curve's capsules: a spline winds its way past much that lies in its hull. */
static double capsules_to_box(const cprox_curve *curve, vec3 centre, vec3 low, vec3 high) {
  enum { DEEPEST = 64 };
  size_t open[2 * DEEPEST] = {1}, count = 1;
  double least = INFINITY;
  while (count > 0) {
    const size_t k = open[--count];
    const curve_capsule c = curve_capsule_at(curve, k);
    if (c.radius < 0.0) continue;
    const vec3 m = vec_sub(vec_lerp(c.a, c.b, 0.5), centre);
    const vec3 n = vec(m.x - fmin(fmax(m.x, low.x), high.x), m.y - fmin(fmax(m.y, low.y), high.y),
                       m.z - fmin(fmax(m.z, low.z), high.z));
    const double lower = vec_norm(n) - 0.5 * vec_norm(vec_sub(c.b, c.a)) - c.radius;
    if (!(lower < least)) continue;
    if (k >= curve->n_leaves)
      least = lower;
    else
      open[count++] = 2 * k, open[count++] = 2 * k + 1;
  }
  return least;
}

/* How far what rides the curve reaches from it. */
static double carried_reach(const query *q) {
  const cprox_body *body = q->mover.body;
  return q->mover.radius + radius_most(q->mover.radius_curve) +
         (body ? vec_norm(body->ball_centre) + body->ball_radius : 0.0);
}

bool traversal_begin(set_traversal *w, const obstacle_bvh *set, const query *q) {
  *w = (set_traversal){.set = set, .q = q, .offset = carried_reach(q)};
  if (!set->boxes) return true;
  const cprox_curve *curve = q->mover.curve;
  const curve_capsule *all = &q->reach;
  tree_segment *s = &w->segment;
  s->x = vec_sub(vec_lerp(all->a, all->b, 0.5), set->centre);
  const size_t points = curve->n_pieces * (curve->degree + 1);
  const bool few = !curve->arcs && points <= TREE_MOST_POINTS;
  s->n = few ? points : 2;
  s->radius = few ? 0.0 : all->radius;
  s->beyond = INFINITY;
  double reach = 0.0, error = 0.0;
  for (size_t k = 0; k < s->n; k++) {
    const vec3 p = vec_sub(vec_sub(few ? curve->points[k] : k ? all->b : all->a, set->centre), s->x);
    s->p[0][k] = p.x, s->p[1][k] = p.y, s->p[2][k] = p.z;
    reach = fmax(reach, vec_norm(p));
  }
  for (size_t i = 0; few && i < curve->n_pieces; i++) error = fmax(error, curve->error[i]);
  const double sizes = vec_norm(s->x) + vec_norm(set->centre) + set->boxes->scale + reach + s->radius + w->offset;
  w->slack = ROUND_UP * (error + (TREE_ROUND + 8.0) * ROUND_U * sizes);
  return push(w, (set_entry){.lower = -INFINITY, .at = 0, .is = SET_NODE});
}

/* ---- walking ---- */

static bool open_node(set_traversal *w, const set_entry *entry) {
  const tree *t = w->set->boxes;
  tree_lanes lanes;
  tree_measure(t, entry->at, TREE_ALL_LANES, &w->segment, &lanes);
  const bool leaf = (entry->at & TREE_LEAF) != 0;
  const uint32_t *ids = leaf ? t->ids + (size_t)(entry->at & ~TREE_LEAF) * TREE_LANES : NULL;
  for (uint32_t l = 0; l < TREE_LANES; l++) {
    const bool used = leaf ? l == 0 || ids[l] != ids[l - 1] : (t->nodes[entry->at].lanes >> l & 1u) != 0;
    if (!used) continue;
    set_entry next = {.lower = fmax(bound_of(w, lanes.bound[l]), entry->lower)};
    next.at = leaf ? ids[l] : t->nodes[entry->at].child[l];
    next.is = leaf ? SET_BOX : SET_NODE;
    if (!push(w, next)) return false;
  }
  return true;
}

static bool refine(set_traversal *w, set_entry *entry) {
  const obstacle_bvh *set = w->set;
  const cprox_curve *curve = w->q->mover.curve;
  entry->is = SET_TARGET;
  if (curve->n_pieces > 1) {
    const double distance = capsules_to_box(curve, set->centre, set->low[entry->at], set->high[entry->at]);
    entry->lower = fmax(entry->lower, bound_of(w, distance));
  }
  return push(w, *entry);
}

bool traversal_next(set_traversal *w, double most, uint32_t *obstacle, double *lower) {
  *obstacle = UINT32_MAX;
  *lower = -INFINITY;
  if (w->unbounded < w->set->n_unbounded) {
    *obstacle = w->set->unbounded[w->unbounded++];
    return true;
  }
  while (w->count > 0) {
    const double least = heap_of(w, 1)[0].lower;
    if (least > most) {
      *lower = least;
      return true;
    }
    set_entry entry = pop(w);
    if (entry.is == SET_TARGET) {
      *obstacle = w->set->of_box[entry.at];
      *lower = entry.lower;
      return true;
    }
    if (!(entry.is == SET_NODE ? open_node(w, &entry) : refine(w, &entry))) return false;
  }
  *lower = INFINITY;
  return true;
}
