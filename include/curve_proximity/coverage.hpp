/* SPDX-License-Identifier: BSD-3-Clause */
/** What an answer does not cover of what was given: doc/coverage.md.
 *
 *  A proof is about the geometry that the core received. Readers note here what of an input did not get there. Robots,
 *  trajectories, scene changes and queries carry the notes, and each answer is made with them: it is never 'clear' of
 *  an input that it does not cover. */
#ifndef CURVE_PROXIMITY_COVERAGE_HPP
#define CURVE_PROXIMITY_COVERAGE_HPP

#include <optional>
#include <string>
#include <vector>

namespace curve_proximity {

/** Why an answer does not cover what was given. The later ones weigh more: they name the status. */
enum class Gap {
  ROUNDED, /**< coordinates changed on reading by more than the interval holds */
  PARTIAL, /**< something that was given was not used */
  EMPTY,   /**< there was nothing to measure: no object, or no pair */
  UNKNOWN, /**< what was expected has not come, and nothing is known in its place */
  STALE    /**< what was used is older than it may be */
};

/** Its status: "rounded", "partial", "empty", "unknown", "stale". */
const char *gapName(Gap gap);

/** A message about it for rows that have no message of their own. */
const char *gapText(Gap gap);

/** The gap of a status; none for a status that is none of the above. */
std::optional<Gap> gapFromName(const std::string &status);

/** What can be wrong with an answer because of a gap. */
enum class Missing {
  ANYTHING, /**< geometry can be missing, or stand elsewhere: contact is not proven either */
  GEOMETRY  /**< geometry can only be missing: what touches without it touches with it */
};

/** The gaps of an input, each with a message. Without any it is complete. */
class Coverage {
 public:
  /** Adds a gap; one with the same message only once. message: one line without a full stop that names the input. */
  void add(Gap gap, const std::string &message, Missing missing = Missing::ANYTHING);

  /** Adds all gaps of another one. */
  void add(const Coverage &other);

  /** True if all that was given is used. */
  bool complete() const {
    return notes_.empty();
  }

  /** The gap that weighs most; none if complete. */
  std::optional<Gap> gap() const;

  /** Its name; "" if complete. */
  std::string status() const;

  /** False if a gap can move or take away geometry: then a contact is not proven. */
  bool provesContact() const;

  /** The messages, in the order in which they came. */
  std::vector<std::string> messages() const;

  /** The first of the messages as one line, and how many there are more; "" if complete. */
  std::string message() const;

 private:
  struct Note {
    Gap gap;
    std::string message;
    Missing missing;
  };
  std::vector<Note> notes_;
};

} // namespace curve_proximity
#endif
