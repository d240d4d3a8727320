/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/pair_lists.h"

/* What stands in front of a block, in the place of an entry. */
typedef struct block_head {
  uint32_t users, count;
  int32_t next; /* of a free block */
  uint32_t size_class;
} block_head;

_Static_assert(sizeof(block_head) <= sizeof(list_entry), "a head takes the place of one entry");

static block_head *head_of(const robot_lists *l, int32_t block) {
  return (block_head *)(void *)(l->memory + block);
}

void lists_begin(robot_lists *l, cprox_workspace *workspace) {
  *l = (robot_lists){.workspace = workspace};
  for (int i = 0; i < LIST_CLASSES; i++) l->free[i] = -1;
}

int32_t lists_take(robot_lists *l, size_t n) {
  uint32_t size_class = 2;
  while (((size_t)1 << size_class) < n) size_class++;
  if (size_class >= LIST_CLASSES) return -1;
  int32_t block = l->free[size_class];
  if (block >= 0) {
    l->free[size_class] = head_of(l, block)->next;
  } else {
    const size_t end = l->used + 1 + ((size_t)1 << size_class);
    if (end > INT32_MAX) return -1;
    list_entry *memory = workspace_reserve(l->workspace, WORKSPACE_ROBOT_LISTS, end * sizeof *memory);
    if (!memory) return -1;
    l->memory = memory;
    block = (int32_t)l->used;
    l->used = end;
  }
  *head_of(l, block) = (block_head){.users = 1, .next = -1, .size_class = size_class};
  return block;
}

list_entry *lists_at(const robot_lists *l, int32_t block) {
  return l->memory + block + 1;
}

void lists_add(const robot_lists *l, const int32_t block[2], size_t n[2], bool second, list_entry entry) {
  lists_at(l, block[second])[n[second]++] = entry;
}

size_t lists_count(const robot_lists *l, int32_t block) {
  return head_of(l, block)->count;
}

void lists_set_count(robot_lists *l, int32_t block, size_t n) {
  head_of(l, block)->count = (uint32_t)n;
}

void lists_share(robot_lists *l, int32_t block) {
  head_of(l, block)->users++;
}

void lists_release(robot_lists *l, int32_t block) {
  block_head *head = head_of(l, block);
  if (--head->users > 0) return;
  head->next = l->free[head->size_class];
  l->free[head->size_class] = block;
}
