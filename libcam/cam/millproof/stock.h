// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/millproof/program_path.h"

#include <vector>

namespace cam::millproof {

/// The stock as a map of heights that tools lower.
class Stock {
  public:
    Stock(const MillJob& job, double cell_mm);

    /// Runs the steps in order; faults: rapids, shanks and holders in the stock, tools in clamps.
    void run(const std::vector<Step>& steps, std::vector<Fault>& faults);

    /// Pieces that nothing holds any more, when the border alone holds the stock.
    void look_for_loose_pieces(std::vector<Fault>& faults) const;

    [[nodiscard]] long rapid_hits() const { return rapid_hits_; }

    [[nodiscard]] StockMap take() && { return std::move(map_); }

  private:
    struct Cutter {
        std::vector<float> lift;  ///< of the cutting surface, over the square of the distance
        double scale = 0;
        double radius = 0;
    };

    /// The line of the last fault of each kind: each line is blamed once.
    struct Told {
        long rapid = 0;
        long shaft = 0;
        long clamp = 0;
    };

    void run_step(const Step& step, Told& told, std::vector<Fault>& faults);
    void look_at_body(const Step& step, const Eigen::Vector3d& at, Told& told,
                      std::vector<Fault>& faults);
    template <class Visit>
    void around(const Eigen::Vector3d& at, double radius, Visit visit);
    void cut(const Cutter& cutter, const Eigen::Vector3d& at, long line);
    [[nodiscard]] bool touches(const Cutter& cutter, const Eigen::Vector3d& at);
    [[nodiscard]] bool shaft_touches(const tool::Tool& tool, const Eigen::Vector3d& at);
    [[nodiscard]] bool in_clamp(const tool::Tool& tool, const Eigen::Vector3d& at) const;

    const MillJob& job_;
    StockMap map_;
    std::vector<Cutter> cutters_;
    long rapid_hits_ = 0;
};

}  // namespace cam::millproof
