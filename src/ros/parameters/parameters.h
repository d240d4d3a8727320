/* SPDX-License-Identifier: BSD-3-Clause */
/** The server's parameters: one table of name, default and range, from which they are read and checked. */
#ifndef CURVE_PROXIMITY_ROS_PARAMETERS_H
#define CURVE_PROXIMITY_ROS_PARAMETERS_H

#include <ros/node_handle.h>

#include <cmath>
#include <curve_proximity/description.hpp>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "../../providers/provider_set.h"

namespace curve_proximity {

/** A parameter that is wrong; what() names it and says what is expected. */
class ParameterError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/** Units, meanings and defaults as config/defaults.yaml documents them; a test compares the two. */
struct Parameters {
  std::string robot_description = "robot_description";
  std::string robot_description_semantic = "robot_description_semantic";
  std::map<std::string, std::string> robots; /**< parameters that hold URDFs, by the names of robots */
  std::string urdf_dir;
  bool allow_missing_geometry = false;
  std::string fixed_frame = "world";
  double tf_timeout = 0.5;
  std::string scene_file;
  std::string state_file = "auto";
  bool ask_planning_scene = false;
  double check_planning_scene = 0.0;
  double epsilon = 1e-6;
  int max_nodes = 500000;
  std::string max_lod = "mesh";
  std::string second_opinion;
  double budget_ms = 5000.0;
  double max_wait_ms = 5000.0;
  double scene_budget_ms = 30000.0;
  int threads = 4;
  int max_waiting = 200;
  std::string query_type = "tolerance";
  double delta = 0.0;
  bool self_collision = true;
  double path_radius = 0.0;
  ObjectDescription path_body; /**< without an id: there is none */
  int queue_size = 10;
  double state_rate = 0.0;
  int profile_intervals = 0;
  bool profile_per_link = false;
  int memory_limit_mb = 4096;
  int max_request_mb = 1024;
  int max_name_length = 256;
  int max_curves = 20000;
  int max_control_points = 2000000;
  int max_results = 200000;
  int max_shape_mb = 1024;
  double mesh_tolerance = 0.0;
  std::string cloud_id = "cloud";
  double cloud_radius = 0.01;
  std::string octomap_id = "<octomap>";
  bool unknown_is_occupied = false;
  bool empty_cloud_clears = false;
  double least_valid_share = 0.01;
  std::vector<std::string> expected_sensors, assumed_joints;
  double max_age = 3.0;
  bool allow_empty = false;
  std::vector<ProviderSpec> constraint_providers = {
      {"curve_proximity/CurveDistance", "curve_proximity/CurveDistance", {}},
      {"curve_proximity/SuperquadricDistance", "curve_proximity/SuperquadricDistance", {}},
      {"curve_proximity/FourierGap", "curve_proximity/FourierGap", {}},
      {"curve_proximity/GrowthDistance", "curve_proximity/GrowthDistance", {}},
      {"curve_proximity/RobotDistance", "curve_proximity/RobotDistance", {}}};
};

/** The values a number may take: least < value or least <= value, value <= most. */
struct Range {
  double least = 0.0;
  bool open = false; /**< least itself is not allowed */
  double most = std::numeric_limits<double>::infinity();

  bool holds(double value) const {
    return (open ? value > least : value >= least) && value <= most && std::isfinite(value);
  }
};

/** What a server leaves on the master for the one that comes after it. */
constexpr const char *KEPT_BY_SERVER = "last_scene";

/** The namespace, in that of a gate, of what the gate reads itself. */
constexpr const char *READING_OF_GATE = "reading";

/** Shows every parameter to a visitor: visit(name, value, range) for numbers, visit(name, value) for the others. */
template <class Fields, class Visitor>
void visitParameters(Fields &parameters, Visitor &&visit) {
  constexpr double count = std::numeric_limits<int>::max();
  visit("robot_description", parameters.robot_description);
  visit("robot_description_semantic", parameters.robot_description_semantic);
  visit("robots", parameters.robots);
  visit("urdf_dir", parameters.urdf_dir);
  visit("allow_missing_geometry", parameters.allow_missing_geometry);
  visit("fixed_frame", parameters.fixed_frame);
  visit("tf_timeout", parameters.tf_timeout, Range{0.0, false, 3600.0});
  visit("scene_file", parameters.scene_file);
  visit("state_file", parameters.state_file);
  visit("ask_planning_scene", parameters.ask_planning_scene);
  visit("check_planning_scene", parameters.check_planning_scene, Range{0.0, false, 1e6});
  visit("epsilon", parameters.epsilon, Range{0.0, true});
  visit("max_nodes", parameters.max_nodes, Range{1.0, false, count});
  visit("max_lod", parameters.max_lod);
  visit("second_opinion", parameters.second_opinion);
  visit("budget_ms", parameters.budget_ms, Range{0.0, true, 1e9});
  visit("max_wait_ms", parameters.max_wait_ms, Range{0.0, true, 1e9});
  visit("scene_budget_ms", parameters.scene_budget_ms, Range{0.0, true, 1e9});
  visit("threads", parameters.threads, Range{1.0, false, 256.0});
  visit("max_waiting", parameters.max_waiting, Range{1.0, false, 10000.0});
  visit("query_type", parameters.query_type);
  visit("delta", parameters.delta, Range{0.0});
  visit("self_collision", parameters.self_collision);
  visit("path_radius", parameters.path_radius, Range{0.0});
  visit("path_body", parameters.path_body);
  visit("queue_size", parameters.queue_size, Range{1.0, false, 1e6});
  visit("state_rate", parameters.state_rate, Range{0.0, false, 1000.0});
  visit("profile_intervals", parameters.profile_intervals, Range{0.0, false, 10000.0});
  visit("profile_per_link", parameters.profile_per_link);
  visit("memory_limit_mb", parameters.memory_limit_mb, Range{0.0, false, count});
  visit("max_request_mb", parameters.max_request_mb, Range{1.0, false, count});
  visit("max_name_length", parameters.max_name_length, Range{16.0, false, 65536.0});
  visit("max_curves", parameters.max_curves, Range{1.0, false, count});
  visit("max_control_points", parameters.max_control_points, Range{1.0, false, count});
  visit("max_results", parameters.max_results, Range{1.0, false, count});
  visit("max_shape_mb", parameters.max_shape_mb, Range{1.0, false, count});
  visit("mesh_tolerance", parameters.mesh_tolerance, Range{0.0, false, 1e6});
  visit("cloud_id", parameters.cloud_id);
  visit("cloud_radius", parameters.cloud_radius, Range{0.0, false, 1e6});
  visit("octomap_id", parameters.octomap_id);
  visit("unknown_is_occupied", parameters.unknown_is_occupied);
  visit("empty_cloud_clears", parameters.empty_cloud_clears);
  visit("least_valid_share", parameters.least_valid_share, Range{0.0, false, 1.0});
  visit("expected_sensors", parameters.expected_sensors);
  visit("assumed_joints", parameters.assumed_joints);
  visit("max_age", parameters.max_age, Range{0.0, false, 1e9});
  visit("allow_empty", parameters.allow_empty);
  visit("constraint_providers", parameters.constraint_providers);
}

/** The parameters of curve_proximity/TrajectoryGate. */
struct GateParameters {
  double delta = 0.0; /**< [m] */
  int queue_size = 10;
  std::string server = "/curve_proximity"; /**< the namespace of the server's services */
  std::string controller;                  /**< the action of the controller; empty: there is no action */
  bool self_collision = true;              /**< of trajectories */
  bool watch = false;                      /**< ~clear_trajectory is watched while it runs */
  double path_tolerance = 0.1;             /**< [rad, m] how far each joint may be from the trajectory that runs */
  double feedback_timeout = 0.5;           /**< [s] without a word of the robot; then what runs is stopped */
  double server_timeout = 2.0;             /**< [s] for an answer about what runs; then it is stopped */
  bool verify = false;                     /**< the server's certificates are checked by what the gate reads itself */
};

template <class Fields, class Visitor>
void visitGateParameters(Fields &parameters, Visitor &&visit) {
  visit("delta", parameters.delta, Range{0.0});
  visit("queue_size", parameters.queue_size, Range{1.0, false, 1e6});
  visit("server", parameters.server);
  visit("controller", parameters.controller);
  visit("self_collision", parameters.self_collision);
  visit("watch", parameters.watch);
  visit("path_tolerance", parameters.path_tolerance, Range{0.0, true});
  visit("feedback_timeout", parameters.feedback_timeout, Range{0.0, true});
  visit("server_timeout", parameters.server_timeout, Range{0.0, true});
  visit("verify", parameters.verify);
}

/** Reads the parameters of a private handle; those that are not set keep their defaults.
 *  Throws ParameterError for a wrong type or value. Names that are none of ours are warned of. */
Parameters readParameters(const ros::NodeHandle &handle);
GateParameters readGateParameters(const ros::NodeHandle &handle);

} // namespace curve_proximity
#endif
