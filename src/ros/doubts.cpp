/* SPDX-License-Identifier: BSD-3-Clause */
#include "doubts.h"

#include <algorithm>
#include <limits>
#include <sstream>

#include "live_scene.h"

namespace curve_proximity {
namespace {

void add(std::string &text, const std::string &sentence) {
  text += (text.empty() ? "" : "; ") + sentence;
}

std::string tooOld(const std::string &what, double age, double max_age) {
  std::ostringstream text;
  text.precision(3);
  text << what << " is " << age << " s old, above ~max_age = " << max_age;
  return text.str();
}

} // namespace

void Doubts::objects(const Query &query, bool any) {
  stale_objects_.clear();
  unknown_objects_.clear();
  const bool everything = query.objects.empty() && query.links.empty();
  if (lost_ && everything) unknown_objects_ = SCENE_LOST;
  for (const SensorState &sensor : sensors_) {
    const bool named = std::find(query.objects.begin(), query.objects.end(), sensor.id) != query.objects.end();
    if (!any || !(everything || named)) continue;
    if (sensor.unknown) {
      add(unknown_objects_, "what is at object '" + sensor.id + "' is unknown: its sensor sees nothing");
    } else if (max_age_ > 0.0 && sensor.age > max_age_) {
      add(stale_objects_, tooOld("object '" + sensor.id + "'", sensor.age, max_age_));
    }
  }
}

void Doubts::ages(double transforms, double joints) {
  stale_ages_.clear();
  if (!(max_age_ > 0.0)) return;
  if (transforms > max_age_) add(stale_ages_, tooOld("a transform", transforms, max_age_));
  if (joints > max_age_) add(stale_ages_, tooOld("a joint value", joints, max_age_));
}

Doubts::Reason Doubts::reason() {
  Reason out{"", !stale_ages_.empty() || !stale_objects_.empty()};
  for (const std::string *part : {&stale_ages_, &stale_objects_, &unknown_objects_})
    if (!part->empty()) add(out.text, *part);
  if (!out.text.empty()) told_.insert(out.text);
  return out;
}

void Doubts::apply(Proximity &row) {
  if (row.lower != row.lower) return;
  const Reason why = reason();
  if (why.text.empty()) return;
  row.status = why.stale ? Proximity::STATUS_STALE : Proximity::STATUS_UNKNOWN;
  row.lower = 0.0;
  row.t_contact_lower = std::numeric_limits<double>::quiet_NaN();
  if (row.verdict == Proximity::VERDICT_CLEAR || (why.stale && !row.verdict.empty()))
    row.verdict = Proximity::VERDICT_UNDECIDED;
  add(row.message, why.text);
}

void Doubts::apply(ConstraintResult &row) {
  if (row.value != row.value) return;
  const Reason why = reason();
  if (why.text.empty()) return;
  row.status = why.stale ? ConstraintResult::STATUS_STALE : ConstraintResult::STATUS_UNKNOWN;
  row.lower = row.upper = std::numeric_limits<double>::quiet_NaN();
  for (TrajectoryConstraint &one : row.rows) one.lower = one.upper = row.lower;
  add(row.message, why.text);
}

void Doubts::tell(std::vector<std::string> &warnings) const {
  constexpr std::size_t MOST = 10;
  for (const std::string &why : told_)
    if (warnings.size() < MOST) warnings.push_back(why);
}

} // namespace curve_proximity
