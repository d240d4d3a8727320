/* SPDX-License-Identifier: BSD-3-Clause */
/* The robot itself; its motion is read by trajectory.c. */
#include "robot.h"

#include <stdlib.h>
#include <string.h>

#include "span.h"
#include "trajectory.h"
#include "words.h"

static const place HERE = {.r = {.m = {1, 0, 0, 0, 1, 0, 0, 0, 1}}};

static place place_of(const pose *p) {
  const num q[4] = {num_of(p->q[0]), num_of(p->q[1]), num_of(p->q[2]), num_of(p->q[3])};
  return (place){rot_of_quaternion(q), vec_of(p->x)};
}

static bool turns_nothing(const double q[4]) {
  return q[0] == 0.0 && q[1] == 0.0 && q[2] == 0.0 && q[3] == 0.0;
}

/* ---- links ---- */

static void add_axis(robot *r, hook *at, axis_kind moves, const double z[3], size_t variable, double multiplier,
                     double offset) {
  axis *a = &r->axes[r->n_axes];
  *a = (axis){.kind = moves, .parent = at->axis, .at = at->at, .variable = variable};
  a->multiplier = multiplier, a->offset = offset;
  num square = num_of(0.0);
  for (int k = 0; k < 3; k++) square = num_add(square, num_mul(num_of(z[k]), num_of(z[k])));
  const num length = num_sqrt(square);
  for (int k = 0; k < 3; k++) a->z[k] = num_div(num_of(z[k]), length);
  *at = (hook){.axis = (int)r->n_axes++, .at = HERE};
}

/* PARENT TYPE x y z qw qx qy qz ax ay az VARIABLE MULTIPLIER OFFSET */
static void read_link(words *w, robot *r) {
  static const char *const names[] = {"fixed", "revolute", "prismatic", "planar", "floating"};
  static const size_t variables[] = {0, 1, 1, 3, 7};
  static const double along[4][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 1}};
  const double parent = words_number(w);
  const size_t type = words_choose(w, names, 5);
  pose origin;
  double z[3], factor[2];
  words_numbers(w, 3, origin.x);
  words_numbers(w, 4, origin.q);
  words_numbers(w, 3, z);
  const size_t v = words_size(w);
  words_numbers(w, 2, factor);
  const bool known = parent == -1.0 || (parent >= 0.0 && parent < (double)r->n_links && parent == floor(parent));
  if (w->wrong || !known || v + variables[type] > r->n_variables || turns_nothing(origin.q)) w->wrong = true;
  if (w->wrong) return;

  const hook world = {.axis = -1, .at = HERE}, *above = parent < 0.0 ? &world : &r->links[(size_t)parent];
  const place step = place_of(&origin);
  hook at = {above->axis, place_product(&above->at, &step)};
  if (type == 1 || type == 2) add_axis(r, &at, type == 1 ? AXIS_TURN : AXIS_SHIFT, z, v, factor[0], factor[1]);
  for (size_t k = 0; type >= 3 && k < (type == 3 ? 2u : 3u); k++)
    add_axis(r, &at, AXIS_SHIFT, along[k], v + k, 1.0, 0.0);
  if (type == 3) add_axis(r, &at, AXIS_TURN, along[2], v + 2, 1.0, 0.0);
  if (type == 4) add_axis(r, &at, AXIS_QUATERNION, along[3], v + 3, 1.0, 0.0);
  r->links[r->n_links++] = at;
}

/* ---- bodies ---- */

static void add_body(robot *r, const set *s, const hook *on) {
  body *b = &r->bodies[r->n_bodies++];
  *b = (body){.shape = s, .axis = on->axis, .at = on->at};
  for (size_t i = 0; i < s->n_poses; i++) {
    const place inner = place_of(&s->poses[i]);
    b->at = place_product(&b->at, &inner);
  }
  const vec centre = vec_of(s->centre);
  b->at.p = place_apply(&b->at, &centre);
  b->radius = span_radius(s);
  span_box(s, b->middle, b->half);
}

/* LINK PADDING P POSE×P KIND SIZES */
static void read_part(words *w, robot *r) {
  const size_t on = words_size(w);
  set *s = &r->parts[r->n_parts++];
  words_set(w, s);
  if (on >= r->n_links || s->kind == HALFSPACE || s->kind >= IMPLICIT) w->wrong = true;
  if (!w->wrong) add_body(r, s, &r->links[on]);
}

/* ---- the whole ---- */

/* "WORD N" and N lines of it. */
static bool read_lines(problem *p, words *w, robot *r, const char *word, size_t n, void (*read)(words *, robot *)) {
  for (size_t i = 0; i < n; i++) {
    if (words_begin(p, w, word)) read(w, r);
    if (!words_end(p, w)) return false;
  }
  return true;
}

/* pairs N, then part and other N times: another part, or after all parts an obstacle. */
static bool read_pairs(problem *p, words *w, robot *r) {
  words_begin(p, w, "pairs");
  r->n_pairs = words_count(w);
  r->pairs = words_room(w, r->n_pairs, sizeof *r->pairs);
  for (size_t i = 0; i < r->n_pairs && !w->wrong; i++) {
    pair *one = &r->pairs[i];
    one->moving = words_size(w);
    one->standing = words_size(w);
    if (one->moving >= r->n_parts || one->standing >= r->n_bodies || one->moving == one->standing) w->wrong = true;
  }
  return words_end(p, w);
}

/* "robot ID" LINKS PARTS VARIABLES, then those links and parts, the pairs, the values of all variables that stand
 * still, and the motion. */
static bool read_all(problem *p, words *w, robot *r) {
  const size_t links = words_size(w), parts = words_size(w);
  r->n_variables = words_size(w);
  if (!words_end(p, w)) return false;
  r->links = words_room(w, links, sizeof *r->links);
  r->axes = words_room(w, 4 * links, sizeof *r->axes);
  r->parts = words_room(w, parts, sizeof *r->parts);
  r->bodies = words_room(w, parts + p->n_sets, sizeof *r->bodies);
  if (w->wrong || !read_lines(p, w, r, "link", links, read_link) || !read_lines(p, w, r, "part", parts, read_part))
    return false;
  const hook world = {.axis = -1, .at = HERE};
  for (size_t i = 0; i < p->n_sets; i++) {
    const set *s = &p->sets[i];
    if (curve_is_there(&s->ride) || curve_is_there(&s->growth))
      w->wrong = true; /* robots are held against what stands */
    add_body(r, s, &world);
  }
  if (w->wrong) return words_end(p, w);
  if (!read_pairs(p, w, r)) return false;
  r->rest = words_room(w, r->n_variables, sizeof *r->rest);
  r->moved = words_room(w, r->n_variables, sizeof *r->moved);
  if (words_begin(p, w, "rest")) words_numbers(w, r->n_variables, r->rest);
  return words_end(p, w) && trajectory_read(p, w, r);
}

robot *robot_read(problem *p, words *w) {
  robot *r = words_room(w, 1, sizeof *r);
  if (r && read_all(p, w, r)) return r;
  if (!p->fault[0]) snprintf(p->fault, sizeof p->fault, "memory is out");
  robot_forget(r);
  return NULL;
}

void robot_forget(robot *r) {
  if (!r) return;
  for (size_t i = 0; r->parts && i < r->n_parts; i++) set_free(&r->parts[i]);
  free(r->links);
  free(r->axes);
  free(r->parts);
  free(r->bodies);
  for (size_t i = 0; r->pairs && i < r->n_pairs; i++) free(r->pairs[i].items);
  free(r->pairs);
  free(r->rest);
  free(r->moved);
  free(r->times);
  free(r->degrees);
  free(r->points);
  free(r->arcs);
  free(r);
}
