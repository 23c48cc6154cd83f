// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/hash.h"

#include <gtest/gtest.h>

namespace {

TEST(Hash, AgreesWithTheExampleOfFips180) {
    EXPECT_EQ(decomp::sha256_hex("abc"),
              "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
