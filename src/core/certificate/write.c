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
#include "kinematics/motion.h"
#include "problem/obstacles.h"
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
  const cprox_obstacle *targets;
  size_t n;
  double delta, before; /* before: INFINITY, or where parameters cease to count */
  const cprox_result *answer;
  const cprox_options *options;
  uint32_t budget;
  double epsilon; /* what a distance may give away */
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

/* The set that part of a target is, with the mover's ball, and what the answer knows of it. */
static cover cover_of(const task *t, size_t target, size_t part, uint32_t width) {
  const cprox_obstacle *at = &t->targets[target];
  cover c = {.curve = t->mover->curve,
             .set = {.body = at->body, .curve = at->curve, .pose = {&at->pose}, .poses = 1},
             .pose = at->pose,
             .until = (double)t->mover->curve->n_pieces,
             .witness = -1.0,
             .witness_on_set = -1.0,
             .budget = t->budget,
             .shortest = width == 4 ? SHORTEST_SINGLE : SHORTEST_DOUBLE,
             .workspace = t->workspace,
             .certificate = t->certificate};
  c.set.offset = sum_up(t->mover->radius, at->margin);
  if (at->body && at->body->kind == CPROX_BODY_COMPOUND) {
    const body_part *inner = &at->body->parts[part];
    c.set.body = inner->body;
    c.set.pose[1] = &inner->pose;
    c.set.poses = 2;
    c.pose = frame_compose(&at->pose, &inner->pose);
  }
  const cprox_body *elements = elements_body(c.set.body);
  if (elements) {
    c.set.offset = sum_up(c.set.offset, elements->shape.margin);
    c.set.body = elements;
  }
  const cprox_result *r = t->answer;
  if (r && r->obstacle_index == (int32_t)target && r->obstacle_part == (int32_t)part && isfinite(r->t)) {
    c.witness = count_at(c.curve, r->t);
    if (at->curve && isfinite(r->t_obstacle)) c.witness_on_set = count_at(at->curve, r->t_obstacle);
    c.normal = r->normal;
  }
  return c;
}

static double size_of(const cprox_curve *curve, vec3 centre) {
  double size = 0.0;
  for (size_t i = 0; i < curve->n_pieces * (curve->degree + 1); i++)
    size = fmax(size, vec_norm2(vec_sub(curve->points[i], centre)));
  return sqrt(size);
}

/* What the rounding of the search is relative to, for the nearest target. */
static double size_of_problem(const task *t, const cover *c) {
  const double of_set = c->set.curve ? size_of(c->set.curve, c->set.curve->points[0]) : c->set.body->shape.scale;
  return size_of(c->curve, c->pose.position) + of_set + c->set.offset + t->delta;
}

/* One attempt: the whole certificate, with normals of the width. until: 0, or where a claim about a part ends. */
static cprox_status attempt(const task *t, uint32_t width, double delta, double until) {
  size_t sections = 0;
  for (size_t i = 0; i < t->n; i++) sections += body_n_parts(t->targets[i].body);
  const cprox_claim claim = until > 0.0 ? CPROX_CLAIM_BEFORE : CPROX_CLAIM_APART;
  certificate_begin(t->certificate, width, claim, delta, (uint32_t)sections);
  if (until > 0.0) certificate_number(t->certificate, until);
  certificate_breaks(t->certificate, t->mover->curve->breaks, t->mover->curve->n_pieces);
  for (size_t i = 0; i < t->n; i++) {
    for (size_t part = 0; part < body_n_parts(t->targets[i].body); part++) {
      cover c = cover_of(t, i, part, width);
      c.delta = delta;
      if (until > 0.0) c.until = until;
      const bool has_elements = c.set.body && c.set.body->tree;
      const cprox_status status = c.set.curve    ? partition_curves(&c)
                                  : has_elements ? partition_elements(&c)
                                                 : partition_convex(&c);
      if (status != CPROX_OK) return status;
    }
  }
  return t->certificate->failed ? CPROX_MEMORY : CPROX_OK;
}

/* Is the claim the lower bound of a distance? A verdict's limit may not be lowered but for rounding. */
static bool is_of_distance(const task *t) {
  return t->answer && t->answer->verdict == CPROX_VERDICT_UNDECIDED && t->delta == t->answer->lower;
}

static cprox_status certify_clear(const task *t) {
  cprox_status status = attempt(t, 4, t->delta, 0.0);
  if (status > 0) status = attempt(t, 8, t->delta, 0.0);
  if (status <= 0 || !t->answer || t->answer->obstacle_index < 0) return status;

  /* the search's own bounds, which know tangent balls, may be tighter than planes can be */
  const cover c = cover_of(t, (size_t)t->answer->obstacle_index, (size_t)t->answer->obstacle_part, 8);
  const double rounding = LOWERED * ROUND_U * size_of_problem(t, &c);
  if (t->delta > rounding) status = attempt(t, 8, t->delta - rounding, 0.0);
  const double given = fmax(t->epsilon, LOWERED * rounding);
  if (status > 0 && is_of_distance(t) && t->delta > given) status = attempt(t, 8, t->delta - given, 0.0);
  return status;
}

/* How far before the time it must end is found by steps back from it, each larger than the one before. */
static cprox_status certify_before(const task *t) {
  const double end = count_at(t->mover->curve, t->before);
  cprox_status status = CPROX_PRECISION;
  for (double back = 0.0; status > 0; back = fmax(STEPS_BACK * back, FINEST_STEP)) {
    const double until = nextafter(end - back, 0.0);
    if (!(until > 0.0)) return CPROX_PRECISION;
    status = attempt(t, 4, t->delta, until);
    if (status > 0) status = attempt(t, 8, t->delta, until);
  }
  return status;
}

/* The witness of the answer, or none. */
static cprox_status certify_near(const task *t) {
  const cprox_result *r = t->answer;
  if (r->obstacle_index < 0 || (size_t)r->obstacle_index >= t->n || !isfinite(r->t)) return CPROX_PRECISION;
  size_t section = (size_t)r->obstacle_part;
  for (size_t i = 0; i < (size_t)r->obstacle_index; i++) section += body_n_parts(t->targets[i].body);
  cover c = cover_of(t, (size_t)r->obstacle_index, (size_t)r->obstacle_part, 8);
  c.delta = t->delta;
  certificate_begin(t->certificate, 8, CPROX_CLAIM_NEAR, t->delta, 1);
  return cover_near(&c, (uint32_t)section, r);
}

static cprox_status certify_curve(const task *t) {
  const cprox_mover *mover = t->mover;
  if (mover->body || !mover->curve)
    return workspace_fail(t->workspace, CPROX_INVALID, "bodies that move have no certificates");
  if (mover->curve->arcs)
    return workspace_fail(t->workspace, CPROX_INVALID, "curves known by their arc length have no certificates");
  for (size_t i = 0; i < t->n; i++) {
    const cprox_obstacle *target = &t->targets[i];
    if (target->synchronized)
      return workspace_fail(t->workspace, CPROX_INVALID, "obstacle %zu is on the mover's clock: it has no certificates",
                            i);
    if (!target->body && target->curve->arcs)
      return workspace_fail(t->workspace, CPROX_INVALID,
                            "obstacle %zu is known by its arc length alone: it has no certificates", i);
    if (target->body && describe_unknown_obstacle(target->body))
      return workspace_fail(t->workspace, CPROX_INVALID, "obstacle %zu is of a kind that has no certificates: %s", i,
                            cprox_body_kind_name(describe_unknown_obstacle(target->body)->kind));
  }
  if (isfinite(t->before)) return certify_before(t);
  if (!t->answer || t->answer->upper > t->delta) return certify_clear(t);
  const cprox_status status = certify_near(t);
  if (status == CPROX_OK || status == CPROX_MEMORY || !is_of_distance(t) || !(t->delta > 0.0)) return status;
  return certify_clear(t); /* a distance that is known exactly: it is no less, either */
}

static cprox_status prove(const task *t) {
  if (!t->mover->motion) return certify_curve(t);
  const claim_wanted wanted = {t->delta, t->before};
  return certify_robot(t->mover, t->targets, t->n, wanted, t->answer, t->options, t->workspace, t->certificate);
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
  query q = query_create(*t->mover, t->targets, t->n, -1.0, false, &options, t->workspace);
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
  meeting.before = INFINITY;
  meeting.delta = fmax(t->answer->upper, 0.0);
  meeting.certificate = &near;
  if (prove(&meeting) == CPROX_OK && near.claim == CPROX_CLAIM_NEAR) {
    certificate_number(t->certificate, near.delta);
    for (size_t i = CERTIFICATE_HEAD; i < near.size; i++) certificate_byte(t->certificate, near.bytes[i]);
  }
  free(near.bytes);
}

static cprox_status certify(const cprox_mover *mover, const cprox_obstacle *targets, size_t n, claim_wanted wanted,
                            const cprox_result *answer, const cprox_options *options, cprox_workspace *workspace,
                            cprox_certificate *certificate) {
  const task t = {.mover = mover,
                  .targets = targets,
                  .n = n,
                  .delta = wanted.delta,
                  .before = wanted.before,
                  .answer = answer,
                  .options = options,
                  .budget = options->max_nodes,
                  .epsilon = answer ? width_allowed(options->epsilon, options->relative_epsilon, answer->upper) : 0.0,
                  .workspace = workspace,
                  .certificate = certificate};
  const double delta = t.delta;
  if (!isfinite(delta)) return workspace_fail(workspace, CPROX_INVALID, "there is nothing to measure");
  cprox_status status = prove(&t);
  if (status == CPROX_OK && isfinite(t.before)) add_meeting(&t);
  if (status == CPROX_OK && certificate->failed) status = CPROX_MEMORY;
  if (status > 0 && is_of_distance(&t) && delta > 0.0 && has_hulls(&t)) status = prove_of_hulls(&t);
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
  const cprox_status status = certify(&q->mover, q->targets, q->n, (claim_wanted){delta, INFINITY}, answer, &q->options,
                                      q->workspace, q->options.certificate);
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
  const arguments_query asked = {"a certificate for an answer", ARGUMENTS_RELATIVE | ARGUMENTS_LOD};
  const cprox_status status =
      validate_query(mover, obstacles_list(obstacles), obstacles_count(obstacles), chosen, asked, workspace);
  if (status == CPROX_OK && !certificate)
    return workspace_fail(workspace, CPROX_INVALID, "certificate is NULL: nowhere to put the proof");
  return status;
}

cprox_status cprox_certify(cprox_mover mover, const cprox_obstacles *obstacles, double delta,
                           const cprox_result *answer, const cprox_options *options, cprox_workspace *workspace,
                           cprox_certificate *certificate) {
  WORKSPACE_USE(workspace);
  const cprox_options chosen = arguments_options(options);
  cprox_status status = validate(&mover, obstacles, &chosen, workspace, certificate);
  if (status == CPROX_OK) status = validate_delta(delta, workspace);
  if (status != CPROX_OK) return status;
  return certify(&mover, obstacles_list(obstacles), obstacles_count(obstacles), (claim_wanted){delta, INFINITY}, answer,
                 &chosen, workspace, certificate);
}

cprox_status cprox_certify_contact(cprox_mover mover, const cprox_obstacles *obstacles, const cprox_result *answer,
                                   const cprox_options *options, cprox_workspace *workspace,
                                   cprox_certificate *certificate) {
  WORKSPACE_USE(workspace);
  const cprox_options chosen = arguments_options(options);
  const cprox_status status = validate(&mover, obstacles, &chosen, workspace, certificate);
  if (status != CPROX_OK) return status;
  if (!answer || answer->status < 0 || isnan(answer->t_contact_lower))
    return workspace_fail(workspace, CPROX_INVALID, "answer is none to the time of contact");
  const bool never = answer->verdict == CPROX_VERDICT_CLEAR;
  const claim_wanted wanted = {0.0, never ? INFINITY : answer->t_contact_lower};
  return certify(&mover, obstacles_list(obstacles), obstacles_count(obstacles), wanted, answer, &chosen, workspace,
                 certificate);
}
