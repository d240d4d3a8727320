/* SPDX-License-Identifier: BSD-3-Clause */
/* Sublevel sets of a function with a Lipschitz constant, as the cells of a grid that may meet them. */
#include <stdlib.h>

#include "fourier/solid.h"

/* What is read of the description, and the values of the last layer, its row and its cell: for the comparison with
 * those of the next. */
typedef struct sampling {
  const cprox_solid_description *d;
  double step; /* how much neighbouring values may differ */
  double *layer;
  cprox_workspace *workspace;
} sampling;

static vec3 middle(const cprox_solid_description *d, size_t x, size_t y, size_t z) {
  const double h = d->cell;
  return vec(d->lowest.x + ((double)x + 0.5) * h, d->lowest.y + ((double)y + 0.5) * h,
             d->dimension == 2 ? 0.0 : d->lowest.z + ((double)z + 0.5) * h);
}

static cprox_status compare(const sampling *s, vec3 at, double value, double before) {
  if (fabs(value - before) <= s->step) return CPROX_OK;
  return fourier_fail(s->workspace, CPROX_INVALID,
                      "the function is %g at (%g, %g, %g) and %g one cell before: that contradicts lipschitz = %g",
                      value, at.x, at.y, at.z, before, s->d->lipschitz);
}

/* Cell (x, y, z): 1 if it may meet the set, 0 if not; -1 on failure. */
static int meets(const sampling *s, size_t x, size_t y, size_t z) {
  const cprox_solid_description *d = s->d;
  const vec3 at = middle(d, x, y, z);
  const double value = d->function(d->user, at);
  double *here = &s->layer[x + d->counts[0] * y];
  if (!isfinite(value)) {
    fourier_fail(s->workspace, CPROX_INVALID, "the function is %g at (%g, %g, %g), must be finite", value, at.x, at.y,
                 at.z);
    return -1;
  }
  if ((z > 0 && compare(s, at, value, *here) != CPROX_OK) || (x > 0 && compare(s, at, value, here[-1]) != CPROX_OK) ||
      (y > 0 && compare(s, at, value, here[-(ptrdiff_t)d->counts[0]]) != CPROX_OK))
    return -1;
  *here = value;
  const double reach = 0.5 * d->cell * sqrt((double)d->dimension) * (1.0 + 1e-12);
  return value <= d->lipschitz * reach;
}

static cprox_status fill_cells(const sampling *s, unsigned char *cells) {
  const uint32_t *n = s->d->counts;
  size_t i = 0;
  for (size_t z = 0; z < n[2]; z++)
    for (size_t y = 0; y < n[1]; y++)
      for (size_t x = 0; x < n[0]; x++, i++) {
        const int met = meets(s, x, y, z);
        if (met < 0) return CPROX_INVALID;
        cells[i] = (unsigned char)met;
      }
  return CPROX_OK;
}

cprox_status solid_create_sublevel(const cprox_solid_description *d, cprox_workspace *workspace, cprox_solid **solid) {
  if (!d->function) return fourier_fail(workspace, CPROX_INVALID, "function is NULL");
  if (!(d->lipschitz > 0.0) || !isfinite(d->lipschitz))
    return fourier_fail(workspace, CPROX_INVALID, "lipschitz is %g, must be > 0 and finite", d->lipschitz);
  cprox_status status = solid_check_grid(d, workspace);
  if (status != CPROX_OK) return status;
  const size_t layer = (size_t)d->counts[0] * d->counts[1];
  const sampling s = {
      .d = d,
      .step = d->lipschitz * d->cell * (1.0 + 1e-9),
      .layer = calloc(layer, sizeof(double)),
      .workspace = workspace,
  };
  unsigned char *cells = malloc(layer * d->counts[2]);
  status = s.layer && cells ? fill_cells(&s, cells) : solid_out_of_memory(workspace);
  if (status == CPROX_OK) {
    cprox_solid_description grid = *d;
    grid.occupied = cells;
    status = solid_create_grid(&grid, workspace, solid);
  }
  free(s.layer);
  free(cells);
  return status;
}
