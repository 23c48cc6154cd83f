// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/protocol/line_splitter.h"

#include <algorithm>

namespace cam::protocol {

bool LineSplitter::next(std::string_view& bytes) {
    if (done_) {
        line_.clear();
        done_ = false;
        cut_ = false;
    }
    while (!bytes.empty()) {
        const std::size_t end = std::min(bytes.find_first_of("\r\n"), bytes.size());
        const bool ended = end < bytes.size();
        if (!skipping_) {
            line_.append(bytes.substr(0, std::min(end, kLongest - line_.size())));
        }
        const bool overlong = !skipping_ && line_.size() == kLongest;
        bytes.remove_prefix(std::min(end + 1, bytes.size()));
        if (overlong) {
            cut_ = true;
            skipping_ = !ended;
            done_ = true;
            return true;
        }
        if (ended) {
            const bool was_skipping = skipping_;
            skipping_ = false;
            if (!was_skipping && !line_.empty()) {
                done_ = true;
                return true;
            }
        }
    }
    return false;
}

void LineSplitter::clear() {
    line_.clear();
    done_ = false;
    cut_ = false;
    skipping_ = false;
}

}  // namespace cam::protocol
