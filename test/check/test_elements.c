/* SPDX-License-Identifier: BSD-3-Clause */
/* The checker on queries and certificates that are written here by hand: every element counts, and what is broken is
 * refused. A curve, and a ball of radius .1 on a slide, go from (0, 0, 0) to (1, 0, 0) above elements. */
#define _POSIX_C_SOURCE 200809L
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "support/cases.h"
#include "support/tampering.h"

enum { ELEMENTS = 7, NONE = ELEMENTS };

#define CURVE "mover c 0.1 bezier 1 0 1 2 0 0 0 1 0 0 0\n"
#define ROBOT                                                                                                       \
  "robot r 1 1 1\nlink -1 prismatic 0 0 0 1 0 0 0 1 0 0 0 1 0\npart 0 0 0 sphere 0.1\npairs 1 0 1\nrest 0\nmotion " \
  "waypoints 1 1 0 2\nat 0 1 0\nat 1 1 1\n"

/* Elements along the way at the height z, but for one, whose least vertex or all of it is at `odd`. */
static char *text_of(const char *what, double radius, double z, int which, double odd, const char *moving) {
  char *text = NULL;
  size_t length = 0;
  FILE *out = open_memstream(&text, &length);
  fprintf(out, "cprox-problem 1\ntargets 1\ntarget 0 0 %s", what);
  if (strcmp(what, "points") == 0) fprintf(out, " %g", radius);
  fprintf(out, " 0 0 0 %d", ELEMENTS);
  for (int i = 0; i < ELEMENTS; i++) {
    const double x = (double)i / (ELEMENTS - 1), at = i == which ? odd : z;
    if (strcmp(what, "points") == 0) fprintf(out, " %g 0 %g", x, at);
    if (strcmp(what, "cells") == 0) fprintf(out, " %g -1 %g %g 1 %g", x, z - 1.0, x + 0.1, at);
    if (strcmp(what, "triangles") == 0) fprintf(out, " %g -1 %g %g 1 %g %g 0 %g", x, z, x, z, x + 0.1, at);
  }
  fprintf(out, "\n%s", moving);
  fclose(out);
  return text;
}

static finding check_text(const char *text, const bytes *b) {
  FILE *in = fmemopen((void *)text, strlen(text), "r");
  problem p;
  if (!problem_open(&p, in) || !problem_next(&p)) fail_msg("%s in\n%s", p.fault, text);
  const finding found = check(&p, b->at, b->n);
  problem_close(&p);
  fclose(in);
  return found;
}

/* ---- certificates ---- */

static void put(bytes *b, const void *value, size_t n) {
  memcpy(b->at + b->n, value, n);
  b->n += n;
}

static void put_count(bytes *b, uint32_t value, size_t n) {
  put(b, &value, n);
}

static void put_number(bytes *b, double value) {
  put(b, &value, 8);
}

static void begin(bytes *b, double delta, uint32_t claimed) {
  b->n = 0;
  put(b, "CPC1", 4);
  put_count(b, 8, 4);
  put_number(b, delta);
  put_count(b, claimed, 4);
  put_count(b, 1, 4);
}

static void put_up(bytes *b) {
  for (int k = 0; k < 3; k++) put_number(b, k == 2);
}

/* Of a curve: one leaf, or a leaf for each element. */
static void curve_apart(bytes *b, double delta, bool each) {
  begin(b, delta, CLAIM_APART);
  put_count(b, 1, 4);
  put_count(b, 3, 1);
  for (int i = 1; i < ELEMENTS && each; i++) {
    put_count(b, 2, 1);
    put_number(b, i);
    put_count(b, 0, 1);
    put_up(b);
  }
  put_count(b, 0, 1);
  put_up(b);
}

/* Of a robot: nothing written; one direction; the items cut at each element in turn. */
static void robot_apart_by(bytes *b, double delta, int how) {
  begin(b, delta, CLAIM_APART);
  const int entries = how == 0 ? 0 : how == 1 ? 1 : ELEMENTS;
  put_count(b, (uint32_t)(2 * entries), 2);
  for (int i = 0; i < entries; i++) {
    const bool cut = i > 0;
    put_count(b, 0, 2);
    put_count(b, cut ? (uint32_t)(2 * (i == 1 ? 0 : 2 * (i - 1)) + 1) : 0, 4);
    if (cut)
      put_count(b, (uint32_t)i, 4);
    else
      put_up(b);
  }
}

static const char *const KINDS[] = {"points", "cells", "triangles"};

/* ---- cases ---- */

CASE(every_element_counts_for_a_curve) {
  bytes b;
  for (int what = 0; what < 3; what++)
    for (int each = 0; each < 2; each++)
      for (int which = 0; which <= NONE; which++) {
        char *text = text_of(KINDS[what], 0.0, -1.0, which, -0.35, CURVE);
        curve_apart(&b, 0.2, each);
        assert_int_equal(check_text(text, &b).claim, CLAIM_APART);
        curve_apart(&b, 0.3, each);
        assert_int_equal(check_text(text, &b).claim, which == NONE ? CLAIM_APART : CLAIM_NONE);
        free(text);
      }
}

CASE(every_element_counts_for_a_robot) {
  bytes b;
  for (int what = 0; what < 3; what++)
    for (int how = 0; how < 3; how++)
      for (int which = 0; which <= NONE; which++) {
        char *text = text_of(KINDS[what], 0.0, -1.0, which, -0.35, ROBOT);
        robot_apart_by(&b, 0.2, how);
        const finding easy = check_text(text, &b);
        if (easy.claim != CLAIM_APART) fail_msg("%s, %d, %d: %s", KINDS[what], how, which, easy.fault);
        robot_apart_by(&b, 0.3, how);
        assert_int_equal(check_text(text, &b).claim, which == NONE ? CLAIM_APART : CLAIM_NONE);
        free(text);
      }
}

CASE(balls_round_points_count) {
  bytes b;
  for (int how = 0; how < 3; how++)
    for (int large = 0; large < 2; large++) {
      char *along = text_of("points", large ? 0.5 : 0.1, -1.0, NONE, 0.0, CURVE);
      char *robot = text_of("points", large ? 0.5 : 0.1, -1.0, NONE, 0.0, ROBOT);
      curve_apart(&b, 0.5, how > 0);
      assert_int_equal(check_text(along, &b).claim, large ? CLAIM_NONE : CLAIM_APART);
      robot_apart_by(&b, 0.5, how);
      assert_int_equal(check_text(robot, &b).claim, large ? CLAIM_NONE : CLAIM_APART);
      free(along);
      free(robot);
    }
}

/* Two triangles a metre apart: the point between them is of neither. */
CASE(a_point_is_near_an_element_and_not_the_hull_of_two) {
  const char *text =
      "cprox-problem 1\ntargets 1\ntarget 0 0 triangles 0 0 0 2 "
      "-1 -1 -1 -1 1 -1 -1 0 1 1 -1 -1 1 1 -1 1 0 1\nmover c 0 bezier 1 0 1 2 0 0 0 1 0 0 0\n";
  const uint32_t vertices[4][4] = {{0, 1, 2, 0}, {0, 1, 2, 3}, {0, 1, 2, 5}, {3, 4, 5, 3}};
  for (uint32_t element = 0; element < 4; element++)
    for (int v = 0; v < 4; v++)
      for (int far = 0; far < 2; far++) {
        bytes b;
        begin(&b, far ? 1.1 : 0.9, CLAIM_NEAR);
        put_count(&b, 0, 4);
        put_number(&b, 0.0);
        put_count(&b, element, 4);
        for (int k = 0; k < 4; k++) {
          put_count(&b, vertices[v][k], 4);
          put_number(&b, k == 2 ? 2.0 : k == 3 && v == 0 ? 0.0 : 1.0);
        }
        const bool so = far && element < 2 && v == 0;
        assert_int_equal(check_text(text, &b).claim, so ? CLAIM_NEAR : CLAIM_NONE);
      }
}

CASE(cuts_that_cannot_be_are_refused) {
  const double cuts[] = {0.0, 0.5, 2.5, ELEMENTS, ELEMENTS + 1.0, -1.0, 1e300, 3.0};
  char *along = text_of("triangles", 0.0, -1.0, NONE, 0.0, CURVE),
       *robot = text_of("cells", 0.0, -1.0, NONE, 0.0, ROBOT);
  for (size_t i = 0; i < sizeof cuts / sizeof *cuts; i++) {
    bytes b;
    begin(&b, 0.2, CLAIM_APART);
    put_count(&b, 1, 4);
    put_count(&b, 3, 1);
    put_count(&b, 2, 1);
    put_number(&b, cuts[i]);
    for (int k = 0; k < 2; k++) put_count(&b, 0, 1), put_up(&b);
    assert_int_equal(check_text(along, &b).claim, cuts[i] == 3.0 ? CLAIM_APART : CLAIM_NONE);
  }
  const uint32_t entries[][3] = {{0, 1, 0},          {0, 1, ELEMENTS}, {0, 1, UINT32_MAX}, {0, 3, 2},
                                 {0, UINT32_MAX, 2}, {1, 1, 3},        {65535, 1, 3},      {0, 1, 3}};
  for (size_t i = 0; i < sizeof entries / sizeof *entries; i++) {
    bytes b;
    begin(&b, 0.2, CLAIM_APART);
    put_count(&b, 2, 2);
    put_count(&b, entries[i][0], 2);
    put_count(&b, entries[i][1], 4);
    put_count(&b, entries[i][2], 4);
    assert_int_equal(check_text(robot, &b).claim, i + 1 == sizeof entries / sizeof *entries ? CLAIM_APART : CLAIM_NONE);
  }
  free(along);
  free(robot);
}

/* 1,000 cuts, each of the rest that the last one left: the checker does not go that deep. */
CASE(cuts_upon_cuts_are_refused) {
  enum { MANY = 1000 };
  char *text = NULL;
  size_t length = 0;
  FILE *out = open_memstream(&text, &length);
  fprintf(out, "cprox-problem 1\ntargets 1\ntarget 0 0 points 0 0 0 0 %d", MANY);
  for (int i = 0; i < MANY; i++) fprintf(out, " %g 0 -1", (double)i / MANY);
  fprintf(out, "\n" ROBOT);
  fclose(out);
  for (uint32_t cuts = 100; cuts < MANY; cuts += 300) {
    bytes b;
    begin(&b, 0.2, CLAIM_APART);
    put_count(&b, 2 * cuts, 2);
    for (uint32_t i = 1; i <= cuts; i++) {
      put_count(&b, 0, 2);
      put_count(&b, 2 * (i == 1 ? 0 : 2 * (i - 1)) + 1, 4);
      put_count(&b, i, 4);
    }
    assert_int_equal(check_text(text, &b).claim, cuts == 100 ? CLAIM_APART : CLAIM_NONE);
  }
  free(text);
}

/* An open mesh is no solid; elements that end early, or that are not numbers, are no elements. */
CASE(what_are_no_elements_is_refused) {
  static const char *const broken[] = {"solid 0 0 0 1 0 0 0 1 0 0 0 1 0",
                                       "triangles 0 0 0 2 0 0 0 1 0 0 0 1 0",
                                       "triangles 0 0 0 0",
                                       "triangles 0 0 0 99999999999 0 0 0",
                                       "triangles 0 0 0 -1 0 0 0",
                                       "triangles 0 0 0 1 0 0 0 1 0 0 0 1 nan",
                                       "triangles 0 0 0 1 0 0 0 1 0 0 0 1 0 0",
                                       "points -1 0 0 0 1 0 0 0",
                                       "points 0 0 0 1 0 0 0",
                                       "cells 0 0 0 1 0 0 0 1 1"};
  for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
    char text[400];
    snprintf(text, sizeof text, "cprox-problem 1\ntargets 1\ntarget 0 0 %s\n" CURVE, broken[i]);
    FILE *in = fmemopen(text, strlen(text), "r");
    problem p;
    assert_true(problem_open(&p, in));
    if (problem_next(&p)) fail_msg("'%s' is read", broken[i]);
    assert_true(p.fault[0] != 0);
    problem_close(&p);
    fclose(in);
  }
}

/* 5,000 texts and certificates (seed 1), cut off, or with words and bytes that were changed: each is read to an end. For
 * sanitizers. */
CASE(texts_that_were_tampered_with_are_read_to_an_end) {
  static const char *const words[] = {"0",     "1",      "-1",    "7",     "1e300",  "nan", "99999999",
                                      "solid", "points", "cells", "robot", "target", "\n",  "0x1p-1074"};
  rng r = rng_seed(1);
  size_t read = 0, proven = 0;
  for (size_t i = 0; i < test_cases(5000); i++) {
    char *text = text_of(KINDS[rng_index(&r, 3)], 0.1, -1.0, NONE, 0.0, i % 2 ? ROBOT : CURVE);
    const size_t length = strlen(text);
    for (size_t k = rng_index(&r, 3); k > 0; k--) {
      const size_t at = rng_index(&r, length);
      const char *word = words[rng_index(&r, sizeof words / sizeof *words)];
      if (rng_index(&r, 4) == 0)
        text[at] = (char)rng_index(&r, 256);
      else
        memcpy(text + at, word, strlen(word) < length - at ? strlen(word) : length - at);
    }
    bytes b;
    static const bytes other = {.n = 1};
    if (i % 2)
      robot_apart_by(&b, 0.2, (int)rng_index(&r, 3));
    else
      curve_apart(&b, 0.2, rng_index(&r, 2) == 0);
    if (rng_index(&r, 2)) tamper(&b, &r, &other);
    FILE *in = fmemopen(text, rng_index(&r, 4) ? length : rng_index(&r, length) + 1, "r");
    problem p;
    if (problem_open(&p, in))
      while (problem_next(&p)) {
        read++;
        proven += !p.mover.none && check(&p, b.at, b.n).claim != CLAIM_NONE;
      }
    problem_close(&p);
    fclose(in);
    free(text);
  }
  print_message("%zu queries read, %zu certificates proven\n", read, proven);
  assert_true(read > test_cases(500) && proven > test_cases(100));
}

int main(void) {
  return cases_run(NULL, NULL);
}
