/* SPDX-License-Identifier: BSD-3-Clause */
/** Queries of curves against a snapshot of the scene, for the node and the command line. */
#ifndef CURVE_PROXIMITY_QUERY_HPP
#define CURVE_PROXIMITY_QUERY_HPP

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <curve_proximity/core.hpp>
#include <curve_proximity/coverage.hpp>
#include <curve_proximity/description.hpp>
#include <curve_proximity/robot.hpp>
#include <curve_proximity/scene.hpp>
#include <curve_proximity/second_opinion.hpp>

namespace curve_proximity {

/** The type of a query. */
enum class QueryType { DISTANCE, TOLERANCE, COLLISION };

/** A query. Members that do not apply are refused, never ignored: delta other than for TOLERANCE, per_object together
 *  with a certificate, and the options that the table at cprox_options excludes. */
struct Query {
  QueryType query_type = QueryType::DISTANCE; /**< what to compute */
  double delta = 0.0;                         /**< [m] >= 0 for TOLERANCE, otherwise 0 */

  /** Epsilon, budget, stop function. `certificate` receives the proof of the result for all obstacles. It stays empty
   *  if there is no proof; Answer::unproven then says why. A certificate does not change the result. */
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  bool per_object = false; /**< one answer per object and per link; otherwise one in all */

  /** The objects to test. If `objects` and `links` are both empty, everything is tested; otherwise only what they
   *  name. An unknown name, or a link without geometry, is an error that names it. */
  std::vector<std::string> objects;
  std::vector<std::string> links; /**< the links to test; of a robot in motion: see motion.hpp */

  /** Of a robot in motion: only what the trajectory moves is measured, against objects links that it moves, of the
   * robot itself pairs that it moves against each other; the message of each answer says so. Of a state nothing is left
   * out. Else every link with geometry counts. Refused for curves. */
  bool moving_only = false;

  /** Nothing to measure is an answer: infinity, and clear. Otherwise it is Gap::EMPTY. */
  bool allow_empty = false;

  /** What the caller knows that is missing or old, beside what scene, robot and motion know themselves. */
  Coverage coverage;

  /** Who measures the pair of each answer again; null: nobody. Profiles and violations name no pair: they have none. */
  std::shared_ptr<const SecondOpinions> second_opinion;
};

/** "sphere", "hull" or "mesh" for options.max_lod; nothing for any other word. */
std::optional<cprox_lod> lodFromName(const std::string &name);

/** The result for one curve, or for one curve and object. */
struct Answer {
  std::string id;             /**< the curve's */
  std::string kind = "curve"; /**< "curve", "environment" or "self" */

  /** As the core gives it; obstacle_index is the number of the shape in object b (or of the collision element in link
   *  b), -1 for none. lower and upper hold for the whole set that was asked about, the rounding of poses and hulls
   *  included (where the bodies as placed touch or overlap, upper is 0). Not answered: status < 0, and the rest
   *  means nothing. Nothing to measure: with Query::allow_empty status CPROX_OK, lower = upper = infinity, verdict
   *  clear for TOLERANCE and COLLISION; otherwise a gap.
   *
   *  With a gap lower is 0 (of a signed distance -infinity), t_contact_lower NaN, and clear is undecided; upper is that
   *  of what was measured. violated stays if geometry can only be missing. */
  cprox_result result{};

  std::optional<Gap> gap; /**< the answer does not cover all that was given; message says what */

  std::string a;          /**< the moving object: the curve's id */
  std::string b;          /**< the nearest object or link; empty where there is none */
  bool b_is_link = false; /**< b names a link of the robot */
  /** The nearest shape is a mesh that was replaced by its convex hull or bounding sphere: because options.max_lod says
   *  so, or because a robot overlaps it and a signed distance was asked for. */
  bool by_hull = false;
  double microseconds = 0; /**< steady clock, around the search of this curve (per object: of this object) */
  std::string status;      /**< gapName(gap) if there is a gap, else cprox_status_name(result.status) */
  /** No pair, but the last row of a list of nearest pairs that was cut by a budget or a stop: what the list does not
   *  name is at least result.lower away, and may be nearer than what it names, or than the limit of the list. */
  bool is_unlisted = false;
  std::string message;  /**< the error message, or a remark; often empty */
  std::string unproven; /**< why a requested certificate is empty; else empty */

  /** What Query::second_opinion says of it; its message is a part of `message`, too. */
  SecondOpinion second_opinion;
};

/** A compiled curve for any number of queries by any number of threads. */
struct CompiledCurve {
  std::string id;           /**< of the description */
  CurveHandle curve;        /**< compiled */
  double radius = 0.0;      /**< [m] of the ball along the curve */
  CurveHandle radius_curve; /**< its x is added to the radius at each parameter; null: the radius does not change */
  double reach = 0.0;       /**< [m] the radius is never larger */

  /** Boxes that together contain the curve (the radius left out), rounding included; or none. */
  std::vector<Eigen::AlignedBox3d> boxes;
};

/** How closely CompiledCurve::boxes follow a curve. The answers are the same. */
enum class CurveBoxes {
  NONE, /**< none: every obstacle is tested exactly */
  MANY  /**< several boxes: find what is near among many obstacles */
};

/** Checks and compiles a curve. Throws Error: a basis that is not available, points that are too few or not finite,
 *  a degree that does not fit, knots that descend or are too few, t0 >= t1, a radius that is negative or not finite.
 *  Where a radius that changes is below 0, queries say so. */
CompiledCurve compile(const CurveDescription &curve, CurveBoxes boxes = CurveBoxes::MANY);

/** The same of a curve that is there already, with a ball of the radius [m]. Throws Error for a radius that is negative
 *  or not finite. */
CompiledCurve compile(const std::string &id, const CurveHandle &curve, double radius,
                      CurveBoxes boxes = CurveBoxes::MANY);

/** What moves along a compiled curve, which must outlive it. */
cprox_mover moverOf(const CompiledCurve &curve);
cprox_mover moverOf(CompiledCurve &&curve) = delete;

/** [m] The radius at t. */
double radiusAt(const CompiledCurve &curve, double t);

/** The same for many curves: `workspace` saves each curve one of its own. */
CompiledCurve compile(const CurveDescription &curve, CurveBoxes boxes, Workspace &workspace);

/** The objects and links of a query, resolved once for all its curves. Immutable; shared by any number of threads. */
class SceneObstacles {
 public:
  /** snapshot  is kept.
   *  links     where the robot's links are in the fixed frame, as given (their own rounding is the caller's). Empty:
   *            the robot is left out. Else every link that has geometry and is asked about needs a pose: a link that is
   *            missing must never read as free.
   *  Throws Error: names that the query should not have, a link without a pose, poses for what is no link of the
   *  robot, poses that are not finite. */
  SceneObstacles(SnapshotPtr snapshot, const LinkPoses &links, const Query &query);
  ~SceneObstacles();
  /** Moves. */
  SceneObstacles(SceneObstacles &&) noexcept;
  /** Moves. */
  SceneObstacles &operator=(SceneObstacles &&) noexcept;

  /** What curves that are tested against these need. */
  CurveBoxes boxes() const;

  struct Data;
  /** Internal. */
  const Data &data() const {
    return *data_;
  }

 private:
  std::unique_ptr<const Data> data_;
};

/** All obstacles of a query in the core's form; valid as long as `obstacles` is. Certificates refer to them: to their
 *  poses in doubles, after the rounding outside the core. */
std::vector<cprox_obstacle> coreObstacles(const SceneObstacles &obstacles);

/** The index of the obstacle that an answer names; -1 for none. */
std::int32_t coreObstacleOf(const SceneObstacles &obstacles, const Answer &answer);

/** The obstacles as text for the program cprox_check (doc/certificates.md): one line per convex part, mesh, cloud or
 *  octree with the name of its owner. Empty if a kind of body has no certificates. */
std::string describeObstacles(const SceneObstacles &obstacles);

/** The query of a curve against these obstacles as that program reads it, with its head; empty where something is of a
 *  kind that has no certificates. */
std::string describeQuery(const SceneObstacles &obstacles, const CurveDescription &curve);

/** The bodies that have no certificates, one message each. If there is one, no result can be proven. */
std::vector<std::string> unprovable(const SceneObstacles &obstacles);

/** Answers a query for one curve. With per_object there is one answer per object and link in the order of their names,
 *  objects first (without any: one answer with b empty); otherwise one answer.
 *
 *  Errors that the core finds (epsilon is NaN, a budget of 0, delta < 0) do not throw: result.status is < 0, and status
 *  and message say why. Any number of threads, each with its own workspace. */
std::vector<Answer> ask(const SceneObstacles &obstacles, const CompiledCurve &curve, const Query &query,
                        Workspace &workspace);

/** The same, appended to `answers`: one list for many curves saves each of them its own. */
void ask(const SceneObstacles &obstacles, const CompiledCurve &curve, const Query &query, Workspace &workspace,
         std::vector<Answer> &answers);

/** Limits of nearestPairs(). */
struct PairLimits {
  std::size_t count = 10;                                  /**< at most so many pairs */
  double within = std::numeric_limits<double>::infinity(); /**< [m] >= 0, only pairs that come this near */
};

/** The shapes of objects and links that come closest to a curve, nearest first. Each answer is that to DISTANCE for its
 *  shape alone. Where a budget or a stop left the list incomplete, its last answer says so: Answer::is_unlisted. With a
 *  gap and no pair there is one answer with b empty. Takes no other query than DISTANCE, no per_object and no
 *  certificate; throws Error for those, and where the core refuses. */
std::vector<Answer> nearestPairs(const SceneObstacles &obstacles, const CompiledCurve &curve, const PairLimits &limits,
                                 const Query &query, Workspace &workspace);

/** The clearance of what moves on one interval of its parameter. */
struct ClearanceInterval {
  double t0 = 0.0;    /**< the start of the interval: parameter of a curve, time of a motion [s] */
  double t1 = 0.0;    /**< its end */
  double lower = 0.0; /**< [m] the least distance is at least this; infinity: nothing to measure */
  double upper = 0.0; /**< [m] and at most this */
  double t = 0.0;     /**< where upper was attained */

  cprox_vec3 witness_a{}; /**< [m] world frame: the point of what moves that attains upper; 0 where upper is infinite */
  cprox_vec3 witness_b{}; /**< the point of what it is near */

  std::string a; /**< the curve's id; of a robot the link or attached object, empty if nothing was measured */
  std::string b; /**< object or link */

  /** CPROX_OK: as narrow as options ask for, or beyond the horizon; else what the core says of the whole profile. */
  cprox_status status = CPROX_OK;

  std::optional<Gap> gap; /**< the profile does not cover all that was given: lower is 0 */

  /** With options.certificate: a certificate that the distance is greater than lower, or where that is 0 that it is at
   *  most upper somewhere; empty: there is none. */
  std::string certificate;
  std::string unproven; /**< why there is none */
};

/** The clearance profile: the least distance on each interval between two breaks, which ascend within the domain of the
 *  curve. Clearance beyond a horizon >= 0 [m] is only bounded: lower > horizon, which is less work. Takes no query but
 *  DISTANCE, no signed_distance and no per_object; throws Error for those, and where the core refuses. */
std::vector<ClearanceInterval> clearanceProfile(const SceneObstacles &obstacles, const CompiledCurve &curve,
                                                const std::vector<double> &breaks, const Query &query,
                                                Workspace &workspace,
                                                double horizon = std::numeric_limits<double>::infinity());

/** The derivatives of a curve's clearance, at its minimiser t. */
struct CurveGradient {
  bool valid = false; /**< the clearance is differentiable here; the numbers are else those of one minimiser, or 0 */
  std::string reason; /**< why valid is false */
  double t = std::numeric_limits<double>::quiet_NaN(); /**< the minimiser; NaN: none was found */

  Eigen::Matrix3Xd points;    /**< by the points of the description [m/m], as gradientByCurve() */
  Eigen::VectorXd parameters; /**< by its parameters, likewise [m/unit of each] */
  double range_start = 0.0;   /**< by the start of the range, the curve itself going on as it is [m/unit of t] */
  double range_end = 0.0;     /**< by its end, likewise; both are 0 where the minimiser is elsewhere */
  double radius = 0.0;        /**< by the radius of the tube: -1 */

  Eigen::Vector3d linear = Eigen::Vector3d::Zero();        /**< by a shift of the whole curve, fixed frame */
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();       /**< [m/rad] by its small turn about the frame's origin */
  Eigen::Vector3d object_linear = Eigen::Vector3d::Zero(); /**< by a shift of the nearest object; 0 for a link */
  Eigen::Vector3d object_angular =
      Eigen::Vector3d::Zero(); /**< [m/rad] by its small turn about its own origin; 0 for a link */
};

/** The derivatives of a value by what defines a curve, n being that by the curve's point at t.
 *
 *  points      by the points of the description, one a column, axes of the fixed frame: control points, coefficients;
 *              of a clothoid, an involute and a Pythagorean hodograph the start; of a Dubins path start and end, whose
 *              height is one number (it stands with the start).
 *  parameters  by the parameters of the description, in their order: headings, curvatures, radii, a preimage, weights.
 *
 *  Both are empty for piecewise curves, and for a Dubins path that has no derivative (cprox_curve_jacobian()). */
void gradientByCurve(const CurveDescription &curve, double t, const Eigen::Vector3d &n, Eigen::Matrix3Xd &points,
                     Eigen::VectorXd &parameters);

/** The clearance of a curve with its gradient. */
struct CurveClearance {
  Answer answer;          /**< as of ask() */
  CurveGradient gradient; /**< at answer.result.t, as far as the search tells it */
};

/** The least distance of a curve and its derivatives (cprox_distance_gradient()). Where the nearest shape has no
 *  gradient (a mesh, a second one that is as near), valid is false and reason says why. The query is DISTANCE without
 *  per_object and without a certificate; throws Error for another, or answers with status "invalid". description: what
 *  the curve was compiled from. Cost: two distances, and with more than one shape the second nearest. */
CurveClearance clearanceGradient(const SceneObstacles &obstacles, const CompiledCurve &curve,
                                 const CurveDescription &description, const Query &query, Workspace &workspace);

/** An interval of the parameter in which what moves is within delta of something (cprox_obstacles_violations()). */
struct Violation {
  double enter_lower = 0.0; /**< farther than delta before, back to leave_upper of the violation before */
  double enter_upper = 0.0; /**< violated: within delta from here */
  double leave_lower = 0.0; /**< to here, everywhere; equal where only one place is proven */
  double leave_upper = 0.0; /**< farther than delta after, up to enter_lower of the next one */
  cprox_verdict verdict = CPROX_VERDICT_UNDECIDED; /**< violated; undecided: it may be none */
  double upper = 0.0;                              /**< [m] the least distance that was measured in it */
  double t = 0.0;                                  /**< there */
  std::string a;                                   /**< the curve's id, or the link or attached object */
  std::string b;                                   /**< object or link */
};

/** All of them, in the order of the parameter. */
struct Violations {
  std::vector<Violation> list;    /**< none: farther than delta everywhere */
  cprox_status status = CPROX_OK; /**< CPROX_BUDGET, CPROX_STOPPED: the last one goes on to the end, all else is true */
  std::string message;            /**< why the status is not CPROX_OK */
  bool measured = true;           /**< false: there was nothing to measure against */
  /** The list does not cover all that was given: each time outside of what is violated is undecided, and message says
   *  why. */
  std::optional<Gap> gap;
  /** With options.certificate, in the order of the parameter: certificates that the distance is above query.delta
   *  between the violations, and that it is not somewhere in each of them. */
  std::vector<std::string> certificates;
  std::string unproven; /**< why one of these is missing; empty: none is */
};

/** All intervals in which the curve is within query.delta of something: where does it enter, where does it leave?
 *  Outside of them it is proven to be farther. Within enter_upper … leave_lower it is proven not to be, but for the
 *  rounding of poses outside the core. resolution > 0, in units of the parameter: as cprox_obstacles_violations() has
 *  it. Takes no other query than TOLERANCE and no per_object; throws Error for those, and where the core refuses. */
Violations violations(const SceneObstacles &obstacles, const CompiledCurve &curve, double resolution,
                      const Query &query, Workspace &workspace);

/** The time of contact: where the curve first touches what it is tested against. The query is COLLISION.
 *  result.t_contact_lower: no contact at any smaller parameter, the rounding outside the core included. Verdict
 *  violated: contact at result.t, within that rounding. clear: no contact at all. undecided: closer than epsilon at
 *  result.t. Refuses per_object and signed_distance as ask() refuses. A certificate is that of
 *  cprox_certify_contact(). */
Answer timeOfContact(const SceneObstacles &obstacles, const CompiledCurve &curve, const Query &query,
                     Workspace &workspace);

/** The same as ask() in one step. An error of compile() or SceneObstacles becomes the only answer, with status
 *  "invalid". */
std::vector<Answer> ask(const SnapshotPtr &snapshot, const LinkPoses &links, const CurveDescription &curve,
                        const Query &query, Workspace &workspace);

} // namespace curve_proximity
#endif
