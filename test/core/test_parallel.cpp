/* SPDX-License-Identifier: BSD-3-Clause */
/* The pool and batches over it. Also run under ThreadSanitizer. */
#include <curve_proximity/parallel.hpp>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <thread>

#include "support/cases.h"

using curve_proximity::Batch;
using curve_proximity::Pool;
using curve_proximity::Workspace;

namespace {

CASE(every_number_is_taken_once) {
  for (unsigned threads = 1; threads <= 8; ++threads) {
    Pool pool(threads);
    assert_int_equal(pool.threads(), threads);
    for (const std::size_t n : {0, 1, 7, 1000}) {
      for (const std::size_t grain : {0, 1, 3, 2000}) {
        std::vector<int> taken(n, 0);
        pool.run(n, grain, [&](std::size_t first, std::size_t last, Workspace &) {
          assert_true(first < last && last <= n && last - first <= std::max<std::size_t>(grain, 1));
          for (std::size_t i = first; i < last; ++i) ++taken[i];
        });
        for (const int times : taken) assert_int_equal(times, 1);
      }
    }
  }
}

constexpr int kRanges = 10000;

struct Outcome {
  bool thrown = false;      /* what range ten threw has arrived */
  int ranges = 0;           /* that were begun */
  std::size_t sum_then = 0; /* of what a run after it was given */
};

Outcome throwInTheTenth(unsigned threads) {
  Pool pool(threads);
  Outcome outcome;
  std::atomic<int> ranges(0);
  try {
    pool.run(kRanges, 1, [&](std::size_t first, std::size_t, Workspace &) {
      ++ranges;
      if (first == 10) throw std::runtime_error("ten");
      if (first > 10) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
  } catch (const std::runtime_error &error) {
    outcome.thrown = std::strcmp(error.what(), "ten") == 0;
  }
  outcome.ranges = ranges;
  std::atomic<std::size_t> sum(0);
  pool.run(101, 2, [&](std::size_t first, std::size_t last, Workspace &) {
    for (std::size_t i = first; i < last; ++i) sum += i;
  });
  outcome.sum_then = sum;
  return outcome;
}

/* One thread begins nothing after the range that throws. Several cannot know at once: each range after it takes a
 * millisecond, so that all of them would take three threads more than three seconds, and the one that throws has as
 * long to say so, whatever else the machine does. */
CASE(the_first_exception_arrives_and_the_pool_goes_on) {
  for (int round = 0; round < 50; ++round) {
    const bool alone = round % 2 == 1;
    const Outcome outcome = throwInTheTenth(alone ? 1 : 4);
    assert_true(outcome.thrown);
    assert_true(alone ? outcome.ranges == 11 : outcome.ranges < kRanges);
    assert_int_equal(outcome.sum_then, 5050);
  }
}

/* 500 cubics and five boxes; movers 70 and 300 are unusable. */
struct World {
  std::vector<cprox_curve *> curves;
  std::vector<cprox_mover> movers;
  std::vector<cprox_body *> bodies;
  std::vector<cprox_obstacle> targets;

  World() {
    for (int i = 0; i < 500; ++i) {
      cprox_vec3 points[4];
      for (int k = 0; k < 4; ++k) points[k] = {std::sin(3.0 * i + k), std::cos(5.0 * i - 2 * k), std::sin(7.0 * i * k)};
      cprox_curve *curve = nullptr;
      cprox_curve_description bezier{};
      bezier.kind = CPROX_CURVE_BEZIER, bezier.points = points, bezier.n = 4, bezier.t1 = 1.0;
      assert_int_equal(cprox_curve_create(&bezier, nullptr, &curve), CPROX_OK);
      curves.push_back(curve);
      movers.push_back(cprox_point_along(curve));
    }
    for (int i = 0; i < 5; ++i) {
      cprox_body *box = nullptr;
      assert_int_equal(cprox_body_create_box({0.1, 0.2, 0.3}, nullptr, &box), CPROX_OK);
      bodies.push_back(box);
      targets.push_back(cprox_obstacle_at(box, {{0.3 * i - 0.6, 0.2 * i - 0.4, 0.1 * i}, {1, 0.1 * i, 0, 0.2}}));
    }
  }
  World(const World &) = delete;
  World &operator=(const World &) = delete;
  ~World() {
    for (cprox_curve *curve : curves) cprox_curve_free(curve);
    for (cprox_body *body : bodies) cprox_body_free(body);
  }
};

bool same(const cprox_result &a, const cprox_result &b) {
  return a.status == b.status && a.verdict == b.verdict && a.lower == b.lower && a.upper == b.upper && a.t == b.t &&
         a.obstacle_index == b.obstacle_index && a.nodes == b.nodes && a.distance_queries == b.distance_queries;
}

CASE(answers_are_the_same_for_one_to_eight_threads) {
  World world;
  world.movers[300].radius = -1;
  world.movers[70].radius = NAN;
  const Batch batch(world.targets);
  const cprox_options options = CPROX_OPTIONS_DEFAULT;
  Pool alone(1);
  const Batch::Answers distance = batch.distance(world.movers, options, alone);
  const Batch::Answers tolerance = batch.tolerance(world.movers, 0.05, options, alone);
  const Batch::Answers collision = batch.collision(world.movers, options, alone);
  assert_int_equal(distance.status, CPROX_INVALID);
  assert_int_equal(distance.reason.find("mover 70: radius"), 0);
  assert_int_equal(distance.results[300].status, CPROX_INVALID);
  assert_int_equal(distance.results[299].status, CPROX_OK);
  for (unsigned threads = 2; threads <= 8; ++threads) {
    Pool pool(threads);
    for (int query_type = 0; query_type < 3; ++query_type) {
      const Batch::Answers &expected = query_type == 0 ? distance : query_type == 1 ? tolerance : collision;
      const Batch::Answers got = query_type == 0   ? batch.distance(world.movers, options, pool)
                                 : query_type == 1 ? batch.tolerance(world.movers, 0.05, options, pool)
                                                   : batch.collision(world.movers, options, pool);
      assert_int_equal(got.status, expected.status);
      assert_string_equal(got.reason.c_str(), expected.reason.c_str());
      for (std::size_t i = 0; i < world.movers.size(); ++i) assert_true(same(got.results[i], expected.results[i]));
    }
  }
}

CASE(unusable_targets_and_options_are_told) {
  World world;
  std::vector<cprox_obstacle> bad = world.targets;
  bad[3].margin = -1;
  bool told = false;
  try {
    const Batch batch(bad);
  } catch (const curve_proximity::Error &error) {
    told = std::string(error.what()).find("target 3") != std::string::npos;
  }
  assert_true(told);

  const Batch batch(world.targets);
  Pool pool(3);
  const Batch::Answers answers = batch.tolerance(world.movers, -1, CPROX_OPTIONS_DEFAULT, pool);
  assert_int_equal(answers.status, CPROX_INVALID);
  assert_true(answers.reason.find("delta") != std::string::npos);
  for (const cprox_result &result : answers.results) assert_int_equal(result.status, CPROX_INVALID);
}

} // namespace

int main() {
  return cases_run(nullptr, nullptr);
}
