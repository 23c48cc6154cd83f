// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/read_mill.h"

#include "cam/profile/mill_fields_detail.h"
#include "cam/profile/profile_files_detail.h"
#include "decomp/base/hash.h"

namespace cam::profile {

using decomp::fail;
using decomp::Result;
using decomp::Status;
namespace fs = std::filesystem;

namespace {

constexpr const char* kMills = "mill";
constexpr const char* kTools = "tools";

Result<tool::Tool> read_tool_from(const std::vector<fs::path>& roots, std::string_view name) {
    const Result<Found> found = find_profile(roots, kTools, name);
    if (!found) {
        return fail(found.error());
    }
    ToolFile file;
    file.tool.name = found->name;
    std::vector<Field> fields = fields_of(file);
    const Status read = read_into(fields, File::Tool, found->path);
    if (!read) {
        return fail(read.error());
    }
    return tool_of(file, found->path.string());
}

std::vector<Field> all_fields(MillMachine& machine, std::vector<ToolFile>& files) {
    std::vector<Field> out = fields_of(machine);
    for (ToolFile& file : files) {
        for (Field& field : fields_of(file)) {
            out.push_back(std::move(field));
        }
    }
    return out;
}

std::vector<ToolFile> files_of(const std::vector<tool::Tool>& tools) {
    std::vector<ToolFile> out;
    out.reserve(tools.size());
    for (const tool::Tool& tool : tools) {
        out.push_back(file_of(tool));
    }
    return out;
}

std::string hash_of(MillSetup setup) {
    std::string text = setup.machine.name + "\n";
    std::vector<ToolFile> files = files_of(setup.tools);
    for (const ToolFile& file : files) {
        text += file.tool.name + "\n";
    }
    for (const Field& field : all_fields(setup.machine, files)) {
        text += field.section + "." + field.key + " = " + toml_text(field.target) + "\n";
    }
    return decomp::sha256_hex(text);
}

std::vector<FieldRow> rows_of(const std::vector<Field>& fields) {
    std::vector<FieldRow> rows;
    rows.reserve(fields.size());
    for (const Field& field : fields) {
        rows.push_back({field.section, field.key, toml_text(field.target), field.unit,
                        range_text(field), field.required, field.doc});
    }
    return rows;
}

std::string text_of(const std::vector<Field>& fields) {
    constexpr std::size_t kColumn = 56;
    std::string out;
    std::string section;
    for (const FieldRow& row : rows_of(fields)) {
        if (row.section != section) {
            section = row.section;
            out += "\n[" + section + "]\n";
        }
        std::string line = "  " + row.key + " = " + row.value;
        line.append(line.size() < kColumn ? kColumn - line.size() : 1, ' ');
        out += line + row.doc + "\n";
    }
    return out;
}

}  // namespace

Result<tool::Tool> read_tool(std::string_view name) { return read_tool_from(search_path(), name); }

Result<MillSetup> read_mill_setup(std::string_view machine, const std::vector<std::string>& tools,
                                  const std::vector<std::string>& settings) {
    std::vector<fs::path> roots = search_path();
    const Result<Found> found = find_profile(roots, kMills, machine);
    if (!found) {
        return fail(found.error());
    }
    if (is_path(machine)) {
        // A machine given by its path brings its own tools along.
        roots.insert(roots.begin(), found->path.parent_path() / "..");
    }
    MillSetup setup;
    setup.machine.name = found->name;
    std::vector<Field> fields = fields_of(setup.machine);
    const Status read = read_into(fields, File::Mill, found->path).and_then([&] {
        return apply_settings(fields, settings);
    });
    if (!read) {
        return fail(read.error());
    }
    const std::vector<std::string> said = inconsistencies(setup.machine);
    if (!said.empty()) {
        return fail(decomp::Error{"profile.inconsistent",
                                  said.front(),
                                  found->path.string(),
                                  {},
                                  {said.begin() + 1, said.end()}});
    }
    if (!tools.empty()) {
        setup.machine.tools = tools;
    }
    for (const std::string& name : setup.machine.tools) {
        Result<tool::Tool> tool = read_tool_from(roots, name);
        if (!tool) {
            return fail(tool.error());
        }
        setup.tools.push_back(std::move(*tool));
    }
    setup.hash = hash_of(setup);
    return setup;
}

std::vector<FieldRow> describe(const MillSetup& setup) {
    MillMachine machine = setup.machine;
    std::vector<ToolFile> files =
        setup.tools.empty() ? std::vector<ToolFile>(1) : files_of({setup.tools.front()});
    return rows_of(all_fields(machine, files));
}

std::string explain(const MillSetup& setup) {
    MillMachine machine = setup.machine;
    std::string out = machine.name + ": " + machine.title + "\n" + text_of(fields_of(machine));
    std::vector<ToolFile> files = files_of(setup.tools);
    for (ToolFile& file : files) {
        out +=
            "\ntool " + file.tool.name + ": " + file.tool.title + "\n" + text_of(fields_of(file));
    }
    return out;
}

std::vector<std::string> list_mills() { return names_in(search_path(), kMills); }

std::vector<std::string> list_tools() { return names_in(search_path(), kTools); }

}  // namespace cam::profile
