// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/signals.h"

#include "tools/exit_code.h"

#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <thread>

namespace tools {

std::stop_source stop_on_signals() {
    sigset_t signals;
    ::sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        ::sigaddset(&signals, signal);
    }
    // Blocked here and so in every later thread: only the waiting thread ever sees them, outside of
    // any handler.
    ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::stop_source source;
    std::thread([signals, source]() mutable {
        int signal = 0;
        ::sigwait(&signals, &signal);
        source.request_stop();
        ::sigwait(&signals, &signal);
        ::_exit(kCancelled);
    }).detach();
    return source;
}

}  // namespace tools
