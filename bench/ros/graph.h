/* SPDX-License-Identifier: BSD-3-Clause */
/** What the measurements of the node share: processes, waits, rows. */
#ifndef BENCH_ROS_GRAPH_H
#define BENCH_ROS_GRAPH_H

#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace bench {

using Clock = std::chrono::steady_clock;

/** This program. */
constexpr const char *PROGRAM = "/proc/self/exe";

inline double microseconds(Clock::duration time) {
  return std::chrono::duration<double, std::micro>(time).count();
}

/** A program that ends with this object. */
class Program {
 public:
  explicit Program(std::vector<std::string> arguments) {
    std::vector<char *> argv;
    for (std::string &argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ != 0) return;
    if (!std::freopen("/dev/null", "w", stdout)) _exit(126);
    execvp(argv[0], argv.data());
    _exit(127);
  }
  ~Program() {
    if (pid_ <= 0) return;
    kill(pid_, SIGINT);
    waitpid(pid_, nullptr, 0);
  }
  Program(const Program &) = delete;
  Program &operator=(const Program &) = delete;

  double residentMb() const {
    std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
    for (std::string line; std::getline(status, line);)
      if (line.rfind("VmRSS:", 0) == 0) return std::atof(line.c_str() + 6) / 1024.0;
    return 0.0;
  }

 private:
  pid_t pid_;
};

inline int freePort() {
  const int probe = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  const bool found = bind(probe, reinterpret_cast<sockaddr *>(&address), size) == 0 &&
                     getsockname(probe, reinterpret_cast<sockaddr *>(&address), &size) == 0;
  close(probe);
  if (!found) throw std::runtime_error("no free port");
  return ntohs(address.sin_port);
}

template <class Condition>
void waitFor(const char *what, Condition condition) {
  const auto deadline = Clock::now() + std::chrono::seconds(30);
  while (!condition()) {
    if (Clock::now() > deadline) throw std::runtime_error(std::string(what) + " is not there after 30 s");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

inline double percentile(std::vector<double> values, double fraction) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/** One row of results.csv; times in microseconds. */
inline void printRow(const char *workload, const std::string &method, const std::string &parameter, double median,
                     double p95, double error = 0.0) {
  std::printf("ros,\"%s\",%s,%s,%.3f,%.3f,0,0,%.3g,0,0\n", workload, method.c_str(), parameter.c_str(), median, p95,
              error);
  std::fflush(stdout);
}

} // namespace bench
#endif
