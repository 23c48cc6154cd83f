// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/millproof/record.h"

#include "tests/support/mill_proofs.h"

#include <gtest/gtest.h>

namespace {

using namespace cam::millproof;

TEST(MillRecord, TheSidecarNamesHashesFiguresAndFaults) {
    const auto part = tests::pocket_part();
    const MillJob job = tests::pocket_job(part);
    const std::string text = tests::text_of(tests::pocket_program());
    const MillProof sound = prove(text, job, {}).value();
    const std::string json = proof_json(sound, text, job, {}, "abc");
    EXPECT_NE(json.find("\"schema\": \"hew.millproof/1\""), std::string::npos);
    EXPECT_NE(json.find("\"passed\": true"), std::string::npos);
    EXPECT_EQ(json, proof_json(prove(text, job, {}).value(), text, job, {}, "abc"));
    const MillProof broken = prove(text + "G20\n", job, {}).value();
    EXPECT_NE(json, proof_json(broken, text + "G20\n", job, {}, "abc"));
}

TEST(MillRecord, ASidecarIsAcceptedForItsBytesProfileAndCheckerAndWhenItPassedAlone) {
    const auto part = tests::pocket_part();
    const MillJob job = tests::pocket_job(part);
    const std::string text = tests::text_of(tests::pocket_program());
    const std::string json = proof_json(prove(text, job, {}).value(), text, job, {}, "abc");
    ASSERT_TRUE(is_mill_record(json));
    const auto record = read_proof_json(json);
    ASSERT_TRUE(record) << record.error().text();
    ASSERT_EQ(record->tools.size(), job.tools.size());
    EXPECT_EQ(record->tools[0], job.tools[0].tool.name);
    EXPECT_TRUE(accept(*record, text, "abc"));
    EXPECT_EQ(accept(*record, text + " ", "abc").error().code, "proof.stale");
    EXPECT_EQ(accept(*record, text, "abd").error().code, "proof.stale");
    MillRecord older = *record;
    --older.checker;
    EXPECT_EQ(accept(older, text, "abc").error().code, "proof.stale");
    std::string inches = text;
    inches.replace(inches.find("G21"), 3, "G20");
    const auto failed =
        read_proof_json(proof_json(prove(inches, job, {}).value(), inches, job, {}, "abc"));
    ASSERT_TRUE(failed);
    EXPECT_EQ(accept(*failed, inches, "abc").error().code, "proof.failed");
}

TEST(MillRecord, ABrokenSidecarIsAnError) {
    const auto part = tests::pocket_part();
    const MillJob job = tests::pocket_job(part);
    const std::string text = tests::text_of(tests::pocket_program());
    const std::string json = proof_json(prove(text, job, {}).value(), text, job, {}, "abc");
    std::string lying = json;
    lying.replace(lying.find("true"), 4, "false");
    std::string other = json;
    other.replace(other.find("millproof"), 9, "proof");
    for (const std::string& bad : {lying, other, json.substr(0, json.size() / 2), std::string()}) {
        const auto read = read_proof_json(bad);
        ASSERT_FALSE(read);
        EXPECT_EQ(read.error().code, "proof.bad_sidecar");
    }
    EXPECT_FALSE(is_mill_record(other));
    EXPECT_FALSE(is_mill_record(""));
}

TEST(MillRecord, TheStockIsGreenWhereItIsRightRedWhereItStandsBlueWhereItIsCut) {
    const auto part = tests::pocket_part();
    const MillJob job = tests::pocket_job(part);
    MillProof proof = prove(tests::text_of(tests::pocket_program()), job, {}).value();
    const auto share = [&](int channel) {
        const DeviationMesh mesh = deviation_mesh(proof.stock, job, 0.5);
        long strong = 0;
        for (const auto& c : mesh.colours) {
            const int other = channel == 0 ? 2 : 0;
            strong +=
                c[static_cast<std::size_t>(channel)] > 100 &&
                c[static_cast<std::size_t>(channel)] > c[static_cast<std::size_t>(other)] + 60;
        }
        return static_cast<double>(strong) / static_cast<double>(mesh.colours.size());
    };
    EXPECT_LT(share(0), 0.02);
    EXPECT_EQ(share(2), 0);
    for (float& z : proof.stock.height) {
        z -= 1;
    }
    EXPECT_GT(share(2), 0.9);
    for (float& z : proof.stock.height) {
        z += 2;
    }
    EXPECT_GT(share(0), 0.9);
    const std::string ply = deviation_ply(deviation_mesh(proof.stock, job, 0.5, 2));
    EXPECT_EQ(ply.substr(0, 4), "ply\n");
    EXPECT_NE(ply.find("property uchar red"), std::string::npos);
}

}  // namespace
