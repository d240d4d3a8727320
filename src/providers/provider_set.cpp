/* SPDX-License-Identifier: BSD-3-Clause */
#include "provider_set.h"

#include <pluginlib/class_loader.hpp>

#include <algorithm>
#include <new>
#include <set>
#include <stdexcept>

namespace curve_proximity {
namespace {

/** Pairs that are kept ready. */
constexpr std::size_t MOST_READY = 256;

std::string listed(const std::vector<std::string> &names) {
  std::string text;
  for (const std::string &name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

} // namespace

std::string messageOf(const std::function<void()> &work, cprox_status *status) {
  cprox_status code = CPROX_OK;
  std::string message;
  try {
    work();
  } catch (const Error &error) {
    code = error.status();
    message = error.what();
  } catch (const std::bad_alloc &) {
    code = CPROX_MEMORY;
    message = "out of memory";
  } catch (const std::exception &error) {
    code = CPROX_INVALID;
    message = error.what();
  } catch (...) {
    code = CPROX_INVALID;
    message = "it threw what is no exception";
  }
  if (code < 0 && message.empty()) message = "it threw without a word";
  if (status) *status = code;
  return message;
}

class ProviderSet::Loader {
 public:
  Loader() : classes_("curve_proximity", "curve_proximity::ConstraintProvider") {}

  std::vector<std::string> declared() {
    return classes_.getDeclaredClasses();
  }

  std::shared_ptr<ConstraintProvider> create(const std::string &type) {
    try {
      return std::shared_ptr<ConstraintProvider>(classes_.createUnmanagedInstance(type));
    } catch (const pluginlib::CreateClassException &) {
      throw std::runtime_error(
          "its library has no class '" + classes_.getClassType(type) +
          "' that was built against this version of curve_proximity/constraint_provider.hpp: build it again");
    }
  }

 private:
  pluginlib::ClassLoader<ConstraintProvider> classes_;
};

ProviderSet::ProviderSet(const std::vector<ProviderSpec> &specs) {
  if (specs.empty()) return;
  loader_ = std::make_shared<Loader>();
  const std::vector<std::string> declared = loader_->declared();
  std::set<std::string> names;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const ProviderSpec &spec = specs[i];
    if (!names.insert(spec.name).second) throw ProviderError(i, "the name '" + spec.name + "' is given twice");
    if (std::find(declared.begin(), declared.end(), spec.type) == declared.end())
      throw ProviderError(i, "there is no constraint provider '" + spec.type + "'; declared are " + listed(declared));

    // A plugin's own failure is its own; wrong parameters are whoever wrote them's.
    LoadedProvider loaded;
    loaded.spec = spec;
    std::shared_ptr<ConstraintProvider> made;
    loaded.failure = messageOf([&] { made = loader_->create(spec.type); });
    bool wrong = false;
    if (loaded.failure.empty()) {
      loaded.failure = messageOf([&] {
        try {
          made->initialise(spec.parameters);
        } catch (const Error &) {
          wrong = true;
          throw;
        }
      });
    }
    if (wrong) throw ProviderError(i, loaded.failure);
    if (loaded.failure.empty()) loaded.provider = std::move(made);
    loaded_.push_back(std::move(loaded));
  }
}

ProviderSet::~ProviderSet() {
  ready_.clear();
  loaded_.clear();
  loader_.reset();
}

const LoadedProvider *ProviderSet::find(const std::string &name) const {
  for (const LoadedProvider &loaded : loaded_)
    if (loaded.spec.name == name) return &loaded;
  return nullptr;
}

std::shared_ptr<const Constraint> ProviderSet::prepared(const LoadedProvider &loaded, const std::string &key,
                                                        const std::function<ConstraintPair()> &pair) {
  const auto place = std::make_pair(loaded.spec.name, key);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = ready_.find(place);
    if (found != ready_.end()) {
      found->second.used = ++clock_;
      return found->second.constraint;
    }
  }
  std::shared_ptr<const Constraint> made = loaded.provider->prepare(pair());
  if (!made) throw Error("the provider made nothing of the pair");
  const std::lock_guard<std::mutex> lock(mutex_);
  if (ready_.size() >= MOST_READY) {
    const auto oldest = std::min_element(ready_.begin(), ready_.end(),
                                         [](const auto &x, const auto &y) { return x.second.used < y.second.used; });
    ready_.erase(oldest);
  }
  ready_[place] = {made, ++clock_};
  return made;
}

} // namespace curve_proximity
