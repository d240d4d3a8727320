/* SPDX-License-Identifier: BSD-3-Clause */
/** The action ~query: batches that take longer than anybody waits for a service. */
#ifndef CURVE_PROXIMITY_ROS_BATCH_ACTION_H
#define CURVE_PROXIMITY_ROS_BATCH_ACTION_H

#include <actionlib/server/action_server.h>
#include <curve_proximity/QueryAction.h>
#include <ros/node_handle.h>

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <string>

#include "queries/queries.h"
#include "transport/threaded_queue.h"

namespace curve_proximity {

/** One batch is answered at a time, and takes turns with the requests; a few others wait, in the order in which they
 * came. */
class BatchAction {
 public:
  /** handle: private, on the queue that runs goals and cancellations. The others are kept by reference. stop: as that
   * of Queries. */
  BatchAction(const ros::NodeHandle &handle, const std::string &fixed_frame, Queries &queries, Turns &turns,
              const std::atomic<bool> &stop);

  /** stop must be set. */
  ~BatchAction();

 private:
  using Server = actionlib::ActionServer<QueryAction>;
  struct Batch {
    Server::GoalHandle handle;
    std::atomic<bool> cancelled{false};
  };

  void begin(Server::GoalHandle handle);
  void cancel(Server::GoalHandle handle);
  void answer(Batch &batch);

  const std::string fixed_frame_;
  Queries &queries_;
  Turns &turns_;
  const std::atomic<bool> &stop_;
  std::mutex mutex_;
  std::deque<std::shared_ptr<Batch>> batches_; /* the first is being answered */
  ros::NodeHandle handle_;
  std::unique_ptr<Server> server_;
  ThreadedQueue queue_; /* of the batches */
};

} // namespace curve_proximity
#endif
