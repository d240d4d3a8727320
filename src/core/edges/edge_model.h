/* SPDX-License-Identifier: BSD-3-Clause */
/* A robot among obstacles in single precision: all that many edges share. Coordinates are seen from the base, the
 * origin of the first axis. doc/robot-edges.md, doc/rounding.md */
#ifndef CPROX_EDGES_EDGE_MODEL_H
#define CPROX_EDGES_EDGE_MODEL_H

#include "base/workspace.h"
#include "curve_proximity/cprox/edges.h"
#include "kinematics/joint_tree.h"
#include "kinematics/part_cover.h"

/* Unit roundoff of float. */
#define EDGE_U 0x1p-24

/* What double arithmetic costs before coordinates are seen from the base, by the sizes of those in the world. */
#define ROUND_WORLD 0x1p-42

/* Frame 0 is the base, which stands; every other one is an axis that turns about its own z, or shifts along it. */
typedef struct edge_frame {
  int32_t parent; /* a frame before this one */
  int32_t variable;
  bool shifts;
  double multiplier, offset;
  float r[9], p[3];   /* where it stands at 0, in its parent's frame */
  int32_t from[3];    /* where r only exchanges axes: column k is `sign` times the parent's column `from`; */
  float sign[3];      /* from[0] < 0: it turns by any angle */
  double length;      /* |p| */
  double fixed_reach; /* of its origin from the base, shifts not counted */
} edge_frame;

typedef struct edge_ball {
  float centre[3]; /* in the frame of its part */
  float outer, inner;
  float reach; /* |centre|, from above */
  int32_t geometry;
} edge_ball;

/* Points of hulls stand in blocks of eight: eight x, eight y, eight z. What is left of a hull's last block repeats its
 * last point. */
enum { EDGE_BLOCK = 8 };

/* Where the first coordinate of point i of a hull stands; the others follow EDGE_BLOCK apart. */
static inline size_t edge_point_place(size_t i) {
  return i / EDGE_BLOCK * 3 * EDGE_BLOCK + i % EDGE_BLOCK;
}

/* A hull of points of its part's frame; in a robot that has hulls a ball is one, too, of its centre. */
typedef struct edge_hull {
  uint32_t first, n;          /* its first block, and how many points it has */
  float centre[3], core;      /* a ball that all its points are in */
  float margin;               /* what it stands for is within this of the hull */
  float inner;                /* what it stands for reaches so far about each point; negative: that is not known */
  uint32_t child, n_children; /* hulls that together contain all that this one stands for */
  uint32_t end;               /* where those of the next cover begin */
  int32_t geometry;
} edge_hull;

/* Geometries on one link that are asked about the same obstacles and the same other geometries. */
typedef struct edge_part {
  int32_t frame;
  uint32_t first_member, n_members; /* the geometries */
  float centre[3];
  float outer, core;      /* radii about that: of all outer balls, and of their centres */
  float reach;            /* |centre|, from above */
  double farthest;        /* the largest reach of any ball, its radius included */
  double reach_of_centre; /* the largest |centre| of any ball */
  uint32_t first, n;      /* balls */
  uint32_t first_hull, end_hull;
  bool by_hulls; /* they are looked at instead of balls */
  uint32_t first_near, n_near;
  bool coarse; /* its balls are not looked at: what its own ball comes near is left open */
} edge_part;

typedef enum edge_shape {
  EDGE_BALL,
  EDGE_ALIGNED_BOX, /* along the coordinates */
  EDGE_BOX,
  EDGE_CAPSULE,
  EDGE_CYLINDER,
  EDGE_CONE,
  EDGE_HALFSPACE
} edge_shape;

/* What stands. The shape is grown by what rounding of its own numbers costs, so that distances from it are never too
 * large on that account. */
typedef struct edge_obstacle {
  edge_shape shape;
  int32_t obstacle;
  float p[3];
  float r[9];    /* columns are its axes; of a halfspace the first one is the normal */
  float size[3]; /* half extents; radius and half height; a halfspace's offset */
  float margin;  /* a ball about each point, and of a cone the growth; the others have grown sizes */
  float grown;   /* distances may be too small by this; infinity: it only contains what stands */
  /* what is in it: the hull of some corners, n > 0, or the elements of a tree */
  edge_hull hull;
  const struct tree *tree;
  float origin[3], axes[9]; /* of these */
  float around, within;     /* they are thicker by less than this, and by more than that; negative: that is not known */
  float costs;              /* distances from them may be too small by this */
} edge_obstacle;

/* A pair of parts: `a` as `b` sees it. */
typedef struct edge_pair {
  uint32_t a, b;
  uint32_t relation;
} edge_pair;

/* An axis on the way from one frame to another one, and how far its origin is from that of the one before. */
typedef struct edge_step {
  int32_t frame;
  int32_t shifted; /* a frame whose shift adds to the length; -1: none */
  double length;
} edge_step;

/* How a frame moves as another one sees it. */
typedef struct edge_relation {
  int32_t a, b;
  uint32_t first, n; /* steps */
  edge_step last;    /* from the last step's origin to that of frame a */
} edge_relation;

/* Of each geometry a row of bits: the obstacles, or where all are asked about one bit for them, then the other
 * geometries that it is asked about. */
typedef struct edge_rows {
  uint64_t *bits;
  size_t words, n_obstacles;
  bool all;
} edge_rows;

struct cprox_edge_checker {
  const cprox_robot *robot;
  cprox_edge_query asked;
  cprox_robot_pair *pairs; /* of geometries and obstacles, then of geometries: all that are asked about */
  size_t n_pairs, n_self_pairs;
  void *memory[2]; /* of the robot's side and of the scene's, where the handle owns them */
  bool in_lanes;   /* single precision can say something */
  bool has_scene;  /* the scene's side is that of the last query */
  vec3 base;
  edge_rows rows;
  int32_t *frame_of; /* of an axis; -1: it carries nothing that is asked about */
  size_t n_frames, n_parts, n_members, n_balls, n_hulls, n_blocks, n_corners, n_obstacles, n_near, n_lane_pairs,
      n_relations, n_steps;
  edge_frame *frames;
  edge_part *parts;
  int32_t *members; /* geometries by part */
  edge_ball *balls;
  edge_hull *hulls;
  float *points;  /* of hulls, in blocks */
  float *corners; /* of obstacles, in blocks */
  edge_obstacle *obstacles;
  uint32_t *near; /* obstacles by part */
  edge_pair *lane_pairs;
  edge_relation *relations;
  edge_step *steps;
  double obstacle_reach; /* the largest coordinate of an obstacle */
  double clear_beyond;   /* [m] delta and the caller's rounding; */
  double hit_within;     /* delta without it, at least 0 */
  double beyond;         /* obstacles that are out of reach stay farther away than clear_beyond and this */
};

/* What is asked about, for the robot's side of a model. */
typedef struct edge_asked {
  const cprox_robot *robot;
  bool about_obstacles, about_self;
  const cprox_robot_pair *pairs, *self_pairs; /* NULL: all, and all that are worth asking for */
  size_t n_pairs, n_self_pairs, n_obstacles;
} edge_asked;

/* Pairs of geometries that there are at most. */
size_t edge_model_count_pairs(const edge_asked *asked);

/* The bytes that the two sides of a model take. */
size_t edge_model_robot_size(const edge_asked *asked, const robot_covers *covers);
size_t edge_model_scene_size(const cprox_edge_checker *model, const cprox_obstacle *obstacles, size_t first,
                             size_t last);

/* The robot's side, in such memory; all else must be 0. Afterwards in_lanes says whether the robot can be in lanes. */
void edge_model_fill_robot(cprox_edge_checker *model, const edge_asked *asked, const robot_covers *covers,
                           char *memory);

/* The robot's side in a buffer of the workspace, where it stays from query to query; it is made again where the robot
 * or what is asked about it is another one. NULL: lanes are no use for it, or memory is out. */
cprox_edge_checker *edge_model_keep(const edge_asked *asked, cprox_workspace *workspace, workspace_buffer buffer);

/* The scene's side: obstacles first … last - 1, those given to edge_model_scene_size(). `reach`
 * of each part, from the base; NULL: as far as it can. Obstacles that are out of all reach are left out. */
void edge_model_fill_scene(cprox_edge_checker *model, const cprox_obstacle *obstacles, size_t first, size_t last,
                           const double *reach, char *memory);

/* Distances of lanes are held against sums of radii that are grown by this factor: it covers the rounding of squares,
 * roots and sums of what is positive. doc/rounding.md */
#define EDGE_GROW 0x1p-19

#endif
