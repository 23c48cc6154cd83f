// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace cam::protocol {

/// Cuts a stream of bytes into lines at LF and CR; empty lines are dropped. A line longer than
/// kLongest is cut there and marked, so that no sender can fill the memory.
class LineSplitter {
  public:
    static constexpr std::size_t kLongest = 4096;

    /// Takes bytes up to and with the next end of line off `bytes`. True: line() is complete; it is
    /// valid until the next call.
    [[nodiscard]] bool next(std::string_view& bytes);

    [[nodiscard]] std::string_view line() const { return line_; }

    /// The line is the beginning of one that was too long.
    [[nodiscard]] bool cut() const { return cut_; }

    void clear();

  private:
    std::string line_;
    bool done_ = false;
    bool cut_ = false;
    bool skipping_ = false;
};

}  // namespace cam::protocol
