/* SPDX-License-Identifier: BSD-3-Clause */
/* curve_mutants QUERIES MUTANTS SEED: random curves beside meshes, points, cells, convex bodies and bodies by inequalities with genuine
 * certificates and tampered ones, and with genuine ones held against targets that came nearer. Judged by the distance,
 * known within 1e-12 of the sizes. */
#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/make_curve.h"
#include "support/mutants.h"
#include "support/of_list.h"
#include "support/queries.h"
#include "support/tampering.h"

/* Checking may try no more directions than there are bytes. */
static bool is_bounded(size_t size, const finding *found) {
  return found->leaves <= size / 13 + 1;
}

static bool distance(const asked *q, cprox_options options, cprox_workspace *ws, double interval[2]) {
  cprox_result result;
  options.certificate = NULL;
  if (distance_of_list(asked_mover(q), q->targets, q->n, &options, ws, &result, NULL) < 0) return false;
  interval[0] = result.lower, interval[1] = result.upper;
  return isfinite(result.upper);
}

/* A certificate of the distance, or of a tolerance below or above it; false where there is none. */
static bool ask(const asked *q, rng *r, cprox_workspace *ws, cprox_certificate *c, double interval[2], bytes *genuine) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-12 * q->scale;
  if (!distance(q, options, ws, interval)) return false;
  const cprox_mover along = asked_mover(q);
  cprox_result result;
  options.certificate = c;
  const double delta = interval[0] > 0.0 ? interval[0] * rng_uniform(r, 0.3, 1.3) : rng_uniform(r, 0.0, 0.1);
  const cprox_status status = rng_index(r, 4)
                                  ? tolerance_of_list(along, q->targets, q->n, delta, &options, ws, &result, NULL)
                                  : distance_of_list(along, q->targets, q->n, &options, ws, &result, NULL);
  genuine->n = cprox_certificate_get_info(c).size;
  if (status < 0 || genuine->n == 0 || genuine->n + 16 > MOST_BYTES) return false;
  memset(genuine->at, 0, sizeof genuine->at);
  memcpy(genuine->at, cprox_certificate_get_info(c).bytes, genuine->n);
  return true;
}

/* Targets come nearer to the curve's first point. */
static void move(asked *q, rng *r) {
  const double by = rng_log_uniform(r, 1e-6, 1.0);
  for (size_t i = 0; i < q->n; i++)
    q->targets[i].pose.position = vec_lerp(q->targets[i].pose.position, q->mover.points[0], by);
}

static void try_query(asked *q, size_t number, size_t mutants, rng *r, cprox_workspace *ws, const bytes *genuine,
                      const bytes *other, const double interval[2], mutants_tally *sum) {
  static bytes mutant;
  asked_text text = asked_text_of(q);
  for (size_t k = 0; k <= mutants; k++) {
    mutant = *genuine;
    const char *done = k == 0 ? "genuine" : tamper(&mutant, r, other);
    const finding found = check(&text.read, mutant.at, mutant.n);
    mutants_judge(&found, is_bounded(mutant.n, &found), interval, done, number, sum);
  }
  asked_text_free(&text);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-9 * q->scale;
  for (size_t k = 0; k < mutants / 4; k++) {
    double changed[2];
    move(q, r);
    if (!distance(q, options, ws, changed)) continue;
    const finding found = asked_check(q, genuine->at, genuine->n);
    mutants_judge(&found, is_bounded(genuine->n, &found), changed, "changed query", number, sum);
  }
}

int main(int argc, char **argv) {
  if (argc != 4) {
    fputs("usage: curve_mutants QUERIES MUTANTS SEED\n", stderr);
    return 2;
  }
  const size_t queries = strtoul(argv[1], NULL, 10), mutants = strtoul(argv[2], NULL, 10);
  rng r = rng_seed(strtoumax(argv[3], NULL, 10));
  cprox_workspace *ws = cprox_workspace_create();
  cprox_certificate *c = cprox_certificate_create();
  static bytes genuine, other;
  mutants_tally sum = {0};
  for (size_t i = 0; i < queries;) {
    asked q;
    asked_kinds kinds = {.meshes = i % 5 > 1, .elements = true, .implicit = true, .bezier_only = i % 2 == 0};
    if (i % 5 == 0) kinds = (asked_kinds){.clock = true, .bezier_only = i % 2 == 0};
    if (i % 5 == 1 && i % 2) kinds = (asked_kinds){.carried = true};
    asked_random(&q, &r, kinds, 1.0, 1.0, ws);
    for (size_t k = 0; k < q.n && i % 3 == 0; k++)
      q.targets[k].pose.position = vec_add(q.mover.points[0], rng_in_cube(&r, 0.3));
    double interval[2];
    if (ask(&q, &r, ws, c, interval, &genuine)) {
      try_query(&q, i++, mutants, &r, ws, &genuine, other.n ? &other : &genuine, interval, &sum);
      other = genuine;
    }
    asked_free(&q);
  }
  cprox_certificate_free(c);
  cprox_workspace_free(ws);
  return mutants_report("curves", &sum);
}
