// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/verify/fault_list.h"

#include "cam/verify/limits.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace cam::verify {

void FaultList::close(Proof& proof) {
    std::stable_sort(faults_.begin(), faults_.end(), [](const Fault& a, const Fault& b) {
        return std::tie(a.line, a.layer, a.code) < std::tie(b.line, b.layer, b.code);
    });
    std::map<std::string, int> seen;
    for (Fault& fault : faults_) {
        if (++seen[fault.code] <= limits::kFaultsPerCode) {
            proof.faults.push_back(std::move(fault));
        }
    }
    for (const auto& [code, count] : seen) {
        if (count > limits::kFaultsPerCode) {
            proof.notes.push_back(std::to_string(count - limits::kFaultsPerCode) +
                                  " further faults " + code);
        }
    }
    faults_.clear();
}

}  // namespace cam::verify
