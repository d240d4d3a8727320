/* SPDX-License-Identifier: BSD-3-Clause */
/* Every kind of solid, one line each: how it is made, and whether it is told its dimension. */
#include "base/workspace.h"
#include "fourier/solid.h"

typedef struct solid_maker {
  solid_constructor *create;
  bool reads_dimension;
} solid_maker;

static const solid_maker makers[] = {
    [CPROX_SOLID_BALL] = {solid_create_ball, true},           [CPROX_SOLID_BOX] = {solid_create_box, true},
    [CPROX_SOLID_ELLIPSOID] = {solid_create_ellipsoid, true}, [CPROX_SOLID_CYLINDER] = {solid_create_cylinder, false},
    [CPROX_SOLID_CAPSULE] = {solid_create_capsule, true},     [CPROX_SOLID_POLYGON] = {solid_create_polygon, false},
    [CPROX_SOLID_MESH] = {solid_create_mesh, false},          [CPROX_SOLID_POLYLINE] = {solid_create_polyline, true},
    [CPROX_SOLID_SWEEP] = {solid_create_sweep, true},         [CPROX_SOLID_GRID] = {solid_create_grid, true},
    [CPROX_SOLID_UNION] = {solid_create_union, false},        [CPROX_SOLID_CLIPPED] = {solid_create_clipped, false},
    [CPROX_SOLID_SUBLEVEL] = {solid_create_sublevel, true},
};

cprox_status cprox_solid_create(const cprox_solid_description *description, cprox_workspace *workspace,
                                cprox_solid **solid) {
  WORKSPACE_USE(workspace);
  fourier_clear(workspace);
  if (!solid) return fourier_fail(workspace, CPROX_INVALID, "solid is NULL: nowhere to put the handle");
  if (!description) return fourier_fail(workspace, CPROX_INVALID, "the description of the solid is NULL");
  if ((size_t)description->kind >= sizeof makers / sizeof *makers)
    return fourier_fail(workspace, CPROX_INVALID, "%d is no kind of solid", (int)description->kind);
  const solid_maker *maker = &makers[description->kind];
  if (maker->reads_dimension && description->dimension != 2 && description->dimension != 3)
    return fourier_fail(workspace, CPROX_INVALID, "dimension is %d, must be 2 or 3", description->dimension);
  cprox_solid *made = NULL;
  const cprox_status status = maker->create(description, workspace, &made);
  if (status != CPROX_OK) return status;
  made->kind = description->kind;
  *solid = made;
  return CPROX_OK;
}
