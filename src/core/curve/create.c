/* SPDX-License-Identifier: BSD-3-Clause */
/* Every kind of curve, one line each: how it is made, how its coefficients weigh at a parameter, and how its
 * point there changes by the numbers that define it. */
#include <math.h>

#include "base/workspace.h"
#include "curve/curve.h"

typedef struct curve_maker {
  curve_constructor *create;
  /* NULL: the points of the curve are no sum of coefficients */
  curve_weighting *weigh;
  /* NULL: the points alone define the curve, or nothing that has a derivative */
  curve_differentiator *differentiate;
} curve_maker;

static const curve_maker makers[] = {
    [CPROX_CURVE_BEZIER] = {curve_create_bezier, curve_weights_bezier, NULL},
    [CPROX_CURVE_BSPLINE] = {curve_create_bspline, curve_weights_bspline, NULL},
    [CPROX_CURVE_POLYNOMIAL] = {curve_create_polynomial, curve_weights_polynomial, NULL},
    [CPROX_CURVE_LEGENDRE] = {curve_create_legendre, curve_weights_legendre, NULL},
    [CPROX_CURVE_LAGRANGE] = {curve_create_lagrange, curve_weights_lagrange, NULL},
    [CPROX_CURVE_TRIGONOMETRIC] = {curve_create_trigonometric, curve_weights_trigonometric, NULL},
    [CPROX_CURVE_CLOTHOID] = {curve_create_clothoid, NULL, curve_jacobian_clothoid},
    [CPROX_CURVE_DUBINS] = {curve_create_dubins, NULL, curve_jacobian_dubins},
    [CPROX_CURVE_INVOLUTE] = {curve_create_involute, NULL, curve_jacobian_involute},
    [CPROX_CURVE_PYTHAGOREAN_HODOGRAPH] = {curve_create_pythagorean_hodograph, NULL,
                                           curve_jacobian_pythagorean_hodograph},
    [CPROX_CURVE_PIECEWISE] = {curve_create_piecewise, NULL, NULL},
    [CPROX_CURVE_SMOOTH] = {curve_create_smooth, NULL, NULL},
    [CPROX_CURVE_RECTIFIABLE] = {curve_create_rectifiable, NULL, NULL},
    [CPROX_CURVE_RATIONAL_BEZIER] = {curve_create_rational_bezier, curve_weights_rational_bezier,
                                     curve_jacobian_rational_bezier},
    [CPROX_CURVE_NURBS] = {curve_create_nurbs, curve_weights_nurbs, curve_jacobian_nurbs},
    [CPROX_CURVE_PART] = {curve_create_part, NULL, NULL},
};

/* NULL for a kind that is none. */
static const curve_maker *maker_of(cprox_curve_kind kind) {
  const size_t n = sizeof makers / sizeof *makers;
  return (size_t)kind < n ? &makers[kind] : NULL;
}

cprox_status cprox_curve_create(const cprox_curve_description *description, cprox_workspace *workspace,
                                cprox_curve **curve) {
  WORKSPACE_USE(workspace);
  workspace_clear(workspace);
  if (!curve) return workspace_fail(workspace, CPROX_INVALID, "the pointer for the new curve is NULL");
  if (!description) return workspace_fail(workspace, CPROX_INVALID, "the description of the curve is NULL");
  const curve_maker *maker = maker_of(description->kind);
  if (!maker) return workspace_fail(workspace, CPROX_INVALID, "%d is no kind of curve", (int)description->kind);
  cprox_curve *made = NULL;
  const cprox_status status = maker->create(description, workspace, &made);
  if (status != CPROX_OK) return status;
  made->kind = (uint8_t)(made->arcs ? CPROX_CURVE_RECTIFIABLE : description->kind);
  *curve = made;
  return CPROX_OK;
}

cprox_status cprox_curve_weights(const cprox_curve_description *description, double t, double *weights) {
  const curve_maker *maker = description ? maker_of(description->kind) : NULL;
  if (!maker || !maker->weigh || description->n == 0) return CPROX_INVALID;
  maker->weigh(description, t, weights);
  return CPROX_OK;
}

cprox_status cprox_curve_jacobian(const cprox_curve_description *description, double t, cprox_vec3 *columns) {
  const curve_maker *maker = description ? maker_of(description->kind) : NULL;
  return maker && maker->differentiate && isfinite(t) ? maker->differentiate(description, t, columns) : CPROX_INVALID;
}
