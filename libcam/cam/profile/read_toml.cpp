// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/read_toml.h"

#include "decomp/base/nearest.h"
#include "decomp/base/number.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>

namespace cam::profile {

using decomp::fail;
using decomp::Status;

namespace {

constexpr int kSchema = 1;

struct Fault {
    toml::source_position at;
    std::string code;
    std::string message;
    std::string hint;
};

std::string wanted_numbers(int count) {
    if (count == kAnyCount) {
        return "a list of numbers";
    }
    return count == 1 ? "one number" : "a list of " + std::to_string(count) + " numbers";
}

class Reader {
  public:
    Reader(std::vector<Field>& fields, File file, std::string name)
        : fields_(fields), file_(file), name_(std::move(name)) {}

    Status read(const toml::table& root) {
        read_schema(root);
        for (const auto& [key, node] : root) {
            if (key.str() != "schema") {
                read_section(key, node);
            }
        }
        report_missing(root);
        return verdict();
    }

  private:
    void report(toml::source_position at, std::string code, std::string message,
                std::string hint = {}) {
        faults_.push_back({at, std::move(code), std::move(message), std::move(hint)});
    }

    void read_schema(const toml::table& root) {
        const toml::node* schema = root.get("schema");
        if (schema == nullptr || schema->value<std::int64_t>() != kSchema) {
            report(schema == nullptr ? root.source().begin : schema->source().begin,
                   "profile.schema", "the file must say schema = 1",
                   "write schema = 1 as its first line");
        }
    }

    void read_section(const toml::key& key, const toml::node& node) {
        const std::string section(key.str());
        std::vector<std::string> sections;
        std::vector<std::string> keys;
        for (const Field& field : fields_) {
            if (field.file == file_) {
                sections.push_back(field.section);
                if (field.section == section) {
                    keys.push_back(field.key);
                }
            }
        }
        const toml::table* table = node.as_table();
        if (keys.empty() || table == nullptr) {
            report(key.source().begin, "profile.unknown_key",
                   table == nullptr ? "unknown key '" + section + "' outside every section"
                                    : "unknown section [" + section + "]",
                   decomp::did_you_mean(section, sections));
            return;
        }
        for (const auto& [name, value] : *table) {
            const std::string_view wanted = name.str();
            const auto field =
                std::find_if(fields_.begin(), fields_.end(), [&](const Field& candidate) {
                    return candidate.file == file_ && candidate.section == section &&
                           candidate.key == wanted;
                });
            if (field == fields_.end()) {
                report(name.source().begin, "profile.unknown_key",
                       "unknown key '" + std::string(name.str()) + "' in [" + section + "]",
                       decomp::did_you_mean(name.str(), keys));
            } else {
                seen_.insert(section + "." + field->key);
                read_value(*field, value);
            }
        }
    }

    void read_value(Field& field, const toml::node& node) {
        if (auto* text = std::get_if<std::string*>(&field.target)) {
            read_plain(field, node, **text, "a text in quotes");
        } else if (auto* flag = std::get_if<bool*>(&field.target)) {
            read_plain(field, node, **flag, "true or false");
        } else if (auto* words = std::get_if<std::vector<std::string>*>(&field.target)) {
            read_words(field, node, **words);
        } else {
            read_numbers(field, node);
        }
    }

    void wrong_type(const Field& field, const toml::node& node, const std::string& wanted) {
        report(node.source().begin, "profile.wrong_type",
               field.section + "." + field.key + " must be " + wanted);
    }

    template <class T>
    void read_plain(const Field& field, const toml::node& node, T& target, const char* wanted) {
        if (const std::optional<T> value = node.value_exact<T>()) {
            target = *value;
        } else {
            wrong_type(field, node, wanted);
        }
    }

    void read_words(const Field& field, const toml::node& node, std::vector<std::string>& target) {
        const toml::array* array = node.as_array();
        if (array == nullptr || !(array->empty() || array->is_homogeneous<std::string>())) {
            wrong_type(field, node, "a list of texts in quotes");
            return;
        }
        target.clear();
        for (const toml::node& element : *array) {
            target.push_back(*element.value<std::string>());
        }
    }

    void read_numbers(Field& field, const toml::node& node) {
        std::vector<double> values;
        const int count = number_count(field.target);
        const toml::array* array = node.as_array();
        if ((array == nullptr) != (count == 1)) {
            wrong_type(field, node, wanted_numbers(count));
            return;
        }
        for (int i = 0; i < (array == nullptr ? 1 : static_cast<int>(array->size())); ++i) {
            const toml::node& element =
                array == nullptr ? node : *array->get(static_cast<std::size_t>(i));
            if (!element.is_number()) {
                wrong_type(field, element, "a number");
                return;
            }
            values.push_back(*element.value<double>());
        }
        const std::string fault = store_checked(field, values);
        if (!fault.empty()) {
            report(node.source().begin, "profile.out_of_range", fault);
        }
    }

    void report_missing(const toml::table& root) {
        for (const Field& field : fields_) {
            if (field.file == file_ && field.required &&
                seen_.count(field.section + "." + field.key) == 0) {
                const toml::node* section = root.get(field.section);
                // A section that is not there has no place in the file.
                report(section == nullptr ? toml::source_position{} : section->source().begin,
                       "profile.missing_key",
                       "[" + field.section + "] must have '" + field.key + "': " + field.doc);
            }
        }
    }

    [[nodiscard]] std::string place(const Fault& fault) const {
        if (fault.at.line == 0) {
            return name_;
        }
        return name_ + ":" + std::to_string(fault.at.line) + ":" + std::to_string(fault.at.column);
    }

    Status verdict() {
        if (faults_.empty()) {
            return {};
        }
        std::stable_sort(faults_.begin(), faults_.end(), [](const Fault& a, const Fault& b) {
            return std::tuple(a.at.line == 0, a.at.line, a.at.column) <
                   std::tuple(b.at.line == 0, b.at.line, b.at.column);
        });
        const Fault& first = faults_.front();
        decomp::Error error{first.code, first.message, place(first), first.hint, {}};
        for (std::size_t i = 1; i < faults_.size(); ++i) {
            const Fault& fault = faults_[i];
            error.notes.push_back(place(fault) + ": " + fault.message +
                                  (fault.hint.empty() ? "" : "; " + fault.hint));
        }
        return fail(error);
    }

    std::vector<Field>& fields_;
    File file_;
    std::string name_;
    std::vector<Fault> faults_;
    std::set<std::string> seen_;
};

}  // namespace

std::string store_checked(Field& field, const std::vector<double>& values) {
    const std::string name = field.section + "." + field.key;
    const int count = number_count(field.target);
    if (count != kAnyCount && static_cast<int>(values.size()) != count) {
        return name + " must be " + wanted_numbers(count);
    }
    for (const double value : values) {
        // Not "value < low": a NaN must fail too.
        if (!(value >= field.low && value <= field.high)) {
            const std::string said = std::isfinite(value) && std::abs(value) < 1e9
                                         ? decomp::decimal(value, 6)
                                         : decomp::shortest(value);
            std::string fault = name;
            fault += " = " + said;
            fault += " is outside " + range_text(field);
            return fault;
        }
        if (std::holds_alternative<int*>(field.target) && value != std::floor(value)) {
            return name + " must be a whole number";
        }
    }
    store_numbers(field.target, values);
    return {};
}

Status read_toml(std::vector<Field>& fields, File file, std::string_view text,
                 const std::string& name) {
    try {
        const toml::table root = toml::parse(text, name);
        return Reader(fields, file, name).read(root);
    } catch (const toml::parse_error& error) {
        const toml::source_position at = error.source().begin;
        return fail("profile.syntax", std::string(error.description()),
                    name + ":" + std::to_string(at.line) + ":" + std::to_string(at.column),
                    "profiles are TOML: https://toml.io");
    }
}

}  // namespace cam::profile
