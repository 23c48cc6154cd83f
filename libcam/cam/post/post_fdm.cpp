// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/post/post_fdm.h"

#include "cam/motion/cooling.h"
#include "cam/motion/estimate.h"
#include "cam/motion/moves.h"
#include "cam/post/gcode_writer.h"
#include "cam/profile/template.h"
#include "decomp/base/number.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

namespace cam::post {

using decomp::fail;
using decomp::Result;
using decomp::Status;

namespace {

/// Coordinates are compared with the chamber after rounding to this, far below any decimal that is
/// printed.
constexpr double kChamberSlackMm = 1e-6;

std::string clock_text(double seconds) {
    const auto whole = static_cast<long>(std::llround(seconds));
    std::string out;
    if (whole >= 3600) {
        out += std::to_string(whole / 3600) + "h ";
    }
    if (whole >= 60) {
        out += std::to_string(whole / 60 % 60) + "m ";
    }
    return out + std::to_string(whole % 60) + "s";
}

/// What may stand in a comment and in parentheses: one line of printable characters.
std::string one_line(const std::string& text) {
    std::string out = text;
    for (char& c : out) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7F || c == '(' || c == ')' || c == ';') {
            c = ' ';
        }
    }
    return out;
}

Status check_layer(const path::Layer& layer, double below_mm, const std::string& where) {
    if (!std::isfinite(layer.z_mm) || layer.z_mm <= below_mm) {
        return fail("post.bad_layer", "the layer is not above the one before", where);
    }
    for (const path::Bead& bead : layer.beads) {
        const double area_mm2 = path::bead_area_mm2(bead.width_mm, bead.height_mm);
        if (!std::isfinite(area_mm2) || area_mm2 <= 0 || !(bead.speed.mm_per_s() > 0) ||
            !std::isfinite(bead.speed.mm_per_s())) {
            return fail("post.bad_layer",
                        std::string("a bead of ") + feature_name(bead.feature) +
                            " has no cross-section or no speed",
                        where);
        }
        for (const Eigen::Vector2d& point : bead.points) {
            if (!point.allFinite()) {
                return fail("post.bad_layer", "a coordinate is no number", where);
            }
        }
    }
    return {};
}

Status check_in_chamber(const Eigen::AlignedBox3d& beads, const profile::FdmMachine& machine) {
    for (int axis = 0; axis < 3; ++axis) {
        const double low = machine.chamber.min_mm[axis];
        const double high = machine.chamber.max_mm[axis];
        const bool below = beads.min()[axis] < low - kChamberSlackMm;
        if (below || beads.max()[axis] > high + kChamberSlackMm) {
            const double value = below ? beads.min()[axis] : beads.max()[axis];
            return fail(
                "post.outside_chamber",
                std::string("the nozzle would go to ") + "XYZ"[axis] + decomp::shortest(value) +
                    ", outside " + decomp::decimal(low, 3) + " .. " + decomp::decimal(high, 3),
                machine.name, "place the part inside the chamber, or choose a bigger machine");
        }
    }
    return {};
}

Result<Eigen::AlignedBox3d> bounds_of(const path::LayerStack& stack) {
    Eigen::AlignedBox3d box;
    double below_mm = 0;
    for (std::size_t i = 0; i < stack.layers.size(); ++i) {
        const path::Layer& layer = stack.layers[i];
        const Status fine = check_layer(layer, below_mm, "layer " + std::to_string(i));
        if (!fine) {
            return fail(fine.error());
        }
        below_mm = layer.z_mm;
        for (const path::Bead& bead : layer.beads) {
            for (const Eigen::Vector2d& point : bead.points) {
                box.extend(Eigen::Vector3d(point.x(), point.y(), layer.z_mm));
            }
        }
    }
    if (box.isEmpty()) {
        return fail("post.empty", "there is nothing to print", {},
                    "is the part thinner than one bead?");
    }
    return box;
}

profile::TemplateValues program_values(const profile::FdmSetup& setup,
                                       const Eigen::AlignedBox3d& beads, std::size_t layer_count,
                                       const std::string& title) {
    const profile::FdmMachine& machine = setup.machine;
    return {
        {"title", title},
        {"material", setup.material.name},
        {"nozzle_celsius", setup.material.nozzle_celsius},
        {"first_layer_nozzle_celsius", setup.material.first_layer_nozzle_celsius},
        {"bed_celsius", setup.material.bed_celsius},
        {"nozzle_diameter_mm", machine.nozzle.diameter_mm},
        {"filament_diameter_mm", machine.nozzle.filament_diameter_mm},
        {"retraction_length_mm", machine.retraction.length_mm},
        {"travel_feed_mm_per_min", machine.process.travel_speed.mm_per_min()},
        {"first_layer_height_mm", machine.process.first_layer_height_mm},
        {"chamber_min_x_mm", machine.chamber.min_mm.x()},
        {"chamber_min_y_mm", machine.chamber.min_mm.y()},
        {"chamber_max_x_mm", machine.chamber.max_mm.x()},
        {"chamber_max_y_mm", machine.chamber.max_mm.y()},
        {"chamber_max_z_mm", machine.chamber.max_mm.z()},
        {"print_min_x_mm", beads.min().x()},
        {"print_min_y_mm", beads.min().y()},
        {"print_max_x_mm", beads.max().x()},
        {"print_max_y_mm", beads.max().y()},
        {"print_max_z_mm", beads.max().z()},
        {"layer_count", static_cast<double>(layer_count)},
    };
}

/// Writes one program; the first error is kept and reported at the end.
class Poster {
  public:
    Poster(const path::LayerStack& stack, const profile::FdmSetup& setup,
           const motion::Estimate& estimate, profile::TemplateValues values)
        : stack_(stack),
          setup_(setup),
          estimate_(estimate),
          values_(std::move(values)),
          writer_(setup.dialect),
          filament_known_(setup.dialect.relative_e) {}

    Result<std::string> write(const std::string& title, const decomp::Run& run) {
        header(title);
        template_text(setup_.machine.templates.start, values_);
        writer_.raw(setup_.dialect.relative_e ? "G21\nG90\nM83" : "G21\nG90\nM82");
        set_fan(0);
        writer_.forget();
        motion::trace(stack_, setup_, [&](const motion::Move& move) {
            if (!run.cancelled()) {
                print(move);
                progress(move);
            }
        });
        if (run.cancelled()) {
            return decomp::cancelled();
        }
        set_fan(0);
        template_text(setup_.machine.templates.end, values_);
        summary();
        if (error_) {
            return fail(*error_);
        }
        return std::move(writer_).take();
    }

  private:
    void template_text(const std::string& text, const profile::TemplateValues& values) {
        if (text.empty()) {
            return;
        }
        Result<std::string> expanded = profile::expand(text, values);
        if (expanded) {
            writer_.raw(*expanded);
        } else if (!error_) {
            error_ = std::move(expanded.error());
        }
    }

    void header(const std::string& title) {
        writer_.comment(" " + title + ", made by hew");
        writer_.comment(" machine: " + setup_.machine.name);
        writer_.comment(" material: " + setup_.material.name);
        writer_.comment("FLAVOR:" + setup_.dialect.name);
        writer_.comment("LAYER_COUNT:" + std::to_string(stack_.layers.size()));
        writer_.comment("TIME:" + decomp::decimal(estimate_.seconds, 0));
    }

    void summary() {
        writer_.comment(" filament used [mm] = " + decomp::fixed(estimate_.filament_mm, 1));
        writer_.comment(" filament used [g] = " + decomp::fixed(estimate_.filament_g, 2));
        if (estimate_.cost > 0) {
            writer_.comment(" filament cost = " + decomp::fixed(estimate_.cost, 2));
        }
        writer_.comment(" estimated printing time = " + clock_text(estimate_.seconds));
    }

    void set_fan(double fraction) {
        const profile::Dialect& dialect = setup_.dialect;
        const double speed = dialect.fan_is_on_off ? (fraction >= 0.5 ? 1.0 : 0.0) : fraction;
        if (fan_ == speed) {
            return;
        }
        fan_ = speed;
        template_text(speed > 0 ? dialect.fan_on : dialect.fan_off,
                      {{"fan_0_255", std::round(255 * speed)}, {"fan_fraction", speed}});
    }

    [[nodiscard]] static profile::TemplateValues position_values(const Eigen::Vector3d& at) {
        return {{"x_mm", at.x()}, {"y_mm", at.y()}, {"z_mm", at.z()}};
    }

    void reset_filament(const Eigen::Vector3d& at) {
        if (!setup_.dialect.relative_e) {
            template_text(setup_.dialect.reset_e, position_values(at));
            writer_.filament_was_reset();
        }
        filament_known_ = true;
    }

    void new_layer(const motion::Move& move) {
        const std::size_t index = move.layer;
        const path::Layer& layer = stack_.layers[index];
        writer_.comment("LAYER:" + std::to_string(index));
        writer_.comment("Z:" + decomp::decimal(layer.z_mm, 4));
        writer_.comment("HEIGHT:" + decomp::decimal(layer.height_mm, 4));
        bead_ = nullptr;
        if (index > 0) {
            reset_filament(move.to);
        }
        const profile::Material& material = setup_.material;
        if (index == 1 && material.nozzle_celsius != material.first_layer_nozzle_celsius) {
            template_text(setup_.dialect.set_nozzle, {{"celsius", material.nozzle_celsius}});
        }
        fan_runs_ = static_cast<long>(index) >= material.fan_from_layer;
        set_fan(fan_runs_ ? material.fan_fraction : 0);
        if (!setup_.machine.templates.layer.empty()) {
            profile::TemplateValues values = values_;
            values["layer"] = static_cast<double>(index);
            values["z_mm"] = layer.z_mm;
            values["height_mm"] = layer.height_mm;
            template_text(setup_.machine.templates.layer, values);
        }
    }

    /// Tells the progress where it changes in what the firmware is told. The first and the last
    /// hundredth belong to the templates: some firmwares begin and end the build there.
    void progress(const motion::Move& move) {
        const std::size_t piece = pieces_.piece_of(move);
        if (piece == piece_) {
            return;
        }
        for (; told_ < piece; ++told_) {
            seconds_ += estimate_.piece_seconds[told_];
        }
        piece_ = piece;
        const double share = estimate_.seconds > 0 ? seconds_ / estimate_.seconds : 0;
        const int percent = std::clamp(static_cast<int>(100 * share), 1, 99);
        const auto left = static_cast<int>(std::lround((estimate_.seconds - seconds_) / 60));
        if (percent == percent_ && left == minutes_left_) {
            return;
        }
        percent_ = percent;
        minutes_left_ = left;
        const profile::TemplateValues values = {{"percent", static_cast<double>(percent)},
                                                {"minutes_left", static_cast<double>(left)}};
        const Result<std::string> words = profile::expand(setup_.dialect.progress, values);
        if (!words || *words != progress_) {  // a dialect without minutes
            template_text(setup_.dialect.progress, values);
            progress_ = words ? *words : std::string();
        }
    }

    /// What hangs in the air is cooled harder.
    void blow_on(path::Feature feature) {
        const profile::Material& material = setup_.material;
        const bool in_air =
            feature == path::Feature::Bridge || feature == path::Feature::OverhangWall;
        if (fan_runs_ && material.bridge_fan_fraction > material.fan_fraction) {
            set_fan(in_air ? material.bridge_fan_fraction : material.fan_fraction);
        }
    }

    void describe(const path::Bead& bead) {
        if (bead_ == &bead) {
            return;
        }
        if (bead_ == nullptr || bead_->feature != bead.feature) {
            writer_.comment(std::string("TYPE:") + path::feature_name(bead.feature));
            blow_on(bead.feature);
        }
        if (bead_ == nullptr || bead_->width_mm != bead.width_mm) {
            writer_.comment("WIDTH:" + decomp::decimal(bead.width_mm, 4));
        }
        bead_ = &bead;
    }

    void print(const motion::Move& move) {
        switch (move.kind) {
            case motion::MoveKind::NewLayer:
                new_layer(move);
                break;
            case motion::MoveKind::Retract:
                // Absolute filament positions mean nothing until the first reset, at the first
                // bead.
                if (filament_known_) {
                    writer_.feed_filament(move.filament_mm, move.speed_mm_per_s);
                }
                break;
            case motion::MoveKind::Recover:
                if (filament_known_) {
                    writer_.feed_filament(move.filament_mm, move.speed_mm_per_s);
                } else {
                    reset_filament(move.to);
                }
                break;
            case motion::MoveKind::Wipe:
                writer_.move_xy(move.to.head<2>(), move.filament_mm, move.speed_mm_per_s);
                break;
            case motion::MoveKind::Pause:
                template_text(setup_.dialect.dwell,
                              {{"milliseconds", std::round(1000 * move.seconds)}});
                break;
            case motion::MoveKind::Raise:
            case motion::MoveKind::Lower:
                writer_.move_z(move.to.z(), move.speed_mm_per_s);
                break;
            case motion::MoveKind::Travel:
                writer_.move_xy(move.to.head<2>(), 0, move.speed_mm_per_s);
                break;
            case motion::MoveKind::Extrude:
                if (!filament_known_) {
                    reset_filament(Eigen::Vector3d(move.bead->points.front().x(),
                                                   move.bead->points.front().y(), move.to.z()));
                }
                describe(*move.bead);
                writer_.move_xy(move.to.head<2>(), move.filament_mm, move.speed_mm_per_s);
                break;
        }
    }

    const path::LayerStack& stack_;
    const profile::FdmSetup& setup_;
    const motion::Estimate& estimate_;
    profile::TemplateValues values_;
    GcodeWriter writer_;
    const path::Bead* bead_ = nullptr;  ///< the last one described in this layer
    bool fan_runs_ = false;             ///< in the layer at hand
    double fan_ = -1;                   ///< unknown after the start template
    bool filament_known_;               ///< what E stands at
    motion::PieceCounter pieces_;
    std::size_t piece_ = ~std::size_t{0};  ///< at hand
    std::size_t told_ = 0;                 ///< pieces whose time is in seconds_
    double seconds_ = 0;                   ///< until the piece at hand
    int percent_ = 0;
    int minutes_left_ = -1;
    std::string progress_;  ///< as it was last told
    std::optional<decomp::Error> error_;
};

}  // namespace

Result<Program> post_fdm(const path::LayerStack& on_bed, const profile::FdmSetup& setup,
                         const PostOptions& options, const decomp::Run& run) {
    const Result<Eigen::AlignedBox3d> beads = bounds_of(on_bed);
    if (!beads) {
        return fail(beads.error());
    }
    const Status inside = check_in_chamber(*beads, setup.machine);
    if (!inside) {
        return fail(inside.error());
    }
    const path::LayerStack stack = motion::cooled(on_bed, setup);
    Program program;
    program.estimate = motion::estimate(stack, setup);
    const std::string title = one_line(options.title);
    Result<std::string> text = Poster(stack, setup, program.estimate,
                                      program_values(setup, *beads, stack.layers.size(), title))
                                   .write(title, run);
    if (!text) {
        return fail(text.error());
    }
    if (const auto word = profile::first_forbidden_word(*text, setup.dialect)) {
        return fail("post.forbidden_word",
                    word->word + " must never be written for " + setup.dialect.name,
                    "line " + std::to_string(word->line),
                    "a template of the machine or of the dialect has it");
    }
    program.text = std::move(*text);
    return program;
}

}  // namespace cam::post
