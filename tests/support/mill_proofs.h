// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/millproof/prove.h"
#include "cam/post/post_mill.h"
#include "tests/support/mill_programs.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tests {

inline void add_quad(decomp::mesh::TriMesh& mesh, Eigen::Vector3d a, Eigen::Vector3d b,
                     Eigen::Vector3d c, Eigen::Vector3d d) {
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), {a, b, c, d});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
}

/// The plate of plate_stock() with a pocket from (8, 8) to (32, 22), 4 mm deep, corners sharp.
inline decomp::mesh::TriMesh pocket_part() {
    decomp::mesh::TriMesh mesh;
    const Eigen::Vector2d out[] = {{0, 0}, {40, 0}, {40, 30}, {0, 30}};
    const Eigen::Vector2d in[] = {{8, 8}, {32, 8}, {32, 22}, {8, 22}};
    const auto at = [](const Eigen::Vector2d& p, double z) {
        return Eigen::Vector3d(p.x(), p.y(), z);
    };
    for (int i = 0; i < 4; ++i) {
        const int j = (i + 1) % 4;
        add_quad(mesh, at(out[i], 0), at(out[j], 0), at(in[j], 0), at(in[i], 0));
        add_quad(mesh, at(out[i], -10), at(out[j], -10), at(out[j], 0), at(out[i], 0));
        add_quad(mesh, at(in[j], -4), at(in[i], -4), at(in[i], 0), at(in[j], 0));
    }
    add_quad(mesh, at(in[0], -4), at(in[1], -4), at(in[2], -4), at(in[3], -4));
    add_quad(mesh, at(out[3], -10), at(out[2], -10), at(out[1], -10), at(out[0], -10));
    return mesh;
}

inline cam::profile::MillSetup mill_setup(const std::string& dialect = "linuxcnc") {
    return cam::profile::read_mill_setup("linuxcnc-router-3axis", {},
                                         {"machine.dialect=" + dialect})
        .value();
}

/// The job of the pocket: tool 1, flat, 6 mm.
inline cam::millproof::MillJob pocket_job(const decomp::mesh::TriMesh& part,
                                          const std::string& dialect = "linuxcnc") {
    const cam::profile::MillSetup setup = mill_setup(dialect);
    cam::millproof::MillJob job;
    job.part = &part;
    job.stock = plate_stock();
    job.safe_z = 5;
    job.floor_z = -10;
    job.tools = {{flat_mill(1, 6), 800}};
    job.machine = setup.machine;
    job.dialect = setup.dialect;
    return job;
}

inline std::string text_of(const cam::path::MillProgram& program,
                           const std::string& dialect = "linuxcnc") {
    auto text = cam::post::post_mill(program, {flat_mill(1, 6), ball_mill(2, 6)},
                                     mill_setup(dialect), "plate");
    EXPECT_TRUE(text) << text.error().text();
    return text ? *text : std::string();
}

/// The first fault of a kind; a fault without kind when there is none.
inline cam::millproof::Fault fault_of(const cam::millproof::MillProof& proof,
                                      const std::string& kind) {
    for (const auto& fault : proof.faults) {
        if (fault.kind == kind) {
            return fault;
        }
    }
    return {};
}

inline std::string words_of(const cam::millproof::MillProof& proof) {
    std::string out;
    for (const auto& fault : proof.faults) {
        out += fault.kind + " in line " + std::to_string(fault.line) + ": " + fault.what + "\n";
    }
    return out;
}

/// Number of the line that holds this text, the `which`-th such line; 0: none.
inline long line_with(const std::string& text, const std::string& what, int which = 1) {
    long line = 1;
    std::size_t begin = 0;
    while (begin < text.size()) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        if (text.substr(begin, end - begin).find(what) != std::string::npos && --which == 0) {
            return line;
        }
        begin = end + 1;
        ++line;
    }
    return 0;
}

}  // namespace tests
