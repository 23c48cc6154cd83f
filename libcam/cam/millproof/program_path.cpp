// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/millproof/program_path.h"

#include "decomp/base/number.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

namespace cam::millproof {

namespace {

constexpr double kChordMm = 0.001;
/// How far the two radii of an arc may differ: three decimals, both ends.
constexpr double kArcMismatchMm = 0.005;
constexpr double kInch = 25.4;
/// Feeds above a limit by less than this share are rounding.
constexpr double kFeedSlack = 1.001;

struct Word {
    char letter = 0;
    double value = 0;
};

class Reader {
  public:
    Reader(std::string_view text, const MillJob& job) : text_(text), job_(job) {}

    ProgramPath run() {
        while (!text_.empty() && !ended_) {
            ++line_;
            const std::size_t end = std::min(text_.find('\n'), text_.size());
            block(text_.substr(0, end));
            text_.remove_prefix(std::min(end + 1, text_.size()));
        }
        if (!ended_ && !job_.dialect.end.starts_with("M5")) {
            fault("end", "the program has no end (M2 or M30)");
        }
        if (spindle_on_ && !ended_) {
            fault("spindle", "the spindle still turns at the end");
        }
        return std::move(path_);
    }

  private:
    void fault(const char* kind, std::string what) {
        path_.faults.push_back({kind, line_, std::move(what)});
    }

    void comment(std::string_view text) {
        while (!text.empty() && text.front() == ' ') {
            text.remove_prefix(1);
        }
        // Controllers without a changer are told of a tool in a comment: "T2: ...".
        double number = 0;
        if (text.size() > 1 && text[0] == 'T') {
            const auto [end, error] =
                std::from_chars(text.data() + 1, text.data() + text.size(), number);
            if (error == std::errc{} && end != text.data() + text.size() && *end == ':') {
                pending_tool_ = static_cast<int>(number);
            }
        }
    }

    /// Splits a line into words; false when it cannot be read.
    bool split(std::string_view line) {
        words_.clear();
        std::size_t i = 0;
        while (i < line.size()) {
            const char c = static_cast<char>(std::toupper(static_cast<unsigned char>(line[i])));
            if (c == ' ' || c == '\t' || c == '\r') {
                ++i;
            } else if (c == ';') {
                comment(line.substr(i + 1));
                return true;
            } else if (c == '(') {
                const std::size_t close = line.find(')', i);
                if (close == std::string_view::npos) {
                    return false;
                }
                comment(line.substr(i + 1, close - i - 1));
                i = close + 1;
            } else if (c >= 'A' && c <= 'Z') {
                Word word{c, 0};
                std::size_t begin = i + 1;
                const auto [end, error] =
                    std::from_chars(line.data() + begin, line.data() + line.size(), word.value);
                if (error != std::errc{}) {
                    return false;
                }
                words_.push_back(word);
                i = static_cast<std::size_t>(end - line.data());
                if (words_.size() == 1 && word.letter == 'M' && word.value == 0) {
                    return true;  // what follows is a text for the operator
                }
            } else {
                return false;
            }
        }
        return true;
    }

    [[nodiscard]] std::optional<double> value(char letter) const {
        for (const Word& word : words_) {
            if (word.letter == letter) {
                return word.value;
            }
        }
        return std::nullopt;
    }

    void block(std::string_view line) {
        if (line.size() > static_cast<std::size_t>(job_.dialect.line_limit) + 1) {
            fault("line", "longer than the controller reads");
        }
        if (!split(line)) {
            fault("word", "cannot be read: " + std::string(line.substr(0, 40)));
            return;
        }
        bool moves = false;
        for (const Word& word : words_) {
            if (word.letter == 'G') {
                g_word(word.value);
            } else if (word.letter == 'F') {
                feed_ = word.value * unit_;
            } else if (word.letter == 'S') {
                rpm_ = word.value;
            } else if (word.letter == 'T') {
                pending_tool_ = static_cast<int>(word.value);
            } else if (word.letter == 'X' || word.letter == 'Y' || word.letter == 'Z') {
                moves = true;
            } else if (std::string_view("IJPHNM").find(word.letter) == std::string_view::npos) {
                fault("word", std::string("a word that nothing here needs: ") + word.letter);
            }
        }
        for (const Word& word : words_) {
            if (word.letter == 'M') {
                m_word(word.value);
            }
        }
        if (moves) {
            move();
        }
    }

    void g_word(double code) {
        static constexpr double kHarmless[] = {4, 17, 21, 40, 43, 49, 54, 64, 80, 90, 91.1, 94};
        const std::string name = "G" + decomp::decimal(code, 1);
        const auto& forbidden = job_.dialect.forbidden;
        if (std::find(forbidden.begin(), forbidden.end(), name) != forbidden.end() && code != 20) {
            fault("word", name + " is forbidden in this dialect");
        }
        if (code >= 0 && code <= 3 && code == std::floor(code)) {
            mode_ = static_cast<int>(code);
        } else if (code == 20) {
            unit_ = kInch;
            fault("units", "G20: inches; every number here is millimetres");
        } else if (code == 21) {
            unit_ = 1;
            millimetres_ = true;
        } else if (std::find(std::begin(kHarmless), std::end(kHarmless), code) ==
                   std::end(kHarmless)) {
            fault("word", name + ": not among the words that can be proved");
        }
    }

    void m_word(double code) {
        if (code == 3) {
            spindle_on_ = true;
            const auto& spindle = job_.machine.spindle;
            if (rpm_ < spindle.min_rpm || rpm_ > spindle.max_rpm || !(rpm_ > 0)) {
                fault("speed", "the spindle cannot turn at " + decomp::decimal(rpm_, 0));
            }
        } else if (code == 4) {
            fault("spindle", "M4: the spindle turns the wrong way");
        } else if (code == 5) {
            spindle_on_ = false;
        } else if (code == 6 || code == 0) {
            change();
        } else if (code == 2 || code == 30) {
            ended_ = true;
            if (spindle_on_) {
                fault("spindle", "the spindle still turns at the end");
            }
        } else if (code != 7 && code != 8 && code != 9 && code != 84) {
            fault("word", "M" + decomp::decimal(code, 0) + ": not a word that can be proved");
        }
    }

    void change() {
        if (spindle_on_) {
            fault("spindle", "a change of tool while the spindle turns");
        }
        if (known_[2] && at_.z() < job_.safe_z - kArcMismatchMm) {
            fault("change", "a change of tool below the safe height");
        }
        tool_ = -1;
        for (std::size_t i = 0; i < job_.tools.size(); ++i) {
            if (job_.tools[i].tool.number == pending_tool_) {
                tool_ = static_cast<int>(i);
            }
        }
        if (tool_ < 0) {
            fault("tool", "there is no tool " + std::to_string(pending_tool_));
        }
        path_.tool_lines.push_back(line_);
        known_[0] = known_[1] = known_[2] = false;
    }

    void move() {
        const Eigen::Vector3d from = at_;
        const bool knew = known_[0] && known_[1] && known_[2];
        const char letters[] = {'X', 'Y', 'Z'};
        for (int axis = 0; axis < 3; ++axis) {
            if (const auto to = value(letters[axis])) {
                at_[axis] = *to * unit_;
                known_[axis] = true;
            }
        }
        if (!millimetres_ && !warned_) {
            warned_ = true;
            fault("units", "moves before G21: millimetres are not sure");
        }
        if (mode_ == 0) {
            if (tool_ < 0) {
                fault("tool", "a move without a tool");
            }
            if (knew) {
                step(from, at_, true);
            } else if ((value('X') || value('Y')) &&
                       (!known_[2] || at_.z() < job_.safe_z - kArcMismatchMm)) {
                fault("start", "a rapid across while the height is not known to be safe");
            }
            return;
        }
        check_cut(knew);
        if (!knew) {
            return;
        }
        if (mode_ == 1) {
            step(from, at_, false);
        } else {
            arc(from);
        }
    }

    void check_cut(bool knew) {
        if (!knew) {
            fault("start", "a cut from a place that the program does not name");
        }
        if (!spindle_on_) {
            fault("spindle", "a cut while the spindle stands still");
        }
        if (tool_ < 0) {
            fault("tool", "a cut without a tool");
        }
        if (!(feed_ > 0)) {
            fault("feed", "a cut without a feed");
        }
        double top = job_.machine.axes.max_feed_mm_per_min.head<2>().maxCoeff();
        if (tool_ >= 0 && job_.tools[static_cast<std::size_t>(tool_)].max_mm_per_min > 0) {
            top = std::min(top, job_.tools[static_cast<std::size_t>(tool_)].max_mm_per_min);
        }
        if (feed_ > top * kFeedSlack && feed_ != told_feed_) {
            told_feed_ = feed_;
            fault("feed", "F" + decomp::decimal(feed_, 1) + " is above " + decomp::decimal(top, 1) +
                              " mm/min, the most for tool and machine");
        }
    }

    void step(const Eigen::Vector3d& from, const Eigen::Vector3d& to, bool rapid) {
        path_.steps.push_back({from, to, line_, tool_, rapid, feed_});
    }

    void arc(const Eigen::Vector3d& from) {
        const Eigen::Vector2d centre =
            from.head<2>() +
            Eigen::Vector2d(value('I').value_or(0), value('J').value_or(0)) * unit_;
        const Eigen::Vector2d begin = from.head<2>() - centre;
        const Eigen::Vector2d end = at_.head<2>() - centre;
        const double r = begin.norm();
        if (!(r > 0) || std::abs(r - end.norm()) > kArcMismatchMm) {
            fault("arc", "an arc whose ends have radii " + decomp::decimal(r, 4) + " and " +
                             decomp::decimal(end.norm(), 4));
            step(from, at_, false);
            return;
        }
        constexpr double kTurn = 2 * std::numbers::pi;
        double angle = std::atan2(end.y(), end.x()) - std::atan2(begin.y(), begin.x());
        if (mode_ == 2) {
            angle = angle >= 0 ? angle - kTurn : angle;
        } else {
            angle = angle <= 0 ? angle + kTurn : angle;
        }
        const double chord = 2 * std::acos(std::max(0.0, 1 - kChordMm / std::max(r, kChordMm)));
        const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(angle) / chord)));
        Eigen::Vector3d last = from;
        for (int i = 1; i <= pieces; ++i) {
            const double share = i / static_cast<double>(pieces);
            Eigen::Vector3d next = at_;
            if (i < pieces) {
                next.head<2>() = centre + Eigen::Rotation2Dd(angle * share) * begin;
                next.z() = from.z() + (at_.z() - from.z()) * share;
            }
            step(last, next, false);
            last = next;
        }
    }

    std::string_view text_;
    const MillJob& job_;
    ProgramPath path_;
    std::vector<Word> words_;
    Eigen::Vector3d at_ = Eigen::Vector3d::Zero();
    bool known_[3] = {false, false, false};
    bool millimetres_ = false;
    bool warned_ = false;
    bool spindle_on_ = false;
    bool ended_ = false;
    long line_ = 0;
    int mode_ = 0;
    int tool_ = -1;
    int pending_tool_ = -1;
    double unit_ = 1;
    double feed_ = 0;
    double told_feed_ = -1;
    double rpm_ = 0;
};

}  // namespace

ProgramPath read_program(std::string_view program, const MillJob& job) {
    return Reader(program, job).run();
}

}  // namespace cam::millproof
