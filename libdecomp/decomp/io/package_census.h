// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/result.h"

#include <cstdint>
#include <string_view>

namespace decomp::io {

/// What a 3MF package would become if it were read.
struct PackageCensus {
    std::uint64_t unpacked_bytes = 0;
    std::uint64_t instances = 0;  ///< objects placed, counted through nested components
};

/// Unpacks the package once and counts, before a reader that trusts it does: a few components that
/// double at each nesting name more instances than any memory holds. O(unpacked bytes).
/// @error io.threemf  no zip archive, an entry larger than it states, XML out of shape or with a
///        document type, components nested more than 32 deep or in a circle
/// @error io.too_large  more than 2 GB unpacked, or more than 100 000 instances
[[nodiscard]] Result<PackageCensus> count_package(std::string_view archive, std::string_view name);

}  // namespace decomp::io
