/* SPDX-License-Identifier: BSD-3-Clause */
/* For each segment of the motion a tree of intervals, cut in halves. On each, every pair that is still open is tried
 * with the last direction that the certificate gave for it, and with one that follows from its place: from the box
 * round what stands to the centre of what moves. What neither settles is open on both halves; an interval that is not
 * cut must settle all.
 *
 * Of a union of elements a pair has items: ranges of these. The first one is all of them; the certificate cuts an item
 * into two, which are items from then on. One that was cut is tried by the box round it; where that does not settle it,
 * its two are tried.
 *
 * A direction n, fixed in what stands, settles a pair if in the middle its plane parts the two by more than delta and
 * the way that points of the moving body may take (first order), or if the second or third order expansion of n·x over
 * the interval stays above delta. */
#include "robot_check.h"

#include <stdlib.h>

#include "inequalities.h"
#include "kinematics.h"
#include "span.h"
#include "trajectory.h"
#include "winding.h"

/* Where an interval begins is a double: a sum of powers of 2, exact to this depth. */
enum { MAX_DEPTH = 50, MAX_CUTS = 256 };

/* Of a direction: far from where squares underflow or overflow. */
#define SHORTEST 0x1p-100
#define LONGEST 0x1p100

typedef struct walk {
  robot *r;
  reader *in;
  uint32_t width;
  double delta, begin, end; /* of the part of the segment that is spoken of */
  size_t segment, *tries;
  axis_state *states;
  place *places; /* of the bodies */
  int *chain;
  double *levers;

  /* the motion that was found last on this interval: pairs that differ in a body that stands share it */
  const body *mover;
  int seen_from; /* axis */
  body_motion motion;
} walk;

/* A pair over the interval, seen from what stands. */
typedef struct view {
  const body *moving, *standing;
  const item *item;
  const set *shape; /* of what stands, NULL: the box round the item, and the ball about its elements */
  const place *at, *from;
  vec apart; /* of the centres */
  const body_motion *motion;
} view;

/* An item that no direction has settled yet. */
typedef struct open_item {
  size_t pair, item;
} open_item;

typedef struct open_list {
  open_item *at;
  size_t n, room;
} open_list;

/* max n·(x - centre) over what stands. */
static num highest(const view *v, const vec *n) {
  const set *s = v->standing->shape;
  if (s->kind == IMPLICIT) return v->item->reach; /* along no other direction it is known */
  if (v->shape) return span_along(v->shape, v->standing->radius, n);
  double most = s->size[0] * length_of(n->m);
  for (int k = 0; k < 3; k++) most += fmax(n->m[k] * v->item->low[k], n->m[k] * v->item->high[k]);
  const double reach = 2.0 * v->standing->radius; /* of a corner of the box */
  return (num){most, GROW(reach * (n->e + 16.0 * BALL_U * length_of(n->m)))};
}

/* min d·(x - centre) over the moving body, without margin. */
static num lowest(const view *v, const vec *d) {
  vec down = rot_turn(&v->at->r, d, true);
  for (int k = 0; k < 3; k++) down.m[k] = -down.m[k];
  return num_neg(span_along(v->moving->shape, v->moving->radius, &down));
}

/* f - rest |n| > delta |n| + the margins, whose share of n·x depends on what d is: |d| <= length. */
static bool is_beyond(num f, double rest) {
  return num_bottom(f) > rest;
}

static bool settles(const walk *w, const view *v, const vec *own) {
  const vec n = rot_turn(&v->from->r, own, false);
  const double size = vec_top(own), moving_pad = v->moving->shape->margin, standing_pad = v->standing->shape->margin;
  const num start = num_sub(vec_dot(&n, &v->apart), highest(v, own));
  const double limit = GROW((w->delta + standing_pad) * size);
  ++*w->tries;
  if (!(size > SHORTEST && size < LONGEST)) return false;

  /* by the ball about what moves; in the middle, and the way from there */
  const double padded = GROW(limit + moving_pad * size);
  if (is_beyond(start, GROW(padded + (v->moving->radius + v->motion->travel) * size))) return true;
  const num middle = num_add(start, lowest(v, &n));
  if (!is_beyond(middle, padded)) return false;
  if (is_beyond(middle, GROW(padded + v->motion->travel * size))) return true;

  /* both ends of tau; then the corners of (tau, tau²) */
  const body_motion *m = v->motion;
  const vec turn = vec_cross(&n, &m->omega), twist = vec_cross(&n, &m->alpha);
  const vec inwards = vec_scale(vec_dot(&m->omega, &n), &m->omega),
            outwards = vec_scale(vec_dot(&m->omega, &m->omega), &n);
  vec bend = vec_add(&twist, &inwards);
  bend = vec_sub(&bend, &outwards);
  const num along = vec_dot(&n, &m->v), faster = vec_dot(&n, &m->a);
  bool second = true, third = true;
  num there[2];
  vec d[2];
  for (int end = 0; end < 2 && (second || third); end++) {
    const double tau = end == 0 ? -0.5 : 0.5;
    d[end] = vec_axpy(&n, tau, &turn);
    there[end] = num_add(start, num_mul(num_of(tau), along));
    const num f = num_add(there[end], lowest(v, &d[end]));
    const double below = GROW(limit + moving_pad * vec_top(&d[end]));
    second = second && is_beyond(f, GROW(below + 0.125 * m->second * size));
    third = third && is_beyond(f, GROW(below + m->third * size / 48.0));
  }
  for (int end = 0; end < 2 && !second && third; end++) {
    const vec e = vec_axpy(&d[end], 0.125, &bend);
    const num g = num_add(num_add(there[end], num_mul(num_of(0.125), faster)), lowest(v, &e));
    third = is_beyond(g, GROW(limit + moving_pad * vec_top(&e) + m->third * size / 48.0));
  }
  return second || third;
}

/* From the box round what stands to the centre of what moves, in the frame of what stands; a halfspace has its own
 * normal. */
static void default_normal(const view *v, double n[3]) {
  const vec y = rot_turn(&v->from->r, &v->apart, true);
  for (int k = 0; k < 3; k++) {
    const double from = y.m[k] - v->item->middle[k], half = v->item->half[k];
    n[k] = v->standing->shape->kind == HALFSPACE ? v->standing->shape->size[k]
           : from > half                         ? from - half
           : from < -half                        ? from + half
                                                 : 0.0;
  }
}

/* By the last direction given, then by the one that needs not be given. */
static bool is_settled_by(const walk *w, const view *v) {
  const kind standing = v->standing->shape->kind;
  if (v->item->given && standing != HALFSPACE && settles(w, v, &v->item->normal)) return true;
  if (standing == IMPLICIT) return false;
  double n[3];
  default_normal(v, n);
  const vec own = vec_of(n);
  return settles(w, v, &own);
}

static bool push(open_list *list, size_t pair_index, size_t item_index) {
  if (list->n == list->room) {
    open_item *more = realloc(list->at, (2 * list->room + 16) * sizeof *more);
    if (!more) return false;
    list->at = more;
    list->room = 2 * list->room + 16;
  }
  list->at[list->n++] = (open_item){pair_index, item_index};
  return true;
}

/* What is not settled of an item joins the list; false where memory is out. */
static bool try_item(const walk *w, view *v, open_item which, open_list *left_open) {
  const pair *p = &w->r->pairs[which.pair];
  const item *one = &p->items[which.item];
  const set *whole = v->standing->shape;
  v->item = one;
  v->shape = whole->corners > 0 ? NULL : whole;
  if (is_settled_by(w, v)) return true;
  if (one->inner > 0)
    return try_item(w, v, (open_item){which.pair, one->inner}, left_open) &&
           try_item(w, v, (open_item){which.pair, one->inner + 1}, left_open);
  if (whole->corners > 0) {
    const set group = set_group(whole, one->begin, one->end);
    v->shape = &group;
    const bool settled = is_settled_by(w, v);
    v->shape = NULL;
    if (settled) return true;
  }
  return push(left_open, which.pair, which.item);
}

static bool try_open(walk *w, open_item which, open_list *left_open) {
  const body *bodies = w->r->bodies;
  const pair *p = &w->r->pairs[which.pair];
  view v = {.moving = &bodies[p->moving], .standing = &bodies[p->standing]};
  v.at = &w->places[p->moving], v.from = &w->places[p->standing];
  v.apart = vec_sub(&v.at->p, &v.from->p);
  v.motion = &w->motion;
  if (w->mover != v.moving || w->seen_from != v.standing->axis) {
    const double radius = GROW(v.moving->radius + v.moving->shape->margin);
    kinematics_motion(w->r, w->states, v.moving, v.at, radius, v.standing, w->chain, w->levers, &w->motion);
    w->mover = v.moving, w->seen_from = v.standing->axis;
  }
  return try_item(w, &v, which, left_open);
}

/* ---- items ---- */

/* An item of the elements begin ... end - 1, or of all of what stands; false where memory is out. */
static bool add_item(pair *p, const body *standing, size_t begin, size_t end, const item *outer) {
  if (p->n_items == p->room) {
    const size_t room = 2 * p->room + 1;
    item *more = realloc(p->items, room * sizeof *more);
    if (!more) return false;
    p->items = more;
    p->room = room;
  }
  item *one = &p->items[p->n_items++];
  *one = (item){.begin = begin, .end = end};
  if (outer) {
    one->given = outer->given;
    one->depth = outer->depth + 1;
    one->normal = outer->normal;
  }
  const set *s = standing->shape;
  for (int k = 0; k < 3; k++) one->middle[k] = standing->middle[k], one->half[k] = standing->half[k];
  if (s->corners > 0 && outer) set_box(s, begin, end, one->low, one->high);
  for (int k = 0; k < 3 && !outer; k++) one->low[k] = s->low[k], one->high[k] = s->high[k];
  for (int k = 0; k < 3 && s->corners > 0; k++) {
    one->middle[k] = 0.5 * (one->low[k] + one->high[k]);
    one->half[k] = 0.5 * (one->high[k] - one->low[k]);
  }
  return true;
}

/* The direction that multipliers make, and what they prove along it. */
static bool read_multipliers(const walk *w, const set *s, item *one) {
  iv *n = iv_new(4), *centre = iv_new(3);
  const bool known = inequalities_reach(n, &n[3], s, w->width, w->in);
  for (int k = 0; k < 3; k++) iv_set_d(&centre[k], s->centre[k]);
  one->normal = winding_ball_of(n);
  iv_dot(&centre[0], n, centre);
  iv_sub(&n[0], &n[3], &centre[0]);
  iv_set_d(&n[1], 0.0);
  iv_set_d(&n[2], 0.0);
  const vec high = winding_ball_of(n);
  one->reach = (num){high.m[0], high.e};
  iv_free(n, 4);
  iv_free(centre, 3);
  return known;
}

/* COUNT × {u16 pair, ENTRY}: from here on these are the directions of those pairs. ENTRY is n[3]; of elements u32 2 ×
 * ITEM and n[3], or u32 2 × ITEM + 1 and u32, the first element of the second one that the item is cut into. */
static const char *read_directions(const walk *w, size_t count) {
  for (size_t i = 0; i < count; i++) {
    const size_t index = (size_t)reader_bits(w->in, 2);
    if (w->in->bad || index >= w->r->n_pairs) return "it is cut off, or it speaks of no pair of these";
    pair *p = &w->r->pairs[index];
    const body *standing = &w->r->bodies[p->standing];
    const uint32_t code = standing->shape->corners > 0 ? reader_count(w->in) : 0;
    if (w->in->bad || code / 2 >= p->n_items) return "it is cut off, or it speaks of no elements of these";
    if (code % 2 == 1) {
      const size_t at = reader_count(w->in), second = p->n_items + 1;
      const item one = p->items[code / 2];
      if (w->in->bad || one.inner > 0 || at <= one.begin || at >= one.end || one.depth > MAX_CUTS)
        return "it cuts elements where it must not";
      if (!add_item(p, standing, one.begin, at, &one) || !add_item(p, standing, at, one.end, &one))
        return "memory is out";
      p->items[code / 2].inner = second - 1;
      continue;
    }
    item *one = &p->items[code / 2];
    double n[3] = {0.0, 0.0, 0.0};
    const bool implicit = standing->shape->kind == IMPLICIT;
    if (implicit && !read_multipliers(w, standing->shape, one)) return "its multipliers prove nothing";
    if (!implicit) reader_normal(w->in, w->width, n);
    if (!implicit) one->normal = vec_of(n);
    if (w->in->bad) return "it is cut off, or not a number";
    one->given = true;
  }
  return NULL;
}

/* ---- intervals ---- */

/* One interval, which begins at u = `from` and is 2^-depth long: `open` items, n of them; points are overwritten. What
 * lies outside of the part that is spoken of is not there. NODE: u16 2 × COUNT + (1 where it is cut), the
 * directions, and where it is cut the left and the right half. */
static const char *check_interval(walk *w, num *points, const open_item *open, size_t n, double from, int depth) {
  const robot *r = w->r;
  if (from >= w->end || from + ldexp(1.0, -depth) <= w->begin) return NULL;
  const size_t head = (size_t)reader_bits(w->in, 2), room = r->n_variables * (ROBOT_MAX_DEGREE + 1);
  if (w->in->bad || depth > MAX_DEPTH) return "its tree is broken";
  const double middle = from + ldexp(0.5, -depth);
  const char *fault = read_directions(w, head / 2);
  if (fault) return fault;

  /* where nothing is open any more, what is left is read and not worked out */
  if (n == 0) {
    for (int half = 0; half < 2 && head % 2 == 1 && !fault; half++)
      fault = check_interval(w, points, open, 0, half == 0 ? from : middle, depth + 1);
    return fault;
  }
  kinematics_axes(r, w->segment, points, w->states);
  w->mover = NULL;
  for (size_t i = 0; i < r->n_bodies; i++) w->places[i] = kinematics_place(&r->bodies[i], w->states);
  open_list left_open = {.n = 0};
  num *left = malloc((room + 1) * sizeof *left);
  if (!left) fault = "memory is out";
  for (size_t i = 0; i < n && !fault; i++) {
    if (!try_open(w, open[i], &left_open)) fault = "memory is out";
    if (!fault && left_open.n > 0 && head % 2 == 0) fault = "a pair is not settled on an interval";
  }
  if (!fault && head % 2 == 1) {
    for (size_t v = 0; v < r->n_variables; v++)
      if (r->moved[v])
        trajectory_halve(points + v * (ROBOT_MAX_DEGREE + 1), r->degrees[w->segment],
                         left + v * (ROBOT_MAX_DEGREE + 1));
    fault = check_interval(w, left, left_open.at, left_open.n, from, depth + 1);
    if (!fault) fault = check_interval(w, points, left_open.at, left_open.n, middle, depth + 1);
  }
  free(left_open.at);
  free(left);
  return fault;
}

/* Where the part of a segment begins nothing is inside of a closed mesh. Then it comes in nowhere, being apart from the triangles.
 */
static const char *check_outside(const walk *w, size_t segment, num *points) {
  const robot *r = w->r;
  bool placed = false;
  for (size_t i = 0; i < r->n_pairs; i++) {
    const body *moving = &r->bodies[r->pairs[i].moving], *standing = &r->bodies[r->pairs[i].standing];
    if (standing->shape->kind != SOLID) continue;
    if (!placed) kinematics_hold(r, segment, w->begin, points, w->states, w->places);
    placed = true;
    const double *vertex = moving->shape->n > 0 ? moving->shape->vertices[0] : NULL;
    vec x = vertex ? vec_of(vertex) : (vec){.e = 0.0}; /* a point of it, about the centre */
    x = place_apply(&w->places[r->pairs[i].moving], &x);
    x = vec_sub(&x, &w->places[r->pairs[i].standing].p);
    x = rot_turn(&w->places[r->pairs[i].standing].r, &x, true);
    if (winding_side(standing->shape, &x) != OUTSIDE) return "a part does not begin outside a mesh";
  }
  return NULL;
}

const char *robot_apart(robot *r, reader *in, uint32_t width, double delta, const motion_place *from,
                        const motion_place *until, size_t *tries) {
  walk w = {.r = r, .in = in, .width = width, .delta = delta, .tries = tries};
  const size_t room = r->n_variables * (ROBOT_MAX_DEGREE + 1);
  w.states = malloc((r->n_axes + 1) * sizeof *w.states);
  w.places = malloc((r->n_bodies + 1) * sizeof *w.places);
  w.chain = malloc((r->n_axes + 1) * sizeof *w.chain);
  w.levers = malloc((r->n_axes + 1) * sizeof *w.levers);
  num *points = malloc((room + 1) * sizeof *points);
  open_item *all = malloc((r->n_pairs + 1) * sizeof *all);
  const char *fault = w.states && w.places && w.chain && w.levers && points && all ? NULL : "memory is out";
  for (size_t i = 0; i < r->n_pairs && !fault; i++) {
    pair *p = &r->pairs[i];
    const body *standing = &r->bodies[p->standing];
    all[i] = (open_item){i, 0};
    p->n_items = 0;
    if (!add_item(p, standing, 0, set_elements(standing->shape), NULL)) fault = "memory is out";
  }
  for (size_t s = from->segment; s <= until->segment && !fault; s++) {
    w.begin = s > from->segment ? 0.0 : from->u;
    w.end = s < until->segment ? 1.0 : until->u;
    w.segment = s;
    fault = check_outside(&w, s, points);
    for (size_t i = 0; i < room; i++) points[i] = robot_points(r, s, 0)[i];
    if (!fault) fault = check_interval(&w, points, all, r->n_pairs, 0.0, 0);
  }
  free(w.states);
  free(w.places);
  free(w.chain);
  free(w.levers);
  free(points);
  free(all);
  return fault;
}
