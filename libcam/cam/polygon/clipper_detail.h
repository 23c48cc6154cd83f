// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/polygon/polygon.h"

#include <polyclipping/clipper.hpp>

namespace cam::polygon::detail {

inline ClipperLib::Paths to_clipper(const Paths& paths) {
    ClipperLib::Paths out;
    out.reserve(paths.size());
    for (const Path& path : paths) {
        ClipperLib::Path& copy = out.emplace_back();
        copy.reserve(path.size());
        for (const Point& p : path) {
            copy.emplace_back(p.x, p.y);
        }
    }
    return out;
}

inline Paths from_clipper(const ClipperLib::Paths& paths) {
    Paths out;
    out.reserve(paths.size());
    for (const ClipperLib::Path& path : paths) {
        Path& copy = out.emplace_back();
        copy.reserve(path.size());
        for (const ClipperLib::IntPoint& p : path) {
            copy.push_back({p.X, p.Y});
        }
    }
    return out;
}

}  // namespace cam::polygon::detail
