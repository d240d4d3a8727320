/* SPDX-License-Identifier: BSD-3-Clause */
#include "hull.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <new>
#include <tuple>
#include <utility>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace curve_proximity {
namespace {

/* Below so many points a hull computation costs more than it saves. */
constexpr std::size_t FEW_POINTS = 16;

/* Points that the hull computation dropped may stand out of the hull by this fraction of the set's size: then they are
 * covered by the excess. Farther ones are taken back. */
constexpr double DROPPED_TOLERANCE = 1e-12;

/* A set whose thickness is below this fraction of its size has no hull that qhull could compute. */
constexpr double FLATNESS = 1e-9;

/* Accuracy of cprox_body_nearest(), per unit of |point| + size (cprox/body.h). */
constexpr double NEAREST_ROUNDING = 64.0 * std::numeric_limits<double>::epsilon() / 2.0;

double largestCoordinate(const Points &points) {
  double largest = 0.0;
  for (const Eigen::Vector3d &p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return largest;
}

/* The farthest point by a measure, and how far. */
template <typename Measure>
std::pair<Eigen::Vector3d, double> farthest(const Points &points, Measure measure) {
  std::pair<Eigen::Vector3d, double> best(points.front(), -1.0);
  for (const Eigen::Vector3d &p : points) {
    const double d = measure(p);
    if (d > best.second) best = {p, d};
  }
  return best;
}

/* Is there no thickness to speak of? By the simplex of points that are each farthest from those before. */
bool isFlat(const Points &points) {
  const Eigen::Vector3d a = points.front();
  const auto [b, length] = farthest(points, [&, &a = a](const Eigen::Vector3d &p) { return (p - a).norm(); });
  if (!(length > 0.0)) return true;
  const Eigen::Vector3d along = (b - a) / length;
  const auto [c, width] = farthest(points, [&](const Eigen::Vector3d &p) { return along.cross(p - a).norm(); });
  if (!(width > FLATNESS * length)) return true;
  const Eigen::Vector3d normal = along.cross(c - a) / width;
  const auto [d, thickness] = farthest(points, [&](const Eigen::Vector3d &p) { return std::abs(normal.dot(p - a)); });
  (void)d;
  return !(thickness > FLATNESS * length);
}

/* ---- qhull ---- */

/* Qhull has no stop function. It reports its progress to a file, though (option TF), and stops by itself after so many
 * vertices (qh->STOPadd): so the file asks the stop function, and then takes that number down. */
class Progress {
 public:
  Progress(qhT *qh, const std::function<bool()> &stop) : qh_(qh), stop_(stop) {
    cookie_io_functions_t functions{};
    functions.write = write;
    file_.reset(fopencookie(this, "w", functions));
    if (!file_) throw std::bad_alloc();
    std::setvbuf(file_.get(), nullptr, _IONBF, 0);
  }
  Progress(const Progress &) = delete;
  Progress &operator=(const Progress &) = delete;

  FILE *file() const {
    return file_.get();
  }

  bool isStopped() const {
    return stopped_;
  }

 private:
  static ssize_t write(void *self, const char *, std::size_t size) {
    Progress &own = *static_cast<Progress *>(self);
    if (!own.stopped_ && own.stop_ && own.stop_()) own.stopped_ = true, own.qh_->STOPadd = 1;
    return static_cast<ssize_t>(size);
  }

  qhT *const qh_;
  const std::function<bool()> &stop_;
  bool stopped_ = false;
  std::unique_ptr<FILE, int (*)(FILE *)> file_{nullptr, std::fclose};
};

/* ---- the proof that points are covered ---- */

/* A set seen from a point within: each facet of the hull is the end of a cone. A point that is a convex combination of
 * that centre and of the corners of a facet is in the hull, whatever the facets are. The weights come from
 * determinants, and how far the combination is from the point is measured: errors of the weights are harmless. */
class Cones {
 public:
  /* centre: in the hull of the points. */
  Cones(const Points &points, const std::vector<HullFacet> &facets, const Eigen::Vector3d &centre)
      : points_(points), centre_(centre) {
    for (const HullFacet &corners : facets) add(corners);
    link();
  }

  /* A bound on the distance from p to the hull but for rounding, infinity where the walk from cone to cone does not
   * arrive. The walk starts at the cone of the last point. */
  double distance(const Eigen::Vector3d &p) {
    if (cones_.empty()) return INFINITY;
    const Eigen::Vector3d way = p - centre_;
    for (std::size_t step = 0; step < MOST_STEPS; ++step) {
      const Cone &cone = cones_[static_cast<std::size_t>(at_)];
      Eigen::Vector3d weight;
      for (int k = 0; k < 3; ++k) weight[k] = cone.side[k].dot(way);
      int least = 0;
      for (int k = 1; k < 3; ++k)
        if (weight[k] < weight[least]) least = k;
      if (weight[least] >= -ON_EDGE * weight.cwiseAbs().sum()) return residual(cone, weight, p);
      if (cone.next[least] < 0) return INFINITY;
      at_ = cone.next[least];
    }
    return INFINITY;
  }

 private:
  static constexpr std::size_t MOST_STEPS = 2000;
  static constexpr double ON_EDGE = 1e-9;

  struct Cone {
    std::array<int, 3> corner;
    Eigen::Vector3d side[3]; /* the weight of a corner, per unit of way */
    std::array<int, 3> next; /* the cone beyond the side, across from the corner */
  };

  void add(const HullFacet &corners) {
    std::array<Eigen::Vector3d, 3> v;
    for (std::size_t k = 0; k < 3; ++k) v[k] = points_[static_cast<std::size_t>(corners[k])] - centre_;
    const double volume = v[0].dot(v[1].cross(v[2]));
    if (!(std::abs(volume) > std::numeric_limits<double>::min())) return;
    Cone cone;
    cone.corner = corners;
    cone.next = {-1, -1, -1};
    for (std::size_t k = 0; k < 3; ++k) cone.side[k] = v[(k + 1) % 3].cross(v[(k + 2) % 3]) / volume;
    cones_.push_back(cone);
  }

  void link() {
    struct Edge {
      std::uint64_t ends;
      int cone, corner;
    };
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < cones_.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto a = static_cast<std::uint32_t>(cones_[i].corner[(k + 1) % 3]),
                   b = static_cast<std::uint32_t>(cones_[i].corner[(k + 2) % 3]);
        edges.push_back(
            {std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), static_cast<int>(i), static_cast<int>(k)});
      }
    }
    std::sort(edges.begin(), edges.end(),
              [](const Edge &a, const Edge &b) { return std::tie(a.ends, a.cone) < std::tie(b.ends, b.cone); });
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
      if (edges[i].ends != edges[i + 1].ends) continue;
      const Edge &a = edges[i], &b = edges[i + 1];
      cones_[static_cast<std::size_t>(a.cone)].next[static_cast<std::size_t>(a.corner)] = b.cone;
      cones_[static_cast<std::size_t>(b.cone)].next[static_cast<std::size_t>(b.corner)] = a.cone;
    }
  }

  double residual(const Cone &cone, const Eigen::Vector3d &found, const Eigen::Vector3d &p) const {
    Eigen::Vector3d weight = found.cwiseMax(0.0);
    const double sum = weight.sum();
    if (!std::isfinite(sum)) return INFINITY;
    if (sum > 1.0) weight /= sum;
    const double of_centre = std::max(0.0, 1.0 - weight.sum());
    Eigen::Vector3d q = of_centre * centre_;
    for (int k = 0; k < 3; ++k)
      q += weight[k] * points_[static_cast<std::size_t>(cone.corner[static_cast<std::size_t>(k)])];
    return (p - q).norm();
  }

  const Points &points_;
  const Eigen::Vector3d centre_;
  std::vector<Cone> cones_;
  int at_ = 0;
};

bool lexicallyLess(const Eigen::Vector3d &a, const Eigen::Vector3d &b) {
  return std::make_tuple(a.x(), a.y(), a.z()) < std::make_tuple(b.x(), b.y(), b.z());
}

Eigen::Vector3d meanOf(const Points &points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d &p : points) sum += p / static_cast<double>(points.size());
  return sum;
}

} // namespace

/* Qhull's own check of its result (option Tv) takes a hundred times as long as its work. coveringPoints() proves what
 * is needed of the result instead. */
HullSurface hullSurfaceOf(const Points &points, const std::function<bool()> &stop) {
  HullSurface out;
  if (points.size() < 4) return out;
  const auto memory = std::make_unique<qhT>();
  qhT *qh = memory.get();
  const Progress progress(qh, stop);
  qh_zero(qh, progress.file());
  Points copy = points; /* qhull may change its input */
  /* Progress is asked for only where it is needed: qhull prints the time with it, by a function that threads share. */
  char silent[] = "qhull Qt", printing[] = "qhull Qt TF500";
  char *const command = stop ? printing : silent;
  const int failed = qh_new_qhull(qh, 3, static_cast<int>(copy.size()), copy.front().data(), False, command,
                                  progress.file(), progress.file());
  if (failed == 0 && !progress.isStopped()) {
    std::vector<int> number(points.size(), -1);
    vertexT *vertex = nullptr, **vertexp = nullptr;
    facetT *facet = nullptr;
    FORALLvertices {
      const auto id = static_cast<std::size_t>(qh_pointid(qh, vertex->point));
      if (id >= points.size()) continue;
      number[id] = static_cast<int>(out.points.size());
      out.points.push_back(points[id]);
    }
    FORALLfacets {
      HullFacet corners{-1, -1, -1};
      std::size_t n = 0;
      FOREACHvertex_(facet->vertices) {
        const auto id = static_cast<std::size_t>(qh_pointid(qh, vertex->point));
        if (n < 3 && id < points.size()) corners[n] = number[id];
        ++n;
      }
      if (n == 3 && *std::min_element(corners.begin(), corners.end()) >= 0) out.facets.push_back(corners);
    }
  }
  int blocks = 0, bytes = 0;
  qh_freeqhull(qh, !qh_ALL);
  qh_memfreeshort(qh, &blocks, &bytes);
  if (progress.isStopped()) throw Error("stopped while its hull was made", CPROX_STOPPED);
  return out;
}

BodyHandle polytopeOf(const Points &points) {
  return makePolytope(
      Eigen::Map<const Eigen::Matrix3Xd>(points.front().data(), 3, static_cast<Eigen::Index>(points.size())));
}

HullPoints coveringPoints(const Points &all, Points kept, const std::vector<HullFacet> &facets) {
  const BodyHandle hull = polytopeOf(kept);
  const auto askCore = [&](const Eigen::Vector3d &p) { return cprox_body_nearest(hull.get(), toVec3(p), nullptr); };
  const double size = largestCoordinate(all), tolerance = DROPPED_TOLERANCE * size;

  // The centre is in the hull up to `centre_out`; then so is every combination with it.
  const Eigen::Vector3d centre = meanOf(kept);
  const double centre_out = std::max(0.0, askCore(centre));
  Cones cones(kept, centre_out <= tolerance / 4 ? facets : std::vector<HullFacet>(), centre);
  Points sorted = kept;
  std::sort(sorted.begin(), sorted.end(), lexicallyLess);

  // What stands out a little is told, what stands out farther is taken back.
  HullPoints out;
  Points back;
  for (const Eigen::Vector3d &p : all) {
    if (std::binary_search(sorted.begin(), sorted.end(), p, lexicallyLess)) continue;
    double out_by = cones.distance(p) + centre_out;
    if (!(out_by <= tolerance / 2)) out_by = askCore(p);
    if (out_by <= tolerance) {
      out.excess = std::max(out.excess, out_by);
    } else {
      back.push_back(p);
    }
  }
  kept.insert(kept.end(), back.begin(), back.end());
  out.kept = std::move(kept);
  // Covers the rounding of the core's answers, and that of a combination: 20 u of the size.
  out.excess += NEAREST_ROUNDING * 6.0 * size;
  return out;
}

HullPoints hullPointsOf(const Points &all) {
  if (all.size() > FEW_POINTS && !isFlat(all)) {
    HullSurface surface = hullSurfaceOf(all);
    if (surface.points.size() >= 4) return coveringPoints(all, std::move(surface.points), surface.facets);
  }
  return {all, 0.0};
}

} // namespace curve_proximity
