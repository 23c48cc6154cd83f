// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/run.h"
#include "tools/verb.h"

#include <memory>
#include <mutex>
#include <string>

namespace spdlog {
class logger;
}

namespace tools {

/// stderr for people: a progress bar on a terminal, a line per stage otherwise, log lines in
/// between. Thread-safe.
class Console {
  public:
    explicit Console(const Common& common);

    void log(const decomp::LogEvent& event);
    void progress(const decomp::Progress& progress);

    /// Takes the progress bar away.
    void clear();

  private:
    void draw();

    std::mutex mutex_;
    std::shared_ptr<spdlog::logger> logger_;
    bool quiet_ = false;
    bool terminal_ = false;
    bool drawn_ = false;
    std::string stage_;
    int percent_ = -1;
};

/// False when NO_COLOR is set or the descriptor is no terminal (https://no-color.org).
[[nodiscard]] bool wants_colour(int descriptor);

}  // namespace tools
