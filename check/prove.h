/* SPDX-License-Identifier: BSD-3-Clause */
/* One certificate and the problem that it is about, both in memory: for programs that link the checker. Any number of
 * threads at once. */
#ifndef CHECK_PROVE_H
#define CHECK_PROVE_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct proof {
  bool apart, near;  /* what is proven: everywhere farther than delta, or somewhere not farther; neither: nothing */
  double delta;      /* [m] of the claim */
  size_t directions; /* separating directions that were tried */
  char fault[300];   /* why nothing is proven; empty where something is */
} proof;

/* text: a problem with one mover. certificate: without its length before it. */
proof prove(const char *text, size_t length, const unsigned char *certificate, size_t size);

#ifdef __cplusplus
}
#endif
#endif
