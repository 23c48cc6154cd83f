// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/fdm_machine.h"
#include "cam/profile/read_profile.h"

#include <string>
#include <variant>
#include <vector>

/// The one table of all profile fields. Reading, validation, `machines show` and docs/profiles.md
/// are driven by it: a new field is a member of fdm_machine.h and one line in fields.cpp.
namespace cam::profile {

/// Where the value of a field lives in the set-up at hand.
using Target =
    std::variant<double*, int*, bool*, std::string*, std::vector<std::string>*, decomp::Speed*,
                 decomp::Angle*, Eigen::Vector3d*, Eigen::Vector4d*, std::vector<double>*>;

/// Which file a section belongs to.
enum class File { Machine, Material, Dialect, Mill, Tool, Link, MillDialect, MillMaterial };

struct Field {
    File file = File::Machine;
    std::string section;
    std::string key;
    std::string unit;  ///< how the key's last words are read: mm/s for ..._mm_per_s; empty: none
    double low = 0;    ///< of numbers, in that unit
    double high = 0;
    bool required = false;
    std::string doc;
    Target target;
};

/// All fields of a set-up, bound to its members, in the order of the files.
[[nodiscard]] std::vector<Field> fields_of(FdmSetup& setup);

/// A value as TOML writes it.
[[nodiscard]] std::string toml_text(const Target& target);

/// Stores numbers in a target, in the unit of its key; sizes must match (one number; 3 or 4 for
/// vectors).
void store_numbers(const Target& target, const std::vector<double>& values);

/// The count of a target that takes a list of numbers of any length.
inline constexpr int kAnyCount = -1;

/// How many numbers a target holds; 0 when it holds a text, a truth value or a list of texts,
/// kAnyCount when it holds as many as are given.
[[nodiscard]] int number_count(const Target& target);

/// "0.05 .. 1", or an empty text for fields without numbers.
[[nodiscard]] std::string range_text(const Field& field);

/// What the values of one file or of all must have to do with each other, beyond the range of each:
/// one sentence
/// ("process.line_width_mm must be above process.layer_height_mm") for each violation.
[[nodiscard]] std::vector<std::string> inconsistencies(const FdmSetup& setup);

}  // namespace cam::profile
