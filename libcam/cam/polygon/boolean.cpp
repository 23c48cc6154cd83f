// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/polygon/boolean.h"

#include "cam/polygon/clipper_detail.h"

namespace cam::polygon {

namespace {

using ClipperLib::ClipType;
using ClipperLib::PolyFillType;
using ClipperLib::PolyType;

Paths combine(const Paths& a, const Paths& b, ClipType type) {
    ClipperLib::Clipper clipper;
    clipper.AddPaths(detail::to_clipper(a), PolyType::ptSubject, true);
    clipper.AddPaths(detail::to_clipper(b), PolyType::ptClip, true);
    ClipperLib::Paths out;
    clipper.Execute(type, out, PolyFillType::pftNonZero, PolyFillType::pftNonZero);
    return detail::from_clipper(out);
}

Paths clip_lines(const Paths& lines, const Paths& region, ClipType type) {
    ClipperLib::Clipper clipper;
    clipper.AddPaths(detail::to_clipper(lines), PolyType::ptSubject, false);
    clipper.AddPaths(detail::to_clipper(region), PolyType::ptClip, true);
    ClipperLib::PolyTree tree;
    clipper.Execute(type, tree, PolyFillType::pftNonZero, PolyFillType::pftNonZero);
    ClipperLib::Paths out;
    ClipperLib::OpenPathsFromPolyTree(tree, out);
    return detail::from_clipper(out);
}

}  // namespace

Paths region_of(const Paths& loops) {
    ClipperLib::Clipper clipper;
    clipper.AddPaths(detail::to_clipper(loops), PolyType::ptSubject, true);
    ClipperLib::Paths out;
    clipper.Execute(ClipType::ctUnion, out, PolyFillType::pftPositive, PolyFillType::pftPositive);
    return detail::from_clipper(out);
}

Paths unite(const Paths& a, const Paths& b) {
    if (a.empty() || b.empty()) {
        return a.empty() ? b : a;
    }
    return combine(a, b, ClipType::ctUnion);
}

Paths intersect(const Paths& a, const Paths& b) {
    if (!touches(bounds(a), bounds(b))) {
        return {};
    }
    return combine(a, b, ClipType::ctIntersection);
}

Paths subtract(const Paths& a, const Paths& b) {
    if (!touches(bounds(a), bounds(b))) {
        return a;
    }
    return combine(a, b, ClipType::ctDifference);
}

Paths lines_inside(const Paths& lines, const Paths& region) {
    return clip_lines(lines, region, ClipType::ctIntersection);
}

Paths lines_outside(const Paths& lines, const Paths& region) {
    return clip_lines(lines, region, ClipType::ctDifference);
}

}  // namespace cam::polygon
