/* SPDX-License-Identifier: BSD-3-Clause */
#include "markers/level_markers.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "messages/geometry_message.h"

namespace curve_proximity {
namespace {

using visualization_msgs::Marker;

constexpr double LEVELS_PATIENCE = 0.1;          /* [s] for all evaluations together */
constexpr double LEAST_SIDE = 8, MOST_SIDE = 64; /* cells along one side of the grid */
constexpr double LEVEL_WIDTH = 0.006;            /* [m] */
constexpr double AROUND = 1.2; /* how much wider the grid is than the places where bounding spheres meet */

struct Level {
  double share; /* of both sides' reach: the value there */
  double r, g, b;
};
constexpr Level LEVELS[] = {{0.0, 0.78, 0.10, 0.16}, {0.05, 0.96, 0.62, 0.20}, {0.15, 0.35, 0.72, 0.62}};

/** Draws a side; how far its points are from its origin [m]. */
double addSide(Canvas &canvas, const ObjectDescription &side, const ResourceOptions &resources) {
  double reach = 0.0;
  for (const ShapeDescription &shape : side.shapes) {
    const BodyHandle hull = sideGeometry(shape, resources).hull;
    canvas.addShape("sides", shape, hull, resources, side.pose * shape.pose, colour(0.42, 0.52, 0.66, 0.45));
    const cprox_body_info info = cprox_body_get_info(hull.get());
    const cprox_vec3 centre = info.centre;
    const double radius = info.radius;
    reach = std::max(reach, (shape.pose * toEigen(centre)).norm() + radius);
  }
  return reach;
}

/** The values over a square of places of side a about side b. */
class Field {
 public:
  Field(const LevelDrawing &drawing, double reach) : constraint_(*drawing.constraint) {
    place_.a = toPose(drawing.asked.a.pose);
    place_.b = toPose(drawing.asked.b.pose);
    const auto begin = std::chrono::steady_clock::now();
    at(place_.b.position.x, place_.b.position.y);
    const double each = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    side_ = static_cast<int>(std::clamp(std::sqrt(LEVELS_PATIENCE / each), LEAST_SIDE, MOST_SIDE));
    step_ = 2.0 * AROUND * reach / side_;
    low_x_ = place_.b.position.x - AROUND * reach;
    low_y_ = place_.b.position.y - AROUND * reach;
    for (int j = 0; j <= side_; ++j)
      for (int i = 0; i <= side_; ++i) values_.push_back(at(low_x_ + i * step_, low_y_ + j * step_));
  }

  /** Both triangles of each cell are met by a level once at most. */
  void addLevel(Marker &lines, double level) const {
    for (int j = 0; j < side_; ++j) {
      for (int i = 0; i < side_; ++i) {
        addCrossing(lines, level, corner(i, j), corner(i + 1, j), corner(i + 1, j + 1));
        addCrossing(lines, level, corner(i, j), corner(i + 1, j + 1), corner(i, j + 1));
      }
    }
  }

 private:
  struct Corner {
    Eigen::Vector3d at;
    double value;
  };

  double at(double x, double y) {
    place_.a.position.x = x;
    place_.a.position.y = y;
    constraint_.evaluate(place_, workspace_, value_);
    return value_.value;
  }

  Corner corner(int i, int j) const {
    return {{low_x_ + i * step_, low_y_ + j * step_, place_.a.position.z},
            values_[static_cast<std::size_t>(j * (side_ + 1) + i)]};
  }

  static void addCrossing(Marker &lines, double level, const Corner &a, const Corner &b, const Corner &c) {
    std::vector<geometry_msgs::Point> met;
    const std::pair<const Corner *, const Corner *> sides[] = {{&a, &b}, {&b, &c}, {&c, &a}};
    for (const auto &[from, to] : sides) {
      if ((from->value < level) == (to->value < level)) continue;
      const double s = (level - from->value) / (to->value - from->value);
      met.push_back(toPointMessage(toVec3(from->at + s * (to->at - from->at))));
    }
    if (met.size() == 2) lines.points.insert(lines.points.end(), met.begin(), met.end());
  }

  const Constraint &constraint_;
  ConstraintPlace place_;
  Workspace workspace_;
  ConstraintValue value_;
  int side_ = 0;
  double step_ = 0.0, low_x_ = 0.0, low_y_ = 0.0;
  std::vector<double> values_;
};

} // namespace

void addLevels(Canvas &canvas, const LevelDrawing &drawing, const ResourceOptions &resources) {
  const double reach = addSide(canvas, drawing.asked.a, resources) + addSide(canvas, drawing.asked.b, resources);
  const Field field(drawing, reach);
  for (const Level &level : LEVELS) {
    Marker &lines = canvas.add("levels", Marker::LINE_LIST);
    setScale(lines, LEVEL_WIDTH, 0.0, 0.0);
    lines.color = colour(level.r, level.g, level.b, 1.0);
    field.addLevel(lines, level.share * reach);
  }
}

} // namespace curve_proximity
