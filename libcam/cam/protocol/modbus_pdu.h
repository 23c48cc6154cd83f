// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Modbus requests and their answers as bytes, without any framing of RTU or TCP: two bytes length
/// of what follows, high byte first, one byte tag, then the protocol data unit. Whoever carries a
/// request out answers with its tag; a function code 0 says that there is no answer, the byte after
/// it why.
namespace cam::protocol {

using Registers = std::vector<std::uint16_t>;

/// Registers that lie together.
struct RegisterSpan {
    std::uint16_t address = 0;
    std::uint16_t count = 0;
};

inline constexpr std::size_t kMostReadRegisters = 125;
inline constexpr std::size_t kMostWriteRegisters = 121;  ///< with function 23; 123 with 16

/// Why a request has no answer. Whether it was carried out is then unknown.
enum class NoAnswer : std::uint8_t { Timeout = 1, Garbled = 2, LinkLost = 3 };

struct ModbusAnswer {
    std::uint8_t tag = 0;
    std::uint8_t exception = 0;         ///< of the other side; 0: none
    std::optional<NoAnswer> no_answer;  ///< with neither, `registers` is what was read
    Registers registers;
};

/// Function 3 or 4. @param function  3 or 4
[[nodiscard]] std::string read_request(std::uint8_t tag, std::uint8_t function,
                                       const RegisterSpan& span);

/// Function 16.
[[nodiscard]] std::string write_request(std::uint8_t tag, std::uint16_t address,
                                        const Registers& values);

/// Function 23: writes, then reads.
[[nodiscard]] std::string exchange_request(std::uint8_t tag, std::uint16_t address,
                                           const Registers& values, std::uint16_t read_address,
                                           std::uint16_t read_count);

/// Cuts answers out of bytes in pieces of any size. What is no answer counts as Garbled: nothing
/// that comes from outside can make it grow beyond one answer.
class AnswerReader {
  public:
    void add(std::string_view bytes);

    /// The next whole answer.
    [[nodiscard]] std::optional<ModbusAnswer> next();

  private:
    std::string bytes_;
    std::size_t begin_ = 0;
};

}  // namespace cam::protocol
