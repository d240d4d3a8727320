// SPDX-License-Identifier: BSD-3-Clause
#include "curve_peers.h"

#include <algorithm>
#include <cmath>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <GeomAPI_ProjectPointOnCurve.hxx>
#include <Standard_Failure.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopoDS_Edge.hxx>

namespace {

struct occt_curve {
  Handle(Geom_Curve) curve;
  TopoDS_Edge edge;
};

void *make(const double (*points)[3], size_t n, size_t degree, const double *knots) {
  TColgp_Array1OfPnt poles(1, static_cast<int>(n));
  for (size_t i = 0; i < n; i++) poles(static_cast<int>(i) + 1) = gp_Pnt(points[i][0], points[i][1], points[i][2]);
  auto *made = new occt_curve;
  if (!knots) {
    made->curve = new Geom_BezierCurve(poles);
    made->edge = BRepBuilderAPI_MakeEdge(made->curve);
    return made;
  }
  const int count = static_cast<int>(n + degree + 1);
  TColStd_Array1OfReal values(1, count);
  TColStd_Array1OfInteger times(1, count);
  for (int i = 1; i <= count; i++) {
    values(i) = knots[i - 1];
    times(i) = 1;
  }
  made->curve = new Geom_BSplineCurve(poles, values, times, static_cast<int>(degree));
  made->edge = BRepBuilderAPI_MakeEdge(made->curve, knots[degree], knots[n]);
  return made;
}

double to_point(const void *curve, const double point[3]) try {
  const auto *c = static_cast<const occt_curve *>(curve);
  const gp_Pnt p(point[0], point[1], point[2]);
  const double first = c->curve->FirstParameter(), last = c->curve->LastParameter();
  double least = std::min(p.Distance(c->curve->Value(first)), p.Distance(c->curve->Value(last)));
  const GeomAPI_ProjectPointOnCurve projected(p, c->curve, first, last);
  if (projected.NbPoints() > 0) least = std::min(least, projected.LowerDistance());
  return least;
} catch (const Standard_Failure &) {
  return NAN;
}

double to_curve(const void *a, const void *b) try {
  const BRepExtrema_DistShapeShape found(static_cast<const occt_curve *>(a)->edge,
                                         static_cast<const occt_curve *>(b)->edge);
  return found.IsDone() ? found.Value() : NAN;
} catch (const Standard_Failure &) {
  return NAN;
}

double to_polygon(const void *curve, const double (*vertices)[3], size_t n) try {
  BRepBuilderAPI_MakePolygon outline;
  for (size_t i = 0; i < n; i++) outline.Add(gp_Pnt(vertices[i][0], vertices[i][1], vertices[i][2]));
  outline.Close();
  const BRepBuilderAPI_MakeFace face(outline.Wire(), Standard_True);
  if (!face.IsDone()) return NAN;
  const BRepExtrema_DistShapeShape found(static_cast<const occt_curve *>(curve)->edge, face.Face());
  return found.IsDone() ? found.Value() : NAN;
} catch (const Standard_Failure &) {
  return NAN; /* what is smaller than its tolerance of 1e-7 it does not build */
}

void drop(void *curve) {
  delete static_cast<occt_curve *>(curve);
}

} // namespace

const curve_peer curve_peer_occt = {"OpenCASCADE", make, to_point, to_curve, to_polygon, drop};
