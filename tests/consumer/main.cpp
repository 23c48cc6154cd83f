// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/path/layers.h"
#include "cam/render/render.h"
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"

#include <cstdio>

/// Measures a tetrahedron with libdecomp and draws it with libcam.
int main() {
    decomp::mesh::TriMesh mesh;
    mesh.points = {{0, 0, 0}, {6, 0, 0}, {0, 6, 0}, {0, 0, 6}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const bool measured =
        decomp::mesh::check_topology(mesh).manifold() && decomp::mesh::volume_mm3(mesh) == 36;

    cam::render::Item item;
    item.mesh = &mesh;
    decomp::Run run;
    const auto picture = cam::render::render_meshes_png({item}, {}, run);
    std::printf("measured: %d, drawn: %d, feature: %s\n", measured ? 1 : 0, picture ? 1 : 0,
                cam::path::feature_name(cam::path::Feature::OuterWall));
    return measured && picture ? 0 : 1;
}
