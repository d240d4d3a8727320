/* SPDX-License-Identifier: BSD-3-Clause */
#include "attack.h"

#include <inttypes.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

enum {
  MAX_TALLIES = 512,
  SHOWN = 100,       /* wrong cases that are printed; all are counted */
  CASE_SECONDS = 120 /* of CPU time: a case that takes longer hangs */
};

typedef struct tally {
  char name[80];
  size_t cases, failed;
} tally;

/* One attack a process. */
static tally kinds[MAX_TALLIES], counts[MAX_TALLIES];
static char kind_name[80], fault[2000];
static bool failed;
static attack running;

static void add(tally *tallies, const char *name, bool wrong) {
  size_t i = 0;
  while (i < MAX_TALLIES - 1 && tallies[i].name[0] && strcmp(tallies[i].name, name) != 0) i++;
  if (!tallies[i].name[0]) snprintf(tallies[i].name, sizeof tallies[i].name, "%s", name);
  tallies[i].cases++;
  tallies[i].failed += wrong;
}

void attack_kind(attack *a, const char *format, ...) {
  (void)a;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(kind_name, sizeof kind_name, format, arguments);
  va_end(arguments);
}

void attack_count(attack *a, const char *what) {
  (void)a;
  add(counts, what, false);
}

void attack_fail(attack *a, const char *format, ...) {
  (void)a;
  if (failed) return;
  failed = true;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(fault, sizeof fault, format, arguments);
  va_end(arguments);
}

bool attack_failed(const attack *a) {
  (void)a;
  return failed;
}

static void show(const char *what) {
  printf("FAILED attack_%s 1 %" PRIu64 " --case %zu: %s%s%s\n", running.family, running.seed, running.number, kind_name,
         kind_name[0] ? ": " : "", what);
  fflush(stdout);
}

/* ---- cases that do not come back ---- */

extern void __sanitizer_set_death_callback(void (*callback)(void)) __attribute__((weak));

static void on_death(void) {
  show("a sanitizer ended the program");
}

static void on_signal(int number) {
  char text[60];
  snprintf(text, sizeof text, number == SIGPROF ? "still running after %d s" : "ended by signal %d",
           number == SIGPROF ? CASE_SECONDS : number);
  show(text);
  puts("0 passed, 1 failed");
  fflush(stdout);
  _exit(1);
}

static void watch(void) {
  signal(SIGPROF, on_signal);
  if (__sanitizer_set_death_callback) {
    __sanitizer_set_death_callback(on_death);
    return;
  }
  const int fatal[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
  for (size_t i = 0; i < sizeof fatal / sizeof *fatal; i++) signal(fatal[i], on_signal);
}

/* ---- cases one by one ---- */

/* The random numbers of a case: neighbouring numbers and seeds share nothing. */
static rng numbers_of(uint64_t seed, size_t number) {
  rng of_seed = rng_seed(seed);
  return rng_seed(rng_next(&of_seed) + (uint64_t)number);
}

/* CPU time, so that a machine that is busy or suspended ends no case. 0: none. */
static void limit_cpu_seconds(int seconds) {
  const struct itimerval limit = {.it_value = {.tv_sec = seconds}};
  setitimer(ITIMER_PROF, &limit, NULL);
}

/* False where it is wrong. */
static bool run(attack_case one, size_t number, size_t *shown) {
  running.number = number;
  kind_name[0] = fault[0] = 0;
  failed = false;
  rng r = numbers_of(running.seed, number);
  limit_cpu_seconds(CASE_SECONDS);
  one(&running, &r);
  limit_cpu_seconds(0);
  add(kinds, kind_name, failed);
  if (failed && (*shown)++ < SHOWN) show(fault);
  return !failed;
}

static void summarise(size_t cases, size_t wrong, size_t shown) {
  if (shown > SHOWN) printf("%zu more wrong cases are not shown\n", shown - SHOWN);
  for (size_t i = 0; i < MAX_TALLIES && kinds[i].name[0]; i++)
    printf("%9zu cases, %zu failed: %s\n", kinds[i].cases, kinds[i].failed, kinds[i].name);
  for (size_t i = 0; i < MAX_TALLIES && counts[i].name[0]; i++)
    printf("%9zu times: %s\n", counts[i].cases, counts[i].name);
  printf("%zu passed, %zu failed\n", cases - wrong, wrong);
}

typedef struct command {
  size_t size, first;
  uint64_t seed;
  double seconds;
  bool alone;
} command;

static bool parse_number(const char *text, uintmax_t *number) {
  char *end;
  *number = strtoumax(text, &end, 10);
  return text[0] >= '0' && text[0] <= '9' && !*end;
}

static bool parse(int argc, char **argv, command *c) {
  *c = (command){.size = 10000, .seed = 1, .seconds = 1e9};
  int words = 0;
  for (int i = 1; i < argc; i++) {
    const bool one = !strcmp(argv[i], "--case"), seconds = !strcmp(argv[i], "--seconds");
    if ((one || seconds) && ++i >= argc) return false;
    uintmax_t number;
    if (!parse_number(argv[i], &number)) return false;
    if (one) {
      c->first = (size_t)number;
      c->alone = true;
    } else if (seconds) {
      c->seconds = (double)number;
    } else if (words == 0) {
      c->size = (size_t)number;
    } else {
      c->seed = number;
    }
    words += !one && !seconds;
  }
  if (c->alone) c->size = 1;
  return words <= 2;
}

int attack_main(int argc, char **argv, const char *family, attack_case one) {
  command c;
  if (!parse(argc, argv, &c)) {
    fprintf(stderr, "usage: attack_%s [SIZE] [SEED] [--case N] [--seconds S]\n", family);
    return 2;
  }
  running = (attack){.family = family, .seed = c.seed, .ws = cprox_workspace_create(), .alone = c.alone};
  if (!running.ws) return 2;
  setvbuf(stdout, NULL, _IOLBF, BUFSIZ);
  watch();
  size_t wrong = 0, shown = 0, cases = 0;
  while (cases < c.size && (double)clock() / CLOCKS_PER_SEC <= c.seconds) {
    wrong += !run(one, c.first + cases, &shown);
    cases++;
  }
  cprox_workspace_free(running.ws);
  summarise(cases, wrong, shown);
  return wrong > 0 || cases == 0;
}
