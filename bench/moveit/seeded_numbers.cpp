/* SPDX-License-Identifier: BSD-3-Clause */
/* MoveIt's random numbers have no seed of their own. This library is preloaded, and stands for the constructor that would
 * take one from the clock: generators are numbered from a seed on. */
#include <atomic>

#include <random_numbers/random_numbers.h>

#include "seeded_numbers.h"

namespace {
std::atomic<boost::uint32_t> next_seed{1};
} // namespace

void seedNumbers(unsigned int seed) {
  next_seed = seed;
}

random_numbers::RandomNumberGenerator::RandomNumberGenerator() : RandomNumberGenerator(next_seed++) {}
