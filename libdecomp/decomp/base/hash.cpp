// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/base/hash.h"

#include "decomp/base/assert.h"

#include <openssl/evp.h>

#include <array>

namespace decomp {

std::string sha256_hex(std::string_view bytes) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int length = 0;
    DECOMP_ASSERT(
        EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) == 1);
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string out;
    out.reserve(std::size_t{2} * length);
    for (unsigned int i = 0; i < length; ++i) {
        out += kDigits[digest.at(i) >> 4U];
        out += kDigits[digest.at(i) & 15U];
    }
    return out;
}

}  // namespace decomp
