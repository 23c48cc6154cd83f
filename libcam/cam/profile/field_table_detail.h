// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/fields.h"

#include <string>
#include <variant>
#include <vector>

/// How the tables of fields.cpp and mill_fields.cpp are written: one row per member.
namespace cam::profile {

enum class Need { Optional, Required };

constexpr Need kRequired = Need::Required;
constexpr Need kOptional = Need::Optional;

template <class S>
using Member = std::variant<double S::*, int S::*, bool S::*, std::string S::*,
                            std::vector<std::string> S::*, decomp::Speed S::*, decomp::Angle S::*,
                            Eigen::Vector3d S::*, Eigen::Vector4d S::*, std::vector<double> S::*>;

template <class S>
struct Row {
    const char* key;
    Member<S> member;
    const char* unit;
    double low;
    double high;
    Need need;
    const char* doc;
};

template <class S>
using Table = std::vector<Row<S>>;

template <class S>
void bind(std::vector<Field>& out, File file, const char* section, const Table<S>& rows,
          S& object) {
    for (const Row<S>& row : rows) {
        const Target target =
            std::visit([&](auto member) -> Target { return &(object.*member); }, row.member);
        out.push_back({file, section, row.key, row.unit, row.low, row.high,
                       row.need == Need::Required, row.doc, target});
    }
}

}  // namespace cam::profile
