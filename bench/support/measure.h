/* SPDX-License-Identifier: BSD-3-Clause */
/* Methods beside each other on the same problems: times, counts, errors, one row of results.csv each.
 *
 * All methods of a workload run in one process, in turns of ten problems. A noisy machine then slows all of them alike:
 * trust ratios. */
#ifndef CPROX_BENCH_MEASURE_H
#define CPROX_BENCH_MEASURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What a method says about one problem. */
typedef struct bench_answer {
  double lower, upper; /* of the distance; a method without bounds sets both to its value */
  uint32_t nodes, distance_queries;
  bool failed;    /* it did not end, or said that it could not answer */
  uint32_t wrong; /* how many verdicts are not what the truth says */
} bench_answer;

/* Answers problem i. `state` is the method's own, `problems` the workload's. */
typedef void (*bench_run)(const void *problems, size_t i, void *state, bench_answer *answer);

typedef struct bench_method {
  const char *name;
  bench_run run;
  void *state;
} bench_method;

typedef struct bench_workload {
  const char *group, *name, *parameter;
  const void *problems;
  size_t n;
  const double *truth; /* the exact distances, or NULL: errors and unsound answers are not counted */
  double doubt;        /* how far the truth itself may be off */
} bench_workload;

/* How much is done: from the command line (--quick, --rounds N, --only WORKLOAD). */
typedef struct bench_size {
  size_t problems; /* of a workload, at most */
  int rounds;
  const char *only; /* workloads whose names contain this, or NULL */
} bench_size;

bench_size bench_arguments(int argc, char **argv);

/* Processor time of this thread [s]. */
double bench_thread_seconds(void);
bool bench_wanted(const bench_size *size, const char *workload);

/* Prints a row for each method: group,workload,method,parameter,median_us,p95_us,nodes,distance
 * queries,error,unsound,failures. Times are medians over the rounds, then median and 95 % over the problems, of thread
 * CPU time, nan where no problem is answered; nodes and distance queries are medians over the problems; error is the
 * largest |upper - truth|; unsound counts intervals that do not contain the truth and wrong verdicts. */
void bench_measure(const bench_workload *workload, const bench_size *size, const bench_method *methods, size_t n);

#ifdef __cplusplus
}
#endif
#endif
