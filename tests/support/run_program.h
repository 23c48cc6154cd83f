// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/file.h"
#include "tests/support/temp_dir.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace tests {

struct Finished {
    int exit_code = -1;  ///< -1: ended by a signal
    int signal = 0;
    std::string out;
    std::string err;
};

struct Kill {
    int signal = SIGKILL;
    std::chrono::milliseconds after{0};
};

/// Runs a program to its end, or sends it a signal after a while. Both outputs go through files, so
/// that nothing blocks. Standard input is empty.
inline Finished run_program(std::vector<std::string> words,
                            std::optional<Kill> kill = std::nullopt) {
    const TempDir scratch;
    const std::string out = scratch / "out";
    const std::string err = scratch / "err";
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT,
                                       0600);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT,
                                       0600);
    std::vector<char*> argv;
    for (std::string& word : words) {
        argv.push_back(word.data());
    }
    argv.push_back(nullptr);
    pid_t child = 0;
    Finished finished;
    if (::posix_spawn(&child, argv.front(), &actions, nullptr, argv.data(), environ) == 0) {
        if (kill) {
            std::this_thread::sleep_for(kill->after);
            ::kill(child, kill->signal);
        }
        int status = 0;
        ::waitpid(child, &status, 0);
        finished.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        finished.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    }
    ::posix_spawn_file_actions_destroy(&actions);
    finished.out = decomp::read_file(out).value_or("");
    finished.err = decomp::read_file(err).value_or("");
    return finished;
}

}  // namespace tests
