/* SPDX-License-Identifier: BSD-3-Clause */
/* Is a timed trajectory proven in one of MoveIt's planning scenes? */
#ifndef CURVE_PROXIMITY_MOVEIT_CERTIFIER_H
#define CURVE_PROXIMITY_MOVEIT_CERTIFIER_H

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <moveit/planning_scene/planning_scene.h>
#include <moveit/robot_trajectory/robot_trajectory.h>

#include "collision_env.h"
#include "detour.h"

namespace curve_proximity {

struct CertifySettings {
  double clearance = 0.0;    /* [m] to prove; 0: no contact */
  double epsilon = 1e-6;     /* [m] how close an interval must come to decide */
  double budget_ms = 1000.0; /* of each query; what is open then is not proven */
};

/* A query that is not proven: against the objects or of the robot against itself. */
struct Doubt {
  Answer answer;    /* the distance where that could be measured */
  Violations where; /* [s] the intervals that are not proven; none: all of the trajectory */
};

struct Finding {
  std::string why;                   /* why the trajectory is not proven, in one line; "": it is */
  bool of_self = false;              /* that is so, at the last, against the robot itself */
  double clear_until = 0.0;          /* [s] proven up to here */
  std::vector<Doubt> doubts;         /* none although `why` is not "": the trajectory cannot be certified */
  std::vector<std::string> warnings; /* joints beyond their limits */
};

/* Any number of threads. What it has taken over of a scene it keeps for the next one. */
class Certifier {
 public:
  Finding certify(const planning_scene::PlanningScene &scene, const robot_trajectory::RobotTrajectory &trajectory,
                  const CertifySettings &settings) const;

  /* The same without measuring where a trajectory is not proven and by how much, which takes many times as long: `why`
   * and `warnings` alone. */
  Finding judge(const planning_scene::PlanningScene &scene, const robot_trajectory::RobotTrajectory &trajectory,
                const CertifySettings &settings) const;

  /* Are straight motions of these joints, all others at `at`, proven? Against the objects, or the robot itself: that
   * takes long where two of its meshes are always close. No budget; not for several threads. Throws Error. */
  EdgeTest edges(const planning_scene::PlanningScene &scene, const moveit::core::RobotState &at,
                 const std::vector<std::string> &joints, RobotPairs against, const CertifySettings &settings) const;

 private:
  Finding find(const planning_scene::PlanningScene &scene, const robot_trajectory::RobotTrajectory &trajectory,
               const CertifySettings &settings, bool measures) const;
  std::shared_ptr<const CollisionEnvCurveProximity> envOf(const planning_scene::PlanningScene &scene) const;

  mutable std::mutex mutex_; /* of last_ */
  mutable std::shared_ptr<CollisionEnvCurveProximity> last_;
};

} // namespace curve_proximity
#endif
