/* SPDX-License-Identifier: BSD-3-Clause */
/* The checker as a library: one problem and one certificate in memory, by any number of threads. */
#include <gmp.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "interval.h"
#include "prove.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/of_list.h"
#include "support/queries.h"
#include "support/robot_queries.h"

enum { THREADS = 4, QUERIES = 30, MOST = 65536 };

/* A random query that is apart, its text, and a certificate of it. */
typedef struct sample {
  char *text;
  size_t length, size;
  unsigned char bytes[MOST];
  double delta;
} sample;

static char *text_of(const asked *q, int movers, size_t *length) {
  char *text = NULL;
  FILE *out = open_memstream(&text, length);
  asked_write_targets(q, out);
  for (int i = 0; i < movers; i++) asked_write_mover(q, "curve", out);
  fclose(out);
  return text;
}

static bool make_sample(rng *r, int movers, cprox_workspace *ws, sample *out) {
  asked q;
  asked_random(&q, r, (asked_kinds){.elements = true}, 1.0, 2.0, ws);
  cprox_certificate *c = cprox_certificate_create();
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.certificate = c;
  cprox_result result;
  const cprox_mover along = cprox_tube_along(q.mover.curve, q.radius);
  const bool asked_well = distance_of_list(along, q.targets, q.n, &options, ws, &result, NULL) >= 0;
  const cprox_certificate_info info = cprox_certificate_get_info(c);
  const bool apart = asked_well && info.claim == CPROX_CLAIM_APART && info.size <= MOST;
  if (apart) {
    memcpy(out->bytes, info.bytes, info.size);
    out->size = info.size;
    out->delta = info.delta;
    out->text = text_of(&q, movers, &out->length);
  }
  cprox_certificate_free(c);
  asked_free(&q);
  return apart;
}

static sample *next_sample(rng *r, int movers, cprox_workspace *ws) {
  static sample made;
  while (!make_sample(r, movers, ws, &made)) {
  }
  return &made;
}

/* Seed 1. */
CASE(a_certificate_in_memory_proves_what_it_claims) {
  rng r = rng_seed(1);
  cprox_workspace *ws = cprox_workspace_create();
  for (int i = 0; i < QUERIES; i++) {
    const sample *s = next_sample(&r, 1, ws);
    const proof found = prove(s->text, s->length, s->bytes, s->size);
    if (!found.apart) fail_msg("refused: %s", found.fault);
    assert_true(found.delta == s->delta && !found.near && found.fault[0] == 0);
    free(s->text);
  }
  cprox_workspace_free(ws);
}

/* Seed 2. */
CASE(what_is_cut_off_or_about_another_query_proves_nothing) {
  rng r = rng_seed(2);
  cprox_workspace *ws = cprox_workspace_create();
  for (int i = 0; i < QUERIES; i++) {
    const sample *s = next_sample(&r, 1, ws);
    for (size_t size = 0; size < s->size; size += 1 + s->size / 20) {
      const proof cut = prove(s->text, s->length, s->bytes, size);
      assert_true(!cut.apart && !cut.near && cut.fault[0] != 0);
    }
    sample other = *s;
    other.bytes[3] = '2';
    assert_string_equal(prove(s->text, s->length, other.bytes, s->size).fault,
                        "it is a certificate of a later version");
    memset(other.bytes, 'x', other.size);
    assert_string_equal(prove(s->text, s->length, other.bytes, s->size).fault, "it is no certificate");
    for (size_t length = 0; length < s->length - 1; length += 1 + s->length / 20) {
      const proof cut = prove(s->text, length, s->bytes, s->size);
      assert_true(!cut.apart || cut.delta == s->delta); /* the last number may have lost digits that are 0 */
      assert_true(cut.apart == (cut.fault[0] == 0));
    }
    free(s->text);
  }
  const sample *two = next_sample(&r, 2, ws);
  const proof found = prove(two->text, two->length, two->bytes, two->size);
  assert_false(found.apart);
  assert_string_equal(found.fault, "the problem has more than one mover");
  free(two->text);
  cprox_workspace_free(ws);
}

static void *check_often(void *data) {
  const sample *s = data;
  size_t *good = calloc(1, sizeof *good);
  for (int i = 0; i < QUERIES; i++) {
    const proof found = prove(s->text, s->length, s->bytes, s->size);
    *good += found.apart && found.delta == s->delta;
  }
  return good;
}

/* Seeds from 3 on: a query a thread. */
CASE(threads_check_at_the_same_time) {
  static sample samples[THREADS];
  pthread_t threads[THREADS];
  cprox_workspace *ws = cprox_workspace_create();
  for (unsigned k = 0; k < THREADS; k++) {
    rng r = rng_seed(3 + k);
    while (!make_sample(&r, 1, ws, &samples[k])) {
    }
  }
  for (int k = 0; k < THREADS; k++) assert_int_equal(pthread_create(&threads[k], NULL, check_often, &samples[k]), 0);
  for (int k = 0; k < THREADS; k++) {
    void *good = NULL;
    assert_int_equal(pthread_join(threads[k], &good), 0);
    assert_int_equal(*(size_t *)good, QUERIES);
    free(good);
    free(samples[k].text);
  }
  cprox_workspace_free(ws);
}

/* ---- where memory is out ---- */

/* What MPFR would end the program by. */
static size_t taken_by_mpfr;

static void *mpfr_takes(size_t size) {
  taken_by_mpfr++;
  return malloc(size);
}

/* All allocations fail but the first 0, 1, 2, …: the refusal says so and keeps nothing. Where all are granted there is
 * a proof. */
static void starve(const char *text, size_t length, const void *bytes, size_t size) {
  const size_t before = allocations_made(), live_before = allocations_live();
  assert_string_equal(prove(text, length, bytes, size).fault, "");
  const size_t needed = allocations_made() - before, freed = live_before - allocations_live(); /* libc's own line */
  for (size_t granted = 0; granted < needed; granted += 1 + granted / 12) {
    const size_t live = allocations_live();
    allocations_fail_after(granted);
    const proof found = prove(text, length, bytes, size);
    allocations_allow();
    if (strcmp(found.fault, "memory is out") != 0) fail_msg("%zu of %zu: '%s'", granted, needed, found.fault);
    assert_true(!found.apart && !found.near && live - allocations_live() == freed);
  }
}

/* Seed 7: curves of every basis, and robots. */
CASE(where_memory_is_out_nothing_is_proven_and_the_program_goes_on) {
  rng r = rng_seed(7);
  cprox_workspace *ws = cprox_workspace_create();
  mp_set_memory_functions(mpfr_takes, NULL, NULL);
  for (int i = 0; i < 12; i++) {
    const sample *s = next_sample(&r, 1, ws);
    starve(s->text, s->length, s->bytes, s->size);
    free(s->text);
  }
  for (int i = 0; i < 4; i++) {
    robot_query q;
    robot_query_random(&q, &r, 0.5, 2.0, false, ws);
    cprox_certificate *c = cprox_certificate_create();
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.certificate = c;
    cprox_result result;
    distance_of_list(q.mover, q.targets, q.n, &options, ws, &result, NULL);
    const cprox_certificate_info info = cprox_certificate_get_info(c);
    char *text = NULL;
    size_t length;
    FILE *out = open_memstream(&text, &length);
    robot_write_targets(q.targets, q.n, out);
    robot_write_mover(&q.mover, q.targets, q.n, "robot", ws, out);
    fclose(out);
    if (info.size > 0) starve(text, length, info.bytes, info.size);
    free(text);
    cprox_certificate_free(c);
    robot_query_free(&q);
  }
  mp_set_memory_functions(NULL, NULL, NULL);
  assert_int_equal(taken_by_mpfr, 0);
  cprox_workspace_free(ws);
}

/* ---- cosines and sines ---- */

/* Seed 8, 20,000 angles: the interval holds what MPFR finds with 100 bits more, and is narrow. */
CASE(cosine_and_sine_hold_those_of_mpfr_and_are_narrow) {
  rng r = rng_seed(8);
  assert_true(iv_begin());
  for (int i = 0; i < 20000; i++) {
    const int bits = i % 3 == 0 ? 64 : 640;
    const double angle = (i % 2 == 0 ? 1.0 : -1.0) * rng_log_uniform(&r, 1e-6, i % 5 == 0 ? 1e6 : 10.0);
    iv_precision(bits);
    iv *w = iv_new(3);
    iv_set_d(&w[2], i == 0 ? 0.0 : angle);
    iv_turn(&w[0], &w[1], &w[2]);
    mpfr_t x, exact[2], width;
    mpfr_inits2(bits + 100, x, exact[0], exact[1], width, (mpfr_ptr)NULL);
    mpfr_set_d(x, i == 0 ? 0.0 : angle, MPFR_RNDN);
    mpfr_sin_cos(exact[1], exact[0], x, MPFR_RNDN);
    for (int k = 0; k < 2; k++) {
      assert_true(mpfr_lessequal_p(w[k].lo, exact[k]) && mpfr_lessequal_p(exact[k], w[k].hi));
      mpfr_sub(width, w[k].hi, w[k].lo, MPFR_RNDU);
      assert_true(mpfr_cmp_d(width, ldexp(1.0, 3 - bits)) <= 0);
    }
    mpfr_clears(x, exact[0], exact[1], width, (mpfr_ptr)NULL);
    iv_free(w, 3);
  }
  iv_precision(640);
  assert_true(iv_end());
  mpfr_free_cache();
}

int main(void) {
  return cases_run(NULL, NULL);
}
