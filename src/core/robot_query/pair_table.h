/* SPDX-License-Identifier: BSD-3-Clause */
/* Which pairs and obstacles were made of what a query's trees hold: each is made when it is first met. */
#ifndef CPROX_ROBOT_QUERY_PAIR_TABLE_H
#define CPROX_ROBOT_QUERY_PAIR_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/workspace.h"

/* An open table, at most half full; zeroed it is empty. */
typedef struct pair_table {
  struct pair_slot *slots;
  size_t room, count;
} pair_table;

typedef enum pair_made { MADE_OBSTACLES, MADE_PAIRS, MADE_SELF_PAIRS } pair_made;

/* The number of the first of what was made of a part and an obstacle (of obstacles the part is 0) or of two parts; -1:
 * nothing was. */
int32_t pair_table_find(const pair_table *table, pair_made made, int32_t part, uint32_t other);

/* Notes it. False where memory is out. */
bool pair_table_note(pair_table *table, cprox_workspace *workspace, pair_made made, int32_t part, uint32_t other,
                     int32_t first);

#endif
