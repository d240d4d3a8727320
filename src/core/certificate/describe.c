/* SPDX-License-Identifier: BSD-3-Clause */
/* Targets as text, a line a convex part: what the checker takes as given. doc/certificates.md has the grammar. */
#include "certificate/describe.h"

#include <stdarg.h>
#include <stdio.h>

#include "curve_proximity/cprox/certificate.h"
#include "shape/kinds.h"

void say(text *t, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const size_t left = t->length < t->size ? t->size - t->length : 0;
  const int n = vsnprintf(left > 0 ? t->at + t->length : NULL, left, format, arguments);
  va_end(arguments);
  if (n > 0) t->length += (size_t)n;
}

void describe_vector(text *t, vec3 v) {
  say(t, " %a %a %a", v.x, v.y, v.z);
}

void describe_pose(text *t, const cprox_pose *pose) {
  const cprox_quat q = pose->orientation;
  describe_vector(t, pose->position);
  say(t, " %a %a %a %a", q.w, q.x, q.y, q.z);
}

static void describe_vertices(text *t, const cprox_body *body) {
  describe_vector(t, body->centre);
  say(t, " %d", (int)body->shape.n);
  for (int32_t i = 0; i < body->shape.n; i++)
    describe_vector(t, vec(body->shape.x[i], body->shape.y[i], body->shape.z[i]));
}

static bool is_known(const cprox_body *body) {
  if (!body->mesh) return body_kind_of(body->kind)->has_certificate;
  return body->hull->kind == CPROX_BODY_POLYTOPE || body->hull->kind == CPROX_BODY_POLYGON;
}

const cprox_body *describe_unknown_kind(const cprox_body *body) {
  if (body->kind != CPROX_BODY_COMPOUND) return is_known(body) ? NULL : body;
  for (size_t i = 0; i < body->n_parts; i++)
    if (!is_known(body->parts[i].body)) return body->parts[i].body;
  return NULL;
}

bool describe_has_mesh(const cprox_body *body) {
  bool found = body->mesh != NULL;
  for (size_t i = 0; i < body->n_parts; i++) found = found || body->parts[i].body->mesh;
  return found;
}

void describe_body(text *t, const cprox_body *body) {
  const double *size = body->shape.size;
  if (body->mesh) {
    say(t, " hull %a", body->excess);
    describe_vertices(t, body->hull);
    return;
  }
  if (body->shape.n > 0) { /* a polygon, too, is the hull of its vertices */
    say(t, " polytope");
    describe_vertices(t, body);
    return;
  }
  const body_kind *kind = body_kind_of(body->kind);
  say(t, " %s", kind->name);
  if (body->kind == CPROX_BODY_POINT) describe_vector(t, body->centre);
  for (int i = 0; i < kind->n_sizes; i++) say(t, " %a", size[kind->sizes[i]]);
}

static void describe_one(text *t, const cprox_obstacle *target, const cprox_body *body, const cprox_pose *inner) {
  say(t, "target %a %d", target->margin, inner ? 2 : 1);
  describe_pose(t, &target->pose);
  if (inner) describe_pose(t, inner);
  describe_body(t, body);
  say(t, "\n");
}

size_t cprox_obstacle_describe(const cprox_obstacle *target, char *out, size_t size) {
  const cprox_body *body = target->body;
  if (!body || target->synchronized || describe_unknown_kind(body)) return 0;
  text t = {.at = out, .size = out ? size : 0};
  if (body->kind != CPROX_BODY_COMPOUND) {
    describe_one(&t, target, body, NULL);
    return t.length;
  }
  for (size_t i = 0; i < body->n_parts; i++) {
    const body_part *part = &body->parts[i];
    describe_one(&t, target, part->body, &part->pose);
  }
  return t.length;
}
