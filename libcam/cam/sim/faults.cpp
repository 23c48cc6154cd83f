// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/sim/faults.h"

#include <cstdlib>
#include <sstream>

namespace cam::sim {

namespace {

bool read_rate(const std::string& word, double& rate) {
    char* end = nullptr;
    rate = std::strtod(word.c_str(), &end);
    return end != word.c_str() && *end == '\0' && rate >= 0 && rate <= 1;
}

bool read_count(const std::string& word, long& count) {
    char* end = nullptr;
    count = std::strtol(word.c_str(), &end, 10);
    return end != word.c_str() && *end == '\0' && count > 0;
}

/// "40ms", "2s"
bool read_time(const std::string& word, Time& time) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    const std::string unit = end;
    if (end == word.c_str() || value < 0 || value > 1e6 || (unit != "ms" && unit != "s")) {
        return false;
    }
    time = Time(static_cast<Time::rep>(value * (unit == "s" ? 1e9 : 1e6)));
    return true;
}

bool read_sides(const std::string& side, double rate, double& out, double& in) {
    if (side != "out" && side != "in" && side != "both") {
        return false;
    }
    out = side == "in" ? out : rate;
    in = side == "out" ? in : rate;
    return true;
}

bool read_fault(const std::vector<std::string>& words, Faults& faults) {
    const auto is = [&](const char* first, const char* second, std::size_t count) {
        return words.size() == count && words[0] == first && words[1] == second;
    };
    double rate = 0;
    long count = 0;
    if (words.size() == 2 && words[0] == "seed" && read_count(words[1], count)) {
        faults.seed = static_cast<std::uint64_t>(count);
        return true;
    }
    if (is("flip", "line", 4)) {
        return read_rate(words[2], rate) &&
               read_sides(words[3], rate, faults.flip_line_out, faults.flip_line_in);
    }
    if (is("flip", "byte", 4)) {
        return read_rate(words[2], rate) &&
               read_sides(words[3], rate, faults.flip_byte_out, faults.flip_byte_in);
    }
    if (is("drop", "byte", 4)) {
        return read_rate(words[2], rate) &&
               read_sides(words[3], rate, faults.drop_byte_out, faults.drop_byte_in);
    }
    if (is("drop", "ack", 3)) {
        return read_rate(words[2], faults.drop_ack);
    }
    if (is("double", "ack", 3)) {
        return read_rate(words[2], faults.double_ack);
    }
    if (is("delay", "ack", 4)) {
        return read_rate(words[2], faults.delay_ack) && read_time(words[3], faults.delay);
    }
    if (is("unplug", "every", 5) && words[3] == "for") {
        return read_count(words[2], faults.unplug_every) && read_time(words[4], faults.unplugged);
    }
    if (is("reset", "at", 3) && read_count(words[2], count)) {
        faults.reset_at.push_back(count);
        return true;
    }
    return false;
}

}  // namespace

tl::expected<Faults, std::string> read_faults(std::string_view script) {
    Faults faults;
    std::istringstream lines{std::string(script)};
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        std::istringstream stream(line.substr(0, line.find('#')));
        std::vector<std::string> words;
        for (std::string word; stream >> word;) {
            words.push_back(word);
        }
        if (!words.empty() && !read_fault(words, faults)) {
            return tl::make_unexpected("line " + std::to_string(number) +
                                       " of the faults cannot be read: '" + line + "'");
        }
    }
    return faults;
}

}  // namespace cam::sim
