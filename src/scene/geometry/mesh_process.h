/* SPDX-License-Identifier: BSD-3-Clause */
/* Reading a mesh file in a process of its own: what is in the file can neither end this process nor hold it up. */
#ifndef CURVE_PROXIMITY_SCENE_MESH_PROCESS_H
#define CURVE_PROXIMITY_SCENE_MESH_PROCESS_H

#include <sys/types.h>

#include <optional>
#include <string>

#include "../../mesh_reader/protocol.h"
#include "base/digest.h"
#include "mesh.h"

namespace curve_proximity {

/* The program curve_proximity_mesh_reader, where it stands beside this library. */
std::string meshReaderProgram();

/* What `program` says of the file (mesh_reader/protocol.h). The process has limits of memory and time, which grow with
 * the file; one that keeps neither them nor the protocol is ended. Throws Error in one message without the file's
 * name. Thread safety: any number of threads. SIGCHLD and SIGPIPE may be ignored, blocked or handled, and a handler may
 * reap. */
MeshData readMeshBy(const std::string &program, const std::string &file);

/* A mesh file as it is at one moment: its digest and what is read of it belong together, whoever writes the file
 * meanwhile. */
class MeshFile {
 public:
  /* Opens the file and copies it. Throws Error in one message without the file's name. */
  explicit MeshFile(const std::string &file);
  ~MeshFile();
  MeshFile(const MeshFile &) = delete;
  MeshFile &operator=(const MeshFile &) = delete;

  /* Of the content and of the name's extension, which tells the format; nothing where the file is too large to be
   * copied. */
  const std::optional<Digest> &digest() const {
    return digest_;
  }

  /* As readMeshBy(); once. */
  MeshData readBy(const std::string &program) const;

 private:
  std::string file_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::optional<Digest> digest_;
};

/* The second half of readMeshBy(): listens to the process of that id at the pipe `from`, then ends and reaps it. */
MeshData hearMesh(int from, pid_t id, const mesh_reader::Limits &limits);

} // namespace curve_proximity
#endif
