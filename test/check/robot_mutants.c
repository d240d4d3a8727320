/* SPDX-License-Identifier: BSD-3-Clause */
/* robot_mutants QUERIES MUTANTS SEED [FOLDER]: random robots in motion with genuine certificates and tampered ones, and
 * with genuine ones held against a query that was changed: a target nearer, a motion that goes farther. Genuine ones
 * must be accepted, and of all that is accepted the claim must be true: the distance, known within 1e-9 m, must not
 * contradict it. Where a folder is given, query i becomes i.problem and i.certificates there, for other checkers to be
 * tried on: the genuine one and the tampered ones. */
#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/mutants.h"
#include "support/of_list.h"
#include "support/robot_queries.h"
#include "support/tampering.h"

/* The distance of a query, and a certificate of it or of a verdict about it; false where there is none. */
static bool ask(const robot_query *q, rng *r, cprox_workspace *ws, cprox_certificate *c, double interval[2],
                bytes *genuine) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-9;
  cprox_result result;
  if (distance_of_list(q->mover, q->targets, q->n, &options, ws, &result, NULL) < 0) return false;
  interval[0] = result.lower, interval[1] = result.upper;
  if (!genuine || !isfinite(result.upper)) return isfinite(result.upper);
  const double delta = rng_index(r, 3) ? result.upper * rng_uniform(r, 0.3, 1.2) : fmax(result.lower - 1e-6, 0.0);
  if (tolerance_of_list(q->mover, q->targets, q->n, delta, &options, ws, &result, NULL) < 0) return false;
  if (certify_of_list(q->mover, q->targets, q->n, delta, &result, &options, ws, c) != CPROX_OK) return false;
  genuine->n = cprox_certificate_get_info(c).size;
  if (genuine->n == 0 || genuine->n + 16 > MOST_BYTES) return false;
  memset(genuine->at, 0, sizeof genuine->at);
  memcpy(genuine->at, cprox_certificate_get_info(c).bytes, genuine->n);
  return true;
}

/* Every interval takes two bytes at least, and on every interval each item is tried with two directions at most, by its
 * box and by its vertices. The head of a genuine certificate has the number of pairs; a cut of an item into two takes
 * ten bytes. */
static bool is_bounded(const bytes *genuine, size_t size, const finding *found) {
  uint32_t pairs;
  memcpy(&pairs, genuine->at + HEAD - sizeof pairs, sizeof pairs);
  return found->leaves <= 4 * (pairs + size / 5) * (size / 2 + 1);
}

/* Targets come nearer by up to a tenth, or the motion goes farther by up to a third. */
static void change(robot_query *q, rng *r, cprox_workspace *ws) {
  if (q->n > 0 && rng_index(r, 2)) {
    for (size_t i = 0; i < q->n; i++)
      q->targets[i].pose.position = vec_scale(1.0 - rng_log_uniform(r, 1e-6, 0.1), q->targets[i].pose.position);
    return;
  }
  test_robot *t = &q->robot;
  const double more = 1.0 + rng_log_uniform(r, 1e-6, 0.3);
  for (size_t i = 1; i < t->n_points; i++)
    for (size_t k = 0; k < t->n_variables; k++)
      t->positions[i][k] = t->positions[0][k] + more * (t->positions[i][k] - t->positions[0][k]);
  robot_rebuild(t);
  robot_query_renew(q, ws);
}

/* The files of a query, NULL where none are wanted. */
typedef struct files {
  FILE *problem, *certificates;
} files;

static files open_files(const char *folder, size_t i, const robot_query *q) {
  files f = {NULL, NULL};
  if (!folder) return f;
  char path[512];
  snprintf(path, sizeof path, "%s/%zu.problem", folder, i);
  f.problem = fopen(path, "w");
  snprintf(path, sizeof path, "%s/%zu.certificates", folder, i);
  f.certificates = fopen(path, "wb");
  if (!f.problem || !f.certificates) {
    fprintf(stderr, "robot_mutants: %s cannot be written\n", path);
    exit(2);
  }
  robot_write_targets(q->targets, q->n, f.problem);
  return f;
}

static void write_record(const files *f, const robot_query *q, const bytes *b, cprox_workspace *ws) {
  if (!f->problem) return;
  robot_write_mover(&q->mover, q->targets, q->n, "robot", ws, f->problem);
  tampering_write(f->certificates, b);
}

static void try_query(robot_query *q, size_t number, size_t mutants, rng *r, cprox_workspace *ws, const bytes *genuine,
                      const bytes *other, const double interval[2], const files *f, mutants_tally *sum) {
  static bytes mutant;
  robot_text text = robot_text_of(&q->mover, q->targets, q->n, ws);
  for (size_t k = 0; k <= mutants; k++) {
    mutant = *genuine;
    const char *done = k == 0 ? "genuine" : tamper(&mutant, r, other);
    const finding found = robot_text_check(&text, mutant.at, mutant.n);
    mutants_judge(&found, is_bounded(genuine, mutant.n, &found), interval, done, number, sum);
    write_record(f, q, &mutant, ws);
  }
  robot_text_free(&text);
  for (size_t k = 0; k < mutants / 4; k++) {
    double changed[2];
    change(q, r, ws);
    if (!ask(q, r, ws, NULL, changed, NULL)) continue;
    text = robot_text_of(&q->mover, q->targets, q->n, ws);
    const finding found = robot_text_check(&text, genuine->at, genuine->n);
    mutants_judge(&found, is_bounded(genuine, genuine->n, &found), changed, "changed query", number, sum);
    robot_text_free(&text);
  }
}

int main(int argc, char **argv) {
  if (argc != 4 && argc != 5) {
    fputs("usage: robot_mutants QUERIES MUTANTS SEED [FOLDER]\n", stderr);
    return 2;
  }
  const size_t queries = strtoul(argv[1], NULL, 10), mutants = strtoul(argv[2], NULL, 10);
  rng r = rng_seed(strtoumax(argv[3], NULL, 10));
  cprox_workspace *ws = cprox_workspace_create();
  cprox_certificate *c = cprox_certificate_create();
  static bytes genuine, other;
  mutants_tally sum = {0};
  for (size_t i = 0; i < queries;) {
    robot_query q;
    robot_query_random(&q, &r, rng_log_uniform(&r, 0.02, 1.0), rng_uniform(&r, 0.5, 3.0), i % 3 == 2, ws);
    if (i % 4 == 3) robot_query_fly(&q, &r, ws);
    if (argc == 4) { /* the program in Python knows neither */
      if (i % 3 == 1) robot_query_inequalities(&q, &r, ws);
      robot_query_whole(&q, &r);
    }
    double interval[2];
    if (ask(&q, &r, ws, c, interval, &genuine)) {
      const files f = open_files(argc == 5 ? argv[4] : NULL, i, &q);
      try_query(&q, i++, mutants, &r, ws, &genuine, other.n ? &other : &genuine, interval, &f, &sum);
      if (f.problem) fclose(f.problem), fclose(f.certificates);
      other = genuine;
    }
    robot_query_free(&q);
  }
  cprox_certificate_free(c);
  cprox_workspace_free(ws);
  return mutants_report("robots", &sum);
}
