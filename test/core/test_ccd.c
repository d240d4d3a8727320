/* SPDX-License-Identifier: BSD-3-Clause */
/* Continuous collision detection of a vertex and a face and of two edges: against steps whose contact is known exactly,
 * and against distances in long double at many times. */
#include <math.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/random.h"

typedef struct step {
  bool edges; /* two edges, else a vertex and a face */
  vec3 start[4], end[4];
  double margin;
  bool open; /* without a margin it has no proof: within a plane, or a point that is an end of both */
} step;

typedef struct tally {
  size_t clear, violated, undecided;
} tally;

static void count(tally *all, cprox_verdict verdict) {
  all->clear += verdict == CPROX_VERDICT_CLEAR, all->violated += verdict == CPROX_VERDICT_VIOLATED;
  all->undecided += verdict == CPROX_VERDICT_UNDECIDED;
}

static cprox_status ask(const step *s, const cprox_options *options, cprox_ccd *r) {
  return s->edges ? cprox_ccd_edge_edge(s->start, s->end, s->margin, options, ws, r)
                  : cprox_ccd_vertex_face(s->start, s->end, s->margin, options, ws, r);
}

static void say(const char *what, size_t number, const step *s, const cprox_ccd *r) {
  for (size_t k = 0; k < 4; k++)
    print_error("  {%a, %a, %a} {%a, %a, %a}\n", s->start[k].x, s->start[k].y, s->start[k].z, s->end[k].x, s->end[k].y,
                s->end[k].z);
  fail_msg("case %zu: %s: %s, margin %.17g, %s, contact in [%.17g, %.17g], distance in [%.17g, %.17g]", number, what,
           s->edges ? "edges" : "vertex and face", s->margin, cprox_verdict_name(r->verdict), r->t_contact_lower, r->t,
           r->lower, r->upper);
}

/* ---- the reference: distances in long double ---- */

typedef struct long3 {
  long double x[3];
} long3;

static long3 long_at(const step *s, size_t k, long double t) {
  const vec3 a = s->start[k], b = s->end[k];
  return (long3){{(1 - t) * a.x + t * b.x, (1 - t) * a.y + t * b.y, (1 - t) * a.z + t * b.z}};
}

static long3 long_sub(long3 a, long3 b) {
  return (long3){{a.x[0] - b.x[0], a.x[1] - b.x[1], a.x[2] - b.x[2]}};
}

static long double long_dot(long3 a, long3 b) {
  return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2];
}

static long3 long_cross(long3 a, long3 b) {
  return (long3){
      {a.x[1] * b.x[2] - a.x[2] * b.x[1], a.x[2] * b.x[0] - a.x[0] * b.x[2], a.x[0] * b.x[1] - a.x[1] * b.x[0]}};
}

static long double point_to_edge(long3 p, long3 a, long3 b) {
  const long3 e = long_sub(b, a), v = long_sub(p, a);
  const long double l = long_dot(e, e);
  const long double s = l > 0 ? fminl(fmaxl(long_dot(v, e) / l, 0), 1) : 0;
  const long3 d = {{v.x[0] - s * e.x[0], v.x[1] - s * e.x[1], v.x[2] - s * e.x[2]}};
  return sqrtl(long_dot(d, d));
}

static long double point_to_face(long3 p, long3 a, long3 b, long3 c) {
  const long double sides = fminl(point_to_edge(p, a, b), fminl(point_to_edge(p, b, c), point_to_edge(p, c, a)));
  const long3 n = long_cross(long_sub(b, a), long_sub(c, a)), v = long_sub(p, a);
  const long double l = long_dot(n, n);
  if (!(l > 0) || long_dot(n, long_cross(long_sub(b, a), v)) < 0 ||
      long_dot(n, long_cross(long_sub(c, b), long_sub(p, b))) < 0 ||
      long_dot(n, long_cross(long_sub(a, c), long_sub(p, c))) < 0)
    return sides;
  return fminl(sides, fabsl(long_dot(n, v)) / sqrtl(l));
}

static long double edge_to_edge(long3 a, long3 b, long3 c, long3 d) {
  const long double ends = fminl(fminl(point_to_edge(a, c, d), point_to_edge(b, c, d)),
                                 fminl(point_to_edge(c, a, b), point_to_edge(d, a, b)));
  const long3 u = long_sub(b, a), v = long_sub(d, c), w = long_sub(c, a), n = long_cross(u, v);
  const long double l = long_dot(n, n);
  if (!(l > 0)) return ends;
  const long double s = long_dot(long_cross(w, v), n) / l, t = long_dot(long_cross(w, u), n) / l;
  if (s < 0 || s > 1 || t < 0 || t > 1) return ends;
  return fminl(ends, fabsl(long_dot(n, w)) / sqrtl(l));
}

static long double distance_at(const step *s, long double t) {
  const long3 a = long_at(s, 0, t), b = long_at(s, 1, t), c = long_at(s, 2, t), d = long_at(s, 3, t);
  return s->edges ? edge_to_edge(a, b, c, d) : point_to_face(a, b, c, d);
}

/* The least distance between two times, by samples and a search by thirds round the least of them. */
static long double least_distance(const step *s, long double from, long double to) {
  enum { SAMPLES = 48 };
  long double least = INFINITY;
  int best = 0;
  for (int i = 0; i <= SAMPLES; i++) {
    const long double d = distance_at(s, from + (to - from) * i / SAMPLES);
    if (d < least) least = d, best = i;
  }
  long double low = from + (to - from) * (best > 0 ? best - 1 : 0) / SAMPLES;
  long double high = from + (to - from) * (best < SAMPLES ? best + 1 : SAMPLES) / SAMPLES;
  for (int i = 0; i < 100; i++) {
    const long double x = low + (high - low) / 3, y = high - (high - low) / 3;
    const long double dx = distance_at(s, x), dy = distance_at(s, y);
    least = fminl(least, fminl(dx, dy));
    if (dx < dy)
      high = y;
    else
      low = x;
  }
  return least;
}

static double size_of(const step *s) {
  double size = 0.0;
  for (size_t k = 0; k < 4; k++) {
    size = fmax(size, vec_norm(vec_sub(s->start[k], s->start[0])));
    size = fmax(size, vec_norm(vec_sub(s->end[k], s->end[0])));
  }
  for (size_t k = 0; k < 4; k++) size = fmax(size, 1e-3 * fmax(vec_norm(s->start[k]), vec_norm(s->end[k])));
  return size;
}

/* All that is certified, at many times. Distances in long double are off by a few 2^-64 of the coordinates. */
static void compare(size_t number, const step *s, const cprox_ccd *r) {
  const long double doubt = 1e-15L * size_of(s), margin = s->margin;
  const long double before = r->t_contact_lower > 0.0 ? least_distance(s, 0, r->t_contact_lower) : INFINITY,
                    at = distance_at(s, r->t);
  if (before < margin - doubt) say("contact before t_contact_lower", number, s, r);
  if (at > margin + r->upper + doubt && r->verdict != CPROX_VERDICT_VIOLATED) say("upper is too low", number, s, r);
  if (r->verdict == CPROX_VERDICT_CLEAR && !(r->lower > 0.0 && r->t_contact_lower == 1.0 && r->upper >= r->lower))
    say("clear without a bound", number, s, r);
  if (r->verdict == CPROX_VERDICT_CLEAR && before < margin + r->lower - doubt) say("lower is too high", number, s, r);
  if (r->verdict == CPROX_VERDICT_VIOLATED && margin > 0 && at > margin + 1e-17L * size_of(s))
    say("violated beyond the margin", number, s, r);
  if (r->verdict == CPROX_VERDICT_VIOLATED &&
      least_distance(s, r->t_contact_lower, r->t) > margin + 1e-12L * size_of(s))
    say("violated without contact", number, s, r);
  if (r->verdict != CPROX_VERDICT_CLEAR && r->lower != 0.0) say("lower is not 0", number, s, r);
  if (!(r->t_contact_lower <= r->t || r->verdict != CPROX_VERDICT_VIOLATED)) say("no interval", number, s, r);
  const double *w = r->weights;
  const double first = s->edges ? w[0] + w[1] : w[0], second = s->edges ? w[2] + w[3] : w[1] + w[2] + w[3];
  assert_true(fabs(first - 1.0) < 1e-12 && fabs(second - 1.0) < 1e-12);
  assert_true(fmin(fmin(w[0], w[1]), fmin(w[2], w[3])) >= 0.0);
}

/* ---- steps ---- */

/* Any step: sizes from 1e-6 to 1e6, far from the origin, some with points that coincide, stand, or lie in a plane. */
static step any_step(rng *r) {
  step s = {.edges = rng_index(r, 2)};
  const double scale = rng_log_uniform(r, 1e-6, 1e6), offset = rng_index(r, 2) ? 0.0 : 1e3 * scale;
  const vec3 centre = rng_in_cube(r, offset), way = vec_scale(scale * rng_uniform(r, 0.0, 2.0), rng_unit(r));
  const double wobble = rng_index(r, 3) ? scale * rng_log_uniform(r, 1e-3, 1.0) : 0.0;
  for (size_t k = 0; k < 4; k++) {
    s.start[k] = vec_add(centre, rng_in_cube(r, scale));
    s.end[k] = vec_add(s.start[k], rng_in_cube(r, wobble));
    if (k < (s.edges ? 2u : 1u)) s.end[k] = vec_add(s.end[k], way);
  }
  const size_t flat = rng_index(r, 12);
  for (size_t k = 0; k < 4 && flat == 0; k++) s.start[k].z = s.end[k].z = centre.z;
  if (flat == 1) s.start[3] = s.start[2], s.end[3] = s.end[2];
  if (flat == 2) s.end[3] = vec_add(s.end[2], vec_sub(s.start[3], s.start[2]));
  if (flat == 3) memcpy(s.end, s.start, sizeof s.end);
  if (flat == 4) s.start[1] = s.start[0], s.end[1] = s.end[0];
  s.open = flat == 0 || flat == 4;
  if (rng_index(r, 3) == 0) s.margin = scale * rng_log_uniform(r, 1e-9, 0.5);
  return s;
}

/* 10^5 steps (seed 4401): what is certified holds at all times, and of those that have a proof almost
 * none is undecided. */
CASE(what_is_certified_of_a_step_holds_at_every_time) {
  rng r = rng_seed(4401);
  tally all = {0};
  size_t open = 0;
  const size_t cases = test_cases(100000);
  for (size_t i = 0; i < cases; i++) {
    const step s = any_step(&r);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = rng_index(&r, 2) ? 0.0 : 1e-6 * size_of(&s);
    cprox_ccd c;
    assert_true(ask(&s, &options, &c) >= 0);
    compare(i, &s, &c);
    open += c.verdict == CPROX_VERDICT_UNDECIDED && (!s.open || s.margin > 0.0);
    count(&all, c.verdict);
  }
  assert_true(all.clear > cases / 2 && all.violated > cases / 20 && open <= cases / 5000);
}

/* Three weights of eighths that sum to 1, or two. */
static void eighths(rng *r, size_t n, int *w) {
  const int first = (int)rng_index(r, 9), second = n == 2 ? 8 - first : (int)rng_index(r, (size_t)(9 - first));
  w[0] = first, w[1] = second, w[2] = 8 - first - second;
}

static vec3 weighed(const vec3 *p, const int *w, size_t n) {
  vec3 at = vec(0, 0, 0);
  for (size_t k = 0; k < n; k++) at = vec_axpy(at, w[k] / 8.0, p[k]);
  return at;
}

/* A contact at the time `when`, an eighth, of points with integer coordinates: the numbers are exact. */
static step exact_hit(rng *r, double *when, bool *through) {
  step s = {.edges = rng_index(r, 2)};
  const size_t kind = rng_index(r, 6); /* 0: within a plane; 1: nothing moves; 2: parallel, or a flat face */
  vec3 at[4], by[4];
  for (size_t k = 0; k < 4; k++) {
    at[k] = vec(8.0 * (double)rng_index(r, 17), 8.0 * (double)rng_index(r, 17), 8.0 * (double)rng_index(r, 17));
    by[k] = vec(8.0 * ((double)rng_index(r, 17) - 8.0), 8.0 * ((double)rng_index(r, 17) - 8.0),
                8.0 * ((double)rng_index(r, 17) - 8.0));
    if (kind == 0) at[k].z = by[k].z = 0.0;
    if (kind == 1) by[k] = vec(0, 0, 0);
  }
  if (kind == 2 && s.edges) at[3] = vec_add(at[2], vec_sub(at[1], at[0]));
  if (kind == 2 && !s.edges) at[3] = vec_lerp(at[1], at[2], 0.5);
  int w[3], v[3];
  eighths(r, s.edges ? 2 : 3, w);
  eighths(r, 2, v);
  const vec3 second = weighed(s.edges ? &at[2] : &at[1], w, s.edges ? 2 : 3);
  const vec3 first = s.edges ? weighed(at, v, 2) : at[0];
  for (size_t k = 0; k < (s.edges ? 2u : 1u); k++) at[k] = vec_add(at[k], vec_sub(second, first));
  *when = (double)rng_index(r, 9) / 8.0;
  const double scale = ldexp(1.0, (int)rng_index(r, 41) - 20), shift = rng_index(r, 2) ? 0.0 : 0x1p20;
  for (size_t k = 0; k < 4; k++) {
    const vec3 from = vec_axpy(at[k], -*when, by[k]), to = vec_axpy(at[k], 1.0 - *when, by[k]);
    s.start[k] = vec_scale(scale, vec(from.x + shift, from.y, from.z - shift));
    s.end[k] = vec_scale(scale, vec(to.x + shift, to.y, to.z - shift));
  }
  const bool within = w[0] > 0 && w[1] > 0 && (s.edges || w[2] > 0) && (!s.edges || (v[0] > 0 && v[1] > 0));
  /* how fast they go through each other: the velocity along the normal */
  const vec3 a = s.edges ? vec_sub(at[1], at[0]) : vec_sub(at[2], at[1]),
             b = s.edges ? vec_sub(at[3], at[2]) : vec_sub(at[3], at[1]);
  const vec3 speed =
      s.edges ? vec_sub(weighed(by, v, 2), weighed(&by[2], w, 2)) : vec_sub(by[0], weighed(&by[1], w, 3));
  *through = within && *when > 0.0 && *when < 1.0 && vec_dot(vec_cross(a, b), speed) != 0.0;
  return s;
}

/* 10^5 steps of integer coordinates (seed 4402), scaled and shifted by powers of 2: touching with corners, sides and
 * insides, at both ends too, within a plane, parallel, and where nothing moves. */
CASE(a_contact_at_a_known_time_is_never_missed_and_never_late) {
  rng r = rng_seed(4402);
  const size_t cases = test_cases(100000);
  size_t through = 0, proven = 0;
  for (size_t i = 0; i < cases; i++) {
    double when;
    bool goes;
    const step s = exact_hit(&r, &when, &goes);
    cprox_ccd c;
    assert_true(ask(&s, NULL, &c) >= 0);
    if (c.verdict == CPROX_VERDICT_CLEAR || c.t_contact_lower > when) say("missed or late", i, &s, &c);
    through += goes, proven += goes && c.verdict == CPROX_VERDICT_VIOLATED;
  }
  assert_true(through > cases / 8 && proven > through - through / 50);
}

/* 10^5 steps whose coordinates have all bits (seed 4403): a corner that the vertex or an edge's end has in common with
 * the other at an end of the step, or half way, as x and -x have 0. */
CASE(a_contact_of_full_mantissas_is_never_missed_and_never_late) {
  rng r = rng_seed(4403);
  const size_t cases = test_cases(100000);
  for (size_t i = 0; i < cases; i++) {
    step s = {.edges = rng_index(&r, 2)};
    const double scale = rng_log_uniform(&r, 1e-6, 1e6);
    for (size_t k = 0; k < 4; k++) {
      const bool wild = rng_index(&r, 2);
      s.start[k] =
          wild ? vec(rng_awkward(&r, scale), rng_awkward(&r, scale), rng_awkward(&r, scale)) : rng_in_cube(&r, scale);
      s.end[k] = rng_in_cube(&r, scale);
    }
    const size_t kind = rng_index(&r, 4), other = s.edges ? 2 + rng_index(&r, 2) : 1 + rng_index(&r, 3);
    double when = 1.0;
    if (kind == 0) {
      s.end[0] = s.end[other];
    } else if (kind == 1) {
      s.start[0] = s.start[other], when = 0.0;
    } else {
      when = 0.5; /* the vertex, or the middle of the first edge, comes to 0, and the middle of a side is there */
      s.end[0] = vec_neg(s.start[0]);
      if (s.edges) s.start[1] = vec_neg(s.start[0]), s.end[1] = s.start[0];
      s.start[3] = vec_neg(s.start[2]), s.end[3] = vec_neg(s.end[2]);
      if (kind == 3) s.end[2] = vec_neg(s.start[2]), s.end[3] = vec_neg(s.start[3]);
    }
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = rng_index(&r, 2) ? 0.0 : 1e-6;
    cprox_ccd c;
    assert_true(ask(&s, &options, &c) >= 0);
    if (c.verdict == CPROX_VERDICT_CLEAR || c.t_contact_lower > when) say("missed or late", i, &s, &c);
  }
}

/* 10^5 steps of integer coordinates on two sides of a plane (seed 4404), as near as 2^-40 of their size. */
CASE(a_step_on_two_sides_of_a_plane_is_never_violated) {
  rng r = rng_seed(4404);
  const size_t cases = test_cases(100000);
  size_t wide = 0, clear = 0;
  for (size_t i = 0; i < cases; i++) {
    step s = {.edges = rng_index(&r, 2)};
    vec3 n = vec((double)rng_index(&r, 5) - 2.0, (double)rng_index(&r, 5) - 2.0, 1.0 + (double)rng_index(&r, 3));
    const size_t first = s.edges ? 2 : 1;
    double high = -INFINITY, low = INFINITY;
    for (size_t k = 0; k < 8; k++) {
      vec3 *p = k < 4 ? &s.start[k] : &s.end[k - 4];
      *p = vec((double)rng_index(&r, 65), (double)rng_index(&r, 65), (double)rng_index(&r, 65));
      /* some in the plane */
      if (rng_index(&r, 2)) p->z = 0.0, p->x = n.y * p->x, p->y = -n.x * p->x / (n.y == 0.0 ? 1.0 : n.y);
      if (k % 4 < first)
        high = fmax(high, vec_dot(n, *p));
      else
        low = fmin(low, vec_dot(n, *p));
    }
    const int depth = (int)rng_index(&r, 41);
    const double gap = ldexp(1.0, -depth) * vec_norm2(n);
    /* along n, by a whole number of lengths of n: n . p changes by n . n */
    const double up = ceil((high - low) / vec_norm2(n)) + ldexp(1.0, -depth);
    for (size_t k = first; k < 4; k++) s.start[k] = vec_axpy(s.start[k], up, n), s.end[k] = vec_axpy(s.end[k], up, n);
    cprox_ccd c;
    assert_true(ask(&s, NULL, &c) >= 0);
    if (c.verdict == CPROX_VERDICT_VIOLATED) say("there is a plane between them", i, &s, &c);
    const bool is_wide = gap > 1e-5;
    if (is_wide && c.verdict != CPROX_VERDICT_CLEAR) say("farther than epsilon", i, &s, &c);
    wide += is_wide, clear += c.verdict == CPROX_VERDICT_CLEAR;
  }
  assert_true(wide > cases / 4 && clear > cases - cases / 50);
}

/* A vertex that falls straight onto a face comes to each distance at a known time. 20,000 (seed 4405), with margins
 * that are the least distance but for some roundings. */
CASE(a_margin_is_kept_to_its_roundings) {
  rng r = rng_seed(4405);
  tally all = {0};
  const size_t cases = test_cases(20000);
  for (size_t i = 0; i < cases; i++) {
    const double high = rng_uniform(&r, 1.0, 2.0), low = rng_uniform(&r, 0.1, 0.9);
    step s = {.start = {vec(0.1, 0.2, high), vec(-3, -2, 0), vec(3, -1, 0), vec(0, 4, 0)},
              .end = {vec(0.2, 0.1, low), vec(-3, -2, 0), vec(3, -1, 0), vec(0, 4, 0)}};
    if (rng_index(&r, 2)) {
      s.edges = true;
      s.start[1] = vec(0.5, 0.7, high), s.end[1] = vec(0.9, 0.6, low);
      s.start[2] = s.end[2] = vec(-1, 1, 0), s.start[3] = s.end[3] = vec(1, 0, 0);
    }
    s.margin = low;
    for (int k = (int)rng_index(&r, 9) - 4; k != 0; k += k < 0 ? 1 : -1) s.margin = nextafter(s.margin, k < 0 ? 0 : 1);
    if (rng_index(&r, 2)) s.margin = rng_uniform(&r, 0.05, 0.95);
    cprox_ccd c;
    assert_true(ask(&s, NULL, &c) >= 0);
    if (c.verdict == CPROX_VERDICT_CLEAR && !(s.margin < low)) say("not clear", i, &s, &c);
    if (c.verdict == CPROX_VERDICT_VIOLATED && s.margin < low) say("not violated", i, &s, &c);
    /* the time at which the height is the margin */
    const long double when = ((long double)high - s.margin) / ((long double)high - low);
    if (c.t_contact_lower > when * (1 + 1e-18L) && when < 1) say("late", i, &s, &c);
    if (c.verdict == CPROX_VERDICT_VIOLATED) assert_true(c.t_contact_lower > when - 1e-5 && c.t < when + 1e-5);
    if (fabs(s.margin - low) > 1e-12)
      assert_int_equal(c.verdict, s.margin < low ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_VIOLATED);
    count(&all, c.verdict);
  }
  assert_true(all.clear > 0 && all.violated > 0);
}

/* 20,000 steps (seed 4406): as good as the least distance over the step, where that is known by samples. */
CASE(a_clear_step_has_an_eighth_of_its_distance_as_its_bound) {
  rng r = rng_seed(4406);
  const size_t cases = test_cases(20000);
  uint64_t nodes = 0, clear = 0;
  for (size_t i = 0; i < cases; i++) {
    step s = any_step(&r);
    s.margin = 0.0;
    cprox_ccd c;
    ask(&s, NULL, &c);
    if (c.verdict != CPROX_VERDICT_CLEAR) continue;
    const double least = (double)least_distance(&s, 0, 1);
    if (least > 1e-6 * size_of(&s) && !(c.lower > 0.12 * least)) say("a weak bound", i, &s, &c);
    nodes += c.nodes, clear++;
  }
  assert_true(nodes < 2 * clear);
}

CASE(a_step_that_cannot_be_asked_about_is_refused_and_said) {
  step s = {.start = {vec(0, 0, 1), vec(-1, -1, 0), vec(1, -1, 0), vec(0, 1, 0)},
            .end = {vec(0, 0, -1), vec(-1, -1, 0), vec(1, -1, 0), vec(0, 1, 0)}};
  cprox_ccd c = {.nodes = 77};
  const step good = s;
  assert_int_equal(cprox_ccd_vertex_face(NULL, s.end, 0.0, NULL, ws, &c), CPROX_INVALID);
  assert_int_equal(cprox_ccd_edge_edge(s.start, NULL, 0.0, NULL, ws, &c), CPROX_INVALID);
  assert_int_equal(cprox_ccd_vertex_face(s.start, s.end, 0.0, NULL, ws, NULL), CPROX_INVALID);
  static const double BAD[] = {NAN, INFINITY, -INFINITY, 1.1e60};
  for (size_t i = 0; i < 4; i++) {
    s = good, s.end[2].y = BAD[i];
    assert_int_equal(ask(&s, NULL, &c), CPROX_INVALID);
    assert_non_null(strstr(cprox_workspace_error(ws), "point 2 at the end"));
    s = good, s.margin = BAD[i] < 0 ? -1.0 : BAD[i];
    assert_int_equal(ask(&s, NULL, &c), CPROX_INVALID);
    assert_non_null(strstr(cprox_workspace_error(ws), "margin"));
  }
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.signed_distance = true;
  assert_int_equal(ask(&good, &options, &c), CPROX_INVALID);
  options = CPROX_OPTIONS_DEFAULT;
  options.size--;
  assert_int_equal(ask(&good, &options, &c), CPROX_INVALID);
  assert_int_equal(c.nodes, 77);
  options = CPROX_OPTIONS_DEFAULT;
  options.max_nodes = 1;
  assert_int_equal(ask(&good, &options, &c), CPROX_BUDGET);
  assert_int_equal(c.verdict, CPROX_VERDICT_UNDECIDED);
  assert_int_equal(cprox_ccd_vertex_face(good.start, good.end, 0.0, NULL, NULL, &c), CPROX_OK);
  assert_int_equal(c.verdict, CPROX_VERDICT_VIOLATED);
  assert_true(c.t_contact_lower > 0.49 && c.t_contact_lower <= 0.5 && c.t >= 0.5 && c.t < 0.5 + 1e-9);
  assert_true(c.normal.z > 0.999 && c.weights[0] == 1.0 && fabs(c.weights[3] - 0.5) < 1e-9);
}

/* The largest and the smallest coordinates: nothing overflows. */
CASE(steps_of_every_size_are_answered) {
  static const double SIZES[] = {1e60, 1e40, 1e-40, 1e-80, 1e-160, 1e-300, 5e-324, 0.0};
  for (size_t i = 0; i < sizeof SIZES / sizeof *SIZES; i++) {
    for (int edges = 0; edges < 2; edges++) {
      const double d = SIZES[i];
      step s = {.edges = edges,
                .start = {vec(0, 0, d), vec(-d, -d, 0), vec(d, -d, 0), vec(0, d, 0)},
                .end = {vec(0, 0, -d), vec(-d, -d, 0), vec(d, -d, 0), vec(0, d, 0)}};
      cprox_ccd c;
      assert_true(ask(&s, NULL, &c) >= 0);
      assert_true(c.verdict != CPROX_VERDICT_CLEAR || edges);
      assert_true(c.t_contact_lower >= 0.0 && c.t_contact_lower <= 1.0 && c.upper >= c.lower);
      if (!edges && d > 1e-7) assert_int_equal(c.verdict, CPROX_VERDICT_VIOLATED);
    }
  }
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
