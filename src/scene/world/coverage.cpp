/* SPDX-License-Identifier: BSD-3-Clause */
#include <curve_proximity/coverage.hpp>

#include <algorithm>
#include <array>

namespace curve_proximity {
namespace {

constexpr std::array<Gap, 5> GAPS = {Gap::ROUNDED, Gap::PARTIAL, Gap::EMPTY, Gap::UNKNOWN, Gap::STALE};

} // namespace

const char *gapName(Gap gap) {
  switch (gap) {
    case Gap::ROUNDED: return "rounded";
    case Gap::PARTIAL: return "partial";
    case Gap::EMPTY: return "empty";
    case Gap::UNKNOWN: return "unknown";
    case Gap::STALE: break;
  }
  return "stale";
}

const char *gapText(Gap gap) {
  switch (gap) {
    case Gap::ROUNDED: return "coordinates were rounded on reading";
    case Gap::PARTIAL: return "something that was given is not used";
    case Gap::EMPTY: return "nothing was measured";
    case Gap::UNKNOWN: return "something that was expected is not known";
    case Gap::STALE: break;
  }
  return "something that was used is too old";
}

std::optional<Gap> gapFromName(const std::string &status) {
  for (const Gap gap : GAPS)
    if (status == gapName(gap)) return gap;
  return std::nullopt;
}

void Coverage::add(Gap gap, const std::string &message, Missing missing) {
  for (Note &note : notes_) {
    if (note.gap != gap || note.message != message) continue;
    if (missing == Missing::ANYTHING) note.missing = missing;
    return;
  }
  notes_.push_back({gap, message, missing});
}

void Coverage::add(const Coverage &other) {
  for (const Note &note : other.notes_) add(note.gap, note.message, note.missing);
}

std::optional<Gap> Coverage::gap() const {
  std::optional<Gap> out;
  for (const Note &note : notes_)
    if (!out || note.gap > *out) out = note.gap;
  return out;
}

std::string Coverage::status() const {
  const std::optional<Gap> found = gap();
  return found ? gapName(*found) : "";
}

bool Coverage::provesContact() const {
  return std::all_of(notes_.begin(), notes_.end(), [](const Note &note) { return note.missing == Missing::GEOMETRY; });
}

std::vector<std::string> Coverage::messages() const {
  std::vector<std::string> out;
  for (const Note &note : notes_) out.push_back(note.message);
  return out;
}

std::string Coverage::message() const {
  constexpr std::size_t MOST = 3;
  std::string out;
  for (std::size_t i = 0; i < std::min(MOST, notes_.size()); ++i) out += (i ? "; " : "") + notes_[i].message;
  if (notes_.size() > MOST) out += "; and " + std::to_string(notes_.size() - MOST) + " more";
  return out;
}

} // namespace curve_proximity
