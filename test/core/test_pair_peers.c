/* SPDX-License-Identifier: BSD-3-Clause */
/* libccd beside our pair solver: wherever bodies are clearly apart or clearly overlap, both say the same. */

#include <ccd/ccd.h>
#include "curve_proximity/cprox/query.h"
#include "shape/body.h"
#include "support/cases.h"
#include "support/random.h"
#include "support/reference.h"
#include "support/shapes.h"

typedef struct posed {
  const cprox_body *body;
  frame f;
} posed;

/* libccd's callback, answered by our support function. */
static void ccd_support(const void *object, const ccd_vec3_t *d, ccd_vec3_t *p) {
  const posed *o = object;
  vec3 at;
  cprox_body_support(o->body, frame_turn_to_local(&o->f, vec(d->v[0], d->v[1], d->v[2])), &at);
  at = frame_to_world(&o->f, at);
  ccdVec3Set(p, at.x, at.y, at.z);
}

static bool ccd_says_overlap(const test_shape *a, const cprox_pose *pa, const test_shape *b, const cprox_pose *pb) {
  const posed oa = {a->body, frame_create(pa, vec(0, 0, 0))}, ob = {b->body, frame_create(pb, vec(0, 0, 0))};
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = ccd.support2 = ccd_support;
  ccd.max_iterations = 200;
  return ccdGJKIntersect(&oa, &ob, &ccd) != 0;
}

/* Seed 701, 1e5 pairs of solid kinds and polytopes: half apart by construction by 1e-6 to 1 sizes, half sharing a point
 * that is at least a twentieth of the way from the surface to the middle of each. libccd has no tolerance of its own in
 * this verdict but its arithmetic; it must not contradict a distance above 1e-6. */
CASE(libccd_gives_the_same_verdict_where_it_is_clear) {
  rng r = rng_seed(701);
  static test_shape a, b;
  const cprox_body_kind kinds[] = {CPROX_BODY_SPHERE,   CPROX_BODY_BOX,  CPROX_BODY_CAPSULE,
                                   CPROX_BODY_CYLINDER, CPROX_BODY_CONE, CPROX_BODY_ELLIPSOID};
  size_t apart = 0, together = 0;
  for (size_t i = 0; i < test_cases(100000); i++) {
    shape_make(&r, kinds[rng_index(&r, 6)], 1.0, 4.0, &a);
    shape_make(&r, kinds[rng_index(&r, 6)], 1.0, 4.0, &b);
    const cprox_pose pa = rng_pose(&r, 1.0);
    cprox_pose pb = rng_pose(&r, 0.0);
    if (i % 2) {
      shape_place(&a, &pa, &b, &pb, shape_telling_direction(&r, &b, &pb), rng_log_uniform(&r, 1e-6, 1.0));
    } else {
      const double fraction = rng_uniform(&r, 0.05, 1.0);
      const vec3l x = ref_sub(shape_point_within(&r, &a, &pa, fraction), shape_point_within(&r, &b, &pb, fraction));
      pb.position = vec((double)x.x, (double)x.y, (double)x.z);
    }
    cprox_result ours;
    assert_true(cprox_pair(cprox_obstacle_at(a.body, pa), cprox_obstacle_at(b.body, pb), NULL, NULL, &ours) >=
                CPROX_OK);
    const bool overlap = ours.upper < 0.0;
    assert_true(overlap == (i % 2 == 0));
    if (ccd_says_overlap(&a, &pa, &b, &pb) != overlap)
      fail_msg("%s and %s: [%.17g, %.17g], libccd says %s", shape_name(&a), shape_name(&b), ours.lower, ours.upper,
               overlap ? "apart" : "overlap");
    overlap ? together++ : apart++;
    cprox_body_free(a.body);
    cprox_body_free(b.body);
  }
  print_message("apart %zu, overlapping %zu\n", apart, together);
}

int main(void) {
  return cases_run(NULL, NULL);
}
