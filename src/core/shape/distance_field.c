/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/distance_field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "shape/construct.h"

/* Squares of lengths, and cells of grids, must neither overflow nor vanish. */
static const double LEAST_LENGTH = 1e-60, MOST_LENGTH = 1e60;

/* ---- values ---- */

/* The arithmetic of whoever computes distances at this place: at most this far off, whatever error was stated. */
static double rounding_at(const distance_field *field, vec3 x, double value) {
  return 64.0 * ROUND_U * (vec_norm(x) + vec_norm(field->centre) + field->radius + fabs(value));
}

static cprox_status contradiction(const distance_field *field, const distance_value *a, const distance_value *b,
                                  double apart, cprox_workspace *workspace) {
  return workspace_fail(workspace, CPROX_INVALID,
                        "%s says %.9g at (%g, %g, %g) and %.9g at (%g, %g, %g), which is %.3g away: more than a "
                        "Lipschitz constant of %g and an error of %g allow",
                        field->source, a->value, a->at.x, a->at.y, a->at.z, b->value, b->at.x, b->at.y, b->at.z, apart,
                        field->lipschitz, field->error);
}

/* Two values differ by no more than the Lipschitz constant says, and, as true distances do, by no more than the two
 * points do; the values may both be off. */
static cprox_status compare(const distance_field *field, const distance_value *a, const distance_value *b,
                            cprox_workspace *workspace) {
  const double apart = vec_norm(vec_sub(a->at, b->at)), differ = fabs(a->value - b->value);
  const double as_values = field->lipschitz * apart + a->rounding + b->rounding;
  const double as_distances = apart + a->error + b->error;
  if (apart > 0.0 && differ > fmin(as_values, as_distances) * ROUND_UP)
    return contradiction(field, a, b, apart, workspace);
  return CPROX_OK;
}

cprox_status distance_field_measure(const distance_field *field, vec3 x, const distance_value *other,
                                    cprox_workspace *workspace, distance_value *measured) {
  double error = 0.0;
  const double value = field->value(field, x, &error), rounding = rounding_at(field, x, value);
  *measured = (distance_value){.at = x, .value = value, .error = error + rounding, .rounding = rounding};
  if (!isfinite(value))
    return workspace_fail(workspace, CPROX_INVALID, "%s answered %g at (%g, %g, %g)", field->source, value, x.x, x.y,
                          x.z);
  const double from_centre = vec_norm(vec_sub(x, field->centre)), slack = ROUND_UP * measured->error;
  if (value < from_centre - field->radius - slack || value > from_centre + field->radius + slack)
    return workspace_fail(workspace, CPROX_INVALID,
                          "%s says %.9g at (%g, %g, %g), but the set lies within %g of (%g, %g, %g), %.9g away",
                          field->source, value, x.x, x.y, x.z, field->radius, field->centre.x, field->centre.y,
                          field->centre.z, from_centre);
  return other ? compare(field, other, measured, workspace) : CPROX_OK;
}

/* ---- bounds ---- */

/* The square of a distance less |x|² is a least of linear functions, so that it is concave: over a segment of length l
 * the square is at least (1 - s) A + s B - s (1 - s) l². The Lipschitz constant may say more where values are off. */
double distance_field_over_segment(const distance_field *field, const distance_value *a, const distance_value *b) {
  const double length = vec_norm(vec_sub(a->at, b->at)), length2 = length * length;
  const double low = greater(a->value - a->error, 0.0), high = greater(b->value - b->error, 0.0);
  const double first = low * low, last = high * high;
  const double slope = last - first - length2;
  const double s = length2 > 0.0 ? lesser(greater(-0.5 * slope / length2, 0.0), 1.0) : 0.0;
  const double square = first + s * (slope + s * length2) - 16.0 * ROUND_U * (first + last + length2);
  const double by_square = square > 0.0 ? sqrt(square) : 0.0;
  const double rise = length > 0.0 ? field->lipschitz * length : 0.0; /* the constant may be infinity */
  const double by_lipschitz = 0.5 * (a->value - a->error + b->value - b->error - rise);
  return greater(by_square, by_lipschitz) * (1.0 - 8.0 * ROUND_U);
}

/* ---- nearest points: suggestions ---- */

static double value_at(const distance_field *field, vec3 x) {
  double error;
  const double value = field->value(field, x, &error);
  return isnan(value) ? INFINITY : value;
}

/* The unit direction in which values grow, by central differences. */
static vec3 direction_at(const distance_field *field, vec3 x, double step) {
  const vec3 axis[3] = {{step, 0, 0}, {0, step, 0}, {0, 0, step}};
  double rise[3];
  for (int k = 0; k < 3; k++) rise[k] = value_at(field, vec_add(x, axis[k])) - value_at(field, vec_sub(x, axis[k]));
  const vec3 slope = vec_scale(0.5 / step, vec(rise[0], rise[1], rise[2]));
  const double steepness = vec_norm(slope);
  return steepness > 0.25 && isfinite(steepness) ? vec_scale(1.0 / steepness, slope) : vec(0, 0, 0);
}

/* Of 26 directions the one along which a step of the distance comes nearest. */
static vec3 direction_by_trial(const distance_field *field, vec3 x, double distance) {
  vec3 best = vec(0, 0, 0);
  double least = INFINITY;
  for (int i = 0; i < 27; i++) {
    const int dx = i % 3 - 1, dy = i / 3 % 3 - 1, dz = i / 9 - 1;
    const vec3 d = vec(dx, dy, dz);
    const double length = vec_norm(d);
    if (!(length > 0.0)) continue;
    const vec3 unit = vec_scale(1.0 / length, d);
    const double value = value_at(field, vec_axpy(x, -distance, unit));
    if (value < least) least = value, best = unit;
  }
  return best;
}

vec3 distance_field_nearest(const distance_field *field, const distance_value *from, vec3 *normal) {
  enum { STEPS = 8 };
  vec3 x = from->at;
  *normal = direction_at(field, x, field->step);
  if (vec_norm2(*normal) == 0.0) *normal = direction_by_trial(field, x, from->value);
  if (!(from->value > 0.0)) return x;
  x = vec_axpy(x, -from->value, *normal);
  for (int i = 0; i < STEPS; i++) {
    const double left = value_at(field, x);
    if (!(left > field->error)) break;
    const vec3 n = direction_at(field, x, fmin(field->step, left));
    if (vec_norm2(n) == 0.0) break;
    x = vec_axpy(x, -left, n);
  }
  const vec3 away = vec_sub(from->at, x);
  if (vec_norm(away) > 0.5 * from->value) *normal = vec_scale(1.0 / vec_norm(away), away);
  return x;
}

/* ---- checks by samples ---- */

/* The radical inverse of i: evenly spread numbers in [0, 1). */
static double radical_inverse(unsigned i, unsigned base) {
  double value = 0.0, digit = 1.0;
  for (; i > 0; i /= base) {
    digit /= base;
    value += digit * (i % base);
  }
  return value;
}

/* Places in the cube of twice the radius, each with a neighbour between a radius and a millionth of it away. */
static cprox_status check_samples(const distance_field *field, cprox_workspace *workspace) {
  enum { SAMPLES = 128, DECADES = 7 };
  static const double least = 1e-6;
  for (unsigned i = 1; i <= SAMPLES; i++) {
    const vec3 spread = vec(radical_inverse(i, 2) - 0.5, radical_inverse(i, 3) - 0.5, radical_inverse(i, 5) - 0.5);
    const vec3 turned = vec(radical_inverse(i, 7) - 0.5, radical_inverse(i, 11) - 0.5, radical_inverse(i, 13) - 0.5);
    const double apart = field->radius * pow(least, (double)(i % DECADES) / (DECADES - 1));
    const vec3 x = vec_axpy(field->centre, 4.0 * field->radius, spread);
    distance_value first, second;
    cprox_status status = distance_field_measure(field, x, NULL, workspace, &first);
    if (status == CPROX_OK)
      status = distance_field_measure(field, vec_axpy(x, apart / (1e-9 + vec_norm(turned)), turned), &first, workspace,
                                      &second);
    if (status != CPROX_OK) return status;
  }
  return CPROX_OK;
}

/* ---- the caller's function ---- */

static double callback_value(const distance_field *field, vec3 x, double *error) {
  const double point[3] = {x.x, x.y, x.z};
  *error = field->error;
  return field->callback(field->user, point);
}

static cprox_status check_length(const char *name, double value, double least, double most,
                                 cprox_workspace *workspace) {
  if (value >= least && value <= most) return CPROX_OK;
  return workspace_fail(workspace, CPROX_INVALID, "%s is %g, must be between %g and %g", name, value, least, most);
}

static cprox_status check_place(const char *name, vec3 p, cprox_workspace *workspace) {
  if (vec_norm(p) <= MOST_LENGTH) return CPROX_OK;
  return workspace_fail(workspace, CPROX_INVALID, "%s is (%g, %g, %g), must be finite and within %g of the origin",
                        name, p.x, p.y, p.z, MOST_LENGTH);
}

/* The body of a field, which it owns from then on, whether it succeeds or not. */
static cprox_status create_body(cprox_body_kind kind, distance_field *field, cprox_workspace *workspace,
                                cprox_body **body) {
  const cprox_status status = check_samples(field, workspace);
  cprox_body *made = status == CPROX_OK ? body_allocate(NULL, kind) : NULL;
  if (!made) {
    distance_field_free(field);
    return status == CPROX_OK ? body_out_of_memory(workspace) : status;
  }
  made->field = field;
  made->centre = made->ball_centre = field->centre;
  made->shape.scale = made->ball_radius = field->radius * (1.0 + ROUND_LENGTH * ROUND_U);
  *body = made;
  return CPROX_OK;
}

cprox_status cprox_body_create_distance(cprox_distance_fn distance, const void *shape, cprox_vec3 centre, double radius,
                                        double lipschitz, double error, cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  cprox_status status;
  if (!body) return workspace_fail(workspace, CPROX_INVALID, "body is NULL: nowhere to put the handle");
  if (!distance) return workspace_fail(workspace, CPROX_INVALID, "distance is NULL");
  if (!(lipschitz > 0.0))
    return workspace_fail(workspace, CPROX_INVALID, "lipschitz is %g, must be > 0: 1 for true distances", lipschitz);
  if ((status = check_place("centre", centre, workspace)) ||
      (status = check_length("radius", radius, LEAST_LENGTH, MOST_LENGTH, workspace)) ||
      (status = check_length("error", error, 0.0, MOST_LENGTH, workspace)))
    return status;
  distance_field *field = malloc(sizeof *field);
  if (!field) return body_out_of_memory(workspace);
  *field = (distance_field){.value = callback_value,
                            .error = error,
                            .lipschitz = lipschitz,
                            .centre = centre,
                            .radius = radius,
                            .step = fmax(1e-6 * radius, 2.0 * error),
                            .source = "the distance callback",
                            .callback = distance,
                            .user = shape};
  return create_body(CPROX_BODY_DISTANCE, field, workspace, body);
}

/* ---- a grid of distances ---- */

static double grid_at(const distance_field *field, size_t i, size_t j, size_t k) {
  return field->values[(k * field->n[1] + j) * field->n[0] + i];
}

/* Within the grid's box: trilinear, clipped to what the eight corners prove. Each corner is off by at most
 * `values_error`; a distance changes by at most the way to the corner, and its square less |x|² is concave. */
static double grid_inside(const distance_field *field, const double from[3], double *error) {
  size_t low[3];
  double weight[3], spread = 0.0;
  for (int k = 0; k < 3; k++) {
    const double most = (double)(field->n[k] - 1), at = lesser(greater(from[k] / field->cell, 0.0), most);
    low[k] = (size_t)lesser(floor(at), most - 1.0);
    weight[k] = at - (double)low[k];
    spread += weight[k] * (1.0 - weight[k]);
  }
  double mean = 0.0, square = 0.0, least = -INFINITY, most = INFINITY;
  for (int corner = 0; corner < 8; corner++) {
    const int up[3] = {corner & 1, corner >> 1 & 1, corner >> 2};
    const double value = grid_at(field, low[0] + (size_t)up[0], low[1] + (size_t)up[1], low[2] + (size_t)up[2]);
    double share = 1.0, way2 = 0.0;
    for (int k = 0; k < 3; k++) {
      const double part = up[k] ? 1.0 - weight[k] : weight[k];
      share *= 1.0 - part;
      way2 += part * part;
    }
    const double way = field->cell * sqrt(way2), sure = greater(value - field->values_error, 0.0);
    mean += share * value;
    square += share * sure * sure;
    least = greater(least, value - field->values_error - way);
    if (value < field->most) most = lesser(most, value + field->values_error + way);
  }
  square -= field->cell * field->cell * spread;
  if (square > 0.0) least = greater(least, sqrt(square));
  if (isinf(most)) most = greater(2.0 * field->radius, least);
  const double value = lesser(greater(mean, least), most);
  *error = greater(value - least, most - value);
  return value;
}

/* Outside, the set lies beyond the box's nearest point c as seen from x: the distance is at least the hypotenuse of
 * |x - c| and that of c, and at most their sum. */
static double grid_value(const distance_field *field, vec3 x, double *error) {
  double from[3] = {x.x - field->origin.x, x.y - field->origin.y, x.z - field->origin.z}, out2 = 0.0;
  for (int k = 0; k < 3; k++) {
    const double inside = lesser(greater(from[k], 0.0), field->cell * (double)(field->n[k] - 1));
    out2 += (from[k] - inside) * (from[k] - inside);
    from[k] = inside;
  }
  const double value = grid_inside(field, from, error);
  if (!(out2 > 0.0)) return value;
  const double sure = greater(value - *error, 0.0), least = sqrt(out2 + sure * sure);
  const double most = sqrt(out2) + greater(value + *error, 0.0);
  *error = 0.5 * (most - least);
  return 0.5 * (least + most);
}

/* Values that are too far apart for their points are no distances. */
static cprox_status check_neighbours(const cprox_distance_grid *grid, size_t index, const size_t at[3],
                                     cprox_workspace *workspace) {
  static const char axis[] = "xyz";
  const double value = grid->values[index];
  if (!isfinite(value))
    return workspace_fail(workspace, CPROX_INVALID, "the distance at grid point (%zu, %zu, %zu) is %g, must be finite",
                          at[0], at[1], at[2], value);
  const double rise = grid->cell + 2.0 * grid->error + 64.0 * ROUND_U * (fabs(value) + grid->cell);
  size_t stride = 1;
  for (int k = 0; k < 3; stride *= grid->n[k], k++) {
    const double before = at[k] > 0 ? grid->values[index - stride] : value;
    if (at[k] > 0 && fabs(value - before) > rise)
      return workspace_fail(
          workspace, CPROX_INVALID,
          "the distances at grid point (%zu, %zu, %zu) and its neighbour in %c are %.9g and %.9g: more "
          "than a cell of %g and an error of %g allow",
          at[0], at[1], at[2], axis[k], value, before, grid->cell, grid->error);
  }
  return CPROX_OK;
}

static cprox_status check_grid(const cprox_distance_grid *grid, cprox_workspace *workspace) {
  cprox_status status;
  size_t count = 1;
  for (int k = 0; k < 3; k++) {
    if (grid->n[k] < 2)
      return workspace_fail(workspace, CPROX_INVALID, "the grid has %zu points along axis %d, at least 2 are needed",
                            grid->n[k], k);
    if (grid->n[k] > SIZE_MAX / sizeof(double) / count)
      return workspace_fail(workspace, CPROX_INVALID, "the grid has too many points");
    count *= grid->n[k];
  }
  if (!grid->values) return workspace_fail(workspace, CPROX_INVALID, "values is NULL");
  if ((status = check_place("origin", grid->origin, workspace)) ||
      (status = check_length("cell", grid->cell, LEAST_LENGTH, MOST_LENGTH, workspace)) ||
      (status = check_length("error", grid->error, 0.0, MOST_LENGTH, workspace)))
    return status;
  if (!(grid->truncated_at > 0.0))
    return workspace_fail(workspace, CPROX_INVALID, "truncated_at is %g, must be > 0: infinity where values go on",
                          grid->truncated_at);
  for (size_t index = 0; index < count; index++) {
    const size_t at[3] = {index % grid->n[0], index / grid->n[0] % grid->n[1], index / grid->n[0] / grid->n[1]};
    if ((status = check_neighbours(grid, index, at, workspace))) return status;
  }
  return CPROX_OK;
}

cprox_status cprox_body_create_distance_grid(const cprox_distance_grid *grid, cprox_workspace *workspace,
                                             cprox_body **body) {
  WORKSPACE_USE(workspace);
  if (!body) return workspace_fail(workspace, CPROX_INVALID, "body is NULL: nowhere to put the handle");
  if (!grid) return workspace_fail(workspace, CPROX_INVALID, "grid is NULL");
  const cprox_status status = check_grid(grid, workspace);
  if (status != CPROX_OK) return status;
  const size_t count = grid->n[0] * grid->n[1] * grid->n[2];
  distance_field *field = malloc(sizeof *field);
  double *values = malloc(count * sizeof *values);
  if (!field || !values) {
    free(field);
    free(values);
    return body_out_of_memory(workspace);
  }
  memcpy(values, grid->values, count * sizeof *values);
  const vec3 half =
      vec_scale(0.5 * grid->cell, vec((double)(grid->n[0] - 1), (double)(grid->n[1] - 1), (double)(grid->n[2] - 1)));
  *field = (distance_field){.value = grid_value,
                            .error = grid->error + 0.8661 * grid->cell, /* half a cell's diagonal */
                            .lipschitz = INFINITY,
                            .centre = vec_add(grid->origin, half),
                            .radius = vec_norm(half) * (1.0 + ROUND_LENGTH * ROUND_U),
                            .step = 0.5 * grid->cell,
                            .source = "the grid of distances",
                            .n = {grid->n[0], grid->n[1], grid->n[2]},
                            .origin = grid->origin,
                            .cell = grid->cell,
                            .values_error = grid->error,
                            .most = grid->truncated_at,
                            .values = values};
  return create_body(CPROX_BODY_DISTANCE_GRID, field, workspace, body);
}

void distance_field_free(distance_field *field) {
  if (!field) return;
  free(field->values);
  free(field);
}
