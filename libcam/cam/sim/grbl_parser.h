// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/sim/planner.h"

#include <array>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace cam::sim {

/// What one line asks of the machine.
struct GrblBlock {
    enum class Kind { Nothing, Move, Dwell, Pause, End };

    Kind kind = Kind::Nothing;
    Point target{};             ///< machine coordinates, mm and degrees
    std::vector<Point> chords;  ///< of an arc, up to its end; empty: straight
    double mm_per_s = 0;        ///< 0: as fast as it goes
    double seconds = 0;
    bool drain = false;  ///< waits for all motion before it
};

/// The modal state of Grbl 1.1's interpreter, and its checks.
class GrblParser {
  public:
    explicit GrblParser(int axes) : axes_(axes) {}

    /// Reads a line without spaces and comments, in capitals. Nothing changes when it is refused.
    /// @param from    machine position where the line begins
    /// @param offset  of the work coordinates
    /// @return 0, or Grbl's number of the error
    [[nodiscard]] int read(std::string_view line, const Point& from,
                           const std::array<Point, 6>& offsets, GrblBlock& block);

    /// As after a reset.
    void clear();

    [[nodiscard]] int coordinate_system() const { return modal_.coordinates; }

    /// "[GC:G0 G54 …]"
    [[nodiscard]] std::string text() const;

  private:
    struct Modal {
        int motion = 0;  ///< 0 1 2 3, 80: none
        int plane = 17;
        int units = 21;
        int distance = 90;
        int feed_mode = 94;
        int coordinates = 0;  ///< 0: G54
        int spindle = 5;
        bool mist = false;
        bool flood = false;
        double feed = 0;  ///< mm/min
        double speed = 0;
        int tool = 0;
    };

    struct Words;

    /// What a line says besides its modes.
    struct Orders {
        std::set<int> groups;  ///< modal groups that have been set
        bool dwell = false;
        bool machine_coordinates = false;
        bool motion = false;
        bool offset = false;
    };

    [[nodiscard]] static int read_words(std::string_view line, Words& words);
    [[nodiscard]] static int take_g(int tenths, Modal& modal, Orders& orders);
    [[nodiscard]] static int take_m(int code, Modal& modal, GrblBlock& block);
    [[nodiscard]] int take_values(const Words& words, Modal& modal, bool& axis_words) const;
    [[nodiscard]] int act(const Words& words, const Point& from,
                          const std::array<Point, 6>& offsets, const Orders& orders, Modal& modal,
                          GrblBlock& block) const;
    [[nodiscard]] int motion(const Words& words, const Point& from, const Point& offset,
                             const Modal& modal, GrblBlock& block) const;
    [[nodiscard]] static int arc(const Words& words, const Point& from, const Modal& modal,
                                 GrblBlock& block);

    int axes_;
    Modal modal_;
};

}  // namespace cam::sim
