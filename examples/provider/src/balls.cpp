/* SPDX-License-Identifier: BSD-3-Clause */
/** A whole provider: the distance of two standing bodies' bounding spheres, which is never more than that of the bodies.
 */
#include <pluginlib/class_list_macros.hpp>

#include <curve_proximity/constraint_provider.hpp>

namespace example_provider {

using namespace curve_proximity;

/** Two balls, made once for a pair of bodies. */
class BallsConstraint : public Constraint {
 public:
  BallsConstraint(const ConstraintPair &pair, double margin) : margin_(margin) {
    if (pair.along_curve) throw Error("Balls is about standing bodies");
    round(pair.a, "a", centre_a_, radius_a_);
    round(pair.b, "b", centre_b_, radius_b_);
  }

  void evaluate(const ConstraintPlace &place, Workspace &, ConstraintValue &out) const override {
    // Both centres as they are turned, and where they are then.
    const Eigen::Isometry3d a = toIsometry(place.a), b = toIsometry(place.b);
    const Eigen::Vector3d arm_a = a.linear() * centre_a_, arm_b = b.linear() * centre_b_;
    const Eigen::Vector3d between = (a.translation() + arm_a) - (b.translation() + arm_b);
    const double length = between.norm();

    out = ConstraintValue();
    out.value = length - radius_a_ - radius_b_ - margin_;
    out.valid = length > 0.0;
    if (!out.valid) {
      out.reason = "the balls have the same centre";
      return;
    }
    out.normal = between / length;
    out.a.linear = out.normal;
    out.a.angular = arm_a.cross(out.normal);
    out.b.linear = -out.normal;
    out.b.angular = out.normal.cross(arm_b);
    out.has_points = true;
    out.witness_a = a.translation() + arm_a - radius_a_ * out.normal;
    out.witness_b = b.translation() + arm_b + radius_b_ * out.normal;
  }

 private:
  static void round(const ConstraintBody &side, const char *name, Eigen::Vector3d &centre, double &radius) {
    const BodyHandle body = joinedBody(side);
    const cprox_body_info info = cprox_body_get_info(body.get());
    radius = info.radius;
    if (!std::isfinite(radius)) throw Error(std::string("side ") + name + " is without end: Balls has no ball for it");
    centre = toEigen(info.centre);
    radius += side.padding + excessOf(side);
  }

  const double margin_;
  Eigen::Vector3d centre_a_, centre_b_;
  double radius_a_ = 0.0, radius_b_ = 0.0;
};

class Balls : public ConstraintProvider {
 public:
  void initialise(const ParameterMap &parameters) override {
    ParameterReader reader(parameters);
    margin_ = reader.number("margin", 0.0, 0.0);
    reader.end();
  }

  std::unique_ptr<const Constraint> prepare(const ConstraintPair &pair) const override {
    return std::make_unique<BallsConstraint>(pair, margin_);
  }

 private:
  double margin_ = 0.0;
};

} // namespace example_provider

PLUGINLIB_EXPORT_CLASS(example_provider::Balls, curve_proximity::ConstraintProvider)
