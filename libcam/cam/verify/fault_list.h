// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/verify/verify.h"

#include <string>
#include <vector>

namespace cam::verify {

/// Gathers faults: in the order of their lines, a handful per code, the rest counted in a note.
class FaultList {
  public:
    void add(Fault fault) { faults_.push_back(std::move(fault)); }

    /// Moves everything into the proof.
    void close(Proof& proof);

  private:
    std::vector<Fault> faults_;
};

}  // namespace cam::verify
