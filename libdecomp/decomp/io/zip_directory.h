// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace decomp::io {

/// One file of a zip archive, as its directory tells it. The sizes are claims.
struct ZipEntry {
    std::string name;
    std::uint64_t unpacked_bytes = 0;
    std::uint64_t packed_bytes = 0;
    std::uint64_t header_at = 0;  ///< of the local header
    std::uint16_t method = 0;     ///< 0 stored, 8 deflated
};

/// What the directory of a zip archive lists (APPNOTE.TXT 4.3.12, zip64 included). Nothing when
/// there is no directory, or it is out of shape.
[[nodiscard]] std::optional<std::vector<ZipEntry>> zip_entries(std::string_view archive);

/// Unpacks an entry piece by piece into `take`, which may end it by false. Never gives more than
/// the entry states.
/// @return false when the entry is out of shape, encrypted, of another method, or larger than
/// stated
[[nodiscard]] bool unpack(std::string_view archive, const ZipEntry& entry,
                          const std::function<bool(std::string_view)>& take);

}  // namespace decomp::io
