/* SPDX-License-Identifier: BSD-3-Clause */
#define TREE_TARGET
#define TREE_KERNEL tree_kernel_plain
#include "bvh/kernel.h"
