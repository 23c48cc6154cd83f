// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/verify/verify.h"

#include <string>
#include <string_view>
#include <vector>

namespace cam::verify {

/// Raised whenever a checker of the same inputs may judge otherwise.
inline constexpr int kCheckerVersion = 2;

/// A placed part by the hash of its mesh.
struct PartHash {
    std::string id;
    std::string sha256;
};

/// What the sidecar `PROGRAM.proof.json` states (schema "hew.proof/1", docs/formats.md).
struct ProofRecord {
    int checker = kCheckerVersion;
    std::string program_sha256;
    std::string profile_sha256;
    std::vector<PartHash> parts;
    Proof proof;
};

/// SHA-256 of a mesh: its counts, then points as little-endian doubles, then indices. Independent
/// of any file format.
[[nodiscard]] std::string mesh_hash(const decomp::mesh::TriMesh& mesh);

/// The record of a proof of this program. O(bytes).
[[nodiscard]] ProofRecord proof_record(std::string_view program,
                                       const std::vector<PlacedPart>& parts,
                                       const profile::FdmSetup& setup, Proof proof);

/// The text of the sidecar: fixed order of keys, figures at fixed decimals, one line a fault.
[[nodiscard]] std::string proof_json(const ProofRecord& record);

/// Reads a sidecar. Figures come back at their printed decimals.
/// @error proof.bad_sidecar (no JSON, another schema, a key missing or of the wrong kind)
[[nodiscard]] decomp::Result<ProofRecord> read_proof_json(std::string_view text);

/// Whether the sidecar holds for these bytes and this profile, by this checker, and passed.
/// @error proof.stale (what differs), proof.failed
[[nodiscard]] decomp::Status accept(const ProofRecord& record, std::string_view program,
                                    std::string_view profile_sha256);

}  // namespace cam::verify
