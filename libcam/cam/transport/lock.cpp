// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/transport/lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <utility>

namespace cam::transport {

namespace fs = std::filesystem;
using decomp::fail;

namespace {

constexpr int kTries = 3;

std::string lock_name(const fs::path& device) {
    std::string name = device.string();
    name = name.starts_with("/dev/") ? name.substr(5) : name.substr(name.find_first_not_of('/'));
    for (char& c : name) {
        c = c == '/' ? '_' : c;
    }
    return "LCK.." + name;
}

tl::unexpected<decomp::Error> busy(const std::string& device, const std::string& holder) {
    return fail("transport.busy", "the port is in use by " + holder, device,
                "end that program first: two senders on one machine cannot work");
}

std::string process_name(long pid) {
    std::ifstream in("/proc/" + std::to_string(pid) + "/comm");
    std::string name;
    std::getline(in, name);
    return "process " + std::to_string(pid) + (name.empty() ? "" : " (" + name + ")");
}

}  // namespace

decomp::Result<LockFile> LockFile::take(const fs::path& device, const fs::path& folder) {
    LockFile lock;
    const fs::path path = folder / lock_name(device);
    for (int attempt = 0; attempt < kTries; ++attempt) {
        const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
        if (file >= 0) {
            std::array<char, 16> text{};
            const int length =
                std::snprintf(text.data(), text.size(), "%10d\n", static_cast<int>(::getpid()));
            const bool written =
                ::write(file, text.data(), static_cast<std::size_t>(length)) == length;
            ::close(file);
            if (!written) {
                ::unlink(path.c_str());
                return lock;
            }
            lock.path_ = path;
            return lock;
        }
        if (errno != EEXIST) {
            return lock;
        }
        std::ifstream in(path);
        long pid = 0;
        if (in >> pid && pid > 0 && (::kill(static_cast<pid_t>(pid), 0) == 0 || errno == EPERM)) {
            return busy(device.string(), process_name(pid));
        }
        // Left behind by a process that has ended.
        ::unlink(path.c_str());
    }
    return lock;
}

LockFile::LockFile(LockFile&& other) noexcept : path_(std::exchange(other.path_, {})) {}

LockFile& LockFile::operator=(LockFile&& other) noexcept {
    if (this != &other) {
        remove();
        path_ = std::exchange(other.path_, {});
    }
    return *this;
}

LockFile::~LockFile() { remove(); }

void LockFile::remove() {
    if (!path_.empty()) {
        ::unlink(path_.c_str());
        path_.clear();
    }
}

decomp::Status lock_terminal(int descriptor, const std::string& name) {
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
        return busy(name, "another process, which holds its lock");
    }
    ::ioctl(descriptor, TIOCEXCL);
    return {};
}

void unlock_terminal(int descriptor) {
    ::ioctl(descriptor, TIOCNXCL);
    ::flock(descriptor, LOCK_UN);
}

}  // namespace cam::transport
