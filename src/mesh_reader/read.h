/* SPDX-License-Identifier: BSD-3-Clause */
/* From the bytes of a mesh file to the messages of protocol.h. */
#ifndef CURVE_PROXIMITY_MESH_READER_READ_H
#define CURVE_PROXIMITY_MESH_READER_READ_H

#include <string>

namespace curve_proximity::mesh_reader {

/* Takes the limits on itself, reads the file from `in`, writes the messages to `out`. For a process that ends after it.
 */
void answer(const std::string &file, int in, int out);

} // namespace curve_proximity::mesh_reader
#endif
