/* SPDX-License-Identifier: BSD-3-Clause */
/* A certificate for an answer: which sets there are, how precisely normals are written, how tight a claim can be
 * proven. */
#include "certificate/write.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "certificate/describe.h"
#include "certificate/partition.h"
#include "curve/relative_curve.h"
#include "kinematics/motion.h"
#include "problem/carried_shape.h"
#include "problem/obstacles.h"
#include "problem/radius.h"
#include "problem/validate.h"
#include "solve/solve.h"

/* Parts shorter than this, relative to a piece, are given up: normals in single precision are for claims with room. */
#define SHORTEST_SINGLE 0x1p-12
#define SHORTEST_DOUBLE 0x1p-50

/* By how much a claim that is too tight is lowered, in roundings of the sizes. */
#define LOWERED 64.0

/* Claims about the time before contact end some steps before it: the first one in pieces, and how they grow. */
#define FINEST_STEP 0x1p-36
#define STEPS_BACK 16.0

typedef struct task {
  const cprox_mover *mover;
  const cprox_obstacle *obstacles;
  size_t n;
  claim_wanted wanted;
  double delta;
  const cprox_result *answer;
  const cprox_options *options;
  uint32_t budget;
  double epsilon;   /* what a distance may give away */
  cprox_curve like; /* n_pieces 0, or its breaks are those of all that is on the mover's clock */
  cprox_workspace *workspace;
  cprox_certificate *certificate;
} task;

/* The counting parameter at t. */
static double count_at(const cprox_curve *curve, double t) {
  size_t piece = 0;
  while (piece + 1 < curve->n_pieces && curve->breaks[piece + 1] <= t) piece++;
  const double t0 = curve->breaks[piece], t1 = curve->breaks[piece + 1];
  return (double)piece + fmin(fmax((t - t0) / (t1 - t0), 0.0), 1.0);
}

/* The least double that is not below the sum of two that are not negative. */
static double sum_up(double a, double b) {
  const dd sum = dd_sum(a, b);
  return sum.low > 0.0 ? nextafter(sum.high, INFINITY) : sum.high;
}

/* ---- one parameter for all that moves ---- */

static bool is_on_clock(const task *t) {
  bool is_so = t->mover->radius_curve != NULL;
  for (size_t i = 0; i < t->n; i++) is_so = is_so || t->obstacles[i].synchronized || t->obstacles[i].radius_curve;
  return is_so;
}

static int compare_numbers(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Every joint of a curve that is on the clock, of the mover and of all obstacles, begins a piece; false where memory is
 * out. */
static bool gather_breaks(const task *t, cprox_curve *like) {
  size_t n = 0;
  double *breaks = NULL;
  for (size_t i = 0; i <= t->n; i++) {
    const bool own = i == t->n;
    const cprox_curve *of[2] = {own                            ? t->mover->curve
                                : t->obstacles[i].synchronized ? t->obstacles[i].curve
                                                               : NULL,
                                own ? t->mover->radius_curve : t->obstacles[i].radius_curve};
    for (int k = 0; k < 2; k++) {
      if (!of[k]) continue;
      breaks = workspace_reserve(t->workspace, WORKSPACE_COVER_ITEMS, (n + of[k]->n_pieces + 1) * sizeof *breaks);
      if (!breaks) return false;
      for (size_t j = 0; j <= of[k]->n_pieces; j++) breaks[n++] = of[k]->breaks[j];
    }
  }
  qsort(breaks, n, sizeof *breaks, compare_numbers);
  size_t kept = 1;
  for (size_t j = 1; j < n; j++)
    if (breaks[j] > breaks[kept - 1]) breaks[kept++] = breaks[j];
  *like = (cprox_curve){.n_pieces = (uint32_t)(kept - 1), .degree = 1, .breaks = breaks};
  return true;
}

/* The curve whose x is what both radii add; NULL: nothing, or memory is out. */
static const cprox_curve *radius_of(const task *t, const cprox_obstacle *at, cprox_curve *sum) {
  static const cprox_pose HALF_TURN = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}};
  const cprox_curve *own = t->mover->radius_curve, *other = at->radius_curve;
  if (!own || !other) return own ? own : other;
  const double from = t->like.breaks[0], to = t->like.breaks[t->like.n_pieces];
  return relative_create(own, other, &HALF_TURN, from, to, t->workspace, WORKSPACE_RADII, sum) ? sum : NULL;
}

/* The curve as it is seen from what rides, and the radius, with the pieces of all; false where memory is out. */
static bool put_on_clock(const task *t, const cprox_obstacle *at, cover *c) {
  cprox_curve relative, sum, like = t->like;
  const double from = like.breaks[0], to = like.breaks[like.n_pieces];
  const cprox_curve *seen = t->mover->curve;
  if (at->synchronized) {
    if (!relative_create(seen, at->curve, &at->pose, from, to, t->workspace, WORKSPACE_RELATIVE, &relative))
      return false;
    seen = &relative;
  }
  const bool grows = t->mover->radius_curve || at->radius_curve;
  const cprox_curve *radius = radius_of(t, at, &sum);
  if (grows && !radius) return false;
  if (seen->degree > like.degree) like.degree = seen->degree;
  if (radius && radius->degree > like.degree) like.degree = radius->degree;
  c->curve = &c->made[0];
  if (!relative_align(seen, &like, from, to, t->workspace, WORKSPACE_ALIGNED, &c->made[0])) return false;
  if (!radius) return true;
  c->radius = &c->made[1];
  return relative_align(radius, &like, from, to, t->workspace, WORKSPACE_ALIGNED_RADII, &c->made[1]);
}

/* The pieces that certificates count. */
static const cprox_curve *pieces_of(const task *t) {
  return t->like.n_pieces > 0 ? &t->like : t->mover->curve;
}

/* ---- covers ---- */

/* The part of what the mover carries, and the two as one shape; false where a support function misbehaved. */
static bool carry(const cprox_body *whole, size_t part, cover *c) {
  if (!whole) return true;
  const bool compound = whole->kind == CPROX_BODY_COMPOUND;
  c->carried = (reach_set){.body = body_part_at(whole, part), .poses = compound};
  if (compound) c->carried.pose[0] = &whole->parts[part].pose;
  c->set.carried = &c->carried;
  if (!c->set.body || c->set.body->tree) return true;
  const cprox_pose *own = compound ? c->carried.pose[0] : &CPROX_POSE_IDENTITY;
  return carried_shape_join(c->set.body, &c->pose, c->carried.body, own, &c->joined);
}

/* A part of an obstacle and one of what is carried. */
typedef struct section_place {
  size_t obstacle, part, load;
} section_place;

/* The set that part of an obstacle is, with the mover's ball, and what the answer knows of it; false where memory is
 * out. */
static bool cover_begin(const task *t, section_place of, uint32_t width, cover *c) {
  const cprox_obstacle *at = &t->obstacles[of.obstacle];
  *c = (cover){.curve = t->mover->curve,
               .set = {.body = at->body, .curve = at->synchronized ? NULL : at->curve, .poses = 1},
               .outer = at->pose,
               .witness = -1.0,
               .witness_on_set = -1.0,
               .budget = t->budget,
               .shortest = width == 4 ? SHORTEST_SINGLE : SHORTEST_DOUBLE,
               .workspace = t->workspace,
               .certificate = t->certificate};
  if (at->synchronized) c->outer.position = vec(0, 0, 0);
  if (at->synchronized && !at->body) c->set.body = &carried_point;
  c->pose = c->outer;
  c->set.pose[0] = &c->outer;
  c->set.offset = sum_up(t->mover->radius, at->margin);
  if (at->body && at->body->kind == CPROX_BODY_COMPOUND) {
    const body_part *inner = &at->body->parts[of.part];
    c->set.body = inner->body;
    c->set.pose[1] = &inner->pose;
    c->set.poses = 2;
    c->pose = frame_compose(&c->outer, &inner->pose);
  }
  const cprox_body *elements = elements_body(c->set.body);
  if (elements) {
    c->set.offset = sum_up(c->set.offset, elements->shape.margin);
    c->set.body = elements;
  }
  if (t->like.n_pieces > 0 && !put_on_clock(t, at, c)) return false;
  c->until = (double)c->curve->n_pieces;
  const cprox_result *r = t->answer;
  const bool found = r && r->obstacle_index == (int32_t)of.obstacle && r->obstacle_part == (int32_t)of.part;
  if (found && isfinite(r->t) && (!t->mover->body || r->mover_part == (int32_t)of.load)) {
    c->witness = count_at(c->curve, r->t);
    if (c->set.curve && isfinite(r->t_obstacle)) c->witness_on_set = count_at(c->set.curve, r->t_obstacle);
    c->normal = r->normal;
  }
  return carry(t->mover->body, of.load, c);
}

/* Those that the answer names. */
static section_place nearest_section(const task *t) {
  const cprox_result *r = t->answer;
  return (section_place){(size_t)r->obstacle_index, (size_t)r->obstacle_part,
                         t->mover->body ? (size_t)r->mover_part : 0};
}

/* The number of parts of all obstacles before one. */
static size_t sections_before(const task *t, size_t obstacle) {
  size_t sections = 0;
  for (size_t i = 0; i < obstacle; i++) sections += body_n_parts(t->obstacles[i].body);
  return sections;
}

static double size_of(const cprox_curve *curve, vec3 centre) {
  double size = 0.0;
  for (size_t i = 0; i < curve->n_pieces * (curve->degree + 1); i++)
    size = fmax(size, vec_norm2(vec_sub(curve->points[i], centre)));
  return sqrt(size);
}

/* What the rounding of the search is relative to, for the nearest obstacle. */
static double size_of_problem(const task *t, const cover *c) {
  const double of_set = c->set.curve ? size_of(c->set.curve, c->set.curve->points[0]) : c->set.body->shape.scale;
  const double carried = c->carried.body ? c->carried.body->shape.scale : 0.0;
  const double grown = c->radius ? c->radius->largest : 0.0;
  return size_of(c->curve, c->pose.position) + of_set + carried + grown + c->set.offset + t->delta;
}

static cprox_status attempt_section(const task *t, section_place of, uint32_t width, double delta, reach_part part) {
  cover c;
  if (!cover_begin(t, of, width, &c)) return CPROX_MEMORY;
  c.delta = delta;
  c.from = part.from, c.until = part.to;
  const bool has_elements = c.set.body && c.set.body->tree;
  return c.set.curve ? partition_curves(&c) : has_elements ? partition_elements(&c) : partition_convex(&c);
}

/* One attempt: the whole certificate, with normals of the width; of a part of the curve, unless all is claimed. */
static cprox_status attempt(const task *t, uint32_t width, double delta, reach_part part) {
  const size_t loads = body_n_parts(t->mover->body), sections = loads * sections_before(t, t->n);
  const cprox_claim claim = t->wanted.apart;
  certificate_begin(t->certificate, width, claim, delta, (uint32_t)sections);
  if (claim == CPROX_CLAIM_DURING) certificate_number(t->certificate, part.from);
  if (claim != CPROX_CLAIM_APART) certificate_number(t->certificate, part.to);
  certificate_breaks(t->certificate, pieces_of(t)->breaks, pieces_of(t)->n_pieces);
  section_place of = {0, 0, 0};
  for (of.load = 0; of.load < loads; of.load++)
    for (of.obstacle = 0; of.obstacle < t->n; of.obstacle++)
      for (of.part = 0; of.part < body_n_parts(t->obstacles[of.obstacle].body); of.part++) {
        const cprox_status status = attempt_section(t, of, width, delta, part);
        if (status != CPROX_OK) return status;
      }
  return t->certificate->failed ? CPROX_MEMORY : CPROX_OK;
}

/* Is the claim the lower bound of a distance? A verdict's limit may not be lowered but for rounding. */
static bool is_of_distance(const task *t) {
  return t->answer && t->answer->verdict == CPROX_VERDICT_UNDECIDED && t->delta == t->answer->lower;
}

static cprox_status certify_clear(const task *t, reach_part part) {
  cprox_status status = attempt(t, 4, t->delta, part);
  if (status > 0) status = attempt(t, 8, t->delta, part);
  if (status <= 0 || !t->answer || t->answer->obstacle_index < 0) return status;

  /* the search's own bounds, which know tangent balls, may be tighter than planes can be */
  cover c;
  if (!cover_begin(t, nearest_section(t), 8, &c)) return CPROX_MEMORY;
  const double moved = c.radius ? curve_error(c.curve) + curve_error(c.radius) : curve_error(c.curve);
  const double rounding = LOWERED * ROUND_U * size_of_problem(t, &c) + 2.0 * moved;
  if (t->delta > rounding) status = attempt(t, 8, t->delta - rounding, part);
  const double given = fmax(t->epsilon, LOWERED * rounding);
  if (status > 0 && is_of_distance(t) && t->delta > given) status = attempt(t, 8, t->delta - given, part);
  return status;
}

/* How far before the time it must end, and after the one where it begins, is found by steps, each larger than the one
 * before. */
static cprox_status certify_part(const task *t) {
  const bool begins = t->wanted.apart == CPROX_CLAIM_DURING;
  const double begin = begins ? count_at(pieces_of(t), t->wanted.t0) : 0.0;
  const double end = count_at(pieces_of(t), t->wanted.t1);
  const bool whole_end = begins && end == (double)pieces_of(t)->n_pieces;
  if (begins && is_of_distance(t)) return certify_clear(t, (reach_part){begin, end});
  cprox_status status = CPROX_PRECISION;
  for (double back = 0.0; status > 0; back = fmax(STEPS_BACK * back, FINEST_STEP)) {
    const double to = whole_end && back == 0.0 ? end : nextafter(end - back, 0.0);
    const reach_part part = {begins ? begin + back : 0.0, to};
    if (!(part.to > part.from) || (begins && back > CLAIM_MOST_BACK)) return CPROX_PRECISION;
    status = attempt(t, 4, t->delta, part);
    if (status > 0) status = attempt(t, 8, t->delta, part);
  }
  return status;
}

/* The witness of the answer, or none. */
static cprox_status certify_near(const task *t) {
  const cprox_result *r = t->answer;
  if (r->obstacle_index < 0 || (size_t)r->obstacle_index >= t->n || !isfinite(r->t)) return CPROX_PRECISION;
  const section_place of = nearest_section(t);
  const size_t section = sections_before(t, of.obstacle) + of.part + of.load * sections_before(t, t->n);
  cover c;
  if (!cover_begin(t, of, 8, &c)) return CPROX_MEMORY;
  c.delta = t->delta;
  certificate_begin(t->certificate, 8, CPROX_CLAIM_NEAR, t->delta, 1);
  const vec3 carrier = partition_point(t->mover->curve, count_at(t->mover->curve, r->t));
  const double radius = t->mover->radius + radius_at(t->mover->radius_curve, r->t, false, t->workspace);
  return cover_near(&c, (uint32_t)section, r, carrier, radius);
}

/* CPROX_OK, or what it is that certificates do not know. */
static cprox_status check_kinds(const task *t) {
  const cprox_mover *mover = t->mover;
  const cprox_body *odd = mover->body ? describe_unknown_kind(mover->body) : NULL;
  if (!odd && mover->body && describe_has_mesh(mover->body)) odd = mover->body;
  if (odd)
    return workspace_fail(t->workspace, CPROX_INVALID, "what is carried is of a kind that has no certificates: %s",
                          cprox_body_kind_name(odd->kind));
  if (mover->curve->arcs)
    return workspace_fail(t->workspace, CPROX_INVALID, "curves known by their arc length have no certificates");
  for (size_t i = 0; i < t->n; i++) {
    const cprox_obstacle *obstacle = &t->obstacles[i];
    if (obstacle->curve && obstacle->curve->arcs)
      return workspace_fail(t->workspace, CPROX_INVALID,
                            "obstacle %zu is known by its arc length alone: it has no certificates", i);
    if (obstacle->body && describe_unknown_obstacle(obstacle->body))
      return workspace_fail(t->workspace, CPROX_INVALID, "obstacle %zu is of a kind that has no certificates: %s", i,
                            cprox_body_kind_name(describe_unknown_obstacle(obstacle->body)->kind));
    for (size_t k = 0; k < body_n_parts(obstacle->body) && obstacle->synchronized && obstacle->body; k++) {
      const cprox_body *elements = elements_body(body_part_at(obstacle->body, k));
      if (elements && elements->winding)
        return workspace_fail(t->workspace, CPROX_INVALID,
                              "obstacle %zu is a closed mesh that moves: it has no certificates", i);
    }
  }
  return CPROX_OK;
}

static cprox_status certify_curve(const task *of) {
  task own = *of, *t = &own;
  const cprox_status known = check_kinds(t);
  if (known != CPROX_OK) return known;
  if (is_on_clock(t) && !gather_breaks(t, &t->like)) return CPROX_MEMORY;
  const reach_part all = {0.0, (double)pieces_of(t)->n_pieces};
  if (t->wanted.apart != CPROX_CLAIM_APART) return certify_part(t);
  if (!t->answer || t->answer->upper > t->delta) return certify_clear(t, all);
  const cprox_status status = certify_near(t);
  if (status == CPROX_OK || status == CPROX_MEMORY || !is_of_distance(t) || !(t->delta > 0.0)) return status;
  return certify_clear(t, all); /* a distance that is known exactly: it is no less, either */
}

static cprox_status prove(const task *t) {
  if (!t->mover->motion) return certify_curve(t);
  claim_wanted wanted = t->wanted;
  wanted.delta = t->delta;
  return certify_robot(t->mover, t->obstacles, t->n, wanted, t->answer, t->options, t->workspace, t->certificate);
}

/* ---- links that are meshes ---- */

/* Links that are meshes stand there by their hulls. */
static bool has_hulls(const task *t) {
  bool found = false;
  const cprox_robot *robot = t->mover->motion ? t->mover->motion->robot : NULL;
  for (size_t i = 0; robot && i < robot->n_geometries && !found; i++)
    found = describe_has_mesh(robot->given_geometries[i].body);
  return found;
}

/* What the hulls of links can prove of a distance: that the hulls are as far apart as they are. */
static cprox_status prove_of_hulls(const task *t) {
  cprox_options options = *t->options;
  options.max_lod = CPROX_LOD_HULL;
  options.signed_distance = false;
  query q = query_create(*t->mover, t->obstacles, t->n, -1.0, &options, t->workspace);
  query_ask_whole(&q);
  cprox_result hulls;
  const cprox_status status = solve_query(&q, 0, q.n, INFINITY, &hulls);
  if (status < 0) return status;
  if (!(hulls.lower > 0.0) || !isfinite(hulls.lower)) return CPROX_PRECISION;
  task coarse = *t;
  coarse.answer = &hulls;
  coarse.delta = hulls.lower;
  return prove(&coarse);
}

/* That they are near is proven by itself; its substance follows. Where there is no proof of it, none does. */
static void add_meeting(const task *t) {
  cprox_certificate near = {.bytes = NULL};
  task meeting = *t;
  meeting.wanted.apart = CPROX_CLAIM_APART;
  meeting.delta = fmax(t->answer->upper, 0.0);
  meeting.certificate = &near;
  if (prove(&meeting) == CPROX_OK && near.claim == CPROX_CLAIM_NEAR) {
    certificate_number(t->certificate, near.delta);
    for (size_t i = CERTIFICATE_HEAD; i < near.size; i++) certificate_byte(t->certificate, near.bytes[i]);
  }
  free(near.bytes);
}

static cprox_status certify(const cprox_mover *mover, const cprox_obstacle *obstacles, size_t n, claim_wanted wanted,
                            const cprox_result *answer, const cprox_options *options, cprox_workspace *workspace,
                            cprox_certificate *certificate) {
  const task t = {.mover = mover,
                  .obstacles = obstacles,
                  .n = n,
                  .wanted = wanted,
                  .delta = wanted.delta,
                  .answer = answer,
                  .options = options,
                  .budget = options->max_nodes,
                  .epsilon = answer ? width_allowed(options->epsilon, options->relative_epsilon, answer->upper) : 0.0,
                  .workspace = workspace,
                  .certificate = certificate};
  const double delta = t.delta;
  if (!isfinite(delta)) return workspace_fail(workspace, CPROX_INVALID, "there is nothing to measure");
  cprox_status status = prove(&t);
  if (status == CPROX_OK && wanted.apart == CPROX_CLAIM_BEFORE) add_meeting(&t);
  if (status == CPROX_OK && certificate->failed) status = CPROX_MEMORY;
  const bool whole = wanted.apart == CPROX_CLAIM_APART;
  if (status > 0 && whole && is_of_distance(&t) && delta > 0.0 && has_hulls(&t)) status = prove_of_hulls(&t);
  if (status == CPROX_OK) {
    workspace_clear(workspace);
    return status;
  }
  cprox_certificate_clear(certificate);
  if (status == CPROX_INVALID) return status; /* its reason is told */
  if (status == CPROX_MEMORY) return workspace_fail(workspace, status, "no memory for a certificate");
  if (status == CPROX_BUDGET) return workspace_fail(workspace, status, "max_nodes were not enough for a certificate");
  return workspace_fail(workspace, status,
                        has_hulls(&t) ? "too close to delta for a certificate, which takes links by their convex hulls"
                                      : "too close to delta for a certificate");
}

/* Of a query. That there is no proof changes nothing in the answer. */
static void prove_answer(const query *q, const cprox_result *answer) {
  enum { MESSAGE = 256 };
  char of_answer[MESSAGE], of_proof[MESSAGE];
  snprintf(of_answer, sizeof of_answer, "%s", cprox_workspace_error(q->workspace));
  const double delta = query_wants_verdict(q) ? q->limit
                       : answer->lower > 0.0  ? answer->lower
                                              : fmax(answer->upper, 0.0);
  const cprox_status status = certify(&q->mover, q->obstacles, q->n, (claim_wanted){CPROX_CLAIM_APART, delta, 0.0, 0.0},
                                      answer, &q->options, q->workspace, q->options.certificate);
  snprintf(of_proof, sizeof of_proof, "%s", cprox_workspace_error(q->workspace));
  if (status == CPROX_OK)
    workspace_fail(q->workspace, answer->status, "%s", of_answer);
  else
    workspace_fail(q->workspace, answer->status, "%s%sno certificate: %s", of_answer, *of_answer ? "; " : "", of_proof);
}

cprox_certificate *cprox_certificate_create(void) {
  cprox_certificate *certificate = calloc(1, sizeof *certificate);
  if (certificate) certificate->prove = prove_answer;
  return certificate;
}

/* What both entry points check. */
static cprox_status validate(const cprox_mover *mover, const cprox_obstacles *obstacles, const cprox_options *chosen,
                             cprox_workspace *workspace, cprox_certificate *certificate) {
  workspace_clear(workspace);
  cprox_certificate_clear(certificate);
  const arguments_query asked = {"a certificate for an answer",
                                 ARGUMENTS_RELATIVE | ARGUMENTS_LOD | ARGUMENTS_RADIUS | ARGUMENTS_WHOLE};
  const cprox_status status =
      validate_query(mover, obstacles_list(obstacles), obstacles_count(obstacles), chosen, asked, workspace);
  if (status == CPROX_OK && !certificate)
    return workspace_fail(workspace, CPROX_INVALID, "certificate is NULL: nowhere to put the proof");
  return status;
}

/* The interval of the options, and a claim without one. */
static cprox_status take_interval(const cprox_mover *mover, cprox_options *options, claim_wanted *wanted,
                                  cprox_workspace *workspace) {
  const double *interval = options->interval;
  options->interval = NULL;
  if (!interval || (!mover->motion && !mover->curve)) return CPROX_OK;
  double whole[2];
  if (mover->motion) {
    const cprox_motion_info info = cprox_motion_get_info(mover->motion);
    whole[0] = info.t0, whole[1] = info.t1;
  } else {
    const cprox_curve_info info = cprox_curve_get_info(mover->curve);
    whole[0] = info.t0, whole[1] = info.t1;
  }
  if (!(interval[0] >= whole[0] && interval[1] <= whole[1] && interval[0] < interval[1]))
    return workspace_fail(workspace, CPROX_INVALID,
                          "interval is [%.17g, %.17g], must ascend within the mover's [%.17g, %.17g]", interval[0],
                          interval[1], whole[0], whole[1]);
  wanted->apart = CPROX_CLAIM_DURING;
  wanted->t0 = interval[0], wanted->t1 = interval[1];
  return CPROX_OK;
}

cprox_status cprox_certify(cprox_mover mover, const cprox_obstacles *obstacles, double delta,
                           const cprox_result *answer, const cprox_options *options, cprox_workspace *workspace,
                           cprox_certificate *certificate) {
  WORKSPACE_USE(workspace);
  cprox_options chosen = validate_defaults(options);
  claim_wanted wanted = {CPROX_CLAIM_APART, delta, 0.0, 0.0};
  const double *interval = chosen.interval;
  chosen.interval = NULL;
  cprox_status status = validate(&mover, obstacles, &chosen, workspace, certificate);
  chosen.interval = interval;
  if (status == CPROX_OK) status = validate_delta(delta, workspace);
  if (status == CPROX_OK) status = take_interval(&mover, &chosen, &wanted, workspace);
  if (status != CPROX_OK) return status;
  return certify(&mover, obstacles_list(obstacles), obstacles_count(obstacles), wanted, answer, &chosen, workspace,
                 certificate);
}

cprox_status cprox_certify_contact(cprox_mover mover, const cprox_obstacles *obstacles, const cprox_result *answer,
                                   const cprox_options *options, cprox_workspace *workspace,
                                   cprox_certificate *certificate) {
  WORKSPACE_USE(workspace);
  const cprox_options chosen = validate_defaults(options);
  const cprox_status status = validate(&mover, obstacles, &chosen, workspace, certificate);
  if (status != CPROX_OK) return status;
  if (!answer || answer->status < 0 || isnan(answer->t_contact_lower))
    return workspace_fail(workspace, CPROX_INVALID, "answer is none to the time of contact");
  const bool never = answer->verdict == CPROX_VERDICT_CLEAR;
  const claim_wanted wanted = {never ? CPROX_CLAIM_APART : CPROX_CLAIM_BEFORE, 0.0, 0.0, answer->t_contact_lower};
  return certify(&mover, obstacles_list(obstacles), obstacles_count(obstacles), wanted, answer, &chosen, workspace,
                 certificate);
}
