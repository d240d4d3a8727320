/* SPDX-License-Identifier: BSD-3-Clause */
/** A thread pool, and batch queries that run on it.
 *
 *  Header-only over libcprox and the standard library's threads. The core starts no threads. */
#ifndef CURVE_PROXIMITY_PARALLEL_HPP
#define CURVE_PROXIMITY_PARALLEL_HPP

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <semaphore.h>

#include <curve_proximity/core.hpp>

namespace curve_proximity {

/** A pool of threads, each with its own workspace. */
class Pool {
 public:
  /** Processes the items [first, last) with the workspace of the calling thread. */
  using Work = std::function<void(std::size_t first, std::size_t last, Workspace &workspace)>;

  /** threads: the number of threads, the caller of run() included; 0: as many as the machine has. */
  explicit Pool(unsigned threads = 0) {
    if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
    try {
      for (unsigned i = 1; i < threads; ++i)
        threads_.emplace_back([this, workspace = Workspace()]() mutable { serve(workspace); });
    } catch (...) {
      stop();
      throw;
    }
  }

  ~Pool() {
    stop();
  }

  Pool(const Pool &) = delete;
  Pool &operator=(const Pool &) = delete;

  /** The number of threads, the caller of run() included. */
  unsigned threads() const {
    return static_cast<unsigned>(threads_.size()) + 1;
  }

  /** Splits 0 … n-1 into ranges of at most `grain` >= 1, calls `work` for each range in parallel, and returns when all
   *  are done. The order is undefined. After an exception no further range is started, and the first exception is
   *  rethrown. Only one run at a time: a second caller waits. */
  void run(std::size_t n, std::size_t grain, const Work &work) {
    const std::lock_guard<std::mutex> alone(runs_);
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      work_ = &work;
      next_ = 0;
      end_ = n;
      grain_ = std::max<std::size_t>(grain, 1);
      failure_ = nullptr;
    }
    wakeAll();
    takeRanges(own_);
    std::unique_lock<std::mutex> lock(mutex_);
    if (busy_ > 0) {
      awaited_ = true;
      lock.unlock();
      idle_.wait(); // until the last one is done; work_ has no ranges left by then
      lock.lock();
    }
    work_ = nullptr;
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  }

 private:
  /** A POSIX semaphore. Condition variables of glibc before 2.41 may lose a wake-up (glibc bug 25847). */
  class Semaphore {
   public:
    Semaphore() {
      sem_init(&semaphore_, 0, 0);
    }
    ~Semaphore() {
      sem_destroy(&semaphore_);
    }
    Semaphore(const Semaphore &) = delete;
    Semaphore &operator=(const Semaphore &) = delete;
    void post() {
      sem_post(&semaphore_);
    }
    void wait() {
      while (sem_wait(&semaphore_) != 0 && errno == EINTR) {
      }
    }

   private:
    sem_t semaphore_;
  };

  /** The loop of a pool thread. A thread that wakes after the end of a run finds no ranges. */
  void serve(Workspace &workspace) {
    for (;;) {
      wake_.wait();
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (stopping_) return;
      }
      takeRanges(workspace);
    }
  }

  void wakeAll() {
    for (std::size_t i = 0; i < threads_.size(); ++i) wake_.post();
  }

  void takeRanges(Workspace &workspace) {
    std::unique_lock<std::mutex> lock(mutex_);
    while (work_ && next_ < end_) {
      const std::size_t first = next_, last = end_ - first > grain_ ? first + grain_ : end_;
      const Work &work = *work_;
      next_ = last;
      ++busy_;
      lock.unlock();
      std::exception_ptr failure;
      try {
        work(first, last, workspace);
      } catch (...) {
        failure = std::current_exception();
      }
      lock.lock();
      if (failure) {
        next_ = end_;
        if (!failure_) failure_ = failure;
      }
      if (--busy_ == 0 && std::exchange(awaited_, false)) idle_.post();
    }
  }

  void stop() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stopping_ = true;
    }
    wakeAll();
    for (std::thread &thread : threads_) thread.join();
  }

  std::mutex runs_;  // held by the run
  std::mutex mutex_; // of all that follows but the semaphores
  Semaphore wake_;   // a thread of the pool
  Semaphore idle_;   // the run, when nobody works on it any more
  const Work *work_ = nullptr;
  std::size_t next_ = 0, end_ = 0, grain_ = 1, busy_ = 0;
  std::exception_ptr failure_;
  bool awaited_ = false; // the run waits for idle_
  bool stopping_ = false;
  Workspace own_; // of the thread that runs
  std::vector<std::thread> threads_;
};

/** Obstacles that many movers are tested against: cprox_obstacles_distance_batch() and its like over a pool. Immutable,
 *  shared by any number of threads. */
class Batch {
 public:
  /** The results; they do not depend on the number of threads. */
  struct Answers {
    std::vector<cprox_result> results; /**< one a mover */
    cprox_status status = CPROX_OK;    /**< the first negative one of them, else the largest */
    std::string reason;                /**< the error message, with the number of the mover; "" for CPROX_OK */
  };

  /** What the obstacles name must outlive the batch. Throws Error as cprox_obstacles_create() fails. */
  explicit Batch(const std::vector<cprox_obstacle> &obstacles) : obstacles_(obstacles, CPROX_INDEX_BATCH) {}

  /** The distance of each mover. */
  Answers distance(const std::vector<cprox_mover> &movers, const cprox_options &options, Pool &pool) const {
    return ask(movers, pool,
               [&](std::size_t first, std::size_t last, cprox_workspace *workspace, cprox_result *results) {
                 return cprox_obstacles_distance_batch(obstacles_.get(), movers.data(), first, last, &options,
                                                       workspace, results);
               });
  }

  /** The tolerance verdict of each mover; delta >= 0 [m]. */
  Answers tolerance(const std::vector<cprox_mover> &movers, double delta, const cprox_options &options,
                    Pool &pool) const {
    return ask(movers, pool,
               [&](std::size_t first, std::size_t last, cprox_workspace *workspace, cprox_result *results) {
                 return cprox_obstacles_tolerance_batch(obstacles_.get(), movers.data(), first, last, delta, &options,
                                                        workspace, results);
               });
  }

  /** The collision verdict of each mover. */
  Answers collision(const std::vector<cprox_mover> &movers, const cprox_options &options, Pool &pool) const {
    return ask(movers, pool,
               [&](std::size_t first, std::size_t last, cprox_workspace *workspace, cprox_result *results) {
                 return cprox_obstacles_tolerance_batch(obstacles_.get(), movers.data(), first, last, 0.0, &options,
                                                        workspace, results);
               });
  }

  /** The C handle, owned by this object. */
  const cprox_obstacles *get() const {
    return obstacles_.get();
  }

 private:
  static constexpr std::size_t kGrain = 32;

  template <typename Ask>
  static Answers ask(const std::vector<cprox_mover> &movers, Pool &pool, const Ask &ask_range) {
    Answers answers;
    cprox_result none{};
    none.status = CPROX_INVALID; // where the call itself is refused nothing is written
    answers.results.assign(movers.size(), none);
    std::mutex mutex;
    std::size_t where = movers.size(); // the range that status and reason are of
    pool.run(movers.size(), kGrain, [&](std::size_t first, std::size_t last, Workspace &workspace) {
      const cprox_status status = ask_range(first, last, workspace.get(), answers.results.data());
      if (status == CPROX_OK) return;
      const std::lock_guard<std::mutex> lock(mutex);
      const bool graver = status < 0 ? answers.status >= 0 || first < where
                                     : status > answers.status || (status == answers.status && first < where);
      if (!graver || (answers.status < 0 && status >= 0)) return;
      answers.status = status;
      answers.reason = workspace.reason();
      where = first;
    });
    return answers;
  }

  Obstacles obstacles_;
};

/** One query about a robot, worked on by all threads of a pool: the intervals of its motion are taken in turn. Those of
 * a distance share their best upper bound, and a violation ends those of a verdict. One thread with a query each is the
 *  better use of a pool; this is for a single query that takes long. */
class SharedQuery {
 public:
  /** The robot against the obstacles (kind ROBOT), itself (ROBOT_SELF), or both (ROBOT_WHOLE). What they name must
   *  outlive the query. options.max_nodes is a budget for each interval; no certificate, interval or share. Throws
   * Error for a mover that is no robot. */
  SharedQuery(const Obstacles &obstacles, const cprox_mover &robot, const cprox_options &options)
      : obstacles_(obstacles), robot_(robot), options_(options) {
    if (!robot.motion)
      throw Error("one query on several threads is for robots: the mover has no motion", CPROX_INVALID);
    if (options.interval || options.share || options.certificate || options.stop)
      throw Error("one query on several threads takes no interval, share, certificate or stop", CPROX_INVALID);
  }

  /** The distance: an interval no wider than asked, whose ends may differ by that width from run to run. The witness is
   *  that of upper; nodes and distance_queries are summed up. Throws Error as Batch. */
  cprox_result distance(Pool &pool) const {
    return ask(pool, -1.0);
  }

  /** The tolerance verdict, delta >= 0 [m], the same for any number of threads as long as no budget ends a part of the
   *  search; nodes and the witness of a violation may differ. */
  cprox_result tolerance(double delta, Pool &pool) const {
    return ask(pool, delta);
  }

 private:
  static constexpr std::size_t kIntervalsPerThread = 8;

  /** What all intervals know. */
  struct Known {
    std::atomic<double> upper{std::numeric_limits<double>::infinity()};
    std::atomic<bool> violated{false};

    static double share(void *user, double upper) {
      auto &known = static_cast<Known *>(user)->upper;
      double least = known.load(std::memory_order_relaxed);
      while (upper < least && !known.compare_exchange_weak(least, upper, std::memory_order_relaxed)) {
      }
      return std::min(upper, least);
    }
    static bool stop(void *user) {
      return static_cast<const Known *>(user)->violated.load(std::memory_order_relaxed);
    }
  };

  cprox_result ask(Pool &pool, double delta) const {
    const cprox_motion_info info = cprox_motion_get_info(robot_.motion);
    const std::size_t n = pool.threads() == 1 ? 1 : kIntervalsPerThread * pool.threads();
    const auto end = [&](std::size_t k) {
      const double part = static_cast<double>(k) / static_cast<double>(n);
      return k == n ? info.t1 : info.t0 + part * (info.t1 - info.t0);
    };
    Known known;
    std::vector<cprox_result> results(n + 1); // the last one: a look at the whole
    std::vector<char> asked(n + 1, 0);        // an interval that is shorter than double tells has no inside
    if (n > 1 && delta < 0.0) {
      pool.run(1, 1, [&](std::size_t, std::size_t, Workspace &workspace) { results[n] = look(known, workspace); });
      if (results[n].status == CPROX_OK || results[n].status < 0) return results[n];
      // the intervals say how near anything comes; this one only where
      results[n].lower = results[n].upper, results[n].status = CPROX_OK;
      asked[n] = 1;
    }
    pool.run(n, 1, [&](std::size_t first, std::size_t, Workspace &workspace) {
      const std::array<double, 2> interval = {end(first), end(first + 1)};
      if (!(interval[0] < interval[1])) return;
      cprox_options options = options_;
      options.interval = interval.data();
      const bool verdict = delta >= 0.0;
      if (verdict) options.stop = &Known::stop, options.stop_user = &known;
      if (!verdict) options.share = &Known::share, options.share_user = &known;
      results[first] = verdict ? obstacles_.tolerance(robot_, delta, options, workspace)
                               : obstacles_.distance(robot_, options, workspace);
      asked[first] = 1;
      if (results[first].verdict == CPROX_VERDICT_VIOLATED) known.violated = true;
    });
    return join(results, asked, delta);
  }

  /** The beginning of a search of the whole motion: an upper bound for all intervals to begin with. Without it each of
   *  them looks for the least distance of its own. */
  cprox_result look(Known &known, Workspace &workspace) const {
    cprox_options options = options_;
    options.max_nodes = 500; // a thousandth of the default
    const cprox_result found = obstacles_.distance(robot_, options, workspace);
    Known::share(&known, found.upper);
    return found;
  }

  /** The union: the least of both ends, with the witness of the upper one. */
  cprox_result join(const std::vector<cprox_result> &results, const std::vector<char> &asked, double delta) const {
    cprox_result all{};
    bool first = true;
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (!asked[i]) continue;
      const cprox_result &one = results[i];
      const cprox_result before = all;
      if (first || one.upper < all.upper) all = one;
      if (!first) {
        all.lower = std::min(before.lower, one.lower);
        all.nodes = before.nodes + one.nodes;
        all.distance_queries = before.distance_queries + one.distance_queries;
        all.lod = std::max(before.lod, one.lod);
        all.status = std::max(before.status, one.status);
      }
      first = false;
    }
    const double width = std::max(options_.epsilon, options_.relative_epsilon * all.upper);
    if (delta >= 0.0) {
      all.verdict = all.upper <= delta  ? CPROX_VERDICT_VIOLATED
                    : all.lower > delta ? CPROX_VERDICT_CLEAR
                                        : CPROX_VERDICT_UNDECIDED;
    }
    const bool decided = delta >= 0.0 && all.verdict != CPROX_VERDICT_UNDECIDED;
    if (decided || (all.upper < std::numeric_limits<double>::infinity() && !(all.upper - all.lower > width)))
      all.status = CPROX_OK;
    return all;
  }

  const Obstacles &obstacles_;
  cprox_mover robot_;
  cprox_options options_;
};

} // namespace curve_proximity

#endif
