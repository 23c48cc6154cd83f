// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/file.h"
#include "decomp/base/hash.h"
#include "decomp/io/write_mesh.h"
#include "tests/support/run_program.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tests {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Runs `hew` with these words.
inline Finished hew(std::vector<std::string> words, std::optional<Kill> kill = std::nullopt) {
    words.insert(words.begin(), HEW_PROGRAM);
    return run_program(std::move(words), kill);
}

/// stdout as exactly one JSON object.
inline Json object_of(const Finished& finished) {
    const Json json = Json::parse(finished.out, nullptr, false);
    EXPECT_TRUE(json.is_object()) << finished.out << finished.err;
    return json;
}

/// A box with a corner at the origin, mm.
inline decomp::mesh::TriMesh block(double x, double y, double z) {
    return box({0, 0, 0}, {x, y, z});
}

inline std::string write_stl(const TempDir& dir, const std::string& name,
                             const decomp::mesh::TriMesh& mesh) {
    const fs::path path = dir / name;
    EXPECT_TRUE(decomp::write_file(path, decomp::io::stl_bytes(mesh), decomp::Overwrite::Allow));
    return path.string();
}

/// Hashes of all files of a directory but timings.json.
inline std::map<std::string, std::string> contents(const fs::path& directory) {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::recursive_directory_iterator(directory)) {
        const std::string name = fs::relative(entry.path(), directory).string();
        if (entry.is_regular_file() && name != "timings.json") {
            out[name] = decomp::sha256_hex(*decomp::read_file(entry.path()));
        }
    }
    return out;
}

/// A coarse process, so that whole jobs take a moment.
inline std::vector<std::string> quick_make(const std::string& model, const fs::path& out) {
    return {"make",      model,
            "--machine", "prusa-mk3s",
            "-o",        out.string(),
            "--set",     "process.layer_height_mm=0.3",
            "--set",     "process.infill_density=0.05"};
}

inline std::vector<std::string> with(std::vector<std::string> words,
                                     const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

}  // namespace tests
