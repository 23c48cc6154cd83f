// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/fields.h"
#include "cam/profile/link_fields_detail.h"
#include "cam/profile/mill_fields_detail.h"
#include "cam/profile/read_profile.h"
#include "cam/profile/template.h"

#include <algorithm>

namespace cam::profile {

namespace {

std::string file_folder(File file) {
    switch (file) {
        case File::Machine:
            return "fdm";
        case File::Material:
        case File::MillMaterial:
            return "materials";
        case File::Dialect:
        case File::MillDialect:
            return "dialects";
        case File::Mill:
            return "mill";
        case File::Tool:
            return "tools";
        case File::Link:
            return "links";
    }
    return "";
}

const char* scope_text(Scope scope) {
    switch (scope) {
        case Scope::Program:
            return "start, layer, end";
        case Scope::Layer:
            return "layer";
        case Scope::Heater:
            return "set_nozzle, set_bed";
        case Scope::Fan:
            return "fan_on, fan_off";
        case Scope::Position:
            return "reset_e";
        case Scope::Progress:
            return "progress";
        case Scope::Dwell:
            return "dwell";
    }
    return "";
}

constexpr const char* kPreface = R"(# Profiles

A printer, a material and a dialect are one TOML file each, in `machine_profiles/fdm`, `materials` and `dialects`; a mill
and a tool in `mill` and `tools`. They are looked for in `./machine_profiles`, `$XDG_CONFIG_HOME/hew/machine_profiles` (`~/.config` when unset), the folder
`share/hew/machine_profiles` beside the installed program, and the source tree; the first file of a name wins. A name with
a slash or `.toml` in it is a path, and brings its own `../materials`, `../dialects` and `../tools` along.

Every file begins with `schema = 1`. Keys end in their unit. An unknown key, a missing one, a value of the wrong type or out
of its range is an error with file, line and column; all faults of a file are told at once. What a mill's controller reads and what is milled are
dialects and materials with a section `[milling]`; `sources` says where each of their values was read. A set-up whose files do not fit
together (a material too hot for the machine, a template with a word that the dialect forbids) is refused.

`--set section.key=value` overrides any number or text of any section for one run, e.g. `--set process.brim_width_mm=5` or
`--set material.fan_fraction=0.5`.

This page is made from the table that reads the files; `HEW_BLESS=1 ctest -R Profile` writes it anew.

Changes: schema 1 is the first.
)";

constexpr const char* kTemplates = R"(
## Templates

Templates are G-code with `{placeholders}`: a name, or an expression of names, numbers, `+ - * / ( )`, `min(a, b)` and
`max(a, b)`; numbers are written with at most three decimals. `{{` stands for a brace.

| placeholder | in | meaning |
|---|---|---|
)";

std::string table_cell(const std::string& text) {
    std::string out;
    for (const char c : text) {
        out += c == '|' ? std::string("\\|") : std::string(1, c);
    }
    return out;
}

void append_block(std::string& out, const std::string& text) {
    std::size_t begin = 0;
    while (begin < text.size()) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        out += "      | " + text.substr(begin, end - begin) + "\n";
        begin = end + 1;
    }
}

}  // namespace

std::vector<FieldRow> describe(const FdmSetup& setup) {
    FdmSetup copy = setup;
    std::vector<FieldRow> rows;
    for (const Field& field : fields_of(copy)) {
        rows.push_back({field.section, field.key, toml_text(field.target), field.unit,
                        range_text(field), field.required, field.doc});
    }
    return rows;
}

std::string explain(const FdmSetup& setup) {
    FdmSetup copy = setup;
    std::string out = setup.machine.name + ": " + setup.machine.title + "\nmaterial " +
                      setup.material.name + ": " + setup.material.title + "\ndialect " +
                      setup.dialect.name + ": " + setup.dialect.title + "\n";
    std::string section;
    for (const Field& field : fields_of(copy)) {
        if (field.section != section) {
            section = field.section;
            out += "\n[" + section + "]\n";
        }
        const auto* const* text = std::get_if<std::string*>(&field.target);
        const bool block = text != nullptr && (*text)->find('\n') != std::string::npos;
        std::string line = "  " + field.key + " = " + (block ? "" : toml_text(field.target));
        constexpr std::size_t kColumn = 56;
        line.append(line.size() < kColumn ? kColumn - line.size() : 1, ' ');
        out += line + field.doc + "\n";
        if (block) {
            append_block(out, **text);
        }
    }
    return out;
}

std::string profile_reference_markdown() {
    FdmSetup printer;
    MillMachine mill;
    ToolFile tool;
    std::vector<Field> fields = fields_of(printer);
    Link link;
    MillDialect dialect;
    MillMaterial material;
    for (std::vector<Field> more : {fields_of(mill), fields_of(tool), fields_of(dialect),
                                    fields_of(material), fields_of(link)}) {
        fields.insert(fields.end(), more.begin(), more.end());
    }
    std::string out = kPreface;
    std::string section;
    for (const Field& field : fields) {
        if (file_folder(field.file) + field.section != section) {
            section = file_folder(field.file) + field.section;
            out += "\n## [" + field.section + "] in " + file_folder(field.file) + "/NAME.toml\n\n";
            out += "| key | default | range | meaning |\n|---|---|---|---|\n";
        }
        std::string value = "required";
        if (!field.required) {
            value = "`";
            value += table_cell(toml_text(field.target)) + "`";
        }
        out += "| `" + field.key + "` | " + value + " | " + range_text(field) + " | " +
               table_cell(field.doc) + (field.unit.empty() ? "" : " (" + field.unit + ")") + " |\n";
    }
    out += kTemplates;
    for (const Placeholder& placeholder : placeholders()) {
        out += "| `{" + placeholder.name + "}` | " + scope_text(placeholder.scope) + " | " +
               placeholder.doc + " |\n";
    }
    return out;
}

}  // namespace cam::profile
