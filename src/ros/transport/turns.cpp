/* SPDX-License-Identifier: BSD-3-Clause */
#include "transport/turns.h"

#include <algorithm>

namespace curve_proximity {
namespace {

/** A turn is kept for so long before anybody else is thought of. To hand it over costs some 15 us. */
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

Turns::Client &Turns::enter(const std::string &name) {
  if (clients_.size() > MOST_CLIENTS) {
    for (auto it = clients_.begin(); it != clients_.end();) it = it->second.active == 0 ? clients_.erase(it) : ++it;
  }
  Client &client = clients_[name];
  if (client.active++ == 0) client.used = std::max(client.used, floor_);
  return client;
}

/** The one whose client has used least; of those the first. */
std::vector<Turns::Ticket *>::iterator Turns::next() {
  return std::min_element(waiting_.begin(), waiting_.end(),
                          [](const Ticket *a, const Ticket *b) { return a->client->used < b->client->used; });
}

/** Gives the turns that are free to those that wait. */
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
  const auto granted = [&ticket] { return !ticket.waits; };
  if (deadline == Clock::time_point::max()) {
    ticket.granted.wait(lock, granted);
  } else if (!ticket.granted.wait_until(lock, deadline, granted)) {
    waiting_.erase(std::find(waiting_.begin(), waiting_.end(), &ticket));
    --waiting_count_;
    return false;
  }
  ticket.began = Clock::now();
  return true;
}

/** Charges the client of the ticket, whose turn is free now. */
void Turns::release(Ticket &ticket) {
  ticket.client->used += seconds(Clock::now() - ticket.began);
  --running_;
  crowded_ = running_ > slots_;
  grant();
}

Turn::Turn(Turns &turns, const std::string &client, Turns::Clock::time_point deadline) : turns_(turns) {
  Turns::Lock lock(turns_.mutex_);
  ticket_.client = &turns_.enter(client);
  const Turns::Clock::time_point since = Turns::Clock::now();
  if (turns_.wait(ticket_, lock, deadline)) return;
  --ticket_.client->active;
  throw Busy("busy: " + std::to_string(turns_.waiting_.size()) + " other requests wait, and this one has waited for " +
             std::to_string(static_cast<int>(1000.0 * seconds(Turns::Clock::now() - since))) + " ms");
}

Turn::~Turn() {
  const Turns::Lock lock(turns_.mutex_);
  turns_.release(ticket_);
  --ticket_.client->active;
}

void Turn::yield() {
  const bool wanted = turns_.waiting() > 0 || turns_.crowded_.load(std::memory_order_relaxed);
  const Turns::Clock::time_point now = Turns::Clock::now();
  if (!wanted || now - ticket_.began < QUANTUM) return;
  Turns::Lock lock(turns_.mutex_);
  Turns::Client &own = *ticket_.client;
  own.used += seconds(now - ticket_.began);
  ticket_.began = now;
  const auto best = turns_.next();
  const bool other = best != turns_.waiting_.end() && ((*best)->client == &own || (*best)->client->used < own.used);
  if (!other && turns_.running_ <= turns_.slots_) return;
  --turns_.running_;
  turns_.crowded_ = turns_.running_ > turns_.slots_;
  turns_.wait(ticket_, lock, Turns::Clock::time_point::max());
}

Turn::Pause::Pause(Turn *turn) : turn_(turn) {
  if (!turn_) return;
  const Turns::Lock lock(turn_->turns_.mutex_);
  turn_->turns_.release(turn_->ticket_);
}

Turn::Pause::~Pause() {
  if (!turn_) return;
  Turns::Lock lock(turn_->turns_.mutex_);
  turn_->turns_.wait(turn_->ticket_, lock, Turns::Clock::time_point::max());
}

} // namespace curve_proximity
