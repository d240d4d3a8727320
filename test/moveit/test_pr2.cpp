/* SPDX-License-Identifier: BSD-3-Clause */
/* The test template that every collision detector of MoveIt passes. Without NDEBUG it asserts no times: these fail
 * beside other work. */
#undef NDEBUG
#include <moveit/collision_detection/test_collision_common_pr2.h>

#include "collision_env.h"

using Allocator = curve_proximity::CollisionDetectorAllocatorCurveProximity;

INSTANTIATE_TYPED_TEST_CASE_P(CurveProximityPr2, CollisionDetectorTest, Allocator);

int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
