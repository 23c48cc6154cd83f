// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/post/convert.h"

#include "decomp/base/file.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <string>
#include <vector>

namespace cam::post {

using decomp::fail;
using decomp::Status;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostOutput = 4096;

void replace_all(std::string& text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos;
         at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
    }
}

/// Split at spaces before the paths go in, so a path with spaces stays one argument.
std::vector<std::string> arguments_of(const profile::FdmMachine::Converter& converter,
                                      const fs::path& in, const fs::path& out) {
    std::vector<std::string> words = {converter.program};
    std::size_t begin = 0;
    while ((begin = converter.arguments.find_first_not_of(' ', begin)) != std::string::npos) {
        const std::size_t end =
            std::min(converter.arguments.find(' ', begin), converter.arguments.size());
        std::string word = converter.arguments.substr(begin, end - begin);
        // Absolute, so that no file name can be taken for an option.
        replace_all(word, "{in}", fs::absolute(in).string());
        replace_all(word, "{out}", fs::absolute(out).string());
        words.push_back(std::move(word));
        begin = end;
    }
    return words;
}

struct Finished {
    int spawn_error = 0;  ///< errno of the start; then nothing else counts
    int exit_status = -1;
    bool timed_out = false;
    bool cancelled = false;
    std::string output;  ///< both streams, the first kilobytes
};

/// Reads what the child says until it closes its end, the time is up or the run is cancelled.
void collect(int descriptor, const decomp::Run& run, Finished& finished) {
    const auto deadline =
        std::chrono::steady_clock::now() + std::chrono::seconds(kConverterSeconds);
    constexpr int kTickMs = 50;
    std::array<char, 1024> buffer{};
    while (!finished.timed_out && !finished.cancelled) {
        pollfd waiting{descriptor, POLLIN, 0};
        if (::poll(&waiting, 1, kTickMs) > 0) {
            const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
            if (count == 0 || (count < 0 && errno != EINTR)) {
                return;
            }
            const std::size_t room = kMostOutput - finished.output.size();
            finished.output.append(
                buffer.data(),
                std::min(room, static_cast<std::size_t>(std::max<ssize_t>(count, 0))));
        }
        finished.timed_out = std::chrono::steady_clock::now() > deadline;
        finished.cancelled = run.cancelled();
    }
}

Finished run_program(std::vector<std::string> words, const decomp::Run& run) {
    Finished finished;
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
        finished.spawn_error = errno;
        return finished;
    }
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& word : words) {
        argv.push_back(word.data());
    }
    argv.push_back(nullptr);
    pid_t child = 0;
    finished.spawn_error =
        ::posix_spawnp(&child, argv.front(), &actions, nullptr, argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    if (finished.spawn_error == 0) {
        collect(ends[0], run, finished);
        if (finished.timed_out || finished.cancelled) {
            ::kill(child, SIGKILL);
        }
        while (::waitpid(child, &finished.exit_status, 0) < 0 && errno == EINTR) {
        }
    }
    ::close(ends[0]);
    return finished;
}

Status verdict(const Finished& finished, const profile::FdmMachine::Converter& converter,
               const std::string& where) {
    if (finished.spawn_error == ENOENT) {
        return fail("post.converter_missing",
                    "the converter '" + converter.program + "' is not installed", where,
                    "apt install " + converter.program);
    }
    if (finished.spawn_error != 0) {
        return fail(
            "post.converter_failed",
            "cannot start '" + converter.program + "': " + std::strerror(finished.spawn_error),
            where);
    }
    if (finished.cancelled) {
        return decomp::cancelled();
    }
    if (finished.timed_out) {
        return fail("post.converter_timeout",
                    "'" + converter.program + "' took more than " +
                        std::to_string(kConverterSeconds) + " s",
                    where);
    }
    if (!WIFEXITED(finished.exit_status) || WEXITSTATUS(finished.exit_status) != 0) {
        decomp::Error error{"post.converter_failed",
                            "'" + converter.program + "' failed",
                            where,
                            {},
                            {finished.output}};
        return fail(error);
    }
    return {};
}

}  // namespace

Status convert(const fs::path& program, const fs::path& out,
               const profile::FdmMachine::Converter& converter, const decomp::Run& run) {
    if (converter.program.empty()) {
        return fail("post.no_converter", "the machine has no converter");
    }
    std::error_code system_error;
    if (!fs::is_regular_file(program, system_error)) {
        return fail("file.not_found", "there is no such file", program.string());
    }
    // Beside the result, for rename() is atomic only within one file system; under its own name,
    // for converters write it into the result.
    std::string folder = (out.parent_path() / ".hew-convert-XXXXXX").string();
    if (::mkdtemp(folder.data()) == nullptr) {
        return fail("file.unwritable", std::string("cannot make a folder: ") + std::strerror(errno),
                    folder);
    }
    const fs::path temporary = fs::path(folder) / out.filename();
    const Finished finished = run_program(arguments_of(converter, program, temporary), run);
    Status status = verdict(finished, converter, program.string());
    if (status && (!fs::is_regular_file(temporary, system_error) ||
                   fs::file_size(temporary, system_error) == 0)) {
        decomp::Error error{"post.converter_failed",
                            "'" + converter.program + "' wrote nothing",
                            program.string(),
                            {},
                            {finished.output}};
        status = fail(error);
    }
    if (status) {
        fs::rename(temporary, out, system_error);
        if (system_error) {
            status = fail("file.unwritable", "cannot write the file: " + system_error.message(),
                          out.string());
        }
    }
    fs::remove_all(folder, system_error);
    return status;
}

}  // namespace cam::post
