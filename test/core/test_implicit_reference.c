/* SPDX-License-Identifier: BSD-3-Clause */
/* Implicit bodies against answers in quadruple precision: the paper's pairs, and families on which solvers fail. */
#include <stdlib.h>

#include "curve_proximity/cprox/query.h"
#include "shape/body.h"
#include "support/cases.h"
#include "support/csv.h"
#include "support/implicits.h"

enum { TAG = 1, X_NAME = 2, X_DEFINITION = 4, Y_DEFINITION = 5, POSES = 6, LOWER = 20, UPPER = 21 };

static cprox_obstacle read_side(const csv_table *table, const csv_row *row, size_t definition, size_t pose) {
  implicit_case c;
  implicit_case_read(row->field[definition], &c);
  double p[7];
  for (size_t i = 0; i < 7; i++) p[i] = csv_number(table, row, pose + i);
  return cprox_obstacle_at(implicit_case_body(&c, NULL),
                           (cprox_pose){.position = {p[4], p[5], p[6]}, .orientation = {p[0], p[1], p[2], p[3]}});
}

/* Every row of a file: the interval contains the reference, and is as narrow as asked, relative to distance and sizes.
 */
static void check_rows(const char *name, double relative) {
  csv_table table = csv_read(name);
  cprox_workspace *workspace = cprox_workspace_create();
  size_t wrong = 0, wide = 0;
  for (size_t i = 1; i < table.n; i++) {
    const csv_row *row = &table.row[i];
    cprox_obstacle a = read_side(&table, row, X_DEFINITION, POSES), b = read_side(&table, row, Y_DEFINITION, POSES + 7);
    const double lower = csv_number(&table, row, LOWER), upper = csv_number(&table, row, UPPER);
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = relative * (upper + a.body->ball_radius + b.body->ball_radius);
    cprox_result r;
    const cprox_status status = cprox_pair(a, b, &options, workspace, &r);
    assert_true(status >= 0);
    const double least = lower - 1e-15 * upper, most = upper + 1e-15 * upper;
    const bool contains = fmax(r.lower, 0.0) <= most && fmax(r.upper, 0.0) >= least;
    /* overlapping: how deep is another query */
    const bool narrow = fmax(r.upper, 0.0) - fmax(r.lower, 0.0) <= 1.0001 * options.epsilon;
    if (!contains || !narrow)
      print_message("%s:%zu %s %s-%s: [%.17g, %.17g], width %.2g of %.2g asked, reference %.17g\n", name, row->line,
                    row->field[TAG], row->field[X_NAME], row->field[X_NAME + 1], r.lower, r.upper, r.upper - r.lower,
                    options.epsilon, upper);
    wrong += !contains;
    wide += !narrow;
    cprox_body_free((cprox_body *)(uintptr_t)a.body);
    cprox_body_free((cprox_body *)(uintptr_t)b.body);
  }
  print_message("%s at %g: %zu rows, %zu wrong, %zu too wide\n", name, relative, table.n - 1, wrong, wide);
  assert_int_equal(wrong, 0);
  assert_int_equal(wide, 0);
  cprox_workspace_free(workspace);
  csv_free(&table);
}

CASE(the_papers_pairs_contain_the_reference_at_1e_8) {
  check_rows("reference/implicit_pairs.csv", 1e-8);
}

CASE(the_papers_pairs_contain_the_reference_at_1e_10) {
  check_rows("reference/implicit_pairs.csv", 1e-10);
}

CASE(the_hard_families_contain_the_reference_at_1e_8) {
  check_rows("reference/implicit_hard.csv", 1e-8);
}

CASE(the_hard_families_contain_the_reference_at_1e_10) {
  check_rows("reference/implicit_hard.csv", 1e-10);
}

int main(void) {
  return cases_run(NULL, NULL);
}
