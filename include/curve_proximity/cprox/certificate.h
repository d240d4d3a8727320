/* SPDX-License-Identifier: BSD-3-Clause */
/** Certificates: what a query leaves behind so that others can check its answer without trusting the search.
 *
 *  A certificate says one of two things about a mover and obstacles: "the distance is greater than delta everywhere",
 *  proven by a cover of the parameter range with a separating direction for each part; or "at this parameter the
 *  distance is at most delta", proven by a point of the obstacle. The program cprox_check reads it together with the
 *  query and decides in arithmetic that does not round, or rounds outwards; it shares no line with this library.
 *  doc/certificates.md has the format.
 */
#ifndef CURVE_PROXIMITY_CPROX_CERTIFICATE_H
#define CURVE_PROXIMITY_CPROX_CERTIFICATE_H

#include <curve_proximity/cprox/obstacles.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum cprox_claim {
  /** nothing is proven: the certificate is empty */
  CPROX_CLAIM_NONE,
  /** mover and obstacles are farther apart than delta everywhere */
  CPROX_CLAIM_APART,
  /** somewhere they are no farther apart than delta */
  CPROX_CLAIM_NEAR,
  /** they are farther apart than delta before a parameter; the certificate may also prove that they meet thereafter */
  CPROX_CLAIM_BEFORE,
  /** between two parameters they are farther apart than delta */
  CPROX_CLAIM_DURING
} cprox_claim;

/** A new, empty certificate, or NULL where memory is out. Owned by the caller: cprox_certificate_free(). It may be used
 *  again and again; like a workspace by one thread at a time. */
CPROX_API cprox_certificate *cprox_certificate_create(void);

/** Frees a certificate; NULL is allowed. */
CPROX_API void cprox_certificate_free(cprox_certificate *certificate);

/** Empties it: nothing is claimed. NULL is allowed. */
CPROX_API void cprox_certificate_clear(cprox_certificate *certificate);

/** What a certificate holds. */
typedef struct cprox_certificate_info {
  /** what it claims */
  cprox_claim claim;
  /** [m] the limit that the claim is about */
  double delta;
  /** the bytes to be kept or sent; valid until the next query with the certificate */
  const void *bytes;
  /** the number of bytes; 0 where nothing is proven */
  size_t size;
} cprox_certificate_info;

/** What a certificate holds. */
CPROX_API cprox_certificate_info cprox_certificate_get_info(const cprox_certificate *certificate);

/** Makes a certificate for an answer: what options->certificate does at the end of a query, for those who have the
 *  answer.
 *
 *  answer      of a query with these arguments; its witness is used, its bounds are not trusted. delta <= its upper
 *              bound.
 *  delta       [m] >= 0. Claimed is `near` where answer->upper <= delta, else `apart`.
 *  options     max_nodes bounds the parts of the cover that are tried, for each obstacle; NULL: the default. With an
 *              interval, here of curves, too, the claim is `during`: that the distance is greater than delta in it.
 *              With an answer to a query for the distance in the interval, delta may be lowered by epsilon; else
 *              the claim may begin later and end earlier, by as little as the form of the proof needs.
 *  certificate receives the proof. It is empty (CPROX_CLAIM_NONE) where none was found, and where the call failed.
 *
 *  Obstacles that are meshes, points or boxes are taken by their triangles, points and boxes. A robot's link that is a
 *  mesh is known by the convex hull that it was made with (cprox_body_create_lod), which contains it. `apart` is proven
 *  of the hull; `near` is never claimed of such a link. Of a distance that such a link answered, the claim may be the
 *  distance to the hulls, where that is above 0.
 *
 *  A claim that is as tight as double arithmetic allows may be proven for a delta that is weaker by a few roundings;
 *  that of a distance (delta == answer->lower) by epsilon, where the curve bends round an obstacle at a constant
 *  distance and planes cannot follow as closely as the search did. cprox_certificate_info.delta tells. Touching a flat
 *  obstacle without radius or margin cannot be proven.
 *
 *  Returns CPROX_OK        there is a proof
 *          CPROX_BUDGET    max_nodes were not enough
 *          CPROX_PRECISION the distance is too close to delta
 *          CPROX_INVALID   an argument is unusable, or of a kind that has no certificates: support callbacks,
 *                          implicit bodies as links or carried, links of points and octrees, links of meshes
 *                          without a hull; or the nearest link is a mesh, and `near` was to be claimed
 *          CPROX_MEMORY    an allocation failed
 *  with the reason in the workspace. Cost: a few times that of the query; memory is allocated for the certificate.
 *  Source: doc/certificates.md.
 */
CPROX_API cprox_status cprox_certify(cprox_mover mover, const cprox_obstacles *obstacles, double delta,
                                     const cprox_result *answer, const cprox_options *options,
                                     cprox_workspace *workspace, cprox_certificate *certificate);

/** Makes a certificate for an answer to the time of contact.
 *
 *  answer      of cprox_time_of_contact(), cprox_obstacles_time_of_contact() or their like with these arguments. Where
 *              its verdict is clear, claimed is `apart` with delta 0. Else: that nothing is touched before a parameter
 *              that is t_contact_lower, or less where rounding or the form of the proof need that; and, where that can
 *              be proven, that by t the distance is no more than upper. The checker prints both parameters.
 *  others      as of cprox_certify()
 *
 *  Returns as cprox_certify(); CPROX_PRECISION where t_contact_lower is at the beginning. Source: doc/certificates.md.
 */
CPROX_API cprox_status cprox_certify_contact(cprox_mover mover, const cprox_obstacles *obstacles,
                                             const cprox_result *answer, const cprox_options *options,
                                             cprox_workspace *workspace, cprox_certificate *certificate);

/** The obstacle as the checker reads it: lines of text, numbers in hexadecimal without rounding, bodies as the library
 *  holds them.
 *
 *  text   receives the lines, cut to size - 1 characters and ended by 0; NULL with size 0: only their length is asked.
 *  Returns the length of the whole text without the 0; 0 for a kind that has no certificates, for curves, and where
 *  memory is out. Meshes are there by their triangles, in the order that certificates count them in. What is
 *  synchronized is described as if it stood: the caller adds the curve to each line.
 */
CPROX_API size_t cprox_obstacle_describe(const cprox_obstacle *obstacle, char *text, size_t size);

/** A robot along a motion as the checker reads it, with the pairs that the query is about: its obstacles are described
 *  before, by cprox_obstacle_describe(). Links that are meshes are there by their hulls: of those "near" is never
 *  claimed.
 *
 *  id          one word.
 *  text, size  as above.
 *  Returns the length of the whole text without the 0; 0 for a mover that is no robot, for bodies of a kind that has no
 *  certificates, and where memory is out.
 */
CPROX_API size_t cprox_mover_describe(const cprox_mover *mover, const cprox_obstacles *obstacles, const char *id,
                                      cprox_workspace *workspace, char *text, size_t size);

#ifdef __cplusplus
}
#endif
#endif
