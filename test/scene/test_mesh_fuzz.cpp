/* SPDX-License-Identifier: BSD-3-Clause */
/* Mutated mesh files of every format whose files are checked: each is a mesh or an error in one line; none ends this
 * process or stalls it. Each mesh that comes is made a body, here. The reader runs in a fork of this program, which is
 * quicker than starting its own; what it says is heard as ever. CURVE_PROXIMITY_MESH_FILES says how many files of each
 * format, CURVE_PROXIMITY_SEED which. */
#include <fcntl.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdlib>

#include "../mesh_reader/read.h"
#include "geometry/mesh_process.h"
#include "mesh_files.h"
#include "support.h"

namespace curve_proximity {
namespace {

using test::Random;

std::uint64_t number(const char *variable, std::uint64_t otherwise) {
  const char *text = std::getenv(variable);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

/* Numbers that programs stumble over. */
std::string nastyNumber(Random &random) {
  static const std::vector<std::string> numbers = {"0",
                                                   "-1",
                                                   "1",
                                                   "3",
                                                   "4294967295",
                                                   "4294967296",
                                                   "2147483648",
                                                   "99999999999999999999",
                                                   "-2147483648",
                                                   "1e999",
                                                   "1e38",
                                                   "nan",
                                                   "inf",
                                                   "1e-320",
                                                   "",
                                                   "x",
                                                   "0x10",
                                                   "1,5",
                                                   "1.2.3",
                                                   "65536",
                                                   "100000000",
                                                   "255",
                                                   "4",
                                                   "-4",
                                                   "5"};
  return numbers[random.below(numbers.size())];
}

/* The place of a run of digits, or any place. */
std::pair<std::size_t, std::size_t> digits(const std::string &text, Random &random) {
  const std::size_t begin = text.find_first_of("0123456789", random.below(text.size()));
  if (begin == std::string::npos) return {random.below(text.size()), 1};
  const std::size_t end = text.find_first_not_of("0123456789.", begin);
  return {begin, std::min(end, text.size()) - begin};
}

void mutate(std::string &bytes, Random &random) {
  if (bytes.empty()) return;
  const std::size_t at = random.below(bytes.size()),
                    length = 1 + random.below(std::min<std::size_t>(bytes.size() - at, 60));
  switch (random.below(9)) {
    case 0: bytes[at] = static_cast<char>(random.below(256)); break;
    case 1: bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8))); break;
    case 2: bytes.erase(at, length); break;
    case 3: bytes.insert(random.below(bytes.size()), bytes.substr(at, length)); break;
    case 4: bytes.resize(at); break;
    case 5: bytes.append(1 + random.below(70), static_cast<char>(random.below(256))); break;
    case 6: {
      const auto [begin, n] = digits(bytes, random);
      bytes.replace(begin, n, nastyNumber(random));
      break;
    }
    case 7: /* a number of four bytes */
      for (std::size_t i = at; i < std::min(at + 4, bytes.size()); ++i) bytes[i] = random.below(3) ? '\xff' : '\0';
      break;
    default: bytes.replace(at, length, std::string(length, random.below(2) ? '\n' : '\0')); break;
  }
}

/* The content as an open file. */
int fileOf(const std::string &content) {
  FILE *file = std::tmpfile();
  if (!file) return -1;
  if (!content.empty() && std::fwrite(content.data(), 1, content.size(), file) != content.size()) return -1;
  std::fflush(file);
  const int out = dup(fileno(file));
  std::fclose(file);
  lseek(out, 0, SEEK_SET);
  return out;
}

MeshData readForked(const std::string &name, const std::string &content) {
  std::array<int, 2> ends{};
  const int in = fileOf(content);
  if (in < 0 || pipe(ends.data()) != 0) std::abort();
  const pid_t id = fork();
  if (id == 0) {
    close(ends[0]);
    for (const int out : {STDOUT_FILENO, STDERR_FILENO}) dup2(open("/dev/null", O_WRONLY), out);
    mesh_reader::answer(name, in, ends[1]);
    _exit(0);
  }
  close(in);
  close(ends[1]);
  struct Closed {
    int descriptor;
    ~Closed() {
      close(descriptor);
    }
  } from{ends[0]};
  return hearMesh(from.descriptor, id, mesh_reader::limitsFor(content.size()));
}

/* What a file was: how many of each are said in the end. */
struct Tally {
  std::uint64_t meshes = 0, refused = 0, crashed = 0, slow = 0, large = 0, no_body = 0;
};

void tryOne(const std::string &name, const std::string &content, Tally &tally) {
  MeshData mesh;
  try {
    mesh = readForked(name, content);
  } catch (const Error &error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    EXPECT_GT(text.size(), 5u);
    EXPECT_EQ(text.find("without an answer"), std::string::npos) << text;
    ++(text.find("crashes") != std::string::npos ? tally.crashed
       : text.find("MiB") != std::string::npos   ? tally.large
       : text.find("reading it") == 0            ? tally.slow
                                                 : tally.refused);
    return;
  }
  ++tally.meshes;
  ResourceOptions options;
  options.memory_limit = std::size_t{1} << 30;
  try {
    makeMeshGeometry(mesh, Eigen::Vector3d::Ones(), tally.meshes % 2 == 0, options);
  } catch (const Error &) {
    ++tally.no_body;
  }
}

class MeshFuzz : public ::testing::TestWithParam<std::pair<std::string, std::string>> {};

TEST_P(MeshFuzz, no_mutated_file_ends_or_stalls_whoever_reads_it) {
  const std::uint64_t files = number("CURVE_PROXIMITY_MESH_FILES", 300),
                      seed = number("CURVE_PROXIMITY_SEED", 20261122);
  const auto &[name, content] = GetParam();
  Random random(seed);
  Tally tally;
  auto slowest = std::chrono::steady_clock::duration::zero();
  for (std::uint64_t i = 0; i < files; ++i) {
    std::string bytes = content;
    for (std::size_t n = 1 + random.below(4); n > 0; --n) mutate(bytes, random);
    SCOPED_TRACE("file " + std::to_string(i) + " of seed " + std::to_string(seed));
    const auto begin = std::chrono::steady_clock::now();
    tryOne(name, bytes, tally);
    slowest = std::max(slowest, std::chrono::steady_clock::now() - begin);
  }
  EXPECT_EQ(tally.meshes + tally.refused + tally.crashed + tally.slow + tally.large, files);
  EXPECT_LT(slowest, std::chrono::seconds(30));
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  const auto n = [](std::uint64_t count) { return static_cast<unsigned long long>(count); };
  std::printf(
      "%s, seed %llu: %llu files, %llu meshes (%llu without a body), %llu refused; in the process apart: %llu crashes, "
      "%llu out of time, %llu out of memory; slowest %.2f s\n",
      name.c_str(), n(seed), n(files), n(tally.meshes), n(tally.no_body), n(tally.refused), n(tally.crashed),
      n(tally.slow), n(tally.large), std::chrono::duration<double>(slowest).count());
}

INSTANTIATE_TEST_SUITE_P(Formats, MeshFuzz, ::testing::ValuesIn(test::meshFiles()), [](const auto &format) {
  const std::string &name = format.param.first;
  return name.substr(0, name.find('.')) + "_" + name.substr(name.find('.') + 1);
});

} // namespace
} // namespace curve_proximity
