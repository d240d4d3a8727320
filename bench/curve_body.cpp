/* SPDX-License-Identifier: BSD-3-Clause */
/* Distance of Bézier curves to a box, a 20-gon and a 64-vertex polytope at epsilon 1e-10: time, intervals examined,
 * nearest-point queries. Run: scripts/run curve_proximity_bench_core, or the executable itself. */
#include <benchmark/benchmark.h>
#include <curve_proximity/cprox.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

namespace {

enum Obstacle { kBox, kPolygon, kPolytope };

constexpr int kProblems = 256;

struct Problem {
  cprox_curve *curve = nullptr;
  cprox_body *body = nullptr;
  cprox_obstacle target{};
};

/* The same problems in every run: curves in the unit cube, obstacles a quarter of its size. */
class Problems {
 public:
  Problems(Obstacle obstacle, int order) : random_(static_cast<unsigned>(17 + order)) {
    for (Problem &p : problems_) make(obstacle, order, &p);
  }
  ~Problems() {
    for (Problem &p : problems_) {
      cprox_curve_free(p.curve);
      cprox_body_free(p.body);
    }
  }
  Problems(const Problems &) = delete;
  Problems &operator=(const Problems &) = delete;
  const Problem &operator[](size_t i) const {
    return problems_[i];
  }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  cprox_vec3 inCube() {
    return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
  }

  void make(Obstacle obstacle, int order, Problem *p) {
    std::vector<cprox_vec3> points(static_cast<size_t>(order) + 1);
    for (cprox_vec3 &q : points) {
      q = inCube();
      if (obstacle == kPolygon) q.z = 0;
    }
    cprox_curve_description bezier{};
    bezier.kind = CPROX_CURVE_BEZIER, bezier.points = points.data(), bezier.n = points.size(), bezier.t1 = 1.0;
    check(cprox_curve_create(&bezier, nullptr, &p->curve));
    cprox_pose pose = {inCube(), {uniform(-1, 1), 0, 0, uniform(-1, 1)}};
    if (obstacle == kPolygon) {
      pose.position.z = 0;
      double polygon[20][2];
      for (int j = 0; j < 20; j++) {
        const double a = 2 * M_PI * (j + uniform(0, 0.7)) / 20;
        polygon[j][0] = 0.25 * std::cos(a), polygon[j][1] = 0.15 * std::sin(a);
      }
      check(cprox_body_create_polygon(polygon, 20, nullptr, &p->body));
    } else if (obstacle == kBox) {
      check(cprox_body_create_box({uniform(0.1, 0.5), uniform(0.1, 0.5), uniform(0.1, 0.5)}, nullptr, &p->body));
      pose.orientation.x = uniform(-1, 1);
    } else {
      std::vector<cprox_vec3> cloud(64);
      for (cprox_vec3 &v : cloud) {
        v = inCube();
        const double scale = 0.25 / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
        v = {scale * v.x, scale * v.y, scale * v.z};
      }
      check(cprox_body_create_polytope(cloud.data(), cloud.size(), nullptr, &p->body));
      pose.orientation.x = uniform(-1, 1);
    }
    p->target = cprox_obstacle_at(p->body, pose);
  }

  static void check(cprox_status status) {
    if (status != CPROX_OK) std::abort();
  }

  std::mt19937 random_;
  Problem problems_[kProblems];
};

uint32_t median(std::vector<uint32_t> counts) {
  std::nth_element(counts.begin(), counts.begin() + kProblems / 2, counts.end());
  return counts[kProblems / 2];
}

void distance(benchmark::State &state, Obstacle obstacle) {
  const Problems problems(obstacle, static_cast<int>(state.range(0)));
  cprox_workspace *workspace = cprox_workspace_create();
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-10;
  std::vector<uint32_t> nodes(kProblems), distance_queries(kProblems);
  for (auto _ : state) {
    for (size_t i = 0; i < kProblems; i++) {
      cprox_result r;
      cprox_distance(cprox_point_along(problems[i].curve), problems[i].target, &options, workspace, &r);
      nodes[i] = r.nodes, distance_queries[i] = r.distance_queries;
      benchmark::DoNotOptimize(r);
    }
  }
  state.SetItemsProcessed(state.iterations() * kProblems);
  state.counters["us"] = benchmark::Counter(static_cast<double>(state.iterations()) * kProblems * 1e-6,
                                            benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["median_nodes"] = median(nodes);
  state.counters["median_distance_queries"] = median(distance_queries);
  cprox_workspace_free(workspace);
}

} // namespace

BENCHMARK_CAPTURE(distance, box, kBox)->Arg(5)->Arg(10)->Arg(15);
BENCHMARK_CAPTURE(distance, polygon_20, kPolygon)->Arg(5)->Arg(10)->Arg(15);
BENCHMARK_CAPTURE(distance, polytope_64, kPolytope)->Arg(5)->Arg(10)->Arg(15);

BENCHMARK_MAIN();
