/* SPDX-License-Identifier: BSD-3-Clause */
/* Speed and separation: stops at random times while persons walk at random, simulated by formulas of the test's own. */
#include <curve_proximity/separation.hpp>

#include "support.h"

using namespace curve_proximity;
using namespace curve_proximity::test;

namespace {

constexpr double LINKS[] = {0.5, 0.4}, BALL = 0.1, PERSON = 0.3;

/* Two links that turn in a plane, with a ball at the end of each. */
std::shared_ptr<const Robot> planar() {
  const auto link = [](const std::string &name, double x) {
    return "<link name='" + name + "'><collision><origin xyz='" + std::to_string(x) +
           " 0 0'/><geometry><sphere radius='0.1'/></geometry></collision></link>";
  };
  const auto joint = [](const std::string &name, const std::string &parent, const std::string &child, double x) {
    return "<joint name='" + name + "' type='continuous'><parent link='" + parent + "'/><child link='" + child +
           "'/><origin xyz='" + std::to_string(x) + " 0 0'/><axis xyz='0 0 1'/></joint>";
  };
  return Robot::fromUrdf("<robot name='planar'><link name='base'/>" + link("upper", LINKS[0]) +
                             link("lower", LINKS[1]) + joint("a", "base", "upper", 0.0) +
                             joint("b", "upper", "lower", LINKS[0]) + "</robot>",
                         {});
}

/* A motion of straight edges in the joint space, and what the test knows of it. */
struct Planar {
  std::vector<double> times;
  std::vector<std::array<double, 2>> values;

  explicit Planar(Random &random) {
    double t = random.uniform(-1.0, 1.0);
    for (int i = 0; i < 4; ++i) {
      times.push_back(t);
      t += random.uniform(0.4, 1.5);
      values.push_back({random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5)});
    }
  }

  TrajectoryDescription trajectory() const {
    TrajectoryDescription out;
    out.id = "planar";
    out.joints = {"a", "b"};
    for (std::size_t i = 0; i < times.size(); ++i) {
      out.points.emplace_back();
      out.points.back().time = times[i];
      out.points.back().positions = {values[i][0], values[i][1]};
    }
    return out;
  }

  /* Where the middles of both balls are. */
  std::array<Eigen::Vector2d, 2> balls(double t) const {
    std::size_t i = 1;
    while (i + 1 < times.size() && t > times[i]) ++i;
    const double f = std::clamp((t - times[i - 1]) / (times[i] - times[i - 1]), 0.0, 1.0);
    const double a = values[i - 1][0] + f * (values[i][0] - values[i - 1][0]);
    const double b = values[i - 1][1] + f * (values[i][1] - values[i - 1][1]);
    const Eigen::Vector2d elbow = LINKS[0] * Eigen::Vector2d(std::cos(a), std::sin(a));
    return {elbow, elbow + LINKS[1] * Eigen::Vector2d(std::cos(a + b), std::sin(a + b))};
  }

  /* No ball is faster at override 1. */
  double speed() const {
    double out = 0.0;
    for (std::size_t i = 1; i < times.size(); ++i) {
      const double a = std::fabs(values[i][0] - values[i - 1][0]), b = std::fabs(values[i][1] - values[i - 1][1]);
      out = std::max(out, (a * (LINKS[0] + LINKS[1]) + b * LINKS[1]) / (times[i] - times[i - 1]));
    }
    return out;
  }
};

Separation randomSeparation(Random &random) {
  Separation out;
  out.person_speed = random.uniform(0.0, 2.0);
  out.reaction_time = random.uniform(0.0, 0.3);
  out.stopping_time = random.uniform(0.0, 0.6);
  out.intrusion = random.uniform(0.0, 0.1);
  out.person_position = random.uniform(0.0, 0.05);
  out.robot_position = random.uniform(0.0, 0.02);
  return out;
}

double keptOf(const Separation &s) {
  return s.intrusion + s.person_position + s.robot_position;
}

/* The motion through a scene with one person at a place: a ball. */
SpeedLimits limitsOf(const Planar &planar_motion, const Eigen::Vector2d &person, const Separation &separation,
                     std::size_t n) {
  static const std::shared_ptr<const Robot> robot = planar();
  Scene scene(robot, {}, {});
  EXPECT_TRUE(
      scene.apply(change({add("person", {shape(ShapeType::SPHERE, {PERSON})}, translation(person.x(), person.y(), 0))}))
          .empty());
  const RobotMotion motion(scene.snapshot(), planar_motion.trajectory(), {});
  Workspace workspace;
  return speedLimits(motion, n, separation, Query(), workspace);
}

/* One run: the robot goes at the limits, or factor times these; from a random moment on the person walks, and after the
 * reaction time the robot brakes. Returns the least distance until the robot stands. */
double runOnce(const Planar &motion, const SpeedLimits &limits, const Separation &s, Eigen::Vector2d person,
               double factor, Random &random) {
  constexpr double STEP = 2e-3;
  std::size_t i = random.below(limits.profile.size());
  if (limits.overrides[i] == 0.0) return 1e9; // the robot stands there, however near the person is
  double t = random.uniform(limits.profile[i].t0, limits.profile[i].t1);
  const double end = limits.profile.back().t1;
  /* to where the robot's nearest ball will be or is, or anywhere */
  const bool chases = random.below(4) != 0;
  const Eigen::Vector2d anywhere = random.vector(1.5).head<2>();
  const auto now = [&] {
    while (i + 1 < limits.profile.size() && t >= limits.profile[i].t1) ++i;
    return std::min(1.0, factor * limits.overrides[i]);
  };
  double k = now(), least = 1e9;
  for (double clock = 0.0;; clock += STEP) {
    const auto balls = motion.balls(t);
    const double first = (balls[0] - person).norm(), second = (balls[1] - person).norm();
    least = std::min({least, first - BALL - PERSON, second - BALL - PERSON});
    if (clock < s.reaction_time)
      k = now();
    else
      k = s.stopping_time > 0.0 ? k - STEP / s.stopping_time : 0.0;
    if (k <= 0.0 && clock >= s.reaction_time) return least;
    /* a step of the person, then of the robot: never farther than both can go */
    const Eigen::Vector2d goal = chases ? balls[first < second ? 0 : 1] : anywhere;
    const Eigen::Vector2d way = goal - person;
    if (way.norm() > 1e-9) person += way.normalized() * std::min(way.norm(), s.person_speed * STEP);
    t = std::min(end, t + std::max(0.0, k) * STEP);
  }
}

} // namespace

/* 150 motions (seed 4601), 100 stops each. The simulation's steps are exact at their ends but for the last one of the
 * braking, in which the person walks and the robot's speed is rounded up to its value before: two steps of both. */
TEST(Separation, no_stop_comes_nearer_than_what_is_to_be_kept) {
  Random random(4601);
  int moving = 0, nearer = 0;
  for (int c = 0; c < 150; ++c) {
    const Planar motion(random);
    Separation s = randomSeparation(random);
    if (c % 3 == 0) s.robot_speed = motion.speed();
    const Eigen::Vector2d person = random.uniform(1.0, 2.0) * Eigen::Vector2d(1.0, random.uniform(-1.0, 1.0));
    const SpeedLimits limits = limitsOf(motion, person, s, 40);
    ASSERT_EQ(limits.overrides.size(), 40u);
    const double lost = 4e-3 * (s.person_speed + motion.speed());
    bool violated = false;
    for (int r = 0; r < 100; ++r) {
      EXPECT_GE(runOnce(motion, limits, s, person, 1.0, random), keptOf(s) - lost) << "case " << c << " run " << r;
      if (!s.robot_speed) violated |= runOnce(motion, limits, s, person, 1.5, random) < keptOf(s) - lost;
    }
    const double constant = *std::min_element(limits.overrides.begin(), limits.overrides.end());
    EXPECT_EQ(constant, limits.constant);
    moving += constant > 0.05 && constant < 0.9;
    nearer += violated && constant > 0.05 && constant < 0.9;
  }
  EXPECT_GT(moving, 20);
  EXPECT_GT(nearer, moving / 4); /* half as fast again is not safe: the limits are not merely low */
}

/* 60 motions (seed 4602): nobody is watched, the person starts with the motion, reaction_time after being seen. */
TEST(Separation, a_motion_that_nobody_watches_ends_before_a_person_is_there) {
  Random random(4602);
  int answered = 0;
  for (int c = 0; c < 60; ++c) {
    const Planar motion(random);
    Separation s = randomSeparation(random);
    s.person_speed = random.uniform(0.05, 0.5);
    const Eigen::Vector2d person = random.uniform(1.2, 2.5) * Eigen::Vector2d(1.0, random.uniform(-1.0, 1.0));
    const SpeedLimits limits = limitsOf(motion, person, s, 600);
    if (!(limits.unwatched <= 1.0)) continue;
    ++answered;
    const double t0 = limits.profile.front().t0, t1 = limits.profile.back().t1;
    for (int r = 0; r < 400; ++r) {
      const double k = random.uniform(limits.unwatched, 1.0), t = random.uniform(t0, t1);
      const double walked = s.person_speed * (s.reaction_time + (t - t0) / k);
      for (const Eigen::Vector2d &ball : motion.balls(t))
        EXPECT_GE((ball - person).norm() - BALL - PERSON - walked, keptOf(s) - 1e-9);
    }
    /* the first moment at which a slower one is too slow */
    double least = 1e9;
    for (int r = 0; r <= 4000; ++r) {
      const double t = t0 + (t1 - t0) * r / 4000.0;
      for (const Eigen::Vector2d &ball : motion.balls(t))
        least = std::min(least, (ball - person).norm() - BALL - PERSON -
                                    s.person_speed * (s.reaction_time + (t - t0) / (0.8 * limits.unwatched)));
    }
    EXPECT_LT(least, keptOf(s));
  }
  EXPECT_GT(answered, 15);
}

/* A robot that comes straight at a wall of persons: clearance 2 - t. */
TEST(Separation, limits_are_those_of_the_formula) {
  std::vector<ClearanceInterval> profile;
  for (int i = 0; i < 100; ++i) {
    ClearanceInterval one;
    one.t0 = 0.01 * i, one.t1 = 0.01 * (i + 1);
    one.lower = one.upper = 2.0 - one.t1;
    profile.push_back(one);
  }
  Separation s;
  s.person_speed = 1.6, s.reaction_time = 0.1, s.stopping_time = 0.5, s.intrusion = 0.3;
  s.robot_speed = 1.0;
  const SpeedLimits any = limitSpeed(profile, s);
  for (int i = 0; i < 100; ++i) {
    /* the least of this interval and of those that reach it */
    const double room = profile[i].lower - 0.3 - 1.6 * 0.1;
    const auto needs = [](double k) { return 1.6 * 0.5 * k + 0.1 * k + 0.25 * k * k; };
    const double k = any.overrides[i];
    EXPECT_LE(needs(k), room) << i;
    /* limits fall: they are lower than need be by what an interval changes, at most */
    EXPECT_GE(needs(k) + (k < 1.0 - 1e-9 ? 0.02 : 1e9), room) << i;
  }
  /* along the path the same robot needs no more: it comes nearer by what it goes */
  s.robot_speed.reset();
  const SpeedLimits along = limitSpeed(profile, s);
  for (int i = 0; i < 80; ++i) EXPECT_GE(along.overrides[i] + 0.02, any.overrides[i]) << i;
  EXPECT_EQ(along.constant, along.overrides.back());

  /* what is not known limits most, what is far limits nothing */
  profile[50].lower = 0.0;
  EXPECT_EQ(limitSpeed(profile, s).overrides[50], 0.0);
  for (ClearanceInterval &one : profile) one.lower = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(limitSpeed(profile, s).constant, 1.0, 1e-9);
  s.stopping_time = -1.0;
  expectContains(errorOf([&] { limitSpeed(profile, s); }), "stopping_time");
}
