// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

/// A file that is only ever appended to, and that can be read after any interruption.
///
/// A record is a line "CCCCCCCC NUMBER TEXT\n": the CRC-32 of what follows it as eight hexadecimal
/// digits, the number of the record from 0, and text without newlines. What follows the last whole
/// record is a torn tail and is ignored.
namespace cam::journal {

/// What a journal holds.
struct Contents {
    std::vector<std::string> records;
    std::uint64_t whole_bytes = 0;  ///< up to and with the last whole record
    std::uint64_t torn_bytes = 0;   ///< behind it
};

/// Reads the records up to the first that is not whole. Never fails on its bytes. O(bytes).
[[nodiscard]] Contents read_records(std::string_view bytes);

/// @error file.not_found, file.unreadable
[[nodiscard]] decomp::Result<Contents> read_journal(const std::filesystem::path& path);

/// One record as it stands in the file.
[[nodiscard]] std::string record_line(std::uint64_t number, std::string_view text);

/// Appends records. A thread of its own writes and syncs, so that a slow disk never delays the
/// caller; what was added is on the disk (fdatasync) at most `sync_time` later, sooner when
/// `sync_count` records wait or one is urgent.
class Writer {
  public:
    struct Options {
        std::chrono::milliseconds sync_time{1000};
        std::uint64_t sync_count = 64;
        /// Called by the writing thread after every sync and when writing fails.
        std::function<void()> on_synced;
    };

    /// Creates the file. @error file.exists, file.unwritable
    [[nodiscard]] static decomp::Result<std::unique_ptr<Writer>> create(
        const std::filesystem::path& path, Options options);

    /// Continues a journal; its torn tail is cut off. @error file.unwritable
    [[nodiscard]] static decomp::Result<std::unique_ptr<Writer>> append(
        const std::filesystem::path& path, const Contents& contents, Options options);

    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;
    Writer(Writer&&) = delete;
    Writer& operator=(Writer&&) = delete;

    /// Writes and syncs what is left.
    ~Writer();

    enum class Urgency { Normal, Urgent };

    /// Adds a record; never waits. @return its number
    std::uint64_t add(std::string_view text, Urgency urgency = Urgency::Normal);

    /// A record of how far things are: only the last of those that come within some milliseconds
    /// is written. Never waits. `lines` counts towards sync_count.
    void note(std::string text, std::uint64_t lines);

    /// Records with a smaller number are on the disk.
    [[nodiscard]] std::uint64_t durable() const;

    /// @error file.unwritable (full disk, and the like): nothing is written from then on
    [[nodiscard]] decomp::Status status() const;

    /// Waits until everything is on the disk. @error file.unwritable
    [[nodiscard]] decomp::Status flush();

  private:
    struct State;
    explicit Writer(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace cam::journal
