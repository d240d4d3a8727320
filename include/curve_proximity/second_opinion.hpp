/* SPDX-License-Identifier: BSD-3-Clause */
/** A second opinion: the pair that an answer names, measured again by FCL or by libccd.
 *
 *  It is no proof. It is a check of this package by libraries that share no code with it. */
#ifndef CURVE_PROXIMITY_SECOND_OPINION_HPP
#define CURVE_PROXIMITY_SECOND_OPINION_HPP

#include <limits>
#include <memory>
#include <optional>
#include <string>

#include <curve_proximity/geometry.hpp>

namespace curve_proximity {

/** Whose opinion. */
enum class Peer {
  FCL,   /**< fcl::distance() with its solver GST_INDEP */
  LIBCCD /**< libccd has no distance: the least margin at which its MPR says that the shapes meet */
};

/** "fcl", "libccd". */
const char *peerName(Peer peer);

/** The peer with that name; nothing for any other word. */
std::optional<Peer> peerFromName(const std::string &name);

/** What a peer says of an answer. */
struct SecondOpinion {
  /** The outcome. */
  enum Verdict {
    NONE,      /**< nobody asked */
    AGREES,    /**< its distances are within the interval, to its accuracy */
    DISAGREES, /**< one of its distances is not: `message` says which */
    UNKNOWN    /**< it could not measure the pair: `message` says why */
  };
  Verdict verdict = NONE; /**< the outcome */
  /** [m] >= 0, the distance of the pair at the witness time; 0 where they touch or overlap. */
  double distance = std::numeric_limits<double>::quiet_NaN();
  std::string message; /**< one line where the verdict is DISAGREES or UNKNOWN */
};

/** "", "agrees", "disagrees", "unknown". */
const char *secondOpinionName(SecondOpinion::Verdict verdict);

/** Asks one peer. Meshes that are read for it are kept. Any number of threads. */
class SecondOpinions {
 public:
  /** objects: where mesh files of objects are searched; those of links are searched as the robot's are. */
  explicit SecondOpinions(Peer peer, ResourceOptions objects = {});
  ~SecondOpinions();

  /** Who is asked. */
  Peer peer() const;

  /** A pair of shapes at poses in one frame (their own `pose` members are not read), of which [lower, upper] is said to
   *  hold the distance; negative numbers are depths and count as 0. */
  SecondOpinion ofPair(const ShapeDescription &a, const Eigen::Isometry3d &pose_a, const ShapeDescription &b,
                       const Eigen::Isometry3d &pose_b, double lower, double upper) const;

  struct Data;
  /** Internal. */
  const Data &data() const {
    return *data_;
  }

 private:
  std::unique_ptr<const Data> data_;
};

} // namespace curve_proximity
#endif
