/* SPDX-License-Identifier: BSD-3-Clause */
/** Workspaces that queries take and give back, so that no more exist than have ever been in use at once. */
#ifndef CURVE_PROXIMITY_ROS_WORKSPACES_H
#define CURVE_PROXIMITY_ROS_WORKSPACES_H

#include <curve_proximity/core.hpp>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace curve_proximity {

class WorkspacePool {
 public:
  /** One workspace, for as long as the lease lives; the pool must outlive it. */
  class Lease {
   public:
    explicit Lease(WorkspacePool &pool) : pool_(pool), workspace_(pool.take()) {}
    ~Lease() {
      pool_.giveBack(std::move(workspace_));
    }
    Lease(const Lease &) = delete;
    Lease &operator=(const Lease &) = delete;

    Workspace &operator*() const {
      return *workspace_;
    }

   private:
    WorkspacePool &pool_;
    std::unique_ptr<Workspace> workspace_;
  };

 private:
  std::unique_ptr<Workspace> take() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!idle_.empty()) {
        std::unique_ptr<Workspace> workspace = std::move(idle_.back());
        idle_.pop_back();
        return workspace;
      }
      idle_.reserve(++made_); // so that giving back never allocates
    }
    return std::make_unique<Workspace>();
  }

  void giveBack(std::unique_ptr<Workspace> workspace) {
    const std::lock_guard<std::mutex> lock(mutex_);
    idle_.push_back(std::move(workspace));
  }

  std::mutex mutex_;
  std::size_t made_ = 0;
  std::vector<std::unique_ptr<Workspace>> idle_;
};

} // namespace curve_proximity
#endif
