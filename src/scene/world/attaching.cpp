/* SPDX-License-Identifier: BSD-3-Clause */
#include "attaching.h"

#include <cmath>
#include <utility>

#include <curve_proximity/nearest_name.hpp>

#include "geometry/placing.h"
#include "geometry/scaling.h"

namespace curve_proximity {
namespace {

/* One shape in the link's frame; the rounding of the two poses becomes the geometry's excess. */
LinkGeometry shapeOnLink(const ShapeDescription &shape, const Eigen::Isometry3d &object, double scale,
                         const ResourceOptions &resources) {
  if (shape.type == ShapeType::HALFSPACE || shape.type == ShapeType::CURVE)
    throw Error(std::string("a link cannot carry a ") + shapeTypeName(shape.type));
  checkPose(shape.pose, "its pose");
  LinkGeometry out;
  out.description = scale == 1.0 ? shape : scaledShape(shape, scale, resources);
  out.geometry = makeGeometry(out.description, resources);
  if (!out.geometry.body) return out; // an empty octree
  const PlacedShape placed = place(out.geometry, object, out.description.pose, 0.0);
  out.geometry.excess = placed.rounding;
  out.pose = object * out.description.pose;
  out.description.pose = out.pose;
  return out;
}

void makeShapes(AttachedObject &object, double scale, const ResourceOptions &resources) {
  const std::vector<ShapeDescription> &shapes = object.description.shapes;
  object.shapes.clear();
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    try {
      LinkGeometry shape = shapeOnLink(shapes[i], object.description.pose, scale, resources);
      if (shape.geometry.body) object.shapes.push_back(std::move(shape));
    } catch (const Error &error) {
      const std::string which = shapes.size() > 1 ? "shape " + std::to_string(i + 1) + ": " : "";
      throw Error(which + error.what(), error.status());
    }
  }
}

} // namespace

void checkLink(const std::string &link, const Robot *robot, const char *what) {
  if (robot && robot->links().count(link) > 0) return;
  throw Error(what + (robot ? "robot '" + robot->name() + "' has no link '" + link + "'" +
                                  didYouMean(link, namesOf(robot->links()))
                            : "link '" + link + "' is unknown: the scene has no robot"));
}

void checkLinkScales(const std::map<std::string, double> &scales, const Robot *robot) {
  for (const auto &[link, scale] : scales) {
    if (!std::isfinite(scale) || !(scale > 0.0)) {
      throw Error("link scale: that of link '" + link + "' is " + std::to_string(scale) +
                  ": it must be finite and above 0");
    }
    checkLink(link, robot, "link scale: ");
  }
}

const Eigen::Isometry3d &poseOfLink(const Attachment &given, const std::string &link) {
  const auto it = given.link_poses.find(link);
  if (it == given.link_poses.end()) throw Error("where link '" + link + "' is now is not known");
  checkPose(it->second, "the pose of link '" + link + "'");
  return it->second;
}

std::shared_ptr<const AttachedObject> carried(const Attachment &given, double link_scale,
                                              const ResourceOptions &resources) {
  if (given.object.shapes.empty()) throw Error("it has no shapes");
  const auto out = std::make_shared<AttachedObject>();
  out->link = given.link;
  out->touch_links = given.touch_links;
  out->description = given.object;
  out->description.frame = given.link;
  makeShapes(*out, link_scale, resources);
  return out;
}

std::shared_ptr<const AttachedObject> attachedObject(const Attachment &given, double link_scale,
                                                     const ResourceOptions &resources) {
  try {
    if (given.object.id.empty()) throw Error("it has no id");
    checkPose(given.object.pose, "its pose");
    checkPadding(given.object.padding);
    return carried(given, link_scale, resources);
  } catch (const Error &error) {
    throw Error("object '" + given.object.id + "': " + error.what(), error.status());
  }
}

std::shared_ptr<const AttachedObject> rescaled(const AttachedObject &object, double link_scale,
                                               const ResourceOptions &resources) {
  const auto out = std::make_shared<AttachedObject>(object);
  makeShapes(*out, link_scale, resources);
  return out;
}

std::shared_ptr<const std::vector<LinkGeometry>> scaledLink(const Robot &robot, const std::string &link, double scale) {
  const auto out = std::make_shared<std::vector<LinkGeometry>>();
  for (const LinkGeometry &element : robot.links().at(link)) {
    LinkGeometry larger;
    try {
      larger.description = scaledShape(element.description, scale, robot.resources());
      larger.geometry = makeGeometry(larger.description, robot.resources());
    } catch (const Error &error) {
      throw Error("link '" + link + "' at scale " + std::to_string(scale) + ": " + error.what(), error.status());
    }
    larger.pose = larger.description.pose;
    out->push_back(std::move(larger));
  }
  return out;
}

} // namespace curve_proximity
