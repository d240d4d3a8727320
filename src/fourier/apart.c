/* SPDX-License-Identifier: BSD-3-Clause */
#include "fourier/apart.h"

#include <stdlib.h>

enum { CELLS = ENCLOSURE_CELLS, SIDE = ENCLOSURE_SIDE, TABLE = ENCLOSURE_TABLE };

static size_t entry(int x, int y, int z) {
  return ((size_t)(x + CELLS) * SIDE + (size_t)(y + CELLS)) * SIDE + (size_t)(z + CELLS);
}

/* Calls with each of the directions until one says true. */
typedef bool (*visitor)(int x, int y, int z, void *user);

static bool visit_directions(int dimension, visitor visit, void *user) {
  for (int x = -CELLS; x <= CELLS; x++)
    for (int y = abs(x) - CELLS; y <= CELLS - abs(x); y++) {
      const int z = CELLS - abs(x) - abs(y);
      if (dimension == 2 && z != 0) continue;
      if (visit(x, y, z, user) || (z != 0 && visit(x, y, -z, user))) return true;
    }
  return false;
}

/* ---- making ---- */

typedef struct filling {
  const cprox_solid *solid;
  size_t from, to; /* pieces */
  double *table;
} filling;

static bool fill(int x, int y, int z, void *user) {
  const filling *f = user;
  const vec3 v = vec(x, y, z);
  double height = -INFINITY;
  for (size_t i = f->from; i < f->to; i++)
    height = fmax(height, piece_height(&f->solid->pieces[i], f->solid->dimension, v));
  f->table[entry(x, y, z)] = height - vec_dot(v, f->solid->centre);
  return false;
}

bool enclosures_make(const cprox_solid *solid, bool merged, enclosures *out) {
  out->n = merged ? 1 : solid->n;
  out->height = calloc(out->n * TABLE, sizeof *out->height);
  for (size_t i = 0; out->height && i < out->n; i++) {
    filling f = {solid, merged ? 0 : i, merged ? solid->n : i + 1, out->height + i * TABLE};
    visit_directions(solid->dimension, fill, &f);
  }
  return out->height != NULL;
}

void enclosures_free(enclosures *e) {
  free(e->height);
  *e = (enclosures){0};
}

/* ---- asking ---- */

/* An upper bound of the support value: w = sum of l v over the directions v of its cell, l >= 0, and support values are
 * sublinear. With c the whole parts of w in units of the lattice, the cell's directions are c + e_j where the parts
 * left are 1 together, and c + (1, 1, 1) - e_j where they are 2. */
static double height_over(const double *table, vec3 w) {
  const double size = fabs(w.x) + fabs(w.y) + fabs(w.z), at[3] = {w.x, w.y, w.z};
  int whole[3], sign[3], left = CELLS;
  double part[3];
  for (int j = 0; j < 3; j++) {
    const double along = fabs(at[j]) * CELLS / size;
    whole[j] = along < CELLS ? (int)along : CELLS;
    part[j] = along - whole[j], sign[j] = at[j] < 0.0 ? -1 : 1, left -= whole[j];
  }
  double sum = 0.0;
  for (int j = 0; j < (left == 0 ? 1 : 3); j++) {
    int v[3];
    for (int k = 0; k < 3; k++) v[k] = sign[k] * (whole[k] + (left == 2 ? j != k : left == 1 && j == k));
    const double share = left == 0 ? 1.0 : left == 1 ? part[j] : 1.0 - part[j];
    if (share > 0.0) sum += share * table[entry(v[0], v[1], v[2])];
  }
  return sum * size / CELLS;
}

typedef struct pair_of_parts {
  const double *first, *second, *turn;
  vec3 x;
  double rounding, found;
} pair_of_parts;

/* Each direction in the frame of the one, where its support value is known, and then in that of the other. */
static bool separate(int i, int j, int k, void *user) {
  pair_of_parts *p = user;
  const vec3 v = vec(i, j, k), back = rotate_back(p->turn, v), forth = rotate(p->turn, v);
  const double by_first = vec_dot(p->x, v) - p->first[entry(i, j, k)] - height_over(p->second, vec_neg(back));
  const double by_second = -vec_dot(p->x, forth) - p->second[entry(i, j, k)] - height_over(p->first, vec_neg(forth));
  p->found = fmax(by_first, by_second) / vec_norm(v) - p->rounding;
  return p->found > 0.0;
}

double enclosures_apart(const enclosures *first, const enclosures *second, int dimension, const double turn[9], vec3 x,
                        double size) {
  double least = INFINITY;
  for (size_t i = 0; i < first->n; i++)
    for (size_t j = 0; j < second->n; j++) {
      pair_of_parts p = {.first = first->height + i * TABLE,
                         .second = second->height + j * TABLE,
                         .turn = turn,
                         .x = x,
                         .rounding = 1e-13 * (vec_norm(x) + size)};
      if (!visit_directions(dimension, separate, &p)) return 0.0;
      least = fmin(least, p.found);
    }
  return isinf(least) ? 0.0 : least;
}
