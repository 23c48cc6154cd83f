// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace decomp {

/// A failure as a value: what went wrong, where, and what to try. Every code is listed in
/// docs/errors.md.
struct Error {
    std::string code;     ///< stable dotted word, e.g. "mesh.not_closed"
    std::string message;  ///< what happened, one sentence
    std::string
        where;  ///< file:line:column, triangle, move, part id; empty if nowhere in particular
    std::string hint;                ///< what to try; empty if nothing sensible can be said
    std::vector<std::string> notes;  ///< further facts, one a line

    /// "where: message [code]\n  hint", as the command line prints it.
    [[nodiscard]] std::string text() const;
};

}  // namespace decomp
