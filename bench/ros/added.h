/* SPDX-License-Identifier: BSD-3-Clause */
/* What the groups share that measure what something adds to the core's calls. */
#ifndef CURVE_PROXIMITY_BENCH_ROS_ADDED_H
#define CURVE_PROXIMITY_BENCH_ROS_ADDED_H

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

/* [us] of this thread's CPU. */
inline double now() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

inline double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
}

/* A row of results.csv. */
inline void printRow(const char *group, const std::string &workload, const char *method,
                     const std::vector<double> &times, const std::string &parameter = "") {
  std::printf("%s,%s,%s,%s,%.4f,%.4f,0,0,0,0,0\n", group, workload.c_str(), method, parameter.c_str(),
              quantile(times, 0.5), quantile(times, 0.95));
}

#endif
