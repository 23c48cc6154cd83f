// SPDX-License-Identifier: GPL-3.0-or-later
// Many lines with every fault at once, and figures: lines a second, memory, undetected errors
// beside what an eight-bit exclusive or predicts. HEW_SOAK_LINES says how many.
#include "tests/support/streaming.h"
#include "tests/support/temp_dir.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>

namespace {

using namespace std::chrono_literals;
using cam::protocol::Phase;
using cam::sim::Faults;
using cam::stream::Session;
using tests::Executed;

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kKeepsFreedMemory = true;
#elif defined(__has_feature)
constexpr bool kKeepsFreedMemory = __has_feature(address_sanitizer);
#else
constexpr bool kKeepsFreedMemory = false;
#endif

std::size_t lines_to_stream() {
    const char* text = std::getenv("HEW_SOAK_LINES");
    return text == nullptr ? 5000 : static_cast<std::size_t>(std::atol(text));
}

/// Resident memory now, MB.
double memory_mb() {
    std::ifstream in("/proc/self/statm");
    long pages = 0;
    long resident = 0;
    in >> pages >> resident;
    return static_cast<double>(resident) * 4096 / 1e6;
}

struct Soak {
    Executed executed;
    cam::stream::Outcome outcome;
    long flipped_lines = 0;
    long lost_acks = 0;
    double least_mb = 1e9;
    double most_mb = 0;

    void stream(const Faults& faults, std::size_t lines) {
        const tests::TempDir folder;
        cam::sim::BoardOptions board_options;
        board_options.instant = true;
        auto board = std::make_unique<cam::sim::MarlinBoard>(board_options);
        executed.wanted = tests::move_line;
        board->on_executed = [this](std::string_view text) { executed.take(text); };
        cam::sim::VirtualMachine::Options options;
        options.faults = faults;
        options.link = folder / "port";
        cam::sim::VirtualMachine machine(std::move(board), options);
        ASSERT_TRUE(machine.start());
        // As every prepared job ends. A board takes a line without its N for one without a number:
        // that it lacks the line is told by the next one, which the last line would not have.
        cam::protocol::JobLines job = tests::job_of(lines, tests::move_line);
        job.add("M114", 0);
        cam::protocol::LinkOptions link = tests::quick_link();
        link.silence = 4ms;
        link.max_resend_fraction = 1;
        cam::protocol::Marlin conversation(job, link);
        Session::Options session_options;
        session_options.told_every = 20ms;
        std::unique_ptr<Session> session;
        session_options.tell = [&](const cam::stream::Notice& notice) {
            using cam::protocol::Event;
            // The operator's yes after a reconnection, and after ten refusals of one line.
            if (notice.kind == cam::stream::Notice::Kind::Event &&
                (notice.event.kind == Event::Kind::Asked ||
                 notice.event.kind == Event::Kind::Paused)) {
                session->post(cam::protocol::Wish::Resume);
            }
            if (notice.progress.acked > lines / 10) {
                least_mb = std::min(least_mb, memory_mb());
                most_mb = std::max(most_mb, memory_mb());
            }
        };
        auto writer = cam::journal::Writer::create(folder / "journal", {1000ms, 64, [&] {
                                                                            if (session) {
                                                                                session->wake();
                                                                            }
                                                                        }});
        ASSERT_TRUE(writer);
        session_options.journal = writer->get();
        session = std::make_unique<Session>(conversation, tests::opener(machine), session_options);
        const auto ended = session->run();
        writer->reset();
        machine.visit([&](cam::sim::Board&, cam::sim::Wire& wire, cam::sim::Time) {
            flipped_lines = wire.flipped_lines();
            lost_acks = wire.lost_acks();
        });
        machine.stop();
        ASSERT_TRUE(ended) << ended.error().text();
        outcome = *ended;
        std::cout << lines << " lines in " << outcome.seconds
                  << " s = " << static_cast<double>(lines) / outcome.seconds << " lines/s; flipped "
                  << flipped_lines << ", answers lost " << lost_acks << ", sent again "
                  << outcome.progress.resent << ", answers asked for "
                  << outcome.progress.lost_answers << "; executed " << executed.count
                  << ", changed " << executed.changed << ", added " << executed.added
                  << ", left out " << executed.lost << "; memory " << least_mb << " .. " << most_mb
                  << " MB\n";
    }
};

TEST(Soak, WithoutFaultsMemoryStaysFlat) {
    Soak soak;
    soak.stream({}, lines_to_stream());
    EXPECT_EQ(soak.outcome.phase, Phase::Finished) << soak.outcome.text;
    EXPECT_EQ(soak.executed.count, lines_to_stream());
    EXPECT_EQ(soak.executed.changed, 0U);
    // The address sanitizer keeps what was given back.
    if (soak.most_mb > 0 && !kKeepsFreedMemory) {
        EXPECT_LT(soak.most_mb - soak.least_mb, 2.0);
    }
}

TEST(Soak, EveryFaultAtOnceLosesNothing) {
    Faults faults;
    faults.flip_line_out = 0.01;
    faults.flip_line_in = 0.01;
    faults.drop_ack = 0.01;
    faults.double_ack = 0.001;
    faults.delay_ack = 0.001;
    faults.delay = 10ms;
    faults.unplug_every = 10000;
    faults.unplugged = 10ms;
    Soak soak;
    soak.stream(faults, lines_to_stream());
    EXPECT_EQ(soak.outcome.phase, Phase::Finished) << soak.outcome.text;
    EXPECT_EQ(soak.executed.count, lines_to_stream());
    EXPECT_EQ(soak.executed.changed, 0U) << soak.executed.first_difference;
    EXPECT_EQ(soak.executed.added, 0U) << soak.executed.first_difference;
    EXPECT_EQ(soak.executed.lost, 0U) << soak.executed.first_difference;
}

/// Of lines with two or more changed bytes one in 255 has the right sum all the same.
TEST(Soak, UndetectedErrorsAreAsManyAsEightBitsLetThrough) {
    Faults faults;
    faults.flip_byte_out = 0.01;
    const std::size_t lines = std::max<std::size_t>(lines_to_stream() / 10, 2000);
    Soak soak;
    soak.stream(faults, lines);
    EXPECT_EQ(soak.outcome.phase, Phase::Finished) << soak.outcome.text;
    double length = 0;
    for (std::size_t i = 0; i < 1000; ++i) {
        length += static_cast<double>(tests::move_line(i).size()) / 1000;
    }
    // The number and its letter are compared besides: only the command itself can be wrong.
    const double none = std::pow(0.99, length);
    const double one = length * 0.01 * std::pow(0.99, length - 1);
    const double attempts =
        static_cast<double>(lines + static_cast<std::size_t>(soak.outcome.progress.resent));
    const double predicted = attempts * (1 - none - one) / 255;
    // A changed letter makes a command that the board does not know: it is left out.
    const std::size_t undetected = soak.executed.changed + soak.executed.added + soak.executed.lost;
    std::cout << "undetected " << undetected << ", predicted about " << predicted << "\n";
    EXPECT_EQ(soak.executed.count, lines);
    EXPECT_LT(static_cast<double>(undetected), 3 * predicted + 10);
}

}  // namespace
