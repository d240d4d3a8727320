/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/pair_table.h"

#include <string.h>

struct pair_slot {
  int32_t part, first; /* first < 0: nothing is here */
  uint32_t other;
  pair_made made;
};

enum { FIRST_ROOM = 64 };

static struct pair_slot *slot_of(struct pair_slot *slots, size_t room, pair_made made, int32_t part, uint32_t other) {
  const uint64_t key = (((uint64_t)(uint32_t)part << 32 | other) + made) * 0x9e3779b97f4a7c15u;
  size_t i = (size_t)(key >> 32) & (room - 1);
  while (slots[i].first >= 0 && (slots[i].part != part || slots[i].other != other || slots[i].made != made))
    i = (i + 1) & (room - 1);
  return &slots[i];
}

/* Room for one more; the larger table is made behind the old one, then takes its place. */
static bool make_room(pair_table *t, cprox_workspace *workspace) {
  const size_t old = t->room, room = old ? 2 * old : FIRST_ROOM;
  if (old && 2 * t->count < old) return true;
  struct pair_slot *slots = workspace_reserve(workspace, WORKSPACE_ROBOT_CLUSTER, (old + room) * sizeof *slots);
  if (!slots) return false;
  for (size_t i = 0; i < room; i++) slots[old + i].first = -1;
  for (size_t i = 0; i < old; i++)
    if (slots[i].first >= 0) *slot_of(slots + old, room, slots[i].made, slots[i].part, slots[i].other) = slots[i];
  memmove(slots, slots + old, room * sizeof *slots);
  t->slots = slots;
  t->room = room;
  return true;
}

int32_t pair_table_find(const pair_table *t, pair_made made, int32_t part, uint32_t other) {
  return t->room ? slot_of(t->slots, t->room, made, part, other)->first : -1;
}

bool pair_table_note(pair_table *t, cprox_workspace *workspace, pair_made made, int32_t part, uint32_t other,
                     int32_t first) {
  if (!make_room(t, workspace)) return false;
  *slot_of(t->slots, t->room, made, part, other) =
      (struct pair_slot){.part = part, .first = first, .other = other, .made = made};
  t->count++;
  return true;
}
