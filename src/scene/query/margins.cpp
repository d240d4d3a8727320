/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/margins.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include "answering.h"
#include "asked_pairs.h"

namespace curve_proximity {
namespace {

constexpr int MOST_STEPS = 60;
constexpr double SPARE = 1e-9;             /* of a clearance: far beyond the rounding of a place */
constexpr double FINE = 1e-4, PART = 0.01; /* [m], and of free: how near free and blocked are searched for */

/* One object at several places. */
class Moved {
 public:
  Moved(const Asked &asked, const Query &query, Workspace &workspace)
      : asked_(asked), query_(query), workspace_(workspace), delta_(query.delta) {
    query_.query_type = QueryType::DISTANCE;
    query_.delta = 0.0;
    for (const cprox_obstacle &obstacle : asked.obstacles) {
      const cprox_vec3 &p = obstacle.pose.position;
      size_ = std::max({size_, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    }
  }

  /* What is left of the clearance of the object where it is moved to: its bounds less delta. */
  struct Room {
    double lower, upper;
    Eigen::Vector3d toward; /* from the object to the robot, a unit vector; 0: nothing was measured */
    Answer names;
  };

  /* The object where it stands. */
  Room standing() {
    return search(Eigen::Vector3d::Zero(), query_.options);
  }

  /* Roughly where there is room, as finely as the query asks where there is little. */
  Room at(const Eigen::Vector3d &way) {
    cprox_options rough = query_.options;
    rough.relative_epsilon = std::max(rough.relative_epsilon, 0.02);
    const Room room = search(way, rough);
    return room.lower < FINE && room.upper > 0.0 ? search(way, query_.options) : room;
  }

  /* The row of an axis. What is left of a clearance is free in any direction: the next place is at its end. */
  ObjectMargin along(const Eigen::Vector3d &axis, const Room &start, double within) {
    ObjectMargin row;
    row.toward = axis;
    note(start, row);
    row.free = std::clamp(start.lower * (1.0 - SPARE), 0.0, within);
    if (start.upper <= 0.0) row.blocked = 0.0;
    for (int step = 0; step < MOST_STEPS && row.free > 0.0 && row.free < within && !isNarrow(row) && !stopped_;
         ++step) {
      const double place = row.free;
      const Room here = at(axis * place);
      if (!(row.blocked < INFINITE) || here.upper <= 0.0) note(here, row);
      if (here.upper <= 0.0) {
        row.blocked = place;
        break;
      }
      row.free = std::clamp(place + here.lower * (1.0 - SPARE), place, within);
      probe(axis, place, here, within, row);
      if (!(row.free > place)) break;
    }
    if (!isNarrow(row) && row.free < within) row.status = stopped_ ? CPROX_STOPPED : CPROX_PRECISION;
    return row;
  }

  static void note(const Room &room, ObjectMargin &row) {
    if (!std::isfinite(room.names.result.upper)) return;
    row.t = room.names.result.t;
    row.a = room.names.a;
  }

 private:
  Room search(const Eigen::Vector3d &way, const cprox_options &options) {
    std::vector<cprox_obstacle> obstacles = asked_.obstacles;
    for (cprox_obstacle &obstacle : obstacles) {
      cprox_vec3 &p = obstacle.pose.position;
      p.x += way.x(), p.y += way.y(), p.z += way.z();
    }
    Room out{0.0, INFINITE, Eigen::Vector3d::Zero(), {}};
    cprox_result &result = out.names.result;
    result.status = askCore(query_, options, asked_.mover(), obstacles, workspace_, result);
    if (result.status < 0) throw Error(workspace_.reason(), result.status);
    stopped_ = stopped_ || result.status == CPROX_STOPPED;
    widen(query_, asked_.rounding + 4e-16 * (size_ + way.norm()), INFINITE, result);
    out.lower = result.lower - delta_, out.upper = result.upper - delta_;
    const cprox_vec3 &to = result.witness_mover, &from = result.witness_obstacle;
    const Eigen::Vector3d between(to.x - from.x, to.y - from.y, to.z - from.z);
    if (result.obstacle_index >= 0 && std::isfinite(result.upper) && between.norm() > 0.0)
      out.toward = between.normalized();
    nameSides(asked_, query_, out.names);
    if (isReplaced(query_.options.max_lod, out.names.by_hull)) out.upper = INFINITE; // the mesh may be farther
    return out;
  }

  static bool isNarrow(const ObjectMargin &row) {
    return row.blocked - row.free <= std::max(FINE, PART * row.free);
  }

  /* Is the object in the way a little beyond where the normal at the witness points says that it will be? */
  void probe(const Eigen::Vector3d &axis, double from, const Room &here, double within, ObjectMargin &row) {
    const double closing = here.toward.dot(axis);
    const double place =
        from + (closing > 0.01 ? here.upper / closing : 2.0 * here.upper) + 0.5 * std::max(FINE, PART * row.free);
    if (!(place > row.free && place < std::min(row.blocked, within))) return;
    const Room there = at(axis * place);
    if (there.upper <= 0.0) {
      row.blocked = place;
      note(there, row);
    } else if (place - there.lower <= row.free) { // its ball reaches back to what is free
      row.free = std::clamp(place + there.lower * (1.0 - SPARE), row.free, within);
    }
  }

  const Asked &asked_;
  Query query_;
  Workspace &workspace_;
  const double delta_;
  double size_ = 0.0;
  bool stopped_ = false;
};

void addRows(const Asked &asked, const std::string &object, double within, const Query &query, Workspace &workspace,
             std::vector<ObjectMargin> &rows) {
  static const std::pair<const char *, Eigen::Vector3d> AXES[] = {
      {"+x", Eigen::Vector3d::UnitX()},  {"-x", -Eigen::Vector3d::UnitX()}, {"+y", Eigen::Vector3d::UnitY()},
      {"-y", -Eigen::Vector3d::UnitY()}, {"+z", Eigen::Vector3d::UnitZ()},  {"-z", -Eigen::Vector3d::UnitZ()}};
  const Coverage coverage = coverageOf(query, asked);
  Answer covered;
  applyCoverage(coverage, query, covered);
  const std::size_t first = rows.size();
  ObjectMargin any;
  any.direction = "any";
  if (asked.pairs.empty()) {
    any.free = within;
    rows.push_back(any);
    for (const auto &[name, axis] : AXES) any.direction = name, any.toward = axis, rows.push_back(any);
  } else {
    Moved moved(asked, query, workspace);
    const Moved::Room start = moved.standing();
    any.free = std::clamp(start.lower, 0.0, within);
    any.blocked = std::max(0.0, start.upper);
    any.toward = start.toward;
    if (!(any.blocked < within)) any.blocked = INFINITE;
    Moved::note(start, any);
    rows.push_back(any);
    for (const auto &[name, axis] : AXES) {
      ObjectMargin row = moved.along(axis, start, within);
      row.direction = name;
      rows.push_back(row);
    }
  }
  for (std::size_t i = first; i < rows.size(); ++i) {
    rows[i].object = object;
    rows[i].gap = covered.gap;
    if (covered.gap) rows[i].free = 0.0;
  }
}

} // namespace

std::vector<ObjectMargin> objectMargins(const RobotMotion &motion, double within, const Query &query,
                                        Workspace &workspace) {
  std::string fault = faultInAll(RobotPairs::ENVIRONMENT, query);
  if (query.query_type == QueryType::DISTANCE) fault = "margins are those of a tolerance or collision";
  if (query.options.certificate) fault = "margins have no certificate";
  if (!(query.delta >= 0.0)) fault = "delta is " + std::to_string(query.delta) + ", must be 0 or more";
  if (!(within > 0.0 && std::isfinite(within)))
    fault = "within is " + std::to_string(within) + ", must be above 0 and finite";
  if (!fault.empty()) throw Error(fault);

  const RobotMotion::Data &data = motion.data();
  const std::vector<Item> &items = data.snapshot->world().items();
  std::vector<ObjectMargin> rows;
  std::vector<std::size_t> shapes;
  const std::vector<std::size_t> named = namedItems(data, query.objects);
  for (std::size_t i = 0; i < named.size(); ++i) {
    shapes.push_back(named[i]);
    if (i + 1 < named.size() && items[named[i + 1]].owner == items[named[i]].owner) continue;
    addRows(askedItems(data, std::exchange(shapes, {}), query), *items[named[i]].owner, within, query, workspace, rows);
  }
  return rows;
}

} // namespace curve_proximity
