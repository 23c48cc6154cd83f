// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/brep/write_step.h"

#include "decomp/brep/canonical_detail.h"
#include "decomp/brep/kernel_detail.h"

namespace decomp::brep {

Result<StepSchema> parse_schema(std::string_view text) {
    if (text == "ap203") {
        return StepSchema::Ap203;
    }
    if (text == "ap214") {
        return StepSchema::Ap214;
    }
    if (text == "ap242") {
        return StepSchema::Ap242;
    }
    return fail("brep.schema", "there is no schema '" + std::string(text) + "'", "schema",
                "use ap203, ap214 or ap242");
}

Result<StepFile> write_step(const std::vector<StepBody>& bodies, const std::string& title,
                            StepSchema schema, const Run& run) {
    const auto loaded = kernel();
    if (!loaded) {
        return fail(loaded.error());
    }
    auto file = (*loaded)->write(bodies, title, schema, run);
    if (file) {
        file->text = canonical_step(file->text);
    }
    return file;
}

}  // namespace decomp::brep
