/* SPDX-License-Identifier: BSD-3-Clause */
/* The test template that every collision detector of MoveIt passes. */
#include <moveit/collision_detection/test_collision_common_panda.h>

#include "collision_env.h"

using Allocator = curve_proximity::CollisionDetectorAllocatorCurveProximity;

INSTANTIATE_TYPED_TEST_CASE_P(CurveProximityPanda, CollisionDetectorPandaTest, Allocator);
INSTANTIATE_TYPED_TEST_CASE_P(CurveProximityPanda, DistanceFullPandaTest, Allocator);
INSTANTIATE_TYPED_TEST_CASE_P(CurveProximityPanda, DistanceCheckPandaTest, Allocator);

int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
