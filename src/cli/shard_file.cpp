/* SPDX-License-Identifier: BSD-3-Clause */
#include "shard_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "exit_code.h"

namespace curve_proximity::cli {
namespace {

constexpr const char *kMagic = "# cprox shard 1";

/* A name as one line: a backslash and a line's end are escaped. */
std::string escapedLine(const std::string &name) {
  std::string out;
  for (const char c : name) {
    if (c == '\\')
      out += "\\\\";
    else if (c == '\n')
      out += "\\n";
    else if (c == '\r')
      out += "\\r";
    else
      out += c;
  }
  return out;
}

std::string headText(const ShardHead &head) {
  std::string out = std::string(kMagic) + "\n# fingerprint " + head.fingerprint + "\n# shard " +
                    std::to_string(head.shard) + " of " + std::to_string(head.shards) + ", rows " +
                    std::to_string(head.range.first) + " to " + std::to_string(head.range.last) + "\n";
  for (const auto &[file, digest] : head.inputs) out += "# input " + digest + " " + escapedLine(file) + "\n";
  return out + "# trajectories " + head.trajectories + "\n";
}

/* What follows a word at the beginning of a line; nothing where it begins otherwise. */
std::optional<std::string> after(const std::string &line, const char *word) {
  const std::size_t size = std::strlen(word);
  if (line.compare(0, size, word) != 0) return std::nullopt;
  return line.substr(size);
}

/* The head's lines; the line behind them is left in `line`. */
ShardHead readHead(const std::function<bool(std::string &)> &next, std::string &line) {
  const auto need = [&](const char *word) {
    const std::optional<std::string> found = next(line) ? after(line, word) : std::nullopt;
    if (!found) throw BadInput("it is no shard: '" + std::string(word) + "' is expected");
    return *found;
  };
  ShardHead head;
  need(kMagic);
  head.fingerprint = need("# fingerprint ");
  const std::string range = need("# shard ");
  const int read = std::sscanf(range.c_str(), "%zu of %zu, rows %zu to %zu", &head.shard, &head.shards,
                               &head.range.first, &head.range.last);
  if (read != 4 || head.shard >= head.shards || head.range.first > head.range.last)
    throw BadInput("it is no shard: '" + line + "' is not understood");
  constexpr std::size_t kDigits = 64;
  while (next(line)) {
    if (const std::optional<std::string> input = after(line, "# input ")) {
      if (input->size() <= kDigits + 1) throw BadInput("it is no shard: '" + line + "' is not understood");
      head.inputs[input->substr(kDigits + 1)] = input->substr(0, kDigits);
      continue;
    }
    const std::optional<std::string> trajectories = after(line, "# trajectories ");
    if (!trajectories) break;
    head.trajectories = *trajectories;
    if (next(line)) return head;
    break;
  }
  throw BadInput("it is torn: its head has no end");
}

} // namespace

std::string shardPath(const std::string &folder, std::size_t shard, std::size_t shards) {
  char name[80];
  std::snprintf(name, sizeof name, "shard-%05zu-of-%05zu.csv", shard, shards);
  return (std::filesystem::path(folder) / name).string();
}

ShardWriter::ShardWriter(std::string path, const ShardHead &head, const std::string &header)
    : path_(std::move(path)), beside_(path_ + "." + std::to_string(getpid()) + ".part") {
  errno = 0;
  file_ = std::fopen(beside_.c_str(), "wb");
  if (!file_) throw BadUsage(beside_ + ": cannot be written: " + std::strerror(errno));
  write(headText(head) + header);
}

ShardWriter::~ShardWriter() {
  if (!file_) return;
  std::fclose(file_);
  std::remove(beside_.c_str());
}

void ShardWriter::fail() const {
  throw std::runtime_error(beside_ + ": writing failed: " + std::strerror(errno));
}

void ShardWriter::put(const std::string &text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail();
}

void ShardWriter::write(const std::string &lines) {
  hasher_.add(lines.data(), lines.size());
  put(lines);
}

void ShardWriter::finish() {
  put("# end " + toHex(hasher_.finish()) + "\n");
  if (std::fflush(file_) != 0 || fsync(fileno(file_)) != 0) fail();
  std::FILE *file = file_;
  file_ = nullptr;
  if (std::fclose(file) != 0 || std::rename(beside_.c_str(), path_.c_str()) != 0) {
    const int why = errno;
    std::remove(beside_.c_str());
    throw std::runtime_error(path_ + ": writing failed: " + std::strerror(why));
  }

  /* the name, too */
  const std::string folder = std::filesystem::path(path_).parent_path().string();
  const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

ShardHead readShard(const std::string &path, std::string &header, const std::function<void(const std::string &)> &row) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw BadInput("it cannot be read");
  Hasher hasher;
  const auto next = [&](std::string &line) {
    return std::getline(stream, line) && !stream.eof(); // a last line without its end is torn
  };
  const auto nextHashed = [&](std::string &line) {
    if (!next(line)) return false;
    hasher.add(line.data(), line.size()).add("\n", 1);
    return true;
  };
  ShardHead head = readHead(nextHashed, header);
  std::string line;
  while (next(line)) {
    if (const std::optional<std::string> digest = after(line, "# end ")) {
      std::string more;
      if (*digest != toHex(hasher.finish()) || std::getline(stream, more))
        throw BadInput("it is torn: its digest does not fit");
      return head;
    }
    hasher.add(line.data(), line.size()).add("\n", 1);
    row(line);
  }
  throw BadInput("it is torn: it has no end");
}

} // namespace curve_proximity::cli
