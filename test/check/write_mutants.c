/* SPDX-License-Identifier: BSD-3-Clause */
/* write_mutants FOLDER QUERIES MUTANTS SEED: random queries with genuine certificates and tampered ones, for checkers
 * to be tried on. Query i becomes i.problem, i.certificates and i.truth: a line a certificate, "genuine" or what was
 * done to it, and the interval that the distance lies in. */
#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/of_list.h"
#include "support/queries.h"
#include "support/tampering.h"

static FILE *open_file(const char *folder, size_t i, const char *what) {
  char path[512];
  snprintf(path, sizeof path, "%s/%zu.%s", folder, i, what);
  FILE *file = fopen(path, "wb");
  if (!file) {
    fprintf(stderr, "write_mutants: %s cannot be written\n", path);
    exit(2);
  }
  return file;
}

/* A distance, or a tolerance below or above it; false where there is no certificate. */
static bool ask(const asked *q, rng *r, cprox_workspace *ws, cprox_certificate *c, double interval[2], bytes *genuine) {
  const cprox_mover along = cprox_tube_along(q->mover.curve, q->radius);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-12 * q->scale;
  options.certificate = c;
  cprox_result result;
  if (distance_of_list(along, q->targets, q->n, &options, ws, &result, NULL) < 0) return false;
  interval[0] = result.lower;
  interval[1] = result.upper;
  if (rng_index(r, 2)) {
    const double delta = result.lower * rng_uniform(r, 0.3, 1.3);
    if (tolerance_of_list(along, q->targets, q->n, delta, &options, ws, &result, NULL) < 0) return false;
  }
  genuine->n = cprox_certificate_get_info(c).size;
  if (genuine->n == 0 || genuine->n + 16 > MOST_BYTES) return false;
  memset(genuine->at, 0, sizeof genuine->at);
  memcpy(genuine->at, cprox_certificate_get_info(c).bytes, genuine->n);
  return true;
}

/* The time of contact; false where there is no certificate, or nothing is before it. */
static bool ask_contact(asked *q, rng *r, cprox_workspace *ws, cprox_certificate *c, double interval[2],
                        bytes *genuine) {
  for (size_t k = 0; k < q->n; k++) /* on the way, at some time */
    q->targets[k].pose.position = vec_add(q->mover.points[q->mover.n / 2], rng_in_cube(r, 0.4 * q->scale));
  const cprox_mover along = cprox_tube_along(q->mover.curve, q->radius);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-6 * q->scale;
  cprox_result result;
  cprox_obstacles *all = NULL;
  if (cprox_obstacles_create(q->targets, q->n, CPROX_INDEX_NONE, ws, &all) != CPROX_OK) return false;
  const cprox_status met = cprox_obstacles_time_of_contact(all, along, &options, ws, &result);
  const cprox_status status = met < 0 ? met : cprox_certify_contact(along, all, &result, &options, ws, c);
  cprox_obstacles_free(all);
  if (status != CPROX_OK || result.verdict == CPROX_VERDICT_CLEAR) return false;
  interval[0] = 0.0, interval[1] = result.upper;
  genuine->n = cprox_certificate_get_info(c).size;
  if (genuine->n + 16 > MOST_BYTES) return false;
  memset(genuine->at, 0, sizeof genuine->at);
  memcpy(genuine->at, cprox_certificate_get_info(c).bytes, genuine->n);
  return true;
}

static void write_query(const asked *q, const char *folder, size_t i, size_t mutants, rng *r, const bytes *genuine,
                        const bytes *other, const double interval[2]) {
  static bytes mutant;
  FILE *text = open_file(folder, i, "problem"), *file = open_file(folder, i, "certificates");
  FILE *truth = open_file(folder, i, "truth");
  asked_write_targets(q, text);
  for (size_t k = 0; k <= mutants; k++) {
    char id[32];
    snprintf(id, sizeof id, "%zu", k);
    asked_write_mover(q, id, text);
    mutant = *genuine;
    const char *done = k == 0 ? "genuine" : tamper(&mutant, r, other);
    fprintf(truth, "%a %a %s\n", interval[0], interval[1], done);
    tampering_write(file, &mutant);
  }
  fclose(text);
  fclose(file);
  fclose(truth);
}

int main(int argc, char **argv) {
  if (argc != 5) {
    fputs("usage: write_mutants FOLDER QUERIES MUTANTS SEED\n", stderr);
    return 2;
  }
  const size_t queries = strtoul(argv[2], NULL, 10), mutants = strtoul(argv[3], NULL, 10);
  rng r = rng_seed(strtoumax(argv[4], NULL, 10));
  cprox_workspace *ws = cprox_workspace_create();
  cprox_certificate *c = cprox_certificate_create();
  static bytes genuine, other;
  for (size_t i = 0; i < queries;) {
    asked q;
    const asked_kinds kinds = {.bezier_only = rng_index(&r, 2) == 0,
                               .polytope_only = rng_index(&r, 3) == 0,
                               .curve_target = rng_index(&r, 4) == 0,
                               .meshes = rng_index(&r, 3) == 0,
                               .elements = true};
    asked_random(&q, &r, kinds, rng_log_uniform(&r, 1e-2, 1e2), rng_log_uniform(&r, 1e-2, 1e4), ws);
    double interval[2];
    const bool certified =
        i % 4 == 3 ? ask_contact(&q, &r, ws, c, interval, &genuine) : ask(&q, &r, ws, c, interval, &genuine);
    if (certified) {
      write_query(&q, argv[1], i++, mutants, &r, &genuine, other.n ? &other : &genuine, interval);
      other = genuine;
    }
    asked_free(&q);
  }
  cprox_certificate_free(c);
  cprox_workspace_free(ws);
  return 0;
}
