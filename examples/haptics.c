/* SPDX-License-Identifier: BSD-3-Clause */
/* A haptic loop at 1 kHz: the signed distance of a tool and a body, both superquadrics, each search begun where the last
 * one ended. The tool slides round the body for the given number of seconds, in and out of contact. The same poses are
 * then asked from scratch. Prints the median, the 99 % quantile and the longest call of both. Link: -lcprox -lm */
#define _POSIX_C_SOURCE 200809L
#include <curve_proximity/cprox.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { RATE = 1000, MOST_SECONDS = 600 }; /* RATE [Hz] */
static double took[RATE * MOST_SECONDS];  /* [us] */

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void wait_until(double time) {
  const double left = time - now();
  const struct timespec t = {.tv_sec = (time_t)floor(left), .tv_nsec = (long)(1e9 * (left - floor(left)))};
  if (left > 0.0) nanosleep(&t, NULL);
}

static int by_size(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* The tool at a time [s]: round the body in 4 s, turning about z, and in and out by 1 cm six times. */
static cprox_pose tool_pose(double time) {
  const double angle = 1.5707963267948966 * time, r = 0.135 + 0.01 * sin(6.0 * angle);
  return (cprox_pose){.position = {r * cos(angle), r * sin(angle), 0.02},
                      .orientation = {.z = sin(0.5 * angle), .w = cos(0.5 * angle)}};
}

int main(int argc, char **argv) {
  const int seconds = argc > 1 ? atoi(argv[1]) : 5;
  if (seconds < 1 || seconds > MOST_SECONDS) return fprintf(stderr, "usage: haptics [SECONDS, 1 to 600]\n"), 2;
  const int n = RATE * seconds;
  cprox_workspace *workspace = cprox_workspace_create();
  cprox_body *body = NULL, *tool = NULL;
  int failed =
      cprox_body_create_superquadric((cprox_vec3){0.1, 0.1, 0.1}, (cprox_vec3){3, 3, 3}, workspace, &body) < 0 ||
      cprox_body_create_superquadric((cprox_vec3){0.03, 0.03, 0.12}, (cprox_vec3){2, 2, 4}, workspace, &tool) < 0;

  for (int warm = 1; warm >= 0 && !failed; warm--) {
    cprox_pair_start start = {0};
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.start = warm ? &start : NULL;
    int contacts = 0, late = 0;
    long steps[2] = {0}; /* apart, in contact */
    const double begin = now();
    for (int i = 0; i < n && !failed; i++) {
      if (warm) wait_until(begin + (double)i / RATE);
      cprox_result r;
      const double before = now();
      failed = cprox_pair(cprox_obstacle_at(tool, tool_pose((double)i / RATE)),
                          cprox_obstacle_at(body, CPROX_POSE_IDENTITY), &options, workspace, &r) < 0;
      took[i] = 1e6 * (now() - before);
      const int contact = r.upper < 0.0;
      /* a depth gains nothing from where the last one ended, and a start asks for other ways out, too */
      if (warm) options.start = contact ? NULL : &start;
      contacts += contact;
      late += took[i] > 1e6 / RATE;
      steps[contact] += (long)r.nodes;
    }
    if (failed) break;
    qsort(took, (size_t)n, sizeof *took, by_size);
    printf(
        "%s: %d calls, %.1f steps where apart, %.1f in contact; median %.1f us, 99 %% %.1f us, longest %.1f us, "
        "%d late\n",
        warm ? "warm, at 1 kHz" : "from scratch", n, (double)steps[0] / (n - contacts), (double)steps[1] / contacts,
        took[n / 2], took[n - 1 - n / 100], took[n - 1], late);
  }
  if (failed) fprintf(stderr, "%s\n", cprox_workspace_error(workspace));
  cprox_body_free(tool);
  cprox_body_free(body);
  cprox_workspace_free(workspace);
  return failed;
}
