// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/verify/verify.h"
#include "tests/support/shapes.h"

#include <cstdio>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

/// A printer of solid boxes that knows nothing of the project's slicer: concentric loops whose
/// volume fills the box.
namespace tests {

struct BoxPrint {
    double half_mm = 10;
    int loops = 25;
    int layers = 20;
    double height_mm = 0.2;
    double speed_mm_per_s = 40;
    bool relative_e = false;
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    /// Called before and after the loops of each layer, to seed faults; may change the state of the
    /// print.
    std::function<void(struct BoxWriter&, int layer)> before;
    std::function<void(struct BoxWriter&, int layer)> after;
};

struct BoxWriter {
    std::string text;
    long line = 0;
    double e = 0;
    double flow = 1;   ///< scales what is extruded
    double speed = 1;  ///< scales the feed
    bool dry = false;  ///< moves without extruding
    bool relative_e = false;
    Eigen::Vector2d shift = Eigen::Vector2d::Zero();
    Eigen::Vector2d at = Eigen::Vector2d::Zero();

    void put(const std::string& words) {
        text += words + "\n";
        ++line;
    }

    template <class... Args>
    void put_numbers(const char* format, Args... args) {
        char buffer[200];
        std::snprintf(buffer, sizeof buffer, format, args...);
        put(buffer);
    }

    void travel(const Eigen::Vector2d& to) {
        at = to + shift;
        put_numbers("G1 X%.3f Y%.3f F7200", at.x(), at.y());
    }

    /// A bead to `to` that fills spacing x height.
    void bead(const Eigen::Vector2d& to, double spacing, double height, double feed_mm_per_s) {
        const Eigen::Vector2d end = to + shift;
        const double volume = (end - at).norm() * spacing * height * flow;
        at = end;
        if (dry) {
            put_numbers("G1 X%.3f Y%.3f F%.0f", at.x(), at.y(), feed_mm_per_s * 60 * speed);
            return;
        }
        const double filament = volume / (std::numbers::pi / 4 * 1.75 * 1.75);
        e += filament;
        put_numbers("G1 X%.3f Y%.3f E%.5f F%.0f", at.x(), at.y(), relative_e ? filament : e,
                    feed_mm_per_s * 60 * speed);
    }

    void square(const Eigen::Vector2d& centre, double half, double spacing, double height,
                double feed) {
        travel(centre + Eigen::Vector2d(-half, -half));
        bead(centre + Eigen::Vector2d(half, -half), spacing, height, feed);
        bead(centre + Eigen::Vector2d(half, half), spacing, height, feed);
        bead(centre + Eigen::Vector2d(-half, half), spacing, height, feed);
        bead(centre + Eigen::Vector2d(-half, -half), spacing, height, feed);
    }
};

struct PrintedBox {
    std::string text;
    std::vector<long> layer_lines;  ///< first line of each layer, and one past the last
};

inline PrintedBox print_box(const BoxPrint& print) {
    BoxWriter out;
    out.relative_e = print.relative_e;
    PrintedBox box;
    for (const char* words :
         {"G21", "G90", "M140 S60", "M104 S215", "M190 S60", "M109 S215", "G28"}) {
        out.put(words);
    }
    out.put(print.relative_e ? "M83" : "M82");
    out.put("G92 E0");
    for (int layer = 0; layer < print.layers; ++layer) {
        box.layer_lines.push_back(out.line + 1);
        out.put_numbers("G1 Z%.3f F600", (layer + 1) * print.height_mm);
        if (print.before) {
            print.before(out, layer);
        }
        const double spacing = print.half_mm / print.loops;
        for (int k = 0; k < print.loops; ++k) {
            out.put(k == 0 ? ";TYPE:outer-wall" : ";TYPE:solid-infill");
            out.square(print.centre, print.half_mm - (k + 0.5) * spacing, spacing, print.height_mm,
                       print.speed_mm_per_s);
        }
        if (print.after) {
            print.after(out, layer);
        }
    }
    box.layer_lines.push_back(out.line + 1);
    for (const char* words : {"M104 S0", "M140 S0", "M84"}) {
        out.put(words);
    }
    box.text = out.text;
    return box;
}

inline cam::verify::PlacedPart box_part(const BoxPrint& print) {
    const Eigen::Vector3d low(print.centre.x() - print.half_mm, print.centre.y() - print.half_mm,
                              0);
    const Eigen::Vector3d high(print.centre.x() + print.half_mm, print.centre.y() + print.half_mm,
                               print.layers * print.height_mm);
    return {"P01", box(low, high)};
}

inline cam::profile::FdmSetup proof_setup() {
    cam::profile::FdmSetup setup;
    setup.machine.name = "test-printer";
    setup.machine.chamber.min_mm = {-113.5, -74, 0};
    setup.machine.chamber.max_mm = {113.5, 74, 150};
    setup.machine.nozzle.max_flow_mm3_per_s = 11;
    setup.machine.motion.max_speed_mm_per_s = {300, 300, 20, 100};
    setup.material.name = "pla";
    setup.dialect.name = "marlin";
    return setup;
}

}  // namespace tests
