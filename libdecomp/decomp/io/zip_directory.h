// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace decomp::io {

/// Sum of the unpacked sizes that the directory of a zip archive states, bytes (APPNOTE.TXT 4.3.12,
/// zip64 included). Nothing when there is no directory, or it is out of shape.
[[nodiscard]] std::optional<std::uint64_t> unpacked_size(std::string_view archive);

}  // namespace decomp::io
