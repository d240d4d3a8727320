/* SPDX-License-Identifier: BSD-3-Clause */
/* curve_proximity_mesh_reader NAME <FILE: reads a mesh file for the library, whose process a malformed file must
 * neither end nor stall. What it says is in protocol.h. */
#include <dirent.h>
#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <vector>

#include "read.h"

namespace {

/* What the process that started this one had open: sockets, above all, that must not outlive it. */
void closeInherited() {
  std::vector<int> open;
  DIR *folder = opendir("/proc/self/fd");
  if (!folder) return;
  while (const dirent *entry = readdir(folder)) {
    const int descriptor = std::atoi(entry->d_name);
    if (descriptor > STDERR_FILENO && descriptor != dirfd(folder)) open.push_back(descriptor);
  }
  closedir(folder);
  for (const int descriptor : open) close(descriptor);
}

/* Where memory runs out this process goes first. */
void volunteerForOutOfMemory() {
  const int file = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  if (write(file, "1000", 4) < 0) { /* then not */
  }
  close(file);
}

} // namespace

int main(int argc, char **argv) {
  if (argc != 2) return 2;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  closeInherited();
  volunteerForOutOfMemory();
  curve_proximity::mesh_reader::answer(argv[1], STDIN_FILENO, STDOUT_FILENO);
  _exit(0);
}
