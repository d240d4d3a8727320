/* SPDX-License-Identifier: BSD-3-Clause */
/* Do links touch anywhere in a box of joint values? Random states and a descent look for contact; branch and bound over
 * the box proves that there is none. doc/collision-matrix.md */
#include <math.h>
#include <string.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "branch_and_bound/search.h"
#include "curve_proximity/cprox/robot.h"
#include "kinematics/joint_tree.h"
#include "problem/validate.h"

/* A side of a pair: a geometry, seen from the axis that both sides hang on. */
typedef struct box_side {
  const cprox_link_geometry *geometry;
  placement at;       /* of the geometry, in its axis's moved frame */
  size_t first, last; /* its parts */
  size_t n_axes;      /* the last axes of the pair's chain that carry it */
  double steps, reach;
} box_side;

/* An axis on the way from side 0 to side 1. */
typedef struct box_axis {
  int32_t axis;
  double chord;  /* no turn of the node is longer than this at an arm of 1; of a shift the shift itself */
  double arm[2]; /* of each side, in the middle of the node */
} box_axis;

typedef struct box_pair {
  box_side side[2];
  box_axis *chain; /* side 0's axes from its own up, then those of side 1 down to its own */
  double loss;     /* over the node: by so much the distance can be less than in its middle */
} box_pair;

typedef struct box_search {
  const cprox_robot *robot;
  const cprox_robot_pair *given;
  box_pair *pairs;
  size_t n_pairs;
  int32_t *variables; /* those that move a pair */
  size_t n_variables;
  placement *frames;   /* of all axes: those of the pair at hand are filled */
  double *state;       /* all variables: the middle of the node at hand */
  double *best, least; /* the state with the least distance so far, and that */
  double *lot;         /* the same of the lot at hand */
  double *weight;      /* of each of `variables`: its part in the loss of the last pair that was too near */
  double *half;        /* of all variables, over the node at hand */
  double extent;       /* of all shifts: they count in rounding */
  size_t slots;        /* boxes in memory */
  int32_t free_slot;
  const cprox_options *options;
  cprox_workspace *workspace;
  cprox_workspace *prover; /* for the search that proves contact within this search; NULL: not yet needed */
  uint32_t work;
} box_search;

typedef struct box_node {
  int32_t slot; /* its box: the least value of each of `variables`, then the largest */
} box_node;

/* ---- where both sides are ---- */

static double value_of(const box_search *s, const robot_axis *axis) {
  return axis->multiplier * s->state[axis->variable] + axis->offset;
}

/* The axes of a side of the pair at the state, from the common one on, which stands. */
static void place_side(box_search *s, const box_pair *pair, int k) {
  const box_side *side = &pair->side[k];
  const box_axis *chain = k == 0 ? pair->chain : pair->chain + pair->side[0].n_axes;
  for (size_t i = 0; i < side->n_axes; i++) {
    const int32_t index = chain[k == 0 ? side->n_axes - 1 - i : i].axis;
    const robot_axis *axis = &s->robot->axes[index];
    s->frames[index] = robot_axis_move(axis, i > 0 ? &s->frames[axis->parent] : NULL, value_of(s, axis), NULL);
  }
}

static int32_t own_axis(const box_pair *pair, int k) {
  const box_side *side = &pair->side[k];
  if (side->n_axes == 0) return -1;
  return k == 0 ? pair->chain[0].axis : pair->chain[pair->side[0].n_axes + side->n_axes - 1].axis;
}

static cprox_obstacle placed_side(const box_search *s, const box_pair *pair, int k) {
  const placement at = placement_under(s->frames, own_axis(pair, k), &pair->side[k].at);
  const cprox_pose pose = placement_pose(&at);
  return cprox_with_margin(cprox_obstacle_at(pair->side[k].geometry->body, pose), pair->side[k].geometry->margin);
}

/* Where the axes and quaternions put the sides is off by no more. */
static double places_error(const box_search *s, const box_pair *pair) {
  double error = 0.0;
  for (int k = 0; k < 2; k++)
    error += ROUND_U * ROUND_JOINT * (pair->side[k].steps + 2.0) * (pair->side[k].reach + s->extent);
  return ROUND_UP * error;
}

/* ---- how much nearer they come over a box ---- */

/* The farthest point of a part from a line, or the largest distance of any of its points from a corner of its box. */
static double arm_of_part(const placement *at, const part_model *model, vec3 point, vec3 z) {
  const vec3 away = vec_sub(at->p, point);
  const double by_ball = vec_norm(vec_cross(z, away)) + model->radius;
  if (model->by_ball) return by_ball;
  double most = 0.0;
  for (int i = 0; i < 8; i++) {
    const vec3 corner =
        vec_add(model->middle, vec(i & 1 ? model->half.x : -model->half.x, i & 2 ? model->half.y : -model->half.y,
                                   i & 4 ? model->half.z : -model->half.z));
    most = greater(most, vec_norm2(vec_cross(z, vec_add(away, placement_turn(at, corner)))));
  }
  return lesser(by_ball, sqrt(most) + model->margin);
}

static double arm_of_side(const box_search *s, const box_pair *pair, int k, vec3 point, vec3 z) {
  double most = 0.0;
  for (size_t i = pair->side[k].first; i < pair->side[k].last; i++) {
    const robot_part *part = &s->robot->parts[i];
    const placement at = placement_under(s->frames, own_axis(pair, k), &part->at);
    most = greater(most, arm_of_part(&at, &part->model, point, z));
  }
  return most;
}

/* Seen from any one link on the way from side 0 to side 1, the axes before it move side 0, those behind it side 1: the
 * best such link counts. *split: so many axes move side 0. */
static double loss_of_pair(box_search *s, box_pair *pair, size_t *split) {
  const size_t n = pair->side[0].n_axes + pair->side[1].n_axes;
  for (size_t i = 0; i < n; i++) {
    box_axis *b = &pair->chain[i];
    const robot_axis *axis = &s->robot->axes[b->axis];
    const double turn = fabs(axis->multiplier) * s->half[axis->variable];
    b->arm[0] = b->arm[1] = 1.0;
    b->chord = turn;
    if (axis->kind != AXIS_PRISMATIC) {
      b->chord = turn < 3.14 ? lesser(turn, 2.0 * sin(0.5 * turn)) : 2.0;
      const vec3 z = placement_turn(&s->frames[b->axis], axis->z);
      for (int k = 0; k < 2; k++) b->arm[k] = arm_of_side(s, pair, k, s->frames[b->axis].p, z);
    }
  }
  double least = INFINITY;
  for (size_t k = 0; k <= n; k++) {
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) sum += pair->chain[i].chord * pair->chain[i].arm[i >= k];
    if (sum < least) least = sum, *split = k;
  }
  return ROUND_UP * (1.0 + 64.0 * ROUND_U) * least;
}

static size_t place_of_variable(const box_search *s, int32_t variable) {
  size_t i = 0;
  while (s->variables[i] != variable) i++;
  return i;
}

/* ---- measuring ---- */

/* Is the contact of a pair at the state proven? As every query about the robot proves it. */
static cprox_status prove_contact(box_search *s, size_t pair, bool *touches) {
  const cprox_state_query asked = {.self_pairs = &s->given[pair], .n_self_pairs = 1, .options = NULL};
  cprox_result result;
  if (!s->prover) s->prover = cprox_workspace_create();
  const cprox_status status = cprox_robot_ask_states(s->robot, &asked, s->state, 1, s->prover, &result, NULL);
  if (status < 0) return workspace_fail(s->workspace, status, "%s", cprox_workspace_error(s->prover));
  s->work += result.distance_queries + result.nodes;
  *touches = result.verdict == CPROX_VERDICT_VIOLATED;
  return CPROX_OK;
}

static void keep_best(box_search *s, double upper, search_best *best) {
  const size_t bytes = s->robot->n_variables * sizeof *s->best;
  if (upper < s->least) s->least = upper, memcpy(s->best, s->state, bytes);
  if (upper < best->upper) best->upper = upper, memcpy(s->lot, s->state, bytes);
}

/* What the pair's distance at the state is, to a hundredth of it. */
static cprox_status measure_state(box_search *s, size_t index, search_best *best, double *distance) {
  const box_pair *pair = &s->pairs[index];
  for (int k = 0; k < 2; k++) place_side(s, pair, k);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.relative_epsilon = 0.01, options.epsilon = 1e-5, options.max_lod = s->options->max_lod;
  cprox_result r;
  const cprox_status status = WORKSPACE_LEND(
      s->workspace, cprox_pair(placed_side(s, pair, 0), placed_side(s, pair, 1), &options, s->workspace, &r));
  if (status < 0) return status;
  s->work++;
  bool touches = false;
  const double error = places_error(s, pair);
  if (r.upper <= 0.0) {
    const cprox_status proven = prove_contact(s, index, &touches);
    if (proven < 0) return proven;
  }
  *distance = touches ? 0.0 : greater(r.upper, 0.0) + error;
  keep_best(s, *distance, best);
  return CPROX_OK;
}

/* One pair over the node: a bound, and whether it is clear all over. */
static cprox_status bound_pair(box_search *s, size_t index, search_best *best, double *lower) {
  box_pair *pair = &s->pairs[index];
  for (int k = 0; k < 2; k++) place_side(s, pair, k);
  size_t split = 0;
  const double error = places_error(s, pair), loss = loss_of_pair(s, pair, &split) + error;
  const cprox_obstacle a = placed_side(s, pair, 0), b = placed_side(s, pair, 1);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.max_lod = s->options->max_lod;
  cprox_result r;
  cprox_status status = WORKSPACE_LEND(s->workspace, cprox_pair_tolerance(a, b, loss, &options, s->workspace, &r));
  if (status < 0) return status;
  s->work++;
  *lower = r.lower - loss;
  if (*lower > 0.0) return CPROX_OK;
  for (size_t i = 0; i < pair->side[0].n_axes + pair->side[1].n_axes; i++) {
    const box_axis *b_axis = &pair->chain[i];
    s->weight[place_of_variable(s, s->robot->axes[b_axis->axis].variable)] += b_axis->chord * b_axis->arm[i >= split];
  }
  status = WORKSPACE_LEND(s->workspace, cprox_pair_tolerance(a, b, 0.0, &options, s->workspace, &r));
  if (status < 0) return status;
  s->work++;
  bool touches = false;
  if (r.upper <= 0.0) {
    const cprox_status proven = prove_contact(s, index, &touches);
    if (proven < 0) return proven;
  }
  if (touches || r.upper > 0.0) keep_best(s, touches ? 0.0 : r.upper + error, best);
  *lower = greater(*lower, r.lower - loss);
  return CPROX_OK;
}

/* ---- the boxes of the search ---- */

static size_t box_size(const box_search *s) {
  return 2 * s->n_variables + 1;
}

static double *box_of(const box_search *s, int32_t slot) {
  double *boxes = workspace_reserve(s->workspace, WORKSPACE_JOINT_BOXES, 0);
  return boxes + (size_t)slot * box_size(s);
}

/* A box not in use: its number, or -1 where memory is out. It may move all boxes. */
static int32_t box_take(box_search *s) {
  if (s->free_slot >= 0) {
    const int32_t slot = s->free_slot;
    s->free_slot = (int32_t)box_of(s, slot)[0];
    return slot;
  }
  const size_t bytes = (s->slots + 1) * box_size(s) * sizeof(double);
  if (s->slots >= INT32_MAX || !workspace_reserve(s->workspace, WORKSPACE_JOINT_BOXES, bytes)) return -1;
  return (int32_t)s->slots++;
}

static void box_release(void *self, const search_node *node) {
  box_search *s = self;
  const box_node *box = (const box_node *)(const void *)&node->payload;
  box_of(s, box->slot)[0] = s->free_slot;
  s->free_slot = box->slot;
}

/* The node's middle becomes the state. */
static void box_enter(box_search *s, const double *box) {
  const double *low = box, *high = box + s->n_variables;
  for (size_t i = 0; i < s->n_variables; i++) {
    const double middle = 0.5 * low[i] + 0.5 * high[i];
    s->state[s->variables[i]] = middle;
    s->half[s->variables[i]] = ROUND_UP * greater(high[i] - middle, middle - low[i]);
    s->weight[i] = 0.0;
  }
}

/* ---- the oracle ---- */

static double box_filter(void *self, search_node *node, double goal) {
  (void)self, (void)goal;
  return node->lower;
}

static cprox_status box_probe(void *self, search_node *node, search_best *best) {
  box_search *s = self;
  const box_node *box = (const box_node *)(const void *)&node->payload;
  box_enter(s, box_of(s, box->slot));
  double least = INFINITY;
  for (size_t i = 0; i < s->n_pairs && best->upper > 0.0; i++) {
    double lower;
    const cprox_status status = bound_pair(s, i, best, &lower);
    if (status < 0) return status;
    least = lesser(lower, least);
  }
  node->lower = greater(least, node->lower);
  return CPROX_OK;
}

/* Across the joint that adds most to the losses; the probe has just left them. */
static int box_split(void *self, search_node *node, search_node *child) {
  box_search *s = self;
  box_node *parent = (box_node *)(void *)&node->payload;
  size_t widest = 0;
  if (s->n_variables == 0) return 0;
  for (size_t i = 1; i < s->n_variables; i++)
    if (s->weight[i] > s->weight[widest]) widest = i;
  const int32_t slot = box_take(s);
  if (slot < 0) return (int)workspace_fail(s->workspace, CPROX_MEMORY, "no memory for boxes of joint values");
  double *box = box_of(s, parent->slot), *other = box_of(s, slot);
  const double low = box[widest], high = box[s->n_variables + widest], middle = 0.5 * low + 0.5 * high;
  if (!(middle > low && middle < high)) {
    other[0] = s->free_slot, s->free_slot = slot;
    return 0;
  }
  memcpy(other, box, box_size(s) * sizeof *box);
  box[s->n_variables + widest] = middle, other[widest] = middle;
  child[0] = child[1] = *node;
  ((box_node *)(void *)&child[1].payload)->slot = slot;
  return 2;
}

/* ---- looking for contact ---- */

/* xorshift64*: the same states on every machine. */
static double fraction(uint64_t *state) {
  *state ^= *state >> 12, *state ^= *state << 25, *state ^= *state >> 27;
  return (double)((*state * 2685821657736338717u) >> 11) * 0x1p-53;
}

/* Half of the budget is for the proof. */
static bool may_look(const box_search *s) {
  return s->work < s->options->max_nodes / 2 && !(s->options->stop && s->options->stop(s->options->stop_user));
}

/* Coordinate by coordinate from the best state on, in shorter and shorter steps. */
static cprox_status descend(box_search *s, size_t pair, const double *low, const double *high, search_best *best) {
  enum { HALVINGS = 12 };
  double here = best->upper;
  memcpy(s->state, s->lot, s->robot->n_variables * sizeof *s->state);
  for (double step = 0.25; step > 0.25 / (1 << HALVINGS) && here > 0.0 && may_look(s); step *= 0.5) {
    for (size_t i = 0; i < s->n_variables && here > 0.0; i++) {
      const int32_t v = s->variables[i];
      const double at = s->state[v];
      for (int side = -1; side <= 1 && here > 0.0; side += 2) {
        double found;
        s->state[v] = lesser(greater(at + side * step * (high[v] - low[v]), low[v]), high[v]);
        const cprox_status status = measure_state(s, pair, best, &found);
        if (status < 0) return status;
        if (found < here) {
          here = found;
          break;
        }
        s->state[v] = at;
      }
    }
  }
  return CPROX_OK;
}

/* Random states of each pair, and descents from the nearest one of several lots. */
static cprox_status look_for_contact(box_search *s, const double *low, const double *high, search_best *best) {
  enum { LOTS = 4, STATES = 50 };
  uint64_t seed = 88172645463325252u;
  cprox_status status = CPROX_OK;
  for (size_t pair = 0; pair < s->n_pairs && best->upper > 0.0; pair++) {
    for (int lot = 0; lot < LOTS && best->upper > 0.0 && may_look(s); lot++) {
      search_best of_lot = {.upper = INFINITY};
      double distance;
      for (int i = 0; i < STATES && of_lot.upper > 0.0; i++) {
        for (size_t k = 0; k < s->n_variables; k++) {
          const int32_t v = s->variables[k];
          s->state[v] = lesser(low[v] + fraction(&seed) * (high[v] - low[v]), high[v]);
        }
        if ((status = measure_state(s, pair, &of_lot, &distance)) < 0) return status;
      }
      if (of_lot.upper > 0.0 && (status = descend(s, pair, low, high, &of_lot)) < 0) return status;
      best->upper = lesser(of_lot.upper, best->upper);
    }
  }
  return CPROX_OK;
}

/* ---- the query ---- */

static void begin_side(box_search *s, int32_t index, int32_t common, box_side *side) {
  const cprox_robot *robot = s->robot;
  const cprox_link_geometry *g = &robot->given_geometries[index];
  const robot_link *link = &robot->links[g->link];
  *side = (box_side){.geometry = g, .at = robot_geometry_place(robot, index)};
  while (side->first < robot->n_parts && robot->parts[side->first].geometry != index) side->first++;
  side->last = side->first;
  while (side->last < robot->n_parts && robot->parts[side->last].geometry == index) {
    const robot_part *part = &robot->parts[side->last++];
    side->steps = greater(part->steps, side->steps), side->reach = greater(part->reach, side->reach);
  }
  for (int32_t i = link->axis; i != common; i = robot->axes[i].parent) side->n_axes++;
}

/* Appends the chain of a pair; the variables that it moves are noted. */
static box_axis *begin_pair(box_search *s, size_t index, box_axis *chain, bool *used) {
  const cprox_robot *robot = s->robot;
  box_pair *pair = &s->pairs[index];
  const cprox_robot_pair given = s->given[index];
  const int32_t a = robot->links[robot->given_geometries[given.geometry].link].axis,
                b = robot->links[robot->given_geometries[given.other].link].axis,
                common = robot_common_axis(robot, a, b);
  begin_side(s, given.geometry, common, &pair->side[0]);
  begin_side(s, given.other, common, &pair->side[1]);
  pair->chain = chain;
  for (int32_t i = a; i != common; i = robot->axes[i].parent) (chain++)->axis = i;
  box_axis *end = chain + pair->side[1].n_axes;
  for (int32_t i = b; i != common; i = robot->axes[i].parent) (--end)->axis = i;
  chain += pair->side[1].n_axes;
  for (const box_axis *i = pair->chain; i < chain; i++) used[robot->axes[i->axis].variable] = true;
  return chain;
}

static cprox_status box_check(const cprox_robot *robot, const cprox_robot_pair *pairs, size_t n_pairs,
                              const cprox_joint_box *box, const cprox_options *options, cprox_workspace *workspace) {
  if (!robot || !pairs || !box || n_pairs == 0) {
    workspace_fail(workspace, CPROX_INVALID, "robot, pairs and box are needed, and at least one pair");
    return CPROX_INVALID;
  }
  if (!box->lowest || !box->highest || box->n_variables != robot->n_variables)
    return workspace_fail(workspace, CPROX_INVALID, "the box has %zu variables, the robot %zu", box->n_variables,
                          robot->n_variables);
  for (size_t i = 0; i < n_pairs; i++) {
    const int32_t n = (int32_t)robot->n_geometries, a = pairs[i].geometry, b = pairs[i].other;
    if (a < 0 || b < 0 || a >= n || b >= n || a == b)
      return workspace_fail(workspace, CPROX_INVALID, "pair %zu is of geometries %d and %d, the robot has %d", i,
                            (int)a, (int)b, (int)n);
  }
  for (size_t i = 0; i < robot->n_variables; i++)
    if (!(box->lowest[i] <= box->highest[i] && fabs(box->lowest[i]) <= LENGTH_MOST &&
          fabs(box->highest[i]) <= LENGTH_MOST))
      return workspace_fail(workspace, CPROX_INVALID, "variable %zu is to be from %g to %g: no interval", i,
                            box->lowest[i], box->highest[i]);
  const arguments_query asked = {"the collision over a box of joint values", ARGUMENTS_STOP | ARGUMENTS_LOD};
  return validate_options(options, asked, workspace);
}

/* All memory but the boxes. */
static cprox_status box_begin(box_search *s, const cprox_joint_box *box) {
  const cprox_robot *robot = s->robot;
  const size_t n = robot->n_variables;
  const size_t bytes = s->n_pairs * (sizeof *s->pairs + 2 * robot->n_axes * sizeof(box_axis)) +
                       (robot->n_axes + 1) * sizeof(placement) + (n + 1) * (5 * sizeof(double) + sizeof(int32_t) + 1);
  char *memory = workspace_reserve(s->workspace, WORKSPACE_JOINT_BOX, bytes);
  if (!memory) {
    workspace_fail(s->workspace, CPROX_MEMORY, "no memory for %zu pairs", s->n_pairs);
    return CPROX_MEMORY;
  }
  memset(memory, 0, bytes);
  s->pairs = (box_pair *)(void *)memory;
  box_axis *chain = (box_axis *)(void *)(s->pairs + s->n_pairs);
  s->frames = (placement *)(void *)(chain + 2 * robot->n_axes * s->n_pairs);
  s->state = (double *)(void *)(s->frames + robot->n_axes + 1);
  s->best = s->state + n, s->lot = s->best + n, s->half = s->lot + n, s->weight = s->half + n;
  s->variables = (int32_t *)(void *)(s->weight + n);
  bool *used = (bool *)(s->variables + n);
  for (size_t i = 0; i < s->n_pairs; i++) chain = begin_pair(s, i, chain, used);
  for (size_t i = 0; i < n; i++) {
    s->state[i] = s->best[i] = box->lowest[i] + 0.5 * (box->highest[i] - box->lowest[i]);
    if (used[i]) s->variables[s->n_variables++] = (int32_t)i;
  }
  for (const box_axis *i = s->pairs[0].chain; i < chain; i++) {
    const robot_axis *axis = &robot->axes[i->axis];
    const double most = greater(fabs(box->lowest[axis->variable]), fabs(box->highest[axis->variable]));
    if (axis->kind == AXIS_PRISMATIC) s->extent += fabs(axis->multiplier) * most + fabs(axis->offset);
    if (axis->kind >= AXIS_BALL)
      return workspace_fail(s->workspace, CPROX_INVALID,
                            "a floating joint is between two links of a pair: boxes are of single values");
  }
  return CPROX_OK;
}

static cprox_status box_run(box_search *s, const cprox_joint_box *box, search_outcome *outcome) {
  search_node root = {.lower = -INFINITY};
  const int32_t slot = box_take(s);
  if (slot < 0) return workspace_fail(s->workspace, CPROX_MEMORY, "no memory for boxes of joint values");
  ((box_node *)(void *)&root.payload)->slot = slot;
  double *values = box_of(s, slot);
  for (size_t i = 0; i < s->n_variables; i++) {
    values[i] = box->lowest[s->variables[i]];
    values[s->n_variables + i] = box->highest[s->variables[i]];
  }
  const search_oracle oracle = {s, &s->work, box_filter, box_probe, box_split, box_release};
  search_goal goal = {.order = SEARCH_DEPTH_FIRST,
                      .limit = 0.0,
                      .cutoff = s->least,
                      .time_cutoff = INFINITY,
                      .epsilon = s->options->epsilon,
                      .max_nodes = s->options->max_nodes,
                      .stop = s->options->stop,
                      .stop_user = s->options->stop_user};
  return search_run(&goal, &oracle, root, s->workspace, outcome);
}

cprox_status cprox_robot_box_collision(const cprox_robot *robot, const cprox_robot_pair *pairs, size_t n_pairs,
                                       const cprox_joint_box *box, const cprox_options *options,
                                       cprox_workspace *workspace, cprox_result *result, double *state) {
  WORKSPACE_USE(workspace);
  if (!workspace) return CPROX_INVALID;
  workspace_clear(workspace);
  const cprox_options copy = validate_defaults(options);
  cprox_status status = box_check(robot, pairs, n_pairs, box, &copy, workspace);
  if (status < 0) return status;
  box_search s = {.robot = robot, .given = pairs, .n_pairs = n_pairs, .free_slot = -1, .least = INFINITY};
  s.options = &copy, s.workspace = workspace;
  status = box_begin(&s, box);
  if (status < 0) return status;
  search_best best = {.upper = INFINITY};
  search_outcome outcome = {.lower = -INFINITY, .best = {.upper = INFINITY}};
  status = look_for_contact(&s, box->lowest, box->highest, &best);
  if (status >= 0 && best.upper > 0.0) status = box_run(&s, box, &outcome);
  cprox_workspace_free(s.prover);
  if (status < 0) return status;

  cprox_result r = {.status = status, .t_obstacle = NAN, .obstacle_index = -1, .mover_part = -1};
  r.lower = greater(lesser(outcome.lower, s.least), 0.0);
  r.upper = s.least;
  r.verdict = r.lower > 0.0 ? CPROX_VERDICT_CLEAR : r.upper <= 0.0 ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_UNDECIDED;
  if (r.verdict != CPROX_VERDICT_UNDECIDED) r.status = CPROX_OK;
  if (r.verdict == CPROX_VERDICT_UNDECIDED && r.status == CPROX_OK) r.status = CPROX_PRECISION;
  r.nodes = outcome.nodes, r.distance_queries = s.work;
  if (state) memcpy(state, s.best, robot->n_variables * sizeof *state);
  *result = r;
  if (r.status == CPROX_OK)
    workspace_clear(workspace);
  else
    workspace_fail(workspace, r.status, "whether the links touch stays open: %s",
                   r.status == CPROX_PRECISION ? "they come closer than epsilon" : "the budget is used up");
  return r.status;
}
