// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/nearest.h"

#include <algorithm>

namespace decomp {

int edit_distance(std::string_view a, std::string_view b) {
    // Three rows of the table are enough: a swap of neighbours looks two rows back.
    std::vector<int> before(b.size() + 1);
    std::vector<int> above(b.size() + 1);
    std::vector<int> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) {
        above[j] = static_cast<int>(j);
    }
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = static_cast<int>(i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const int replaced = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = std::min(row[j], before[j - 2] + 1);
            }
        }
        before.swap(above);
        above.swap(row);
    }
    return above[b.size()];
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates) {
    int best = std::max(2, static_cast<int>(word.size()) / 3) + 1;
    const std::string* found = nullptr;
    for (const std::string& candidate : candidates) {
        const int distance = edit_distance(word, candidate);
        // A short word may not be replaced as a whole: "ab" is no misspelling of "xy".
        if (distance < best && distance < static_cast<int>(word.size())) {
            best = distance;
            found = &candidate;
        }
    }
    if (found != nullptr || word.empty()) {
        return found != nullptr ? *found : std::string();
    }
    int containing = 0;
    for (const std::string& candidate : candidates) {
        if (candidate.find(word) != std::string::npos) {
            ++containing;
            found = &candidate;
        }
    }
    return containing == 1 ? *found : std::string();
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
    const std::string found = nearest_word(word, candidates);
    return found.empty() ? found : "did you mean '" + found + "'?";
}

}  // namespace decomp
