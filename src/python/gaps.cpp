/* SPDX-License-Identifier: BSD-3-Clause */
/* Solid and FourierGap of the module cprox: cprox_fourier.h with NumPy arrays. */
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <curve_proximity/fourier.hpp>

#include "conversion.h"

namespace curve_proximity::python {
namespace {

/** A solid, as Python holds it. */
struct Solid {
  SolidHandle solid;
};

/* Two or three numbers: the dimension, and the numbers, the third one 0. */
int spread(const Array &array, const char *what, cprox_vec3 &out) {
  if (array.ndim() != 1 || (array.shape(0) != 2 && array.shape(0) != 3))
    throw Error(std::string(what) + " must be two numbers in the plane, or three in space");
  const bool planar = array.shape(0) == 2;
  out = {array.at(0), array.at(1), planar ? 0.0 : array.at(2)};
  return planar ? 2 : 3;
}

cprox_solid_description described(cprox_solid_kind kind, int dimension = 3) {
  cprox_solid_description out{};
  out.kind = kind;
  out.dimension = dimension;
  return out;
}

Solid polygonOf(const Array &corners) {
  if (corners.ndim() != 2 || corners.shape(1) != 2) throw Error("corners must be an array of shape (n, 2)");
  cprox_solid_description d = described(CPROX_SOLID_POLYGON, 2);
  d.corners = reinterpret_cast<const double(*)[2]>(corners.data());
  d.n = static_cast<std::size_t>(corners.shape(0));
  return {makeSolid(d)};
}

Solid meshOf(const Array &vertices, const py::object &given) {
  const Points points(vertices, "vertices");
  const Whole corners = toWhole(given, "triangles", 0, 0xffffffff);
  if (corners.ndim() != 2 || corners.shape(1) != 3) throw Error("triangles must be an array of shape (m, 3)");
  const std::vector<std::uint32_t> indices(corners.data(), corners.data() + corners.size());
  cprox_solid_description d = described(CPROX_SOLID_MESH);
  d.points = points.data, d.n = points.size;
  d.triangles = reinterpret_cast<const std::uint32_t(*)[3]>(indices.data());
  d.n_triangles = static_cast<std::size_t>(corners.shape(0));
  return {makeSolid(d)};
}

Solid unionOf(const std::vector<Solid> &parts, const std::vector<Array> &poses) {
  std::vector<SolidHandle> handles;
  std::vector<cprox_pose> places;
  for (const Solid &part : parts) handles.push_back(part.solid);
  for (const Array &pose : poses) places.push_back(toPose(toTransform(pose)));
  return {makeUnion(handles, places)};
}

/* The occupied cells of an array by (x, y, z), or (x, y) in the plane; the library wants x fastest. */
Solid gridOf(const py::array_t<bool, py::array::forcecast> &occupied, const Array &lowest, double cell) {
  cprox_solid_description d = described(CPROX_SOLID_GRID);
  d.dimension = spread(lowest, "lowest", d.lowest);
  if (occupied.ndim() != d.dimension) throw Error("occupied must have as many dimensions as lowest has numbers");
  d.cell = cell;
  std::array<py::ssize_t, 3> n = {1, 1, 1};
  for (int i = 0; i < d.dimension; ++i) {
    n[static_cast<std::size_t>(i)] = occupied.shape(i);
    if (occupied.shape(i) > (py::ssize_t{1} << 30)) throw Error("occupied has more than 2^30 cells");
    d.counts[i] = static_cast<std::uint32_t>(occupied.shape(i));
  }
  if (d.dimension == 2) d.counts[2] = 1;
  std::vector<unsigned char> cells;
  for (py::ssize_t z = 0; z < n[2]; ++z)
    for (py::ssize_t y = 0; y < n[1]; ++y)
      for (py::ssize_t x = 0; x < n[0]; ++x)
        cells.push_back(d.dimension == 2 ? occupied.at(x, y) : occupied.at(x, y, z));
  d.occupied = cells.data();
  return {makeSolid(d)};
}

/* A convex body as a solid: the box about it, clipped by its tangents. */
Solid solidOf(const Shape &shape, int dimension) {
  cprox_vec3 low, high;
  const auto reach = [&](double x, double y, double z) {
    cprox_vec3 at;
    const double height = cprox_body_support(shape.body.get(), {x, y, z}, &at);
    if (!(height < 1e100)) throw Error("the shape is no bounded convex body");
    return height;
  };
  high = {reach(1, 0, 0), reach(0, 1, 0), dimension == 2 ? 0.0 : reach(0, 0, 1)};
  low = {-reach(-1, 0, 0), -reach(0, -1, 0), dimension == 2 ? 0.0 : -reach(0, 0, -1)};
  cprox_solid_description box = described(CPROX_SOLID_BOX, dimension);
  box.size = {high.x - low.x, high.y - low.y, high.z - low.z};
  cprox_pose middle = CPROX_POSE_IDENTITY;
  middle.position = {0.5 * (low.x + high.x), 0.5 * (low.y + high.y), 0.5 * (low.z + high.z)};
  const SolidHandle about = makeUnion({makeSolid(box)}, {middle});
  cprox_solid_description d = described(CPROX_SOLID_CLIPPED, dimension);
  d.solid = about.get();
  d.body = shape.body.get();
  return {makeSolid(d)};
}

cprox_gap_mode modeOf(const std::string &mode) {
  if (mode == "certified") return CPROX_GAP_MODE_CERTIFIED;
  if (mode == "tuned") return CPROX_GAP_MODE_TUNED;
  if (mode == "signal") return CPROX_GAP_MODE_SIGNAL;
  throw Error("mode '" + mode + "' is none of certified, tuned, signal");
}

GapHandle gapOf(const Solid &a, const Solid &b, Count samples, double delta, const std::string &mode, double period,
                std::size_t memory_limit) {
  cprox_gap_options options = CPROX_GAP_OPTIONS_DEFAULT;
  options.mode = modeOf(mode);
  options.samples = samples == 0 && delta == 0.0 ? 33 : samples;
  options.delta = delta;
  options.period = period;
  options.memory_limit = memory_limit;
  const Workspace workspace;
  cprox_workspace_set_stop(workspace.get(), interrupted, nullptr);
  return unlocked([&] { return makeGap(a.solid, b.solid, options, workspace); });
}

/* A gap, as Python holds it. */
struct Gap {
  GapHandle gap;
  cprox_gap_info info;
};

/* -log(V/t) times the length, of the signal c times the length. */
double metresOf(const Gap &gap, const cprox_gap_result &r) {
  return gap.info.length * (gap.info.mode == CPROX_GAP_MODE_SIGNAL ? r.value : -std::log(r.value));
}

/* By the pose of b: three numbers by its position, three by its turn in the axes of the world, as providers have it. */
void writeGradient(const cprox_pose &b, const cprox_gap_result &r, double *to) {
  const cprox_quat &q = b.orientation;
  const Eigen::Vector3d turn = Eigen::Quaterniond(q.w, q.x, q.y, q.z) * toEigen(r.rotation_b);
  const cprox_vec3 &linear = r.position_b;
  for (const double number : {linear.x, linear.y, linear.z, turn.x(), turn.y(), turn.z()}) *to++ = number;
}

py::dict resultOf(const Gap &gap, const cprox_pose &b, const cprox_gap_result &r, cprox_status status, bool gradient) {
  py::dict out;
  out["verdict"] = cprox_gap_verdict_name(r.verdict);
  out["value"] = r.value;
  out["error"] = r.error;
  out["metres"] = metresOf(gap, r);
  out["clearance"] = r.clearance;
  out["terms"] = r.terms;
  out["status"] = cprox_status_name(status);
  if (gradient) {
    Array numbers(6);
    writeGradient(b, r, numbers.mutable_data());
    out["gradient"] = numbers;
  }
  return out;
}

py::dict evaluateAt(const Gap &gap, const Array &pose_b, const std::optional<Array> &pose_a) {
  const cprox_pose a = toPose(toTransform(pose_a)), b = toPose(toTransform(pose_b));
  cprox_status status;
  const cprox_gap_result r = evaluate(gap.gap, a, b, threadWorkspace(), &status);
  return resultOf(gap, b, r, status, true);
}

py::dict testAt(const Gap &gap, const Array &pose_b, const std::optional<Array> &pose_a) {
  const cprox_pose a = toPose(toTransform(pose_a)), b = toPose(toTransform(pose_b));
  return resultOf(gap, b, test(gap.gap, a, b, threadWorkspace()), CPROX_OK, false);
}

py::tuple evaluateMany(const Gap &gap, const Array &poses_b, const std::optional<Array> &pose_a) {
  if (poses_b.ndim() != 3 || poses_b.shape(1) != 4 || poses_b.shape(2) != 4)
    throw Error("poses_b must be an array of shape (n, 4, 4)");
  const cprox_pose a = toPose(toTransform(pose_a));
  const py::ssize_t n = poses_b.shape(0);
  std::vector<cprox_pose> poses;
  for (py::ssize_t i = 0; i < n; ++i)
    poses.push_back(toPose(toTransform(Array({4, 4}, poses_b.data(i, 0, 0), poses_b))));
  Array values(n), gradients({n, py::ssize_t{6}});
  double *value = values.mutable_data(), *gradient = gradients.mutable_data();
  Workspace &workspace = threadWorkspace();
  {
    const py::gil_scoped_release unlocked;
    for (const cprox_pose &b : poses) {
      const cprox_gap_result r = evaluate(gap.gap, a, b, workspace);
      *value++ = r.value;
      writeGradient(b, r, gradient);
      gradient += 6;
    }
  }
  return py::make_tuple(values, gradients);
}

} // namespace

void addGaps(py::module &module) {
  py::class_<Solid>(
      module, "Solid",
      "A solid in the plane or in space for FourierGap: the closed-form Fourier transform of its indicator.")
      .def_static(
          "ball",
          [](double radius, int dimension) {
            cprox_solid_description d = described(CPROX_SOLID_BALL, dimension);
            d.radius = radius;
            return Solid{makeSolid(d)};
          },
          py::arg("radius"), py::arg("dimension") = 3, "A disc or a ball about the origin.")
      .def_static(
          "box",
          [](const Array &size) {
            cprox_solid_description d = described(CPROX_SOLID_BOX);
            d.dimension = spread(size, "size", d.size);
            return Solid{makeSolid(d)};
          },
          py::arg("size"), "A rectangle (two edge lengths [m]) or a box (three) about the origin.")
      .def_static(
          "ellipsoid",
          [](const Array &semi_axes) {
            cprox_solid_description d = described(CPROX_SOLID_ELLIPSOID);
            d.dimension = spread(semi_axes, "semi_axes", d.semi_axes);
            return Solid{makeSolid(d)};
          },
          py::arg("semi_axes"), "An ellipse (two semi-axes [m]) or an ellipsoid (three) about the origin.")
      .def_static(
          "cylinder",
          [](double height, double radius) {
            cprox_solid_description d = described(CPROX_SOLID_CYLINDER);
            d.height = height, d.radius = radius;
            return Solid{makeSolid(d)};
          },
          py::arg("height"), py::arg("radius"), "A cylinder along z about the origin.")
      .def_static(
          "capsule",
          [](double height, double radius, int dimension) {
            cprox_solid_description d = described(CPROX_SOLID_CAPSULE, dimension);
            d.height = height, d.radius = radius;
            return Solid{makeSolid(d)};
          },
          py::arg("height"), py::arg("radius"), py::arg("dimension") = 3,
          "A capsule about the origin, along z, in the plane along x.")
      .def_static("polygon", &polygonOf, py::arg("corners"),
                  "A simple polygon in the plane, convex or not: corners (n, 2) [m], counter-clockwise.")
      .def_static(
          "mesh", &meshOf, py::arg("vertices"), py::arg("triangles"),
          "The inside of a closed mesh, convex or not: vertices (n, 3) [m], triangles (m, 3) of indices from 0, "
          "counter-clockwise from outside.")
      .def_static("grid", &gridOf, py::arg("occupied"), py::arg("lowest"), py::arg("cell"),
                  "The true cells of an array by (x, y, z), in the plane by (x, y). lowest: the corner of the first "
                  "cell [m], cell: edge length [m].")
      .def_static("union", &unionOf, py::arg("parts"), py::arg("poses"), "The union of solids, each at a pose (4, 4).")
      .def_static("of", &solidOf, py::arg("shape"), py::arg("dimension") = 3,
                  "A convex Shape by its tangents in 48 directions, which contain it (32 in the plane, of its shadow).")
      .def_property_readonly("dimension", [](const Solid &s) { return cprox_solid_get_info(s.solid.get()).dimension; })
      .def_property_readonly("measure", [](const Solid &s) { return cprox_solid_get_info(s.solid.get()).measure; })
      .def_property_readonly("radius", [](const Solid &s) { return cprox_solid_get_info(s.solid.get()).radius; });

  py::class_<Gap>(
      module, "FourierGap",
      "A smooth measure of how much two solids overlap, for poses of both (Lysenko 2011).\n\n"
      "samples: odd, 3 to 1025 an axis, 33 if neither it nor delta [m] is given; delta: the largest clearance "
      "that may\nstill be called a collision. mode: 'certified': clear is a proof; 'signal': a penalty; "
      "'tuned': finer, no proof.\nA gap that needs more than memory_limit bytes is a ValueError with the "
      "bytes. Control-C ends the making.")
      .def(py::init([](const Solid &a, const Solid &b, Count samples, double delta, const std::string &mode,
                       double period, std::size_t memory_limit) {
             Gap gap{gapOf(a, b, samples, delta, mode, period, memory_limit), {}};
             gap.info = cprox_gap_get_info(gap.gap.get());
             return gap;
           }),
           py::arg("a"), py::arg("b"), py::arg("samples") = 0, py::arg("delta") = 0.0, py::arg("mode") = "certified",
           py::arg("period") = 0.0, py::arg("memory_limit") = std::size_t{256} << 20)
      .def(
          "evaluate", &evaluateAt, py::arg("pose_b"), py::arg("pose_a") = py::none(),
          "A dict: verdict ('clear', 'far': proven; 'collide': they may overlap; 'undecided'), value (V/t; signal: c), "
          "error, metres\n(the value in metres, the larger the freer), clearance, terms, status, and gradient (6,) of "
          "value by b's position and\nby its turn about its origin, axes of the world.")
      .def("test", &testAt, py::arg("pose_b"), py::arg("pose_a") = py::none(),
           "The verdict alone, by bounds per direction first: the same dict without gradient.")
      .def("evaluate_many", &evaluateMany, py::arg("poses_b"), py::arg("pose_a") = py::none(),
           "Values (n,) and gradients (n, 6) of poses (n, 4, 4) of b.")
      .def_property_readonly("samples", [](const Gap &g) { return g.info.samples; })
      .def_property_readonly("period", [](const Gap &g) { return g.info.period; })
      .def_property_readonly(
          "over_reach", [](const Gap &g) { return g.info.over_reach; },
          "[m] Solids farther apart are never called colliding; inf where that is unknown.")
      .def_property_readonly("guaranteed", [](const Gap &g) { return g.info.guaranteed; })
      .def_property_readonly(
          "length", [](const Gap &g) { return g.info.length; },
          "[m] length * -log(value), of the signal length * value, has a slope near 1 at contact.")
      .def_property_readonly(
          "touching_least", [](const Gap &g) { return g.info.touching_least; },
          "Signal: below it the interiors overlap; -inf where that is unknown.")
      .def_property_readonly(
          "touching_most", [](const Gap &g) { return g.info.touching_most; },
          "Signal: above it the solids do not meet.")
      .def_property_readonly("bytes", [](const Gap &g) { return g.info.bytes; })
      .def_property_readonly("terms", [](const Gap &g) { return g.info.terms; });
}

} // namespace curve_proximity::python
