/* SPDX-License-Identifier: BSD-3-Clause */
/* Of every pair the last normal that was written stays in force (cover_item.normal, in the frame of what stands), and
 * beside it the one from the box round what stands to the centre of what moves, which need not be written. Only where
 * neither parts the pair is a distance measured, and its normal written where that settles the pair. Against elements
 * the same is done with ranges of these, which are cut where the hull of a range is too near or too large. */
#include "certificate/partition_robot.h"

#include <math.h>

#include "base/rounding.h"
#include "certificate/multipliers.h"

enum { MOST_WRITTEN = 0x7fff };

/* The checker's own rounding is up to ten times as large as ours; what it finds must still be beyond delta. */
static const double SLACKS = 32.0;

/* Parts that move farther than their own size, and than this fraction of their distance, are not measured: halves tell
 * more. */
static const double MOST_DISPLACEMENT = 0.25;
#define SHORT_INTERVAL 0x1p-8

/* The normal that is not written is computed once here and once by the checker: it may differ by this, of the sizes. */
#define UNSURE 0x1p-46

typedef enum outcome { SETTLED, WRITTEN, OPEN, CUT, TOO_NEAR } outcome;

/* ---- items ---- */

/* What stands, or a range of its elements. The first ones are the wholes, one a pair. */
typedef struct cover_item {
  int32_t pair;
  uint32_t code;       /* its number among those of the pair */
  uint32_t count;      /* of a whole: how many the pair has */
  int32_t inner;       /* the first of the two that it was cut into; 0: it was not */
  element_range range; /* of elements */
  element_box box;
  vec3 normal;   /* that was written last, in the frame of what stands */
  double height; /* of a body by inequalities along it, about the centre */
  bool normal_known;
} cover_item;

/* An item in the middle of the interval. */
typedef struct item_view {
  placed_robot_pair pair;
  const cover_item *item;
  const robot_cover_elements *elements; /* NULL: what stands is convex */
  robot_body standing;                  /* of elements: the hull of the range about the tree's origin */
  element_hull hull;
  bool by_box;                /* the item was cut: it is as large as its box */
  const cprox_body *implicit; /* what stands by inequalities, or NULL; then */
  implicit_dual dual;         /* what was found last, */
  double height;              /* and how far it reaches along the normal that is tried */
} item_view;

static cover_item *items_reserve(const robot_cover *c, size_t n) {
  return workspace_reserve(c->scene->q->workspace, WORKSPACE_COVER_ITEMS, (n + 1) * sizeof(cover_item));
}

static const robot_cover_elements *elements_of(const robot_cover *c, const robot_pair *pair) {
  const robot_cover_elements *e = pair->self ? NULL : &c->elements[pair->standing];
  return e && e->order.t ? e : NULL;
}

/* Begins with the wholes. */
static bool begin_items(robot_cover *c) {
  c->n_items = c->scene->n_pairs;
  cover_item *items = items_reserve(c, c->n_items);
  for (size_t i = 0; items && i < c->n_items; i++) {
    items[i] = (cover_item){.pair = (int32_t)i, .count = 1};
    const robot_cover_elements *e = elements_of(c, &c->scene->pairs[i]);
    if (!e) continue;
    items[i].range = elements_all(&e->order);
    items[i].box = elements_box(&e->order, &items[i].range);
  }
  return items != NULL;
}

/* Cuts an item in two, which go on with its normal. */
static bool cut_item(robot_cover *c, int32_t index) {
  cover_item *items = items_reserve(c, c->n_items + 2);
  if (!items) return false;
  cover_item *one = &items[index], *whole = &items[one->pair];
  const robot_cover_elements *e = elements_of(c, &c->scene->pairs[one->pair]);
  element_range half[2];
  elements_cut(&e->order, one->range, half);
  one->inner = (int32_t)c->n_items;
  for (int k = 0; k < 2; k++) {
    cover_item *inner = &items[c->n_items++];
    *inner = *one;
    inner->inner = 0;
    inner->code = whole->count++;
    inner->range = half[k];
    inner->box = elements_box(&e->order, &half[k]);
  }
  return true;
}

/* What stands by inequalities, or NULL. */
static const cprox_body *implicit_of(const robot_cover *c, const robot_pair *pair) {
  if (pair->self) return NULL;
  const robot_body *o = &c->scene->obstacles[pair->standing];
  const cprox_body *body = body_part_at(c->scene->q->obstacles[o->index].body, (size_t)o->part);
  return body->shape.implicit ? body : NULL;
}

static void place_item(const robot_cover *c, int32_t index, item_view *v) {
  const cover_item *item = workspace_filled(c->scene->q->workspace, WORKSPACE_COVER_ITEMS);
  v->item = item + index;
  placed_robot_pair_at(c->scene, v->item->pair, &v->pair);
  placed_robot_pair_move(&v->pair);
  v->elements = elements_of(c, v->pair.pair);
  v->by_box = v->item->inner > 0;
  v->implicit = implicit_of(c, v->pair.pair);
  v->height = v->item->height;
  if (!v->elements) {
    v->standing = *v->pair.standing;
    return;
  }
  v->standing = v->elements->standing;
  elements_hull(&v->hull, &v->elements->order, v->item->range);
  v->standing.side.shape = &v->hull.shape;
}

/* ---- normals ---- */

static bool is_halfspace(const item_view *v) {
  return robot_body_is_halfspace(&v->standing);
}

/* How far what stands reaches along a unit normal of the world, seen from its own origin. */
static double height_of(const item_view *v, vec3 n) {
  if (v->implicit) return v->height + v->standing.side.margin;
  if (!v->elements) return robot_pair_height(&v->standing, n);
  const vec3 own = placement_turn_back(&v->standing.side.at, n);
  const double height = v->by_box ? element_box_reach(&v->item->box, own)
                                  : elements_reach(&v->elements->order, &v->item->range, own, NULL);
  return height + v->standing.side.margin;
}

/* Does a normal in the frame of what stands settle the item? unsure: by how much it may be off. */
static bool settles(const robot_cover *c, const item_view *v, vec3 own, double unsure) {
  const robot_body *moving = v->pair.moving, *standing = &v->standing;
  vec3 n = placement_turn(&standing->side.at, own);
  const double length = vec_norm(n);
  if (!(length > 0.0) || !isfinite(length)) return false;
  n = vec_scale(1.0 / length, n);
  n = vec_scale(1.0 / vec_norm(n), n);
  const double height = height_of(v, n), heights[2] = {height, height};
  const vec3 apart = vec_sub(moving->side.at.p, standing->side.at.p);
  const double middle = vec_dot(n, apart) - bound_height(&moving->side, vec_neg(n)) - height;
  if (!(middle > c->delta)) return false;
  double slack;
  const double bound = motion_plane_bound(v->pair.motion, &moving->side, &standing->side, n, vec(0, 0, 0), heights,
                                          moving->steps + standing->steps, INFINITY, &slack);
  const double sizes = vec_norm(apart) + moving->radius;
  const double needed = c->delta + SLACKS * slack + unsure * sizes;
  return middle - v->pair.motion->displacement > needed || bound > needed;
}

/* From the box to the centre of what moves, in the frame of what stands. */
static vec3 default_normal(const item_view *v, double *unsure) {
  const bound_side *side = &v->standing.side;
  const double *normal = side->shape->size;
  *unsure = 0.0;
  if (is_halfspace(v)) return vec(normal[0], normal[1], normal[2]);
  const vec3 y = placement_turn_back(&side->at, vec_sub(v->pair.moving->side.at.p, side->at.p));
  const bool rounded = side->shape->ops->kind == CPROX_BODY_ELLIPSOID; /* the box is that of its core */
  const double more = rounded ? side->shape->margin : 0.0;
  const vec3 h = vec_add(side->half, vec(more, more, more));
  const element_box box =
      v->elements ? v->item->box : (element_box){vec_sub(side->middle, h), vec_add(side->middle, h)};
  const vec3 out = element_box_way(&box, y), half = element_box_half(&box);
  *unsure = UNSURE * (vec_norm(vec_sub(y, element_box_middle(&box))) + vec_norm(half)) / vec_norm(out);
  return out;
}

/* Whether halves of the elements tell more than halves of the interval: of those that the moving part is too near to,
 * and of those that are larger than its way. */
static bool is_to_be_cut(const item_view *v, bool too_near, double way) {
  element_range unused[2];
  if (!v->elements || !elements_cut(&v->elements->order, v->item->range, unused)) return false;
  return too_near || vec_norm(element_box_half(&v->item->box)) > way;
}

/* The normal as it is written; false where there are no multipliers for it. */
static bool round_normal(const robot_cover *c, item_view *v, vec3 own, vec3 *written) {
  *written = certificate_round(c->certificate, own);
  if (!v->implicit) return true;
  if (!multipliers_find(v->implicit, own, c->certificate, c->scene->q->workspace, &v->dual)) return false;
  *written = multipliers_direction(v->implicit, &v->dual, &v->height);
  return true;
}

static outcome settle(const robot_cover *c, item_view *v, double width, vec3 *written) {
  if (v->item->normal_known && settles(c, v, v->item->normal, v->implicit ? UNSURE : 0.0)) return SETTLED;
  double unsure;
  const vec3 out = default_normal(v, &unsure);
  const double length = vec_norm(out), displacement = v->pair.motion->displacement;
  if (length > 0.0 && !v->implicit && settles(c, v, out, unsure)) return SETTLED;
  if (v->by_box) return OPEN;

  const robot_body *moving = v->pair.moving;
  const double size = fmax(moving->radius, MOST_DISPLACEMENT * (length - moving->radius));
  if (is_halfspace(v) || (displacement > size && width > SHORT_INTERVAL)) return OPEN;
  robot_gap gap;
  const robot_accuracy accuracy = {.floor = c->delta, .fraction = 0.01};
  robot_pair_measure(moving, &v->standing, accuracy, &gap);
  const bool too_near = gap.support_failed || !(gap.upper > c->delta) || !(vec_norm2(gap.normal) > 0.0);
  if (!too_near) {
    const vec3 own = placement_turn_back(&v->standing.side.at, gap.normal);
    if (round_normal(c, v, own, written) && settles(c, v, *written, v->implicit ? UNSURE : 0.0)) return WRITTEN;
  }
  if (too_near && c->reaches_beyond) return OPEN;
  if (is_to_be_cut(v, too_near, fmax(displacement, moving->radius))) return CUT;
  return too_near ? TOO_NEAR : OPEN;
}

/* ---- intervals ---- */

static int32_t *reserve(const robot_cover *c, size_t n) {
  return workspace_reserve(c->scene->q->workspace, WORKSPACE_COVER, (n + 1) * sizeof(int32_t));
}

/* The list of an interval: what it leaves open stands from `to` on. */
typedef struct open_list {
  size_t to, kept;
  double width;
  unsigned count; /* entries written */
} open_list;

static void write_entry(const robot_cover *c, const cover_item *item, bool cut) {
  certificate_short(c->certificate, (uint16_t)item->pair);
  if (elements_of(c, &c->scene->pairs[item->pair])) certificate_count(c->certificate, 2 * item->code + cut);
}

/* Writes what settles an item, or puts it on the list. */
static cprox_status try_item(robot_cover *c, int32_t index, open_list *list) {
  item_view v;
  place_item(c, index, &v);
  vec3 written = vec(0, 0, 0);
  outcome out = settle(c, &v, list->width, &written);
  if (out == SETTLED) return CPROX_OK;
  if (out == TOO_NEAR) return CPROX_PRECISION;
  if (out != OPEN && list->count == MOST_WRITTEN) out = OPEN;
  cover_item *items = workspace_filled(c->scene->q->workspace, WORKSPACE_COVER_ITEMS);
  if (out == WRITTEN) {
    items[index].normal = written;
    items[index].height = v.height;
    items[index].normal_known = true;
    write_entry(c, &items[index], false);
    if (v.implicit)
      multipliers_write(v.implicit, c->certificate, &v.dual);
    else
      certificate_normal(c->certificate, written);
    list->count++;
    return CPROX_OK;
  }
  if (out == CUT) {
    if (!cut_item(c, index)) return CPROX_MEMORY;
    items = workspace_filled(c->scene->q->workspace, WORKSPACE_COVER_ITEMS);
    write_entry(c, &items[index], true);
    certificate_count(c->certificate, items[items[index].inner].range.end);
    list->count++;
  }
  const int32_t inner = items[index].inner;
  if (inner > 0) {
    const cprox_status status = try_item(c, inner, list);
    return status == CPROX_OK ? try_item(c, inner + 1, list) : status;
  }
  int32_t *open = reserve(c, list->to + list->kept + 1);
  if (!open) return CPROX_MEMORY;
  open[list->to + list->kept++] = index;
  return CPROX_OK;
}

/* The items that an interval leaves open come to stand behind `to`; their number is *kept. Writes the head and the
 * normals. */
static cprox_status certify_open_items(robot_cover *c, size_t from, size_t to, double width, size_t *kept) {
  const size_t head = certificate_short(c->certificate, 0);
  open_list list = {.to = to, .width = width};
  for (size_t i = from; i < to; i++) {
    const int32_t *open = workspace_filled(c->scene->q->workspace, WORKSPACE_COVER);
    const cprox_status status = try_item(c, open[i], &list);
    if (status != CPROX_OK) return status;
  }
  *kept = list.kept;
  certificate_restate_short(c->certificate, head, (uint16_t)(2 * list.count + (list.kept > 0)));
  return CPROX_OK;
}

/* The interval [a, b] of a segment and the items at from ... to - 1 of the list. Its depth is that of halves of 1. */
static cprox_status lay(robot_cover *c, size_t segment, double a, double b, size_t from, size_t to) {
  if ((segment == c->last && a >= c->end) || (segment == c->first && b <= c->begin)) return CPROX_OK;
  if (c->budget == 0) return CPROX_BUDGET;
  c->budget--;
  robot_scene_enter(c->scene, segment, a, b);
  c->reaches_beyond = (segment == c->last && b > c->end) || (segment == c->first && a < c->begin);
  size_t kept;
  cprox_status status = certify_open_items(c, from, to, b - a, &kept);
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
  if (!open || !begin_items(c)) return CPROX_MEMORY;
  for (size_t i = 0; i < n; i++) open[i] = (int32_t)i;
  for (size_t s = c->first; s <= c->last && status == CPROX_OK; s++) status = lay(c, s, 0.0, 1.0, 0, n);
  return status;
}
