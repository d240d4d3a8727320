/* SPDX-License-Identifier: BSD-3-Clause */
/** Messages of moveit_msgs 0.11 (Noetic), and what they hold of octomap_msgs and object_recognition_msgs, by their
 *  published definitions: none of these packages need be installed.
 *
 *  One mechanism: structs of ours, which roscpp writes and reads field by field in the order of the definition. Their
 *  bytes and md5 sums are those of the published messages, so a node that has moveit_msgs cannot tell the difference,
 *  and nothing is generated where moveit_msgs is found. Only that part of moveit_msgs is here that the server speaks.
 *  Constants are those of the definitions. */
#ifndef CURVE_PROXIMITY_ROS_MOVEIT_MESSAGES_H
#define CURVE_PROXIMITY_ROS_MOVEIT_MESSAGES_H

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/Vector3.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/MultiDOFJointState.h>
#include <shape_msgs/Mesh.h>
#include <shape_msgs/Plane.h>
#include <shape_msgs/SolidPrimitive.h>
#include <std_msgs/ColorRGBA.h>
#include <std_msgs/Header.h>
#include <trajectory_msgs/JointTrajectory.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "messages/foreign_message.h"
#include "messages/octomap_message.h"

namespace curve_proximity::moveit {

struct ObjectType {
  std::string key, db;
};

struct CollisionObject {
  static constexpr std::int8_t ADD = 0, REMOVE = 1, APPEND = 2, MOVE = 3;
  std_msgs::Header header;
  geometry_msgs::Pose pose;
  std::string id;
  ObjectType type;
  std::vector<shape_msgs::SolidPrimitive> primitives;
  std::vector<geometry_msgs::Pose> primitive_poses;
  std::vector<shape_msgs::Mesh> meshes;
  std::vector<geometry_msgs::Pose> mesh_poses;
  std::vector<shape_msgs::Plane> planes;
  std::vector<geometry_msgs::Pose> plane_poses;
  std::vector<std::string> subframe_names;
  std::vector<geometry_msgs::Pose> subframe_poses;
  std::int8_t operation = ADD;
};

struct AttachedCollisionObject {
  std::string link_name;
  CollisionObject object;
  std::vector<std::string> touch_links;
  trajectory_msgs::JointTrajectory detach_posture;
  double weight = 0.0;
};

struct RobotState {
  sensor_msgs::JointState joint_state;
  sensor_msgs::MultiDOFJointState multi_dof_joint_state;
  std::vector<AttachedCollisionObject> attached_collision_objects;
  std::uint8_t is_diff = 0;
};

struct AllowedCollisionEntry {
  std::vector<std::uint8_t> enabled;
};

struct AllowedCollisionMatrix {
  std::vector<std::string> entry_names;
  std::vector<AllowedCollisionEntry> entry_values;
  std::vector<std::string> default_entry_names;
  std::vector<std::uint8_t> default_entry_values;
};

struct LinkPadding {
  std::string link_name;
  double padding = 0.0;
};

struct LinkScale {
  std::string link_name;
  double scale = 0.0;
};

struct ObjectColor {
  std::string id;
  std_msgs::ColorRGBA color;
};

/** octomap_msgs/OctomapWithPose */
struct OctomapWithPose {
  std_msgs::Header header;
  geometry_msgs::Pose origin;
  OctomapMessage octomap;
};

struct PlanningSceneWorld {
  std::vector<CollisionObject> collision_objects;
  OctomapWithPose octomap;
};

struct PlanningScene {
  std::string name;
  RobotState robot_state;
  std::string robot_model_name;
  std::vector<geometry_msgs::TransformStamped> fixed_frame_transforms;
  AllowedCollisionMatrix allowed_collision_matrix;
  std::vector<LinkPadding> link_padding;
  std::vector<LinkScale> link_scale;
  std::vector<ObjectColor> object_colors;
  PlanningSceneWorld world;
  std::uint8_t is_diff = 0;
};
using PlanningSceneConstPtr = boost::shared_ptr<const PlanningScene>;

struct RobotTrajectory {
  trajectory_msgs::JointTrajectory joint_trajectory;
  trajectory_msgs::MultiDOFJointTrajectory multi_dof_joint_trajectory;
};
using RobotTrajectoryConstPtr = boost::shared_ptr<const RobotTrajectory>;

struct DisplayTrajectory {
  std::string model_id;
  std::vector<RobotTrajectory> trajectory;
  RobotState trajectory_start;
};
using DisplayTrajectoryConstPtr = boost::shared_ptr<const DisplayTrajectory>;

struct ContactInformation {
  static constexpr std::uint32_t ROBOT_LINK = 0, WORLD_OBJECT = 1, ROBOT_ATTACHED = 2;
  std_msgs::Header header;
  geometry_msgs::Point position;
  geometry_msgs::Vector3 normal;
  double depth = 0.0;
  std::string contact_body_1;
  std::uint32_t body_type_1 = ROBOT_LINK;
  std::string contact_body_2;
  std::uint32_t body_type_2 = ROBOT_LINK;
};

/** The request of moveit_msgs/GetPlanningScene: PlanningSceneComponents alone. */
struct GetPlanningSceneRequest {
  static constexpr std::uint32_t ALL = 1023;
  std::uint32_t components = ALL;
};

struct GetPlanningSceneResponse {
  PlanningScene scene;
};

/** The service moveit_msgs/GetPlanningScene. */
constexpr const char *GET_PLANNING_SCENE_MD5 = "65cf69d3e7a0342e16374024d4eeef65";

} // namespace curve_proximity::moveit

CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::moveit::ObjectType, key, db)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::moveit::CollisionObject, header, pose, id, type, primitives,
                                   primitive_poses, meshes, mesh_poses, planes, plane_poses, subframe_names,
                                   subframe_poses, operation)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::moveit::AttachedCollisionObject, link_name, object, touch_links,
                                   detach_posture, weight)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::moveit::RobotState, joint_state, multi_dof_joint_state,
                                   attached_collision_objects, is_diff)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::moveit::AllowedCollisionEntry, enabled)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::moveit::AllowedCollisionMatrix, entry_names, entry_values,
                                   default_entry_names, default_entry_values)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::moveit::LinkPadding, link_name, padding)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::moveit::LinkScale, link_name, scale)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::moveit::ObjectColor, id, color)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::moveit::OctomapWithPose, header, origin, octomap)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::moveit::PlanningSceneWorld, collision_objects, octomap)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::moveit::PlanningScene, name, robot_state, robot_model_name,
                                   fixed_frame_transforms, allowed_collision_matrix, link_padding, link_scale,
                                   object_colors, world, is_diff)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::moveit::RobotTrajectory, joint_trajectory,
                                   multi_dof_joint_trajectory)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::moveit::DisplayTrajectory, model_id, trajectory, trajectory_start)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::moveit::ContactInformation, header, position, normal, depth,
                                   contact_body_1, body_type_1, contact_body_2, body_type_2)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::moveit::GetPlanningSceneRequest, components)
CURVE_PROXIMITY_FOREIGN_SERIALIZER(curve_proximity::moveit::GetPlanningSceneResponse, scene)

/* Definitions of what is only received are left out: tools look them up by name. */
CURVE_PROXIMITY_FOREIGN_TRAITS(curve_proximity::moveit::PlanningScene, "moveit_msgs/PlanningScene",
                               "acfc50bcfd6c7b978066bfa7c786002c", "")
CURVE_PROXIMITY_FOREIGN_TRAITS(curve_proximity::moveit::RobotTrajectory, "moveit_msgs/RobotTrajectory",
                               "dfa9556423d709a3729bcef664bddf67", "")
CURVE_PROXIMITY_FOREIGN_TRAITS(curve_proximity::moveit::DisplayTrajectory, "moveit_msgs/DisplayTrajectory",
                               "41936b74e168ba754279ae683ce3f121", "")
CURVE_PROXIMITY_FOREIGN_TRAITS(curve_proximity::moveit::GetPlanningSceneRequest, "moveit_msgs/GetPlanningSceneRequest",
                               "d81da6c0e5e015646a4efe344f33d7dc", "")
CURVE_PROXIMITY_FOREIGN_TRAITS(curve_proximity::moveit::GetPlanningSceneResponse,
                               "moveit_msgs/GetPlanningSceneResponse", "532b54e7c502b73178625025da63b084", "")
CURVE_PROXIMITY_FOREIGN_TRAITS(curve_proximity::moveit::ContactInformation, "moveit_msgs/ContactInformation",
                               "116228ca08b0c286ec5ca32a50fdc17b",
                               "Header header\ngeometry_msgs/Point position\ngeometry_msgs/Vector3 normal\n"
                               "float64 depth\nstring contact_body_1\nuint32 body_type_1\nstring contact_body_2\n"
                               "uint32 body_type_2\nuint32 ROBOT_LINK=0\nuint32 WORLD_OBJECT=1\n"
                               "uint32 ROBOT_ATTACHED=2\n"
                               "================================================================================\n"
                               "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
                               "================================================================================\n"
                               "MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n"
                               "================================================================================\n"
                               "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n")
namespace ros::message_traits {
template <>
struct HasHeader<curve_proximity::moveit::ContactInformation> : TrueType {};
} // namespace ros::message_traits
#endif
