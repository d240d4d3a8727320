/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/workspace.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* What stands before a buffer's memory. */
typedef struct buffer_head {
  _Alignas(max_align_t) size_t bytes;
} buffer_head;

struct cprox_workspace {
  buffer_head *buffer[WORKSPACE_BUFFERS];
  char reason[256];
  bool (*stop)(void *user); /* NULL: never */
  void *stop_user;
  bool stopped;
  uint64_t work;
  uint32_t users;   /* public functions that have begun and not returned; */
  uint32_t lent;    /* all but the last of these have lent the workspace to the next one */
  bool was_refused; /* the last function that wanted the workspace did not get it */
};

cprox_workspace *cprox_workspace_create(void) {
  return calloc(1, sizeof(cprox_workspace));
}

void cprox_workspace_free(cprox_workspace *workspace) {
  if (!workspace) return;
  for (int i = 0; i < WORKSPACE_BUFFERS; i++) free(workspace->buffer[i]);
  free(workspace);
}

size_t cprox_workspace_bytes(const cprox_workspace *workspace) {
  if (!workspace) return 0;
  size_t sum = sizeof *workspace;
  for (int i = 0; i < WORKSPACE_BUFFERS; i++)
    if (workspace->buffer[i]) sum += sizeof(buffer_head) + workspace->buffer[i]->bytes;
  return sum;
}

const char *cprox_workspace_error(const cprox_workspace *workspace) {
  if (workspace && workspace->was_refused)
    return "the workspace is in use: a function that a query calls needs a workspace of its own to ask anything";
  return workspace ? workspace->reason : "";
}

/* ---- one user at a time ---- */

bool cprox_workspace_enter(cprox_workspace *workspace) {
  if (!workspace) return true;
  workspace->was_refused = workspace->users > workspace->lent;
  if (!workspace->was_refused) workspace->users++;
  return !workspace->was_refused;
}

void cprox_workspace_leave(cprox_workspace *const *workspace) {
  if (!*workspace) return;
  (*workspace)->users--;
  (*workspace)->was_refused = false;
}

void cprox_workspace_lend(cprox_workspace *workspace) {
  if (workspace) workspace->lent++;
}

cprox_status cprox_workspace_take_back(cprox_workspace *workspace, cprox_status status) {
  if (workspace) workspace->lent--;
  return status;
}

/* ---- memory ---- */

void *workspace_reserve(cprox_workspace *workspace, workspace_buffer buffer, size_t bytes) {
  enum { SMALL = 8192 }; /* a curve's query has few open nodes: no room for more is made before it is asked for */
  buffer_head *head = workspace->buffer[buffer];
  const size_t before = head ? head->bytes : 0;
  if (bytes > before) {
    size_t grown = before + (bytes > SMALL ? before / 2 : 0);
    if (grown < bytes) grown = bytes;
    head = grown < SIZE_MAX - sizeof *head ? realloc(head, sizeof *head + grown) : NULL;
    if (!head) return NULL;
    head->bytes = grown;
    workspace->buffer[buffer] = head;
  }
  return head ? head + 1 : NULL;
}

void *workspace_filled(const cprox_workspace *workspace, workspace_buffer buffer) {
  return workspace->buffer[buffer] ? workspace->buffer[buffer] + 1 : NULL;
}

void *cprox_workspace_reserve(cprox_workspace *workspace, size_t bytes) {
  return workspace_reserve(workspace, WORKSPACE_CALLER, bytes);
}

void cprox_workspace_set_error(cprox_workspace *workspace, const char *message) {
  workspace_fail(workspace, CPROX_OK, "%s", message ? message : "");
}

cprox_status workspace_fail(cprox_workspace *workspace, cprox_status status, const char *format, ...) {
  if (!workspace) return status;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(workspace->reason, sizeof workspace->reason, format, arguments);
  va_end(arguments);
  return status;
}

void cprox_workspace_set_stop(cprox_workspace *workspace, bool (*stop)(void *user), void *user) {
  if (!workspace) return;
  workspace->stop = stop;
  workspace->stop_user = user;
  workspace->stopped = false;
}

bool workspace_stops(cprox_workspace *workspace) {
  if (!workspace || !workspace->stop) return false;
  workspace->stopped = workspace->stopped || workspace->stop(workspace->stop_user);
  return workspace->stopped;
}

bool cprox_workspace_wants_stop(cprox_workspace *workspace) {
  return workspace_stops(workspace);
}

bool workspace_has_stopped(const cprox_workspace *workspace) {
  return workspace && workspace->stopped;
}

void workspace_add_work(cprox_workspace *workspace, uint64_t work) {
  workspace->work += work;
}

uint64_t workspace_work(const cprox_workspace *workspace) {
  return workspace->work;
}

void workspace_forget_work(cprox_workspace *workspace) {
  workspace->work = 0;
}

void workspace_clear(cprox_workspace *workspace) {
  if (!workspace) return;
  workspace->work = 0;
  workspace->reason[0] = '\0';
  workspace->stopped = false;
}
