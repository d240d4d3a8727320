/* SPDX-License-Identifier: BSD-3-Clause */
/* check: hands the query, read from the same inputs again, to the program cprox_check. What is trusted is the reading
 * of the inputs and that program; not the search, nor what wrote the certificates. */
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>

#include "certificates.h"
#include "commands.h"
#include "csv.h"
#include "failure.h"
#include "trajectory.h"
#include "world.h"

namespace curve_proximity::cli {
namespace {

/* It stands beside this program; else the PATH is searched. */
std::string checkerPath() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path beside = self.parent_path() / "cprox_check";
  return !error && std::filesystem::exists(beside, error) ? beside.string() : "cprox_check";
}

/* cprox_check at work, its standard input being the problem. */
class Checker {
 public:
  explicit Checker(std::string certificates) : certificates_(std::move(certificates)) {}

  ~Checker() {
    if (input_ >= 0) finish();
  }

  Checker(const Checker &) = delete;
  Checker &operator=(const Checker &) = delete;

  /* False where it no longer listens. It is started by the first text: an input that cannot be read is no problem of
   * its own. */
  bool tell(const std::string &text) {
    if (process_ < 0) start();
    for (std::size_t sent = 0; sent < text.size();) {
      const ssize_t n = write(input_, text.data() + sent, text.size() - sent);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      sent += static_cast<std::size_t>(n);
    }
    return true;
  }

  /* Its exit code. */
  int finish() {
    close(input_);
    input_ = -1;
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  void start() {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) throw BadUsage(std::string("no pipe to cprox_check: ") + std::strerror(errno));
    const std::string path = checkerPath();
    process_ = fork();
    if (process_ < 0) throw BadUsage(std::string("cprox_check cannot be started: ") + std::strerror(errno));
    if (process_ == 0) {
      dup2(ends[0], STDIN_FILENO);
      close(ends[0]);
      close(ends[1]);
      execlp(path.c_str(), "cprox_check", "-", certificates_.c_str(), static_cast<char *>(nullptr));
      constexpr int kNotThere = 127;
      _exit(kNotThere);
    }
    close(ends[0]);
    input_ = ends[1];
    std::signal(SIGPIPE, SIG_IGN); // it may give up before it has read all
  }

  std::string certificates_;
  pid_t process_ = -1;
  int input_ = -1;
};

/* The mover of a row; of one that cannot be a curve, that there is none. */
std::string moverOf(const CsvRow &row) {
  try {
    const CurveDescription description = parseCurve(row.text);
    compile(description);
    return moverLine(description);
  } catch (const std::bad_alloc &) {
    throw;
  } catch (const std::exception &) {
    return noMoverLine(rowId(row.text));
  }
}

/* A row of either file; the other curve is the target. */
std::string pairOf(const std::optional<CsvRow> &first, const std::optional<CsvRow> &second) {
  if (!first || !second) return noMoverLine(first ? rowId(first->text) : "");
  try {
    const CurveDescription target = parseCurve(second->text);
    compile(target);
    return curveTargetLines(target) + moverOf(*first);
  } catch (const std::bad_alloc &) {
    throw;
  } catch (const std::exception &) {
    return noMoverLine(rowId(first->text));
  }
}

void tellCurves(const Arguments &arguments, Console &console, Checker &checker) {
  Warnings warnings;
  const World world = readWorld(arguments, warnings);
  const Targets targets(world.snapshot, world.links, arguments.query);
  const std::vector<std::string> none = unprovable(targets);
  warnOfUnprovable(none, warnings);
  console.warn(warnings);
  CsvFile file(arguments.curves);
  bool listening = checker.tell(problemHead() + (none.empty() ? describeTargets(targets) : ""));
  for (std::optional<CsvRow> row = file.next(); row && listening; row = file.next()) {
    listening = checker.tell(none.empty() ? moverOf(*row) : noMoverLine(rowId(row->text)));
  }
}

void tellTrajectory(const Arguments &arguments, Console &console, Checker &checker) {
  Warnings warnings;
  const World world = readWorld(arguments, warnings);
  const RobotMotion motion = readMotion(arguments, world, warnings);
  warnOfUnprovable(unprovable(motion, false, arguments.query), warnings);
  if (arguments.self) warnOfUnprovable(unprovable(motion, true, arguments.query), warnings);
  console.warn(warnings);
  bool listening = checker.tell(problemHead());
  for (const bool self : {false, true}) {
    if (!listening || (self && !arguments.self)) return;
    const std::string query = describeQuery(motion, self, arguments.query);
    listening = checker.tell(query.empty() ? noMoverLine(self ? "self" : "environment") : query);
  }
}

void tellPairs(const Arguments &arguments, Checker &checker) {
  CsvFile first(arguments.curves), second(arguments.against);
  bool listening = checker.tell(problemHead() + "targets 0\n");
  while (listening) {
    const std::optional<CsvRow> a = first.next(), b = second.next();
    if (!a && !b) return;
    listening = checker.tell(pairOf(a, b));
  }
}

} // namespace

int checkCertificates(const Arguments &arguments, Console &console) {
  if (!std::filesystem::exists(arguments.certificate))
    throw BadUsage(arguments.certificate + ": there is no such file");
  Checker checker(arguments.certificate);
  if (!arguments.trajectory.empty())
    tellTrajectory(arguments, console, checker);
  else if (arguments.against.empty())
    tellCurves(arguments, console, checker);
  else
    tellPairs(arguments, checker);
  const int code = checker.finish();
  if (code == 0) return kAllAnswered;
  if (code == 1) return kSomeRowsFailed;
  throw BadUsage("cprox_check did not come to an end of its own (exit code " + std::to_string(code) + ")");
}

} // namespace curve_proximity::cli
