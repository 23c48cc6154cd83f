// SPDX-License-Identifier: GPL-3.0-or-later
// Arbitrary bytes as the answers of a Grbl board in the middle of a job.
#include "cam/protocol/grbl.h"

#include <cstdint>
#include <string_view>

namespace {

cam::protocol::JobLines twenty_lines() {
    cam::protocol::JobLines job;
    for (int i = 0; i < 20; ++i) {
        job.add("G1X1", i + 1,
                i % 7 == 6 ? cam::protocol::LineKind::Ask : cam::protocol::LineKind::Send);
    }
    return job;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace cam::protocol;
    std::string_view bytes(reinterpret_cast<const char*>(data), size);
    (void)read_grbl_reply(bytes);
    static const JobLines job = twenty_lines();
    LinkOptions options;
    options.expects_banner = false;
    options.precheck = size % 2 == 0;
    options.window = size % 3 == 0 ? 4 : 1;
    Grbl conversation(job, options);
    Instant now{};
    conversation.allow(job.size(), now);
    conversation.meet(size % 5 == 0 ? Meeting::Again : Meeting::Fresh, now);
    while (!bytes.empty()) {
        const std::size_t length = 1 + static_cast<unsigned char>(bytes.front()) % 40;
        conversation.receive(bytes.substr(0, length), now);
        bytes.remove_prefix(length < bytes.size() ? length : bytes.size());
        if (conversation.phase() == Phase::Ready) {
            conversation.run(0, now);
        }
        if (conversation.phase() == Phase::Asking || conversation.phase() == Phase::Paused) {
            conversation.wish(Wish::Resume, now);
        }
        now += std::chrono::milliseconds(700);
        if (const auto deadline = conversation.deadline(); deadline && now >= *deadline) {
            conversation.tick(now);
        }
        const Output out = conversation.take_output();
        const Progress progress = conversation.progress();
        if (progress.acked > progress.total || progress.sent > progress.total) {
            __builtin_trap();
        }
    }
    return 0;
}
