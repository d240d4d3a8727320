/* SPDX-License-Identifier: BSD-3-Clause */
/* Which boxes are near this one? FCL's dynamic tree behind a small interface; broadphase.cpp alone knows FCL. */
#ifndef CURVE_PROXIMITY_SCENE_BROADPHASE_H
#define CURVE_PROXIMITY_SCENE_BROADPHASE_H

#include <cstdint>
#include <Eigen/Geometry>
#include <limits>
#include <memory>
#include <vector>

namespace curve_proximity {

/* A lower bound of the distance between two boxes [m]: 0 where they touch; rounded down. */
double boxGap(const Eigen::AlignedBox3d &a, const Eigen::AlignedBox3d &b);

/* The name of a box that is not to be found. */
constexpr std::uint32_t NO_BOX = std::numeric_limits<std::uint32_t>::max();

struct NearestBox {
  std::uint32_t id = 0;                                 /* its name */
  double gap = std::numeric_limits<double>::infinity(); /* boxGap; infinity: there is no box */
};

/* Immutable; its queries change nothing and may run in any number of threads. */
class Broadphase {
 public:
  /* The boxes, finite. Each query gives them names, in their order: a box without one is not found. */
  explicit Broadphase(const std::vector<Eigen::AlignedBox3d> &boxes);
  ~Broadphase();
  Broadphase(const Broadphase &) = delete;
  Broadphase &operator=(const Broadphase &) = delete;

  /* The box that is nearest to any of the boxes asked about, by boxGap within a relative 1e-12. */
  NearestBox nearest(const std::vector<Eigen::AlignedBox3d> &to, const std::vector<std::uint32_t> &names) const;

  /* Appends the names of at least all boxes whose distance from any of the boxes asked about is at most `reach`
   * (finite, >= 0); a name may come several times. */
  void within(const std::vector<Eigen::AlignedBox3d> &of, double reach, const std::vector<std::uint32_t> &names,
              std::vector<std::uint32_t> &found) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

} // namespace curve_proximity
#endif
