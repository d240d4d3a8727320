/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/implicits.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* The numbers of one constraint; returns how many. */
static size_t read_numbers(const char **text, double *number, size_t most) {
  size_t n = 0;
  while (**text == ':') {
    char *end;
    assert_true(n < most);
    number[n++] = strtod(*text + 1, &end);
    assert_true(end > *text + 1);
    *text = end;
  }
  return n;
}

void implicit_case_read(const char *text, implicit_case *c) {
  double number[80];
  *c = (implicit_case){0};
  cprox_implicit_description *d = &c->description;
  for (;;) {
    const char kind = *text++;
    const size_t n = read_numbers(&text, number, 80);
    if (kind == 'H') {
      const size_t k = d->n_hyperquadrics++;
      assert_true(k < 8 && n % 5 == 0);
      memcpy(c->terms[k], number, n * sizeof *number);
      c->hyperquadrics[k] = (cprox_hyperquadric){.terms = (const double(*)[5])c->terms[k], .n_terms = n / 5};
    } else if (kind == 'P') {
      assert_true(n == 4 && d->n_planes < 32);
      memcpy(c->planes[d->n_planes++], number, sizeof *c->planes);
    } else {
      assert_true(kind == 'Q' && n == 10 && d->n_quadrics < 8);
      memcpy(c->quadrics[d->n_quadrics++], number, sizeof *c->quadrics);
    }
    if (*text != '|') break;
    text++;
  }
  assert_int_equal(*text, '\0');
  d->hyperquadrics = c->hyperquadrics;
  d->planes = (const double(*)[4])c->planes;
  d->quadrics = (const double(*)[10])c->quadrics;
}

void implicit_case_paper(int object, implicit_case *c) {
  static const char *const text[] = {
      "H:1:0:0:0:1.3333333333333333:0:1.4285714285714286:0:0:1.4:0:0:0.66666666666666663:0:1.1538461538461537",
      "H:1:0:0:0:2.0909090909090908:0:1:0:0:2.2:0:0:0.58823529411764708:0:13.76923076923077",
      "H:1:0:0:0:8.4444444444444446:0:1:0:0:14.2:0:0:0.66666666666666663:0:13.76923076923077",
      ("H:0.5:0:0:0:2.0909090909090908:0:1:0:0:2.2:0:0:0.58823529411764708:0:2.4285714285714284"
       "|P:-1:0:0:-0.5|P:1:0:0:-0.5|P:0:-1:0:-0.75|P:0:0:-1:0.4"),
      "H:0:1:0:0:16:1:0.5:0:0:16:1:-0.5:0:0:16:0:0:2.5:0:2",
      "H:1:0:1:0:16:0:1:1:0:16:0:0:1:0:16:1:0:-1:0:16:0:1:-1:0:16"};
  assert_true(object >= 1 && object <= 6);
  implicit_case_read(text[object - 1], c);
}

cprox_body *implicit_case_body(const implicit_case *c, const cprox_affine *map) {
  cprox_workspace *workspace = cprox_workspace_create();
  cprox_body *body = NULL;
  if (cprox_body_create_implicit(&c->description, map, workspace, &body) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(workspace));
  cprox_workspace_free(workspace);
  return body;
}

long double implicit_case_value(const implicit_case *c, const long double x[3]) {
  const cprox_implicit_description *d = &c->description;
  long double most = -INFINITY;
  for (size_t k = 0; k < d->n_planes; k++) {
    const double *p = d->planes[k];
    most = fmaxl(most, p[0] * x[0] + p[1] * x[1] + p[2] * x[2] + p[3]);
  }
  for (size_t k = 0; k < d->n_quadrics; k++) {
    const double *q = d->quadrics[k];
    most = fmaxl(most, q[0] * x[0] * x[0] + q[3] * x[1] * x[1] + q[5] * x[2] * x[2] +
                           2 * (q[1] * x[0] * x[1] + q[2] * x[0] * x[2] + q[4] * x[1] * x[2]) + q[6] * x[0] +
                           q[7] * x[1] + q[8] * x[2] + q[9]);
  }
  for (size_t k = 0; k < d->n_hyperquadrics; k++) {
    long double sum = -1;
    for (size_t i = 0; i < d->hyperquadrics[k].n_terms; i++) {
      const double *t = d->hyperquadrics[k].terms[i];
      sum += powl(fabsl(t[0] * x[0] + t[1] * x[1] + t[2] * x[2] + t[3]), t[4]);
    }
    most = fmaxl(most, sum);
  }
  return most;
}

cprox_pose implicit_random_pose(rng *r, double near, double far) {
  const vec3 direction = rng_unit(r);
  return (cprox_pose){.position = vec_scale(rng_uniform(r, near, far), direction), .orientation = rng_quat(r)};
}
