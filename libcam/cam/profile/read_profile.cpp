// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/read_profile.h"

#include "cam/profile/fields.h"
#include "cam/profile/profile_files_detail.h"
#include "decomp/base/hash.h"

namespace cam::profile {

using decomp::fail;
using decomp::Result;
using decomp::Status;
namespace fs = std::filesystem;

namespace {

Status check_consistency(const FdmSetup& setup, const std::string& where) {
    const std::vector<std::string> faults = inconsistencies(setup);
    if (faults.empty()) {
        return {};
    }
    decomp::Error error{
        "profile.inconsistent", faults.front(), where, {}, {faults.begin() + 1, faults.end()}};
    return fail(error);
}

std::string hash_of(FdmSetup& setup) {
    std::string text =
        setup.machine.name + "\n" + setup.material.name + "\n" + setup.dialect.name + "\n";
    for (const Field& field : fields_of(setup)) {
        text += field.section + "." + field.key + " = " + toml_text(field.target) + "\n";
    }
    return decomp::sha256_hex(text);
}

}  // namespace

Result<FdmSetup> read_fdm_setup(std::string_view machine, std::string_view material,
                                const std::vector<std::string>& settings) {
    std::vector<fs::path> roots = search_path();
    const Result<Found> machine_file = find_profile(roots, "fdm", machine);
    if (!machine_file) {
        return fail(machine_file.error());
    }
    if (is_path(machine)) {
        // A machine given by its path brings its own materials and dialects along.
        roots.insert(roots.begin(), machine_file->path.parent_path() / "..");
    }
    FdmSetup setup;
    std::vector<Field> fields = fields_of(setup);
    setup.machine.name = machine_file->name;
    Status read = read_into(fields, File::Machine, machine_file->path).and_then([&] {
        return apply_settings(fields, settings);
    });
    if (!read) {
        return fail(read.error());
    }
    const std::string chosen =
        material.empty() ? setup.machine.process.material : std::string(material);
    const Result<Found> material_file = find_profile(roots, "materials", chosen);
    if (!material_file) {
        return fail(material_file.error());
    }
    const Result<Found> dialect_file = find_profile(roots, "dialects", setup.machine.dialect);
    if (!dialect_file) {
        return fail(dialect_file.error());
    }
    setup.material.name = material_file->name;
    setup.machine.process.material = material_file->name;
    setup.dialect.name = dialect_file->name;
    read = read_into(fields, File::Material, material_file->path)
               .and_then([&] { return read_into(fields, File::Dialect, dialect_file->path); })
               .and_then([&] { return apply_settings(fields, settings); });
    setup.machine.process.material = material_file->name;
    if (read) {
        read = check_consistency(setup, machine_file->path.string());
    }
    if (!read) {
        return fail(read.error());
    }
    setup.hash = hash_of(setup);
    return setup;
}

std::vector<std::string> list_machines() { return names_in(search_path(), "fdm"); }

}  // namespace cam::profile
