/* SPDX-License-Identifier: BSD-3-Clause */
/* Pairs of solids that are hard for gaps: do their interiors overlap? Overlaps have a witness, a point inside of both.
 * What is apart is apart by a plane, with a known distance; a dot among bars by the distance of a point from boxes.
 * Wrong: clear for an overlap, or an overlap for what is apart. Given up: neither is proven. Clear is a proof of the
 * certified gap alone. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "curve_proximity/cprox_fourier.h"
#include "stability/hard.h"

enum { PARTS = 6, GAPS = 2 };
static const uint32_t SAMPLES_OF_GAPS = 33;

/* Boxes at places of their own, or one other body. */
typedef struct side {
  size_t n;
  vec3 size[PARTS];
  cprox_pose at[PARTS];
  cprox_body *body[PARTS];
  cprox_solid *solid;
} side;

typedef struct gap_pair {
  side a, b;
  cprox_gap *gap[GAPS]; /* certified, tuned */
} gap_pair;

typedef struct overlap_case {
  const gap_pair *pair;
  cprox_pose place;
  double apart; /* [m] negative: the interiors overlap */
} overlap_case;

typedef struct gap_family {
  const char *name;
  void (*make)(rng *r, side *a, side *b);
  cprox_quat (*turn)(rng *r);
  bool level; /* apart along an axis of a */
} gap_family;

static void add_solid_box(side *s, vec3 size, vec3 at) {
  s->size[s->n] = size, s->at[s->n] = CPROX_POSE_IDENTITY, s->at[s->n].position = at;
  if (cprox_body_create_box(size, NULL, &s->body[s->n++])) exit(1);
}

static void finish_boxes(side *s) {
  cprox_solid *parts[PARTS];
  for (size_t i = 0; i < s->n; i++) {
    const cprox_solid_description d = {.kind = CPROX_SOLID_BOX, .dimension = 3, .size = s->size[i]};
    if (cprox_solid_create(&d, NULL, &parts[i])) exit(1);
  }
  const cprox_solid_description all = {
      .kind = CPROX_SOLID_UNION, .parts = (const cprox_solid *const *)parts, .poses = s->at, .n = s->n};
  if (cprox_solid_create(&all, NULL, &s->solid)) exit(1);
  for (size_t i = 0; i < s->n; i++) cprox_solid_free(parts[i]);
}

static void one_box(side *s, double x, double y, double z) {
  add_solid_box(s, (vec3){x, y, z}, (vec3){0, 0, 0});
  finish_boxes(s);
}

static void thin(rng *r, side *a, side *b) {
  one_box(a, 1.0, 0.8, pow(10.0, rng_uniform(r, -5.0, -2.0)));
  one_box(b, 0.9, pow(10.0, rng_uniform(r, -5.0, -2.0)), 1.0);
}

static void dot_among_bars(rng *r, side *a, side *b) {
  for (int i = 0; i < PARTS; i++) add_solid_box(a, (vec3){0.04, 1.0, 0.04}, (vec3){0.2 * (i - 2.5), 0, 0});
  finish_boxes(a);
  const double edge = pow(10.0, rng_uniform(r, -4.0, -2.0));
  one_box(b, edge, edge, edge);
}

static void alike(rng *r, side *a, side *b) {
  const double x = rng_uniform(r, 0.5, 1.0), y = rng_uniform(r, 0.5, 1.0);
  one_box(a, x, x, y);
  one_box(b, x, x, y);
}

static void unequal(rng *r, side *a, side *b) {
  one_box(a, 1.0, 0.8, 0.9);
  const double edge = pow(10.0, rng_uniform(r, -5.0, -3.0));
  one_box(b, edge, 0.7 * edge, 0.8 * edge);
}

/* A superquadric as all tangents of a box that contains it. */
static void edgy(rng *r, side *a, side *b) {
  one_box(b, 0.6, 0.7, 0.5);
  const double n = pow(10.0, rng_uniform(r, 1.3, 2.7));
  a->n = 1, a->size[0] = (vec3){0.9, 0.7, 0.8}, a->at[0] = CPROX_POSE_IDENTITY;
  const vec3 half = {0.45, 0.35, 0.4};
  cprox_solid *box;
  const cprox_solid_description d = {.kind = CPROX_SOLID_BOX, .dimension = 3, .size = a->size[0]};
  if (cprox_body_create_superquadric(half, (vec3){n, n, n}, NULL, &a->body[0]) || cprox_solid_create(&d, NULL, &box))
    exit(1);
  const cprox_solid_description clipped = {.kind = CPROX_SOLID_CLIPPED, .solid = box, .body = a->body[0]};
  if (cprox_solid_create(&clipped, NULL, &a->solid)) exit(1);
  cprox_solid_free(box);
}

static cprox_quat any_turn(rng *r) {
  return rng_quat(r);
}

static cprox_quat no_turn(rng *r) {
  (void)r;
  return (cprox_quat){1, 0, 0, 0};
}

static cprox_quat small_turn(rng *r) {
  const double w = pow(10.0, rng_uniform(r, -12.0, -3.0));
  return (cprox_quat){1, w * rng_uniform(r, -1, 1), w * rng_uniform(r, -1, 1), w * rng_uniform(r, -1, 1)};
}

static const gap_family GAP_FAMILIES[] = {
    {"gap: thin plates", thin, any_turn, false},
    {"gap: a dot among bars", dot_among_bars, any_turn, false},
    {"gap: symmetry face to face", alike, no_turn, true},
    {"gap: sizes 1 to 1e-3 ... 1e-5", unequal, any_turn, false},
    {"gap: nearly equal rotations", alike, small_turn, true},
    {"gap: exponents 20 to 500", edgy, any_turn, false},
};

static vec3 turned(cprox_quat q, vec3 v) {
  const vec3 u = {q.x, q.y, q.z};
  const double norm = q.w * q.w + u.x * u.x + u.y * u.y + u.z * u.z;
  const vec3 t = {2 * (u.y * v.z - u.z * v.y), 2 * (u.z * v.x - u.x * v.z), 2 * (u.x * v.y - u.y * v.x)};
  return (vec3){v.x + (q.w * t.x + u.y * t.z - u.z * t.y) / norm, v.y + (q.w * t.y + u.z * t.x - u.x * t.z) / norm,
                v.z + (q.w * t.z + u.x * t.y - u.y * t.x) / norm};
}

static vec3 inside(rng *r, const side *s) {
  const size_t i = (size_t)rng_index(r, s->n);
  const vec3 z = s->size[i], c = s->at[i].position;
  /* an exponent of 20 leaves nine tenths of a corner's half edge */
  return (vec3){c.x + 0.4 * z.x * rng_uniform(r, -1, 1), c.y + 0.4 * z.y * rng_uniform(r, -1, 1),
                c.z + 0.4 * z.z * rng_uniform(r, -1, 1)};
}

/* The farthest point along n, in the side's frame. */
static vec3 farthest(const side *s, vec3 n) {
  double most = -INFINITY;
  vec3 out = {0, 0, 0};
  for (size_t i = 0; i < s->n; i++) {
    vec3 p;
    const vec3 c = s->at[i].position;
    const double h = cprox_body_support(s->body[i], n, &p) + n.x * c.x + n.y * c.y + n.z * c.z;
    if (h > most) most = h, out = (vec3){p.x + c.x, p.y + c.y, p.z + c.z};
  }
  return out;
}

static double from_boxes(const side *s, vec3 p) {
  double least = INFINITY;
  for (size_t i = 0; i < s->n; i++) {
    const vec3 c = s->at[i].position, z = s->size[i];
    const double x = fmax(fabs(p.x - c.x) - 0.5 * z.x, 0), y = fmax(fabs(p.y - c.y) - 0.5 * z.y, 0),
                 h = fmax(fabs(p.z - c.z) - 0.5 * z.z, 0);
    least = fmin(least, sqrt(x * x + y * y + h * h));
  }
  return least;
}

static overlap_case make_case(const gap_family *f, const gap_pair *p, rng *r, size_t i) {
  overlap_case c = {.pair = p, .place = {.orientation = f->turn(r)}};
  vec3 to, from;
  if (i % 2 == 0) { /* a common point */
    to = inside(r, &p->a), from = turned(c.place.orientation, inside(r, &p->b));
    c.apart = -1.0;
  } else if (p->a.n > 1) { /* a dot between two bars */
    const double reach = 0.5 * sqrt(3.0) * p->b.size[0].x;
    to = (vec3){0.2 * (double)(rng_index(r, 5)) - 0.4 + rng_uniform(r, -0.04, 0.04), rng_uniform(r, -0.4, 0.4),
                rng_uniform(r, -0.02, 0.02)};
    from = (vec3){0, 0, 0};
    c.apart = from_boxes(&p->a, to) - reach;
  } else {
    vec3 n = f->level ? (vec3){1, 0, 0} : rng_unit(r);
    to = farthest(&p->a, n);
    const cprox_quat q = c.place.orientation;
    const vec3 back = turned((cprox_quat){q.w, -q.x, -q.y, -q.z}, (vec3){-n.x, -n.y, -n.z});
    from = turned(q, farthest(&p->b, back));
    c.apart = pow(10.0, rng_uniform(r, -3.0, 0.0));
    to = (vec3){to.x + c.apart * n.x, to.y + c.apart * n.y, to.z + c.apart * n.z};
  }
  c.place.position = (vec3){to.x - from.x, to.y - from.y, to.z - from.z};
  return c;
}

/* proven_apart, proven_overlap: what a method says; neither: it gives up. */
static void judge(const overlap_case *c, bool says_apart, bool says_overlap, bench_answer *a) {
  *a = (bench_answer){.lower = NAN, .upper = NAN};
  a->wrong = c->apart > 0.0 ? says_overlap : says_apart;
  a->failed = !says_apart && !says_overlap;
}

static cprox_obstacle placed(const side *s, size_t i, const cprox_pose *place) {
  cprox_pose at = *place;
  const vec3 by = turned(place->orientation, s->at[i].position);
  at.position = (vec3){at.position.x + by.x, at.position.y + by.y, at.position.z + by.z};
  return cprox_obstacle_at(s->body[i], at);
}

static void by_pairs(const overlap_case *c, bool growth, cprox_workspace *ws, bench_answer *a) {
  const gap_pair *p = c->pair;
  const cprox_pose here = CPROX_POSE_IDENTITY;
  bool apart = true, overlap = false;
  for (size_t i = 0; i < p->a.n; i++)
    for (size_t j = 0; j < p->b.n; j++) {
      const cprox_obstacle x = placed(&p->a, i, &here), y = placed(&p->b, j, &c->place);
      cprox_result r = {.status = CPROX_INVALID};
      cprox_growth g = {.lower = 0.0, .upper = INFINITY};
      double lower, upper;
      if (growth) {
        const bool known = cprox_growth_distance(x, y, NULL, ws, &g) >= 0;
        lower = known ? g.lower - 1.0 : -1.0, upper = known ? g.upper - 1.0 : 1.0;
      } else {
        const bool known = cprox_pair(x, y, NULL, ws, &r) >= 0;
        lower = known ? r.lower : -1.0, upper = known ? r.upper : 1.0;
      }
      apart = apart && lower > 0.0, overlap = overlap || upper < 0.0;
    }
  judge(c, apart, overlap, a);
}

static void distance(const void *problems, size_t i, void *state, bench_answer *a) {
  by_pairs((const overlap_case *)problems + i, false, state, a);
}

static void growth(const void *problems, size_t i, void *state, bench_answer *a) {
  by_pairs((const overlap_case *)problems + i, true, state, a);
}

/* "Collide" is no proof: it is right of an overlap, and gives up what is apart. */
static void by_gap(const overlap_case *c, int k, bool sum_alone, cprox_workspace *ws, bench_answer *a) {
  const cprox_gap *gap = c->pair->gap[k];
  const cprox_pose here = CPROX_POSE_IDENTITY;
  cprox_gap_result r;
  const cprox_status status =
      sum_alone ? cprox_gap_evaluate(gap, &here, &c->place, ws, &r) : cprox_gap_test(gap, &here, &c->place, ws, &r);
  const bool apart = status >= 0 && (r.verdict == CPROX_GAP_VERDICT_CLEAR || r.verdict == CPROX_GAP_VERDICT_FAR);
  judge(c, apart, !apart && c->apart < 0.0, a);
}

static void sum_alone(const void *problems, size_t i, void *state, bench_answer *a) {
  by_gap((const overlap_case *)problems + i, 0, true, state, a);
}

static void verdict(const void *problems, size_t i, void *state, bench_answer *a) {
  by_gap((const overlap_case *)problems + i, 0, false, state, a);
}

static void tuned_sum(const void *problems, size_t i, void *state, bench_answer *a) {
  by_gap((const overlap_case *)problems + i, 1, true, state, a);
}

static void drop_side(side *s) {
  for (size_t i = 0; i < s->n; i++) cprox_body_free(s->body[i]);
  cprox_solid_free(s->solid);
}

static void make_pair(const gap_family *f, rng *r, cprox_workspace *ws, gap_pair *p) {
  *p = (gap_pair){.a = {.n = 0}};
  f->make(r, &p->a, &p->b);
  for (int k = 0; k < GAPS; k++) {
    cprox_gap_options options = CPROX_GAP_OPTIONS_DEFAULT;
    options.mode = k ? CPROX_GAP_MODE_TUNED : CPROX_GAP_MODE_CERTIFIED, options.samples = SAMPLES_OF_GAPS;
    if (cprox_gap_create(p->a.solid, p->b.solid, &options, ws, &p->gap[k])) exit(1);
  }
}

void stability_gaps(const bench_size *size, uint64_t seed, tools *t) {
  enum { PAIRS = 5 };
  const bench_method methods[] = {{"curve_proximity", distance, t->workspace},
                                  {"growth distance", growth, t->workspace},
                                  {"certified gap: V alone", sum_alone, t->workspace},
                                  {"certified gap", verdict, t->workspace},
                                  {"tuned gap: V alone", tuned_sum, t->workspace}};
  for (size_t f = 0; f < sizeof GAP_FAMILIES / sizeof *GAP_FAMILIES; f++) {
    if (!bench_wanted(size, GAP_FAMILIES[f].name)) continue;
    rng r = rng_seed(seed + f);
    gap_pair pairs[PAIRS];
    overlap_case *cases = calloc(size->problems, sizeof *cases);
    if (!cases) exit(1);
    for (int k = 0; k < PAIRS; k++) make_pair(&GAP_FAMILIES[f], &r, t->workspace, &pairs[k]);
    for (size_t i = 0; i < size->problems; i++) cases[i] = make_case(&GAP_FAMILIES[f], &pairs[i % PAIRS], &r, i);
    char parameter[64];
    snprintf(parameter, sizeof parameter, "%zu cases seed %llu", size->problems, (unsigned long long)(seed + f));
    const bench_workload w = {.group = "stability",
                              .name = GAP_FAMILIES[f].name,
                              .parameter = parameter,
                              .problems = cases,
                              .n = size->problems};
    bench_measure(&w, size, methods, sizeof methods / sizeof *methods);
    for (int k = 0; k < PAIRS; k++) {
      for (int i = 0; i < GAPS; i++) cprox_gap_free(pairs[k].gap[i]);
      drop_side(&pairs[k].a), drop_side(&pairs[k].b);
    }
    free(cases);
  }
}
