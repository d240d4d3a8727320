/* SPDX-License-Identifier: BSD-3-Clause */
/* The bounds of a batch (balls, boxes, OBBs, clusters) are never above the true distance. */
#include <curve_proximity/cprox.h>
#include <math.h>
#include <string.h>

#include "batch/obstacle_batch.h"
#include "problem/placed_pair.h"
#include "shape/body.h"
#include "support/batch_scene.h"
#include "support/cases.h"
#include "support/curves.h"
#include "support/reference.h"

/* Seed 14, 2000 sets of 13 balls, scales 1e-6 … 1e6, offsets to 1e6 of them: never above the distance in long double,
 * and no farther below than twice the rounding that the code states. */
CASE(ball_bounds_are_never_above_the_true_distance) {
  enum { BALLS = 13, PADDED = 16 };
  rng r = rng_seed(14);
  for (size_t round = 0; round < test_cases(2000); round++) {
    double numbers[5][PADDED] = {{0}}, lower[PADDED];
    const packet_balls balls = {BALLS, PADDED, numbers[0], numbers[1], numbers[2], numbers[3], numbers[4]};
    const double scale = rng_log_uniform(&r, 1e-6, 1e6);
    const vec3 offset = vec_scale(round % 2 ? 0.0 : 1e6 * scale, rng_unit(&r));
    curve_capsule c = {vec_add(offset, rng_in_cube(&r, scale)), vec_add(offset, rng_in_cube(&r, scale)), scale};
    if (round % 7 == 0) c.b = c.a;
    for (int k = 0; k < BALLS; k++) {
      const vec3 x = vec_add(offset, rng_in_cube(&r, 3 * scale));
      balls.x[k] = x.x, balls.y[k] = x.y, balls.z[k] = x.z;
      balls.reach[k] = rng_uniform(&r, 0, scale);
      balls.sizes[k] = vec_norm(x) + balls.reach[k];
    }
    packet_ball_bounds(&balls, &c, 0.25 * scale, lower);
    for (int k = 0; k < BALLS; k++) {
      const vec3 x = vec(balls.x[k], balls.y[k], balls.z[k]);
      const long double apart = ref_point_segment(ref_vec(x), ref_vec(c.a), ref_vec(c.b));
      const long double truth =
          apart - (long double)c.radius - 0.25L * (long double)scale - (long double)balls.reach[k];
      assert_true((long double)lower[k] <= truth);
      assert_true((double)(truth - (long double)lower[k]) <= 128 * 0x1p-53 * (10 * scale + 4 * vec_norm(offset)));
    }
  }
}

/* Seed 15, 3000 pieces of all degrees: chords begin within (10 n + 16) u of de Casteljau's points in long double; the
 * nearest point of the chords is no farther and no nearer than that of each by itself, within 16 u of the sizes. */
CASE(chords_are_those_of_the_piece) {
  rng r = rng_seed(15);
  cprox_workspace *workspace = cprox_workspace_create();
  for (size_t round = 0; round < test_cases(3000); round++) {
    const size_t degree = random_degree(&r);
    vec3 points[CPROX_MAX_DEGREE + 1], begin[CHORDS + 1];
    random_points(&r, degree + 1, points);
    const double *basis = packet_basis(degree, workspace);
    packet_chords chords;
    for (uint32_t first = 0; first < CHORDS; first += LANES) {
      const vec3 from = rng_in_cube(&r, 1.0);
      uint32_t nearest, again;
      const double square = packet_points(basis, points, degree, false, first, from, &chords, &nearest);
      assert_true(square == packet_nearest_point(&chords, first, from, &again) && nearest == again);
      for (uint32_t k = first; k < first + LANES; k++)
        assert_true(square <= vec_norm2(vec_sub(from, vec(chords.x[k], chords.y[k], chords.z[k]))));
    }
    packet_join(&chords);
    const double size = ref_largest(points, degree + 1);
    const double allowed = (10.0 * (double)degree + 16) * 0x1p-53 * size;
    for (size_t k = 0; k < CHORDS; k++) {
      const vec3l exact = ref_bezier(points, degree, (long double)k / CHORDS, 0);
      begin[k] = vec(chords.x[k], chords.y[k], chords.z[k]);
      assert_true(ref_error(exact, begin[k]) <= allowed);
    }
    begin[CHORDS] = points[degree];
    const vec3 from = vec_axpy(points[0], size, rng_unit(&r));
    size_t chord;
    double s;
    const double distance = sqrt(packet_closest(&chords, from, &chord, &s));
    long double least = INFINITY;
    for (size_t k = 0; k < CHORDS; k++)
      least = fminl(least, ref_point_segment(ref_vec(from), ref_vec(begin[k]), ref_vec(begin[k + 1])));
    assert_true(fabsl((long double)distance - least) <= 16 * 0x1p-53 * 3 * size);
    const vec3 at = vec_lerp(begin[chord], begin[chord + 1], s);
    assert_true(fabs(vec_norm(vec_sub(from, at)) - distance) <= 16 * 0x1p-53 * 3 * size);
  }
  cprox_workspace_free(workspace);
}

/* The square distance of a point from a box. */
static long double square_from_box(const packet_box *box, vec3 p) {
  const long double beyond[3] = {
      fmaxl(fmaxl((long double)box->low.x - (long double)p.x, (long double)p.x - (long double)box->high.x), 0.0L),
      fmaxl(fmaxl((long double)box->low.y - (long double)p.y, (long double)p.y - (long double)box->high.y), 0.0L),
      fmaxl(fmaxl((long double)box->low.z - (long double)p.z, (long double)p.z - (long double)box->high.z), 0.0L)};
  return beyond[0] * beyond[0] + beyond[1] * beyond[1] + beyond[2] * beyond[2];
}

/* Seed 19, 3000 pieces of all degrees, 8 balls each, at offsets up to 1e6: the bound by boxes is never above the
 * distance of the chords in them, lies within 160 u of the sizes below that of the boxes, and lowers nothing. */
CASE(boxes_bound_the_chords_in_them) {
  enum { BALLS = 8 };
  rng r = rng_seed(19);
  cprox_workspace *workspace = cprox_workspace_create();
  for (size_t round = 0; round < test_cases(3000); round++) {
    const vec3 offset = vec_scale(round % 3 == 0 ? 0.0 : pow(10.0, rng_uniform(&r, 0, 6)), rng_unit(&r));
    const size_t degree = random_degree(&r);
    vec3 points[CPROX_MAX_DEGREE + 1];
    random_points(&r, degree + 1, points);
    for (size_t i = 0; i <= degree; i++) points[i] = vec_add(points[i], offset);
    packet_chords chords;
    uint32_t unused;
    for (uint32_t first = 0; first < CHORDS; first += LANES)
      packet_points(packet_basis(degree, workspace), points, degree, false, first, offset, &chords, &unused);
    packet_box boxes[PACKET_INTERVALS];
    packet_boxes(&chords, boxes);

    double x[BALLS], y[BALLS], z[BALLS], reach[BALLS], sizes[BALLS], lower[BALLS];
    for (int k = 0; k < BALLS; k++) {
      const vec3 c = vec_axpy(offset, rng_uniform(&r, 0, 4), rng_unit(&r));
      x[k] = c.x, y[k] = c.y, z[k] = c.z, reach[k] = rng_uniform(&r, 0, 0.5);
      sizes[k] = vec_norm(c) + reach[k];
      lower[k] = k == 0 ? 1e300 : -INFINITY;
    }
    const packet_balls balls = {.n = BALLS, .padded = BALLS, .x = x, .y = y, .z = z, .reach = reach, .sizes = sizes};
    const double radius = rng_uniform(&r, 0, 0.5);
    packet_box_bounds(&balls, boxes, PACKET_INTERVALS, radius, 0.0, lower);
    assert_true(lower[0] == 1e300);
    for (int k = 1; k < BALLS; k++) {
      const vec3 c = vec(x[k], y[k], z[k]);
      const long double margin = (long double)radius + (long double)reach[k];
      long double to_chords = INFINITY, to_boxes = INFINITY;
      for (size_t i = 0; i < CHORDS; i++) {
        const vec3 a = vec(chords.x[i], chords.y[i], chords.z[i]);
        const vec3 b = vec(chords.x[i + 1], chords.y[i + 1], chords.z[i + 1]);
        to_chords = fminl(to_chords, ref_point_segment(ref_vec(c), ref_vec(a), ref_vec(b)));
      }
      for (size_t i = 0; i < PACKET_INTERVALS; i++) to_boxes = fminl(to_boxes, sqrtl(square_from_box(&boxes[i], c)));
      assert_true((long double)lower[k] <= to_chords - margin);
      assert_true((double)(to_boxes - margin - (long double)lower[k]) <=
                  160 * 0x1p-53 * ((double)(to_boxes + margin) + sizes[k]));
    }
  }
  cprox_workspace_free(workspace);
}

/* Seed 20, 2000 pieces of all degrees: points within a chord are those of de Casteljau in long double, within (10 n +
 * 16) u. */
CASE(chords_are_cut_again_where_the_piece_goes) {
  rng r = rng_seed(20);
  cprox_workspace *workspace = cprox_workspace_create();
  for (size_t round = 0; round < test_cases(2000); round++) {
    const size_t degree = random_degree(&r), chord = rng_index(&r, CHORDS);
    vec3 points[CPROX_MAX_DEGREE + 1];
    random_points(&r, degree + 1, points);
    const double *basis = packet_fine_basis(degree, chord, workspace);
    packet_chords fine;
    uint32_t unused;
    for (uint32_t first = 0; first < CHORDS; first += LANES)
      packet_points(basis, points, degree, false, first, vec(0, 0, 0), &fine, &unused);
    const double allowed = (10.0 * (double)degree + 16) * 0x1p-53 * ref_largest(points, degree + 1);
    for (size_t k = 0; k < CHORDS; k++) {
      const long double s = ((long double)chord + (long double)k / CHORDS) / CHORDS;
      const vec3 point = vec(fine.x[k], fine.y[k], fine.z[k]);
      assert_true(ref_error(ref_bezier(points, degree, s, 0), point) <= allowed);
    }
  }
  cprox_workspace_free(workspace);
}

/* The distance of a point of the chord from the OBB, in long double; the frame's matrix is taken as it is, which a
 * rotation is but for 20 u. */
static long double from_obb(const packet_obb *b, const packet_chords *c, size_t k, long double s) {
  const long double v[3] = {(long double)c->x[k] + s * (long double)c->dx[k] - (long double)b->position.x,
                            (long double)c->y[k] + s * (long double)c->dy[k] - (long double)b->position.y,
                            (long double)c->z[k] + s * (long double)c->dz[k] - (long double)b->position.z};
  const long double centre[3] = {(long double)b->centre.x, (long double)b->centre.y, (long double)b->centre.z};
  const long double half[3] = {(long double)b->half.x, (long double)b->half.y, (long double)b->half.z};
  long double square = 0.0L;
  for (int i = 0; i < 3; i++) {
    long double y = -centre[i];
    for (int j = 0; j < 3; j++) y += (long double)b->r[3 * j + i] * v[j];
    const long double beyond = fmaxl(fabsl(y) - half[i], 0.0L);
    square += beyond * beyond;
  }
  return sqrtl(square);
}

/* Seed 21, 1000 OBBs anywhere, also flat ones and points, 1 to 1e6 m away: the bound of a chord is not above its
 * distance, which is convex along the chord and found by golden section to 1e-12 of it; it is the distance to 5 % and
 * less for nine chords in ten that are apart; the point is where it says. */
CASE(obbs_bound_chords_from_below) {
  rng r = rng_seed(21);
  cprox_workspace *workspace = cprox_workspace_create();
  size_t apart = 0, tight = 0;
  for (size_t round = 0; round < test_cases(1000); round++) {
    const size_t degree = 1 + rng_index(&r, 6);
    vec3 points[CPROX_MAX_DEGREE + 1];
    const double far = round % 2 ? rng_log_uniform(&r, 1.0, 1e6) : 0.0;
    const vec3 offset = vec_scale(far, rng_unit(&r));
    for (size_t i = 0; i <= degree; i++) points[i] = vec_add(offset, rng_in_cube(&r, 1.0));
    if (round % 11 == 0) points[1] = points[0];
    packet_chords chords;
    uint32_t unused;
    for (uint32_t first = 0; first < CHORDS; first += LANES)
      packet_points(packet_basis(degree, workspace), points, degree, false, first, offset, &chords, &unused);
    packet_join(&chords);
    const cprox_pose pose = rng_pose(&r, 1.0);
    const frame f = frame_create(&pose, vec(0, 0, 0));
    packet_obb obb = {.position = vec_add(offset, pose.position), .centre = rng_in_cube(&r, 0.2)};
    memcpy(obb.r, f.r, sizeof obb.r);
    obb.half = vec(rng_uniform(&r, 0, 0.5), rng_uniform(&r, 0, 0.5), round % 5 ? rng_uniform(&r, 0, 0.5) : 0.0);
    if (round % 7 == 0) obb.half = vec(0, 0, 0);
    packet_sample sight;
    packet_see_obb(&chords, &obb, &sight);
    const long double allowed = 128 * 0x1p-53L * (long double)(far + 4.0);
    for (size_t k = 0; k < CHORDS; k++) {
      long double a = 0.0L, b = 1.0L;
      for (int step = 0; step < 60; step++) {
        const long double left = b - 0.6180339887498949L * (b - a), right = a + 0.6180339887498949L * (b - a);
        if (from_obb(&obb, &chords, k, left) <= from_obb(&obb, &chords, k, right))
          b = right;
        else
          a = left;
      }
      const long double least = from_obb(&obb, &chords, k, 0.5L * (a + b));
      assert_true((long double)sight.lower[k] <= least + 1e-12L + allowed);
      assert_true(sight.lower[k] >= 0.0 && sight.s[k] >= 0.0 && sight.s[k] <= 1.0);
      const long double at = from_obb(&obb, &chords, k, (long double)sight.s[k]);
      assert_true(fabsl(at - sqrtl((long double)sight.square[k])) <= allowed);
      apart += least > 1e-6L;
      tight += least > 1e-6L && (long double)sight.lower[k] >= 0.95L * least;
    }
  }
  assert_true(apart > 0 && 10 * tight >= 9 * apart);
  cprox_workspace_free(workspace);
}

/* Seed 23, 20 scenes: an OBB holds the points of its part that lie farthest in 100 directions, and each of its faces
 * has one of them within a third of its width; 1e-12 is the rounding of the poses here, amply. */
CASE(obbs_hold_their_parts) {
  rng r = rng_seed(23);
  cprox_workspace *workspace = cprox_workspace_create();
  size_t obbs = 0;
  for (size_t round = 0; round < test_cases(20); round++) {
    batch_scene s = {0};
    batch_scene_targets(&r, round % 4 == 3, workspace, &s);
    obstacle_batch *batch = NULL;
    assert_int_equal(obstacle_batch_create(s.obstacles, s.n_obstacles, workspace, &batch), CPROX_OK);
    const query q = {.obstacles = s.obstacles, .n = s.n_obstacles};
    for (size_t k = 0; k < batch->balls.n; k++) {
      const batch_core *core = &batch->cores[k];
      if (!core->has_obb) continue;
      obbs++;
      const placed_pair placed = placed_pair_resolve(&q, &batch->parts[k]);
      const cprox_body *body = placed.shape;
      const frame f = placed.frame;
      const frame own = {.position = core->obb.position, .centre = core->obb.centre, .rotated = true};
      frame obb = own;
      memcpy(obb.r, core->obb.r, sizeof obb.r);
      double least[3] = {INFINITY, INFINITY, INFINITY}, most[3] = {-INFINITY, -INFINITY, -INFINITY};
      const double half[3] = {core->obb.half.x, core->obb.half.y, core->obb.half.z};
      for (int i = 0; i < 106; i++) {
        vec3 d = rng_unit(&r), at;
        if (i < 6) d = vec(i / 2 == 0, i / 2 == 1, i / 2 == 2);
        if (i < 6 && i % 2) d = vec_neg(d);
        body->shape.ops->support(&body->shape, d, NULL, &at);
        double error = 0.0;
        const vec3 y = frame_to_local(&obb, frame_to_world(&f, vec_axpy(at, body->shape.margin, d)), &error);
        const double inside[3] = {y.x, y.y, y.z};
        for (int j = 0; j < 3; j++) {
          assert_true(fabs(inside[j]) <= half[j] + 1e-12);
          least[j] = fmin(least[j], inside[j]), most[j] = fmax(most[j], inside[j]);
        }
      }
      for (int j = 0; j < 3; j++) assert_true(most[j] >= half[j] / 3 - 1e-12 && least[j] <= -half[j] / 3 + 1e-12);
    }
    obstacle_batch_free(batch);
    batch_scene_free(&s);
  }
  assert_true(obbs > 0);
  cprox_workspace_free(workspace);
}

/* Seed 24: 75 boxes, compounds of two, and two halfspaces, which have no balls. Each part is in one cluster; the bound
 * of a cluster is above the distance of none of its balls from 4 boxes, in long double, and no more than 160 u of the
 * sizes below that of the box round its balls. */
CASE(clusters_hold_each_part_once_and_bound_it) {
  enum { N = 75, BOXES = 4 };
  rng r = rng_seed(24);
  cprox_workspace *workspace = cprox_workspace_create();
  for (size_t round = 0; round < test_cases(100); round++) {
    const size_t n = 1 + rng_index(&r, N);
    cprox_body *box = NULL, *pair = NULL, *half = NULL;
    cprox_obstacle obstacles[N];
    assert_int_equal(cprox_body_create_box(vec(0.1, 0.2, 0.3), workspace, &box), CPROX_OK);
    assert_int_equal(cprox_body_create_halfspace(vec(0, 0, 1), 0.0, workspace, &half), CPROX_OK);
    const cprox_pose poses[2] = {rng_pose(&r, 0.5), rng_pose(&r, 0.5)};
    assert_int_equal(cprox_body_create_compound((const cprox_body *[]){box, box}, poses, 2, workspace, &pair),
                     CPROX_OK);
    const double far = round % 2 ? rng_log_uniform(&r, 1.0, 1e5) : 0.0;
    const vec3 offset = vec_scale(far, rng_unit(&r));
    for (size_t i = 0; i < n; i++) {
      cprox_pose pose = rng_pose(&r, 2.0);
      pose.position = vec_add(pose.position, offset);
      obstacles[i] = cprox_obstacle_at(i % 40 == 20 ? half : i % 4 == 1 ? pair : box, pose);
      obstacles[i].margin = i % 3 == 0 ? 0.1 : 0.0;
    }
    obstacle_batch *batch = NULL;
    assert_int_equal(obstacle_batch_create(obstacles, n, workspace, &batch), CPROX_OK);
    int met[N][2] = {{0}};
    for (size_t k = 0; k < batch->balls.n; k++) met[batch->parts[k].obstacle][batch->parts[k].part]++;
    for (size_t i = 0; i < n; i++) assert_true(met[i][0] == 1 && met[i][1] == (obstacles[i].body == pair));

    packet_box boxes[BOXES];
    for (int i = 0; i < BOXES; i++) {
      const vec3 at = vec_add(offset, rng_in_cube(&r, 4.0)),
                 size = vec(rng_uniform(&r, 0, 1), rng_uniform(&r, 0, 1), 0);
      boxes[i] = (packet_box){at, vec_add(at, size)};
    }
    double lower[N];
    const double radius = rng_uniform(&r, 0, 0.2);
    const packet_clusters *clusters = &batch->clusters;
    assert_true(clusters->padded <= N && clusters->n == (batch->balls.n + CLUSTER - 1) / CLUSTER);
    packet_cluster_bounds(clusters, boxes, BOXES, radius, 0.0, lower);
    for (size_t k = 0; k < batch->balls.n; k++) {
      const packet_balls *balls = &batch->balls;
      if (isinf(balls->reach[k])) {
        assert_true(lower[k / CLUSTER] == -INFINITY);
        continue;
      }
      const vec3 c = vec(balls->x[k], balls->y[k], balls->z[k]);
      long double least = INFINITY;
      for (int i = 0; i < BOXES; i++) least = fminl(least, square_from_box(&boxes[i], c));
      const long double truth = fmaxl(sqrtl(least) - (long double)balls->reach[k], 0.0L) - (long double)radius;
      assert_true((long double)lower[k / CLUSTER] <= truth);
    }
    for (size_t b = 0; b < clusters->n; b++) {
      if (lower[b] == -INFINITY) continue;
      long double least = INFINITY;
      for (int i = 0; i < BOXES; i++) {
        const double low[3] = {boxes[i].low.x, boxes[i].low.y, boxes[i].low.z};
        const double high[3] = {boxes[i].high.x, boxes[i].high.y, boxes[i].high.z};
        long double square = 0.0L;
        for (int j = 0; j < 3; j++) {
          const long double over = (long double)low[j] - (long double)clusters->high[j][b];
          const long double under = (long double)clusters->low[j][b] - (long double)high[j];
          const long double gap = fmaxl(fmaxl(over, under), 0.0L);
          square += gap * gap;
        }
        least = fminl(least, square);
      }
      const long double below = sqrtl(least) - (long double)radius - (long double)lower[b];
      assert_true(below >= 0.0L && below <= 160 * 0x1p-53L * (sqrtl(least) + 1.0L + (long double)clusters->sizes[b]));
    }
    obstacle_batch_free(batch);
    cprox_body_free(pair);
    cprox_body_free(box);
    cprox_body_free(half);
  }
  cprox_workspace_free(workspace);
}

int main(void) {
  return cases_run(NULL, NULL);
}
