/* SPDX-License-Identifier: BSD-3-Clause */
#include "queries/batch_action.h"

#include <ros/console.h>

#include <chrono>
#include <limits>
#include <utility>

#include "transport/checked_stream.h"
#include "transport/guard.h"

namespace curve_proximity {
namespace {

constexpr std::size_t MOST_BATCHES = 10;                  /* that wait, the one at work included */
constexpr std::uint32_t MOST_GOALS = 50;                  /* that come at once: as actionlib's */
constexpr std::chrono::milliseconds FEEDBACK_PERIOD{100}; /* at least, between two feedbacks */

/** Counts rows as they come, and says so now and then. */
class Feedback {
 public:
  explicit Feedback(std::size_t total) {
    message_.total = static_cast<std::uint32_t>(total);
    message_.lower = message_.upper = std::numeric_limits<double>::infinity();
  }

  /** Takes in the rows that are new; true where it is time to tell. */
  bool update(const QueryResponse &response, std::size_t done) {
    for (; rows_ < response.results.size(); ++rows_) {
      const Proximity &row = response.results[rows_];
      message_.undecided += row.verdict == cprox_verdict_name(CPROX_VERDICT_UNDECIDED);
      message_.failed += row.lower != row.lower;
      if (!(row.upper < message_.upper)) continue;
      message_.lower = row.lower;
      message_.upper = row.upper;
      message_.id = row.id;
    }
    message_.done = static_cast<std::uint32_t>(done);
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return false;
    next_ = now + FEEDBACK_PERIOD;
    return true;
  }

  const QueryFeedback &message() const {
    return message_;
  }

 private:
  QueryFeedback message_;
  std::size_t rows_ = 0;
  std::chrono::steady_clock::time_point next_;
};

void logQueryError(const std::string &why) {
  ROS_ERROR("~query: %s", why.c_str());
}

} // namespace

BatchAction::BatchAction(const ros::NodeHandle &handle, const std::string &fixed_frame, Queries &queries, Turns &turns,
                         const std::atomic<bool> &stop)
    : fixed_frame_(fixed_frame), queries_(queries), turns_(turns), stop_(stop), handle_(handle) {
  const auto keep = [this](const GoalEvent &goal) { last_ = goal; };
  // The first of a topic's subscribers reads its messages, for actionlib, too.
  ros::SubscribeOptions goals = checkedSubscription<QueryActionGoal, const GoalEvent &>("query/goal", MOST_GOALS, keep);
  goals_ = handle_.subscribe(goals);
  server_ = std::make_unique<Server>(
      handle_, "query", [this](Server::GoalHandle goal) { guarded([&] { begin(std::move(goal)); }, logQueryError); },
      [this](Server::GoalHandle goal) { guarded([&] { cancel(std::move(goal)); }, logQueryError); }, false);
  server_->start();
  results_ = handle_.advertise<QueryActionResult>(
      "query/result", 1, {}, [this](const ros::SingleSubscriberPublisher &gone) { leave(gone.getSubscriberName()); });
  queue_.start();
}

BatchAction::~BatchAction() {
  queue_.end();
  goals_.shutdown();
  results_.shutdown();
  batches_.clear();
  server_.reset();
}

void BatchAction::begin(Server::GoalHandle handle) {
  const GoalEvent sent = std::exchange(last_, GoalEvent()); // it may be large
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (batches_.size() < MOST_BATCHES) {
      handle.setAccepted();
      const auto batch = std::make_shared<Batch>();
      if (sent.getConstMessage() && &sent.getConstMessage()->goal == handle.getGoal().get())
        batch->client = sent.getPublisherName();
      batch->handle = std::move(handle);
      batches_.push_back(batch);
      queue_.post([this, batch] {
        guarded([&] { answer(*batch); }, logQueryError);
        const std::lock_guard<std::mutex> ending(mutex_);
        batches_.pop_front();
      });
      return;
    }
  }
  QueryResult result;
  result.message = std::to_string(MOST_BATCHES) + " batches are waiting already";
  handle.setRejected(result, result.message);
}

void BatchAction::cancel(Server::GoalHandle handle) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const std::shared_ptr<Batch> &batch : batches_)
    if (batch->handle == handle) batch->cancelled = true;
}

void BatchAction::leave(const std::string &client) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const std::shared_ptr<Batch> &batch : batches_)
    if (batch->client == client) batch->left = batch->cancelled = true;
}

void BatchAction::answer(Batch &batch) {
  const auto goal = batch.handle.getGoal();
  QueryResult result;
  result.frame_id = fixed_frame_;
  guarded(
      [&] {
        const std::optional<QueryType> query_type = queryTypeFromName(goal->query_type);
        if (!query_type) throw Error("the query '" + goal->query_type + "' is none of distance, tolerance, collision");
        QueryRequest request(*query_type, goal->delta, goal->query);
        Feedback feedback(request.size());
        const double budget_ms = goal->query.budget_ms;
        request.budget_ms = budget_ms != 0.0 ? budget_ms : std::numeric_limits<double>::infinity();
        Turn turn(turns_, "~query", Turns::Clock::time_point::max());
        request.turn = &turn;
        request.cancelled = [&batch] { return batch.cancelled.load(); };
        request.progress = [&](const QueryResponse &response, std::size_t done) {
          if (feedback.update(response, done)) batch.handle.publishFeedback(feedback.message());
        };
        QueryResponse response;
        Drawing drawing;
        queries_.answer(request, response, drawing);
        result.success = response.success;
        result.message = std::move(response.message);
        result.warnings = std::move(response.warnings);
        result.scene = std::move(response.scene);
        result.results = std::move(response.results);
      },
      [&](const std::string &why) {
        result.success = false;
        result.message = why;
      });

  // How it ended, as actionlib has it: a batch with rows that failed is a result, one without any answer is none.
  if (batch.cancelled || stop_) {
    result.success = false;
    result.message = stop_ ? "the server is shutting down" : batch.left ? "its client has gone" : "cancelled";
    batch.handle.setCanceled(result, result.message);
  } else if (result.results.empty() && !result.success) {
    batch.handle.setAborted(result, result.message);
  } else {
    batch.handle.setSucceeded(result, result.message);
  }
}

} // namespace curve_proximity
