/* SPDX-License-Identifier: BSD-3-Clause */
/* SceneObstacles as text, a line a convex part: what the checker takes as given. doc/certificates.md has the
 * grammar. */
#include "certificate/describe.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "certificate/element_order.h"
#include "curve_proximity/cprox/certificate.h"
#include "implicit/implicit.h"
#include "problem/carried_shape.h"
#include "shape/kinds.h"

void describe_text(text *t, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const size_t left = t->length < t->size ? t->size - t->length : 0;
  const int n = vsnprintf(left > 0 ? t->at + t->length : NULL, left, format, arguments);
  va_end(arguments);
  if (n > 0) t->length += (size_t)n;
}

void describe_vector(text *t, vec3 v) {
  describe_text(t, " %a %a %a", v.x, v.y, v.z);
}

void describe_pose(text *t, const cprox_pose *pose) {
  const cprox_quat q = pose->orientation;
  describe_vector(t, pose->position);
  describe_text(t, " %a %a %a %a", q.w, q.x, q.y, q.z);
}

static void describe_vertices(text *t, const cprox_body *body) {
  describe_vector(t, body->centre);
  describe_text(t, " %d", (int)body->shape.n);
  for (int32_t i = 0; i < body->shape.n; i++)
    describe_vector(t, vec(body->shape.x[i], body->shape.y[i], body->shape.z[i]));
}

static bool is_known(const cprox_body *body) {
  if (!body->mesh) return body_kind_of(body->kind)->has_certificate;
  return body->hull->kind == CPROX_BODY_POLYTOPE || body->hull->kind == CPROX_BODY_POLYGON;
}

static bool is_known_obstacle(const cprox_body *body) {
  return elements_body(body) || body->shape.implicit || is_known(body);
}

static const cprox_body *unknown_part(const cprox_body *body, bool (*known)(const cprox_body *body)) {
  for (size_t i = 0; i < body_n_parts(body); i++)
    if (!known(body_part_at(body, i))) return body_part_at(body, i);
  return NULL;
}

const cprox_body *describe_unknown_kind(const cprox_body *body) {
  return unknown_part(body, is_known);
}

const cprox_body *describe_unknown_obstacle(const cprox_body *body) {
  return unknown_part(body, is_known_obstacle);
}

bool describe_has_mesh(const cprox_body *body) {
  bool found = body->mesh != NULL;
  for (size_t i = 0; i < body->n_parts; i++) found = found || body->parts[i].body->mesh;
  return found;
}

void describe_body(text *t, const cprox_body *body) {
  const double *size = body->shape.size;
  if (body->mesh) {
    describe_text(t, " hull %a", body->excess);
    describe_vertices(t, body->hull);
    return;
  }
  if (body->shape.n > 0) { /* a polygon, too, is the hull of its vertices */
    describe_text(t, " polytope");
    describe_vertices(t, body);
    return;
  }
  const body_kind *kind = body_kind_of(body->kind);
  describe_text(t, " %s", kind->name);
  if (body->kind == CPROX_BODY_POINT) describe_vector(t, body->centre);
  for (int i = 0; i < kind->n_sizes; i++) describe_text(t, " %a", size[kind->sizes[i]]);
}

/* ---- elements ---- */

typedef struct listed {
  text *t;
  const tree *elements;
} listed;

static void describe_element(void *self, tree_place at) {
  const listed *l = self;
  vec3 corner[3];
  const int n = tree_corners(l->elements, at, corner);
  for (int k = 0; k < n; k++) describe_vector(l->t, corner[k]);
}

/* In the order that certificates count them in; false where memory is out. */
static bool describe_elements(text *t, const cprox_body *body) {
  const tree *elements = body->tree;
  uint32_t *first = malloc(elements->n_packs * sizeof *first);
  if (!first) return false;
  const element_order order = elements_order(elements, first);
  const element_range all = elements_all(&order);
  if (elements->kind == TREE_POINTS)
    describe_text(t, " points %a", body->shape.margin);
  else
    describe_text(t, elements->kind == TREE_BOXES ? " cells" : body->winding ? " solid" : " triangles");
  describe_vector(t, body->centre);
  describe_text(t, " %zu", elements->n);
  listed l = {t, elements};
  elements_each(&order, &all, describe_element, &l);
  free(first);
  return true;
}

/* ---- inequalities ---- */

static void describe_inequalities(text *t, const cprox_body *body) {
  const implicit *shape = body->shape.implicit;
  describe_text(t, " implicit");
  describe_vector(t, body->centre);
  describe_text(t, " %d", (int)shape->n_planes);
  for (int32_t i = 0; i < shape->n_planes; i++) {
    describe_vector(t, shape->plane[i].b);
    describe_text(t, " %a", shape->plane[i].c);
  }
  describe_text(t, " %d", (int)shape->n_quadrics);
  for (int32_t i = 0; i < shape->n_quadrics; i++) {
    for (int k = 0; k < 6; k++) describe_text(t, " %a", shape->quadric[i].q[k]);
    describe_vector(t, shape->quadric[i].b);
    describe_text(t, " %a", shape->quadric[i].c);
  }
  describe_text(t, " %d %d", (int)shape->n_powers, (int)shape->n_terms);
  for (int32_t k = 0; k < shape->n_powers; k++)
    for (int32_t i = shape->power[k].first; i < shape->power[k].first + shape->power[k].n; i++) {
      describe_text(t, " %d", (int)k);
      describe_vector(t, shape->term[i].a);
      describe_text(t, " %a %a", shape->term[i].d, shape->term[i].p);
    }
}

/* ---- obstacles ---- */

static bool describe_one(text *t, const cprox_obstacle *obstacle, const cprox_body *body, const cprox_pose *inner) {
  describe_text(t, "target %a %d", obstacle->margin, inner ? 2 : 1);
  describe_pose(t, &obstacle->pose);
  if (inner) describe_pose(t, inner);
  const cprox_body *elements = elements_body(body);
  if (elements && !describe_elements(t, elements)) return false;
  if (body->shape.implicit)
    describe_inequalities(t, body);
  else if (!elements)
    describe_body(t, body);
  describe_text(t, "\n");
  return true;
}

size_t cprox_obstacle_describe(const cprox_obstacle *obstacle, char *out, size_t size) {
  const cprox_body *body = obstacle->synchronized && !obstacle->body ? &carried_point : obstacle->body;
  if (!body || describe_unknown_obstacle(body)) return 0;
  text t = {.at = out, .size = out ? size : 0};
  const bool compound = body->kind == CPROX_BODY_COMPOUND;
  for (size_t i = 0; i < body_n_parts(body); i++)
    if (!describe_one(&t, obstacle, body_part_at(body, i), compound ? &body->parts[i].pose : NULL)) return 0;
  return t.length;
}
