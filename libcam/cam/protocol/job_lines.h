// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace cam::protocol {

/// Positions of up to six axes; those that nobody knows are NaN.
inline constexpr std::size_t kMaxAxes = 6;
using AxisValues = std::array<double, kMaxAxes>;

/// How a line travels.
enum class LineKind : std::uint8_t {
    Send,   ///< as fast as the machine takes them
    Alone,  ///< nothing else is on its way while it is: it writes the controller's memory
    Drain,  ///< its answer comes when all motion before it is done; nothing follows until then
    Ask     ///< as Drain, then the operator is asked and must say yes
};

/// What is streamed: one entry for each line that goes over the wire, without its end, free of
/// comments. Texts lie in one block of memory.
class JobLines {
  public:
    /// @param source  1-based line of the program; 0: added by Hew
    void add(std::string_view text, long source, LineKind kind = LineKind::Send);

    /// What the operator is asked at the entry added last, which must be of LineKind::Ask.
    void ask(std::string question);

    /// Where the machine must stand once the entry added last, of LineKind::Drain or Ask, is done:
    /// millimetres and degrees in the active work coordinates.
    void expect(const AxisValues& position);

    [[nodiscard]] std::size_t size() const { return entries_.size(); }

    [[nodiscard]] std::string_view text(std::size_t index) const;

    [[nodiscard]] LineKind kind(std::size_t index) const { return entries_[index].kind; }

    [[nodiscard]] long source(std::size_t index) const { return entries_[index].source; }

    [[nodiscard]] const std::string& question(std::size_t index) const;

    /// Null when nothing is expected there.
    [[nodiscard]] const AxisValues* expected(std::size_t index) const;

    /// Bytes of all lines with their ends.
    [[nodiscard]] std::size_t wire_bytes() const { return text_.size() + entries_.size(); }

  private:
    struct Entry {
        std::uint64_t begin = 0;
        std::uint32_t length = 0;
        std::uint32_t source = 0;
        LineKind kind = LineKind::Send;
    };

    std::string text_;
    std::vector<Entry> entries_;
    std::map<std::size_t, std::string> questions_;
    std::map<std::size_t, AxisValues> expected_;
};

}  // namespace cam::protocol
