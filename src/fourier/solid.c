/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids of one formula, unions, and what every solid can tell. */
#include "fourier/solid.h"
#include "base/workspace.h"

#include <stdlib.h>

static const double NO_TURN[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

cprox_status solid_check_length(const char *name, double value, cprox_workspace *workspace) {
  if (!(value > 0.0)) return fourier_fail(workspace, CPROX_INVALID, "%s is %g, must be > 0", name, value);
  if (!isfinite(value)) return fourier_fail(workspace, CPROX_INVALID, "%s is %g, must be finite", name, value);
  if (value < SOLID_LEAST || value > SOLID_LARGEST)
    return fourier_fail(workspace, CPROX_INVALID, "%s is %g, must be between %g and %g", name, value, SOLID_LEAST,
                        SOLID_LARGEST);
  return CPROX_OK;
}

cprox_status solid_check_points(const char *name, const vec3 *points, size_t n, int dimension,
                                cprox_workspace *workspace) {
  for (size_t i = 0; i < n; i++) {
    const vec3 p = points[i];
    if (!vec_finite(p) || fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))) > SOLID_LARGEST)
      return fourier_fail(workspace, CPROX_INVALID, "%s %zu is (%g, %g, %g), must be finite and within %g", name, i,
                          p.x, p.y, p.z, SOLID_LARGEST);
    if (dimension == 2 && p.z != 0.0)
      return fourier_fail(workspace, CPROX_INVALID, "%s %zu has z = %g, a planar solid lies in z = 0", name, i, p.z);
  }
  return CPROX_OK;
}

cprox_status solid_out_of_memory(cprox_workspace *workspace) {
  return fourier_fail(workspace, CPROX_MEMORY, "no memory for a solid");
}

cprox_solid *solid_allocate(int dimension, size_t n) {
  cprox_solid *solid = calloc(1, sizeof *solid);
  if (!solid) return NULL;
  solid->dimension = dimension;
  solid->n = n;
  solid->pieces = calloc(n, sizeof *solid->pieces);
  if (!solid->pieces) {
    free(solid);
    return NULL;
  }
  return solid;
}

void cprox_solid_free(cprox_solid *solid) {
  if (!solid) return;
  for (size_t i = 0; i < solid->n; i++) piece_free(&solid->pieces[i]);
  free(solid->pieces);
  free(solid);
}

void solid_bound(cprox_solid *solid) {
  vec3 low = vec(INFINITY, INFINITY, INFINITY), high = vec(-INFINITY, -INFINITY, -INFINITY);
  for (size_t i = 0; i < solid->n; i++) {
    vec3 l, h;
    piece_box(&solid->pieces[i], solid->dimension, &l, &h);
    low = vec(fmin(low.x, l.x), fmin(low.y, l.y), fmin(low.z, l.z));
    high = vec(fmax(high.x, h.x), fmax(high.y, h.y), fmax(high.z, h.z));
  }
  solid->centre = vec_axpy(vec_scale(0.5, low), 0.5, high);
  if (solid->dimension == 2) solid->centre.z = 0.0;
  solid->radius = 0.0;
  for (size_t i = 0; i < solid->n; i++)
    solid->radius = fmax(solid->radius, piece_radius_about(&solid->pieces[i], solid->dimension, solid->centre));
  solid->radius *= 1.0 + 1e-14; /* the rounding of centres, radii and poses */
}

cprox_status solid_of_piece(int dimension, piece *p, cprox_workspace *workspace, cprox_solid **solid) {
  cprox_solid *made = solid_allocate(dimension, 1);
  if (!made) {
    piece_free(p);
    return solid_out_of_memory(workspace);
  }
  made->pieces[0] = *p;
  solid_bound(made);
  *solid = made;
  return CPROX_OK;
}

/* A piece of one to three lengths, each checked under its name. */
static cprox_status create_simple(piece_kind kind, int dimension, const char *const names[3], const double given[3],
                                  const double size[3], cprox_workspace *workspace, cprox_solid **solid) {
  for (int i = 0; i < 3; i++) {
    const cprox_status status = names[i] ? solid_check_length(names[i], given[i], workspace) : CPROX_OK;
    if (status != CPROX_OK) return status;
  }
  piece p = piece_create(kind);
  for (int i = 0; i < 3; i++) p.size[i] = size[i];
  return solid_of_piece(dimension, &p, workspace, solid);
}

cprox_status solid_create_ball(const cprox_solid_description *d, cprox_workspace *workspace, cprox_solid **solid) {
  const double r[3] = {d->radius, d->radius, d->radius};
  return create_simple(PIECE_ELLIPSOID, d->dimension, (const char *const[3]){"radius", NULL, NULL}, r, r, workspace,
                       solid);
}

cprox_status solid_create_box(const cprox_solid_description *d, cprox_workspace *workspace, cprox_solid **solid) {
  const double full[3] = {d->size.x, d->size.y, d->size.z};
  const double half[3] = {0.5 * d->size.x, 0.5 * d->size.y, 0.5 * d->size.z};
  const char *const names[3] = {"size.x", "size.y", d->dimension == 2 ? NULL : "size.z"};
  return create_simple(PIECE_BOX, d->dimension, names, full, half, workspace, solid);
}

cprox_status solid_create_ellipsoid(const cprox_solid_description *d, cprox_workspace *workspace, cprox_solid **solid) {
  const double a[3] = {d->semi_axes.x, d->semi_axes.y, d->semi_axes.z};
  const char *const names[3] = {"semi_axes.x", "semi_axes.y", d->dimension == 2 ? NULL : "semi_axes.z"};
  return create_simple(PIECE_ELLIPSOID, d->dimension, names, a, a, workspace, solid);
}

cprox_status solid_create_cylinder(const cprox_solid_description *d, cprox_workspace *workspace, cprox_solid **solid) {
  return create_simple(PIECE_CYLINDER, 3, (const char *const[3]){"height", "radius", NULL},
                       (const double[3]){d->height, d->radius, 0}, (const double[3]){d->radius, 0.5 * d->height, 0},
                       workspace, solid);
}

cprox_status solid_create_capsule(const cprox_solid_description *d, cprox_workspace *workspace, cprox_solid **solid) {
  return create_simple(PIECE_CAPSULE, d->dimension, (const char *const[3]){"height", "radius", NULL},
                       (const double[3]){d->height, d->radius, 0}, (const double[3]){d->radius, 0.5 * d->height, 0},
                       workspace, solid);
}

/* Whether a pose is one of the dimension: NULL, or the fault as part of an error message. */
static const char *pose_error(const cprox_pose *pose, int dimension) {
  const char *support_failed = frame_pose_error(pose);
  if (support_failed || dimension == 3) return support_failed;
  if (pose->orientation.x != 0.0 || pose->orientation.y != 0.0) return "a planar pose turns about z only";
  return pose->position.z != 0.0 ? "a planar pose has z = 0" : NULL;
}

cprox_status solid_create_union(const cprox_solid_description *d, cprox_workspace *workspace, cprox_solid **solid) {
  const cprox_solid *const *parts = d->parts;
  const cprox_pose *poses = d->poses;
  const size_t n = d->n;
  if (n == 0) return fourier_fail(workspace, CPROX_INVALID, "a union needs at least 1 part, got none");
  if (!parts || !poses) return fourier_fail(workspace, CPROX_INVALID, "%s is NULL", parts ? "poses" : "parts");
  size_t pieces = 0;
  for (size_t i = 0; i < n; i++) {
    if (!parts[i]) return fourier_fail(workspace, CPROX_INVALID, "part %zu is NULL", i);
    if (parts[i]->dimension != parts[0]->dimension)
      return fourier_fail(workspace, CPROX_INVALID, "part %zu has dimension %d, part 0 has %d", i, parts[i]->dimension,
                          parts[0]->dimension);
    const char *support_failed = pose_error(&poses[i], parts[0]->dimension);
    if (support_failed) return fourier_fail(workspace, CPROX_INVALID, "the pose of part %zu: %s", i, support_failed);
    if ((parts[i]->pieces[0].kind == PIECE_SWEEP) != (parts[0]->pieces[0].kind == PIECE_SWEEP))
      return fourier_fail(workspace, CPROX_INVALID, "parts 0 and %zu: a sweep cannot be united with a solid", i);
    pieces += parts[i]->n;
  }
  if (n > 1 && parts[0]->pieces[0].kind == PIECE_SWEEP)
    return fourier_fail(workspace, CPROX_INVALID, "sweeps cannot be united: make one gap for each");

  cprox_solid *made = solid_allocate(parts[0]->dimension, pieces);
  if (!made) return solid_out_of_memory(workspace);
  size_t at = 0;
  for (size_t i = 0; i < n; i++) {
    const frame f = frame_create(&poses[i], vec(0, 0, 0));
    for (size_t j = 0; j < parts[i]->n; j++)
      if (!piece_copy(&parts[i]->pieces[j], f.r, f.position, &made->pieces[at++])) {
        cprox_solid_free(made);
        return solid_out_of_memory(workspace);
      }
  }
  solid_bound(made);
  *solid = made;
  return CPROX_OK;
}

cprox_solid *solid_offset(const cprox_solid *solid, double rho, double *reach) {
  cprox_solid *made = solid_allocate(solid->dimension, solid->n);
  if (!made) return NULL;
  *reach = 0.0;
  for (size_t i = 0; i < solid->n; i++) {
    piece enlarged;
    bool ok = piece_offset(&solid->pieces[i], solid->dimension, rho, &enlarged, reach);
    if (ok) {
      ok = piece_copy(&enlarged, NO_TURN, vec_neg(solid->centre), &made->pieces[i]);
      piece_free(&enlarged);
    }
    if (!ok) {
      cprox_solid_free(made);
      return NULL;
    }
  }
  solid_bound(made);
  return made;
}

void solid_spectrum(const cprox_solid *solid, vec3 q, bool gradient, wave_jet *jet) {
  *jet = (wave_jet){0};
  for (size_t i = 0; i < solid->n; i++) {
    wave_jet own;
    piece_spectrum(&solid->pieces[i], solid->dimension, q, gradient, &own);
    jet->value.re += own.value.re, jet->value.im += own.value.im;
    jet->re = vec_add(jet->re, own.re), jet->im = vec_add(jet->im, own.im);
  }
}

double solid_error_scale(const cprox_solid *solid, double q) {
  double sum = 0.0;
  for (size_t i = 0; i < solid->n; i++) sum += piece_error_scale(&solid->pieces[i], solid->dimension, q);
  return sum;
}

cprox_solid_info cprox_solid_get_info(const cprox_solid *solid) {
  cprox_solid_info info = {
      .kind = solid->kind, .dimension = solid->dimension, .centre = solid->centre, .radius = solid->radius};
  for (size_t i = 0; i < solid->n; i++) info.measure += piece_measure(&solid->pieces[i], solid->dimension);
  return info;
}

cprox_status cprox_solid_spectrum(const cprox_solid *solid, cprox_vec3 q, cprox_workspace *workspace, double value[2],
                                  cprox_vec3 gradient[2]) {
  WORKSPACE_USE(workspace);
  fourier_clear(workspace);
  if (!solid || !value) return fourier_fail(workspace, CPROX_INVALID, "%s is NULL", solid ? "value" : "solid");
  if (!vec_finite(q) || (solid->dimension == 2 && q.z != 0.0))
    return fourier_fail(workspace, CPROX_INVALID, "q is (%g, %g, %g), must be finite%s", q.x, q.y, q.z,
                        solid->dimension == 2 ? " and have z = 0 in the plane" : "");
  wave_jet jet;
  solid_spectrum(solid, q, gradient != NULL, &jet);
  value[0] = jet.value.re, value[1] = jet.value.im;
  if (gradient) gradient[0] = jet.re, gradient[1] = jet.im;
  return CPROX_OK;
}
