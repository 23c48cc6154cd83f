// SPDX-License-Identifier: GPL-3.0-or-later
// What the records of a job's journal say: "begin {…}", "allow N", "at ACKED SENT", "event …",
// "lost", "end …".
#include "cam/stream/resume.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>

namespace cam::stream {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "hew.journal/1";

bool take_count(std::string_view& text, std::size_t& count) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    text.remove_prefix(text.starts_with(' ') ? 1 : 0);
    return error == std::errc{};
}

decomp::Result<JournalHead> read_head(std::string_view text) {
    try {
        const Json json = Json::parse(text);
        if (json.at("schema").get<std::string>() != kSchema) {
            return decomp::fail("stream.journal_schema", "the journal is of another version");
        }
        JournalHead head;
        json.at("program").get_to(head.program);
        json.at("program_sha256").get_to(head.program_sha256);
        json.at("profile_sha256").get_to(head.profile_sha256);
        json.at("machine").get_to(head.machine);
        json.at("link").get_to(head.link);
        json.at("protocol").get_to(head.protocol);
        json.at("first_line").get_to(head.first_line);
        json.at("preamble").get_to(head.preamble);
        json.at("allowed").get_to(head.allowed);
        json.at("foreign").get_to(head.foreign);
        json.at("entries").get_to(head.entries);
        return head;
    } catch (const Json::exception& exception) {
        return decomp::fail(
            "stream.journal_schema",
            std::string("the journal's beginning cannot be read: ") + exception.what());
    }
}

}  // namespace

std::string begin_record(const JournalHead& head) {
    const Json json{{"schema", kSchema},
                    {"program", head.program},
                    {"program_sha256", head.program_sha256},
                    {"profile_sha256", head.profile_sha256},
                    {"machine", head.machine},
                    {"link", head.link},
                    {"protocol", head.protocol},
                    {"first_line", head.first_line},
                    {"preamble", head.preamble},
                    {"allowed", head.allowed},
                    {"foreign", head.foreign},
                    {"entries", head.entries}};
    return "begin " + json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

decomp::Result<Standing> read_standing(const journal::Contents& contents) {
    Standing standing;
    bool begun = false;
    for (const std::string& record : contents.records) {
        std::string_view text = record;
        const std::string_view kind = text.substr(0, text.find(' '));
        text.remove_prefix(std::min(kind.size() + 1, text.size()));
        if (kind == "begin") {
            auto head = read_head(text);
            if (!head) {
                return decomp::fail(head.error());
            }
            standing = {};
            standing.head = std::move(*head);
            begun = true;
        } else if (kind == "allow") {
            // A later attempt begins with less, and takes nothing back.
            std::size_t allowed = 0;
            (void)take_count(text, allowed);
            standing.allowed = std::max(standing.allowed, allowed);
        } else if (kind == "at") {
            (void)(take_count(text, standing.acked) && take_count(text, standing.sent));
            standing.ended = false;
        } else if (kind == "event") {
            standing.last_event = text;
        } else if (kind == "continue") {
            standing.ended = false;
        } else if (kind == "end") {
            standing.ended = true;
            standing.ending = text;
        }
    }
    if (!begun) {
        return decomp::fail("stream.no_journal", "the journal holds no whole beginning of a job",
                            {}, "begin the job anew with --force");
    }
    return standing;
}

}  // namespace cam::stream
