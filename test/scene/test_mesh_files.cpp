/* SPDX-License-Identifier: BSD-3-Clause */
/* Mesh files: read in double precision, in a process of its own, to the shape that geometric_shapes makes of them; what
 * is wrong with one is said in one line. */
#include <sys/stat.h>
#include <sys/wait.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <memory>
#include <thread>

#include <geometric_shapes/mesh_operations.h>

#include "geometry/mesh_process.h"
#include "mesh_files.h"
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
  ASSERT_EQ(mesh.triangles.cols(), static_cast<Eigen::Index>(expected->triangle_count)) << file;
  // A polygon has several ways to be cut: its corners and its area are the same for all.
  using Corner = std::array<double, 3>;
  std::set<Corner> corners, expected_corners;
  Eigen::Vector3d area = Eigen::Vector3d::Zero(), expected_area = area;
  for (Eigen::Index i = 0; i < mesh.triangles.cols(); ++i) {
    Eigen::Vector3d p[3], q[3];
    for (int k = 0; k < 3; ++k) {
      p[k] = mesh.vertices.col(mesh.triangles(k, i));
      q[k] = Eigen::Vector3d(expected->vertices + 3 * expected->triangles[3 * i + k]);
      corners.insert({p[k].x(), p[k].y(), p[k].z()});
      expected_corners.insert({q[k].x(), q[k].y(), q[k].z()});
    }
    area += (p[1] - p[0]).cross(p[2] - p[0]);
    expected_area += (q[1] - q[0]).cross(q[2] - q[0]);
  }
  EXPECT_EQ(corners, expected_corners) << file;
  EXPECT_NEAR((area - expected_area).norm(), 0.0, 1e-9) << file;
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

/* ---- coordinates, units, nodes ---- */

/* Points near `offset` whose decimals no float holds. */
std::vector<Eigen::Vector3d> somePoints(std::uint64_t seed, double offset) {
  test::Random random(seed);
  std::vector<Eigen::Vector3d> out;
  for (int i = 0; i < 4; ++i) out.push_back(random.vector(1.0) + Eigen::Vector3d(offset, -offset, 0.5 * offset));
  return out;
}

std::string digitsOf(const Eigen::Vector3d &p) {
  char text[100];
  std::snprintf(text, sizeof text, "%.17g %.17g %.17g", p.x(), p.y(), p.z());
  return text;
}

/* Those points in each format that has doubles, as a tetrahedron. */
std::vector<std::pair<std::string, std::string>> filesOf(const std::vector<Eigen::Vector3d> &points) {
  std::string header = test::plyHeader("ascii");
  for (const std::string axis : {"x", "y", "z"}) {
    const std::size_t at = header.find("property float " + axis);
    header.replace(at, 14, "property double");
  }
  std::string stl = "solid\n", ply = header, obj, dae = test::collada(), numbers, faces, binary = header;
  binary.replace(binary.find("ascii"), 5, "binary_big_endian");
  for (const Eigen::Vector3d &p : points) {
    ply += digitsOf(p) + " 255\n";
    obj += "v " + digitsOf(p) + "\n";
    numbers += digitsOf(p) + " ";
    for (int k = 0; k < 3; ++k) binary += test::bytesOf(p[k], false);
    binary += '\0';
  }
  for (const auto &face : test::FACES) {
    stl += "facet normal 0 0 0\nouter loop\n";
    obj += "f";
    ply += "3";
    binary += '\3';
    for (const int corner : face) {
      stl += "vertex " + digitsOf(points[static_cast<std::size_t>(corner)]) + "\n";
      obj += " " + std::to_string(corner + 1);
      ply += " " + std::to_string(corner);
      binary += test::bytesOf(corner, false);
    }
    stl += "endloop\nendfacet\n";
    obj += "\n";
    ply += "\n";
  }
  const std::string old = "0 0 0 1 0 0 0 1 0 0.25 0.25 1";
  dae.replace(dae.find(old), old.size(), numbers);
  return {{"text.stl", stl + "endsolid\n"}, {"text.ply", ply}, {"big.ply", binary}, {"o.obj", obj}, {"c.dae", dae}};
}

TEST(MeshFiles, coordinates_are_those_of_the_file_to_the_last_bit) {
  const MeshFolder folder;
  for (const double offset : {0.0, 1.0, 6280000.0, 1e12}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const std::vector<Eigen::Vector3d> points = somePoints(seed, offset);
      for (const auto &[name, content] : filesOf(points)) {
        const MeshData mesh = readMesh(folder.write(name, content));
        ASSERT_EQ(mesh.triangles.cols(), 4) << name;
        for (Eigen::Index t = 0; t < 4; ++t)
          for (int k = 0; k < 3; ++k) {
            const auto corner =
                static_cast<std::size_t>(test::FACES[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)]);
            ASSERT_EQ(mesh.vertices.col(mesh.triangles(k, t)), points[corner]) << name << " at " << offset;
          }
        EXPECT_EQ(mesh.remark, "");
      }
    }
  }
}

TEST(MeshFiles, a_collada_unit_multiplies_coordinates_and_poses_and_is_said) {
  const MeshFolder folder;
  std::string text = test::collada();
  text.replace(text.find("meter=\"1\""), 9, "meter=\"0.01\"");
  text.replace(text.find("<node id=\"n\">"), 13, "<node id=\"n\"><translate>100 0 0</translate>");
  const MeshData mesh = readMesh(folder.write("a.dae", text));
  EXPECT_NEAR(mesh.vertices.row(0).minCoeff(), 1.0, 1e-15);
  EXPECT_NEAR(mesh.vertices.row(0).maxCoeff(), 1.01, 1e-15);
  EXPECT_NEAR(mesh.vertices.row(2).maxCoeff(), 0.01, 1e-15);
  expectContains(mesh.remark, "its unit is '0.01' m");
}

TEST(MeshFiles, of_collada_all_polygons_and_maps_and_instances_are_read) {
  const MeshFolder folder;
  const auto meshOf = [&](const std::string &lists, const std::string &nodes) {
    std::string text = test::collada();
    const std::size_t begin = text.find("<triangles"), end = text.find("</triangles>") + 12;
    text.replace(begin, end - begin, lists);
    const std::string node = "<instance_geometry url=\"#m\"/>";
    text.replace(text.find(node), node.size(), nodes.empty() ? node : nodes);
    return readMesh(folder.write("a.dae", text));
  };
  const std::string input =
      "<input semantic=\"NORMAL\" source=\"#v\" offset=\"0\"/><input semantic=\"VERTEX\" "
      "source=\"#v\" offset=\"1\"/>";
  const std::string four = "<p>9 0 9 1 9 2 9 3</p>";
  EXPECT_EQ(meshOf("<polylist count=\"1\">" + input + "<vcount>4</vcount>" + four + "</polylist>", "").triangles.cols(),
            2);
  EXPECT_EQ(meshOf("<polygons count=\"2\">" + input + four + four + "</polygons>", "").triangles.cols(), 4);
  EXPECT_EQ(meshOf("<tristrips count=\"1\">" + input + four + "</tristrips>", "").triangles.cols(), 2);
  const MeshData fan = meshOf("<trifans count=\"1\">" + input + four + "</trifans>", "");
  EXPECT_EQ(fan.triangles, (Triangles(3, 2) << 0, 0, 1, 2, 2, 3).finished());
  // From the right to the left: to (1, 0, 0), twice as large, a quarter turn about z, 10 along x.
  const MeshData moved = meshOf("<triangles count=\"1\">" + input + "<p>9 0 9 1 9 2</p></triangles>",
                                "<translate>10 0 0</translate><rotate>0 0 2 90</rotate><scale>2 2 2</scale>"
                                "<matrix>1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1</matrix>"
                                "<node id=\"deep\"><instance_geometry url=\"#m\"/></node>");
  EXPECT_EQ(moved.vertices, (Eigen::Matrix3Xd(3, 3) << 10, 10, 8, 2, 4, 2, 0, 0, 0).finished());
  // A mirror turns the triangles, so that their outside stays outside.
  const MeshData mirrored = meshOf("<triangles count=\"1\">" + input + "<p>9 0 9 1 9 2</p></triangles>",
                                   "<scale>-1 1 1</scale><instance_geometry url=\"#m\"/>");
  const auto corner = [&](int k) { return Eigen::Vector3d(mirrored.vertices.col(mirrored.triangles(k, 0))); };
  EXPECT_GT((corner(1) - corner(0)).cross(corner(2) - corner(0)).z(), 0.0);
  expectContains(errorOf([&] { meshOf("", "<instance_node url=\"#n\"/>"); }), "more than 200 nodes in each other");
}

/* ---- glTF ---- */

/* The tetrahedron below two nodes: 5 along x and a thousandth of its size, turned by half a turn about z. */
std::string glb(const std::string &node = R"("scale":[0.001,0.001,0.001],"translation":[5,0,0],"rotation":[0,0,1,0])",
                const std::string &more = "") {
  std::string binary;
  for (const auto &p : test::CORNERS)
    for (const float x : p) binary += test::bytesOf(x);
  for (const auto &face : test::FACES)
    for (const int corner : face) binary += static_cast<char>(corner);
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{)" + node +
      R"(,"children":[1]},{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
{"bufferView":1,"componentType":5121,"count":12,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],
"buffers":[{"byteLength":60}])" +
      more + "}";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto word = [](std::size_t n) { return test::bytesOf(static_cast<std::uint32_t>(n)); };
  const std::string chunks = word(json.size()) + "JSON" + json + word(binary.size()) + std::string("BIN\0", 4) + binary;
  return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
}

TEST(MeshFiles, a_gltf_mesh_stands_where_all_its_nodes_put_it) {
  const MeshFolder folder;
  const MeshData mesh = readMesh(folder.write("a.glb", glb()));
  ASSERT_EQ(mesh.triangles.cols(), 4);
  EXPECT_NEAR(mesh.vertices.row(0).maxCoeff(), 5.0, 1e-15);
  EXPECT_NEAR(mesh.vertices.row(0).minCoeff(), 4.999, 1e-15);
  EXPECT_NEAR(mesh.vertices.row(1).minCoeff(), -0.001, 1e-15);
  EXPECT_NEAR(mesh.vertices.row(2).maxCoeff(), 0.001, 1e-15);
  const MeshData matrix =
      readMesh(folder.write("b.glb", glb(R"("matrix":[-0.001,0,0,0,0,-0.001,0,0,0,0,0.001,0,5,0,0,1])")));
  EXPECT_LT((matrix.vertices - mesh.vertices).norm(), 1e-15);
}

TEST(MeshFiles, what_gltf_files_have_and_is_not_read_is_refused) {
  const MeshFolder folder;
  const auto bad = [&](const std::string &content) { return why(folder.write("a.glb", content)); };
  expectContains(bad(glb(R"("skin":0,"mesh":0)")), "node 0: skinned meshes are not read");
  expectContains(bad(glb(R"("mesh":0,"weights":[0.5])")), "mesh 0: morphed meshes are not read");
  expectContains(bad(glb(R"("scale":[1,1])")), "node 0: its scale has not 3 finite numbers");
  expectContains(bad(glb(R"("mesh":7)")), "mesh 7 is used, but there are 1");
  expectContains(bad(glb(R"("name":"n")", R"(,"extensionsRequired":["KHR_draco_mesh_compression"])")),
                 "it requires the extension 'KHR_draco_mesh_compression'");
  EXPECT_EQ(readMesh(folder.write("m.glb", glb(R"("name":"n")", R"(,"extensionsRequired":["KHR_materials_unlit"])")))
                .triangles.cols(),
            4);
  const std::string good = glb();
  expectContains(bad(good.substr(0, good.size() - 1)), "the header promises");
  std::string beyond = good;
  beyond.replace(beyond.find("\"count\":4"), 9, "\"count\":5");
  expectContains(bad(beyond), "accessor 0 goes beyond its view of 48 bytes");
  std::string index = good;
  index.back() = 9;
  expectContains(bad(index), "mesh 0 uses vertex 9, but there are 4");
  expectContains(why(folder.write("a.gltf", "{\"asset\":")), "its JSON is wrong at character");
}

/* ---- forms of text ---- */

TEST(MeshFiles, text_stl_may_begin_with_a_mark_or_blank_lines_and_be_in_capitals) {
  const MeshFolder folder;
  const std::string text = test::textStl();
  std::string capitals = text;
  for (char &c : capitals) c = static_cast<char>(std::toupper(c));
  for (const std::string &content :
       {"\xef\xbb\xbf" + text, "\n\r\n  \t\n" + text, capitals, "\xef\xbb\xbf\n" + capitals})
    EXPECT_EQ(readMesh(folder.write("a.stl", content)).triangles.cols(), 4) << content.substr(0, 20);
}

TEST(MeshFiles, obj_and_ply_may_begin_with_a_byte_order_mark) {
  const MeshFolder folder;
  for (const auto &[name, content] : test::meshFiles()) {
    if (name.find(".stl") != std::string::npos || name == "collada.dae") continue;
    EXPECT_EQ(readMesh(folder.write(name, "\xef\xbb\xbf" + content)).triangles.cols(), 4) << name;
  }
}

TEST(MeshFiles, vertices_of_obj_may_have_a_weight_or_a_colour) {
  const MeshFolder folder;
  const std::string rest = "v 0 1 0\nv 0 0 1\nf 1 2 3\n";
  EXPECT_EQ(readMesh(folder.write("a.obj", "v 2 4 6 2\n" + rest)).vertices.col(0), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(readMesh(folder.write("a.obj", "v 2 4 6 .5 .5 .5 # x\n" + rest)).vertices.col(0), Eigen::Vector3d(2, 4, 6));
  expectContains(why(folder.write("a.obj", "v 2 4 6 0\n" + rest)), "not finite");
}

TEST(MeshFiles, strips_of_triangles_in_ply_turn_every_second_one) {
  const MeshFolder folder;
  std::string ply = test::plyHeader("ascii");
  ply.replace(ply.find("face 4"), 6, "tristrips 1");
  for (const auto *p : {"0 0 0 1", "1 0 0 1", "0 1 0 1", "1 1 0 1"}) ply += std::string(p) + "\n";
  const MeshData mesh = readMesh(folder.write("a.ply", ply + "8 0 1 2 3 -1 0 1 2\n"));
  EXPECT_EQ(mesh.triangles, (Triangles(3, 3) << 0, 2, 0, 1, 1, 1, 2, 3, 2).finished());
}

/* Random polygons round a point, most of them not convex: the triangles cover each exactly once, all on one side. */
TEST(MeshFiles, polygons_are_cut_into_triangles_of_their_area_and_side) {
  const MeshFolder folder;
  test::Random random(20261127);
  for (int round = 0; round < 50; ++round) {
    const std::size_t n = 4 + random.below(12);
    const Eigen::Matrix3d turn = random.pose(0.0).linear();
    std::vector<Eigen::Vector3d> corners;
    std::string obj, face = "f";
    double area = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(n);
      const double r = random.uniform(0.2, 1.0);
      corners.emplace_back(turn * Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), 0.3));
      obj += "v " + digitsOf(corners.back()) + "\n";
      face += " " + std::to_string(i + 1);
    }
    const Eigen::Vector3d normal = turn.col(2);
    for (std::size_t i = 0; i < n; ++i) area += 0.5 * normal.dot(corners[i].cross(corners[(i + 1) % n]));
    const MeshData mesh = readMesh(folder.write("a.obj", obj + face + "\n"));
    ASSERT_EQ(mesh.triangles.cols(), static_cast<Eigen::Index>(n - 2));
    double sum = 0.0;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
      const auto corner = [&](int k) { return Eigen::Vector3d(mesh.vertices.col(mesh.triangles(k, t))); };
      const double part = 0.5 * normal.dot((corner(1) - corner(0)).cross(corner(2) - corner(0)));
      EXPECT_GE(part, -1e-14);
      sum += part;
    }
    EXPECT_NEAR(sum, area, 1e-13);
    EXPECT_EQ(mesh.remark, "");
  }
  const std::string bow = "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nv 0.5 2 0\nf 1 2 3 4 5\n";
  const MeshData crossed = readMesh(folder.write("a.obj", bow));
  EXPECT_EQ(crossed.triangles.cols(), 3);
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
  std::string comma = text; /* as some programs write it */
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
  expectContains(changed("a.dae", dae, "2 0 3</p>", "2 0 9</p>"), "line 9: it uses vertex 9, but there are 4");
  expectContains(changed("a.dae", dae, "triangles count=\"4\"", "triangles count=\"400000000\""),
                 "<triangles> promises 400000000 polygons and has 4");
  expectContains(changed("a.dae", dae, "url=\"#m\"", "url=\"#q\""), "names '#q', but there is no such <geometry>");
  expectContains(changed("a.dae", dae, "url=\"#m\"", "url=\"other.dae#m\""), "other files are not read");
  expectContains(changed("a.dae", dae, "<instance_geometry", "<instance_controller url=\"#c\"/><instance_geometry"),
                 "line 11: skinned and morphed meshes");
  expectContains(changed("a.dae", dae, "meter=\"1\"", "meter=\"0\""), "line 3: '0' is no unit");
  expectContains(changed("a.obj", obj, "g b", "surf 0 1 0 1 1 2"), "'surf' is not read");
  expectContains(changed("a.obj", obj, "v 0 0 0", "v 0 0 0 1 1"), "a vertex has three numbers");
  expectContains(why(folder.write("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")),
                 "its format 'off' is none of stl, ply, obj, dae, gltf, glb");
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
  expectContains(by(R"(printf 'r\003\0\0\0\0\0\0\0odd'; kill -SEGV $$)"), "(Segmentation fault)");
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
