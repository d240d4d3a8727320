/* SPDX-License-Identifier: BSD-3-Clause */
/** Who computes when: requests of many clients share a few turns fairly, however large each is. */
#ifndef CURVE_PROXIMITY_ROS_TURNS_H
#define CURVE_PROXIMITY_ROS_TURNS_H

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

namespace curve_proximity {

/** A request that must come back later; what() says why. */
class Busy : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/** A number of turns, each held by one thread. Where several wait, the client that has computed least goes first; a
 * client that was idle starts level with the others. A holder that calls Turn::yield() now and then makes way for a
 * client that has computed less, so that a small request waits for a few milliseconds behind any number of large ones.
 * The requests of one client take turns in the order in which they came.
 *
 *  Start-time fair queuing (P. Goyal, H. M. Vin, H. Cheng, SIGCOMM 1996). The tag is the time for which a client has
 *  held turns. */
class Turns {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Turns(int slots) : slots_(slots) {}

  /** Takes effect at once for those that wait, and at the next yield() of those that compute. */
  void setSlots(int slots);

  /** Threads that wait now. */
  std::size_t waiting() const {
    return waiting_count_.load(std::memory_order_relaxed);
  }

 private:
  friend class Turn;

  struct Client {
    double used = 0.0;      /* [s] */
    std::size_t active = 0; /* turns that are held or waited for */
  };
  struct Ticket {
    Client *client = nullptr;
    Clock::time_point began;
    bool waits = false;
    std::condition_variable granted;
  };

  using Lock = std::unique_lock<std::mutex>;
  Client &enter(const std::string &name);
  bool wait(Ticket &ticket, Lock &lock, Clock::time_point deadline);
  void release(Ticket &ticket);
  void grant();
  std::vector<Ticket *>::iterator next();

  std::mutex mutex_;
  int slots_;
  int running_ = 0;
  double floor_ = 0.0;            /* [s] what the client in turn had used: nobody starts below it */
  std::vector<Ticket *> waiting_; /* in the order of their coming */
  std::map<std::string, Client> clients_;
  std::atomic<std::size_t> waiting_count_{0};
  std::atomic<bool> crowded_{false}; /* more hold a turn than there are */
};

/** One turn, for as long as this lives. For one thread. */
class Turn {
 public:
  /** client: who shares one place in the order. Waits until there is a turn; throws Busy at the deadline. */
  Turn(Turns &turns, const std::string &client, Turns::Clock::time_point deadline);
  ~Turn();

  Turn(const Turn &) = delete;
  Turn &operator=(const Turn &) = delete;

  /** Lets others compute if it is their turn; returns when it is ours again. Costs a load where nobody waits. */
  void yield();

  /** Nobody's turn is held while this thread waits for something else. turn may be null. */
  class Pause {
   public:
    explicit Pause(Turn *turn);
    ~Pause();
    Pause(const Pause &) = delete;
    Pause &operator=(const Pause &) = delete;

   private:
    Turn *const turn_;
  };

 private:
  Turns &turns_;
  Turns::Ticket ticket_;
};

} // namespace curve_proximity
#endif
