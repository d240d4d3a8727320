/* SPDX-License-Identifier: BSD-3-Clause */
#include "broadphase.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include <fcl/config.h>
#if FCL_MAJOR_VERSION == 0 && FCL_MINOR_VERSION < 6
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/collision_object.h>
#else
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/narrowphase/collision_object.h>
#endif

namespace curve_proximity {
namespace {

/* Ubuntu 20.04 has FCL 0.5, without templates; Debian 12 has 0.7. */
#if FCL_MAJOR_VERSION == 0 && FCL_MINOR_VERSION < 6
using FclVector = fcl::Vec3f;
using FclGeometry = fcl::CollisionGeometry;
using FclObject = fcl::CollisionObject;
using FclTree = fcl::DynamicAABBTreeCollisionManager;
#else
using FclVector = fcl::Vector3d;
using FclGeometry = fcl::CollisionGeometryd;
using FclObject = fcl::CollisionObjectd;
using FclTree = fcl::DynamicAABBTreeCollisionManagerd;
#endif

FclVector toFcl(const Eigen::Vector3d &v) {
  return FclVector(v.x(), v.y(), v.z());
}

/* A geometry that is nothing but its box: FCL takes it over bit by bit, since the pose stays the identity. */
class BoxGeometry : public FclGeometry {
 public:
  explicit BoxGeometry(const Eigen::AlignedBox3d &box) {
    aabb_local.min_ = toFcl(box.min());
    aabb_local.max_ = toFcl(box.max());
    const Eigen::Vector3d centre = 0.5 * box.min() + 0.5 * box.max();
    aabb_center = toFcl(centre);
    aabb_radius = (box.max() - centre).norm();
    user_data = nullptr;
  }

  void computeLocalAABB() override {}
};

/* One box in the tree. */
struct Entry {
  Entry(std::size_t n, const Eigen::AlignedBox3d &b) : number(n), box(b), object(std::make_shared<BoxGeometry>(b)) {
    object.setUserData(this);
  }

  std::size_t number;
  Eigen::AlignedBox3d box;
  FclObject object;
};

const Entry &entryOf(FclObject *a, FclObject *b, const FclObject *query) {
  return *static_cast<const Entry *>((a == query ? b : a)->getUserData());
}

struct NearestQuery {
  const FclObject *object;
  const Eigen::AlignedBox3d *box;
  const std::vector<std::uint32_t> *names;
  NearestBox best;
};

bool visitNearest(FclObject *a, FclObject *b, void *data, double &limit) {
  auto &query = *static_cast<NearestQuery *>(data);
  const Entry &entry = entryOf(a, b, query.object);
  const std::uint32_t name = (*query.names)[entry.number];
  const double gap = name == NO_BOX ? query.best.gap : boxGap(entry.box, *query.box);
  if (gap < query.best.gap) query.best = {name, gap};
  limit = query.best.gap;
  return query.best.gap <= 0.0; // nothing can be nearer
}

struct WithinQuery {
  const FclObject *object;
  const std::vector<std::uint32_t> *names;
  std::vector<std::uint32_t> *found;
};

bool visitWithin(FclObject *a, FclObject *b, void *data) {
  const auto &query = *static_cast<WithinQuery *>(data);
  const std::uint32_t name = (*query.names)[entryOf(a, b, query.object).number];
  if (name != NO_BOX) query.found->push_back(name);
  return false;
}

} // namespace

double boxGap(const Eigen::AlignedBox3d &a, const Eigen::AlignedBox3d &b) {
  // A difference of doubles is within 2^-53 of itself, and so is each step after it: 8 of them.
  const Eigen::Vector3d between = (a.min() - b.max()).cwiseMax(b.min() - a.max()).cwiseMax(Eigen::Vector3d::Zero());
  return between.stableNorm() * (1.0 - 4.0 * std::numeric_limits<double>::epsilon());
}

struct Broadphase::Tree {
  std::deque<Entry> entries; /* FCL points at them: they stay where they are */
  FclTree manager;
};

Broadphase::Broadphase(const std::vector<Eigen::AlignedBox3d> &boxes) : tree_(new Tree) {
  std::vector<FclObject *> objects;
  objects.reserve(boxes.size());
  for (const Eigen::AlignedBox3d &box : boxes) {
    tree_->entries.emplace_back(objects.size(), box);
    objects.push_back(&tree_->entries.back().object);
  }
  tree_->manager.registerObjects(objects);
  tree_->manager.setup();
}

Broadphase::~Broadphase() = default;

NearestBox Broadphase::nearest(const std::vector<Eigen::AlignedBox3d> &to,
                               const std::vector<std::uint32_t> &names) const {
  NearestBox best;
  for (const Eigen::AlignedBox3d &box : to) {
    FclObject object(std::make_shared<BoxGeometry>(box));
    NearestQuery query{&object, &box, &names, best};
    tree_->manager.distance(&object, &query, &visitNearest);
    best = query.best;
    if (best.gap <= 0.0) break;
  }
  return best;
}

void Broadphase::within(const std::vector<Eigen::AlignedBox3d> &of, double reach,
                        const std::vector<std::uint32_t> &names, std::vector<std::uint32_t> &found) const {
  for (const Eigen::AlignedBox3d &box : of) {
    // Outward by a little more than the reach, so that rounding leaves nothing out.
    const double size = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
    const double by = reach + 1e-14 * (reach + size);
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(by);
    FclObject object(std::make_shared<BoxGeometry>(Eigen::AlignedBox3d(box.min() - margin, box.max() + margin)));
    WithinQuery query{&object, &names, &found};
    tree_->manager.collide(&object, &query, &visitWithin);
  }
}

} // namespace curve_proximity
