// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/plc.h"

#include <algorithm>
#include <cmath>

namespace cam::sim {

namespace {

constexpr std::size_t kRegisters = 2048;
constexpr std::size_t kStatus = 16;
constexpr std::size_t kTag = 48;
constexpr std::size_t kCommand = 49;
constexpr std::size_t kNonce = 50;
constexpr std::size_t kJob = 51;
constexpr std::size_t kStart = 53;
constexpr std::size_t kTotal = 55;
constexpr std::size_t kWatchdog = 59;
constexpr std::size_t kOverride = 60;
constexpr std::size_t kSlotArea = 64;
constexpr std::size_t kHead = 8;
constexpr int kIllegalAddress = 2;
constexpr int kIllegalValue = 3;
constexpr std::uint16_t kBadLine = 1;
constexpr std::uint16_t kGap = 2;
constexpr std::uint16_t kDamaged = 3;
constexpr std::uint16_t kWatchdogError = 6;
constexpr std::uint16_t kRestarted = 7;

/// Bit by bit, as a PLC would that has no table to spare.
std::uint32_t crc_of(const std::string& bytes) {
    std::uint32_t crc = 0xFFFFFFFF;
    for (const char c : bytes) {
        crc ^= static_cast<unsigned char>(c);
        for (int i = 0; i < 8; ++i) {
            crc = (crc & 1U) != 0 ? crc >> 1U ^ 0xEDB88320U : crc >> 1U;
        }
    }
    return crc ^ 0xFFFFFFFF;
}

void add_word(std::string& bytes, std::uint16_t word) {
    bytes += static_cast<char>(word >> 8U);
    bytes += static_cast<char>(word & 0xFFU);
}

}  // namespace

Plc::Plc(PlcOptions options)
    : options_(options),
      regs_(kRegisters),
      planner_(options_.board),
      parser_(static_cast<int>(kAxes)),
      seen_(static_cast<std::size_t>(options.slots)),
      heard_tags_(static_cast<std::size_t>(options.slots)) {
    regs_[kOverride] = 100;
    publish({});
}

std::uint32_t Plc::two(std::size_t address) const {
    return static_cast<std::uint32_t>(regs_[address]) << 16U | regs_[address + 1];
}

void Plc::put_two(std::size_t address, std::uint32_t value) {
    regs_[address] = static_cast<std::uint16_t>(value >> 16U);
    regs_[address + 1] = static_cast<std::uint16_t>(value & 0xFFFFU);
}

int Plc::read(unsigned address, unsigned count, std::vector<std::uint16_t>& out) const {
    if (count == 0 || count > 125) {
        return kIllegalValue;
    }
    if (address + count > regs_.size()) {
        return kIllegalAddress;
    }
    out.assign(regs_.begin() + address, regs_.begin() + address + count);
    return 0;
}

int Plc::write(unsigned address, const std::vector<std::uint16_t>& values) {
    if (values.empty() || values.size() > 123) {
        return kIllegalValue;
    }
    // Identity and status are the machine's own.
    if (address < kTag || address + values.size() > regs_.size()) {
        return kIllegalAddress;
    }
    std::copy(values.begin(), values.end(), regs_.begin() + address);
    return 0;
}

void Plc::scan(Time now) {
    planner_.advance(now);
    finish(now);
    hear(now);
    obey(now);
    if (state_ == kRun || state_ == kHold) {
        take_slots();
    }
    if (state_ == kRun) {
        plan(now);
        finish(now);
        if (executed_ == total_ && queue_.empty() && planned_.empty()) {
            state_ = kDone;
        }
        if (now - heard_ > std::chrono::milliseconds(watchdog_ms_) && state_ == kRun) {
            planner_.hold(now);
            state_ = kHold;
            error_ = kWatchdogError;
        }
    }
    publish(now);
}

/// The newest tag is echoed: it shows that the master lives, and that what it reads is no older
/// than what it wrote. That of register 48 always counts, those of slots when they are newer.
void Plc::hear(Time now) {
    bool heard = false;
    if (regs_[kTag] != heard_tag_) {
        echo_ = heard_tag_ = regs_[kTag];
        heard = true;
    }
    for (std::size_t slot = 0; slot < seen_.size(); ++slot) {
        const std::uint16_t tag =
            regs_[kSlotArea + slot * static_cast<std::size_t>(options_.slot_regs)];
        if (tag == heard_tags_[slot]) {
            continue;
        }
        heard_tags_[slot] = tag;
        heard = true;
        if (static_cast<std::int16_t>(tag - echo_) > 0) {
            echo_ = tag;
        }
    }
    if (heard) {
        heard_ = now;
    }
}

void Plc::obey(Time now) {
    if (regs_[kNonce] == nonce_) {
        return;
    }
    nonce_ = regs_[kNonce];
    switch (regs_[kCommand]) {
        case 1:
            start(now);
            break;
        case 2:
            if (state_ == kRun) {
                planner_.hold(now);
                state_ = kHold;
            }
            break;
        case 3:
            if (state_ == kHold) {
                planner_.release(now);
                stops_after_block_ = false;
                state_ = kRun;
                error_ = 0;
                heard_ = now;
            }
            break;
        case 4:
            stops_after_block_ = state_ == kRun;
            break;
        case 5:
            planner_.drop(now);
            forget();
            if (state_ != kAlarm) {
                state_ = kIdle;
                error_ = 0;
            }
            job_ = 0;
            break;
        case 6:
            if (state_ == kAlarm) {
                state_ = kIdle;
                error_ = 0;
                job_ = 0;
            }
            break;
        default:
            break;
    }
}

void Plc::start(Time now) {
    if (state_ != kIdle && state_ != kDone) {
        return;
    }
    forget();
    parser_.clear();
    job_ = two(kJob);
    accepted_ = executed_ = two(kStart) - 1;
    total_ = two(kTotal);
    watchdog_ms_ = std::max<std::uint16_t>(regs_[kWatchdog], 100);
    error_ = 0;
    doubled_ = 0;
    heard_ = now;
    state_ = kRun;
    // What lies in the slots belongs to an older job.
    for (std::size_t slot = 0; slot < seen_.size(); ++slot) {
        seen_[slot] = regs_[kSlotArea + slot * static_cast<std::size_t>(options_.slot_regs)];
    }
}

void Plc::take_slots() {
    bool waits = false;
    bool gap = false;
    bool progress = true;
    while (progress) {
        progress = waits = gap = false;
        for (std::size_t slot = 0; slot < seen_.size(); ++slot) {
            const Taken taken = take_slot(slot);
            progress = progress || taken == Taken::Once;
            waits = waits || taken == Taken::Waits;
            gap = gap || taken == Taken::Gap;
        }
    }
    if (gap && !waits && error_ == 0) {
        error_ = kGap;
        error_line_ = accepted_ + 1;
    }
}

Plc::Taken Plc::take_slot(std::size_t slot) {
    const std::size_t base = kSlotArea + slot * static_cast<std::size_t>(options_.slot_regs);
    const std::uint16_t tag = regs_[base];
    if (tag == seen_[slot]) {
        return Taken::Nothing;
    }
    const std::uint32_t first = two(base + 2);
    const unsigned count = regs_[base + 4] & 0xFFU;
    const std::size_t length = regs_[base + 5];
    std::string summed;
    std::string text;
    if (length <= 2 * (static_cast<std::size_t>(options_.slot_regs) - kHead)) {
        for (std::size_t i = 1; i <= 5; ++i) {
            add_word(summed, regs_[base + i]);
        }
        for (std::size_t i = 0; i < (length + 1) / 2; ++i) {
            add_word(text, regs_[base + kHead + i]);
        }
        text.resize(length);
    }
    const bool whole = !summed.empty() && crc_of(summed + text) == two(base + 6) &&
                       std::count(text.begin(), text.end(), '\n') == static_cast<long>(count) &&
                       count > 0;
    if (!whole || regs_[base + 1] != (job_ & 0xFFFFU) || regs_[base + 4] >> 8U != 1) {
        ++damaged_;
        error_ = kDamaged;
        error_line_ = accepted_ + 1;
        return Taken::Damaged;
    }
    if (first + count - 1 <= accepted_) {
        ++doubled_;
        seen_[slot] = tag;
        return Taken::Once;
    }
    if (first != accepted_ + 1) {
        return Taken::Gap;
    }
    if (queue_.size() + count > static_cast<std::size_t>(options_.queue_lines)) {
        return Taken::Waits;
    }
    std::size_t begin = 0;
    for (unsigned i = 0; i < count; ++i) {
        const std::size_t end = text.find('\n', begin);
        queue_.push_back({first + i, text.substr(begin, end - begin)});
        begin = end + 1;
    }
    accepted_ += count;
    seen_[slot] = tag;
    if (error_ == kGap || error_ == kDamaged) {
        error_ = 0;
    }
    return Taken::Once;
}

/// Lines go from the queue into motion.
void Plc::plan(Time now) {
    if (stops_after_block_) {
        if (planned_.empty()) {
            state_ = kHold;
        }
        return;
    }
    while (!queue_.empty() && !planner_.full()) {
        GrblBlock block;
        const std::array<Point, 6> offsets{};
        if (parser_.read(queue_.front().text, planner_.target(), offsets, block) != 0) {
            error_line_ = queue_.front().number;
            alarm(kBadLine);
            return;
        }
        if (block.drain && !planner_.empty()) {
            return;
        }
        move(block, now);
        if (options_.board.instant) {
            finish(now);
        }
    }
}

/// The next line becomes one block of the planner, an arc as many as it has chords.
void Plc::move(const GrblBlock& block, Time now) {
    const double speed = (block.mm_per_s > 0 ? block.mm_per_s : options_.board.max_mm_per_s) *
                         regs_[kOverride] / 100.0;
    std::vector<Point> ends = block.chords;
    if (ends.empty()) {
        const bool moves = block.kind == GrblBlock::Kind::Move;
        ends.push_back(moves ? block.target : planner_.target());
    }
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const bool last = i + 1 == ends.size();
        planned_.push_back({queue_.front().number, last ? queue_.front().text : "", last});
        planner_.add(ends[i], speed, block.seconds, now);
    }
    queue_.pop_front();
}

/// A line is done when its last block has left the planner.
void Plc::finish(Time /*now*/) {
    const auto in_motion =
        static_cast<std::size_t>(options_.board.planner_blocks - planner_.free());
    while (planned_.size() > in_motion) {
        if (planned_.front().last) {
            executed_ = planned_.front().number;
            if (on_executed) {
                on_executed(planned_.front().text);
            }
        }
        planned_.pop_front();
    }
}

void Plc::forget() {
    queue_.clear();
    planned_.clear();
    stops_after_block_ = false;
}

void Plc::alarm(std::uint16_t error) {
    state_ = kAlarm;
    error_ = error;
    forget();
}

void Plc::restart(Time now) {
    planner_.drop(now);
    forget();
    ++boot_;
    std::fill(regs_.begin() + kTag, regs_.end(), std::uint16_t{0});
    regs_[kOverride] = 100;
    std::fill(seen_.begin(), seen_.end(), std::uint16_t{0});
    std::fill(heard_tags_.begin(), heard_tags_.end(), std::uint16_t{0});
    heard_tag_ = echo_ = nonce_ = 0;
    const bool keeps = options_.retentive && job_ != 0 && state_ != kDone;
    state_ = keeps ? kAlarm : kIdle;
    error_ = keeps ? kRestarted : std::uint16_t{0};
    if (!keeps) {
        job_ = accepted_ = executed_ = 0;
    }
    publish(now);
}

void Plc::publish(Time now) {
    regs_[0] = 0x4742;
    regs_[1] = 1;
    regs_[2] = static_cast<std::uint16_t>(options_.slots);
    regs_[3] = static_cast<std::uint16_t>(options_.slot_regs);
    regs_[4] = 1;
    regs_[5] = static_cast<std::uint16_t>((options_.retentive ? 1U : 0U) | 2U |
                                          (options_.combined ? 4U : 0U));
    put_two(6, boot_);
    regs_[kStatus] = state_;
    regs_[17] = error_;
    regs_[18] = nonce_;
    put_two(19, job_);
    put_two(21, accepted_);
    put_two(23, executed_);
    put_two(25, error_line_);
    regs_[27] = static_cast<std::uint16_t>(options_.queue_lines - static_cast<int>(queue_.size()));
    regs_[28] = 0;
    regs_[29] = doubled_;
    const Point at = planner_.position(now);
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
        put_two(30 + 2 * axis, static_cast<std::uint32_t>(
                                   static_cast<std::int32_t>(std::lround(1000 * at[axis]))));
    }
    regs_[45] = regs_[kOverride];
    regs_[46] = 4;  // homed
    regs_[47] = echo_;
}

}  // namespace cam::sim
