// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/marlin_board.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace cam::sim {

using namespace std::chrono_literals;

namespace {

constexpr std::size_t kCommands = 4;
constexpr std::size_t kLongestLine = 96;

}  // namespace

MarlinBoard::MarlinBoard(const BoardOptions& options) : options_(options), planner_(options_) {}

void MarlinBoard::reset(Time now) {
    buffer_.clear();
    partial_.clear();
    emergency_.clear();
    queue_.clear();
    working_ = in_comment_ = halted_ = heating_ = false;
    wait_ = Wait::None;
    planner_.drop(now);
    planner_.place({});
    last_number_ = 0;
    absolute_ = absolute_e_ = true;
    feed_percent_ = 100;
    report_seconds_ = place_seconds_ = 0;
    nozzle_.target = bed_.target = 0;
    out_ += "start\necho:Marlin 2.0.9\necho: Free Memory: 4242\n";
}

void MarlinBoard::receive(std::string_view bytes, Time now) {
    for (const char byte : bytes) {
        if (options_.emergency_parser) {
            scan_emergency(byte, now);
        }
        if (buffer_.size() + 1 >= options_.receive_bytes) {
            ++overflowed_;
            // What can be read is read between two bytes; a full queue lets the buffer run over.
            advance(now);
            if (buffer_.size() + 1 >= options_.receive_bytes) {
                continue;
            }
            --overflowed_;
        }
        buffer_.push_back(byte);
    }
}

/// Sees bare commands byte by byte as they come in, ahead of everything that waits.
void MarlinBoard::scan_emergency(char byte, Time now) {
    if (byte != '\n' && byte != '\r') {
        if (emergency_.size() < 12) {
            emergency_ += byte;
        }
        return;
    }
    if (emergency_ == "M112") {
        halt();
    } else if (emergency_ == "M108") {
        if (wait_ == Wait::User || heating_) {
            heating_ = false;
            wait_ = Wait::None;
            finish(now);
        }
    } else if (emergency_ == "M410") {
        planner_.drop(now);
    }
    emergency_.clear();
}

void MarlinBoard::halt() {
    halted_ = true;
    queue_.clear();
    working_ = false;
    nozzle_.target = bed_.target = 0;
    planner_.drop(Time{});
    out_ += "Error:Printer halted. kill() called!\n";
}

void MarlinBoard::take_lines(Time now) {
    while (queue_.size() < kCommands && !buffer_.empty()) {
        const char byte = buffer_.front();
        buffer_.pop_front();
        if (byte == '\n' || byte == '\r') {
            in_comment_ = false;
            std::string text;
            text.swap(partial_);
            if (!text.empty()) {
                line(std::move(text), now);
            }
        } else if (byte == ';') {
            in_comment_ = true;
        } else if (!in_comment_ && partial_.size() + 1 < kLongestLine) {
            partial_ += byte;
        }
    }
}

void MarlinBoard::refuse(const char* why) {
    ++refused_;
    out_ += std::string("Error:") + why + ", Last Line: " + std::to_string(last_number_) + "\n";
    buffer_.clear();
    partial_.clear();
    out_ += "Resend: " + std::to_string(last_number_ + 1) + "\nok\n";
}

void MarlinBoard::line(std::string text, Time /*now*/) {
    text.erase(0, text.find_first_not_of(' '));
    // As C strings, which end at the first zero byte.
    text.resize(std::min(text.size(), text.find('\0')));
    long number = -1;
    if (!text.empty() && text[0] == 'N') {
        const std::size_t m110 = text.find("M110");
        std::size_t at = 0;
        if (m110 != std::string::npos) {
            const std::size_t second = text.find('N', 4);
            at = second == std::string::npos ? 0 : second;
        }
        number = std::strtol(text.c_str() + at + 1, nullptr, 10);
        if (number != last_number_ + 1 && m110 == std::string::npos) {
            refuse("Line Number is not Last Line Number+1");
            return;
        }
        const std::size_t star = text.rfind('*');
        if (star == std::string::npos) {
            refuse("No Checksum with line number");
            return;
        }
        unsigned sum = 0;
        for (std::size_t i = 0; i < star; ++i) {
            sum ^= static_cast<unsigned char>(text[i]);
        }
        if (static_cast<long>(sum) != std::strtol(text.c_str() + star + 1, nullptr, 10)) {
            refuse("checksum mismatch");
            return;
        }
        last_number_ = number;
        text.resize(star);
        const std::size_t body = text.find_first_not_of("-0123456789", 1);
        text.erase(0, std::min(body, text.size()));
        text.erase(0, std::min(text.find_first_not_of(' '), text.size()));
    }
    queue_.push_back({std::move(text), number});
}

void MarlinBoard::advance(Time now) {
    warm(now);
    planner_.advance(now);
    bool progress = !halted_;
    while (progress) {
        take_lines(now);
        progress = work(now);
    }
    if (halted_) {
        buffer_.clear();
        return;
    }
    if (report_seconds_ > 0 && now >= next_report_) {
        next_report_ = now + std::chrono::seconds(report_seconds_);
        out_ += " " + temperatures() + "\n";
    }
    if (place_seconds_ > 0 && now >= next_place_) {
        next_place_ = now + std::chrono::seconds(place_seconds_);
        out_ += place_text(now) + "\n";
    }
    if (working_ && now >= next_busy_) {
        next_busy_ = now + 2s;
        out_ += wait_ == Wait::User ? "echo:busy: paused for user\n" : "echo:busy: processing\n";
    }
}

/// True when something was finished or begun.
bool MarlinBoard::work(Time now) {
    if (!working_) {
        if (queue_.empty()) {
            return false;
        }
        current_ = std::move(queue_.front());
        queue_.pop_front();
        working_ = true;
        next_busy_ = now + 2s;
        start(current_.text, now);
        return true;
    }
    switch (wait_) {
        case Wait::None:
        case Wait::User:
            return false;
        case Wait::Slot:
            for (; chord_ < chords_.size(); ++chord_) {
                if (planner_.full()) {
                    return false;
                }
                planner_.add(chords_[chord_], pending_speed_, 0, now);
            }
            break;
        case Wait::Drain:
            if (!planner_.empty()) {
                return false;
            }
            break;
        case Wait::Until:
            if (heating_ ? !(nozzle_.celsius >= nozzle_.target - 0.5 &&
                             bed_.celsius >= bed_.target - 0.5)
                         : now < until_) {
                return false;
            }
            heating_ = false;
            break;
    }
    wait_ = Wait::None;
    finish(now);
    return true;
}

void MarlinBoard::finish(Time now) {
    working_ = false;
    out_ += "ok";
    if (options_.advanced_ok) {
        out_ += (current_.number >= 0 ? " N" + std::to_string(current_.number) : std::string()) +
                " P" + std::to_string(planner_.free()) + " B" +
                std::to_string(kCommands - queue_.size());
    }
    if (current_.text.starts_with("M105")) {
        out_ += " " + temperatures();
    } else if (current_.text.starts_with("M114")) {
        // Marlin prints the position before its answer.
        out_.insert(out_.rfind("ok"), place_text(now) + "\n");
    }
    out_ += "\n";
}

std::optional<Time> MarlinBoard::next() const {
    std::optional<Time> soonest;
    const auto consider = [&](Time when) { soonest = std::min(soonest.value_or(when), when); };
    if (report_seconds_ > 0) {
        consider(next_report_);
    }
    if (place_seconds_ > 0) {
        consider(next_place_);
    }
    if (working_) {
        consider(next_busy_);
        if (wait_ == Wait::Until) {
            consider(warmed_ + 100ms);
        } else if (!planner_.empty()) {
            consider(planner_.first_end());
        }
    }
    return soonest;
}

std::string MarlinBoard::take_output() {
    std::string out;
    out.swap(out_);
    return out;
}

}  // namespace cam::sim
