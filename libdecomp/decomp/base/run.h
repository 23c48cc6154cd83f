// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>

namespace decomp {

enum class LogLevel { Debug, Info, Warning };

struct LogEvent {
    LogLevel level = LogLevel::Info;
    std::string text;
};

/// How far one named stage has come; fraction runs from 0 to exactly 1.
struct Progress {
    std::string_view stage;
    double fraction = 0;
};

/// The ambient of one run, handed down as the last parameter; there is no other ambient state.
/// Libraries never print: they call `log` and `progress`, which the caller binds.
struct Run {
    int jobs = 1;            ///< threads at most; results never depend on it
    std::uint64_t seed = 1;  ///< the only source of randomness
    std::stop_token stop;
    std::function<void(const LogEvent&)> log_sink;
    std::function<void(const Progress&)> progress_sink;

    void log(LogLevel level, std::string text) const {
        if (log_sink) {
            log_sink({level, std::move(text)});
        }
    }

    void info(std::string text) const { log(LogLevel::Info, std::move(text)); }

    void warn(std::string text) const { log(LogLevel::Warning, std::move(text)); }

    void progress(std::string_view stage, double fraction) const {
        if (progress_sink) {
            progress_sink({stage, fraction});
        }
    }

    [[nodiscard]] bool cancelled() const { return stop.stop_requested(); }
};

/// What a cancelled function returns.
[[nodiscard]] inline tl::unexpected<Error> cancelled() {
    return fail("run.cancelled", "the run was cancelled");
}

}  // namespace decomp
