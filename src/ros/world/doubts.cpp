/* SPDX-License-Identifier: BSD-3-Clause */
#include "world/doubts.h"

#include <algorithm>
#include <limits>
#include <sstream>

namespace curve_proximity {
namespace {

std::string tooOld(const std::string &what, double age, double max_age) {
  std::ostringstream text;
  text.precision(3);
  text << what << " is " << age << " s old, above ~max_age = " << max_age;
  return text.str();
}

} // namespace

void Doubts::objects(const Query &query, bool any) {
  objects_ = Coverage();
  const bool everything = query.objects.empty() && query.links.empty();
  const auto asked = [&](const std::string &id) {
    return any && (everything || std::find(query.objects.begin(), query.objects.end(), id) != query.objects.end());
  };
  for (const Unknown &unknown : unknowns_)
    if (unknown.object.empty() || asked(unknown.object)) objects_.add(Gap::UNKNOWN, unknown.message, unknown.missing);
  for (const SensorState &sensor : sensors_) {
    if (!asked(sensor.id)) continue;
    if (sensor.unknown) {
      objects_.add(
          Gap::UNKNOWN,
          "what is at object '" + sensor.id + "' is unknown: its sensor sees nothing, or what it sent cannot be used",
          snapshot_->objects().count(sensor.id) > 0 ? Missing::ANYTHING : Missing::GEOMETRY); // as it was seen last
    } else if (max_age_ > 0.0 && sensor.age > max_age_) {
      objects_.add(Gap::STALE, tooOld("object '" + sensor.id + "'", sensor.age, max_age_));
    }
  }
}

void Doubts::ages(double transforms, double joints) {
  ages_ = Coverage();
  if (!(max_age_ > 0.0)) return;
  if (transforms > max_age_) ages_.add(Gap::STALE, tooOld("a transform", transforms, max_age_));
  if (joints > max_age_) ages_.add(Gap::STALE, tooOld("a joint value", joints, max_age_));
}

void Doubts::joints(const std::string &unknown) {
  joints_ = Coverage();
  if (!unknown.empty()) joints_.add(Gap::UNKNOWN, unknown);
}

Coverage Doubts::coverage() {
  Coverage out = ages_;
  out.add(joints_);
  out.add(objects_);
  for (const std::string &message : out.messages()) told_.insert(message);
  return out;
}

void Doubts::apply(ConstraintResult &row) {
  if (row.value != row.value) return;
  const Coverage why = coverage();
  if (why.complete()) return;
  row.status = why.status();
  row.lower = row.upper = row.touching_least = row.touching_most = std::numeric_limits<double>::quiet_NaN();
  for (TrajectoryConstraint &one : row.rows) one.lower = one.upper = row.lower;
  row.message += (row.message.empty() ? "" : "; ") + why.message();
}

void Doubts::tell(std::vector<std::string> &warnings) const {
  constexpr std::size_t MOST = 10;
  std::set<std::string> all = told_;
  for (const Unknown &unknown : unknowns_) all.insert(unknown.message);
  for (const std::string &why : all)
    if (warnings.size() < MOST) warnings.push_back(why);
}

} // namespace curve_proximity
