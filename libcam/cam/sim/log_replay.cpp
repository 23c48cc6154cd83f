// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/log_replay.h"

#include <cstdlib>
#include <sstream>

namespace cam::sim {

namespace {

/// "\n", "\r", "\\", "\xff" and plain text.
std::string unescaped(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\\' || i + 1 == text.size()) {
            out += text[i];
            continue;
        }
        const char kind = text[++i];
        if (kind == 'n') {
            out += '\n';
        } else if (kind == 'r') {
            out += '\r';
        } else if (kind == 'x' && i + 2 < text.size()) {
            out += static_cast<char>(
                std::strtol(std::string(text.substr(i + 1, 2)).c_str(), nullptr, 16));
            i += 2;
        } else {
            out += kind;
        }
    }
    return out;
}

}  // namespace

tl::expected<std::unique_ptr<LogReplay>, std::string> LogReplay::read(std::string_view log) {
    std::unique_ptr<LogReplay> replay(new LogReplay);
    std::istringstream lines{std::string(log)};
    std::string line;
    long long last = 0;
    for (int number = 1; std::getline(lines, line); ++number) {
        if (line.empty() || line[0] == '#') {
            continue;
        }
        char* end = nullptr;
        const long long microseconds = std::strtoll(line.c_str(), &end, 10);
        const std::string rest = end;
        if (end == line.c_str() || rest.size() < 3 || (rest[1] != '>' && rest[1] != '<')) {
            return tl::make_unexpected("line " + std::to_string(number) +
                                       " is none of a raw log: MICROSECONDS > or < TEXT");
        }
        const std::string text = unescaped(std::string_view(rest).substr(3));
        if (rest[1] == '>') {
            replay->host_ += text;
        } else {
            replay->answers_.push_back(
                {replay->host_.size(), std::chrono::microseconds(microseconds - last), text});
        }
        last = microseconds;
    }
    return replay;
}

void LogReplay::reset(Time now) {
    at_ = heard_ = 0;
    differs_at_ = std::string::npos;
    last_ = now;
}

void LogReplay::receive(std::string_view bytes, Time now) {
    for (const char byte : bytes) {
        const bool same = heard_ < host_.size() && host_[heard_] == byte;
        if (!same && differs_at_ == std::string::npos) {
            differs_at_ = heard_;
        }
        ++heard_;
        last_ = now;
    }
}

void LogReplay::advance(Time now) {
    while (at_ < answers_.size() && heard_ >= answers_[at_].after_bytes &&
           now >= last_ + answers_[at_].wait) {
        out_ += answers_[at_].text;
        ++at_;
        last_ = now;
    }
}

std::optional<Time> LogReplay::next() const {
    if (at_ >= answers_.size() || heard_ < answers_[at_].after_bytes) {
        return std::nullopt;
    }
    return last_ + answers_[at_].wait;
}

std::string LogReplay::take_output() {
    std::string out;
    out.swap(out_);
    return out;
}

}  // namespace cam::sim
