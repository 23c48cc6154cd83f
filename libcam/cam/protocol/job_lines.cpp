// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/protocol/job_lines.h"

#include "decomp/base/assert.h"

namespace cam::protocol {

void JobLines::add(std::string_view text, long source, LineKind kind) {
    entries_.push_back({text_.size(), static_cast<std::uint32_t>(text.size()),
                        static_cast<std::uint32_t>(source), kind});
    text_ += text;
}

void JobLines::ask(std::string question) {
    DECOMP_ASSERT(!entries_.empty() && entries_.back().kind == LineKind::Ask);
    questions_[entries_.size() - 1] = std::move(question);
}

void JobLines::expect(const AxisValues& position) {
    DECOMP_ASSERT(!entries_.empty() && (entries_.back().kind == LineKind::Ask ||
                                        entries_.back().kind == LineKind::Drain));
    expected_[entries_.size() - 1] = position;
}

std::string_view JobLines::text(std::size_t index) const {
    const Entry& entry = entries_[index];
    return std::string_view(text_).substr(entry.begin, entry.length);
}

const std::string& JobLines::question(std::size_t index) const {
    static const std::string kContinue = "continue?";
    const auto found = questions_.find(index);
    return found == questions_.end() ? kContinue : found->second;
}

const AxisValues* JobLines::expected(std::size_t index) const {
    const auto found = expected_.find(index);
    return found == expected_.end() ? nullptr : &found->second;
}

}  // namespace cam::protocol
