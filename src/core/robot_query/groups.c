/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/groups.h"

#include <math.h>
#include <string.h>

#include "base/rounding.h"

enum { WORD = 64, MOST_SEEN = 1 << 18 };

/* A group over the node at hand. */
typedef struct group_state {
  uint32_t placed; /* the node for which all this was found */
  vec3 centre;     /* of a ball, in the middle of the node, that contains the parts where they are exactly */
  double radius;
  double core;   /* of one about the same centre that contains their cores: margins do not turn */
  double within; /* so far they move as the group's axis sees them */
  int32_t from;  /* so far as this axis above it sees them, */
  double displacement;
} group_state;

struct robot_groups {
  const part_groups *of;
  group_state *state;
  uint64_t *asked; /* of each group a row of bits: the places of parts that some part of it is asked about with */
  uint64_t
      *given; /* of each place the places of the parts that stand in given pairs in which it moves; NULL: all may */
  uint64_t *single; /* of each place: its row while all are asked about, */
  uint64_t *still;  /* and the places of parts that stand still to it; NULL, of a state: all do */
  size_t words;     /* in a row */
  double *seen; /* of each group and each depth of an axis above it: how far that axis sees it move, as far up as was
                   asked; NULL: there are too many */
  size_t depths;
  int32_t *first; /* of what is on an axis, by its number + 1, the first place; -1: none */
};

/* ---- which parts are asked about ---- */

static void set_bit(uint64_t *row, int32_t place) {
  row[place / WORD] |= (uint64_t)1 << (place % WORD);
}

static bool has_bit(const uint64_t *row, int32_t place) {
  return row[place / WORD] >> (place % WORD) & 1u;
}

/* The bits of a word from `first` on, up to `last`, both counted from the row's beginning. */
static uint64_t bits_between(size_t word, int32_t first, int32_t last) {
  const int32_t from = (int32_t)(word * WORD);
  uint64_t bits = ~(uint64_t)0;
  if (first > from) bits &= ~(uint64_t)0 << (first - from);
  if (last < from + WORD) bits &= ~(uint64_t)0 >> (from + WORD - last);
  return bits;
}

static int32_t place_of(const struct robot_groups *g, int32_t part) {
  return g->of->at[g->of->alone[part]].first;
}

static uint64_t *row_of(const struct robot_groups *g, size_t group) {
  return g->asked + group * g->words;
}

bool robot_groups_ask(const robot_scene *s, group_pair pair) {
  const struct robot_groups *g = s->groups;
  const part_group *other = &g->of->at[pair.group[1]];
  const uint32_t first = (uint32_t)other->first, last = (uint32_t)other->last - 1;
  const uint64_t *row = row_of(g, (size_t)pair.group[0]), *end = row + last / WORD;
  uint64_t bits = ~(uint64_t)0 << (first % WORD);
  for (row += first / WORD; row < end; row++, bits = ~(uint64_t)0)
    if (*row & bits) return true;
  return (*row & bits & ~(uint64_t)0 >> (WORD - 1 - last % WORD)) != 0;
}

/* The rows of single parts, by place: those of pairs that were given. */
static void ask_given(const robot_scene *s, uint64_t *rows) {
  const struct robot_groups *g = s->groups;
  const cprox_mover *mover = &s->q->mover;
  const bool whole = mover_is_whole(mover);
  const cprox_robot_pair *pairs = whole ? mover->self_pairs : mover->pairs;
  const size_t n = whole ? mover->n_self_pairs : mover->n_pairs;
  const robot_part *parts = s->motion->robot->parts;
  const int32_t n_parts = (int32_t)s->motion->robot->n_parts;
  for (size_t k = 0; k < n; k++) {
    const size_t *first_part = s->motion->robot->first_part;
    const int32_t first = (int32_t)first_part[pairs[k].geometry], other = (int32_t)first_part[pairs[k].other];
    for (int32_t i = first; i < n_parts && parts[i].geometry == pairs[k].geometry; i++)
      for (int32_t j = other; j < n_parts && parts[j].geometry == pairs[k].other; j++) {
        const int32_t a = place_of(g, i), b = place_of(g, j);
        set_bit(g->given + (size_t)a * g->words, b);
        set_bit(rows + (size_t)a * g->words, b);
        set_bit(rows + (size_t)b * g->words, a);
      }
  }
}

/* What carries the joint that ends in the axis. */
static int32_t axis_before_joint(const cprox_robot *robot, int32_t axis) {
  while (!robot->axes[axis].first_of_joint) axis = robot->axes[axis].parent;
  return robot->axes[axis].parent;
}

static int32_t axis_at(const robot_scene *s, int32_t place) {
  return s->motion->robot->parts[s->groups->of->part[place]].axis;
}

/* The parts of an axis stand together: the first place behind them. */
static int32_t end_of_axis(const robot_scene *s, int32_t place) {
  const int32_t axis = axis_at(s, place), n = (int32_t)s->motion->robot->n_parts;
  while (place < n && axis_at(s, place) == axis) place++;
  return place;
}

static void clear_bits(uint64_t *row, int32_t first, int32_t last) {
  for (size_t w = (size_t)first / WORD; w * WORD < (size_t)last; w++) row[w] &= ~bits_between(w, first, last);
}

/* Two parts of one link, or of links with one joint between them, are not asked about. */
static void clear_neighbours(const robot_scene *s, uint64_t *rows, int32_t first, int32_t last) {
  const struct robot_groups *g = s->groups;
  const int32_t axis = axis_at(s, first);
  for (int32_t i = first; i < last; i++) clear_bits(rows + (size_t)i * g->words, first, last);
  if (axis < 0) return;
  const int32_t from = g->first[axis_before_joint(s->motion->robot, axis) + 1];
  if (from < 0) return; /* it carries nothing */
  const int32_t to = end_of_axis(s, from);
  for (int32_t i = first; i < last; i++) clear_bits(rows + (size_t)i * g->words, from, to);
  for (int32_t i = from; i < to; i++) clear_bits(rows + (size_t)i * g->words, first, last);
}

/* Parts that stand still to each other. Their rows are one, that of the first of them. */
static void set_still(const robot_scene *s) {
  const struct robot_groups *g = s->groups;
  uint64_t *rows = g->still;
  const int32_t n = (int32_t)s->motion->robot->n_parts;
  for (int pass = 0; pass < 2; pass++)
    for (int32_t i = 0; i < n; i++) {
      int32_t *first = &g->first[s->motion->carrier[axis_at(s, i) + 1] + 1];
      if (*first < 0) *first = i;
      if (pass == 0)
        set_bit(rows + (size_t)*first * g->words, i);
      else if (*first < i)
        memcpy(rows + (size_t)i * g->words, rows + (size_t)*first * g->words, g->words * sizeof *rows);
    }
  for (size_t i = 0; i <= s->motion->robot->n_axes; i++) g->first[i] = -1;
}

/* The rows of single parts, by place: all that motion_relates_links() has related. */
static void ask_all(const robot_scene *s, uint64_t *rows) {
  const struct robot_groups *g = s->groups;
  const int32_t n = (int32_t)s->motion->robot->n_parts;
  for (int32_t i = 0; i < n; i++)
    for (size_t w = 0; w < g->words; w++) rows[(size_t)i * g->words + w] = bits_between(w, 0, n);
  for (int32_t i = 0, end = 0; i < n; i = end) {
    end = end_of_axis(s, i);
    g->first[axis_at(s, i) + 1] = i;
    clear_neighbours(s, rows, i, end);
  }
}

/* Pairs of another class of starts are not asked about. */
static void clear_other_classes(const robot_scene *s, uint64_t *rows) {
  const struct robot_groups *g = s->groups;
  const int32_t n = (int32_t)s->motion->robot->n_parts;
  for (int32_t i = 0; i < n; i++)
    for (int32_t k = 0; k < n; k++)
      if (!start_class_has(s->motion, s->starts, g->of->part[i], g->of->part[k]))
        clear_bits(rows + (size_t)i * g->words, k, k + 1);
}

/* ---- beginning ---- */

/* The rows of single parts become those of their groups, those of halves are united. */
void robot_groups_choose(robot_scene *s, pair_choice choice) {
  const struct robot_groups *g = s->groups;
  for (size_t i = g->of->n; i-- > 0;) {
    const part_group *group = &g->of->at[i];
    uint64_t *row = row_of(g, i);
    const size_t place = (size_t)group->first * g->words;
    const uint64_t *a = group->half < 0 ? g->single + place : row_of(g, (size_t)group->half);
    const uint64_t *b = group->half < 0 ? a : a + g->words;
    for (size_t w = 0; w < g->words; w++) row[w] = a[w] | b[w];
    if (group->half >= 0 || !g->still || choice == PAIRS_ALL) continue;
    const uint64_t flip = choice == PAIRS_STANDING ? 0 : ~(uint64_t)0;
    for (size_t w = 0; w < g->words; w++) row[w] &= g->still[place + w] ^ flip;
  }
}

bool robot_groups_begin(robot_scene *s) {
  const cprox_robot *robot = s->motion->robot;
  const part_groups *of = &robot->groups;
  const size_t n = robot->n_parts, words = (n + WORD - 1) / WORD;
  if (n == 0) return true;
  const bool given = (mover_is_whole(&s->q->mover) ? s->q->mover.self_pairs : s->q->mover.pairs) != NULL;
  size_t depths = 1;
  for (size_t i = 0; i < robot->n_axes; i++)
    depths = robot->axes[i].depth >= depths ? robot->axes[i].depth + 1 : depths;
  const size_t seen = of->n * depths <= MOST_SEEN ? of->n * depths : 0;
  const bool moves = !s->motion->is_state;
  const size_t bits = (of->n + n + (given ? n : 0) + (moves ? n : 0)) * words;
  const size_t cleared = sizeof *s->groups + of->n * sizeof *s->groups->state + bits * sizeof *s->groups->asked;
  const size_t bytes = cleared + seen * sizeof *s->groups->seen + (robot->n_axes + 1) * sizeof *s->groups->first;
  struct robot_groups *g = workspace_reserve(s->q->workspace, WORKSPACE_ROBOT_GROUPS, bytes);
  if (!g) return false;
  memset(g, 0, cleared);
  s->groups = g;
  g->of = of;
  g->words = words;
  g->state = (group_state *)(void *)(g + 1);
  g->asked = (uint64_t *)(void *)(g->state + of->n);
  uint64_t *rows = g->single = g->asked + of->n * words;
  g->given = given ? rows + n * words : NULL;
  g->still = moves ? rows + (given ? 2 : 1) * n * words : NULL;
  g->seen = seen ? (double *)(void *)(g->asked + bits) : NULL;
  g->depths = depths;
  g->first = (int32_t *)(void *)((char *)g + cleared + seen * sizeof *g->seen);
  for (size_t i = 0; i <= robot->n_axes; i++) g->first[i] = -1;
  if (given)
    ask_given(s, rows);
  else
    ask_all(s, rows);
  if (s->starts) clear_other_classes(s, rows);
  for (size_t i = 0; i <= robot->n_axes; i++) g->first[i] = -1;
  if (moves) set_still(s);
  robot_groups_choose(s, PAIRS_ALL);
  if (!robot_groups_ask(s, (group_pair){{0, 0}})) s->groups = NULL;
  return true;
}

/* ---- over a node ---- */

/* A ball that contains two others. Whatever its centre is, the radius is right. */
static void unite_balls(const group_state *a, const group_state *b, group_state *both) {
  const double apart = vec_norm(vec_sub(b->centre, a->centre));
  const double share = apart > 0.0 ? 0.5 + 0.5 * (b->radius - a->radius) / apart : 0.5;
  const double along = lesser(greater(share, 0.0), 1.0);
  both->centre = vec_axpy(a->centre, along, vec_sub(b->centre, a->centre));
  both->radius = ROUND_UP * greater(vec_norm(vec_sub(a->centre, both->centre)) + a->radius,
                                    vec_norm(vec_sub(b->centre, both->centre)) + b->radius);
  both->core = ROUND_UP * greater(vec_norm(vec_sub(a->centre, both->centre)) + a->core,
                                  vec_norm(vec_sub(b->centre, both->centre)) + b->core);
}

static void place_group(robot_scene *s, int32_t group);

static inline group_state *group_at(robot_scene *s, int32_t group) {
  group_state *state = &s->groups->state[group];
  if (state->placed != s->node) place_group(s, group);
  return state;
}

static void place_group(robot_scene *s, int32_t group) {
  const struct robot_groups *g = s->groups;
  const part_group *of = &g->of->at[group];
  group_state *state = &g->state[group];
  state->placed = s->node;
  state->from = of->axis;
  double *seen = g->seen ? g->seen + (size_t)group * g->depths + robot_axis_depth(s->motion->robot, of->axis) : NULL;
  if (seen) *seen = 0.0;
  if (of->half < 0) {
    const robot_body *body = robot_scene_part(s, g->of->part[of->first]);
    state->centre = body->side.at.p;
    state->radius = ROUND_UP * (body->radius + body->side.error);
    state->core = ROUND_UP * body->core;
    state->within = state->displacement = 0.0;
    return;
  }
  unite_balls(group_at(s, of->half), group_at(s, of->half + 1), state);
  state->within = state->displacement =
      greater(robot_group_displacement(s, of->half, of->axis), robot_group_displacement(s, of->half + 1, of->axis));
  if (seen) *seen = state->within;
}

double robot_group_displacement(robot_scene *s, int32_t group, int32_t from) {
  group_state *state = group_at(s, group);
  if (state->from == from) return state->displacement;
  const struct robot_groups *g = s->groups;
  const cprox_robot *robot = s->motion->robot;
  const uint32_t depth = robot_axis_depth(robot, from), known = robot_axis_depth(robot, state->from);
  if (g->seen) {
    double *seen = g->seen + (size_t)group * g->depths;
    if (depth >= known) return seen[depth];
    motion_displacements_up(s->motion, s->axes, state->from, from, state->centre, state->core, seen);
    state->displacement = seen[depth];
  } else {
    if (depth > known) state->from = g->of->at[group].axis, state->displacement = state->within;
    if (state->from != from)
      state->displacement = ROUND_UP * (state->displacement + motion_displacement(s->motion, s->axes, from, state->from,
                                                                                  state->centre, state->core));
  }
  state->from = from;
  return state->displacement;
}

double robot_groups_apart(robot_scene *s, group_pair pair) {
  const group_state *a = group_at(s, pair.group[0]), *b = group_at(s, pair.group[1]);
  const double between = vec_norm(vec_sub(a->centre, b->centre)), radii = a->radius + b->radius;
  return between - radii - ROUND_UP * ROUND_LENGTH * ROUND_U * (between + radii);
}

double robot_groups_radius(robot_scene *s, group_pair pair) {
  return greater(group_at(s, pair.group[0])->radius, group_at(s, pair.group[1])->radius);
}

double robot_groups_displacement(robot_scene *s, group_pair pair) {
  const part_group *a = &s->groups->of->at[pair.group[0]], *b = &s->groups->of->at[pair.group[1]];
  const int32_t common = robot_common_axis(s->motion->robot, a->axis, b->axis);
  const double displacement =
      robot_group_displacement(s, pair.group[0], common) + robot_group_displacement(s, pair.group[1], common);
  return ROUND_UP * displacement;
}

double robot_groups_displacement_of(robot_scene *s, const robot_pair *pair) {
  const int32_t *alone = s->groups->of->alone;
  return robot_group_displacement(s, alone[pair->moving], pair->common) +
         robot_group_displacement(s, alone[pair->standing], pair->common);
}

bool robot_groups_are_parts(const robot_scene *s, group_pair pair) {
  const part_group *at = s->groups->of->at;
  return at[pair.group[0]].half < 0 && at[pair.group[1]].half < 0;
}

static void keep_asked(const robot_scene *s, int32_t a, int32_t b, group_pair *inside, size_t *n) {
  const group_pair pair = {{a, b}};
  if (robot_groups_ask(s, pair)) inside[(*n)++] = pair;
}

size_t robot_groups_open(robot_scene *s, group_pair pair, group_pair inside[GROUP_PAIRS_INSIDE]) {
  const part_group *at = s->groups->of->at;
  size_t n = 0;
  if (group_pair_is_one(pair)) {
    const int32_t half = at[pair.group[0]].half;
    keep_asked(s, half, half, inside, &n);
    keep_asked(s, half + 1, half + 1, inside, &n);
    keep_asked(s, half, half + 1, inside, &n);
    return n;
  }
  const double a = group_at(s, pair.group[0])->radius, b = group_at(s, pair.group[1])->radius;
  const int opened = at[pair.group[1]].half < 0 || (at[pair.group[0]].half >= 0 && a >= b) ? 0 : 1;
  const int32_t half = at[pair.group[opened]].half, other = pair.group[1 - opened];
  keep_asked(s, half, other, inside, &n);
  keep_asked(s, half + 1, other, inside, &n);
  return n;
}

int32_t robot_groups_pair(robot_scene *s, group_pair pair) {
  const struct robot_groups *g = s->groups;
  const int32_t places[2] = {g->of->at[pair.group[0]].first, g->of->at[pair.group[1]].first};
  const int32_t parts[2] = {g->of->part[places[0]], g->of->part[places[1]]};
  const robot_part *of = s->motion->robot->parts;
  const bool first_moves = g->given ? has_bit(g->given + (size_t)places[0] * g->words, places[1])
                                    : of[parts[0]].geometry > of[parts[1]].geometry;
  const int32_t moving = parts[first_moves ? 0 : 1], standing = parts[first_moves ? 1 : 0];
  const int32_t known = pair_table_find(&s->met, MADE_SELF_PAIRS, moving, (uint32_t)standing);
  if (known >= 0) return known;
  const robot_pair made = robot_scene_pair_of(s, &(planned_pair){.moving = moving, .standing = standing}, true);
  const int32_t number = robot_scene_add_pair(s, &made);
  if (number < 0) return -1;
  return pair_table_note(&s->met, s->q->workspace, MADE_SELF_PAIRS, moving, (uint32_t)standing, number) ? number : -1;
}
