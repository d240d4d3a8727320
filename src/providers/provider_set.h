/* SPDX-License-Identifier: BSD-3-Clause */
/** Constraint providers loaded by name through pluginlib, for the node and the command line. Needs no master. */
#ifndef CURVE_PROXIMITY_PROVIDERS_PROVIDER_SET_H
#define CURVE_PROXIMITY_PROVIDERS_PROVIDER_SET_H

#include <curve_proximity/constraint_provider.hpp>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace curve_proximity {

/** A provider as it is asked for. */
struct ProviderSpec {
  std::string name; /**< of one's own choice; each once */
  std::string type; /**< of the plugin: "curve_proximity/CurveDistance" */
  ParameterMap parameters;
};

/** A provider that is wanted wrongly: a type that no package declares, a parameter, a name given twice. */
class ProviderError : public Error {
 public:
  ProviderError(std::size_t place, const std::string &reason) : Error(reason), place_(place) {}

  /** Which of the specs, from 0. */
  std::size_t place() const {
    return place_;
  }

 private:
  std::size_t place_;
};

/** One provider, or why there is none: a plugin that does not load, or throws. */
struct LoadedProvider {
  ProviderSpec spec;
  std::shared_ptr<const ConstraintProvider> provider; /**< null where it failed */
  std::string failure;
};

/** Runs `work`, and makes a message of whatever it throws, whether an exception or not; "" where it throws nothing.
 * Errors keep their status, all else is CPROX_INVALID. */
std::string messageOf(const std::function<void()> &work, cprox_status *status = nullptr);

/** Providers, and the pairs that they have made ready lately. Any number of threads. */
class ProviderSet {
 public:
  /** Throws ProviderError; what is wrong with a plugin itself is kept as its failure, and the others go on. */
  explicit ProviderSet(const std::vector<ProviderSpec> &specs);
  ~ProviderSet();

  const std::vector<LoadedProvider> &all() const {
    return loaded_;
  }

  /** The one of that name; null where there is none. */
  const LoadedProvider *find(const std::string &name) const;

  /** The pair made ready by the provider, at once where it was so lately: `key` says all that the pair is, and `pair`
   * makes it. Throws what these two throw. */
  std::shared_ptr<const Constraint> prepared(const LoadedProvider &provider, const std::string &key,
                                             const std::function<ConstraintPair()> &pair);

 private:
  class Loader;
  std::shared_ptr<Loader> loader_; /* outlives what it has loaded */
  std::vector<LoadedProvider> loaded_;

  struct Ready {
    std::shared_ptr<const Constraint> constraint;
    std::uint64_t used = 0;
  };
  std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, Ready> ready_;
  std::uint64_t clock_ = 0;
};

} // namespace curve_proximity
#endif
