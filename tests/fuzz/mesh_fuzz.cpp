// SPDX-License-Identifier: GPL-3.0-or-later
// Arbitrary bytes as a mesh file of any format, and as a part. What is read holds together: indices
// in range, coordinates finite; and what is written of it reads back the same.
#include "decomp/io/part_ply.h"
#include "decomp/io/read_mesh.h"
#include "decomp/io/write_mesh.h"

#include <cstdint>
#include <string_view>

namespace {

void demand(bool condition) {
    if (!condition) {
        __builtin_trap();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const decomp::Run run;
    for (const char* name : {"a.stl", "a.obj"}) {
        const auto mesh = decomp::io::parse_mesh(bytes, name, {}, run);
        if (!mesh) {
            demand(!mesh.error().code.empty());
            continue;
        }
        demand(!mesh->triangles.empty());
        for (const auto& triangle : mesh->triangles) {
            for (const auto corner : triangle) {
                demand(corner < mesh->points.size());
            }
        }
        for (const auto& point : mesh->points) {
            demand(point.allFinite());
        }
        const auto again = decomp::io::parse_mesh(decomp::io::ply_bytes(*mesh), "a.ply", {}, run);
        demand(again && again->points == mesh->points && again->triangles == mesh->triangles);
    }
    if (const auto part = decomp::io::parse_part_ply(bytes, "P01.ply")) {
        demand(part->sources.size() == part->mesh.triangles.size());
    }
    return 0;
}
