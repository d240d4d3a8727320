/* SPDX-License-Identifier: BSD-3-Clause */
/* Clipping by half-spaces: closed loops and soups stay closed, so that winding numbers, and with them spectra, stay
 * exact. */
#include <string.h>

#include "fourier/points.h"
#include "fourier/solid.h"

static double beyond(const double plane[4], vec3 p) {
  return plane[0] * p.x + plane[1] * p.y + plane[2] * p.z - plane[3];
}

/* Sutherland-Hodgman on one closed polygon; the new edges lie along the plane. *out_to and *in_from: where it left the
 * half-space and where it came back, the last time each (a triangle does so once). Returns whether it did. */
static bool cut(const vec3 *in, size_t n, const double plane[4], points *out, vec3 *out_to, vec3 *in_from) {
  bool crossed = false;
  for (size_t i = 0; i < n; i++) {
    const vec3 a = in[i], b = in[(i + 1) % n];
    const double da = beyond(plane, a), db = beyond(plane, b);
    if (da <= 0.0) points_add(out, a);
    if ((da <= 0.0) == (db <= 0.0)) continue;
    const vec3 at = vec_lerp(a, b, da / (da - db));
    points_add(out, at);
    *(da <= 0.0 ? out_to : in_from) = at;
    crossed = true;
  }
  return crossed;
}

void clip_loop(points *loop, const double plane[4]) {
  points kept = {.failed = loop->failed};
  vec3 out_to, in_from;
  cut(loop->at, loop->n, plane, &kept, &out_to, &in_from);
  free(loop->at);
  *loop = kept;
}

void clip_soup(points *soup, const double plane[4]) {
  points kept = {.failed = soup->failed}, part = {0};
  bool have_centre = false;
  vec3 centre = vec(0, 0, 0);
  for (size_t i = 0; i + 2 < soup->n; i += 3) {
    vec3 out_to = centre, in_from = centre;
    part.n = 0;
    const bool crossed = cut(soup->at + i, 3, plane, &part, &out_to, &in_from);
    for (size_t j = 1; j + 1 < part.n; j++) points_add_triangle(&kept, part.at[0], part.at[j], part.at[j + 1]);
    if (!crossed) continue;
    /* the cap: a fan from any point of the plane over all cuts, each against the direction of the polygon it closes */
    if (!have_centre) centre = out_to, have_centre = true;
    points_add_triangle(&kept, centre, in_from, out_to);
  }
  kept.failed = kept.failed || part.failed;
  free(part.at);
  free(soup->at);
  *soup = kept;
}

/* Whether another plane of the same direction makes plane i redundant. */
static bool is_hidden(const double (*plane)[4], size_t n, size_t i) {
  const vec3 u = vec(plane[i][0], plane[i][1], plane[i][2]);
  for (size_t j = 0; j < n; j++)
    if (j != i && vec_dot(u, vec(plane[j][0], plane[j][1], plane[j][2])) > 1.0 - 1e-13 &&
        (plane[j][3] < plane[i][3] || (plane[j][3] == plane[i][3] && j < i)))
      return true;
  return false;
}

/* The face of the polytope in plane i: a square of half the side `half` about `middle`, clipped by all other planes. */
static points face_in(const double (*plane)[4], size_t n, size_t i, double grow, vec3 middle, double half) {
  const vec3 u = vec(plane[i][0], plane[i][1], plane[i][2]), other = fabs(u.x) < 0.6 ? vec(1, 0, 0) : vec(0, 1, 0);
  const vec3 across = vec_cross(other, u), v = vec_scale(half / vec_norm(across), across), w = vec_cross(u, v);
  const vec3 foot = vec_axpy(middle, plane[i][3] + grow - vec_dot(u, middle), u);
  points face = {0};
  points_add(&face, vec_add(foot, vec_add(v, w)));
  points_add(&face, vec_add(foot, vec_sub(w, v)));
  points_add(&face, vec_sub(foot, vec_add(v, w)));
  points_add(&face, vec_sub(foot, vec_sub(w, v)));
  for (size_t j = 0; j < n && face.n > 0; j++) {
    const double cutter[4] = {plane[j][0], plane[j][1], plane[j][2], plane[j][3] + grow};
    if (j != i && !is_hidden(plane, n, j)) clip_loop(&face, cutter);
  }
  return face;
}

bool polytope_soup(const double (*plane)[4], size_t n, double grow, vec3 middle, double size, points *soup) {
  for (size_t i = 0; i < n && !soup->failed; i++) {
    if (is_hidden(plane, n, i)) continue;
    points face = face_in(plane, n, i, grow, middle, size);
    soup->failed = soup->failed || face.failed;
    for (size_t j = 0; j < face.n; j++)
      if (vec_norm(vec_sub(face.at[j], middle)) > size) soup->failed = true;
    for (size_t j = 1; j + 1 < face.n; j++) points_add_triangle(soup, face.at[0], face.at[j], face.at[j + 1]);
    free(face.at);
  }
  return !soup->failed;
}
