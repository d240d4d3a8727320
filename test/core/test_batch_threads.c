/* SPDX-License-Identifier: BSD-3-Clause */
/* Batches against themselves in other splits and by 1 to 8 threads. Also run under ThreadSanitizer. */
#include <curve_proximity/cprox.h>
#include <pthread.h>
#include <string.h>

#include "support/batch_scene.h"
#include "support/cases.h"

typedef struct worker {
  const cprox_obstacles *batch;
  const batch_scene *scene;
  query_type query_type;
  size_t first, last;
  cprox_result *results;
} worker;

static void *work(void *argument) {
  const worker *w = argument;
  cprox_workspace *workspace = cprox_workspace_create();
  batch_ask(w->query_type, w->batch, w->scene, w->first, w->last, workspace, w->results);
  cprox_workspace_free(workspace);
  return NULL;
}

/* Seed 13: 1 to 8 threads on ranges of random lengths, each with a workspace of its own, write into one array. */
CASE(results_are_the_same_for_every_split_and_number_of_threads) {
  rng r = rng_seed(13);
  cprox_workspace *workspace = cprox_workspace_create();
  for (int planar = 0; planar < 2; planar++) {
    batch_scene s = {0};
    batch_scene_targets(&r, planar, workspace, &s);
    batch_scene_movers(&r, planar, workspace, &s);
    cprox_obstacles *batch = NULL;
    assert_int_equal(cprox_obstacles_create(s.obstacles, s.n_obstacles, CPROX_INDEX_BATCH, workspace, &batch),
                     CPROX_OK);
    for (int v = 0; v < QUERY_TYPES; v++) {
      cprox_result whole[MOVERS], split[MOVERS];
      batch_ask((query_type)v, batch, &s, 0, MOVERS, workspace, whole);
      for (size_t threads = 1; threads <= 8; threads++) {
        memset(split, 0, sizeof split);
        pthread_t thread[8];
        worker workers[8];
        size_t from = 0;
        for (size_t k = 0; k < threads; k++) {
          const size_t to = k + 1 == threads ? MOVERS : from + rng_index(&r, MOVERS - from + 1);
          workers[k] = (worker){batch, &s, (query_type)v, from, to, split};
          from = to;
          assert_int_equal(pthread_create(&thread[k], NULL, work, &workers[k]), 0);
        }
        for (size_t k = 0; k < threads; k++) assert_int_equal(pthread_join(thread[k], NULL), 0);
        for (size_t i = 0; i < MOVERS; i++) assert_true(same_answer(&whole[i], &split[i]));
      }
    }
    cprox_obstacles_free(batch);
    batch_scene_free(&s);
  }
  cprox_workspace_free(workspace);
}

int main(void) {
  return cases_run(NULL, NULL);
}
