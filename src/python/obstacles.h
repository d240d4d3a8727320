/* SPDX-License-Identifier: BSD-3-Clause */
/** What moves and what stands, as Python holds them. */
#ifndef CURVE_PROXIMITY_PYTHON_OBSTACLES_H
#define CURVE_PROXIMITY_PYTHON_OBSTACLES_H

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <curve_proximity/parallel.hpp>

#include "conversion.h"

namespace curve_proximity::python {

/** A mover, and what it refers to. */
struct Mover {
  cprox_mover mover{};
  CurveHandle curve, radius;
  BodyHandle body;
  py::object made = py::none();
};

/** An obstacle, and what it refers to. */
struct Obstacle {
  cprox_obstacle obstacle{};
  BodyHandle body;
  CurveHandle curve;
  std::vector<std::shared_ptr<Mover>> others; /**< at the same parameter */
  std::shared_ptr<const void> owner;          /**< of a scene's: the scene */
  py::object made = py::none();
};

/** Many obstacles, and what they refer to; immutable. The batch index is made when it is first wanted. */
class ObstacleSet {
 public:
  /** index: "bvh" or "none". names: of a scene's, the object of each. */
  ObstacleSet(std::vector<std::shared_ptr<Obstacle>> list, const std::string &index,
              std::vector<std::string> names = {});

  const Obstacles &get() const {
    return set_;
  }

  const std::vector<std::string> &names() const {
    return names_;
  }

  const Batch &batch() const;

  py::object made = py::none();

 private:
  std::vector<std::shared_ptr<Obstacle>> list_;
  std::vector<std::string> names_;
  std::vector<cprox_obstacle> obstacles_;
  Obstacles set_;
  mutable std::mutex mutex_;
  mutable std::unique_ptr<Batch> batch_;
};

} // namespace curve_proximity::python
#endif
