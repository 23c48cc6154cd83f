// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/fields.h"
#include "cam/profile/template.h"
#include "decomp/base/nearest.h"
#include "decomp/base/number.h"

#include <algorithm>

namespace cam::profile {

namespace {

class Check {
  public:
    void must(bool holds, std::string sentence) {
        if (!holds) {
            faults_.push_back(std::move(sentence));
        }
    }

    void must_expand(const char* key, const std::string& text, const std::vector<Scope>& scopes) {
        if (const std::optional<decomp::Error> error = template_fault(text, scopes)) {
            faults_.push_back(std::string(key) + ": " + error->message +
                              (error->hint.empty() ? "" : "; " + error->hint));
        }
    }

    void must_be_allowed(const char* key, const std::string& text, const Dialect& dialect) {
        if (const std::optional<ForbiddenWord> word = first_forbidden_word(text, dialect)) {
            faults_.push_back(std::string(key) + ": line " + std::to_string(word->line) + " has " +
                              word->word + ", which the dialect " + dialect.name + " forbids");
        }
    }

    [[nodiscard]] std::vector<std::string> faults() && { return std::move(faults_); }

  private:
    std::vector<std::string> faults_;
};

void check_sizes(Check& check, const FdmMachine& machine) {
    const FdmMachine::Process& process = machine.process;
    const double side_mm = 2 * machine.chamber.margin_mm;
    const Eigen::Vector3d size = machine.chamber.max_mm - machine.chamber.min_mm;
    check.must(size.x() > side_mm && size.y() > side_mm && size.z() > machine.chamber.margin_mm,
               "chamber.max_mm must be above chamber.min_mm by more than the margins");
    const double bore_mm = machine.nozzle.diameter_mm;
    check.must(
        process.layer_height_mm <= bore_mm && process.first_layer_height_mm <= bore_mm,
        "layers of " +
            decomp::decimal(std::max(process.layer_height_mm, process.first_layer_height_mm), 3) +
            " mm are higher than the nozzle is wide (" + decomp::decimal(bore_mm, 3) + " mm)");
    check.must(process.line_width_mm > process.layer_height_mm,
               "process.line_width_mm must be above process.layer_height_mm");
    check.must(process.first_layer_line_width_mm > process.first_layer_height_mm,
               "process.first_layer_line_width_mm must be above process.first_layer_height_mm");
    check.must(
        process.line_width_mm <= 3 * bore_mm && process.first_layer_line_width_mm <= 3 * bore_mm,
        "line widths must be at most three times the nozzle's diameter");
}

void check_choices(Check& check, const FdmMachine::Process& process) {
    const auto one_of = [&](const char* key, const std::string& value,
                            const std::vector<std::string>& known) {
        if (std::find(known.begin(), known.end(), value) == known.end()) {
            check.must(false, std::string(key) + ": there is no '" + value + "'; " +
                                  decomp::did_you_mean(value, known));
        }
    };
    one_of("process.infill_pattern", process.infill_pattern,
           {"grid", "rectilinear", "gyroid", "cubic", "concentric"});
    one_of("process.seam", process.seam, {"hidden", "aligned", "rear", "nearest"});
}

void check_heat(Check& check, const FdmMachine& machine, const Material& material) {
    const double hottest = std::max(material.nozzle_celsius, material.first_layer_nozzle_celsius);
    check.must(hottest <= machine.heaters.max_nozzle_celsius,
               "the material " + material.name + " wants a nozzle of " +
                   decomp::decimal(hottest, 1) + " degrees C, the machine allows " +
                   decomp::decimal(machine.heaters.max_nozzle_celsius, 1));
    check.must(material.bed_celsius <= machine.heaters.max_bed_celsius,
               "the material " + material.name + " wants a bed of " +
                   decomp::decimal(material.bed_celsius, 1) + " degrees C, the machine allows " +
                   decomp::decimal(machine.heaters.max_bed_celsius, 1));
}

void check_words(Check& check, const FdmSetup& setup) {
    const Dialect& dialect = setup.dialect;
    const FdmMachine::Templates& templates = setup.machine.templates;
    for (const char axis : std::string("XYZE")) {
        check.must(
            dialect.max_axes.find(axis) != std::string::npos,
            "the dialect " + dialect.name + " cannot speak of the axis " + std::string(1, axis));
    }
    check.must(!dialect.comment.empty(), "dialect.comment must not be empty");
    check.must(dialect.fan_on.empty() == dialect.fan_off.empty(),
               "dialect.fan_on and dialect.fan_off go together");
    check.must(setup.material.fan_fraction == 0 || !dialect.fan_on.empty(),
               "the material " + setup.material.name + " wants a fan, the dialect " + dialect.name +
                   " has none");
    check.must_expand("templates.start", templates.start, {Scope::Program});
    check.must_expand("templates.layer", templates.layer, {Scope::Program, Scope::Layer});
    check.must_expand("templates.end", templates.end, {Scope::Program});
    check.must_expand("dialect.fan_on", dialect.fan_on, {Scope::Fan});
    check.must_expand("dialect.fan_off", dialect.fan_off, {Scope::Fan});
    check.must_expand("dialect.set_nozzle", dialect.set_nozzle, {Scope::Heater});
    check.must_expand("dialect.set_bed", dialect.set_bed, {Scope::Heater});
    check.must(dialect.relative_e || !dialect.reset_e.empty(),
               "dialect.reset_e is needed unless dialect.relative_e");
    check.must_expand("dialect.reset_e", dialect.reset_e, {Scope::Position});
    check.must_expand("dialect.dwell", dialect.dwell, {Scope::Dwell});
    check.must_expand("dialect.progress", dialect.progress, {Scope::Progress});
    check.must_be_allowed("templates.start", templates.start, dialect);
    check.must_be_allowed("templates.layer", templates.layer, dialect);
    check.must_be_allowed("templates.end", templates.end, dialect);
}

}  // namespace

std::vector<std::string> inconsistencies(const FdmSetup& setup) {
    Check check;
    check_sizes(check, setup.machine);
    check_choices(check, setup.machine.process);
    check_heat(check, setup.machine, setup.material);
    check_words(check, setup);
    const FdmMachine::Converter& converter = setup.machine.converter;
    check.must(
        converter.program.empty() || (converter.arguments.find("{in}") != std::string::npos &&
                                      converter.arguments.find("{out}") != std::string::npos &&
                                      !converter.extension.empty()),
        "converter.arguments must name {in} and {out}, and converter.extension must be given");
    return std::move(check).faults();
}

}  // namespace cam::profile
