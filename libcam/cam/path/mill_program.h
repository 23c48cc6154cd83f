// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/path/mill_feeds.h"
#include "cam/tool/tool.h"
#include "decomp/base/frame.h"
#include "decomp/base/units.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// The neck between planning and machines for milling on three axes: semantic moves of the tool's
/// tip, no dialect, no machine coordinates.
///
/// The frame of a program is that of its set-up: X, Y, Z are the program's own words, the zero is
/// the one that the operator touches off, +Z points to the spindle. All is millimetres.
namespace cam::path {

/// The frame in which a part is clamped for one milling set-up: its zero is the program's zero.
struct MillFrame {};

enum class MillOperation : std::uint8_t {
    Dowels,      ///< holes for the dowels about which the stock is turned over
    Rough,       ///< level by level, leaving an allowance
    RestRough,   ///< the same with a smaller tool where the larger did not fit
    Flats,       ///< level faces to their height
    Waterline,   ///< steep faces, level by level
    Parallel,    ///< shallow faces, line by line
    RestFinish,  ///< what the larger finishing tool left
    Drill,       ///< holes that the part has
    Contour,     ///< the outline, down to tabs or skin
};

/// "dowels", "rough", "rest-rough", "flats", "waterline", "parallel", "rest-finish", "drill",
/// "contour".
[[nodiscard]] std::string_view operation_name(MillOperation operation);

/// To a point without cutting, all axes at their own best speed: the path between is not a line.
/// Rapids go up alone, across alone at a safe height, or down alone.
struct MillRapid {
    Eigen::Vector3d to = Eigen::Vector3d::Zero();
};

/// Along a straight line at a feed.
struct MillCut {
    Eigen::Vector3d to = Eigen::Vector3d::Zero();
    decomp::Speed feed;
};

/// Around a centre in the XY plane, Z changing evenly; less than a whole turn unless it ends where
/// it began, then exactly one.
struct MillArc {
    Eigen::Vector3d to = Eigen::Vector3d::Zero();
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< absolute
    bool clockwise = false;                            ///< seen from +Z
    decomp::Speed feed;
};

/// Stands still, the spindle turning.
struct MillDwell {
    double seconds = 0;
};

/// The operator or the machine takes this tool. The tip is at the safe height or above, the spindle
/// stands still before and after.
struct MillTakeTool {
    int number = 0;  ///< Tool::number of one of the plan's tools
};

/// Starts the spindle clockwise (0: stops it) and waits for its speed.
struct MillSpindle {
    double rpm = 0;
};

enum class Coolant : std::uint8_t { Off, Mist, Flood };

struct MillCoolant {
    Coolant coolant = Coolant::Off;
};

struct MillMove {
    MillOperation operation = MillOperation::Rough;
    std::variant<MillRapid, MillCut, MillArc, MillDwell, MillTakeTool, MillSpindle, MillCoolant>
        what;
};

/// How one set-up's stock is held.
enum class Hold : std::uint8_t {
    Bottom,  ///< glued, taped or by vacuum to what lies below it
    Frame,   ///< its outer border is clamped or screwed down; the part hangs on tabs or skin in it
};

/// One set-up: how the stock lies, and its program. The program starts with the tool anywhere above
/// safe_z and the spindle still, takes a tool before it moves, ends at safe_z with spindle and
/// coolant off. No cut before the spindle turns.
struct MillProgram {
    std::string name;  ///< "top", "bottom": for file names and the sheet
    decomp::Pose<MillFrame, decomp::ModelFrame> from_model;  ///< of part and stock
    Eigen::AlignedBox3d stock;                               ///< as it lies here, uncut
    double safe_z = 0;   ///< rapids across go here; above stock and clamps
    double floor_z = 0;  ///< no tip goes below: what lies under the stock
    Hold hold = Hold::Bottom;
    std::vector<Eigen::AlignedBox3d> keep_outs;  ///< clamps, dowel pins: no tool, no holder in them
    std::vector<MillMove> moves;
};

/// Material that is left on purpose, in the frame of the first set-up.
struct MillKeep {
    enum class Kind : std::uint8_t { Tab, Skin, Frame } kind = Kind::Tab;
    Eigen::AlignedBox3d box;
};

/// A dowel about whose like the stock is turned over, in the frame of the first set-up.
struct MillDowel {
    Eigen::Vector2d at = Eigen::Vector2d::Zero();
    double diameter_mm = 6;
    double bottom_z = 0;
};

/// A part's milling from first to last: set-ups in order, one stock.
struct MillPlan {
    std::vector<tool::Tool> tools;  ///< those that the programs take, by number
    std::vector<MillProgram> programs;
    std::vector<MillKeep> keeps;
    std::vector<MillDowel> dowels;
    std::string flip_axis;    ///< "x" or "y" of the first set-up, "" for one set-up
    double allowance_mm = 0;  ///< that roughing leaves
    double scallop_mm = 0;    ///< that finishing leaves at most, by its stepover
    double tolerance_mm = 0;  ///< of the finishing paths: by how much chords may leave curves
    std::vector<std::string> warnings;  ///< for the sheet, a sentence each
};

}  // namespace cam::path
