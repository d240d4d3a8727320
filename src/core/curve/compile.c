/* SPDX-License-Identifier: BSD-3-Clause */
/* Remainder: the quintic that shares value and two derivatives with psi at both ends of a piece of length h is within
 * max|psi^(6)| (t-a)³(b-t)³/6! <= K6 h^6/46080 of it.
 *
 * Rounding: the inner Bézier points are p + .4h v + .05h² w, p, v, w within e_0, e_1, e_2 of the exact data; h, its
 * factors and products cost at most 5u of the second and 6u of the third term, the two sums 2u of all: e_0 + .4h e_1 +
 * .05h² e_2 + u(2|p| + 7 (.4h)|v| + 8 (.05h²)|w|). The constant is added at the very end, which costs u of the result.
 * Every point of the piece is a convex sum of these, so their error bounds the curve's. Where lengths underflow
 * CURVE_LEAST covers it. */
#include "curve/compile.h"

#include <stdlib.h>
#include <string.h>

#include "base/rounding.h"
#include "base/workspace.h"

/* ---- memory ---- */

static void release_memory(compile *c) {
  free(c->breaks);
  free(c->points);
  free(c->error);
  *c = (compile){.workspace = c->workspace};
}

/* Room for one piece more; false where memory is out. */
static bool make_room(compile *c) {
  if (c->n < c->room) return true;
  const size_t room = c->room ? 2 * c->room : 64;
  double *breaks = realloc(c->breaks, room * sizeof *breaks);
  if (breaks) c->breaks = breaks;
  vec3 *points = realloc(c->points, 6 * room * sizeof *points);
  if (points) c->points = points;
  double *error = realloc(c->error, room * sizeof *error);
  if (error) c->error = error;
  if (!breaks || !points || !error) return false;
  c->room = room;
  return true;
}

/* ---- steps ---- */

double compile_step(double sixth, double accuracy) {
  return sixth > 0.0 ? pow(46080.0 * (accuracy / sixth), 1.0 / 6.0) : sixth == 0.0 ? INFINITY : 0.0;
}

/* How long a piece may be for what is known of [from, from + h]. */
static double reach(const compile_source *source, double from, double h) {
  return compile_step(source->sixth(source->self, from, from + h), source->accuracy);
}

/* A length that the remainder allows, near the longest one of at most `limit`. As |psi^(6)| is smaller on less, min(h,
 * reach(h)) is always allowed. */
static double step_within(const compile_source *source, double from, double limit) {
  double h = fmin(limit, reach(source, from, limit));
  for (int tries = 0; h < 1e-9 * limit && tries < 64; tries++) {
    limit *= 0.125;
    h = fmin(limit, reach(source, from, limit));
  }
  for (int round = 0; round < 3 && h < limit; round++) {
    const double longer = fmin(limit, reach(source, from, h));
    h = fmax(h, fmin(longer, reach(source, from, longer)));
  }
  return h;
}

/* The end of the piece that begins at `from`; what is left is cut evenly. */
static double next_end(const compile_source *source, double from, double end, double limit) {
  const double rest = end - from, h = step_within(source, from, fmin(rest, limit));
  const double pieces = ceil(rest / h * (1.0 - 1e-9));
  return pieces > 1.0 ? from + rest / pieces : end;
}

/* ---- pieces ---- */

static double larger_norm(const compile_jet *a, const compile_jet *b, int k) {
  return sqrt(fmax(vec_norm2(a->d[k]), vec_norm2(b->d[k])));
}

/* The quintic with the given values and derivatives at both ends, the constant added; returns its largest |point|. */
static double hermite(const compile_jet *at0, const compile_jet *at1, double h, vec3 constant, vec3 *bezier) {
  const double first = 0.4 * h, second = h * h / 20.0;
  bezier[0] = at0->d[0];
  bezier[1] = vec_axpy(at0->d[0], 0.5 * first, at0->d[1]);
  bezier[2] = vec_axpy(vec_axpy(at0->d[0], first, at0->d[1]), second, at0->d[2]);
  bezier[3] = vec_axpy(vec_axpy(at1->d[0], -first, at1->d[1]), second, at1->d[2]);
  bezier[4] = vec_axpy(at1->d[0], -0.5 * first, at1->d[1]);
  bezier[5] = at1->d[0];
  double largest = 0.0;
  for (int j = 0; j <= 5; j++) {
    bezier[j] = vec_add(bezier[j], constant);
    largest = fmax(largest, vec_norm2(bezier[j]));
  }
  return sqrt(largest);
}

static double piece_error(const compile_jet *at0, const compile_jet *at1, double h, double sixth, double largest) {
  const double factor[3] = {1.0, 0.4 * h, 0.05 * h * h}, roundings[3] = {2.0, 7.0, 8.0};
  double of_data = 0.0;
  for (int k = 0; k < 3; k++)
    of_data += factor[k] * (fmax(at0->error[k], at1->error[k]) + roundings[k] * ROUND_U * larger_norm(at0, at1, k));
  const double remainder = sixth * (h * h * h) * (h * h * h) / 46080.0;
  return ROUND_UP * (remainder + of_data + ROUND_U * largest) + CURVE_LEAST;
}

static cprox_status evaluate(const compile *c, const compile_source *source, double t, compile_jet *jet) {
  static const char *const name[3] = {"point", "first derivative", "second derivative"};
  source->evaluate(source->self, t, jet);
  for (int k = 0; k < 3; k++) {
    const vec3 d = jet->d[k];
    if (!vec_finite(d))
      return workspace_fail(c->workspace, CPROX_INVALID, "at t = %.17g the curve's %s is (%g, %g, %g), not finite", t,
                            name[k], d.x, d.y, d.z);
  }
  return CPROX_OK;
}

/* The middle of a piece is where the remainder is largest, and where a bound of the sixth derivative that is too small
 * shows. */
static cprox_status check_middle(const compile *c, const compile_source *source, double a, double b, const vec3 *bezier,
                                 double error) {
  const double t = 0.5 * a + 0.5 * b;
  compile_jet jet;
  const cprox_status status = evaluate(c, source, t, &jet);
  if (status != CPROX_OK) return status;
  vec3 middle = vec_scale(1.0 / 32.0, vec_add(bezier[0], bezier[5]));
  middle = vec_axpy(middle, 5.0 / 32.0, vec_add(bezier[1], bezier[4]));
  middle = vec_axpy(middle, 10.0 / 32.0, vec_add(bezier[2], bezier[3]));
  const double apart = vec_norm(vec_sub(middle, vec_add(jet.d[0], source->constant)));
  const double size = vec_norm(middle) + vec_norm(source->constant);
  if (apart <= error + jet.error[0] + 32.0 * ROUND_U * size) return CPROX_OK;
  return workspace_fail(
      c->workspace, CPROX_INVALID,
      "at t = %.17g the curve is %.3g m from its quintic, which its bounds allow %.3g: a bound of its "
      "sixth derivative or of its errors is false",
      t, apart, error);
}

static cprox_status append_piece(compile *c, const compile_source *source, double a, double b, const compile_jet *at0,
                                 compile_jet *at1) {
  if (!make_room(c)) return workspace_fail(c->workspace, CPROX_MEMORY, "no memory for a curve of %zu pieces", c->n + 1);
  const double h = b - a;
  vec3 *bezier = c->points + 6 * c->n;
  const cprox_status status = evaluate(c, source, b, at1);
  if (status != CPROX_OK) return status;
  const double largest = hermite(at0, at1, h, source->constant, bezier);
  const double error = piece_error(at0, at1, h, source->sixth(source->self, a, b), largest);
  if (!(largest <= CURVE_LARGEST && error <= CURVE_LARGEST))
    return workspace_fail(c->workspace, CPROX_INVALID, "on [%.15g, %.15g] the curve goes beyond %g m", a, b,
                          CURVE_LARGEST);
  c->error[c->n] = error;
  c->breaks[c->n++] = b;
  return source->doubted ? check_middle(c, source, a, b, bezier, error) : CPROX_OK;
}

static cprox_status append_pieces(compile *c, const compile_source *source, double t0, double t1) {
  compile_jet at0, at1;
  const cprox_status first = evaluate(c, source, t0, &at0);
  if (first != CPROX_OK) return first;
  double limit = t1 - t0;
  const double shortest = 4.0 * ROUND_U * fmax(fabs(t0), fabs(t1));
  for (double a = t0; a < t1;) {
    const double b = next_end(source, a, t1, limit), h = b - a;
    if (b < t1 && !(h > shortest))
      return workspace_fail(c->workspace, CPROX_INVALID,
                            "at t = %.15g the curve needs pieces of %.3g, shorter than the steps of double arithmetic",
                            a, h);
    if (c->n == COMPILE_MOST_PIECES)
      return workspace_fail(c->workspace, CPROX_INVALID,
                            "[%.15g, %.15g] would need more than %d pieces: at t = %.15g they are %.3g long", t0, t1,
                            COMPILE_MOST_PIECES, a, h);
    const cprox_status status = append_piece(c, source, a, b, &at0, &at1);
    if (status != CPROX_OK) return status;
    if (curve_stops(c->n, c->workspace))
      return workspace_fail(c->workspace, CPROX_INVALID, "stopped while a curve was being made, after %zu pieces",
                            c->n);
    at0 = at1;
    a = b;
    limit = 2.0 * h;
  }
  return CPROX_OK;
}

/* ---- the curve ---- */

cprox_status compile_append(compile *c, const compile_source *source, double t0, double t1) {
  if (c->n == 0) c->from = t0;
  const cprox_status status = append_pieces(c, source, t0, t1);
  if (status != CPROX_OK) release_memory(c);
  return status;
}

cprox_status compile_finish(compile *c, cprox_curve **curve) {
  if (c->n == 0) {
    release_memory(c);
    return workspace_fail(c->workspace, CPROX_INVALID, "the curve has no pieces");
  }
  cprox_curve *made = curve_allocate_with(5, c->n, c->beside);
  if (made) {
    made->breaks[0] = c->from;
    memcpy(made->breaks + 1, c->breaks, c->n * sizeof *c->breaks);
    memcpy(made->points, c->points, 6 * c->n * sizeof *c->points);
    memcpy(made->error, c->error, c->n * sizeof *c->error);
  }
  const size_t n = c->n;
  release_memory(c);
  if (!made) return workspace_fail(c->workspace, CPROX_MEMORY, "no memory for a curve of %zu pieces", n);
  return curve_finish(made, c->workspace, curve);
}

cprox_status compile_curve(const compile_source *source, double t0, double t1, cprox_workspace *workspace,
                           cprox_curve **curve) {
  compile c = {.workspace = workspace};
  const cprox_status status = compile_append(&c, source, t0, t1);
  return status == CPROX_OK ? compile_finish(&c, curve) : status;
}
