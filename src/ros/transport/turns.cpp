/* SPDX-License-Identifier: BSD-3-Clause */
#include "transport/turns.h"

#include <algorithm>
#include <cerrno>
#include <ctime>

namespace curve_proximity {
namespace {

/** A turn is kept for so long before anybody else is thought of. */
constexpr std::chrono::microseconds QUANTUM{125};

/** Clients are forgotten beyond so many. */
constexpr std::size_t MOST_CLIENTS = 4096;

double seconds(Turns::Clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

/** [s] What this thread has computed. */
double processorTime() {
  timespec time = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/** False: the deadline came first. */
bool waitUntil(sem_t &semaphore, Turns::Clock::time_point deadline) {
  const auto since_zero = std::chrono::duration_cast<std::chrono::nanoseconds>(deadline.time_since_epoch()).count();
  const timespec at = {static_cast<std::time_t>(since_zero / 1000000000), static_cast<long>(since_zero % 1000000000)};
  while (sem_clockwait(&semaphore, CLOCK_MONOTONIC, &at) != 0) {
    if (errno != EINTR) return false;
  }
  return true;
}

} // namespace

void Turns::setSlots(int slots) {
  Lock lock(mutex_);
  slots_ = slots;
  crowded_ = running_ > slots_;
  wake(lock, grant(nullptr));
}

double Turns::takeLongestWait() {
  return longest_wait_.exchange(0.0);
}

void Turns::noteWait(double seconds) {
  double longest = longest_wait_;
  while (seconds > longest && !longest_wait_.compare_exchange_weak(longest, seconds)) continue;
}

Turns::Client &Turns::enter(const std::string &name) {
  if (clients_.size() > MOST_CLIENTS) {
    for (auto it = clients_.begin(); it != clients_.end();) it = it->second.active == 0 ? clients_.erase(it) : ++it;
  }
  Client &client = clients_[name];
  if (client.active++ == 0) client.used = std::max(client.used, floor_);
  return client;
}

/** The one that has used least; of those the first. */
std::vector<Turns::Ticket *>::iterator Turns::next() {
  return std::min_element(waiting_.begin(), waiting_.end(),
                          [](const Ticket *a, const Ticket *b) { return a->client->used < b->client->used; });
}

/** Gives turns to those that wait; who has got one, and after them those of `granted`. */
Turns::Ticket *Turns::grant(Ticket *granted) {
  while (running_ < slots_ && !waiting_.empty()) {
    const auto best = next();
    Ticket &ticket = **best;
    waiting_.erase(best);
    --waiting_count_;
    ticket.alone = running_++ == 0 && waiting_.empty();
    floor_ = std::max(floor_, ticket.client->used);
    ticket.waits = false;
    ticket.after = granted;
    granted = &ticket;
  }
  return granted;
}

/** Gives the lock back first: the system may run a thread that wakes at once, in place of this one. */
void Turns::wake(Lock &lock, Ticket *granted) {
  lock.unlock();
  while (granted) {
    Ticket &ticket = *granted;
    granted = ticket.after;
    sem_post(&ticket.granted); // it may be gone from here on
  }
}

/** Gives the lock back, and wakes those of `granted` too. False: the deadline came first; the ticket waits no more, and
 * the lock is held. */
bool Turns::wait(Ticket &ticket, Lock &lock, Ticket *granted, Clock::time_point deadline) {
  ticket.waits = true;
  waiting_.push_back(&ticket);
  ++waiting_count_;
  wake(lock, grant(granted));
  if (deadline == Clock::time_point::max()) {
    while (sem_wait(&ticket.granted) != 0) continue;
  } else if (!waitUntil(ticket.granted, deadline)) {
    lock.lock();
    if (ticket.waits) {
      waiting_.erase(std::find(waiting_.begin(), waiting_.end(), &ticket));
      --waiting_count_;
      return false;
    }
    lock.unlock();
    while (sem_wait(&ticket.granted) != 0) continue; // it was granted in time, and is being woken
  }
  begin(ticket);
  return true;
}

void Turns::begin(Ticket &ticket) {
  ticket.began = Clock::now();
  ticket.began_at = ticket.alone ? 0.0 : processorTime();
}

/** [s] What the thread of this turn has computed since it began. Not under the lock: the system likes to change threads
 * where it is asked for this. */
double Turns::used(const Ticket &ticket) {
  return ticket.alone ? seconds(Clock::now() - ticket.began) : processorTime() - ticket.began_at;
}

/** Those that have a turn now. */
Turns::Ticket *Turns::release() {
  --running_;
  crowded_ = running_ > slots_;
  return grant(nullptr);
}

Turn::Turn(Turns &turns, const std::string &client, Turns::Clock::time_point deadline)
    : turns_(turns), client_(client) {
  Turns::Lock lock(turns_.mutex_);
  ticket_.client = &turns_.enter(client);
  const Turns::Clock::time_point since = Turns::Clock::now();
  const bool in_time = turns_.wait(ticket_, lock, nullptr, deadline);
  const double waited = seconds(Turns::Clock::now() - since);
  turns_.noteWait(waited);
  if (in_time) return;
  --ticket_.client->active;
  throw Busy("busy: " + std::to_string(turns_.waiting_.size()) + " other requests wait, and this one has waited for " +
             std::to_string(static_cast<int>(1000.0 * waited)) + " ms");
}

/** The lock is held. */
Turn::Turn(Turns &turns, const std::string &client, Granted) : turns_(turns), client_(client) {
  ticket_.client = &turns_.enter(client);
  Turns::begin(ticket_);
  ++turns_.running_;
}

std::function<std::unique_ptr<Turn>()> Turn::others() const {
  return [&turns = turns_, client = client_]() -> std::unique_ptr<Turn> {
    const Turns::Lock lock(turns.mutex_);
    if (!turns.waiting_.empty() || turns.running_ >= turns.slots_) return nullptr;
    return std::unique_ptr<Turn>(new Turn(turns, client, Granted()));
  };
}

Turn::~Turn() {
  const double used = Turns::used(ticket_);
  Turns::Lock lock(turns_.mutex_);
  ticket_.client->used += used;
  --ticket_.client->active;
  Turns::wake(lock, turns_.release());
}

void Turn::yield() {
  const bool wanted = turns_.waiting() > 0 || turns_.crowded_.load(std::memory_order_relaxed);
  if (!wanted || Turns::Clock::now() - ticket_.began < QUANTUM) return;
  const double used = Turns::used(ticket_);
  ticket_.alone = false;
  Turns::begin(ticket_);
  Turns::Lock lock(turns_.mutex_);
  ticket_.client->used += used;
  const auto best = turns_.next();
  const bool other = best != turns_.waiting_.end() && (*best)->client->used < ticket_.client->used;
  if (other || turns_.running_ > turns_.slots_)
    turns_.wait(ticket_, lock, turns_.release(), Turns::Clock::time_point::max());
}

void Turn::giveBack() {
  const double used = Turns::used(ticket_);
  Turns::Lock lock(turns_.mutex_);
  ticket_.client->used += used;
  Turns::wake(lock, turns_.release());
}

void Turn::takeAgain() {
  Turns::Lock lock(turns_.mutex_);
  turns_.wait(ticket_, lock, nullptr, Turns::Clock::time_point::max());
}

} // namespace curve_proximity
