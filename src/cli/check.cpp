/* SPDX-License-Identifier: BSD-3-Clause */
/* check: hands the query, read from the same inputs again, to the program cprox_check. What is trusted is the reading
 * of the inputs and that program; not the search, nor what wrote the certificates. */
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string_view>
#include <utility>

#include "../scene/query/certificate_problem.h"
#include "certificates.h"
#include "commands.h"
#include "csv.h"
#include "exit_code.h"
#include "json.h"
#include "library.h"
#include "moving_world.h"
#include "trajectory.h"
#include "world_files.h"

namespace curve_proximity::cli {
namespace {

/* It stands beside this program; else the PATH is searched. */
std::string checkerPath() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path beside = self.parent_path() / "cprox_check";
  return !error && std::filesystem::exists(beside, error) ? beside.string() : "cprox_check";
}

/* A file without a name, that a child inherits. */
class Scratch {
 public:
  Scratch() : file_(memfd_create("cprox", 0)) {
    if (file_ < 0) throw BadUsage(std::string("no memory for cprox_check: ") + std::strerror(errno));
  }
  explicit Scratch(std::string_view bytes) : Scratch() {
    while (!bytes.empty()) {
      const ssize_t n = write(file_, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) throw BadUsage(std::string("no memory for cprox_check: ") + std::strerror(errno));
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    lseek(file_, 0, SEEK_SET);
  }
  ~Scratch() {
    if (file_ >= 0) close(file_);
  }
  Scratch(Scratch &&other) noexcept : file_(std::exchange(other.file_, -1)) {}
  Scratch &operator=(Scratch &&) = delete;

  int get() const {
    return file_;
  }

  /* All that was written. */
  std::string text() const {
    std::string out;
    std::array<char, 1 << 16> block{};
    lseek(file_, 0, SEEK_SET);
    for (ssize_t n = 0; (n = read(file_, block.data(), block.size())) != 0;) {
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) throw BadUsage(std::string("the report of cprox_check cannot be read: ") + std::strerror(errno));
      out.append(block.data(), static_cast<std::size_t>(n));
    }
    return out;
  }

 private:
  int file_;
};

/* What a line says that is proven: the word of the column `proof`, or "parts" of several claims. */
std::string claimOf(const std::string &said) {
  const std::size_t counts = said.rfind(" bytes, "), parts = said.find(" parts, ", counts);
  if (counts != std::string::npos && parts != std::string::npos) return "parts";
  if (said.rfind("not ", 0) == 0) return "near";
  if (said.find(" m before ") != std::string::npos) return "before";
  return said.find(" m from ") != std::string::npos ? "during" : "apart";
}

/* A line of cprox_check, `ID: proven: farther than X m everywhere (…)` for example, as JSON. */
std::string jsonLine(const std::string &line) {
  constexpr std::array<std::string_view, 3> words{": proven: ", ": refused: ", ": nothing is claimed"};
  const std::string whole = ": " + line; // its ID may be missing
  std::size_t at = std::string::npos, found = 0;
  for (std::size_t i = 0; i < words.size(); ++i)
    if (const std::size_t here = whole.find(words[i]); here < at) at = here, found = i;
  Json row;
  if (at == std::string::npos) {
    row["message"] = line;
    return textOfJson(row);
  }
  const std::string said = whole.substr(at + words[found].size());
  const std::string proof = found == 0 ? claimOf(said) : found == 1 ? "refused" : "none";
  const std::size_t delta = found == 0 && proof != "parts" ? said.find("than ") : std::string::npos;
  row["id"] = at > 0 ? whole.substr(2, at - 2) : "";
  row["proof"] = proof;
  row["delta"] = delta != std::string::npos ? Json(std::stod(said.substr(delta + std::strlen("than ")))) : Json();
  row["message"] = found == 2 ? "nothing is claimed" : said;
  return textOfJson(row);
}

void print(const std::string &report, bool json) {
  std::string out = report;
  if (json) {
    out.clear();
    std::istringstream lines(report);
    for (std::string line; std::getline(lines, line);) out += jsonLine(line) + "\n";
  }
  if (std::fwrite(out.data(), 1, out.size(), stdout) != out.size() || std::fflush(stdout) != 0)
    throw std::runtime_error(std::string("standard output: writing failed: ") + std::strerror(errno));
}

/* cprox_check at work on one block of rows. */
class Checker {
 public:
  Checker(const std::string &problem, std::string_view certificates) : problem_(problem), certificates_(certificates) {
    const std::string path = checkerPath(), file = "/proc/self/fd/" + std::to_string(certificates_.get());
    process_ = fork();
    if (process_ < 0) throw BadUsage(std::string("cprox_check cannot be started: ") + std::strerror(errno));
    if (process_ > 0) return;
    dup2(problem_.get(), STDIN_FILENO);
    dup2(report_.get(), STDOUT_FILENO);
    execlp(path.c_str(), "cprox_check", "-", file.c_str(), static_cast<char *>(nullptr));
    constexpr int kNotThere = 127;
    _exit(kNotThere);
  }

  /* Waits for its end, prints its report; its exit code. */
  int finish(bool json) {
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    print(report_.text(), json);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  Scratch problem_, certificates_, report_;
  pid_t process_ = -1;
};

/* Several of them: rows are handed out in blocks, reports are printed in the order of the rows. */
class Checkers {
 public:
  Checkers(const std::string &certificates, std::size_t threads, bool json) : threads_(threads), json_(json) {
    std::ifstream stream(certificates, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    if (!stream) throw BadUsage(certificates + ": cannot be read");
    rest_ = bytes_;
  }

  /* What stands before the movers of every block. */
  void begin(const std::string &head) {
    head_ = head;
  }

  void add(const std::string &mover) {
    if (in_block_ == kRowsPerBlock) start(take(in_block_));
    movers_ += mover;
    ++in_block_;
    ++rows_;
  }

  std::size_t rows() const {
    return rows_;
  }

  /* 0: all are proven; 1: not all. The last block has all certificates that are left: there should be none too many. */
  int finish() {
    if (rows_ > 0) start(rest_);
    while (!working_.empty()) collect();
    return code_;
  }

 private:
  static constexpr std::size_t kRowsPerBlock = 2000;

  /* The certificates of so many rows, each behind its length (u32, little endian); fewer where the file ends. */
  std::string_view take(std::size_t rows) {
    std::size_t size = 0;
    for (; rows > 0 && rest_.size() - size >= 4; --rows) {
      std::size_t length = 0;
      for (std::size_t i = 4; i-- > 0;) length = length << 8 | static_cast<unsigned char>(rest_[size + i]);
      size += 4;
      if (length > rest_.size() - size) {
        size = rest_.size();
        break;
      }
      size += length;
    }
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  void start(std::string_view certificates) {
    if (working_.size() == threads_) collect();
    working_.push_back(std::make_unique<Checker>(head_ + movers_, certificates));
    movers_.clear();
    in_block_ = 0;
  }

  void collect() {
    const int code = working_.front()->finish(json_);
    working_.pop_front();
    if (code != 0 && code != 1)
      throw BadUsage("cprox_check did not come to an end of its own (exit code " + std::to_string(code) + ")");
    code_ = std::max(code_, code);
  }

  const std::size_t threads_;
  const bool json_;
  std::string bytes_, head_, movers_;
  std::string_view rest_;
  std::size_t in_block_ = 0, rows_ = 0;
  std::deque<std::unique_ptr<Checker>> working_;
  int code_ = 0;
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

/* A row of either file; the other curve is the obstacle. */
std::string pairOf(const std::optional<CsvRow> &first, const std::optional<CsvRow> &second, bool synchronized) {
  if (!first || !second) return noMoverLine(first ? rowId(first->text) : "");
  try {
    const CurveDescription obstacle = parseCurve(second->text);
    compile(obstacle);
    return curveObstacleLines(obstacle, synchronized) + moverOf(*first);
  } catch (const std::bad_alloc &) {
    throw;
  } catch (const std::exception &) {
    return noMoverLine(rowId(first->text));
  }
}

void tellCurves(const Arguments &arguments, Console &console, Checkers &checkers) {
  Warnings warnings;
  const World world = readStandingWorld(arguments, "'check'", warnings);
  const SceneObstacles obstacles(world.snapshot, world.links, arguments.query);
  const std::vector<std::string> none = unprovable(obstacles);
  warnOfUnprovable(none, warnings);
  console.warn(warnings);
  CsvFile file(arguments.curves);
  checkers.begin(problemHead() + (none.empty() ? describeObstacles(obstacles) : ""));
  while (const std::optional<CsvRow> row = file.next())
    checkers.add(none.empty() ? moverOf(*row) : noMoverLine(rowId(row->text)));
}

/* The robot, or null: what moves in the scene, or a body along a path. A row of the robot itself follows. */
void tellMovers(const Arguments &arguments, const World &world, std::shared_ptr<const RobotMotion> motion,
                Checkers &checkers) {
  const MovingWorld moving = gatherMovers(arguments, world, motion);
  const std::string query = problemOf(askedAmong(moving, arguments).subject, arguments.query).text;
  checkers.begin("");
  checkers.add(query.empty() ? problemHead() + noMoverLine("movers") : query);
  if (!motion || !arguments.self) return;
  const std::string own = describeQuery(*moving.subject->motion, true, arguments.query);
  checkers.add(own.empty() ? noMoverLine("self") : own);
}

void tellTrajectory(const Arguments &arguments, Console &console, Checkers &checkers) {
  Warnings warnings;
  const World world = readWorld(arguments, warnings);
  if (world.moves()) {
    tellMovers(arguments, world, std::make_shared<const RobotMotion>(readMotion(arguments, world, warnings)), checkers);
    return console.warn(warnings);
  }
  const RobotMotion motion = readMotion(arguments, world, warnings);
  warnOfUnprovable(unprovable(motion, false, arguments.query), warnings);
  if (arguments.self) warnOfUnprovable(unprovable(motion, true, arguments.query), warnings);
  console.warn(warnings);
  checkers.begin(problemHead());
  for (const bool self : {false, true}) {
    if (self && !arguments.self) break;
    const std::string query = describeQuery(motion, self, arguments.query);
    checkers.add(query.empty() ? noMoverLine(self ? "self" : "environment") : query);
  }
}

void tellMoving(const Arguments &arguments, Console &console, Checkers &checkers) {
  Warnings warnings;
  const World world = readWorld(arguments, warnings);
  tellMovers(arguments, world, nullptr, checkers);
  console.warn(warnings);
}

void tellPairs(const Arguments &arguments, Checkers &checkers) {
  CsvFile first(arguments.curves), second(arguments.against);
  checkers.begin(problemHead() + "targets 0\n");
  while (true) {
    const std::optional<CsvRow> a = first.next(), b = second.next();
    if (!a && !b) return;
    checkers.add(pairOf(a, b, arguments.synchronized));
  }
}

/* Of which files it was, and on what it rests. */
void explain(const Arguments &arguments, Console &console) {
  std::vector<std::string> files = inputsOf(arguments);
  files.push_back(arguments.certificate);
  for (const std::string &file : files)
    if (!file.empty())
      console.say("read: " + file + ", BLAKE2b " + digestOfFile(file, true) + " with the meshes it names");
  console.say(
      "what is proven is true of these files as cprox reads them; it rests on that reading, on cprox_check, MPFR "
      "and the compiler, and not on what wrote the certificates");
}

} // namespace

int checkCertificates(const Arguments &arguments, Console &console) {
  if (!std::filesystem::exists(arguments.certificate))
    throw BadUsage(arguments.certificate + ": there is no such file");
  Checkers checkers(arguments.certificate, arguments.threads, arguments.json);
  if (!arguments.trajectory.empty())
    tellTrajectory(arguments, console, checkers);
  else if (arguments.curves.empty())
    tellMoving(arguments, console, checkers);
  else if (arguments.against.empty())
    tellCurves(arguments, console, checkers);
  else
    tellPairs(arguments, checkers);
  const int code = checkers.finish();
  if (arguments.verbose) explain(arguments, console);
  if (checkers.rows() == 0) {
    console.say("warning: the input has no rows");
    return kUnanswered;
  }
  return code == 0 ? kAllAnswered : kSomeViolated;
}

} // namespace curve_proximity::cli
