/* SPDX-License-Identifier: BSD-3-Clause */
/* Trees that came from each other by updates of their points: which blocks they share. */
#ifndef CPROX_BVH_FAMILY_H
#define CPROX_BVH_FAMILY_H

#include <stdatomic.h>

#include "bvh/bvh.h"

/* What trees that came from each other share: numbers for the states of blocks, each given once. */
struct tree_family {
  atomic_uint_fast64_t next;
  atomic_uint_fast32_t members;
};

struct tree_blocks {
  struct tree_family *family;
  uint32_t *block_of; /* an element's, for good */
  uint64_t *state;    /* a block's */
  double *area;       /* of a block's packs when they were sorted; 0 where nobody has asked yet */
  size_t n;
};

/* The record of n elements' blocks, without a family yet; NULL where memory is out. */
struct tree_blocks *tree_blocks_allocate(size_t n);

#endif
