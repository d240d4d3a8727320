/* SPDX-License-Identifier: BSD-3-Clause */
#include "run.h"

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <exception>
#include <map>
#include <mutex>
#include <thread>

namespace curve_proximity::cli {
namespace {

/* A signal handler can reach nothing but a static flag. */
volatile std::sig_atomic_t interrupt_seen = 0;

void onInterrupt(int) {
  interrupt_seen = 1;
}

/* How far the threads may run ahead of a row that takes long: a bound on what waits to be written. */
constexpr std::size_t kMostAhead = 4096;

/* Warnings about single rows that are told; the rest is counted. */
constexpr std::size_t kMostWarnings = 10;

constexpr std::chrono::milliseconds kProgressEvery(200);

class Run {
 public:
  Run(const Rows &rows, Console &console) : rows_(rows), console_(console) {}

  Tally answerAll(std::size_t threads) {
    std::vector<std::thread> workers;
    {
      /* a thread more is not started while one fails */
      const std::lock_guard<std::mutex> lock(mutex_);
      working_ = threads;
    }
    for (std::size_t i = 0; i < threads; ++i) workers.emplace_back([this] { work(); });

    /* meanwhile this thread tells how far they are */
    {
      std::unique_lock<std::mutex> lock(mutex_);
      while (!finished_.wait_for(lock, kProgressEvery, [this] { return working_ == 0; })) tellProgress();
    }
    for (std::thread &worker : workers) worker.join();

    if (failure_) std::rethrow_exception(failure_);
    tally_.interrupted = interrupt_seen != 0;
    return tally_;
  }

 private:
  void work() {
    try {
      Workspace workspace;
      std::size_t number = 0;
      while (const std::optional<Task> task = take(number)) deliver(number, (*task)(workspace));
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      room_.notify_all();
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    if (--working_ == 0) finished_.notify_all();
  }

  /* The next row and its number; nothing at the end, or when the run is over for another reason. */
  std::optional<Task> take(std::size_t &number) {
    /* not too far ahead of what is written */
    const std::lock_guard<std::mutex> source(source_);
    {
      std::unique_lock<std::mutex> lock(mutex_);
      room_.wait(lock, [this] { return taken_ < written_ + kMostAhead || over(); });
      if (over()) return std::nullopt;
    }

    /* the input may have to be waited for: others deliver meanwhile */
    std::optional<Task> task;
    try {
      task = rows_.next();
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      exhausted_ = true; // no other thread goes on behind what cannot be read
      throw;
    }

    const std::lock_guard<std::mutex> lock(mutex_);
    exhausted_ = !task;
    if (task) number = taken_++;
    if (rows_.portion) portion_ = rows_.portion();
    return task;
  }

  bool over() const {
    return failure_ || exhausted_ || interrupt_seen != 0 || stopped_;
  }

  /* Writes all rows that have become the next ones. */
  void deliver(std::size_t number, Outcome outcome) {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.emplace(number, std::move(outcome));
    std::string lines, records;
    for (auto it = waiting_.find(written_); it != waiting_.end() && !stopped_; it = waiting_.find(written_)) {
      const Outcome &next = it->second;
      stopped_ = next.stopped;
      if (stopped_) break;
      for (const std::string &error_message : next.error_messages) {
        if (messages_++ < rows_.most_messages) console_.say(error_message);
        if (messages_ == rows_.most_messages) console_.say("further rows that fail are counted");
      }
      for (const std::string &message : next.unproven) {
        if (tally_.unproven++ < kMostWarnings) console_.say("warning: " + message);
      }
      lines += next.text;
      records += next.certificate;
      ++tally_.rows;
      tally_.violated += next.violated ? 1 : 0;
      tally_.undecided += next.undecided && !next.violated ? 1 : 0;
      tally_.uncovered += next.uncovered ? 1 : 0;
      tally_.disputed += next.disputed ? 1 : 0;
      tally_.against_nothing += next.against_nothing ? 1 : 0;
      tally_.failed += next.error_messages.empty() ? 0 : 1;
      waiting_.erase(it);
      ++written_;
    }
    if (!lines.empty()) rows_.write(lines);
    if (!records.empty() && rows_.certify) rows_.certify(records);
    room_.notify_all();
  }

  void tellProgress() {
    if (rows_.progress) {
      rows_.progress(tally_);
      return;
    }
    std::string line = std::to_string(tally_.rows) + " rows";
    if (tally_.failed) line += ", " + std::to_string(tally_.failed) + " failed";
    if (portion_) line += ", " + std::to_string(static_cast<int>(100.0 * *portion_)) + " %";
    console_.progress(line);
  }

  const Rows &rows_;
  Console &console_;

  std::mutex source_; /* of rows_.next and rows_.portion; taken before mutex_ */
  std::mutex mutex_;  /* of rows_.write and of everything below */
  std::condition_variable room_, finished_;
  std::map<std::size_t, Outcome> waiting_;
  std::size_t taken_ = 0, written_ = 0, working_ = 0;
  std::size_t messages_ = 0;
  bool exhausted_ = false, stopped_ = false;
  std::exception_ptr failure_;
  std::optional<double> portion_;
  Tally tally_;
};

} // namespace

void catchInterrupts() {
  struct sigaction action = {};
  action.sa_handler = onInterrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted(void *) {
  return interrupt_seen != 0;
}

Tally runRows(std::size_t threads, const Rows &rows, Console &console) {
  return Run(rows, console).answerAll(threads);
}

} // namespace curve_proximity::cli
