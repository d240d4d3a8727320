/* SPDX-License-Identifier: BSD-3-Clause */
/* A query about a robot, made ready: what stands, the pairs, and where everything is over a node. */
#ifndef CPROX_ROBOT_QUERY_ROBOT_SCENE_H
#define CPROX_ROBOT_QUERY_ROBOT_SCENE_H

#include "kinematics/bound.h"
#include "kinematics/errors.h"
#include "problem/candidates.h"
#include "robot_query/element.h"
#include "robot_query/pair_distance.h"
#include "robot_query/pair_plan.h"
#include "robot_query/pair_table.h"

/* A pair of a part of the robot that moves and what it is held against. */
typedef struct robot_pair {
  int32_t moving;     /* which part of the robot */
  int32_t standing;   /* which obstacle, or of a pair with itself which part */
  uint32_t shared;    /* of the robot itself: so many axes are above both sides, */
  int32_t common;     /* this one the last of them; -1: none */
  int32_t element[2]; /* of what the moving and the standing side are made of, as robot_element_make() has it */
  int32_t near[2];  /* of whole sides: the elements that were nearest to each other last; ROBOT_WHOLE: none is known */
  int32_t inner;    /* the first of the pairs that it was opened into, */
  uint32_t n_inner; /* so many; 0: it was not */
  /* the last separating direction, from what stands to what moves, in the frame of what stands, where on the motion it
   * was found (robot_scene_place()), and how fast it turned there; so it may be carried on between `from` and `to` */
  vec3 normal, normal_rate;
  double found, from, to;
  bool normal_known;
  bool self; /* what stands is a part of the robot, too */
} robot_pair;

/* Of whole sides, no elements. */
static inline bool robot_pair_is_whole(const robot_pair *pair) {
  return pair->element[0] == ROBOT_WHOLE && pair->element[1] == ROBOT_WHOLE;
}

/* A part over the node at hand. */
typedef struct part_state {
  uint32_t placed, displaced, moved; /* the node for which `body.side.at`, `displacement` and `motion` were found */
  robot_body body;
  int32_t carrier;     /* the last axis above it that the motion moves; -1: it stands in the world */
  double displacement; /* that of the motion */
  uint32_t swept;      /* the node for which `sweep` was found */
  sweep_box sweep;
  chain_motion motion; /* seen from the world */
} part_state;

/* A track of the motion over the node at hand. */
typedef struct track_state {
  uint32_t found;      /* the node for which `own` was found */
  uint32_t filled;     /* and its rows */
  motion_interval own; /* of its own segments */
} track_state;

/* Of a whole part, by the node for which it was found. */
typedef struct part_deviation {
  uint32_t found;
  deviation joints, places; /* by joints that are off; by the base, flex, obstacles that are shifted, and sensors */
  double travel;            /* how far the part moves from the middle to anywhere in the node */
} part_deviation;

typedef struct robot_scene {
  const query *q;
  const cprox_motion *motion;
  bool has_solids;                        /* a side of a pair may be a solid mesh */
  const start_class *starts;              /* only pairs of this class; NULL: all */
  double lead_tolerance, other_tolerance; /* [s] of its clocks */
  robot_body *obstacles;
  part_state *parts;
  axis_state *axes;      /* those above the parts that were asked for on the present node, */
  uint32_t *axis_placed; /* which have its number here */
  track_state *tracks;
  double *rows, *scratch;
  double *displacements; /* of each part over the node at hand, as motion_displacements() has them, so many a part; NULL
                            where those would be too many */
  size_t n_displacements;
  chain_axis *chain;
  axis_deviations *deviations; /* where the query has errors (robot_query/deviation.h), of each axis */
  part_deviation *part_deviations;
  robot_pair *pairs;
  size_t n_pairs, n_obstacles;
  pair_plan plan;              /* what was listed in the beginning: these come first */
  pair_table met;              /* what was made of obstacles of the set, and of groups */
  struct robot_groups *groups; /* of parts, where pairs with itself are found by them (robot_query/groups.h), or NULL */
  robot_element element[2];    /* those of the pair that was placed last: moving, standing */
  uint32_t node;               /* counts the nodes, so that states know whether they are of the present one */
  motion_interval over;        /* that node; where the class has another clock, of its lead, */
  motion_interval other;       /* and that of the other clock */
  span_centre centre; /* everything stands as it does here: in its middle, or near that of a span. A bent span is only
                         bounded by how far parts move */
  span_centre other_centre; /* the same of the other clock */
  bool at_place;            /* the node is a place: of axes only the frames are known */
  two_times times;
} robot_scene;

/* So many pairs of a robot with itself are listed one by one; groups of parts would cost more. */
#ifndef ROBOT_MOST_LISTED
#define ROBOT_MOST_LISTED 200
#endif

/* Makes the scene of obstacles first … last - 1 ready, for pairs of a class (kept by reference; NULL: all, as if all
 * starts were known); false where memory is out. Of a set, only those without a box; the
 * rest come as they are needed. If the robot could have more than `most_listed` pairs with itself, these come as groups
 * of its parts come near each other; SIZE_MAX: every pair is listed. Otherwise those of several robots that stay too
 * far apart to matter are left out; `cutoff`: an upper bound known from elsewhere, or infinity. */
bool robot_scene_begin(robot_scene *scene, const query *q, const start_class *starts, size_t first, size_t last,
                       size_t most_listed, double cutoff);

/* Whether the class's pairs are at two times. */
static inline bool robot_scene_has_two_times(const robot_scene *scene) {
  return scene->starts && scene->starts->other != CLOCK_NONE;
}

/* All times of the class's clocks that are asked about. */
void robot_scene_range(const robot_scene *scene, motion_interval *lead, motion_interval *other);

/* Takes off what is not possible of both intervals together; false: nothing is left. */
bool robot_scene_fit(const robot_scene *scene, motion_interval *lead, motion_interval *other);

/* The earliest time of the clock of all at which its two clocks can be at these times, or later; rounded down. */
double robot_scene_clock(const robot_scene *scene, double lead, double other);

/* Of two times: how far the side of the pair moves that is on the other clock, and the one on the lead. */
void robot_scene_displacements(robot_scene *scene, const robot_pair *pair, double *other, double *lead);

/* A pair of which nothing is known yet; self: of two parts of the robot. */
robot_pair robot_scene_pair_of(const robot_scene *scene, const planned_pair *planned, bool self);

/* Whether the motion does not move the sides of a pair against each other. */
static inline bool robot_scene_stands(const robot_scene *scene, const robot_pair *pair) {
  const int32_t other = pair->self ? scene->parts[pair->standing].carrier : -1;
  return scene->parts[pair->moving].carrier == other;
}

/* The parts of an obstacle are obstacles; adds them: the number of the first one, or -1 where memory is out. It may
 * move all obstacles in memory. */
int32_t robot_scene_add_obstacles(robot_scene *scene, size_t obstacle);

/* A new node: of one segment, or of any number; another clock is at the same times, or at its own. */
void robot_scene_enter(robot_scene *scene, size_t segment, double a, double b);
void robot_scene_enter_span(robot_scene *scene, const motion_interval *over);
void robot_scene_enter_both(robot_scene *scene, const motion_interval *lead, const motion_interval *other);

/* A single time, where nothing but distances is asked for: the frames of parts are found, and nothing moves. Not where
 * the class has two times. */
void robot_scene_enter_place(robot_scene *scene, size_t segment, double u);

/* Whether the middle of the node, where everything is measured, is possible. */
bool robot_scene_is_possible(const robot_scene *scene);

static inline bool robot_scene_is_bent(const robot_scene *scene) {
  return scene->centre.bent || scene->other_centre.bent;
}

/* The time of the other clock in the middle of the node. */
double robot_scene_other_time(const robot_scene *scene);

/* Looks at the tracks that move a pair, or at all: whether a span is bent is known of those that were looked at.
 * Nothing is done twice on a node. */
void robot_scene_fill_pair(robot_scene *scene, const robot_pair *pair);
void robot_scene_fill(robot_scene *scene);

/* Where a segment's u is along the motion, in [0, 1] by time: only to choose by. */
double robot_scene_place(const robot_scene *scene, size_t segment, double u);

/* One more pair; its number, or -1 where memory is out. It may move all pairs in memory. */
int32_t robot_scene_add_pair(robot_scene *scene, const robot_pair *pair);

/* A whole part in the middle of the node; how far it moves over it, seen from the world: then its displacements are
 * known, too. */
void robot_scene_place_part(robot_scene *scene, int32_t part);
static inline const robot_body *robot_scene_part(robot_scene *scene, int32_t part) {
  if (scene->parts[part].placed != scene->node) robot_scene_place_part(scene, part);
  return &scene->parts[part].body;
}
double robot_scene_part_displacement(robot_scene *scene, int32_t part);

/* Of a motion of several tracks: over all of the node the sides of a pair are never nearer than this; known without a
 * look at how they move. -infinity where that leaves open whether they touch. */
double robot_scene_swept_apart(robot_scene *scene, const robot_pair *pair);

#endif
