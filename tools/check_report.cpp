// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/check_report.h"

#include "decomp/base/number.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace tools {

std::string TextTable::text() const {
    std::vector<std::size_t> widths;
    for (const auto& row : rows_) {
        widths.resize(std::max(widths.size(), row.size()), 0);
        for (std::size_t i = 0; i < row.size(); ++i) {
            widths[i] = std::max(widths[i], row[i].size());
        }
    }
    std::string out;
    for (const auto& row : rows_) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string space(widths[i] - row[i].size(), ' ');
            line += i == 0 ? row[i] + space : "  " + space + row[i];
        }
        line.erase(line.find_last_not_of(' ') + 1);
        out += line + "\n";
    }
    return out;
}

Json share_json(const cam::check::Share& share) {
    return {{"by_area_percent", share.by_area_percent},
            {"by_facets_percent", share.by_facets_percent},
            {"area_mm2", share.area_mm2},
            {"facets", share.facets}};
}

Json vector_json(const Eigen::Vector3d& vector) {
    // + 0.0 makes a -0 a 0: nobody looks for a sign there.
    return {vector.x() + 0.0, vector.y() + 0.0, vector.z() + 0.0};
}

std::string percent_text(double percent) { return decomp::fixed(percent, 2); }

std::string direction_text(const Eigen::Vector3d& direction) {
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(direction[axis]) == 1) {
            return std::string(direction[axis] < 0 ? "-" : "") + "xyz"[axis];
        }
    }
    return decomp::decimal(direction.x(), 3) + " " + decomp::decimal(direction.y(), 3) + " " +
           decomp::decimal(direction.z(), 3);
}

decomp::Result<Eigen::Vector3d> parse_direction(const std::string& text) {
    const bool negative = text.starts_with('-');
    const std::string letter = negative ? text.substr(1) : text;
    const std::size_t axis = std::string("xyz").find(letter);
    if (letter.size() == 1 && axis != std::string::npos) {
        return Eigen::Vector3d((negative ? -1 : 1) * Eigen::Vector3d::Unit(static_cast<int>(axis)));
    }
    Eigen::Vector3d out = Eigen::Vector3d::Zero();
    const char* at = text.data();
    const char* end = at + text.size();
    for (int i = 0; i < 3; ++i) {
        const auto [rest, failed] = std::from_chars(at, end, out[i]);
        const bool last = i == 2;
        if (failed != std::errc{} || (last ? rest != end : rest == end || *rest != ',')) {
            return decomp::fail("usage.direction", "'" + text + "' is no direction", {},
                                "write x, -x, y, -y, z, -z or three numbers: 0.1,-0.9,0");
        }
        at = rest + 1;
    }
    return out;
}

}  // namespace tools
