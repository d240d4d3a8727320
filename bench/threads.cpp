/* SPDX-License-Identifier: BSD-3-Clause */
/* A thousand quintics against a hundred boxes over 1, 2, … threads, as many as the machine runs at once. Times are of the wall; all
 * numbers of threads take turns. What is wrong is what differs from one thread's answers. */
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <curve_proximity/parallel.hpp>

#include "support/measure.h"

namespace {

using namespace curve_proximity;

constexpr std::size_t kCurves = 1000, kBoxes = 100;
constexpr double kTube = 0.02, kDelta = 0.05;

struct Scene {
  std::vector<cprox_curve *> curves;
  std::vector<cprox_body *> bodies;
  std::vector<cprox_target> targets;
  std::vector<cprox_mover> movers;

  Scene() {
    std::mt19937_64 engine(100);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::normal_distribution<double> turn;
    for (std::size_t i = 0; i < kCurves; ++i) {
      cprox_vec3 p[6];
      for (cprox_vec3 &x : p) x = {unit(engine), unit(engine), unit(engine)};
      p[0] = {-0.2, 0.5, 0.5}, p[5] = {1.2, 0.5, 0.5};
      curves.push_back(nullptr);
      cprox_curve_create_bezier(p, 6, 0.0, 1.0, nullptr, &curves.back());
      movers.push_back(cprox_tube_along(curves.back(), kTube));
    }
    for (std::size_t i = 0; i < kBoxes; ++i) {
      const cprox_vec3 edges = {0.05 * unit(engine) + 0.01, 0.05 * unit(engine) + 0.01, 0.05 * unit(engine) + 0.01};
      bodies.push_back(nullptr);
      cprox_body_create_box(edges, nullptr, &bodies.back());
      const cprox_pose pose = {{unit(engine), unit(engine), unit(engine)},
                               {turn(engine), turn(engine), turn(engine), turn(engine)}};
      targets.push_back(cprox_at(bodies.back(), pose));
    }
  }

  ~Scene() {
    for (cprox_curve *curve : curves) cprox_curve_free(curve);
    for (cprox_body *body : bodies) cprox_body_free(body);
  }
  Scene(const Scene &) = delete;
  Scene &operator=(const Scene &) = delete;
};

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
}

} // namespace

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  const unsigned most = std::max(2u, std::thread::hardware_concurrency());
  std::vector<std::unique_ptr<Pool>> pools;
  for (unsigned threads = 1; threads <= most; threads *= 2) pools.push_back(std::make_unique<Pool>(threads));
  const Scene scene;
  const Batch batch(scene.targets);
  const cprox_options options = cprox_options_default();
  const std::pair<const char *, std::function<Batch::Answers(Pool &)>> verbs[] = {
      {"distance", [&](Pool &pool) { return batch.distance(scene.movers, options, pool); }},
      {"tolerance", [&](Pool &pool) { return batch.tolerance(scene.movers, kDelta, options, pool); }},
      {"collision", [&](Pool &pool) { return batch.collision(scene.movers, options, pool); }}};
  for (const auto &[verb, ask] : verbs) {
    const std::string workload = std::string("growth threads ") + verb;
    if (!bench_wanted(&size, workload.c_str())) continue;
    std::vector<std::vector<double>> times(pools.size());
    std::vector<Batch::Answers> answers(pools.size());
    for (int round = 0; round <= 3 * size.rounds; ++round) { // the first warms up
      for (std::size_t k = 0; k < pools.size(); ++k) {
        const auto begin = std::chrono::steady_clock::now();
        answers[k] = ask(*pools[k]);
        const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begin;
        if (round > 0) times[k].push_back(took.count());
      }
    }
    for (std::size_t k = 0; k < pools.size(); ++k) {
      std::size_t nodes = 0, wrong = 0, failed = 0;
      for (std::size_t i = 0; i < kCurves; ++i) {
        const cprox_result &own = answers[k].results[i], &alone = answers[0].results[i];
        nodes += own.nodes;
        wrong += own.lower != alone.lower || own.upper != alone.upper || own.verdict != alone.verdict;
        failed += own.status < 0;
      }
      std::printf("threads,%s,curve_proximity,%u threads,%.4g,%.4g,%zu,0,,%zu,%zu\n", workload.c_str(),
                  pools[k]->threads(), quantile(times[k], 0.5), quantile(times[k], 0.95), nodes, wrong, failed);
    }
  }
  return 0;
}
