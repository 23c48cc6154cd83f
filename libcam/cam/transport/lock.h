// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"

#include <filesystem>
#include <string>

namespace cam::transport {

/// The lock file of a device, as other programs for modems and machines keep it: LCK..NAME with
/// the number of the process. Removed at the end of its life.
class LockFile {
  public:
    /// Takes the lock; one of a process that has ended is taken over. Where the folder does not
    /// exist or may not be written, there is no such lock, and nothing is taken.
    /// @param device  a real path, e.g. /dev/ttyUSB0
    /// @error transport.busy
    [[nodiscard]] static decomp::Result<LockFile> take(
        const std::filesystem::path& device, const std::filesystem::path& folder = "/run/lock");

    LockFile(LockFile&& other) noexcept;
    LockFile& operator=(LockFile&& other) noexcept;
    LockFile(const LockFile&) = delete;
    LockFile& operator=(const LockFile&) = delete;
    ~LockFile();

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    LockFile() = default;
    void remove();
    std::filesystem::path path_;  ///< empty: none taken
};

/// Takes an open terminal for this process: flock() and TIOCEXCL. @error transport.busy
[[nodiscard]] decomp::Status lock_terminal(int descriptor, const std::string& name);

/// Gives it back, before it is closed: where others have the terminal open, the marks would stay.
void unlock_terminal(int descriptor);

}  // namespace cam::transport
