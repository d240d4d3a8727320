/* SPDX-License-Identifier: BSD-3-Clause */
/** A plugin that was built against other headers: under the same name a base class whose functions are none of ours. */
#include <pluginlib/class_list_macros.hpp>

#include <cstdlib>

namespace curve_proximity {

class ConstraintProvider {
 public:
  virtual ~ConstraintProvider() = default;
  virtual void somethingElse() = 0;
};

} // namespace curve_proximity

namespace faulty_provider {

class OtherHeaders : public curve_proximity::ConstraintProvider {
 public:
  void somethingElse() override {
    std::abort(); // whoever takes it for initialise() ends here
  }
};

} // namespace faulty_provider

PLUGINLIB_EXPORT_CLASS(faulty_provider::OtherHeaders, curve_proximity::ConstraintProvider)
