/* SPDX-License-Identifier: BSD-3-Clause */
/* Meshes that were read once, and the extreme points of their hulls: in the memory of this process, and in files under
 * the user's cache directory. Keys are digests of content; what a file of the cache says is believed only where its own
 * digest fits. */
#ifndef CURVE_PROXIMITY_SCENE_MESH_CACHE_H
#define CURVE_PROXIMITY_SCENE_MESH_CACHE_H

#include <memory>
#include <string>

#include "base/digest.h"
#include "hull.h"
#include "mesh.h"

namespace curve_proximity {

/* A mesh and what covers it at a scale. The mesh is empty where it came from no file. */
struct PreparedMesh {
  MeshData mesh;      /* not scaled; simplified where that was asked for */
  double moved = 0.0; /* [m] what that moved, at most */
  HullPoints hull;
};
using PreparedMeshPtr = std::shared_ptr<const PreparedMesh>;

/* ---- in memory ---- */

/* What was kept under a key, or NULL. The latest uses of up to 64 MiB are kept. Thread safety: any number of threads.
 */
PreparedMeshPtr recallMesh(const Digest &key);
void keepMesh(const Digest &key, const PreparedMeshPtr &mesh);

/* Forgets all that is kept in memory. */
void forgetMeshes();

/* ---- on disk ---- */

/* What the folder holds under a key; NULL where it holds nothing, or something else: a file that is cut short, changed,
 * of another version or of another user. */
PreparedMeshPtr loadMesh(const std::string &folder, const Digest &key);

/* Writes under another name, then renames: other processes find all or nothing. A folder that cannot be written is no
 * fault. Beyond 1 GiB the files that were not used for longest are removed. */
void saveMesh(const std::string &folder, const Digest &key, const PreparedMesh &mesh);

/* What keys of this version begin with. */
Hasher keyOf(const char *kind);

} // namespace curve_proximity
#endif
