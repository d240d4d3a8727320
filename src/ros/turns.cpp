/* SPDX-License-Identifier: BSD-3-Clause */
#include "turns.h"

#include <algorithm>

namespace curve_proximity {
namespace {

/** A turn is kept for so long before anybody else is thought of. */
constexpr std::chrono::microseconds QUANTUM{250};

/** Clients are forgotten beyond so many. */
constexpr std::size_t MOST_CLIENTS = 4096;

double seconds(Turns::Clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

} // namespace

void Turns::setSlots(int slots) {
  const Lock lock(mutex_);
  slots_ = slots;
  crowded_ = running_ > slots_;
  grant();
}

double Turns::takeLongestWait() {
  const Lock lock(mutex_);
  const double out = longest_wait_;
  longest_wait_ = 0.0;
  return out;
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
std::list<Turns::Ticket *>::iterator Turns::next() {
  return std::min_element(waiting_.begin(), waiting_.end(),
                          [](const Ticket *a, const Ticket *b) { return a->client->used < b->client->used; });
}

void Turns::grant() {
  while (running_ < slots_ && !waiting_.empty()) {
    const auto best = next();
    Ticket &ticket = **best;
    waiting_.erase(best);
    --waiting_count_;
    ++running_;
    floor_ = std::max(floor_, ticket.client->used);
    ticket.waits = false;
    ticket.granted.notify_one();
  }
}

/** False: the deadline came first, and the ticket waits no more. */
bool Turns::wait(Ticket &ticket, Lock &lock, Clock::time_point deadline) {
  ticket.waits = true;
  waiting_.push_back(&ticket);
  ++waiting_count_;
  grant();
  if (deadline == Clock::time_point::max()) {
    while (ticket.waits) ticket.granted.wait(lock);
  } else {
    while (ticket.waits && ticket.granted.wait_until(lock, deadline) != std::cv_status::timeout) continue;
  }
  if (ticket.waits) {
    waiting_.remove(&ticket);
    --waiting_count_;
    return false;
  }
  ticket.began = Clock::now();
  return true;
}

void Turns::charge(Ticket &ticket) {
  const Clock::time_point now = Clock::now();
  ticket.client->used += seconds(now - ticket.began);
  ticket.began = now;
}

void Turns::release(Ticket &ticket) {
  charge(ticket);
  --running_;
  crowded_ = running_ > slots_;
  grant();
}

Turn::Turn(Turns &turns, const std::string &client, Turns::Clock::time_point deadline)
    : turns_(turns), client_(client) {
  Turns::Lock lock(turns_.mutex_);
  ticket_.client = &turns_.enter(client);
  ticket_.since = Turns::Clock::now();
  const bool granted = turns_.wait(ticket_, lock, deadline);
  const double waited = seconds(Turns::Clock::now() - ticket_.since);
  turns_.longest_wait_ = std::max(turns_.longest_wait_, waited);
  if (granted) return;
  --ticket_.client->active;
  throw Busy("busy: " + std::to_string(turns_.waiting_.size()) + " other requests wait, and this one has waited for " +
             std::to_string(static_cast<int>(1000.0 * waited)) + " ms");
}

/** The lock is held. */
Turn::Turn(Turns &turns, const std::string &client, Granted) : turns_(turns), client_(client) {
  ticket_.client = &turns_.enter(client);
  ticket_.since = ticket_.began = Turns::Clock::now();
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
  const Turns::Lock lock(turns_.mutex_);
  turns_.release(ticket_);
  --ticket_.client->active;
}

void Turn::yield() {
  const bool wanted = turns_.waiting() > 0 || turns_.crowded_.load(std::memory_order_relaxed);
  if (!wanted || Turns::Clock::now() - ticket_.began < QUANTUM) return;
  Turns::Lock lock(turns_.mutex_);
  turns_.charge(ticket_);
  const auto best = turns_.next();
  const bool other = best != turns_.waiting_.end() && (*best)->client->used < ticket_.client->used;
  if (!other && turns_.running_ <= turns_.slots_) return;
  turns_.release(ticket_);
  turns_.wait(ticket_, lock, Turns::Clock::time_point::max());
}

void Turn::giveBack() {
  const Turns::Lock lock(turns_.mutex_);
  turns_.release(ticket_);
}

void Turn::takeAgain() {
  Turns::Lock lock(turns_.mutex_);
  turns_.wait(ticket_, lock, Turns::Clock::time_point::max());
}

} // namespace curve_proximity
