// SPDX-License-Identifier: GPL-3.0-or-later
// Arbitrary answers of a PLC in the middle of a job: raw bytes, and well-formed ones whose
// registers say anything.
#include "cam/protocol/mailbox.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

namespace {

using namespace cam::protocol;

JobLines forty_lines() {
    JobLines job;
    for (int i = 0; i < 40; ++i) {
        job.add("G1X1", i + 1, i % 9 == 8 ? LineKind::Ask : LineKind::Send);
    }
    return job;
}

/// What remains of the input; zeros at its end.
struct Source {
    std::string_view bytes;

    std::uint8_t next() {
        const std::uint8_t value =
            bytes.empty() ? std::uint8_t{0} : static_cast<std::uint8_t>(bytes.front());
        bytes.remove_prefix(bytes.empty() ? 0 : 1);
        return value;
    }
};

/// An answer of the right shape to this request; some of its registers are the input's.
std::string shaped(const std::string& request, const JobLines& job, Source& source,
                   std::uint32_t number) {
    const auto at = [&](std::size_t i) { return static_cast<std::uint8_t>(request[i]); };
    std::string pdu(1, request[3]);
    if (at(3) == 16) {
        pdu += request.substr(4, 4);
    } else {
        const unsigned address = at(4) << 8U | at(5);
        const unsigned count = at(6) << 8U | at(7);
        Registers values(count);
        if (address == 0 && count >= 8) {
            values = {kMailboxMagic, 1, 3, 40, 1, 6, 0, 9};
            values.resize(count);
        } else if (count == 32) {
            values[0] = 2;
            values[3] = static_cast<std::uint16_t>(number >> 16U);
            values[4] = static_cast<std::uint16_t>(number & 0xFFFFU);
            values[6] = source.next() % (job.size() + 1);
            values[8] = source.next() % (job.size() + 1);
            values[11] = 20;
            // What a write begins with is its tag; 50 is the nonce.
            values[31] = at(3) == 23 && request.size() > 14
                             ? static_cast<std::uint16_t>(at(13) << 8U | at(14))
                             : std::uint16_t{0};
            values[2] = at(3) == 23 && request.size() == 19
                            ? static_cast<std::uint16_t>(at(17) << 8U | at(18))
                            : std::uint16_t{1};
        }
        for (unsigned changes = source.next() % 4; changes > 0 && count > 0; --changes) {
            std::uint16_t& changed = values[source.next() % count];
            const unsigned high = source.next();
            changed = static_cast<std::uint16_t>(high << 8U | source.next());
        }
        pdu.push_back(static_cast<char>(2 * count));
        for (const std::uint16_t value : values) {
            pdu.push_back(static_cast<char>(value >> 8U));
            pdu.push_back(static_cast<char>(value & 0xFFU));
        }
    }
    const std::size_t length = pdu.size() + 1;
    return std::string{static_cast<char>(length >> 8U), static_cast<char>(length & 0xFFU),
                       request[2]} +
           pdu;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const JobLines job = forty_lines();
    Source source{{reinterpret_cast<const char*>(data), size}};
    Mailbox conversation(job, {});
    Instant now{};
    const std::uint8_t kind = source.next();
    conversation.allow(job.size(), now);
    conversation.meet(kind % 5 == 4 ? Meeting::Again : Meeting::Fresh, now);
    while (!source.bytes.empty()) {
        const Output out = conversation.take_output();
        if (out.bytes.size() > 2 + 1 + 254) {
            __builtin_trap();
        }
        const std::uint8_t choice = source.next();
        if (choice % 8 == 7) {
            const std::size_t wanted = source.next();
            const std::size_t length = std::min(wanted, source.bytes.size());
            conversation.receive(source.bytes.substr(0, length), now);
            source.bytes.remove_prefix(length);
        } else if (!out.bytes.empty()) {
            conversation.receive(shaped(out.bytes, job, source, conversation.job_number()), now);
        }
        if (conversation.phase() == Phase::Ready) {
            conversation.run(kind % 5 == 4 ? conversation.progress().acked : 0, now);
        }
        if (choice % 16 == 8) {
            conversation.wish(static_cast<Wish>(source.next() % 7), now);
        }
        if (conversation.phase() == Phase::Asking || conversation.phase() == Phase::Paused) {
            conversation.wish(Wish::Resume, now);
        }
        now += std::chrono::milliseconds(choice);
        if (const auto deadline = conversation.deadline(); deadline && now >= *deadline) {
            conversation.tick(now);
        }
        const Progress progress = conversation.progress();
        if (progress.acked > progress.total || progress.sent > progress.total) {
            __builtin_trap();
        }
    }
    return 0;
}
