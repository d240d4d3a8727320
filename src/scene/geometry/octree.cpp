/* SPDX-License-Identifier: BSD-3-Clause */
#include "octree.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <vector>

#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include "octree_bytes.h"

namespace curve_proximity {
namespace {

/* What a node costs while octomap holds the tree: itself, and eight pointers for each that has children. */
constexpr std::size_t NODE_BYTES = 96;

constexpr int CELLS = 1 << OCTREE_DEPTH;

/* ---- the header of a file ---- */

struct Header {
  OctreeData octree;
  std::size_t size = 0; /* nodes */
  bool has_size = false;
};

/* Lines of a word and a value, up to `data`; what is behind are the bytes. */
Header readHeader(std::istream &stream) {
  Header out;
  std::string line;
  std::getline(stream, line);
  const bool binary = line.rfind("# Octomap OcTree binary file", 0) == 0;
  if (!binary && line.rfind("# Octomap OcTree file", 0) != 0) throw Error("it begins with no octomap header");
  out.octree.binary = binary;
  out.octree.id.clear();
  while (std::getline(stream, line)) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "data") return out;
    if (key == "id") words >> out.octree.id;
    if (key == "res") words >> out.octree.resolution;
    if (key == "size") out.has_size = static_cast<bool>(words >> out.size);
    if (!words) throw Error("its header says '" + line + "'");
  }
  throw Error("its header has no end: the word data is missing");
}

/* ---- the cells ---- */

/* A cube of cells, counted from the corner of the space that octrees divide. */
struct Cube {
  std::array<int, 3> low;
  int span;

  Cube child(unsigned i) const {
    Cube out{low, span / 2};
    for (unsigned axis = 0; axis < 3; ++axis) out.low[axis] += (i >> axis & 1U) != 0 ? out.span : 0;
    return out;
  }
};

/* Boxes of cells, cut to where something was measured. */
struct Cells {
  std::array<int, 3> least{CELLS, CELLS, CELLS}, most{0, 0, 0};
  std::vector<std::array<int, 6>> boxes;

  void measured(const Cube &cube) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], cube.low[axis]);
      most[axis] = std::max(most[axis], cube.low[axis] + cube.span);
    }
  }

  void add(const Cube &cube) {
    std::array<int, 6> box{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box[axis] = std::max(cube.low[axis], least[axis]);
      box[axis + 3] = std::min(cube.low[axis] + cube.span, most[axis]);
      if (box[axis] >= box[axis + 3]) return;
    }
    boxes.push_back(box);
  }
};

/* Visits the cubes of the tree: known(cube, node) for leaves, unknown(cube) for children that are not there. */
template <class Tree, class Known, class Unknown>
void visit(const Tree &tree, const typename Tree::NodeType *node, const Cube &cube, const Known &known,
           const Unknown &unknown) {
  if (!tree.nodeHasChildren(node)) {
    known(cube, node);
    return;
  }
  for (unsigned i = 0; i < 8; ++i) {
    if (tree.nodeChildExists(node, i)) {
      visit(tree, tree.getNodeChild(node, i), cube.child(i), known, unknown);
    } else {
      unknown(cube.child(i));
    }
  }
}

template <class Tree>
Cells cellsIn(const OctreeData &octree, bool unknown_is_occupied) {
  Tree tree(octree.resolution);
  std::istringstream stream(octree.data);
  stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
  if (octree.binary) {
    tree.readBinaryData(stream);
  } else {
    tree.readData(stream);
  }

  // Occupied or free is all that is asked: eight children of one kind are one cube.
  tree.toMaxLikelihood();
  tree.prune();

  Cells cells;
  const Cube all{{0, 0, 0}, CELLS};
  using Node = typename Tree::NodeType;
  const auto nothing = [](const Cube &) {};
  visit(
      tree, tree.getRoot(), all, [&](const Cube &cube, const Node *) { cells.measured(cube); }, nothing);
  visit(
      tree, tree.getRoot(), all,
      [&](const Cube &cube, const Node *node) {
        if (tree.isNodeOccupied(node)) cells.add(cube);
      },
      [&](const Cube &cube) {
        if (unknown_is_occupied) cells.add(cube);
      });
  return cells;
}

Cells cellsOf(const OctreeData &octree, bool unknown_is_occupied) {
  return octree.id == "ColorOcTree" ? cellsIn<octomap::ColorOcTree>(octree, unknown_is_occupied)
                                    : cellsIn<octomap::OcTree>(octree, unknown_is_occupied);
}

} // namespace

bool isEmpty(const OctreeData &octree, bool unknown_is_occupied) {
  if (octree.data.empty()) return true;
  countNodes(octree);
  return cellsOf(octree, unknown_is_occupied).boxes.empty();
}

OctreeData readOctree(const std::string &file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error("octree '" + file + "' cannot be read");
  try {
    Header header = readHeader(stream);
    header.octree.data.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    const std::size_t nodes = header.octree.data.empty() ? 0 : countNodes(header.octree);
    if (header.has_size && nodes != header.size) {
      throw Error("its header promises " + std::to_string(header.size) + " nodes, it holds " + std::to_string(nodes));
    }
    return std::move(header.octree);
  } catch (const Error &error) {
    throw Error("octree '" + file + "': " + error.what());
  }
}

Boxes cellBoxes(const OctreeData &octree, bool unknown_is_occupied, std::size_t memory_limit) {
  if (octree.data.empty()) return {};
  const std::size_t nodes = countNodes(octree);
  if (nodes > memory_limit / NODE_BYTES) {
    throw Error(std::to_string(nodes) + " octree nodes need about " + std::to_string(nodes * NODE_BYTES) +
                    " bytes, above the limit of " + std::to_string(memory_limit),
                CPROX_MEMORY);
  }
  const Cells cells = cellsOf(octree, unknown_is_occupied);

  // Faces are products of whole numbers with the resolution, so that neighbours share theirs to the last bit.
  const auto n = static_cast<Eigen::Index>(cells.boxes.size());
  Boxes out{Eigen::Matrix3Xd(3, n), Eigen::Matrix3Xd(3, n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::array<int, 6> &box = cells.boxes[static_cast<std::size_t>(i)];
    for (int axis = 0; axis < 3; ++axis) {
      out.low(axis, i) = (box[static_cast<std::size_t>(axis)] - CELLS / 2) * octree.resolution;
      out.high(axis, i) = (box[static_cast<std::size_t>(axis) + 3] - CELLS / 2) * octree.resolution;
    }
  }
  return out;
}

} // namespace curve_proximity
