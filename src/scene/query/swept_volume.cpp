/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies at poses, grown by how far they move, are drawn into blocks of cells. doc/swept-volume.md */
#include <curve_proximity/swept_volume.hpp>

#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <sstream>

#include <curve_proximity/nearest_name.hpp>
#include <curve_proximity/parallel.hpp>

#include "motion/motion_data.h"

namespace curve_proximity {
namespace {

using Cell = std::array<std::int32_t, 3>;

constexpr int LEVELS = 5; /* a block has 2^5 cells a side */
constexpr std::int32_t SIDE = 1 << LEVELS;

/* A body at a pose, and the ball round all that it passes through there. */
struct SweptBody {
  std::int32_t geometry;
  bool has_planes; /* its support function is exact */
  cprox_obstacle placed;
  const cprox_body *surface; /* null: its depth is known */
  double displacement;
  Eigen::Vector3d centre;
  double radius;
  Eigen::Matrix3d turn; /* of the pose, as its position */
  Eigen::Vector3d position;
};

/* Implicit bodies have theirs from a solver, and support callbacks are someone else's. */
bool hasExactSupport(cprox_body_kind kind) {
  switch (kind) {
    case CPROX_BODY_POINT:
    case CPROX_BODY_SPHERE:
    case CPROX_BODY_BOX:
    case CPROX_BODY_CAPSULE:
    case CPROX_BODY_CYLINDER:
    case CPROX_BODY_CONE:
    case CPROX_BODY_ELLIPSOID:
    case CPROX_BODY_POLYTOPE:
    case CPROX_BODY_POLYGON:
    case CPROX_BODY_MESH:
    case CPROX_BODY_POINTS:
    case CPROX_BODY_OCTREE:
    case CPROX_BODY_LOD: return true;
    default: return false;
  }
}

/* All of a geometry is on one side: normal·x <= reach for each point x in its own frame. */
struct Plane {
  std::int32_t geometry = -1;
  Eigen::Vector3f normal;
  double reach = 0.0;
};

/* Does this plane part the cube with these half edges from the body, grown by its displacement? */
bool parts(const Plane &plane, const SweptBody &body, const Eigen::Vector3d &centre, double half) {
  constexpr double ROUNDING = 1e-12; /* of the sizes: some thousand roundings of doubles */
  const Eigen::Vector3d normal = body.turn * plane.normal.cast<double>();
  const double cube = normal.dot(centre) - half * normal.lpNorm<1>();
  const double all = plane.reach + normal.dot(body.position) + (body.placed.margin + body.displacement) * normal.norm();
  const double sizes = centre.lpNorm<1>() + half + body.position.lpNorm<1>() + body.radius + std::fabs(plane.reach);
  return cube - all > ROUNDING * sizes;
}

void demandTime(const SweepOptions &options) {
  if (options.stop && options.stop(options.stop_user)) throw Error("stopped", CPROX_STOPPED);
}

/* room: [bytes] for them. */
std::vector<SweptBody> bodiesAlong(const RobotMotion::Data &data, const SweepOptions &options, double displacement,
                                   double room, Workspace &workspace) {
  std::vector<SweptBody> out;
  const Kinematics &kinematics = *data.kinematics;
  for (std::size_t i = 0; i < kinematics.geometries.size(); ++i) {
    const MovingGeometry &geometry = kinematics.geometries[i];
    if (!data.wanted[i] || geometry.within) continue;
    const std::vector<std::string> &links = options.links;
    if (!links.empty() && std::find(links.begin(), links.end(), *geometry.link) == links.end()) continue;
    std::vector<cprox_swept_pose> poses;
    for (std::size_t n = 0, most = 64;; most = n) {
      poses.resize(most);
      const cprox_status status = cprox_motion_sweep(data.core.get(), static_cast<std::int32_t>(i), displacement,
                                                     workspace.get(), most, poses.data(), &n);
      demandTime(options);
      if (status != CPROX_OK) throw Error(workspace.reason(), status);
      const double bytes =
          2.0 * static_cast<double>(out.size() + n) * sizeof(SweptBody); // a list that grows is there twice
      if (bytes > room)
        throw Error("a resolution of " + std::to_string(options.resolution) + " m takes more than " +
                        std::to_string(out.size() + n) + " bodies at poses, " + std::to_string(bytes / 1e9) +
                        " GB, the limit is " + std::to_string(static_cast<double>(options.memory_limit) / 1e9) + " GB",
                    CPROX_MEMORY);
      if (n > most) continue;
      poses.resize(n);
      break;
    }
    const double margin = marginOf(data, i);
    const cprox_body_info info = cprox_body_get_info(geometry.body);
    const Eigen::Vector3d middle(info.centre.x, info.centre.y, info.centre.z);
    for (const cprox_swept_pose &pose : poses) {
      const Eigen::Quaterniond turn = Eigen::Quaterniond(pose.pose.orientation.w, pose.pose.orientation.x,
                                                         pose.pose.orientation.y, pose.pose.orientation.z)
                                          .normalized();
      const Eigen::Vector3d at(pose.pose.position.x, pose.pose.position.y, pose.pose.position.z);
      out.push_back({static_cast<std::int32_t>(i), hasExactSupport(info.kind),
                     cprox_with_margin(cprox_obstacle_at(geometry.body, pose.pose), margin),
                     geometry.is_mesh ? shapeOf(data, i).surface.get() : nullptr, pose.displacement, at + turn * middle,
                     (info.radius + margin + pose.displacement) * (1.0 + 1e-9), turn.toRotationMatrix(), at});
    }
  }
  return out;
}

/* Cells of a block, and of the blocks of 2³, 4³, … of them; level 0 are the cells. */
class Block {
 public:
  Block(const Cell &first, const SweepOptions &options, const std::vector<BodyHandle> &boxes)
      : first_(first), resolution_(options.resolution), wants_inside_(options.inside), boxes_(boxes) {
    for (int level = 0; level <= LEVELS; ++level) full_[level].assign(std::size_t{1} << 3 * (LEVELS - level), false);
    inside_.assign(std::size_t{1} << 3 * LEVELS, false);
    for (int level = 0; level <= LEVELS; ++level) {
      planes_[level].resize(full_[level].size());
      entered_[level].assign(full_[level].size(), -1);
    }
  }

  bool isFull() const {
    return full_[LEVELS][0];
  }

  /* Every cell that the body may touch over its interval. */
  void draw(const SweptBody &body, Workspace &workspace) {
    draw(body, LEVELS, {0, 0, 0}, workspace);
  }

  void take(std::vector<std::pair<Cell, bool>> &out) const {
    for (std::int32_t x = 0; x < SIDE; ++x)
      for (std::int32_t y = 0; y < SIDE; ++y)
        for (std::int32_t z = 0; z < SIDE; ++z) {
          const std::size_t i = index(0, {x, y, z});
          if (full_[0][i]) out.push_back({{first_[0] + x, first_[1] + y, first_[2] + z}, inside_[i]});
        }
  }

 private:
  static std::size_t index(int level, const Cell &at) {
    const int bits = LEVELS - level;
    return static_cast<std::size_t>((at[0] << 2 * bits) + (at[1] << bits) + at[2]);
  }

  Eigen::Vector3d centreOf(int level, const Cell &at) const {
    Eigen::Vector3d out;
    const double side = 1 << level;
    for (int i = 0; i < 3; ++i) out[i] = resolution_ * (first_[i] + (at[i] + 0.5) * side);
    return out;
  }

  /* False where the ball round the body parts it from the block, or one of two planes: the one that was the last to do
   * so here, or anywhere, which is beside here. */
  bool isNear(const SweptBody &body, int level, std::size_t i, const Eigen::Vector3d &centre) {
    const double half = 0.5 * resolution_ * (1 << level);
    if ((body.centre - centre).norm() > body.radius + 1.7320508075688774 * half * (1.0 + 1e-9)) return false;
    Plane &here = planes_[level][i];
    for (const Plane &plane : {here, last_}) {
      if (plane.geometry != body.geometry || !parts(plane, body, centre, half * (1.0 + 1e-9))) continue;
      here = last_ = plane;
      return false;
    }
    return true;
  }

  /* Whether the body may touch the block of that level; where not, a plane that parts them is kept. */
  bool touches(const SweptBody &body, int level, std::size_t i, const Eigen::Vector3d &centre, Workspace &workspace) {
    const cprox_obstacle box =
        cprox_obstacle_at(boxes_[static_cast<std::size_t>(level)].get(), {toVec3(centre), {1, 0, 0, 0}});
    cprox_result result{};
    const cprox_status status =
        cprox_pair_tolerance(box, body.placed, body.displacement, nullptr, workspace.get(), &result);
    if (status < 0) throw Error(workspace.reason(), status);
    if (result.verdict != CPROX_VERDICT_CLEAR) return true;
    const Eigen::Vector3d normal(result.normal.x, result.normal.y, result.normal.z); /* from the body to the box */
    if (body.has_planes && normal.allFinite() && normal.squaredNorm() > 0.5) {
      last_.geometry = body.geometry;
      last_.normal = (body.turn.transpose() * normal).cast<float>();
      last_.reach = cprox_body_support(body.placed.body, toVec3(last_.normal.cast<double>()), nullptr);
      planes_[level][i] = last_;
    }
    return false;
  }

  /* Whether the body, in the middle of its interval, fills the ball round the cell: it has the ball's centre, and its
   * surface is no nearer than the radius. 1e-9 m is a million times what its place there is off. */
  bool fills(const SweptBody &body, const Eigen::Vector3d &centre, Workspace &workspace) const {
    const double radius = 0.8660254037844387 * resolution_ * (1.0 + 1e-9) + 1e-9;
    cprox_obstacle at = cprox_obstacle_at(boxes_.back().get(), {toVec3(centre), {1, 0, 0, 0}});
    cprox_result result{};
    cprox_status status = cprox_pair(at, body.placed, nullptr, workspace.get(), &result);
    if (status < 0) throw Error(workspace.reason(), status);
    if (result.upper <= -radius) return true;
    if (!body.surface || result.upper > 0.0) return false;
    const cprox_obstacle surface = cprox_obstacle_at(body.surface, body.placed.pose);
    status = cprox_pair_tolerance(at, surface, radius, nullptr, workspace.get(), &result);
    if (status < 0) throw Error(workspace.reason(), status);
    if (result.verdict != CPROX_VERDICT_CLEAR) return false;
    at.margin = 0.0;
    cprox_obstacle bare = body.placed;
    bare.margin = 0.0;
    status = cprox_pair_tolerance(at, bare, 0.0, nullptr, workspace.get(), &result);
    return status >= 0 && result.verdict == CPROX_VERDICT_VIOLATED;
  }

  /* Whether the body may touch it. A block that the geometry was in at its last pose is not asked about itself: its
   * parts are. */
  bool draw(const SweptBody &body, int level, const Cell &at, Workspace &workspace) {
    const std::size_t i = index(level, at);
    if (done(level, i)) return true;
    const Eigen::Vector3d centre = centreOf(level, at);
    if (level == 0 && full_[0][i]) {
      inside_[i] = fills(body, centre, workspace);
      return true;
    }
    if (!isNear(body, level, i, centre)) return false;
    if (level == 0) {
      if (!touches(body, 0, i, centre, workspace)) return false;
      full_[0][i] = true;
      inside_[i] = wants_inside_ && fills(body, centre, workspace);
      return true;
    }
    if (entered_[level][i] != body.geometry && !touches(body, level, i, centre, workspace)) return false;
    bool full = true, entered = false;
    for (int k = 0; k < 8; ++k) {
      const Cell child = {2 * at[0] + (k & 1), 2 * at[1] + (k >> 1 & 1), 2 * at[2] + (k >> 2)};
      entered = draw(body, level - 1, child, workspace) || entered;
      full = full && done(level - 1, index(level - 1, child));
    }
    full_[level][i] = full;
    entered_[level][i] = entered ? body.geometry : -1;
    return entered;
  }

  /* Nothing more can be learned of it. */
  bool done(int level, std::size_t i) const {
    return level == 0 && wants_inside_ ? inside_[i] : full_[level][i];
  }

  const Cell first_;
  const double resolution_;
  const bool wants_inside_;
  const std::vector<BodyHandle> &boxes_;
  std::vector<bool> full_[LEVELS + 1]; /* of level 0: in the cover; above: all its cells are done */
  std::vector<bool> inside_;
  std::vector<Plane> planes_[LEVELS + 1];         /* the last that parted a geometry from the block */
  Plane last_;                                    /* the last of all */
  std::vector<std::int32_t> entered_[LEVELS + 1]; /* the geometry that was last in it; -1: none */
};

void append(std::string &out, const void *bytes, std::size_t n) {
  out.append(static_cast<const char *>(bytes), n);
}

bool isWanted(const SweptVolume &volume, std::size_t i, bool inside_only) {
  return !inside_only || volume.inside[i];
}

void fill(octomap::OcTree &tree, const SweptVolume &volume, bool inside_only) {
  for (std::size_t i = 0; i < volume.cells.size(); ++i) {
    if (!isWanted(volume, i, inside_only)) continue;
    octomap::OcTreeKey key;
    for (int k = 0; k < 3; ++k) {
      const std::int32_t place = volume.cells[i][k] + (1 << 15);
      if (place < 0 || place >= 1 << 16) throw Error("the swept volume is larger than an octree of this resolution");
      key[static_cast<unsigned>(k)] = static_cast<octomap::key_type>(place);
    }
    tree.updateNode(key, true, true);
  }
  tree.updateInnerOccupancy();
  tree.toMaxLikelihood();
  tree.prune();
}

} // namespace

SweptVolume sweptVolume(const RobotMotion &motion, const SweepOptions &options) {
  const double r = options.resolution;
  if (!(r > 0.0 && std::isfinite(r)))
    throw Error("the resolution is " + std::to_string(r) + ", must be above 0 (metres)");
  Workspace workspace;
  cprox_workspace_set_stop(workspace.get(), options.stop, options.stop_user);
  SweptVolume out;
  out.resolution = r;
  const double displacement = 0.5 * r;

  const auto &known = motion.data().kinematics->robot->links();
  for (const std::string &link : options.links)
    if (known.count(link) == 0) throw Error("the robot has no link '" + link + "'" + didYouMean(link, namesOf(known)));

  /* the blocks that the bodies may reach, by few poses: all memory is known before the work begins */
  constexpr double ROUGH = 0.01;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
  const auto limit = static_cast<double>(options.memory_limit);
  for (const SweptBody &body : bodiesAlong(motion.data(), options, std::max(displacement, ROUGH), limit, workspace)) {
    low = low.cwiseMin((body.centre.array() - body.radius).matrix());
    high = high.cwiseMax((body.centre.array() + body.radius).matrix());
  }
  if (!(low.x() <= high.x())) throw Error("the motion has no collision geometry");
  std::array<std::int32_t, 3> first{}, n{};
  double cells = 1.0;
  for (int i = 0; i < 3; ++i) {
    const double from = std::floor(low[i] / (r * SIDE)), to = std::floor(high[i] / (r * SIDE)) + 1.0;
    cells *= (to - from) * SIDE;
    if (!(std::fabs(from) * SIDE < 1e9 && std::fabs(to) * SIDE < 1e9)) cells = INFINITY;
    if (!std::isfinite(cells)) break;
    first[i] = static_cast<std::int32_t>(from), n[i] = static_cast<std::int32_t>(to - from);
  }
  constexpr double BYTES = 16.0; /* of a cell in the lists */
  if (!(cells * BYTES <= limit))
    throw Error("a resolution of " + std::to_string(r) + " m takes up to " + std::to_string(cells * BYTES / 1e9) +
                    " GB, the limit is " + std::to_string(limit / 1e9) + " GB",
                CPROX_MEMORY);

  const std::vector<SweptBody> bodies =
      bodiesAlong(motion.data(), options, displacement, limit - cells * BYTES, workspace);
  out.n_poses = bodies.size();
  std::vector<BodyHandle> boxes;
  for (int level = 0; level <= LEVELS; ++level) boxes.push_back(makeBox(Eigen::Vector3d::Constant(r * (1 << level))));
  boxes.push_back(makePoint(Eigen::Vector3d::Zero()));
  std::vector<std::pair<Cell, bool>> found;
  std::mutex mutex;
  Pool pool(options.threads);
  const std::size_t blocks =
      static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(n[2]);
  pool.run(blocks, 1, [&](std::size_t from, std::size_t to, Workspace &own) {
    for (std::size_t i = from; i < to; ++i) {
      const auto at = static_cast<std::int32_t>(i);
      const Cell corner = {SIDE * (first[0] + at / (n[1] * n[2])), SIDE * (first[1] + at / n[2] % n[1]),
                           SIDE * (first[2] + at % n[2])};
      Block block(corner, options, boxes);
      for (const SweptBody &body : bodies) {
        demandTime(options);
        if (!block.isFull()) block.draw(body, own);
      }
      const std::lock_guard<std::mutex> lock(mutex);
      block.take(found);
    }
  });
  std::sort(found.begin(), found.end());
  for (const auto &[cell, inside] : found) out.cells.push_back(cell), out.inside.push_back(inside);
  /* a cell's farthest corner, where it touches the grown body, and back to the body */
  out.gap = (1.7320508075688774 * r + displacement) * (1.0 + 1e-9) + 1e-6;
  return out;
}

std::string toStl(const SweptVolume &volume, bool inside_only) {
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < volume.cells.size(); ++i)
    if (isWanted(volume, i, inside_only)) cells.push_back(volume.cells[i]);
  std::string facets;
  std::uint32_t n = 0;
  for (const Cell &cell : cells) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        Cell beside = cell;
        beside[axis] += side ? 1 : -1;
        if (std::binary_search(cells.begin(), cells.end(), beside)) continue;
        /* counter-clockwise, seen from outside */
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        float corner[4][3], normal[3] = {0, 0, 0};
        for (int k = 0; k < 4; ++k) {
          std::array<std::int32_t, 3> at = cell;
          at[axis] += side;
          at[side ? u : v] += k == 1 || k == 2;
          at[side ? v : u] += k >= 2;
          for (int i = 0; i < 3; ++i) corner[k][i] = static_cast<float>(at[i] * volume.resolution);
        }
        normal[axis] = side ? 1.0F : -1.0F;
        for (int half = 0; half < 2; ++half) {
          append(facets, normal, sizeof normal);
          for (const int k : {0, half + 1, half + 2}) append(facets, corner[k], sizeof corner[k]);
          facets.append(2, '\0');
          ++n;
        }
      }
    }
  }
  std::string out(80, ' ');
  append(out, &n, sizeof n);
  return out + facets;
}

OctreeData toOctree(const SweptVolume &volume, bool inside_only) {
  octomap::OcTree tree(volume.resolution);
  fill(tree, volume, inside_only);
  std::ostringstream data;
  tree.writeBinaryData(data);
  return {tree.getTreeType(), volume.resolution, true, data.str()};
}

std::string toOctomap(const SweptVolume &volume, bool inside_only) {
  octomap::OcTree tree(volume.resolution);
  fill(tree, volume, inside_only);
  /* octomap's own header is written with a message on the console, and six digits */
  std::ostringstream out;
  out.precision(17);
  out << "# Octomap OcTree binary file\nid " << tree.getTreeType() << "\nsize " << tree.size() << "\nres "
      << volume.resolution << "\ndata\n";
  tree.writeBinaryData(out);
  return out.str();
}

} // namespace curve_proximity
