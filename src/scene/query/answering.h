/* SPDX-License-Identifier: BSD-3-Clause */
/* What queries about curves and about robots share: the core's queries, and what the core does not know. */
#ifndef CURVE_PROXIMITY_SCENE_ANSWERING_H
#define CURVE_PROXIMITY_SCENE_ANSWERING_H

#include <array>
#include <chrono>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <curve_proximity/query.hpp>

#include "world/world.h"

namespace curve_proximity {

inline constexpr double INFINITE = std::numeric_limits<double>::infinity();

using Clock = std::chrono::steady_clock;

double microsecondsSince(Clock::time_point start);

/* What a reader must know of an answer with Query::moving_only. */
inline const char *const MOVING_ONLY = "moving_only: what the trajectory does not move is left out";

/* What the query asks for and its answer would not heed, as a message; "" where there is nothing. Of a robot in
 * motion, of which `in_all` has one answer for all objects or pairs. */
std::string faultOf(const Query &query);
std::string faultOfMotion(const Query &query, bool in_all);

/* Why a query that knows only objects that stand cannot be answered about the objects named (none: about all), ""
 * where it can. */
std::string faultOfMoving(const Snapshot &snapshot, const std::vector<std::string> &objects);

/* The answer to such a query. */
Answer refusal(const std::string &id, const std::string &kind, const std::string &why);

/* An answer that knows nothing, since the stop function has ended the query before its search began. */
Answer unasked(const std::string &id, const std::string &kind, const Query &query);

/* The query without its certificate. */
Query withoutCertificate(Query query);

/* The part of epsilon that rounding takes is not the core's to use. */
cprox_options withoutRounding(cprox_options options, double rounding);

/* The query that the query asks. */
cprox_status askCore(const Query &query, const cprox_options &options, const cprox_mover &mover,
                     const std::vector<cprox_obstacle> &obstacles, Workspace &workspace, cprox_result &result);
cprox_status askCore(const Query &query, const cprox_options &options, const cprox_mover &mover,
                     const cprox_obstacles *obstacles, Workspace &workspace, cprox_result &result);

/* Widens the core's interval by what it does not know: rounding before it; what it was not shown is farther than
 * left_out. The verdict is reviewed by the interval as it then is. */
void widen(const Query &query, double rounding, double left_out, cprox_result &result);

/* What a profile or a list of violations is about: the arguments of the core, and what the core does not know. */
struct Stated {
  cprox_mover mover;
  std::vector<cprox_obstacle> obstacles;
  double rounding;                    /* [m] */
  bool is_empty;                      /* there is nothing to measure against */
  std::function<void(Answer &)> name; /* names both sides of what the core found, as nameItem() does */
};

/* Of a curve against all obstacles. The arguments outlive it. */
Stated statedOf(const SceneObstacles &obstacles, const CompiledCurve &curve, const Query &query);

/* The clearance profile, widened by the rounding that the core does not know. Throws Error where the core refuses. */
std::vector<ClearanceInterval> searchProfile(const Stated &stated, const std::vector<double> &breaks, double horizon,
                                             const Query &query, Workspace &workspace);

/* The same where there is nothing to measure against. */
std::vector<ClearanceInterval> profileOfNothing(const std::vector<double> &breaks);

/* Throws Error where violations cannot be asked for in this way. */
void checkViolations(const Query &query, double resolution);

/* The violations of delta and the rounding that the core does not know: outside of what is found everything is farther
 * than delta. Throws Error where the core refuses. */
Violations searchViolations(const Stated &stated, double resolution, const Query &query, Workspace &workspace);

/* The core's time of contact with obstacles that have been enlarged by what rounding can have moved: no contact comes
 * before it. */
void searchContact(const cprox_mover &mover, const std::vector<cprox_obstacle> &enlarged, const Query &query,
                   Workspace &workspace, cprox_result &result);

/* Why a query of distances alone (nearest pairs, profiles), or of the time of contact, cannot be answered; "" where it
 * can. What cannot be asked of any query is not looked at here. */
std::string faultOfDistances(const Query &query);
std::string faultOfProfile(const Query &query, const std::vector<double> &breaks, double horizon);
std::string faultOfContact(const Query &query);

/* How far rounding can have moved any point of a shape that a curve can be near to. */
double roundingOf(const CompiledCurve &curve, const PlacedShape &shape);

/* The same of any shape of the items. */
double roundingOf(const CompiledCurve &curve, const std::vector<Item> &items);

/* Names the shape that a curve's answer is about, and what of it has answered. */
void nameItem(const Item &item, cprox_lod max_lod, Answer &answer);

/* Whether a model that contains it stands for what is nearest, because max_lod says so. */
inline bool isReplaced(cprox_lod max_lod, bool is_mesh) {
  return max_lod == CPROX_LOD_SPHERE || (max_lod == CPROX_LOD_HULL && is_mesh);
}

inline const char *const MESH_BY_HULL = "the nearest shape is a mesh: its convex hull answers for it";

/* What is replaced may be farther than its model, or never be met: its answer claims no upper end and no violation. */
void claimOneSide(cprox_result &result);

/* The status by name; why there is no answer, where there is none. */
void finishAnswer(const Workspace &workspace, Answer &answer);

/* What a list of nearest pairs tells beside its pairs. */
struct Unlisted {
  cprox_status status = CPROX_OK;                         /* of the list; CPROX_OK: it is complete */
  double lower = std::numeric_limits<double>::infinity(); /* [m] of all pairs that are not listed */

  /* What the core says of a list of `results`, the rounding taken off. */
  void add(cprox_status of_list, const cprox_listed &listed, double rounding);

  /* The row of it behind the answers, where there must be one: where a pair that is not listed may be nearer than the
   * last of the list or than `within`. */
  void addRow(const PairLimits &limits, const cprox_options &options, const std::string &id, const std::string &kind,
              std::vector<Answer> &answers) const;
};

/* Why a curve has nothing to be measured against. */
constexpr const char *NO_OBJECT = "there is no object";

/* There is nothing to measure against. */
void answerNothing(const Query &query, cprox_result &result);

/* ---- coverage: the one place where answers learn of it ---- */

/* What answers do not cover: gaps of the query and of `given`, and Gap::EMPTY where nothing is measured and the query
 * does not allow that. nothing: why nothing is; "" where something is. */
Coverage coverageOf(const Query &query, const Coverage &given, const std::string &nothing);

/* Of an answer that there is: writes gap, status and message; takes from the result what it does not prove. */
void applyCoverage(const Coverage &coverage, const Query &query, Answer &answer);

/* Of a list of pairs: with a gap and no pair one answer takes the place of the list. `nothing` has its names. */
void applyCoverage(const Coverage &coverage, const Query &query, const Answer &nothing, std::vector<Answer> &answers);

/* Of all intervals of a profile. */
void applyCoverage(const Coverage &coverage, std::vector<ClearanceInterval> &profile);

/* Of all violations over the domain: nothing is proven to be farther. */
void applyCoverage(const Coverage &coverage, const std::array<double, 2> &domain, Violations &violations);

/* The part of a domain that the query is about. */
std::array<double, 2> domainOf(const Query &query, const std::array<double, 2> &all);

/* Of a gradient: it is not valid. */
template <class Gradient>
void applyGap(const Answer &answer, Gradient &gradient) {
  if (!answer.gap) return;
  gradient.valid = false;
  gradient.reason = answer.message;
}

} // namespace curve_proximity
#endif
