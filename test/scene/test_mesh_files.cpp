/* SPDX-License-Identifier: BSD-3-Clause */
/* Mesh files: read as geometric_shapes reads them, in a process of its own; what is wrong with one is said in one line.
 */
#include <sys/stat.h>
#include <sys/wait.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <memory>
#include <thread>

#include <geometric_shapes/mesh_operations.h>

#include "mesh_files.h"
#include "mesh_process.h"
#include "support.h"

namespace curve_proximity {
namespace {

using test::errorOf;
using test::expectContains;
using test::MeshFolder;

std::string why(const std::string &file) {
  return errorOf([&] { readMesh(file); });
}

void expectSame(const std::string &file) {
  const std::string bytes = test::readText(file);
  const std::unique_ptr<const shapes::Mesh> expected(shapes::createMeshFromBinary(bytes.data(), bytes.size(), file));
  ASSERT_TRUE(expected) << file;
  const MeshData mesh = readMesh(file);
  ASSERT_EQ(mesh.vertices.cols(), static_cast<Eigen::Index>(expected->vertex_count)) << file;
  ASSERT_EQ(mesh.triangles.cols(), static_cast<Eigen::Index>(expected->triangle_count)) << file;
  for (Eigen::Index i = 0; i < mesh.vertices.size(); ++i)
    ASSERT_EQ(mesh.vertices.data()[i], expected->vertices[i]) << file;
  for (Eigen::Index i = 0; i < mesh.triangles.size(); ++i)
    ASSERT_EQ(static_cast<unsigned>(mesh.triangles.data()[i]), expected->triangles[i]) << file;
}

TEST(MeshFiles, are_read_as_geometric_shapes_reads_them) {
  const MeshFolder folder;
  for (const auto &[name, content] : test::meshFiles()) expectSame(folder.write(name, content));
  std::size_t files = 0;
  for (const auto &entry : std::filesystem::recursive_directory_iterator(TEST_DATA_DIR)) {
    if (entry.path().extension() != ".stl") continue;
    expectSame(entry.path().string());
    ++files;
  }
  EXPECT_GE(files, 20u);
}

/* Nodes with poses of their own, and an axis that libassimp would turn. */
TEST(MeshFiles, collada_nodes_stand_where_their_poses_put_them_and_axes_are_not_turned) {
  const MeshFolder folder;
  std::string text = test::collada();
  const std::string node = "<instance_geometry url=\"#m\"/></node>";
  text.replace(text.find(node), node.size(),
               node + "<node id=\"o\"><translate>1 2 3</translate><scale>2 1 1</scale>" + node);
  for (const std::string axis : {"X_UP", "Y_UP", "Z_UP"}) {
    std::string turned = text;
    turned.replace(turned.find("Z_UP"), 4, axis);
    const std::string file = folder.write(axis + ".dae", turned);
    expectSame(file);
    EXPECT_EQ(readMesh(file).triangles.cols(), 8);
  }
}

TEST(MeshFiles, stl_files_that_are_cut_or_too_long_say_by_how_much) {
  const MeshFolder folder;
  const std::string binary = test::binaryStl(), text = test::textStl();
  const auto stl = [&](const std::string &content) { return why(folder.write("a.stl", content)); };
  expectContains(stl(binary.substr(0, 84 + 50 + 49)), "the header promises 4 triangles, the file ends after 1");
  expectContains(stl(binary + "xy"), "which end at byte 284: the file has 2 bytes more");
  expectContains(stl("solid" + binary.substr(5, 84 + 60)), "the header promises 4 triangles, the file ends after 1");
  expectContains(stl(text.substr(0, text.find("endsolid"))),
                 "line 30: the file ends after 4 triangles without 'endsolid'");
  expectContains(stl(text.substr(0, text.find("endloop"))),
                 "line 7: the file ends after 1 triangle without 'endsolid'");
  expectContains(stl(text + "facet"), "line 31: 'facet' stands after the end");
  expectContains(stl("solid\nendsolid\n"), "no triangle");
  expectContains(stl("this is no mesh"), "'solid'");
  expectContains(stl(std::string(80, ' ') + std::string(4, '\0')), "no triangle");
  std::string comma = text; /* what libassimp takes */
  comma.replace(comma.find("vertex 1"), 8, "vertex 1,5");
  EXPECT_EQ(readMesh(folder.write("comma.stl", comma)).vertices.row(0).maxCoeff(), 1.5);
}

TEST(MeshFiles, what_is_wrong_is_said_with_its_place) {
  const MeshFolder folder;
  const auto changed = [&](const std::string &name, std::string content, const std::string &from,
                           const std::string &to) {
    content.replace(content.find(from), from.size(), to);
    return why(folder.write(name, content));
  };
  const std::string ply = test::textPly(), obj = test::obj(), dae = test::collada(), stl = test::textStl();
  expectContains(changed("a.stl", stl, "vertex 0 0 0", "vertex 0 x 0"),
                 "line 4: a vertex needs three numbers: 'x' is none");
  expectContains(changed("a.stl", stl, "  vertex 0 0 0\n", ""), "line 7: a facet ends after 2 of 3 vertices");
  expectContains(changed("a.stl", stl, " endloop", "vertex 0 0 0\n endloop"), "line 7: a vertex outside");
  expectContains(changed("a.ply", ply, "face 4", "face 5"),
                 "the header promises 5 of the element 'face', the file ends after 4");
  expectContains(changed("a.ply", ply, "vertex 4", "vertex 400000000"), "the file ends after 8");
  expectContains(changed("a.ply", ply, "vertex 4", "vertex -4"),
                 "line 4: element 'vertex': '-4' is no number of elements");
  expectContains(changed("a.ply", ply, "3 0 2 1", "3 0 2 7"),
                 "element 'face' 1 of 4: it uses vertex 7, but there are 4");
  expectContains(changed("a.ply", ply, "3 0 2 1", "3 0 2"), "line 16: element 'face' 1 of 4: the line ends too early");
  expectContains(changed("a.ply", ply, "float x", "floot x"), "line 5: 'floot' is no type");
  expectContains(changed("a.ply", ply, "property float y", "propeloat y"),
                 "line 6: 'propeloat' is no word of a PLY header");
  expectContains(changed("a.ply", ply, "end_header", ""), "line 12: '0' is no word of a PLY header");
  expectContains(changed("a.ply", test::binaryPly(true), "face 4", "face 9"),
                 "the header promises 9 of the element 'face', the file ends after 4");
  expectContains(changed("a.obj", obj, "f 1 3 2", "f 1 3 9"), "line 11: a face uses vertex 9, but there are 4");
  expectContains(changed("a.obj", obj, "f 1 3 2", "f 1 3 0"), "line 11: '0' is no vertex");
  expectContains(changed("a.obj", obj, "f -2 -4", "f -2 -5"), "a face uses vertex -5");
  expectContains(changed("a.obj", obj, "v 0 0 0", "v 0 0"), "line 4: a vertex needs three numbers");
  expectContains(changed("a.dae", dae, "count=\"12\"", "count=\"4000000000\""),
                 "a float_array promises '4000000000' numbers and has 12");
  expectContains(changed("a.dae", dae, "</float_array>", ""), "its XML is wrong in line");
  expectContains(changed("a.dae", dae, "2 0 3</p>", "2 0 9</p>"), "9/4");
  expectContains(changed("a.dae", dae, "triangles count=\"4\"", "triangles count=\"400000000\""), "");
}

/* Wherever a file is cut: refused, or nothing was lost. (An OBJ file does not say how long it is.) */
TEST(MeshFiles, a_file_that_is_cut_anywhere_never_loses_a_triangle) {
  const MeshFolder folder;
  for (const auto &[name, content] : test::meshFiles()) {
    if (name == "wavefront.obj") continue;
    for (std::size_t length = 1; length < content.size(); length += 7) {
      const std::string file = folder.write(name, content.substr(0, length));
      try {
        EXPECT_EQ(readMesh(file).triangles.cols(), 4) << name << " cut to " << length;
        EXPECT_GE(length + 24, content.size()) << name;
      } catch (const Error &error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        expectContains(error.what(), name);
      }
    }
  }
}

/* ---- the process ---- */

std::size_t openDescriptors() {
  std::size_t n = 0;
  for (const auto &entry : std::filesystem::directory_iterator("/proc/self/fd")) n += entry.exists() || true;
  return n;
}

void expectNothingLeft(std::size_t descriptors) {
  EXPECT_EQ(openDescriptors(), descriptors);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1); /* no child, dead or alive */
  EXPECT_EQ(errno, ECHILD);
}

/* Programs that do not keep the protocol. */
TEST(MeshProcess, whatever_the_program_does_is_an_error) {
  const MeshFolder folder;
  const std::string file = folder.write("a.stl", test::binaryStl());
  const auto by = [&](const std::string &script) {
    const std::string program = folder.write("reader", "#!/bin/sh\n" + script + "\n");
    chmod(program.c_str(), 0755);
    return errorOf([&] { readMeshBy(program, file); });
  };
  const std::size_t descriptors = openDescriptors();
  expectContains(by("kill -SEGV $$"), "crashes on it (Segmentation fault)");
  expectContains(by("kill -ABRT $$"), "crashes on it (Aborted)");
  expectContains(by("kill -XCPU $$"), "takes more than 5 s");
  expectContains(by("kill -ALRM $$"), "takes more than 20 s");
  expectContains(by("exit 0"), "without an answer");
  expectContains(by("exec >&-; sleep 600"), "more than 20 s"); /* closed its output and stays: ended after 2 s */
  expectContains(by("echo what is this, a text of some length that is no message"), "without an answer");
  expectContains(by("exec cat /dev/zero"), "");
  expectContains(by(R"(printf 'n\003\0\0\0\0\0\0\0odd'; kill -SEGV $$)"), "(Segmentation fault); odd");
  expectContains(by(R"(printf 'e\003\0\0\0\0\0\0\0bad'; sleep 600)"), "bad"); /* answered: not waited for */
  expectContains(by(R"(printf 'm\377\377\377\377\377\377\377\377'; sleep 1)"), "without an answer");
  expectContains(by(R"(printf 'm\021\0\0\0\0\0\0\0\377\377\377\377\377\377\377\377\377\377\377\377\377\377\377\377.')"),
                 "without");
  expectContains(errorOf([&] { readMeshBy("/nowhere/reader", file); }), "'/nowhere/reader'");
  expectNothingLeft(descriptors);
}

/* A process that writes for ever without saying anything is heard until the deadline only. */
TEST(MeshProcess, one_that_says_nothing_is_ended) {
  const std::size_t descriptors = openDescriptors();
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const pid_t id = fork();
  if (id == 0) {
    for (;;) pause();
  }
  close(ends[1]);
  const auto begin = std::chrono::steady_clock::now();
  const mesh_reader::Limits limits{1 << 20, 1, 0};
  expectContains(errorOf([&] { hearMesh(ends[0], id, limits); }), "it takes more than 0 s");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
  close(ends[0]);
  expectNothingLeft(descriptors);
}

void reapAll(int) {
  const int before = errno;
  while (waitpid(-1, nullptr, WNOHANG) > 0) continue;
  errno = before;
}

TEST(MeshProcess, the_callers_signals_and_descriptors_may_be_as_they_like) {
  const MeshFolder folder;
  const std::string good = folder.write("a.stl", test::binaryStl()), bad = folder.write("b.stl", "solid");
  const auto inChild = [&](void (*prepare)()) {
    const pid_t id = fork();
    if (id == 0) {
      prepare();
      int faults = 0;
      for (int i = 0; i < 5; ++i) {
        try {
          faults += readMesh(good).triangles.cols() != 4;
        } catch (const Error &) {
          ++faults;
        }
        try {
          readMesh(bad);
          ++faults;
        } catch (const Error &error) {
          faults += std::string(error.what()).find("endsolid") == std::string::npos;
        }
      }
      _exit(faults);
    }
    int status = -1;
    waitpid(id, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  EXPECT_EQ(inChild([] {}), 0);
  EXPECT_EQ(inChild([] { std::signal(SIGCHLD, SIG_IGN); }), 0);
  EXPECT_EQ(inChild([] { std::signal(SIGCHLD, reapAll); }), 0);
  EXPECT_EQ(inChild([] { std::signal(SIGPIPE, SIG_IGN), raise(SIGPIPE); }), 0);
  EXPECT_EQ(inChild([] { close(0), close(1), close(2); }), 0);
  EXPECT_EQ(inChild([] { close(0), close(2); }), 0);
  EXPECT_EQ(inChild([] {
              sigset_t all;
              sigfillset(&all);
              sigprocmask(SIG_BLOCK, &all, nullptr);
            }),
            0);
}

TEST(MeshProcess, many_threads_read_at_once_and_leave_nothing_behind) {
  const MeshFolder folder;
  const std::string good = folder.write("a.stl", test::binaryStl()),
                    bad = folder.write("b.stl", test::binaryStl() + "x");
  readMesh(good);
  const std::size_t descriptors = openDescriptors();
  std::atomic<int> faults{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t)
    threads.emplace_back([&] {
      for (int i = 0; i < 10; ++i) {
        if (readMesh(good).triangles.cols() != 4) ++faults;
        try {
          readMesh(bad);
          ++faults;
        } catch (const Error &) {
        }
      }
    });
  for (std::thread &thread : threads) thread.join();
  EXPECT_EQ(faults, 0);
  expectNothingLeft(descriptors);
}

} // namespace
} // namespace curve_proximity
