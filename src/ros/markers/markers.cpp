/* SPDX-License-Identifier: BSD-3-Clause */
#include "markers/markers.h"

#include <ros/console.h>

#include <algorithm>

#include "markers/canvas.h"
#include "markers/curve_markers.h"
#include "markers/motion_markers.h"
#include "markers/mover_markers.h"
#include "transport/guard.h"

namespace curve_proximity {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double DRAWING_PERIOD = 0.1;    /* [s] between two publications at least */
constexpr std::size_t MAX_SAMPLES = 2000; /* of all curves of a drawing together */
constexpr std::size_t MAX_CURVE_SAMPLES = 160;
constexpr double LARGE = 0.4; /* [m] the diagonal from which on an object is drawn translucent */

void addScene(Canvas &canvas, const Snapshot &scene, const ResourceOptions &resources, StandingBodies &placed) {
  for (const auto &entry : scene.objects()) {
    const SceneObject &object = *entry.second;
    for (std::size_t i = 0; i < object.shapes.size(); ++i) {
      const ShapeDescription &shape = object.description.shapes[i];
      if (object.shapes[i].geometry.isEmpty()) continue;
      const Eigen::Isometry3d pose = object.description.pose * shape.pose;
      if (object.shapes[i].geometry.curve) {
        addObstacleCurve(canvas, object.shapes[i].geometry, pose, object.description.padding);
        continue;
      }
      // What is large, a shelf say, must not hide what it holds.
      const bool is_seen =
          shape.type == ShapeType::OCTREE || shape.type == ShapeType::POINTS; // as a sensor sees it: from outside
      const bool is_large = !is_seen && !(object.shapes[i].placed.box.sizes().norm() < LARGE);
      const std_msgs::ColorRGBA tint = is_large ? colour(0.72, 0.76, 0.8, 0.35) : colour(0.55, 0.6, 0.66, 1.0);
      canvas.addShape("scene", shape, object.shapes[i].geometry.hull, resources, pose, tint);
      placed.push_back(
          {object.shapes[i].geometry.body.get(), pose, object.description.padding + object.shapes[i].geometry.margin});
    }
  }
}

void addCurves(Canvas &canvas, const Snapshot &scene, const Drawing &drawing, const StandingBodies &placed) {
  const std::size_t samples = std::clamp<std::size_t>(MAX_SAMPLES / drawing.lines.size(), 2, MAX_CURVE_SAMPLES);
  for (const Drawing::Line &line : drawing.lines) {
    addCurve(canvas, line.curve, placed, samples);
    const Answer *nearest = nearestOf(line.answers);
    if (nearest && drawing.snapshot->version() == scene.version()) addPair(canvas, *nearest);
  }
}

/** Drawings may be null. */
MarkerArray toMarkers(const Snapshot &scene, const Drawing *curves, const Drawing *motion, const std::string &frame,
                      const MarkerResources &resources) {
  Canvas canvas(frame);
  StandingBodies objects;
  addScene(canvas, scene, resources.objects, objects);

  // One robot: at the closest moment of the trajectory, or where the curves met it.
  StandingBodies everything = objects;
  addMovers(canvas, scene, motion, resources.objects, resources.robot);
  if (motion && motion->motion.robot) {
    addMotion(canvas, scene, *motion, resources.robot, objects);
  } else if (curves && curves->snapshot->robot()) {
    addRobot(canvas, *curves->snapshot, curves->links, resources.robot, everything);
  }
  if (curves) addCurves(canvas, scene, *curves, everything);
  return canvas.take();
}

} // namespace

MarkerPublisher::MarkerPublisher(ros::NodeHandle &handle, const Scene &scene, const std::string &frame,
                                 MarkerResources resources)
    : scene_(scene), frame_(frame), resources_(std::move(resources)) {
  publisher_ = handle.advertise<MarkerArray>("markers", 1, true);
  timer_ = handle.createWallTimer(ros::WallDuration(DRAWING_PERIOD), [this](const ros::WallTimerEvent &) {
    guarded([this] { publishIfNew(); }, [](const std::string &why) { ROS_ERROR("markers: %s", why.c_str()); });
  });
}

void MarkerPublisher::show(std::shared_ptr<const Drawing> drawing) {
  if (!isWatched()) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (drawing->motion.robot || drawing->motion.movers) motion_ = drawing;
  if (!drawing->lines.empty()) curves_ = std::move(drawing);
  changed_ = true;
}

void MarkerPublisher::showState(std::shared_ptr<const Drawing> drawing) {
  if (!isWatched()) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  state_ = std::move(drawing);
  changed_ = changed_ || !motion_;
}

void MarkerPublisher::publishIfNew() {
  const SnapshotPtr scene = scene_.snapshot();
  std::shared_ptr<const Drawing> curves, motion;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!isWatched()) {
      curves_ = motion_ = state_ = nullptr;
      changed_ = true;
      return;
    }
    if (!changed_ && shown_scene_ == scene->version()) return;
    changed_ = false;
    shown_scene_ = scene->version();
    curves = curves_;
    motion = motion_ ? motion_ : state_;
  }
  publisher_.publish(toMarkers(*scene, curves.get(), motion.get(), frame_, resources_));
}

} // namespace curve_proximity
