/* SPDX-License-Identifier: BSD-3-Clause */
/** C++ around cprox_fourier.h: solids and gaps that free themselves, errors as exceptions. Link libcprox_fourier.
 *
 *  doc/fourier.md says what a gap is. Metres, radians, right-handed frames. */
#ifndef CURVE_PROXIMITY_FOURIER_HPP
#define CURVE_PROXIMITY_FOURIER_HPP

#include <memory>
#include <vector>

#include <curve_proximity/cprox_fourier.h>
#include <curve_proximity/core.hpp>

namespace curve_proximity {

/** A solid of cprox_fourier.h. Immutable, shared by any number of threads. */
using SolidHandle = std::shared_ptr<const cprox_solid>;

/** A pair of solids made ready. Immutable, shared by any number of threads, each with its own workspace. */
using GapHandle = std::shared_ptr<const cprox_gap>;

/** A solid as described. Throws Error. */
inline SolidHandle makeSolid(const cprox_solid_description &description) {
  Workspace workspace;
  cprox_solid *solid = nullptr;
  require(cprox_solid_create(&description, workspace.get(), &solid), workspace);
  return SolidHandle(solid, [](const cprox_solid *s) { cprox_solid_free(const_cast<cprox_solid *>(s)); });
}

/** The union of solids of one dimension, each at a pose. Throws Error. */
inline SolidHandle makeUnion(const std::vector<SolidHandle> &parts, const std::vector<cprox_pose> &poses) {
  if (parts.size() != poses.size()) throw Error("a union needs as many poses as parts");
  std::vector<const cprox_solid *> handles;
  for (const SolidHandle &part : parts) handles.push_back(part.get());
  cprox_solid_description all{};
  all.kind = CPROX_SOLID_UNION;
  all.parts = handles.data();
  all.poses = poses.data();
  all.n = handles.size();
  return makeSolid(all);
}

/** A gap of two solids. workspace: the function that cprox_workspace_set_stop() gave it is asked. Throws Error, also
 *  where the gap would need more than options.memory_limit: the message says how much. */
inline GapHandle makeGap(const SolidHandle &a, const SolidHandle &b, const cprox_gap_options &options,
                         const Workspace &workspace = {}) {
  cprox_gap *gap = nullptr;
  require(cprox_gap_create(a.get(), b.get(), &options, workspace.get(), &gap), workspace);
  return GapHandle(gap, [](const cprox_gap *g) { cprox_gap_free(const_cast<cprox_gap *>(g)); });
}

/** Value, verdict and gradients at a pose of each solid. A status of CPROX_PRECISION (signals) is kept in `status`. */
inline cprox_gap_result evaluate(const GapHandle &gap, const cprox_pose &a, const cprox_pose &b, Workspace &workspace,
                                 cprox_status *status = nullptr) {
  cprox_gap_result result{};
  const cprox_status got = require(cprox_gap_evaluate(gap.get(), &a, &b, workspace.get(), &result), workspace);
  if (status) *status = got;
  return result;
}

/** The verdict alone. */
inline cprox_gap_result test(const GapHandle &gap, const cprox_pose &a, const cprox_pose &b, Workspace &workspace) {
  cprox_gap_result result{};
  require(cprox_gap_test(gap.get(), &a, &b, workspace.get(), &result), workspace);
  return result;
}

} // namespace curve_proximity
#endif
