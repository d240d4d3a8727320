/* SPDX-License-Identifier: BSD-3-Clause */
/* What balls and chords tell of one mover and all parts of a batch, before anything is searched. doc/batches.md says
 * why it is sound. */
#ifndef CPROX_BATCH_PREFILTER_H
#define CPROX_BATCH_PREFILTER_H

#include "batch/obstacle_batch.h"

enum {
  BATCH_MOST_PIECES = 4
}; /* curves of more are searched along their tree of capsules instead of cut into chords */

/* One call, and the mover that it is at. */
typedef struct batch_run {
  const obstacle_batch *batch;
  query q;
  double *cluster_lower; /* of each cluster of parts, */
  double *lower;         /* of each part's ball, padded; not known in clusters that are beyond what matters */
  uint32_t *open;        /* the n_open parts whose bound does not settle them */
  size_t n_open;
  bool short_enough;                                      /* for points and chords */
  packet_box boxes[BATCH_MOST_PIECES * PACKET_INTERVALS]; /* round intervals of the curve's chords: n_boxes, */
  size_t n_boxes;                                         /* or 0, where the curve's capsule has to do */
  candidate *near;                                        /* what may matter to the mover */
  const double *basis;                                    /* of the degree, */
  size_t degree;                                          /* this one; SIZE_MAX: of none */
  bool measured;                                          /* `slack` is known */
  uint32_t cut; /* which halves of the pieces have points at equal parameters below: */
  bool joined;  /* and the chords between all of them are known */
  packet_chords chords[BATCH_MOST_PIECES];
  double beside; /* how far the curve may be from the chords' points of the same parameter */
  double slack;  /* how much rounding may add to that */
} batch_run;

/* Where the curve comes within the limit of a part. */
typedef struct batch_hit {
  double upper;   /* of the distance, rounding included */
  size_t part;    /* number in the batch */
  uint32_t piece; /* the curve's point: at s of this, */
  double s;
  vec3 point;      /* here, */
  double distance; /* so far from the part without its margin, 0 or less inside, */
  vec3 surface;    /* of which this point is that near */
} batch_hit;

typedef struct batch_prefilter_answer {
  bool is_hit; /* that settles it: of what is below `beyond` and `level of detail` are known */
  batch_hit hit;
  size_t n;      /* candidates in `near`: the one of the least upper bound first, the others nearest first */
  double beyond; /* the least lower bound of all others */
  cprox_lod lod; /* what that took */
} batch_prefilter_answer;

/* Looks at all parts from the curve of run->q.mover, a point or a ball with control points. Fills *look. */
void batch_prefilter(batch_run *run, batch_prefilter_answer *look);

/* Which parts may matter: bounds the clusters of them, by boxes round the curve's chords where there are many; the part
 * that may be nearest, or SIZE_MAX where there is none; lists in run->open what is not farther than `most`, and returns
 * the least bound of the others. */
void batch_cull_begin(batch_run *run);
size_t batch_cull_nearest(batch_run *run);
double batch_cull_list(batch_run *run, double most);

/* The basis and run->slack; false where memory is out. The least square distance of the points of half a piece from a
 * point, and which one of the piece has it. The chords between all points, and run->beside. */
bool batch_points_ready(batch_run *run);
double batch_points_nearest(batch_run *run, uint32_t half, vec3 from, uint32_t *nearest);
void batch_points_join(batch_run *run);

/* What the box round a part says of the curve, whose chords are joined. Raises c->lower, to more than `most` where that
 * can be shown, says where a search should begin, and sets *upper to an upper bound or infinity. True where it finds a
 * hit: contact, or what violates the limit. */
bool batch_bound_by_obb(batch_run *run, size_t part, double most, candidate *c, double *upper, batch_hit *hit);

#endif
