/* SPDX-License-Identifier: BSD-3-Clause */
/* Where on a trajectory a robot is: never later than it is, and nowhere if it is not on it. What a watch doubts. */
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "gate/motion_watches.h"
#include "gate/trajectory_progress.h"

namespace curve_proximity {
namespace {

using trajectory_msgs::JointTrajectory;
using trajectory_msgs::JointTrajectoryPoint;

const std::vector<std::string> ONE = {"a"};

JointTrajectory through(const std::vector<double> &positions, double step) {
  JointTrajectory out;
  out.joint_names = ONE;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    JointTrajectoryPoint point;
    point.positions = {positions[i]};
    point.time_from_start = ros::Duration(step * static_cast<double>(i));
    out.points.push_back(point);
  }
  return out;
}

TEST(TrajectoryProgress, a_slow_robot_is_where_its_joints_are) {
  TrajectoryProgress progress(through({0, 1, 2, 3}, 1.0), 0.1);
  EXPECT_EQ(progress.tell(ONE, {0.48}, 2.0), "");
  EXPECT_EQ(progress.point(), 0u);
  EXPECT_EQ(progress.tell(ONE, {1.5}, 1.0), "");
  EXPECT_EQ(progress.point(), 1u);
  EXPECT_EQ(progress.tell(ONE, {0.5}, 1.0).substr(0, 34), "the robot is not on the trajectory");
  EXPECT_EQ(progress.point(), 1u);
  EXPECT_FALSE(progress.isAtEnd());
  EXPECT_EQ(progress.tell(ONE, {2.95}, 1.0), "");
  EXPECT_TRUE(progress.isAtEnd());
}

TEST(TrajectoryProgress, a_place_that_is_passed_twice_is_the_first_one) {
  TrajectoryProgress progress(through({0, 0.5, 1, 0.5, 0}, 1.0), 0.01);
  for (const double at : {0.2, 0.7, 0.99, 0.7}) EXPECT_EQ(progress.tell(ONE, {at}, 0.5), "");
  EXPECT_EQ(progress.point(), 1u);
  EXPECT_EQ(progress.tell(ONE, {0.4}, 0.5),
            "the robot is not on the trajectory: joint 'a' at 0.4 is 0.1 away from it, "
            "more than ~path_tolerance = 0.01");
  EXPECT_EQ(progress.tell(ONE, {0.4}, 2.0), ""); // time enough to have come there
  EXPECT_EQ(progress.point(), 3u);
}

TEST(TrajectoryProgress, what_lies_ahead_is_not_reached_in_no_time) {
  TrajectoryProgress progress(through({0, 1, 0, -1}, 1.0), 0.01);
  EXPECT_NE(progress.tell(ONE, {-0.5}, 0.0), "");
  EXPECT_EQ(progress.tell(ONE, {-0.5}, 2.0), "");
  EXPECT_EQ(progress.point(), 2u);
}

TEST(TrajectoryProgress, the_continuous_joints_of_a_robot_are_those_of_its_description) {
  const std::string limit = "<limit lower='-9' upper='9' effort='1' velocity='1'/>";
  const std::string urdf =
      "<robot name='three'><link name='a'/><link name='b'/><link name='c'/><link name='d'/>"
      "<joint name='wheel' type='continuous'><parent link='a'/><child link='b'/></joint>"
      "<joint name='elbow' type='revolute'><parent link='b'/><child link='c'/>" +
      limit +
      "</joint>"
      "<joint name='slide' type='prismatic'><parent link='c'/><child link='d'/>" +
      limit + "</joint>";
  EXPECT_EQ(continuousJoints(urdf + "</robot>"), std::set<std::string>{"wheel"});
  EXPECT_THROW(continuousJoints(urdf), Error);
}

TEST(TrajectoryProgress, continuous_joints_are_compared_up_to_full_turns_and_all_must_be_told) {
  TrajectoryProgress progress(through({3.0, 3.3}, 1.0), 0.01, {"a"}), other(through({3.0, 3.3}, 1.0), 0.01, {"b"});
  EXPECT_EQ(progress.tell({"b", "a"}, {7.0, 3.2 - 2.0 * M_PI}, 0.5), "");
  EXPECT_NE(other.tell({"b", "a"}, {7.0, 3.2 - 2.0 * M_PI}, 0.5), ""); // it would turn back, or is a slide
  EXPECT_EQ(other.tell(ONE, {3.2}, 0.5), "");
  EXPECT_EQ(progress.tell({"b"}, {3.2}, 0.5), "where joint 'a' is was not told");
  EXPECT_EQ(progress.tell(ONE, {}, 0.5), "where joint 'a' is was not told");
  EXPECT_EQ(progress.tell(ONE, {NAN}, 0.5), "where joint 'a' is was not told");
}

/* The cubic or quintic of random points, at random times: always on it, never before the point that is told. */
TEST(TrajectoryProgress, a_robot_on_the_spline_is_on_the_trajectory_and_not_before_its_point) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  for (int n = 0; n < 2000; ++n) {
    const bool quintic = n % 2;
    JointTrajectory trajectory = through({value(random), value(random), value(random), value(random)}, 0.5);
    for (JointTrajectoryPoint &point : trajectory.points) {
      point.velocities = {3.0 * value(random)};
      if (quintic) point.accelerations = {5.0 * value(random)};
    }
    TrajectoryProgress progress(trajectory, 1e-9);
    for (double t = 0.01; t < 1.5; t += 0.01) {
      const auto i = static_cast<std::size_t>(t / 0.5);
      const JointTrajectoryPoint &a = trajectory.points[i], &b = trajectory.points[i + 1];
      const double h = 0.5, s = t / h - static_cast<double>(i);
      const double p = a.positions[0], q = b.positions[0], v = h * a.velocities[0], w = h * b.velocities[0];
      double x = p + s * v + s * s * (3 * (q - p) - 2 * v - w) + s * s * s * (2 * (p - q) + v + w);
      if (quintic) {
        const double c = h * h * a.accelerations[0], d = h * h * b.accelerations[0], e = q - p;
        x = p + v * s + c / 2 * s * s + (10 * e - 6 * v - 4 * w - 1.5 * c + d / 2) * s * s * s +
            (-15 * e + 8 * v + 7 * w + 1.5 * c - d) * s * s * s * s +
            (6 * e - 3 * v - 3 * w - c / 2 + d / 2) * s * s * s * s * s;
      }
      ASSERT_EQ(progress.tell(ONE, {x}, 0.01), "") << n << " at " << t;
      ASSERT_LE(progress.point(), i);
    }
  }
}

/* ROS time is the test's own. */
TEST(MotionWatch, silence_and_a_time_that_goes_back_are_doubts) {
  ros::Time::init();
  ros::Time::setNow(ros::Time(100.0));
  ProximityQuery query;
  query.trajectories.push_back(through({0.0, 1.0}, 10.0));
  MotionWatch watch(query, SeenScene(), GateParameters(), {}, [](Refusal) {});
  EXPECT_EQ(watch.doubt(), "");
  ros::Time::setNow(ros::Time(101.0));
  EXPECT_NE(watch.doubt().find("has not told"), std::string::npos);
  watch.tell(ONE, {0.1}, ros::Time());
  EXPECT_EQ(watch.doubt(), "");
  ros::Time::setNow(ros::Time(100.9)); // less than ~feedback_timeout: a clock that is set
  EXPECT_EQ(watch.doubt(), "");
  ros::Time::setNow(ros::Time(50.0));
  watch.tell(ONE, {0.2}, ros::Time());
  EXPECT_EQ(watch.doubt(), "ROS time has gone back by 51 s");
}

} // namespace
} // namespace curve_proximity
