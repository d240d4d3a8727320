/* SPDX-License-Identifier: BSD-3-Clause */
#include "octree_bytes.h"

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <curve_proximity/core.hpp>

namespace curve_proximity {
namespace {

/* Reads along, and knows where the end is. */
class Bytes {
 public:
  explicit Bytes(const std::string &data) : data_(data) {}

  unsigned byte() {
    need(1);
    return static_cast<unsigned char>(data_[at_++]);
  }

  float number() {
    float value;
    need(sizeof value);
    std::memcpy(&value, data_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }

  void skip(std::size_t n) {
    need(n);
    at_ += n;
  }

 private:
  void need(std::size_t n) const {
    if (data_.size() - at_ >= n) return;
    throw Error("octree is cut short: its " + std::to_string(data_.size()) + " bytes end inside a node");
  }

  const std::string &data_;
  std::size_t at_ = 0;
};

/* The levels of the nodes that are yet to come, the next one last: nodes stand parent first, its children in order. */
class Levels {
 public:
  bool next(int &level) {
    if (waiting_.empty()) return false;
    level = waiting_.back();
    waiting_.pop_back();
    return true;
  }

  void add(int level) {
    if (level > OCTREE_DEPTH) {
      throw Error("octree goes deeper than " + std::to_string(OCTREE_DEPTH) + " levels: these are not its bytes");
    }
    waiting_.push_back(level);
  }

 private:
  std::vector<int> waiting_ = {0};
};

/* Two bits a child: 00 none, 01 and 10 a leaf, 11 a child that has children itself and comes later. */
std::size_t countBinary(Bytes bytes) {
  std::size_t nodes = 1;
  Levels levels;
  for (int level = 0; levels.next(level);) {
    const unsigned low = bytes.byte(), children = low | bytes.byte() << 8U;
    for (unsigned i = 0; i < 8; ++i) {
      const unsigned child = children >> 2U * i & 3U;
      if (child != 0) ++nodes;
      if (child != 0 && level == OCTREE_DEPTH) levels.add(level + 1);
      if (child == 3) levels.add(level + 1);
    }
  }
  return nodes;
}

/* Occupancy, `extra` bytes, and a bit for each child that follows. */
std::size_t countFull(Bytes bytes, std::size_t extra) {
  std::size_t nodes = 0;
  Levels levels;
  for (int level = 0; levels.next(level);) {
    ++nodes;
    if (!std::isfinite(bytes.number()))
      throw Error("octree node " + std::to_string(nodes - 1) + " has no finite occupancy");
    bytes.skip(extra);
    for (unsigned children = bytes.byte(); children != 0; children &= children - 1) levels.add(level + 1);
  }
  return nodes;
}

} // namespace

std::size_t countNodes(const OctreeData &octree) {
  if (!(octree.resolution > 0.0 && std::isfinite(octree.resolution))) {
    throw Error("octree resolution is " + std::to_string(octree.resolution) + ": it must be above 0 and finite");
  }
  const bool plain = octree.id == "OcTree", coloured = octree.id == "ColorOcTree";
  if (!plain && !coloured) throw Error("octree is of kind '" + octree.id + "': OcTree and ColorOcTree can be read");
  if (octree.binary) return countBinary(Bytes(octree.data));
  constexpr std::size_t colour = 3;
  return countFull(Bytes(octree.data), coloured ? colour : 0);
}

} // namespace curve_proximity
