/* SPDX-License-Identifier: BSD-3-Clause */
/* What a query leaves behind is accepted by the checker, which reads the query itself and shares no line with the
 * search. */

#include <string.h>
#include <time.h>

#include "quick.h"
#include "support/cases.h"
#include "support/make_curve.h"
#include "support/of_list.h"
#include "support/queries.h"
#include "support/tampering.h"

enum { SAMPLES = 200, MUTANTS = 25 };

/* Figures of a campaign, printed at its end. */
typedef struct tally {
  size_t asked, apart, near, none;
  size_t bytes, leaves, largest;
  double milliseconds[3]; /* of what is apart: without a certificate, with it, to check it with the text read */
} tally;

static double milliseconds(void) {
  return 1e3 * (double)clock() / CLOCKS_PER_SEC;
}

static cprox_status ask(const asked *q, double delta, const cprox_options *options, cprox_workspace *ws,
                        cprox_result *result) {
  const cprox_mover along = asked_mover(q);
  return delta < 0.0 ? distance_of_list(along, q->targets, q->n, options, ws, result, NULL)
                     : tolerance_of_list(along, q->targets, q->n, delta, options, ws, result, NULL);
}

/* What a distance may give away: rounding, and what moves on one clock is seen by curves that were made of two, each
 * number within a few roundings of its size (64 of them are allowed). */
static double given_away(const asked *q) {
  double largest = 0.0;
  for (size_t i = 0; i < q->mover.n && (q->growth.curve || q->ride.curve); i++)
    largest = fmax(largest, vec_norm(q->mover.points[i]));
  return 1e-12 * q->scale + 64.0 * 0x1p-53 * largest;
}

/* Asks the distance and two tolerances about it; every certificate is checked. */
static void examine(const asked *q, cprox_workspace *ws, cprox_certificate *c, tally *sum) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-6 * q->scale;
  options.certificate = c;
  double distance = 0.0;
  for (int i = 0; i < 3; i++) {
    cprox_result r;
    const double delta = i == 0 ? -1.0 : i == 1 ? 0.5 * distance : 1.5 * distance;
    const cprox_status status = ask(q, delta, &options, ws, &r);
    if (status < 0) fail_msg("%s", cprox_workspace_error(ws));
    if (i == 0) distance = r.lower;
    sum->asked++;
    const bool open = i == 0 ? r.lower == 0.0 && r.upper == 0.0 : r.upper > delta && r.lower <= delta;
    if (cprox_certificate_get_info(c).size == 0) {
      sum->none++;
      if (!open) fail_msg("no certificate of lower %.17g over %.17g: %s", r.lower, delta, cprox_workspace_error(ws));
      continue;
    }
    const finding found = asked_check(q, cprox_certificate_get_info(c).bytes, cprox_certificate_get_info(c).size);
    if (found.fault)
      fail_msg("refused: %s (lower %.17g, delta %.17g)", found.fault, r.lower, cprox_certificate_get_info(c).delta);
    assert_int_equal(found.claim, cprox_certificate_get_info(c).claim);
    assert_true(found.delta == cprox_certificate_get_info(c).delta);
    sum->apart += found.claim == CLAIM_APART;
    if (i == 0 && found.claim == CLAIM_APART && found.delta < r.lower - given_away(q))
      fail_msg("distance > %.17g is proven, but not > %.17g", found.delta, r.lower);
    sum->near += found.claim == CLAIM_NEAR;
    if (found.claim == CLAIM_APART && i == 1) {
      sum->bytes += cprox_certificate_get_info(c).size;
      sum->leaves += found.leaves;
      if (cprox_certificate_get_info(c).size > sum->largest) sum->largest = cprox_certificate_get_info(c).size;
    }
  }
}

static void examine_many(uint64_t seed, size_t cases, asked_kinds kinds, const char *what) {
  rng r = rng_seed(seed);
  cprox_workspace *ws = cprox_workspace_create();
  cprox_certificate *c = cprox_certificate_create();
  tally sum = {0};
  for (size_t i = 0; i < test_cases(cases); i++) {
    asked q;
    const double scale = rng_index(&r, 2) ? 1.0 : rng_log_uniform(&r, 1e-3, 1e3);
    asked_random(&q, &r, kinds, scale, rng_index(&r, 3) ? scale : 1e4 * scale, ws);
    examine(&q, ws, c, &sum);
    asked_free(&q);
  }
  print_message(
      "%s: %zu asked, %zu apart, %zu near, %zu without; a tolerance: %.0f bytes, %.1f directions, at most %zu bytes\n",
      what, sum.asked, sum.apart, sum.near, sum.none, (double)sum.bytes / fmax(1.0, (double)sum.apart / 2.0),
      (double)sum.leaves / fmax(1.0, (double)sum.apart / 2.0), sum.largest);
  cprox_certificate_free(c);
  cprox_workspace_free(ws);
}

/* Seeds 1 to 3, sizes below. */
CASE(a_bezier_curve_and_a_polytope_leave_a_certificate_that_holds) {
  examine_many(1, 200, (asked_kinds){.bezier_only = true, .polytope_only = true}, "bezier, polytope");
}

CASE(every_basis_and_every_convex_kind_leave_certificates_that_hold) {
  examine_many(2, 200, (asked_kinds){0}, "all kinds");
}

CASE(bodies_by_inequalities_leave_certificates_that_hold) {
  examine_many(5, 100, (asked_kinds){.implicit = true}, "inequalities");
}

CASE(what_is_carried_leaves_certificates_that_hold) {
  examine_many(6, 100, (asked_kinds){.carried = true}, "carried");
}

/* One of the two bodies is carried by a curve that stays where it begins. */
CASE(pairs_that_stand_leave_certificates_that_hold) {
  examine_many(9, 60, (asked_kinds){.carried = true, .stays = true}, "pairs that stand");
}

CASE(what_moves_on_one_clock_leaves_certificates_that_hold) {
  examine_many(7, 100, (asked_kinds){.clock = true}, "clock");
}

CASE(curves_against_curves_leave_certificates_that_hold) {
  examine_many(3, 60, (asked_kinds){.curve_target = true}, "curve, curve");
}

/* ---- elements: meshes, points, cells ---- */

/* The least distance that is seen from the curve to the elements of the target, or into the inside of a closed mesh: no
 * claim may say that it is farther. */
static double seen(const asked *q, size_t target, int samples, cprox_workspace *ws) {
  const cprox_obstacle *t = &q->targets[target];
  double least = INFINITY, t0, t1;
  t0 = cprox_curve_get_info(q->mover.curve).t0, t1 = cprox_curve_get_info(q->mover.curve).t1;
  for (int i = 0; i <= samples; i++) {
    vec3 p;
    const double at = fmin(t0 + (t1 - t0) * i / samples, t1);
    assert_int_equal(cprox_curve_evaluate(q->mover.curve, at, ws, &p, NULL, NULL), CPROX_OK);
    const double d = query_mesh_distance(&q->mesh[target], ref_to_local(&t->pose, ref_vec(p)));
    least = fmin(least, fmax(d - q->radius - t->margin, 0.0));
  }
  return least;
}

static bool is_same(const cprox_result *a, const cprox_result *b) {
  return a->status == b->status && a->verdict == b->verdict && a->lower == b->lower && a->upper == b->upper &&
         a->t == b->t && vec_norm2(vec_sub(a->witness_mover, b->witness_mover)) == 0.0 &&
         vec_norm2(vec_sub(a->witness_obstacle, b->witness_obstacle)) == 0.0 &&
         a->obstacle_index == b->obstacle_index && a->lod == b->lod && a->nodes == b->nodes &&
         a->distance_queries == b->distance_queries;
}

/* A query with and without a certificate: the answer is the same, and what is proven is so. */
static void examine_elements(const asked *q, double delta, cprox_workspace *ws, cprox_certificate *c, tally *sum) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-6 * q->scale;
  cprox_result plain, r;
  const double begin = milliseconds();
  assert_true(ask(q, delta, &options, ws, &plain) >= 0);
  const double asked_plain = milliseconds();
  options.certificate = c;
  assert_true(ask(q, delta, &options, ws, &r) >= 0);
  const double asked_both = milliseconds();
  assert_true(is_same(&plain, &r));
  sum->asked++;
  const double wanted = delta < 0.0 ? 0.0 : delta;
  if (cprox_certificate_get_info(c).size == 0) {
    if (delta < 0.0 ? r.lower > 0.0 : r.lower > wanted || r.upper <= wanted)
      fail_msg("no certificate of [%.17g, %.17g] over %.17g: %s", r.lower, r.upper, delta, cprox_workspace_error(ws));
    sum->none++;
    return;
  }
  asked_text text = asked_text_of(q);
  const double read = milliseconds();
  const finding found = check(&text.read, cprox_certificate_get_info(c).bytes, cprox_certificate_get_info(c).size);
  const double checked = milliseconds();
  asked_text_free(&text);
  if (found.fault) fail_msg("refused: %s", found.fault);
  sum->apart += found.claim == CLAIM_APART;
  sum->near += found.claim == CLAIM_NEAR;
  if (found.claim == CLAIM_NEAR) {
    assert_true(found.delta >= r.lower);
    return;
  }
  sum->milliseconds[0] += asked_plain - begin;
  sum->milliseconds[1] += asked_both - asked_plain;
  sum->milliseconds[2] += checked - read;
  sum->bytes += cprox_certificate_get_info(c).size;
  sum->leaves += found.leaves;
  const int samples = q->mesh[0].surface.m < 1000 ? SAMPLES : 10;
  for (size_t i = 0; i < q->n; i++)
    if (q->mesh[i].body && seen(q, i, samples, ws) < found.delta * (1.0 - 1e-12))
      fail_msg("farther than %g is not so", found.delta);
  const double least = r.lower - 2.0 * options.epsilon;
  if (delta < 0.0 && found.delta < least) fail_msg("farther than %.17g is proven, not %.17g", found.delta, least);
}

/* 300 queries, seed 4: curves beside meshes that are not convex, points and cells, in their holes and inside of them. */
CASE(proofs_of_elements_hold_of_each_and_leave_answers_as_they_are) {
  rng r = rng_seed(4);
  cprox_workspace *ws = cprox_workspace_create();
  cprox_certificate *c = cprox_certificate_create();
  tally sum = {0};
  for (size_t i = 0; i < test_cases(300); i++) {
    asked q;
    asked_random(&q, &r, (asked_kinds){.meshes = true, .elements = true, .bezier_only = i % 2 == 0}, 1.0,
                 i % 3 ? 1.0 : 0.1, ws);
    for (size_t k = 0; k < q.n && i % 2; k++)
      if (q.mesh[k].body) q.targets[k].pose.position = vec_add(q.mover.points[0], rng_in_cube(&r, 0.3));
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    cprox_result exact;
    ask(&q, -1.0, &options, ws, &exact);
    examine_elements(&q, -1.0, ws, c, &sum);
    examine_elements(&q, 0.5 * exact.lower, ws, c, &sum);
    examine_elements(&q, 1.5 * exact.lower, ws, c, &sum);
    asked_free(&q);
  }
  print_message("elements: %zu asked, %zu apart, %zu near, %zu without; %.0f bytes, %.1f directions\n", sum.asked,
                sum.apart, sum.near, sum.none, (double)sum.bytes / (double)sum.apart,
                (double)sum.leaves / (double)sum.apart);
  assert_true(sum.apart > test_cases(300) && sum.near > test_cases(150));
  cprox_certificate_free(c);
  cprox_workspace_free(ws);
}

/* A curve within a closed box is apart from its triangles; of the solid that proves nothing. */
CASE(what_is_inside_of_a_solid_is_not_apart_from_it) {
  rng r = rng_seed(8);
  cprox_workspace *ws = cprox_workspace_create();
  cprox_certificate *c = cprox_certificate_create();
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.certificate = c;
  test_mesh box = mesh_box(vec(1, 1, 1));
  cprox_body *surface = mesh_body(&box, CPROX_MESH_FILL_SURFACE, ws);
  cprox_body *solid = mesh_body(&box, CPROX_MESH_FILL_SOLID, ws);
  for (int i = 0; i < 50; i++) {
    const double most = i % 2 ? 0.9 : 3.0;
    asked q = {.scale = 1.0, .n = 1};
    q.mover = (given_curve){.basis = "bezier", .degree = 3, .t1 = 1.0, .n = 4};
    for (int k = 0; k < 4; k++) q.mover.points[k] = rng_in_cube(&r, most);
    assert_int_equal(curve_from(describe_bezier(q.mover.points, 4, 0.0, 1.0), ws, &q.mover.curve), CPROX_OK);
    cprox_result of_surface, of_solid;
    q.targets[0] = cprox_obstacle_at(solid, rng_pose(&r, 0.01));
    ask(&q, -1.0, &options, ws, &of_solid);
    assert_null(asked_check(&q, cprox_certificate_get_info(c).bytes, cprox_certificate_get_info(c).size).fault);
    q.targets[0].body = surface;
    ask(&q, -1.0, &options, ws, &of_surface);
    const cprox_certificate_info info = cprox_certificate_get_info(c);
    assert_null(asked_check(&q, info.bytes, info.size).fault);
    q.targets[0].body = solid;
    const finding found = asked_check(&q, info.bytes, info.size);
    if (of_solid.upper == 0.0 && of_surface.lower > 0.0)
      assert_string_equal(found.fault, "the curve does not begin outside the mesh");
    asked_free(&q);
  }
  cprox_body_free(surface);
  cprox_body_free(solid);
  mesh_free(&box);
  cprox_certificate_free(c);
  cprox_workspace_free(ws);
}

static void print_large(const char *what, const tally *sum) {
  const double apart = (double)sum->apart;
  print_message(
      "20,000 triangles, %s: %zu apart, %zu near; %.0f bytes, %.1f directions; milliseconds %.2f, with a "
      "certificate %.2f, to check it %.2f\n",
      what, sum->apart, sum->near, (double)sum->bytes / apart, (double)sum->leaves / apart,
      sum->milliseconds[0] / apart, sum->milliseconds[1] / apart, sum->milliseconds[2] / apart);
}

/* 30 curves (seed 7) that come near a closed mesh of 20,000 triangles, some through its hole: what they leave is small,
 * and the checker looks at few triangles more than once. */
CASE(a_large_mesh_leaves_a_small_certificate) {
  rng r = rng_seed(7);
  cprox_workspace *ws = cprox_workspace_create();
  cprox_certificate *c = cprox_certificate_create();
  tally sum = {0}, distances = {0};
  test_mesh torus = mesh_torus(100, 100, 1.0, 0.3, 0.05);
  cprox_body *body = mesh_body(&torus, CPROX_MESH_FILL_SOLID, ws);
  for (size_t i = 0; i < test_cases(30); i++) {
    asked q = {.scale = 1.0, .radius = 0.05, .n = 1};
    const double side = i % 3 == 0 ? 0.3 : 1.0;
    q.mover = (given_curve){.basis = "bezier", .degree = 3, .t1 = 1.0, .n = 4};
    for (int k = 0; k < 4; k++) q.mover.points[k] = vec_add(vec(0, 0, 0.8 * (k - 1.5)), rng_in_cube(&r, 0.3));
    for (int k = 0; k < 4; k++) q.mover.points[k].x *= side, q.mover.points[k].y *= side;
    if (i % 2) q.mover.points[3] = vec(1.6, 0.3, 0.2);
    assert_int_equal(curve_from(describe_bezier(q.mover.points, 4, 0.0, 1.0), ws, &q.mover.curve), CPROX_OK);
    q.targets[0] = cprox_obstacle_at(body, CPROX_POSE_IDENTITY);
    q.mesh[0] = (query_mesh){.body = body, .surface = torus};
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    cprox_result exact;
    ask(&q, -1.0, &options, ws, &exact);
    examine_elements(&q, -1.0, ws, c, &distances);
    examine_elements(&q, 0.9 * exact.lower, ws, c, &sum);
    if (cprox_certificate_get_info(c).size > sum.largest) sum.largest = cprox_certificate_get_info(c).size;
    q.mesh[0] = (query_mesh){.body = NULL};
    asked_free(&q);
  }
  print_large("distance", &distances);
  print_large("tolerance", &sum);
  assert_true(sum.apart > test_cases(10) && distances.apart > test_cases(10) && sum.largest < 20000);
  cprox_body_free(body);
  mesh_free(&torus);
  cprox_certificate_free(c);
  cprox_workspace_free(ws);
}

/* A proof that a curve is near the polytope which a mesh's hull is, held against the query about the mesh. */
CASE(that_a_hull_is_near_proves_nothing_of_its_mesh) {
  rng r = rng_seed(5);
  cprox_workspace *ws = cprox_workspace_create();
  cprox_certificate *c = cprox_certificate_create();
  size_t tried = 0;
  for (size_t i = 0; i < test_cases(100); i++) {
    asked q;
    asked_random(&q, &r, (asked_kinds){.meshes = true}, 1.0, 1.0, ws);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.certificate = c;
    cprox_obstacle lods[QUERY_MAX_TARGETS];
    for (size_t k = 0; k < q.n; k++) {
      lods[k] = q.targets[k];
      if (q.mesh[k].body) q.targets[k].body = q.mesh[k].hull;
    }
    cprox_result by_hull;
    ask(&q, 2.0, &options, ws, &by_hull);
    for (size_t k = 0; k < q.n; k++) q.targets[k] = lods[k];
    if (cprox_certificate_get_info(c).claim == CPROX_CLAIM_NEAR && q.mesh[by_hull.obstacle_index].body) {
      assert_int_equal(asked_check(&q, cprox_certificate_get_info(c).bytes, cprox_certificate_get_info(c).size).claim,
                       CLAIM_NONE);
      tried++;
    }
    asked_free(&q);
  }
  assert_true(tried > test_cases(20));
  cprox_certificate_free(c);
  cprox_workspace_free(ws);
}

/* Segments that begin where planes through vertices of a box meet, on a grid in it: there tetrahedra of vertices have
 * the common point on a face. */
CASE(contact_on_a_plane_through_vertices_is_proven) {
  cprox_workspace *ws = cprox_workspace_create();
  cprox_certificate *c = cprox_certificate_create();
  cprox_vec3 corner[8];
  for (int i = 0; i < 8; i++) corner[i] = vec(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  cprox_body *box = NULL;
  assert_int_equal(cprox_body_create_polytope(corner, 8, ws, &box), CPROX_OK);
  size_t proven = 0;
  for (int i = 0; i < 7 * 7 * 7; i++) {
    asked q = {.scale = 1.0, .radius = 0.0, .n = 1};
    q.mover = (given_curve){.basis = "bezier", .degree = 1, .t1 = 1.0, .n = 2};
    q.mover.points[0] = vec((i % 7 - 3) * 0.25, (i / 7 % 7 - 3) * 0.25, (i / 49 - 3) * 0.25);
    q.mover.points[1] = vec_scale(4.0, q.mover.points[0]);
    assert_int_equal(curve_from(describe_bezier(q.mover.points, 2, 0.0, 1.0), ws, &q.mover.curve), CPROX_OK);
    q.targets[0] = cprox_obstacle_at(box, CPROX_POSE_IDENTITY);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.certificate = c;
    cprox_result r;
    assert_int_equal(ask(&q, 0.0, &options, ws, &r), CPROX_OK);
    assert_int_equal(r.verdict, CPROX_VERDICT_VIOLATED);
    const finding found = asked_check(&q, cprox_certificate_get_info(c).bytes, cprox_certificate_get_info(c).size);
    if (found.fault) fail_msg("%d: refused: %s", i, found.fault);
    proven += found.claim == CLAIM_NEAR && found.delta <= 1e-13;
    cprox_curve_free(q.mover.curve);
  }
  assert_int_equal(proven, 7 * 7 * 7);
  cprox_body_free(box);
  cprox_certificate_free(c);
  cprox_workspace_free(ws);
}

/* ---- work ---- */

/* The numbers of a query: points of both curves, vertices, and what every target takes. */
static double numbers_of(const asked *q) {
  double numbers = (double)(q->mover.n + q->mover.n_knots + q->target_curve.n + q->target_curve.n_knots);
  for (size_t i = 0; i < q->n; i++) numbers += 16.0 + (double)cprox_obstacle_describe(&q->targets[i], NULL, 0) / 20.0;
  return numbers;
}

/* Products of 640 bits that a number of the certificate may cost with each number of the query. */
#define DEAR 200.0

/* By intervals alone. */
static finding check_by_intervals(const asked *q, const bytes *b) {
  quick_use(false);
  const finding found = asked_check(q, b->at, b->n);
  quick_use(true);
  return found;
}

/* 60 queries of every basis and kind (seed 6), each with its certificate tampered with 25 times: what the checker does
 * is bounded by the bytes of the certificate and the size of the query, and to refuse one takes no more than to accept
 * it by intervals alone. Doubles change no finding. In products of words, so that it is no matter of the machine. */
CASE(what_a_check_takes_is_bounded_by_what_it_is_given) {
  static bytes genuine, other, mutant;
  rng r = rng_seed(6);
  cprox_workspace *ws = cprox_workspace_create();
  cprox_certificate *c = cprox_certificate_create();
  double dearest = 0.0, most = 0.0;
  for (size_t i = 0; i < test_cases(60); i++) {
    asked q;
    asked_random(&q, &r, (asked_kinds){.curve_target = i % 3 == 0, .meshes = i % 3 == 1}, 1.0, 1.0, ws);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.certificate = c;
    cprox_result result;
    ask(&q, -1.0, &options, ws, &result);
    genuine.n = cprox_certificate_get_info(c).size;
    if (genuine.n > 0 && genuine.n + 16 < MOST_BYTES) {
      memcpy(genuine.at, cprox_certificate_get_info(c).bytes, genuine.n);
      const finding accepted = check_by_intervals(&q, &genuine);
      assert_null(accepted.fault);
      assert_null(asked_check(&q, genuine.at, genuine.n).fault);
      for (int k = 0; k < MUTANTS; k++) {
        mutant = genuine;
        tamper(&mutant, &r, other.n > 0 ? &other : &genuine);
        const finding found = asked_check(&q, mutant.at, mutant.n), slowly = check_by_intervals(&q, &mutant);
        assert_int_equal(found.claim, slowly.claim);
        assert_true(found.work <= slowly.work);
        const double given = (double)(mutant.n + 8) / 8.0 * numbers_of(&q);
        dearest = fmax(dearest, found.work / 100.0 / given);
        if (found.fault && strcmp(found.fault, "it is about another kind of target") != 0)
          most = fmax(most, found.work / accepted.work);
      }
      other = genuine;
    }
    asked_free(&q);
  }
  print_message("work: %.3g products a number of both, a mutant %.3g times what the genuine one took\n", dearest, most);
  assert_true(dearest < DEAR && most < 3.0);
  cprox_certificate_free(c);
  cprox_workspace_free(ws);
}

int main(void) {
  return cases_run(NULL, NULL);
}
