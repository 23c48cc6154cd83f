// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/error.h"

namespace decomp {

std::string Error::text() const {
    std::string out;
    if (!where.empty()) {
        out += where + ": ";
    }
    out += message + " [" + code + "]";
    for (const std::string& note : notes) {
        out += "\n  note: " + note;
    }
    if (!hint.empty()) {
        out += "\n  try: " + hint;
    }
    return out;
}

}  // namespace decomp
