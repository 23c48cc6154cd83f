// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/labels/label_file.h"

#include <algorithm>

namespace decomp::labels {

namespace {

std::string_view trimmed(std::string_view line) {
    constexpr std::string_view kBlank = " \t\r";
    const std::size_t first = line.find_first_not_of(kBlank);
    if (first == std::string_view::npos) {
        return {};
    }
    return line.substr(first, line.find_last_not_of(kBlank) - first + 1);
}

}  // namespace

std::string label_text(const Labeling& labels) {
    std::string text;
    text.reserve(2 * labels.size());
    for (const AxisLabel label : labels) {
        text += static_cast<char>('0' + static_cast<int>(label));
        text += '\n';
    }
    return text;
}

Result<Labeling> parse_labels(std::string_view text, std::string_view name, std::size_t triangles) {
    Labeling labels;
    std::size_t number = 0;
    while (!text.empty()) {
        ++number;
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view word = trimmed(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (word.empty()) {
            continue;
        }
        if (word.size() != 1 || word[0] < '0' || word[0] >= '0' + kLabelCount) {
            return fail("labels.syntax", "'" + std::string(word.substr(0, 20)) + "' is no label",
                        std::string(name) + ":" + std::to_string(number),
                        "one number from 0 to 5 a line: +X, -X, +Y, -Y, +Z, -Z");
        }
        labels.push_back(static_cast<AxisLabel>(word[0] - '0'));
    }
    if (labels.size() != triangles) {
        return fail("labels.count",
                    "there are " + std::to_string(labels.size()) + " labels for " +
                        std::to_string(triangles) + " triangles",
                    std::string(name), "give the labels of this very surface");
    }
    return labels;
}

Result<Labeling> read_labels(const std::filesystem::path& path, std::size_t triangles) {
    const Result<std::string> text = read_file(path);
    if (!text) {
        return fail(text.error());
    }
    return parse_labels(*text, path.string(), triangles);
}

Status write_labels(const std::filesystem::path& path, const Labeling& labels,
                    Overwrite overwrite) {
    return write_file(path, label_text(labels), overwrite);
}

}  // namespace decomp::labels
