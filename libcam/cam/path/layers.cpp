// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/path/layers.h"

#include <numbers>

namespace cam::path {

const char* feature_name(Feature feature) {
    switch (feature) {
        case Feature::OuterWall:
            return "outer-wall";
        case Feature::InnerWall:
            return "inner-wall";
        case Feature::SolidInfill:
            return "solid-infill";
        case Feature::TopSkin:
            return "top-skin";
        case Feature::BottomSkin:
            return "bottom-skin";
        case Feature::SparseInfill:
            return "sparse-infill";
        case Feature::OverhangWall:
            return "overhang-wall";
        case Feature::Bridge:
            return "bridge";
        case Feature::Support:
            return "support";
        case Feature::SupportInterface:
            return "support-interface";
        case Feature::Skirt:
            return "skirt";
        case Feature::Brim:
            return "brim";
        case Feature::Prime:
            return "prime";
    }
    return "unknown";
}

double bead_area_mm2(double width_mm, double height_mm) {
    return (width_mm - height_mm * (1.0 - std::numbers::pi / 4.0)) * height_mm;
}

}  // namespace cam::path
