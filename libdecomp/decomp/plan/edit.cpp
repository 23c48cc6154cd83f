// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/plan/edit.h"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

namespace decomp::plan {

namespace {

std::optional<double> number(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
        return std::nullopt;
    }
    return value;
}

Result<Edit> parse_split(std::string_view text) {
    const auto refused = [&] {
        return fail("plan.edit", "'" + std::string(text) + "' does not say where to split", "",
                    "write PART:AXIS=SHARE, the axis x, y or z, the share between 0 and 1: "
                    "P03:z=0.5");
    };
    const std::size_t colon = text.find(':');
    const std::size_t equals = text.find('=');
    if (colon == std::string_view::npos || colon == 0 || equals != colon + 2) {
        return refused();
    }
    const std::size_t axis = std::string_view("xyz").find(text[colon + 1]);
    const std::optional<double> share = number(text.substr(equals + 1));
    if (axis == std::string_view::npos || !share || *share <= 0 || *share >= 1) {
        return refused();
    }
    Edit edit;
    edit.parts.emplace_back(text.substr(0, colon));
    edit.axis = static_cast<int>(axis);
    edit.share = *share;
    return edit;
}

Result<Edit> parse_merge(std::string_view text) {
    Edit edit;
    edit.kind = Edit::Kind::Merge;
    std::set<std::string_view> names;
    for (std::string_view rest = text;;) {
        const std::size_t plus = rest.find('+');
        const std::string_view name = rest.substr(0, plus);
        if (name.empty() || !names.insert(name).second) {
            break;
        }
        edit.parts.emplace_back(name);
        if (plus == std::string_view::npos) {
            if (edit.parts.size() < 2) {
                break;
            }
            return edit;
        }
        rest = rest.substr(plus + 1);
    }
    return fail("plan.edit", "'" + std::string(text) + "' does not say what to merge", "",
                "write two or more different parts: P02+P05");
}

Result<Edit> parse_plane(std::string_view text) {
    Edit edit;
    edit.kind = Edit::Kind::Plane;
    std::vector<double> values;
    std::istringstream words{std::string(text)};
    bool sound = true;
    for (std::string word; words >> word;) {
        const std::optional<double> value = number(word);
        sound = sound && value;
        values.push_back(value.value_or(0));
    }
    if (sound && values.size() == 4) {
        const Eigen::Vector3d normal(values[0], values[1], values[2]);
        const double length = normal.norm();
        if (length > 0 && std::isfinite(length)) {
            edit.plane = {normal / length, values[3]};
            return edit;
        }
    }
    return fail("plan.edit", "'" + std::string(text) + "' is no plane", "",
                "write four numbers, the normal and the distance from the origin along it in mm: "
                "\"0 0 1 50\"");
}

}  // namespace

Result<Edit> parse_edit(std::string_view text) {
    const std::size_t space = text.find(' ');
    const std::string_view verb = text.substr(0, space);
    const std::string_view rest =
        space == std::string_view::npos ? std::string_view() : text.substr(space + 1);
    Result<Edit> edit = verb == "split"   ? parse_split(rest)
                        : verb == "merge" ? parse_merge(rest)
                        : verb == "plane"
                            ? parse_plane(rest)
                            : fail("plan.edit", "'" + std::string(text) + "' is no edit", "",
                                   "edits begin with split, merge or plane");
    if (edit) {
        edit->text = std::string(text);
    }
    return edit;
}

}  // namespace decomp::plan
