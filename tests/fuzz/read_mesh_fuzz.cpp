// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/brep/read_brep.h"
#include "decomp/io/read_mesh.h"

#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace {

/// What every reader promises of a mesh that it returns.
void expect_sound(const decomp::mesh::TriMesh& mesh) {
    for (const auto& point : mesh.points) {
        if (!point.allFinite()) {
            std::abort();
        }
    }
    for (const auto& triangle : mesh.triangles) {
        for (const auto corner : triangle) {
            if (corner >= mesh.points.size()) {
                std::abort();
            }
        }
    }
}

}  // namespace

// Every format known by its content, and as STL and OBJ what is known by its name only. Packages
// (3MF) are lib3mf's business and solids (STEP, BREP) the geometry kernel's: both are left out.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    if (bytes.starts_with("PK") || decomp::brep::kind_of(bytes)) {
        return 0;
    }
    for (const char* name : {"a.stl", "a.obj"}) {
        const auto mesh = decomp::io::parse_mesh(bytes, name, {}, decomp::Run{});
        if (mesh) {
            expect_sound(*mesh);
        } else if (mesh.error().code.empty() || mesh.error().where.empty()) {
            std::abort();
        }
    }
    return 0;
}
