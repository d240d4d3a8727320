/* SPDX-License-Identifier: BSD-3-Clause */
/** Plugins that do what no plugin should: whoever loads them must live on. */
#include <pluginlib/class_list_macros.hpp>

#include <curve_proximity/constraint_provider.hpp>

namespace faulty_provider {

using namespace curve_proximity;

class ThrowsAtStart : public ConstraintProvider {
 public:
  void initialise(const ParameterMap &) override {
    throw 7;
  }
  std::unique_ptr<const Constraint> prepare(const ConstraintPair &) const override {
    return nullptr;
  }
};

class Thrower : public Constraint {
 public:
  void evaluate(const ConstraintPlace &, Workspace &, ConstraintValue &) const override {
    throw "a word";
  }
};

class ThrowsWhenAsked : public ConstraintProvider {
 public:
  void initialise(const ParameterMap &) override {}
  std::unique_ptr<const Constraint> prepare(const ConstraintPair &) const override {
    return std::make_unique<Thrower>();
  }
};

/** The sum of the squares of all positions, with half of its gradient. */
class HalfSquares : public MotionConstraint {
 public:
  void evaluate(const ConstraintMotion &motion, Workspace &, MotionValue &out) const override {
    const TrajectoryDescription &trajectory = motion.description;
    MotionRow row;
    row.positions.resize(static_cast<Eigen::Index>(trajectory.points.size()),
                         static_cast<Eigen::Index>(trajectory.joints.size()));
    for (std::size_t i = 0; i < trajectory.points.size(); ++i)
      for (std::size_t k = 0; k < trajectory.joints.size(); ++k) {
        const double position = trajectory.points[i].positions[k];
        row.positions(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = position;
        row.value += position * position;
      }
    row.valid = true;
    out = MotionValue();
    out.value = row.value;
    out.rows.push_back(row);
  }
};

class WrongGradient : public ConstraintProvider {
 public:
  void initialise(const ParameterMap &) override {}
  std::unique_ptr<const Constraint> prepare(const ConstraintPair &) const override {
    throw Error("WrongGradient is about trajectories");
  }
  std::unique_ptr<const MotionConstraint> prepareMotion(const PreparedRobot &) const override {
    return std::make_unique<HalfSquares>();
  }
};

} // namespace faulty_provider

PLUGINLIB_EXPORT_CLASS(faulty_provider::WrongGradient, curve_proximity::ConstraintProvider)
PLUGINLIB_EXPORT_CLASS(faulty_provider::ThrowsAtStart, curve_proximity::ConstraintProvider)
PLUGINLIB_EXPORT_CLASS(faulty_provider::ThrowsWhenAsked, curve_proximity::ConstraintProvider)
