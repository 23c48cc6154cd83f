// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/profile_files_detail.h"
#include "cam/profile/read_profile.h"
#include "cam/profile/read_toml.h"
#include "decomp/base/file.h"
#include "decomp/base/nearest.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>

namespace cam::profile {

using decomp::fail;
using decomp::Result;
using decomp::Status;
namespace fs = std::filesystem;

namespace {

std::string joined(const std::vector<std::string>& words) {
    std::string out;
    for (const std::string& word : words) {
        out += (out.empty() ? "" : ", ") + word;
    }
    return out;
}

std::optional<std::vector<double>> numbers_in(std::string_view text) {
    std::vector<double> out;
    if (text.starts_with('[') && text.ends_with(']')) {
        text = text.substr(1, text.size() - 2);
    }
    while (!text.empty()) {
        const std::size_t comma = std::min(text.find(','), text.size());
        std::string_view word = text.substr(0, comma);
        word.remove_prefix(std::min(word.find_first_not_of(' '), word.size()));
        double value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc{} ||
            std::any_of(end, word.data() + word.size(), [](char c) { return c != ' '; })) {
            return std::nullopt;
        }
        out.push_back(value);
        text.remove_prefix(std::min(comma + 1, text.size()));
    }
    return out;
}

/// "process.layer_height_mm=0.15"
Status apply_setting(std::vector<Field>& fields, const std::string& setting) {
    const std::string where = "--set " + setting;
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) {
        return fail("profile.bad_setting", "a setting has the form section.key=value", where);
    }
    const std::string name = setting.substr(0, equals);
    const std::string value = setting.substr(equals + 1);
    std::vector<std::string> known;
    for (Field& field : fields) {
        known.push_back(field.section + "." + field.key);
        if (known.back() != name) {
            continue;
        }
        if (auto* text = std::get_if<std::string*>(&field.target)) {
            **text = value;
            return {};
        }
        if (auto* flag = std::get_if<bool*>(&field.target)) {
            if (value != "true" && value != "false") {
                return fail("profile.wrong_type", name + " is true or false", where);
            }
            **flag = value == "true";
            return {};
        }
        if (number_count(field.target) == 0) {
            return fail("profile.bad_setting", name + " can only be set in a file", where);
        }
        const std::optional<std::vector<double>> numbers = numbers_in(value);
        const std::string fault = numbers ? store_checked(field, *numbers) : name + " is a number";
        if (!fault.empty()) {
            return fail(numbers ? "profile.out_of_range" : "profile.wrong_type", fault, where);
        }
        return {};
    }
    return fail("profile.unknown_key", "unknown setting '" + name + "'", where,
                decomp::did_you_mean(name, known));
}

}  // namespace

bool is_path(std::string_view name) {
    return name.find('/') != std::string_view::npos || name.ends_with(".toml");
}

std::vector<std::string> names_in(const std::vector<fs::path>& roots, const char* folder) {
    std::vector<std::string> names;
    for (const fs::path& root : roots) {
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(root / folder, ignored)) {
            if (entry.path().extension() == ".toml") {
                names.push_back(entry.path().stem().string());
            }
        }
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

Result<Found> find_profile(const std::vector<fs::path>& roots, const char* folder,
                           std::string_view name) {
    std::error_code ignored;
    if (is_path(name)) {
        const fs::path path{name};
        if (!fs::is_regular_file(path, ignored)) {
            return fail("profile.not_found", "there is no such profile", path.string());
        }
        return Found{path, path.stem().string()};
    }
    for (const fs::path& root : roots) {
        fs::path path = root / folder / (std::string(name) + ".toml");
        if (fs::is_regular_file(path, ignored)) {
            return Found{std::move(path), std::string(name)};
        }
    }
    const std::vector<std::string> known = names_in(roots, folder);
    std::string hint = decomp::did_you_mean(name, known);
    if (hint.empty()) {
        hint = known.empty() ? "no profiles are installed" : "known are: " + joined(known);
    }
    decomp::Error error{"profile.not_found",
                        "unknown profile '" + std::string(name) + "' of " + folder,
                        {},
                        hint,
                        {}};
    for (const fs::path& root : roots) {
        error.notes.push_back("looked in " + (root / folder).string());
    }
    return fail(error);
}

Status apply_settings(std::vector<Field>& fields, const std::vector<std::string>& settings) {
    for (const std::string& setting : settings) {
        Status applied = apply_setting(fields, setting);
        if (!applied) {
            return applied;
        }
    }
    return {};
}

Status read_into(std::vector<Field>& fields, File file, const fs::path& path) {
    const Result<std::string> text = decomp::read_file(path);
    if (!text) {
        return fail(text.error());
    }
    return read_toml(fields, file, *text, path.string());
}

std::vector<fs::path> search_path() {
    std::vector<fs::path> out = {"machine_profiles"};
    const char* config = std::getenv("XDG_CONFIG_HOME");
    const char* home = std::getenv("HOME");
    if (config != nullptr && *config != '\0') {
        out.push_back(fs::path(config) / "hew" / "machine_profiles");
    } else if (home != nullptr && *home != '\0') {
        out.push_back(fs::path(home) / ".config" / "hew" / "machine_profiles");
    }
    std::error_code unreadable;
    const fs::path program = fs::read_symlink("/proc/self/exe", unreadable);
    if (!unreadable) {
        out.push_back(program.parent_path().parent_path() / "share" / "hew" / "machine_profiles");
    }
    out.emplace_back(HEW_INSTALLED_PROFILES);
    out.emplace_back(HEW_SOURCE_PROFILES);
    return out;
}

}  // namespace cam::profile
