/* SPDX-License-Identifier: BSD-3-Clause */
/* Trees of boxes, eight lanes wide, over triangles, points or boxes: which element is nearest to a point, which ones
 * matter to a segment of curve or to a convex shape. What an element means (a face, a ball, an occupied cell, a whole
 * body) is the caller's affair. doc/non-convex.md derives the bounds.
 *
 * The layout is the same on every machine; the loops over lanes are compiled for several instruction sets and chosen
 * when a tree is made. They do the same operations in the same order, so that every machine gives the same answer. */
#ifndef CPROX_BVH_BVH_H
#define CPROX_BVH_BVH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/vec.h"

enum { TREE_LANES = 8, TREE_ALL_LANES = (1 << TREE_LANES) - 1, TREE_DEEPEST = 40, TREE_MOST_POINTS = 64 };

/* A child with this bit is a pack of elements, else a node. */
#define TREE_LEAF 0x80000000u

/* Elements are numbered below this. */
#define TREE_MOST_ELEMENTS ((size_t)1 << 30)

/* What rounding can take from a lane's bound or distance, per unit of the lengths that enter (doc/non-convex.md). */
#define TREE_ROUND 16.0

typedef enum tree_kind { TREE_TRIANGLES, TREE_POINTS, TREE_BOXES } tree_kind;

typedef struct tree_node {
  _Alignas(64) double low[3][TREE_LANES], high[3][TREE_LANES]; /* unused lanes repeat the last one */
  uint32_t child[TREE_LANES];
  uint32_t lanes; /* one bit for each lane in use */
} tree_node;

/* What is in a lane of a node lies between two planes, too: low <= s·x <= high, s of length 1 or so. Boxes of pieces of
 * a slanted surface stick out of it by their own size, these by its square. */
typedef struct tree_slabs {
  _Alignas(64) double s[3][TREE_LANES], low[TREE_LANES], high[TREE_LANES];
} tree_slabs;

/* Numbers a pack: three corners, one, or two; a coordinate is TREE_LANES numbers. */
static inline size_t tree_pack_size(tree_kind kind) {
  return (size_t)TREE_LANES * (kind == TREE_TRIANGLES ? 9 : kind == TREE_BOXES ? 6 : 3);
}

struct tree_kernel;
struct tree_blocks;

typedef struct tree {
  tree_kind kind;
  size_t n, n_nodes, n_packs;
  tree_node *nodes;  /* the first one is the root */
  tree_slabs *slabs; /* of each node where there are triangles, else NULL */
  double *packs;
  uint32_t *ids; /* TREE_LANES a pack; a pack that is not full repeats its last element */
  double scale;  /* no element reaches farther from the origin */
  const struct tree_kernel *kernel;
  struct tree_blocks *blocks; /* of a tree whose points may move, else NULL */
} tree;

/* ---- building ---- */

/* Elements as they were given; they are stored about the centre. */
typedef struct tree_source {
  tree_kind kind;
  size_t n;                       /* 1 … TREE_MOST_ELEMENTS elements */
  const vec3 *points;             /* vertices; points; the boxes' lower corners */
  const vec3 *high;               /* the boxes' upper corners */
  const uint32_t (*triangles)[3]; /* indices of vertices */
  vec3 centre;
  cprox_workspace *workspace; /* its stop function is asked while the tree is built; may be NULL */
} tree_source;

/* By surface area: slower to build, faster to ask. By Morton's curve: for what changes with every measurement. */
typedef enum tree_build { TREE_BY_AREA, TREE_BY_MORTON } tree_build;

/* NULL where memory is out, or the source's workspace stops. tree_free() frees. */
tree *tree_create(const tree_source *source, tree_build build);
void tree_free(tree *t);

/* The bytes that a tree of n elements needs at most; what building it needs besides is given back. */
size_t tree_bytes_needed(tree_kind kind, size_t n, tree_build build);

/* How many packs and nodes a build needs at most. */
size_t tree_most_packs(size_t n, tree_build build);
size_t tree_most_nodes(size_t n, tree_build build);

/* The bytes that this one takes. */
size_t tree_bytes(const tree *t);

/* ---- points that move ---- */

/* Elements stay in their block, which is rebuilt by itself when one of them moves: whole packs, whole nodes of three
 * levels. */
enum { TREE_BLOCK = 4096 };

/* Makes ready for updates a tree of points by Morton's curve; false where memory is out. What that takes besides. */
bool tree_begin_family(tree *t);
size_t tree_blocks_bytes(size_t n);
bool tree_is_family(const tree *a, const tree *b);
void tree_blocks_free(struct tree_blocks *blocks);

/* The same points, but that changed[i] stands at points[i], about the centre. NULL where memory is out. `retired`, of
 * the same family and otherwise out of use, or NULL: becomes the new tree; what it has in common with the previous one
 * is not even copied. */
tree *tree_update(const tree *previous, const uint32_t *changed, const vec3 *points, size_t n, vec3 centre,
                  tree *retired);

/* ---- elements ---- */

/* Where an element stands. */
typedef struct tree_place {
  uint32_t pack, lane;
} tree_place;

static inline uint32_t tree_element(const tree *t, tree_place at) {
  return t->ids[(size_t)at.pack * TREE_LANES + at.lane];
}

/* Its corners as stored; how many: 3, 1 or 2. */
int tree_corners(const tree *t, tree_place at, vec3 corner[3]);

/* What of an element is nearest to a point. */
typedef struct tree_near {
  double distance; /* attained, within TREE_ROUND u (|x| + scale + distance) */
  vec3 point;
  vec3 normal;  /* unit, from the element to x; (0,0,0) where they touch */
  int tangents; /* of the feature: a vertex has none, an edge one, a face two */
  vec3 e[2];
} tree_near;

void tree_element_near(const tree *t, tree_place at, vec3 x, tree_near *near);

/* ---- queries --------------------------------------------------------------------------------------------------------
 * */

/* The element nearest to x. Elements at `bound` or farther are of no interest: infinity, where all are. */
typedef struct tree_hit {
  bool found;
  tree_place at;
  double upper; /* attained by the element found; else the bound */
  double lower; /* every element is at least so far away; both but for TREE_ROUND u (|x| + scale + upper) */
} tree_hit;

tree_hit tree_nearest(const tree *t, vec3 x, double bound);

/* How far the elements reach along d, of any length but 0, and a corner that does: the support function of their hull,
 * within 4 u |d| scale. */
double tree_farthest(const tree *t, vec3 d, vec3 *at);

/* What is in a lane of a node reaches no farther along d, |d| = 1, but for 8 u scale. */
double tree_lane_reach(const tree *t, uint32_t at, uint32_t lane, vec3 d);

/* A segment of curve as the tree sees it: the hull of points, thickened by a radius. */
typedef struct tree_segment {
  vec3 x;                        /* where own normals are taken */
  size_t n;                      /* 1 … TREE_MOST_POINTS */
  double p[3][TREE_MOST_POINTS]; /* the points less x */
  double radius;
  const double *thick; /* NULL, or what is taken off at each point on top of that */
  double thickest;     /* the most of it; 0 where there is none */
  bool known;          /* a normal from elsewhere is to be tried too: */
  vec3 normal;         /* unit within 4 u, */
  double along;        /* min normal·p, less what is taken off */
  bool stepping;       /* x is the first point, and slopes are wanted */
  double beyond;       /* lanes that are farther are of no interest: infinity, where all are */
} tree_segment;

/* What one node or pack says of a segment, lane by lane. */
typedef struct tree_lanes {
  _Alignas(64) double bound[TREE_LANES]; /* the lane is at least so far from the segment */
  double distance2[TREE_LANES];          /* squared, from x: attained by elements, a lower bound for boxes */
  double width2[TREE_LANES];             /* of a node's boxes: their diagonal, squared */
  double first[TREE_LANES];              /* stepping: the bound at the first point by the lane's own normal, */
  double slope[TREE_LANES];              /* and how fast it can fall, per segment */
  uint32_t live;                         /* wanted lanes that are not beyond what is of interest, */
  double rest;                           /* and the least bound of those that are */
} tree_lanes;

/* `at` is a node, or a pack with TREE_LEAF; `wanted` has a bit for each lane that matters. Of a pack of which none
 * comes within `beyond` only the bounds are filled in, and distances are infinite. */
void tree_measure(const tree *t, uint32_t at, uint32_t wanted, const tree_segment *segment, tree_lanes *lanes);

/* Elements that could come nearer than `bound` to a convex shape in a ball, nearest first. The visitor measures one and
 * may lower the bound and tell a normal that the shape lies behind. */
typedef struct tree_seeker {
  vec3 centre; /* of a ball that contains the shape */
  double radius;
  double bound;
  bool known; /* all of the shape has normal·x >= least */
  vec3 normal;
  double least;
  void (*visit)(struct tree_seeker *seeker, tree_place at, uint32_t element);
  void *self;
} tree_seeker;

/* All elements that were not visited are at least seeker->bound, as it is in the end, from the shape, but for
 * TREE_ROUND u (|centre| + scale + radius + bound). */
void tree_seek(const tree *t, tree_seeker *seeker);

#endif
