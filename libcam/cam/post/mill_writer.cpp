// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/post/mill_writer.h"

#include "decomp/base/number.h"

#include <algorithm>
#include <cmath>

namespace cam::post {

namespace {

constexpr const char* kLetters = "XYZ";
/// Of the unit: a feed this near below a value of the grid is that value.
constexpr double kRounding = 1e-6;

}  // namespace

MillWriter::MillWriter(profile::MillDialect dialect, double rapid_mm_per_min)
    : dialect_(std::move(dialect)),
      rapid_mm_per_min_(rapid_mm_per_min),
      scale_(std::pow(10.0, dialect_.decimals)) {}

void MillWriter::put(const std::string& line) {
    ++lines_;
    if (long_line_ == 0 && line.size() > static_cast<std::size_t>(dialect_.line_limit)) {
        long_line_ = lines_;
    }
    text_ += line + "\n";
}

void MillWriter::raw(std::string_view text) {
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        if (end > 0) {
            put(std::string(text.substr(0, end)));
        }
        text.remove_prefix(std::min(end + 1, text.size()));
    }
}

void MillWriter::comment(std::string_view text) {
    std::string clean;
    for (const char c : text) {
        const bool plain = c >= ' ' && c <= '~' && c != '(' && c != ')' && c != ';';
        clean += plain ? c : ' ';
    }
    const std::size_t room = static_cast<std::size_t>(dialect_.line_limit) -
                             dialect_.comment_open.size() - dialect_.comment_close.size() - 1;
    const std::string open = dialect_.comment_open + (dialect_.comment_close.empty() ? " " : "");
    for (std::size_t at = 0; at < clean.size(); at += room) {
        put(open + clean.substr(at, room) + dialect_.comment_close);
    }
}

void MillWriter::forget() {
    at_.fill(std::nullopt);
    feed_.reset();
}

Eigen::Vector3d MillWriter::position() const {
    Eigen::Vector3d out = Eigen::Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
        out[axis] = static_cast<double>(at_[static_cast<std::size_t>(axis)].value_or(0)) / scale_;
    }
    return out;
}

std::int64_t MillWriter::grid(double value_mm) const { return std::llround(value_mm * scale_); }

std::string MillWriter::printed(std::int64_t on_grid) const {
    return decomp::fixed(static_cast<double>(on_grid) / scale_, dialect_.decimals);
}

bool MillWriter::same_in_print(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    return grid(a.x()) == grid(b.x()) && grid(a.y()) == grid(b.y()) && grid(a.z()) == grid(b.z());
}

/// " X12.500", or nothing when the axis is there already.
std::string MillWriter::word(int axis, double value_mm) {
    std::optional<std::int64_t>& at = at_[static_cast<std::size_t>(axis)];
    const std::int64_t to = grid(value_mm);
    if (at == to) {
        return {};
    }
    at = to;
    return std::string(" ") + kLetters[axis] + printed(to);
}

void MillWriter::feed_word(std::string& line, double mm_per_min) {
    const double scale = std::pow(10.0, dialect_.feed_decimals);
    // Downwards: a clamped feed must not be rounded above its limit.
    const std::int64_t on_grid = std::max<std::int64_t>(
        1, static_cast<std::int64_t>(std::floor(mm_per_min * scale + kRounding)));
    if (feed_ != on_grid) {
        feed_ = on_grid;
        line +=
            " F" + decomp::decimal(static_cast<double>(on_grid) / scale, dialect_.feed_decimals);
    }
}

void MillWriter::rapid(const Eigen::Vector3d& to) {
    const auto move = [&](bool across, bool height) {
        std::string words;
        if (across) {
            words += word(0, to.x());
            words += word(1, to.y());
        }
        if (height) {
            words += word(2, to.z());
        }
        if (!words.empty()) {
            std::string line = "G0" + words;
            if (dialect_.rapid_feed) {
                feed_word(line, rapid_mm_per_min_);
            }
            put(line);
        }
    };
    const bool up = !at_[2] || grid(to.z()) > *at_[2];
    move(!up, up);
    move(up, !up);
}

void MillWriter::line(const Eigen::Vector3d& to, double mm_per_min) {
    std::string words;
    for (int axis = 0; axis < 3; ++axis) {
        words += word(axis, to[axis]);
    }
    if (!words.empty()) {
        std::string line = "G1" + words;
        feed_word(line, mm_per_min);
        put(line);
    }
}

void MillWriter::half_arc(const Eigen::Vector3d& to, const Eigen::Vector2d& centre, bool clockwise,
                          double mm_per_min) {
    const Eigen::Vector3d from = position();
    std::string line = clockwise ? "G2" : "G3";
    // Both ends are written: a missing word would say a whole turn to some controllers.
    at_[0].reset();
    at_[1].reset();
    line += word(0, to.x());
    line += word(1, to.y());
    line += word(2, to.z());
    line += " I" + printed(grid(centre.x() - from.x()));
    line += " J" + printed(grid(centre.y() - from.y()));
    feed_word(line, mm_per_min);
    put(line);
}

}  // namespace cam::post
