/* SPDX-License-Identifier: BSD-3-Clause */
/* Paths led round discs in a plane: each edge holds by a distance that is measured here. */
#include "../../src/moveit/detour.h"

#include "support.h"

using namespace curve_proximity;

namespace {

struct Disc {
  Row centre;
  double radius;
};

double distance(const Row &a, const Row &b) {
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

/* Of a point and a straight edge. */
double distance(const Row &point, const Row &a, const Row &b) {
  const double dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
  const double along = square > 0.0 ? ((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / square : 0.0;
  const double u = std::clamp(along, 0.0, 1.0);
  return distance(point, {a[0] + u * dx, a[1] + u * dy});
}

bool isFree(const std::vector<Disc> &discs, const Row &a, const Row &b, double clearance) {
  return std::all_of(discs.begin(), discs.end(),
                     [&](const Disc &disc) { return distance(disc.centre, a, b) > disc.radius + clearance; });
}

constexpr double MARGIN = 0.01;

constexpr double STEP = 0.2;

/* New edges keep the first of these margins for which there is a way. */
Detours among(const std::vector<Disc> &discs, const std::vector<double> &margins = {MARGIN}) {
  Detours out;
  out.stays = out.needed = [&discs](const Row &a, const Row &b) { return isFree(discs, a, b, 0.0); };
  for (const double margin : margins)
    out.wanted.push_back([&discs, margin](const Row &a, const Row &b) { return isFree(discs, a, b, margin); });
  out.limits = {{-3.0, -3.0}, {3.0, 3.0}};
  out.step = STEP;
  out.is_over = [] { return false; };
  return out;
}

/* 21 rows from (-2, 0) to (2, 0). */
/* 21 rows from (-2, 0) to (2, 0). */
Path line() {
  Path out;
  for (int i = 0; i <= 20; ++i) out.push_back({-2.0 + 0.2 * i, 0.0});
  return out;
}

/* Twelve discs that leave the ends of the line free. */
std::vector<Disc> randomDiscs(std::mt19937_64 &random) {
  std::uniform_real_distribution<double> x(-1.5, 1.5), y(-0.8, 0.8), radius(0.05, 0.3);
  std::vector<Disc> out;
  while (out.size() < 12) {
    const Disc disc{{x(random), y(random)}, radius(random)};
    const bool free = distance(disc.centre, line().front()) > disc.radius + 2.0 * MARGIN &&
                      distance(disc.centre, line().back()) > disc.radius + 2.0 * MARGIN;
    if (free) out.push_back(disc);
  }
  return out;
}

} // namespace

TEST(Detour, holds_on_each_edge_and_keeps_both_ends) {
  std::mt19937_64 random(11);
  int led_round = 0;
  for (int i = 0; i < 200; ++i) {
    const std::vector<Disc> discs = randomDiscs(random);
    const Path path = around(line(), among(discs));
    ASSERT_FALSE(path.empty()) << i << ": there is a way past all discs, they end at y = 1.1";
    EXPECT_EQ(path.front(), line().front());
    EXPECT_EQ(path.back(), line().back());
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
      ASSERT_TRUE(isFree(discs, path[k], path[k + 1], 0.0)) << i << ", edge " << k;
      ASSERT_LE(distance(path[k], path[k + 1]), STEP * (1.0 + 1e-9)) << i << ", edge " << k;
    }
    for (const Row &row : path)
      for (const double value : row) ASSERT_LE(std::abs(value), 3.0) << i;
    led_round += path == line() ? 0 : 1;
  }
  EXPECT_GT(led_round, 150) << "most lines hit a disc";
}

TEST(Detour, leaves_a_path_that_holds_as_it_is) {
  const std::vector<Disc> discs = {{{0.0, 1.0}, 0.5}};
  EXPECT_EQ(around(line(), among(discs)), line());
}

/* Two rows alone: so far from each other that what is new would be cut off by its first edge. */
TEST(Detour, has_rows_as_close_as_its_corners_want) {
  std::mt19937_64 random(12);
  for (int i = 0; i < 100; ++i) {
    const std::vector<Disc> discs = randomDiscs(random);
    const Path straight = {line().front(), line().back()};
    Detours detours = among(discs);
    detours.step = 4.0;
    const Path path = around(straight, detours);
    ASSERT_FALSE(path.empty()) << i;
    for (std::size_t k = 0; k + 1 < path.size(); ++k) ASSERT_TRUE(isFree(discs, path[k], path[k + 1], 0.0)) << i;
    ASSERT_LE(path.size(), 150u) << i;
  }
}

TEST(Detour, is_the_same_for_the_same_path) {
  const std::vector<Disc> discs = {{{0.0, 0.1}, 0.5}, {{1.0, -0.2}, 0.3}};
  const Path once = around(line(), among(discs));
  EXPECT_NE(once, line());
  EXPECT_EQ(around(line(), among(discs)), once);
}

/* An end that has less clearance than what is new, and edges of the path that no detour touches. */
TEST(Detour, leaves_what_holds_without_the_clearance_of_what_is_new) {
  const std::vector<Disc> discs = {{{-2.0, 0.2}, 0.195}, {{1.7, -0.3}, 0.297}, {{0.0, 0.0}, 0.1}};
  const Path path = around(line(), among(discs));
  ASSERT_FALSE(path.empty());
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    const bool is_new = std::abs(path[k][1]) > 1e-9 || std::abs(path[k + 1][1]) > 1e-9;
    EXPECT_TRUE(isFree(discs, path[k], path[k + 1], is_new ? 0.5 * MARGIN : 0.0)) << k; // resampling cuts corners
  }
  EXPECT_EQ(path[1], line()[1]);
  EXPECT_EQ(path[path.size() - 2], line()[line().size() - 2]);
}

/* Between two discs there is less room than the first margin wants; past them there is none. */
TEST(Detour, takes_less_clearance_where_there_is_no_other_way) {
  std::vector<Disc> wall = {{{0.0, 0.0}, 0.15}, {{0.0, 0.315}, 0.15}};
  for (int i = 0; i < 60; ++i)
    for (const double side : {-0.15 - 0.05 * i, 0.465 + 0.05 * i}) wall.push_back({{0.0, side}, 0.05});
  EXPECT_TRUE(around(line(), among(wall)).empty());
  const Path path = around(line(), among(wall, {MARGIN, 0.002}));
  ASSERT_FALSE(path.empty());
  for (std::size_t k = 0; k + 1 < path.size(); ++k) EXPECT_TRUE(isFree(wall, path[k], path[k + 1], 0.0)) << k;
}

TEST(Detour, is_empty_where_there_is_no_way) {
  std::vector<Disc> ring;
  for (int i = 0; i < 24; ++i)
    ring.push_back({{2.0 + 0.5 * std::cos(i * M_PI / 12.0), 0.5 * std::sin(i * M_PI / 12.0)}, 0.1});
  EXPECT_TRUE(around(line(), among(ring)).empty());
}

TEST(Detour, is_empty_when_the_time_is_over) {
  const std::vector<Disc> discs = {{{0.0, 0.0}, 0.5}};
  Detours detours = among(discs);
  detours.is_over = [] { return true; };
  EXPECT_TRUE(around(line(), detours).empty());
}

TEST(Detour, asks_about_no_edge_when_the_time_is_over) {
  const std::vector<Disc> discs = {{{0.0, 0.0}, 0.5}, {{1.0, 0.2}, 0.3}};
  const Detours given = among(discs);
  int asked = 0;
  for (int most = 1; most < 400; most += 7) { // also while what is new is shortened and rounded
    Detours detours = given;
    detours.stays = detours.needed = [&](const Row &from, const Row &to) { return ++asked, given.needed(from, to); };
    detours.wanted = {[&](const Row &from, const Row &to) { return ++asked, given.wanted.front()(from, to); }};
    detours.is_over = [&] { return asked >= most; };
    asked = 0;
    around(line(), detours);
    ASSERT_LE(asked, most);
  }
}

TEST(Detour, is_halved_between_its_rows) {
  EXPECT_EQ(halved({{0.0, 0.0}, {1.0, 0.0}, {1.0, 2.0}}),
            (Path{{0.0, 0.0}, {0.5, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {1.0, 2.0}}));
}

TEST(Detour, is_resampled_at_equal_distances) {
  const Path path = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}, {1.0, 2.0}};
  const Path rows = resampled(path, 0.7);
  ASSERT_EQ(rows.size(), 6u) << "3 m in 5 parts of .6 m";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double way = 0.6 * static_cast<double>(i);
    EXPECT_NEAR(rows[i][0], std::min(1.0, way), 1e-12) << i;
    EXPECT_NEAR(rows[i][1], std::max(0.0, way - 1.0), 1e-12) << i;
  }
  EXPECT_EQ(resampled(path, 100.0), (Path{path.front(), path.back()}));
}
