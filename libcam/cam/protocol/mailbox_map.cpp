// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/protocol/mailbox_map.h"

#include <algorithm>
#include <charconv>

namespace cam::protocol {

namespace {

struct Row {
    Reg reg;
    std::string_view name;
    std::uint16_t address;
    std::uint16_t count;
};

constexpr std::array kRows = {
    Row{Reg::Magic, "magic", 0, 1},
    Row{Reg::Version, "version", 1, 1},
    Row{Reg::Slots, "slots", 2, 1},
    Row{Reg::SlotRegs, "slot_regs", 3, 1},
    Row{Reg::Payloads, "payloads", 4, 1},
    Row{Reg::Caps, "caps", 5, 1},
    Row{Reg::BootId, "boot_id", 6, 2},
    Row{Reg::State, "state", 16, 1},
    Row{Reg::Error, "error", 17, 1},
    Row{Reg::NonceEcho, "nonce_echo", 18, 1},
    Row{Reg::JobEcho, "job_echo", 19, 2},
    Row{Reg::Accepted, "acc_seq", 21, 2},
    Row{Reg::Executed, "exec_seq", 23, 2},
    Row{Reg::ErrorLine, "err_seq", 25, 2},
    Row{Reg::FreeLines, "free_lines", 27, 1},
    Row{Reg::BufferedMs, "buffered_ms", 28, 1},
    Row{Reg::Doubled, "doubled", 29, 1},
    Row{Reg::X, "x", 30, 2},
    Row{Reg::Y, "y", 32, 2},
    Row{Reg::Z, "z", 34, 2},
    Row{Reg::A, "a", 36, 2},
    Row{Reg::B, "b", 38, 2},
    Row{Reg::C, "c", 40, 2},
    Row{Reg::Feed, "feed", 42, 1},
    Row{Reg::Rpm, "rpm", 43, 1},
    Row{Reg::Tool, "tool", 44, 1},
    Row{Reg::Override, "override", 45, 1},
    Row{Reg::Inputs, "inputs", 46, 1},
    Row{Reg::TagEcho, "tag_echo", 47, 1},
    Row{Reg::Tag, "tag", 48, 1},
    Row{Reg::Command, "command", 49, 1},
    Row{Reg::Nonce, "nonce", 50, 1},
    Row{Reg::Job, "job", 51, 2},
    Row{Reg::Start, "start_seq", 53, 2},
    Row{Reg::Total, "total", 55, 2},
    Row{Reg::JobCrc, "job_crc", 57, 2},
    Row{Reg::Watchdog, "watchdog_ms", 59, 1},
    Row{Reg::WishedOverride, "wished_override", 60, 1},
    Row{Reg::SlotArea, "slot_area", 64, 1},
};
static_assert(kRows.size() == static_cast<std::size_t>(Reg::Count));

RegisterSpan span(const MailboxMap& map, Reg first, Reg last) {
    unsigned low = 0xFFFF;
    unsigned high = 0;
    for (const Row& row : kRows) {
        if (row.reg >= first && row.reg <= last) {
            low = std::min<unsigned>(low, map.at(row.reg));
            high = std::max<unsigned>(high, map.at(row.reg) + row.count - 1U);
        }
    }
    return {static_cast<std::uint16_t>(low), static_cast<std::uint16_t>(high - low + 1)};
}

std::uint16_t word(const Registers& in, const RegisterSpan& span, std::uint16_t address) {
    return in[static_cast<std::size_t>(address - span.address)];
}

std::uint32_t two_words(const MailboxMap& map, const Registers& in, const RegisterSpan& span,
                        Reg reg) {
    const std::uint32_t first = word(in, span, map.at(reg));
    const std::uint32_t second = word(in, span, static_cast<std::uint16_t>(map.at(reg) + 1));
    return map.low_word_first ? second << 16U | first : first << 16U | second;
}

tl::unexpected<decomp::Error> bad(const std::string& what, const std::string& where) {
    return decomp::fail("protocol.bad_map", what, where, "see docs/modbus-mailbox.md");
}

decomp::Status check(const MailboxMap& map) {
    for (const RegisterSpan& one : {identity_span(map), status_span(map), job_span(map)}) {
        if (one.count > kMostReadRegisters) {
            return bad("a block of registers is too wide for one transaction",
                       std::to_string(one.address));
        }
    }
    if (map.at(Reg::Command) != map.at(Reg::Tag) + 1 ||
        map.at(Reg::Nonce) != map.at(Reg::Tag) + 2) {
        return bad("tag, command and nonce must follow each other: they are written at once",
                   "tag");
    }
    constexpr unsigned kOfJob = 9;
    if (job_span(map).count != kOfJob) {
        return bad("job, start_seq, total, job_crc and watchdog_ms must follow each other", "job");
    }
    std::vector<bool> taken(0x10001);
    for (const Row& row : kRows) {
        for (unsigned i = 0; i < row.count; ++i) {
            if (map.at(row.reg) + i > 0xFFFF || taken[map.at(row.reg) + i]) {
                return bad("two registers share an address, or one lies beyond 65535",
                           std::string(row.name));
            }
            taken[map.at(row.reg) + i] = true;
        }
    }
    return {};
}

}  // namespace

MailboxMap MailboxMap::version_1() {
    MailboxMap map;
    for (const Row& row : kRows) {
        map.address.at(static_cast<std::size_t>(row.reg)) = row.address;
    }
    return map;
}

decomp::Result<MailboxMap> read_mailbox_map(const std::vector<std::string>& moved) {
    MailboxMap map = MailboxMap::version_1();
    for (const std::string& text : moved) {
        const std::size_t equals = text.find('=');
        const std::string name = text.substr(0, equals);
        const auto* const row = std::find_if(kRows.begin(), kRows.end(),
                                             [&](const Row& one) { return one.name == name; });
        if (row == kRows.end()) {
            return bad("there is no register '" + name + "'", text);
        }
        std::uint16_t address = 0;
        const char* const end = text.data() + text.size();
        const char* const begin = equals == std::string::npos ? end : text.data() + equals + 1;
        const auto read = std::from_chars(begin, end, address);
        if (read.ec != std::errc{} || read.ptr != end) {
            return bad("an address is a whole number from 0 to 65535", text);
        }
        map.address.at(static_cast<std::size_t>(row->reg)) = address;
    }
    if (const decomp::Status checked = check(map); !checked) {
        return decomp::fail(checked.error());
    }
    return map;
}

RegisterSpan identity_span(const MailboxMap& map) { return span(map, Reg::Magic, Reg::BootId); }

RegisterSpan status_span(const MailboxMap& map) { return span(map, Reg::State, Reg::TagEcho); }

RegisterSpan job_span(const MailboxMap& map) { return span(map, Reg::Job, Reg::Watchdog); }

std::optional<PlcIdentity> read_identity(const MailboxMap& map, const Registers& in) {
    const RegisterSpan span = identity_span(map);
    if (in.size() != span.count) {
        return std::nullopt;
    }
    const auto one = [&](Reg reg) { return word(in, span, map.at(reg)); };
    return PlcIdentity{one(Reg::Magic),
                       one(Reg::Version),
                       one(Reg::Slots),
                       one(Reg::SlotRegs),
                       one(Reg::Payloads),
                       one(Reg::Caps),
                       two_words(map, in, span, Reg::BootId)};
}

std::optional<PlcStatus> read_status(const MailboxMap& map, const Registers& in) {
    const RegisterSpan span = status_span(map);
    if (in.size() != span.count) {
        return std::nullopt;
    }
    const auto one = [&](Reg reg) { return word(in, span, map.at(reg)); };
    const auto two = [&](Reg reg) { return two_words(map, in, span, reg); };
    if (one(Reg::State) > static_cast<std::uint16_t>(PlcState::Done)) {
        return std::nullopt;
    }
    PlcStatus out;
    out.state = static_cast<PlcState>(one(Reg::State));
    out.error = one(Reg::Error);
    out.nonce = one(Reg::NonceEcho);
    out.job = two(Reg::JobEcho);
    out.accepted = two(Reg::Accepted);
    out.executed = two(Reg::Executed);
    out.error_line = two(Reg::ErrorLine);
    out.free_lines = one(Reg::FreeLines);
    out.buffered_ms = one(Reg::BufferedMs);
    out.doubled = one(Reg::Doubled);
    constexpr std::array kAxes = {Reg::X, Reg::Y, Reg::Z, Reg::A, Reg::B, Reg::C};
    for (std::size_t axis = 0; axis < kAxes.size(); ++axis) {
        out.position_mm.at(axis) = static_cast<std::int32_t>(two(kAxes.at(axis))) / 1000.0;
    }
    out.feed_override = one(Reg::Override) / 100.0;
    out.inputs = one(Reg::Inputs);
    out.tag = one(Reg::TagEcho);
    return out;
}

void put_long(const MailboxMap& map, Registers& values, std::size_t index, std::uint32_t value) {
    const auto high = static_cast<std::uint16_t>(value >> 16U);
    const auto low = static_cast<std::uint16_t>(value & 0xFFFFU);
    values[index] = map.low_word_first ? low : high;
    values[index + 1] = map.low_word_first ? high : low;
}

Registers slot_registers(const MailboxMap& map, std::uint16_t tag, std::uint32_t job,
                         std::uint32_t first, std::uint8_t count, std::string_view lines) {
    constexpr std::uint16_t kText = 1;
    Registers out(kSlotHead + (lines.size() + 1) / 2);
    const auto low_job = static_cast<std::uint16_t>(job & 0xFFFFU);
    const auto kind = static_cast<std::uint16_t>(kText << 8U | count);
    const auto length = static_cast<std::uint16_t>(lines.size());
    // The sum is over values, so that word and byte order of the machine do not matter to it.
    std::string summed;
    for (const std::uint16_t value : {low_job, static_cast<std::uint16_t>(first >> 16U),
                                      static_cast<std::uint16_t>(first & 0xFFFFU), kind, length}) {
        summed.push_back(static_cast<char>(value >> 8U));
        summed.push_back(static_cast<char>(value & 0xFFU));
    }
    out[0] = tag;
    out[1] = low_job;
    put_long(map, out, 2, first);
    out[4] = kind;
    out[5] = length;
    put_long(map, out, 6, crc32(lines, crc32(summed)));
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const bool high = (i % 2 == 0) != map.low_byte_first;
        const auto letter = static_cast<unsigned>(static_cast<unsigned char>(lines[i]));
        std::uint16_t& value = out[kSlotHead + i / 2];
        value = static_cast<std::uint16_t>(value | (high ? letter << 8U : letter));
    }
    return out;
}

std::uint32_t crc32(std::string_view bytes, std::uint32_t before) {
    static const std::array<std::uint32_t, 256> kTable = [] {
        std::array<std::uint32_t, 256> table{};
        for (std::uint32_t i = 0; i < table.size(); ++i) {
            std::uint32_t value = i;
            for (int bit = 0; bit < 8; ++bit) {
                value = (value & 1U) != 0 ? 0xEDB88320U ^ value >> 1U : value >> 1U;
            }
            table.at(i) = value;
        }
        return table;
    }();
    std::uint32_t sum = ~before;
    for (const char letter : bytes) {
        sum = kTable.at((sum ^ static_cast<unsigned char>(letter)) & 0xFFU) ^ sum >> 8U;
    }
    return ~sum;
}

std::string plc_error_text(std::uint16_t error) {
    constexpr std::array<std::string_view, 10> kTexts = {
        "no error",
        "a line could not be understood",
        "a line number was left out",
        "a slot arrived damaged",
        "a soft limit would be left",
        "a drive has failed",
        "the master fell silent (watchdog)",
        "the controller has restarted",
        "a limit switch was hit",
        "the machine is not homed",
    };
    return error < kTexts.size() ? std::string(kTexts.at(error))
                                 : "error " + std::to_string(error) + " of the machine's own";
}

}  // namespace cam::protocol
