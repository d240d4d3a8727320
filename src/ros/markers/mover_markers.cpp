/* SPDX-License-Identifier: BSD-3-Clause */
#include "markers/mover_markers.h"

#include <algorithm>
#include <vector>

#include "markers/curve_markers.h"

namespace curve_proximity {
namespace {

constexpr std::size_t WAY_SAMPLES = 60;
constexpr std::size_t OBJECT_GHOSTS = 5; /* poses of an object on its way */
constexpr double WAY_RADIUS = 0.005;     /* [m] as it is drawn */

const std_msgs::ColorRGBA OBJECT = colour(0.9, 0.6, 0.2, 1.0), GHOST = colour(0.9, 0.6, 0.2, 0.12);
const std_msgs::ColorRGBA ROBOT = colour(0.72, 0.68, 0.86, 1.0);

/** An object that moves, as it is drawn. */
struct DrawnObject {
  const ObjectDescription &description;
  std::vector<BodyHandle> hulls; /**< of its shapes */

  explicit DrawnObject(const MovingSceneObject &object) : description(object.description) {
    for (const Geometry &geometry : object.geometries) hulls.push_back(geometry.hull);
  }
  DrawnObject(const ObjectDescription &object, const ResourceOptions &resources) : description(object) {
    for (const ShapeDescription &shape : object.shapes) hulls.push_back(makeGeometry(shape, resources).hull);
  }
};

void addObject(Canvas &canvas, const std::string &space, const DrawnObject &object, const Eigen::Isometry3d &pose,
               const ResourceOptions &resources, const std_msgs::ColorRGBA &tint) {
  for (std::size_t i = 0; i < object.hulls.size(); ++i) {
    const ShapeDescription &shape = object.description.shapes[i];
    canvas.addShape(space, shape, object.hulls[i], resources, pose * shape.pose, tint);
  }
}

/** The way of the origin, and the object on it. */
void addWay(Canvas &canvas, const DrawnObject &object, const Movers &movers, const ResourceOptions &resources) {
  const auto poseAt = [&](std::size_t i, std::size_t n) {
    return movers.objectPose(object.description.id, sampleAt(movers.domain(), i, n));
  };
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i <= WAY_SAMPLES; ++i) points.push_back(poseAt(i, WAY_SAMPLES).translation());
  addTube(canvas, "movers_way", points, std::vector<std_msgs::ColorRGBA>(points.size(), OBJECT), WAY_RADIUS);
  for (std::size_t i = 0; i <= OBJECT_GHOSTS; ++i)
    addObject(canvas, "movers_way", object, poseAt(i, OBJECT_GHOSTS), resources, GHOST);
}

void addRobotAt(Canvas &canvas, const MovingRobot &robot, double t, const ResourceOptions &resources) {
  const std::array<double, 2> domain = robot.motion->domain();
  const LinkPoses poses = robot.motion->linkPoses(std::clamp(t - robot.start, domain[0], domain[1]));
  const Snapshot &own = *robot.motion->snapshot();
  for (const auto &[link, pose] : poses) {
    if (own.robot()->links().count(link) == 0) continue;
    for (const LinkGeometry &element : own.linkGeometry(link))
      canvas.addShape("movers", element.description, element.geometry.hull, resources, pose * element.pose, ROBOT);
  }
}

} // namespace

void addMovers(Canvas &canvas, const Snapshot &scene, const Drawing *drawing, const ResourceOptions &objects,
               const ResourceOptions &robots) {
  if (!drawing || !drawing->motion.movers || drawing->snapshot->version() != scene.version()) {
    for (const auto &[id, object] : scene.moving())
      addObject(canvas, "movers", DrawnObject(*object), object->trajectory.poses.front().pose, objects, OBJECT);
    return;
  }
  const Drawing::Motion &motion = drawing->motion;
  const Answer *nearest = nearestOf(motion.answers);
  const double t = nearest ? nearest->result.t : motion.movers->domain()[0];
  const auto addMoving = [&](const DrawnObject &object) {
    addObject(canvas, "movers", object, motion.movers->objectPose(object.description.id, t), objects, OBJECT);
    addWay(canvas, object, *motion.movers, objects);
  };
  for (const auto &[id, object] : scene.moving()) addMoving(DrawnObject(*object));
  if (motion.rider) addMoving(DrawnObject(*motion.rider, objects));
  for (const MovingRobot &robot : motion.others) addRobotAt(canvas, robot, t, robots);
  if (nearest && !motion.robot) addPair(canvas, *nearest); // the robot's own picture has the pair
}

} // namespace curve_proximity
