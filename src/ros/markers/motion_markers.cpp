/* SPDX-License-Identifier: BSD-3-Clause */
#include "markers/motion_markers.h"

#include <algorithm>
#include <limits>

namespace curve_proximity {
namespace {

constexpr std::size_t ROBOT_GHOSTS = 6;   /* poses of the robot on its way */
constexpr std::size_t SWEEP_SAMPLES = 60; /* of the way of its closest point */
constexpr double SWEEP_RADIUS = 0.008;    /* [m] as it is drawn */

/** A collision element of a link, or of what it carries. */
struct ShownPart {
  const LinkGeometry *element;
  double padding; /**< [m] */
};
using Parts = std::vector<ShownPart>;

Parts partsOf(const Snapshot &scene, const std::string &link) {
  Parts parts;
  if (!scene.robot()->links().count(link)) return parts;
  for (const LinkGeometry &element : scene.linkGeometry(link)) parts.push_back({&element, scene.linkPadding(link)});
  for (const auto &entry : scene.attached()) {
    if (entry.second->link != link) continue;
    for (const LinkGeometry &element : entry.second->shapes)
      parts.push_back({&element, scene.attachedPadding(*entry.second)});
  }
  return parts;
}

/** [m] The least plain distance of the parts of a link to the bodies; where they overlap 0 less the paddings. */
double linkClearance(const Parts &parts, const Eigen::Isometry3d &link, const StandingBodies &objects,
                     Workspace &workspace) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-4;
  double least = std::numeric_limits<double>::infinity();
  for (const ShownPart &part : parts) {
    const cprox_obstacle a = cprox_obstacle_at(part.element->geometry.hull.get(), toPose(link * part.element->pose));
    for (const StandingBody &object : objects) {
      cprox_result result{};
      if (cprox_pair(a, cprox_obstacle_at(object.body, toPose(object.pose)), &options, workspace.get(), &result) < 0)
        continue;
      least = std::min(least, std::max(0.0, result.upper) - part.padding - object.padding);
    }
  }
  return least;
}

void addLink(Canvas &canvas, const std::string &space, const Parts &parts, const Eigen::Isometry3d &link,
             const ResourceOptions &resources, const std_msgs::ColorRGBA &tint) {
  for (const ShownPart &part : parts) {
    const LinkGeometry &element = *part.element;
    canvas.addShape(space, element.description, element.geometry.hull, resources, link * element.pose, tint);
  }
}

/** The way of a point that is fixed to a link, coloured by the link's clearance. */
void addSweep(Canvas &canvas, const Snapshot &scene, const RobotMotion &motion, const std::string &link,
              const Eigen::Vector3d &point, const StandingBodies &objects, Workspace &workspace) {
  const Parts parts = partsOf(scene, link);
  std::vector<Eigen::Vector3d> points;
  std::vector<std_msgs::ColorRGBA> tints;
  for (std::size_t i = 0; i <= SWEEP_SAMPLES; ++i) {
    const Eigen::Isometry3d pose = motion.linkPoses(sampleAt(motion.domain(), i, SWEEP_SAMPLES)).at(link);
    points.push_back(pose * point);
    tints.push_back(clearanceColour(linkClearance(parts, pose, objects, workspace)));
  }
  addTube(canvas, "sweep", points, tints, SWEEP_RADIUS);
}

} // namespace

void addRobot(Canvas &canvas, const Snapshot &scene, const LinkPoses &links, const ResourceOptions &resources,
              StandingBodies &placed) {
  for (const auto &link : links) {
    const Parts parts = partsOf(scene, link.first);
    addLink(canvas, "robot", parts, link.second, resources, colour(0.93, 0.93, 0.91, 1.0));
    for (const ShownPart &part : parts)
      placed.push_back({part.element->geometry.body.get(), link.second * part.element->pose,
                        part.padding + part.element->geometry.margin});
  }
}

void addMotion(Canvas &canvas, const Snapshot &scene, const Drawing &drawing, const ResourceOptions &resources,
               const StandingBodies &objects) {
  const RobotMotion &motion = *drawing.motion.robot;
  const std::array<double, 2> domain = motion.domain();
  const Answer *nearest = nearestOf(drawing.motion.answers);
  const double closest = nearest ? nearest->result.t : domain[0];

  // On its way, faintly.
  std::vector<LinkPoses> ghosts;
  for (std::size_t i = 0; i < ROBOT_GHOSTS; ++i)
    ghosts.push_back(motion.linkPoses(sampleAt(domain, i, ROBOT_GHOSTS - 1)));
  const bool moves = std::any_of(ghosts.begin(), ghosts.end(), [&](const LinkPoses &poses) {
    return std::any_of(poses.begin(), poses.end(),
                       [&](const auto &link) { return !link.second.isApprox(ghosts.front().at(link.first), 0.0); });
  });
  if (!moves) ghosts.clear();
  for (const LinkPoses &ghost : ghosts) {
    for (const auto &link : ghost)
      addLink(canvas, "swept", partsOf(*drawing.snapshot, link.first), link.second, resources,
              colour(0.6, 0.68, 0.78, 0.07));
  }

  // At its closest moment.
  Workspace workspace;
  const LinkPoses poses = motion.linkPoses(closest);
  for (const auto &link : poses) {
    const Parts parts = partsOf(*drawing.snapshot, link.first);
    const double room = linkClearance(parts, link.second, objects, workspace);
    addLink(canvas, "robot", parts, link.second, resources, clearanceColour(room));
  }

  // What comes closest; a scene that has changed makes the pair untrue.
  if (!nearest) return;
  if (drawing.snapshot->version() == scene.version()) addPair(canvas, *nearest);
  const auto link = poses.find(nearest->a);
  if (!moves || link == poses.end()) return; // it stands, or something that is carried comes closest
  const Eigen::Vector3d point = link->second.inverse() * toEigen(nearest->result.witness_mover);
  addSweep(canvas, *drawing.snapshot, motion, link->first, point, objects, workspace);
}

} // namespace curve_proximity
