/* SPDX-License-Identifier: BSD-3-Clause */
#define EDGE_TARGET
#define EDGE_KERNEL edge_kernel_plain
#include "edges/kernel.h"
