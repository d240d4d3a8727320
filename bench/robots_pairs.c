/* SPDX-License-Identifier: BSD-3-Clause */
/* How many of the pairs that a node looks at have their distance measured: the same search as a query's, its oracle
 * watched from outside. `nodes` are looks at a pair on an interval of the motion, `distance queries` distances
 * measured, those that the search begins with and those of elements of meshes included, `error` their share. */
#include <math.h>
#include <stdio.h>

#include "robot_query/oracle.h"
#include "robots.h"
#include "solve/list.h"
#include "solve/solve.h"

typedef struct watched {
  robot_search search;
  search_oracle oracle;
  uint64_t looks;
} watched;

static double filter(void *self, search_node *node, double goal) {
  watched *w = self;
  return w->oracle.filter(w->oracle.self, node, goal);
}

static cprox_status probe(void *self, search_node *node, search_best *best) {
  watched *w = self;
  const robot_search *o = &w->search;
  const robot_node *payload = robot_known(node);
  const list_entry *entry = lists_at(&o->lists, payload->list);
  const size_t n = lists_count(&o->lists, payload->list);
  for (size_t i = 0; i < n; i++) w->looks += !search_is_pruned(&o->goal, o->best_bound.upper, entry[i].lower);
  return w->oracle.probe(w->oracle.self, node, best);
}

static int split(void *self, search_node *node, search_node *child) {
  watched *w = self;
  return w->oracle.split(w->oracle.self, node, child);
}

static void release(void *self, const search_node *node) {
  watched *w = self;
  w->oracle.release(w->oracle.self, node);
}

/* The search of one query; false where it is not the one that the query makes. */
static bool watch(const robot_case *c, bool self, double delta, double epsilon, cprox_workspace *ws, uint64_t *looks,
                  uint64_t *measured) {
  const cprox_mover mover =
      self ? cprox_robot_self(c->motion, c->self_pairs, c->n_self_pairs) : cprox_robot_along(c->motion, NULL, 0);
  const size_t n = self ? 0 : c->n_targets;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = epsilon;
  cprox_result r;
  if (delta < 0.0)
    list_distance(mover, c->targets, n, &options, ws, &r, NULL);
  else
    list_tolerance(mover, c->targets, n, delta, &options, ws, &r, NULL);

  query q = query_create(mover, c->targets, n, delta, &options, ws);
  query_ask_whole(&q);
  watched w = {.looks = 0};
  search_goal goal = {.order = delta < 0.0 ? SEARCH_BEST_FIRST : SEARCH_DEPTH_FIRST,
                      .limit = delta,
                      .cutoff = INFINITY,
                      .time_cutoff = INFINITY,
                      .epsilon = epsilon,
                      .relative_epsilon = options.relative_epsilon,
                      .max_nodes = options.max_nodes};
  if (!robot_scene_begin(&w.search.scene, &q, NULL, 0, n, ROBOT_MOST_LISTED, INFINITY)) return false;
  robot_search_begin(&w.search, &goal);
  w.oracle = robot_search_oracle(&w.search);
  const search_oracle outer = {.self = &w, .filter = filter, .probe = probe, .split = split, .release = release};
  search_outcome found;
  search_node root;
  const motion_interval over = {.b = 1.0, .last = c->motion->n_segments};
  if (!robot_search_root(&w.search, &over, &over, &root)) return false;
  if (search_run(&goal, &outer, root, ws, &found) != CPROX_OK) return false;
  *looks += w.looks, *measured += w.search.gaps;
  return found.nodes == r.nodes && w.search.gaps == r.distance_queries;
}

/* Whose pairs: with the scene, the robot's own. */
enum { SCENE = 1, SELF = 2 };

static void row(const char *parameter, const robot_case *cases, size_t n, int whose, double factor, double epsilon,
                cprox_workspace *ws) {
  uint64_t looks = 0, measured = 0;
  unsigned long failures = 0;
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < cases[i].n_answers; k++) {
      const case_answer *a = &cases[i].answers[k];
      if (!(whose & (a->self ? SELF : SCENE)) || !(a->lower > 0.0)) continue;
      const double delta = factor < 0.0 ? -1.0 : factor * 0.5 * (a->lower + a->upper);
      failures += !watch(&cases[i], a->self, delta, epsilon, ws, &looks, &measured);
    }
  printf("robots,pairs measured,curve_proximity,%s,nan,nan,%llu,%llu,%.4g,0,%lu\n", parameter,
         (unsigned long long)looks, (unsigned long long)measured, (double)measured / (double)looks, failures);
  fflush(stdout);
}

void bench_robot_pairs(const robot_case *cases, size_t n, cprox_workspace *ws) {
  row("all epsilon 1e-06", cases, n, SCENE | SELF, -1.0, 1e-6, ws);
  row("all epsilon 0.0001", cases, n, SCENE | SELF, -1.0, 1e-4, ws);
  row("all delta 0.9 D", cases, n, SCENE | SELF, 0.9, 1e-6, ws);
  row("environment epsilon 1e-06", cases, n, SCENE, -1.0, 1e-6, ws);
  row("environment delta 0.9 D", cases, n, SCENE, 0.9, 1e-6, ws);
  row("self epsilon 1e-06", cases, n, SELF, -1.0, 1e-6, ws);
  row("self delta 0.9 D", cases, n, SELF, 0.9, 1e-6, ws);
}
