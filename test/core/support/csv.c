/* SPDX-License-Identifier: BSD-3-Clause */
#include "csv.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static char *read_text(const char *path) {
  FILE *file = fopen(path, "rb");
  if (!file) fail_msg("%s cannot be opened", path);
  size_t size = 0, room = 1 << 16;
  char *text = malloc(room);
  while (text) {
    size += fread(text + size, 1, room - 1 - size, file);
    if (size < room - 1) break;
    room *= 2;
    text = realloc(text, room);
  }
  fclose(file);
  if (!text) fail_msg("%s: no memory", path);
  text[size] = '\0';
  return text;
}

csv_table csv_read(const char *name) {
  csv_table table = {.path = name};
  char path[1024];
  snprintf(path, sizeof path, "%s/%s", TEST_DATA_DIR, name);
  table.text = read_text(path);

  /* room for every line and every field */
  size_t lines = 1, commas = 0;
  for (const char *c = table.text; *c; c++) lines += *c == '\n', commas += *c == ',';
  table.row = calloc(lines, sizeof *table.row);
  table.fields = calloc(lines + commas, sizeof *table.fields);
  assert_non_null(table.row);
  assert_non_null(table.fields);

  char **next = table.fields;
  size_t line = 0;
  for (char *at = table.text; *at;) {
    /* one line, without its end */
    char *end = at + strcspn(at, "\r\n");
    char *following = end + strspn(end, "\r");
    if (*following == '\n') following++;
    line++;
    if (end > at && *at != '#') {
      *end = '\0';
      csv_row *row = &table.row[table.n++];
      row->line = line;
      row->field = next;
      for (char *field = at; field;) {
        row->field[row->n++] = field;
        field = strchr(field, ',');
        if (field) *field++ = '\0';
      }
      next += row->n;
    }
    at = following;
  }
  return table;
}

void csv_free(csv_table *table) {
  free(table->text);
  free(table->row);
  free(table->fields);
}

const csv_row *csv_find(const csv_table *table, const char *id) {
  for (size_t i = 0; i < table->n; i++)
    if (strcmp(table->row[i].field[0], id) == 0) return &table->row[i];
  fail_msg("%s has no row %s", table->path, id);
  return NULL;
}

double csv_number(const csv_table *table, const csv_row *row, size_t field) {
  if (field >= row->n) fail_msg("%s, line %zu: field %zu is missing", table->path, row->line, field + 1);
  char *end;
  const double value = strtod(row->field[field], &end);
  if (end == row->field[field] || *end)
    fail_msg("%s, line %zu: field %zu is \"%s\", not a number", table->path, row->line, field + 1, row->field[field]);
  return value;
}

size_t csv_count(const csv_table *table, const csv_row *row, size_t field) {
  const double value = csv_number(table, row, field);
  if (!(value >= 0.0 && value <= 1e9 && value == floor(value)))
    fail_msg("%s, line %zu: field %zu is \"%s\", not a count", table->path, row->line, field + 1, row->field[field]);
  return (size_t)value;
}

void csv_points(const csv_table *table, const csv_row *row, size_t field, size_t dim, size_t n, vec3 *points) {
  for (size_t i = 0; i < n; i++) {
    const size_t at = field + i * dim;
    points[i] = vec(csv_number(table, row, at), csv_number(table, row, at + 1),
                    dim == 3 ? csv_number(table, row, at + 2) : 0.0);
  }
}

void csv_curve_case_read(const csv_table *table, const csv_row *row, csv_curve_case *c) {
  c->id = row->field[0];
  c->kind = row->n > 1 ? row->field[1] : "";
  c->dim = csv_count(table, row, 2);
  c->n_points = csv_count(table, row, 3) + 1;
  c->n_vertices = csv_count(table, row, 4);
  if (c->dim < 2 || c->dim > 3 || c->n_points > sizeof c->points / sizeof c->points[0] ||
      c->n_vertices > sizeof c->vertices / sizeof c->vertices[0] ||
      row->n != 5 + c->dim * (c->n_points + c->n_vertices))
    fail_msg("%s, line %zu: dimension %zu, %zu points and %zu vertices do not fit %zu fields", table->path, row->line,
             c->dim, c->n_points, c->n_vertices, row->n);
  csv_points(table, row, 5, c->dim, c->n_points, c->points);
  csv_points(table, row, 5 + c->dim * c->n_points, c->dim, c->n_vertices, c->vertices);
}
