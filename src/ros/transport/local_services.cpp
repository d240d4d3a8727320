/* SPDX-License-Identifier: BSD-3-Clause */
#include "transport/local_services.h"

#include <curve_proximity/local_call.hpp>
#include <map>
#include <mutex>
#include <shared_mutex>

namespace curve_proximity {

struct LocalService {
  std::string md5sum;
  std::shared_mutex running; /* shared by calls, and held alone by the end */
  std::function<void(const void *request, void *response)> work;
};

namespace {

/** All of the process. */
struct Registry {
  std::mutex mutex;
  std::map<std::string, std::shared_ptr<LocalService>> services;

  std::shared_ptr<LocalService> find(const std::string &name) {
    const std::lock_guard<std::mutex> lock(mutex);
    const auto found = services.find(name);
    return found == services.end() ? nullptr : found->second;
  }
};

Registry &registry() {
  static Registry the_one;
  return the_one;
}

} // namespace

bool local::call(const std::string &name, const std::string &md5sum, const void *request, void *response) {
  const std::shared_ptr<LocalService> service = registry().find(name);
  if (!service || service->md5sum != md5sum) return false;
  const std::shared_lock<std::shared_mutex> running(service->running);
  if (!service->work) return false;
  service->work(request, response);
  return true;
}

void LocalServices::add(const std::string &name, const std::string &md5sum, Work work) {
  const auto service = std::make_shared<LocalService>();
  service->md5sum = md5sum;
  service->work = std::move(work);
  const std::lock_guard<std::mutex> lock(registry().mutex);
  registry().services[name] = service;
  services_.emplace_back(name, service);
}

void LocalServices::end() {
  for (const auto &[name, service] : services_) {
    const std::unique_lock<std::shared_mutex> alone(service->running);
    service->work = nullptr;
    const std::lock_guard<std::mutex> lock(registry().mutex);
    const auto found = registry().services.find(name);
    if (found != registry().services.end() && found->second == service) registry().services.erase(found);
  }
  services_.clear();
}

} // namespace curve_proximity
