/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/edge_worlds.h"

#include <math.h>

#include "convex/convex.h"
#include "shape/body.h"
#include "support/builders.h"
#include "support/cases.h"

/* ---- robots of balls ---- */

static ref_pose pose_of(const cprox_pose *pose) {
  const cprox_quat q = pose->orientation;
  ref_pose out = {.p = ref_vec(pose->position), .q = {q.x, q.y, q.z, q.w}};
  long double norm = 0.0L;
  for (int k = 0; k < 4; k++) norm += out.q[k] * out.q[k];
  for (int k = 0; k < 4; k++) out.q[k] /= sqrtl(norm);
  return out;
}

void edge_robot_make(rng *r, double scale, bool capsules, edge_robot *b) {
  robot_make(r, 0.5, &b->t);
  test_robot *t = &b->t;
  b->n = 0;
  for (size_t i = 0; i < t->n_links; i++) {
    cprox_link *l = &t->links[i];
    if (l->type == CPROX_JOINT_FLOATING) l->type = CPROX_JOINT_FIXED;
    l->origin.position = vec_scale(scale, l->origin.position);
    if (rng_index(r, 3) == 0) l->axis = vec(0, 0, rng_index(r, 2) ? 1 : -1);
    if (rng_index(r, 3) == 0) l->origin.orientation = (cprox_quat){.w = 1, .x = rng_index(r, 2) ? 1 : 0};
    for (size_t k = 1 + rng_index(r, 3); k-- > 0; b->n++) {
      cprox_body *body = NULL;
      b->radius[b->n] = scale * rng_uniform(r, 0.02, 0.1);
      b->half[b->n] = capsules && rng_index(r, 2) ? scale * rng_uniform(r, 0.01, 0.15) : 0.0;
      if (b->half[b->n] > 0.0)
        assert_int_equal(cprox_body_create_capsule(2.0 * b->half[b->n], b->radius[b->n], ws, &body), CPROX_OK);
      else
        assert_int_equal(cprox_body_create_sphere(b->radius[b->n], ws, &body), CPROX_OK);
      b->geometries[b->n] = (cprox_link_geometry){.body = body, .pose = rng_pose(r, 0.2 * scale), .link = (int32_t)i};
    }
  }
  assert_int_equal(cprox_robot_create(t->links, t->n_links, b->geometries, b->n, t->n_variables, ws, &b->robot),
                   CPROX_OK);
}

void edge_robot_free(edge_robot *b) {
  cprox_robot_free(b->robot);
  for (size_t i = 0; i < b->n; i++) cprox_body_free((cprox_body *)b->geometries[i].body);
  robot_free(&b->t);
}

static bool shifts(const edge_robot *b, size_t variable) {
  for (size_t i = 0; i < b->t.n_links; i++) {
    const cprox_link *l = &b->t.links[i];
    const size_t first = (size_t)l->variable;
    if (l->type == CPROX_JOINT_PRISMATIC && first == variable) return true;
    if (l->type == CPROX_JOINT_PLANAR && variable >= first && variable < first + 2) return true;
  }
  return false;
}

void edge_robot_draw(rng *r, const edge_robot *b, double scale, double *from, double *to) {
  const double turn = rng_log_uniform(r, 1e-3, 3.0);
  for (size_t k = 0; k < b->t.n_variables; k++) {
    const double size = shifts(b, k) ? scale : 1.0;
    from[k] = size * rng_uniform(r, -2.0, 2.0);
    to[k] = from[k] + size * rng_uniform(r, -turn, turn);
    if (rng_index(r, 5) == 0) to[k] = from[k];
  }
}

void edge_robot_links(const edge_robot *b, const double *from, const double *to, long double t, ref_pose *links) {
  long double values[TEST_MAX_VARIABLES + 1] = {0};
  for (size_t k = 0; k < b->t.n_variables; k++)
    values[k] = (long double)from[k] + t * ((long double)to[k] - (long double)from[k]);
  robot_ref_links(&b->t, values, links);
}

vec3l edge_robot_centre(const edge_robot *b, const ref_pose *links, size_t i, double along) {
  const ref_pose at = pose_of(&b->geometries[i].pose);
  const vec3l own = {0, 0, (long double)(along * b->half[i])};
  return ref_pose_apply(&links[b->geometries[i].link], ref_pose_apply(&at, own));
}

/* ---- obstacles ---- */

cprox_body *edge_world_body(rng *r, double s, size_t kind) {
  cprox_body *body = NULL;
  vec3 v[8];
  switch (kind) {
    case 0: cprox_body_create_sphere(s * rng_uniform(r, 0.05, 0.3), ws, &body); break;
    case 1:
      cprox_body_create_box(
          vec(s * rng_uniform(r, 0.01, 0.5), s * rng_uniform(r, 0.01, 0.5), s * rng_uniform(r, 0.01, 0.5)), ws, &body);
      break;
    case 2: cprox_body_create_capsule(s * rng_uniform(r, 0.1, 0.6), s * rng_uniform(r, 0.005, 0.1), ws, &body); break;
    case 3: cprox_body_create_cylinder(s * rng_uniform(r, 0.005, 0.6), s * rng_uniform(r, 0.01, 0.2), ws, &body); break;
    case 4: cprox_body_create_cone(s * rng_uniform(r, 0.05, 0.6), s * rng_uniform(r, 0.02, 0.2), ws, &body); break;
    case 5: cprox_body_create_halfspace(rng_unit(r), s * rng_uniform(r, -1.5, -0.7), ws, &body); break;
    case 6:
      cprox_body_create_ellipsoid(
          vec(s * rng_uniform(r, 0.05, 0.3), s * rng_uniform(r, 0.05, 0.3), s * rng_uniform(r, 0.05, 0.3)), ws, &body);
      break;
    default:
      for (int k = 0; k < 8; k++) v[k] = rng_in_cube(r, 0.2 * s);
      cprox_body_create_polytope(v, 8, ws, &body);
  }
  assert_non_null(body);
  return body;
}

static cprox_body *thin_body(rng *r, double s) {
  const double thick = s * rng_log_uniform(r, 5e-5, 1e-3), length = s * rng_uniform(r, 0.1, 1.0);
  cprox_body *body = NULL;
  switch (rng_index(r, 4)) {
    case 0: cprox_body_create_capsule(length, thick, ws, &body); break;
    case 1: cprox_body_create_cylinder(length, thick, ws, &body); break;
    case 2: cprox_body_create_box(vec(length, s * rng_uniform(r, 0.1, 1.0), thick), ws, &body); break;
    default: cprox_body_create_box(vec(length, thick, thick), ws, &body);
  }
  assert_non_null(body);
  return body;
}

void edge_world_make(rng *r, double scale, bool capsules, bool thin, edge_world *w) {
  edge_robot_make(r, scale, capsules, &w->b);
  w->n = 1 + rng_index(r, EDGE_WORLD_OBSTACLES);
  for (size_t i = 0; i < w->n; i++) {
    cprox_body *body = thin ? thin_body(r, scale) : edge_world_body(r, scale, rng_index(r, EDGE_WORLD_KINDS));
    w->targets[i] = cprox_obstacle_at(body, rng_pose(r, 1.2 * scale));
    if (!thin && rng_index(r, 4) == 0) w->targets[i].margin = scale * rng_uniform(r, 0, 0.05);
  }
  assert_int_equal(cprox_obstacles_create(w->targets, w->n, CPROX_INDEX_NONE, ws, &w->set), CPROX_OK);
  w->n_pairs = w->n_selves = 0;
  for (size_t g = 0; g < w->b.n; g++) {
    for (size_t k = 0; k < w->n; k++) w->pairs[w->n_pairs++] = (cprox_robot_pair){(int32_t)g, (int32_t)k};
    for (size_t k = 0; k < g; k++) {
      const int32_t a = w->b.geometries[g].link, z = w->b.geometries[k].link;
      const int32_t up = w->b.t.links[a].parent, down = w->b.t.links[z].parent;
      if (a != z && up != z && down != a) w->selves[w->n_selves++] = (cprox_robot_pair){(int32_t)g, (int32_t)k};
    }
  }
}

void edge_world_free(edge_world *w) {
  cprox_obstacles_free(w->set);
  for (size_t i = 0; i < w->n; i++) cprox_body_free((cprox_body *)w->targets[i].body);
  edge_robot_free(&w->b);
}

cprox_edge_query edge_world_asks(const edge_world *w, bool self, double delta) {
  return (cprox_edge_query){.obstacles = w->set,
                            .pairs = w->pairs,
                            .n_pairs = w->n_pairs,
                            .self_pairs = w->selves,
                            .n_self_pairs = w->n_selves,
                            .without_self = !self,
                            .delta = delta};
}

cprox_edge_checker *edge_world_checker(const cprox_robot *robot, const cprox_edge_query *q) {
  cprox_edge_checker *c = NULL;
  if (cprox_edge_checker_create(robot, q, ws, &c) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  return c;
}

/* ---- samples ---- */

/* A frame's origin and axes, in double precision. */
typedef struct spot {
  vec3 p, x, y, z;
} spot;

static vec3 seen_from(const spot *f, vec3 v) {
  return vec_axpy(vec_axpy(vec_scale(v.x, f->x), v.y, f->y), v.z, f->z);
}

static vec3 point_of(const spot *f, vec3 v) {
  return vec_add(f->p, seen_from(f, v));
}

static vec3 turned(vec3 v, vec3 axis, double angle) {
  const vec3 along = vec_scale(vec_dot(axis, v), axis), across = vec_sub(v, along);
  return vec_add(along, vec_axpy(vec_scale(cos(angle), across), sin(angle), vec_cross(axis, v)));
}

static void turn(spot *f, vec3 axis, double angle) {
  f->x = turned(f->x, axis, angle), f->y = turned(f->y, axis, angle), f->z = turned(f->z, axis, angle);
}

static spot spot_of(const cprox_pose *pose) {
  const cprox_quat q = pose->orientation;
  const vec3 v = vec(q.x, q.y, q.z);
  const double size = vec_norm(v);
  spot out = {pose->position, vec(1, 0, 0), vec(0, 1, 0), vec(0, 0, 1)};
  if (size > 0.0) turn(&out, vec_scale(1.0 / size, v), 2.0 * atan2(size, q.w));
  return out;
}

static spot under(const spot *base, const spot *f) {
  return (spot){point_of(base, f->p), seen_from(base, f->x), seen_from(base, f->y), seen_from(base, f->z)};
}

/* Two sides of a pair: the points on a geometry's line, and an obstacle or the other one's line. */
typedef struct sampled_pair {
  size_t geometry, other;
  bool self;
  double speed;          /* the distance changes by no more */
  double seen, distance; /* when it was measured last, and what it was then */
} sampled_pair;

/* An edge that is sampled. */
typedef struct samples {
  const edge_world *w;
  const double *from, *to;
  spot origin[TEST_MAX_LINKS], link[TEST_MAX_LINKS];
  vec3 axis[TEST_MAX_LINKS];
  vec3 end[EDGE_WORLD_BALLS][2]; /* of a geometry's line, in its link */
  frame stands[EDGE_WORLD_OBSTACLES];
  sampled_pair pairs[EDGE_WORLD_PAIRS];
  size_t n_pairs;
  double least, at;
} samples;

enum { ALONG = 9 };

static double value_of(const samples *s, int32_t variable, double t) {
  return s->from[variable] + t * (s->to[variable] - s->from[variable]);
}

static void place_links(samples *s, double t) {
  const test_robot *robot = &s->w->b.t;
  for (size_t i = 0; i < robot->n_links; i++) {
    const cprox_link *l = &robot->links[i];
    spot *f = &s->link[i];
    *f = l->parent < 0 ? s->origin[i] : under(&s->link[l->parent], &s->origin[i]);
    const double value = l->type == CPROX_JOINT_FIXED ? 0.0 : l->multiplier * value_of(s, l->variable, t) + l->offset;
    const vec3 axis = seen_from(f, s->axis[i]);
    if (l->type == CPROX_JOINT_REVOLUTE) turn(f, axis, value);
    if (l->type == CPROX_JOINT_PRISMATIC) f->p = vec_axpy(f->p, value, axis);
    if (l->type != CPROX_JOINT_PLANAR) continue;
    f->p = point_of(f, vec(value_of(s, l->variable, t), value_of(s, l->variable + 1, t), 0.0));
    turn(f, f->z, value_of(s, l->variable + 2, t));
  }
}

/* How fast any point of each geometry's line moves: from the base to the tip, the speed of a frame's origin and the rate
 * at which it turns, with all that shifts as long as it ever is. */
static void bound_speeds(const samples *s, double *speed) {
  const edge_robot *b = &s->w->b;
  double moves[TEST_MAX_LINKS], turns[TEST_MAX_LINKS];
  for (size_t i = 0; i < b->t.n_links; i++) {
    const cprox_link *l = &b->t.links[i];
    const double *from = s->from + l->variable, *to = s->to + l->variable;
    double length = vec_norm(l->origin.position), shift = 0.0, turn_rate = 0.0;
    const double rate = l->type == CPROX_JOINT_FIXED ? 0.0 : fabs(l->multiplier * (to[0] - from[0]));
    if (l->type == CPROX_JOINT_REVOLUTE) turn_rate = rate;
    if (l->type == CPROX_JOINT_PRISMATIC)
      shift = rate, length += fmax(fabs(l->multiplier * from[0] + l->offset), fabs(l->multiplier * to[0] + l->offset));
    if (l->type == CPROX_JOINT_PLANAR) {
      shift = hypot(to[0] - from[0], to[1] - from[1]), turn_rate = fabs(to[2] - from[2]);
      length += fmax(hypot(from[0], from[1]), hypot(to[0], to[1]));
    }
    moves[i] = shift, turns[i] = turn_rate;
    if (l->parent < 0) continue;
    moves[i] += moves[l->parent] + turns[l->parent] * length, turns[i] += turns[l->parent];
  }
  for (size_t g = 0; g < b->n; g++) {
    const int32_t link = b->geometries[g].link;
    const double reach = fmax(vec_norm(s->end[g][0]), vec_norm(s->end[g][1]));
    speed[g] = (moves[link] + turns[link] * reach) * (1.0 + 1e-9);
  }
}

static void begin_samples(const edge_world *w, const double *from, const double *to, bool self, samples *s) {
  const edge_robot *b = &w->b;
  s->w = w, s->from = from, s->to = to, s->n_pairs = 0, s->least = INFINITY, s->at = 0.0;
  for (size_t i = 0; i < b->t.n_links; i++) {
    const cprox_link *l = &b->t.links[i];
    assert_true(l->type != CPROX_JOINT_FLOATING && l->type != CPROX_JOINT_ROTATION_VECTOR);
    s->origin[i] = spot_of(&l->origin);
    s->axis[i] = vec_norm(l->axis) > 0.0 ? vec_scale(1.0 / vec_norm(l->axis), l->axis) : vec(0, 0, 1);
  }
  for (size_t g = 0; g < b->n; g++) {
    const spot own = spot_of(&b->geometries[g].pose);
    for (int k = 0; k < 2; k++) s->end[g][k] = vec_axpy(own.p, k ? b->half[g] : -b->half[g], own.z);
  }
  for (size_t i = 0; i < w->n; i++) s->stands[i] = frame_create(&w->targets[i].pose, w->targets[i].body->centre);
  double speed[EDGE_WORLD_BALLS];
  bound_speeds(s, speed);
  for (size_t i = 0; i < w->n_pairs + (self ? w->n_selves : 0); i++) {
    const bool is_self = i >= w->n_pairs;
    const cprox_robot_pair pair = is_self ? w->selves[i - w->n_pairs] : w->pairs[i];
    s->pairs[s->n_pairs++] = (sampled_pair){.geometry = (size_t)pair.geometry,
                                            .other = (size_t)pair.other,
                                            .self = is_self,
                                            .speed = speed[pair.geometry] + (is_self ? speed[pair.other] : 0.0),
                                            .distance = -INFINITY};
  }
}

static double from_obstacle(const samples *s, size_t i, vec3 p) {
  const cprox_obstacle *o = &s->w->targets[i];
  double error = 0.0;
  convex_near near;
  convex_hint hint = {0};
  o->body->shape.ops->nearest(&o->body->shape, frame_to_local(&s->stands[i], p, &error), &hint, &near);
  return near.distance - o->margin;
}

static double from_line(vec3 a, vec3 b, vec3 p) {
  const vec3 along = vec_sub(b, a), way = vec_sub(p, a);
  const double size2 = vec_dot(along, along);
  const double share = size2 > 0.0 ? fmin(fmax(vec_dot(way, along) / size2, 0.0), 1.0) : 0.0;
  return vec_norm(vec_axpy(way, -share, along));
}

static double measure_pair(const samples *s, const sampled_pair *pair) {
  const edge_robot *b = &s->w->b;
  const spot *own = &s->link[b->geometries[pair->geometry].link];
  const vec3 first = point_of(own, s->end[pair->geometry][0]), last = point_of(own, s->end[pair->geometry][1]);
  vec3 its[2] = {first, last};
  for (int k = 0; k < 2 && pair->self; k++)
    its[k] = point_of(&s->link[b->geometries[pair->other].link], s->end[pair->other][k]);
  double least = INFINITY;
  const int points = b->half[pair->geometry] > 0.0 ? ALONG : 1;
  for (int k = 0; k < points; k++) {
    const double share = points > 1 ? (double)k / (ALONG - 1) : 0.0;
    const vec3 p = vec_axpy(first, share, vec_sub(last, first));
    least = fmin(least, pair->self ? from_line(its[0], its[1], p) : from_obstacle(s, pair->other, p));
  }
  return least - b->radius[pair->geometry] - (pair->self ? b->radius[pair->other] : 0.0);
}

static void sample(samples *s, double t) {
  bool placed = false;
  for (size_t i = 0; i < s->n_pairs; i++) {
    sampled_pair *pair = &s->pairs[i];
    if (pair->distance - pair->speed * fabs(t - pair->seen) >= s->least) continue;
    if (!placed) place_links(s, t);
    placed = true;
    pair->distance = measure_pair(s, pair), pair->seen = t;
    if (pair->distance < s->least) s->least = pair->distance, s->at = t;
  }
}

double edge_world_distance(const edge_world *w, const double *from, const double *to, double t, bool self) {
  static samples s;
  begin_samples(w, from, to, self, &s);
  place_links(&s, t);
  double least = INFINITY;
  for (size_t i = 0; i < s.n_pairs; i++) least = fmin(least, measure_pair(&s, &s.pairs[i]));
  return least;
}

double edge_world_least(const edge_world *w, const double *from, const double *to, bool self, double *at) {
  static samples s;
  const int n = EDGE_WORLD_SAMPLES;
  begin_samples(w, from, to, self, &s);
  for (int k = 0; k <= n; k++) sample(&s, (double)k / (double)n);
  for (double step = 0.5 / (double)n; step > 1e-7; step *= 0.5)
    for (int side = -1; side <= 1; side += 2) sample(&s, fmin(fmax(s.at + side * step, 0.0), 1.0));
  *at = s.at;
  return s.least;
}

void edge_world_check(const edge_world *w, const cprox_edge_query *q, const cprox_edge_result *r, uint8_t verdict,
                      const double *from, const double *to, double scale, bool self, double least) {
  assert_int_equal(r->verdict, verdict);
  if (verdict == CPROX_VERDICT_CLEAR && !(least >= q->delta - 1e-9 * scale))
    fail_msg("clear, but %.9g at delta %.9g (level %d, scale %g, self %d)", least, q->delta, (int)r->level, scale,
             self);
  if (verdict != CPROX_VERDICT_VIOLATED) return;
  assert_true(r->t >= 0.0 && r->t <= 1.0 && r->geometry >= 0 && r->other >= 0);
  const bool other_is_line = r->other >= (int32_t)w->n && w->b.half[r->other - (int32_t)w->n] > 0.0;
  if (w->b.half[r->geometry] > 0.0 || other_is_line) return; /* samples of lines are not the nearest points */
  const double there = edge_world_distance(w, from, to, r->t, self);
  if (!(there <= q->delta + 1e-9 * scale))
    fail_msg("violated, but %.9g at t = %.9g, delta %.9g (level %d)", there, r->t, q->delta, (int)r->level);
}

void edge_world_try(uint64_t seed, size_t worlds, bool thin, size_t counts[3], size_t levels[CPROX_EDGE_SEARCH + 1]) {
  enum { EDGES = EDGE_WORLD_EDGES };
  rng r = rng_seed(seed);
  for (size_t i = 0; i < worlds; i++) {
    const double scale = rng_log_uniform(&r, 1e-2, 1e2);
    const bool self = rng_index(&r, 2);
    edge_world w;
    edge_world_make(&r, scale, i % 2, thin, &w);
    const cprox_edge_query q = edge_world_asks(&w, self, rng_index(&r, 2) ? 0.0 : scale * rng_uniform(&r, 0, 0.1));
    cprox_edge_checker *c = edge_world_checker(w.b.robot, &q);
    double from[EDGES * TEST_MAX_VARIABLES + 1], to[EDGES * TEST_MAX_VARIABLES + 1];
    const size_t n = w.b.t.n_variables;
    for (size_t k = 0; k < EDGES; k++) edge_robot_draw(&r, &w.b, scale, from + k * n, to + k * n);
    uint8_t verdicts[EDGES];
    cprox_edge_result results[EDGES];
    assert_true(cprox_robot_edges(c, from, to, EDGES, ws, verdicts, results) >= 0);
    for (size_t k = 0; k < EDGES; k++) {
      double at = 0.0;
      const double least = edge_world_least(&w, from + k * n, to + k * n, self, &at);
      edge_world_check(&w, &q, &results[k], verdicts[k], from + k * n, to + k * n, scale, self, least);
      if (least < q.delta - 1e-3 * scale) assert_int_not_equal(verdicts[k], CPROX_VERDICT_CLEAR);
      counts[verdicts[k]]++, levels[results[k].level]++;
    }
    cprox_edge_checker_free(c);
    edge_world_free(&w);
  }
  print_message("%zu %sedges, none wrong\n", EDGES * worlds, thin ? "thin " : "");
}
