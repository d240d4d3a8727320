// SPDX-License-Identifier: BSD-3-Clause
#include "ccd_tight_inclusion.h"

#include <tight_inclusion/ccd.hpp>

namespace {

ticcd::Vector3 at(const cprox_vec3 &p) {
  return {p.x, p.y, p.z};
}

template <typename Query>
bool ask(Query query, const cprox_vec3 start[4], const cprox_vec3 end[4], double *t) {
  double tolerance;
  return query(at(start[0]), at(start[1]), at(start[2]), at(start[3]), at(end[0]), at(end[1]), at(end[2]), at(end[3]),
               ticcd::Array3(-1.0, -1.0, -1.0), 0.0, *t, 1e-6, 1.0, 1000000, tolerance, ticcd::DEFAULT_NO_ZERO_TOI,
               ticcd::CCDRootFindingMethod::BREADTH_FIRST_SEARCH);
}

} // namespace

bool tight_inclusion_vertex_face(const cprox_vec3 start[4], const cprox_vec3 end[4], double *t) {
  return ask(ticcd::vertexFaceCCD, start, end, t);
}

bool tight_inclusion_edge_edge(const cprox_vec3 start[4], const cprox_vec3 end[4], double *t) {
  return ask(ticcd::edgeEdgeCCD, start, end, t);
}
