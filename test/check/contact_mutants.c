/* SPDX-License-Identifier: BSD-3-Clause */
/* contact_mutants QUERIES MUTANTS SEED: random curves and robots that meet something, with genuine certificates of the
 * time of contact and of parts of the parameter range, and tampered ones. Judged by the time of contact with targets
 * that are larger by the limit that was accepted, and by the clearance on the part. */
#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/make_curve.h"
#include "support/of_list.h"
#include "support/queries.h"
#include "support/robot_queries.h"
#include "support/tampering.h"

enum { MOST_TARGETS = ROBOT_QUERY_TARGETS };

/* What moves and what stands. */
typedef struct subject {
  cprox_mover mover;
  cprox_obstacle *targets;
  size_t n;
  problem *read;               /* as the checker has it */
  double scale, begin, length; /* [m]; of the parameter's range */
} subject;

typedef struct tally {
  size_t genuine, meets, parts, none, tampered, accepted, failed;
  double bytes, late; /* sums: of genuine ones; how much earlier than the answer they end, of the parameter's length */
} tally;

static const double TOLERANCE = 1e-9;

/* The first time at which something is as near as delta: [0] nothing is before it, [1] it is then; INFINITY: never or
 * not known. The distance over all times: [0] at least, [1] at most. */
typedef struct truth {
  double time[2], distance[2];
} truth;

static bool know(const subject *s, double delta, cprox_workspace *ws, truth *out) {
  cprox_obstacle larger[MOST_TARGETS];
  for (size_t i = 0; i < s->n; i++) {
    larger[i] = s->targets[i];
    larger[i].margin += delta;
  }
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-10 * s->scale;
  cprox_result r;
  if (time_of_contact_of_list(s->mover, larger, s->n, &options, ws, &r) < 0) return false;
  const bool met = r.verdict == CPROX_VERDICT_VIOLATED;
  out->time[0] = r.verdict == CPROX_VERDICT_CLEAR ? INFINITY : r.t_contact_lower;
  out->time[1] = met ? r.t : INFINITY;
  if (distance_of_list(s->mover, s->targets, s->n, &options, ws, &r, NULL) < 0) return false;
  out->distance[0] = r.lower, out->distance[1] = r.upper;
  return true;
}

/* The distance between two parameters: at least, at most. */
static bool know_part(const subject *s, const double part[2], cprox_workspace *ws, cprox_profile_interval *out) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-10 * s->scale;
  cprox_obstacles *all = NULL;
  if (cprox_obstacles_create(s->targets, s->n, CPROX_INDEX_NONE, ws, &all) != CPROX_OK) return false;
  const cprox_status status = cprox_obstacles_profile(all, s->mover, part, 1, INFINITY, &options, ws, out);
  cprox_obstacles_free(all);
  return status >= 0;
}

/* What an accepted claim says must be so. */
static bool is_true(const subject *s, const finding *found, cprox_workspace *ws) {
  const double room = TOLERANCE * s->scale, later = TOLERANCE * s->length;
  truth t;
  if (found->claim == CLAIM_NONE) return true;
  const double most = 1e3 * s->scale; /* the reach of all queries */
  if (found->claim == CLAIM_DURING) {
    const double part[2] = {found->from, found->until};
    cprox_profile_interval known;
    if (!(part[0] < part[1])) return true;
    return know_part(s, part, ws, &known) && found->delta < known.upper + room;
  }
  if (found->claim == CLAIM_NEAR && found->delta > most) return true;
  if (found->delta > most || !know(s, found->delta, ws, &t)) return false;
  if (found->claim == CLAIM_APART) return found->delta < t.distance[1] + room;
  if (found->claim == CLAIM_NEAR) return found->delta >= t.distance[0] - room;
  if (found->until > t.time[1] + later) return false;
  if (!found->meets || found->meets_delta > most) return true;
  return know(s, found->meets_delta, ws, &t) && found->meets_by >= t.time[0] - later;
}

static void judge(const subject *s, const finding *found, const char *done, size_t number, cprox_workspace *ws,
                  tally *sum) {
  const bool genuine = strcmp(done, "genuine") == 0, proven = found->claim != CLAIM_NONE;
  sum->genuine += genuine, sum->tampered += !genuine, sum->accepted += !genuine && proven;
  if (genuine && !proven) {
    printf("FAILED query %zu: a genuine certificate was refused: %s\n", number, found->fault);
    sum->failed++;
  } else if (!is_true(s, found, ws)) {
    printf("FAILED query %zu (%s): %g m until %.17g was accepted (claim %d, meets %d: %g m by %.17g)\n", number, done,
           found->delta, found->until, (int)found->claim, found->meets, found->meets_delta, found->meets_by);
    sum->failed++;
  }
}

/* The first of its numbers, where what is claimed ends, or begins and ends. */
static const char *tamper_end(bytes *b, const subject *s, rng *r) {
  size_t place = s->mover.motion ? HEAD + 4 : HEAD;
  if (b->at[16] == CLAIM_DURING && rng_uniform(r, 0.0, 1.0) < 0.5) place += s->mover.motion ? 12 : 8;
  double end;
  memcpy(&end, b->at + place, sizeof end);
  end *= 1.0 + (rng_uniform(r, 0.0, 1.0) < 0.7 ? 1.0 : -1.0) * rng_log_uniform(r, 1e-12, 0.5);
  memcpy(b->at + place, &end, sizeof end);
  return "later";
}

/* A certificate of the time of contact; false where there is none. */
static bool ask(const subject *s, cprox_workspace *ws, cprox_certificate *c, bytes *genuine, tally *sum) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-6 * s->scale;
  cprox_result r;
  if (time_of_contact_of_list(s->mover, s->targets, s->n, &options, ws, &r) < 0) return false;
  cprox_obstacles *all = NULL;
  if (cprox_obstacles_create(s->targets, s->n, CPROX_INDEX_NONE, ws, &all) != CPROX_OK) return false;
  const cprox_status status = cprox_certify_contact(s->mover, all, &r, &options, ws, c);
  cprox_obstacles_free(all);
  const cprox_certificate_info info = cprox_certificate_get_info(c);
  if (r.verdict == CPROX_VERDICT_CLEAR) return false; /* a claim about all times: others try these */
  if (status != CPROX_OK) {
    sum->none += r.t_contact_lower > s->begin;
    return false;
  }
  if (info.size + 16 > MOST_BYTES) return false;
  genuine->n = info.size;
  memset(genuine->at, 0, sizeof genuine->at);
  memcpy(genuine->at, info.bytes, info.size);
  const finding found = check(s->read, genuine->at, genuine->n);
  if (found.claim != CLAIM_BEFORE) {
    printf("FAILED: a genuine certificate was refused: %s\n", found.fault ? found.fault : "another claim");
    sum->failed++;
    return false;
  }
  sum->meets += found.meets;
  sum->bytes += (double)info.size;
  sum->late += (r.t_contact_lower - found.until) / s->length;
  return true;
}

/* A certificate of a part of the range; false where there is none. Half claim the distance there, as a profile does,
 * and half less. */
static bool ask_part(const subject *s, size_t number, rng *r, cprox_workspace *ws, cprox_certificate *c, bytes *genuine,
                     tally *sum) {
  const double a = rng_uniform(r, 0.0, 1.0), b = rng_uniform(r, 0.0, 1.0);
  const double part[2] = {s->begin + fmin(a, b) * s->length, s->begin + fmax(a, b) * s->length};
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  cprox_profile_interval known;
  if (!(part[1] - part[0] > 0.01 * s->length) || !know_part(s, part, ws, &known) || !(known.lower > 0.0)) return false;
  cprox_obstacles *all = NULL;
  if (cprox_obstacles_create(s->targets, s->n, CPROX_INDEX_NONE, ws, &all) != CPROX_OK) return false;
  options.epsilon = 1e-6 * s->scale;
  options.interval = part;
  const bool distance = number % 4 < 2;
  const double delta = distance ? known.lower : (1.0 - rng_log_uniform(r, 1e-6, 1.0)) * known.lower;
  const cprox_result answer = {.verdict = CPROX_VERDICT_UNDECIDED,
                               .lower = known.lower,
                               .upper = known.upper,
                               .t = known.t,
                               .obstacle_index = -1,
                               .mover_part = -1};
  const cprox_status status = cprox_certify(s->mover, all, delta, distance ? &answer : NULL, &options, ws, c);
  cprox_obstacles_free(all);
  const cprox_certificate_info info = cprox_certificate_get_info(c);
  sum->none += status != CPROX_OK;
  if (status != CPROX_OK || info.size + 16 > MOST_BYTES) return false;
  genuine->n = info.size;
  memset(genuine->at, 0, sizeof genuine->at);
  memcpy(genuine->at, info.bytes, info.size);
  const finding found = check(s->read, genuine->at, genuine->n);
  const double lost = fmax(found.from - part[0], part[1] - found.until) / s->length;
  if (found.claim != CLAIM_DURING || lost > 1e-3) {
    printf("FAILED: a genuine certificate of a part was refused: %s, %g of the range is left out\n",
           found.fault ? found.fault : "no", lost);
    sum->failed++;
    return false;
  }
  sum->parts++;
  sum->bytes += (double)info.size;
  return true;
}

/* False where there is nothing to try. */
static bool try_subject(const subject *s, size_t number, size_t mutants, rng *r, cprox_workspace *ws,
                        cprox_certificate *c, bytes *other, tally *sum) {
  static bytes genuine, mutant;
  const bool whole = number % 2 == 0;
  if (!(whole ? ask(s, ws, c, &genuine, sum) : ask_part(s, number, r, ws, c, &genuine, sum))) return false;
  if (other->n == 0) *other = genuine;
  for (size_t k = 0; k <= mutants; k++) {
    mutant = genuine;
    const char *done = k == 0 ? "genuine" : k % 4 == 0 ? tamper_end(&mutant, s, r) : tamper(&mutant, r, other);
    const finding found = check(s->read, mutant.at, mutant.n);
    judge(s, &found, done, number, ws, sum);
  }
  *other = genuine;
  return true;
}

static bool try_curve(rng *r, size_t number, size_t mutants, cprox_workspace *ws, cprox_certificate *c, bytes *other,
                      tally *sum) {
  asked q;
  asked_random(&q, r, (asked_kinds){.meshes = number % 2 == 0, .elements = true, .bezier_only = number % 4 < 2}, 1.0,
               1.0, ws);
  for (size_t k = 0; k < q.n; k++) /* on the way, at some time */
    q.targets[k].pose.position = vec_add(q.mover.points[q.mover.n / 2], rng_in_cube(r, 0.4));
  asked_text text = asked_text_of(&q);
  const subject s = {.mover = cprox_tube_along(q.mover.curve, q.radius),
                     .targets = q.targets,
                     .n = q.n,
                     .read = &text.read,
                     .scale = q.scale,
                     .begin = q.mover.t0,
                     .length = q.mover.t1 - q.mover.t0};
  const bool tried = try_subject(&s, number, mutants, r, ws, c, other, sum);
  asked_text_free(&text);
  asked_free(&q);
  return tried;
}

static bool try_robot(rng *r, size_t number, size_t mutants, cprox_workspace *ws, cprox_certificate *c, bytes *other,
                      tally *sum) {
  robot_query q;
  robot_query_random(&q, r, rng_log_uniform(r, 0.1, 1.0), rng_uniform(r, 0.3, 1.5), false, ws);
  robot_text text = robot_text_of(&q.mover, q.targets, q.n, ws);
  const cprox_motion_info info = cprox_motion_get_info(q.mover.motion);
  const subject s = {.mover = q.mover,
                     .targets = q.targets,
                     .n = q.n,
                     .read = &text.read,
                     .scale = 1.0,
                     .begin = info.t0,
                     .length = info.t1 - info.t0};
  const bool tried = try_subject(&s, number, mutants, r, ws, c, other, sum);
  robot_text_free(&text);
  robot_query_free(&q);
  return tried;
}

int main(int argc, char **argv) {
  if (argc != 4) {
    fputs("usage: contact_mutants QUERIES MUTANTS SEED\n", stderr);
    return 2;
  }
  const size_t queries = strtoul(argv[1], NULL, 10), mutants = strtoul(argv[2], NULL, 10);
  rng r = rng_seed(strtoumax(argv[3], NULL, 10));
  cprox_workspace *ws = cprox_workspace_create();
  cprox_certificate *c = cprox_certificate_create();
  static bytes others[2];
  int failed = 0;
  for (int robots = 0; robots < 2; robots++) {
    tally sum = {0};
    for (size_t i = 0; i < queries;)
      i += robots ? try_robot(&r, i, mutants, ws, c, &others[1], &sum)
                  : try_curve(&r, i, mutants, ws, c, &others[0], &sum);
    printf(
        "%s: %zu genuine certificates (%.0f bytes, %zu with contact, ending %.1e of the range before the answer; %zu "
        "of parts), "
        "%zu without; %zu mutants, of which %zu prove something true\n",
        robots ? "robots" : "curves", sum.genuine, sum.bytes / (double)sum.genuine, sum.meets,
        sum.late / (double)sum.genuine, sum.parts, sum.none, sum.tampered, sum.accepted);
    printf("%zu passed, %zu failed\n", sum.genuine + sum.tampered - sum.failed, sum.failed);
    failed |= sum.failed > 0;
  }
  cprox_certificate_free(c);
  cprox_workspace_free(ws);
  return failed;
}
