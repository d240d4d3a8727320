/* SPDX-License-Identifier: BSD-3-Clause */
/* The pool and batches over it. Also run under ThreadSanitizer. */
#include <curve_proximity/cprox/robot.h>
#include <curve_proximity/parallel.hpp>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>
#include <stdexcept>
#include <thread>

#include "support/cases.h"

using curve_proximity::at;
using curve_proximity::Batch;
using curve_proximity::BodyHandle;
using curve_proximity::CurveHandle;
using curve_proximity::makeBezier;
using curve_proximity::makeBox;
using curve_proximity::makeSphere;
using curve_proximity::Pool;
using curve_proximity::SharedQuery;
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
    told = std::string(error.what()).find("obstacle 3") != std::string::npos;
  }
  assert_true(told);

  const Batch batch(world.targets);
  Pool pool(3);
  const Batch::Answers answers = batch.tolerance(world.movers, -1, CPROX_OPTIONS_DEFAULT, pool);
  assert_int_equal(answers.status, CPROX_INVALID);
  assert_true(answers.reason.find("delta") != std::string::npos);
  for (const cprox_result &result : answers.results) assert_int_equal(result.status, CPROX_INVALID);
}

/* ---- one query on several threads ---- */

constexpr std::size_t kJoints = 6, kWaypoints = 9;

/* A chain of six bars on a motion through nine waypoints, among twelve balls. */
struct Arm {
  std::vector<BodyHandle> bodies;
  std::vector<cprox_obstacle> targets;
  cprox_robot *robot = nullptr;
  cprox_motion *motion = nullptr;

  explicit Arm(std::mt19937 &random) {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    bodies.push_back(makeBox({0.1, 0.1, 0.4}));
    bodies.push_back(makeSphere(0.1));
    std::vector<cprox_link> links;
    std::vector<cprox_link_geometry> geometries;
    std::array<std::int32_t, kJoints> variables{};
    for (std::size_t i = 0; i < kJoints; ++i) {
      const auto number = static_cast<std::int32_t>(i);
      variables[i] = number;
      cprox_link link{};
      link.parent = number - 1, link.type = CPROX_JOINT_REVOLUTE, link.variable = number, link.multiplier = 1.0;
      link.origin = {{0.0, 0.0, i == 0 ? 0.0 : 0.5}, {0, 0, 0, 1}};
      link.axis = i % 2 == 0 ? cprox_vec3{0, 1, 0} : cprox_vec3{1, 0, 0};
      links.push_back(link);
      geometries.push_back({bodies[0].get(), {{0.0, 0.0, 0.25}, {0, 0, 0, 1}}, number, 0.0});
    }
    std::vector<std::array<double, kJoints>> positions(kWaypoints);
    std::vector<cprox_waypoint> waypoints;
    for (std::size_t k = 0; k < kWaypoints; ++k) {
      for (double &q : positions[k]) q = 1.2 * unit(random);
      waypoints.push_back({static_cast<double>(k), positions[k].data(), nullptr, nullptr});
    }
    for (int i = 0; i < 12; ++i) {
      const Eigen::Vector3d way(unit(random), unit(random), unit(random));
      targets.push_back(at(bodies[1], Eigen::Isometry3d(Eigen::Translation3d(2.2 * way))));
    }
    cprox_motion_description description{};
    description.variables = variables.data(), description.n_variables = kJoints;
    description.waypoints = waypoints.data(), description.n_waypoints = kWaypoints;
    assert_int_equal(cprox_robot_create(links.data(), kJoints, geometries.data(), kJoints, kJoints, nullptr, &robot),
                     CPROX_OK);
    assert_int_equal(cprox_motion_create(robot, &description, nullptr, &motion), CPROX_OK);
  }
  ~Arm() {
    cprox_motion_free(motion);
    cprox_robot_free(robot);
  }
  Arm(const Arm &) = delete;
  Arm &operator=(const Arm &) = delete;
};

/* Arms against obstacles, themselves and both: the intervals of one and of several threads both contain the distance,
 * and are no wider than asked; verdicts on either side of it are the same. The arms and where they are nearest: seed 5.
 */
CASE(one_query_on_several_threads_answers_as_on_one) {
  std::mt19937 random(5);
  Pool alone(1), two(2), three(3);
  Workspace workspace;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  for (int i = 0; i < 24; ++i) {
    const Arm arm(random);
    const curve_proximity::Obstacles obstacles(i % 3 == 1 ? std::vector<cprox_obstacle>() : arm.targets);
    cprox_mover mover = cprox_robot_along(arm.motion, nullptr, 0);
    mover.kind = i % 3 == 0 ? CPROX_MOVER_ROBOT : i % 3 == 1 ? CPROX_MOVER_ROBOT_SELF : CPROX_MOVER_ROBOT_WHOLE;
    options.epsilon = i % 2 == 0 ? 1e-6 : 1e-3;
    const SharedQuery query(obstacles, mover, options);
    const cprox_result whole = obstacles.distance(mover, options, workspace);
    for (Pool *pool : {&alone, &two, &three}) {
      const cprox_result r = query.distance(*pool);
      assert_int_equal(r.status, CPROX_OK);
      assert_true(r.lower <= r.upper && r.upper - r.lower <= options.epsilon);
      assert_true(r.lower <= whole.upper && whole.lower <= r.upper);
      for (const double delta : {0.5 * whole.lower, 0.9 * whole.lower, 1.1 * whole.upper, whole.upper + 0.1}) {
        const cprox_result verdict = query.tolerance(delta, *pool);
        assert_int_equal(verdict.status, CPROX_OK);
        assert_int_equal(verdict.verdict, delta >= whole.upper ? CPROX_VERDICT_VIOLATED
                                          : delta < whole.lower
                                              ? CPROX_VERDICT_CLEAR
                                              : obstacles.tolerance(mover, delta, options, workspace).verdict);
      }
    }
  }
}

/* The least of the distances of intervals is that of the whole motion, and times stay inside: seed 6. */
CASE(intervals_of_a_motion_cover_it) {
  std::mt19937 random(6);
  Workspace workspace;
  for (int i = 0; i < 20; ++i) {
    const Arm arm(random);
    const curve_proximity::Obstacles obstacles(arm.targets);
    const cprox_mover mover = cprox_robot_along(arm.motion, nullptr, 0);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    const cprox_result whole = obstacles.distance(mover, options, workspace);
    const cprox_result contact = obstacles.timeOfContact(mover, options, workspace);
    const std::vector<double> ends = {0.0, 0.3, 1.0, 2.7, 2.8, 5.0, 5.0 + 1e-9, 8.0};
    double lower = INFINITY, upper = INFINITY, first_contact = INFINITY;
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
      options.interval = &ends[k];
      const cprox_result r = obstacles.distance(mover, options, workspace);
      assert_true(r.t >= ends[k] && r.t <= ends[k + 1]);
      lower = std::min(lower, r.lower), upper = std::min(upper, r.upper);
      const cprox_result touch = obstacles.timeOfContact(mover, options, workspace);
      if (touch.verdict == CPROX_VERDICT_CLEAR) continue;
      assert_true(touch.t_contact_lower >= ends[k] && touch.t_contact_lower <= ends[k + 1]);
      first_contact = std::min(first_contact, touch.t_contact_lower);
    }
    assert_true(lower <= whole.upper && whole.lower <= upper && upper - lower <= 1e-6);
    if (contact.verdict == CPROX_VERDICT_VIOLATED) {
      assert_true(first_contact <= contact.t);
      assert_true(std::fabs(first_contact - contact.t_contact_lower) < 1e-4);
    }
  }
}

/* Sixteen intervals that share a bound, by turns: only the first one looks for a bound of its own before it divides, so
 * that all together measure little more than one query of the whole. Seed 8. */
CASE(intervals_that_share_a_bound_measure_little_more_than_the_whole) {
  constexpr std::size_t kIntervals = 16;
  std::mt19937 random(8);
  Workspace workspace;
  std::uint64_t of_whole = 0, of_intervals = 0;
  for (int i = 0; i < 40; ++i) {
    const Arm arm(random);
    const curve_proximity::Obstacles obstacles(i % 2 == 0 ? arm.targets : std::vector<cprox_obstacle>());
    cprox_mover mover = cprox_robot_along(arm.motion, nullptr, 0);
    mover.kind = i % 2 == 0 ? CPROX_MOVER_ROBOT : CPROX_MOVER_ROBOT_SELF;
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    const cprox_result whole = obstacles.distance(mover, options, workspace);
    of_whole += whole.distance_queries;
    double least = INFINITY, lower = INFINITY;
    options.share = [](void *known, double upper) {
      return *static_cast<double *>(known) = std::min(*static_cast<double *>(known), upper);
    };
    options.share_user = &least;
    const cprox_motion_info info = cprox_motion_get_info(arm.motion);
    const auto end = [&](std::size_t k) { return info.t0 + (info.t1 - info.t0) * static_cast<double>(k) / kIntervals; };
    for (std::size_t k = 0; k < kIntervals; ++k) {
      const std::array<double, 2> interval = {end(k), end(k + 1)};
      options.interval = interval.data();
      const cprox_result r = obstacles.distance(mover, options, workspace);
      of_intervals += r.distance_queries, lower = std::min(lower, r.lower);
    }
    assert_true(lower <= whole.upper && whole.lower <= least && least - lower <= options.epsilon);
  }
  assert_true(of_whole > 1000 && of_intervals < of_whole + of_whole * 6 / 10);
}

/* Two threads: what both examine together, against one search. Which finds what first differs from run to run; without
 * a bound to begin with it is more than twice as much. Seed 9. */
CASE(one_query_on_two_threads_examines_little_more_than_on_one) {
  std::mt19937 random(9);
  Workspace workspace;
  curve_proximity::Pool pool(2);
  std::uint64_t of_whole = 0, of_both = 0;
  for (int i = 0; i < 40; ++i) {
    const Arm arm(random);
    const curve_proximity::Obstacles obstacles(i % 2 == 0 ? arm.targets : std::vector<cprox_obstacle>());
    cprox_mover mover = cprox_robot_along(arm.motion, nullptr, 0);
    mover.kind = i % 2 == 0 ? CPROX_MOVER_ROBOT : CPROX_MOVER_ROBOT_SELF;
    const cprox_options options = CPROX_OPTIONS_DEFAULT;
    const cprox_result whole = obstacles.distance(mover, options, workspace);
    const cprox_result both = curve_proximity::SharedQuery(obstacles, mover, options).distance(pool);
    assert_true(both.status == CPROX_OK && both.upper - both.lower <= options.epsilon);
    assert_true(both.lower <= whole.upper && whole.lower <= both.upper);
    of_whole += whole.nodes, of_both += both.nodes;
  }
  print_message("%llu nodes on one thread, %llu on two\n", static_cast<unsigned long long>(of_whole),
                static_cast<unsigned long long>(of_both));
  assert_true(of_whole > 1000 && of_both < 2 * of_whole);
}

CASE(what_is_no_part_of_a_robots_query_is_told) {
  std::mt19937 random(7);
  const Arm arm(random);
  const curve_proximity::Obstacles obstacles(arm.targets);
  Workspace workspace;
  cprox_result r;
  const cprox_mover mover = cprox_robot_along(arm.motion, nullptr, 0);
  const auto refused = [&](const cprox_mover &asked, const cprox_options &options, const char *words) {
    const cprox_status status =
        cprox_obstacles_distance(obstacles.get(), asked, &options, workspace.get(), &r, nullptr);
    return status == CPROX_INVALID && workspace.reason().find(words) != std::string::npos;
  };
  const CurveHandle curve = makeBezier(Eigen::Matrix3Xd::Random(3, 4));
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  for (const std::array<double, 2> &bad :
       std::vector<std::array<double, 2>>{{-1, 2}, {2, 9}, {3, 3}, {4, 3}, {NAN, 3}, {0, INFINITY}}) {
    options.interval = bad.data();
    assert_true(refused(mover, options, "interval is ["));
  }
  const std::array<double, 2> good = {0.0, 0.5};
  options.interval = good.data();
  assert_true(refused(curve_proximity::along(curve), options, "interval is an option of robots"));
  options.share = [](void *, double upper) { return upper; };
  options.interval = nullptr;
  assert_true(refused(curve_proximity::along(curve), options, "share is an option of robots"));
  assert_int_equal(cprox_obstacles_tolerance(obstacles.get(), mover, 0.1, &options, workspace.get(), &r, nullptr),
                   CPROX_INVALID);
  bool told = false;
  try {
    SharedQuery(obstacles, mover, options);
  } catch (const curve_proximity::Error &error) {
    told = std::string(error.what()).find("takes no interval") != std::string::npos;
  }
  assert_true(told);
}

} // namespace

int main() {
  return cases_run(nullptr, nullptr);
}
