/* SPDX-License-Identifier: BSD-3-Clause */
/* What a question costs again, and after one change of the scene. scripts/moveit_beside runs it and writes the page.
 *
 * Prints rows of CSV: what, first_ms, again_ms, changed_ms: the first question, the median of those after it, and that of
 * those after one change each. Times of this thread's processor. */
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <functional>
#include <thread>

#include <moveit/collision_detection/occupancy_map.h>
#include <moveit/planning_scene/planning_scene.h>
#include <ros/console.h>

#include "../../test/moveit/panda.h"
#include "certifier.h"

namespace {

namespace cd = collision_detection;
using Steps = std::function<void()>;

constexpr int TIMES = 31;

void noPause() {}

/* Longer than a detector takes octrees' cells for what they were, as between plans. */
void longPause() {
  std::this_thread::sleep_for(std::chrono::milliseconds(110));
}

double milliseconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

double timeOf(const Steps &question) {
  const double begin = milliseconds();
  question();
  return milliseconds() - begin;
}

double medianOf(const Steps &before, const Steps &question) {
  std::vector<double> all;
  for (int i = 0; i < TIMES; ++i) {
    before();
    all.push_back(timeOf(question));
  }
  std::nth_element(all.begin(), all.begin() + TIMES / 2, all.end());
  return all[TIMES / 2];
}

/* `pause` comes before each question that no change comes before. */
void print(const std::string &what, const Steps &question, const Steps &change, const Steps &pause = noPause) {
  const double first = timeOf(question), again = medianOf(pause, question), changed = medianOf(change, question);
  std::printf("%s,%.3f,%.3f,%.3f\n", what.c_str(), first, again, changed);
}

Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

/* A closed surface of 2 n² - 4 n + 2 triangles. */
shapes::ShapeConstPtr ball(unsigned int n, double radius) {
  auto out = std::make_shared<shapes::Mesh>(n * n, 2 * (n - 1) * (n - 1));
  unsigned int *triangle = out->triangles;
  for (unsigned int i = 0; i < n; ++i)
    for (unsigned int k = 0; k < n; ++k) {
      const double a = 2.0 * M_PI * i / (n - 1), b = M_PI * k / (n - 1);
      const unsigned int corner = i * n + k;
      double *vertex = out->vertices + 3 * corner;
      vertex[0] = radius * std::sin(b) * std::cos(a);
      vertex[1] = radius * std::sin(b) * std::sin(a);
      vertex[2] = radius * std::cos(b);
      if (i + 1 == n || k + 1 == n) continue;
      for (const unsigned int other : {corner, corner + n, corner + 1, corner + 1, corner + n, corner + n + 1})
        *triangle++ = other;
    }
  return out;
}

void attachedMesh() {
  const auto scene = pandaScene(true);
  const shapes::ShapeConstPtr mesh = ball(71, 0.03);
  const moveit::core::RobotState without(scene->getCurrentState());
  moveit::core::RobotState with(without);
  with.attachBody("cup", Eigen::Isometry3d::Identity(), {mesh}, {at(0.0, 0.0, 0.2)},
                  std::vector<std::string>{"panda_hand"}, "panda_hand");
  with.update();
  scene->isStateColliding(without);
  print(
      "a state with an attached mesh of 9800 triangles; states without it in turn",
      [&] { scene->isStateColliding(with); }, [&] { scene->isStateColliding(without); });
}

void boxes(int n) {
  const auto scene = pandaScene(true);
  const cd::WorldPtr &world = scene->getWorldNonConst();
  for (int i = 0; i < n; ++i)
    world->addToObject("box" + std::to_string(i), std::make_shared<shapes::Box>(0.1, 0.1, 0.1),
                       at(1.2 + 0.2 * (i % 10), 0.2 * (i / 10 % 10) - 1.0, 0.2 * (i / 100)));
  const moveit::core::RobotState from(scene->getCurrentState()), to = turned(0.05);
  int moves = 0;
  const Steps motion = [&] {
    cd::CollisionResult res;
    scene->getCollisionEnv()->checkRobotCollision({}, res, from, to, scene->getAllowedCollisionMatrix());
    if (res.collision) throw curve_proximity::Error("the motion is in collision");
  };
  print("a motion among " + std::to_string(n) + " boxes; one is moved", motion,
        [&] { world->setObjectPose("box5", at(2.2, 0.01 * ++moves, 0.0)); });
  print("a motion among " + std::to_string(n) + " boxes; one is replaced", motion, [&] {
    world->removeObject("box5");
    world->addToObject("box5", std::make_shared<shapes::Box>(0.1, 0.1, 0.1), at(2.2, 0.01 * ++moves, 0.0));
  });
}

/* Occupied cells beside the robot, `step` cells from one to the next. */
void octomapOf(const std::string &what, const std::array<int, 3> &counts, int step) {
  const auto scene = pandaScene(false);
  const auto tree = std::make_shared<cd::OccMapTree>(0.02);
  const auto cell = [step](int i, int k, int j) {
    const float apart = 0.02F * static_cast<float>(step);
    return octomap::point3d(1.51F + apart * static_cast<float>(i), -0.89F + apart * static_cast<float>(k),
                            0.01F + apart * static_cast<float>(j));
  };
  for (int i = 0; i < counts[0]; ++i)
    for (int k = 0; k < counts[1]; ++k)
      for (int j = 0; j < counts[2]; ++j) tree->updateNode(cell(i, k, j), true);
  scene->processOctomapPtr(tree, Eigen::Isometry3d::Identity());
  robot_trajectory::RobotTrajectory plan(panda(), "panda_arm");
  plan.addSuffixWayPoint(scene->getCurrentState(), 0.0);
  plan.addSuffixWayPoint(turned(0.4), 1.0);
  const curve_proximity::Certifier certifier;
  bool occupied = true;
  print(
      "a plan beside an octomap of " + std::to_string(tree->getNumLeafNodes()) + " leaves " + what +
          " (FCL's detector); one cell changes",
      [&] {
        const std::string why = certifier.certify(*scene, plan, {}).why;
        if (!why.empty()) throw curve_proximity::Error(why);
      },
      [&] {
        occupied = !occupied;
        tree->setNodeValue(cell(0, 0, 0), occupied ? 2.0F : -2.0F);
        tree->updateInnerOccupancy();
        scene->processOctomapPtr(tree, Eigen::Isometry3d::Identity());
      },
      longPause);
}

} // namespace

int main() try {
  ros::Time::init();
  ros::console::set_logger_level(ROSCONSOLE_ROOT_LOGGER_NAME,
                                 ros::console::levels::Error); // its other lines go to stdout
  ros::console::notifyLoggerLevelsChanged();
  std::printf("what,first_ms,again_ms,changed_ms\n");
  attachedMesh();
  boxes(1000);
  octomapOf("apart", {17, 17, 17}, 2);
  octomapOf("apart", {47, 47, 47}, 2);
  octomapOf("of a wall", {1, 322, 322}, 1);
  return 0;
} catch (const std::exception &error) {
  std::fprintf(stderr, "moveit_costs: %s\n", error.what());
  return 2;
}
