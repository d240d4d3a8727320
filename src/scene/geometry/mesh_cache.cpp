/* SPDX-License-Identifier: BSD-3-Clause */
#include "mesh_cache.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <list>
#include <map>
#include <mutex>
#include <vector>

namespace curve_proximity {
namespace {

namespace fs = std::filesystem;

/* Counts changes of what a file holds, of how meshes are read and of how hulls are made, between versions of the
 * library. */
constexpr std::uint64_t FORMAT = 4;

constexpr std::size_t MEMORY_LIMIT = std::size_t{64} << 20;
constexpr std::uintmax_t FOLDER_LIMIT = std::uintmax_t{1} << 30, FOLDER_AFTER = FOLDER_LIMIT / 4 * 3;

/* ---- in memory ---- */

std::size_t sizeOf(const PreparedMesh &mesh) {
  return sizeof mesh + static_cast<std::size_t>(mesh.mesh.vertices.size()) * sizeof(double) +
         static_cast<std::size_t>(mesh.mesh.triangles.size()) * sizeof(int) +
         mesh.hull.kept.size() * sizeof(Eigen::Vector3d) + mesh.mesh.remark.size();
}

class Memory {
 public:
  PreparedMeshPtr recall(const Digest &key) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto it = by_key_.find(key);
    if (it == by_key_.end()) return nullptr;
    uses_.splice(uses_.begin(), uses_, it->second);
    return it->second->second;
  }

  void keep(const Digest &key, const PreparedMeshPtr &mesh) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (by_key_.count(key) || sizeOf(*mesh) > MEMORY_LIMIT / 2) return;
    uses_.emplace_front(key, mesh);
    by_key_[key] = uses_.begin();
    bytes_ += sizeOf(*mesh);
    while (bytes_ > MEMORY_LIMIT) {
      bytes_ -= sizeOf(*uses_.back().second);
      by_key_.erase(uses_.back().first);
      uses_.pop_back();
    }
  }

  void forget() {
    const std::lock_guard<std::mutex> lock(mutex_);
    by_key_.clear();
    uses_.clear();
    bytes_ = 0;
  }

 private:
  using Uses = std::list<std::pair<Digest, PreparedMeshPtr>>; /* the latest first */
  std::mutex mutex_;
  Uses uses_;
  std::map<Digest, Uses::iterator> by_key_;
  std::size_t bytes_ = 0;
};

Memory &memory() {
  static Memory one;
  return one;
}

/* ---- files ---- */

struct Head {
  char magic[16];
  std::uint64_t format;
  Digest key;
  std::uint64_t vertices, triangles, kept, remark;
  double excess, moved;
};
constexpr char MAGIC[16] = "cprox mesh\n\x1a\r\n";

std::string nameOf(const std::string &folder, const Digest &key) {
  return folder + "/" + toHex(key) + ".mesh";
}

/* The bytes of a file of this user's own that nobody else can write; empty otherwise. */
std::vector<char> contentOf(const std::string &name) {
  std::vector<char> out;
  const int file = open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (file < 0) return out;
  struct stat status {};
  const bool own = fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid() &&
                   (status.st_mode & (S_IWGRP | S_IWOTH)) == 0 && status.st_size > 0 &&
                   static_cast<std::uintmax_t>(status.st_size) < FOLDER_LIMIT;
  if (own) out.resize(static_cast<std::size_t>(status.st_size));
  std::size_t got = 0;
  while (got < out.size()) {
    const ssize_t n = read(file, out.data() + got, out.size() - got);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    got += static_cast<std::size_t>(n);
  }
  if (got < out.size()) out.clear();
  if (!out.empty()) futimens(file, nullptr); /* so that what is in use is not removed */
  close(file);
  return out;
}

template <typename T>
void append(std::vector<char> &to, const T *from, std::size_t n) {
  const char *bytes = reinterpret_cast<const char *>(from);
  to.insert(to.end(), bytes, bytes + n * sizeof(T));
}

template <typename T>
const char *take(const char *from, T *to, std::size_t n) {
  if (n > 0) std::memcpy(to, from, n * sizeof(T));
  return from + n * sizeof(T);
}

bool writeFile(const std::string &name, const std::vector<char> &bytes) {
  const int file = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, S_IRUSR | S_IWUSR);
  if (file < 0) return false;
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = write(file, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    done += static_cast<std::size_t>(n);
  }
  return close(file) == 0 && done == bytes.size();
}

/* Keeps the folder below its limit. */
void prune(const std::string &folder) {
  struct File {
    fs::file_time_type used;
    std::uintmax_t size;
    fs::path path;
  };
  std::vector<File> files;
  std::uintmax_t total = 0;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code gone;
    const std::uintmax_t size = it->file_size(gone);
    const fs::file_time_type used = it->last_write_time(gone);
    if (gone) continue;
    files.push_back({used, size, it->path()});
    total += size;
  }
  if (total <= FOLDER_LIMIT) return;
  std::sort(files.begin(), files.end(), [](const File &a, const File &b) { return a.used < b.used; });
  for (const File &file : files) {
    if (total <= FOLDER_AFTER) break;
    fs::remove(file.path, error);
    total -= file.size;
  }
}

} // namespace

PreparedMeshPtr recallMesh(const Digest &key) {
  return memory().recall(key);
}

void keepMesh(const Digest &key, const PreparedMeshPtr &mesh) {
  memory().keep(key, mesh);
}

void forgetMeshes() {
  memory().forget();
}

Hasher keyOf(const char *kind) {
  Hasher out;
  out.add(std::string(cprox_version())).add(&FORMAT, sizeof FORMAT).add(std::string(kind));
  return out;
}

PreparedMeshPtr loadMesh(const std::string &folder, const Digest &key) {
  if (folder.empty()) return nullptr;
  const std::vector<char> bytes = contentOf(nameOf(folder, key));
  Head head{};
  if (bytes.size() < sizeof head + sizeof(Digest)) return nullptr;
  std::memcpy(&head, bytes.data(), sizeof head);
  if (std::memcmp(head.magic, MAGIC, sizeof MAGIC) != 0 || head.format != FORMAT || head.key != key) return nullptr;
  const std::size_t most = bytes.size() / sizeof(std::int32_t);
  if (head.vertices > most || head.triangles > most || head.kept > most || head.remark > bytes.size()) return nullptr;
  const std::size_t size = sizeof head + 3 * (head.vertices + head.kept) * sizeof(double) +
                           3 * head.triangles * sizeof(std::int32_t) + head.remark + sizeof(Digest);
  if (size != bytes.size()) return nullptr;
  Digest digest{};
  std::memcpy(digest.data(), bytes.data() + size - sizeof digest, sizeof digest);
  if (digest != digestOf(bytes.data(), size - sizeof digest)) return nullptr;

  auto out = std::make_shared<PreparedMesh>();
  out->mesh.vertices.resize(3, static_cast<Eigen::Index>(head.vertices));
  out->mesh.triangles.resize(3, static_cast<Eigen::Index>(head.triangles));
  out->hull.kept.resize(head.kept);
  out->hull.excess = head.excess;
  out->moved = head.moved;
  const char *at = bytes.data() + sizeof head;
  at = take(at, out->mesh.vertices.data(), 3 * head.vertices);
  for (Eigen::Vector3d &p : out->hull.kept) at = take(at, p.data(), 3);
  at = take(at, out->mesh.triangles.data(), 3 * head.triangles);
  out->mesh.remark.assign(at, head.remark);
  return out;
}

void saveMesh(const std::string &folder, const Digest &key, const PreparedMesh &mesh) {
  if (folder.empty()) return;
  Head head{};
  std::memcpy(head.magic, MAGIC, sizeof MAGIC);
  head.format = FORMAT;
  head.key = key;
  head.vertices = static_cast<std::uint64_t>(mesh.mesh.vertices.cols());
  head.triangles = static_cast<std::uint64_t>(mesh.mesh.triangles.cols());
  head.kept = mesh.hull.kept.size();
  head.remark = mesh.mesh.remark.size();
  head.excess = mesh.hull.excess;
  head.moved = mesh.moved;
  std::vector<char> bytes;
  append(bytes, &head, 1);
  append(bytes, mesh.mesh.vertices.data(), 3 * head.vertices);
  for (const Eigen::Vector3d &p : mesh.hull.kept) append(bytes, p.data(), 3);
  append(bytes, mesh.mesh.triangles.data(), 3 * head.triangles);
  append(bytes, mesh.mesh.remark.data(), head.remark);
  const Digest digest = digestOf(bytes.data(), bytes.size());
  append(bytes, digest.data(), digest.size());

  static std::atomic<unsigned> number{0};
  const std::string name = nameOf(folder, key),
                    other = name + "." + std::to_string(getpid()) + "." + std::to_string(number++) + ".new";
  std::error_code error;
  fs::create_directories(folder, error);
  if (!writeFile(other, bytes) || std::rename(other.c_str(), name.c_str()) != 0) {
    unlink(other.c_str());
    return;
  }
  prune(folder);
}

} // namespace curve_proximity
