/* SPDX-License-Identifier: BSD-3-Clause */
#include "constraints.h"

#include <ros/console.h>

#include <chrono>
#include <limits>
#include <utility>

#include "conversions.h"
#include "doubts.h"
#include "name_limits.h"
#include "robot_description.h"
#include "turns.h"

namespace curve_proximity {
namespace {

/** The provider whose values are a field over places, and not a distance. */
constexpr const char *GAP = "curve_proximity/FourierGap";

constexpr double NONE = std::numeric_limits<double>::quiet_NaN();

/* ---- from messages ---- */

bool hasShapes(const CollisionObject &side) {
  return !side.primitives.empty() || !side.meshes.empty() || !side.planes.empty() || !side.bodies.empty();
}

bool hasPose(const CollisionObject &side) {
  const geometry_msgs::Point &p = side.pose.position;
  const geometry_msgs::Quaternion &q = side.pose.orientation;
  return p.x != 0 || p.y != 0 || p.z != 0 || q.x != 0 || q.y != 0 || q.z != 0 || q.w != 0;
}

/** A side as described, or the scene's object of that id; its pose in the fixed frame, unless it rides a curve. */
ObjectDescription toSide(const CollisionObject &message, const Snapshot &snapshot, FrameLookup &lookup, bool rides) {
  ObjectDescription side;
  if (hasShapes(message)) {
    CollisionObject object = message;
    object.operation = CollisionObject::ADD;
    side = toOperation(object).object;
  } else if (!message.id.empty()) {
    const auto found = snapshot.objects().find(message.id);
    if (found == snapshot.objects().end()) throw Error("there is no object '" + message.id + "' in the scene");
    side = found->second->description;
    if (rides) side.pose = Eigen::Isometry3d::Identity();
    if (!hasPose(message)) return side;
    side.pose = toIsometry(message.pose);
  } else if (hasPose(message)) {
    side.pose = toIsometry(message.pose);
  }
  if (!rides) side.pose = lookup.toFixed(message.header.frame_id, message.header.stamp) * side.pose;
  return side;
}

ConstraintCase toCase(const ConstraintQuery &message, const Snapshot &snapshot, FrameLookup &lookup) {
  ConstraintCase out;
  out.id = message.id;
  out.providers = message.providers;
  const bool rides = !message.curve.points.empty();
  out.a = toSide(message.a, snapshot, lookup, rides);
  out.b = toSide(message.b, snapshot, lookup, false);
  if (rides) {
    const std_msgs::Header &header = message.curve.header;
    out.curve = toDescription(message.curve, lookup.toFixed(header.frame_id, header.stamp));
  }
  return out;
}

/* ---- to messages ---- */

geometry_msgs::Vector3 toVectorMessage(const Eigen::Vector3d &v) {
  geometry_msgs::Vector3 message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

geometry_msgs::Twist toTwistMessage(const ConstraintGradient &gradient) {
  geometry_msgs::Twist message;
  message.linear = toVectorMessage(gradient.linear);
  message.angular = toVectorMessage(gradient.angular);
  return message;
}

ConstraintResult toMessage(const ConstraintRow &row) {
  ConstraintResult message;
  message.id = row.id;
  message.provider = row.provider;
  message.status = cprox_status_name(row.status);
  message.message = row.message;

  // What has no value has no numbers.
  const Eigen::Vector3d nothing = Eigen::Vector3d::Constant(NONE);
  const bool answered = row.status >= 0;
  const ConstraintValue &value = row.value;
  const ConstraintGradient none{nothing, nothing};
  message.value = answered ? value.value : NONE;
  message.lower = answered && value.bounded ? value.lower : NONE;
  message.upper = answered && value.bounded ? value.upper : NONE;
  message.valid = answered && value.valid;
  message.gradient_a = toTwistMessage(answered ? value.a : none);
  message.gradient_b = toTwistMessage(answered ? value.b : none);
  for (Eigen::Index i = 0; answered && i < value.points.cols(); ++i)
    message.gradient_points.push_back(toVectorMessage(value.points.col(i)));
  message.gradient_radius = answered ? value.radius : NONE;
  message.t = answered ? value.t : NONE;
  const bool points = answered && value.has_points;
  message.witness_a = toPointMessage(toVec3(points ? value.witness_a : nothing));
  message.witness_b = toPointMessage(toVec3(points ? value.witness_b : nothing));
  message.normal = toVectorMessage(points ? value.normal : nothing);
  message.microseconds = answered ? row.microseconds : NONE;
  return message;
}

void limit(const char *parameter, int most, std::size_t count, const char *what) {
  if (count <= static_cast<std::size_t>(most)) return;
  throw Error(std::to_string(count) + " " + what + " are more than ~" + parameter + " = " + std::to_string(most));
}

} // namespace

Constraints::Constraints(const Parameters &parameters, const LiveScene &live, const Frames &frames,
                         const std::atomic<bool> &stop)
    : parameters_(parameters), live_(live), frames_(frames), stop_(stop) {
  try {
    providers_ = std::make_unique<ProviderSet>(parameters.constraint_providers);
  } catch (const ProviderError &error) {
    throw ParameterError("parameter ~constraint_providers[" + std::to_string(error.place()) + "] ('" +
                         parameters.constraint_providers[error.place()].name + "'): " + error.what());
  }
  for (const std::string &failure : failures()) ROS_ERROR("%s", failure.c_str());
}

std::vector<std::string> Constraints::failures() const {
  std::vector<std::string> sentences;
  for (const LoadedProvider &loaded : providers_->all())
    if (!loaded.provider)
      sentences.push_back("constraint provider '" + loaded.spec.name + "' (" + loaded.spec.type +
                          ") failed to load: " + loaded.failure);
  return sentences;
}

void Constraints::checkLimits(const EvaluateConstraints::Request &request) const {
  limit("max_curves", parameters_.max_curves, request.cases.size(), "cases");
  NameLimits(parameters_.max_name_length).check(request);
  std::size_t points = 0, results = 0;
  for (const ConstraintQuery &asked : request.cases) {
    points += asked.curve.points.size();
    results += asked.providers.empty() ? providers_->all().size() : asked.providers.size();
  }
  limit("max_control_points", parameters_.max_control_points, points, "control points");
  limit("max_results", parameters_.max_results, results, "results");
}

void Constraints::answer(const EvaluateConstraints::Request &request, EvaluateConstraints::Response &response,
                         std::shared_ptr<const LevelDrawing> &drawing, Turn *turn) {
  if (providers_->all().empty()) throw Error("~constraint_providers names none");
  checkLimits(request);
  const auto deadline =
      std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                             std::chrono::duration<double, std::milli>(parameters_.budget_ms));
  const SnapshotPtr snapshot = live_.scene.snapshot();
  response.scene = live_.state(*snapshot);
  live_.demand(*snapshot, request.scene_epoch, request.scene_version);
  const ResourceOptions resources = resourceOptions("", parameters_.max_shape_mb);
  const WorkspacePool::Lease workspace(workspaces_);
  FrameLookup lookup(frames_, turn);
  Doubts doubts(parameters_.max_age, response.scene.sensors);
  std::size_t failed = 0;
  for (std::size_t i = 0; i < request.cases.size(); ++i) {
    const ConstraintQuery &asked = request.cases[i];
    if (turn) turn->yield();
    lookup.begin();
    std::vector<ConstraintRow> rows;
    ConstraintCase described;
    cprox_status fault = CPROX_OK;
    const std::string why = sentenceOf(
        [&] {
          if (stop_) throw Error("the server is shutting down");
          if (std::chrono::steady_clock::now() >= deadline) throw Error("~budget_ms are over");
          described = toCase(asked, *snapshot, lookup);
          rows = answerCase(*providers_, described, resources, *workspace);
        },
        &fault);
    if (fault < 0) rows = {failedRow(asked.id, why, fault)};

    doubts.ages(lookup.age(), NONE);

    // The first row that failed is told.
    std::shared_ptr<const Constraint> gap;
    for (const ConstraintRow &row : rows) {
      if (row.status < 0 && failed++ == 0)
        response.message = "case " + std::to_string(i) + " ('" + row.id + "')" +
                           (row.provider.empty() ? "" : ", provider '" + row.provider + "'") + ": " + row.message;
      response.results.push_back(toMessage(row));
      doubts.apply(response.results.back());
      if (row.status >= 0 && providers_->find(row.provider)->spec.type == GAP) gap = row.constraint;
    }
    if (gap) drawing = std::make_shared<const LevelDrawing>(LevelDrawing{std::move(gap), std::move(described)});
  }
  response.scene.transform_age = lookup.oldest();
  doubts.tell(response.warnings);
  if (live_.lost) response.warnings.push_back(SCENE_LOST);
  response.success = failed == 0;
  if (failed)
    response.message =
        std::to_string(failed) + " of " + std::to_string(response.results.size()) + " rows failed; " + response.message;
}

} // namespace curve_proximity
