// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/error.h"

#include <tl/expected.hpp>

#include <string>
#include <utility>

namespace decomp {

/// What every room's door returns: a value or an Error.
template <class T>
using Result = tl::expected<T, Error>;

/// A Result without a value.
using Status = Result<void>;

/// What a function returns on failure: `return fail("mesh.empty", "the file holds no triangle",
/// path);`
[[nodiscard]] inline tl::unexpected<Error> fail(std::string code, std::string message,
                                                std::string where = {}, std::string hint = {}) {
    return tl::make_unexpected(
        Error{std::move(code), std::move(message), std::move(where), std::move(hint), {}});
}

/// Passes the error of another Result on: `if (!mesh) { return fail(mesh.error()); }`
[[nodiscard]] inline tl::unexpected<Error> fail(Error error) {
    return tl::make_unexpected(std::move(error));
}

}  // namespace decomp
