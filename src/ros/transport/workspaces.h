/* SPDX-License-Identifier: BSD-3-Clause */
/** Workspaces that queries take and give back. */
#ifndef CURVE_PROXIMITY_ROS_WORKSPACES_H
#define CURVE_PROXIMITY_ROS_WORKSPACES_H

#include <array>
#include <cstddef>
#include <curve_proximity/core.hpp>
#include <memory>
#include <mutex>
#include <utility>

namespace curve_proximity {

/** Keeps a few that nobody uses: they have grown already. Those that a hard query has made large are freed. */
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
      if (n_idle_ > 0) return std::move(idle_[--n_idle_]);
    }
    return std::make_unique<Workspace>();
  }

  void giveBack(std::unique_ptr<Workspace> workspace) {
    if (workspace->bytes() > MOST_BYTES) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (n_idle_ < MOST_IDLE) idle_[n_idle_++] = std::move(workspace);
  }

  static constexpr std::size_t MOST_IDLE = 4, MOST_BYTES = std::size_t{2} << 20; // a workspace

  std::mutex mutex_;
  std::array<std::unique_ptr<Workspace>, MOST_IDLE> idle_; // so that giving back never allocates
  std::size_t n_idle_ = 0;
};

} // namespace curve_proximity
#endif
