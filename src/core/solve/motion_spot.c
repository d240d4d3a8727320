/* SPDX-License-Identifier: BSD-3-Clause */
#include "solve/motion_spot.h"

#include <math.h>
#include <string.h>

#include "base/workspace.h"
#include "convex/feature.h"
#include "robot_query/refine.h"
#include "solve/gradient_ties.h"

/* Distances are measured as exactly as arithmetic allows. */
static robot_accuracy exactly(const spot_pair *p) {
  return (robot_accuracy){.depth = p->scene->q->is_signed};
}

/* A step along a segment after which the minimum along it is found: the next one would be as much smaller again. */
static const double STILL = 1e-10;

/* In sizes: how far apart two nearest points are that count as two. */
static const double TWO_POINTS = 1e-6;

/* How far apart two normals are that count as two: those of curved sides are known to the root of what depths are. */
static const double TWO_NORMALS = 2e-5;

/* In sizes: by so much the other way out is longer where one is looked at. Its normals at such steps lead to the spot:
 * what is found there may be so far from it, at least, and as a fraction of how far they bend; or they bend by less
 * than that and are continued. Nearest points that jump bend the slopes, by more than that fraction. */
static const double CLEAR_OF_OTHER = 3e-5, SAME_WAY = 1e-6, SAME_WAY_BENT = 0.1, STRAIGHT_WAY = 1e-6,
                    STRAIGHT_SLOPE = 2e-3;

/* Along a segment: the first of five steps downhill, each eight times as long, which together cross a segment. */
static const double FIRST_STEP = 1e-3;

/* In sizes: nearest points that move by less in a turn stay where they are; some units of rounding. */
static const double STANDS_STILL = 1e-15;

/* In radii: how well hulls tell where to begin, how well elements are told apart, and how much farther than the nearest
 * ones of before it is looked, which is ten times that. */
static const double HULLS_KNOWN = 1e-3, ELEMENTS_KNOWN = 1e-9, ELEMENTS_BEYOND = 10.0 * 1e-9;

bool spot_begin(robot_scene *scene, int32_t index, spot_pair *p) {
  const cprox_robot *robot = scene->motion->robot;
  *p = (spot_pair){.scene = scene, .pair = scene->pairs[index], .index = index};
  p->element[0] = p->pair.element[0], p->element[1] = p->pair.element[1];
  p->pair.element[0] = p->pair.element[1] = -1;
  if (p->element[0] >= 0 || p->element[1] >= 0) p->index = robot_scene_add_pair(scene, &p->pair);
  const size_t frames = (robot->n_axes + 1) * sizeof(placement), rows = (robot->n_variables + 1) * sizeof(double);
  char *memory = workspace_reserve(scene->q->workspace, WORKSPACE_ROBOT_SPOT, frames + 4 * rows);
  if (p->index < 0 || !memory) return false;
  p->frames = (placement *)(void *)memory;
  p->values = (double *)(void *)(memory + frames);
  p->rates = p->values + robot->n_variables + 1;
  p->by_variable = p->rates + robot->n_variables + 1;
  p->sum = p->by_variable + robot->n_variables + 1;
  return true;
}

double spot_time(const spot_pair *p, const motion_spot *spot) {
  return motion_time(p->scene->motion, spot->segment, spot->u);
}

/* ---- measuring ---- */

static cprox_status refuse(const spot_pair *p) {
  return workspace_fail(p->scene->q->workspace, CPROX_INVALID, CONVEX_NO_SUPPORT);
}

static cprox_status measure(spot_pair *p, const robot_body *moving, const robot_body *standing, robot_accuracy accuracy,
                            robot_gap *gap) {
  robot_pair_measure(moving, standing, accuracy, gap);
  p->gaps++;
  return gap->support_failed ? refuse(p) : CPROX_OK;
}

/* Both sides at a place of the motion. */
static void place_at(spot_pair *p, size_t segment, double u) {
  robot_scene_enter(p->scene, segment, u, u);
  placed_robot_pair_at(p->scene, p->index, &p->placed);
}

/* Two elements of them. */
static void place_elements(const spot_pair *p, const int32_t element[2], robot_pair *pair, placed_robot_pair *placed) {
  *pair = p->pair;
  pair->element[0] = element[0], pair->element[1] = element[1];
  placed_robot_pair_of(p->scene, pair, placed);
}

static cprox_status measure_elements(spot_pair *p, const int32_t element[2], robot_gap *gap) {
  robot_pair pair;
  placed_robot_pair elements;
  place_elements(p, element, &pair, &elements);
  return measure(p, elements.moving, elements.standing, exactly(p), gap);
}

/* ---- curved sides ---- */

static bool knows_nearest(const robot_body *body) {
  const convex_ops *ops = body->side.shape->ops;
  return (ops->closed_form || ops->kind == CPROX_BODY_POLYTOPE) && ops->kind != CPROX_BODY_HALFSPACE;
}

/* The point of the side's core that is nearest to a point of the world. */
static vec3 nearest_on_core(const robot_body *body, vec3 y) {
  const convex *shape = body->side.shape;
  convex_near near;
  shape->ops->nearest(shape, placement_turn_back(&body->side.at, vec_sub(y, body->side.at.p)), NULL, &near);
  return placement_apply(&body->side.at, vec_axpy(near.point, -shape->margin, near.normal));
}

/* A distance known within e tells the nearest points of curved sides within the root of e. Projecting one onto the
 * other in turns knows them better, where it converges fast. */
static void sharpen(const robot_body *moving, const robot_body *standing, robot_gap *gap) {
  enum { MOST_TURNS = 12 };
  if (gap->n > 0 || !(gap->lower > 0.0) || !knows_nearest(moving) || !knows_nearest(standing)) return;
  vec3 x = vec_axpy(gap->on_moving, moving->side.margin, gap->normal), y = x;
  const double size = moving->radius + standing->radius,
               before = gap->upper + moving->side.margin + standing->side.margin;
  for (int i = 0; i < MOST_TURNS; i++) {
    y = nearest_on_core(standing, x);
    const vec3 next = nearest_on_core(moving, y);
    const double moved = vec_norm(vec_sub(next, x));
    x = next;
    if (!(moved > STANDS_STILL * size)) break;
  }
  const vec3 v = vec_sub(x, y);
  const double distance = vec_norm(v);
  if (!(distance <= before + 4.0 * gap->slack) || !(distance > 0.0)) return;
  gap->normal = vec_scale(1.0 / distance, v);
  gap->on_moving = vec_axpy(x, -moving->side.margin, gap->normal);
  gap->on_standing = vec_axpy(y, standing->side.margin, gap->normal);
}

/* ---- elements ---- */

/* What is nearest of all elements: those that were nearest last say how far it is worth looking. */
static cprox_status measure_trees(spot_pair *p, robot_gap *gap) {
  const robot_body *moving = p->placed.moving, *standing = p->placed.standing;
  const double radii = moving->radius + (robot_body_is_halfspace(standing) ? 0.0 : standing->radius);
  robot_gap hulls;
  cprox_status status = measure(p, moving, standing, (robot_accuracy){.epsilon = HULLS_KNOWN * moving->radius}, &hulls);
  if (status < 0) return status;
  robot_refinement c = {.pair = &p->placed,
                        .reach = fmax(hulls.upper, 0.0) + 4.0 * radii,
                        .accuracy = ELEMENTS_KNOWN * radii,
                        .normal = hulls.upper > 0.0 ? hulls.normal : vec(0, 0, 0)};
  if (p->element[0] >= 0 || p->element[1] >= 0) {
    status = measure_elements(p, p->element, gap);
    if (status < 0) return status;
    c.reach = fmin(c.reach, fmax(gap->upper, 0.0) + ELEMENTS_BEYOND * radii);
  }
  robot_refinement_run(&c);
  p->gaps += c.gaps;
  if (c.support_failed) return refuse(p);
  if (c.nearest.gap.upper < INFINITY) p->element[0] = c.nearest.element[0], p->element[1] = c.nearest.element[1];
  return measure_elements(p, p->element, gap);
}

/* By every variable, at the place that the frames stand for. */
static void differentiate(spot_pair *p, const robot_gap *gap) {
  const cprox_robot *robot = p->scene->motion->robot;
  const int32_t moving = robot->parts[p->pair.moving].axis;
  const int32_t standing = p->pair.self ? robot->parts[p->pair.standing].axis : -1;
  const int32_t common = p->pair.common;
  memset(p->by_variable, 0, robot->n_variables * sizeof *p->by_variable);
  motion_add_gradient(robot, p->values, p->frames, moving, common, gap->normal, gap->on_moving, p->by_variable);
  motion_add_gradient(robot, p->values, p->frames, standing, common, vec_neg(gap->normal), gap->on_standing,
                      p->by_variable);
}

void spot_differentiate(spot_pair *p, const motion_spot *spot) {
  motion_place(p->scene->motion, spot->segment, spot->u, p->values, p->frames);
  differentiate(p, &spot->gap);
  motion_rates(p->scene->motion, spot->segment, spot->u, p->rates);
}

cprox_status spot_measure(spot_pair *p, size_t segment, double u, motion_spot *spot) {
  const cprox_motion *motion = p->scene->motion;
  place_at(p, segment, u);
  const robot_body *moving = p->placed.moving, *standing = p->placed.standing;
  *spot = (motion_spot){.segment = segment, .u = u};
  const bool trees = moving->tree || standing->tree;
  const cprox_status status =
      trees ? measure_trees(p, &spot->gap) : measure(p, moving, standing, exactly(p), &spot->gap);
  if (status < 0) return status;
  if (!trees) sharpen(moving, standing, &spot->gap);
  spot_differentiate(p, spot);
  for (size_t v = 0; v < motion->robot->n_variables; v++) spot->slope += p->by_variable[v] * p->rates[v];
  return CPROX_OK;
}

/* ---- the minimum along the motion ---- */

/* Between left, where the distance falls, and right, where it grows (Illinois): until a step is so small that one of
 * the bracket's ends would be known as well, and is. */
static cprox_status find_root(spot_pair *p, motion_spot left, motion_spot right, motion_spot *at) {
  enum { MOST_STEPS = 100 };
  double fa = left.slope, fb = right.slope;
  int side = 0;
  bool over = false; /* the step before was too small to tell */
  for (int i = 0; i < MOST_STEPS && right.u - left.u > STILL; i++) {
    double next = over || i % 8 == 7 ? 0.5 * (left.u + right.u) : (left.u * fb - right.u * fa) / (fb - fa);
    const bool is_small = !over && i > 0 && fabs(next - at->u) < STILL;
    if (is_small) next = side < 0 ? left.u + 4.0 * STILL : right.u - 4.0 * STILL;
    if (!(next > left.u && next < right.u)) next = 0.5 * (left.u + right.u);
    const cprox_status status = spot_measure(p, left.segment, next, at);
    if (status < 0 || at->slope == 0.0) return status;
    const int now = at->slope < 0.0 ? -1 : 1;
    if (now < 0)
      left = *at, fa = at->slope, fb *= side < 0 ? 0.5 : 1.0;
    else
      right = *at, fb = at->slope, fa *= side > 0 ? 0.5 : 1.0;
    over = is_small && now == side;
    side = now;
    if (is_small && !over) break;
  }
  *at = -left.slope < right.slope ? left : right;
  return CPROX_OK;
}

/* The ends of what is asked about, on one segment. */
static double first_u(const motion_interval *within, size_t segment) {
  return segment == within->first ? within->a : 0.0;
}

static double last_u(const motion_interval *within, size_t segment) {
  return segment + 1 == within->last ? within->b : 1.0;
}

/* On the segment of the spot: *beyond is -1 or 1 where the distance falls out of its beginning or its end. */
static cprox_status refine_on_segment(spot_pair *p, double low, double high, motion_spot *spot, int *beyond,
                                      bool *found) {
  *beyond = 0;
  *found = false;
  enum { MOST_STEPS = 5 };
  motion_spot near = *spot;
  double step = FIRST_STEP;
  for (int i = 0; i < MOST_STEPS; i++, step *= 8.0) {
    /* downhill; from where it is flat forwards, but from the end, where a motion may rest, backwards */
    const bool backwards = near.slope > 0.0 || (near.slope == 0.0 && near.u >= high);
    const double next = backwards ? fmax(near.u - step, low) : fmin(near.u + step, high);
    motion_spot far;
    const cprox_status status = spot_measure(p, near.segment, next, &far);
    if (status < 0) return status;
    if (near.slope * far.slope < 0.0) {
      *found = true;
      *spot = far;
      return near.slope < 0.0 ? find_root(p, near, far, spot) : find_root(p, far, near, spot);
    }
    if (far.slope == 0.0 && near.slope == 0.0) return CPROX_OK;
    *spot = near = far;
    if (far.slope >= 0.0 && far.u <= low) *beyond = -1;
    if (far.slope <= 0.0 && far.u >= high) *beyond = 1;
    if (*beyond != 0) return CPROX_OK;
  }
  return CPROX_OK;
}

/* A motion that rests at an end of what is asked about has its minimum there where the slopes beside it are rounding.
 */
static cprox_status snap_to_end(spot_pair *p, const motion_interval *within, motion_spot *spot) {
  const double first = first_u(within, spot->segment), last = last_u(within, spot->segment);
  const bool begins = spot->segment == within->first && spot->u != first && spot->u - first <= STILL,
             ends = spot->segment + 1 == within->last && spot->u != last && last - spot->u <= STILL;
  if (!begins && !ends) return CPROX_OK;
  motion_spot end;
  const cprox_status status = spot_measure(p, spot->segment, begins ? first : last, &end);
  if (status < 0) return status;
  if (end.gap.lower <= spot->gap.upper) *spot = end;
  return CPROX_OK;
}

cprox_status spot_refine(spot_pair *p, const motion_interval *within, motion_spot *spot, bool *found) {
  enum { MOST_SEGMENTS = 4 };
  *found = false;
  for (int i = 0; i < MOST_SEGMENTS; i++) {
    const size_t segment = spot->segment;
    int beyond;
    cprox_status status = refine_on_segment(p, first_u(within, segment), last_u(within, segment), spot, &beyond, found);
    if (status >= 0 && *found) return snap_to_end(p, within, spot);
    if (status < 0 || beyond == 0) return status;
    /* an end, or a knot with the next segment behind it */
    *found = beyond < 0 ? segment == within->first : segment + 1 == within->last;
    if (*found) return CPROX_OK;
    motion_spot next;
    status = spot_measure(p, beyond < 0 ? segment - 1 : segment + 1, beyond < 0 ? 1.0 : 0.0, &next);
    if (status < 0) return status;
    *found = beyond < 0 ? next.slope <= 0.0 : next.slope >= 0.0;
    *spot = next;
    if (*found) return CPROX_OK;
  }
  return CPROX_OK;
}

/* ---- nearest points ---- */

static bool is_round(const robot_body *body) {
  const cprox_body_kind kind = body->side.shape->ops->kind;
  return kind == CPROX_BODY_POINT || kind == CPROX_BODY_SPHERE;
}

/* The side turned about a point of the world by the small vector w. */
static robot_body turned_about(const robot_body *side, vec3 centre, vec3 w) {
  robot_body turned = *side;
  const double angle2 = vec_norm2(w);
  const vec3 from = vec_sub(side->side.at.p, centre);
  /* Rodrigues to the fourth power of the angle */
  const double s = 1.0 - angle2 / 6.0, c = 0.5 - angle2 / 24.0;
  vec3 v[4] = {from};
  const double *r = side->side.at.r;
  for (int k = 0; k < 3; k++) v[k + 1] = vec(r[k], r[3 + k], r[6 + k]);
  for (int k = 0; k < 4; k++) {
    const vec3 once = vec_cross(w, v[k]), twice = vec_cross(w, once);
    v[k] = vec_axpy(vec_axpy(v[k], s, once), c, twice);
  }
  turned.side.at.p = vec_add(centre, v[0]);
  for (int k = 0; k < 3; k++)
    turned.side.at.r[k] = v[k + 1].x, turned.side.at.r[3 + k] = v[k + 1].y, turned.side.at.r[6 + k] = v[k + 1].z;
  return turned;
}

/* How far apart the nearest points are when the standing side has turned to one side and to the other. */
static cprox_status spread_of(spot_pair *p, const robot_body *moving, const robot_body *standing, const robot_gap *here,
                              double turn, double *spread) {
  vec3 axis[2];
  feature_tangents(here->normal, &axis[0], &axis[1]);
  *spread = 0.0;
  for (int i = 0; i < 2; i++) {
    robot_gap seen[2];
    for (int k = 0; k < 2; k++) {
      const robot_body turned = turned_about(standing, here->on_standing, vec_scale(k ? turn : -turn, axis[i]));
      const cprox_status status = measure(p, moving, &turned, exactly(p), &seen[k]);
      if (status < 0) return status;
    }
    *spread = fmax(vec_norm(vec_sub(seen[1].on_moving, seen[0].on_moving)), *spread);
  }
  return CPROX_OK;
}

/* Of the larger side: a point in a body has a depth, too. */
static double depth_size(const robot_body *moving, const robot_body *standing) {
  return robot_body_is_halfspace(standing) ? moving->radius : fmax(moving->radius, standing->radius);
}

/* How far apart the ways out are when the moving side has shifted to one side and to the other. */
static cprox_status lean_of(spot_pair *p, const robot_body *moving, const robot_body *standing, double step,
                            double *lean) {
  *lean = 0.0;
  for (int i = 0; i < 3; i++) {
    robot_gap seen[2];
    for (int k = 0; k < 2; k++) {
      robot_body shifted = *moving;
      shifted.side.at.p = vec_axpy(moving->side.at.p, k ? step : -step, vec(i == 0, i == 1, i == 2));
      const cprox_status status = measure(p, &shifted, standing, exactly(p), &seen[k]);
      if (status < 0) return status;
    }
    *lean = fmax(vec_norm(vec_sub(seen[1].normal, seen[0].normal)), *lean);
  }
  return CPROX_OK;
}

/* Two that overlap may have more than one shortest way out. */
static cprox_status way_out_is_alone(spot_pair *p, const robot_body *moving, const robot_body *standing, bool *alone) {
  const double size = depth_size(moving, standing);
  double near, far = 0.0;
  cprox_status status = lean_of(p, moving, standing, TIES_NEAR * size, &near);
  if (status >= 0 && near > TWO_NORMALS) status = lean_of(p, moving, standing, TIES_FAR * size, &far);
  *alone = !ties_is_jump(near, far, TWO_NORMALS);
  return status;
}

/* Two convex sides may be nearest along an edge or a face. */
static cprox_status convex_is_alone(spot_pair *p, const robot_body *moving, const robot_body *standing,
                                    const robot_gap *gap, bool *alone) {
  *alone = true;
  if (vec_norm2(gap->normal) == 0.0) return CPROX_OK;
  const bool halfspace = robot_body_is_halfspace(standing);
  const double size = halfspace ? moving->radius : fmin(moving->radius, standing->radius);
  cprox_status status = CPROX_OK;
  if (gap->upper < 0.0) status = way_out_is_alone(p, moving, standing, alone);
  if (status < 0 || !*alone || is_round(moving) || (!halfspace && is_round(standing))) return status;
  double near, far = 0.0;
  status = spread_of(p, moving, standing, gap, TIES_NEAR, &near);
  if (status >= 0 && near > TWO_POINTS * size) status = spread_of(p, moving, standing, gap, TIES_FAR, &far);
  *alone = !ties_is_jump(near, far, TWO_POINTS * size);
  return status;
}

/* Other elements may be as near, elsewhere. */
static cprox_status elements_are_alone(spot_pair *p, const motion_spot *spot, double size, double apart, bool *alone) {
  robot_refinement c = {.pair = &p->placed,
                        .reach = spot->gap.upper + 2.0 * apart,
                        .room = 2.0 * apart,
                        .accuracy = 0.1 * apart,
                        .listing = true};
  robot_refinement_run(&c);
  p->gaps += c.gaps;
  if (c.support_failed) return refuse(p);
  if (c.no_memory) return workspace_fail(p->scene->q->workspace, CPROX_MEMORY, "no memory for the elements of a mesh");
  *alone = c.complete;
  for (size_t i = 0; i < c.n_found && *alone; i++) {
    robot_gap gap;
    const cprox_status status = measure_elements(p, c.found[i].element, &gap);
    if (status < 0) return status;
    *alone = gap.lower > spot->gap.upper + apart ||
             vec_norm(vec_sub(gap.on_moving, spot->gap.on_moving)) <= TWO_POINTS * size;
  }
  return CPROX_OK;
}

cprox_status spot_is_alone(spot_pair *p, const motion_spot *spot, double apart, bool *alone) {
  place_at(p, spot->segment, spot->u);
  const robot_body *moving = p->placed.moving, *standing = p->placed.standing;
  robot_pair pair;
  placed_robot_pair elements;
  if (moving->tree || standing->tree) {
    const double size = robot_body_is_halfspace(standing) ? moving->radius : fmin(moving->radius, standing->radius);
    const cprox_status status = elements_are_alone(p, spot, size, apart, alone);
    if (status < 0 || !*alone) return status;
    place_elements(p, p->element, &pair, &elements);
    moving = elements.moving, standing = elements.standing;
  }
  return convex_is_alone(p, moving, standing, &spot->gap, alone);
}

/* ---- two ways out ---- */

/* What is known at one, two and three steps is continued to where there was none: a parabola. */
enum { SIDE_PLACES = SPOT_SIDES / 2 };
static const double CONTINUED[SIDE_PLACES] = {3.0, -3.0, 1.0};

/* At u of the spot's segment, where there is one. */
static cprox_status measure_beside(spot_pair *p, const motion_interval *within, const motion_spot *spot, double u,
                                   motion_spot *beside, bool *inside) {
  *inside = u > first_u(within, spot->segment) && u < last_u(within, spot->segment);
  return *inside ? spot_measure(p, spot->segment, u, beside) : CPROX_OK;
}

/* The nearest place on one side of the spot (sign) where the distance rises away from it: two ways out cross between.
 */
static cprox_status step_across(spot_pair *p, const motion_interval *within, const motion_spot *spot, double sign,
                                motion_spot *next, bool *found) {
  enum { MOST_STEPS = 6 };
  double step = 2.0 * STILL;
  for (int i = 0; i < MOST_STEPS; i++, step *= 4.0) {
    const cprox_status status = measure_beside(p, within, spot, spot->u + sign * step, next, found);
    if (status < 0 || !*found || sign * next->slope > 0.0) return status;
  }
  *found = false;
  return CPROX_OK;
}

/* One way out on one side of the spot (sign): a sum of places with these factors; *depth: how long it is at the spot.
 * Where the other is clearly longer, twice and thrice as far, it is the only one. Directly beside the spot what is
 * measured may be neither of the two where they are curved; flat ones are exact there. */
static cprox_status find_side(spot_pair *p, const motion_interval *within, const motion_spot *spot, double apart,
                              double sign, motion_spot side[SIDE_PLACES], double factor[SIDE_PLACES], double *depth,
                              bool *found) {
  const cprox_motion *m = p->scene->motion;
  motion_spot next;
  cprox_status status = step_across(p, within, spot, sign, &next, found);
  if (status < 0 || !*found) return status;
  const robot_body *moving = p->placed.moving, *standing = p->placed.standing;
  const double speed = sign * next.slope * (m->times[spot->segment + 1] - m->times[spot->segment]);
  for (int k = 0; k < SIDE_PLACES && *found; k++) {
    const double step = (k + 1) * CLEAR_OF_OTHER * depth_size(moving, standing) / speed;
    status = measure_beside(p, within, spot, spot->u + sign * step, &side[k], found);
    if (status < 0) return status;
  }
  *found = *found && sign * side[0].slope > 0.0;
  if (*found) status = spot_is_alone(p, &side[0], apart, found);
  if (status < 0 || !*found) return status;

  const vec3 a = side[0].gap.normal, b = side[1].gap.normal, c = side[2].gap.normal;
  const double bend = vec_norm(vec_axpy(vec_add(a, c), -2.0, b));
  const vec3 led = vec_axpy(c, CONTINUED[0], vec_sub(a, b));
  const double slope =
                   CONTINUED[0] * (side[0].slope - side[1].slope) + side[2].slope, /* of the parabola, at the spot */
      bend_of_slope = fabs(side[0].slope - 2.0 * side[1].slope + side[2].slope);
  const vec3 x = side[0].gap.on_moving, y = side[1].gap.on_moving, z = side[2].gap.on_moving;
  const double bend_of_point = vec_norm(vec_axpy(vec_add(x, z), -2.0, y)), size = depth_size(moving, standing);
  const vec3 led_to = vec_axpy(z, CONTINUED[0], vec_sub(x, y));
  const bool is_next =
      vec_norm(vec_sub(next.gap.normal, led)) < fmax(SAME_WAY, SAME_WAY_BENT * bend) &&
      vec_norm(vec_sub(next.gap.on_moving, led_to)) < fmax(SAME_WAY * size, SAME_WAY_BENT * bend_of_point) &&
      fabs(next.slope - slope) < fmax(SAME_WAY * fabs(slope), SAME_WAY_BENT * bend_of_slope);
  *depth = 3.0 * (spot_distance(&side[0]) - spot_distance(&side[1])) + spot_distance(&side[2]);
  for (int k = 0; k < SIDE_PLACES; k++) factor[k] = is_next ? (k == 0) : CONTINUED[k];
  if (is_next) side[0] = next;
  *found = (is_next || (bend < STRAIGHT_WAY && bend_of_point < STRAIGHT_WAY * size)) &&
           bend_of_slope < STRAIGHT_SLOPE * fabs(slope);
  return CPROX_OK;
}

cprox_status spot_find_crossing(spot_pair *p, const motion_interval *within, const motion_spot *spot, double apart,
                                motion_spot side[SPOT_SIDES], double part[SPOT_SIDES], bool *found) {
  *found = true;
  double slope[2] = {0.0, 0.0}, depth[2] = {0.0, 0.0};
  for (int k = 0; k < 2 && *found; k++) {
    motion_spot *of = side + SIDE_PLACES * k;
    double *factor = part + SIDE_PLACES * k;
    const cprox_status status = find_side(p, within, spot, apart, k ? 1.0 : -1.0, of, factor, &depth[k], found);
    if (status < 0) return status;
    for (int i = 0; i < SIDE_PLACES && *found; i++) slope[k] += factor[i] * of[i].slope; /* at the spot */
  }
  *found = *found && slope[0] < 0.0 && slope[1] > 0.0 && fabs(depth[0] - depth[1]) < apart;
  for (int i = 0; i < SPOT_SIDES && *found; i++)
    part[i] *= (i < SIDE_PLACES ? slope[1] : -slope[0]) / (slope[1] - slope[0]);
  return CPROX_OK;
}
