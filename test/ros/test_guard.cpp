/* SPDX-License-Identifier: BSD-3-Clause */
/* The shell round every callback: whatever is thrown inside ends there, as a message. */
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "transport/guard.h"

namespace curve_proximity {
namespace {

struct Response {
  bool success = true;
  std::string message;
  int rows = 0;
};

template <class Work>
std::string message(Work work) {
  std::string said = "nothing";
  guarded(work, [&](const std::string &why) { said = why; });
  return said;
}

TEST(Guard, whatever_is_thrown_becomes_a_message) {
  EXPECT_EQ(message([] {}), "nothing");
  EXPECT_EQ(message([] { throw std::runtime_error("so"); }), "so");
  EXPECT_EQ(message([] { throw std::bad_alloc(); }), "out of memory");
  EXPECT_EQ(message([] { throw 7; }), "an unknown failure");
  EXPECT_EQ(message([] { throw "a word"; }), "an unknown failure");
}

TEST(Guard, a_handler_says_true_whatever_happens_and_leaves_no_half_answer) {
  Response response;
  EXPECT_TRUE(answered(response, [&] { response.rows = 3; }));
  EXPECT_TRUE(response.success);
  EXPECT_EQ(response.rows, 3);
  EXPECT_TRUE(answered(response, [&] {
    response.rows = 5;
    throw 7;
  }));
  EXPECT_FALSE(response.success);
  EXPECT_EQ(response.message, "an unknown failure");
  EXPECT_EQ(response.rows, 0);
}

} // namespace
} // namespace curve_proximity
