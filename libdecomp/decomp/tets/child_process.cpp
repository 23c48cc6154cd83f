// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/tets/child_process_detail.h"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string_view>

namespace decomp::tets {

namespace {

/// Exit codes of the copy; anything else means that it crashed.
constexpr int kDone = 0;
constexpr int kFailed = 1;

bool write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t done = ::write(descriptor, bytes.data(), bytes.size());
        if (done < 0 && errno != EINTR) {
            return false;
        }
        bytes.remove_prefix(done > 0 ? static_cast<std::size_t>(done) : 0);
    }
    return true;
}

bool read_all(int descriptor, std::string& bytes) {
    std::array<char, 65536> buffer{};
    for (;;) {
        const ssize_t done = ::read(descriptor, buffer.data(), buffer.size());
        if (done == 0) {
            return true;
        }
        if (done < 0 && errno != EINTR) {
            return false;
        }
        bytes.append(buffer.data(), done > 0 ? static_cast<std::size_t>(done) : 0);
    }
}

[[noreturn]] void be_child(int descriptor, const std::function<std::string()>& body) {
    int code = kFailed;
    try {
        code = write_all(descriptor, body()) ? kDone : kFailed;
    } catch (...) {
        code = kFailed;
    }
    // No destructors, no atexit handlers: they belong to the parent.
    ::_exit(code);
}

}  // namespace

Result<std::string> in_child_process(const std::function<std::string()>& body) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) {
        return fail("tets.failed", "no pipe to a process of its own");
    }
    const pid_t child = ::fork();
    if (child < 0) {
        ::close(ends[0]);
        ::close(ends[1]);
        return fail("tets.failed", "no process of its own", {}, "free some memory");
    }
    if (child == 0) {
        ::close(ends[0]);
        be_child(ends[1], body);
    }
    ::close(ends[1]);
    std::string bytes;
    const bool whole = read_all(ends[0], bytes);
    ::close(ends[0]);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!whole || !WIFEXITED(status) || WEXITSTATUS(status) != kDone) {
        return fail("tets.failed", "the mesher crashed");
    }
    return bytes;
}

}  // namespace decomp::tets
