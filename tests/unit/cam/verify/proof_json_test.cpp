// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/proof_json.h"

#include "tests/unit/cam/verify/print_box.h"

#include <gtest/gtest.h>

namespace {

using namespace cam::verify;
using tests::print_box;

ProofRecord record_of_box(const std::string& program) {
    const tests::BoxPrint print;
    cam::profile::FdmSetup setup = tests::proof_setup();
    setup.hash = std::string(64, 'a');
    auto proof = examine(program, {box_part(print)}, setup, {}, {});
    return proof_record(program, {box_part(print)}, setup, proof ? *proof : Proof{});
}

TEST(ProofJson, ComesBackAsItWasWritten) {
    const std::string program = print_box({}).text;
    ProofRecord record = record_of_box(program);
    record.proof.faults.push_back({"proof.flow", 12, 3, "a \"quoted\" sentence"});
    record.proof.notes.emplace_back("a note");
    const std::string text = proof_json(record);
    const auto back = read_proof_json(text);
    ASSERT_TRUE(back.has_value()) << back.error().text();
    EXPECT_EQ(proof_json(*back), text);
    EXPECT_EQ(back->program_sha256, record.program_sha256);
    EXPECT_EQ(back->parts.at(0).id, "P01");
    EXPECT_EQ(back->proof.faults.at(0).text, "a \"quoted\" sentence");
    EXPECT_FALSE(back->proof.passed());
}

TEST(ProofJson, AcceptsOnlyTheBytesAndTheProfileThatWereProved) {
    const std::string program = print_box({}).text;
    const ProofRecord record = record_of_box(program);
    const std::string profile(64, 'a');
    EXPECT_TRUE(accept(record, program, profile).has_value());
    EXPECT_EQ(accept(record, program + "\n", profile).error().code, "proof.stale");
    EXPECT_EQ(accept(record, program, std::string(64, 'b')).error().code, "proof.stale");
    ProofRecord failed = record;
    failed.proof.faults.push_back({"proof.flow", 1, 0, "too fast"});
    EXPECT_EQ(accept(failed, program, profile).error().code, "proof.failed");
}

TEST(ProofJson, RefusesWhatIsNoSidecar) {
    const std::string good = proof_json(record_of_box(print_box({}).text));
    std::string other = good;
    other.replace(other.find("hew.proof/1"), 11, "hew.proof/9");
    std::string lie = good;
    lie.replace(lie.find("\"passed\": true"), 14, "\"passed\": false");
    for (const std::string& text : {std::string(), std::string("{}"), std::string("[1, 2"), other,
                                    lie, good.substr(0, good.size() / 2)}) {
        const auto read = read_proof_json(text);
        ASSERT_FALSE(read.has_value());
        EXPECT_EQ(read.error().code, "proof.bad_sidecar");
    }
}

TEST(ProofJson, AMeshHashFollowsEveryBitOfTheMesh) {
    decomp::mesh::TriMesh mesh = tests::box({0, 0, 0}, {1, 2, 3});
    const std::string hash = mesh_hash(mesh);
    EXPECT_EQ(mesh_hash(mesh), hash);
    mesh.points[3].x() = std::nextafter(mesh.points[3].x(), 10.0);
    EXPECT_NE(mesh_hash(mesh), hash);
}

}  // namespace
