/* SPDX-License-Identifier: BSD-3-Clause */
/* The lists of pairs that are still of interest on a segment of a motion. Children share their parent's list, so lists
 * are counted by their users; memory is the workspace's, in blocks of powers of two. */
#ifndef CPROX_ROBOT_QUERY_PAIR_LISTS_H
#define CPROX_ROBOT_QUERY_PAIR_LISTS_H

#include <stdbool.h>

#include "base/workspace.h"

/* What is no pair yet: all that is under a node of the set's tree, for one part of the robot; two groups of its parts.
 */
enum { LIST_CLUSTER = -1, LIST_GROUPS = -2 };

typedef struct list_entry {
  double lower; /* a bound on the pair's distance over the node, known so far */
  int32_t pair;
  int32_t part;     /* or one group */
  uint32_t under;   /* or the other one */
  bool needs_split; /* on this node the part moves too far to be measured, */
  bool bounded;     /* and planes have said what they can */
} list_entry;

enum { LIST_CLASSES = 28 };

typedef struct robot_lists {
  cprox_workspace *workspace;
  list_entry *memory;
  size_t used;
  int32_t free[LIST_CLASSES]; /* the first free block of each size, or -1 */
} robot_lists;

void lists_begin(robot_lists *l, cprox_workspace *workspace);

/* A block with room for n entries, used once; -1 where memory is out. It may move all blocks in memory. */
int32_t lists_take(robot_lists *l, size_t n);
/* To one of two blocks, which have so many by now and room for more. */
void lists_add(const robot_lists *l, const int32_t block[2], size_t n[2], bool second, list_entry entry);
list_entry *lists_at(const robot_lists *l, int32_t block);
size_t lists_count(const robot_lists *l, int32_t block);
void lists_set_count(robot_lists *l, int32_t block, size_t n);

/* One more user, or one less. */
void lists_share(robot_lists *l, int32_t block);
void lists_release(robot_lists *l, int32_t block);

#endif
