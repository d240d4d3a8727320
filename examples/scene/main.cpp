/* SPDX-License-Identifier: BSD-3-Clause */
/* How close does an arm come to a box on its way? Without ROS: scene_example ROBOT.urdf JOINT FROM TO [rad]. */
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <curve_proximity/motion.hpp>
#include <curve_proximity/scene.hpp>

using namespace curve_proximity;

static ObjectDescription box() {
  ShapeDescription shape;
  shape.type = ShapeType::BOX;
  shape.dimensions = {0.2, 0.2, 0.2};
  ObjectDescription object;
  object.id = "box";
  object.pose.translation() << 0.5, 0.0, 0.9;
  object.shapes = {shape};
  return object;
}

int main(int argc, char **argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: scene_example ROBOT.urdf JOINT FROM TO\n");
    return 2;
  }
  try {
    std::ifstream file(argv[1]);
    if (!file) throw Error(std::string(argv[1]) + " cannot be read");
    const std::string urdf((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    RobotOptions options;
    options.resources.base_dir = std::filesystem::path(argv[1]).parent_path().string();

    Scene scene(Robot::fromUrdf(urdf, options));
    Operation add;
    add.object = box();
    SceneChange change;
    change.operations = {add};
    for (const std::string &fault : scene.apply(change)) throw Error(fault);

    TrajectoryDescription trajectory;
    trajectory.joints = {argv[2]};
    trajectory.points.resize(2);
    trajectory.points[0].positions = {std::atof(argv[3])};
    trajectory.points[1].positions = {std::atof(argv[4])};
    trajectory.points[1].time = 1.0;
    const RobotMotion motion(scene.snapshot(), trajectory, {});
    Workspace workspace;
    const Answer answer = askEnvironment(motion, Query{}, workspace).front();
    std::printf("%.6f <= distance <= %.6f m: %s to %s at %.3f s\n", answer.result.lower, answer.result.upper,
                answer.a.c_str(), answer.b.c_str(), answer.result.t);
  } catch (const std::exception &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
