// SPDX-License-Identifier: GPL-3.0-or-later
// Lets libserialport 0.1.1 open pseudo-terminals, for tests alone: it looks for the device below
// /sys/class/tty, where they are not, and asks for modem lines, which they lack. Functions of the
// program win over those of the C library for calls made inside libserialport.
#include <dlfcn.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <string>
#include <string_view>

namespace {

bool is_terminal_entry(const char* path) {
    return std::string_view(path).starts_with("/sys/class/tty/pts/");
}

template <class Function>
Function next(const char* name) {
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

namespace tests {
std::string dtr_changes;  // '+' raised, '-' dropped
}

extern "C" {

// NOLINTBEGIN: names and signatures are those of the C library.
int lstat(const char* path, struct stat* out) noexcept {
    if (is_terminal_entry(path)) {
        std::memset(out, 0, sizeof *out);
        out->st_mode = S_IFLNK | 0777;
        return 0;
    }
    return next<int (*)(const char*, struct stat*)>("lstat")(path, out);
}

int __lxstat(int /*version*/, const char* path, struct stat* out) noexcept {
    return lstat(path, out);
}

ssize_t readlink(const char* path, char* out, size_t size) noexcept {
    if (is_terminal_entry(path)) {
        constexpr std::string_view kTarget = "../../devices/virtual/tty/pts";
        const size_t length = std::min(size, kTarget.size());
        std::memcpy(out, kTarget.data(), length);
        return static_cast<ssize_t>(length);
    }
    return next<ssize_t (*)(const char*, char*, size_t)>("readlink")(path, out, size);
}

ssize_t __readlink_chk(const char* path, char* out, size_t size, size_t /*room*/) noexcept {
    return readlink(path, out, size);
}

int ioctl(int descriptor, unsigned long request, ...) noexcept {
    va_list arguments;
    va_start(arguments, request);
    void* argument = va_arg(arguments, void*);
    va_end(arguments);
    const int answer =
        next<int (*)(int, unsigned long, void*)>("ioctl")(descriptor, request, argument);
    if (answer < 0 && (errno == ENOTTY || errno == EINVAL)) {
        if (request == TIOCMGET) {
            *static_cast<int*>(argument) =
                TIOCM_CTS | TIOCM_DSR | TIOCM_CAR | TIOCM_DTR | TIOCM_RTS;
            return 0;
        }
        if (request == TIOCMBIS || request == TIOCMBIC || request == TIOCMSET) {
            if (request != TIOCMSET && (*static_cast<int*>(argument) & TIOCM_DTR) != 0) {
                tests::dtr_changes += request == TIOCMBIS ? '+' : '-';
            }
            return 0;
        }
    }
    return answer;
}

// NOLINTEND

}  // extern "C"
