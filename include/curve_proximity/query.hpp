/* SPDX-License-Identifier: BSD-3-Clause */
/** Curves against a snapshot of the scene: the code beneath both the node and the command line. */
#ifndef CURVE_PROXIMITY_QUERY_HPP
#define CURVE_PROXIMITY_QUERY_HPP

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <curve_proximity/core.hpp>
#include <curve_proximity/description.hpp>
#include <curve_proximity/robot.hpp>
#include <curve_proximity/scene.hpp>

namespace curve_proximity {

enum class QueryType { DISTANCE, TOLERANCE, COLLISION };

/** What is asked. What does not apply is refused, never ignored: delta but to TOLERANCE; per_object together with a
 *  certificate; and of options what the table at cprox_options says. */
struct Query {
  QueryType query_type = QueryType::DISTANCE;
  double delta = 0.0; /**< [m] >= 0: of TOLERANCE, else 0 */

  /** Epsilon, budget, stop function. `certificate` receives the proof of the answer, about everything that is asked
   *  about, or is left empty: then Answer::unproven says why. It changes nothing in the answer. */
  cprox_options options = cprox_options_default();
  bool per_object = false; /**< one answer for each object and each link (for its nearest shape), else one in all */

  /** What the curve is measured against: everything where both lists are empty, else only what they name (objects
   *  alone: no links). A name that is not in the snapshot, and a link without geometry, is an error that names it. */
  std::vector<std::string> objects, links;
};

/** "sphere", "hull" or "mesh" for options.max_lod; nothing for any other word. */
std::optional<cprox_lod> lodFromName(const std::string &name);

/** One answer: a row of the results. */
struct Answer {
  std::string id;             /**< the curve's */
  std::string kind = "curve"; /**< what was asked about */

  /** As the core gives it; obstacle_index is the number of the shape in object b (or of the collision element in link
   *  b), -1 for none. lower and upper hold for the whole set that was asked about, the rounding of poses and hulls
   *  included (where the bodies as placed touch or overlap, upper is 0). Nothing to measure: status CPROX_OK,
   *  lower = upper = infinity; verdict clear for TOLERANCE and COLLISION. Not answered: status < 0, and the rest
   *  means nothing. */
  cprox_result result{};

  std::string a;          /**< what moved: the curve's id */
  std::string b;          /**< the nearest object or link; empty where there is none */
  bool b_is_link = false; /**< b names a link of the robot */
  /** the nearest shape is a mesh, and its convex hull or bounding ball, which contains it, answered for it: as
   *  options.max_lod asked, or because it is solid and the robot moves */
  bool by_hull = false;
  double microseconds = 0; /**< steady clock, around the search of this curve (per object: of this object) */
  std::string status;      /**< cprox_status_name(result.status) */
  std::string message;     /**< for a person: why there is no answer, or what is special about it; often empty */
  std::string unproven;    /**< for a person: why the certificate that was asked for is empty; else empty */
};

/** A curve made ready for any number of queries, by any number of threads. */
struct CompiledCurve {
  std::string id;
  CurveHandle curve;
  double radius = 0.0; /**< [m] */

  /** Boxes that together contain the curve (the radius left out), rounding included. */
  std::vector<Eigen::AlignedBox3d> boxes;
};

/** Checks and compiles a curve. Throws Error: a basis that is not available, points that are too few or not finite,
 *  a degree that does not fit, knots that descend or are too few, t0 >= t1, a radius that is negative or not finite. */
CompiledCurve compile(const CurveDescription &curve);

/** The objects and links that a query is about, resolved once for all its curves. Immutable; shared by any number of
 *  threads. */
class Targets {
 public:
  /** snapshot  is kept.
   *  links     where the robot's links are in the fixed frame, as given (their own rounding is the caller's). Empty:
   *            the robot is left out. Else every link that has geometry and is asked about needs a pose: a link that is
   *            missing must never read as free.
   *  Throws Error: names that the query should not have, a link without a pose, poses for what is no link of the
   *  robot, poses that are not finite. */
  Targets(SnapshotPtr snapshot, const LinkPoses &links, const Query &query);
  ~Targets();
  Targets(Targets &&) noexcept;
  Targets &operator=(Targets &&) noexcept;

  struct Data;
  const Data &data() const {
    return *data_;
  }

 private:
  std::unique_ptr<const Data> data_;
};

/** Everything that a query is about, as the core takes it; valid as long as `targets` is. Certificates are about
 *  these: where things stand, in doubles, when rounding before the core is done. */
std::vector<cprox_obstacle> coreTargets(const Targets &targets);

/** Which of them an answer names; -1 for none. */
std::int32_t coreTargetOf(const Targets &targets, const Answer &answer);

/** The same as the program cprox_check reads it (doc/certificates.md), a line a convex part with the name of its owner;
 *  meshes by their convex hulls. Empty where something is of a kind that has no certificates. */
std::string describeTargets(const Targets &targets);

/** What has no certificates, with its kind: a sentence each. Where there is any, no answer can be proven. */
std::vector<std::string> unprovable(const Targets &targets);

/** Answers a query for one curve: one answer, or with per_object one for each object and link in the order of their
 *  names (objects first; none at all: one answer with b empty).
 *
 *  Never throws for what the core finds wrong (an epsilon that is NaN, a budget of 0, a delta below 0): such answers
 *  have result.status < 0, status and message say why. Any number of threads, each with its own workspace. */
std::vector<Answer> ask(const Targets &targets, const CompiledCurve &curve, const Query &query, Workspace &workspace);

/** The same in one step; what compile() and Targets find wrong becomes the one answer, "invalid" with the reason. */
std::vector<Answer> ask(const SnapshotPtr &snapshot, const LinkPoses &links, const CurveDescription &curve,
                        const Query &query, Workspace &workspace);

} // namespace curve_proximity
#endif
