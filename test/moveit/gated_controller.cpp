/* SPDX-License-Identifier: BSD-3-Clause */
/* A controller for tests that stands behind the gate: what passes the gate counts as executed, what it refuses as aborted. */
#include <curve_proximity/Refusal.h>
#include <moveit/controller_manager/controller_manager.h>
#include <ros/ros.h>
#include <pluginlib/class_list_macros.hpp>

#include <condition_variable>
#include <mutex>

using moveit_controller_manager::ExecutionStatus;
using moveit_controller_manager::MoveItControllerHandle;

class GatedController : public MoveItControllerHandle {
 public:
  explicit GatedController(const std::string &name)
      : MoveItControllerHandle(name),
        to_gate_(node_.advertise<trajectory_msgs::JointTrajectory>("/gate/trajectory", 1)),
        passed_(node_.subscribe<trajectory_msgs::JointTrajectory>(
            "/gate/clear_trajectory", 1,
            [this](const trajectory_msgs::JointTrajectory::ConstPtr &) { end(ExecutionStatus::SUCCEEDED); })),
        refused_(node_.subscribe<curve_proximity::Refusal>(
            "/gate/refused", 1,
            [this](const curve_proximity::Refusal::ConstPtr &) { end(ExecutionStatus::ABORTED); })) {}

  bool sendTrajectory(const moveit_msgs::RobotTrajectory &trajectory) override {
    while (ros::ok() &&
           (to_gate_.getNumSubscribers() == 0 || passed_.getNumPublishers() == 0 || refused_.getNumPublishers() == 0))
      ros::WallDuration(0.05).sleep();
    end(ExecutionStatus::RUNNING);
    to_gate_.publish(trajectory.joint_trajectory);
    return true;
  }

  bool cancelExecution() override {
    end(ExecutionStatus::PREEMPTED);
    return true;
  }

  bool waitForExecution(const ros::Duration &) override {
    std::unique_lock<std::mutex> lock(mutex_);
    return ended_.wait_for(lock, std::chrono::seconds(20), [this] { return status_ != ExecutionStatus::RUNNING; });
  }

  ExecutionStatus getLastExecutionStatus() override {
    const std::lock_guard<std::mutex> lock(mutex_);
    return status_;
  }

 private:
  void end(const ExecutionStatus &status) {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_ = status;
    ended_.notify_all();
  }

  ros::NodeHandle node_;
  ros::Publisher to_gate_;
  ros::Subscriber passed_, refused_;
  std::mutex mutex_; /* of what follows */
  ExecutionStatus status_ = ExecutionStatus::SUCCEEDED;
  std::condition_variable ended_;
};

class GatedControllers : public moveit_controller_manager::MoveItControllerManager {
 public:
  moveit_controller_manager::MoveItControllerHandlePtr getControllerHandle(const std::string &name) override {
    if (!handle_) handle_ = std::make_shared<GatedController>(name);
    return handle_;
  }
  void getControllersList(std::vector<std::string> &names) override {
    names = {"arm"};
  }
  void getActiveControllers(std::vector<std::string> &names) override {
    names = {"arm"};
  }
  void getControllerJoints(const std::string &, std::vector<std::string> &joints) override {
    joints.clear();
    for (int i = 1; i <= 7; ++i) joints.push_back("panda_joint" + std::to_string(i));
  }
  ControllerState getControllerState(const std::string &) override {
    ControllerState state;
    state.active_ = state.default_ = true;
    return state;
  }
  bool switchControllers(const std::vector<std::string> &, const std::vector<std::string> &) override {
    return true;
  }

 private:
  moveit_controller_manager::MoveItControllerHandlePtr handle_;
};

PLUGINLIB_EXPORT_CLASS(GatedControllers, moveit_controller_manager::MoveItControllerManager)
