// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/verify/gcode_reader.h"
#include "cam/verify/printed_heights.h"
#include "cam/verify/replay.h"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace cam::verify {

inline constexpr std::size_t kTools = 16;

/// One linear axis. The frame is trusted once the printer knows where it is; the value may be
/// unknown after homing.
struct Axis {
    double position = 0;
    double offset = 0;  ///< of G92: position = programmed + offset
    bool known = false;
    bool trusted = true;
};

struct Tool {
    double fed = 0;
    double high_water = 0;  ///< filament beyond it is deposited; below it is retraction made good
    double target = 0;
    bool heated = false;  ///< waited for since the target was raised
};

/// Consecutive moves above the flow limit on one height.
struct Rush {
    long line = 0;
    double z = 0;
    double flow = 0;
    double length = 0;
};

/// The printer as the program drives it: modes, axes, retraction ledger, heaters and printed
/// heights.
class Machine {
  public:
    Machine(const profile::FdmSetup& setup, const Options& options);

    /// Line `number` of the program.
    void execute(const GcodeLine& line, long number);

    /// Everything seen; the machine is spent.
    [[nodiscard]] Replayed finish(long lines);

  private:
    void comment(std::string_view text);
    void command(const GcodeLine& line, const Word& word);
    void g_code(const GcodeLine& line, int code);
    void m_code(const GcodeLine& line, int code);
    void linear(const GcodeLine& line);
    void arc(const GcodeLine& line, bool clockwise);
    void home(const GcodeLine& line, bool trusted_after);
    void set_position(const GcodeLine& line);
    void heat(const GcodeLine& line, bool wait);
    void unknown(const std::string& name);
    void sight(const char* code, std::string text, bool at_layer = true);
    [[nodiscard]] double end_of(const GcodeLine& line, std::size_t axis, bool& given);
    [[nodiscard]] double filament_of(const GcodeLine& line);
    void go(const std::array<double, 3>& to, const std::array<bool, 3>& given, double filament);
    void check_bounds(const std::array<bool, 3>& given);
    void deposit(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double filament,
                 bool was_known);
    void check_flow(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double volume);
    [[nodiscard]] bool near_chamber(const Eigen::Vector3d& point) const;
    void check_heat();
    void end_rush();

    const profile::FdmSetup& setup_;
    const Options& options_;
    PrintedHeights heights_;
    double filament_area_;
    double intended_;  ///< share of the fed filament that beads are meant to hold
    double flow_limit_;
    bool sailfish_;

    std::array<Axis, 3> axes_;
    std::array<Tool, kTools> tools_;
    std::size_t tool_ = 0;
    double e_ = 0;
    double unit_mm_ = 1;
    double feed_mm_per_s_ = 0;
    double feed_scale_ = 1;  ///< of M220
    double flow_scale_ = 1;  ///< of M221
    bool absolute_ = true;
    bool e_absolute_ = true;
    double bed_target_ = 0;
    Role role_ = Role::Part;
    bool outer_wall_ = false;
    bool declared_ = false;  ///< a feature comment has been seen
    bool cold_told_ = false;
    bool bed_ever_ = false;
    long line_ = 0;
    std::string_view text_;
    std::optional<Rush> rush_;
    std::map<std::string, std::pair<long, int>> unknown_;  ///< first line and number of uses
    Replayed out_;
};

/// A figure for a message, whatever its size.
[[nodiscard]] std::string figure(double value, int decimals = 2);

/// The start of a line, fit for a message whatever its bytes.
[[nodiscard]] std::string quoted(std::string_view line);

}  // namespace cam::verify
