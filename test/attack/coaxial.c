/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies of revolution whose axes all but coincide, axes 0 or 1e-14 to 1e-2 sizes apart and as much askew, pairs and
 * carried. Every direction bounds the depth from above, in long double, whose own error is 1e-17 of what is added up:
 * the upper end must not lie below any of them, and the lower end of a pair not above what its own normal proves. */
#include <string.h>

#include "attack.h"
#include "support/make_curve.h"
#include "support/reference.h"
#include "support/shapes.h"

/* One of the kinds of revolution, from scale/aspect to scale. */
static void make_of_revolution(rng *r, double scale, double aspect, test_shape *s) {
  const cprox_body_kind kinds[] = {CPROX_BODY_CYLINDER, CPROX_BODY_CONE, CPROX_BODY_CAPSULE, CPROX_BODY_ELLIPSOID};
  const cprox_body_kind kind = kinds[rng_index(r, 4)];
  if (kind != CPROX_BODY_ELLIPSOID) {
    shape_make(r, kind, scale, aspect, s);
    return;
  }
  memset(s, 0, sizeof *s);
  s->kind = kind;
  s->size[0] = s->size[1] = scale * rng_log_uniform(r, 1.0 / aspect, 1.0);
  s->size[2] = scale * rng_log_uniform(r, 1.0 / aspect, 1.0);
  cprox_body_create_ellipsoid(vec(s->size[0], s->size[1], s->size[2]), NULL, &s->body);
}

static cprox_quat times(cprox_quat p, cprox_quat q) {
  return (cprox_quat){p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y, p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x,
                      p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w, p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z};
}

/* By the angle about an axis across z, and spun about z before that; the other way round if flipped. */
static cprox_quat tilted(rng *r, double angle, bool flipped) {
  const double around = rng_uniform(r, 0, 6.28), spin = rng_uniform(r, -3, 3), s = sin(0.5 * angle);
  const cprox_quat tilt = {s * cos(around), s * sin(around), 0, cos(0.5 * angle)};
  const cprox_quat flip = flipped ? (cprox_quat){1, 0, 0, 0} : (cprox_quat){0, 0, 0, 1};
  return times(tilt, times(flip, (cprox_quat){0, 0, sin(0.5 * spin), cos(0.5 * spin)}));
}

typedef struct coaxial {
  test_shape a, b;
  cprox_pose pa, pb;
  double size;
} coaxial;

/* Zero in a fifth of the cases. */
static double slight(rng *r, double least, double most) {
  return rng_index(r, 5) == 0 ? 0.0 : rng_log_uniform(r, least, most);
}

static void coaxial_make(rng *r, coaxial *c) {
  const double scale = rng_log_uniform(r, 1e-3, 1e3), ratio = rng_index(r, 2) ? 1.0 : rng_log_uniform(r, 1e-3, 1.0);
  make_of_revolution(r, scale, 100.0, &c->a);
  make_of_revolution(r, scale * ratio, 100.0, &c->b);
  c->size = scale;
  c->pa = rng_pose(r, rng_index(r, 2) ? scale : 0.0);
  const double reach =
      c->a.size[c->a.kind == CPROX_BODY_ELLIPSOID ? 2 : 1] + c->b.size[c->b.kind == CPROX_BODY_ELLIPSOID ? 2 : 1];
  const double along = rng_uniform(r, -0.7, 0.7) * reach, aside = scale * slight(r, 1e-14, 1e-2),
               around = rng_uniform(r, 0, 6.28);
  const vec3l at = ref_to_world(&c->pa, (vec3l){aside * cos(around), aside * sin(around), along});
  c->pb.position = vec((double)at.x, (double)at.y, (double)at.z);
  c->pb.orientation = times(c->pa.orientation, tilted(r, slight(r, 1e-14, 1e-2), rng_index(r, 2) == 0));
}

/* min over A - B of u·m, u of any length: a lower bound on the signed distance. */
static long double phi(const coaxial *c, vec3l u) {
  const vec3l away = ref_scale(-1, u);
  return ref_dot(u, ref_sub(shape_extreme(&c->a, &c->pa, away), shape_extreme(&c->b, &c->pb, u))) / ref_norm(u);
}

/* Of directions all round the axis and in the planes of the misalignment, the one that leads out soonest, climbed from
 * by smaller and smaller steps. */
static long double soonest_way_out(rng *r, const coaxial *c) {
  long double best = -HUGE_VALL;
  vec3l u = {0, 0, 1};
  for (int i = 0; i < 24; i++)
    for (int j = 0; j <= 8; j++) {
      const double slope = 3.14159265358979 * (j == 4 ? 0.5 : (j + 1e-9) / 8.0), angle = 6.283185307179586 * i / 24.0;
      if (j % 8 == 0 && i > 0) continue;
      const vec3l v = pose_turn(&c->pa, ref_vec(vec(sin(slope) * cos(angle), sin(slope) * sin(angle), cos(slope))));
      const long double there = phi(c, v);
      if (there > best) best = there, u = v;
    }
  double step = 0.2;
  for (int i = 0; i < 150; i++) {
    const vec3l next = ref_add(u, ref_scale(step, ref_vec(rng_unit(r))));
    const long double there = phi(c, next);
    if (there > best) {
      best = there;
      u = ref_scale(1.0L / ref_norm(next), next);
    } else {
      step *= 0.9;
    }
  }
  return best;
}

/* Where b is carried: a curve so short that its length hardly matters, past b's place. */
static cprox_status ask_carried(const coaxial *c, double length, cprox_workspace *ws, cprox_options *options,
                                cprox_result *result) {
  cprox_pose still = c->pb;
  still.position = vec(0, 0, 0);
  cprox_body *turned = NULL;
  const cprox_body *part = c->b.body;
  cprox_curve *curve = NULL;
  const vec3 points[2] = {c->pb.position, vec_add(c->pb.position, vec(0, 0, length))};
  cprox_status status = cprox_body_create_compound(&part, &still, 1, ws, &turned);
  if (status >= 0) status = curve_from(describe_bezier(points, 2, 0.0, 1.0), ws, &curve);
  options->signed_distance = true;
  options->max_nodes = 50; /* each may take as long as a pair; what is left open is true as well */
  if (status >= 0)
    status = cprox_distance(cprox_body_along(turned, curve), cprox_obstacle_at(c->a.body, c->pa), options, ws, result);
  cprox_curve_free(curve);
  cprox_body_free(turned);
  return status;
}

static void compare(attack *t, rng *r, const coaxial *c, const cprox_result *result, bool has_normal, double sign,
                    double room) {
  const long double hair =
      (long double)room + 1e-17L * (long double)(c->size + vec_norm(c->pa.position) + vec_norm(c->pb.position));
  const long double best = soonest_way_out(r, c);
  long double own = HUGE_VALL;
  if (has_normal) own = phi(c, ref_scale(sign, ref_vec(result->normal)));
  attack_check(t, own >= (long double)result->lower - hair && (long double)result->upper >= best - hair,
               "[%.17g, %.17g]: a direction proves %.20Lg, the normal %.20Lg; sizes (%.17g, %.17g) and (%.17g, %.17g)",
               result->lower, result->upper, best, own, c->a.size[0], c->a.size[1], c->b.size[0], c->b.size[1]);
}

static void one_case(attack *t, rng *r) {
  static coaxial c;
  coaxial_make(r, &c);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = c.size * rng_log_uniform(r, 1e-9, 1e-1);
  const bool carried = rng_index(r, 8) == 0, swapped = rng_index(r, 2) == 0;
  attack_kind(t, "%s, %s%s", shape_name(&c.a), shape_name(&c.b), carried ? ", carried" : "");
  const cprox_obstacle a = cprox_obstacle_at(c.a.body, c.pa), b = cprox_obstacle_at(c.b.body, c.pb);
  const double length = carried ? 1e-14 * c.size : 0.0;
  cprox_result result;
  const cprox_status status = carried ? ask_carried(&c, length, t->ws, &options, &result)
                                      : cprox_pair(swapped ? b : a, swapped ? a : b, &options, t->ws, &result);
  attack_check(t, status >= 0, "%s", cprox_workspace_error(t->ws));
  if (status > 0) attack_count(t, cprox_status_name(status));
  if (!attack_failed(t)) {
    const bool has_normal = !carried && vec_norm2(result.normal) > 0.0 && result.upper < 0.0;
    compare(t, r, &c, &result, has_normal, swapped ? -1 : 1, length);
  }
  cprox_body_free(c.a.body);
  cprox_body_free(c.b.body);
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "coaxial", one_case);
}
