/* SPDX-License-Identifier: BSD-3-Clause */
/* A thousand quintics against a hundred boxes over 1, 2, … threads, as many as the machine runs at once. Times are of
 * the wall. All numbers of threads take turns, round by round, forwards and backwards; the time of several is the
 * median of what each round took over what one thread took in the same round, times one thread's median: what slows a
 * machine for longer than a round slows both. Beside them a loop of plain arithmetic over the same pools: where that
 * gains nothing from a second thread, the machine's second core was not free. What is wrong is what differs from one
 * thread's answers.
 * Then edges of a robot, and single queries, each on all threads: robots with their meshes, against themselves. */
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <curve_proximity/parallel.hpp>

#include "support/measure.h"
extern "C" {
#include "support/robot_case.h"
}

namespace {

using namespace curve_proximity;

constexpr std::size_t kCurves = 1000, kBoxes = 100;
constexpr double kTube = 0.02, kDelta = 0.05;

struct Scene {
  std::vector<cprox_curve *> curves;
  std::vector<cprox_body *> bodies;
  std::vector<cprox_obstacle> targets;
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
      cprox_curve_description bezier{};
      bezier.kind = CPROX_CURVE_BEZIER, bezier.points = p, bezier.n = 6, bezier.t1 = 1.0;
      cprox_curve_create(&bezier, nullptr, &curves.back());
      movers.push_back(cprox_tube_along(curves.back(), kTube));
    }
    for (std::size_t i = 0; i < kBoxes; ++i) {
      const cprox_vec3 edges = {0.05 * unit(engine) + 0.01, 0.05 * unit(engine) + 0.01, 0.05 * unit(engine) + 0.01};
      bodies.push_back(nullptr);
      cprox_body_create_box(edges, nullptr, &bodies.back());
      const cprox_pose pose = {{unit(engine), unit(engine), unit(engine)},
                               {turn(engine), turn(engine), turn(engine), turn(engine)}};
      targets.push_back(cprox_obstacle_at(bodies.back(), pose));
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

/* A sample lasts at least this long [us] on one thread: less is the time that a sleeping thread takes to wake up. */
constexpr double kShortestSample = 5000.0;

double wallTime(const std::function<void()> &ask) {
  const auto begin = std::chrono::steady_clock::now();
  ask();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
}

struct Times {
  double median, p95;
};

/* One for each of n ways, by turns; the first is on one thread. */
std::vector<Times> measure(std::size_t n, int rounds, const std::function<void(std::size_t)> &ask) {
  double once = 0.0;
  for (std::size_t k = n; k-- > 0;) once = wallTime([&] { ask(k); }); // all are warm; one thread is the last
  const int repeats = 1 + static_cast<int>(kShortestSample / std::max(once, 1.0));
  std::vector<std::vector<double>> times(n), ratios(n);
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t turn = 0; turn < n; ++turn) {
      const std::size_t k = round % 2 == 0 ? turn : n - 1 - turn;
      times[k].push_back(wallTime([&] {
                           for (int i = 0; i < repeats; ++i) ask(k);
                         }) /
                         repeats);
    }
    for (std::size_t k = 0; k < n; ++k) ratios[k].push_back(times[k].back() / times[0].back());
  }
  std::vector<Times> result;
  for (std::size_t k = 0; k < n; ++k)
    result.push_back({quantile(times[0], 0.5) * quantile(ratios[k], 0.5), quantile(times[k], 0.95)});
  return result;
}

/* As many ranges as a batch has, of additions and multiplications that need no memory. */
void plainLoop(Pool &pool) {
  constexpr std::size_t kRanges = 32;
  constexpr int kSteps = 40000;
  std::vector<double> sums(kRanges);
  pool.run(kRanges, 1, [&](std::size_t first, std::size_t, Workspace &) {
    double x = 0.5 + 1e-3 * static_cast<double>(first);
    for (int i = 0; i < kSteps; ++i) x = 3.7 * x * (1.0 - x);
    sums[first] = x;
  });
  if (std::any_of(sums.begin(), sums.end(), [](double x) { return !(x >= 0.0 && x <= 1.0); })) std::abort();
}

void print(const std::string &workload, const char *method, unsigned threads, const Times &times, std::size_t nodes,
           std::size_t wrong, std::size_t failed) {
  std::printf("threads,%s,%s,%u threads,%.4g,%.4g,%zu,0,,%zu,%zu\n", workload.c_str(), method, threads, times.median,
              times.p95, nodes, wrong, failed);
}

/* A robot of test/data/motion with its exact meshes on a long way: to and fro between postures of its trajectory. */
struct Wanderer {
  robot_case c{};
  cprox_motion *motion = nullptr;

  Wanderer(FILE *f, std::mt19937_64 &engine) {
    constexpr std::size_t kWaypoints = 60;
    if (!robot_case_read(f, BENCH_DATA_DIR "/motion", &c)) std::abort();
    const cprox_motion_info info = cprox_motion_get_info(c.mesh_motion);
    std::uniform_real_distribution<double> time(info.t0, info.t1);
    std::vector<std::int32_t> variables(c.n_variables);
    std::iota(variables.begin(), variables.end(), 0);
    std::vector<std::vector<double>> positions(kWaypoints, std::vector<double>(c.n_variables));
    std::vector<cprox_waypoint> waypoints;
    for (std::size_t k = 0; k < kWaypoints; ++k) {
      cprox_motion_evaluate(c.mesh_motion, time(engine), positions[k].data());
      waypoints.push_back({static_cast<double>(k), positions[k].data(), nullptr, nullptr});
    }
    cprox_motion_description description{};
    description.variables = variables.data(), description.n_variables = c.n_variables;
    description.waypoints = waypoints.data(), description.n_waypoints = kWaypoints;
    if (cprox_motion_create(c.mesh_robot, &description, nullptr, &motion) != CPROX_OK) std::abort();
  }
  ~Wanderer() {
    cprox_motion_free(motion);
    robot_case_free(&c);
  }
  Wanderer(const Wanderer &) = delete;
  Wanderer &operator=(const Wanderer &) = delete;
};

/* So many processes, which do their share each time they are asked to. */
class Processes {
 public:
  Processes(std::size_t n, const std::function<void(std::size_t)> &work) {
    for (std::size_t i = 0; i < n; ++i) {
      int to[2], from[2];
      if (pipe(to) != 0 || pipe(from) != 0) std::abort();
      const pid_t id = fork();
      if (id < 0) std::abort();
      if (id == 0) {
        close(to[1]), close(from[0]);
        char byte;
        while (read(to[0], &byte, 1) == 1) {
          work(i);
          if (write(from[1], &byte, 1) != 1) break;
        }
        _exit(0);
      }
      close(to[0]), close(from[1]);
      processes_.push_back({id, to[1], from[0]});
    }
  }
  ~Processes() {
    for (const Process &p : processes_) close(p.go), close(p.done), kill(p.id, SIGKILL), waitpid(p.id, nullptr, 0);
  }
  Processes(const Processes &) = delete;
  Processes &operator=(const Processes &) = delete;

  void run() const {
    char byte = 0;
    for (const Process &p : processes_)
      if (write(p.go, &byte, 1) != 1) std::abort();
    for (const Process &p : processes_)
      if (read(p.done, &byte, 1) != 1) std::abort();
  }

 private:
  struct Process {
    pid_t id;
    int go, done;
  };
  std::vector<Process> processes_;
};

/* Random straight edges of a Panda by 59 balls in a bookshelf, each against the scene and itself. As many processes, each
 * with its share of the edges, are what the machine has to give. */
void manyEdges(const std::vector<std::unique_ptr<Pool>> &pools, int rounds) {
  constexpr std::size_t kEdges = 20000, kPart = 16;
  static robot_case scene, model;
  std::size_t n = 0;
  FILE *f = std::fopen(BENCH_DATA_DIR "/motion/cases.txt", "r");
  if (!f || std::fscanf(f, "%zu", &n) != 1 || !robot_case_read(f, BENCH_DATA_DIR "/motion", &scene) ||
      !robot_case_read_robot(BENCH_DATA_DIR "/motion", "panda_spheres", &model))
    std::abort();
  std::fclose(f);
  Workspace workspace;
  cprox_obstacles *set = nullptr;
  cprox_edge_checker *checker = nullptr;
  cprox_obstacles_create(scene.targets, scene.n_targets, CPROX_INDEX_NONE, workspace.get(), &set);
  cprox_edge_query asked{};
  asked.obstacles = set, asked.self_pairs = model.self_pairs, asked.n_self_pairs = model.n_self_pairs;
  if (cprox_edge_checker_create(model.robot, &asked, workspace.get(), &checker) != CPROX_OK) std::abort();
  std::mt19937_64 engine(9);
  std::uniform_real_distribution<double> at(-2.5, 2.5), way(-0.7, 0.7);
  const std::size_t row = model.n_variables;
  std::vector<double> from(kEdges * row), to(kEdges * row);
  for (std::size_t i = 0; i < from.size(); ++i) from[i] = at(engine), to[i] = from[i] + way(engine);
  std::vector<std::vector<std::uint8_t>> verdicts(pools.size(), std::vector<std::uint8_t>(kEdges));
  const auto ask = [&](std::size_t first, std::size_t last, Workspace &own, std::uint8_t *out) {
    cprox_robot_edges(checker, &from[first * row], &to[first * row], last - first, own.get(), out + first, nullptr);
  };
  std::vector<std::unique_ptr<Processes>> apart;
  for (const auto &pool : pools) {
    const std::size_t share = (kEdges + pool->threads() - 1) / pool->threads();
    apart.push_back(std::make_unique<Processes>(pool->threads(), [&, share](std::size_t i) {
      ask(i * share, std::min(kEdges, (i + 1) * share), workspace, verdicts[0].data());
    }));
  }
  const std::vector<Times> times = measure(2 * pools.size(), rounds, [&](std::size_t k) {
    if (k >= pools.size()) return apart[k - pools.size()]->run();
    pools[k]->run(kEdges, kPart, [&](std::size_t first, std::size_t last, Workspace &own) {
      ask(first, last, own, verdicts[k].data());
    });
  });
  for (std::size_t k = 0; k < pools.size(); ++k) {
    std::size_t wrong = 0, failed = 0;
    for (std::size_t i = 0; i < kEdges; ++i) {
      wrong += verdicts[k][i] != verdicts[0][i];
      failed += verdicts[k][i] == CPROX_VERDICT_UNDECIDED;
    }
    print("growth threads edges", "curve_proximity", pools[k]->threads(), times[k], 0, wrong, failed);
    print("growth threads edges", "separate processes", pools[k]->threads(), times[pools.size() + k], 0, 0, 0);
  }
  cprox_edge_checker_free(checker);
  cprox_obstacles_free(set);
  robot_case_free(&model);
  robot_case_free(&scene);
}

/* Queries that take one thread this long [us]: shorter ones have no need of a second. */
constexpr double kLongQuery = 5000.0;

void oneQuery(const std::vector<std::unique_ptr<Pool>> &pools, int rounds) {
  const Obstacles nothing({});
  std::mt19937_64 engine(7);
  FILE *f = std::fopen(BENCH_DATA_DIR "/motion/cases.txt", "r");
  std::size_t n = 0;
  if (!f || std::fscanf(f, "%zu", &n) != 1) std::abort();
  for (std::size_t i = 0; i < n; ++i) {
    const Wanderer robot(f, engine);
    const cprox_mover mover = cprox_robot_self(robot.motion, robot.c.self_pairs, robot.c.n_self_pairs);
    const SharedQuery query(nothing, mover, CPROX_OPTIONS_DEFAULT);
    query.distance(*pools[0]);
    if (wallTime([&] { query.distance(*pools[0]); }) < kLongQuery) continue;
    std::vector<cprox_result> answers(pools.size());
    const std::vector<Times> times =
        measure(pools.size(), rounds, [&](std::size_t k) { answers[k] = query.distance(*pools[k]); });
    for (std::size_t k = 0; k < pools.size(); ++k) {
      const cprox_result &own = answers[k], &alone = answers[0];
      const bool wrong = own.lower > alone.upper || alone.lower > own.upper;
      print(std::string("growth one query ") + robot.c.name, "curve_proximity", pools[k]->threads(), times[k],
            own.nodes, wrong, own.status != CPROX_OK);
    }
  }
  std::fclose(f);
}

} // namespace

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  const int rounds = 15 * size.rounds;
  const unsigned most = std::max(2u, std::thread::hardware_concurrency());
  std::vector<std::unique_ptr<Pool>> pools;
  for (unsigned threads = 1; threads <= most; threads *= 2) pools.push_back(std::make_unique<Pool>(threads));
  const Scene scene;
  const Batch batch(scene.targets);
  const cprox_options options = CPROX_OPTIONS_DEFAULT;
  const std::pair<const char *, std::function<Batch::Answers(Pool &)>> query_types[] = {
      {"distance", [&](Pool &pool) { return batch.distance(scene.movers, options, pool); }},
      {"tolerance", [&](Pool &pool) { return batch.tolerance(scene.movers, kDelta, options, pool); }},
      {"collision", [&](Pool &pool) { return batch.collision(scene.movers, options, pool); }}};
  for (const auto &[query_type, ask] : query_types) {
    const std::string workload = std::string("growth threads ") + query_type;
    if (!bench_wanted(&size, workload.c_str())) continue;
    std::vector<Batch::Answers> answers(pools.size());
    const std::vector<Times> times = measure(pools.size(), rounds, [&](std::size_t k) { answers[k] = ask(*pools[k]); });
    for (std::size_t k = 0; k < pools.size(); ++k) {
      std::size_t nodes = 0, wrong = 0, failed = 0;
      for (std::size_t i = 0; i < kCurves; ++i) {
        const cprox_result &own = answers[k].results[i], &alone = answers[0].results[i];
        nodes += own.nodes;
        wrong += own.lower != alone.lower || own.upper != alone.upper || own.verdict != alone.verdict;
        failed += own.status < 0;
      }
      print(workload, "curve_proximity", pools[k]->threads(), times[k], nodes, wrong, failed);
    }
  }
  if (bench_wanted(&size, "growth threads edges")) manyEdges(pools, rounds);
  if (bench_wanted(&size, "growth one query")) oneQuery(pools, rounds);
  const std::string loop = "growth plain loop over threads";
  if (bench_wanted(&size, loop.c_str())) {
    const std::vector<Times> times = measure(pools.size(), rounds, [&](std::size_t k) { plainLoop(*pools[k]); });
    for (std::size_t k = 0; k < pools.size(); ++k) print(loop, "arithmetic", pools[k]->threads(), times[k], 0, 0, 0);
  }
  return 0;
}
