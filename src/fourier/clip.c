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
