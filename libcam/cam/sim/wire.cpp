// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/wire.h"

#include <algorithm>

namespace cam::sim {

namespace {

constexpr Time::rep kBitsPerByte = 10;
constexpr Time::rep kNanosecondsPerSecond = 1'000'000'000;

}  // namespace

Wire::Wire(Faults faults, long baud)
    : faults_(std::move(faults)), baud_(baud), state_(faults_.seed * 0x2545F4914F6CDD1DULL + 1) {
    std::sort(faults_.reset_at.begin(), faults_.reset_at.end());
}

/// xorshift64* (Vigna 2014).
std::uint64_t Wire::random() {
    state_ ^= state_ >> 12U;
    state_ ^= state_ << 25U;
    state_ ^= state_ >> 27U;
    return state_ * 0x2545F4914F6CDD1DULL;
}

bool Wire::chance(double rate) {
    return rate > 0 && static_cast<double>(random() >> 11U) * 0x1.0p-53 < rate;
}

void Wire::disturb(std::string& line, double flip_line, double flip_byte, double drop_byte) {
    const auto flip = [&](std::size_t at) {
        const auto mask = static_cast<unsigned>(1 + random() % 255);
        line[at] = static_cast<char>(static_cast<unsigned char>(line[at]) ^ mask);
        ++flipped_bytes_;
    };
    const long before = flipped_bytes_;
    if (!line.empty() && chance(flip_line)) {
        flip(random() % line.size());
    }
    for (std::size_t i = 0; flip_byte > 0 && i < line.size(); ++i) {
        if (chance(flip_byte)) {
            flip(i);
        }
    }
    for (std::size_t i = 0; drop_byte > 0 && i < line.size(); ++i) {
        if (chance(drop_byte)) {
            line.erase(i--, 1);
        }
    }
    flipped_lines_ += flipped_bytes_ > before ? 1 : 0;
}

void Wire::put(Direction& direction, std::string bytes, Time now, Time delay) {
    if (bytes.empty()) {
        return;
    }
    Time at = std::max(now + delay, direction.busy_until);
    if (baud_ <= 0) {
        direction.busy_until = at;
        direction.pieces.emplace_back(at, std::move(bytes));
        return;
    }
    for (const char byte : bytes) {
        at += Time(kBitsPerByte * kNanosecondsPerSecond / baud_);
        direction.pieces.emplace_back(at, std::string(1, byte));
    }
    direction.busy_until = at;
}

void Wire::from_host(std::string_view bytes, Time now) {
    while (!bytes.empty()) {
        const std::size_t end = std::min(bytes.find('\n'), bytes.size() - 1) + 1;
        std::string line(bytes.substr(0, end));
        host_lines_ += line.back() == '\n' && line.size() > 1 ? 1 : 0;
        disturb(line, faults_.flip_line_out, faults_.flip_byte_out, faults_.drop_byte_out);
        put(out_, std::move(line), now);
        bytes.remove_prefix(end);
    }
}

void Wire::from_board(std::string_view bytes, Time now) {
    while (!bytes.empty()) {
        const std::size_t end = std::min(bytes.find('\n'), bytes.size() - 1) + 1;
        std::string line(bytes.substr(0, end));
        bytes.remove_prefix(end);
        const bool is_ack = line.starts_with("ok");
        if (is_ack && chance(faults_.drop_ack)) {
            ++lost_acks_;
            continue;
        }
        const bool twice = is_ack && chance(faults_.double_ack);
        const Time delay = is_ack && chance(faults_.delay_ack) ? faults_.delay : Time{};
        const std::string whole = line;
        disturb(line, faults_.flip_line_in, faults_.flip_byte_in, faults_.drop_byte_in);
        put(in_, std::move(line), now, delay);
        if (twice) {
            put(in_, whole, now);
        }
    }
}

std::string Wire::taken(Direction& direction, Time now) {
    std::string out;
    while (!direction.pieces.empty() && direction.pieces.front().first <= now) {
        out += direction.pieces.front().second;
        direction.pieces.pop_front();
    }
    return out;
}

std::optional<Time> Wire::next() const {
    std::optional<Time> soonest;
    for (const Direction* direction : {&out_, &in_}) {
        if (!direction->pieces.empty()) {
            const Time at = direction->pieces.front().first;
            soonest = std::min(soonest.value_or(at), at);
        }
    }
    return soonest;
}

void Wire::cut() {
    out_.pieces.clear();
    in_.pieces.clear();
}

bool Wire::unplug_due() {
    if (faults_.unplug_every <= 0 || host_lines_ < unplugged_at_ + faults_.unplug_every) {
        return false;
    }
    unplugged_at_ = host_lines_;
    return true;
}

bool Wire::reset_due() {
    if (resets_ >= faults_.reset_at.size() || host_lines_ < faults_.reset_at[resets_]) {
        return false;
    }
    ++resets_;
    return true;
}

}  // namespace cam::sim
