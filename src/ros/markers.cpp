/* SPDX-License-Identifier: BSD-3-Clause */
#include "markers.h"

#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "conversions.h"
#include "guard.h"

namespace curve_proximity {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double PERIOD = 0.1;            /* [s] between two publications at least */
constexpr std::size_t MAX_SAMPLES = 2000; /* of all curves of a drawing together */
constexpr std::size_t MAX_CURVE_SAMPLES = 100;
constexpr double RED_CLEARANCE = 0.0;   /* [m] a curve is red here … */
constexpr double GREEN_CLEARANCE = 0.3; /* [m] … and green from here on */
constexpr double LINE_WIDTH = 0.006;    /* [m] */
constexpr double HALFSPACE_SIZE = 4.0;  /* [m] of the slab that stands for a halfspace */

std_msgs::ColorRGBA colour(double r, double g, double b, double a) {
  std_msgs::ColorRGBA out;
  out.r = static_cast<float>(r);
  out.g = static_cast<float>(g);
  out.b = static_cast<float>(b);
  out.a = static_cast<float>(a);
  return out;
}

/** Red at a touch, yellow between, green with room to spare. */
std_msgs::ColorRGBA clearanceColour(double clearance) {
  const double s = std::clamp((clearance - RED_CLEARANCE) / (GREEN_CLEARANCE - RED_CLEARANCE), 0.0, 1.0);
  return colour(std::min(1.0, 2.0 - 2.0 * s), std::min(1.0, 2.0 * s), 0.1, 1.0);
}

/** Gathers markers that share frame and stamp, and numbers them. */
class Canvas {
 public:
  explicit Canvas(std::string frame) : frame_(std::move(frame)) {
    Marker all;
    all.header.frame_id = frame_;
    all.action = Marker::DELETEALL;
    all.pose.orientation.w = 1.0;
    array_.markers.push_back(all);
  }

  Marker &add(const std::string &space, int type, const Eigen::Isometry3d &pose = Eigen::Isometry3d::Identity()) {
    Marker marker;
    marker.header.frame_id = frame_;
    marker.ns = space;
    marker.id = static_cast<int>(array_.markers.size());
    marker.type = type;
    marker.action = Marker::ADD;
    marker.pose = toMessage(pose);
    array_.markers.push_back(marker);
    return array_.markers.back();
  }

  MarkerArray take() {
    return std::move(array_);
  }

 private:
  const std::string frame_;
  MarkerArray array_;
};

void setScale(Marker &marker, double x, double y, double z) {
  marker.scale.x = x;
  marker.scale.y = y;
  marker.scale.z = z;
}

/* ---- bodies ------------------------------------------------------------------------------------------------------- */

/** The surface of a solid of revolution about z, as triangles: `profile` is a list of (radius, z) from bottom to top. */
void addLathe(Marker &marker, const std::vector<std::pair<double, double>> &profile) {
  constexpr int SIDES = 24;
  const auto at = [](const std::pair<double, double> &p, int k) {
    const double angle = 2.0 * M_PI * k / SIDES;
    return toPointMessage(cprox_vec3{p.first * std::cos(angle), p.first * std::sin(angle), p.second});
  };
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    for (int k = 0; k < SIDES; ++k) {
      const geometry_msgs::Point corners[4] = {at(profile[i], k), at(profile[i], k + 1), at(profile[i + 1], k + 1),
                                               at(profile[i + 1], k)};
      for (const int c : {0, 1, 2, 0, 2, 3}) marker.points.push_back(corners[c]);
    }
  }
}

/** The outline of a capsule: two half circles. */
std::vector<std::pair<double, double>> capsuleProfile(double height, double radius) {
  constexpr int STEPS = 8;
  std::vector<std::pair<double, double>> profile;
  for (const double side : {-1.0, 1.0}) {
    for (int k = 0; k <= STEPS; ++k) {
      const double angle = 0.5 * M_PI * (side < 0 ? k - STEPS : k) / STEPS;
      profile.emplace_back(radius * std::cos(angle), side * height / 2 + radius * std::sin(angle));
    }
  }
  return profile;
}

/** A convex body drawn by its support function, for those that have neither a marker type nor triangles of their own:
 *  the support points of a grid of directions are corners of the hull. */
void addSupportSurface(Marker &marker, const cprox_body *body) {
  constexpr int RINGS = 16, SIDES = 32;
  const auto at = [body](int ring, int side) {
    const double latitude = M_PI * (static_cast<double>(ring) / RINGS - 0.5), longitude = 2.0 * M_PI * side / SIDES;
    cprox_vec3 point;
    cprox_body_support(
        body, {std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude), std::sin(latitude)},
        &point);
    return toPointMessage(point);
  };
  for (int ring = 0; ring < RINGS; ++ring) {
    for (int side = 0; side < SIDES; ++side) {
      const geometry_msgs::Point corners[4] = {at(ring, side), at(ring, side + 1), at(ring + 1, side + 1),
                                               at(ring + 1, side)};
      for (const int c : {0, 1, 2, 0, 2, 3}) marker.points.push_back(corners[c]);
    }
  }
}

/** A slab whose upper face is the halfspace's boundary near the origin of its frame. */
void addHalfspace(Canvas &canvas, const std::string &space, const ShapeDescription &shape,
                  const Eigen::Isometry3d &pose, const std_msgs::ColorRGBA &tint) {
  const Eigen::Vector3d normal(shape.dimensions[0], shape.dimensions[1], shape.dimensions[2]);
  constexpr double THICKNESS = 0.02;
  Eigen::Isometry3d local = Eigen::Isometry3d::Identity();
  local.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal).toRotationMatrix();
  local.translation() = -normal * (shape.dimensions[3] / normal.squaredNorm()) - normal.normalized() * (THICKNESS / 2);
  Marker &marker = canvas.add(space, Marker::CUBE, pose * local);
  setScale(marker, HALFSPACE_SIZE, HALFSPACE_SIZE, THICKNESS);
  marker.color = tint;
}

void addShape(Canvas &canvas, const std::string &space, const ShapeDescription &shape, const BodyHandle &body,
              const Eigen::Isometry3d &pose, const std_msgs::ColorRGBA &tint) {
  const std::vector<double> &d = shape.dimensions;
  if (shape.type == ShapeType::HALFSPACE) return addHalfspace(canvas, space, shape, pose, tint);

  // RViz has some of the kinds itself; the others are drawn as triangles.
  const bool own = shape.type == ShapeType::BOX || shape.type == ShapeType::SPHERE ||
                   shape.type == ShapeType::ELLIPSOID || shape.type == ShapeType::CYLINDER;
  Marker &marker = canvas.add(space, own ? int(Marker::CUBE) : int(Marker::TRIANGLE_LIST), pose);
  marker.color = tint;
  setScale(marker, 1.0, 1.0, 1.0);
  switch (shape.type) {
    case ShapeType::BOX: setScale(marker, d[0], d[1], d[2]); break;
    case ShapeType::SPHERE:
      marker.type = Marker::SPHERE;
      setScale(marker, 2 * d[0], 2 * d[0], 2 * d[0]);
      break;
    case ShapeType::ELLIPSOID:
      marker.type = Marker::SPHERE;
      setScale(marker, 2 * d[0], 2 * d[1], 2 * d[2]);
      break;
    case ShapeType::CYLINDER:
      marker.type = Marker::CYLINDER;
      setScale(marker, 2 * d[1], 2 * d[1], d[0]);
      break;
    case ShapeType::CONE: addLathe(marker, {{0.0, -d[0] / 2}, {d[1], -d[0] / 2}, {0.0, d[0] / 2}}); break;
    case ShapeType::CAPSULE: addLathe(marker, capsuleProfile(d[0], d[1])); break;
    default: addSupportSurface(marker, body.get()); break;
  }
}

/* ---- the scene and the robot --------------------------------------------------------------------------------------- */

/** A placed body, for the colours of the curves. */
struct Placed {
  const cprox_body *body;
  Eigen::Isometry3d to_body; /**< from the fixed frame to the body's */
  double padding;
};

void addScene(Canvas &canvas, const Snapshot &scene, std::vector<Placed> &placed) {
  for (const auto &entry : scene.objects()) {
    const SceneObject &object = *entry.second;
    for (std::size_t i = 0; i < object.shapes.size(); ++i) {
      const Eigen::Isometry3d pose = object.description.pose * object.description.shapes[i].pose;
      addShape(canvas, "scene", object.description.shapes[i], object.shapes[i].geometry.body, pose,
               colour(0.55, 0.6, 0.68, 0.55));
      placed.push_back({object.shapes[i].geometry.body.get(), pose.inverse(), object.description.padding});
    }
  }
}

/** The links as the query saw them: hulls of their meshes. */
void addRobot(Canvas &canvas, const Snapshot &scene, const LinkPoses &links, std::vector<Placed> &placed) {
  for (const auto &link : links) {
    const auto found = scene.robot()->links().find(link.first);
    if (found == scene.robot()->links().end()) continue;
    for (const LinkGeometry &element : scene.linkGeometry(link.first)) {
      const Eigen::Isometry3d pose = link.second * element.pose;
      addShape(canvas, "robot", element.description, element.geometry.body, pose, colour(0.9, 0.85, 0.7, 0.5));
      placed.push_back({element.geometry.body.get(), pose.inverse(), scene.linkPadding(link.first)});
    }
  }
  for (const auto &entry : scene.attached()) {
    const AttachedObject &object = *entry.second;
    const auto link = links.find(object.link);
    if (link == links.end()) continue;
    for (const LinkGeometry &shape : object.shapes) {
      const Eigen::Isometry3d pose = link->second * shape.pose;
      addShape(canvas, "robot", shape.description, shape.geometry.body, pose, colour(0.75, 0.6, 0.75, 0.6));
      placed.push_back({shape.geometry.body.get(), pose.inverse(), scene.attachedPadding(object)});
    }
  }
}

/* ---- curves and pairs ---------------------------------------------------------------------------------------------- */

double clearance(const cprox_vec3 &point, double radius, const std::vector<Placed> &placed) {
  double least = std::numeric_limits<double>::infinity();
  for (const Placed &p : placed) {
    const double d = cprox_body_nearest(p.body, toVec3(p.to_body * toEigen(point)), nullptr);
    least = std::min(least, d - radius - p.padding);
  }
  return least;
}

void addCurve(Canvas &canvas, const CompiledCurve &curve, const std::vector<Placed> &placed, std::size_t samples) {
  double t0 = 0.0, t1 = 0.0;
  cprox_curve_domain(curve.curve.get(), &t0, &t1);
  Marker &line = canvas.add("curves", Marker::LINE_STRIP);
  setScale(line, std::max(LINE_WIDTH, 2 * curve.radius), 0.0, 0.0);
  for (std::size_t i = 0; i < samples; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(samples - 1);
    cprox_vec3 point;
    if (cprox_curve_evaluate(curve.curve.get(), i + 1 == samples ? t1 : t0 + s * (t1 - t0), nullptr, &point, nullptr,
                             nullptr) != CPROX_OK)
      continue;
    line.points.push_back(toPointMessage(point));
    line.colors.push_back(clearanceColour(clearance(point, curve.radius, placed)));
  }
}

/** A line between the two points, a ball at each, and the distance in words. */
void addPair(Canvas &canvas, const Answer &answer) {
  const cprox_result &result = answer.result;
  if (result.status < 0 || answer.b.empty()) return;
  const std_msgs::ColorRGBA tint = clearanceColour(result.lower);
  Marker &line = canvas.add("pairs", Marker::LINE_LIST);
  setScale(line, LINE_WIDTH, 0.0, 0.0);
  line.color = tint;
  line.points = {toPointMessage(result.on_mover), toPointMessage(result.on_target)};
  for (const cprox_vec3 &end : {result.on_mover, result.on_target}) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = toEigen(end);
    Marker &ball = canvas.add("pairs", Marker::SPHERE, pose);
    setScale(ball, 3 * LINE_WIDTH, 3 * LINE_WIDTH, 3 * LINE_WIDTH);
    ball.color = tint;
  }

  char text[64];
  std::snprintf(text, sizeof text, "%.1f mm", 1e3 * result.upper);
  Eigen::Isometry3d middle = Eigen::Isometry3d::Identity();
  middle.translation() = 0.5 * (toEigen(result.on_mover) + toEigen(result.on_target)) + 0.04 * Eigen::Vector3d::UnitZ();
  Marker &label = canvas.add("labels", Marker::TEXT_VIEW_FACING, middle);
  setScale(label, 0.0, 0.0, 0.04);
  label.color = colour(0.1, 0.1, 0.1, 1.0);
  label.text = text;
}

/** A finite point in every coordinate, as RViz insists on. */
bool isFinite(const Marker &marker) {
  const auto finite = [](const geometry_msgs::Point &p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  return finite(marker.pose.position) && std::all_of(marker.points.begin(), marker.points.end(), finite);
}

} // namespace

MarkerArray toMarkers(const Snapshot &scene, const Drawing *drawing, const std::string &frame) {
  Canvas canvas(frame);
  std::vector<Placed> placed;
  addScene(canvas, scene, placed);
  if (drawing && drawing->snapshot->robot()) addRobot(canvas, *drawing->snapshot, drawing->links, placed);
  if (drawing && !drawing->lines.empty()) {
    const std::size_t samples = std::clamp<std::size_t>(MAX_SAMPLES / drawing->lines.size(), 2, MAX_CURVE_SAMPLES);
    for (const Drawing::Line &line : drawing->lines) {
      addCurve(canvas, line.curve, placed, samples);
      const auto nearest =
          std::min_element(line.answers.begin(), line.answers.end(),
                           [](const Answer &a, const Answer &b) { return a.result.upper < b.result.upper; });
      const bool still_true = drawing->snapshot->version() == scene.version();
      if (still_true && nearest != line.answers.end()) addPair(canvas, *nearest);
    }
  }
  MarkerArray array = canvas.take();
  array.markers.erase(
      std::remove_if(array.markers.begin(), array.markers.end(), [](const Marker &m) { return !isFinite(m); }),
      array.markers.end());
  return array;
}

MarkerPublisher::MarkerPublisher(ros::NodeHandle &handle, const Scene &scene, const std::string &frame)
    : scene_(scene), frame_(frame) {
  publisher_ = handle.advertise<MarkerArray>("markers", 1, true);
  timer_ = handle.createWallTimer(ros::WallDuration(PERIOD), [this](const ros::WallTimerEvent &) {
    guarded([this] { publishIfNew(); }, [](const std::string &why) { ROS_ERROR("markers: %s", why.c_str()); });
  });
}

void MarkerPublisher::show(std::shared_ptr<const Drawing> drawing) {
  const std::lock_guard<std::mutex> lock(mutex_);
  drawing_ = std::move(drawing);
  changed_ = true;
}

void MarkerPublisher::publishIfNew() {
  if (publisher_.getNumSubscribers() == 0) return;
  const SnapshotPtr scene = scene_.snapshot();
  std::shared_ptr<const Drawing> drawing;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!changed_ && shown_scene_ == scene->version()) return;
    changed_ = false;
    shown_scene_ = scene->version();
    drawing = drawing_;
  }
  publisher_.publish(toMarkers(*scene, drawing.get(), frame_));
}

} // namespace curve_proximity
