/* SPDX-License-Identifier: BSD-3-Clause */
#include "world/sensors.h"

#include <ros/console.h>

#include <utility>

#include "messages/cloud.h"
#include "messages/shape_message.h"
#include "transport/checked_stream.h"
#include "transport/guard.h"

namespace curve_proximity {

Sensors::Sensors(const ros::NodeHandle &handle, const Parameters &parameters, LiveScene &live, const Frames &frames)
    : parameters_(parameters), live_(live), frames_(frames), handle_(onQueue(handle, queue_)) {
  for (const std::string &id : parameters.expected_sensors) live_.sensors.awaits(id);
  const auto hear = [this](ros::SubscribeOptions topic) { subscribers_.push_back(handle_.subscribe(topic)); };
  hear(checkedSubscription<sensor_msgs::PointCloud2>("cloud", 1, [this](const auto &message) { takeCloud(message); }));
  hear(checkedSubscription<octomap_msgs::Octomap>("octomap", 1, [this](const auto &message) { takeOctomap(message); }));
  queue_.start();
}

Sensors::~Sensors() {
  for (ros::Subscriber &subscriber : subscribers_) subscriber.shutdown();
  queue_.end();
}

/** Does the work of a message. What it throws makes the object unknown. */
template <class Work>
void Sensors::take(const std::string &topic, const std::string &id, Work &&work) {
  guarded(work, [&](const std::string &why) {
    live_.sensors.refused(id);
    if (log_limit_.isDue(topic + why)) ROS_WARN_STREAM(topic + ": " + why + "; what is there now is unknown");
  });
}

void Sensors::takeCloud(const sensor_msgs::PointCloud2::ConstPtr &message) {
  take("~cloud", parameters_.cloud_id, [&] {
    Cloud cloud = toCloud(*message);
    const auto valid = static_cast<double>(cloud.points.cols());
    const double all = valid + static_cast<double>(cloud.left_out);
    if (valid == 0.0 || valid < parameters_.least_valid_share * all) {
      if (valid > 0.0 || !parameters_.empty_cloud_clears)
        return live_.sensors.sawNothing(parameters_.cloud_id, message->header.stamp);
      return remove(parameters_.cloud_id, message->header.stamp);
    }
    ShapeDescription shape;
    shape.type = ShapeType::POINTS;
    shape.dimensions = {parameters_.cloud_radius};
    shape.vertices = std::move(cloud.points);
    replace(parameters_.cloud_id, message->header, std::move(shape));
  });
}

void Sensors::takeOctomap(const octomap_msgs::Octomap::ConstPtr &message) {
  take("~octomap", parameters_.octomap_id, [&] {
    ShapeDescription shape;
    shape.type = ShapeType::OCTREE;
    shape.unknown_is_occupied = parameters_.unknown_is_occupied;
    shape.octree = toOctree(*message);
    replace(parameters_.octomap_id, message->header, std::move(shape));
  });
}

void Sensors::replace(const std::string &id, const std_msgs::Header &header, ShapeDescription shape) {
  Operation operation;
  operation.object.id = id;
  operation.object.pose = frames_.place(header.frame_id, header.stamp, frames_.deadline(), nullptr).pose;
  operation.object.shapes.push_back(std::move(shape));
  SceneChange change;
  change.operations.push_back(std::move(operation));
  live_.applySeen(change, id, header.stamp);
}

void Sensors::remove(const std::string &id, const ros::Time &stamp) {
  if (live_.scene.snapshot()->objects().count(id) == 0) return live_.sensors.saw(id, stamp, live_.sensors.emptied());
  SceneChange change;
  change.operations.resize(1);
  change.operations.front().kind = Operation::Kind::REMOVE;
  change.operations.front().object.id = id;
  live_.applySeen(change, id, stamp);
}

} // namespace curve_proximity
