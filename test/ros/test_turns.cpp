/* SPDX-License-Identifier: BSD-3-Clause */
/* Turns: how many compute at once, who is next, and that nobody is forgotten. */
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "transport/turns.h"

namespace curve_proximity {
namespace {

using Clock = Turns::Clock;
using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr Clock::time_point NEVER = Clock::time_point::max();

void compute(Clock::duration time) {
  const Clock::time_point end = Clock::now() + time;
  while (Clock::now() < end) continue;
}

/** Waits until so many threads wait for a turn. */
void waitFor(const Turns &turns, std::size_t waiting) {
  const Clock::time_point end = Clock::now() + std::chrono::seconds(10);
  while (turns.waiting() < waiting && Clock::now() < end) std::this_thread::sleep_for(microseconds(100));
  ASSERT_EQ(turns.waiting(), waiting);
}

/** A client takes a turn and computes for so long. */
void use(Turns &turns, const std::string &client, Clock::duration time) {
  const Turn turn(turns, client, NEVER);
  compute(time);
}

/** The clients in the order in which they get the one turn, which is taken until all of them wait. */
std::vector<std::string> order(Turns &turns, const std::vector<std::string> &clients) {
  std::vector<std::string> out;
  std::vector<std::thread> threads;
  {
    const Turn taken(turns, "somebody else", NEVER);
    for (const std::string &client : clients) {
      threads.emplace_back([&turns, &out, client] {
        const Turn turn(turns, client, NEVER);
        out.push_back(client); // only one has a turn
      });
      waitFor(turns, threads.size());
    }
  }
  for (std::thread &thread : threads) thread.join();
  return out;
}

TEST(Turns, who_has_computed_least_is_next) {
  Turns turns(1);
  use(turns, "much", milliseconds(30));
  use(turns, "little", milliseconds(1));
  use(turns, "some", milliseconds(10));
  EXPECT_EQ(order(turns, {"much", "some", "little"}), (std::vector<std::string>{"little", "some", "much"}));
}

TEST(Turns, of_equal_ones_the_first_is_next) {
  Turns turns(1);
  EXPECT_EQ(order(turns, {"c", "a", "b"}), (std::vector<std::string>{"c", "a", "b"}));
}

/* Three requests of one client that each compute for long, then a short one of the same client. */
TEST(Turns, a_short_request_does_not_wait_for_long_ones_of_its_own_client) {
  Turns turns(1);
  std::atomic<int> begun{0};
  std::atomic<bool> ending{false};
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i) {
    threads.emplace_back([&] {
      Turn turn(turns, "client", NEVER);
      ++begun;
      while (!ending) {
        compute(microseconds(50));
        turn.yield();
      }
    });
  }
  const Clock::time_point end = Clock::now() + std::chrono::seconds(10);
  while (begun < 3 && Clock::now() < end) std::this_thread::sleep_for(milliseconds(1));
  EXPECT_EQ(begun, 3); // the second and the third have had a turn while the first goes on
  EXPECT_NO_THROW(Turn(turns, "client", Clock::now() + std::chrono::seconds(10)));
  ending = true;
  for (std::thread &thread : threads) thread.join();
}

TEST(Turns, a_holder_makes_way_and_goes_on_afterwards) {
  Turns turns(1);
  std::promise<void> other_done;
  Turn turn(turns, "long", NEVER);
  std::thread other([&] {
    use(turns, "short", microseconds(10));
    other_done.set_value();
  });
  waitFor(turns, 1);
  std::future<void> done = other_done.get_future();
  const Clock::time_point end = Clock::now() + std::chrono::seconds(10);
  while (done.wait_for(Clock::duration::zero()) != std::future_status::ready && Clock::now() < end) {
    compute(microseconds(50));
    turn.yield();
  }
  EXPECT_EQ(done.wait_for(Clock::duration::zero()), std::future_status::ready);
  other.join();
}

TEST(Turns, a_deadline_ends_the_wait) {
  Turns turns(1);
  const Turn taken(turns, "first", NEVER);
  EXPECT_THROW(Turn(turns, "second", Clock::now() + milliseconds(20)), Busy);
  EXPECT_EQ(turns.waiting(), 0U);
}

TEST(Turns, more_slots_let_those_in_that_wait) {
  Turns turns(1);
  const Turn taken(turns, "first", NEVER);
  std::thread other([&] { use(turns, "second", microseconds(1)); });
  waitFor(turns, 1);
  turns.setSlots(2);
  other.join();
}

/* Threads that take, yield, pause and give up at random, while slots come and go. Nobody may wait for ever, and no more
 * may compute than there are slots, of which there were never more than four. */
TEST(Turns, nobody_is_forgotten_and_no_more_compute_than_may) {
  constexpr int THREADS = 16, ROUNDS = 400, MOST = 4;
  Turns turns(MOST);
  std::atomic<int> computing{0}, most{0}, given_up{0}, done{0};
  std::atomic<bool> ending{false};
  std::vector<std::thread> threads;
  for (int t = 0; t < THREADS; t++) {
    threads.emplace_back([&, t] {
      std::mt19937 random(static_cast<unsigned>(t));
      const auto inside = [&] {
        const int now = ++computing;
        int before = most;
        while (now > before && !most.compare_exchange_weak(before, now)) continue;
        compute(microseconds(random() % 40));
        --computing;
      };
      for (int i = 0; i < ROUNDS; i++) {
        try {
          const bool patient = random() % 4 != 0;
          Turn turn(turns, "client " + std::to_string(random() % 6),
                    patient ? NEVER : Clock::now() + microseconds(random() % 200));
          for (unsigned k = random() % 12; k-- > 0;) {
            inside();
            turn.yield();
          }
          if (random() % 8 == 0) {
            const Turn::Pause pause(&turn);
            std::this_thread::sleep_for(microseconds(random() % 100));
          }
          inside();
        } catch (const Busy &) {
          ++given_up;
        }
      }
      ++done;
    });
  }
  std::thread changes([&] {
    std::mt19937 random(99);
    while (!ending) {
      turns.setSlots(1 + static_cast<int>(random() % MOST));
      std::this_thread::sleep_for(microseconds(300));
    }
  });
  const Clock::time_point end = Clock::now() + std::chrono::seconds(60);
  while (done < THREADS && Clock::now() < end) std::this_thread::sleep_for(milliseconds(5));
  ASSERT_EQ(done, THREADS) << turns.waiting() << " threads wait";
  ending = true;
  changes.join();
  for (std::thread &thread : threads) thread.join();
  EXPECT_LE(most, MOST);
  EXPECT_GT(most, 1);
  EXPECT_GT(given_up, 0);
  EXPECT_EQ(turns.waiting(), 0U);
}

} // namespace
} // namespace curve_proximity
