/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads the reference files of test/data: one record a line, fields between commas, lines that begin with # skipped.
 * Whatever is wrong with a file fails the test with a message. */
#ifndef CPROX_TEST_CSV_H
#define CPROX_TEST_CSV_H

#include <stddef.h>

#include "base/vec.h"

typedef struct csv_row {
  size_t line; /* in the file, from 1 */
  size_t n;
  char **field;
} csv_row;

typedef struct csv_table {
  const char *path;
  size_t n;
  csv_row *row;
  char *text;    /* the file, cut into strings */
  char **fields; /* of all rows */
} csv_table;

/* All rows of the file TEST_DATA_DIR/name. csv_free() frees. */
csv_table csv_read(const char *name);
void csv_free(csv_table *table);

/* The row whose first field is the id; the test fails where there is none. */
const csv_row *csv_find(const csv_table *table, const char *id);

/* A field as a number ("inf" and "nan" too) or a count; the test fails where it is none. */
double csv_number(const csv_table *table, const csv_row *row, size_t field);
size_t csv_count(const csv_table *table, const csv_row *row, size_t field);

/* n points of dim (2 or 3) coordinates from the field on; z = 0 where dim is 2. */
void csv_points(const csv_table *table, const csv_row *row, size_t field, size_t dim, size_t n, vec3 *points);

/* A row of curve_point, curve_polygon, curve3d and edge: `id,kind,dim,order,nverts,cp…,verts…`. */
typedef struct csv_curve_case {
  const char *id, *kind;
  size_t dim, n_points, n_vertices;
  vec3 points[64];
  vec3 vertices[1024];
} csv_curve_case;

void csv_curve_case_read(const csv_table *table, const csv_row *row, csv_curve_case *c);

#endif
