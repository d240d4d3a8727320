/* SPDX-License-Identifier: BSD-3-Clause */
/* Dubins paths: the shortest curves of bounded curvature between two planar poses, three arcs or lines each. The
 * lengths are those of A. M. Shkel, V. Lumelsky, "Classification of the Dubins set", 2001, in units of the turning
 * radius; the pieces come from heading.c. Where a formula is ill-conditioned (circles that nearly touch) it is so
 * backwards stable: the lengths are those of a path to an end pose that is off by a few roundings. */
#include "base/workspace.h"
#include "curve/heading.h"

#define TWO_PI 6.283185307179586

/* A turn that lacks less than this of a full one is no turn: rounding made it one. */
#define LEAST_TURN 1e-15

/* Circles whose centres are nearer than this, in radii and distances, are one. */
#define LEAST_LENGTH 1e-14

/* The longest path and the largest angle, in radii and radians, whose rounding the turns can bear. */
#define MOST_RADII 1e12
#define MOST_HEADING 1e6

typedef enum turn { TURN_RIGHT = -1, TURN_NONE = 0, TURN_LEFT = 1 } turn;

static const turn turns_of[][3] = {
    [CPROX_DUBINS_LSL] = {TURN_LEFT, TURN_NONE, TURN_LEFT},   [CPROX_DUBINS_LSR] = {TURN_LEFT, TURN_NONE, TURN_RIGHT},
    [CPROX_DUBINS_RSL] = {TURN_RIGHT, TURN_NONE, TURN_LEFT},  [CPROX_DUBINS_RSR] = {TURN_RIGHT, TURN_NONE, TURN_RIGHT},
    [CPROX_DUBINS_RLR] = {TURN_RIGHT, TURN_LEFT, TURN_RIGHT}, [CPROX_DUBINS_LRL] = {TURN_LEFT, TURN_RIGHT, TURN_LEFT},
};

/* An angle in [0, 2 pi), 0 where rounding has made nearly a full turn of it. `size`: of the numbers it came from. */
static double wrap(double radians, double size) {
  const double turned = radians - TWO_PI * floor(radians / TWO_PI);
  return turned >= 0.0 && turned < TWO_PI - LEAST_TURN * (8.0 + size) ? turned : 0.0;
}

/* The poses in units of the radius, the second seen from the first along the line that joins them. */
typedef struct dubins_poses {
  double distance, alpha, beta; /* alpha, beta: the headings against that line */
  double size;                  /* of the angles that entered */
} dubins_poses;

/* The three lengths of a word; false where it cannot join the poses. With the turns s and t of the first and the last
 * arc, the heading after the first one is h, N(h) the normal to its left, and the centres of the circles are C = x + s
 * N, so that C3 - C1 = p T(h) - (s - t) N(h)          for a line of length p, C3 - C1 = 4 sin(p/2) T(h - s p/2) for an
 * arc of p between two arcs of the other turn; the longer one is shortest. */
static bool lengths_of(cprox_dubins_word word, const dubins_poses *p, double length[3]) {
  const double first = turns_of[word][0], middle = turns_of[word][1], last = turns_of[word][2];
  const double across = p->distance + first * sin(p->alpha) - last * sin(p->beta);
  const double up = last * cos(p->beta) - first * cos(p->alpha);
  const double apart = hypot(across, up);
  double heading = atan2(up, across), turned = 0.0;
  if (middle != 0.0) {
    if (apart > 4.0) return false;
    const double half = asin(0.25 * apart);
    length[1] = TWO_PI - 2.0 * half;
    heading += first * (0.5 * TWO_PI - half);
    turned = middle * length[1];
  } else if (first != last) {
    if (apart < 2.0) return false;
    length[1] = sqrt((apart - 2.0) * (apart + 2.0));
    heading += first * atan2(2.0, length[1]);
  } else {
    length[1] = apart;
    /* one circle: which way its centre lies from itself is rounding */
    if (apart <= LEAST_LENGTH * (1.0 + p->distance)) heading = p->alpha, length[1] = 0.0;
  }
  length[0] = wrap(first * (heading - p->alpha), p->size);
  length[2] = wrap(last * (p->beta - heading - turned), p->size);
  return true;
}

/* The word asked for, or the shortest one of all; false where there is none. */
static bool find_lengths(cprox_dubins_word wanted, const dubins_poses *p, cprox_dubins_word *word, double length[3]) {
  double least = INFINITY;
  for (cprox_dubins_word w = CPROX_DUBINS_LSL; w <= CPROX_DUBINS_LRL; w++) {
    double of_word[3];
    if ((wanted != CPROX_DUBINS_SHORTEST && w != wanted) || !lengths_of(w, p, of_word)) continue;
    const double sum = of_word[0] + of_word[1] + of_word[2];
    if (!(sum < least)) continue;
    least = sum;
    *word = w;
    for (int i = 0; i < 3; i++) length[i] = of_word[i];
  }
  return isfinite(least);
}

static cprox_status check_poses(vec3 start, double start_heading, vec3 end, double end_heading, double radius,
                                cprox_workspace *workspace) {
  cprox_status status = curve_check_values("start point", &start, 1, 1, workspace);
  if (status == CPROX_OK) status = curve_check_values("end point", &end, 1, 1, workspace);
  if (status != CPROX_OK) return status;
  if (start.z != end.z)
    return workspace_fail(workspace, CPROX_INVALID, "the path starts at z = %g and ends at z = %g; it is planar",
                          start.z, end.z);
  if (!(fabs(start_heading) <= MOST_HEADING && fabs(end_heading) <= MOST_HEADING))
    return workspace_fail(workspace, CPROX_INVALID, "a heading, %g or %g, is not finite or beyond %g rad",
                          start_heading, end_heading, MOST_HEADING);
  if (!(radius > 0.0 && radius <= CURVE_LARGEST))
    return workspace_fail(workspace, CPROX_INVALID, "the turning radius is %g; it must be above 0 and finite", radius);
  const double distance = hypot(end.x - start.x, end.y - start.y);
  if (!(distance <= MOST_RADII * radius))
    return workspace_fail(workspace, CPROX_INVALID, "the poses are %.3g m apart, more than %g turning radii of %g m",
                          distance, MOST_RADII, radius);
  return CPROX_OK;
}

/* The pieces of the path whose arcs and line end at ends[]. */
static cprox_status compile_path(vec3 start, double heading, double radius, const cprox_dubins_path *path,
                                 cprox_workspace *workspace, cprox_curve **curve) {
  const dd one_turn = dd_divide(dd_from(1.0), dd_from(radius));
  heading_curve c = {.heading = dd_from(heading)};
  compile pieces = {.workspace = workspace, .beside = sizeof *path};
  double from = 0.0;
  for (int i = 0; i < 3; i++) {
    if (!(path->ends[i] > from)) continue;
    c.curvature = dd_scale(one_turn, turns_of[path->word][i]);
    c.origin = from;
    compile_source source = heading_source(&c);
    source.constant = start;
    source.accuracy = HEADING_ACCURACY * path->ends[2] + ROUND_U * vec_norm(start);
    const cprox_status status = compile_append(&pieces, &source, from, path->ends[i]);
    if (status != CPROX_OK) return status;

    /* the next one goes on with the heading that this one ends with */
    double heading_error = 0.0;
    c.heading = heading_at(&c, path->ends[i], &heading_error);
    c.heading_error = heading_error;
    from = path->ends[i];
  }
  return compile_finish(&pieces, curve);
}

bool curve_find_dubins(const cprox_curve_description *d, cprox_dubins_path *path) {
  const double dx = d->end.x - d->start.x, dy = d->end.y - d->start.y, line = atan2(dy, dx);
  const dubins_poses poses = {.distance = hypot(dx, dy) / d->radius,
                              .alpha = d->heading - line,
                              .beta = d->end_heading - line,
                              .size = fabs(d->heading) + fabs(d->end_heading)};
  double length[3] = {0.0, 0.0, 0.0};
  path->word = d->word;
  if (!find_lengths(d->word, &poses, &path->word, length)) return false;
  path->ends[0] = d->radius * length[0];
  path->ends[1] = path->ends[0] + d->radius * length[1];
  path->ends[2] = path->ends[1] + d->radius * length[2];
  return true;
}

int curve_dubins_turn(cprox_dubins_word word, int i) {
  return turns_of[word][i];
}

cprox_status curve_create_dubins(const cprox_curve_description *d, cprox_workspace *workspace, cprox_curve **curve) {
  const cprox_vec3 start = d->start, end = d->end;
  const double start_heading = d->heading, end_heading = d->end_heading, radius = d->radius;
  const cprox_dubins_word word = d->word;
  if (word < CPROX_DUBINS_SHORTEST || word > CPROX_DUBINS_LRL)
    return workspace_fail(workspace, CPROX_INVALID, "%d is no word of a Dubins path", (int)word);
  const cprox_status status = check_poses(start, start_heading, end, end_heading, radius, workspace);
  if (status != CPROX_OK) return status;

  cprox_dubins_path found;
  if (!curve_find_dubins(d, &found))
    return workspace_fail(workspace, CPROX_INVALID, "the poses are too %s for a path of this word",
                          turns_of[word][1] == TURN_NONE ? "near each other" : "far apart");
  if (!(found.ends[2] > 0.0))
    return workspace_fail(workspace, CPROX_INVALID, "start and end pose are the same: the path has no length");

  const cprox_status made = compile_path(start, start_heading, radius, &found, workspace, curve);
  if (made == CPROX_OK) *(cprox_dubins_path *)curve_room(*curve) = found;
  return made;
}
