/* SPDX-License-Identifier: BSD-3-Clause */
#include "near_items.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "geometry/placing.h"

namespace curve_proximity {
namespace {

using Box = Eigen::AlignedBox3d;

/* Up to so many items the core alone is faster. */
constexpr std::size_t MANY_ITEMS = 64;

/* Boxes cost a forward kinematics for each geometry and segment, whatever the budget: so many links and geometries may
 * be placed for all of them. */
constexpr std::size_t MOST_SEGMENTS = 256, MOST_PLACED = 1000000;

/* Of the sizes that enter a box: some roundings of doubles. */
constexpr double BOX_ROUNDING = 1e-12;

/* Round all that a geometry passes through; nothing where that is not known. */
std::optional<Box> sweptBox(const RobotMotion::Data &data, std::size_t geometry, Workspace &workspace) {
  std::array<cprox_swept_pose, MOST_SEGMENTS> poses;
  std::size_t n = 0;
  constexpr double ANY = 1e6; /* [m] one pose for each segment */
  const cprox_status status = cprox_motion_sweep(data.core.get(), static_cast<std::int32_t>(geometry), ANY,
                                                 workspace.get(), poses.size(), poses.data(), &n);
  if (status != CPROX_OK || n == 0 || n > poses.size()) return std::nullopt;
  const cprox_body_info info = cprox_body_get_info(data.kinematics->geometries[geometry].body);
  const double margin = marginOf(data, geometry);
  Box out;
  for (std::size_t i = 0; i < n; ++i) {
    const auto &turn = poses[i].pose.orientation;
    const Eigen::Vector3d at = toEigen(poses[i].pose.position);
    const Eigen::Vector3d centre =
        at + Eigen::Quaterniond(turn.w, turn.x, turn.y, turn.z).normalized() * toEigen(info.centre);
    const double sizes = info.radius + margin + poses[i].displacement;
    const Eigen::Vector3d half =
        Eigen::Vector3d::Constant(sizes + BOX_ROUNDING * (sizes + at.lpNorm<1>() + centre.lpNorm<1>()));
    out.extend(Box(centre - half, centre + half));
  }
  return out;
}

/* Boxes round all geometries that have pairs with items; empty where one is not known, or too dear. */
std::vector<Box> sweptBoxes(const RobotMotion::Data &data, Workspace &workspace) {
  std::vector<Box> out;
  const cprox_motion_info info = cprox_motion_get_info(data.core.get());
  const std::size_t geometries = data.kinematics->geometries.size();
  if (info.n_pieces > MOST_SEGMENTS || geometries * info.n_pieces * (geometries + info.n_variables) > MOST_PLACED)
    return out;
  for (std::size_t i = 0; i < data.wanted.size(); ++i) {
    if (!data.wanted[i] || data.prepared->environment[i].empty()) continue;
    const std::optional<Box> box = sweptBox(data, i, workspace);
    if (!box || !box->sizes().allFinite()) return {};
    out.push_back(*box);
  }
  return out;
}

/* A lower bound of the distance: along the axis on which they are farthest apart. */
double apart(const Box &a, const Box &b) {
  return (a.min() - b.max()).cwiseMax(b.min() - a.max()).maxCoeff();
}

/* What robots are not asked about is refused wherever it stands. */
bool isAnswered(const PlacedShape &shape) {
  return shape.obstacle.body && cprox_body_get_info(shape.obstacle.body).kind != CPROX_BODY_DISTANCE_GRID;
}

bool wantsVerdictAlone(const Query &query) {
  return query.query_type != QueryType::DISTANCE && !query.options.certificate && !query.options.signed_distance;
}

} // namespace

NearItems nearItems(const RobotMotion::Data &data, std::vector<std::size_t> items, const Query &query,
                    Workspace &workspace) {
  NearItems all{std::move(items), INFINITE};
  if (all.items.size() <= MANY_ITEMS || !wantsVerdictAlone(query)) return all;
  const std::vector<Box> boxes = sweptBoxes(data, workspace);
  if (boxes.empty()) return all;
  Box whole;
  for (const Box &box : boxes) whole.extend(box);

  const double limit = query.query_type == QueryType::TOLERANCE ? query.delta : 0.0;
  const double reach = limit + std::max({query.options.epsilon, 1e-3 * limit, 1e-6});
  NearItems out;
  std::size_t nearest = all.items.front();
  for (const std::size_t k : all.items) {
    const PlacedShape &shape = *data.snapshot->world().items()[k].shape;
    double gap = -INFINITE;
    if (isAnswered(shape) && !unbounded(shape)) gap = apart(whole, shape.box);
    if (gap <= reach && gap > -INFINITE) {
      gap = INFINITE;
      for (const Box &box : boxes) gap = std::min(gap, apart(box, shape.box));
    }
    if (!(gap > reach)) {
      out.items.push_back(k);
    } else if (gap < out.left_out) {
      out.left_out = gap;
      nearest = k;
    }
  }
  if (out.items.empty()) out.items.push_back(nearest);
  out.left_out *= 1.0 - BOX_ROUNDING;
  return out;
}

} // namespace curve_proximity
