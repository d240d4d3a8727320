/* SPDX-License-Identifier: BSD-3-Clause */
#include "scenes.h"

#include <math.h>
#include <string.h>

static const cprox_pose HERE = {.orientation = {1, 0, 0, 0}};

/* ---- what is where at a parameter ---- */

static vec3l mover_nearest(const scene *s, vec3l at, vec3l p) {
  if (!s->bodied) return at;
  vec3l q;
  body_nearest(&s->body, &HERE, ref_sub(p, at), &q);
  return ref_add(at, q);
}

/* The nearest point of the obstacle's curve at rest, at any parameter; p in its frame. */
static vec3l nearest_on_path(const random_path *path, vec3l p) {
  enum { SAMPLES = 48 };
  long double least = HUGE_VALL, t = path->t0;
  vec3l best = {0, 0, 0};
  const long double step = ((long double)path->t1 - path->t0) / SAMPLES;
  for (int i = 0; i <= SAMPLES; i++) {
    const vec3l x = path_at(path, fminl(path->t0 + step * i, path->t1));
    const long double d = ref_norm(ref_sub(x, p));
    if (!(d < least)) continue;
    least = d;
    best = x;
    t = fminl(path->t0 + step * i, path->t1);
  }
  for (long double width = 0.5L * step; width > 1e-7L * step; width *= 0.5L)
    for (int side = -1; side <= 1; side += 2) {
      const long double u = fmaxl(path->t0, fminl(path->t1, t + side * width));
      const vec3l x = path_at(path, u);
      const long double d = ref_norm(ref_sub(x, p));
      if (!(d < least)) continue;
      least = d;
      best = x;
      t = u;
    }
  return best;
}

static vec3l obstacle_nearest(const obstacle *o, long double t, double at, vec3l p) {
  vec3l q;
  if (!o->curved) {
    body_nearest(&o->body, &o->pose, p, &q);
    return q;
  }
  const vec3l own = ref_to_local(&o->pose, p);
  vec3l c;
  if (o->synchronized)
    c = path_at(&o->path, t);
  else
    c = isnan(at) ? nearest_on_path(&o->path, own) : path_at(&o->path, at);
  if (!o->bodied) return ref_to_world(&o->pose, c);
  body_nearest(&o->body, &HERE, ref_sub(own, c), &q);
  return ref_to_world(&o->pose, ref_add(c, q));
}

long double scene_off_mover(const scene *s, long double t, vec3l p) {
  const vec3l at = path_at(&s->path, t);
  return fmaxl(0.0L, ref_norm(ref_sub(p, mover_nearest(s, at, p))) - s->radius);
}

long double scene_off_obstacle(const scene *s, size_t i, long double t, double at, vec3l p) {
  const obstacle *o = &s->obstacles[i];
  return fmaxl(0.0L, ref_norm(ref_sub(p, obstacle_nearest(o, t, at, p))) - o->margin);
}

bool scene_is_exact(const scene *s, size_t i) {
  const obstacle *o = &s->obstacles[i];
  return !s->bodied && (!o->curved || o->synchronized);
}

/* Points of both in turns: each step brings them closer, and the sets are convex or the bound is but a bound. */
static long double alternate(const scene *s, const obstacle *o, long double t, double at, vec3l x) {
  vec3l p = x;
  long double d = HUGE_VALL;
  for (int i = 0; i < 30; i++) {
    const vec3l q = obstacle_nearest(o, t, at, p);
    p = mover_nearest(s, x, q);
    const long double now = ref_norm(ref_sub(p, q));
    const bool done = !(now < d * (1.0L - 1e-12L));
    d = fminl(d, now);
    if (done) break;
  }
  return d;
}

long double scene_distance(const scene *s, size_t i, long double t, double at) {
  const obstacle *o = &s->obstacles[i];
  const vec3l x = path_at(&s->path, t);
  const long double thick = (long double)s->radius + o->margin;
  if (s->bodied) return alternate(s, o, t, at, x) - thick;
  const long double d = ref_norm(ref_sub(x, obstacle_nearest(o, t, at, x)));
  if (d > 0.0L || o->curved || !o->body.depth) return d - thick;
  return -body_depth(&o->body, &o->pose, x) - thick;
}

/* ---- errors of the reference ---- */

static long double reach(const scene *s, size_t i) {
  const obstacle *o = &s->obstacles[i];
  return (long double)s->path.extent + s->body.extent + s->radius + o->body.extent + o->path.extent + o->margin +
         vec_norm(o->pose.position);
}

static long double power_room(const random_body *b) {
  for (size_t k = 0; k < b->n_parts; k++)
    if (b->parts[k].form == FORM_POWER) return 0x1p-46L * b->extent;
  return 0.0L;
}

long double scene_room(const scene *s, size_t i) {
  const obstacle *o = &s->obstacles[i];
  const long double given = (long double)s->body.slack + o->body.slack;
  return 0x1p-56L * reach(s, i) + given + power_room(&o->body) + power_room(&s->body);
}

double scene_step(const random_path *p) {
  return 4.0 * 0x1p-53 * fmax(fabs(p->t0), fabs(p->t1));
}

/* Points in double, poses of double, curves as far from their pieces as they say, parameters of double. */
long double scene_witness_room(const scene *s, size_t i) {
  const obstacle *o = &s->obstacles[i];
  long double room =
      0x1p-46L * reach(s, i) + 4.0L * scene_room(s, i) + 2.0L * cprox_curve_get_info(s->path.curve).error;
  if (o->curved) room += 2.0L * cprox_curve_get_info(o->path.curve).error;
  return room + 1e-11L * s->scale;
}

/* ---- searching ---- */

typedef struct best {
  long double d;
  double t;
} best;

static void look(const scene *s, size_t i, double t, double t0, double t1, best *b) {
  const double inside = fmax(t0, fmin(t1, t));
  const long double d = scene_distance(s, i, inside, NAN);
  if (d < b->d) *b = (best){d, inside};
}

long double scene_least(const scene *s, size_t i, rng *r, double t, double t0, double t1, double *where) {
  best b = {HUGE_VALL, t0};
  const double length = t1 - t0;
  enum { SAMPLES = 24 };
  const int samples = scene_is_exact(s, i) ? SAMPLES : 10;
  for (int k = 0; k <= samples; k++) look(s, i, t0 + length * k / samples, t0, t1, &b);
  for (int k = 0; k < 8; k++) look(s, i, rng_uniform(r, t0, t1), t0, t1, &b);
  if (t >= t0 && t <= t1) {
    look(s, i, t, t0, t1, &b);
    for (int k = 0; k < 8; k++)
      look(s, i, t + (k % 2 ? 1.0 : -1.0) * length * rng_log_uniform(r, 1e-12, 1e-1), t0, t1, &b);
  }
  for (double width = length / samples / 2.0; width > 1e-9 * length; width *= 0.4) {
    look(s, i, b.t - width, t0, t1, &b);
    look(s, i, b.t + width, t0, t1, &b);
  }
  *where = b.t;
  return b.d;
}

/* ---- making ---- */

static cprox_pose place(rng *r, double scale, vec3 origin, bool planar) {
  cprox_pose pose = rng_pose(r, 2.5 * scale);
  if (rng_index(r, 4) == 0) pose.orientation = (cprox_quat){1, 0, 0, 0};
  if (planar) {
    pose.orientation = (cprox_quat){pose.orientation.w, 0, 0, pose.orientation.z};
    pose.position.z = 0.0;
  }
  pose.position = vec_add(pose.position, origin);
  const double norm = rng_index(r, 3) ? 1.0 : rng_log_uniform(r, 1e-6, 1e6);
  pose.orientation.w *= norm;
  pose.orientation.x *= norm;
  pose.orientation.y *= norm;
  pose.orientation.z *= norm;
  return pose;
}

static bool make_obstacle(attack *a, rng *r, const scene *s, vec3 origin, obstacle *o) {
  o->margin = rng_index(r, 3) ? 0.0 : s->scale * rng_uniform(r, 0.0, 0.3);
  o->pose = place(r, s->scale, origin, s->planar);
  o->curved = rng_index(r, 6) == 0;
  if (!o->curved) {
    /* meshes, points and boxes refuse bodies on curves: seldom asked */
    const size_t kind =
        s->planar && rng_index(r, 2) ? 8 : rng_index(r, s->bodied && rng_index(r, 50) ? 16 : BODY_KINDS);
    body_make(a, r, kind, s->scale, &o->body);
    o->target = cprox_with_margin(cprox_obstacle_at(o->body.body, o->pose), o->margin);
    return o->body.body;
  }
  /* its curve is made about its own frame's origin; on the clock over the same range */
  const path_family family = (path_family)rng_index(r, PATH_FAMILIES);
  const bool by_length = (family == PATH_RECTIFIABLE) != (s->path.family == PATH_RECTIFIABLE);
  const bool long_range = s->path.t1 - s->path.t0 > 20.0; /* arc lengths: too many turns for a trigonometric series */
  o->synchronized = rng_index(r, 2) && path_has_range(family) && !by_length && !long_range;
  const double t0 = o->synchronized ? s->path.t0 : 0.0, t1 = o->synchronized ? s->path.t1 : 1.0;
  path_make_on(a, r, family, s->scale, vec(0, 0, 0), s->planar, t0, t1, &o->path);
  if (!o->path.curve) return false;
  if (!o->synchronized) {
    o->target = cprox_obstacle_curve(o->path.curve, o->margin);
    o->target.pose = o->pose;
    return true;
  }
  o->bodied = rng_index(r, 3) == 0;
  if (o->bodied) body_make(a, r, rng_index(r, 13), s->scale, &o->body);
  if (o->bodied && !o->body.body) return false;
  cprox_mover other = o->bodied ? cprox_body_along(o->body.body, o->path.curve) : cprox_point_along(o->path.curve);
  other.radius = o->margin;
  o->target = cprox_synchronized(other);
  o->target.pose = o->pose;
  return true;
}

bool scene_make(attack *a, rng *r, scene *s) {
  memset(s, 0, sizeof *s);
  s->scale = rng_index(r, 2) ? 1.0 : rng_log_uniform(r, 1e-6, 1e6);
  s->planar = rng_index(r, 5) == 0;
  const double far[] = {0.0, 0.0, 1e3, 1e6};
  const double away = s->scale > 1.0 ? s->scale * far[rng_index(r, 3)] : far[rng_index(r, 4)] * fmax(s->scale, 1e-3);
  const vec3 anywhere = rng_in_cube(r, away), origin = vec(anywhere.x, anywhere.y, s->planar ? 0.0 : anywhere.z);
  path_make(a, r, (path_family)rng_index(r, PATH_FAMILIES), s->scale, origin, s->planar, &s->path);
  if (!s->path.curve) return false;
  s->radius = rng_index(r, 2) ? 0.0 : s->scale * rng_uniform(r, 0.0, 0.3);
  s->bodied = !s->planar && rng_index(r, 3) == 0;
  s->mover = cprox_tube_along(s->path.curve, s->radius);
  if (s->bodied) {
    body_make(a, r, body_carried_kind(r), s->scale, &s->body);
    if (!s->body.body) return false;
    s->mover = cprox_body_along(s->body.body, s->path.curve);
    s->mover.radius = s->radius;
  }
  const size_t n = rng_index(r, 2) ? 1 : 1 + rng_index(r, SCENE_OBSTACLES);
  for (s->n = 0; s->n < n; s->n++) {
    if (!make_obstacle(a, r, s, origin, &s->obstacles[s->n])) {
      s->n++;
      return false;
    }
    s->targets[s->n] = s->obstacles[s->n].target;
  }
  return true;
}

void scene_free(scene *s) {
  path_free(&s->path);
  body_free(&s->body);
  for (size_t i = 0; i < s->n; i++) {
    path_free(&s->obstacles[i].path);
    body_free(&s->obstacles[i].body);
  }
}
