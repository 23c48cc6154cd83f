// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/plan/plan_file.h"

#include "decomp/base/nearest.h"
#include "decomp/base/number.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <tuple>
#include <utility>

namespace decomp::plan {

namespace {

constexpr int kSchema = 1;
constexpr double kUnitWithin = 1e-6;  // of the normals in the file

struct Fault {
    toml::source_position at;
    std::string code;
    std::string message;
    std::string hint;
};

class Reader {
  public:
    explicit Reader(std::string name) : name_(std::move(name)) {}

    Result<Plan> read(const toml::table& root) {
        const toml::node* schema = root.get("schema");
        if (schema == nullptr || schema->value<std::int64_t>() != kSchema) {
            report((schema == nullptr ? static_cast<const toml::node*>(&root) : schema)
                       ->source()
                       .begin,
                   "plan.schema", "the file must say schema = 1",
                   "write schema = 1 as its first line");
        }
        check_keys(root, "the file", {"schema", "shape", "origin", "step"});
        if (const toml::table* shape = table(root, "shape", true)) {
            check_keys(*shape, "[shape]", {"sha256"});
            read_value(*shape, "[shape]", "sha256", plan_.shape_sha256, true);
        }
        if (const toml::table* origin = table(root, "origin", false)) {
            read_origin(*origin);
        }
        read_steps(root);
        return verdict();
    }

  private:
    void report(toml::source_position at, std::string code, std::string message,
                std::string hint = {}) {
        faults_.push_back({at, std::move(code), std::move(message), std::move(hint)});
    }

    void check_keys(const toml::table& table, const std::string& place,
                    const std::vector<std::string>& known) {
        for (const auto& [key, node] : table) {
            if (std::find(known.begin(), known.end(), key.str()) == known.end()) {
                report(key.source().begin, "plan.unknown_key",
                       "unknown key '" + std::string(key.str()) + "' in " + place,
                       did_you_mean(key.str(), known));
            }
        }
    }

    const toml::node* wanted(const toml::table& table, const std::string& place,
                             std::string_view key) {
        const toml::node* node = table.get(key);
        if (node == nullptr) {
            report(table.source().begin, "plan.missing_key",
                   place + " must have '" + std::string(key) + "'");
        }
        return node;
    }

    void wrong_type(const toml::node& node, std::string_view key, const std::string& type) {
        report(node.source().begin, "plan.wrong_type", std::string(key) + " must be " + type);
    }

    const toml::table* table(const toml::table& root, const std::string& key, bool required) {
        const toml::node* node = root.get(key);
        if (node == nullptr) {
            if (required) {
                report({}, "plan.missing_key", "the file must have [" + key + "]");
            }
            return nullptr;
        }
        if (node->as_table() == nullptr) {
            wrong_type(*node, key, "a section: [" + key + "]");
        }
        return node->as_table();
    }

    template <class T>
    void read_value(const toml::table& table, const std::string& place, std::string_view key,
                    T& target, bool required) {
        const toml::node* node = required ? wanted(table, place, key) : table.get(key);
        if (node == nullptr) {
            return;
        }
        if (const std::optional<T> value = node->value_exact<T>()) {
            target = *value;
        } else {
            wrong_type(*node, key,
                       std::is_same_v<T, bool>          ? "true or false"
                       : std::is_same_v<T, std::string> ? "a text in quotes"
                                                        : "a whole number");
        }
    }

    void read_words(const toml::node& node, std::string_view key,
                    std::vector<std::string>& target) {
        const toml::array* array = node.as_array();
        if (array == nullptr || !(array->empty() || array->is_homogeneous<std::string>())) {
            wrong_type(node, key, "a list of texts in quotes");
            return;
        }
        for (const toml::node& element : *array) {
            target.push_back(*element.value<std::string>());
        }
    }

    /// As many finite numbers as wished, or nothing and a fault.
    std::optional<std::vector<double>> numbers(const toml::node& node, std::string_view key,
                                               std::size_t count, const std::string& type) {
        const toml::array* array = node.as_array();
        std::vector<double> out;
        if (array != nullptr && array->size() == count) {
            for (const toml::node& element : *array) {
                const std::optional<double> value =
                    element.is_number() ? element.value<double>() : std::nullopt;
                if (value && std::isfinite(*value)) {
                    out.push_back(*value);
                }
            }
        }
        if (out.size() != count) {
            wrong_type(node, key, type);
            return std::nullopt;
        }
        return out;
    }

    void read_one_of(const toml::table& table, std::string_view key, std::string& target,
                     const std::vector<std::string>& words) {
        read_value(table, "[origin]", key, target, false);
        if (std::find(words.begin(), words.end(), target) == words.end()) {
            std::string list;
            for (const std::string& word : words) {
                list += (list.empty() ? "" : ", ") + word;
            }
            std::string hint = did_you_mean(target, words);
            report(table.get(key)->source().begin, "plan.out_of_range",
                   std::string(key) + " must be one of " + list, std::move(hint));
        }
    }

    void read_origin(const toml::table& table) {
        Origin& origin = plan_.origin;
        check_keys(table, "[origin]",
                   {"mode", "sweep", "boxes", "polycube", "tier", "seed", "notes"});
        read_one_of(table, "mode", origin.mode, {"sheets", "paper", "sections"});
        read_one_of(table, "sweep", origin.sweep, {"local", "global"});
        read_one_of(table, "polycube", origin.polycube, {"none", "made", "given"});
        read_value(table, "[origin]", "boxes", origin.boxes, false);
        read_value(table, "[origin]", "tier", origin.tier, false);
        auto seed = static_cast<std::int64_t>(origin.seed);
        read_value(table, "[origin]", "seed", seed, false);
        origin.seed = static_cast<std::uint64_t>(seed);
        if (const toml::node* notes = table.get("notes")) {
            read_words(*notes, "notes", origin.notes);
        }
    }

    void read_steps(const toml::table& root) {
        const toml::node* node = root.get("step");
        if (node == nullptr) {
            return;
        }
        const toml::array* steps = node->as_array();
        if (steps == nullptr || !(steps->empty() || steps->is_homogeneous<toml::table>())) {
            wrong_type(*node, "step", "a list of sections: [[step]]");
            return;
        }
        for (const toml::node& step : *steps) {
            read_step(*step.as_table());
        }
    }

    void read_step(const toml::table& table) {
        Step step;
        step.where = place(table.source().begin);
        const bool cuts = table.contains("cut");
        if (cuts == table.contains("merge")) {
            report(table.source().begin, "plan.missing_key",
                   "a step has either 'cut', the region to cut, or 'merge', the regions to unite",
                   R"(cut = "r0", or merge = ["r0", "r1"])");
            check_keys(table, "[[step]]", {"cut", "plane", "loops", "gives", "merge", "by"});
            return;
        }
        if (cuts) {
            check_keys(table, "a cut", {"cut", "plane", "loops", "gives", "by"});
            read_cut(table, step);
        } else {
            check_keys(table, "a merge", {"merge", "by"});
            read_merge(*table.get("merge"), step);
        }
        read_value(table, "[[step]]", "by", step.by, false);
        plan_.steps.push_back(std::move(step));
    }

    void read_cut(const toml::table& table, Step& step) {
        read_value(table, "a cut", "cut", step.region, true);
        if (const toml::node* node = wanted(table, "a cut", "plane")) {
            const auto values = numbers(*node, "plane", 4,
                                        "four numbers: the normal, and the offset along it in mm");
            if (values) {
                step.plane = {{(*values)[0], (*values)[1], (*values)[2]}, (*values)[3]};
                if (std::abs(step.plane.normal.norm() - 1) > kUnitWithin) {
                    report(node->source().begin, "plan.out_of_range",
                           "the normal of the plane must have length 1, it has " +
                               shortest(step.plane.normal.norm()));
                }
            }
        }
        if (const toml::node* node = table.get("gives")) {
            read_words(*node, "gives", step.names);
            report_twice(*node, "gives", step.names);
        }
        if (const toml::node* node = table.get("loops")) {
            read_loops(*node, step);
        }
    }

    void read_loops(const toml::node& node, Step& step) {
        const toml::array* points = node.as_array();
        if (points == nullptr || points->empty()) {
            wrong_type(node, "loops", "a list of points: [[1.0, 2.0, 3.0]]");
            return;
        }
        for (const toml::node& point : *points) {
            if (const auto values = numbers(point, "a point of loops", 3, "three numbers, mm")) {
                step.loops_mm.emplace_back((*values)[0], (*values)[1], (*values)[2]);
            }
        }
    }

    void read_merge(const toml::node& node, Step& step) {
        step.kind = Step::Kind::Merge;
        std::vector<std::string> names;
        const std::size_t before = faults_.size();
        read_words(node, "merge", names);
        if (names.size() < 2) {
            if (faults_.size() == before) {
                report(node.source().begin, "plan.out_of_range",
                       "merge must name two regions or more");
            }
            return;
        }
        report_twice(node, "merge", names);
        step.region = names.front();
        step.names.assign(names.begin() + 1, names.end());
    }

    void report_twice(const toml::node& node, const std::string& key,
                      std::vector<std::string> names) {
        std::sort(names.begin(), names.end());
        const auto twice = std::adjacent_find(names.begin(), names.end());
        if (twice != names.end()) {
            report(node.source().begin, "plan.out_of_range", key + " names '" + *twice + "' twice");
        }
    }

    [[nodiscard]] std::string place(const toml::source_position& at) const {
        return at.line == 0
                   ? name_
                   : name_ + ":" + std::to_string(at.line) + ":" + std::to_string(at.column);
    }

    Result<Plan> verdict() {
        if (faults_.empty()) {
            return std::move(plan_);
        }
        std::stable_sort(faults_.begin(), faults_.end(), [](const Fault& a, const Fault& b) {
            return std::tuple(a.at.line == 0, a.at.line, a.at.column) <
                   std::tuple(b.at.line == 0, b.at.line, b.at.column);
        });
        const Fault& first = faults_.front();
        Error error{first.code, first.message, place(first.at), first.hint, {}};
        for (std::size_t i = 1; i < faults_.size(); ++i) {
            const Fault& fault = faults_[i];
            error.notes.push_back(place(fault.at) + ": " + fault.message +
                                  (fault.hint.empty() ? "" : "; " + fault.hint));
        }
        return fail(error);
    }

    std::string name_;
    Plan plan_;
    std::vector<Fault> faults_;
};

/// In quotes, as TOML wants it.
std::string quoted(const std::string& text) {
    constexpr std::string_view kHex = "0123456789abcdef";
    std::string out = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (byte < 0x20 || byte == 0x7f) {
            out += "\\u00";
            out += kHex[byte / 16];
            out += kHex[byte % 16];
        } else {
            out += c;
        }
    }
    return out + "\"";
}

std::string list_of(const std::vector<std::string>& words) {
    std::string out;
    for (const std::string& word : words) {
        out += (out.empty() ? "" : ", ") + quoted(word);
    }
    return "[" + out + "]";
}

template <class Numbers>
std::string numbers_text(const Numbers& numbers) {
    std::string out;
    for (const double number : numbers) {
        out += (out.empty() ? "" : ", ") + shortest(number + 0.0);
    }
    return "[" + out + "]";
}

std::string step_text(const Step& step) {
    std::string out = "\n[[step]]\n";
    if (step.kind == Step::Kind::Merge) {
        std::vector<std::string> names{step.region};
        names.insert(names.end(), step.names.begin(), step.names.end());
        out += "merge = " + list_of(names) + "\n";
    } else {
        const Eigen::Vector4d plane(step.plane.normal.x(), step.plane.normal.y(),
                                    step.plane.normal.z(), step.plane.offset_mm);
        out += "cut = " + quoted(step.region) + "\nplane = " + numbers_text(plane) + "\n";
        std::string loops;
        for (const Eigen::Vector3d& point : step.loops_mm) {
            loops += (loops.empty() ? "" : ", ") + numbers_text(point);
        }
        out += loops.empty() ? "" : "loops = [" + loops + "]\n";
        out += step.names.empty() ? "" : "gives = " + list_of(step.names) + "\n";
    }
    return out + (step.by.empty() ? "" : "by = " + quoted(step.by) + "\n");
}

}  // namespace

std::string plan_toml(const Plan& plan, const std::vector<std::string>& parts) {
    const Origin& origin = plan.origin;
    std::string out =
        "# How a shape is cut. Change it and carry it out: hew decompose MODEL --plan plan.toml\n"
        "# docs/formats.md explains the keys.\n"
        "schema = 1\n\n[shape]\nsha256 = " +
        quoted(plan.shape_sha256) + "\n\n[origin]\nmode = " + quoted(origin.mode) +
        "\nsweep = " + quoted(origin.sweep) + "\nboxes = " + (origin.boxes ? "true" : "false") +
        "\npolycube = " + quoted(origin.polycube) + "\ntier = " + quoted(origin.tier) +
        "\nseed = " + std::to_string(static_cast<std::int64_t>(origin.seed)) +
        "\nnotes = " + list_of(origin.notes) + "\n";
    for (const Step& step : plan.steps) {
        out += step_text(step);
    }
    out += parts.empty() ? "" : "\n# The parts that this gives:\n";
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::string number = std::to_string(i + 1);
        out += "# P" + std::string(number.size() < 2 ? 1 : 0, '0') + number + " is region " +
               parts[i] + "\n";
    }
    return out;
}

Result<Plan> parse_plan(std::string_view text, const std::string& name) {
    try {
        const toml::table root = toml::parse(text, name);
        return Reader(name).read(root);
    } catch (const toml::parse_error& error) {
        const toml::source_position at = error.source().begin;
        return fail("plan.syntax", std::string(error.description()),
                    name + ":" + std::to_string(at.line) + ":" + std::to_string(at.column),
                    "plans are TOML: https://toml.io");
    }
}

}  // namespace decomp::plan
