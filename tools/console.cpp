// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/console.h"

#include <spdlog/logger.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace tools {

namespace {

constexpr int kBarWidth = 28;

spdlog::level::level_enum threshold(const Common& common) {
    if (common.quiet) {
        return spdlog::level::err;
    }
    return common.verbosity > 0 ? spdlog::level::debug : spdlog::level::info;
}

}  // namespace

bool wants_colour(int descriptor) {
    const char* no_color = std::getenv("NO_COLOR");
    return (no_color == nullptr || *no_color == '\0') && ::isatty(descriptor) != 0;
}

Console::Console(const Common& common)
    : quiet_(common.quiet), terminal_(::isatty(STDERR_FILENO) != 0) {
    const auto mode =
        wants_colour(STDERR_FILENO) ? spdlog::color_mode::always : spdlog::color_mode::never;
    logger_ = std::make_shared<spdlog::logger>(
        "hew", std::make_shared<spdlog::sinks::stderr_color_sink_mt>(mode));
    logger_->set_pattern("%^%l%$: %v");
    logger_->set_level(threshold(common));
    logger_->flush_on(spdlog::level::debug);
}

void Console::log(const decomp::LogEvent& event) {
    const std::scoped_lock lock(mutex_);
    const bool redraw = drawn_;
    if (drawn_) {
        std::fputs("\r\x1b[K", stderr);
        drawn_ = false;
    }
    switch (event.level) {
        case decomp::LogLevel::Debug:
            logger_->debug("{}", event.text);
            break;
        case decomp::LogLevel::Info:
            logger_->info("{}", event.text);
            break;
        case decomp::LogLevel::Warning:
            logger_->warn("{}", event.text);
            break;
    }
    if (redraw) {
        draw();
    }
}

void Console::progress(const decomp::Progress& progress) {
    if (quiet_) {
        return;
    }
    const std::scoped_lock lock(mutex_);
    const int percent = static_cast<int>(100 * std::clamp(progress.fraction, 0.0, 1.0));
    const bool new_stage = progress.stage != stage_;
    if (!new_stage && percent == percent_) {
        return;
    }
    stage_ = progress.stage;
    percent_ = percent;
    if (terminal_) {
        draw();
    } else if (new_stage) {
        std::fprintf(stderr, "%3d %% %s\n", percent_, stage_.c_str());
    }
}

void Console::draw() {
    const int filled = kBarWidth * percent_ / 100;
    const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                            std::string(static_cast<std::size_t>(kBarWidth - filled), '.');
    std::fprintf(stderr, "\r\x1b[K[%s] %3d %% %s", bar.c_str(), percent_, stage_.c_str());
    std::fflush(stderr);
    drawn_ = true;
}

void Console::clear() {
    const std::scoped_lock lock(mutex_);
    if (drawn_) {
        std::fputs("\r\x1b[K", stderr);
        std::fflush(stderr);
        drawn_ = false;
    }
}

}  // namespace tools
