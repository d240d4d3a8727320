/* SPDX-License-Identifier: BSD-3-Clause */
/* Words of a query as the checker reads it; doc/certificates.md has the grammar. */
#ifndef CPROX_CERTIFICATE_DESCRIBE_H
#define CPROX_CERTIFICATE_DESCRIBE_H

#include <stdbool.h>

#include "shape/body.h"

/* Text that grows beyond its room: then only its length is counted. */
typedef struct text {
  char *at;
  size_t size, length;
} text;

void describe_text(text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
void describe_vector(text *t, vec3 v);
void describe_pose(text *t, const cprox_pose *pose);

/* A convex body; of a link that is a mesh with a hull the hull. */
void describe_body(text *t, const cprox_body *body);

/* The part of a link's body, or the body itself, that certificates do not know; NULL: they know all of it. The same of
 * an obstacle's. */
const cprox_body *describe_unknown_kind(const cprox_body *body);
const cprox_body *describe_unknown_obstacle(const cprox_body *body);

/* Whether a part of a link's body is a mesh, of which its hull stands in the text. */
bool describe_has_mesh(const cprox_body *body);

#endif
