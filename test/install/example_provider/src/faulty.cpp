/* SPDX-License-Identifier: BSD-3-Clause */
/** Plugins that do what no plugin should: whoever loads them must live on. */
#include <pluginlib/class_list_macros.hpp>

#include <curve_proximity/constraint_provider.hpp>

namespace example_provider {

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

} // namespace example_provider

PLUGINLIB_EXPORT_CLASS(example_provider::ThrowsAtStart, curve_proximity::ConstraintProvider)
PLUGINLIB_EXPORT_CLASS(example_provider::ThrowsWhenAsked, curve_proximity::ConstraintProvider)
