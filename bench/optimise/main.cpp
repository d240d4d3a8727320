/* SPDX-License-Identifier: BSD-3-Clause */
/* The group `optimise`: motions of a Panda made smooth and 10 mm clear, in seven families of scenes, by clearances of
 * the whole motion and by sampled states. Two rows a family and method: what is said of the clearance, and of contact.
 * nodes: evaluations; distance_queries: the motions of which it is said; error: how far [m] one of these is nearer, at
 * most; unsound: how many are nearer. */
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>

#include "methods.h"

using namespace curve_proximity;

namespace {

constexpr std::uint64_t kSeed = 21;
constexpr int kProblems = 10, kQuickProblems = 1;
constexpr int kTruthStates = 1000;
constexpr double kDoubt = 1e-6; /* [m] what FCL's distances are trusted to */

struct Method {
  std::string name;
  std::function<Outcome(const ArmProblem &)> run;
};

struct Judged {
  Outcome outcome;
  Truth truth;
};

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
}

/* A row: what was said (`says`), and the distance [m] that it means. */
void print(const std::string &family, const char *what, const std::string &method, const std::vector<Judged> &all,
           bool Outcome::*says, double meant) {
  std::vector<double> times, evaluations;
  double error = 0.0;
  int many = 0, unsound = 0;
  for (const Judged &one : all) {
    times.push_back(one.outcome.microseconds);
    evaluations.push_back(one.outcome.evaluations);
    const bool said = one.outcome.*says;
    const double nearer = std::max(meant - one.truth.upper, meant - one.truth.sampled - kDoubt);
    const bool wrong = said && nearer > 0.0;
    many += said, unsound += wrong;
    if (wrong) error = std::max(error, nearer);
  }
  std::printf("optimise,%s,%s,%s %zu motions,%.4g,%.4g,%.4g,%d,%.3g,%d,0\n", what, method.c_str(), family.c_str(),
              all.size(), quantile(times, 0.5), quantile(times, 0.95), quantile(evaluations, 0.5), many, error,
              unsound);
}

void run(int problems, const char *only) {
  Workspace workspace;
  std::vector<Method> methods = {
      {"curve_proximity", [&](const ArmProblem &problem) { return by_rows(problem, workspace); }}};
  for (const int states : {20, 50, 200}) {
    const std::string of = std::to_string(states) + " states";
    methods.push_back({"FCL hinges " + of, [=](const ArmProblem &p) { return by_sampled_hinges(p, states); }});
    methods.push_back({"FCL rows " + of, [=](const ArmProblem &p) { return by_sampled_rows(p, states); }});
  }
  for (const std::string &family : kFamilies) {
    if (only && family.find(only) == std::string::npos) continue;
    const std::vector<ArmProblem> all = arm_problems(family, problems, kSeed);
    for (const Method &method : methods) {
      std::vector<Judged> judged;
      for (const ArmProblem &problem : all) {
        const Outcome outcome = method.run(problem);
        judged.push_back({outcome, truth_of(problem, outcome.control, kTruthStates, workspace)});
        std::fprintf(stderr, "\roptimise: %s, %s, %zu of %zu        ", family.c_str(), method.name.c_str(),
                     judged.size(), all.size());
      }
      print(family, "clear by 10 mm", method.name, judged, &Outcome::says_clear, kClear);
      print(family, "free of contact", method.name, judged, &Outcome::says_free, 0.0);
      std::fflush(stdout);
    }
  }
  std::fprintf(stderr, "\n");
}

} // namespace

int main(int argc, char **argv) {
  int problems = kProblems;
  const char *only = nullptr;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--quick") == 0) {
      problems = kQuickProblems;
    } else if (std::strcmp(argv[i], "--only") == 0 && i + 1 < argc) {
      only = argv[++i];
    } else {
      std::fprintf(stderr, "usage: %s [--quick] [--only FAMILY]\n", argv[0]);
      return 2;
    }
  }
  try {
    run(problems, only);
    return 0;
  } catch (const std::exception &error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
}
