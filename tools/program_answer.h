// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/verify/verify.h"
#include "tools/verb.h"

namespace tools {

/// A proof for people and for --json; exit code 5 when it failed.
[[nodiscard]] Answer proof_answer(const cam::verify::Proof& proof);

}  // namespace tools
