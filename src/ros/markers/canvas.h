/* SPDX-License-Identifier: BSD-3-Clause */
/** Markers of one frame, and how bodies are drawn with them. */
#ifndef CURVE_PROXIMITY_ROS_CANVAS_H
#define CURVE_PROXIMITY_ROS_CANVAS_H

#include <visualization_msgs/MarkerArray.h>

#include <array>
#include <curve_proximity/geometry.hpp>
#include <string>

namespace curve_proximity {

std_msgs::ColorRGBA colour(double r, double g, double b, double a);

/** Red at a touch, amber between, teal with 0.3 m to spare; hue and lightness both change, for eyes that do not tell
 * red from green. */
std_msgs::ColorRGBA clearanceColour(double clearance);

/** The i-th of n + 1 times from the beginning of a domain to its end. */
inline double sampleAt(const std::array<double, 2> &domain, std::size_t i, std::size_t n) {
  const double part = static_cast<double>(i) / static_cast<double>(n);
  return domain[0] * (1.0 - part) + domain[1] * part;
}

/** Gathers markers that share a frame, and numbers them. The first one takes away what was shown before. */
class Canvas {
 public:
  explicit Canvas(std::string frame);

  visualization_msgs::Marker &add(const std::string &space, int type, const Eigen::Vector3d &scale,
                                  const std_msgs::ColorRGBA &tint,
                                  const Eigen::Isometry3d &pose = Eigen::Isometry3d::Identity());

  /** A body, from its description where RViz has a type or a mesh file for it, else from its surface. resources: where
   * its mesh file is looked for. */
  void addShape(const std::string &space, const ShapeDescription &shape, const BodyHandle &body,
                const ResourceOptions &resources, const Eigen::Isometry3d &pose, const std_msgs::ColorRGBA &tint);

  /** All markers; those with a coordinate that is not finite are left out, for RViz takes none of them. */
  visualization_msgs::MarkerArray take();

 private:
  void addPoints(const std::string &space, const ShapeDescription &shape, const Eigen::Isometry3d &pose,
                 const std_msgs::ColorRGBA &tint);
  void addOctree(const std::string &space, const ShapeDescription &shape, const ResourceOptions &resources,
                 const Eigen::Isometry3d &pose, const std_msgs::ColorRGBA &tint);
  bool addFile(const std::string &space, const ShapeDescription &shape, const ResourceOptions &resources,
               const Eigen::Isometry3d &pose, const std_msgs::ColorRGBA &tint);
  void addSurface(const std::string &space, const ShapeDescription &shape, const BodyHandle &body,
                  const ResourceOptions &resources, const Eigen::Isometry3d &pose, const std_msgs::ColorRGBA &tint);

  const std::string frame_;
  visualization_msgs::MarkerArray array_;
};

} // namespace curve_proximity
#endif
