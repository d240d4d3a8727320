/* SPDX-License-Identifier: BSD-3-Clause */
/* Points that move: bodies made by updates answer as bodies made anew, and queries run on the body as it was while the
 * next one is made. Also run under ThreadSanitizer. */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/cases.h"
#include "support/make_curve.h"
#include "support/random.h"

static cprox_body *cloud(const vec3 *points, size_t n, cprox_workspace *ws) {
  cprox_body *body = NULL;
  if (cprox_body_create_points(points, n, 0.01, SIZE_MAX, ws, &body) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
  return body;
}

static cprox_curve *random_curve(rng *r) {
  vec3 points[4];
  cprox_curve *curve = NULL;
  for (int k = 0; k < 4; k++) points[k] = rng_in_cube(r, 1.0);
  assert_int_equal(curve_from(describe_bezier(points, 4, 0.0, 1.0), NULL, &curve), CPROX_OK);
  return curve;
}

/* ---- the same answers ---- */

/* Moves some points, near their places, so that boxes follow, or some of them far, so that blocks are sorted anew; *n
 * of them, some twice. */
static void move_some(rng *r, vec3 *points, size_t all, uint32_t *changed, vec3 *places, size_t *n) {
  const vec3 centre = rng_in_cube(r, 1.0);
  const double reach = rng_uniform(r, 0.0, 0.6), rarely = rng_index(r, 2) ? 0.5 : 0.002;
  *n = 0;
  for (size_t i = 0; i < all; i++) {
    if (vec_norm(vec_sub(points[i], centre)) > reach) continue;
    const double step = rng_index(r, 10) == 0 ? rarely : 0.02 * rarely;
    changed[*n] = (uint32_t)i;
    places[(*n)++] = rng_in_cube(r, 3.0); /* this one is taken back at once: */
    changed[*n] = (uint32_t)i;
    points[i] = vec_add(points[i], rng_in_cube(r, step));
    places[(*n)++] = points[i];
  }
}

/* Clouds of 1 to 30,000 points (seed 131), 8 updates each, with and without memory of retired bodies: distances are
 * those of a cloud made anew, to epsilon; nearest points are equally far; the body before answers as before. */
CASE(updated_clouds_answer_as_new_ones_do) {
  enum { MOST = 30000 };
  static vec3 points[MOST], places[2 * MOST];
  static uint32_t changed[2 * MOST];
  rng r = rng_seed(131);
  cprox_workspace *ws = cprox_workspace_create();
  static const size_t sizes[] = {1, 7, 100, 4095, 4097, MOST};
  for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
    const size_t all = sizes[k];
    for (size_t i = 0; i < all; i++) points[i] = rng_in_cube(&r, 1.0);
    cprox_body *now = cloud(points, all, ws), *before = NULL;
    for (int update = 0; update < 8; update++) {
      const vec3 seen = rng_in_cube(&r, 1.2);
      const double as_was = cprox_body_nearest(now, seen, NULL);
      size_t n;
      move_some(&r, points, all, changed, places, &n);
      cprox_body *next = NULL;
      cprox_body *retired = update % 3 ? before : NULL;
      if (cprox_body_update_points(now, changed, places, n, retired, ws, &next) != CPROX_OK)
        fail_msg("%s", cprox_workspace_error(ws));
      if (!retired) cprox_body_free(before);
      assert_true(cprox_body_nearest(now, seen, NULL) == as_was);
      before = now, now = next;

      cprox_body *anew = cloud(points, all, ws);
      for (int i = 0; i < 50; i++) {
        const vec3 x = rng_in_cube(&r, 1.5);
        assert_true(fabs(cprox_body_nearest(now, x, NULL) - cprox_body_nearest(anew, x, NULL)) < 1e-14);
        const cprox_body_info info = cprox_body_get_info(now);
        const vec3 centre = info.centre;
        const double radius = info.radius;
        assert_true(vec_norm(vec_sub(points[rng_index(&r, all)], centre)) <= radius);
      }
      cprox_curve *curve = random_curve(&r);
      cprox_result a, b;
      assert_int_equal(
          cprox_distance(cprox_point_along(curve), cprox_obstacle_at(now, CPROX_POSE_IDENTITY), NULL, ws, &a),
          CPROX_OK);
      assert_int_equal(
          cprox_distance(cprox_point_along(curve), cprox_obstacle_at(anew, CPROX_POSE_IDENTITY), NULL, ws, &b),
          CPROX_OK);
      assert_true(a.lower <= b.upper && b.lower <= a.upper);
      cprox_curve_free(curve);
      cprox_body_free(anew);
    }
    cprox_body_free(now);
    cprox_body_free(before);
  }
  cprox_workspace_free(ws);
}

CASE(bad_updates_are_refused) {
  cprox_workspace *ws = cprox_workspace_create();
  const vec3 points[2] = {{0, 0, 0}, {1, 0, 0}}, wrong[1] = {{NAN, 0, 0}};
  const uint32_t which[1] = {2}, first[1] = {0};
  cprox_body *body = cloud(points, 2, ws), *other = cloud(points, 2, ws), *ball = NULL, *made = NULL;
  assert_int_equal(cprox_body_create_sphere(1.0, ws, &ball), CPROX_OK);
  assert_int_equal(cprox_body_update_points(body, which, points, 1, NULL, ws, &made), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "point 2"));
  assert_int_equal(cprox_body_update_points(body, first, wrong, 1, NULL, ws, &made), CPROX_INVALID);
  assert_int_equal(cprox_body_update_points(ball, first, points, 1, NULL, ws, &made), CPROX_INVALID);
  assert_int_equal(cprox_body_update_points(body, first, points, 1, other, ws, &made), CPROX_INVALID);
  assert_int_equal(cprox_body_update_points(body, first, points, 1, body, ws, &made), CPROX_INVALID);
  assert_null(made);
  assert_int_equal(cprox_body_update_points(body, NULL, NULL, 0, NULL, ws, &made), CPROX_OK);
  cprox_body_free(made);
  cprox_body_free(body);
  cprox_body_free(other);
  cprox_body_free(ball);
  cprox_workspace_free(ws);
}

/* ---- while queries run ---- */

enum { READERS = 2, POINTS = 8192, UPDATES = 20, KEPT = 4 };

/* The newest body, and how many readers hold each; a body is retired when none does and a newer one is there. */
typedef struct board {
  pthread_mutex_t mutex;
  cprox_body *body[KEPT];
  double shift[KEPT]; /* how far its points have moved up */
  int held[KEPT], newest;
  bool ended;
} board;

static void *reader(void *argument) {
  board *b = argument;
  cprox_workspace *ws = cprox_workspace_create();
  const vec3 line[2] = {{-1, 0, 5}, {1, 0, 5}};
  cprox_curve *curve = NULL;
  size_t wrong = curve_from(describe_bezier(line, 2, 0.0, 1.0), ws, &curve) != CPROX_OK;
  for (bool ended = false; !ended && !wrong;) {
    pthread_mutex_lock(&b->mutex);
    const int mine = b->newest;
    b->held[mine]++;
    ended = b->ended;
    pthread_mutex_unlock(&b->mutex);
    /* all points of the plane stand at one height: the distance says which state was seen */
    cprox_result r;
    const cprox_status status =
        cprox_distance(cprox_point_along(curve), cprox_obstacle_at(b->body[mine], CPROX_POSE_IDENTITY), NULL, ws, &r);
    wrong += status != CPROX_OK || fabs(r.upper - (5.0 - b->shift[mine] - 0.01)) > 1e-3;
    pthread_mutex_lock(&b->mutex);
    b->held[mine]--;
    pthread_mutex_unlock(&b->mutex);
  }
  cprox_curve_free(curve);
  cprox_workspace_free(ws);
  return (void *)wrong;
}

/* A slot that nobody holds and that is not the newest. */
static int free_slot(board *b) {
  for (;;) {
    pthread_mutex_lock(&b->mutex);
    int slot = -1;
    for (int k = 0; k < KEPT && slot < 0; k++)
      if (k != b->newest && b->held[k] == 0) slot = k;
    pthread_mutex_unlock(&b->mutex);
    if (slot >= 0) return slot;
  }
}

/* Two readers, one writer that raises a plane of 8,192 points step by step, with the memory of retired bodies. Every
 * answer is that of one state, never of a mixture. */
CASE(readers_see_one_state_while_the_next_is_made) {
  static vec3 points[POINTS];
  static uint32_t all[POINTS];
  cprox_workspace *ws = cprox_workspace_create();
  rng r = rng_seed(137);
  for (uint32_t i = 0; i < POINTS; i++)
    all[i] = i, points[i] = vec(rng_uniform(&r, -1.0, 1.0), rng_uniform(&r, -0.01, 0.01), 0.0);
  board b = {.newest = 0};
  pthread_mutex_init(&b.mutex, NULL);
  b.body[0] = cloud(points, POINTS, ws);
  pthread_t threads[READERS];
  for (int k = 0; k < READERS; k++) assert_int_equal(pthread_create(&threads[k], NULL, reader, &b), 0);
  for (int update = 1; update <= UPDATES; update++) {
    for (size_t i = 0; i < POINTS; i++) points[i].z = 0.1 * update;
    const int slot = free_slot(&b);
    cprox_body *next = NULL;
    assert_int_equal(cprox_body_update_points(b.body[b.newest], all, points, POINTS, b.body[slot], ws, &next),
                     CPROX_OK);
    pthread_mutex_lock(&b.mutex);
    b.body[slot] = next;
    b.shift[slot] = 0.1 * update;
    b.newest = slot;
    b.ended = update == UPDATES;
    pthread_mutex_unlock(&b.mutex);
  }
  for (int k = 0; k < READERS; k++) {
    void *wrong;
    assert_int_equal(pthread_join(threads[k], &wrong), 0);
    assert_null(wrong);
  }
  for (int k = 0; k < KEPT; k++) cprox_body_free(b.body[k]);
  pthread_mutex_destroy(&b.mutex);
  cprox_workspace_free(ws);
}

int main(void) {
  return cases_run(NULL, NULL);
}
