/* SPDX-License-Identifier: BSD-3-Clause */
/* The account of the process: this program has the node's malloc. */
#include "transport/memory_limit.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <random>
#include <thread>
#include <vector>

#include "transport/memory_account.h"

namespace curve_proximity {
namespace {

constexpr std::size_t MEGABYTE = std::size_t{1} << 20;
constexpr int LIMIT_MB = 200;

struct Free {
  void operator()(void *memory) const {
    std::free(memory);
  }
};
using Block = std::unique_ptr<void, Free>;

/** Megabytes that can be had in one piece now. */
std::size_t room() {
  std::size_t most = 0;
  for (std::size_t step = 256; step > 0; step /= 2) {
    if (Block(std::malloc((most + step) * MEGABYTE))) most += step;
  }
  return most;
}

/** What a request may not have: smaller allocations than a megabyte fail only there. */
struct AtRequest {
  AtRequest() {
    memory::at_request = true;
  }
  ~AtRequest() {
    memory::at_request = false;
  }
};

TEST(MemoryLimit, the_process_itself_counts) {
  const std::size_t of_libraries = 5; // at least
  EXPECT_LT(room() + of_libraries, static_cast<std::size_t>(LIMIT_MB));
  EXPECT_GT(room(), static_cast<std::size_t>(LIMIT_MB) / 2);
}

TEST(MemoryLimit, what_is_too_much_fails_however_it_is_asked_for) {
  const std::size_t size = LIMIT_MB * MEGABYTE;
  errno = 0;
  EXPECT_EQ(Block(std::malloc(size)), nullptr);
  EXPECT_EQ(errno, ENOMEM);
  EXPECT_EQ(Block(std::calloc(size / 8, 8)), nullptr);
  EXPECT_EQ(Block(std::aligned_alloc(64, size)), nullptr);
  void *memory = nullptr;
  EXPECT_EQ(posix_memalign(&memory, 64, size), ENOMEM);
  EXPECT_EQ(posix_memalign(&memory, 24, 100), EINVAL);
  EXPECT_THROW(static_cast<void>(std::unique_ptr<char>(static_cast<char *>(::operator new(size)))), std::bad_alloc);
  EXPECT_THROW(std::vector<double> all(size / 8), std::bad_alloc);
}

TEST(MemoryLimit, a_block_that_cannot_grow_stays_as_it_is) {
  Block small(std::malloc(4000));
  std::memset(small.get(), 7, 4000);
  EXPECT_EQ(std::realloc(small.get(), LIMIT_MB * MEGABYTE), nullptr);
  for (int i = 0; i < 4000; i++) ASSERT_EQ(static_cast<char *>(small.get())[i], 7);
  small.reset(std::realloc(small.release(), 2 * MEGABYTE));
  ASSERT_NE(small, nullptr);
  for (int i = 0; i < 4000; i++) ASSERT_EQ(static_cast<char *>(small.get())[i], 7);
}

TEST(MemoryLimit, small_ones_fail_at_a_request_alone) {
  std::vector<Block> all;
  while (true) {
    Block more(std::malloc(MEGABYTE));
    if (!more) break;
    all.push_back(std::move(more));
  }
  while (true) { // what is left
    const AtRequest marked;
    Block more(std::malloc(4096));
    if (!more) break;
    all.push_back(std::move(more));
  }
  EXPECT_NE(Block(std::malloc(4096)), nullptr);
  std::thread([] {
    const AtRequest marked;
    EXPECT_EQ(Block(std::malloc(4096)), nullptr);
    EXPECT_THROW(static_cast<void>(std::make_unique<char[]>(4096)), std::bad_alloc);
    EXPECT_NE(Block(std::malloc(16)), nullptr);
  }).join();
}

/* Allocated by one way, resized, and freed by any that the language allows: nothing may be left on the account, nor be
 * taken from it twice. */
TEST(MemoryLimit, the_account_balances) {
  const std::size_t before = room();
  std::vector<std::thread> threads;
  for (unsigned t = 0; t < 4; t++) {
    threads.emplace_back([t] {
      std::mt19937 random(t);
      std::vector<Block> blocks(64);
      std::vector<std::unique_ptr<char[]>> arrays(64);
      for (int i = 0; i < 30000; i++) {
        Block &block = blocks[random() % blocks.size()];
        const std::size_t size = std::size_t{1} << (random() % 18);
        switch (random() % 6) {
          case 0: block.reset(std::malloc(size)); break;
          case 1: block.reset(std::calloc(size, 1)); break;
          case 2: block.reset(std::realloc(block.release(), size)); break;
          case 3: block.reset(std::aligned_alloc(32, size < 32 ? 32 : size)); break;
          case 4: arrays[random() % arrays.size()] = std::make_unique<char[]>(size); break;
          default: {
            void *memory = nullptr;
            if (posix_memalign(&memory, 16, size) == 0) block.reset(memory);
          }
        }
      }
    });
  }
  for (std::thread &thread : threads) thread.join();
  EXPECT_NEAR(static_cast<double>(room()), static_cast<double>(before), 2.0);
}

} // namespace
} // namespace curve_proximity

int main(int argc, char **argv) {
  curve_proximity::limitMemory(curve_proximity::LIMIT_MB);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
