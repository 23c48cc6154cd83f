// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/read_mill.h"

#include "cam/profile/mill_fields_detail.h"
#include "cam/profile/profile_files_detail.h"
#include "decomp/base/file.h"
#include "decomp/base/hash.h"

namespace cam::profile {

using decomp::fail;
using decomp::Result;
using decomp::Status;
namespace fs = std::filesystem;

namespace {

constexpr const char* kMills = "mill";
constexpr const char* kTools = "tools";
constexpr const char* kDialects = "dialects";
constexpr const char* kMaterials = "materials";

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

Status consistent(const std::vector<std::string>& said, const fs::path& where) {
    if (said.empty()) {
        return {};
    }
    return fail(decomp::Error{
        "profile.inconsistent", said.front(), where.string(), {}, {said.begin() + 1, said.end()}});
}

void append(std::vector<Field>& to, std::vector<Field> more) {
    for (Field& field : more) {
        to.push_back(std::move(field));
    }
}

std::vector<Field> all_fields(MillMachine& machine, MillDialect& dialect,
                              std::vector<ToolFile>& files) {
    std::vector<Field> out = fields_of(machine);
    append(out, fields_of(dialect));
    for (ToolFile& file : files) {
        append(out, fields_of(file));
    }
    return out;
}

/// Stems of those files of a folder that have a section [milling].
std::vector<std::string> milling_names_in(const char* folder) {
    std::vector<std::string> out;
    for (const std::string& name : names_in(search_path(), folder)) {
        const Result<Found> found = find_profile(search_path(), folder, name);
        const Result<std::string> text =
            found ? decomp::read_file(found->path) : decomp::Result<std::string>("");
        if (text && text->find("\n[milling]") != std::string::npos) {
            out.push_back(name);
        }
    }
    return out;
}

Result<MillDialect> read_dialect_from(const std::vector<fs::path>& roots, std::string_view name) {
    const Result<Found> found = find_profile(roots, kDialects, name);
    if (!found) {
        return fail(found.error());
    }
    MillDialect dialect;
    dialect.name = found->name;
    std::vector<Field> fields = fields_of(dialect);
    const Status read = read_into(fields, File::MillDialect, found->path).and_then([&] {
        return consistent(inconsistencies(dialect), found->path);
    });
    if (!read) {
        return fail(read.error());
    }
    return dialect;
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
    std::string text = setup.machine.name + "\n" + setup.dialect.name + "\n";
    std::vector<ToolFile> files = files_of(setup.tools);
    for (const ToolFile& file : files) {
        text += file.tool.name + "\n";
    }
    for (const Field& field : all_fields(setup.machine, setup.dialect, files)) {
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
    append(fields, fields_of(setup.dialect));
    // Settings are applied twice: one may name another dialect, whose file the others then outrank.
    Status read = read_into(fields, File::Mill, found->path).and_then([&] {
        return apply_settings(fields, settings);
    });
    if (!read) {
        return fail(read.error());
    }
    Result<MillDialect> dialect = read_dialect_from(roots, setup.machine.dialect);
    if (!dialect) {
        return fail(dialect.error());
    }
    setup.dialect = std::move(*dialect);
    read = apply_settings(fields, settings)
               .and_then([&] { return consistent(inconsistencies(setup.machine), found->path); })
               .and_then([&] { return consistent(inconsistencies(setup.dialect), found->path); })
               .and_then([&] {
                   return consistent(inconsistencies(setup.machine, setup.dialect), found->path);
               });
    if (!read) {
        return fail(read.error());
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
    MillDialect dialect = setup.dialect;
    std::vector<ToolFile> files =
        setup.tools.empty() ? std::vector<ToolFile>(1) : files_of({setup.tools.front()});
    return rows_of(all_fields(machine, dialect, files));
}

std::string explain(const MillSetup& setup) {
    MillMachine machine = setup.machine;
    std::string out = machine.name + ": " + machine.title + "\n" + text_of(fields_of(machine));
    MillDialect dialect = setup.dialect;
    out += "\ndialect " + dialect.name + ": " + dialect.title + "\n" + text_of(fields_of(dialect));
    std::vector<ToolFile> files = files_of(setup.tools);
    for (ToolFile& file : files) {
        out +=
            "\ntool " + file.tool.name + ": " + file.tool.title + "\n" + text_of(fields_of(file));
    }
    return out;
}

Result<MillMaterial> read_mill_material(std::string_view name,
                                        const std::vector<std::string>& settings) {
    const Result<Found> found = find_profile(search_path(), kMaterials, name);
    if (!found) {
        return fail(found.error());
    }
    MillMaterial material;
    material.name = found->name;
    std::vector<Field> fields = fields_of(material);
    const Status read =
        read_into(fields, File::MillMaterial, found->path)
            .and_then([&] { return apply_settings(fields, settings); })
            .and_then([&] { return consistent(inconsistencies(material), found->path); });
    if (!read) {
        return fail(read.error());
    }
    return material;
}

Result<MillDialect> read_mill_dialect(std::string_view name) {
    return read_dialect_from(search_path(), name);
}

std::vector<std::string> list_mill_materials() { return milling_names_in(kMaterials); }

std::vector<std::string> list_mill_dialects() { return milling_names_in(kDialects); }

std::vector<std::string> list_mills() { return names_in(search_path(), kMills); }

std::vector<std::string> list_tools() { return names_in(search_path(), kTools); }

}  // namespace cam::profile
