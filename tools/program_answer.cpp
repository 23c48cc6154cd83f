// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/program_answer.h"

#include "decomp/base/number.h"
#include "tools/exit_code.h"

#include <algorithm>

namespace tools {

namespace {

constexpr std::size_t kFaultsPrinted = 20;

Json figures_json(const cam::verify::Figures& figures) {
    return {{"lines", figures.lines},
            {"layers", figures.layers},
            {"filament_mm", figures.filament_mm},
            {"extruded_mm3", figures.extruded_mm3},
            {"max_flow_mm3_per_s", figures.max_flow_mm3_per_s},
            {"out_of_part_percent", figures.out_of_part_percent},
            {"uncovered_skin_percent", figures.uncovered_skin_percent},
            {"worst_layer_uncovered_percent", figures.worst_layer_uncovered_percent},
            {"solid_fill_ratio", figures.solid_fill_ratio},
            {"floating_islands", figures.floating_islands},
            {"moves_below_printed", figures.moves_below_printed},
            {"moves_outside_chamber", figures.moves_outside_chamber},
            {"blob_mm3", figures.blob_mm3}};
}

std::string fault_text(const cam::verify::Fault& fault) {
    std::string where;
    if (fault.line > 0) {
        where += "line " + std::to_string(fault.line) + ": ";
    }
    if (fault.layer >= 0) {
        where += "layer " + std::to_string(fault.layer) + ": ";
    }
    return where + fault.text + " [" + fault.code + "]";
}

}  // namespace

Answer proof_answer(const cam::verify::Proof& proof) {
    Answer answer;
    answer.exit_code = proof.passed() ? kOk : kProofFailed;
    answer.json["passed"] = proof.passed();
    answer.json["faults"] = Json::array();
    for (const cam::verify::Fault& fault : proof.faults) {
        answer.json["faults"].push_back({{"code", fault.code},
                                         {"line", fault.line},
                                         {"layer", fault.layer},
                                         {"text", fault.text}});
    }
    answer.json["notes"] = proof.notes;
    answer.json["figures"] = figures_json(proof.figures);
    const cam::verify::Figures& figures = proof.figures;
    answer.text =
        (proof.passed() ? "proved: "
                        : "NOT PROVED, " + std::to_string(proof.faults.size()) + " faults: ") +
        std::to_string(figures.layers) + " layers, outside the part " +
        decomp::decimal(figures.out_of_part_percent, 3) + " %, skin uncovered " +
        decomp::decimal(figures.uncovered_skin_percent, 3) + " %, flow at most " +
        decomp::decimal(figures.max_flow_mm3_per_s, 2) + " mm3/s\n";
    for (std::size_t i = 0; i < std::min(kFaultsPrinted, proof.faults.size()); ++i) {
        answer.text += "  " + fault_text(proof.faults[i]) + "\n";
    }
    if (proof.faults.size() > kFaultsPrinted) {
        answer.text += "  and " + std::to_string(proof.faults.size() - kFaultsPrinted) +
                       " more; --json lists all\n";
    }
    return answer;
}

}  // namespace tools
