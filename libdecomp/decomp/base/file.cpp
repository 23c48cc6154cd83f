// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

namespace decomp {

namespace {

tl::unexpected<Error> unwritable(const std::filesystem::path& path, int error_number) {
    return fail("file.unwritable",
                std::string("cannot write the file: ") + std::strerror(error_number), path.string(),
                "check the folder, its permissions and the free space");
}

bool write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno != EINTR) {
            return false;
        }
        bytes.remove_prefix(written > 0 ? static_cast<std::size_t>(written) : 0);
    }
    return true;
}

}  // namespace

Result<std::string> read_file(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        return fail("file.not_found", "there is no such file", path.string());
    }
    std::ifstream in(path, std::ios::binary);
    std::string bytes;
    if (in && std::filesystem::is_regular_file(path, ignored)) {
        bytes.assign(std::istreambuf_iterator<char>(in), {});
    }
    if (!in || in.bad() || std::filesystem::is_directory(path, ignored)) {
        return fail("file.unreadable", "cannot read the file", path.string(),
                    "check its permissions");
    }
    return bytes;
}

Status write_file(const std::filesystem::path& path, std::string_view bytes, Overwrite overwrite) {
    std::error_code ignored;
    if (overwrite == Overwrite::Refuse && std::filesystem::exists(path, ignored)) {
        return fail("file.exists", "the file exists already", path.string(),
                    "choose another name, or add --force");
    }
    // The temporary lies in the same folder, for rename() is atomic only within one file system.
    std::string temporary =
        (path.parent_path() / (".hew-" + path.filename().string() + "-XXXXXX")).string();
    const int descriptor = ::mkstemp(temporary.data());
    if (descriptor < 0) {
        return unwritable(path, errno);
    }
    const mode_t mask = ::umask(0);
    ::umask(mask);
    const bool written = write_all(descriptor, bytes) && ::fchmod(descriptor, 0666 & ~mask) == 0 &&
                         ::fsync(descriptor) == 0;
    const int error_number = errno;
    ::close(descriptor);
    if (!written || ::rename(temporary.c_str(), path.c_str()) != 0) {
        const int reason = written ? errno : error_number;
        ::unlink(temporary.c_str());
        return unwritable(path, reason);
    }
    return {};
}

}  // namespace decomp
