/* SPDX-License-Identifier: BSD-3-Clause */
/** The action ~query: batches that take longer than anybody waits for a service. */
#ifndef CURVE_PROXIMITY_ROS_BATCH_ACTION_H
#define CURVE_PROXIMITY_ROS_BATCH_ACTION_H

#include <actionlib/server/action_server.h>
#include <curve_proximity/QueryAction.h>
#include <ros/message_event.h>
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
 * came. A batch ends when the node that sent its goal no longer listens to the results: it has ended, or is killed. */
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
    std::string client; /* the node that sent it */
    std::atomic<bool> cancelled{false}, left{false};
  };
  using GoalEvent = ros::MessageEvent<const QueryActionGoal>;

  void begin(Server::GoalHandle handle);
  void cancel(Server::GoalHandle handle);
  void leave(const std::string &client);
  void answer(Batch &batch);

  const std::string fixed_frame_;
  Queries &queries_;
  Turns &turns_;
  const std::atomic<bool> &stop_;
  std::mutex mutex_;
  std::deque<std::shared_ptr<Batch>> batches_; /* the first is being answered */
  ros::NodeHandle handle_;                     /* one callback at a time */
  GoalEvent last_;                             /* actionlib does not say who sent a goal: it comes here first */
  ros::Subscriber goals_;
  std::unique_ptr<Server> server_;
  ros::Publisher results_; /* the server's too: it says who no longer listens */
  ThreadedQueue queue_;    /* of the batches */
};

} // namespace curve_proximity
#endif
