/* SPDX-License-Identifier: BSD-3-Clause */
#define _POSIX_C_SOURCE 200809L
#include "measure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MAX_ROUNDS = 64, MAX_METHODS = 32, BLOCK = 10 };

/* A sample lasts at least this long, so that the clock's own cost does not count [s]. */
static const double SHORTEST_SAMPLE = 2e-5;

/* A method that takes longer than this [s] is asked in a third of the rounds only: its noise is small beside its time,
 * and its time is most of the run's. */
static const double SLOW = 2e-3;

double bench_thread_seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double quantile(double *values, size_t n, double q) {
  qsort(values, n, sizeof *values, ascending);
  return values[(size_t)(q * (double)(n - 1) + 0.5)];
}

/* ---- the command line ---- */

bench_size bench_arguments(int argc, char **argv) {
  bench_size size = {.problems = 200, .rounds = 7};
  for (int i = 1; i < argc; i++) {
    if (strcmp(argv[i], "--quick") == 0) {
      size.problems = 40;
      size.rounds = 3;
    } else if (strcmp(argv[i], "--rounds") == 0 && i + 1 < argc && atoi(argv[i + 1]) > 0) {
      size.rounds = atoi(argv[++i]);
    } else if (strcmp(argv[i], "--only") == 0 && i + 1 < argc) {
      size.only = argv[++i];
    } else {
      fprintf(stderr, "usage: %s [--quick] [--rounds N] [--only WORKLOAD]\n", argv[0]);
      exit(2);
    }
  }
  return size;
}

bool bench_wanted(const bench_size *size, const char *workload) {
  return !size->only || strstr(workload, size->only);
}

/* ---- one workload ---- */

/* What is kept of one method. */
typedef struct record {
  double *time; /* medians, one a problem [s] */
  double *nodes, *distance_queries;
  double error;
  size_t unsound, failures;
} record;

static double time_of(const bench_workload *w, const bench_method *m, size_t problem, size_t repeats,
                      bench_answer *answer) {
  const double start = bench_thread_seconds();
  for (size_t k = 0; k < repeats; k++) m->run(w->problems, problem, m->state, answer);
  return (bench_thread_seconds() - start) / (double)repeats;
}

/* How often a sample asks, and in how many rounds. */
typedef struct effort {
  size_t repeats;
  int rounds;
} effort;

static effort effort_for(const bench_workload *w, const bench_size *size, const bench_method *m, size_t problem) {
  bench_answer answer;
  double once = time_of(w, m, problem, 1, &answer); /* warm */
  if (once > SLOW) return (effort){1, (size->rounds + 2) / 3};
  once = time_of(w, m, problem, 1, &answer);
  if (once >= SHORTEST_SAMPLE) return (effort){1, size->rounds};
  return (effort){(size_t)fmin(SHORTEST_SAMPLE / fmax(once, 1e-8), 1000.0) + 1, size->rounds};
}

static void judge(const bench_workload *w, size_t problem, const bench_answer *answer, record *r) {
  r->nodes[problem] = answer->nodes;
  r->distance_queries[problem] = answer->distance_queries;
  if (answer->failed) {
    r->failures++;
    return;
  }
  r->unsound += answer->wrong;
  if (!w->truth || isnan(w->truth[problem]) || isnan(answer->upper)) return;
  const double truth = w->truth[problem];
  if (isfinite(answer->upper)) r->error = fmax(r->error, fabs(answer->upper - truth));
  if (answer->lower < answer->upper && (answer->lower > truth + w->doubt || answer->upper < truth - w->doubt))
    r->unsound++;
}

/* What is measured of one problem. */
typedef struct samples {
  double time[MAX_METHODS][MAX_ROUNDS];
  effort effort[MAX_METHODS];
  bench_answer answer[MAX_METHODS];
} samples;

/* A method answers some problems in a row before the next one's turn: in use, too, queries come in rows, and what a
 * method finds in the caches is what it left there itself. */
static void measure_block(const bench_workload *w, const bench_size *size, const bench_method *methods, size_t n,
                          size_t first, size_t count, samples *block, record *records) {
  for (size_t m = 0; m < n; m++)
    for (size_t i = 0; i < count; i++) block[i].effort[m] = effort_for(w, size, &methods[m], first + i);
  for (int round = 0; round < size->rounds; round++) {
    for (size_t m = 0; m < n; m++) {
      for (size_t i = 0; i < count; i++) {
        const effort *often = &block[i].effort[m];
        if (round >= often->rounds) continue;
        block[i].answer[m] = (bench_answer){.lower = NAN, .upper = NAN};
        block[i].time[m][round] = time_of(w, &methods[m], first + i, often->repeats, &block[i].answer[m]);
      }
    }
  }
  for (size_t m = 0; m < n; m++) {
    for (size_t i = 0; i < count; i++) {
      records[m].time[first + i] = quantile(block[i].time[m], (size_t)block[i].effort[m].rounds, 0.5);
      judge(w, first + i, &block[i].answer[m], &records[m]);
    }
  }
}

void bench_measure(const bench_workload *w, const bench_size *size, const bench_method *methods, size_t n) {
  if (n > MAX_METHODS || size->rounds > MAX_ROUNDS) abort();
  record records[MAX_METHODS];
  memset(records, 0, sizeof records);
  for (size_t m = 0; m < n; m++) {
    records[m].time = calloc(3 * w->n, sizeof(double));
    if (!records[m].time) abort();
    records[m].nodes = records[m].time + w->n;
    records[m].distance_queries = records[m].nodes + w->n;
  }

  samples *block = calloc(BLOCK, sizeof *block);
  if (!block) abort();
  for (size_t i = 0; i < w->n; i += BLOCK) {
    fprintf(stderr, "\r%s: %s %s, %zu of %zu        ", w->group, w->name, w->parameter, i, w->n);
    measure_block(w, size, methods, n, i, w->n - i < BLOCK ? w->n - i : BLOCK, block, records);
  }
  free(block);
  fprintf(stderr, "\r%s: %s %s, done                    \n", w->group, w->name, w->parameter);

  for (size_t m = 0; m < n; m++) {
    record *r = &records[m];
    const bool answers = r->failures < w->n;
    const double typical = answers ? quantile(r->time, w->n, 0.5) : NAN,
                 slow = answers ? quantile(r->time, w->n, 0.95) : NAN;
    printf("%s,%s,%s,%s,%.4g,%.4g,%.4g,%.4g,", w->group, w->name, methods[m].name, w->parameter, 1e6 * typical,
           1e6 * slow, quantile(r->nodes, w->n, 0.5), quantile(r->distance_queries, w->n, 0.5));
    if (w->truth) printf("%.3g", r->error);
    printf(",%zu,%zu\n", r->unsound, r->failures);
    free(r->time);
  }
  fflush(stdout);
}
