// SPDX-License-Identifier: GPL-3.0-or-later
// Figures of a session on this computer: how soon a stop is on the wire, how full a slow line is
// kept. They are printed, not judged: a loaded computer is no fault. HEW_FIGURES says how many
// times as much of it is to be done.
#include "tests/support/streaming.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <mutex>

namespace {

using namespace std::chrono_literals;
using cam::protocol::Phase;
using cam::protocol::Wish;
using cam::stream::Session;
using Clock = std::chrono::steady_clock;

std::size_t times() {
    const char* text = std::getenv("HEW_FIGURES");
    return text == nullptr ? 1 : static_cast<std::size_t>(std::max(1L, std::atol(text)));
}

double milliseconds(Clock::duration time) {
    return std::chrono::duration<double, std::milli>(time).count();
}

/// When bytes passed.
struct Watch {
    std::mutex mutex;
    char awaited = '!';
    std::optional<Clock::time_point> awaited_left;
    Clock::time_point last_read;
    Clock::time_point read_before;  ///< the last read before that

    std::optional<Clock::time_point> left() {
        const std::scoped_lock lock(mutex);
        return awaited_left;
    }
};

class WatchedChannel final : public cam::transport::ByteChannel {
  public:
    WatchedChannel(std::unique_ptr<ByteChannel> channel, Watch& watch)
        : channel_(std::move(channel)), watch_(watch) {}

    [[nodiscard]] int descriptor() const override { return channel_->descriptor(); }

    [[nodiscard]] decomp::Result<std::size_t> read(char* bytes, std::size_t size) override {
        auto got = channel_->read(bytes, size);
        const std::scoped_lock lock(watch_.mutex);
        watch_.last_read = Clock::now();
        return got;
    }

    [[nodiscard]] decomp::Result<std::size_t> write(std::string_view bytes) override {
        auto sent = channel_->write(bytes);
        const std::scoped_lock lock(watch_.mutex);
        if (sent && !watch_.awaited_left &&
            bytes.substr(0, *sent).find(watch_.awaited) != std::string_view::npos) {
            watch_.awaited_left = Clock::now();
            watch_.read_before = watch_.last_read;
        }
        return sent;
    }

    void discard_output() override { channel_->discard_output(); }

    [[nodiscard]] std::string_view kind() const override { return channel_->kind(); }

  private:
    std::unique_ptr<ByteChannel> channel_;
    Watch& watch_;
};

Session::Open watched(const cam::sim::VirtualMachine& machine, Watch& watch) {
    return [&]() -> decomp::Result<std::unique_ptr<cam::transport::ByteChannel>> {
        auto channel = cam::transport::open_channel(machine.port(), {});
        if (!channel) {
            return decomp::fail(channel.error());
        }
        return std::make_unique<WatchedChannel>(std::move(*channel), watch);
    };
}

void print(const char* what, std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto at = [&](double fraction) {
        return values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
    };
    std::cout << what << ": " << values.size() << " times; ms: median " << at(0.5) << ", 99 % "
              << at(0.99) << ", 99.9 % " << at(0.999) << ", worst " << values.back() << "\n";
}

std::unique_ptr<cam::sim::VirtualMachine> mill(cam::sim::GrblBoard*& board, bool instant,
                                               const cam::sim::Faults& faults = {}, long baud = 0) {
    cam::sim::BoardOptions options;
    options.instant = instant;
    auto own = std::make_unique<cam::sim::GrblBoard>(options);
    board = own.get();
    return std::make_unique<cam::sim::VirtualMachine>(
        std::move(own), cam::sim::VirtualMachine::Options{baud, faults, {}, true});
}

/// A feed hold takes the way of a stop: past everything that waits.
TEST(Figures, FromTheKeyToTheWire) {
    std::vector<double> taken;
    cam::sim::GrblBoard* board = nullptr;
    const auto machine = mill(board, false);
    ASSERT_TRUE(machine->start());
    cam::protocol::JobLines job;
    for (int i = 0; i < 2000; ++i) {
        job.add("G1X" + std::to_string(i % 2 * 20) + "F100", i + 1);
    }
    cam::protocol::Grbl conversation(job, tests::quick_link());
    Watch watch;
    Session session(conversation, watched(*machine, watch), {});
    std::thread carrier([&] { (void)session.run(); });
    const auto wait_for = [&](bool moving) {
        for (bool now = !moving; now != moving;) {
            std::this_thread::sleep_for(2ms);
            machine->visit(
                [&](cam::sim::Board&, cam::sim::Wire&, cam::sim::Time) { now = board->moving(); });
        }
    };
    for (std::size_t i = 0; i < 20 * times(); ++i) {
        wait_for(true);
        {
            const std::scoped_lock lock(watch.mutex);
            watch.awaited_left.reset();
        }
        const auto asked = Clock::now();
        session.post(Wish::Pause);
        while (!watch.left()) {
            std::this_thread::sleep_for(100us);
        }
        taken.push_back(milliseconds(*watch.left() - asked));
        wait_for(false);
        session.post(Wish::Resume);
    }
    session.post(Wish::Stop);
    carrier.join();
    print("from the operator's wish to the wire", taken);
}

/// From the answer that cannot be to the feed hold on the wire; the board holds when it reads it.
TEST(Figures, FromADisturbedAnswerToTheFeedHold) {
    std::vector<double> taken;
    std::size_t undetected = 0;
    for (std::size_t i = 0; i < 10 * times(); ++i) {
        cam::sim::GrblBoard* board = nullptr;
        cam::sim::Faults faults;
        faults.flip_line_in = 0.05;
        faults.flip_line_out = 0.05;
        faults.seed = i + 1;
        const auto machine = mill(board, true, faults);
        ASSERT_TRUE(machine->start());
        const cam::protocol::JobLines job = tests::job_of(400, tests::mill_line);
        cam::protocol::Grbl conversation(job, tests::quick_link());
        Watch watch;
        Session session(conversation, watched(*machine, watch), {});
        const auto outcome = session.run();
        ASSERT_TRUE(outcome);
        if (watch.awaited_left) {
            taken.push_back(milliseconds(*watch.awaited_left - watch.read_before));
        } else {
            ++undetected;
        }
    }
    std::cout << undetected << " jobs ended before the feed could be held\n";
    ASSERT_FALSE(taken.empty());
    print("from the read of a disturbed answer to the hold on the wire", taken);
}

double seconds_for(Session& session) {
    const auto before = Clock::now();
    const auto outcome = session.run();
    EXPECT_TRUE(outcome && outcome->phase == Phase::Finished);
    return std::chrono::duration<double>(Clock::now() - before).count();
}

TEST(Figures, GrblKeepsASlowLineFull) {
    cam::sim::GrblBoard* board = nullptr;
    const auto machine = mill(board, true, {}, 115200);
    ASSERT_TRUE(machine->start());
    const cam::protocol::JobLines job = tests::job_of(1000 * times(), tests::mill_line);
    cam::protocol::Grbl conversation(job, tests::quick_link());
    Session session(conversation, tests::opener(*machine), {});
    const double taken = seconds_for(session);
    std::cout << "Grbl at 115200 baud: "
              << static_cast<double>(job.wire_bytes()) * 10 / 115200 / taken
              << " of the line rate, " << static_cast<double>(job.size()) / taken << " lines/s\n";
}

TEST(Figures, MarlinBesideTheBoundOfItsRoundTrip) {
    cam::sim::BoardOptions options;
    options.instant = true;
    cam::sim::VirtualMachine machine(std::make_unique<cam::sim::MarlinBoard>(options),
                                     {115200, {}, {}, true});
    ASSERT_TRUE(machine.start());
    const cam::protocol::JobLines job = tests::job_of(500 * times(), tests::move_line);
    cam::protocol::Marlin conversation(job, tests::quick_link());
    Session session(conversation, tests::opener(machine), {});
    const double taken = seconds_for(session);
    // Every line with number and sum, and "ok" before the next.
    double bytes = 0;
    for (std::size_t i = 0; i < job.size(); ++i) {
        bytes += static_cast<double>(
            cam::protocol::numbered_line(10001 + static_cast<long>(i), job.text(i)).size() + 3);
    }
    std::cout << "Marlin at 115200 baud, one line in flight: "
              << static_cast<double>(job.size()) / taken << " lines/s, "
              << bytes * 10 / 115200 / taken << " of the bound "
              << static_cast<double>(job.size()) / (bytes * 10 / 115200) << "\n";
}

}  // namespace
