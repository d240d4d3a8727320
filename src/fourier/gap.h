/* SPDX-License-Identifier: BSD-3-Clause */
/* The inside of a gap: the fixed solid's spectrum times the kernel in blocks of lattice points, and the turned solid.
 */
#ifndef CPROX_FOURIER_GAP_H
#define CPROX_FOURIER_GAP_H

#include "fourier/apart.h"
#include "fourier/kernel.h"
#include "fourier/lookup.h"
#include "fourier/solid.h"
#include "simd/dispatch.h"

/* Lattice points with one k_y, k_z and LANES consecutive k_x are summed side by side. */
enum { LANES = 8 };

typedef struct block {
  int32_t k[3]; /* of the first lane */
} block;

/* What a pair needs before its spectra are computed. */
typedef struct gap_plan {
  cprox_gap_mode mode;
  int dimension, N;
  double beta, period, offset;
  double over_reach;
  bool unbounded;    /* no over-reach can be proven, however many samples */
  bool turned_first; /* whether the first solid is the one to turn; the lattice lies in the other's frame */
  bool tabulated;    /* the turned solid is a grid, whose spectrum is looked up */
  double bytes;      /* of its table */
  double cell[2];    /* of the cells that cover the first and the second solid in its place [m]; 0: it is what it is */
} gap_plan;

struct cprox_gap {
  cprox_gap_info info;
  double inverse;      /* of the threshold times L^d: the sum times this is the value */
  double half_energy;  /* (L^d integral of T² - T(0)²)/2, at least the sum over J of |T|² */
  double constant;     /* C(0) T(0) */
  double steepness;    /* the gradient of a value by the position is never longer [1/m] */
  double curvature;    /* no second derivative of a value along a line of positions is larger [1/m²] */
  double stirring[2];  /* the same where each point of the turned solid moves by a vector of its own */
  double turned_reach; /* every point of the offset turned solid is within this of its centre [m] */
  vec3 centre_a, centre_b;
  double radius_a, radius_b;     /* of the bare solids about these */
  enclosures bounds_a, bounds_b; /* per direction, of the bare solids */
  cprox_solid *turned;           /* offset, about its centre; NULL: a table, or a ball, folded into the coefficients */
  spectrum_table *table;         /* of the turned solid, or NULL */
  double images;                 /* what the images of a tabulated solid add to a value at most */
  int N;
  size_t n_blocks;
  block *blocks;   /* by descending energy of the coefficients */
  double *c;       /* 2 LANES a block: real parts, imaginary parts */
  double *tail;    /* n_blocks + 1: 2 sqrt(sum over the blocks from here on of |C|²) */
  simd_level simd; /* how wide sums are computed; results are the same bit for bit */
};

/* One sum: what goes in, and what comes out. */
typedef struct gap_job {
  const cprox_gap *gap;
  double turn[9]; /* turned to fixed frame */
  vec3 x;         /* position of the turned solid in the fixed one's frame */
  void *scratch;  /* gap_scratch_size() bytes */
  bool gradient, early;
  /* out, times 1/threshold */
  double value, tail;
  vec3 position, moment; /* gradient by x; by rotation, in the fixed frame */
  size_t blocks;
} gap_job;

/* Bytes of scratch memory a sum needs. */
size_t gap_scratch_size(const cprox_gap *gap);

void gap_sum(gap_job *job);

/* CPROX_OK, or why it is none. */
cprox_status gap_check_pose(const char *name, const cprox_pose *pose, int dimension, cprox_workspace *workspace);

/* The solids at these poses, which are usable, are at least so far apart: by their bounding spheres or by a direction
 * that separates each pair of parts. 0: neither says so. */
double gap_clearance(const cprox_gap *gap, const cprox_pose *a, const cprox_pose *b);

/* Makes a gap of solids that are offset and centred already (both are taken over, also on failure). radius and centre:
 * those of the bare ones. */
cprox_status gap_build(const gap_plan *plan, cprox_solid *a, cprox_solid *b, size_t memory_limit,
                       cprox_workspace *workspace, cprox_gap **gap);

/* A copy of the caller's options, of NULL the default. Options of another size are not read: the copy is the default
 * with their size, which gap_plan_choose() refuses. */
cprox_gap_options gap_options(const cprox_gap_options *options);

/* The solids that a plan is about: those given, or covers of them, for gap_forms_free(). */
cprox_status gap_forms(const gap_plan *plan, const cprox_solid *a, const cprox_solid *b, cprox_workspace *workspace,
                       const cprox_solid *form[2]);
void gap_forms_free(const cprox_solid *a, const cprox_solid *b, const cprox_solid *form[2]);

/* What the images of a tabulated solid can overlap a solid of this peak and measure. */
double gap_images(const table_bounds *table, double peak, double measure);

/* |q| of the lattice's farthest point. */
double gap_farthest_frequency(int N, double period);

/* Chooses the plan for what the options ask. */
cprox_status gap_plan_choose(const cprox_solid *a, const cprox_solid *b, const cprox_gap_options *options,
                             cprox_workspace *workspace, gap_plan *plan);

/* The threshold of a plan (period and offset set): t, or that of a sweep; in units of the measure squared over L^d. */
double gap_threshold(const kernel *k, const gap_plan *plan, const cprox_solid *a, const cprox_solid *b);

/* The signal's blur sigma, in L/n. */
#define GAP_SIGNAL_BLUR 2.2

/* Of a signal whose threshold and rounding are known: between what it lies where the bare solids touch. false where
 * memory is out. */
bool gap_bound_touching(const gap_plan *plan, const kernel *k, const cprox_solid *a, const cprox_solid *b,
                        cprox_gap_info *info);

/* How much it costs to turn a solid; 0 for a ball. */
double gap_cost_of_turning(const cprox_solid *s);

/* Bytes that a gap of n samples will hold, at most. */
double gap_bytes(int dimension, int N);

#endif
