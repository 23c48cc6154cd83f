// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/protocol/mailbox.h"
#include "cam/sim/plc.h"
#include "tests/support/jobs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace tests {

/// A master and a virtual PLC joined without a port, a thread or a clock: what gets lost, comes
/// late or comes twice is decided here.
struct MailboxBench {
    enum class Fate { Arrives, LostBefore, LostAfter, Stale, Damaged };

    cam::protocol::JobLines job;
    cam::sim::Plc plc;
    cam::protocol::Mailbox master;
    cam::protocol::Instant now{std::chrono::seconds(1)};
    std::function<Fate()> fate = [] { return Fate::Arrives; };
    std::vector<cam::protocol::Event> events;
    std::string stale;  ///< an older answer
    long exchanges = 0;
    std::mt19937_64 random{1};
    std::vector<std::string> executed;

    MailboxBench(cam::protocol::JobLines lines, cam::sim::PlcOptions plc_options,
                 cam::protocol::MailboxOptions options)
        : job(std::move(lines)), plc(plc_options), master(job, options) {
        plc.on_executed = [this](std::string_view text) { executed.emplace_back(text); };
    }

    static unsigned word(const std::string& bytes, std::size_t at) {
        return static_cast<unsigned char>(bytes.at(at)) * 256U +
               static_cast<unsigned char>(bytes.at(at + 1));
    }

    /// The machine's answer, as a protocol data unit.
    std::string served(const std::string& pdu) {
        const unsigned function = static_cast<unsigned char>(pdu.at(0));
        const auto refused = [&](int code) {
            return std::string{static_cast<char>(function + 128), static_cast<char>(code)};
        };
        if (function == 23 && !plc.options().combined) {
            return refused(1);
        }
        if (function == 16 || function == 23) {
            std::vector<std::uint16_t> values;
            for (std::size_t at = function == 16 ? 6 : 10; at + 1 < pdu.size(); at += 2) {
                values.push_back(static_cast<std::uint16_t>(word(pdu, at)));
            }
            if (const int code = plc.write(word(pdu, function == 16 ? 1 : 5), values)) {
                return refused(code);
            }
            if (function == 16) {
                return pdu.substr(0, 5);
            }
        }
        std::vector<std::uint16_t> read;
        if (const int code = plc.read(word(pdu, 1), word(pdu, 3), read)) {
            return refused(code);
        }
        std::string answer{static_cast<char>(function), static_cast<char>(2 * read.size())};
        for (const std::uint16_t value : read) {
            answer += {static_cast<char>(value >> 8), static_cast<char>(value & 255)};
        }
        return answer;
    }

    void carry(const std::string& request) {
        ++exchanges;
        const char tag = request.at(2);
        const Fate what = fate();
        std::string answer{'\0', '\1'};
        if (what != Fate::LostBefore) {
            std::string pdu = request.substr(3);
            constexpr unsigned kSlotArea = 64;
            if (what == Fate::Damaged && pdu[0] == 23 && word(pdu, 5) >= kSlotArea) {
                // As when a bit falls over where no frame's sum sees it.
                pdu[10 + random() % (pdu.size() - 10)] ^= static_cast<char>(1U << random() % 8);
            }
            const std::string fresh = served(pdu);
            if (what == Fate::Stale && stale.size() == fresh.size() && stale[0] == fresh[0]) {
                answer = stale;
            } else if (what != Fate::LostAfter) {
                answer = fresh;
            }
            stale = fresh;
        }
        plc.scan(now);
        now += std::chrono::milliseconds(1);
        std::string bytes{static_cast<char>((answer.size() + 1) >> 8),
                          static_cast<char>((answer.size() + 1) & 255), tag};
        master.receive(bytes + answer, now);
    }

    /// One turn. False: nothing can happen any more.
    bool step() {
        cam::protocol::Output out = master.take_output();
        for (const cam::protocol::Event& event : out.events) {
            events.push_back(event);
            if (event.kind == cam::protocol::Event::Kind::Ready) {
                master.run(static_cast<std::size_t>(event.line), now);
            }
        }
        if (!out.bytes.empty()) {
            EXPECT_EQ(out.bytes.size(), 2 + word(out.bytes, 0)) << "one request at a time";
            carry(out.bytes);
            return true;
        }
        if (!out.events.empty()) {
            return true;
        }
        const auto deadline = master.deadline();
        if (!deadline) {
            return false;
        }
        // Motion and watchdog go on while the master sleeps.
        do {
            now = std::min(std::max(*deadline, now), now + std::chrono::milliseconds(20));
            plc.scan(now);
        } while (now < *deadline);
        master.tick(now);
        return true;
    }

    void run(long most = 10'000'000) {
        while (most-- > 0 && step()) {
        }
        EXPECT_GT(most, 0) << "never ends";
    }

    bool until(const std::function<bool()>& done, long most = 1'000'000) {
        while (most-- > 0 && !done()) {
            if (!step()) {
                return done();
            }
        }
        return most > 0;
    }

    [[nodiscard]] bool said(cam::protocol::Event::Kind kind, const std::string& code = {}) const {
        return std::any_of(events.begin(), events.end(), [&](const cam::protocol::Event& one) {
            return one.kind == kind && one.code == code;
        });
    }
};

}  // namespace tests
