/* SPDX-License-Identifier: BSD-3-Clause */
#include "read.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <new>

#include "formats.h"
#include "protocol.h"

namespace curve_proximity::mesh_reader {
namespace {

/* ---- messages ---- */

/* Whoever no longer listens has no use for this process. */
void writeAll(int out, const void *data, std::size_t size) {
  const char *at = static_cast<const char *>(data);
  while (size > 0) {
    const ssize_t written = write(out, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) _exit(1);
    at += written;
    size -= static_cast<std::size_t>(written);
  }
}

void writeHead(int out, char kind, std::uint64_t size) {
  writeAll(out, &kind, 1);
  writeAll(out, &size, sizeof size);
}

/* One line of printable characters. */
void writeText(int out, char kind, const char *text) {
  std::array<char, LONGEST_TEXT> line{};
  std::size_t size = 0;
  for (; text[size] != '\0' && size < line.size(); ++size) {
    const auto c = static_cast<unsigned char>(text[size]);
    line[size] = c < ' ' || c == 0x7f ? ' ' : text[size];
  }
  while (size > 0 && line[size - 1] == ' ') --size;
  writeHead(out, kind, size);
  writeAll(out, line.data(), size);
}

void writeMesh(int out, const Mesh &mesh) {
  const std::uint64_t vertices = mesh.vertices.size() * sizeof(double),
                      triangles = mesh.triangles.size() * sizeof(std::int32_t);
  const std::array<std::uint64_t, 2> counts = {mesh.vertices.size() / 3, mesh.triangles.size() / 3};
  writeHead(out, MESH, sizeof counts + vertices + triangles + 1);
  writeAll(out, counts.data(), sizeof counts);
  writeAll(out, mesh.vertices.data(), vertices);
  writeAll(out, mesh.triangles.data(), triangles);
  writeAll(out, &END, 1);
}

/* ---- limits ---- */

int out_of_memory = -1; /* where to say so */
std::array<char, 100> out_of_memory_text{};

void sayOutOfMemory() {
  writeText(out_of_memory, ERROR, out_of_memory_text.data());
  _exit(0);
}

void limit(decltype(RLIMIT_AS) what, rlim_t soft, rlim_t hard) {
  rlimit now{};
  if (getrlimit(what, &now) != 0) return;
  now.rlim_max = std::min(now.rlim_max, hard);
  now.rlim_cur = std::min(now.rlim_max, soft);
  setrlimit(what, &now);
}

/* Sanitizers reserve more address space than there is. */
constexpr bool limitsMemory() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return false;
#else
  return true;
#endif
}

void takeLimits(std::uint64_t file_size, int out) {
  const Limits limits = limitsFor(file_size);
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_CPU, limits.processor_time, limits.processor_time + 1);
  alarm(limits.time);
  if (limitsMemory()) limit(RLIMIT_AS, limits.memory, limits.memory);
  out_of_memory = out;
  std::snprintf(out_of_memory_text.data(), out_of_memory_text.size(), "reading it takes more than %llu MiB of memory",
                static_cast<unsigned long long>(limits.memory >> 20));
  std::set_new_handler(sayOutOfMemory);
}

/* ---- the file ---- */

std::string contentOf(int in, std::uint64_t size) {
  std::string bytes(size, '\0');
  std::size_t got = 0;
  while (got < size) {
    const ssize_t n = read(in, bytes.data() + got, size - got);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw Fault(std::string("it cannot be read: ") + std::strerror(errno));
    if (n == 0) throw Fault("it became shorter while it was read");
    got += static_cast<std::size_t>(n);
  }
  return bytes;
}

} // namespace

void answer(const std::string &file, int in, int out) {
  struct stat status {};
  if (fstat(in, &status) != 0 || !S_ISREG(status.st_mode) || status.st_size < 0) {
    return writeText(out, ERROR, "it is no regular file");
  }
  const auto size = static_cast<std::uint64_t>(status.st_size);
  takeLimits(size, out);
  try {
    const Mesh mesh = readBytes(extensionOf(file), contentOf(in, size));
    if (!mesh.remark.empty()) writeText(out, REMARK, mesh.remark.c_str());
    writeMesh(out, mesh);
  } catch (const std::exception &error) {
    writeText(out, ERROR, error.what());
  }
}

} // namespace curve_proximity::mesh_reader
