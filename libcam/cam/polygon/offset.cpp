// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/polygon/offset.h"

#include "cam/polygon/clipper_detail.h"

namespace cam::polygon {

namespace {

constexpr double kMiterLimit = 2.0;

Paths offset_nanometres(const ClipperLib::Paths& paths, double delta, Join join,
                        ClipperLib::EndType end) {
    ClipperLib::ClipperOffset offsetter(kMiterLimit, kArcToleranceMm * 1e6);
    offsetter.AddPaths(
        paths, join == Join::Miter ? ClipperLib::JoinType::jtMiter : ClipperLib::JoinType::jtRound,
        end);
    ClipperLib::Paths out;
    offsetter.Execute(out, delta);
    return detail::from_clipper(out);
}

}  // namespace

Paths offset(const Paths& region, double delta_mm, Join join) {
    const std::int64_t delta = nanometres(delta_mm);
    if (delta == 0 || region.empty()) {
        return region;
    }
    return offset_nanometres(detail::to_clipper(region), static_cast<double>(delta), join,
                             ClipperLib::EndType::etClosedPolygon);
}

Paths opened(const Paths& region, double radius_mm, Join join) {
    return offset(offset(region, -radius_mm, join), radius_mm, join);
}

Paths closed(const Paths& region, double radius_mm, Join join) {
    return offset(offset(region, radius_mm, join), -radius_mm, join);
}

Paths thickened(const Paths& lines, double radius_mm) {
    return offset_nanometres(detail::to_clipper(lines), static_cast<double>(nanometres(radius_mm)),
                             Join::Round, ClipperLib::EndType::etOpenRound);
}

}  // namespace cam::polygon
