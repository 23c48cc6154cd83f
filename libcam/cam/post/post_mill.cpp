// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/post/post_mill.h"

#include "cam/post/mill_writer.h"
#include "cam/profile/template.h"
#include "decomp/base/number.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace cam::post {

namespace {

/// A sweep this little above a whole number of pieces is that number.
constexpr double kSlack = 1e-9;

using decomp::fail;
using decomp::Result;
using decomp::Status;

class Poster {
  public:
    Poster(const path::MillProgram& program, const std::vector<tool::Tool>& tools,
           const profile::MillSetup& setup)
        : program_(program),
          tools_(tools),
          setup_(setup),
          writer_(setup.dialect, setup.machine.axes.max_feed_mm_per_min.minCoeff()) {}

    Result<std::string> run(const std::string& title) {
        head(title);
        Status done = expanded(setup_.dialect.start);
        for (const path::MillMove& move : program_.moves) {
            ++index_;
            if (!done) {
                break;
            }
            if (named_ != move.operation || index_ == 1) {
                named_ = move.operation;
                writer_.comment(path::operation_name(named_));
            }
            done = std::visit([&](const auto& what) { return put(what); }, move.what);
        }
        if (done) {
            done = expanded(setup_.dialect.end);
        }
        if (!done) {
            return fail(done.error());
        }
        const long line = writer_.long_line();
        if (line > 0) {
            return fail("post.long_line",
                        "a line is longer than " + std::to_string(setup_.dialect.line_limit) +
                            " characters, which " + setup_.dialect.title + " may not read",
                        "line " + std::to_string(line));
        }
        return allowed(std::move(writer_).take());
    }

  private:
    void head(const std::string& title) {
        const auto box = [](const Eigen::Vector3d& at) {
            return decomp::decimal(at.x(), 3) + " " + decomp::decimal(at.y(), 3) + " " +
                   decomp::decimal(at.z(), 3);
        };
        writer_.comment(title + ", " + program_.name);
        writer_.comment("stock from " + box(program_.stock.min()) + " to " +
                        box(program_.stock.max()) + " mm, safe at Z " +
                        decomp::decimal(program_.safe_z, 3));
        for (const tool::Tool& tool : tools_) {
            writer_.comment("tool " + std::to_string(tool.number) + ": " + tool.title);
        }
    }

    Status expanded(const std::string& text) {
        const profile::TemplateValues values = {{"tool", static_cast<double>(tool_)},
                                                {"rpm", rpm_},
                                                {"seconds", seconds_},
                                                {"milliseconds", seconds_ * 1000},
                                                {"safe_z_mm", program_.safe_z}};
        const Result<std::string> written = profile::expand(text, values);
        if (!written) {
            return fail(written.error());
        }
        writer_.raw(*written);
        return {};
    }

    [[nodiscard]] tl::unexpected<decomp::Error> order(const std::string& what) const {
        return fail("post.mill_order", what, program_.name + ", move " + std::to_string(index_));
    }

    Status may_cut(const Eigen::Vector3d& to, decomp::Speed feed) {
        if (!to.allFinite()) {
            return order("a coordinate is no number");
        }
        if (!(rpm_ > 0)) {
            return order("a cut while the spindle stands still");
        }
        if (!writer_.knows_position()) {
            return order("a cut from an unknown place: a rapid must come first");
        }
        if (!(feed.mm_per_min() > 0) || !std::isfinite(feed.mm_per_min())) {
            return fail("post.mill_feed", "a cut without a feed",
                        program_.name + ", move " + std::to_string(index_));
        }
        return {};
    }

    Status put(const path::MillRapid& rapid) {
        if (!rapid.to.allFinite()) {
            return order("a coordinate is no number");
        }
        if (tool_ == 0) {
            return order("a move before a tool was taken");
        }
        if (!writer_.knows_height() && rapid.to.z() < program_.safe_z) {
            // Nobody knows how high the tool stands: up first, then where it shall go.
            writer_.rapid({rapid.to.x(), rapid.to.y(), program_.safe_z});
        }
        writer_.rapid(rapid.to);
        return {};
    }

    Status put(const path::MillCut& cut) {
        Status may = may_cut(cut.to, cut.feed);
        if (may) {
            writer_.line(cut.to, cut.feed.mm_per_min());
        }
        return may;
    }

    Status put(const path::MillArc& arc) {
        Status may = may_cut(arc.to, arc.feed);
        if (may) {
            round(arc);
        }
        return may;
    }

    void round(const path::MillArc& arc) {
        const Eigen::Vector3d from = writer_.position();
        const Eigen::Vector2d begin = from.head<2>() - arc.centre;
        const Eigen::Vector2d end = arc.to.head<2>() - arc.centre;
        const double radius = begin.norm();
        constexpr double kTurn = 2 * std::numbers::pi;
        double sweep = std::atan2(begin.x() * end.y() - begin.y() * end.x(), begin.dot(end));
        if ((end - begin).norm() < std::pow(10.0, -setup_.dialect.decimals)) {
            sweep = arc.clockwise ? -kTurn : kTurn;
        } else if (arc.clockwise && sweep > 0) {
            sweep -= kTurn;
        } else if (!arc.clockwise && sweep < 0) {
            sweep += kTurn;
        }
        const double rise = arc.to.z() - from.z();
        const profile::MillDialect& dialect = setup_.dialect;
        const bool as_arc = dialect.arcs && radius >= dialect.min_arc_radius_mm &&
                            radius <= dialect.max_arc_radius_mm && (dialect.helices || rise == 0);
        const double chord =
            2 * std::acos(std::max(0.0, 1 - kMillChordMm / std::max(radius, kMillChordMm)));
        const int pieces = static_cast<int>(
            std::ceil(std::abs(sweep) / (as_arc ? std::numbers::pi : chord) - kSlack));
        for (int i = 1; i <= std::max(pieces, 1); ++i) {
            const double share = i / static_cast<double>(std::max(pieces, 1));
            Eigen::Vector3d to = arc.to;
            if (i < pieces) {
                const Eigen::Rotation2Dd turn(sweep * share);
                to.head<2>() = arc.centre + turn * begin;
                to.z() = from.z() + rise * share;
            }
            if (as_arc && !writer_.same_in_print(to, writer_.position())) {
                writer_.half_arc(to, arc.centre, arc.clockwise, arc.feed.mm_per_min());
            } else {
                writer_.line(to, arc.feed.mm_per_min());
            }
        }
    }

    Status put(const path::MillDwell& dwell) {
        seconds_ = dwell.seconds;
        return expanded(setup_.dialect.dwell);
    }

    Status put(const path::MillTakeTool& take) {
        if (rpm_ > 0) {
            return order("a change of tool while the spindle turns");
        }
        const bool known = std::any_of(tools_.begin(), tools_.end(), [&](const tool::Tool& tool) {
            return tool.number == take.number;
        });
        if (!known) {
            return fail("post.mill_tool", "there is no tool number " + std::to_string(take.number),
                        program_.name + ", move " + std::to_string(index_));
        }
        tool_ = take.number;
        writer_.forget();
        Status done = expanded(setup_.dialect.take_tool);
        if (done) {
            done = expanded(setup_.dialect.tool_length);
        }
        return done;
    }

    Status put(const path::MillSpindle& spindle) {
        rpm_ = spindle.rpm;
        if (!(rpm_ > 0)) {
            return expanded(setup_.dialect.spindle_off);
        }
        Status done = expanded(setup_.dialect.spindle_on);
        if (done && setup_.machine.spindle.spin_up_s > 0) {
            done = put(path::MillDwell{setup_.machine.spindle.spin_up_s});
        }
        return done;
    }

    Status put(const path::MillCoolant& coolant) {
        switch (coolant.coolant) {
            case path::Coolant::Mist:
                return expanded(setup_.dialect.mist);
            case path::Coolant::Flood:
                return expanded(setup_.dialect.flood);
            case path::Coolant::Off:
                break;
        }
        return expanded(setup_.dialect.coolant_off);
    }

    [[nodiscard]] Result<std::string> allowed(std::string text) const {
        profile::Dialect words;
        words.comment = setup_.dialect.comment_open;
        words.forbidden = setup_.dialect.forbidden;
        if (const auto word = profile::first_forbidden_word(text, words)) {
            return fail("post.forbidden_word",
                        "the program has " + word->word + ", which the dialect " +
                            setup_.dialect.name + " forbids",
                        "line " + std::to_string(word->line));
        }
        return text;
    }

    const path::MillProgram& program_;
    const std::vector<tool::Tool>& tools_;
    const profile::MillSetup& setup_;
    MillWriter writer_;
    path::MillOperation named_ = path::MillOperation::Rough;
    std::size_t index_ = 0;
    int tool_ = 0;
    double rpm_ = 0;
    double seconds_ = 0;
};

}  // namespace

Result<std::string> post_mill(const path::MillProgram& program,
                              const std::vector<tool::Tool>& tools, const profile::MillSetup& setup,
                              const std::string& title) {
    return Poster(program, tools, setup).run(title);
}

}  // namespace cam::post
