/* SPDX-License-Identifier: BSD-3-Clause */
/* What a provider's plugin adds to the core's own calls: the same places asked both ways, in turns. What a gap of any two
 * kinds of bodies costs, prepared and evaluated.
 *
 * Workloads named "... adds" have the difference for their time. */
#include <pluginlib/class_loader.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <curve_proximity/cprox_fourier.h>
#include <curve_proximity/constraint_provider.hpp>
#include <curve_proximity/query.hpp>

#include "added.h"
#include "support/measure.h"

using namespace curve_proximity;

namespace {

/* One place, asked of the core and through the plugin. */
using Ask = std::function<void(std::size_t)>;

/* The least of several rounds for each place, of calls that take turns. */
void measure(const char *workload, std::size_t n, int rounds, const Ask &core, const Ask &plugin) {
  constexpr int kRepeats = 20;
  std::vector<double> by_core(n), by_plugin(n), added(n);
  for (std::size_t i = 0; i < n; ++i) {
    by_core[i] = by_plugin[i] = INFINITY;
    for (int round = 0; round < rounds; ++round) {
      for (const bool through : {false, true}) {
        const double begin = now();
        for (int k = 0; k < kRepeats; ++k) (through ? plugin : core)(i);
        double &best = through ? by_plugin[i] : by_core[i];
        best = std::min(best, (now() - begin) / kRepeats);
      }
    }
    added[i] = by_plugin[i] - by_core[i];
  }
  printRow("providers", workload, "curve_proximity", by_plugin);
  printRow("providers", workload, "core", by_core);
  printRow("providers", std::string(workload) + " adds", "curve_proximity", added);
}

class Random {
 public:
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  cprox_pose pose(double half) {
    Random &r = *this;
    return {{r(-half, half), r(-half, half), r(-half, half)}, {r(-1, 1), r(-1, 1), r(-1, 1), r(0.1, 1)}};
  }

 private:
  std::mt19937 engine_{71};
};

ConstraintBody sideOf(ShapeType type, std::vector<double> dimensions) {
  ShapeDescription shape;
  shape.type = type;
  shape.dimensions = std::move(dimensions);
  ConstraintBody side;
  side.parts.push_back({shape, makeGeometry(shape).body, 0.0, {}});
  return side;
}

struct Places {
  std::vector<ConstraintPlace> places;
  std::vector<ConstraintCurve> curves;
};

Places randomPlaces(std::size_t n, bool along, Random &random) {
  Places out;
  out.curves.resize(along ? n : 0);
  for (std::size_t i = 0; i < n; ++i) {
    ConstraintPlace place;
    place.b = random.pose(0.3);
    if (along) {
      CurveDescription &c = out.curves[i].description;
      c.points.resize(3, 6);
      for (Eigen::Index k = 0; k < 6; ++k) c.points.col(k) << random(0.5, 2.5), random(-1, 1), random(-1, 1);
      out.curves[i].curve = compile(c).curve;
      place.curve = &out.curves[i];
    } else {
      place.a = random.pose(0.3);
      place.a.position.x += 2.0;
    }
    out.places.push_back(place);
  }
  return out;
}

ConstraintBody sideOf(const ShapeDescription &shape) {
  ConstraintBody side;
  side.parts.push_back({shape, makeGeometry(shape).body, 0.0, {}});
  return side;
}

/* One of each kind whose spectrum has another form, about 1 m large. */
std::vector<std::pair<const char *, ConstraintBody>> bodiesOfAllKinds() {
  ShapeDescription corners, octahedron, slab;
  corners.type = ShapeType::POLYTOPE;
  octahedron.type = ShapeType::MESH;
  corners.vertices = octahedron.vertices = 0.5 * (Eigen::Matrix3Xd(3, 6) << 1, -1, 0, 0, 0, 0, //
                                                  0, 0, 1, -1, 0, 0,                           //
                                                  0, 0, 0, 0, 1, -1)
                                                     .finished();
  octahedron.triangles.resize(3, 8);
  octahedron.triangles << 0, 2, 1, 3, 2, 1, 3, 0, 2, 1, 3, 0, 0, 2, 1, 3, 4, 4, 4, 4, 5, 5, 5, 5;
  octahedron.solid = true;
  slab.type = ShapeType::IMPLICIT;
  slab.hyperquadrics = {{{2, 0, 0, 0, 4}, {0, 2, 0, 0, 4}, {0, 0, 2, 0, 4}}};
  slab.planes = {{0.6, 0.8, 0, -0.3}};
  return {{"sphere", sideOf(ShapeType::SPHERE, {0.5})},
          {"box", sideOf(ShapeType::BOX, {0.8, 0.7, 0.9})},
          {"ellipsoid", sideOf(ShapeType::ELLIPSOID, {0.5, 0.3, 0.4})},
          {"capsule", sideOf(ShapeType::CAPSULE, {0.6, 0.2})},
          {"cylinder", sideOf(ShapeType::CYLINDER, {0.8, 0.4})},
          {"cone", sideOf(ShapeType::CONE, {0.8, 0.4})},
          {"superquadric", sideOf(ShapeType::SUPERQUADRIC, {0.4, 0.3, 0.5, 2.5, 3.5, 5.0})},
          {"implicit", sideOf(slab)},
          {"polytope", sideOf(corners)},
          {"mesh", sideOf(octahedron)}};
}

/* The medians of times that several calls take at each place, in turns; the least of several rounds at a place. */
std::vector<std::vector<double>> inTurns(std::size_t n, int rounds, const std::vector<Ask> &calls) {
  std::vector<std::vector<double>> times(calls.size(), std::vector<double>(n, INFINITY));
  for (std::size_t i = 0; i < n; ++i) {
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t k = 0; k < calls.size(); ++k) {
        const double begin = now();
        calls[k](i);
        times[k][i] = std::min(times[k][i], now() - begin);
      }
    }
  }
  return times;
}

/* What a value with its gradient costs beside the distance, or the depth, of the same pair: the provider also asks
 * whether there is one minimiser alone. And what the same distance costs from the answer 1 mm beside. */
void gradientsBesidePairs(pluginlib::ClassLoader<ConstraintProvider> &plugins, const bench_size &size) {
  const auto provider = plugins.createUniqueInstance("curve_proximity/SuperquadricDistance");
  provider->initialise({});
  const auto bodies = bodiesOfAllKinds();
  const std::pair<std::size_t, std::size_t> pairs[] = {{1, 1}, {1, 4}, {1, 8}, {2, 6}, {4, 6}, {6, 6}};
  for (const bool overlaps : {false, true}) {
    const std::string workload = std::string("value and gradient ") + (overlaps ? "in overlap" : "apart");
    for (const auto &[i, j] : pairs) {
      Random random;
      ConstraintPair pair;
      pair.a = bodies[i].second, pair.b = bodies[j].second;
      const auto constraint = provider->prepare(pair);
      Places at = randomPlaces(size.problems, false, random);
      if (overlaps)
        for (ConstraintPlace &place : at.places) place.a.position.x -= 1.8;
      Workspace workspace;
      ConstraintValue value;
      cprox_options options = CPROX_OPTIONS_DEFAULT;
      options.epsilon = 1e-9;
      const auto ask = [&](const ConstraintPlace &place, cprox_pair_start *start) {
        cprox_result result;
        options.start = start;
        cprox_pair(cprox_obstacle_at(pair.a.parts[0].body.get(), place.a),
                   cprox_obstacle_at(pair.b.parts[0].body.get(), place.b), &options, workspace.get(), &result);
      };
      std::vector<cprox_pair_start> starts(at.places.size());
      for (std::size_t k = 0; k < starts.size(); ++k) {
        ConstraintPlace beside = at.places[k];
        beside.b.position.z += 1e-3;
        starts[k] = {};
        ask(beside, &starts[k]);
      }
      const Ask alone = [&](std::size_t k) { ask(at.places[k], nullptr); };
      const Ask warm = [&](std::size_t k) {
        cprox_pair_start start = starts[k];
        ask(at.places[k], &start);
      };
      const Ask whole = [&](std::size_t k) {
        value.start = {};
        constraint->evaluate(at.places[k], workspace, value);
      };
      const auto times = inTurns(at.places.size(), size.rounds, {alone, warm, whole});
      const std::string kinds = std::string(bodies[i].first) + " and " + bodies[j].first;
      printRow("providers", workload, "core", times[0], kinds);
      printRow("providers", workload, "core from beside", times[1], kinds);
      printRow("providers", workload, "curve_proximity", times[2], kinds);
    }
  }
}

/* Of each two kinds in space: what prepare() takes, and a value with its gradient at places where the spheres meet. */
void gapsOfAllKinds(pluginlib::ClassLoader<ConstraintProvider> &plugins, const bench_size &size) {
  const auto bodies = bodiesOfAllKinds();
  for (const int samples : {9, 33}) {
    const auto provider = plugins.createUniqueInstance("curve_proximity/FourierGap");
    provider->initialise({{"samples", samples}});
    const std::size_t n = samples == 9 ? 20 : 5;
    const std::string at_n = " n " + std::to_string(samples);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      for (std::size_t j = i; j < bodies.size(); ++j) {
        Random random;
        Workspace workspace;
        ConstraintValue value;
        ConstraintPair pair;
        pair.a = bodies[i].second, pair.b = bodies[j].second;
        const double begin = now();
        const auto constraint = provider->prepare(pair);
        const std::vector<double> prepared{now() - begin};
        std::vector<double> times(n, INFINITY);
        for (std::size_t k = 0; k < n; ++k) {
          ConstraintPlace place;
          place.a = random.pose(0.3), place.b = random.pose(0.3);
          for (int round = 0; round < std::min(size.rounds, 3); ++round) {
            const double start = now();
            constraint->evaluate(place, workspace, value);
            times[k] = std::min(times[k], now() - start);
          }
        }
        const std::string kinds = std::string(bodies[i].first) + " and " + bodies[j].first;
        printRow("providers", "gap prepared" + at_n, "curve_proximity", prepared, kinds);
        printRow("providers", "gap value and gradient" + at_n, "curve_proximity", times, kinds);
      }
    }
  }
}

/* The same of bodies that a curve carries past a box. */
void gapsAlongCurves(pluginlib::ClassLoader<ConstraintProvider> &plugins, Random &random) {
  const auto provider = plugins.createUniqueInstance("curve_proximity/FourierGap");
  provider->initialise({{"samples", 9}});
  const auto bodies = bodiesOfAllKinds();
  const Places at = randomPlaces(20, true, random);
  for (const auto &body : bodies) {
    Workspace workspace;
    ConstraintValue value;
    ConstraintPair pair;
    pair.along_curve = true;
    pair.a = body.second, pair.b = bodies[1].second;
    const auto constraint = provider->prepare(pair);
    std::vector<double> times;
    for (const ConstraintPlace &place : at.places) {
      const double begin = now();
      constraint->evaluate(place, workspace, value);
      times.push_back(now() - begin);
    }
    printRow("providers", "gap along a curve n 9", "curve_proximity", times, std::string(body.first) + " and box");
  }
}

} // namespace

int main(int argc, char **argv) {
  const bench_size size = bench_arguments(argc, argv);
  pluginlib::ClassLoader<ConstraintProvider> plugins("curve_proximity", "curve_proximity::ConstraintProvider");
  Random random;
  Workspace workspace;
  ConstraintValue value;
  const std::size_t n = size.problems;

  if (bench_wanted(&size, "CurveDistance")) {
    const auto provider = plugins.createUniqueInstance("curve_proximity/CurveDistance");
    provider->initialise({});
    ConstraintPair pair;
    pair.along_curve = true;
    pair.b = sideOf(ShapeType::BOX, {0.5, 0.7, 0.9});
    const auto constraint = provider->prepare(pair);
    const Places at = randomPlaces(n, true, random);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-9;
    options.signed_distance = true;
    const Ask core = [&](std::size_t i) {
      const cprox_mover mover = cprox_point_along(at.curves[i].curve.get());
      const cprox_obstacle target = cprox_obstacle_at(pair.b.parts[0].body.get(), at.places[i].b);
      cprox_result result;
      cprox_gradient gradient;
      if (cprox_distance(mover, target, &options, workspace.get(), &result) >= 0)
        cprox_distance_gradient(mover, target, &options, &result, workspace.get(), &gradient);
    };
    measure("CurveDistance", n, size.rounds, core,
            [&](std::size_t i) { constraint->evaluate(at.places[i], workspace, value); });
  }

  if (bench_wanted(&size, "SuperquadricDistance")) {
    const auto provider = plugins.createUniqueInstance("curve_proximity/SuperquadricDistance");
    provider->initialise({});
    ConstraintPair pair;
    pair.a = sideOf(ShapeType::SUPERQUADRIC, {0.4, 0.3, 0.5, 2.5, 3.5, 5.0});
    pair.b = sideOf(ShapeType::SUPERQUADRIC, {0.5, 0.6, 0.4, 4.0, 2.2, 6.0});
    const auto constraint = provider->prepare(pair);
    const Places at = randomPlaces(n, false, random);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-9;
    const Ask core = [&](std::size_t i) {
      cprox_result result;
      cprox_pair(cprox_obstacle_at(pair.a.parts[0].body.get(), at.places[i].a),
                 cprox_obstacle_at(pair.b.parts[0].body.get(), at.places[i].b), &options, workspace.get(), &result);
    };
    measure("SuperquadricDistance", n, size.rounds, core,
            [&](std::size_t i) { constraint->evaluate(at.places[i], workspace, value); });
  }

  if (bench_wanted(&size, "SuperquadricDistance beside its distance")) gradientsBesidePairs(plugins, size);

  if (bench_wanted(&size, "FourierGap")) {
    const auto provider = plugins.createUniqueInstance("curve_proximity/FourierGap");
    provider->initialise({{"samples", 9}, {"mode", std::string("signal")}});
    ConstraintPair pair;
    pair.a = sideOf(ShapeType::ELLIPSOID, {0.5, 0.3, 0.4});
    pair.b = sideOf(ShapeType::BOX, {0.5, 0.7, 0.6});
    const auto constraint = provider->prepare(pair);
    Places at = randomPlaces(n, false, random);
    for (ConstraintPlace &place : at.places) place.a.position.x -= 1.5;
    cprox_solid *a = nullptr, *b = nullptr;
    cprox_gap *gap = nullptr;
    cprox_gap_options options = CPROX_GAP_OPTIONS_DEFAULT;
    options.samples = 9;
    options.mode = CPROX_GAP_MODE_SIGNAL;
    cprox_solid_description ellipsoid{}, box{};
    ellipsoid.kind = CPROX_SOLID_ELLIPSOID;
    box.kind = CPROX_SOLID_BOX;
    ellipsoid.dimension = box.dimension = 3;
    ellipsoid.semi_axes = {0.5, 0.3, 0.4};
    box.size = {0.5, 0.7, 0.6};
    require(cprox_solid_create(&ellipsoid, workspace.get(), &a), workspace);
    require(cprox_solid_create(&box, workspace.get(), &b), workspace);
    require(cprox_gap_create(a, b, &options, workspace.get(), &gap), workspace);
    const Ask core = [&](std::size_t i) {
      cprox_gap_result result;
      cprox_gap_evaluate(gap, &at.places[i].a, &at.places[i].b, workspace.get(), &result);
    };
    measure("FourierGap", n, size.rounds, core,
            [&](std::size_t i) { constraint->evaluate(at.places[i], workspace, value); });
    cprox_gap_free(gap);
    cprox_solid_free(a);
    cprox_solid_free(b);
  }

  if (bench_wanted(&size, "gap of any two kinds")) {
    gapsOfAllKinds(plugins, size);
    gapsAlongCurves(plugins, random);
  }
  return 0;
}
