// SPDX-License-Identifier: GPL-3.0-or-later
// Arbitrary bytes as a machine, a material and a dialect profile, and as a template.
#include "cam/profile/read_toml.h"
#include "cam/profile/template.h"

#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace cam::profile;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    for (const File file : {File::Machine, File::Material, File::Dialect}) {
        FdmSetup setup;
        auto fields = fields_of(setup);
        if (read_toml(fields, file, text, "fuzz.toml")) {
            (void)inconsistencies(setup);
        }
    }
    const TemplateValues values = {{"bed_c", 60.0}, {"name", std::string("part")}};
    (void)expand(text, values);
    (void)template_fault(text, {Scope::Program, Scope::Layer});
    return 0;
}
