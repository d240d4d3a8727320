/* SPDX-License-Identifier: BSD-3-Clause */
/** Bodies from libccd support callbacks.
 *
 *  Header-only over libcprox and libccd's header: libccd itself is not called and need not be linked. */
#ifndef CURVE_PROXIMITY_CCD_HPP
#define CURVE_PROXIMITY_CCD_HPP

#include <ccd/ccd.h>
#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>

#include <curve_proximity/core.hpp>

namespace curve_proximity {

namespace detail {

/** The user pointer of the C callback: libccd's callback and its object. */
struct CcdShape {
  ccd_support_fn support;
  const void *object;
};

inline void ccdSupport(const void *shape, const double direction[3], double point[3]) {
  const auto *self = static_cast<const CcdShape *>(shape);
  ccd_vec3_t dir, at;
  for (int i = 0; i < 3; ++i) dir.v[i] = static_cast<ccd_real_t>(direction[i]);
  for (int i = 0; i < 3; ++i) at.v[i] = std::numeric_limits<ccd_real_t>::quiet_NaN(); // a callback that writes nothing
  self->support(self->object, &dir, &at);
  for (int i = 0; i < 3; ++i) point[i] = static_cast<double>(at.v[i]);
}

} // namespace detail

/** Makes the convex body that the support function `support` describes.
 *
 *  The body's frame is the frame in which the callback answers. libccd's callbacks usually answer in the world frame;
 *  then the body's pose is the identity.
 *
 *  object   is passed to the callback. The body keeps a reference, so the object must outlive the body.
 *  centre   a point of the shape [m].
 *  radius   every point of the shape is within this distance of the centre [m], > 0.
 *  slack    the support error: how far an answer may be from the shape and from the true maximum [m], >= 0. If libccd
 *           was built with float, the rounding of float directions and answers is added.
 *  margin   a ball of this radius is added to the shape [m], >= 0.
 *
 *  Throws Error where cprox_body_create_support() fails. Thread safety: that of the callback. */
inline BodyHandle makeSupport(ccd_support_fn support, const void *object, const Eigen::Vector3d &centre, double radius,
                              double slack = 0.0, double margin = 0.0) {
  if (!support) throw Error("the support callback is null");

  // A direction rounded to float is off by 2^-24 a component, an answer by 2^-24 of its size; eight times covers both.
  if (std::is_same<ccd_real_t, float>::value) slack += std::ldexp(centre.norm() + 2.0 * radius, -21);

  const auto shape = std::make_shared<const detail::CcdShape>(detail::CcdShape{support, object});
  return detail::makeBody(
      [&](cprox_workspace *w, cprox_body **b) {
        return cprox_body_create_support(&detail::ccdSupport, shape.get(), toVec3(centre), radius, slack, margin, w, b);
      },
      shape);
}

} // namespace curve_proximity
#endif
