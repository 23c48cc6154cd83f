// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/millproof/prove.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cam::millproof {

/// Raised whenever a checker of the same inputs may judge otherwise.
inline constexpr int kMillCheckerVersion = 2;

/// The text of the sidecar `PROGRAM.proof.json` of a milling program (schema "hew.millproof/1",
/// docs/formats.md): hashes of program, part and profile, options, figures, faults. Same proof,
/// same bytes.
[[nodiscard]] std::string proof_json(const MillProof& proof, std::string_view program,
                                     const MillJob& job, const ProofOptions& options,
                                     std::string_view profile_sha256);

/// What a sidecar states, as far as somebody who wants to run the program must know it.
struct MillRecord {
    int checker = 0;
    bool passed = false;
    std::size_t faults = 0;
    std::string program_sha256;
    std::string profile_sha256;
    std::vector<std::string> tools;  ///< names, in the order of their numbers
};

/// Whether a sidecar is one of these, and not of a printing program.
[[nodiscard]] bool is_mill_record(std::string_view text);

/// @error proof.bad_sidecar (no JSON, another schema, a key missing or of the wrong kind)
[[nodiscard]] decomp::Result<MillRecord> read_proof_json(std::string_view text);

/// Whether the sidecar holds for these bytes and this profile, by this checker, and passed.
/// @error proof.stale (what differs), proof.failed
[[nodiscard]] decomp::Status accept(const MillRecord& record, std::string_view program,
                                    std::string_view profile_sha256);

/// The stock that remains, coloured by what stands on the part or is missing of it.
struct DeviationMesh {
    decomp::mesh::TriMesh mesh;
    std::vector<std::array<std::uint8_t, 3>> colours;  ///< one a triangle
};

/// Grey for no number, green within a tenth of `range_mm`, to red where stock is left, to blue
/// where the part is cut.
[[nodiscard]] std::array<std::uint8_t, 3> deviation_colour(double deviation_mm, double range_mm);

/// Two triangles for each square of cells; grey where no part lies below, green within a tenth of
/// `range_mm`, to red where stock is left, to blue where the part is cut. `step` cells make a
/// square.
[[nodiscard]] DeviationMesh deviation_mesh(const StockMap& stock, const MillJob& job,
                                           double range_mm, int step = 1);

/// The mesh as binary PLY with a colour for each face.
[[nodiscard]] std::string deviation_ply(const DeviationMesh& mesh);

}  // namespace cam::millproof
