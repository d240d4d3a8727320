/* SPDX-License-Identifier: BSD-3-Clause */
#include "mesh_process.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <memory>
#include <thread>
#include <utility>

extern char **environ;

namespace curve_proximity {
namespace {

using Clock = std::chrono::steady_clock;

/* What is wrong with the process, not with the file. */
std::string systemError(const std::string &what, int code) {
  return what + ": " + std::strerror(code);
}

/* ---- what must not be left behind ---- */

/* Above the standard ones, so that the process that is started can be given it as one of them; closed in every other.
 */
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int descriptor) : descriptor_(fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1)) {
    const int why = errno;
    if (descriptor >= 0) ::close(descriptor);
    if (descriptor_ < 0) throw Error(systemError("it cannot be read", why));
  }
  ~Descriptor() {
    close();
  }
  Descriptor(Descriptor &&other) noexcept : descriptor_(other.release()) {}
  Descriptor(const Descriptor &) = delete;
  Descriptor &operator=(const Descriptor &) = delete;
  void close() {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
  }
  int get() const {
    return descriptor_;
  }
  int release() {
    return std::exchange(descriptor_, -1);
  }

 private:
  int descriptor_ = -1;
};

/* The process, which is ended and reaped whatever happens. */
class Process {
 public:
  explicit Process(pid_t id) : id_(id) {}
  ~Process() {
    if (!reaped_) end();
  }
  Process(const Process &) = delete;
  Process &operator=(const Process &) = delete;

  /* Its status once it has ended, at the latest at the deadline, when it is killed. -1 where someone else has reaped
   * it. */
  int status(Clock::time_point deadline) {
    while (!reaped_) {
      if (reap(WNOHANG)) break;
      if (Clock::now() >= deadline) {
        end();
        break;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return status_;
  }

  void end() {
    kill(id_, SIGKILL);
    reap(0);
  }

 private:
  bool reap(int options) {
    int status = 0;
    pid_t id = 0;
    do {
      id = waitpid(id_, &status, options);
    } while (id < 0 && errno == EINTR);
    if (id == 0) return false;
    status_ = id == id_ ? status : -1;
    reaped_ = true;
    return true;
  }

  const pid_t id_;
  int status_ = -1;
  bool reaped_ = false;
};

/* ---- starting ---- */

/* The file as standard input, the pipe as standard output, and signals as in a process that nobody has changed. */
class SpawnSettings {
 public:
  SpawnSettings(int in, int out) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawnattr_init(&attributes_);
    posix_spawn_file_actions_adddup2(&actions_, in, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, out, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    sigset_t signals;
    sigfillset(&signals);
    posix_spawnattr_setsigdefault(&attributes_, &signals);
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(&attributes_, &signals);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnSettings(const SpawnSettings &) = delete;
  SpawnSettings &operator=(const SpawnSettings &) = delete;

  pid_t start(std::string program, std::string file) {
    const std::array<char *, 3> arguments = {program.data(), file.data(), nullptr};
    pid_t id = -1;
    const int code = posix_spawn(&id, program.c_str(), &actions_, &attributes_, arguments.data(), environ);
    if (code != 0) throw Error(systemError("the program '" + program + "' that reads meshes cannot be started", code));
    return id;
  }

 private:
  posix_spawn_file_actions_t actions_;
  posix_spawnattr_t attributes_;
};

/* ---- listening ---- */

/* What the process writes, until a deadline. */
class Inbox {
 public:
  Inbox(int descriptor, Clock::time_point deadline) : descriptor_(descriptor), deadline_(deadline) {}

  /* False where less comes. */
  bool read(void *into, std::size_t size) {
    char *at = static_cast<char *>(into);
    while (size > 0) {
      if (!wait()) return false;
      const ssize_t n = ::read(descriptor_, at, size);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      at += n;
      size -= static_cast<std::size_t>(n);
    }
    return true;
  }

 private:
  bool wait() const {
    pollfd waiting{descriptor_, POLLIN, 0};
    for (;;) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline_ - Clock::now()).count();
      if (left < 0) return false;
      const int n = poll(&waiting, 1, static_cast<int>(std::min<std::int64_t>(left + 1, 1000)));
      if (n > 0) return true;
      if (n < 0 && errno != EINTR) return false;
    }
  }

  const int descriptor_;
  const Clock::time_point deadline_;
};

/* What came: a mesh, or a text; neither where the process ended without a word, or with one that is none. */
struct Received {
  bool is_mesh = false, is_error = false;
  MeshData mesh;
  std::string error;
};

bool receiveText(Inbox &inbox, std::uint64_t size, std::string &text) {
  if (size > mesh_reader::LONGEST_TEXT) return false;
  text.resize(size);
  return inbox.read(text.data(), size);
}

bool receiveMesh(Inbox &inbox, std::uint64_t size, std::uint64_t most, MeshData &mesh) {
  constexpr std::uint64_t VERTEX = 3 * sizeof(double), TRIANGLE = 3 * sizeof(std::int32_t);
  std::array<std::uint64_t, 2> n{};
  if (size > most || !inbox.read(n.data(), sizeof n)) return false;
  constexpr std::uint64_t LARGEST = std::numeric_limits<std::int32_t>::max();
  if (n[0] > LARGEST || n[1] > LARGEST || size != sizeof n + VERTEX * n[0] + TRIANGLE * n[1] + 1) return false;
  mesh.vertices.resize(3, static_cast<Eigen::Index>(n[0]));
  mesh.triangles.resize(3, static_cast<Eigen::Index>(n[1]));
  static_assert(sizeof(*mesh.triangles.data()) == sizeof(std::int32_t));
  char end = '\0';
  return inbox.read(mesh.vertices.data(), VERTEX * n[0]) && inbox.read(mesh.triangles.data(), TRIANGLE * n[1]) &&
         inbox.read(&end, 1) && end == mesh_reader::END;
}

Received receive(Inbox inbox, std::uint64_t most) {
  Received out;
  char kind = '\0';
  std::uint64_t size = 0;
  while (inbox.read(&kind, 1) && inbox.read(&size, sizeof size)) {
    if (kind == mesh_reader::REMARK && out.mesh.remark.empty() && receiveText(inbox, size, out.mesh.remark)) continue;
    if (kind == mesh_reader::ERROR) out.is_error = receiveText(inbox, size, out.error);
    if (kind == mesh_reader::MESH) out.is_mesh = receiveMesh(inbox, size, most, out.mesh);
    break;
  }
  return out;
}

/* ---- what is said of a process that did not answer ---- */

std::string endOf(int status, const mesh_reader::Limits &limits) {
  if (status != -1 && WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU) return "reading it takes more than " + std::to_string(limits.processor_time) + " s";
    if (signal == SIGALRM || signal == SIGKILL)
      return "reading it was ended: it takes more than " + std::to_string(limits.time) +
             " s, or more memory than there is";
    return std::string("the program that reads meshes crashes on it (") + strsignal(signal) + ")";
  }
  return "the program that reads meshes ended without an answer";
}

int openForReading(const std::string &file) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) throw Error(systemError("it cannot be read", errno));
  return descriptor;
}

std::uint64_t sizeOf(const Descriptor &file) {
  struct stat status {};
  if (fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) throw Error("it is no regular file");
  if (status.st_size <= 0) throw Error("it is empty");
  return static_cast<std::uint64_t>(status.st_size);
}

/* Larger files are read as they are. */
constexpr std::uint64_t LARGEST_COPY = std::uint64_t{256} << 20;

/* Reads all bytes; false where the file became shorter. */
bool readAll(int from, char *to, std::size_t size) {
  while (size > 0) {
    const ssize_t n = read(from, to, size);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw Error(systemError("it cannot be read", errno));
    if (n == 0) return false;
    to += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

std::string extensionOf(const std::string &file) {
  std::string out = std::filesystem::path(file).extension().string();
  for (char &c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

/* A copy of the file that has no name, and its digest. No digest where the machine has no such files. */
Descriptor copyOf(const Descriptor &in, std::uint64_t size, const std::string &file, std::optional<Digest> &digest) {
  const int made = memfd_create("mesh", MFD_CLOEXEC);
  if (made < 0) return Descriptor();
  Descriptor copy(made);
  if (ftruncate(copy.get(), static_cast<off_t>(size)) != 0) return Descriptor();
  void *bytes = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, copy.get(), 0);
  if (bytes == MAP_FAILED) return Descriptor();
  const auto unmap = [size](void *at) { munmap(at, size); };
  const std::unique_ptr<void, decltype(unmap)> mapped(bytes, unmap);
  if (!readAll(in.get(), static_cast<char *>(bytes), size)) throw Error("it became shorter while it was read");
  digest = Hasher().add(extensionOf(file)).add(bytes, size).finish();
  return copy;
}

} // namespace

std::string meshReaderProgram() {
  Dl_info library{};
  std::error_code error;
  if (dladdr(reinterpret_cast<const void *>(&meshReaderProgram), &library) == 0 || !library.dli_fname) return "";
  const std::filesystem::path path = std::filesystem::canonical(library.dli_fname, error);
  const std::filesystem::path apart = (path.parent_path() / CURVE_PROXIMITY_MESH_READER).lexically_normal();
  const std::filesystem::path beside = path.parent_path() / apart.filename(); // of a program with the library inside
  return std::filesystem::exists(beside, error) ? beside.string() : apart.string();
}

MeshData hearMesh(int from, pid_t id, const mesh_reader::Limits &limits) {
  // Its own alarm comes first; this deadline is for a process that is not what it should be.
  constexpr std::chrono::seconds LATER{2};
  Process process(id);
  const auto deadline = Clock::now() + std::chrono::seconds(limits.time) + LATER;
  Received received = receive(Inbox(from, deadline), limits.memory);
  if (received.is_mesh) return std::move(received.mesh);
  if (received.is_error) throw Error(received.error);
  throw Error(endOf(process.status(std::min(deadline, Clock::now() + LATER)), limits));
}

MeshFile::MeshFile(const std::string &file) : file_(file) {
  Descriptor in(openForReading(file));
  size_ = sizeOf(in);
  Descriptor copy = size_ <= LARGEST_COPY ? copyOf(in, size_, file, digest_) : Descriptor();
  descriptor_ = digest_ ? copy.release() : in.release();
}

MeshFile::~MeshFile() {
  close(descriptor_);
}

MeshData MeshFile::readBy(const std::string &program) const {
  const mesh_reader::Limits limits = mesh_reader::limitsFor(size_);
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw Error(systemError("it cannot be read", errno));
  const Descriptor from(ends[0]);
  Descriptor to(ends[1]);
  const pid_t id = SpawnSettings(descriptor_, to.get()).start(program, file_);
  to.close();
  return hearMesh(from.get(), id, limits);
}

MeshData readMeshBy(const std::string &program, const std::string &file) {
  return MeshFile(file).readBy(program);
}

} // namespace curve_proximity
