// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/post/gcode_writer.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace cam::post {

namespace {

double scale_of(int decimals) {
    double scale = 1;
    for (int i = 0; i < decimals; ++i) {
        scale *= 10;
    }
    return scale;
}

std::int64_t on_grid(double value, int decimals) {
    return std::llround(value * scale_of(decimals));
}

}  // namespace

GcodeWriter::GcodeWriter(profile::Dialect dialect) : dialect_(std::move(dialect)) {}

void GcodeWriter::raw(std::string_view text) {
    text_ += text;
    if (!text_.empty() && text_.back() != '\n') {
        text_ += '\n';
    }
}

void GcodeWriter::comment(std::string_view text) {
    text_ += dialect_.comment;
    text_ += text;
    text_ += '\n';
}

void GcodeWriter::forget() {
    at_ = {};
    feed_.reset();
}

void GcodeWriter::append_grid(std::int64_t grid, int decimals) {
    if (grid < 0) {
        text_ += '-';
        grid = -grid;
    }
    std::array<char, 24> digits{};
    const char* end = std::to_chars(digits.data(), digits.data() + digits.size(), grid).ptr;
    const auto count = static_cast<int>(end - digits.data());
    int fraction = decimals;
    while (fraction > 0 &&
           (decimals - fraction >= count ||
            digits.at(static_cast<std::size_t>(count - 1 - (decimals - fraction))) == '0')) {
        --fraction;
    }
    const int whole = count - decimals;
    if (whole > 0) {
        text_.append(digits.data(), static_cast<std::size_t>(whole));
    } else {
        text_ += '0';
    }
    if (fraction > 0) {
        text_ += '.';
        text_.append(static_cast<std::size_t>(std::max(0, -whole)), '0');
        const int first = std::max(0, whole);
        text_.append(digits.data() + first,
                     static_cast<std::size_t>(count - (decimals - fraction) - first));
    }
}

std::int64_t GcodeWriter::total_e_grid() const { return on_grid(total_e_mm_, dialect_.e_decimals); }

bool GcodeWriter::word(Axis axis, double value_mm) {
    const std::int64_t grid = on_grid(value_mm, dialect_.xyz_decimals);
    std::optional<std::int64_t>& now = at_.at(axis);
    if (now == grid) {
        return false;
    }
    now = grid;
    text_ += ' ';
    text_ += "XYZ"[axis];
    append_grid(grid, dialect_.xyz_decimals);
    return true;
}

bool GcodeWriter::filament_word() {
    const std::int64_t total = total_e_grid();
    if (total == written_e_) {
        return false;
    }
    text_ += " E";
    append_grid(dialect_.relative_e ? total - written_e_ : total - zero_e_, dialect_.e_decimals);
    written_e_ = total;
    return true;
}

void GcodeWriter::end(double speed_mm_per_s, std::size_t undo_to, bool moved) {
    if (!moved) {
        text_.resize(undo_to);
        return;
    }
    const std::int64_t feed = on_grid(speed_mm_per_s * 60, dialect_.feed_decimals);
    if (feed_ != feed) {
        feed_ = feed;
        text_ += " F";
        append_grid(feed, dialect_.feed_decimals);
    }
    text_ += '\n';
}

void GcodeWriter::move_xy(const Eigen::Vector2d& to, double filament_mm, double speed_mm_per_s) {
    const std::size_t before = text_.size();
    text_ += "G1";
    bool moved = word(X, to.x());
    moved = word(Y, to.y()) || moved;
    total_e_mm_ += filament_mm;
    // A move too short for the grid leaves its filament to the next one, rather than feeding it at
    // a standstill.
    if (moved && filament_mm != 0) {
        filament_word();
    }
    end(speed_mm_per_s, before, moved);
}

void GcodeWriter::move_z(double z_mm, double speed_mm_per_s) {
    const std::size_t before = text_.size();
    text_ += "G1";
    end(speed_mm_per_s, before, word(Z, z_mm));
}

void GcodeWriter::feed_filament(double filament_mm, double speed_mm_per_s) {
    const std::size_t before = text_.size();
    text_ += "G1";
    total_e_mm_ += filament_mm;
    end(speed_mm_per_s, before, filament_word());
}

}  // namespace cam::post
