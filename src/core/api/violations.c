/* SPDX-License-Identifier: BSD-3-Clause */
/* All intervals in which the clearance is at most delta. doc/time-of-contact.md, Enter and leave. */
#include <math.h>

#include "problem/section.h"
#include "problem/validate.h"
#include "robot_query/answer.h"
#include "robot_query/measure.h"
#include "solve/list.h"
#include "solve/solve.h"

/* A part of the parameter range: nowhere within delta, everywhere within delta, or as short as asked and neither. */
typedef enum piece_kind { PIECE_CLEAR, PIECE_VIOLATED, PIECE_OPEN } piece_kind;

typedef struct piece {
  double from, to;
  size_t section; /* of a curve: its piece */
} piece;

typedef struct violation_search {
  query q;
  double delta, resolution;
  cprox_violations *out;
  cprox_status failure;

  /* what was found from left to right */
  bool within;          /* the last violation goes on */
  bool open;            /* after it, or alone: there are open pieces, */
  double from, to;      /* from here to there, */
  cprox_result nearest; /* in which this was nearest */
} violation_search;

/* ---- from left to right ---- */

/* False where there is no room. */
static bool push(violation_search *s, double from, double to) {
  if (s->out->count == s->out->room) {
    if (s->out->count > 0) s->out->list[s->out->count - 1].leave_upper = s->q.t1;
    s->failure = CPROX_BUDGET;
    return false;
  }
  s->out->list[s->out->count++] = (cprox_violation){.enter_lower = from,
                                                    .enter_upper = to,
                                                    .leave_lower = from,
                                                    .leave_upper = to,
                                                    .verdict = CPROX_VERDICT_UNDECIDED,
                                                    .upper = INFINITY,
                                                    .t = from,
                                                    .obstacle_index = -1,
                                                    .mover_part = -1};
  return true;
}

static void note_nearest(violation_search *s, const cprox_result *r) {
  cprox_violation *v = &s->out->list[s->out->count - 1];
  if (!(r->upper < v->upper)) return;
  v->upper = r->upper, v->t = r->t, v->obstacle_index = r->obstacle_index, v->mover_part = r->mover_part;
}

/* What is open belongs to the violation before it, or is one of its own. */
static bool end_violation(violation_search *s) {
  bool room = true;
  if (s->open && s->within) {
    s->out->list[s->out->count - 1].leave_upper = s->to;
  } else if (s->open) {
    room = push(s, s->from, s->to);
    cprox_violation *v = &s->out->list[s->out->count - 1];
    if (room) note_nearest(s, &s->nearest);
    if (room && s->nearest.upper <= s->delta)
      v->verdict = CPROX_VERDICT_VIOLATED, v->enter_upper = v->leave_lower = s->nearest.t;
  }
  s->within = s->open = false;
  return room;
}

static void add_open(violation_search *s, const piece *p, const cprox_result *r) {
  if (!s->open) s->from = p->from, s->nearest = *r;
  s->open = true;
  s->to = p->to;
  if (r->upper < s->nearest.upper) s->nearest = *r;
}

static bool add_violated(violation_search *s, const piece *p, const cprox_result *r) {
  const bool had_open = s->open;
  const double from = had_open ? s->from : p->from;
  if (had_open && s->within && !end_violation(s)) return false;
  if (!s->within) {
    s->open = false;
    if (!push(s, from, p->from)) return false;
  }
  cprox_violation *v = &s->out->list[s->out->count - 1];
  v->leave_lower = v->leave_upper = p->to;
  v->verdict = CPROX_VERDICT_VIOLATED;
  note_nearest(s, r);
  s->within = true;
  return true;
}

/* ---- one piece ---- */

/* A bound on how far what comes nearest moves between any two places of the section: its capsule's size. */
static double travel_of_section(const query *q) {
  for (size_t i = 0; i < q->n; i++)
    if (q->obstacles[i].synchronized) return INFINITY; /* it moves, too */
  return vec_norm(vec_sub(q->reach.b, q->reach.a)) + 2.0 * q->reach.radius;
}

static cprox_status ask(violation_search *s, const piece *p, double limit, cprox_result *r, double *travel) {
  query *q = &s->q;
  q->limit = limit;
  q->is_signed = limit < 0.0 && q->options.signed_distance; /* of a verdict it does not matter how deep */
  if (q->mover.motion) {
    q->t0 = p->from, q->t1 = p->to;
    return robot_answer_and_travel(q, r, travel);
  }
  query_ask_section(q, p->section, p->from, p->to);
  *travel = travel_of_section(q);
  const cprox_status status = solve_query(q, 0, q->n, INFINITY, r);
  if (status >= 0) r->upper += section_outward(q->mover.curve, p->section);
  return status;
}

static cprox_status look_at(violation_search *s, const piece *p, piece_kind *kind, cprox_result *r) {
  double travel;
  *kind = PIECE_OPEN;
  const cprox_status verdict = ask(s, p, s->delta, r, &travel);
  if (verdict < 0) return verdict;
  if (r->lower > s->delta) {
    *kind = PIECE_CLEAR;
    return CPROX_OK;
  }
  const cprox_status status = ask(s, p, -1.0, r, &travel);
  if (status < 0) return status;
  r->t = fmin(fmax(r->t, p->from), p->to);
  if (r->lower > s->delta) *kind = PIECE_CLEAR;
  if (r->upper + travel <= s->delta) *kind = PIECE_VIOLATED;
  return *kind == PIECE_OPEN && (verdict == CPROX_STOPPED || status == CPROX_STOPPED) ? CPROX_STOPPED : CPROX_OK;
}

/* ---- what stands ---- */

/* Pairs that stand still against each other are within delta all the time, or never; then *left is true, and the others
 * are left to ask about. */
static cprox_status look_at_standing(violation_search *s, const piece *all, bool *left) {
  query *q = &s->q;
  *left = true;
  if (q->mover.motion->is_state || q->mover.motion->n_tracks > 1) return CPROX_OK;
  double travel;
  cprox_result r;
  q->choice = PAIRS_STANDING;
  const cprox_status status = ask(s, all, s->delta, &r, &travel);
  q->choice = PAIRS_ALL;
  if (status < 0) return status;
  if (r.lower > s->delta) {
    q->choice = PAIRS_MOVING;
    return CPROX_OK;
  }
  *left = false;
  const bool violated = r.upper <= s->delta;
  const cprox_status nearest = ask(s, all, -1.0, &r, &travel);
  if (nearest < 0) return nearest;
  if (status == CPROX_STOPPED || nearest == CPROX_STOPPED) s->failure = CPROX_STOPPED;
  r.t = fmin(fmax(r.t, all->from), all->to);
  if (violated)
    add_violated(s, all, &r);
  else
    add_open(s, all, &r);
  return CPROX_OK;
}

/* ---- the whole ---- */

/* Where to divide a piece; false where it is short enough. Of many segments it is divided at knots, however short: one
 * segment says more of itself than a span. */
static bool divides_at(const violation_search *s, const piece *p, double *at) {
  *at = p->from + 0.5 * (p->to - p->from);
  const cprox_motion *m = s->q.mover.motion;
  if (m) {
    const motion_interval over = motion_interval_of(m, p->from, p->to);
    if (motion_is_span(&over)) {
      *at = m->times[robot_knot_near(m, over.first, over.last, 1, *at)];
      return *at > p->from && *at < p->to;
    }
  }
  return p->to - p->from > s->resolution && *at > p->from && *at < p->to;
}

enum { DEEPEST = 128 };

/* The piece, and its halves until nothing is open that is longer than asked. CPROX_STOPPED and CPROX_BUDGET leave it
 * open. */
static cprox_status look_over(violation_search *s, const piece *whole) {
  piece stack[DEEPEST];
  size_t n = 0;
  stack[n++] = *whole;
  while (n > 0) {
    const piece p = stack[--n];
    cprox_result r = query_nothing();
    piece_kind kind = PIECE_OPEN;
    cprox_status status = s->failure;
    if (workspace_work(s->q.workspace) >= s->q.options.max_nodes) status = CPROX_BUDGET;
    if (status != CPROX_STOPPED && status != CPROX_BUDGET) status = look_at(s, &p, &kind, &r);
    if (status < 0) return status;
    if (status == CPROX_STOPPED || status == CPROX_BUDGET) s->failure = status;
    double middle;
    const bool divides = n + 2 <= DEEPEST && s->failure == CPROX_OK && divides_at(s, &p, &middle);
    bool room = true;
    if (kind == PIECE_CLEAR) {
      room = end_violation(s);
    } else if (kind == PIECE_VIOLATED) {
      room = add_violated(s, &p, &r);
    } else if (divides) {
      stack[n++] = (piece){middle, p.to, p.section};
      stack[n++] = (piece){p.from, middle, p.section};
    } else {
      add_open(s, &p, &r);
    }
    if (!room) return CPROX_BUDGET;
  }
  return CPROX_OK;
}

/* All pieces of the range, each as far as it lies in it. */
static cprox_status search_range(violation_search *s, double from, double to) {
  const cprox_curve *curve = s->q.mover.motion ? NULL : s->q.mover.curve;
  for (size_t i = 0; i < (curve ? curve->n_pieces : 1); i++) {
    const piece part = {curve ? fmax(from, curve->breaks[i]) : from, curve ? fmin(to, curve->breaks[i + 1]) : to, i};
    if (!(part.from < part.to)) continue;
    const cprox_status status = look_over(s, &part);
    if (status != CPROX_OK) return status;
  }
  return CPROX_OK;
}

/* ---- ends as narrow as asked ---- */

enum { NARROWINGS = 16, FEW = 8 };

/* Pieces of `resolution` leave an end open that is crossed obliquely: it is searched again by smaller ones. What is
 * found replaces the end's bounds. A violation's end is [*clear, *within] where it enters, [*within, *clear] where it
 * leaves. Ends that get no narrower (it runs along delta, or epsilon is reached), and those that budget or stop leave,
 * stay as they are. */
static cprox_status narrow_end(const violation_search *whole, bool enters, double *clear, double *within) {
  double resolution = whole->resolution;
  for (int i = 0; i < NARROWINGS && fabs(*within - *clear) > whole->resolution; i++) {
    const double from = fmin(*clear, *within), to = fmax(*clear, *within), width = to - from;
    resolution *= fmax(0.5 * whole->resolution / width, 0.25);
    cprox_violation list[FEW];
    cprox_violations found = {.list = list, .room = FEW};
    violation_search s = *whole;
    s.out = &found, s.resolution = resolution, s.failure = CPROX_OK, s.within = s.open = false;
    const cprox_status status = search_range(&s, from, to);
    if (status < 0) return status;
    if (status != CPROX_OK || s.failure != CPROX_OK || !end_violation(&s)) return CPROX_OK;
    const cprox_violation *first = &list[0], *last = &list[found.count - (found.count > 0)];
    if (found.count == 0) {
      *clear = *within;
    } else if (enters) {
      *clear = first->enter_lower;
      if (last->verdict == CPROX_VERDICT_VIOLATED && last->leave_lower >= to) *within = last->enter_upper;
    } else {
      *clear = last->leave_upper;
      if (first->verdict == CPROX_VERDICT_VIOLATED && first->enter_upper <= from) *within = first->leave_lower;
    }
    if (fabs(*within - *clear) > 0.75 * width) return CPROX_OK;
  }
  return CPROX_OK;
}

/* Ends that two violations share are left: between them may be one. */
static cprox_status narrow_ends(const violation_search *s) {
  cprox_violation *list = s->out->list;
  for (size_t i = 0; i < s->out->count; i++) {
    cprox_violation *v = &list[i];
    if (v->verdict != CPROX_VERDICT_VIOLATED) continue;
    const bool shares_first = i > 0 && list[i - 1].leave_upper > v->enter_lower,
               shares_last = i + 1 < s->out->count && v->leave_upper > list[i + 1].enter_lower;
    cprox_status status = CPROX_OK;
    if (!shares_first) status = narrow_end(s, true, &v->enter_lower, &v->enter_upper);
    if (status == CPROX_OK && !shares_last) status = narrow_end(s, false, &v->leave_upper, &v->leave_lower);
    if (status != CPROX_OK) return status;
  }
  return CPROX_OK;
}

static cprox_status check(const violation_search *s) {
  cprox_workspace *workspace = s->q.workspace;
  if (!s->out || (!s->out->list && s->out->room > 0) || s->out->room == 0)
    return workspace_fail(workspace, CPROX_INVALID, "there is no room for violations");
  if (!(s->delta >= 0.0 && isfinite(s->delta)))
    return workspace_fail(workspace, CPROX_INVALID, "delta is %g m, must be at least 0 and finite", s->delta);
  if (!(s->resolution > 0.0 && isfinite(s->resolution)))
    return workspace_fail(workspace, CPROX_INVALID, "the resolution is %g, must be above 0 and finite", s->resolution);
  return CPROX_OK;
}

cprox_status list_violations(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, double delta,
                             double resolution, const cprox_options *options, cprox_workspace *workspace,
                             cprox_violations *violations) {
  violation_search s = {.q = query_create(mover, obstacles, n, -1.0, options, workspace),
                        .delta = delta,
                        .resolution = resolution,
                        .out = violations};
  const arguments_query asked = {"intervals of violation",
                                 ARGUMENTS_SEARCH | ARGUMENTS_SIGNED | ARGUMENTS_WHOLE | ARGUMENTS_INTERVAL};
  cprox_status status = query_begin(&s.q, asked);
  if (status == CPROX_OK) status = check(&s);
  if (status != CPROX_OK) return status;
  violations->count = 0;
  const double t0 = s.q.t0, t1 = s.q.t1;
  bool left = true;
  if (mover.motion) status = look_at_standing(&s, &(piece){t0, t1, 0}, &left);
  if (left && status == CPROX_OK) status = search_range(&s, t0, t1);
  if (status < 0) return status;
  s.q.t1 = t1;
  if (status == CPROX_OK) end_violation(&s);
  if (left && status == CPROX_OK && s.failure == CPROX_OK) status = narrow_ends(&s);
  if (status < 0) return status;
  if (violations->count > 0 && status == CPROX_BUDGET) violations->list[violations->count - 1].leave_upper = t1;
  if (s.failure != CPROX_OK) workspace_fail(workspace, s.failure, "%s", query_shortfall(s.failure));
  return s.failure;
}
