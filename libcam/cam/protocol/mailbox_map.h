// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/protocol/modbus_pdu.h"
#include "decomp/base/result.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// The registers of the G-code mailbox, version 1; docs/modbus-mailbox.md is its document.
namespace cam::protocol {

/// Named registers: 32-bit ones take two.
enum class Reg {
    Magic,
    Version,
    Slots,
    SlotRegs,
    Payloads,
    Caps,
    BootId,  // identity
    State,
    Error,
    NonceEcho,
    JobEcho,
    Accepted,
    Executed,
    ErrorLine,
    FreeLines,
    BufferedMs,
    Doubled,
    X,
    Y,
    Z,
    A,
    B,
    C,
    Feed,
    Rpm,
    Tool,
    Override,
    Inputs,
    TagEcho,  // status
    Tag,
    Command,
    Nonce,
    Job,
    Start,
    Total,
    JobCrc,
    Watchdog,
    WishedOverride,  // control
    SlotArea,
    Count
};

enum class PlcState { Init, Idle, Run, Hold, Alarm, EmergencyStop, ToolChange, Done };
enum class PlcCommand { None, Start, Hold, Resume, StopAfterBlock, Abort, ClearAlarm, ToolChanged };

inline constexpr std::uint16_t kMailboxMagic = 0x4742;
inline constexpr std::uint16_t kMailboxVersion = 1;
inline constexpr std::size_t kSlotHead = 8;  ///< registers of a slot ahead of its text
inline constexpr std::uint16_t kErrorRestarted = 7;

/// Where the registers of one machine lie and how they are spoken to.
struct MailboxMap {
    std::array<std::uint16_t, static_cast<std::size_t>(Reg::Count)> address{};
    bool low_word_first = false;  ///< of 32-bit values
    bool low_byte_first = false;  ///< of text: the first character in the low byte
    bool combined = true;         ///< function 23 where the machine has it; else 16, then 3 or 4
    std::uint8_t read_function = 3;

    [[nodiscard]] std::uint16_t at(Reg reg) const {
        return address.at(static_cast<std::size_t>(reg));
    }

    /// Version 1 as it stands in the document.
    [[nodiscard]] static MailboxMap version_1();
};

/// @param moved  "NAME=ADDRESS" for each register that lies elsewhere, names as in the document
/// @error protocol.bad_map  an unknown name, or blocks that one transaction cannot reach
[[nodiscard]] decomp::Result<MailboxMap> read_mailbox_map(const std::vector<std::string>& moved);

/// Registers from..to in one transaction.
[[nodiscard]] RegisterSpan identity_span(const MailboxMap& map);
[[nodiscard]] RegisterSpan status_span(const MailboxMap& map);
/// Job to Watchdog.
[[nodiscard]] RegisterSpan job_span(const MailboxMap& map);

struct PlcIdentity {
    std::uint16_t magic = 0;
    std::uint16_t version = 0;
    std::uint16_t slots = 0;
    std::uint16_t slot_regs = 0;
    std::uint16_t payloads = 0;
    std::uint16_t caps = 0;
    std::uint32_t boot_id = 0;
};

struct PlcStatus {
    PlcState state = PlcState::Init;
    std::uint16_t error = 0;
    std::uint16_t nonce = 0;
    std::uint32_t job = 0;
    std::uint32_t accepted = 0;
    std::uint32_t executed = 0;
    std::uint32_t error_line = 0;
    std::uint16_t free_lines = 0;
    std::uint16_t buffered_ms = 0;
    std::uint16_t doubled = 0;
    std::array<double, 6> position_mm{};
    double feed_override = 1;
    std::uint16_t inputs = 0;
    std::uint16_t tag = 0;
};

/// Both take what was read at their span. @return nothing when it is too short or the state is none
[[nodiscard]] std::optional<PlcIdentity> read_identity(const MailboxMap& map, const Registers& in);
[[nodiscard]] std::optional<PlcStatus> read_status(const MailboxMap& map, const Registers& in);

/// A 32-bit value into two registers at `values[index]`.
void put_long(const MailboxMap& map, Registers& values, std::size_t index, std::uint32_t value);

/// The registers of one slot: head, CRC-32 over the rest of the head and the text, text.
/// @param lines  joined, each with its line feed
[[nodiscard]] Registers slot_registers(const MailboxMap& map, std::uint16_t tag, std::uint32_t job,
                                       std::uint32_t first, std::uint8_t count,
                                       std::string_view lines);

/// ISO-HDLC: reflected polynomial EDB88320. O(length).
[[nodiscard]] std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0);

/// What an error number of the machine means.
[[nodiscard]] std::string plc_error_text(std::uint16_t error);

}  // namespace cam::protocol
