// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/sim/board.h"

#include <tl/expected.hpp>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace cam::sim {

/// Plays the machine's side of a raw log: an answer is given once the host has sent as much as it
/// had when the answer came, and as long after it as then.
class LogReplay final : public Board {
  public:
    /// @return the board, or which line of the log cannot be read
    [[nodiscard]] static tl::expected<std::unique_ptr<LogReplay>, std::string> read(
        std::string_view log);

    void reset(Time now) override;
    void receive(std::string_view bytes, Time now) override;
    void advance(Time now) override;
    [[nodiscard]] std::optional<Time> next() const override;
    [[nodiscard]] std::string take_output() override;

    [[nodiscard]] std::size_t overflowed() const override { return 0; }

    /// Where the host first said something else than in the log; npos: nowhere.
    [[nodiscard]] std::size_t differs_at() const { return differs_at_; }

    [[nodiscard]] bool done() const { return at_ == answers_.size(); }

  private:
    struct Answer {
        std::size_t after_bytes = 0;  ///< of the host
        Time wait{};                  ///< since the host's last byte, or the answer before
        std::string text;
    };

    LogReplay() = default;

    std::string host_;  ///< all that the host said in the log
    std::vector<Answer> answers_;
    std::size_t at_ = 0;
    std::size_t heard_ = 0;
    std::size_t differs_at_ = std::string::npos;
    Time last_{};
    std::string out_;
};

}  // namespace cam::sim
