/* SPDX-License-Identifier: BSD-3-Clause */
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

/* Meshes are kept in a cache directory of the test's own. */
int main(int argc, char **argv) {
  testing::InitGoogleTest(&argc, argv);
  std::string cache = (std::filesystem::temp_directory_path() / "curve_proximity_cache_XXXXXX").string();
  if (!mkdtemp(cache.data()) || setenv("XDG_CACHE_HOME", cache.c_str(), 1) != 0) return 2;
  const int failed = RUN_ALL_TESTS();
  std::error_code ignored;
  std::filesystem::remove_all(cache, ignored);
  return failed;
}
