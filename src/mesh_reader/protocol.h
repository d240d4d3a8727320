/* SPDX-License-Identifier: BSD-3-Clause */
/* What the program curve_proximity_mesh_reader takes and says. Standard input is the file, the only argument its name.
 * Standard output is a row of messages: a kind, the bytes of the payload as uint64_t, the payload; numbers as this
 * machine has them. A mesh or an error is the last message. */
#ifndef CURVE_PROXIMITY_MESH_READER_PROTOCOL_H
#define CURVE_PROXIMITY_MESH_READER_PROTOCOL_H

#include <unistd.h>

#include <algorithm>
#include <cstdint>

namespace curve_proximity::mesh_reader {

/* A text about the mesh that follows: what its reader may not expect, such as a unit that is not 1 m. */
constexpr char REMARK = 'r';
/* A text: why there is no mesh. */
constexpr char ERROR = 'e';
/* Two uint64_t, V and T; 3 V doubles [m]; 3 T int32_t; the byte END. */
constexpr char MESH = 'm';
constexpr char END = '.';

constexpr std::size_t LONGEST_TEXT = 2000; /* [bytes] */

/* What reading a file may cost. */
struct Limits {
  std::uint64_t memory;    /* [bytes] of address space */
  unsigned processor_time; /* [s] */
  unsigned time;           /* [s] by the clock on the wall, for a machine that has other work */
};

inline Limits limitsFor(std::uint64_t file_size) {
  constexpr std::uint64_t MIB = std::uint64_t{1} << 20;
  const std::uint64_t physical = static_cast<std::uint64_t>(std::max(sysconf(_SC_PHYS_PAGES), 1L)) *
                                 static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  const std::uint64_t size = std::min(file_size, 4096 * MIB), mib = size / MIB;
  Limits out{};
  out.memory = std::min(512 * MIB + 64 * size, std::max(physical / 2, 512 * MIB));
  out.processor_time = static_cast<unsigned>(5 + mib / 2);
  out.time = static_cast<unsigned>(20 + 4 * mib);
  return out;
}

} // namespace curve_proximity::mesh_reader
#endif
